//! Features of a section that are far shorter than an element: a soft segment, a notch between the rows of a table.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use flexion::quadrature::Gauss;
use flexion_case::{Reading, parse};
use flexion_results::Status;
use std::ops::ControlFlow;
use std::path::PathBuf;

const FORCE: f64 = 1.0;
const LENGTH: f64 = 10.0;

/// A folder of its own with a table of sections.
fn table(name: &str, rows: &[(f64, f64)], head: &str, row: impl Fn(f64) -> String) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("flexion-{}-{name}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let lines = rows.iter().map(|(x, stiffness)| format!("{x}, {}\n", row(*stiffness)));
    std::fs::write(folder.join("t.csv"), format!("{head}\n{}", lines.collect::<String>())).unwrap();
    folder.join("case.toml")
}

/// Rows (x, EI): straight lines between them.
fn stiffness(rows: &[(f64, f64)], x: f64) -> f64 {
    let i = rows.partition_point(|row| row.0 <= x).clamp(1, rows.len() - 1);
    let ((a, f), (b, g)) = (rows[i - 1], rows[i]);
    f + (x - a) / (b - a) * (g - f)
}

/// ∫ F (L − x)²/EI dx of a cantilever with a force at its tip.
fn deflection(rows: &[(f64, f64)]) -> f64 {
    let gauss = Gauss::new(20);
    let density = |x: f64| FORCE * (LENGTH - x).powi(2) / stiffness(rows, x);
    let piece = |pair: &[(f64, f64)]| -> f64 {
        let (a, h) = (pair[0].0, (pair[1].0 - pair[0].0) / 40.0);
        (0..40).map(|k| gauss.integrate(a + h * f64::from(k), a + h * f64::from(k + 1), density)).sum()
    };
    rows.windows(2).filter(|pair| pair[1].0 > pair[0].0).map(piece).sum()
}

fn read(case: &str, at: &std::path::Path, changes: &[&str]) -> Reading {
    let changes: Vec<String> = changes.iter().map(|c| (*c).to_owned()).collect();
    parse(case.to_owned(), at, &changes).unwrap_or_else(|problems| panic!("{problems}"))
}

fn tip(case: &str, at: &std::path::Path, column: &str, changes: &[&str]) -> f64 {
    let run = read(case, at, changes).prepare().unwrap().run(&mut |_| ControlFlow::Continue(()));
    assert_eq!(run.status, Status::Finished, "{:?}", run.message);
    *run.trajectory.column(column).unwrap().last().unwrap()
}

const PLANE: &str = "[beam]\nlength = 10\n[hub]\nmotion = { kind = 'constant', speed = 0 }\n[[load]]\non = 'tip'\nforce = [0, 1]\n\
                     [initial]\nkind = 'static'\n[run]\nduration = 0\n[section]\n";
const SPACE: &str = "initial = { kind = 'static' }\nrun = { duration = 0 }\n[[beam]]\nname = 'b'\nlength = 10\nroot = 'clamped'\n\
                     section = { kind = 'deck', format = 'csv', file = 't.csv' }\n[[load]]\non = 'b.tip'\nforce = [0, 0, 1]\n";
const WHOLE: f64 = 14_000.0;

/// 2 cm of 10 m with a thousandth of the bending stiffness: a hinge with a spring, 64 % of the deflection of the tip.
#[test]
fn a_soft_segment_bends_a_beam_however_short_it_is() {
    for (width, part) in [(0.02, 1e-3), (2e-3, 1e-4), (0.2, 1e-2)] {
        let section = format!(
            "kind = 'piecewise'\nends = [4.5, {}, 10]\nmodulus = ['70 GPa', '70 GPa', '70 GPa']\ndensity = [3000, 3000, 3000]\n\
             area = [4e-4, 4e-4, 4e-4]\nsecond-moment = [2e-7, {}, 2e-7]\n",
            4.5 + width,
            2e-7 * part
        );
        let (a, b) = (4.5, 4.5 + width);
        let soft = WHOLE * part;
        let rows = [(0.0, WHOLE), (a, WHOLE), (a, soft), (b, soft), (b, WHOLE), (10.0, WHOLE)];
        let expected = deflection(&rows);
        let case = format!("{PLANE}{section}");
        let at = std::path::Path::new("case.toml");
        for changes in [
            &[][..],
            &["basis.elements=3"],
            &["model.coupling=exact"],
            &["model.coupling=high"],
            &["mass=[{on='4.51 m',mass=1}]"],
        ] {
            let found = tip(&case, at, "tip.deflection", changes);
            // A large deflection shortens the beam by the square of its slope.
            let allowed = 2.0 * (expected / LENGTH).powi(2) + 1e-7;
            assert!((found / expected - 1.0).abs() < allowed, "{width} {changes:?}: {found} for {expected}");
        }
    }
}

/// A table whose rows make a notch of 6 cm, to a hundredth: by the beam in the plane and in space.
#[test]
fn a_notch_between_rows_bends_a_beam() {
    let rows = [(0.0, WHOLE), (6.14, WHOLE), (6.17, 0.01 * WHOLE), (6.2, WHOLE), (10.0, WHOLE)];
    let expected = deflection(&rows);
    let all = |ei: f64| format!("{}, {}, {ei}", 1.2 * ei / WHOLE, 2000.0 * ei);
    let at = table("plane", &rows, "x, mass, EA, EI", all);
    let case = format!("{PLANE}kind = 'table'\nfile = 't.csv'\ninterpolation = 'linear'\n");
    for changes in [&[][..], &["model.coupling=exact"], &["basis.elements=37"]] {
        let found = tip(&case, &at, "tip.deflection", changes);
        assert!((found / expected - 1.0).abs() < 1e-3, "{changes:?}: {found} for {expected}");
    }
    // Twice the elements take each part in two, and see what is left.
    let finer = tip(&case, &at, "tip.deflection", &["basis.refine=2"]);
    assert!((finer / expected - 1.0).abs() < 1e-4, "{finer} for {expected}");

    let both = |ei: f64| format!("{}, {}, {ei}, {ei}, {ei}, 1e-3, 1e-3", 1.2 * ei / WHOLE, 2000.0 * ei);
    let at = table("space", &rows, "x, mass, EA, EI-flap, EI-chord, GJ, inertia-flap, inertia-chord", both);
    let found = tip(SPACE, &at, "b.tip.displacement.z", &[]);
    assert!((found / expected - 1.0).abs() < 2e-3, "space: {found} for {expected}");
}

/// Two thousand rows of a cone: as many elements as asked for, few more.
#[test]
fn many_rows_of_a_smooth_table_make_few_elements() {
    let rows: Vec<(f64, f64)> =
        (0..=2000).map(|i| 0.005 * f64::from(i)).map(|x| (x, WHOLE * (1.0 - 0.05 * x).powi(2))).collect();
    let expected = deflection(&rows);
    let at = table("many", &rows, "x, mass, EA, EI", |ei| format!("1.2, {}, {ei}", 2000.0 * ei));
    let case = format!("{PLANE}kind = 'table'\nfile = 't.csv'\ninterpolation = 'linear'\n");
    let reading = read(&case, &at, &[]);
    let unknowns = reading.case.system().unwrap().size().v;
    assert!(unknowns < 4 * 3 * 10, "{unknowns}");
    let found = tip(&case, &at, "tip.deflection", &[]);
    assert!((found / expected - 1.0).abs() < 1e-5, "{found} for {expected}");
}
