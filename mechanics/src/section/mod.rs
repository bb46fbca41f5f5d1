//! Cross-sections: each a file; all give [`Resultants`] along the beam.

mod blade;
mod ends;
mod graded;
mod matrices;
mod matrix_table;
mod piecewise;
mod shape;
mod table;
mod tapered;
mod uniform;

pub use blade::{
    AsStiffAcross, BladeResultants, BladeSection, HomogeneousBlade, PlanarBlade, PlanarProjection,
    UniformBlade,
};
pub use graded::{Graded, Material};
pub use matrices::{Matrices, Matrix6};
pub use matrix_table::MatrixTable;
pub use piecewise::{Piecewise, Segment};
pub use shape::Shape;
pub use table::{Interpolation, Table};
pub use tapered::Tapered;
pub use uniform::Uniform;

/// Stiffness and inertia resultants of a planar section at a station. y is the height over the
/// reference axis, in the plane of motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Resultants {
    /// Mass per length ρA = ∫ρ dA [kg/m].
    pub mass: f64,
    /// First mass moment ρS = ∫ρ y dA \[kg\]; 0 where it is left out.
    pub first_moment: f64,
    /// Rotary inertia ρI = ∫ρ y² dA [kg·m]; 0 where it is left out.
    pub rotary_inertia: f64,
    /// Axial stiffness EA = ∫E dA \[N\].
    pub axial_stiffness: f64,
    /// Coupling stiffness ES = ∫E y dA [N·m].
    pub coupling_stiffness: f64,
    /// Bending stiffness EI = ∫E y² dA [N·m²].
    pub bending_stiffness: f64,
}

impl Resultants {
    /// Whether strain and kinetic energy are positive: ρA, EA, EI > 0, ES² < EA EI, and ρS² ≤ ρA ρI.
    ///
    /// # Errors
    /// [`SectionError`] names the first quantity that is out of range.
    pub fn validate(&self) -> Result<(), SectionError> {
        positive("mass per length ρA", "kg/m", self.mass)?;
        positive("axial stiffness EA", "N", self.axial_stiffness)?;
        positive("bending stiffness EI", "N·m²", self.bending_stiffness)?;
        if !(self.rotary_inertia.is_finite() && self.rotary_inertia >= 0.0) {
            return Err(SectionError::Quantity {
                quantity: "rotary inertia ρI",
                unit: "kg·m",
                value: self.rotary_inertia,
                needed: "zero or positive, and finite",
            });
        }
        let bound = (self.axial_stiffness * self.bending_stiffness).sqrt();
        if self.coupling_stiffness.is_nan() || self.coupling_stiffness.abs() >= bound {
            return Err(SectionError::Indefinite {
                quantity: "coupling stiffness ES",
                unit: "N·m",
                value: self.coupling_stiffness,
                bound,
                of: "√(EA·EI)",
                energy: "strain",
            });
        }
        let bound = (self.mass * self.rotary_inertia).sqrt();
        if self.first_moment.is_nan() || self.first_moment.abs() > bound {
            return Err(SectionError::Indefinite {
                quantity: "first mass moment ρS",
                unit: "kg",
                value: self.first_moment,
                bound,
                of: "√(ρA·ρI)",
                energy: "kinetic",
            });
        }
        Ok(())
    }
}

/// Which part of a section's inertia the beam keeps. The first moment is never kept without the rotary
/// inertia: the kinetic energy of short waves would be negative.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Inertia {
    /// ρA alone.
    #[default]
    Translation,
    /// ρA and ρI.
    Rotary,
    /// ρA, ρS and ρI.
    Full,
}

impl Inertia {
    /// The resultants with only this part of the inertia.
    fn of(self, mut full: Resultants) -> Resultants {
        if self != Inertia::Full {
            full.first_moment = 0.0;
        }
        if self == Inertia::Translation {
            full.rotary_inertia = 0.0;
        }
        full
    }
}

/// A quantity that makes no section.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SectionError {
    /// A quantity is out of its range.
    #[error("the {quantity} is {value} {unit} and must be {needed}")]
    Quantity {
        /// Quantity.
        quantity: &'static str,
        /// Its SI unit.
        unit: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        needed: &'static str,
    },
    /// An energy that must be positive is not.
    #[error(
        "the {quantity} is {value} {unit}: its magnitude must stay below {of} = {bound} {unit}, or the {energy} energy is not positive"
    )]
    Indefinite {
        /// Quantity.
        quantity: &'static str,
        /// Its SI unit.
        unit: &'static str,
        /// Its value.
        value: f64,
        /// Largest magnitude.
        bound: f64,
        /// Formula of the bound.
        of: &'static str,
        /// Which energy.
        energy: &'static str,
    },
    /// The parts do not make a section of the beam.
    #[error("{0}")]
    Invalid(String),
}

/// Refuses a quantity that is not positive and finite.
fn positive(quantity: &'static str, unit: &'static str, value: f64) -> Result<(), SectionError> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    Err(SectionError::Quantity { quantity, unit, value, needed: "positive and finite" })
}

/// A cross-section along the beam.
///
/// A section of one's own, here a square bar whose sides narrow as e^(−x/h), is checked by
/// [`verify::section`](fn@crate::verify::section):
///
/// ```
/// use flexion::section::{Resultants, Section};
///
/// #[derive(Debug)]
/// struct Horn {
///     root_side: f64,
///     h: f64,
/// }
///
/// impl Section for Horn {
///     fn resultants(&self, x: f64) -> Resultants {
///         let (modulus, density) = (70e9, 2700.0);
///         let side = self.root_side * (-x / self.h).exp();
///         let (area, second_moment) = (side.powi(2), side.powi(4) / 12.0);
///         Resultants {
///             mass: density * area,
///             rotary_inertia: density * second_moment,
///             axial_stiffness: modulus * area,
///             bending_stiffness: modulus * second_moment,
///             ..Resultants::default()
///         }
///     }
///     fn fibres(&self, x: f64) -> Option<(f64, f64)> {
///         let side = self.root_side * (-x / self.h).exp();
///         Some((-0.5 * side, 0.5 * side))
///     }
/// }
///
/// let own = Horn { root_side: 0.1, h: 8.0 };
/// assert_eq!(flexion::verify::section(&own, 10.0), []);
/// ```
pub trait Section: Send + Sync + std::fmt::Debug {
    /// Resultants at station `x` \[m\].
    fn resultants(&self, x: f64) -> Resultants;

    /// Stations inside (0, L) at which the resultants jump or kink: cells end there.
    fn breaks(&self) -> &[f64] {
        &[]
    }

    /// Those of the breaks at which the resultants jump.
    fn jumps(&self) -> &[f64] {
        &[]
    }

    /// Stations inside the beam at which its elements should end that have the ends `cells`, or do already, where elements of the length `h` \[m\]
    /// were asked for: the jumps, and of the other breaks those without which the section within an element would be far from a straight line.
    fn ends(&self, cells: &[f64], h: f64) -> Vec<f64> {
        let values = |x: f64| {
            let r = self.resultants(x);
            [
                r.mass,
                r.first_moment,
                r.rotary_inertia,
                r.axial_stiffness,
                r.coupling_stiffness,
                r.bending_stiffness,
            ]
        };
        ends::ends(cells, h, (self.breaks(), self.jumps()), &values)
    }

    /// Heights of the lower and upper fibre \[m\] if the shape of the section is known.
    fn fibres(&self, _x: f64) -> Option<(f64, f64)> {
        None
    }
}

impl Section for std::sync::Arc<dyn Section> {
    fn resultants(&self, x: f64) -> Resultants {
        (**self).resultants(x)
    }

    fn breaks(&self) -> &[f64] {
        (**self).breaks()
    }

    fn jumps(&self) -> &[f64] {
        (**self).jumps()
    }

    fn ends(&self, cells: &[f64], h: f64) -> Vec<f64> {
        (**self).ends(cells, h)
    }

    fn fibres(&self, x: f64) -> Option<(f64, f64)> {
        (**self).fibres(x)
    }
}
