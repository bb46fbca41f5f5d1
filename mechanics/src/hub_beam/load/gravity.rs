//! Gravity on the beam and on its lumped masses; the hub rotates about its centre of mass, so that its weight does no work.
//!
//! ```text
//! V = −∫ ρA g·r + ρS g·n dx,   n the normal of the section;   without foreshortening etc. see the parent module
//! ```
//!
//! In the couplings with small deflections the section rotates to second order in φ = w₂′,
//! n = (−φ, 1 − ½φ²): C_x ∋ −∫ρS φ dx, C_y ∋ ∫ρS (1 − ½φ²) dx.

use super::group::{Group, Store};
use super::site::Share;
use super::{Axes, Kinematics, Load, Site};
use crate::hub_beam::beam::Beam;
use crate::hub_beam::fields::{add_outer, add_vector};
use crate::linalg::Matrix;

/// Uniform gravity in the plane of motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gravity {
    /// Acceleration g [m/s²].
    pub acceleration: f64,
    /// Angle of its direction against the inertial x axis, counterclockwise \[rad\]: −π/2 is down.
    pub direction: f64,
}

impl Load for Gravity {
    fn group(&self, site: &Site<'_>) -> Option<Group> {
        // The weight is where the mass is.
        let site = &Site { fields: site.fields.inertial(), ..*site };
        let (sin, cos) = libm::sincos(self.direction);
        let force = [self.acceleration * cos, self.acceleration * sin];
        let Beam { section, masses, .. } = site.beam;
        let mut points: Vec<(f64, f64)> = masses.iter().map(|m| (m.station, m.mass)).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let cells = site.fields.cells();
        let share = Share { density: &|x| section.resultants(x).mass, points: &points, cells };
        let mut group = site.group(&share, force, Axes::Dead, None);
        group.set_store(Store::Gravity, 0.0);
        let moment = Share { density: &|x| section.resultants(x).first_moment, points: &[], cells };
        let mut across = Matrix::new(&site.structure());
        let mut eccentric = false;
        moment.each(site.fields, |point, p| {
            eccentric = true;
            if site.kinematics == Kinematics::Curve {
                group.push_eccentric(point, p, site.radius);
                return;
            }
            group.c_y += p;
            add_vector(&mut group.g_x, &point.transverse, 1, -p);
            add_outer(&mut across, (&point.transverse, 1), (&point.transverse, 1), -p);
        });
        if eccentric && site.kinematics != Kinematics::Curve {
            let shortened = site.kinematics == Kinematics::Foreshortened;
            let mut along = Matrix::new(&site.structure());
            if shortened {
                site.add_tail(&mut along, &share);
            }
            group.stiffen(&site.structure(), shortened.then_some(&along), Some(&across), None);
        }
        Some(group)
    }
}
