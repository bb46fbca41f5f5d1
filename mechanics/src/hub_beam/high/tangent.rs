//! The tangent of the high-order coupling: a full matrix made of running sums.
//!
//! With weights w and increments δ of the unknowns, σ = w₂′, and
//!
//! ```text
//! z₁ = w·(δẅ_c − ω²δw_c) = −∫₀ˣ g₁ δw₂′,      g₁ = w_q σ̈ + 2w_v σ̇ + (w_a − w_q ω²) σ
//! z₂ = w·(ω̇ δw_c + 2ω δẇ_c) = −∫₀ˣ g₂ δw₂′,   g₂ = (w_q ω̇ + 2ω w_v) σ + 2ω w_q σ̇
//! n  = w·δN = ∫ₓᴸ ρA [ (w_a − w_q ω²) δw₁ − (w_q ω̇ + 2ω w_v) δw₂ + z₁ ] dξ
//! ```
//!
//! the increments of the forces are
//!
//! ```text
//! on w₁  ∫ρA z₁ φx dx      on w₂  ∫ρA z₂ φy dx − ∫ (n σ + w_q N δw₂′) φy′ dx
//! ```
//!
//! In a cell all these are sums over its own points, but for the values of z₁ and z₂ at its start and of n at its
//! end. Taken for unknowns, three at each boundary between cells, they make the tangent a band:
//!
//! ```text
//! z(end) − z(start) + ∫_cell g δw₂′ = 0,      n(start) − n(end) − ∫_cell ρA [ … + z₁ ] = 0
//! ```
//!
//! [`crate::linalg::Condensed`] hides them. Their coefficients contain the state but no weights, as it asks
//! for. Where the bases are global and a dense matrix is cheaper, the same recurrences run over its rows.
//! Hidden unknowns are scaled by the mean mass of a cell, so that pivots need no interchange.

use super::axial_acceleration;
use super::sums::{Cell, Sums};
use crate::hub_beam::fields::Fields;
use crate::linalg::{Condensed, Dense, Places, Storage, Structure};
use crate::profile::HubKinematics;
use crate::system::Weights;
use std::sync::Arc;

/// Places of the hidden unknowns at a boundary between cells.
#[derive(Clone, Copy, Debug, Default)]
struct Hidden {
    z: [usize; 2],
    n: usize,
}

/// The tangent and its scratch; see the [module documentation](self).
#[derive(Clone, Debug)]
pub struct Tangent {
    /// Places at the boundaries 1 … cells − 1; those at the ends of the beam are not used.
    hidden: Vec<Hidden>,
    places: Arc<Places>,
    half_bandwidth: usize,
    /// Units of z and n.
    scale: [f64; 2],
    /// N at the end of each cell.
    tails: Vec<f64>,
    block: Block,
    /// For a dense matrix: rows of z₁ and z₂ at the start of a cell, of n at its end, of the increments of n
    /// cell by cell, and what n does in each cell.
    rows: [Vec<f64>; 3],
    steps: Vec<f64>,
    ends: Vec<f64>,
}

/// One cell of the tangent: scratch.
#[derive(Clone, Debug)]
struct Block {
    /// N at the points, times the quadrature weight.
    tension: Vec<f64>,
    /// g₁ and g₂ at the points.
    g: [Vec<f64>; 2],
    /// z₁ and z₂ at the masses by the transverse unknowns (places × functions); z₁ with the rest of δα.
    z: [Vec<f64>; 2],
    /// Σ_k S_gk h σ_k φ′_k: what an axial force at a point does on the transverse unknowns.
    lever: Vec<f64>,
    /// Forces on axial unknowns by z₁; on transverse ones by z₁, z₂ and n.
    axial_by_z: Vec<f64>,
    by_z: [Vec<f64>; 2],
    by_n: Vec<f64>,
    /// Increments of z₁, z₂ over the cell by the transverse unknowns, of n by axial and transverse ones.
    step: [Vec<f64>; 2],
    axial_step: Vec<f64>,
    transverse_step: Vec<f64>,
    /// Forces by unknowns: axial × transverse, transverse × axial, transverse × transverse.
    xy: Vec<f64>,
    yx: Vec<f64>,
    yy: Vec<f64>,
    /// Mass [kg].
    mass: f64,
}

impl Tangent {
    /// The tangent over `fields` and the points of `sums`.
    pub fn new(fields: &Fields, sums: &Sums) -> Tangent {
        let cells = sums.cells.len();
        let n = fields.len();
        let mut anchors = vec![0.0; n];
        let (axial, transverse) = fields.indices();
        for (basis, index) in [(fields.axial(), axial), (fields.transverse(), transverse)] {
            for (i, &number) in index.iter().enumerate() {
                anchors[number] = basis.anchor(i);
            }
        }
        // n before the unknowns at its boundary, z behind them: the narrowest band for elements.
        let near = 1e-9 * fields.length();
        let mut visible = Vec::with_capacity(n);
        let mut hidden = vec![Hidden::default(); cells + 1];
        let mut place = 0;
        let mut take = || {
            place += 1;
            place - 1
        };
        for (c, boundary) in fields.cells().iter().enumerate().take(cells).skip(1) {
            while visible.len() < n && anchors[visible.len()] < boundary - near {
                visible.push(take());
            }
            hidden[c].n = take();
            while visible.len() < n && anchors[visible.len()] <= boundary + near {
                visible.push(take());
            }
            hidden[c].z = [take(), take()];
        }
        while visible.len() < n {
            visible.push(take());
        }
        let inner = &hidden[1..cells];
        let order = inner.iter().flat_map(|h| h.z).chain(inner.iter().rev().map(|h| h.n)).collect();
        let places = Arc::new(Places { visible, hidden: order });
        let total: f64 = sums.cells.iter().flat_map(|cell| &cell.mass).sum();
        let mean = (total / cells as f64).sqrt();
        let most = |f: fn(&Cell) -> &Vec<usize>| sums.cells.iter().map(|c| f(c).len()).max().unwrap_or(0);
        let (na, nt) = (most(|c| &c.axial), most(|c| &c.transverse));
        let block = Block::new(sums, na, nt);
        let mut tangent = Tangent {
            hidden,
            places,
            half_bandwidth: 0,
            scale: [1.0 / mean, mean],
            tails: vec![0.0; cells],
            block,
            rows: Default::default(),
            steps: Vec::new(),
            ends: Vec::new(),
        };
        tangent.half_bandwidth = tangent.measure(sums);
        if matches!(tangent.structure(0), Structure::Dense { .. }) {
            tangent.make_rows(cells);
        }
        tangent
    }

    /// Scratch for a dense matrix: from the start where that is the structure, else when an analysis asks for one.
    fn make_rows(&mut self, cells: usize) {
        let n = self.places.visible.len();
        self.rows = [vec![0.0; n], vec![0.0; n], vec![0.0; n]];
        self.steps = vec![0.0; n * cells];
        self.ends = vec![0.0; self.block.by_n.len() * cells];
    }

    /// Largest distance of two unknowns of which one stands in the equation of the other.
    fn measure(&self, sums: &Sums) -> usize {
        let cells = sums.cells.len();
        let mut widest = 0;
        let mut meet = |row: usize, column: usize| widest = widest.max(row.abs_diff(column));
        for (c, cell) in sums.cells.iter().enumerate() {
            let (start, end) = (self.hidden[c], self.hidden[c + 1]);
            let (first, last) = (c > 0, c + 1 < cells);
            let unknowns: Vec<usize> =
                cell.axial.iter().chain(&cell.transverse).map(|&i| self.places.visible[i]).collect();
            for &row in &unknowns {
                unknowns.iter().for_each(|&column| meet(row, column));
                if first {
                    start.z.into_iter().chain([start.n]).for_each(|z| meet(row, z));
                }
                if last {
                    meet(row, end.n);
                }
            }
            if last {
                for &i in &cell.transverse {
                    end.z.into_iter().for_each(|z| meet(z, self.places.visible[i]));
                }
            }
            if first && last {
                start.z.into_iter().zip(end.z).for_each(|(a, b)| meet(b, a));
                meet(start.n, end.n);
            }
            if first {
                meet(start.n, start.z[0]);
            }
        }
        widest
    }

    /// Structure of the whole tangent, with `border` unknowns of a hub.
    pub fn structure(&self, border: usize) -> Structure {
        let half = self.half_bandwidth;
        Structure::Condensed { places: self.places.clone(), lower: half, upper: half, border }.cheaper()
    }

    /// Adds the tangent at the state that `sums` follow.
    pub fn add(&mut self, sums: &Sums, hub: &HubKinematics, w: &Weights<'_>, out: &mut Storage<f64>) {
        let mut tail = 0.0;
        for (c, cell) in sums.cells.iter().enumerate().rev() {
            self.tails[c] = tail;
            tail += cell
                .mass
                .iter()
                .zip(sums.of_cell(c))
                .map(|(m, at)| m * axial_acceleration(at, hub))
                .sum::<f64>();
        }
        match out {
            Storage::Condensed(out) => self.add_condensed(sums, hub, w, out),
            Storage::Dense(out) => {
                if self.steps.is_empty() {
                    self.make_rows(sums.cells.len());
                }
                self.add_dense(sums, hub, w, out);
            }
            Storage::Band(_) => debug_assert!(false, "no structure of this tangent"),
        }
    }

    fn add_condensed(&mut self, sums: &Sums, hub: &HubKinematics, w: &Weights<'_>, out: &mut Condensed<f64>) {
        let cells = sums.cells.len();
        let [unit_z, unit_n] = self.scale;
        let visible = &self.places.visible;
        let band = out.whole_mut().band_mut();
        for (c, cell) in sums.cells.iter().enumerate() {
            let block = &mut self.block;
            block.fill(sums, c, self.tails[c], hub, w);
            let (na, nt) = (cell.axial.len(), cell.transverse.len());
            let (start, end) = (self.hidden[c], self.hidden[c + 1]);
            let (first, last) = (c > 0, c + 1 < cells);
            for (a, &i) in cell.axial.iter().enumerate() {
                let i = visible[i];
                for (x, &j) in block.xy[a * nt..].iter().zip(&cell.transverse) {
                    band.add(i, visible[j], *x);
                }
                if first {
                    band.add(i, start.z[0], unit_z * block.axial_by_z[a]);
                    band.add(start.n, i, -block.axial_step[a] / unit_n);
                }
            }
            for (b, &i) in cell.transverse.iter().enumerate() {
                let i = visible[i];
                for (x, &j) in block.yx[b * na..].iter().zip(&cell.axial) {
                    band.add(i, visible[j], *x);
                }
                for (x, &j) in block.yy[b * nt..].iter().zip(&cell.transverse) {
                    band.add(i, visible[j], *x);
                }
                if first {
                    band.add(i, start.z[0], unit_z * block.by_z[0][b]);
                    band.add(i, start.z[1], unit_z * block.by_z[1][b]);
                    band.add(start.n, i, -block.transverse_step[b] / unit_n);
                }
                if last {
                    band.add(i, end.n, unit_n * block.by_n[b]);
                    band.add(end.z[0], i, block.step[0][b] / unit_z);
                    band.add(end.z[1], i, block.step[1][b] / unit_z);
                }
            }
            if first {
                band.add(start.n, start.n, 1.0);
                band.add(start.n, start.z[0], -block.mass * unit_z / unit_n);
            }
            if last {
                band.add(end.z[0], end.z[0], 1.0);
                band.add(end.z[1], end.z[1], 1.0);
            }
            if first && last {
                band.add(start.n, end.n, -1.0);
                band.add(end.z[0], start.z[0], -1.0);
                band.add(end.z[1], start.z[1], -1.0);
            }
        }
    }

    fn add_dense(&mut self, sums: &Sums, hub: &HubKinematics, w: &Weights<'_>, out: &mut Dense<f64>) {
        let [z1, z2, n] = &mut self.rows;
        let (order, most) = (z1.len(), self.ends.len() / sums.cells.len().max(1));
        let stride = out.order();
        for row in [&mut *z1, &mut *z2, &mut *n] {
            row.fill(0.0);
        }
        let add_row = |out: &mut Dense<f64>, i: usize, weight: f64, row: &[f64]| {
            for (out, x) in out.data_mut()[i * stride..].iter_mut().zip(row) {
                *out += weight * x;
            }
        };
        for (c, cell) in sums.cells.iter().enumerate() {
            let block = &mut self.block;
            block.fill(sums, c, self.tails[c], hub, w);
            let (na, nt) = (cell.axial.len(), cell.transverse.len());
            let step = &mut self.steps[c * order..(c + 1) * order];
            for (step, z) in step.iter_mut().zip(z1.iter()) {
                *step = block.mass * z;
            }
            for (a, &i) in cell.axial.iter().enumerate() {
                for (x, &j) in block.xy[a * nt..].iter().zip(&cell.transverse) {
                    out.add(i, j, *x);
                }
                add_row(out, i, block.axial_by_z[a], z1);
                step[i] += block.axial_step[a];
            }
            for (b, &i) in cell.transverse.iter().enumerate() {
                for (x, &j) in block.yx[b * na..].iter().zip(&cell.axial) {
                    out.add(i, j, *x);
                }
                for (x, &j) in block.yy[b * nt..].iter().zip(&cell.transverse) {
                    out.add(i, j, *x);
                }
                add_row(out, i, block.by_z[0][b], z1);
                add_row(out, i, block.by_z[1][b], z2);
                step[i] += block.transverse_step[b];
                self.ends[c * most + b] = block.by_n[b];
            }
            for (b, &i) in cell.transverse.iter().enumerate() {
                z1[i] -= block.step[0][b];
                z2[i] -= block.step[1][b];
            }
        }
        for (c, cell) in sums.cells.iter().enumerate().rev() {
            for (b, &i) in cell.transverse.iter().enumerate() {
                add_row(out, i, self.ends[c * most + b], n);
            }
            for (n, step) in n.iter_mut().zip(&self.steps[c * order..(c + 1) * order]) {
                *n += step;
            }
        }
    }
}

impl Block {
    /// Scratch for the cells of `sums`, of so many axial and transverse functions at most.
    fn new(sums: &Sums, na: usize, nt: usize) -> Block {
        let zeros = |n: usize| vec![0.0; n];
        let (points, rows) = (sums.points, sums.rows);
        Block {
            tension: zeros(points),
            g: [zeros(points), zeros(points)],
            z: [zeros(rows * nt), zeros(rows * nt)],
            lever: zeros(rows * nt),
            axial_by_z: zeros(na),
            by_z: [zeros(nt), zeros(nt)],
            by_n: zeros(nt),
            step: [zeros(nt), zeros(nt)],
            axial_step: zeros(na),
            transverse_step: zeros(nt),
            xy: zeros(na * nt),
            yx: zeros(na * nt),
            yy: zeros(nt * nt),
            mass: 0.0,
        }
    }

    fn clear(&mut self) {
        let [z1, z2] = &mut self.z;
        let [by1, by2] = &mut self.by_z;
        let [step1, step2] = &mut self.step;
        for vector in [
            &mut self.lever,
            &mut self.axial_by_z,
            &mut self.by_n,
            &mut self.axial_step,
            &mut self.transverse_step,
            &mut self.xy,
            &mut self.yx,
            &mut self.yy,
            z1,
            z2,
            by1,
            by2,
            step1,
            step2,
        ] {
            vector.fill(0.0);
        }
    }

    /// Cell `c`, at whose end N is `tail`.
    fn fill(&mut self, sums: &Sums, c: usize, tail: f64, hub: &HubKinematics, w: &Weights<'_>) {
        self.clear();
        let p = sums.points;
        let cell = &sums.cells[c];
        let (at, slope) = (sums.of_cell(c), &sums.slope[c * p..(c + 1) * p]);
        let (na, nt) = (cell.axial.len(), cell.transverse.len());
        let (om, al, h) = (hub.speed, hub.acceleration, cell.length);
        let (inertial, coriolis) = (w.a - w.q * om * om, w.q * al + 2.0 * w.v * om);
        for (k, [u, v, a]) in slope.iter().enumerate() {
            self.g[0][k] = w.q * a + 2.0 * w.v * v + inertial * u;
            self.g[1][k] = coriolis * u + 2.0 * om * w.q * v;
            self.tension[k] = sums.weights[k] * tail;
        }
        self.mass = cell.mass.iter().sum();
        for (g, &m) in cell.mass.iter().enumerate() {
            let force = m * axial_acceleration(&at[g], hub);
            let partial = &sums.partial[g * p..(g + 1) * p];
            let range = g * nt..(g + 1) * nt;
            let [z1, z2] = &mut self.z;
            let (z1, z2, lever) =
                (&mut z1[range.clone()], &mut z2[range.clone()], &mut self.lever[range.clone()]);
            for (k, s) in partial.iter().enumerate() {
                self.tension[k] += s * force;
                let s = h * s;
                let (s1, s2, s3) = (s * self.g[0][k], s * self.g[1][k], s * slope[k][0]);
                for (j, phi) in cell.slope[k * nt..(k + 1) * nt].iter().enumerate() {
                    z1[j] -= s1 * phi;
                    z2[j] -= s2 * phi;
                    lever[j] += s3 * phi;
                }
            }
            let (phi_x, phi_y) = (&cell.phi_x[g * na..(g + 1) * na], &cell.phi_y[range]);
            for (i, phi) in phi_x.iter().enumerate() {
                let m = m * phi;
                self.axial_by_z[i] += m;
                self.axial_step[i] += inertial * m;
                for (x, z) in self.xy[i * nt..].iter_mut().zip(z1.iter()) {
                    *x += m * z;
                }
            }
            for j in 0..nt {
                z1[j] -= coriolis * phi_y[j];
                self.transverse_step[j] += m * z1[j];
            }
            for i in 0..nt {
                let (own, lever) = (m * phi_y[i], m * lever[i]);
                self.by_z[0][i] -= lever;
                self.by_z[1][i] += own;
                for (x, phi) in self.yx[i * na..].iter_mut().zip(phi_x) {
                    *x -= lever * inertial * phi;
                }
                let (z1, z2) = (&z1[..nt], &z2[..nt]);
                for (j, x) in self.yy[i * nt..(i + 1) * nt].iter_mut().enumerate() {
                    *x += own * z2[j] - lever * z1[j];
                }
            }
        }
        for k in 0..p {
            let weight = h * sums.weights[k];
            let (s1, s2, s3) = (weight * self.g[0][k], weight * self.g[1][k], weight * slope[k][0]);
            let tension = w.q * h * self.tension[k];
            let phi = &cell.slope[k * nt..(k + 1) * nt];
            for i in 0..nt {
                self.step[0][i] += s1 * phi[i];
                self.step[1][i] += s2 * phi[i];
                self.by_n[i] -= s3 * phi[i];
                let tension = tension * phi[i];
                for (x, phi) in self.yy[i * nt..(i + 1) * nt].iter_mut().zip(phi) {
                    *x -= tension * phi;
                }
            }
        }
    }
}
