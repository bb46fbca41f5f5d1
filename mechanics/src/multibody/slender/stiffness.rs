//! The second variation of the strain energy of an element.
//!
//! At a quadrature point all is written in nine variations: the components along t, n, b of δr′ and of δr″, then δΘ, δε and
//! δκ₁. Each is a row over the unknowns of the element. With m₂, m₃ the moments, F = m₂ δκ₂ + m₃ δκ₃ as a row, c = m₂κ₂ + m₃κ₃,
//! and ω = m₂κ₃ − m₃κ₂, differentiation of the variations in [`super::strain`] gives, by
//! δt = (n n·δr′ + b b·δr′)/|r′|, δn = δΘ b − t n·δr′/|r′|, δb = −δΘ n − t b·δr′/|r′|, a 7 × 7 matrix of few entries, and
//! ω times the variation of δΘ itself: that of the vectors c of the pairs.

use super::element::Stiffness;
use super::pair::Block;
use super::shapes::{POINTS, Point, Shapes};
use super::strain::{CENTRELINE, ENDS, Forces, SPINS, Section, Sections};
use super::triad::{Vector, times};

/// Unknowns of an element, and one more place that stays zero.
const WIDTH: usize = 16;
/// A linear form on the variations of an element's unknowns.
type Row = [f64; WIDTH];
/// Matrix of an element; the last column is not used.
pub(super) type Tangent = [Row; 15];

/// Numbers of the variations at a point: those of r′ and r″ along t, n, b, then Θ, ε, κ₁.
const SLOPE: usize = 0;
const CURVATURE: usize = 3;
const SPIN: usize = 6;
const AXIAL: usize = 7;
const TORSION: usize = 8;
const LOCAL: usize = 9;

/// row += n ⊗ x
#[inline(always)]
fn spread(row: &mut Row, n: &[f64; 4], x: Vector) {
    for i in 0..4 {
        for k in 0..3 {
            row[CENTRELINE[i] + k] += n[i] * x[k];
        }
    }
}

/// row += c other
#[inline(always)]
fn add(row: &mut Row, c: f64, other: &Row) {
    for k in 0..WIDTH {
        row[k] += c * other[k];
    }
}

/// N′ at the sections: of r′₁, r′ₘ, r′₂ by the centreline's unknowns.
fn slopes(shapes: &Shapes) -> [[f64; 4]; 3] {
    [[0.0, 1.0, 0.0, 0.0], shapes.middle, [0.0, 0.0, 0.0, 1.0]]
}

/// δκ₂ and δκ₃ of the seven variations of r′, r″ and Θ; δε and δκ₁ are variations themselves.
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

/// The matrix of the nine variations: that of the material, γᵀ C γ, and that of the moments.
#[inline(always)]
fn local(
    section: &Section,
    stress: [f64; 4],
    stiffness: &[[f64; 4]; 4],
    weight: f64,
) -> [[f64; LOCAL]; LOCAL] {
    let [second, third] = bending(section);
    let mut rows = [[0.0; LOCAL], [0.0; LOCAL], second, third];
    (rows[0][AXIAL], rows[1][TORSION]) = (1.0, 1.0);
    let mut out = [[0.0; LOCAL]; LOCAL];
    for a in 0..4 {
        let mut product = [0.0; LOCAL];
        for b in 0..4 {
            let c = weight * stiffness[a][b];
            for k in 0..LOCAL {
                product[k] += c * rows[b][k];
            }
        }
        for i in 0..LOCAL {
            for k in 0..LOCAL {
                out[i][k] += rows[a][i] * product[k];
            }
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
    for k in 0..SPIN + 1 {
        let force = m2 * second[k] + m3 * third[k];
        out[t][k] -= inverse * force;
        out[k][t] -= inverse * force;
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

/// Rows that all quadrature points share.
struct Rows {
    /// δε at the three sections.
    samples: [Row; 3],
    /// δφ of the three pairs.
    angles: [Row; 3],
}

impl Rows {
    fn new(shapes: &Shapes, sections: &Sections) -> Rows {
        let (mut samples, mut angles) = ([[0.0; WIDTH]; 3], [[0.0; WIDTH]; 3]);
        let slopes = slopes(shapes);
        for (i, row) in samples.iter_mut().enumerate() {
            spread(row, &slopes[i], sections.triads[i].tangent);
        }
        for ((row, pair), [a, b]) in angles.iter_mut().zip(&sections.pairs).zip(ENDS) {
            row[SPINS[a]] -= 1.0;
            row[SPINS[b]] += 1.0;
            for i in [a, b] {
                spread(row, &slopes[i], times(1.0 / sections.triads[i].length, pair.c));
            }
        }
        Rows { samples, angles }
    }

    /// The nine rows at a quadrature point.
    #[inline(always)]
    fn at(&self, at: &Point, middle: &[f64; 4], length: f64, section: &Section) -> [Row; LOCAL] {
        let mut rows = [[0.0; WIDTH]; LOCAL];
        let triad = &section.triad;
        for (k, axis) in [triad.tangent, triad.normal, triad.binormal].into_iter().enumerate() {
            spread(&mut rows[SLOPE + k], &at.slope, axis);
            spread(&mut rows[CURVATURE + k], &at.curvature, axis);
        }
        for k in 0..3 {
            add(&mut rows[AXIAL], at.sample[k], &self.samples[k]);
            add(&mut rows[TORSION], at.torsion[k], &self.angles[k]);
        }
        let spin = &mut rows[SPIN];
        spin[SPINS[1]] = 1.0;
        add(spin, -at.sample[0], &self.angles[0]);
        add(spin, at.sample[2], &self.angles[1]);
        spread(spin, middle, times(-1.0 / length, section.pair.c));
        spread(spin, &at.slope, times(-1.0 / triad.length, section.pair.c));
        rows
    }
}

/// out += (m ⊗ n) ⊗ block on the centreline's unknowns.
#[inline(always)]
fn spread_block(out: &mut Tangent, m: &[f64; 4], n: &[f64; 4], block: &Block) {
    for i in 0..4 {
        for j in 0..4 {
            let weight = m[i] * n[j];
            for k in 0..3 {
                for l in 0..3 {
                    out[CENTRELINE[i] + k][CENTRELINE[j] + l] += weight * block[k][l];
                }
            }
        }
    }
}

/// Adds `weight` times the derivative of the forces of the strain energy to `out`.
pub(super) fn add_tangent(
    shapes: &Shapes,
    stiffness: &[Stiffness; POINTS],
    initial: &[[f64; 4]; POINTS],
    sections: &Sections,
    weight: f64,
    out: &mut Tangent,
) {
    let rows = Rows::new(shapes, sections);
    let triads = &sections.triads;
    let mut forces = Forces::default();
    for ((at, stiffness), initial) in shapes.points.iter().zip(stiffness).zip(initial) {
        let section = Section::new(at, sections);
        let scale = weight * at.weight;
        let stress = stiffness.stress(&section.strain, initial, scale);
        forces.add(at, &section, stress);
        let matrix = local(&section, stress, &stiffness.0, scale);
        let rows = rows.at(at, &shapes.middle, triads[1].length, &section);
        for i in 0..LOCAL {
            let mut product = [0.0; WIDTH];
            for k in 0..LOCAL {
                add(&mut product, matrix[i][k], &rows[k]);
            }
            for k in 0..15 {
                add(&mut out[k], rows[i][k], &product);
            }
        }
        let [_, _, m2, m3] = stress;
        let [_, _, k2, k3] = section.strain;
        let blocks = section.pair.second(&triads[1], &section.triad, m3 * k2 - m2 * k3);
        let slopes = [&shapes.middle, &at.slope];
        for i in 0..2 {
            for j in 0..2 {
                spread_block(out, slopes[i], slopes[j], &blocks[i][j]);
            }
        }
    }
    let slopes = slopes(shapes);
    for ((pair, [a, b]), force) in sections.pairs.iter().zip(ENDS).zip(forces.angles) {
        let blocks = pair.second(&triads[a], &triads[b], force);
        for (i, row) in [a, b].into_iter().zip(blocks) {
            for (j, block) in [a, b].into_iter().zip(row) {
                spread_block(out, &slopes[i], &slopes[j], &block);
            }
        }
    }
    for i in 0..3 {
        let (t, scale) = (triads[i].tangent, forces.samples[i] / triads[i].length);
        let block = std::array::from_fn(|k| {
            std::array::from_fn(|l| scale * (f64::from(u8::from(k == l)) - t[k] * t[l]))
        });
        spread_block(out, &slopes[i], &slopes[i], &block);
    }
}
