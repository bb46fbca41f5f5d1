//! Strain energy of an element, its force and its tangent.

use super::{CLAMPED, Element, components};
use crate::hub_beam::rule::{Block, POINTS, Products, Relative, Rule};
use crate::linalg::vector::inner;

/// Strains of an element and the forces they cause.
struct Strains {
    /// Unit tangents at the three samples.
    tangent: [[f64; 2]; 3],
    /// 1/|p′| at the three samples.
    inverse_stretch: [f64; 3],
    /// ε at the three samples, and its work conjugates.
    strain: [f64; 3],
    axial: [f64; 3],
    /// κ at the quadrature points, its first derivatives by X′, Y′, X″, Y″, and its conjugates.
    curvature: [f64; POINTS],
    gradient: [[f64; 4]; POINTS],
    slope: [[f64; 2]; POINTS],
    moment: [f64; POINTS],
}

impl Element {
    /// The work conjugates S e of strains (ε at the samples, κ at the quadrature points).
    pub(super) fn conjugates(&self, rule: &Rule, e: &[f64; 3 + POINTS]) -> [f64; 3 + POINTS] {
        let mut out = [0.0; 3 + POINTS];
        for i in 0..3 {
            out[i] = (0..3).map(|j| self.axial[i][j] * e[j]).sum();
        }
        for (g, p) in rule.points.iter().enumerate() {
            out[3 + g] += self.bending[g] * e[3 + g];
            for i in 0..3 {
                out[i] -= self.coupling[g] * p.l[i] * e[3 + g];
                out[3 + g] -= self.coupling[g] * p.l[i] * e[i];
            }
        }
        out
    }

    #[inline(always)]
    fn strains(&self, rule: &Rule, d: &[f64; 8]) -> Strains {
        // Difference of the displacements of both ends, and the slopes there.
        let [u0, du0, u1, du1, v0, dv0, v1, dv1] = *d;
        let d = [[u1 - u0, v1 - v0], [du0, dv0], [du1, dv1]];
        let [x, y] = combined(rule.middle_relative, d);
        let slopes = [[1.0 + du0, dv0], [1.0 + x, y], [1.0 + du1, dv1]];
        let mut out = Strains {
            tangent: [[0.0; 2]; 3],
            inverse_stretch: [0.0; 3],
            strain: [0.0; 3],
            axial: [0.0; 3],
            curvature: [0.0; POINTS],
            gradient: [[0.0; 4]; POINTS],
            slope: [[0.0; 2]; POINTS],
            moment: [0.0; POINTS],
        };
        for (i, [x, y]) in slopes.into_iter().enumerate() {
            let stretch = (x * x + y * y).sqrt();
            let inverse = 1.0 / stretch;
            out.inverse_stretch[i] = inverse;
            out.tangent[i] = [x * inverse, y * inverse];
            // |p′| − 1 without the cancellation that loses the strain of a slender beam.
            let u = x - 1.0;
            out.strain[i] = (u * (2.0 + u) + y * y) / (stretch + 1.0);
        }
        for i in 0..3 {
            out.axial[i] = (0..3).map(|j| self.axial[i][j] * out.strain[j]).sum();
        }
        for (g, p) in rule.points.iter().enumerate() {
            let [[x1, y1], [x2, y2]] = p.relative.map(|n| combined(n, d));
            let x1 = 1.0 + x1;
            let inverse = 1.0 / (x1 * x1 + y1 * y1);
            let k = (x1 * y2 - y1 * x2) * inverse;
            out.curvature[g] = k;
            out.slope[g] = [x1, y1];
            out.gradient[g] =
                [(y2 - 2.0 * k * x1) * inverse, (-x2 - 2.0 * k * y1) * inverse, -y1 * inverse, x1 * inverse];
            out.moment[g] = self.bending[g] * k;
            if self.has_coupling {
                let es = self.coupling[g];
                for i in 0..3 {
                    out.axial[i] -= es * p.l[i] * k;
                    out.moment[g] -= es * p.l[i] * out.strain[i];
                }
            }
        }
        out
    }

    /// ½ ∫ EA ε̄² − 2 ES ε̄ κ + EI κ² dx.
    pub fn strain_energy(&self, rule: &Rule, d: &[f64; 8]) -> f64 {
        let s = self.strains(rule, d);
        let axial: f64 = s.axial.iter().zip(&s.strain).map(|(n, e)| n * e).sum();
        let bending: f64 = s.moment.iter().zip(&s.curvature).map(|(m, k)| m * k).sum();
        // Both sums hold one half of the coupling term −ES ε̄ κ.
        0.5 * (axial + bending)
    }

    /// Adds ∂U/∂d to `f`.
    #[inline]
    pub fn strain_force(&self, rule: &Rule, d: &[f64; 8], f: &mut [f64; 8]) {
        let s = self.strains(rule, d);
        // On the difference of the displacements of both ends, and on the slopes there.
        let along = s.tangent[1].map(|t| s.axial[1] * t);
        let mut force = rule.middle_relative.map(|n| along.map(|x| x * n));
        for c in 0..2 {
            force[1][c] += s.axial[0] * s.tangent[0][c];
            force[2][c] += s.axial[2] * s.tangent[2][c];
        }
        for (g, p) in rule.points.iter().enumerate() {
            let [n1, n2] = p.relative;
            let [x1, y1, x2, y2] = s.gradient[g].map(|k| k * s.moment[g]);
            let (first, second) = ([x1, y1], [x2, y2]);
            for k in 0..3 {
                for c in 0..2 {
                    force[k][c] += first[c] * n1[k] + second[c] * n2[k];
                }
            }
        }
        let [chord, first, last] = force;
        for c in 0..2 {
            f[4 * c] -= chord[c];
            f[4 * c + 1] += first[c];
            f[4 * c + 2] += chord[c];
            f[4 * c + 3] += last[c];
        }
    }

    /// Adds w ∂²U/∂d² to `out`.
    #[inline]
    pub fn strain_tangent(&self, rule: &Rule, d: &[f64; 8], w: f64, out: &mut [[f64; 8]; 8]) {
        let s = self.strains(rule, d);
        // The blocks ∂²U/∂U∂U, ∂²U/∂U∂V and ∂²U/∂V∂V.
        let mut blocks = [[0.0; 16]; 3];
        self.axial_tangent(rule, &s, w, &mut blocks);
        self.curvature_tangent(rule, &s, w, &mut blocks);
        let [xx, xy, yy] = &blocks;
        for i in 0..4 {
            for j in 0..4 {
                out[i][j] += xx[4 * i + j];
                out[i][4 + j] += xy[4 * i + j];
                out[4 + i][j] += xy[4 * j + i];
                out[4 + i][4 + j] += yy[4 * i + j];
            }
        }
        if self.has_coupling {
            self.coupling_tangent(rule, &s, w, out);
        }
    }

    /// The strain's part: with pᵢ′ the slopes at the samples, U ∋ ½ Σ Aᵢⱼ εᵢ εⱼ and
    /// ∂²U/∂pᵢ′∂pⱼ′ = Aᵢⱼ tᵢ tⱼᵀ + δᵢⱼ Nᵢ nᵢ nᵢᵀ/ℓᵢ.
    #[inline(always)]
    fn axial_tangent(&self, rule: &Rule, s: &Strains, w: f64, [xx, xy, yy]: &mut [Block; 3]) {
        // ∂²U/∂X′∂X′, ∂X′∂Y′, ∂Y′∂X′, ∂Y′∂Y′ of samples i and j.
        let pair = |i: usize, j: usize| {
            let (a, [tx, ty], [ux, uy]) = (w * self.axial[i][j], s.tangent[i], s.tangent[j]);
            let n = if i == j { w * s.axial[i] * s.inverse_stretch[i] } else { 0.0 };
            [
                a * tx * ux + n * ty * uy,
                a * tx * uy - n * tx * ty,
                a * ty * ux - n * tx * ty,
                a * ty * uy + n * tx * ux,
            ]
        };
        // The middle sample depends on all four unknowns of a component,
        let [cxx, cxy, _, cyy] = pair(1, 1);
        for (k, product) in rule.middle_product.iter().enumerate() {
            xx[k] += cxx * product;
            xy[k] += cxy * product;
            yy[k] += cyy * product;
        }
        // the samples at the ends on the slope there alone.
        for (end, slope) in [(0, 1), (2, 3)] {
            let [cxx, cxy, cyx, cyy] = pair(end, 1);
            for (k, n) in rule.middle.iter().enumerate() {
                xx[4 * slope + k] += cxx * n;
                xx[4 * k + slope] += cxx * n;
                xy[4 * slope + k] += cxy * n;
                xy[4 * k + slope] += cyx * n;
                yy[4 * slope + k] += cyy * n;
                yy[4 * k + slope] += cyy * n;
            }
            for (other, column) in [(0, 1), (2, 3)] {
                let [cxx, cxy, _, cyy] = pair(end, other);
                xx[4 * slope + column] += cxx;
                xy[4 * slope + column] += cxy;
                yy[4 * slope + column] += cyy;
            }
        }
    }

    /// The curvature's part, EI κ_a κ_b + M κ_ab with a, b ∈ {X′, Y′, X″, Y″}:
    /// κ_ab = (c_ab − κ_b s_a − κ s_ab − κ_a s_b)/s, s = ℓ², c = X′Y″ − Y′X″.
    #[inline(always)]
    fn curvature_tangent(&self, rule: &Rule, s: &Strains, w: f64, [xx, xy, yy]: &mut [Block; 3]) {
        for (g, p) in rule.points.iter().enumerate() {
            let [x1, y1, x2, y2] = s.gradient[g];
            let ([sx, sy], k0) = (s.slope[g], s.curvature[g]);
            let ei = w * self.bending[g];
            let m = w * s.moment[g] / (sx * sx + sy * sy);
            let x1x1 = ei * x1 * x1 - m * (4.0 * sx * x1 + 2.0 * k0);
            let y1y1 = ei * y1 * y1 - m * (4.0 * sy * y1 + 2.0 * k0);
            let x1y1 = ei * x1 * y1 - 2.0 * m * (sx * y1 + sy * x1);
            let x1x2 = ei * x1 * x2 - 2.0 * m * sx * x2;
            let y1y2 = ei * y1 * y2 - 2.0 * m * sy * y2;
            let x1y2 = ei * x1 * y2 + m * (1.0 - 2.0 * sx * y2);
            let x2y1 = ei * x2 * y1 - m * (1.0 + 2.0 * sy * x2);
            let (x2x2, x2y2, y2y2) = (ei * x2 * x2, ei * x2 * y2, ei * y2 * y2);
            let Products { n11, n12, n21, n22 } = &p.products;
            for k in 0..16 {
                let mixed = n12[k] + n21[k];
                xx[k] += x1x1 * n11[k] + x1x2 * mixed + x2x2 * n22[k];
                yy[k] += y1y1 * n11[k] + y1y2 * mixed + y2y2 * n22[k];
                xy[k] += x1y1 * n11[k] + x1y2 * n12[k] + x2y1 * n21[k] + x2y2 * n22[k];
            }
        }
    }

    /// The part −ES (∂ε̄/∂d ∂κ/∂dᵀ + ∂κ/∂d ∂ε̄/∂dᵀ).
    fn coupling_tangent(&self, rule: &Rule, s: &Strains, w: f64, out: &mut [[f64; 8]; 8]) {
        let samples: [[f64; 4]; 3] = [[0.0, 1.0, 0.0, 0.0], rule.middle, [0.0, 0.0, 0.0, 1.0]];
        for (g, p) in rule.points.iter().enumerate() {
            let [x1, y1, x2, y2] = s.gradient[g];
            let (mut strain, mut curvature) = ([0.0; 8], [0.0; 8]);
            for k in 0..4 {
                curvature[k] = x1 * p.n1[k] + x2 * p.n2[k];
                curvature[4 + k] = y1 * p.n1[k] + y2 * p.n2[k];
                for i in 0..3 {
                    strain[k] += p.l[i] * s.tangent[i][0] * samples[i][k];
                    strain[4 + k] += p.l[i] * s.tangent[i][1] * samples[i][k];
                }
            }
            let scaled = strain.map(|x| -w * self.coupling[g] * x);
            add_outer(out, &scaled, &curvature);
            add_outer(out, &curvature, &scaled);
        }
    }

    /// Adds dᵀ(∂²U/∂q²)d of the unknowns d that each of the vectors has here, with δε and δκ the first variations and δ²ε and
    /// δ²κ the second ones: ∫ EA δε² − 2 ES δε δκ + EI δκ² + N δ²ε + M δ²κ dx.
    pub fn strain_forms(&self, rule: &Rule, state: &[f64; 8], vectors: &[Vec<f64>], out: &mut [f64]) {
        let s = self.strains(rule, state);
        for (x, out) in vectors.iter().zip(out) {
            let d: [f64; 8] =
                self.unknowns.map(|i| if i == CLAMPED { 0.0 } else { x.get(i).copied().unwrap_or(0.0) });
            let [du, dv] = components(&d);
            let slopes = [[du[1], dv[1]], [inner(rule.middle, du), inner(rule.middle, dv)], [du[3], dv[3]]];
            let mut strain = [0.0; 3];
            for i in 0..3 {
                let ([tx, ty], [x, y]) = (s.tangent[i], slopes[i]);
                strain[i] = tx * x + ty * y;
                *out += s.axial[i] * s.inverse_stretch[i] * (tx * y - ty * x).powi(2);
            }
            for i in 0..3 {
                *out += strain[i] * (0..3).map(|j| self.axial[i][j] * strain[j]).sum::<f64>();
            }
            for (g, p) in rule.points.iter().enumerate() {
                let ([sx, sy], [x1, y1, x2, y2]) = (s.slope[g], s.gradient[g]);
                let (px, py) = (inner(p.n1, du), inner(p.n1, dv));
                let (rx, ry) = (inner(p.n2, du), inner(p.n2, dv));
                let curvature = x1 * px + y1 * py + x2 * rx + y2 * ry;
                let along = sx * px + sy * py;
                let second = 2.0 * (px * ry - py * rx)
                    - 4.0 * along * curvature
                    - 2.0 * s.curvature[g] * (px * px + py * py);
                *out += self.bending[g] * curvature * curvature + s.moment[g] * second / (sx * sx + sy * sy);
                if self.has_coupling {
                    let mean: f64 = (0..3).map(|i| p.l[i] * strain[i]).sum();
                    *out -= 2.0 * self.coupling[g] * mean * curvature;
                }
            }
        }
    }
}

/// Σ nₖ dₖ of vectors of the plane.
#[inline(always)]
fn combined(n: Relative, d: [[f64; 2]; 3]) -> [f64; 2] {
    [0, 1].map(|c| n[0] * d[0][c] + n[1] * d[1][c] + n[2] * d[2][c])
}

/// out += a bᵀ
#[inline(always)]
fn add_outer(out: &mut [[f64; 8]; 8], a: &[f64; 8], b: &[f64; 8]) {
    for (row, a) in out.iter_mut().zip(a) {
        for (out, b) in row.iter_mut().zip(b) {
            *out += a * b;
        }
    }
}
