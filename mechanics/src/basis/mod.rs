//! Bases for the displacement fields of a beam, x ∈ [0, L], clamped at the root: each a file.

mod b_spline;
mod bezier;
#[cfg(test)]
pub(crate) mod checks;
pub(crate) mod conformance;
mod domains;
mod hermite;
mod lagrange;
mod massless_tip;
mod modes;
mod polynomial;
mod radial;

pub use b_spline::BSpline;
pub use bezier::Bezier;
pub use hermite::Hermite;
pub use lagrange::Lagrange;
pub use massless_tip::MasslessTip;
pub use modes::Modes;
pub use polynomial::{Polynomial, PolynomialParameters};
pub use radial::{Radial, RadialParameters};

use std::ops::Range;

/// The largest number of functions of any basis that do not vanish in one cell, and so the size of
/// buffer that is always enough for [`Basis::eval`] is [`Basis::max_support`].
pub type Support = Range<usize>;

/// What the coefficient of a basis function is: sets its unit and its scale.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// A displacement \[m\] at its anchor.
    Value,
    /// A slope \[1\] at its anchor.
    Slope,
    /// The amplitude \[m\] of a shape.
    Amplitude,
    /// The displacement \[m\] of a control point at its anchor.
    Control,
}

/// Which displacement field a basis is for: it decides what the clamp removes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Field {
    /// Axial field: φ(0) = 0.
    Axial,
    /// Transverse field: φ(0) = φ′(0) = 0.
    Transverse,
}

/// How well the functions are determined by the numbers that define them.
#[derive(Clone, Debug, PartialEq)]
pub struct Conditioning {
    /// Largest condition number of the matrices named by `of`; 1 if nothing is inverted.
    pub number: f64,
    /// What was inverted, or must be to use the functions, for people.
    pub of: &'static str,
}

impl Conditioning {
    /// Of a basis for which nothing is inverted.
    pub fn none() -> Conditioning {
        Conditioning { number: 1.0, of: "nothing" }
    }
}

/// The function of a basis whose coefficient moves the tip alone.
#[derive(Clone, Debug, PartialEq)]
pub struct Tip {
    /// Its number.
    pub function: usize,
    /// Functions of the last cell with their weights: the tip of a rigid beam, and of one that bends little, is at the sum of
    /// their coefficients.
    pub follows: Vec<(usize, f64)>,
}

/// A finite set of functions φ_i(x) on [0, L] that satisfy the clamp at x = 0.
///
/// The beam is cut into cells; inside a cell every function is smooth, and the functions that do
/// not vanish there are a contiguous range of indices (so that banded storage is natural).
///
/// A basis of one's own, here φ_i = (x/L)^(i + 2) in a single cell, is checked by [`verify::basis`](fn@crate::verify::basis):
///
/// ```
/// use flexion::basis::{Basis, Conditioning, Field, Role, Support};
///
/// #[derive(Debug)]
/// struct Monomials {
///     count: usize,
///     cells: [f64; 2],
/// }
///
/// impl Basis for Monomials {
///     fn len(&self) -> usize {
///         self.count
///     }
///     fn cells(&self) -> &[f64] {
///         &self.cells
///     }
///     // n Gauss points integrate degree 2n − 1: twice the highest power, and one for the weight.
///     fn points_per_cell(&self) -> usize {
///         self.count + 2
///     }
///     fn support(&self, _cell: usize) -> Support {
///         0..self.count
///     }
///     fn eval(&self, _cell: usize, x: f64, derivative: usize, out: &mut [f64]) -> Support {
///         let length = self.cells[1];
///         for i in 0..self.count {
///             let power = i + 2;
///             out[i] = if derivative > power {
///                 0.0
///             } else {
///                 let factor: f64 = (0..derivative).map(|k| (power - k) as f64 / length).product();
///                 factor * (x / length).powi((power - derivative) as i32)
///             };
///         }
///         0..self.count
///     }
///     fn anchor(&self, _i: usize) -> f64 {
///         self.cells[1]
///     }
///     fn role(&self, _i: usize) -> Role {
///         Role::Amplitude
///     }
///     fn conditioning(&self) -> Conditioning {
///         Conditioning::none()
///     }
/// }
///
/// let own = Monomials { count: 5, cells: [0.0, 10.0] };
/// assert_eq!(flexion::verify::basis(&own, Field::Transverse), []);
/// ```
pub trait Basis: Send + Sync + std::fmt::Debug {
    /// Number of functions.
    fn len(&self) -> usize;

    /// Whether the basis has no function at all.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Boundaries of the cells: ascending, first 0, last L \[m\].
    fn cells(&self) -> &[f64];

    /// Gauss points a cell needs so that products of two functions (or derivatives) and a linear
    /// weight are integrated exactly, or to working precision where they are not polynomials.
    fn points_per_cell(&self) -> usize;

    /// The functions that do not vanish in a cell.
    fn support(&self, cell: usize) -> Support;

    /// Largest `support(cell).len()`.
    fn max_support(&self) -> usize {
        (0..self.cells().len().saturating_sub(1)).map(|c| self.support(c).len()).max().unwrap_or(0)
    }

    /// Derivative `derivative` (0 to 3) of the functions `support(cell)` at `x` of that cell:
    /// `out[k]` = φ⁽ᵈ⁾ of function `support.start + k`. Returns the support.
    fn eval(&self, cell: usize, x: f64, derivative: usize, out: &mut [f64]) -> Support;

    /// Where along the beam function `i` belongs \[m\]: unknowns are numbered in this order.
    fn anchor(&self, i: usize) -> f64;

    /// What the coefficient of function `i` is.
    fn role(&self, i: usize) -> Role;

    /// Conditioning of the matrices behind the functions.
    fn conditioning(&self) -> Conditioning;

    /// The function that moves the tip alone, and what follows it where the tip has no mass: see [`MasslessTip`].
    fn tip(&self) -> Option<Tip> {
        None
    }

    /// The cell in which `x` lies (the right one at a boundary, the last one at L).
    fn locate(&self, x: f64) -> usize {
        let cells = self.cells();
        let inner = &cells[1..cells.len().saturating_sub(1).max(1)];
        inner.partition_point(|&end| end <= x)
    }
}

impl Basis for std::sync::Arc<dyn Basis> {
    fn len(&self) -> usize {
        (**self).len()
    }

    fn cells(&self) -> &[f64] {
        (**self).cells()
    }

    fn points_per_cell(&self) -> usize {
        (**self).points_per_cell()
    }

    fn support(&self, cell: usize) -> Support {
        (**self).support(cell)
    }

    fn max_support(&self) -> usize {
        (**self).max_support()
    }

    fn eval(&self, cell: usize, x: f64, derivative: usize, out: &mut [f64]) -> Support {
        (**self).eval(cell, x, derivative, out)
    }

    fn anchor(&self, i: usize) -> f64 {
        (**self).anchor(i)
    }

    fn role(&self, i: usize) -> Role {
        (**self).role(i)
    }

    fn tip(&self) -> Option<Tip> {
        (**self).tip()
    }

    fn conditioning(&self) -> Conditioning {
        (**self).conditioning()
    }

    fn locate(&self, x: f64) -> usize {
        (**self).locate(x)
    }
}

/// A basis that cannot be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BasisError {
    /// The moment matrix is singular to working precision.
    #[error(
        "the moment matrix of {basis} is singular to working precision: condition number {number:.1e} at {place} ({parameters}); {advice}"
    )]
    Singular {
        /// Basis as in a case file.
        basis: &'static str,
        /// Condition number.
        number: f64,
        /// Where, for people.
        place: String,
        /// The parameters in force.
        parameters: String,
        /// What to try.
        advice: &'static str,
    },
    /// The parameters make no basis.
    #[error("{0}")]
    Invalid(String),
}

/// Stations nearer to each other than this part of the length are one: the stiffness of an element is as the inverse of the cube of its
/// length, and rounding with it.
const ONE: f64 = 1e-5;

/// Ends of elements on [0, `length`] \[m\]: those of `elements` equal ones, and the `stations`, at which a load acts or a
/// section jumps. An end of the equal ones that is nearer than two fifths of their length to a station makes room for it. Stations that
/// differ by less than 1e-5 of the length are one.
///
/// # Errors
/// [`BasisError::Invalid`] if the length is not positive and finite or if there is no element.
pub fn mesh(length: f64, elements: usize, stations: &[f64]) -> Result<Vec<f64>, BasisError> {
    let equal = uniform_cells(length, elements)?;
    let h = length / elements as f64;
    let mut stations: Vec<f64> = stations.iter().copied().filter(|x| (0.0..length).contains(x)).collect();
    stations.sort_by(f64::total_cmp);
    let mut kept = vec![0.0];
    for x in stations {
        // An end of the equal elements is written as theirs, to the last digit.
        let nearest = equal[((x / h).round() as usize).min(elements)];
        let x = if (x - nearest).abs() < 1e-9 * h { nearest } else { x };
        if x - kept[kept.len() - 1] > ONE * length && length - x > ONE * length {
            kept.push(x);
        }
    }
    kept.push(length);
    let mut cells = kept.clone();
    cells.extend(equal.into_iter().filter(|cell| {
        let i = kept.partition_point(|x| x < cell).min(kept.len() - 1);
        let before = if i == 0 { f64::INFINITY } else { cell - kept[i - 1] };
        let room = |distance: f64, end: bool| distance > if end { 1e-9 * h } else { 0.4 * h };
        room(before, i == 1) && room(kept[i] - cell, i + 1 == kept.len())
    }));
    cells.sort_by(f64::total_cmp);
    Ok(cells)
}

/// Boundaries of `count` equal cells on [0, `length`].
fn uniform_cells(length: f64, count: usize) -> Result<Vec<f64>, BasisError> {
    if !(length.is_finite() && length > 0.0) {
        return Err(BasisError::Invalid(format!(
            "the length {length} m of the beam must be positive and finite"
        )));
    }
    if count == 0 {
        return Err(BasisError::Invalid("a beam needs at least one cell, and 0 were asked for".into()));
    }
    let boundary = |i| if i == count { length } else { length * (i as f64 / count as f64) };
    Ok((0..=count).map(boundary).collect())
}

/// Whether the boundaries ascend from 0.
fn check_cells(cells: &[f64]) -> Result<(), BasisError> {
    if cells.len() < 2 || cells[0] != 0.0 {
        return Err(BasisError::Invalid(
            "the boundaries of the cells must be at least two, the first 0".into(),
        ));
    }
    match cells.windows(2).find(|c| !(c[1].is_finite() && c[0] < c[1])) {
        Some(c) => Err(BasisError::Invalid(format!(
            "the boundaries of the cells must ascend, but {} m is followed by {} m",
            c[0], c[1]
        ))),
        None => Ok(()),
    }
}
