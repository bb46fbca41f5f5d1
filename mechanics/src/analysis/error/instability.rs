//! Whether a run would hide that its motion is unstable.
//!
//! A motion in a plane stays there exactly, in finer meshes and shorter steps too, also where the smallest push would lead it
//! out. A companion of the same mesh and method begins with [disturbed](crate::analysis::disturb) velocities: with a part ε² of the largest
//! kinetic and strain energy of the run, a part ε of its amplitudes. Where that grows to a hundredth of the largest
//! displacement or angle (or of a hundredth of the size of the system, if that is more), to more than the error of the run, and faster
//! than a drift, the motion is unstable. Components of quaternions are compared without their signs, which mean nothing.

use super::pair::Pair;
use super::{Disturbance, Refinable, Variant};
use crate::analysis::recording::{Record, Watch};
use crate::system::{Channel, Kind, Role, State};
use std::ops::ControlFlow;

/// ε
const SIZE: f64 = 1e-6;
/// Part of the largest value of its unit to which a difference must grow.
const LARGE: f64 = 0.01;
/// Part at which it is said to begin growing: ten times the disturbance.
const SMALL: f64 = 10.0 * SIZE;
/// Growth within the second half of the time until then: faster than any drift.
const FASTER: f64 = 10.0;
/// Waves that are left out are shorter than this part of the run.
const SHORTEST: f64 = 0.01;
/// Steps of the companion over those of the run at which it is given up: a motion that has left its plane may be far costlier.
const STEPS: u64 = 3;
/// Deflection of a straight beam, over its length.
const STRAIGHT: f64 = 1e-9;

/// A motion that a small disturbance changes.
#[derive(Clone, Debug, PartialEq)]
pub struct Unstable {
    /// The disturbance over the amplitudes of the run.
    pub size: f64,
    /// Name of the column that shows it first.
    pub column: String,
    /// When it has grown tenfold \[s\].
    pub from: f64,
    /// When it has grown to a hundredth of the largest value \[s\].
    pub until: f64,
}

/// Quantities that are of one size.
#[derive(Clone, Copy, PartialEq)]
enum Group {
    Displacements,
    Angles,
    Rotations,
}

impl Group {
    fn holds(self, channel: &Channel) -> bool {
        match self {
            Group::Displacements => channel.unit == "m",
            Group::Angles => channel.unit == "rad",
            Group::Rotations => channel.kind == Kind::Quaternion,
        }
    }

    fn apart(self, (x, y): (f64, f64)) -> f64 {
        if self == Group::Rotations { (x.abs() - y.abs()).abs() } else { (x - y).abs() }
    }
}

/// How a disturbance of a run grows, where it does; `fine` is its refined companion.
pub(super) fn instability<P: Refinable>(
    problem: &P,
    variant: &Variant,
    run: &Record,
    fine: &Record,
    watch: &mut Watch<'_>,
) -> Result<Option<Unstable>, P::Fault> {
    let (ours, safety) = (&run.trajectory, problem.safety());
    let of_kind =
        |kind: Kind| ours.channels().iter().enumerate().filter(move |(_, c)| c.kind == kind).map(|(i, _)| i);
    // In the plane only a beam that stays straight hides what a finer companion would disturb.
    let bends = of_kind(Kind::Deflection).any(|i| ours.extremes(i).range() > STRAIGHT * problem.size());
    if !run.events.is_empty() || bends {
        return Ok(None);
    }
    let energies = of_kind(Kind::KineticEnergy).chain(of_kind(Kind::StrainEnergy));
    let energy = energies.map(|i| ours.extremes(i).largest()).fold(0.0, f64::max) * SIZE * SIZE;
    let disturbance = Some(Disturbance { energy, period: SHORTEST * variant.plan.end });
    let mut left = STEPS * run.counters.steps;
    let mut until = |state: &State| {
        left = left.saturating_sub(1);
        if left == 0 { ControlFlow::Break(()) } else { watch(state) }
    };
    let disturbed = problem.record(&Variant { disturbance, ..variant.clone() }, &mut until)?;
    let mut found: Option<Unstable> = None;
    for (group, least) in
        [(Group::Displacements, problem.size()), (Group::Angles, 1.0), (Group::Rotations, 1.0)]
    {
        let channels = ours.channels().iter().filter(|c| c.role != Role::Integration && group.holds(c));
        let names: Vec<&str> = channels.map(|c| c.name.as_str()).collect();
        let range = |name: &&str| ours.index(name).map_or(0.0, |i| ours.extremes(i).range());
        let size = names.iter().map(range).fold(LARGE * least, f64::max);
        let pair = |other, name| Pair::new(ours, other, name);
        for name in names {
            let (Some(moved), Some(error)) =
                (pair(&disturbed.trajectory, name), pair(&fine.trajectory, name))
            else {
                continue;
            };
            let largest = |pair: &Pair<'_>| -> Vec<f64> {
                let rows = pair.values().map(|values| group.apart(values));
                rows.scan(0.0_f64, |largest, x| {
                    *largest = largest.max(x);
                    Some(*largest)
                })
                .collect()
            };
            let (grown, errors) = (largest(&moved), largest(&error));
            let times = ours.times();
            let unstable = |k: &usize| {
                let half = times.partition_point(|t| *t <= 0.5 * times[*k]).saturating_sub(1);
                let error = errors.get(*k).map_or(0.0, |error| safety * error);
                grown[*k] > error.max(LARGE * size) && grown[*k] > FASTER * grown[half]
            };
            let Some(row) = (0..grown.len()).find(unstable) else { continue };
            if found.as_ref().is_none_or(|found| times[row] < found.until) {
                let from = grown[..row].iter().rposition(|x| *x <= SMALL * size).unwrap_or(0);
                let (column, from, until) = (name.to_owned(), times[from], times[row]);
                found = Some(Unstable { size: SIZE, column, from, until });
            }
        }
    }
    Ok(found)
}
