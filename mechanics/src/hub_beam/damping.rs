//! Damping of the beam.

/// Viscous damping of the beam's deformation; both parts together are Rayleigh damping.
///
/// Mass-proportional: the force −β ρA ẇ on every part of the beam, with its velocity ẇ relative to the hub, that is
/// −β M v. Stiffness-proportional: the material of Kelvin and Voigt, stress E (ε + η ε̇) in every fibre; −η K v in a
/// linear coupling. A mode of angular frequency ω then has the damping ratio ζ = β/(2ω) + ηω/2.
///
/// In the exact coupling the masses move without their sections' rotary inertia: β acts on translation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Damping {
    /// β \[1/s\]
    pub mass: f64,
    /// η \[s\]
    pub stiffness: f64,
}

impl Damping {
    /// Whether there is no damping.
    pub fn is_none(&self) -> bool {
        self.mass == 0.0 && self.stiffness == 0.0
    }
}
