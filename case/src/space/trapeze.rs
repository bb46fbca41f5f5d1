//! How much the tension of rotation would stiffen beams with shear in torsion, which have no such stiffness.

use super::Space;
use crate::kinds::beam::Beam;
use flexion::linalg::Vec3;
use flexion::multibody::Axis;

/// Part of the torsional stiffness from which on there is a caution: frequencies of torsion change by half of it.
const COUNTS: f64 = 0.02;
/// Intervals of the integrals along a beam.
const INTERVALS: usize = 64;

impl Space {
    /// Cautions for beams with shear whose torsion the tension in a steady rotation [rad/s] would stiffen (the trapeze effect).
    pub fn without_trapeze(&self, speed: f64) -> Vec<String> {
        let Ok(rotation) = &self.rotation else { return Vec::new() };
        let with_shear = self.beams.iter().map(|(beam, _)| beam).filter(|beam| beam.shear && beam.torsion);
        let each = with_shear.map(|beam| (&beam.name, stiffening(beam, &rotation.axis, speed)));
        let counts = each.filter(|(_, part)| *part > COUNTS);
        let said = counts
            .map(|(name, part)| {
                format!(
                    "beam `{name}` has shear and no trapeze effect: at {speed:.4} rad/s its tension would make it stiffer in torsion by about {:.2} %, and the \
                     frequencies of torsion lie about {:.2} % too low; without shear, `shear = false`, they have it",
                    100.0 * part,
                    100.0 * ((1.0 + part).sqrt() - 1.0)
                )
            })
            .collect();
        self.once(said)
    }
}

/// ∫N K² φ′² ds over ∫GJ φ′² ds with the tension N of the rotation, the polar radius of gyration K of the stiffness, and the first torsion φ′ = cos(πs/2L) of
/// a prismatic beam.
fn stiffening(beam: &Beam, axis: &Axis, speed: f64) -> f64 {
    let step = beam.length / INTERVALS as f64;
    let (mut force, mut added, mut stiffness) = (Vec3::ZERO, 0.0, 0.0);
    for i in (0..INTERVALS).rev() {
        let s = (i as f64 + 0.5) * step;
        let (of, section) = (beam.frame(s), beam.blade.resultants(s));
        let half =
            0.5 * step * section.mass * speed * speed * (of.position - axis.point).across(axis.direction);
        force += half;
        let weight = libm::cos(std::f64::consts::FRAC_PI_2 * s / beam.length).powi(2);
        let square = (section.flap_stiffness + section.chord_stiffness) / section.axial_stiffness;
        added += weight * force.dot(of.rotation.column(0)) * square;
        stiffness += weight * section.torsional_stiffness;
        force += half;
    }
    added / stiffness
}
