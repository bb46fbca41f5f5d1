//! Prints what of an impact of the falling pendulum converges with the basis and what does not, for each law of contact, and
//! draws it: the tables of `docs/src/impact_study.md` and `docs/src/impact_convergence.png`.
//!
//! `cargo run --release -p flexion-case --example impact_convergence`
//!
//! The impulse J of the contact is that of its force, ∫F dt, whatever its law. The ground is level and frictionless, so that the
//! moment of momentum H about the hinge changes by dH = x dJ + τ dt, with x the abscissa of the tip and τ the moment of
//! gravity: J = Σ (ΔH − τ Δt)/x over the intervals between samples.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // what it is for

use flexion::analysis::transient::{Ending, Event, Observer, Plan, Step, transient};
use flexion::system::{Direction, Frame, State, System};
use flexion_case::{Reading, read};
use flexion_results::plot::{Axis, Figure, Line, Marker, Panel, Series};
use flexion_results::write_file;
use std::f64::consts::FRAC_PI_2;
use std::ops::ControlFlow;
use std::path::Path;

/// The first burst of impacts is over, and the second has not begun [s].
const BETWEEN: f64 = 0.6;

/// What a run shows.
#[derive(Default)]
struct Watch {
    /// Time, H, x and τ of the last sample.
    last: Option<[f64; 4]>,
    /// Impulse until now and of the first burst [N·s].
    impulse: f64,
    burst: f64,
    /// Energy between the bursts [J].
    energy: f64,
    /// Time of the second touch [s].
    second: Option<f64>,
}

impl Observer for Watch {
    fn sample(&mut self, system: &mut dyn System, state: &State, _: &Step) {
        let mut row = vec![0.0; system.channels().len()];
        system.record(state, &mut row);
        let column = system.channels().iter().position(|c| c.name == "hub.angular_momentum").unwrap();
        let hinge = (0..state.q.len()).find(|i| system.direction(*i) == Direction::Hub).unwrap();
        // V = A cos θ + B sin θ, so that −∂V/∂θ is a difference of values a quarter of a turn away.
        let [ahead, behind] = [FRAC_PI_2, -FRAC_PI_2].map(|turn| {
            let mut turned = state.clone();
            turned.q[hinge] += turn;
            system.energy(&turned).gravity
        });
        let mut tip = [Frame::default()];
        system.frames(0, state, &[1.0], &mut tip);
        let now = [state.t, row[column], tip[0].position[0], 0.5 * (behind - ahead)];
        if let Some(last) = self.last.replace(now) {
            let mean = |i: usize| 0.5 * (last[i] + now[i]);
            self.impulse += (now[1] - last[1] - mean(3) * (now[0] - last[0])) / mean(2);
        }
        if state.t < BETWEEN {
            (self.burst, self.energy) = (self.impulse, system.energy(state).total());
        }
    }

    fn step(&mut self, _: &State) -> ControlFlow<()> {
        if self.second.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn event(&mut self, event: &Event) {
        if event.time > BETWEEN && self.second.is_none() {
            self.second = Some(event.time);
        }
    }
}

/// The falling pendulum with a law of contact and a basis: what its run shows, its number of unknowns, and why it ended early.
fn run(law: &str, basis: &str, sample: f64) -> (Watch, usize, String) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../verification/falling_pendulum");
    let set = [
        format!("contact=[{{obstacle={{kind='plane',point=[0,0]}},law={{{law}}}}}]"),
        format!("basis={{{basis}}}"),
        "integrator={kind='radau',tolerance=1e-8,absolute-tolerance=1e-10}".to_owned(),
    ];
    let reading: Reading = read(&path, &set).unwrap();
    let mut live = reading.build().unwrap();
    let (mut state, mut watch) = (live.system.initial(), Watch::default());
    let plan = Plan { end: 1.0, step: None, longest_step: None, break_steps: 1, contact_step: None, sample };
    let ending = transient(live.system.as_mut(), live.integrator.as_mut(), &mut state, &plan, &mut watch);
    let why = if let Ending::Failed(error) = ending { error.to_string() } else { String::new() };
    (watch, live.system.size().v, why)
}

fn modes(n: usize) -> String {
    format!("kind='modes',axial={n},transverse={n}")
}

fn elements(n: usize) -> String {
    format!("kind='finite-elements',elements={n}")
}

/// A family of bases: name, numbers, and what a number means.
type Family = (&'static str, &'static [usize], fn(usize) -> String);

const LAWS: [(&str, &str); 4] = [
    ("constraint, e = 0", "kind='constraint',restitution=0"),
    ("constraint, e = ½", "kind='constraint',restitution=0.5"),
    ("massless", "kind='massless'"),
    ("Hunt–Crossley, K = 10⁶, e = ½", "kind='hunt-crossley',stiffness=1e6,restitution=0.5"),
];

const FAMILIES: [Family; 2] = [("modes", &[2, 3, 5, 7], modes), ("elements", &[1, 2, 4], elements)];

/// Number of unknowns and impulse, energy and second touch of every basis of a family; prints them.
fn curve((law, keys): (&str, &str), (family, numbers, basis): Family) -> Vec<(usize, [f64; 3])> {
    let point = |n: &usize| {
        let (watch, unknowns, why) = run(keys, &basis(*n), 1e-4);
        let values = [watch.burst, watch.energy, watch.second.unwrap_or(f64::NAN)];
        let [impulse, energy, second] = values;
        println!("| {law} | {n} {family} | {unknowns} | {impulse:.4} | {energy:.4} | {second:.4} | {why}");
        (unknowns, values)
    };
    numbers.iter().map(point).collect()
}

fn convergence() {
    let axes = ["Impulse of the burst [N·s]", "Energy behind it [J]", "Second touch [s]"];
    let panel = |name: &str| {
        let (quantity, unit) = name.trim_end_matches(']').split_once(" [").unwrap();
        let x = Axis::new("Number of unknowns", "");
        Panel { x, y: Axis::new(quantity, unit), ..Panel::default() }
    };
    let mut panels = axes.map(panel);
    println!(
        "| law | basis | unknowns | impulse of the first burst [N·s] | energy behind it [J] | second touch [s] |"
    );
    println!("|---|---|---|---|---|---|");
    // One thread a law and family.
    let families = LAWS.into_iter().enumerate().flat_map(|law| FAMILIES.map(|family| (law, family)));
    let curves: Vec<_> = std::thread::scope(|scope| {
        let threads: Vec<_> = families
            .map(|((color, law), family)| (color, law.0, family.0, scope.spawn(move || curve(law, family))))
            .collect();
        threads
            .into_iter()
            .map(|(color, law, family, thread)| (color, law, family, thread.join().unwrap()))
            .collect()
    });
    for (color, law, family, points) in curves {
        let (line, marker) = match family {
            "modes" => (Line::Solid, Marker::Circle),
            _ => (Line::Dashed, Marker::Square),
        };
        for (k, panel) in panels.iter_mut().enumerate() {
            let name = (k == 2 && line == Line::Solid).then(|| law.to_owned());
            let points = points.iter().map(|(unknowns, values)| (*unknowns as f64, values[k])).collect();
            panel.series.push(Series {
                name,
                points,
                line,
                marker: Some(marker),
                color: Some(color),
                ..Series::default()
            });
        }
    }
    let title = "Solid: modes. Dashed: finite elements".to_owned();
    let figure = Figure { title: Some(title), panels: panels.into(), columns: 3, share_x: false };
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/src/impact_convergence.png");
    write_file(&path, &figure.draw().png().unwrap()).unwrap();
}

fn stiffness() {
    let (constraint, _, why) = run("kind='constraint',restitution=1", &modes(3), 1e-5);
    println!(
        "\n| K [N/m^1.5] | impulse of the first burst [N·s] | over that of the constraint, less 1 |\n|---|---|---|"
    );
    println!("| constraint | {:.6} | {why}", constraint.burst);
    for k in ["1e7", "1e8", "1e9", "1e10", "1e11", "1e12"] {
        let (watch, _, why) = run(&format!("kind='hertz',stiffness={k}"), &modes(3), 1e-5);
        println!("| {k} | {:.6} | {:.1e} | {why}", watch.burst, watch.burst / constraint.burst - 1.0);
    }
}

fn main() {
    let wanted = std::env::args().nth(1);
    for (name, table) in [("convergence", convergence as fn()), ("stiffness", stiffness)] {
        if wanted.as_deref().is_none_or(|wanted| wanted == name) {
            table();
        }
    }
}
