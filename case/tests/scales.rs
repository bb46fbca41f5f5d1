//! A case of one shape in any size: with lengths, times and speeds in proportion the motion is the same.
//!
//! With the length s: L ∝ s, EA and mass per length ∝ s², EI ∝ s⁴, bodies ∝ s³ and s⁵, gravity and speeds of rotation ∝ 1/s, times ∝ s.
//! Displacements are ∝ s, and velocities, angles and strains the same. Beams of 100 µm are real: resonators of silicon.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use crate::written::{finished, reading};
use flexion::linalg::vector::noise;
use flexion_case::{ModesRequest, Run};
use flexion_results::{Frequencies, Units};

/// Parts of the largest value by which last values may differ: of motions whose steps have a tolerance of 1e-6, and of equilibria. Crests between records
/// are those of parabolas through ends of steps, of which rounding chooses others.
const MOVING: f64 = 1e-4;
const STILL: f64 = 1e-6;
const CRESTS: f64 = 1e-3;

const SCALES: [f64; 6] = [1e-6, 1e-4, 1e-2, 1e2, 1e4, 1e6];

/// A beam in the plane, with what differs.
fn planar(s: f64, more: &str) -> String {
    format!(
        "gravity=[0,{:e}]\n[beam]\nlength={s:e}\n[section]\nkind='resultants'\nmass-per-length={:e}\naxial-stiffness={:e}\nbending-stiffness={:e}\n\
         rotary-inertia={:e}\n[basis]\nkind='finite-elements'\nelements=4\n{more}",
        -9.81 / s,
        1.2 * s.powi(2),
        2.8e5 * s.powi(2),
        140.0 * s.powi(4),
        6e-4 * s.powi(4)
    )
}

fn run(s: f64) -> String {
    format!("[run]\nduration={:e}\n[output]\nstep={:e}\n", 0.2 * s, 0.01 * s)
}

/// A beam in space whose section is known all around.
fn beam(s: f64) -> String {
    format!(
        "[[beam]]\nname='arm'\nlength={s:e}\nelements=3\nup=[0,0,1]\npolar-inertia={:e}\nsection={{kind='general',mass-per-length={:e},\
         axial-stiffness={:e},torsional-stiffness={:e},bending-stiffness={:e},bending-stiffness-across={:e}}}\n",
        1e-3 * s.powi(4),
        1.2 * s.powi(2),
        2.8e5 * s.powi(2),
        100.0 * s.powi(4),
        140.0 * s.powi(4),
        200.0 * s.powi(4)
    )
}

fn body(s: f64, name: &str, [x, y]: [f64; 2]) -> String {
    let [a, b, c] = [0.01, 0.02, 0.015].map(|moment| moment * s.powi(5));
    format!(
        "[[body]]\nname='{name}'\nmass={:e}\ninertia={{kind='principal',moments=[{a:e},{b:e},{c:e}]}}\nposition=[{:e},{:e},0]\n",
        0.7 * s.powi(3),
        x * s,
        y * s
    )
}

/// Smallest, largest and last values of the recorded displacements and angles, and the last of velocities, whose waves of the mesh are fast.
fn values(run: &Run, s: f64) -> Vec<(String, String, [f64; 3])> {
    let channels = run.trajectory.channels().iter().enumerate();
    let scaled = channels.filter_map(|(i, channel)| {
        let unit = match channel.unit.as_ref() {
            "m" => s,
            "rad" => 1.0,
            "m/s" => {
                let last = run.trajectory.extremes(i).last;
                return Some((channel.name.clone(), channel.unit.to_string(), [last; 3]));
            }
            _ => return None,
        };
        let of = run.trajectory.extremes(i);
        let moves = !channel.name.starts_with("constraint");
        moves.then(|| {
            (channel.name.clone(), channel.unit.to_string(), [of.min, of.max, of.last].map(|x| x / unit))
        })
    });
    scaled.collect()
}

/// Whether the case of any size has the values of that of one metre, but for a part of the largest of their unit.
fn same(what: &str, case: &dyn Fn(f64) -> String, part: f64) {
    same_at(&SCALES, what, case, part);
}

fn same_at(scales: &[f64], what: &str, case: &dyn Fn(f64) -> String, part: f64) {
    let of = |s: f64| values(&finished(&reading(&case(s), &[])), s);
    let expected = of(1.0);
    assert!(expected.len() > 2, "{what}");
    for &s in scales {
        for ((name, unit, x), (.., y)) in of(s).iter().zip(&expected) {
            let alike = expected.iter().filter(|(_, other, _)| other == unit).flat_map(|(.., y)| y);
            let largest = alike.fold(1e-9_f64, |most, y| most.max(y.abs()));
            let parts = [CRESTS, CRESTS, part];
            for ((x, y), part) in x.iter().zip(y).zip(parts) {
                assert!((x - y).abs() <= part * largest, "{what}, {s} m: {name} is {x} and not {y}");
            }
        }
    }
}

#[test]
fn beams_in_the_plane_move_alike_in_any_size() {
    for coupling in ["zeroth", "first", "high", "exact", "space"] {
        let turning = |s: f64| {
            let hub = format!(
                "[hub]\nmotion={{kind='constant',speed={:e}}}\n[model]\ncoupling='{coupling}'\n",
                0.3 / s
            );
            planar(s, &hub) + &run(s)
        };
        same(coupling, &turning, MOVING);
    }
    for (coupling, method) in [("first", "newmark"), ("exact", "generalized-alpha")] {
        let fixed = |s: f64| {
            let hub = "[hub]\nmotion={kind='constant',speed=0}\n";
            let steps = format!(
                "[model]\ncoupling='{coupling}'\n[integrator]\nkind='{method}'\nstep={:e}\n",
                1e-3 * s
            );
            planar(s, hub) + &steps + &run(s)
        };
        same(method, &fixed, MOVING);
    }
    let free = |s: f64| {
        let torque = format!("torque={{kind='constant',torque={:e}}}", 5.0 * s.powi(3));
        let hub = format!("[hub]\ninertia={:e}\nmotion={{kind='free',{torque}}}\n", 0.3 * s.powi(5));
        planar(s, &hub) + &run(s)
    };
    same("free hub", &free, MOVING);
    // It falls onto a stop, and rebounds in bursts of impacts.
    let falling = |s: f64| {
        let stop = format!(
            "[[contact]]\non='tip'\nlaw={{kind='constraint',restitution=0.5}}\nobstacle={{kind='plane',point=[0,{:e}],normal=[0,1]}}\n",
            -0.02 * s
        );
        planar(s, "[hub]\nmotion={kind='free'}\n[model]\ncoupling='exact'\n")
            + &stop
            + &run(s).replace("duration=2e", "duration=1e")
    };
    same("contact", &falling, MOVING);
    for coupling in ["first", "exact", "space"] {
        let still = |s: f64| {
            let hub = format!("[hub]\nmotion={{kind='constant',speed=0}}\n[model]\ncoupling='{coupling}'\n");
            planar(s, &hub) + "[initial]\nkind='static'\n[run]\nduration=0\n"
        };
        same(&format!("static {coupling}"), &still, STILL);
    }
}

#[test]
fn systems_in_space_move_alike_in_any_size() {
    let gravity = |s: f64| format!("gravity=[0,{:e},{:e}]\n", -9.81 / s, 3.0 / s);
    let clamped = |s: f64| gravity(s) + &run(s) + &beam(s) + "root='clamped'\n";
    same("clamped", &clamped, MOVING);
    let still =
        |s: f64| gravity(s) + "initial={kind='static'}\nrun={duration=0}\n" + &beam(s) + "root='clamped'\n";
    same("static", &still, STILL);
    let jointed = |s: f64| {
        let joint = |kind: &str, between: [&str; 2], x: f64, more: &str| {
            format!("[[joint]]\nkind='{kind}'\nbetween={between:?}\nat=[{x:e},0,0]\n{more}")
        };
        gravity(s)
            + &run(s)
            + &beam(s)
            + &body(s, "weight", [1.0, 0.0])
            + &joint("revolute", ["ground", "arm.root"], 0.0, "axis=[0,0,1]\n")
            + &joint("spherical", ["arm.tip", "weight"], s, "")
    };
    same("joints", &jointed, MOVING);
    // A four-bar chain, whose rows follow from each other in part: which pivots vanish is judged against rows of other units.
    let chain = |s: f64| {
        let bodies = [("left", [0.0, 0.5]), ("top", [0.5, 1.0]), ("right", [1.0, 0.5])]
            .map(|(name, at)| body(s, name, at));
        let joints = [
            ("ground", "left", 0.0, 0.0),
            ("left", "top", 0.0, 1.0),
            ("top", "right", 1.0, 1.0),
            ("right", "ground", 1.0, 0.0),
        ];
        let joints = joints.map(|(a, b, x, y)| {
            format!(
                "[[joint]]\nkind='revolute'\nbetween=['{a}','{b}']\nat=[{:e},{:e},0]\naxis=[0,0,1]\n",
                x * s,
                y * s
            )
        });
        gravity(s) + "model={drop-redundant-rows=true}\n" + &run(s) + &bodies.concat() + &joints.concat()
    };
    same_at(&SCALES[1..4], "chain", &chain, MOVING);
    // A ball that falls onto a floor and rebounds.
    let falling = |s: f64| {
        let floor = "[[contact]]\nname='floor'\non='ball'\nat=[AT]\nobstacle={kind='plane',normal=[0,1,0]}\nlaw={kind='constraint',restitution=0.5}\n";
        let lowest = format!("at=[0,{:e},0]", 0.08 * s);
        gravity(s) + &run(s) + &body(s, "ball", [0.0, 0.1]) + &floor.replace("at=[AT]", &lowest)
    };
    same("ball", &falling, MOVING);
}

/// A steel tube and a concrete girder, and beams at random, clamped or on two hinges.
fn vibrating(seed: u64, elements: usize) -> impl Fn([f64; 3]) -> String {
    let random = noise(8, seed);
    let between = move |i: usize, from: f64, to: f64| from + (to - from) * 0.5 * (1.0 + random[i]);
    move |[length, modulus, density]: [f64; 3]| {
        let long = length * 10.0_f64.powf(between(0, 0.0, 2.0));
        let width = long / 10.0_f64.powf(between(1, 1.0, 2.5));
        let height = width * between(2, 1.1, 3.0);
        let modulus = modulus * 10.0_f64.powf(between(3, 9.0, 11.5));
        let density = density * 10.0_f64.powf(between(4, 3.0, 4.0));
        let shear = between(5, -1.0, 1.0) > 0.0;
        let hinges = between(6, -1.0, 1.0) > 0.0;
        let (root, joints) = match hinges {
            true => (
                "free",
                "[[joint]]\nkind='spherical'\nbetween=['ground','arm.root']\n[[joint]]\nkind='cylindrical'\nbetween=['ground','arm.tip']\naxis=[1,0,0]\n",
            ),
            false => ("clamped", ""),
        };
        format!(
            "[[beam]]\nname='arm'\nlength={long:e}\nroot='{root}'\nelements={elements}\nup=[0,0,1]\nshear={shear}\n\
             section={{kind='rectangle',modulus={modulus:e},density={density:e},width={width:e},height={height:e}}}\n{joints}\
             [rotation]\naxis=[0,0,1]\n[run]\nduration=0\n"
        )
    }
}

/// Units of length, modulus and density: frequencies are ∝ √(E/ρ)/L. Rows of joints have entries of one or of a length, and stiffnesses those of
/// the units.
#[test]
fn beams_vibrate_alike_in_any_units() {
    let of = |case: &str, speed: f64| {
        let request = ModesRequest {
            speed,
            count: 6,
            free_hub: false,
            units: Units { speed: Frequencies::RADIANS, frequency: Frequencies::RADIANS },
            film: false,
        };
        reading(case, &[]).modes(&request).unwrap_or_else(|error| panic!("{error}\n{case}")).modes.modes
    };
    for (seed, elements) in [(1, 10), (2, 24), (3, 48), (4, 80), (5, 4), (6, 60), (7, 80), (8, 16)] {
        let case = vibrating(seed, elements);
        let expected = of(&case([1.0; 3]), 0.0);
        for [length, mass] in
            [[0, -9], [0, -5], [0, 3], [0, 6], [0, 9], [-6, 0], [-3, 0], [2, 0], [4, 0], [-5, -5], [3, 6]]
        {
            let [length, mass] = [length, mass].map(|power| 10.0_f64.powi(power));
            let found = of(&case([length, mass, mass]), 0.0);
            assert_eq!(found.len(), expected.len(), "{seed}: lengths × {length:e}, masses × {mass:e}");
            for (mode, expected) in found.iter().zip(&expected) {
                let (frequency, expected) = (mode.frequency() * length, expected.frequency());
                let what =
                    format!("{seed}: lengths × {length:e}, masses × {mass:e}: {frequency} and {expected}");
                assert!((frequency - expected).abs() <= 1e-9 * expected, "{what}");
                assert!(mode.residual < 1e-7 && mode.mesh.is_some(), "{what}, residual {}", mode.residual);
            }
        }
    }
}

/// A body on a joint at the tip, which nothing turns back: its motion without stiffness is told from rounding of the forces of the joint under gravity, and
/// the vibrations behind it are those of any size.
#[test]
fn a_body_that_turns_freely_leaves_the_vibrations_of_any_size() {
    let of = |s: f64, joint: &str, shear: bool| {
        let request = ModesRequest {
            speed: 0.0,
            count: 5,
            free_hub: false,
            units: Units { speed: Frequencies::RADIANS, frequency: Frequencies::RADIANS },
            film: false,
        };
        let section = format!("section={{kind='circle',modulus=7e10,density=2700,radius={:e}}}", 0.02 * s);
        let case = format!(
            "gravity=[0,{:e},0]\n[[beam]]\nname='arm'\nlength={s:e}\nelements=6\nroot='clamped'\nshear={shear}\n{section}\n{}\
             [[joint]]\nkind='{joint}'\nbetween=['arm.tip','weight']\n{}[run]\nduration=0\n",
            -9.81 / s,
            body(s, "weight", [1.0, 0.0]),
            if joint == "spherical" { "" } else { "axis=[0,0,1]\n" }
        );
        let modes =
            reading(&case, &[]).modes(&request).unwrap_or_else(|error| panic!("{error}\n{case}")).modes;
        modes.modes.iter().map(|mode| mode.frequency() * s).collect::<Vec<f64>>()
    };
    for (joint, shear, free) in
        [("revolute", true, 1), ("revolute", false, 1), ("spherical", true, 3), ("spherical", false, 3)]
    {
        let expected = of(1.0, joint, shear);
        assert_eq!(
            expected.iter().filter(|frequency| **frequency == 0.0).count(),
            free,
            "{joint} {shear}: {expected:?}"
        );
        for s in [1e-3, 1e-2, 0.1, 0.3, 3.0, 10.0, 30.0, 100.0, 1e3] {
            let found = of(s, joint, shear);
            let alike = found.iter().zip(&expected).all(|(x, y)| (x - y).abs() <= 1e-7 * y);
            assert!(found.len() == 5 && alike, "{joint} {shear} {s} m: {found:?} {expected:?}");
        }
    }
}
