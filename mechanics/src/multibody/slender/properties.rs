//! Stiffness and inertia of a section of a slender beam.

use crate::section::BladeResultants;

/// Stiffness and inertia per length of a section, in its axes [t, n, b]. The centreline goes through the centres of mass,
/// and n and b are principal axes of the section's inertia.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Properties {
    /// C, symmetric and positive definite: (N, M₁, M₂, M₃) = C (ε, κ₁, κ₂, κ₃) with M₁ the torque about t, M₂ and M₃ the
    /// bending moments about n and b. Entries \[N\], [N·m] and [N·m²]. A tension centre off the axis at (y, z) along n and
    /// b couples ε with κ₂ by EA z and with κ₃ by −EA y.
    pub stiffness: [[f64; 4]; 4],
    /// Mass per length ρA [kg/m].
    pub mass: f64,
    /// Moments of inertia per length about t, n, b [kg·m]. The first must be positive, or the twist has no inertia; the
    /// others may be 0 where rotary inertia is left out.
    pub inertia: [f64; 3],
}

impl Properties {
    /// A section whose axes are principal: C = diag(EA, GJ, EI₂, EI₃), with I₂ = ∫z² dA and I₃ = ∫y² dA for the places
    /// (y, z) along n and b; ρA, and the moments of inertia about t, n, b.
    pub fn principal(stiffness: [f64; 4], mass: f64, inertia: [f64; 3]) -> Properties {
        let mut matrix = [[0.0; 4]; 4];
        for (k, c) in stiffness.into_iter().enumerate() {
            matrix[k][k] = c;
        }
        Properties { stiffness: matrix, mass, inertia }
    }

    /// The section rotated by `angle` about t against the axes [t, n, b], so that a beam with a pretwist need not twist
    /// its axes: C and ρI of the section in the axes of the beam. The moments of inertia about n and b must be equal or
    /// zero where the angle is not zero: their product of inertia is left out.
    pub fn rolled(self, angle: f64) -> Properties {
        let (sin, cos) = libm::sincos(angle);
        let q = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, cos, sin], [0.0, 0.0, -sin, cos]];
        let product = |a: usize, b: usize| -> f64 {
            (0..4).map(|i| (0..4).map(|j| q[i][a] * self.stiffness[i][j] * q[j][b]).sum::<f64>()).sum()
        };
        Properties { stiffness: std::array::from_fn(|a| std::array::from_fn(|b| product(a, b))), ..self }
    }
}

/// The section of a blade with n along its chord and b normal to it; its twist is not applied.
impl From<&BladeResultants> for Properties {
    fn from(r: &BladeResultants) -> Properties {
        let stiffness = [r.axial_stiffness, r.torsional_stiffness, r.flap_stiffness, r.chord_stiffness];
        let inertia = [r.flap_inertia + r.chord_inertia, r.flap_inertia, r.chord_inertia];
        Properties::principal(stiffness, r.mass, inertia)
    }
}
