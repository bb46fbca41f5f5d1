//! Running sums over the quadrature points of a beam: the foreshortening w_c from the root to the tip, tails
//! of axial forces from the tip to the root.
//!
//! Inside a cell of length h the integral up to a point is that of the polynomial through the values at the
//! Gauss points, ∫₀^{ξ_g} f dx = h Σ_k S_gk f_k. Tails use the transposed rule, so that the forces are exactly
//! the derivatives of the kinetic energy that these sums define.
//!
//! A lumped mass is at the end of a cell, which is a further point of the cell for the mass but not for the slope: the
//! sum up to there is that over the whole cell, and its axial force enters the tails as a jump.

use crate::hub_beam::beam::Beam;
use crate::hub_beam::fields::{Fields, Shapes};
use crate::profile::HubKinematics;
use crate::quadrature::Gauss;
use crate::system::State;
use std::sync::Arc;

/// Value, velocity and acceleration.
pub type Rates = [f64; 3];

/// The axis at a point.
#[derive(Clone, Copy, Debug, Default)]
pub struct Point {
    /// Axial displacement w₁ \[m\] and its rates.
    pub w1: Rates,
    /// Deflection w₂ \[m\] and its rates.
    pub w2: Rates,
    /// Foreshortening w_c \[m\] and its rates.
    pub wc: Rates,
}

impl Point {
    /// α: the axial acceleration of the axis without the −ω²R that [`Inertia`](crate::hub_beam::Inertia) has.
    pub fn axial_acceleration(&self, hub: &HubKinematics) -> f64 {
        let (om, al) = (hub.speed, hub.acceleration);
        (self.w1[2] + self.wc[2])
            - al * self.w2[0]
            - 2.0 * om * self.w2[1]
            - om * om * (self.w1[0] + self.wc[0])
    }
}

/// A cell: unknowns and shapes at its points, by rows.
#[derive(Clone, Debug)]
pub struct Cell {
    /// Length h \[m\].
    pub length: f64,
    /// Unknowns of the axial and of the transverse functions.
    pub axial: Vec<usize>,
    /// Unknowns of the transverse functions.
    pub transverse: Vec<usize>,
    /// ρA times the quadrature weight [kg] at each point, then the lumped mass at the end of the cell if there is one.
    pub mass: Vec<f64>,
    /// φx at each point of mass.
    pub phi_x: Vec<f64>,
    /// φy at each point of mass.
    pub phi_y: Vec<f64>,
    /// φy′ at each point.
    pub slope: Vec<f64>,
}

/// The points of a beam and what the running sums give there.
#[derive(Clone, Debug)]
pub struct Sums {
    /// Points of a cell.
    pub points: usize,
    /// Points of mass of a cell in `at`: its points and, on a beam with lumped masses, its end.
    pub rows: usize,
    /// S by rows, for a cell of unit length; the last row, for its end, holds the weights.
    pub partial: Arc<[f64]>,
    /// Quadrature weights of a cell of unit length.
    pub weights: Arc<[f64]>,
    /// The cells, root first.
    pub cells: Arc<[Cell]>,
    /// The axis at every point of mass.
    pub at: Vec<Point>,
    /// w₂′ and its rates at every point.
    pub slope: Vec<Rates>,
    /// Tails at the points of a cell, times the quadrature weight.
    tension: Vec<Rates>,
    /// q, v and a that were followed last.
    followed: Vec<Rates>,
}

/// S_gk = ∫₀^{ξ_g} ℓ_k dξ on the unit cell with Lagrange's polynomials ℓ_k of the Gauss points, through
/// ℓ_k(z) = w_k Σ_l (2l + 1)/2 P_l(z_k) P_l(z) and ∫₋₁ᶻ P_l = (P_{l+1} − P_{l−1})/(2l + 1), z = 2ξ − 1.
fn partial_integrals(gauss: &Gauss) -> Vec<f64> {
    let n = gauss.len();
    let nodes: Vec<(f64, f64)> = gauss.on(-1.0, 1.0).collect();
    let legendre = |z: f64| {
        let mut p = vec![1.0, z];
        for l in 1..n {
            let l = l as f64;
            let next = ((2.0 * l + 1.0) * z * p[p.len() - 1] - l * p[p.len() - 2]) / (l + 1.0);
            p.push(next);
        }
        p
    };
    let values: Vec<Vec<f64>> = nodes.iter().map(|&(z, _)| legendre(z)).collect();
    let mut out = Vec::with_capacity(n * n);
    for (g, &(z, _)) in nodes.iter().enumerate() {
        for (k, &(_, w)) in nodes.iter().enumerate() {
            let mut sum = z + 1.0;
            for l in 1..n {
                sum += values[k][l] * (values[g][l + 1] - values[g][l - 1]);
            }
            // Half for ℓ_k, half for the unit cell.
            out.push(0.25 * w * sum);
        }
    }
    out
}

impl Sums {
    /// The points of `fields` with the mass of `beam`; cells of the fields end at its lumped masses.
    pub fn new(fields: &Fields, beam: &Beam<'_>) -> Sums {
        let gauss = fields.gauss();
        let points = gauss.len();
        let mut cells: Vec<Cell> = Vec::with_capacity(fields.cells().len());
        let mut count = 0;
        let copy = |shapes: &Shapes, d: usize, out: &mut Vec<f64>| out.extend_from_slice(&shapes.value[d]);
        fields.integrate(|p| {
            if count % points == 0 {
                let ends = &fields.cells()[cells.len()..];
                cells.push(Cell {
                    length: ends[1] - ends[0],
                    axial: p.axial.index.clone(),
                    transverse: p.transverse.index.clone(),
                    mass: Vec::with_capacity(points),
                    phi_x: Vec::new(),
                    phi_y: Vec::new(),
                    slope: Vec::new(),
                });
            }
            count += 1;
            let Some(cell) = cells.last_mut() else { return };
            cell.mass.push(p.weight * beam.section.resultants(p.x).mass);
            copy(&p.axial, 0, &mut cell.phi_x);
            copy(&p.transverse, 0, &mut cell.phi_y);
            copy(&p.transverse, 1, &mut cell.slope);
        });
        let lumped = &beam.masses;
        for (c, cell) in cells.iter_mut().enumerate() {
            let end = fields.cell_end(c);
            let here = lumped.iter().filter(|m| (m.station - end.x).abs() <= 1e-12 * fields.length());
            let mass: f64 = here.map(|m| m.mass).sum();
            if mass != 0.0 {
                cell.mass.push(mass);
                copy(&end.axial, 0, &mut cell.phi_x);
                copy(&end.transverse, 0, &mut cell.phi_y);
            }
        }
        let rows = points + usize::from(!lumped.is_empty());
        let weights: Vec<f64> = gauss.on(0.0, 1.0).map(|(_, w)| w).collect();
        let mut partial = partial_integrals(gauss);
        partial.extend_from_slice(&weights);
        Sums {
            points,
            rows,
            partial: partial.into(),
            weights: weights.into(),
            at: vec![Point::default(); cells.len() * rows],
            slope: vec![[0.0; 3]; cells.len() * points],
            tension: vec![[0.0; 3]; points],
            followed: vec![[f64::NAN; 3]; fields.len()],
            cells: cells.into(),
        }
    }

    /// Follows the axis of a state from the root to the tip, unless it is the last one again: forces, torque, tangent
    /// and power of one state are asked for one after the other.
    pub fn follow(&mut self, s: &State) {
        let p = self.points;
        let mut same = true;
        for (i, followed) in self.followed.iter_mut().enumerate() {
            let now = [s.q[i], s.v[i], s.a[i]];
            same &= *followed == now;
            *followed = now;
        }
        if same {
            return;
        }
        // w_c and its rates at the start of the cell.
        let mut start = [0.0; 3];
        let axis = self.at.chunks_exact_mut(self.rows);
        let cells = self.cells.iter().zip(axis).zip(self.slope.chunks_exact_mut(p));
        for ((cell, at), slope) in cells {
            let (na, nt) = (cell.axial.len(), cell.transverse.len());
            let sum = |unknowns: &[usize], phi: &[f64]| {
                let mut sum = [0.0; 3];
                unknowns.iter().zip(phi).for_each(|(i, phi)| add(&mut sum, *phi, self.followed[*i]));
                sum
            };
            for (g, slope) in slope.iter_mut().enumerate() {
                *slope = sum(&cell.transverse, &cell.slope[g * nt..]);
            }
            let shortening = &mut self.tension;
            for (shortening, [u, v, a]) in shortening.iter_mut().zip(&*slope) {
                *shortening = [-0.5 * u * u, -u * v, -(v * v + u * a)];
            }
            let along = |weights: &[f64]| {
                let mut sum = start;
                let shortening = weights.iter().zip(&*shortening);
                shortening.for_each(|(weight, x)| add(&mut sum, cell.length * weight, *x));
                sum
            };
            for (g, (at, _)) in at.iter_mut().zip(&cell.mass).enumerate() {
                let w1 = sum(&cell.axial, &cell.phi_x[g * na..]);
                let w2 = sum(&cell.transverse, &cell.phi_y[g * nt..]);
                *at = Point { w1, w2, wc: along(&self.partial[g * p..][..p]) };
            }
            start = along(&self.weights);
        }
    }

    /// Calls `f` with the mass [kg] and the axis of every point of mass.
    pub fn each(&self, mut f: impl FnMut(f64, &Point)) {
        for (cell, at) in self.cells.iter().zip(self.at.chunks_exact(self.rows)) {
            for (m, at) in cell.mass.iter().zip(at) {
                f(*m, at);
            }
        }
    }

    /// Adds to `y` the part of cell `c` in ∂w_c/∂qᵢ = −∫ w₂′ φy′ᵢ and its rates, with the quadrature weights `partial` of
    /// a cell of unit length.
    pub fn add_derivatives(&self, c: usize, partial: &[f64], y: &mut [Rates]) {
        let cell = &self.cells[c];
        let shapes = cell.slope.chunks_exact(cell.transverse.len().max(1));
        for ((s, slope), phi) in partial.iter().zip(&self.slope[c * self.points..]).zip(shapes) {
            for (&i, phi) in cell.transverse.iter().zip(phi) {
                add(&mut y[i], -cell.length * s * phi, *slope);
            }
        }
    }

    /// Calls `f` with every cell, its slopes, and the tails ∫ₓᴸ dm `along` at its points times the quadrature weights of a
    /// cell of unit length; from the tip to the root.
    pub fn tails<const N: usize>(
        &mut self,
        along: impl Fn(&Point) -> [f64; N],
        mut f: impl FnMut(&Cell, &[Rates], &[Rates]),
    ) {
        let p = self.points;
        // Tails at the end of the cell.
        let mut beyond = [0.0; N];
        for (c, cell) in self.cells.iter().enumerate().rev() {
            for (tension, weight) in self.tension.iter_mut().zip(&*self.weights) {
                for (tension, beyond) in tension.iter_mut().zip(beyond) {
                    *tension = weight * beyond;
                }
            }
            let at = &self.at[c * self.rows..(c + 1) * self.rows];
            for ((m, at), partial) in cell.mass.iter().zip(at).zip(self.partial.chunks_exact(p)) {
                let along = along(at).map(|x| m * x);
                for (tension, partial) in self.tension.iter_mut().zip(partial) {
                    for (tension, along) in tension.iter_mut().zip(along) {
                        *tension += partial * along;
                    }
                }
                for (beyond, along) in beyond.iter_mut().zip(along) {
                    *beyond += along;
                }
            }
            f(cell, &self.slope[c * p..(c + 1) * p], &self.tension);
        }
    }

    /// Adds to `r` the forces of accelerations `of`(point) = ([on w₁, on w₂], [along the axis, by N]):
    /// Σ m a₁ φx, Σ m a₂ φy, and −∫ (N₀ w₂′ + N₁ ẇ₂′ + …) φy′ with the tails N of the last ones.
    pub fn scatter<const N: usize>(&mut self, r: &mut [f64], of: impl Fn(&Point) -> ([f64; 2], [f64; N])) {
        for (cell, at) in self.cells.iter().zip(self.at.chunks_exact(self.rows)) {
            let (na, nt) = (cell.axial.len(), cell.transverse.len());
            for (g, (&m, at)) in cell.mass.iter().zip(at).enumerate() {
                let (on, _) = of(at);
                for (&i, phi) in cell.axial.iter().zip(&cell.phi_x[g * na..]) {
                    r[i] += m * on[0] * phi;
                }
                for (&i, phi) in cell.transverse.iter().zip(&cell.phi_y[g * nt..]) {
                    r[i] += m * on[1] * phi;
                }
            }
        }
        self.tails(
            |at| of(at).1,
            |cell, slope, tension| {
                let shapes = cell.slope.chunks_exact(cell.transverse.len().max(1));
                for ((tension, slope), phi) in tension.iter().zip(slope).zip(shapes) {
                    let force: f64 = tension.iter().zip(slope).take(N).map(|(n, slope)| n * slope).sum();
                    for (&i, phi) in cell.transverse.iter().zip(phi) {
                        r[i] -= cell.length * force * phi;
                    }
                }
            },
        );
    }
}

#[inline(always)]
fn add(out: &mut Rates, w: f64, x: Rates) {
    for (out, x) in out.iter_mut().zip(x) {
        *out += w * x;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn partial_integrals_of_polynomials_are_exact() {
        for n in [1, 2, 6, 13, 30] {
            let gauss = Gauss::new(n);
            let s = partial_integrals(&gauss);
            let nodes: Vec<f64> = gauss.on(0.0, 1.0).map(|(x, _)| x).collect();
            for degree in 0..n {
                for (g, x) in nodes.iter().enumerate() {
                    let sum: f64 = (0..n).map(|k| s[g * n + k] * nodes[k].powi(degree as i32)).sum();
                    let exact = x.powi(degree as i32 + 1) / (degree as f64 + 1.0);
                    assert!((sum - exact).abs() < 1e-14, "{n} points, degree {degree}: {sum} {exact}");
                }
            }
        }
    }
}
