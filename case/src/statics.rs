//! The path of equilibria of a case at rest as its loads grow.

use super::problem::Problems;
use super::reading::Reading;
use flexion::analysis::path::{Plan, Point, follow};
use flexion::system::System;
use flexion_results::{LoadPath, LoadPoint};

impl Reading {
    /// Follows the equilibrium of the case, its hub at rest and held, under the loads of t = 0 times a factor that grows from
    /// zero, to the load factor of the plan. `progress` gets the number of points and the load factor, and stops by `false`.
    ///
    /// # Errors
    /// [`Problems`] of the case, and of a hub that rotates at the start. A path that ends early is no error.
    pub fn load_path(
        &self,
        plan: &Plan,
        mut progress: impl FnMut(usize, f64) -> bool,
    ) -> Result<LoadPath, Problems> {
        let mut system = self.build()?.system;
        let key = if self.case.space().is_some() { "" } else { "hub" };
        self.at_rest(&system.initial().v, key, "`flexion modes` and `campbell` find its equilibrium")?;
        system.hold(true);
        let start = system.initial();
        let channels = system.channels().to_vec();
        let mut points: Vec<LoadPoint> = Vec::new();
        let mut stopped = false;
        let visit = |system: &mut dyn System, point: &Point| {
            let mut values = vec![0.0; channels.len()];
            system.record(&point.state, &mut values);
            points.push(LoadPoint {
                factor: point.factor,
                length: point.length,
                stability: point.stability.as_ref().ok().copied(),
                critical: point.critical,
                values,
            });
            stopped = !progress(points.len(), point.factor);
            !point.arrived && !stopped
        };
        let end = follow(system.as_mut(), &start, plan, visit).err().map(|end| end.to_string());
        let end = if stopped { Some("stopped by the user".to_owned()) } else { end };
        Ok(LoadPath { channels, points, to: plan.to, end })
    }
}
