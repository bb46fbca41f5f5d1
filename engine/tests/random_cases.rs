//! Cases at random: what a run reports as its error holds against a finer run of the exact coupling, or the run ends
//! with an error. `FLEXION_RANDOM_CASES=500` runs that many instead of a few; `FLEXION_RANDOM_FIRST`
//! begins with a later one, and `FLEXION_RANDOM_SEED` draws others.

#![allow(clippy::unwrap_used, clippy::panic, missing_docs)] // in helpers of tests

use fastrand::Rng;
use flexion::case::{Problems, Reading, Run, parse};
use flexion::output::{Status, Trajectory};
use std::fmt::Write;
use std::ops::{ControlFlow, Range};
use std::path::Path;

/// Cases of a usual run of the tests.
const CASES: usize = 12;

/// What is compared, with the size below which nobody asks, in lengths of the beam or in radians.
const COLUMNS: &[(&str, f64)] =
    &[("tip.deflection", 1e-9), ("tip.axial", 1e-9), ("tip.rotation", 1e-8), ("hub.angle", 1e-9)];

fn between(random: &mut Rng, range: Range<f64>) -> f64 {
    range.start + (range.end - range.start) * random.f64()
}

/// A number between two others, whose logarithm is evenly distributed.
fn scale(random: &mut Rng, range: Range<f64>) -> f64 {
    between(random, range.start.ln()..range.end.ln()).exp()
}

fn pick<'a>(random: &mut Rng, among: &[&'a str]) -> &'a str {
    among[random.usize(..among.len())]
}

/// Loads that would bend the beam statically by up to a third of its length, and damping; of a uniform beam, `mass` is
/// per length and `bending` the stiffness.
fn loads(random: &mut Rng, text: &mut String, length: f64, mass: f64, bending: f64, duration: f64) {
    // The force at the tip that bends it by its length.
    let force = 3.0 * bending / (length * length);
    let size = |random: &mut Rng, reference: f64| reference * scale(random, 1e-3..0.3);
    if random.u8(..3) == 0 {
        let acceleration = size(random, force / (mass * length)).min(9.81);
        let _ = writeln!(text, "[gravity]\nacceleration = {acceleration}");
    }
    let frame = pick(random, &["dead", "hub", "follower"]);
    let amplitude = match random.u8(..3) {
        0 => "{ kind = \"constant\" }".to_owned(),
        1 => format!(
            "{{ kind = \"expression\", formula = \"sin({}*t)\" }}",
            between(random, 1.0..12.0) / duration
        ),
        _ => format!("{{ kind = \"expression\", formula = \"1 - exp(-{}*t)\" }}", 3.0 / duration),
    };
    if random.u8(..3) == 0 {
        let (along, across) = (size(random, force), size(random, force));
        let _ = writeln!(
            text,
            "[[force]]\nstation = {}\nforce = [{}, {across}]\nframe = \"{frame}\"\namplitude = {amplitude}",
            length * between(random, 0.3..1.0),
            0.3 * along,
        );
    }
    if random.u8(..4) == 0 {
        let couple = size(random, force * length);
        let _ = writeln!(text, "[[couple]]\nstation = {length}\ncouple = {couple}\namplitude = {amplitude}");
    }
    if random.u8(..4) == 0 {
        let across = size(random, force / length);
        let _ = writeln!(
            text,
            "[[distributed-load]]\nforce = [0, {across}]\nframe = \"{frame}\"\namplitude = {amplitude}"
        );
    }
    if random.u8(..4) == 0 {
        let _ = writeln!(text, "[damping]\nmass-proportional = {}", scale(random, 0.01..3.0) / duration);
    }
}

/// A valid case, and the length of its beam.
fn case(random: &mut Rng) -> (String, f64) {
    let length = scale(random, 0.3..20.0);
    let height = length / scale(random, 20.0..300.0);
    let width = height * scale(random, 0.5..5.0);
    let (modulus, density) =
        [(70e9, 2700.0), (210e9, 7850.0), (3e9, 1100.0), (40e9, 1900.0)][random.usize(..4)];
    let mut text = format!("[beam]\nlength = {length}\n");
    let (bending, mass) = (modulus * width * height.powi(3) / 12.0, density * width * height);
    let section = pick(random, &["rectangle", "rectangle", "graded", "tapered"]);
    let plate = format!("width = {width}\nheight = {height}");
    let _ = match section {
        "graded" => writeln!(
            text,
            "[section]\nkind = \"graded\"\nceramic-modulus = {}\nmetal-modulus = {modulus}\nceramic-density = {}\n\
             metal-density = {density}\n{plate}\nexponent = {}",
            modulus * between(random, 1.0..2.5),
            density * between(random, 0.6..1.4),
            between(random, 0.0..6.0),
        ),
        "tapered" => writeln!(
            text,
            "[section]\nkind = \"tapered-rectangle\"\nmodulus = {modulus}\ndensity = {density}\nroot-width = {width}\n\
             root-height = {height}\ntip-width = {}\ntip-height = {}",
            width * between(random, 0.4..1.0),
            height * between(random, 0.4..1.0),
        ),
        _ => writeln!(
            text,
            "[section]\nkind = \"rectangle\"\nmodulus = {modulus}\ndensity = {density}\n{plate}\nrotary-inertia = {}",
            random.bool()
        ),
    };
    // First natural frequency of the uniform beam, and the period.
    let frequency = 3.516 * (bending / (mass * length.powi(4))).sqrt();
    let period = std::f64::consts::TAU / frequency;
    let duration = period * between(random, 0.5..3.0);
    loads(random, &mut text, length, mass, bending, duration);
    let _ = writeln!(text, "[hub]\nradius = {}", length * between(random, 0.0..0.5));
    let inertia = mass * length.powi(3) / 3.0;
    let _ = match random.u8(..4) {
        0 => writeln!(
            text,
            "inertia = {}\nmotion = {{ kind = \"free\", damping = {}, torque = {{ kind = \"ramp\", torque = {}, time = {} }} }}",
            inertia * scale(random, 0.3..10.0),
            inertia * frequency * between(random, 0.0..0.2),
            inertia * frequency * frequency * between(random, -0.15..0.15),
            duration * between(random, 0.2..1.0),
        ),
        1 => writeln!(
            text,
            "motion = {{ kind = \"constant\", speed = {} }}",
            frequency * between(random, 0.0..0.6)
        ),
        _ => writeln!(
            text,
            "motion = {{ kind = \"spin-up\", speed = {}, time = {} }}",
            frequency * scale(random, 0.1..3.0),
            duration * between(random, 0.5..1.2),
        ),
    };
    let coupling = pick(random, &["zeroth", "first", "first", "high", "high", "exact", "exact"]);
    let _ = writeln!(text, "[model]\ncoupling = \"{coupling}\"");
    let elements = random.usize(3..12);
    let basis = match if coupling == "exact" { 0 } else { random.u8(..7) } {
        0..=2 => {
            format!("kind = \"finite-elements\"\nelements = {elements}\naxial-degree = {}", random.u8(1..3))
        }
        3 => format!("kind = \"modes\"\naxial = {}\ntransverse = {}", random.u8(1..5), random.u8(2..7)),
        4 => format!("kind = \"radial\"\nnodes = {}", elements + 4),
        5 => format!("kind = \"b-spline\"\nelements = {elements}\ndegree = {}", random.u8(2..6)),
        _ => format!("kind = \"polynomial\"\nnodes = {}", elements + 2),
    };
    let _ = writeln!(text, "[basis]\n{basis}");
    let step = period / scale(random, 15.0..600.0);
    let integrator = match random.u8(..8) {
        0 => format!("kind = \"newmark\"\nstep = {step}"),
        1 => format!("kind = \"hht\"\nalpha = {}\nstep = {step}", between(random, 0.0..0.33)),
        2 => format!("kind = \"generalized-alpha\"\nspectral-radius = {}\nstep = {step}", random.f64()),
        3 => format!("kind = \"runge-kutta-4\"\nstep = {}", 0.005 * step),
        _ => format!("kind = \"radau\"\ntolerance = {:e}", scale(random, 1e-8..1e-3)),
    };
    let _ = writeln!(text, "[integrator]\n{integrator}");
    let _ = writeln!(text, "[run]\nduration = {duration}\n[output]\nstep = {}", duration / 100.0);
    (text, length)
}

fn run(reading: &Reading) -> Result<Run, Problems> {
    Ok(reading.prepare()?.run(&mut |_| ControlFlow::Continue(())))
}

fn read(text: &str, overrides: &[&str]) -> Result<Reading, Problems> {
    let overrides: Vec<String> = overrides.iter().map(|text| (*text).to_owned()).collect();
    parse(text.to_owned(), Path::new("case.toml"), &overrides)
}

/// Largest difference of a column over the common rows.
fn apart(a: &Trajectory, b: &Trajectory, column: &str) -> f64 {
    let (a, b) = (a.column(column).unwrap(), b.column(column).unwrap());
    a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[derive(Debug, Default)]
struct Tally {
    right: usize,
    refused: usize,
    failed: usize,
    without_reference: usize,
    without_estimate: usize,
}

impl Tally {
    /// A case that is refused: only for what no key alone can tell.
    fn refuse(&mut self, problems: &Problems, text: &str) -> Result<(), String> {
        self.refused += 1;
        let known = |message: &str| message.contains("stability limit") || message.contains("singular");
        match problems.list.iter().find(|problem| !known(&problem.message)) {
            Some(problem) => Err(format!("refused: {}: {}\n{text}", problem.key, problem.message)),
            None => Ok(()),
        }
    }
}

/// Runs one case; `Err` says what it got wrong silently.
fn judge(text: &str, length: f64, tally: &mut Tally) -> Result<(), String> {
    let reading = match read(text, &[]) {
        Ok(reading) => reading,
        Err(problems) => return tally.refuse(&problems, text),
    };
    let run_of_case = match run(&reading) {
        Ok(run) => run,
        Err(problems) => return tally.refuse(&problems, text),
    };
    if run_of_case.status != Status::Finished {
        tally.failed += 1;
        return Ok(());
    }
    let errors = reading.estimate_errors(&run_of_case, &mut |_| ControlFlow::Continue(())).unwrap();
    let finest = [
        "model.coupling=exact",
        "basis={kind='finite-elements',elements=32}",
        "integrator={kind='radau',tolerance=1e-9,absolute-tolerance=1e-11}",
    ];
    let reference = read(text, &finest).ok().and_then(|reading| run(&reading).ok());
    let Some(reference) = reference.filter(|run| run.status == Status::Finished) else {
        tally.without_reference += 1;
        return Ok(());
    };
    for (column, negligible) in COLUMNS {
        let Some(error) = errors.columns.iter().find(|error| error.column == *column) else { continue };
        let exact = reading.case.coupling == flexion::case::Coupling::Exact;
        let Some(model) = error.model.or(exact.then_some(0.0)) else {
            // Not known, and said so.
            assert!(!errors.warnings.is_empty(), "no model error of {column} and no word about it:\n{text}");
            tally.without_estimate += 1;
            return Ok(());
        };
        let reported =
            error.discretization + model + negligible * if column.ends_with('n') { 1.0 } else { length };
        let found = apart(&run_of_case.trajectory, &reference.trajectory, column);
        // Written so that NaN is an error.
        if !(found <= reported) {
            return Err(format!("{column} is off by {found:e}, and the run reports {reported:e}:\n{text}"));
        }
    }
    tally.right += 1;
    Ok(())
}

#[test]
fn a_run_is_right_within_its_reported_error_or_ends_with_an_error() {
    let number = |name: &str| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let (count, seed) = (number("FLEXION_RANDOM_CASES"), number("FLEXION_RANDOM_SEED").unwrap_or(1));
    let count = count.map_or(CASES, |count| count as usize);
    let first = number("FLEXION_RANDOM_FIRST").unwrap_or(0) as usize;
    let (mut tally, mut wrong) = (Tally::default(), Vec::new());
    for k in first..first + count {
        let mut random = Rng::with_seed(seed.wrapping_mul(1_000_003).wrapping_add(k as u64));
        let (text, length) = case(&mut random);
        let begun = std::time::Instant::now();
        if let Err(message) = judge(&text, length, &mut tally) {
            eprintln!("case {k}: {message}");
            wrong.push(message);
        }
        if begun.elapsed().as_secs() >= 5 {
            eprintln!("case {k} took {:?}:\n{text}", begun.elapsed());
        }
    }
    eprintln!("{count} cases: {tally:?}, {} silently wrong", wrong.len());
    assert!(
        wrong.is_empty(),
        "{} of {count} cases are silently wrong; the first:\n{}",
        wrong.len(),
        wrong[0]
    );
    assert!(2 * tally.right > count, "too few cases say anything: {tally:?}");
}
