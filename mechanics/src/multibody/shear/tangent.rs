//! The derivative of the forces of an element.
//!
//! At a quadrature point the strains e = (Γ, κ) are functions of y = (x′, Ψ, Ψ′), and with the stress σ = C (e − e₀) + D ė
//!
//! ```text
//! ∂(Jᵀσ)/∂y = Jᵀ C J + Σ σₖ ∂²eₖ/∂y² + Jᵀ D ∂(J ẏ)/∂y,      J = ∂e/∂y
//! ```
//!
//! which is summed to a matrix K of the variables (xᵢ, Θᵢ) of the nodes beside the reference section. With forces X and M on
//! them, S = T(Θ)⁻¹ and nodal displacements δρ = Λₘᵀδr, the derivative of the nodal forces is that of `Relative::nodal`:
//!
//! ```text
//! δρᵢ:   δXᵢ + δφₘ × Xᵢ                       δφᵢ:   Sᵢᵀ δMᵢ + ∂(SᵢᵀMᵢ)/∂Θᵢ δΘᵢ
//! δρₘ:   −Σ (δXᵢ + δφₘ × Xᵢ)                  δφₘ:   Σ δXᵢ × xᵢ + Xᵢ × δxᵢ − Sᵢ δMᵢ − ∂(SᵢMᵢ)/∂Θᵢ δΘᵢ
//! ```
//!
//! The rates of the variables depend on the configuration too: δẋᵢ = Λₘᵀ(ṙᵢ − ṙₘ) × δφₘ − Ωₘ × δxᵢ and
//! δΘ̇ᵢ = (∂(SᵢΩᵢ)/∂Θᵢ − ∂(SᵢᵀΩₘ)/∂Θᵢ) δΘᵢ.

use super::shapes::{NODES, OTHERS, POINTS, Point, REFERENCE};
use super::strain::{Blocks, Rates, Relative, Section, Strain, Variables};
use crate::linalg::{Mat3, Vec3};

/// J, or C J: rows Γ and κ, columns x′, Ψ and Ψ′.
type Jacobian = [[Mat3; 3]; 2];
/// A matrix of the variables.
type Reduced = [[Blocks; POINTS]; POINTS];
/// A matrix of the nodes: by rows and columns the displacement and the rotation of each.
pub(super) type Nodal = [[Blocks; NODES]; NODES];

const ZERO: Blocks = [[Mat3::ZERO; 2]; 2];

#[inline(always)]
fn add(out: &mut Mat3, x: Mat3) {
    *out = *out + x;
}

/// −A
#[inline(always)]
fn negative(a: Mat3) -> Mat3 {
    -1.0 * a
}

impl Section {
    /// J
    #[inline(always)]
    fn jacobian(&self) -> Jacobian {
        [
            [self.inward.matrix(), self.inward.derivative(self.slope), Mat3::ZERO],
            [Mat3::ZERO, self.tangent.derivative(self.bend), self.tangent.matrix()],
        ]
    }

    /// Σ σₖ ∂²eₖ/∂y²
    #[inline(always)]
    fn add_geometric(&self, [force, moment]: Strain, out: &mut [[Mat3; 3]; 3]) {
        let slope = self.inward.transposed().derivative(force);
        let bend = self.tangent.transposed().derivative(moment);
        add(&mut out[0][1], slope);
        add(&mut out[1][0], slope.transpose());
        add(&mut out[2][1], bend);
        add(&mut out[1][2], bend.transpose());
        add(&mut out[1][1], self.inward.hessian(force, self.slope) + self.tangent.hessian(moment, self.bend));
    }

    /// ∂(J ẏ)/∂y at given ẏ: the rows of Γ and κ are the second derivatives of their components, times ẏ.
    fn change_of_rates(&self, [slope, turn, bend]: [Vec3; 3]) -> Jacobian {
        let mut out = [[Mat3::ZERO; 3]; 2];
        for (k, axis) in Vec3::AXES.into_iter().enumerate() {
            let of_slope = self.inward.transposed().derivative(axis);
            let of_bend = self.tangent.transposed().derivative(axis);
            out[0][0][k] = (of_slope * turn).0;
            out[0][1][k] = (of_slope.transpose() * slope + self.inward.hessian(axis, self.slope) * turn).0;
            out[1][2][k] = (of_bend * turn).0;
            out[1][1][k] = (of_bend.transpose() * bend + self.tangent.hessian(axis, self.bend) * turn).0;
        }
        out
    }
}

/// weight · C J
#[inline(always)]
fn weighted(weight: f64, c: &Blocks, j: &Jacobian) -> Jacobian {
    [0, 1].map(|i| {
        let [first, second] = [weight * c[i][0], weight * c[i][1]];
        [first * j[0][0], first * j[0][1] + second * j[1][1], second * j[1][2]]
    })
}

/// Jᵀ P
#[inline(always)]
fn congruent(j: &Jacobian, p: &Jacobian) -> [[Mat3; 3]; 3] {
    let [slope, turn, curved, bend] =
        [j[0][0].transpose(), j[0][1].transpose(), j[1][1].transpose(), j[1][2].transpose()];
    [
        [0, 1, 2].map(|k| slope * p[0][k]),
        [0, 1, 2].map(|k| turn * p[0][k] + curved * p[1][k]),
        [0, 1, 2].map(|k| bend * p[1][k]),
    ]
}

/// Adds a matrix of (x′, Ψ, Ψ′) to that of the variables.
#[inline(always)]
fn add_point(at: &Point, matrix: &[[Mat3; 3]; 3], out: &mut Reduced) {
    for j in 0..POINTS {
        let (value, slope) = (at.value[j], at.slope[j]);
        let columns = [0, 1, 2].map(|row: usize| {
            let of = &matrix[row];
            [slope * of[0], value * of[1] + slope * of[2]]
        });
        for i in 0..POINTS {
            let (value, slope) = (at.value[i], at.slope[i]);
            for k in 0..2 {
                add(&mut out[i][j][0][k], slope * columns[0][k]);
                add(&mut out[i][j][1][k], value * columns[1][k] + slope * columns[2][k]);
            }
        }
    }
}

/// The points of an element with their sections.
pub(super) type Sections<'a> = (&'a [Point; POINTS], &'a [Section; POINTS]);

/// Σ Bᵀ Jᵀ C J B over the points.
fn material((points, sections): Sections<'_>, c: &[Blocks; POINTS], weight: f64, out: &mut Reduced) {
    for k in 0..POINTS {
        let j = sections[k].jacobian();
        let p = weighted(weight * points[k].weight, &c[k], &j);
        add_point(&points[k], &congruent(&j, &p), out);
    }
}

/// The part of a nodal matrix that is the derivative of X and M.
fn add_changes(relative: &Relative, k: &Reduced, extra: Option<&[[Mat3; 2]; POINTS]>, out: &mut Nodal) {
    let inverse = relative.inverse.map(|map| map.matrix());
    let places = relative.variables.map(|[x, _]| Mat3::skew(x));
    // The derivatives of the forces on the variables by the displacements and rotations of the nodes.
    let mut changes = [[ZERO; NODES]; POINTS];
    for i in 0..POINTS {
        let row = &mut changes[i];
        if let Some(extra) = extra {
            (0..2).for_each(|of| row[REFERENCE][of][1] = extra[i][of]);
        }
        for j in 0..POINTS {
            for of in 0..2 {
                let [place, turn] = k[i][j][of];
                let node = OTHERS[j];
                row[node][of] = [place, turn * inverse[j]];
                add(&mut row[REFERENCE][of][0], negative(place));
                add(&mut row[REFERENCE][of][1], place * places[j] - turn * inverse[j].transpose());
            }
        }
    }
    for i in 0..POINTS {
        let (node, transposed) = (OTHERS[i], inverse[i].transpose());
        for j in 0..NODES {
            for by in 0..2 {
                let [place, turn] = [changes[i][j][0][by], changes[i][j][1][by]];
                add(&mut out[node][j][0][by], place);
                add(&mut out[node][j][1][by], transposed * turn);
                add(&mut out[REFERENCE][j][0][by], negative(place));
                add(&mut out[REFERENCE][j][1][by], negative(places[i] * place + inverse[i] * turn));
            }
        }
    }
}

/// The part of a nodal matrix that is the derivative of the nodal forces at given X and M.
fn add_rotation_of_forces(relative: &Relative, forces: &Variables, weight: f64, out: &mut Nodal) {
    const M: usize = REFERENCE;
    for i in 0..POINTS {
        let (node, map, [x, _]) = (OTHERS[i], &relative.inverse[i], relative.variables[i]);
        let [force, moment] = forces[i].map(|x| weight * x);
        let (arm, inverse) = (Mat3::skew(force), map.matrix());
        let (own, reference) = (map.transposed().derivative(moment), map.derivative(moment));
        let back = inverse.transpose();
        add(&mut out[node][M][0][1], negative(arm));
        add(&mut out[M][M][0][1], arm);
        add(&mut out[node][node][1][1], own * inverse);
        add(&mut out[node][M][1][1], negative(own * back));
        add(&mut out[M][node][1][0], arm);
        add(&mut out[M][M][1][0], negative(arm));
        add(&mut out[M][node][1][1], negative(reference * inverse));
        add(&mut out[M][M][1][1], arm * Mat3::skew(x) + reference * back);
    }
}

/// weight · ∂(forces)/∂q, in nodal displacements along the axes of the reference section, at the forces of the stresses at the
/// points times their weights. `viscous` are D and the rates, where there is damping; without `stiffness` the stresses are kept.
pub(super) fn by_configuration(
    relative: &Relative,
    at: Sections<'_>,
    stiffness: Option<&[Blocks; POINTS]>,
    (stresses, forces): (&[Strain; POINTS], &Variables),
    viscous: Option<(&[Blocks; POINTS], &Rates)>,
    weight: f64,
) -> Nodal {
    let (points, sections) = at;
    let mut reduced = [[ZERO; POINTS]; POINTS];
    for k in 0..POINTS {
        let mut matrix = [[Mat3::ZERO; 3]; 3];
        if let Some(stiffness) = stiffness {
            let j = sections[k].jacobian();
            matrix = congruent(&j, &weighted(weight * points[k].weight, &stiffness[k], &j));
        }
        sections[k].add_geometric(stresses[k].map(|x| weight * x), &mut matrix);
        add_point(&points[k], &matrix, &mut reduced);
    }
    let mut out = [[ZERO; NODES]; NODES];
    if let Some((damping, rates)) = viscous {
        let extra = add_rates(relative, at, damping, rates, weight, &mut reduced);
        add_changes(relative, &reduced, Some(&extra), &mut out);
    } else {
        add_changes(relative, &reduced, None, &mut out);
    }
    add_rotation_of_forces(relative, forces, weight, &mut out);
    out
}

/// weight · ∂(forces)/∂v, in nodal displacements along the axes of the reference section.
pub(super) fn by_velocity(
    relative: &Relative,
    at: Sections<'_>,
    damping: &[Blocks; POINTS],
    weight: f64,
) -> Nodal {
    let mut reduced = [[ZERO; POINTS]; POINTS];
    material(at, damping, weight, &mut reduced);
    let mut out = [[ZERO; NODES]; NODES];
    add_changes(relative, &reduced, None, &mut out);
    out
}

/// Adds the change of the viscous stresses with the configuration at given velocities; returns the forces on the variables by δφₘ
/// alone.
fn add_rates(
    relative: &Relative,
    at: Sections<'_>,
    damping: &[Blocks; POINTS],
    rates: &Rates,
    weight: f64,
    out: &mut Reduced,
) -> [[Mat3; 2]; POINTS] {
    let (points, sections) = at;
    for k in 0..POINTS {
        let (point, section) = (&points[k], &sections[k]);
        let change = section.change_of_rates(super::strain::interpolated(point, &rates.variables));
        let p = weighted(weight * point.weight, &damping[k], &change);
        add_point(point, &congruent(&section.jacobian(), &p), out);
    }
    let mut viscous = [[ZERO; POINTS]; POINTS];
    material(at, damping, weight, &mut viscous);
    let turning = Mat3::skew(-rates.spin);
    let mut extra = [[Mat3::ZERO; 2]; POINTS];
    for j in 0..POINTS {
        let map = &relative.inverse[j];
        let change = map.derivative(rates.spins[j]) - map.transposed().derivative(rates.spin);
        let chord = Mat3::skew(rates.chords[j]);
        for i in 0..POINTS {
            for of in 0..2 {
                let [place, turn] = viscous[i][j][of];
                add(&mut out[i][j][of][0], place * turning);
                add(&mut out[i][j][of][1], turn * change);
                add(&mut extra[i][of], place * chord);
            }
        }
    }
    extra
}
