//! The second variation of the strain energy of an element.
//!
//! At a quadrature point all is written in nine variations: δr′ and δr″, first along t, n, b and then along fixed axes, then
//! δΘ, δε and δκ₁. The derivatives of the forces on them are rows over the variables of the strains, and are summed in the same
//! way as the forces themselves. With m₂, m₃ the moments, F = m₂ δκ₂ + m₃ δκ₃ as a row, c = m₂κ₂ + m₃κ₃,
//! and ω = m₂κ₃ − m₃κ₂, differentiation of the variations in [`super::strain`] gives, by
//! δt = (n n·δr′ + b b·δr′)/|r′|, δn = δΘ b − t n·δr′/|r′|, δb = −δΘ n − t b·δr′/|r′|, a 7 × 7 matrix of few entries, and
//! ω times the variation of δΘ itself: that of the vectors c of the pairs.

use super::shapes::{POINTS, Point, Shapes};
use super::strain::{
    ENDS, Forces, Linear, Local, Section, Sections, Stiffness, Stress, VARIABLES, combined, shares,
};
use super::triad::Triad;
use crate::linalg::vector::inner;
use crate::linalg::{Mat3, Vec3};

/// A force's derivative by the variables of the strains.
type Row = [f64; VARIABLES];

impl Linear for Row {
    const ZERO: Row = [0.0; VARIABLES];

    #[inline(always)]
    fn add(&mut self, c: f64, x: &Row) {
        for k in 0..VARIABLES {
            self[k] += c * x[k];
        }
    }
}

/// Numbers of the variations at a point: those of r′ and r″, then Θ, ε, κ₁.
const SLOPE: usize = 0;
const CURVATURE: usize = 3;
const SPIN: usize = 6;
const AXIAL: usize = 7;
const TORSION: usize = 8;
const LOCAL: usize = 9;

/// δκ₂ and δκ₃ of the variations of r′ and r″ along t, n, b and of Θ.
#[inline(always)]
fn bending(section: &Section) -> [[f64; LOCAL]; 2] {
    let [_, _, k2, k3] = section.strain;
    let (inverse, mu) = (1.0 / section.triad.length, section.along);
    let (mut second, mut third) = ([0.0; LOCAL], [0.0; LOCAL]);
    (second[SLOPE], second[SLOPE + 2]) = (-k2 * inverse, mu * inverse);
    (second[CURVATURE + 2], second[SPIN]) = (-inverse, k3);
    (third[SLOPE], third[SLOPE + 1]) = (-k3 * inverse, -mu * inverse);
    (third[CURVATURE + 1], third[SPIN]) = (inverse, -k2);
    [second, third]
}

/// The derivative of the forces on the nine variations, along t, n, b: that of the stress, γᵀ C γ, and that of the
/// variations of the strains.
#[inline(always)]
fn along_axes(
    section: &Section,
    stress: [f64; 4],
    stiffness: &Stiffness,
    weight: f64,
) -> [[f64; LOCAL]; LOCAL] {
    let [second, third] = bending(section);
    let mut out = [[0.0; LOCAL]; LOCAL];
    let mut products = [[0.0; LOCAL]; 4];
    for (row, c) in products.iter_mut().zip(&stiffness.0) {
        for k in 0..LOCAL {
            row[k] = weight * (c[2] * second[k] + c[3] * third[k]);
        }
        (row[AXIAL], row[TORSION]) = (weight * c[0], weight * c[1]);
    }
    (out[AXIAL], out[TORSION]) = (products[0], products[1]);
    for i in 0..AXIAL {
        for k in 0..LOCAL {
            out[i][k] = second[i] * products[2][k] + third[i] * products[3][k];
        }
    }
    let [_, _, m2, m3] = stress;
    let [_, _, k2, k3] = section.strain;
    let (inverse, mu) = (1.0 / section.triad.length, section.along);
    let (spin, work) = (m2 * k3 - m3 * k2, m2 * k2 + m3 * k3);
    let (t, n, b) = (SLOPE, SLOPE + 1, SLOPE + 2);
    let (kt, kn, kb) = (CURVATURE, CURVATURE + 1, CURVATURE + 2);
    // δμ of r′ and the part of r″ along t.
    let along = [-mu * inverse, k3 * inverse, -k2 * inverse, inverse];
    for k in 0..4 {
        out[n][k] -= m3 * inverse * along[k];
        out[b][k] += m2 * inverse * along[k];
    }
    for k in 0..AXIAL {
        let force = inverse * (m2 * second[k] + m3 * third[k]);
        out[t][k] -= force;
        out[k][t] -= force;
        out[SPIN][k] += m2 * third[k] - m3 * second[k];
    }
    let square = inverse * inverse;
    out[t][n] += mu * m3 * square;
    out[t][b] -= mu * m2 * square;
    out[n][n] -= work * square;
    out[b][b] -= work * square;
    out[n][SPIN] -= mu * m2 * inverse;
    out[b][SPIN] -= mu * m3 * inverse;
    out[kt][n] -= m3 * square;
    out[kt][b] += m2 * square;
    out[kn][SPIN] += m2 * inverse;
    out[kb][SPIN] += m3 * inverse;
    out[SPIN][t] += spin * inverse;
    out
}

/// The same along fixed axes: rows and columns of r′ and r″ multiplied by Λ.
#[inline(always)]
fn along_fixed_axes(triad: &Triad, mut matrix: [[f64; LOCAL]; LOCAL]) -> [[f64; LOCAL]; LOCAL] {
    for at in [SLOPE, CURVATURE] {
        for row in &mut matrix {
            triad.outward(Vec3::at(row, at)).put(row, at);
        }
    }
    let mut out = matrix;
    for at in [SLOPE, CURVATURE] {
        for k in 0..LOCAL {
            let turned = triad.outward(Vec3([matrix[at][k], matrix[at + 1][k], matrix[at + 2][k]]));
            for i in 0..3 {
                out[at + i][k] = turned[i];
            }
        }
    }
    out
}

/// Variations of the samples of ε̄ and of the angles of the pairs, as rows.
struct Rows {
    samples: [Row; 3],
    angles: [Row; 3],
}

impl Rows {
    fn new(shapes: &Shapes, sections: &Sections) -> Rows {
        let (mut samples, mut angles) = ([Row::ZERO; 3], [Row::ZERO; 3]);
        let parts = shares(shapes);
        for (i, row) in samples.iter_mut().enumerate() {
            add_vector(row, &parts[i], sections.triads[i].tangent);
        }
        for ((row, pair), [a, b]) in angles.iter_mut().zip(&sections.pairs).zip(ENDS) {
            row[9 + a] -= 1.0;
            row[9 + b] += 1.0;
            for i in [a, b] {
                add_vector(row, &parts[i], 1.0 / sections.triads[i].length * pair.c);
            }
        }
        let mut rows = Rows { samples, angles };
        for i in 0..3 {
            let winding = rows.winding(shapes, i);
            rows.samples[i].add(sections.lever(i), &winding);
        }
        rows
    }

    /// δκ₁ of the section `i`.
    #[inline(always)]
    fn winding(&self, shapes: &Shapes, i: usize) -> Row {
        let mut row = Row::ZERO;
        (0..3).for_each(|j| row.add(shapes.windings[i][j], &self.angles[j]));
        row
    }

    /// δΘ, δε̄, δκ₁ at a point.
    #[inline(always)]
    fn at(&self, at: &Point, shapes: &Shapes, middle: &Triad, section: &Section) -> [Row; 3] {
        let [mut spin, mut axial, mut torsion] = [Row::ZERO; 3];
        for k in 0..3 {
            axial.add(at.sample[k], &self.samples[k]);
            torsion.add(at.torsion[k], &self.angles[k]);
        }
        spin[10] = 1.0;
        spin.add(-at.sample[0], &self.angles[0]);
        spin.add(at.sample[2], &self.angles[1]);
        let (here, there) = (-1.0 / section.triad.length, -1.0 / middle.length);
        let parts = std::array::from_fn(|i| there * shapes.middle[i] + here * at.slope[i]);
        add_vector(&mut spin, &parts, section.pair.c);
        [spin, axial, torsion]
    }
}

/// row += n ⊗ x on (r₂ − r₁, r′₁, r′₂)
#[inline(always)]
fn add_vector(row: &mut Row, n: &[f64; 3], x: Vec3) {
    for i in 0..3 {
        for k in 0..3 {
            row[3 * i + k] += n[i] * x[k];
        }
    }
}

/// rows += block · (n ⊗ 1) on (r₂ − r₁, r′₁, r′₂)
#[inline(always)]
fn add_block(rows: &mut [Row; 3], block: &Mat3, n: &[f64; 3]) {
    for k in 0..3 {
        add_vector(&mut rows[k], n, Vec3(block.0[k]));
    }
}

/// Rates of the strains (ε̄, κ₁, κ₂, κ₃) at the quadrature points, and of the parts of ε̄ and κ₁ that vanish there, for the rates
/// `u` of the variables.
pub(super) fn rates(
    shapes: &Shapes,
    sections: &Sections,
    points: &[Section; POINTS],
    u: &Row,
) -> ([[f64; 4]; POINTS], [f64; 2]) {
    let rows = Rows::new(shapes, sections);
    let chord = [0, 3, 6].map(|at| Vec3::at(u, at));
    let rates = std::array::from_fn(|k| {
        let (at, section) = (&shapes.points[k], &points[k]);
        let [spin, axial, torsion] =
            rows.at(at, shapes, &sections.triads[1], section).map(|row| inner(row, *u));
        let Vec3([t, n, b]) = section.triad.inward(combined(&at.slope, &chord));
        let Vec3([kt, kn, kb]) = section.triad.inward(combined(&at.curvature, &chord));
        let local = [t, n, b, kt, kn, kb, spin, axial, torsion];
        let [second, third] = bending(section).map(|row| inner(row, local));
        [axial, torsion, second, third]
    });
    let (mut axial, mut torsion) = (0.0, 0.0);
    for k in 0..3 {
        axial += shapes.rest.sample[k] * inner(rows.samples[k], *u);
        torsion += shapes.rest.torsion[k] * inner(rows.angles[k], *u);
    }
    (rates, [axial, torsion])
}

/// The derivative of the forces of stresses on the variables of the strains: `weights[0]` times that of the stresses as they are,
/// and `weights[1]` times that by the stiffness at the points and in the middle.
pub(super) fn tangent(
    shapes: &Shapes,
    (stiffness, middle): (&[Stiffness; POINTS], &Stiffness),
    stress: &Stress,
    (sections, points): (&Sections, &[Section; POINTS]),
    weights: [f64; 2],
) -> [Row; VARIABLES] {
    let [weight, material] = weights;
    let rows = Rows::new(shapes, sections);
    let Sections { triads, pairs, .. } = sections;
    let (mut forces, mut changes) = (Forces::<f64>::ZERO, Forces::<Row>::ZERO);
    for (k, (at, section)) in shapes.points.iter().zip(points).enumerate() {
        let stress = stress.points[k].map(|x| weight * x);
        let force = section.forces(stress);
        forces.add(at, section, &triads[1], &force);
        let matrix = along_axes(section, stress, &stiffness[k], material * at.weight);
        let matrix = along_fixed_axes(&section.triad, matrix);
        let scalars = rows.at(at, shapes, &triads[1], section);
        let mut m = [Row::ZERO; LOCAL];
        for (out, row) in m.iter_mut().zip(&matrix) {
            for i in 0..3 {
                out.add(row[SPIN + i], &scalars[i]);
            }
            add_vector(out, &at.slope, Vec3::at(row, SLOPE));
            add_vector(out, &at.curvature, Vec3::at(row, CURVATURE));
        }
        let mut slope = [m[0], m[1], m[2]];
        // c of the middle and the point, on which the moment −ω acts.
        let [middle, here] = section.pair.second(&triads[1], &section.triad, -force.spin);
        let mut on_middle = [Row::ZERO; 3];
        add_block(&mut on_middle, &middle[0], &shapes.middle);
        add_block(&mut on_middle, &middle[1], &at.slope);
        add_block(&mut slope, &here[0], &shapes.middle);
        add_block(&mut slope, &here[1], &at.slope);
        let change = Local { slope, curvature: [m[3], m[4], m[5]], spin: m[6], axial: m[7], torsion: m[8] };
        changes.add(at, section, &triads[1], &change);
        changes.add_middle(&on_middle);
    }
    let mut scalars = [Row::ZERO; 2];
    for k in 0..3 {
        scalars[0].add(shapes.rest.sample[k], &rows.samples[k]);
        scalars[1].add(shapes.rest.torsion[k], &rows.angles[k]);
    }
    let (c, [axial, torsion]) = (&middle.0, stress.rest.map(|x| weight * x));
    forces.add_sampled(&shapes.rest, &axial, &torsion);
    let mut change = [Row::ZERO; 2];
    for i in 0..2 {
        (0..2).for_each(|j| change[i].add(material * shapes.rest.weight * c[i][j], &scalars[j]));
    }
    changes.add_sampled(&shapes.rest, &change[0], &change[1]);
    let (samples, angles) = forces.of_samples_and_angles(shapes, sections);
    // N K² (δκ₁)²
    let windings = std::array::from_fn(|i| {
        let mut row = Row::ZERO;
        row.add(samples[i] * sections.polar[i], &rows.winding(shapes, i));
        row
    });
    changes.add_windings(shapes, &windings);
    let mut out = changes.total(shapes, sections);
    // The derivatives of t and c at the sections, by r′ at the sections.
    let mut blocks = [[Mat3::ZERO; 3]; 3];
    for ((pair, ends), force) in pairs.iter().zip(ENDS).zip(angles) {
        let second = pair.second(&triads[ends[0]], &triads[ends[1]], force);
        for (i, row) in ends.into_iter().zip(second) {
            for (j, block) in ends.into_iter().zip(row) {
                (0..9).for_each(|k| blocks[i][j][k / 3][k % 3] += block[k / 3][k % 3]);
            }
        }
    }
    for i in 0..3 {
        let (t, scale) = (triads[i].tangent, samples[i] / triads[i].length);
        for k in 0..3 {
            blocks[i][i][k][k] += scale;
            (0..3).for_each(|l| blocks[i][i][k][l] -= scale * t[k] * t[l]);
        }
    }
    let parts = shares(shapes);
    for i in 0..3 {
        let mut rows = [Row::ZERO; 3];
        for j in 0..3 {
            add_block(&mut rows, &blocks[i][j], &parts[j]);
        }
        for part in (0..3).filter(|part| parts[i][*part] != 0.0) {
            (0..3).for_each(|k| out[3 * part + k].add(parts[i][part], &rows[k]));
        }
    }
    out
}
