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

/// Tolerance of the moments of a density, over ∫|p| dx, and how often a cell may be halved for it.
const TOLERANCE: f64 = 1e-10;
const HALVINGS: u32 = 24;

/// Cells of the fields, cut at `seen` and halved until their quadrature rule integrates the density, by itself and times a
/// cubic: a narrow load between two nodes is integrated whatever the mesh.
fn refined(fields: &Fields, seen: &[f64], density: &dyn Fn(f64) -> f64) -> Vec<f64> {
    let (gauss, length) = (fields.gauss(), fields.length());
    let mut ends = [fields.cells(), seen].concat();
    ends.retain(|x| (0.0..=length).contains(x));
    ends.sort_by(f64::total_cmp);
    ends.dedup_by(|b, a| *b - *a <= 1e-12 * length);
    let size: f64 = ends.windows(2).map(|e| gauss.integrate(e[0], e[1], |x| density(x).abs())).sum();
    let mut open: Vec<(f64, f64, u32)> = ends.windows(2).rev().map(|e| (e[0], e[1], 0)).collect();
    let mut cells = vec![0.0];
    while let Some((a, b, halvings)) = open.pop() {
        let middle = 0.5 * (a + b);
        let moments = |from: f64, to: f64| {
            let cubic = |x: f64| ((x - a) / (b - a)).powi(3);
            [0, 1].map(|k| gauss.integrate(from, to, |x| density(x) * if k == 0 { 1.0 } else { cubic(x) }))
        };
        let (whole, first, second) = (moments(a, b), moments(a, middle), moments(middle, b));
        let good = (0..2).all(|k| (whole[k] - first[k] - second[k]).abs() <= TOLERANCE * size);
        if good || halvings == HALVINGS {
            cells.push(b);
        } else {
            open.push((middle, b, halvings + 1));
            open.push((a, middle, halvings + 1));
        }
    }
    cells
}
