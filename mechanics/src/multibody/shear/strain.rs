//! Strains of an element and the forces of its strain energy.
//!
//! All sections are seen from the reference section m, in its axes. Node i has the place xᵢ = Λₘᵀ(rᵢ − rₘ) and the rotation
//! vector Θᵢ, exp Θᵢ = Λₘᵀ Λᵢ. With Lagrange's functions, x = Σ Lᵢ xᵢ and Ψ = Σ Lᵢ Θᵢ, the section at s has the axes Λₘ exp Ψ, and
//!
//! ```text
//! Γ = Λᵀ r′ = R(exp Ψ)ᵀ x′,      κ = axial(ΛᵀΛ′) = T(Ψ) Ψ′
//! δxᵢ = Λₘᵀ(δrᵢ − δrₘ) + xᵢ × δφₘ,      δΘᵢ = T(Θᵢ)⁻¹ δφᵢ − T(Θᵢ)⁻ᵀ δφₘ
//! ```
//!
//! where δφ is the rotation of a section in its own axes. The strains are functions of the variables (xᵢ, Θᵢ) of the other nodes,
//! and these are the same whatever the position and orientation of the whole.

use super::rotation_map::RotationMap;
use super::shapes::{NODES, OTHERS, POINTS, Point, REFERENCE};
use crate::linalg::{Mat3, Vec3};
use crate::multibody::rotation::Quaternion;

/// (Γ, κ), or forces and moments (N, M), in the axes of a section.
pub(super) type Strain = [Vec3; 2];
/// A 6 × 6 matrix by blocks.
pub(super) type Blocks = [[Mat3; 2]; 2];
/// Vectors (x, Θ) of the nodes beside the reference section.
pub(super) type Variables = [[Vec3; 2]; POINTS];

/// C e
#[inline(always)]
pub(super) fn product(c: &Blocks, e: &Strain) -> Strain {
    [c[0][0] * e[0] + c[0][1] * e[1], c[1][0] * e[0] + c[1][1] * e[1]]
}

/// The blocks of a matrix by rows.
pub(super) fn blocks(matrix: &[[f64; 6]; 6]) -> Blocks {
    let block = |i: usize, j: usize| Mat3([0, 1, 2].map(|k| Vec3::at(&matrix[3 * i + k], 3 * j).0));
    [[block(0, 0), block(0, 1)], [block(1, 0), block(1, 1)]]
}

/// The sections of an element, seen from the reference section.
#[derive(Clone, Copy, Debug)]
pub(super) struct Relative {
    /// Λₘ
    pub rotation: Mat3,
    /// xᵢ and Θᵢ
    pub variables: Variables,
    /// T(Θᵢ)⁻¹
    pub inverse: [RotationMap; POINTS],
}

/// Rates of what is seen from the reference section.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rates {
    /// Λₘᵀ(ṙᵢ − ṙₘ)
    pub chords: [Vec3; POINTS],
    /// Ωₘ
    pub spin: Vec3,
    /// Ωᵢ
    pub spins: [Vec3; POINTS],
    /// ẋᵢ and Θ̇ᵢ
    pub variables: Variables,
}

impl Relative {
    /// Of the positions and quaternions of the nodes.
    #[inline]
    pub fn new(q: &[f64; 7 * NODES]) -> Relative {
        let (origin, turned) = (Vec3::at(q, 7 * REFERENCE), Quaternion::at(q, 7 * REFERENCE + 3));
        let (rotation, back) = (turned.matrix(), turned.inverse());
        let inward = rotation.transpose();
        let variables = OTHERS.map(|i| {
            let turn = back * Quaternion::at(q, 7 * i + 3);
            [inward * (Vec3::at(q, 7 * i) - origin), turn.logarithm()]
        });
        let inverse = variables.map(|[_, turn]| RotationMap::inverse_tangent(turn));
        Relative { rotation, variables, inverse }
    }

    #[inline]
    pub fn rates(&self, v: &[f64; 6 * NODES]) -> Rates {
        let (velocity, spin) = (Vec3::at(v, 6 * REFERENCE), Vec3::at(v, 6 * REFERENCE + 3));
        let inward = self.rotation.transpose();
        let chords = OTHERS.map(|i| inward * (Vec3::at(v, 6 * i) - velocity));
        let spins = OTHERS.map(|i| Vec3::at(v, 6 * i + 3));
        let variables = std::array::from_fn(|k| {
            let inverse = &self.inverse[k];
            let turn = inverse.apply(spins[k]) - inverse.transposed().apply(spin);
            [chords[k] + self.variables[k][0].cross(spin), turn]
        });
        Rates { chords, spin, spins, variables }
    }

    /// The forces X on x and M on Θ as forces on the nodes in space and moments in the axes of their sections:
    /// Λₘ Xᵢ and T(Θᵢ)⁻ᵀ Mᵢ; −Σ Λₘ Xᵢ and Σ Xᵢ × xᵢ − T(Θᵢ)⁻¹ Mᵢ on the reference section.
    #[inline]
    pub fn nodal(&self, forces: &Variables) -> [[Vec3; 2]; NODES] {
        let mut out = [[Vec3::ZERO; 2]; NODES];
        for (k, i) in OTHERS.into_iter().enumerate() {
            let ([x, _], [force, moment], inverse) = (self.variables[k], forces[k], &self.inverse[k]);
            let there = self.rotation * force;
            out[i] = [there, inverse.transposed().apply(moment)];
            out[REFERENCE][0] -= there;
            out[REFERENCE][1] += force.cross(x) - inverse.apply(moment);
        }
        out
    }
}

/// Σ cᵢ yᵢ of one of both vectors.
#[inline(always)]
fn combined(c: &[f64; POINTS], y: &Variables, which: usize) -> Vec3 {
    let mut out = Vec3::ZERO;
    for k in 0..POINTS {
        out += c[k] * y[k][which];
    }
    out
}

/// (x′, Ψ, Ψ′) of the variables of an element, or their rates.
#[inline(always)]
pub(super) fn interpolated(at: &Point, y: &Variables) -> [Vec3; 3] {
    [combined(&at.slope, y, 0), combined(&at.value, y, 1), combined(&at.slope, y, 1)]
}

/// Adds to the forces on the variables those of forces on (x′, Ψ, Ψ′).
#[inline(always)]
pub(super) fn add_forces(at: &Point, [slope, turn, bend]: [Vec3; 3], out: &mut Variables) {
    for k in 0..POINTS {
        out[k][0] += at.slope[k] * slope;
        out[k][1] += at.value[k] * turn + at.slope[k] * bend;
    }
}

/// A section between the nodes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Section {
    /// R(exp Ψ)ᵀ and T(Ψ)
    pub inward: RotationMap,
    pub tangent: RotationMap,
    /// x′ and Ψ′
    pub slope: Vec3,
    pub bend: Vec3,
}

impl Section {
    #[inline(always)]
    pub fn new(at: &Point, variables: &Variables) -> Section {
        let [slope, turn, bend] = interpolated(at, variables);
        let [inward, tangent] = RotationMap::inverse_rotation_and_tangent(turn);
        Section { inward, tangent, slope, bend }
    }

    /// Γ and κ, those without stress included.
    #[inline(always)]
    pub fn strain(&self) -> Strain {
        [self.inward.apply(self.slope), self.tangent.apply(self.bend)]
    }

    /// The forces on (x′, Ψ, Ψ′) of the stress resultants N and M.
    #[inline(always)]
    pub fn forces(&self, [force, moment]: Strain) -> [Vec3; 3] {
        let turn = self.inward.gradient(force, self.slope) + self.tangent.gradient(moment, self.bend);
        [self.inward.transposed().apply(force), turn, self.tangent.transposed().apply(moment)]
    }

    /// The rates of Γ and κ for the rates of (x′, Ψ, Ψ′).
    #[inline(always)]
    pub fn rate(&self, [slope, turn, bend]: [Vec3; 3]) -> Strain {
        let of_slope = self.inward.apply(slope) + self.inward.derivative(self.slope) * turn;
        [of_slope, self.tangent.apply(bend) + self.tangent.derivative(self.bend) * turn]
    }
}
