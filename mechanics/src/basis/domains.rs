//! Bases of moving support domains: the functions in a cell are those of the nodes within a half width α_s d_c about its middle (d_c the node spacing), in
//! ξ = (x − middle of the cell)/d_c.
//!
//! A cell is the interval between two neighbouring nodes. Where each point has a domain of its own, the nodes about it, it is cut where the nodes of the domain
//! change: the functions jump there.
//!
//! The unknowns are the values at the nodes for the axial field, values and slopes for the transverse one.

use super::{Basis, BasisError, Conditioning, Field, Role, Support, uniform_cells};

/// Part of an interval below which two places are one.
const SAME: f64 = 1e-9;

/// The functions of one support domain: first all of the first node, a value and in a transverse field a slope.
pub trait Patch: Send + Sync + std::fmt::Debug {
    /// Positions ξ of the nodes; the cell is in [−½, ½].
    fn nodes(&self) -> &[f64];

    /// Number of functions.
    fn functions(&self) -> usize;

    /// Derivative `derivative` of function `k` with respect to ξ, −½ ≤ ξ ≤ ½.
    fn eval(&self, k: usize, derivative: usize, xi: f64) -> f64;

    /// κ₁ of the moment matrix.
    fn condition(&self) -> f64;

    /// Gauss points of a cell that integrate products of the functions.
    fn points(&self) -> usize;
}

/// A basis of moving support domains on [0, L].
#[derive(Clone, Debug)]
pub struct Domains<P> {
    cells: Vec<f64>,
    /// Node spacing d_c \[m\].
    spacing: f64,
    /// Positions of the nodes \[m\].
    nodes: Vec<f64>,
    /// Unknowns of a node: 1 axial, 2 transverse.
    per_node: usize,
    /// Distinct patches, and for each cell (patch, first node).
    patches: Vec<P>,
    cell_patches: Vec<(usize, usize)>,
}

/// Unknowns of a node.
pub(super) fn per_node(field: Field) -> usize {
    if field == Field::Axial { 1 } else { 2 }
}

impl<P: Patch> Domains<P> {
    /// The basis of `nodes` nodes, of which the first is clamped, whose domains have the half width `support` ≥ ½, `per_point` or one a cell; `make`
    /// gives the patch of nodes at the positions ξ about x \[m\].
    pub(super) fn of(
        length: f64,
        nodes: usize,
        (support, per_point): (f64, bool),
        field: Field,
        make: impl Fn(Vec<f64>, f64) -> Result<P, BasisError>,
    ) -> Result<Domains<P>, BasisError> {
        let intervals = uniform_cells(length, nodes.saturating_sub(1))?;
        let spacing = length / (nodes - 1) as f64;
        // Parts of an interval at whose ends nodes enter the domain and leave it.
        let part = if per_point { support.fract() } else { 0.0 };
        let mut cuts = vec![0.0, part.min(1.0 - part), part.max(1.0 - part)];
        cuts.retain(|cut| *cut < 1.0 - SAME && (*cut == 0.0 || *cut > SAME));
        cuts.dedup_by(|a, b| (*a - *b).abs() < SAME);
        let within = |interval: usize| cuts.iter().map(move |cut| interval as f64 + cut);
        let starts: Vec<f64> = (0..nodes - 1).flat_map(within).collect();
        let place = |at: f64| {
            let interval = at as usize;
            if at == at.trunc() { intervals[interval] } else { intervals[interval] + spacing * at.fract() }
        };
        let cells: Vec<f64> = starts.iter().map(|at| place(*at)).chain([length]).collect();
        let (mut patches, mut cell_patches) = (Vec::<P>::new(), Vec::new());
        for (cell, start) in starts.iter().enumerate() {
            let end = starts.get(cell + 1).copied().unwrap_or((nodes - 1) as f64);
            let middle = 0.5 * (start + end);
            let first = (middle - support - 1e-9).ceil().max(0.0) as usize;
            let last = ((middle + support + 1e-9).floor() as usize).min(nodes - 1);
            let positions: Vec<f64> = (first..=last).map(|node| node as f64 - middle).collect();
            let known = patches.iter().position(|patch| patch.nodes() == positions);
            cell_patches.push((known.unwrap_or(patches.len()), first));
            if known.is_none() {
                patches.push(make(positions, middle * spacing)?);
            }
        }
        Ok(Domains { cells, spacing, nodes: intervals, per_node: per_node(field), patches, cell_patches })
    }

    /// Functions of a patch that belong to the clamped root, 0 where it is not in the support.
    fn clamped(&self, first_node: usize) -> usize {
        if first_node == 0 { self.per_node } else { 0 }
    }
}

impl<P: Patch> Basis for Domains<P> {
    fn len(&self) -> usize {
        self.per_node * (self.nodes.len() - 1)
    }

    fn cells(&self) -> &[f64] {
        &self.cells
    }

    fn points_per_cell(&self) -> usize {
        self.patches.iter().map(P::points).max().unwrap_or(1)
    }

    fn support(&self, cell: usize) -> Support {
        let (patch, first) = self.cell_patches[cell];
        let start = (first * self.per_node).saturating_sub(self.per_node);
        start..start + self.patches[patch].functions() - self.clamped(first)
    }

    fn eval(&self, cell: usize, x: f64, derivative: usize, out: &mut [f64]) -> Support {
        let (patch, first) = self.cell_patches[cell];
        let patch = &self.patches[patch];
        let (a, b) = (self.cells[cell], self.cells[cell + 1]);
        let xi = (x - 0.5 * (a + b)) / self.spacing;
        let scale = self.spacing.powi(-(derivative as i32));
        for (out, k) in out.iter_mut().zip(self.clamped(first)..patch.functions()) {
            let slope = self.per_node == 2 && k % 2 == 1;
            let unit = if slope { self.spacing } else { 1.0 };
            *out = unit * scale * patch.eval(k, derivative, xi);
        }
        self.support(cell)
    }

    fn anchor(&self, i: usize) -> f64 {
        self.nodes[i / self.per_node + 1]
    }

    fn role(&self, i: usize) -> Role {
        if self.per_node == 2 && i % 2 == 1 { Role::Slope } else { Role::Value }
    }

    fn conditioning(&self) -> Conditioning {
        let number = self.patches.iter().map(P::condition).fold(1.0, f64::max);
        Conditioning { number, of: "moment matrices of the support domains" }
    }
}
