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
//! transverse field C¹ although their support domains differ. With a support domain for each point the fields jump where a node enters or leaves it.
//!
//! Sources: J. G. Wang & G. R. Liu, *Int. J. Numer. Methods Eng.* 54 (2002) 1623–1648,
//! doi:10.1002/nme.489; C. F. Du, D. G. Zhang & J. Z. Hong, *Chin. J. Theor. Appl. Mech.* 47 (2015)
//! 279–288, doi:10.6052/0459-1879-14-334, equations (11)–(37).

mod double;
mod patch;

use super::domains::{Domains, per_node};
use super::{BasisError, Field};
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
    /// Whether each point has a support domain of its own, as in the paper, and not each cell. The field jumps inside of the beam, where a node enters the
    /// domain; the energy does not see the jumps.
    pub per_point: bool,
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
        RadialParameters { nodes, shape: 4.0, exponent: 1.03, support: 2.5, degree, per_point: false }
    }
}

/// Radial point interpolation on [0, L]. Its formulas head the source file.
pub type Radial = Domains<Patch>;

impl Radial {
    /// The basis on a beam of the given length \[m\].
    ///
    /// # Errors
    /// [`BasisError::Invalid`] if the length or a parameter is out of its range;
    /// [`BasisError::Singular`] if a moment matrix G is singular to working precision, κ₁(G)·2⁻⁵² ≥ 1 (the
    /// rounding of its own entries then decides what its inverse is), or if in 106-bit arithmetic some entry
    /// of G G⁻¹ − 1 is off by more than 1e-10 or the shape functions have noise above 1e-14 of their size.
    pub fn new(length: f64, parameters: RadialParameters, field: Field) -> Result<Radial, BasisError> {
        let RadialParameters { nodes, shape, exponent, support, degree, per_point } = parameters;
        let range = |name: &str, value: f64, holds: bool, needed: &str| {
            if holds && value.is_finite() {
                return Ok(());
            }
            Err(BasisError::Invalid(format!("{name} {value} of the radial basis must be {needed}")))
        };
        range("shape parameter", shape, shape > 0.0, "positive and finite; 2 to 7 serve well")?;
        range("exponent", exponent, true, "finite; 1.03 serves well")?;
        range("support", support, support >= 0.5, "at least 0.5, or a cell misses its own nodes")?;
        let terms = degree.map_or(0, |degree| degree.saturating_add(1));
        Domains::of(length, nodes, (support, per_point), field, |positions, x| {
            let count = positions.len();
            if count > MOST_NODES {
                return Err(BasisError::Invalid(format!(
                    "the support of {support} spacings holds {count} nodes and at most {MOST_NODES} are inverted together; narrow it"
                )));
            }
            let data = per_node(field) * count;
            if terms > data {
                return Err(BasisError::Invalid(format!(
                    "polynomials of degree {} need {terms} data and the support of {support} spacings at x = {x:.4} m holds {data}; lower the degree or widen the support",
                    terms - 1
                )));
            }
            let layout = Layout { nodes: positions, slopes: field != Field::Axial, shape, exponent, terms };
            Patch::new(layout).map_err(|fault| match fault {
                Fault::Singular(number) => BasisError::Singular {
                    basis: "radial",
                    number,
                    place: format!("x = {x:.4} m"),
                    parameters: format!(
                        "shape {shape}, exponent {exponent}, support {support} with {count} nodes, {terms} polynomial terms"
                    ),
                    advice: "lower the shape parameter, narrow the support or take an exponent that is not whole, such as 1.03",
                },
                Fault::Unresolved => BasisError::Invalid(format!(
                    "the radial functions vary too fast between the nodes at x = {x:.4} m to be integrated; raise the shape parameter {shape}"
                )),
            })
        })
    }
}

#[cfg(test)]
mod tests;
