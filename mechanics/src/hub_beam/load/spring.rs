//! A spring between a station of the beam and a point that is fixed in space, with a damper beside it.
//!
//! ```text
//! F = −k (r − A),   V = ½k |r − A|² = −k A·r + ½k |ρ|² + ½k |A|²,   ρ = (a + x, 0) + u
//! ```
//!
//! r is the place of the station in inertial axes, ρ the same in the hub's frame, u = ℓ + ½(qᵀG_x q, 0) its displacement
//! with the linear part ℓ. The first term is the potential of a dead force k A; the second does not depend on the angle of
//! the hub and has no torque about it. In the couplings with small deflections it is kept to second order in q,
//! ½|ρ|² = ½(a + x)² + (a + x) u_x + ½|ℓ|²; without foreshortening, and on a curve, nothing is left out.
//!
//! Valid for a spring that pulls equally in all directions, of no natural length. The [damper](super::Damper) resists the
//! velocity of the station.

use super::group::{Group, Store};
use super::site::Share;
use super::{Axes, Damper, Kinematics, Load, Site};
use crate::hub_beam::fields::{add_outer, add_vector};
use crate::linalg::Matrix;

/// A spring from one station of the axis to the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// Station x \[m\].
    pub station: f64,
    /// Stiffness k \[N/m\].
    pub stiffness: f64,
    /// Coefficient c of the damper [N·s/m].
    pub damping: f64,
    /// Place A of the other end, in inertial axes \[m\].
    pub anchor: [f64; 2],
}

impl Load for Spring {
    fn group(&self, site: &Site<'_>) -> Option<Group> {
        let (k, distance) = (self.stiffness, site.radius + self.station);
        let share = |p| [(self.station, p)];
        let (one, central) = (share(1.0), share(-k * distance));
        let share = Share { density: &|_| 0.0, points: &one, cells: site.fields.cells() };
        let mut group = site.group(&share, self.anchor.map(|a| k * a), Axes::Dead, None);
        let point = site.fields.point(self.station, 1.0);
        let new = || Matrix::new(&site.structure());
        let (mut along, mut own) = (new(), new());
        add_vector(&mut group.m, &point.axial, 0, -k * distance);
        for shapes in [&point.axial, &point.transverse] {
            add_outer(&mut own, (shapes, 0), (shapes, 0), -k);
        }
        let shortened = site.kinematics == Kinematics::Foreshortened;
        if shortened {
            site.add_tail(&mut along, &share);
            site.add_tail(
                &mut own,
                &Share { density: &|_| 0.0, points: &central, cells: site.fields.cells() },
            );
        }
        group.stiffen(&site.structure(), shortened.then_some(&along), None, Some(&own));
        let [x, y] = self.anchor;
        group.set_store(Store::Spring, 0.5 * k * (distance * distance + x * x + y * y));
        Some(group)
    }
    fn damper(&self, site: &Site<'_>) -> Option<Damper> {
        (self.damping > 0.0).then(|| Damper::new(site, self.station, self.damping))
    }
}
