//! Live loads from a validated case.

use super::build;
use super::layout::Case;
use super::loads::{Amplitude, Distribution, Loads};
use flexion::hub_beam::load::{Couple, DistributedForce, Force, Load};
use flexion::profile::{End, Expression, Polyline, Profile, ProfileError, Ramp, Table, covers};
use std::sync::Arc;

/// A factor against time over the duration \[s\]; `None` for 1.
///
/// # Errors
/// [`ProfileError`] when it cannot be built or does not cover the run.
pub fn amplitude(case: &Amplitude, duration: f64) -> Result<Option<Arc<dyn Profile>>, ProfileError> {
    let profile: Arc<dyn Profile> = match case {
        Amplitude::Constant => return Ok(None),
        Amplitude::Ramp { time } => Arc::new(Ramp::new(0.0, 1.0, *time)?),
        Amplitude::Table(rows) => Arc::new(Table::new(rows, End::default())?),
        Amplitude::Expression(formula) => {
            Arc::new(Expression::new(formula, "t", build::known_for(duration))?)
        }
    };
    covers(profile.as_ref(), duration)?;
    Ok(Some(profile))
}

/// A factor along a beam of the given length \[m\]; `None` for 1.
///
/// # Errors
/// [`ProfileError`] when it cannot be built.
pub fn distribution(case: &Distribution, length: f64) -> Result<Option<Arc<dyn Profile>>, ProfileError> {
    Ok(Some(match case {
        Distribution::Uniform => return Ok(None),
        Distribution::Table(rows) => Arc::new(Polyline::new(rows)?),
        Distribution::Expression(formula) => Arc::new(Expression::new(formula, "x", length)?),
    }))
}

/// The loads of a case.
///
/// # Errors
/// [`ProfileError`] when a profile cannot be built.
pub fn loads(case: &Case) -> Result<Vec<Box<dyn Load>>, ProfileError> {
    let Loads { gravity, forces, couples, distributed, .. } = &case.loads;
    let mut loads: Vec<Box<dyn Load>> = Vec::new();
    if let Some(gravity) = gravity {
        loads.push(Box::new(*gravity));
    }
    for f in forces {
        let amplitude = amplitude(&f.amplitude, case.duration)?;
        loads.push(Box::new(Force { station: f.station, force: f.force, axes: f.axes, amplitude }));
    }
    for c in couples {
        let amplitude = amplitude(&c.amplitude, case.duration)?;
        loads.push(Box::new(Couple { station: c.station, couple: c.couple, amplitude }));
    }
    for d in distributed {
        loads.push(Box::new(DistributedForce {
            force: d.force,
            axes: d.axes,
            distribution: distribution(&d.distribution, case.length)?,
            range: (d.range.0, d.range.1.unwrap_or(case.length)),
            amplitude: amplitude(&d.amplitude, case.duration)?,
        }));
    }
    Ok(loads)
}

/// Stations at which the loads of a case begin, end or jump \[m\].
///
/// # Errors
/// [`ProfileError`] when a distribution cannot be built.
pub fn stations(case: &Case) -> Result<Vec<f64>, ProfileError> {
    let Loads { forces, couples, distributed, .. } = &case.loads;
    let mut stations: Vec<f64> = forces.iter().map(|f| f.station).collect();
    stations.extend(couples.iter().map(|c| c.station));
    for d in distributed {
        stations.extend([d.range.0, d.range.1.unwrap_or(case.length)]);
        if let Some(profile) = distribution(&d.distribution, case.length)? {
            stations.extend(profile.breaks());
        }
    }
    Ok(stations)
}
