//! Smallest and largest values: those of a motion, not of its records, and of no curve that nothing moves along.

#![allow(clippy::unwrap_used)] // in helpers of tests

use crate::written::{finished, reading};

const BEAM: &str = "
beam.length = '1 cm'
section = { kind = 'resultants', mass-per-length = 1, axial-stiffness = 1e9, bending-stiffness = 50 }
hub.motion = { kind = 'constant', speed = 0 }
load = [{ on = 'tip', force = [0, 1.5], amplitude = { kind = 'ramp', time = 0.3 } }]
run.duration = '1 s'
";

/// A stiff beam follows a load that ceases to grow: of the velocity that it has then, 2/(ω T) of the deflection are left, 3e-5. Records and steps are
/// a thousand times as long as its vibrations.
#[test]
fn a_stiff_beam_does_not_overshoot_behind_a_ramp() {
    for coupling in ["first", "exact", "space"] {
        for step in ["0.01", "0.001"] {
            let set = [format!("model.coupling={coupling}"), format!("output.step={step}")];
            let run = finished(&reading(BEAM, &[&set[0], &set[1]]));
            let of = run.trajectory.extremes(run.trajectory.index("tip.deflection").unwrap());
            assert!((of.max / 1e-8 - 1.0).abs() < 3e-5, "{coupling}, {step} s: {}", of.max);
            assert!(
                !run.all_warnings().any(|said| said.contains("not to be trusted")),
                "{coupling}, {step} s"
            );
        }
    }
}

const SHAKEN: &str = "
beam.length = '2 m'
section = { kind = 'resultants', mass-per-length = 1, axial-stiffness = 1e6, bending-stiffness = 50 }
hub.motion = { kind = 'expression', formula = '3*sin(5*t)+if(t>1.3,2,0)', of = 'speed' }
load = [{ on = 'beam', law = { kind = 'quadratic-drag', coefficient = 0.5 } }]
run.duration = '2 s'
";

/// Energy and work are followed between the records as all other columns are.
#[test]
fn extremes_of_energy_and_work_do_not_depend_on_the_records() {
    for integrator in ["{kind='generalized-alpha',step=0.002}", "{kind='radau'}"] {
        let extremes = |step: &str| {
            let set = [
                "model.coupling=exact".to_owned(),
                format!("integrator={integrator}"),
                format!("output.step={step}"),
            ];
            let run = finished(&reading(SHAKEN, &[&set[0], &set[1], &set[2]]));
            ["energy.total", "energy.drive", "energy.loads", "energy.dissipated"].map(|name| {
                let of = run.trajectory.extremes(run.trajectory.index(name).unwrap());
                (name, of.min, of.max)
            })
        };
        for ((name, least, most), (_, low, high)) in extremes("0.1").into_iter().zip(extremes("0.001")) {
            let size = low.abs().max(high.abs());
            let off = (least - low).abs().max((most - high).abs());
            assert!(off <= 1e-3 * size, "{integrator}, {name}: {least} … {most} for {low} … {high}");
        }
    }
}
