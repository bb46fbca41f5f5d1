//! The beam on which loads act, while a system is built.

use super::group::Group;
use super::{Amplitude, Axes};
use crate::hub_beam::beam::Beam;
use crate::hub_beam::fields::{Fields, Point, add_outer, add_vector};
use crate::linalg::{Matrix, Structure};

/// How a coupling describes the axis; see the [module documentation](super).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kinematics {
    /// Without foreshortening.
    Straight,
    /// With the foreshortening −½∫₀ˣ w₂′² dξ.
    Foreshortened,
    /// The fields are the coordinates of the curve.
    Curve,
}

/// A beam for loads to act on.
#[derive(Debug)]
pub struct Site<'a> {
    /// Its displacement fields, whose cells end where loads begin, end or jump.
    pub fields: &'a Fields,
    /// How the coupling describes the axis.
    pub kinematics: Kinematics,
    /// Its section and lumped masses.
    pub beam: &'a Beam<'a>,
    /// Radius a of the hub \[m\].
    pub radius: f64,
    /// Number of unknowns of the hub.
    pub border: usize,
}

/// A share of force along the axis: p(x) per length and p_m at stations, which ascend.
pub(super) struct Share<'s> {
    pub density: &'s dyn Fn(f64) -> f64,
    pub points: &'s [(f64, f64)],
    /// Ends of the cells over which p is integrated: those of the fields, or parts of them.
    pub cells: &'s [f64],
}

impl Share<'_> {
    /// Calls `f` at every point with its share of the force, quadrature weights included.
    pub fn each(&self, fields: &Fields, mut f: impl FnMut(&Point, f64)) {
        fields.integrate_over(self.cells, |point| {
            let p = point.weight * (self.density)(point.x);
            if p != 0.0 {
                f(point, p);
            }
        });
        for &(x, p) in self.points {
            f(&fields.point(x, 1.0), p);
        }
    }
}

impl Site<'_> {
    /// An empty matrix for the fields' unknowns.
    pub(super) fn structure(&self) -> Structure {
        self.fields.structure(self.border)
    }

    /// A force with the given components, shared out along the axis.
    pub(super) fn group(
        &self,
        share: &Share<'_>,
        force: [f64; 2],
        axes: Axes,
        amplitude: Amplitude,
    ) -> Group {
        let fields = self.fields;
        let mut group = Group::new(fields.len(), force, axes, amplitude);
        if self.kinematics == Kinematics::Curve && axes == Axes::Follower {
            share.each(fields, |point, p| group.push_follower(point, p, self.radius));
            return group;
        }
        let new = || Matrix::new(&self.structure());
        let (mut along, mut follower) = (new(), new());
        share.each(fields, |point, p| {
            let r = self.radius + point.x;
            group.c_x += p * r;
            add_vector(&mut group.g_x, &point.axial, 0, p);
            add_vector(&mut group.g_y, &point.transverse, 0, p);
            if axes == Axes::Follower {
                // (F_x, F_y) rotated by φ = w₂′: (−φ F_y, φ F_x).
                add_outer(&mut follower, (&point.axial, 0), (&point.transverse, 1), -p * force[1]);
                add_outer(&mut follower, (&point.transverse, 0), (&point.transverse, 1), p * force[0]);
                add_vector(&mut group.h, &point.transverse, 1, p * r * force[0]);
            }
        });
        let shortened = self.kinematics == Kinematics::Foreshortened;
        if shortened {
            self.add_tail(&mut along, share);
        }
        let follower = (axes == Axes::Follower).then_some(&follower);
        group.stiffen(&self.structure(), shortened.then_some(&along), None, follower);
        group
    }

    /// out −= ∫ P φ′φ′ᵀ dξ with P(ξ) = ∫_ξᴸ p dx.
    pub(super) fn add_tail(&self, out: &mut Matrix, share: &Share<'_>) {
        let spread = self.fields.tail_over(share.cells, share.density);
        let points = share.points;
        let mut beyond = vec![0.0; points.len() + 1];
        for (i, (_, p)) in points.iter().enumerate().rev() {
            beyond[i] = beyond[i + 1] + p;
        }
        self.fields.integrate_over(share.cells, |point| {
            let beyond = beyond[points.partition_point(|(x, _)| *x <= point.x)];
            let tail = point.weight * (spread(point.x) + beyond);
            add_outer(out, (&point.transverse, 1), (&point.transverse, 1), -tail);
        });
    }
}
