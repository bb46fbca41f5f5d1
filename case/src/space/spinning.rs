//! Beams that spin about their own axis, as shafts do, and what of their inertia they need for it.
//!
//! A section that whirls at its speed Ω of spin has the gyroscopic moment (J₁ − J₂) Ω² against its inclination: J₁ about the tangent stiffens the shaft, and J₂
//! in bending takes back half of it, for J₁ = 2 J₂ of a round section. With ρI left out J₂ is 0 and J₁, without which nothing can twist, is not: the critical
//! speeds of a round shaft of pinned ends are k² √(EI/μ)/√(1 − 2(ik)²) in place of k² √(EI/μ)/√(1 − (ik)²), with the radius of gyration i and k = nπ/L.

use super::Space;
use crate::kinds::beam::Beam;
use flexion::linalg::Vec3;
use flexion::multibody::Axis;

/// Part of the direction of a beam that is along the axis of a spin of its own.
const ALONG: f64 = 0.5;

impl Space {
    /// Cautions for beams without rotary inertia in bending that spin about their own axes, in a run of this duration \[s\] or in a steady rotation.
    pub fn spinning(&self, duration: f64) -> Vec<String> {
        let spins =
            self.beams.iter().filter(|(beam, _)| beam.leaves_out_gyration() && self.spins(beam, duration));
        let caution = |(beam, _): &(Beam, _)| {
            let share = 0.5 * (std::f64::consts::PI * beam.gyration() / beam.length).powi(2);
            format!(
                "beam `{}` spins about its own axis without rotary inertia in bending: its polar moment of inertia stiffens it as a gyroscope, and what takes back half of \
                 that is left out. Its critical speeds come out too high, the n-th of pinned ends by about n² × {:.2} %: give its section `rotary-inertia`, or the \
                 beam `shear = true`",
                beam.name,
                100.0 * share
            )
        };
        self.once(spins.map(caution).collect())
    }

    /// Whether a beam spins about its own direction: with the rotation of the case, from the start, or by the prescribed motion of a joint at it.
    fn spins(&self, beam: &Beam, duration: f64) -> bool {
        let middle = beam.frame(0.5 * beam.length);
        let (point, tangent) = (middle.position, middle.rotation.column(0));
        let along = |spin: Vec3| spin.norm() > 0.0 && spin.dot(tangent).abs() >= ALONG * spin.norm();
        let model = self.multibody.model();
        let turned = |joint: &str| {
            let speed = |k: usize| {
                let axis = Axis::new(point, middle.rotation.column(k));
                axis.map_or(0.0, |axis| model.prescribed_speed(joint, &axis, duration))
            };
            along(middle.rotation * Vec3([speed(0), speed(1), speed(2)]))
        };
        let own = format!("{}.", beam.name);
        let mut at_it =
            self.joints.iter().filter(|link| link.between.iter().any(|part| part.starts_with(&own)));
        self.rotation.as_ref().is_ok_and(|rotation| along(rotation.axis.direction))
            || beam.motion[1].is_some_and(along)
            || at_it.any(|link| turned(&link.name))
    }
}
