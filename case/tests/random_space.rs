//! Systems in space at random: trees of bodies and beams on joints of every kind, with springs and loads. A run agrees with a
//! finer one within the error that it reports, keeps its balance of energy, or ends with an error.
//! `FLEXION_RANDOM_SPACE=200` runs that many, `FLEXION_RANDOM_FIRST` begins with a later one.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use fastrand::Rng;
use flexion_case::{Effort, Reading, Run, parse};
use flexion_results::{Status, Trajectory};
use std::fmt::Write as _;
use std::ops::ControlFlow;
use std::path::Path;

/// Cases of a usual run of the tests.
const CASES: u64 = 12;
/// Steps of a run that is given up.
const MOST_STEPS: usize = 30_000;
/// Size below which nobody asks, in metres or radians.
const NEGLIGIBLE: f64 = 1e-7;

fn between(random: &mut Rng, from: f64, to: f64) -> f64 {
    from + (to - from) * random.f64()
}

fn vector(random: &mut Rng, size: f64) -> String {
    let [x, y, z] = [0; 3].map(|_| between(random, -size, size));
    format!("[{x}, {y}, {z}]")
}

/// A tree of parts, each joined to one before it.
fn draw(seed: u64) -> String {
    let random = &mut Rng::with_seed(seed);
    let mut text = String::from("gravity = [0, 1, -9.81]\n");
    let duration = between(random, 0.1, 0.5);
    let method = match random.u8(..3) {
        0 => format!("integrator = {{ kind = \"generalized-alpha\", step = {} }}", duration / 400.0),
        _ => format!(
            "integrator = {{ kind = \"radau\", tolerance = {:e} }}",
            10_f64.powf(between(random, -7.0, -4.0))
        ),
    };
    let _ = writeln!(
        text,
        "{method}\nrun = {{ duration = {duration} }}\noutput = {{ step = {} }}",
        duration / 50.0
    );
    let mut ends = vec![("ground".to_owned(), [0.0; 3])];
    let mut tables = String::new();
    for k in 0..random.usize(1..4) {
        let (from, at) = ends[random.usize(..ends.len())].clone();
        let way: [f64; 3] = [0; 3].map(|_| between(random, -1.0, 1.0));
        let length = way.iter().map(|x| x * x).sum::<f64>().sqrt().max(0.3);
        let far = [0, 1, 2].map(|i| at[i] + way[i]);
        let flexible = random.u8(..3) == 0;
        let to = if flexible { format!("beam{k}.root") } else { format!("body{k}") };
        if flexible {
            let _ = writeln!(
                tables,
                "[[beam]]\nname = \"beam{k}\"\nlength = {length}\nstart = {at:?}\ndirection = {way:?}\nup = {}\nelements = {}\n\
                 section = {{ kind = \"rectangle\", modulus = 7e10, density = 2700, width = {}, height = {} }}",
                vector(random, 1.0),
                random.usize(2..5),
                between(random, 0.01, 0.03),
                between(random, 0.004, 0.02),
            );
            ends.push((format!("beam{k}.tip"), [0, 1, 2].map(|i| at[i] + way[i] / length_of(way) * length)));
        } else {
            let centre = [0, 1, 2].map(|i| at[i] + 0.5 * way[i]);
            let inertia = match random.u8(..3) {
                0 => format!("{{ kind = \"box\", size = [{length}, 0.1, 0.2] }}"),
                1 => format!("{{ kind = \"cylinder\", radius = 0.1, length = {length} }}"),
                _ => "{ kind = \"sphere\", radius = 0.2 }".to_owned(),
            };
            let _ = writeln!(
                tables,
                "[[body]]\nname = \"body{k}\"\nmass = {}\nposition = {centre:?}\naxis = {way:?}\ninertia = {inertia}\ndamping = {}",
                between(random, 0.2, 3.0),
                [0.0, 0.5][random.usize(..2)],
            );
            ends.push((format!("body{k}"), far));
        }
        let kinds = ["revolute", "spherical", "universal", "cylindrical", "fixed", "prismatic", "planar"];
        let kind = kinds[random.usize(..if flexible { 5 } else { kinds.len() })];
        let drive = match (kind, random.u8(..3)) {
            ("revolute", 0) => {
                "motion = { kind = \"expression\", of = \"angle\", formula = \"0.5*(1-cos(3*t))\" }\n"
            }
            ("revolute", 1) => "motion = { kind = \"free\", stiffness = 5, damping = 0.1 }\n",
            ("prismatic", 0) => "travel = { kind = \"free\", stiffness = 100 }\n",
            _ => "",
        };
        let _ = writeln!(
            tables,
            "[[joint]]\nkind = \"{kind}\"\nbetween = [\"{from}\", \"{to}\"]\nat = {at:?}\naxis = {}\nacross = {}\n{drive}",
            vector(random, 1.0),
            vector(random, 1.0),
        );
    }
    let (last, at) = ends[ends.len() - 1].clone();
    if random.bool() {
        let axes = ["dead", "follower"][random.usize(..2)];
        let force = vector(random, 3.0);
        let _ = writeln!(tables, "[[load]]\non = \"{last}\"\nforce = {force}\naxes = \"{axes}\"");
    }
    if random.bool() {
        let far = [at[0] + 0.5, at[1] - 0.4, at[2] + 0.7];
        let _ = writeln!(
            tables,
            "[[spring]]\nbetween = [\"ground\", \"{last}\"]\nfrom = {far:?}\nstiffness = 20\ndamping = 1"
        );
    }
    text + &tables
}

fn length_of(x: [f64; 3]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn run(reading: &Reading) -> Run {
    let mut steps = 0;
    reading.prepare().unwrap_or_else(|problems| panic!("{problems}")).run(&mut |_| {
        steps += 1;
        if steps > MOST_STEPS { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })
}

/// Largest difference of a column over the common rows.
fn apart(a: &Trajectory, b: &Trajectory, column: &str) -> f64 {
    let (a, b) = (a.column(column).unwrap(), b.column(column).unwrap());
    let differences = a.iter().zip(&b).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, |largest, d| if d <= largest { largest } else { d })
}

/// What is wrong with a case; `None` for one that is right, or that ends with an error.
fn judge(text: &str) -> (&'static str, Option<String>) {
    let reading = match parse(text.to_owned(), Path::new("case.toml"), &[]) {
        Ok(reading) => reading,
        Err(problems) => return ("refused", Some(problems.to_string())),
    };
    let found = run(&reading);
    match found.status {
        Status::Finished => {}
        Status::Stopped => return ("out of time", None),
        Status::Failed => return ("failed", found.message.is_none().then(|| "without a message".to_owned())),
    }
    let mut steps = 0;
    let errors = reading.estimate_errors(&found, Effort::Full, &mut |_| {
        steps += 1;
        if steps > 4 * MOST_STEPS { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    let errors = errors.unwrap_or_else(|problems| panic!("{problems}"));
    if !errors.warnings.is_empty() {
        return ("not estimated", None);
    }
    let finest = ["model.refine=4", "integrator={kind='radau', tolerance=1e-9, absolute-tolerance=1e-10}"];
    let finest = parse(text.to_owned(), Path::new("case.toml"), &finest.map(str::to_owned)).unwrap();
    let reference = run(&finest);
    if reference.status != Status::Finished {
        return ("no reference", None);
    }
    for error in &errors.columns {
        let place = error.column.contains(".position.") || error.column.ends_with(".angle");
        if place {
            let off = apart(&found.trajectory, &reference.trajectory, &error.column);
            // Written so that NaN is an error.
            if !(off <= error.discretization + NEGLIGIBLE) {
                let message =
                    format!("{} is off by {off:e}, reported {:e}", error.column, error.discretization);
                return ("wrong", Some(message));
            }
        }
    }
    ("right", None)
}

#[test]
fn a_system_in_space_is_right_within_its_reported_error_or_ends_with_an_error() {
    let number = |name: &str| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let first = number("FLEXION_RANDOM_FIRST").unwrap_or(0);
    let count = number("FLEXION_RANDOM_SPACE").unwrap_or(CASES);
    let mut wrong = Vec::new();
    let mut right = 0;
    for k in first..first + count {
        let text = draw(7_000_003 + k);
        let (verdict, message) = judge(&text);
        eprintln!("case {k}: {verdict} {}", message.as_deref().unwrap_or_default());
        right += u64::from(verdict == "right");
        if let Some(message) = message {
            wrong.push(format!("case {k}: {verdict}: {message}\n{text}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(2 * right > count, "only {right} of {count} cases are known to be right");
}
