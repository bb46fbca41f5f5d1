//! Running sums over the quadrature points of a beam: the foreshortening w_c from the root to the tip, tails
//! of axial forces from the tip to the root.
//!
//! Inside a cell of length h the integral up to a point is that of the polynomial through the values at the
//! Gauss points, ∫₀^{ξ_g} f dx = h Σ_k S_gk f_k. Tails use the transposed rule, so that the forces are exactly
//! the derivatives of the kinetic energy that these sums define.
//!
//! A lumped mass is at the end of a cell, which is a further point of the cell for the mass but not for the slope: the
//! sum up to there is that over the whole cell, and its axial force enters the tails as a jump.

use super::table::{LANES, Table};
use crate::hub_beam::beam::Beam;
use crate::hub_beam::fields::Fields;
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

/// A cell: unknowns and shapes at its points.
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
    pub phi_x: Table,
    /// φy at each point of mass.
    pub phi_y: Table,
    /// φy′ at each point.
    pub slope: Table,
}

/// The points of a beam and what the running sums give there.
#[derive(Clone, Debug)]
pub struct Sums {
    /// Points of a cell.
    pub points: usize,
    /// Points of mass of a cell in `at`: its points and, on a beam with lumped masses, its end.
    pub rows: usize,
    /// S of a cell of unit length, whose functions are Lagrange's, at its points of mass.
    pub partial: Arc<Table>,
    /// Quadrature weights of a cell of unit length.
    pub weights: Arc<[f64]>,
    /// The cells, root first.
    pub cells: Arc<[Cell]>,
    /// The axis at every point of mass.
    pub at: Vec<Point>,
    /// w₂′ and its rates at every point.
    pub slope: Vec<Rates>,
    /// What is integrated along a cell, or tails at its points times the quadrature weight.
    tension: Vec<Rates>,
    /// Unknowns of a cell.
    unknowns: Vec<Rates>,
    /// Forces at the points of mass of a cell.
    forces: [Vec<[f64; LANES]>; 5],
    /// Forces on the slopes at the points of a cell.
    bending: Vec<[f64; LANES]>,
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
        fields.integrate(|p| {
            if count % points == 0 {
                let ends = &fields.cells()[cells.len()..];
                cells.push(Cell {
                    length: ends[1] - ends[0],
                    axial: p.axial.index.clone(),
                    transverse: p.transverse.index.clone(),
                    mass: Vec::with_capacity(points),
                    phi_x: Table::new(p.axial.index.len()),
                    phi_y: Table::new(p.transverse.index.len()),
                    slope: Table::new(p.transverse.index.len()),
                });
            }
            count += 1;
            let Some(cell) = cells.last_mut() else { return };
            cell.mass.push(p.weight * beam.section.resultants(p.x).mass);
            cell.phi_x.push(&p.axial.value[0]);
            cell.phi_y.push(&p.transverse.value[0]);
            cell.slope.push(&p.transverse.value[1]);
        });
        let lumped = &beam.masses;
        for (c, cell) in cells.iter_mut().enumerate() {
            let end = fields.cell_end(c);
            let here = lumped.iter().filter(|m| (m.station - end.x).abs() <= 1e-12 * fields.length());
            let mass: f64 = here.map(|m| m.mass).sum();
            if mass != 0.0 {
                cell.mass.push(mass);
                cell.phi_x.push(&end.axial.value[0]);
                cell.phi_y.push(&end.transverse.value[0]);
            }
        }
        let rows = points + usize::from(!lumped.is_empty());
        let weights: Vec<f64> = gauss.on(0.0, 1.0).map(|(_, w)| w).collect();
        let mut partial = Table::new(points);
        partial_integrals(gauss).chunks_exact(points).for_each(|row| partial.push(row));
        if rows > points {
            partial.push(&weights);
        }
        let forces = || vec![[0.0; LANES]; rows.div_ceil(LANES)];
        Sums {
            points,
            rows,
            partial: partial.into(),
            weights: weights.into(),
            at: vec![Point::default(); cells.len() * rows],
            slope: vec![[0.0; 3]; cells.len() * points],
            tension: vec![[0.0; 3]; points],
            unknowns: Vec::with_capacity(fields.len()),
            forces: [(); 5].map(|()| forces()),
            bending: forces(),
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
            let of_cell = |unknowns: &[usize], out: &mut Vec<Rates>| {
                out.clear();
                out.extend(unknowns.iter().map(|i| self.followed[*i]));
            };
            of_cell(&cell.transverse, &mut self.unknowns);
            cell.slope.values(&self.unknowns, |g, found| {
                let [u, v, a] = found;
                slope[g] = found;
                self.tension[g] = [-0.5 * u * u, -u * v, -(v * v + u * a)];
            });
            cell.phi_y.values(&self.unknowns, |g, w2| at[g].w2 = w2);
            of_cell(&cell.axial, &mut self.unknowns);
            cell.phi_x.values(&self.unknowns, |g, w1| at[g].w1 = w1);
            self.partial.values(&self.tension, |g, sum| {
                let mut wc = start;
                add(&mut wc, cell.length, sum);
                at[g].wc = wc;
            });
            for (weight, x) in self.weights.iter().zip(&self.tension) {
                add(&mut start, cell.length * weight, *x);
            }
        }
    }

    /// Calls `f` with the mass [kg] and the axis of every point of mass.
    #[inline]
    pub fn each(&self, mut f: impl FnMut(f64, &Point)) {
        for (cell, at) in self.cells.iter().zip(self.at.chunks_exact(self.rows)) {
            for (m, at) in cell.mass.iter().zip(at) {
                f(*m, at);
            }
        }
    }

    /// Adds to `y` the part of cell `c` in ∂w_c/∂qᵢ = −∫ w₂′ φy′ᵢ and its rates, with the quadrature weights `partial` of
    /// a cell of unit length.
    pub fn add_derivatives(&self, c: usize, partial: impl Iterator<Item = f64>, y: &mut [Rates]) {
        let cell = &self.cells[c];
        for (g, (s, slope)) in partial.zip(&self.slope[c * self.points..][..self.points]).enumerate() {
            for (&i, phi) in cell.transverse.iter().zip(cell.slope.at(g)) {
                add(&mut y[i], -cell.length * s * phi, *slope);
            }
        }
    }

    /// Calls `f` with every cell, its slopes, and the tails ∫ₓᴸ dm N at its points times the quadrature weights of a cell of
    /// unit length; from the tip to the root. Of the accelerations `of`(point) = ([on w₁, on w₂], [N]), m times the first two
    /// are handed over too.
    pub fn tails<const N: usize>(
        &mut self,
        of: impl Fn(&Point) -> ([f64; 2], [f64; N]),
        mut f: impl FnMut(&Cell, &[Rates], &[Rates], [&[[f64; LANES]]; 2]),
    ) {
        let p = self.points;
        // Tails at the end of the cell.
        let mut beyond = [0.0; N];
        for (c, cell) in self.cells.iter().enumerate().rev() {
            let [on_axial, on_transverse, along @ ..] = &mut self.forces;
            // A cell without lumped mass has a point of mass less.
            let last = (self.rows - 1) / LANES;
            on_axial[last] = [0.0; LANES];
            on_transverse[last] = [0.0; LANES];
            along.iter_mut().take(N).for_each(|along| along[last] = [0.0; LANES]);
            for (tension, weight) in self.tension.iter_mut().zip(&*self.weights) {
                for (tension, beyond) in tension.iter_mut().zip(beyond) {
                    *tension = weight * beyond;
                }
            }
            for (g, (m, at)) in cell.mass.iter().zip(&self.at[c * self.rows..]).enumerate() {
                let (block, lane) = (g / LANES, g % LANES);
                let (on, tails) = of(at);
                (on_axial[block][lane], on_transverse[block][lane]) = (m * on[0], m * on[1]);
                for ((along, beyond), tail) in along.iter_mut().zip(&mut beyond).zip(tails) {
                    along[block][lane] = m * tail;
                    *beyond += m * tail;
                }
            }
            for (n, along) in along.iter().take(N).enumerate() {
                self.partial.moments(along, |k, sum| self.tension[k][n] += sum);
            }
            f(cell, &self.slope[c * p..][..p], &self.tension, [on_axial, on_transverse]);
        }
    }

    /// Adds to `r` the forces of accelerations `of`(point) = ([on w₁, on w₂], [along the axis, by N]):
    /// Σ m a₁ φx, Σ m a₂ φy, and −∫ (N₀ w₂′ + N₁ ẇ₂′ + …) φy′ with the tails N of the last ones.
    pub fn scatter<const N: usize>(&mut self, r: &mut [f64], of: impl Fn(&Point) -> ([f64; 2], [f64; N])) {
        let mut bending = std::mem::take(&mut self.bending);
        self.tails(of, |cell, slope, tension, [on_axial, on_transverse]| {
            for (g, (tension, slope)) in tension.iter().zip(slope).enumerate() {
                let force: f64 = tension.iter().zip(slope).take(N).map(|(n, slope)| n * slope).sum();
                bending[g / LANES][g % LANES] = -cell.length * force;
            }
            cell.phi_x.moments(on_axial, |i, sum| r[cell.axial[i]] += sum);
            cell.phi_y.moments(on_transverse, |i, sum| r[cell.transverse[i]] += sum);
            cell.slope.moments(&bending, |i, sum| r[cell.transverse[i]] += sum);
        });
        self.bending = bending;
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
