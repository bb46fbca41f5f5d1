//! Whether a run would hide that its motion is unstable.
//!
//! A motion in a plane stays there exactly, in finer meshes and shorter steps too, also where the smallest push would lead it
//! out. A companion of the same mesh and method begins with [disturbed](disturb) velocities: with a part ε² of the largest
//! kinetic and strain energy of the run, a part ε of its amplitudes. Where that grows to a hundredth of the largest
//! displacement or angle (or of a hundredth of the size of the system, if that is more), to more than the error of the run, and faster
//! than a drift, the motion is unstable. Components of quaternions are compared without their signs, which mean nothing.

use super::Run;
use super::difference::Pair;
use crate::problem::Problems;
use crate::reading::Reading;
use flexion::analysis::disturb;
use flexion::analysis::recording::Watch;
use flexion::system::{Channel, Role};
use flexion_results::Unstable;
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
/// In the names of components of rotations.
const ROTATION: &str = ".rotation.";

impl Reading {
    /// How a disturbance of a run grows, where it does; `fine` is its refined companion, `safety` times the difference
    /// of which is its error.
    pub(super) fn instability(
        &self,
        run: &Run,
        fine: &Run,
        safety: f64,
        watch: &mut Watch<'_>,
    ) -> Result<Option<Unstable>, Problems> {
        let ours = &run.trajectory;
        // In the plane only a beam that stays straight hides what a finer companion would disturb.
        let bends = ours
            .index("tip.deflection")
            .is_some_and(|i| ours.extremes(i).range() > STRAIGHT * self.case.size());
        if self.case.has_contacts() || bends {
            return Ok(None);
        }
        let energies = ["energy.kinetic", "energy.strain"].map(|name| ours.index(name));
        let energies = energies.into_iter().flatten().map(|i| ours.extremes(i).largest());
        let energy = energies.fold(0.0, f64::max) * SIZE * SIZE;
        let mut disturbed = self.with(&["output.vtk=false".to_owned()])?.prepare()?;
        let (system, time) = (disturbed.live.system.as_mut(), SHORTEST * self.case.duration);
        if !matches!(disturb(system, &mut disturbed.state, energy, time), Ok(true)) {
            return Ok(None);
        }
        let mut left = STEPS * run.counters.steps;
        let disturbed = disturbed.run(&mut |state| {
            left = left.saturating_sub(1);
            if left == 0 { ControlFlow::Break(()) } else { watch(state) }
        });
        let mut found: Option<Unstable> = None;
        let of_motion = |c: &&Channel| c.role != Role::Integration;
        for (group, least) in [("m", self.case.size()), ("rad", 1.0), (ROTATION, 1.0)] {
            let rotation = |c: &Channel| group == ROTATION && c.name.contains(ROTATION);
            let within = |c: &&Channel| c.unit == group || rotation(c);
            let channels = ours.channels().iter().filter(of_motion).filter(within);
            let names: Vec<&str> = channels.map(|c| c.name.as_str()).collect();
            let range = |name: &&str| ours.index(name).map_or(0.0, |i| ours.extremes(i).range());
            let size = names.iter().map(range).fold(LARGE * least, f64::max);
            let apart = |(x, y): (f64, f64)| {
                if group == ROTATION { (x.abs() - y.abs()).abs() } else { (x - y).abs() }
            };
            let pair = |other, name| Pair::new(ours, other, name);
            for name in names {
                let (Some(moved), Some(error)) =
                    (pair(&disturbed.trajectory, name), pair(&fine.trajectory, name))
                else {
                    continue;
                };
                let largest = |pair: &Pair<'_>| -> Vec<f64> {
                    let rows = pair.values().map(apart);
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
}
