//! A force per length.

use super::group::Group;
use super::site::Share;
use super::{Amplitude, Axes, Load, Site};
use crate::hub_beam::Fields;
use crate::linalg::Vec3;
use crate::profile::{Profile, drawn};
use std::sync::Arc;

/// A force per length f(t) p(x) F along the axis.
#[derive(Clone, Debug)]
pub struct DistributedForce {
    /// Components F \[N/m\].
    pub force: [f64; 2],
    /// What they refer to.
    pub axes: Axes,
    /// Share p as a function of the station x \[m\]; 1 everywhere where there is none.
    pub distribution: Option<Arc<dyn Profile>>,
    /// First and last station of the load \[m\].
    pub range: (f64, f64),
    /// Factor f(t).
    pub amplitude: Amplitude,
}

impl DistributedForce {
    /// Stations at which cells must end: ends of the load and breaks of its distribution \[m\].
    pub fn stations(&self) -> Vec<f64> {
        let mut stations = vec![self.range.0, self.range.1];
        stations.extend(self.distribution.iter().flat_map(|p| p.breaks()));
        stations
    }

    /// Stations at which it is drawn on a beam of this length \[m\].
    pub(super) fn drawn(&self, length: f64) -> Vec<f64> {
        drawn(self.distribution.as_deref(), self.range.into(), length)
    }

    /// Force per length at a station \[m\] and a time \[s\], in the axes that it refers to [N/m].
    pub(in crate::hub_beam) fn at(&self, station: f64, time: f64) -> Vec3 {
        let share = self.distribution.as_ref().map_or(1.0, |p| p.value(station));
        let factor = share * self.amplitude.as_ref().map_or(1.0, |f| f.value(time));
        let [x, y] = self.force;
        factor * Vec3([x, y, 0.0])
    }
}

impl Load for DistributedForce {
    fn along(&self) -> Option<&DistributedForce> {
        Some(self)
    }

    fn group(&self, site: &Site<'_>) -> Option<Group> {
        let density = |x: f64| {
            if x < self.range.0 || x > self.range.1 {
                return 0.0;
            }
            self.distribution.as_ref().map_or(1.0, |p| p.value(x))
        };
        let cells = match &self.distribution {
            Some(distribution) => refined(site.fields, distribution.resolution(), &density),
            None => site.fields.cells().to_vec(),
        };
        let share = Share { density: &density, points: &[], cells: &cells };
        Some(site.group(&share, self.force, self.axes, self.amplitude.clone()))
    }
}

/// Cells of the fields, cut at `seen` and halved until their quadrature rule integrates the density: a narrow load between two nodes is integrated
/// whatever the mesh.
fn refined(fields: &Fields, seen: &[f64], density: &dyn Fn(f64) -> f64) -> Vec<f64> {
    let length = fields.length();
    let mut ends = [fields.cells(), seen].concat();
    ends.retain(|x| (0.0..=length).contains(x));
    fields.gauss().resolved(ends, density)
}
