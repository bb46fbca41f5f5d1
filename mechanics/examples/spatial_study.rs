//! Prints the tables of `docs/src/spatial_study.md`: beams in space against the planar program, and two cases of a cantilever
//! and of a plate on a hub.
//!
//! `cargo run --release -p flexion --example spatial_study TABLE [ARGUMENTS]`, with `plane`, `couple`, `reference` or `plate`.

#![allow(missing_docs, clippy::unwrap_used, clippy::panic, clippy::print_stdout)] // what it is for

use flexion::analysis::transient::{Ending, Observer, Plan, Step, transient_to_checkpoint};
use flexion::hub_beam::{self, ExactCoupling, Hub, HubBeam};
use flexion::integrator::{GeneralizedAlpha, Integrator, Radau, Tolerance};
use flexion::linalg::Vec3;
use flexion::multibody::slender::{Beam, Properties, Station};
use flexion::multibody::{Axes, Body, Drive, Flexible, Joint, Kind, Load, Marker, Model, Multibody, Part};
use flexion::profile::{Expression, Motion, SpinUp};
use flexion::section::{Resultants, Shape, Uniform};
use flexion::system::{State, System};
use std::f64::consts::{FRAC_1_SQRT_2, PI};
use std::sync::Arc;
use std::time::Instant;

/// Values of channels at every sample.
struct Watch<'a> {
    channels: Vec<usize>,
    rows: Vec<Vec<f64>>,
    values: Vec<f64>,
    names: &'a [&'a str],
}

impl<'a> Watch<'a> {
    fn new(names: &'a [&'a str]) -> Watch<'a> {
        Watch { channels: Vec::new(), rows: Vec::new(), values: Vec::new(), names }
    }
}

impl Observer for Watch<'_> {
    fn sample(&mut self, system: &mut dyn System, state: &State, _: &Step) {
        if self.channels.is_empty() {
            let place = |name: &&str| {
                let found = system.channels().iter().position(|c| c.name == **name);
                found.unwrap_or_else(|| panic!("no channel {name}"))
            };
            self.channels = self.names.iter().map(place).collect();
            self.values = vec![0.0; system.channels().len()];
        }
        system.record(state, &mut self.values);
        let row = std::iter::once(state.t).chain(self.channels.iter().map(|i| self.values[*i]));
        self.rows.push(row.collect());
    }
}

/// What a run gave: rows of time and channels, and what it cost.
struct Run {
    rows: Vec<Vec<f64>>,
    seconds: f64,
    counters: flexion::integrator::Counters,
    ending: Ending,
}

fn run(
    system: &mut dyn System,
    method: &dyn Integrator,
    (end, step): (f64, Option<f64>),
    sample: f64,
    names: &[&str],
) -> Run {
    let mut state = system.initial();
    let mut watch = Watch::new(names);
    let plan = Plan { end, step, longest_step: None, break_steps: 1, contact_step: None, sample };
    let start = Instant::now();
    let (ending, checkpoint) = transient_to_checkpoint(system, method, &mut state, &plan, &mut watch);
    let (seconds, counters) = (start.elapsed().as_secs_f64(), checkpoint.counters().unwrap());
    Run { rows: watch.rows, seconds, counters, ending }
}

fn radau(tolerance: f64) -> Radau {
    Radau::new(Tolerance::uniform(tolerance)).unwrap()
}

/// `radau:1e-8`, `alpha:0.8` (with a step behind a further colon).
fn method(text: &str) -> (Box<dyn Integrator>, Option<f64>) {
    let parts: Vec<&str> = text.split(':').collect();
    let number = |i: usize| parts.get(i).and_then(|x| x.parse::<f64>().ok());
    match parts[0] {
        "radau" => (Box::new(radau(number(1).unwrap_or(1e-8))), number(2)),
        "stabilized" => {
            let method = GeneralizedAlpha::chung_hulbert(number(1).unwrap_or(0.8)).unwrap();
            (Box::new(method.stabilized()), number(2))
        }
        _ => (Box::new(GeneralizedAlpha::chung_hulbert(number(1).unwrap_or(0.8)).unwrap()), number(2)),
    }
}

/// Largest difference in column `k`, and the largest value there.
fn apart(a: &[Vec<f64>], b: &[Vec<f64>], k: usize) -> (f64, f64) {
    a.iter().zip(b).fold((0.0, 0.0), |(far, peak): (f64, f64), (a, b)| {
        assert!((a[0] - b[0]).abs() < 1e-9, "samples at other times");
        (far.max((a[k] - b[k]).abs()), peak.max(b[k].abs()))
    })
}

/// Wu & Haug's beam on a hub that is spun up to 4 rad/s in 15 s: in space, and by the planar exact coupling.
fn plane(elements: usize, tolerance: f64) {
    let resultants =
        Resultants { mass: 1.2, axial_stiffness: 2.8e7, bending_stiffness: 1.4e4, ..Default::default() };
    let motion = Motion::Speed { profile: Arc::new(SpinUp::new(4.0, 15.0).unwrap()), initial_angle: 0.0 };
    let hub = Hub { radius: 0.0, inertia: 0.0, drive: hub_beam::Drive::Prescribed(motion.clone()) };
    let section = Uniform::from_resultants(resultants).unwrap();
    let coupling = ExactCoupling::new(10.0, elements, &section, &hub).unwrap();
    let mut planar = HubBeam::new(hub, coupling, &[10.0]);
    let of_planar = run(&mut planar, &radau(1e-9), (20.0, None), 0.02, &["tip.deflection", "tip.axial"]);
    let mut spatial = spun(elements, motion.clone());
    let names = ["beam.tip.position.x", "beam.tip.position.y"];
    let mut of_space = run(&mut spatial, &radau(tolerance), (20.0, None), 0.02, &names);
    for row in &mut of_space.rows {
        let (sin, cos) = motion.at(row[0]).angle.sin_cos();
        let (x, y) = (row[1], row[2]);
        (row[1], row[2]) = (cos * y - sin * x, cos * x + sin * y - 10.0);
    }
    let [(w, peak), (u, longest)] = [1, 2].map(|k| apart(&of_space.rows, &of_planar.rows, k));
    println!("{elements} elements: {:?} {:?}", of_planar.ending, of_space.ending);
    println!("deflection: {w:.2e} m of {peak:.6} m, axial: {u:.2e} m of {longest:.6} m");
    println!("planar {:.2} s {:?}", of_planar.seconds, of_planar.counters);
    println!("space  {:.2} s {:?}", of_space.seconds, of_space.counters);
}

/// Wu & Haug's beam on a revolute joint with the ground that is driven.
fn spun(elements: usize, motion: Motion) -> Multibody {
    let section = Properties::principal([2.8e7, 1.1e4, 1.4e4, 1.4e4], 1.2, [1.2e-3, 0.0, 0.0]);
    let root =
        Station { position: Vec3([0.0; 3]), tangent: Vec3([1.0, 0.0, 0.0]), normal: Vec3([0.0, 1.0, 0.0]) };
    let mut model = Model::new();
    let beam = Flexible::new("beam", Beam::straight(root, 10.0, elements, section).unwrap());
    let beam = model.beam(beam);
    let to = Marker::new(Part::Section { beam, node: 0 }, [0.0; 3]);
    let joint = Joint::new("hub", Kind::Revolute, Marker::new(Part::Ground, [0.0; 3]), to);
    model.joint(joint.driven(Drive::Prescribed(motion)));
    Multibody::new(model).unwrap()
}

/// A cantilever of 1 m × 2 mm × 2 mm of aluminium under a couple M₀ sin(πt/T₀) about the fixed z axis at its tip, M₀ =
/// 2πEI/L, and a disturbance `across` \[m\] of the couple's axis over the length.
fn cantilever(elements: usize, period: f64, across: f64) -> Multibody {
    let (side, density, modulus): (f64, f64, f64) = (2e-3, 2700.0, 70e9);
    let shear = modulus / 2.6;
    let bending = modulus * side.powi(4) / 12.0;
    let torsion = shear * Shape::Rectangle { width: side, height: side }.torsion_constant();
    let (mass, rotary) = (density * side * side, density * side.powi(4) / 12.0);
    let stiffness = [modulus * side * side, torsion, bending, bending];
    let section = Properties::principal(stiffness, mass, [2.0 * rotary, rotary, rotary]);
    let root =
        Station { position: Vec3([0.0; 3]), tangent: Vec3([1.0, 0.0, 0.0]), normal: Vec3([0.0, 1.0, 0.0]) };
    let mut model = Model::new();
    let beam = model.beam(Flexible::new("beam", Beam::straight(root, 1.0, elements, section).unwrap()));
    let clamped = Marker::new(Part::Section { beam, node: 0 }, [0.0; 3]);
    model.joint(Joint::new("clamp", Kind::Fixed, Marker::new(Part::Ground, [0.0; 3]), clamped));
    let amplitude = Expression::new(&format!("if(t < {period}, sin(pi*t/{period}), 0)"), "t", 20.0).unwrap();
    let couple = 2.0 * PI * bending;
    model.load(Load {
        name: "couple".into(),
        at: Marker::new(Part::Section { beam, node: elements }, [0.0; 3]),
        force: Vec3([0.0; 3]),
        moment: Vec3([0.0, across * couple, couple]),
        axes: Axes::Dead,
        amplitude: Some(Arc::new(amplitude)),
    });
    Multibody::new(model).unwrap()
}

const TIP: [&str; 3] = ["beam.tip.position.x", "beam.tip.position.y", "beam.tip.position.z"];

fn path(name: &str) -> std::path::PathBuf {
    std::env::temp_dir().join(name)
}

fn write(name: &str, rows: &[Vec<f64>]) {
    let line = |row: &Vec<f64>| row.iter().map(|x| format!("{x:.12e}")).collect::<Vec<_>>().join(",");
    std::fs::write(path(name), rows.iter().map(line).collect::<Vec<_>>().join("\n")).unwrap();
}

fn read(name: &str) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(path(name)).unwrap();
    text.lines().map(|line| line.split(',').map(|x| x.parse().unwrap()).collect()).collect()
}

fn couple(period: f64, elements: usize, by: &str, across: f64) -> Run {
    let (mut method, step) = method(by);
    let mut system = cantilever(elements, period, across);
    run(&mut system, method.as_mut(), (10.0, step), 0.01, &TIP)
}

/// A plate on an air bearing that bends and turns the hub by its weight.
fn plate(elements: usize) -> Multibody {
    let (length, width, thickness): (f64, f64, f64) = (1.45, 0.1, 2.5e-3);
    let (density, modulus, damping): (f64, f64, f64) = (2766.0, 69e9, 0.2);
    let shape = Shape::Rectangle { width, height: thickness };
    let torsion = modulus / 2.6 * shape.torsion_constant();
    let (flat, edge) = (width * thickness.powi(3) / 12.0, thickness * width.powi(3) / 12.0);
    let area = width * thickness;
    // n is the normal of the plate, b its width: bending about n is edgewise.
    let stiffness = [modulus * area, torsion, modulus * edge, modulus * flat];
    let inertia = [density * (flat + edge), density * edge, density * flat];
    let section = Properties::principal(stiffness, density * area, inertia);
    let root = Station {
        position: Vec3([0.35, 0.0, 0.0]),
        tangent: Vec3([1.0, 0.0, 0.0]),
        normal: Vec3([0.0, FRAC_1_SQRT_2, FRAC_1_SQRT_2]),
    };
    let mut model = Model::new().with_gravity([0.0, 0.0, -9.81]);
    let mut hub = Body::new("hub", 10.0, [9.557; 3]);
    hub.damping = damping;
    let hub = model.body(hub);
    let beam = Flexible::new("beam", Beam::straight(root, length, elements, section).unwrap())
        .damped(damping)
        .with_fibre("C", 0.3, [0.5 * thickness, 0.0])
        .with_fibre("D", 1.2, [0.5 * thickness, 0.0]);
    let beam = model.beam(beam);
    let axis = ([0.0, 0.0, 1.0], None);
    model.join("bearing", Kind::Revolute, [Part::Ground, hub], [0.0; 3], axis).unwrap();
    let section = Part::Section { beam, node: 0 };
    model.join("clamp", Kind::Fixed, [hub, section], root.position, axis).unwrap();
    Multibody::new(model).unwrap()
}

const PLATE: [&str; 5] = ["bearing.speed", "beam.C.strain", "beam.D.strain", TIP[1], TIP[2]];

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let argument = |i: usize| arguments.get(i).map(String::as_str);
    let number = |i: usize, default: f64| argument(i).and_then(|x| x.parse().ok()).unwrap_or(default);
    match argument(0) {
        Some("plane") => plane(number(1, 20.0) as usize, number(2, 1e-9)),
        // T0, elements, method
        Some("reference") => {
            let (period, elements) = (number(1, 3.0), number(2, 80.0) as usize);
            let by = argument(3).unwrap_or("radau:1e-9");
            let out = couple(period, elements, by, 0.0);
            println!("{:?} {:.1} s {:?}", out.ending, out.seconds, out.counters);
            write(&format!("couple_{period}.csv"), &out.rows);
        }
        // T0, method, elements …
        Some("couple") => {
            let period = number(1, 3.0);
            let converged = read(&format!("couple_{period}.csv"));
            for elements in arguments[3..].iter().map(|x| x.parse().unwrap()) {
                let out = couple(period, elements, &arguments[2], 0.0);
                let [(x, _), (y, peak)] = [1, 2].map(|k| apart(&out.rows, &converged, k));
                println!(
                    "{elements} {} y {y:.3e} x {x:.3e} m of {peak:.4} ({:.4} %), {:.2} s {:?} {:?}",
                    arguments[2],
                    100.0 * y / peak,
                    out.seconds,
                    out.counters,
                    out.ending
                );
            }
        }
        // T0, elements, method, disturbance
        Some("across") => {
            let out = couple(number(1, 4.0), number(2, 20.0) as usize, &arguments[3], number(4, 1e-6));
            println!("{:?} {:.1} s", out.ending, out.seconds);
            for second in 0..=10 {
                let z = out.rows.iter().filter(|row| row[0] <= f64::from(second) + 1e-9);
                println!("{second} s: {:.3e} m", z.fold(0.0_f64, |m, row| m.max(row[3].abs())));
            }
        }
        // elements, method
        Some("plate") => {
            let (mut method, step) = method(argument(2).unwrap_or("radau:1e-8"));
            let mut system = plate(number(1, 20.0) as usize);
            let out = run(&mut system, method.as_mut(), (number(3, 10.0), step), 0.01, &PLATE);
            println!("{:?} {:.1} s {:?}", out.ending, out.seconds, out.counters);
            let name =
                format!("plate_{}_{}.csv", arguments[1], argument(2).unwrap_or("radau").replace(':', "_"));
            write(&name, &out.rows);
            if let Some(other) = argument(4) {
                let converged = read(other);
                for (k, name) in PLATE.iter().enumerate() {
                    let (far, peak) = apart(&out.rows, &converged, k + 1);
                    println!("{name}: {far:.3e} of {peak:.5e}, {:.4} %", 100.0 * far / peak);
                }
            }
        }
        other => panic!("no table {other:?}"),
    }
}
