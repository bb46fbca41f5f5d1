//! Writes the tables of P1's and P3's transients in every basis and coupling, as Markdown:
//! `cargo run --release --example basis_coupling_tables > docs/src/basis_coupling_tables.md`.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

#[path = "../tests/verification/run.rs"]
mod run;

use run::{Span, case, integrate};

const WHOLE: Span = Span { from: 0.0, to: 20.0 };
const AFTER: Span = Span { from: 15.0, to: 20.0 };
const TIP: &str = "tip.deflection";
/// Extremes are those of the motion and not of its sampling.
const OUTPUT: &str = "output={step=0.005,energy-balance=false}";

const CASES: [(&str, &str); 9] = [
    ("p1_spin_up_4", "P1: Ω = 4 rad/s, E = 70 GPa"),
    ("p1_spin_up_20", "P1: Ω = 20 rad/s, E = 70 GPa"),
    ("p1_spin_up_20_at_30_gpa", "P1: Ω = 20 rad/s, E = 30 GPa"),
    ("p1_spin_up_4_at_5_gpa", "P1: Ω = 4 rad/s, E = 5 GPa"),
    ("p3_spin_up/n0", "P3: N = 0, Ω = 4 rad/s"),
    ("p3_spin_up", "P3: N = 2, Ω = 4 rad/s"),
    ("p3_spin_up/at_10_rad_s", "P3: N = 2, Ω = 10 rad/s"),
    ("p3_spin_up/at_20_rad_s", "P3: N = 2, Ω = 20 rad/s"),
    ("p3_spin_up/soft_ceramic", "P3: N = 0, ceramic modulus 15.1 GPa, Ω = 10 rad/s"),
];

const BASES: [(&str, &str); 6] = [
    ("finite elements, 10", "basis={kind='finite-elements',elements=10,axial-degree=2}"),
    ("modes, 5 + 5", "basis={kind='modes',axial=5,transverse=5}"),
    ("RPIM, 11 nodes", "basis={kind='radial',nodes=11}"),
    ("PIM, 11 nodes", "basis={kind='polynomial',nodes=11}"),
    ("B-splines, 8 of degree 4", "basis={kind='b-spline',elements=8,degree=4}"),
    ("Bézier, degree 9", "basis={kind='bezier',degree=9}"),
];

const COUPLINGS: [&str; 4] = ["zeroth", "first", "high", "exact"];

/// What a cell says.
enum Cell {
    /// Smallest deflection of the tip and amplitude after the spin-up [m].
    Ends(f64, f64),
    /// Time at which the run ended [s], and why.
    Breaks(f64, String),
    /// Why there is no run.
    Refused(String),
}

fn cell(folder: &str, coupling: &str, basis: &str) -> Cell {
    let model = format!("model.coupling={coupling}");
    // The exact coupling has one field, whose axial part has no degree of its own.
    let basis = if coupling == "exact" { basis.replace(",axial-degree=2", "") } else { basis.to_owned() };
    let run = case(folder, &[&model, &basis, OUTPUT]).and_then(|reading| integrate(&reading));
    match run {
        Err(problems) => Cell::Refused(problems.list[0].message.clone()),
        Ok(run) => match &run.failure {
            Some(message) => Cell::Breaks(run.end, message.clone()),
            None => Cell::Ends(run.extreme(TIP, -1.0, WHOLE).0, run.amplitude(TIP, AFTER)),
        },
    }
}

/// The reason in a message that a run broke down with, without what the table says already.
fn reason(message: &str) -> String {
    let after = |key: &str| message.split(key).nth(1).map(|rest| rest.split([' ', ':', ',']).next().unwrap());
    if let (Some(passed), true) = (after("since t = "), message.contains("stiffness K")) {
        return format!("stiffness exhausted since {passed} s");
    }
    // "the deflection (… at x = …) exceeds 10 m on a beam of 10 m: …"
    let beyond = message.split(" exceeds ").nth(1).and_then(|rest| rest.split(" on a beam").next());
    beyond.map_or_else(
        || message.to_owned(),
        |bound| format!("deflects by more than {bound}, the length of the beam"),
    )
}

fn main() {
    println!(
        "# Transients in every basis and coupling\n\n\
         Made by `cargo run --release --example basis_coupling_tables`: P1's four spin-ups (Du, Zhang & Hong 2015, \
         doi:10.6052/0459-1879-14-334)\nand the graded beams of P3, with each basis and each coupling. P3's underlined terms are \
         what `high` has beyond `first`.\n\n\
         A cell has the smallest deflection of the tip over the run and, in brackets, its difference from the exact coupling with 40\n\
         elements; then the amplitude (max − min)/2 of the deflection after the spin-up, 15–20 s. Or it says when the run ended\n\
         and why, or why there is none. Integrator: `radau` with its default tolerances.\n"
    );
    println!(
        "The exact coupling with another basis than finite elements is refused: it describes the whole curve of the beam by \
         one Hermite\nfield. `zeroth` ends as soon as the hub has rotated faster than the first frequency of the beam for long enough.\n\n\
         At E = 5 GPa and Ω = 4 rad/s a simple iteration on the high-order equations is said to lose convergence near 14–15 s. With Newton's \
         method\nthe `high` column below ends earlier, at 7.4 s (five modes: 8.6 s), when the tip passes the length of the beam: the model \
         gives up, not the\niteration; a simple iteration gives up still earlier, at a slope of 0.6 \
         ([why](theory/hub_beam.md#where-the-high-order-coupling-ends)).\n"
    );
    for (folder, title) in CASES {
        let fine = "basis={kind='finite-elements',elements=40}";
        let reference = match cell(folder, "exact", fine) {
            Cell::Ends(minimum, amplitude) => Some((minimum, amplitude)),
            _ => None,
        };
        println!("## {title}\n");
        if let Some((minimum, amplitude)) = reference {
            println!("Exact, 40 elements: {minimum:.5} m, {amplitude:.3e} m.\n");
        }
        println!("| basis | {} |\n|---|---|---|---|---|", COUPLINGS.map(|c| format!("`{c}`")).join(" | "));
        for (name, basis) in BASES {
            let cells = COUPLINGS.map(|coupling| match cell(folder, coupling, basis) {
                Cell::Ends(minimum, amplitude) => {
                    let off = reference.map_or(f64::NAN, |(least, _)| 100.0 * (minimum / least - 1.0));
                    format!("{minimum:.5} m ({off:+.2} %), {amplitude:.3e} m")
                }
                Cell::Breaks(time, message) => format!("ends at t = {time:.3} s: {}", reason(&message)),
                Cell::Refused(message) => match message.split_once(" and cannot use the basis") {
                    // Said once above.
                    Some((why, _)) if why.contains("one Hermite field") => "refused".to_owned(),
                    _ => format!("refused: {message}"),
                },
            });
            println!("| {name} | {} |", cells.join(" | "));
        }
        println!();
    }
}
