//! Loads along beams.
//!
//! A load f(s) Λ p per length, with the axes Λ of the sections, is Λ p at the sections of an element that have axes among the coordinates, and is interpolated between
//! them by Lagrange's functions L. With the [functions](super::beam) N of the axis, the force on the vector xᵢ is Σₖ wₖᵢ Λₖ p,
//!
//! ```text
//! wₖᵢ = ∫ f Lₖ Nᵢ ds
//! ```

use super::force::Axes;
use crate::linalg::Vec3;
use crate::profile::Profile;
use crate::quadrature::Gauss;
use std::ops::Range;
use std::sync::Arc;

/// Points of Gauss' rule, between two [cuts](cuts) of a distribution.
const POINTS: usize = 6;

/// A force per length along a beam.
#[derive(Clone, Debug)]
pub struct LineLoad {
    /// Name, unique in its model.
    pub name: String,
    /// Number of the beam.
    pub beam: usize,
    /// Elements on which it acts; `None` for all.
    pub elements: Option<Range<usize>>,
    /// Factor f(s) of the force by the arc length s \[m\]; 1 where there is none.
    pub distribution: Option<Arc<dyn Profile>>,
    /// Force per length without stress [N/m].
    pub force: Vec3,
    /// What the components refer to: inertial axes, or the axes of each section.
    pub axes: Axes,
    /// Factor f(t); 1 where there is none.
    pub amplitude: Option<Arc<dyn Profile>>,
}

impl LineLoad {
    /// The components at the time `t` when `part` of the loads acts.
    pub(super) fn at(&self, t: f64, part: f64) -> Vec3 {
        part * self.amplitude.as_ref().map_or(1.0, |f| f.value(t)) * self.force
    }

    pub(super) fn follows(&self) -> bool {
        self.axes == Axes::Follower
    }
}

/// The weights of a load along a beam.
#[derive(Clone, Debug, Default)]
pub(super) struct LineDistribution {
    /// Number of the first element on which it acts.
    pub first: usize,
    /// The rows wₖ \[m\] of each element from there on, section by section.
    pub rows: Vec<[f64; 4]>,
    /// Arc lengths at which the load is drawn \[m\].
    pub stations: Vec<f64>,
}

/// Arc lengths between which f is integrated, from the first of these ends of elements to the last \[m\]: a narrow load within an element is seen whatever the
/// mesh.
pub(super) fn cuts(mut ends: Vec<f64>, f: &dyn Profile) -> Vec<f64> {
    let [from, to] = [ends[0], ends[ends.len() - 1]];
    let shown = f.breaks().iter().chain(f.resolution()).copied();
    ends.extend(shown.filter(|s| *s > from && *s < to));
    Gauss::new(POINTS).resolved(ends, |s| f.value(s))
}

/// The weights of an element of the length `h` \[m\] between two arc lengths \[m\], cut at these; L and N by the place in it, 0 to 1.
pub(super) fn weights<const SECTIONS: usize>(
    h: f64,
    [from, to]: [f64; 2],
    (distribution, cuts): (Option<&dyn Profile>, &[f64]),
    l: impl Fn(f64) -> [f64; SECTIONS],
    n: impl Fn(f64) -> [f64; 4],
) -> [[f64; 4]; SECTIONS] {
    let (mut out, gauss) = ([[0.0; 4]; SECTIONS], Gauss::new(POINTS));
    let inside = cuts.partition_point(|s| *s <= from)..cuts.partition_point(|s| *s < to);
    let inside = cuts.get(inside).unwrap_or_default();
    let cuts = [&[from], inside, &[to]].concat();
    for piece in cuts.windows(2) {
        for (s, weight) in gauss.on(piece[0], piece[1]) {
            let z = (s - from) / h;
            let (n, l, f) = (n(z), l(z), distribution.map_or(1.0, |f| f.value(s)));
            for (out, l) in out.iter_mut().zip(l) {
                out.iter_mut().zip(n).for_each(|(out, n)| *out += weight * f * l * n);
            }
        }
    }
    out
}
