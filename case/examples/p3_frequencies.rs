//! Writes the chordwise frequencies of graded rotating beams by assumed modes and by elements (P3), as Markdown:
//! `cargo run --release --example p3_frequencies > docs/src/rotating_frequencies.md`.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use flexion::analysis::modes::modes;
use flexion::analysis::rotation::rotate_stably;
use flexion::system::State;
use flexion_case::{Reading, read};
use std::path::Path;

const SPEEDS: [f64; 9] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 10.0, 20.0, 50.0];
const EXPONENTS: [f64; 6] = [0.0, 0.5, 1.0, 2.0, 5.0, 10.0];
const MODES: &str = "basis={kind='modes',axial=4,transverse=4}";
const ELEMENTS: &str = "basis={kind='finite-elements',elements=10,axial-degree=2}";

/// τ = (12 ρt L⁴ / (Et h²))^½ of P3's beam: metal 70 GPa, 2707 kg/m³, L = 5 m, h = 20 mm.
fn unit_of_time() -> f64 {
    (12.0 * 2707.0 * 5.0_f64.powi(4) / (70e9 * 0.02 * 0.02)).sqrt()
}

fn case(exponent: f64, basis: &str) -> Reading {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../verification/p3_spin_up");
    let overrides = [format!("section.exponent={exponent}"), basis.to_owned()];
    read(&folder, &overrides).unwrap()
}

/// The two lowest frequencies times τ at γ = Ωτ: all unknowns.
fn full(exponent: f64, basis: &str, gamma: f64) -> [f64; 2] {
    let mut system = case(exponent, basis).case.system().unwrap();
    let mut state = State::zeros(system.size(), 0.0);
    rotate_stably(system.as_mut(), &mut state, 0.0, gamma / unit_of_time()).unwrap();
    let found = modes(system.as_mut(), &state, 2, &[]).unwrap().modes;
    [found[0].frequency() * unit_of_time(), found[1].frequency() * unit_of_time()]
}

/// The same with the transverse unknowns only: M₂ B̈ + [Ω²(C − M₂) + K₃] B = 0.
fn transverse(exponent: f64, basis: &str, gamma: f64) -> [f64; 2] {
    let found = case(exponent, basis).transverse_frequencies(gamma / unit_of_time(), 2).unwrap();
    [found[0].0 * unit_of_time(), found[1].0 * unit_of_time()]
}

fn table(which: usize, of: fn(f64, &str, f64) -> [f64; 2]) {
    let head: Vec<String> = EXPONENTS.iter().map(|n| format!(" N = {n} |")).collect();
    println!("| γ |{}", head.concat());
    println!("|---|{}", "---|".repeat(EXPONENTS.len()));
    for gamma in SPEEDS {
        print!("| {gamma} |");
        for exponent in EXPONENTS {
            let (a, b) = (of(exponent, MODES, gamma)[which], of(exponent, ELEMENTS, gamma)[which]);
            print!(" {b:.4} ({:+.3} %) |", 100.0 * (a / b - 1.0));
        }
        println!();
    }
    println!();
}

fn main() {
    println!(
        "# Frequencies of rotating graded beams, computed

Made by `cargo run --release --example p3_frequencies`. The beam of P3 (ceramic 151 GPa and 3000 kg/m³, metal 70 GPa and
2707 kg/m³, 5 m × 20 mm × 20 mm, no hub radius) rotates steadily; chordwise frequencies ω and speed Ω are multiples of 1/τ,
τ = (12 ρₜL⁴/(Eₜh²))^½, γ = Ωτ. Each entry: 10 finite elements, and in brackets how far 4 assumed modes are from them. N is
the exponent of the grading, N = 0 pure ceramic.

*Transverse* keeps the deflection only, as P3's frequency equation does: M₂ B̈ + [Ω²(C − M₂) + K₃] B = 0. *Full* is the
whole linear problem of the first-order coupling: axial displacement, the coupling ES of stretch and bending, and
gyroscopic forces.
"
    );
    for (which, name) in ["First", "Second"].iter().enumerate() {
        println!("## {name} frequency, transverse\n");
        table(which, transverse);
        println!("## {name} frequency, full\n");
        table(which, full);
    }
}
