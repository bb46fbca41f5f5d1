//! Mass and gyroscopic matrices of fields along both axes that are of one basis: one matrix m serves all.
//!
//! A point has the same mass along both axes. With the unknowns of a node in the order (U, U′, V, V′) and the functions of both fields
//! the same,
//!
//! ```text
//! M = ⎡m  0⎤    Pᵀ − P = ⎡ 0  −2m⎤      of the blocks U and V,
//!     ⎣0  m⎦             ⎣2m    0⎦
//! ```
//!
//! and m is block-tridiagonal with blocks of 2 × 2, an eighth of the entries of the band that holds M and Pᵀ − P. At the clamped root
//! U′, the strain there, may be an unknown.
//!
//! The vectors that m multiplies have components along both axes: those of U and V, and of U′ and V′, of one node after the other. Of the
//! motion of the hub they take up what the equations of [`super::inertia`] have apart,
//!
//! ```text
//! M a + (Pᵀ − P)(ω v + ½ω̇ q) − ω² M q = m A,   A = p̈ + 2ωJṗ + ω̇Jp − ω²p
//! ```

use super::hub::absolute;
use super::vectors::Entry;
use crate::linalg::Matrix;
use crate::linalg::vector::inner;
use crate::profile::HubKinematics;
use crate::system::State;
use std::sync::Arc;

/// Unknowns of a node along one axis, and of a node.
const HALF: usize = 2;
const NODE: usize = 2 * HALF;

/// Difference of entries that are the same but for rounding, over the largest.
const SAME: f64 = 1e-14;

/// Rows of m of one node: its entries with the node before, with itself, and with the node behind.
#[derive(Clone, Copy, Debug, Default)]
struct Block([[f64; 3 * HALF]; HALF]);

/// The matrix m of the header.
#[derive(Clone, Debug)]
pub(super) struct Isotropic {
    blocks: Arc<[Block]>,
    /// Entries of the U′ of the root with itself, and with U and U′ of the first node.
    root: Option<[f64; 1 + HALF]>,
}

impl Isotropic {
    /// The matrix m of the matrices M and Pᵀ − P of this many rows, if they are of this form; `reach` is how far entries lie from the diagonal.
    pub(super) fn of(order: usize, reach: usize, mass: &Matrix, gyroscopic: &Matrix) -> Option<Isotropic> {
        // Unknowns of the root.
        let before = order % NODE;
        if before > 1 || order < NODE {
            return None;
        }
        let largest = (0..order).fold(0.0_f64, |most, i| most.max(mass.get(i, i).abs()));
        let same = |a: f64, b: f64| (a - b).abs() <= SAME * largest;
        let is_root = |i: usize| i < before;
        let node = |i: usize| if is_root(i) { 0 } else { 1 + (i - before) / NODE };
        let function = |i: usize| if is_root(i) { HALF - 1 } else { (i - before) % HALF };
        let second = |i: usize| !is_root(i) && (i - before) % NODE >= HALF;
        let along_first = |i: usize| if second(i) { i - HALF } else { i };
        let mut blocks = vec![Block::default(); order / NODE];
        let mut root = [0.0; 1 + HALF];
        for i in 0..order {
            for j in i.saturating_sub(reach)..(i + reach + 1).min(order) {
                let near = node(i).abs_diff(node(j)) <= 1;
                let m = if near { mass.get(along_first(i), along_first(j)) } else { 0.0 };
                let expected = match (second(i), second(j)) {
                    (false, false) | (true, true) => [m, 0.0],
                    (false, true) => [0.0, -2.0 * m],
                    (true, false) => [0.0, 2.0 * m],
                };
                if !(same(mass.get(i, j), expected[0]) && same(gyroscopic.get(i, j), expected[1])) {
                    return None;
                }
                if is_root(i) && near && !second(j) {
                    root[j] = m;
                }
                if near && !is_root(i) {
                    blocks[node(i) - 1].0[function(i)][HALF * (node(j) + 1 - node(i)) + function(j)] = m;
                }
            }
        }
        Some(Isotropic { blocks: blocks.into(), root: (before == 1).then_some(root) })
    }

    /// Memory for vectors to multiply, and for their products: the root in front, zeros behind the tip.
    pub(super) fn scratch(&self) -> Plane {
        let zeros = || vec![[0.0; 2]; HALF * (self.blocks.len() + 2)];
        Plane { vector: zeros(), product: zeros() }
    }

    /// Writes m A to `r`, with the forces βMv of a damping.
    pub(super) fn inertia_forces(
        &self,
        s: &State,
        hub: &HubKinematics,
        damping: f64,
        x: &mut Plane,
        r: &mut [f64],
    ) {
        let at = |q: &[f64; 2], v: &[f64; 2], a: &[f64; 2]| {
            absolute(*q, *v, [a[0] + damping * v[0], a[1] + damping * v[1]], hub)
        };
        if self.root.is_some() {
            x.vector[1] = at(&[s.q[0], 0.0], &[s.v[0], 0.0], &[s.a[0], 0.0]);
        }
        let states = self.nodes(&s.q).iter().zip(self.nodes(&s.v)).zip(self.nodes(&s.a));
        for (x, ((q, v), a)) in x.vector[HALF..].as_chunks_mut::<HALF>().0.iter_mut().zip(states) {
            for k in 0..HALF {
                x[k] = at(&[q[k], q[k + HALF]], &[v[k], v[k + HALF]], &[a[k], a[k + HALF]]);
            }
        }
        self.multiply(x);
        if self.root.is_some() {
            r[0] = x.product[1][0];
        }
        let nodes = r[usize::from(self.root.is_some())..].as_chunks_mut::<NODE>().0;
        for (r, [value, slope]) in nodes.iter_mut().zip(x.product[HALF..].as_chunks::<HALF>().0) {
            *r = [value[0], slope[0], value[1], slope[1]];
        }
    }

    /// Writes M y and (Pᵀ − P) y, row after row.
    pub(super) fn products(&self, y: &[f64], x: &mut Plane, out: &mut [Entry]) {
        self.apply(y, x);
        let entries = |p: [f64; 2]| [[p[0], -2.0 * p[1], 0.0, 0.0], [p[1], 2.0 * p[0], 0.0, 0.0]];
        if self.root.is_some() {
            [out[0], _] = entries(x.product[1]);
        }
        let nodes = out[usize::from(self.root.is_some())..].as_chunks_mut::<NODE>().0;
        for (out, [value, slope]) in nodes.iter_mut().zip(x.product[HALF..].as_chunks::<HALF>().0) {
            let ([u, v], [du, dv]) = (entries(*value), entries(*slope));
            *out = [u, du, v, dv];
        }
    }

    /// yᵀ M y
    pub(super) fn form(&self, y: &[f64], x: &mut Plane) -> f64 {
        self.apply(y, x);
        x.vector.iter().zip(&x.product).map(|(y, my)| inner(*y, *my)).sum()
    }

    /// The unknowns of the nodes without those of the root.
    fn nodes<'a>(&self, y: &'a [f64]) -> &'a [[f64; NODE]] {
        y[usize::from(self.root.is_some())..].as_chunks::<NODE>().0
    }

    /// m y
    fn apply(&self, y: &[f64], x: &mut Plane) {
        if self.root.is_some() {
            x.vector[1] = [y[0], 0.0];
        }
        for (x, y) in x.vector[HALF..].as_chunks_mut::<HALF>().0.iter_mut().zip(self.nodes(y)) {
            for k in 0..HALF {
                x[k] = [y[k], y[k + HALF]];
            }
        }
        self.multiply(x);
    }

    /// The product of m with the vector.
    fn multiply(&self, x: &mut Plane) {
        let Plane { vector, product } = x;
        if let (Some([m, m0, m1]), [_, root, u, du, ..]) = (self.root, &vector[..]) {
            product[1] = [0, 1].map(|c| m * root[c] + m0 * u[c] + m1 * du[c]);
        }
        let products = product[HALF..].as_chunks_mut::<HALF>().0;
        for (node, (Block(rows), out)) in self.blocks.iter().zip(products).enumerate() {
            let Some(x) = vector[HALF * node..].first_chunk::<{ 3 * HALF }>() else { return };
            for (row, out) in rows.iter().zip(out) {
                let mut sum = [0.0; 2];
                for (m, x) in row.iter().zip(x) {
                    sum[0] += m * x[0];
                    sum[1] += m * x[1];
                }
                *out = sum;
            }
        }
    }
}

/// A vector with components along both axes, two values at each node, and its product with m.
#[derive(Clone, Debug)]
pub(super) struct Plane {
    vector: Vec<[f64; 2]>,
    product: Vec<[f64; 2]>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::Structure;

    /// M and Pᵀ − P of three nodes, with U′ of the root or without it, and an entry that is of another form.
    fn matrices(root: usize, odd: f64) -> (Structure, [Matrix; 2]) {
        let (order, structure) = (12 + root, Structure::band(12 + root, 7, 7, 0));
        let [mut mass, mut gyroscopic] = [(); 2].map(|()| Matrix::new(&structure));
        // U and U′ node after node, beginning with the U′ of the root.
        let unknown = |k: usize, second: bool| {
            if k < root {
                k
            } else {
                root + NODE * ((k - root) / HALF) + (k - root) % HALF + HALF * usize::from(second)
            }
        };
        for i in 0..6 + root {
            for j in 0..6 + root {
                let node = |k: usize| if k < root { 0 } else { 1 + (k - root) / HALF };
                if node(i).abs_diff(node(j)) > 1 {
                    continue;
                }
                let m = 1.0 / (1 + i + j) as f64 + if i == j { 3.0 } else { 0.0 };
                let there = |k: usize, second: bool| (k >= root || !second).then(|| unknown(k, second));
                for (second, sign) in [(false, -2.0), (true, 2.0)] {
                    if let (Some(row), Some(column)) = (there(i, second), there(j, second)) {
                        mass.add(row, column, m);
                    }
                    if let (Some(row), Some(column)) = (there(i, second), there(j, !second)) {
                        gyroscopic.add(row, column, sign * m);
                    }
                }
            }
        }
        mass.add(order - 1, order - 1, odd);
        (structure, [mass, gyroscopic])
    }

    #[test]
    fn products_forms_and_forces_are_those_of_the_matrices() {
        for root in [0, 1] {
            let (_, [mass, gyroscopic]) = matrices(root, 0.0);
            let order = 12 + root;
            let isotropic = Isotropic::of(order, 7, &mass, &gyroscopic).unwrap();
            let mut plane = isotropic.scratch();
            let [q, v, a]: [Vec<f64>; 3] =
                [2.3, 0.7, 1.9].map(|w| (0..order).map(|i| libm::sin(1.0 + w * i as f64)).collect());
            let of = |matrix: &Matrix, x: &[f64]| {
                let mut product = vec![0.0; order];
                matrix.multiply(x, &mut product);
                product
            };
            let mut products = vec![Entry::default(); order];
            isotropic.products(&q, &mut plane, &mut products);
            let (mq, gq) = (of(&mass, &q), of(&gyroscopic, &q));
            for i in 0..order {
                let [m, g, ..] = products[i];
                assert!((m - mq[i]).abs() < 1e-14 && (g - gq[i]).abs() < 1e-14, "{root} {i}: {m} {g}");
            }
            let form: f64 = q.iter().zip(&mq).map(|(a, b)| a * b).sum();
            assert!((isotropic.form(&q, &mut plane) - form).abs() < 1e-13 * form, "{root}");

            let hub = HubKinematics { angle: 0.0, speed: 1.7, acceleration: -0.9 };
            let (w, w1, damping) = (hub.speed, hub.acceleration, 0.3);
            let inertial: Vec<f64> = (0..order).map(|i| a[i] + damping * v[i] - w * w * q[i]).collect();
            let turning: Vec<f64> = (0..order).map(|i| w * v[i] + 0.5 * w1 * q[i]).collect();
            let (first, second) = (of(&mass, &inertial), of(&gyroscopic, &turning));
            let mut forces = vec![0.0; order];
            let state = State { q, v, a, ..State::default() };
            isotropic.inertia_forces(&state, &hub, damping, &mut plane, &mut forces);
            for i in 0..order {
                let expected = first[i] + second[i];
                assert!((forces[i] - expected).abs() < 1e-13, "{root} {i}: {} {expected}", forces[i]);
            }
        }
    }

    #[test]
    fn a_mass_that_is_another_along_the_second_axis_is_not_isotropic() {
        let (_, [mass, gyroscopic]) = matrices(1, 1e-9);
        assert!(Isotropic::of(13, 7, &mass, &gyroscopic).is_none());
    }
}
