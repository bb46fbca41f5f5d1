//! Meshfree radial point interpolation (RPIM) with multiquadrics.
//!
//! ```text
//! w(x) = Σ Rᵢ(x) aᵢ + Σ p_j(x) b_j,   Rᵢ = [(x − xᵢ)² + (α_c d_c)²]^q,   Σ p_j(xᵢ) aᵢ = 0
//! ```
//!
//! over the nodes of a support domain, of half width α_s d_c about the middle of a cell (the interval
//! between two neighbouring nodes, d_c apart). The axial field interpolates the values at the nodes; the
//! transverse field values and slopes, with the derivatives of Rᵢ as further functions (Hermite type).
//! Since neighbouring cells interpolate the same data at their common node, the axial field is C⁰ and the
//! transverse field C¹ although their support domains differ.
//!
//! Sources: J. G. Wang & G. R. Liu, *Int. J. Numer. Methods Eng.* 54 (2002) 1623–1648,
//! doi:10.1002/nme.489; C. F. Du, D. G. Zhang & J. Z. Hong, *Chin. J. Theor. Appl. Mech.* 47 (2015)
//! 279–288, doi:10.6052/0459-1879-14-334, equations (11)–(37).

mod double;
mod patch;

use super::{Basis, BasisError, Conditioning, Field, Role, Support, uniform_cells};
use patch::{Fault, Layout, Patch};

/// Most nodes of a support domain: more are never better conditioned and cost their cube to invert.
const MOST_NODES: usize = 40;

/// Parameters of radial point interpolation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadialParameters {
    /// Number of equally spaced nodes, the clamped one at x = 0 included (≥ 2).
    pub nodes: usize,
    /// Shape parameter α_c (> 0): width of the radial functions over the node spacing.
    pub shape: f64,
    /// Exponent q of the multiquadric; whole numbers give polynomials and a singular moment matrix.
    pub exponent: f64,
    /// Half width α_s of the support domain over the node spacing (≥ ½).
    pub support: f64,
    /// Degree of the polynomials added to the radial functions; `None` adds none.
    pub degree: Option<usize>,
}

impl RadialParameters {
    /// `nodes` nodes with the default parameters α_c = 4, q = 1.03, α_s = 2.5, degree 3 (less for fewer
    /// than 4 nodes).
    ///
    /// With 11 nodes on a uniform cantilever they give the static tip deflection to rounding (cubics are
    /// reproduced) and the first bending frequency to 3e-9; 10 Hermite elements give it to 9e-7. α_c from 2
    /// to 7 changes the error from 2e-7 to 5e-11 and κ₁ of the moment matrix from 2e7 to 3e15.
    pub fn new(nodes: usize) -> RadialParameters {
        let degree = Some(nodes.saturating_sub(1).min(3));
        RadialParameters { nodes, shape: 4.0, exponent: 1.03, support: 2.5, degree }
    }
}

/// Radial point interpolation on [0, L]. Its formulas head the source file.
#[derive(Clone, Debug)]
pub struct Radial {
    cells: Vec<f64>,
    /// Node spacing d_c [m].
    spacing: f64,
    /// Unknowns of a node: 1 axial, 2 transverse.
    per_node: usize,
    /// Distinct patches, and for each cell (patch, first node).
    patches: Vec<Patch>,
    cell_patches: Vec<(usize, usize)>,
}

impl Radial {
    /// The basis on a beam of the given length \[m\].
    ///
    /// # Errors
    /// [`BasisError::Invalid`] if the length or a parameter is out of its range;
    /// [`BasisError::Singular`] if a moment matrix G is singular to working precision, κ₁(G)·2⁻⁵² ≥ 1 (the
    /// rounding of its own entries then decides what its inverse is), or if in 106-bit arithmetic some entry
    /// of G G⁻¹ − 1 is off by more than 1e-10 or the shape functions have noise above 1e-14 of their size.
    pub fn new(length: f64, parameters: RadialParameters, field: Field) -> Result<Radial, BasisError> {
        let RadialParameters { nodes, shape, exponent, support, degree } = parameters;
        let cells = uniform_cells(length, nodes.saturating_sub(1))?;
        let range = |name: &str, value: f64, holds: bool, needed: &str| {
            if holds && value.is_finite() {
                return Ok(());
            }
            Err(BasisError::Invalid(format!("{name} {value} of the radial basis must be {needed}")))
        };
        range("shape parameter", shape, shape > 0.0, "positive and finite; 2 to 7 serve well")?;
        range("exponent", exponent, true, "finite; 1.03 serves well")?;
        range("support", support, support >= 0.5, "at least 0.5, or a cell misses its own nodes")?;
        let per_node = if field == Field::Axial { 1 } else { 2 };
        let terms = degree.map_or(0, |degree| degree.saturating_add(1));
        let (mut patches, mut cell_patches) = (Vec::<Patch>::new(), Vec::new());
        for cell in 0..nodes - 1 {
            let middle = cell as f64 + 0.5;
            let first = (middle - support - 1e-9).ceil().max(0.0) as usize;
            let last = ((middle + support + 1e-9).floor() as usize).min(nodes - 1);
            let inside = first..last + 1;
            if inside.len() > MOST_NODES {
                return Err(BasisError::Invalid(format!(
                    "the support of {support} spacings holds {} nodes and at most {MOST_NODES} are inverted together; narrow it",
                    inside.len()
                )));
            }
            if terms > per_node * inside.len() {
                return Err(BasisError::Invalid(format!(
                    "polynomials of degree {} need {terms} data and the support of {support} spacings at x = {:.4} m holds {}; lower the degree or widen the support",
                    terms - 1,
                    middle * length / (nodes - 1) as f64,
                    per_node * inside.len()
                )));
            }
            let positions = inside.clone().map(|node| node as f64 - middle).collect();
            let layout = Layout { nodes: positions, slopes: per_node == 2, shape, exponent, terms };
            let known = patches.iter().position(|patch| patch.layout == layout);
            let index = match known {
                Some(index) => index,
                None => {
                    let place = || format!("x = {:.4} m", middle * length / (nodes - 1) as f64);
                    let singular = |number| BasisError::Singular {
                        basis: "radial",
                        number,
                        place: place(),
                        parameters: format!(
                            "shape {shape}, exponent {exponent}, support {support} with {} nodes, {terms} polynomial terms",
                            inside.len()
                        ),
                        advice: "lower the shape parameter, narrow the support or take an exponent that is not whole, such as 1.03",
                    };
                    patches.push(Patch::new(layout).map_err(|fault| match fault {
                        Fault::Singular(number) => singular(number),
                        Fault::Unresolved => BasisError::Invalid(format!(
                            "the radial functions vary too fast between the nodes at {} to be integrated; raise the shape parameter {shape}",
                            place()
                        )),
                    })?);
                    patches.len() - 1
                }
            };
            cell_patches.push((index, first));
        }
        Ok(Radial { spacing: length / (nodes - 1) as f64, cells, per_node, patches, cell_patches })
    }

    /// Functions of a patch that belong to the clamped root, 0 where it is not in the support.
    fn clamped(&self, first_node: usize) -> usize {
        if first_node == 0 { self.per_node } else { 0 }
    }
}

impl Basis for Radial {
    fn len(&self) -> usize {
        self.per_node * (self.cells.len() - 1)
    }

    fn cells(&self) -> &[f64] {
        &self.cells
    }

    fn points_per_cell(&self) -> usize {
        // Gauss points n integrate degree 2n − 1; the coefficients of a product of two resolved series
        // have fallen to rounding at the degree of one.
        self.patches.iter().map(Patch::degree).max().unwrap_or(0) / 2 + 3
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
        let xi = (x - 0.5 * (a + b)) / (b - a);
        let scale = self.spacing.powi(-(derivative as i32));
        for (out, k) in out.iter_mut().zip(self.clamped(first)..patch.functions()) {
            let slope = self.per_node == 2 && k % 2 == 1;
            let unit = if slope { self.spacing } else { 1.0 };
            *out = unit * scale * patch.eval(k, derivative, xi);
        }
        self.support(cell)
    }

    fn anchor(&self, i: usize) -> f64 {
        self.cells[i / self.per_node + 1]
    }

    fn role(&self, i: usize) -> Role {
        if self.per_node == 2 && i % 2 == 1 { Role::Slope } else { Role::Value }
    }

    fn conditioning(&self) -> Conditioning {
        let number = self.patches.iter().map(|patch| patch.condition).fold(1.0, f64::max);
        Conditioning { number, of: "moment matrices of the support domains" }
    }
}

#[cfg(test)]
mod tests;
