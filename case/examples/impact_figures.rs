//! Computes figures 2 to 9 of P4 again, and draws them as `docs/src/impact_{methods,modes,shares}.png`.
//!
//! `cargo run --release -p flexion-case --example impact_figures [FIGURE]`, with `methods`, `modes` or `shares`; all without
//! (4 minutes of one processor, most of them for Adams' method with steps below its stability limit, 130 s with N = 7).

#![allow(missing_docs, dead_code, unused_imports, clippy::unwrap_used, clippy::panic, clippy::print_stdout)] // what it is for

#[path = "../../mechanics/tests/impact/falling_pendulum.rs"]
mod falling_pendulum;

use falling_pendulum::pendulum;
use flexion::analysis::Violation;
use flexion::analysis::transient::{Ending, Observer, Plan, Step, transient};
use flexion::contact::{ContactForce, Dissipation, Law};
use flexion::integrator::{Adams, GeneralizedAlpha, Integrator};
use flexion::system::{Direction, Dynamics, State, System};
use flexion_results::plot::{Axis, Figure, Panel, Series};
use flexion_results::write_file;
use std::path::Path;

/// End of a run and interval of its samples [s].
const END: f64 = 1.0;
const SAMPLE: f64 = 1e-3;

/// Histories of a run.
#[derive(Default)]
struct History {
    angle: Vec<(f64, f64)>,
    energy: Vec<(f64, f64)>,
    /// Shares B²/ΣB² of the first and of the last transverse mode.
    shares: [Vec<(f64, f64)>; 2],
    /// Largest |ġ| and |g̈| of the closed contact in each interval, of the states at the ends of steps.
    violations: [Vec<(f64, f64)>; 2],
    violation: Violation,
    largest: [f64; 2],
}

impl Observer for History {
    fn sample(&mut self, system: &mut dyn System, state: &State, _: &Step) {
        let hinge = (0..state.q.len()).find(|i| system.direction(*i) == Direction::Hub).unwrap();
        let mut squares = (0..state.q.len()).filter(|i| system.direction(*i) == Direction::Chord);
        let squares: Vec<f64> = squares.by_ref().map(|i| state.q[i].powi(2)).collect();
        let sum = squares.iter().sum::<f64>().max(f64::MIN_POSITIVE);
        self.angle.push((state.t, state.q[hinge]));
        self.energy.push((state.t, system.energy(state).total()));
        for (share, square) in self.shares.iter_mut().zip([squares[0], squares[squares.len() - 1]]) {
            share.push((state.t, square / sum));
        }
        for (violation, largest) in self.violations.iter_mut().zip(&mut self.largest) {
            violation.push((state.t, std::mem::take(largest)));
        }
    }

    fn passing(&mut self, system: &mut dyn System, state: &State) {
        if self.violation.position.len() != state.lambda.len() {
            self.violation = Violation::new(system);
        }
        self.violation.evaluate(system, state);
        for (largest, now) in self.largest.iter_mut().zip(&self.violation.largest[1..]) {
            *largest = largest.max(*now);
        }
    }
}

/// A run: number of modes, law and method with its steps in flight and near the contact.
type Run = (usize, Law, Box<dyn Integrator + Send>, (f64, f64));

fn run((modes, law, mut method, steps): Run) -> History {
    let mut system = pendulum(modes, law);
    let mut state = Dynamics::initial(&system);
    let plan = Plan {
        end: END,
        step: Some(steps.0),
        contact_step: Some(steps.1),
        longest_step: None,
        break_steps: 1,
        sample: SAMPLE,
    };
    let mut history = History::default();
    let ending = transient(&mut system, method.as_mut(), &mut state, &plan, &mut history);
    let peak = |k: usize| history.violations[k].iter().fold(0.0_f64, |m, (_, x)| m.max(*x));
    println!(
        "N = {modes}, {law:?}, {}, {steps:?}: {} s, energy {:.3} J at the end, |ġ| {:.1e} m/s, |g̈| {:.1e} m/s²{}",
        method.info().name,
        state.t,
        history.energy.last().unwrap().1,
        peak(0),
        peak(1),
        if let Ending::Failed(error) = ending { format!(", {error}") } else { String::new() }
    );
    history
}

/// All runs, two at a time.
fn runs(all: Vec<Run>) -> Vec<History> {
    let waiting = std::sync::Mutex::new(all.into_iter().enumerate().collect::<Vec<_>>());
    let done = std::sync::Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                loop {
                    let next = waiting.lock().unwrap().pop();
                    let Some((number, next)) = next else { return };
                    let history = run(next);
                    done.lock().unwrap().push((number, history));
                }
            });
        }
    });
    let mut done = done.into_inner().unwrap();
    done.sort_by_key(|(number, _)| *number);
    done.into_iter().map(|(_, history)| history).collect()
}

fn stop(restitution: f64) -> Law {
    Law::Constraint { restitution, friction: 0.0 }
}

/// P4's steps.
const STEPS: (f64, f64) = (1e-4, 1e-6);

fn hht(modes: usize, restitution: f64, alpha: f64) -> Run {
    (modes, stop(restitution), Box::new(GeneralizedAlpha::hht(alpha).unwrap().stabilized()), STEPS)
}

/// Adams' method with Baumgarte's (δ, ε), in steps below its stability limit.
fn adams(modes: usize, restitution: f64, delta: f64, epsilon: f64) -> Run {
    let step = if modes == 3 { 2e-6 } else { 8e-7 };
    (modes, stop(restitution), Box::new(Adams::new().with_baumgarte(delta, epsilon)), (step, step))
}

/// The continuous contact force, by Newmark's method.
fn force(restitution: f64) -> Run {
    let law = ContactForce {
        stiffness: 1e8,
        exponent: 1.5,
        factor: Dissipation::LankaraniNikravesh.factor(restitution),
        friction: 0.0,
        slip_speed: 1.0,
    };
    let newmark = GeneralizedAlpha::newmark(0.25, 0.5).unwrap();
    (MODES, Law::Force(law), Box::new(newmark), (1e-5, 1e-6))
}

fn panel(heading: &str, y: Axis, curves: Vec<(&str, Vec<(f64, f64)>)>) -> Panel {
    let series = curves.into_iter().enumerate();
    let series = series.map(|(k, (name, points))| Series::line(Some(name), points).numbered(k)).collect();
    let words =
        flexion_results::plot::Words { text: heading.to_owned(), outside: true, ..Default::default() };
    Panel { x: Axis::time(), y, series, words: vec![words], ..Panel::default() }
}

fn draw(name: &str, panels: Vec<Panel>) {
    let figure = Figure { title: None, panels, columns: 2, share_x: false };
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../docs/src/impact_{name}.png"));
    write_file(&path, &figure.draw().png().unwrap()).unwrap();
}

fn angle() -> Axis {
    Axis::new("Angle θ", "rad")
}

fn energy() -> Axis {
    Axis::new("Energy E", "J")
}

/// Modes of figures 2 and 3: P4 has 5, with which Adams' method takes four times as long, and α and (δ, ε) do as little.
const MODES: usize = 3;

/// Figures 2 and 3: angle and energy, e = 0 and 0.3, HHT with three α, Baumgarte's form with two pairs, and the
/// continuous force.
fn methods() {
    let mut all = Vec::new();
    for e in [0.0, 0.3] {
        all.extend([0.0, 0.15, 1.0 / 3.0].map(|alpha| hht(MODES, e, alpha)));
        all.extend([adams(MODES, e, 0.0, 0.0), adams(MODES, e, 1000.0, 5000.0), force(e)]);
    }
    let found = runs(all);
    let names = ["α = 0", "α = −0.15", "α = −1/3", "(0, 0)", "(1000, 5000)", "force"];
    let mut panels = Vec::new();
    type Pick = fn(&History) -> &Vec<(f64, f64)>;
    let angles: Pick = |history| &history.angle;
    let energies: Pick = |history| &history.energy;
    for (pick, axis, kinds) in [
        (
            angles,
            angle(),
            &[("HHT", &[0, 1, 2][..]), ("Baumgarte", &[3, 4]), ("three methods", &[1, 4, 5])][..],
        ),
        (energies, energy(), &[("HHT", &[0, 1, 2][..]), ("Baumgarte", &[3, 4])]),
    ] {
        for (kind, members) in kinds {
            for (row, e) in ["e = 0", "e = 0.3"].iter().enumerate() {
                let curve = |k: &usize| (names[*k], pick(&found[6 * row + k]).clone());
                let curves = members.iter().map(curve).collect();
                panels.push(panel(&format!("{kind}, {e}"), axis.clone(), curves));
            }
        }
    }
    draw("methods", panels);
}

/// Figures 4, 5 and 9: e = 0, HHT with α = 0 and −0.15 for several N; violations of ġ and g̈.
fn modes() {
    let mut all: Vec<Run> = Vec::new();
    for n in [3, 5, 7, 9] {
        all.extend([hht(n, 0.0, 0.0), hht(n, 0.0, 0.15)]);
    }
    let found = runs(all);
    let names = ["N = 3", "N = 5", "N = 7", "N = 9"];
    let families = [("HHT, α = 0", [0, 2, 4, 6]), ("HHT, α = −0.15", [1, 3, 5, 7])];
    let mut panels = Vec::new();
    for (family, members) in &families {
        for (axis, energies) in [(angle(), false), (energy(), true)] {
            let curve = |(k, i): (usize, &usize)| {
                let history = &found[*i];
                (names[k], if energies { history.energy.clone() } else { history.angle.clone() })
            };
            let mut panel = panel(family, axis, members.iter().enumerate().map(curve).collect());
            // A run that gains energy would hide the others.
            panel.y.range = Some(if energies { (0.0, 5.0) } else { (-0.2, 0.9) });
            panels.push(panel);
        }
    }
    for (k, y) in [Axis::logarithmic("Violation |ġ|", "m/s"), Axis::logarithmic("Violation |g̈|", "m/s²")]
        .into_iter()
        .enumerate()
    {
        let curve = |(number, i): (usize, &usize)| (names[number], found[*i].violations[k].clone());
        let mut panel = panel("HHT, α = −0.15", y, families[1].1.iter().enumerate().map(curve).collect());
        panel.x = Axis { range: Some((0.35, 0.42)), ..Axis::time() };
        for series in &mut panel.series {
            series.points.retain(|(t, _)| (0.35..=0.42).contains(t));
        }
        panels.push(panel);
    }
    draw("modes", panels);
}

/// Figures 6 to 8: shares of the first and of the seventh transverse mode, N = 7.
fn shares() {
    let found = runs(vec![hht(7, 0.0, 0.0), hht(7, 0.0, 0.15), adams(7, 0.0, 1000.0, 5000.0)]);
    let names = ["HHT, α = 0", "HHT, α = −0.15", "Baumgarte, (1000, 5000)"];
    let mut panels = Vec::new();
    for (name, history) in names.iter().zip(&found) {
        for (k, y) in [Axis::logarithmic("Share W₇", ""), Axis::new("Share W₁", "")].into_iter().enumerate()
        {
            let series = vec![Series::line(None, history.shares[1 - k].clone())];
            let mut panel = Panel { series, ..panel(name, y, Vec::new()) };
            panel.y.range = Some(if k == 0 { (1e-12, 1.0) } else { (0.0, 1.05) });
            panels.push(panel);
        }
    }
    draw("shares", panels);
}

fn main() {
    let wanted = std::env::args().nth(1);
    for (name, figure) in [("methods", methods as fn()), ("modes", modes), ("shares", shares)] {
        if wanted.as_deref().is_none_or(|wanted| wanted == name) {
            figure();
        }
    }
}
