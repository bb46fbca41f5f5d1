//! Stiffness and inertia of a section of a slender beam.

use crate::section::{BladeResultants, Matrices};

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

    /// The section whose axis of no bending under tension, the tension centre, is at the place (y, z) \[m\] along n and b of the
    /// centreline, and whose bending stiffnesses are about axes through it: with the strain ε − y κ₃ + z κ₂ there,
    /// N = EA (ε − y κ₃ + z κ₂), M₂ = EI₂ κ₂ + z N and M₃ = EI₃ κ₃ − y N.
    #[must_use]
    pub fn with_tension_centre(mut self, [y, z]: [f64; 2]) -> Properties {
        let (arm, axial) = ([1.0, 0.0, z, -y], self.stiffness[0][0]);
        for i in 0..4 {
            for j in (0..4).filter(|j| (i, *j) != (0, 0)) {
                self.stiffness[i][j] += axial * arm[i] * arm[j];
            }
        }
        self
    }

    /// The section with the stiffnesses \[N·m²\] by which torsion and bending about n, torsion and bending about b, and the two
    /// bendings are coupled: they are added to C₁₂, C₁₃ and C₂₃ (and C₂₁ …), counted from 0.
    #[must_use]
    pub fn with_coupling(mut self, coupling: [f64; 3]) -> Properties {
        for ([i, j], c) in [[1, 2], [1, 3], [2, 3]].into_iter().zip(coupling) {
            self.stiffness[i][j] += c;
            self.stiffness[j][i] += c;
        }
        self
    }

    /// The section with its torsion held: nothing couples it and GJ = 100 (EI₂ + EI₃). Where rotary inertia is left out in bending, so it is
    /// about t but for a ten thousandth of ρA (EI₂ + EI₃)/EA: torsion is a thousand times as fast as axial vibration.
    #[must_use]
    pub fn without_torsion(mut self) -> Properties {
        let bending = self.stiffness[2][2] + self.stiffness[3][3];
        for k in 0..4 {
            (self.stiffness[1][k], self.stiffness[k][1]) = (0.0, 0.0);
        }
        self.stiffness[1][1] = 100.0 * bending;
        if self.inertia[1..] == [0.0; 2] {
            self.inertia[0] = 1e-4 * self.mass * bending / self.stiffness[0][0];
        }
        self
    }

    /// The section rotated by `angle` about t against the axes [t, n, b], so that a beam with a pretwist need not twist
    /// its axes: C and ρI of the section in the axes of the beam, and fibres along them, which tension does not untwist. The moments of inertia about n and b must be equal or
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

/// The section at zero shear force. Its centre of mass is put on the axis, with the moments of inertia about it.
impl From<&Matrices> for Properties {
    fn from(of: &Matrices) -> Properties {
        Properties { stiffness: of.condensed(), mass: of.mass[0][0], inertia: of.central_inertia() }
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
