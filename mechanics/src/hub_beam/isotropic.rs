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

use super::vectors::{Entry, Vectors};
use crate::linalg::Matrix;

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
    blocks: Box<[Block]>,
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
        let mut blocks = vec![Block::default(); order / NODE].into_boxed_slice();
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
                if near && !is_root(i) && !is_root(j) {
                    blocks[node(i) - 1].0[function(i)][HALF * (node(j) + 1 - node(i)) + function(j)] = m;
                }
            }
        }
        Some(Isotropic { blocks, root: (before == 1).then_some(root) })
    }

    /// Zeros in front of and behind vectors to multiply with.
    pub(super) fn padding(&self) -> [usize; 2] {
        [NODE, NODE]
    }

    /// Writes the products of M and Pᵀ − P with the first two vectors, row after row.
    pub(super) fn products(&self, x: &Vectors, out: &mut [Entry]) {
        let before = usize::from(self.root.is_some());
        let nodes = out[before..].as_chunks_mut::<NODE>().0;
        for (node, (block, out)) in self.blocks.iter().zip(nodes).enumerate() {
            *out = block.products(x.window::<{ 3 * NODE }>(before + NODE * node));
        }
        if let (Some([m, m0, m1]), [root, u, du, v, dv, ..]) = (self.root, out) {
            let x = x.window::<{ 1 + NODE }>(NODE);
            *root =
                [m * x[0][0] + m0 * x[1][0] + m1 * x[2][0], -2.0 * (m0 * x[3][1] + m1 * x[4][1]), 0.0, 0.0];
            u[0] += m0 * x[0][0];
            du[0] += m1 * x[0][0];
            v[1] += 2.0 * m0 * x[0][1];
            dv[1] += 2.0 * m1 * x[0][1];
        }
    }

    /// xᵀ M x
    pub(super) fn mass_form(&self, x: &[f64]) -> f64 {
        let nodes = x[usize::from(self.root.is_some())..].as_chunks::<NODE>().0;
        let mut sum = match (self.root, x) {
            (Some([m, m0, m1]), [root, u, du, ..]) => root * (m * root + 2.0 * (m0 * u + m1 * du)),
            _ => 0.0,
        };
        for (node, Block(rows)) in self.blocks.iter().enumerate() {
            for other in node.saturating_sub(1)..(node + 2).min(nodes.len()) {
                let (here, there) = (&nodes[node], &nodes[other]);
                for (i, row) in rows.iter().enumerate() {
                    for (j, m) in row[HALF * (other + 1 - node)..][..HALF].iter().enumerate() {
                        sum += m * (here[i] * there[j] + here[i + HALF] * there[j + HALF]);
                    }
                }
            }
        }
        sum
    }
}

impl Block {
    /// The rows of its node, of the entries of the vectors at the node before, its own and the one behind.
    #[inline(always)]
    fn products(&self, x: &[[f64; 2]]) -> [Entry; NODE] {
        let mut out = [Entry::default(); NODE];
        for (i, row) in self.0.iter().enumerate() {
            // Of m with what each vector has along the first axis, and along the second.
            let (mut first, mut second) = ([0.0; 2], [0.0; 2]);
            for (j, m) in row.iter().enumerate() {
                let at = NODE * (j / HALF) + j % HALF;
                for k in 0..2 {
                    first[k] += m * x[at][k];
                    second[k] += m * x[at + HALF][k];
                }
            }
            out[i] = [first[0], -2.0 * second[1], 0.0, 0.0];
            out[i + HALF] = [second[0], 2.0 * first[1], 0.0, 0.0];
        }
        out
    }
}
