//! The mechanics of [`flexion`] in WebAssembly: a beam of 10 m on a hub that spins up to 4 rad/s in 15 s
//! (`verification/p1_spin_up_4`), with the first-order coupling, run for 20 s by [`Radau`].
//!
//! The module imports nothing. Its [exports] run the case and hand out the trajectory in linear memory;
//! `compare.mjs` reads it and holds it to that of the native program.

// A `no_mangle` name counts as unsafe code, for two libraries might export the same one.
#[allow(unsafe_code)]
pub mod exports;

use flexion::analysis::recording::record;
use flexion::analysis::transient::{Ending, Plan};
use flexion::basis::{Field, Hermite, Lagrange};
use flexion::hub_beam::{Drive, Fields, Foreshortening, Hub, HubBeam, LinearCoupling};
use flexion::integrator::{Radau, Tolerance};
use flexion::profile::{Motion, SpinUp};
use flexion::section::{Resultants, Section, Uniform};
use flexion::system::Channel;
use std::error::Error;
use std::sync::Arc;

/// Length L of the beam \[m\].
const LENGTH: f64 = 10.0;

/// A recorded run.
#[derive(Debug, Default)]
pub struct Trajectory {
    /// Names of the columns with their units, separated by commas, as in `trajectory.csv`; the reason if the run failed.
    pub heading: String,
    /// Number of columns, the time included.
    pub columns: usize,
    /// The values in SI units, row after row.
    pub values: Vec<f64>,
}

/// Runs the case with so many finite elements.
///
/// # Errors
/// When there is no element, or the run does not come to its end.
pub fn spin_up(elements: usize) -> Result<Trajectory, Box<dyn Error>> {
    let (modulus, density, area, second_moment) = (70e9, 3000.0, 4e-4, 2e-7);
    let section = Uniform::from_resultants(Resultants {
        mass: density * area,
        axial_stiffness: modulus * area,
        bending_stiffness: modulus * second_moment,
        ..Resultants::default()
    })?;
    let axial = Lagrange::new(LENGTH, elements, 1)?;
    let transverse = Hermite::new(LENGTH, elements, Field::Transverse)?;
    let fields = Fields::new(LENGTH, Box::new(axial), Box::new(transverse), section.breaks());
    let motion = Motion::Speed { profile: Arc::new(SpinUp::new(4.0, 15.0)?), initial_angle: 0.0 };
    let hub = Hub { radius: 0.0, inertia: 0.0, drive: Drive::Prescribed(motion) };
    let coupling = LinearCoupling::new(fields, &section, &hub, Foreshortening::First);
    let mut system = HubBeam::new(hub, coupling, &[]);
    let integrator = Radau::new(Tolerance { relative: 1e-6, absolute: 1e-8 })?;
    let run = record(&mut system, &integrator, &Plan::new(20.0, 0.02));
    match run.ending {
        Ending::Finished => {}
        Ending::Stopped => return Err("the run was stopped".into()),
        Ending::Failed(error) => return Err(error.into()),
    }
    let mut names = vec!["time [s]".to_owned()];
    let name =
        |c: &Channel| if c.unit.is_empty() { c.name.clone() } else { format!("{} [{}]", c.name, c.unit) };
    names.extend(run.trajectory.channels().iter().map(name));
    let values = run.trajectory.rows().flat_map(|(t, row)| std::iter::once(t).chain(row.iter().copied()));
    Ok(Trajectory { heading: names.join(","), columns: names.len(), values: values.collect() })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the same equations, coded independently: `verification/p1_spin_up_4/expected.toml`.
    #[test]
    fn the_tip_lags_by_two_fifths_of_a_metre_at_most() {
        assert_eq!(exports::flexion_run(10), 1001);
        let trajectory = spin_up(10).unwrap();
        assert_eq!(exports::flexion_columns(), trajectory.columns);
        let column = trajectory.heading.split(',').position(|name| name == "tip.deflection [m]").unwrap();
        let deflection = trajectory.values.chunks(trajectory.columns).map(|row| row[column]);
        let smallest = deflection.fold(0.0, f64::min);
        assert!((smallest + 0.400337212).abs() < 4e-6, "{smallest}");
    }

    #[test]
    fn a_case_that_cannot_run_says_why() {
        assert!(spin_up(0).unwrap_err().to_string().contains("at least one cell"));
    }
}
