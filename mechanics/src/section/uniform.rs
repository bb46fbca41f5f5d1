//! Sections that are the same all along the beam.

use super::{Inertia, Resultants, Section, SectionError, Shape, positive};

/// A section that does not change along the beam, homogeneous or given by its resultants.
#[derive(Clone, Debug, PartialEq)]
pub struct Uniform {
    /// With all inertia.
    full: Resultants,
    /// As handed out.
    kept: Resultants,
    fibres: Option<(f64, f64)>,
}

impl Uniform {
    /// A homogeneous section: ρA, EA, EI and ρI from Young's modulus E \[Pa\], density ρ [kg/m³] and
    /// shape. Rotary inertia is left out unless requested with [`Uniform::with_inertia`].
    ///
    /// # Errors
    /// [`SectionError::Quantity`] if one of them is not positive and finite.
    pub fn from_material(modulus: f64, density: f64, shape: Shape) -> Result<Uniform, SectionError> {
        positive("Young's modulus", "Pa", modulus)?;
        positive("density", "kg/m³", density)?;
        shape.validate()?;
        let (area, second_moment) = (shape.area(), shape.second_moment());
        let full = Resultants {
            mass: density * area,
            rotary_inertia: density * second_moment,
            axial_stiffness: modulus * area,
            bending_stiffness: modulus * second_moment,
            ..Resultants::default()
        };
        full.validate()?;
        let section = Uniform { full, kept: full, fibres: Some(shape.fibres()) };
        Ok(section.with_inertia(Inertia::Translation))
    }

    /// A section given by its resultants, all of which are kept.
    ///
    /// # Errors
    /// As [`Resultants::validate`].
    pub fn from_resultants(resultants: Resultants) -> Result<Uniform, SectionError> {
        resultants.validate()?;
        Ok(Uniform { full: resultants, kept: resultants, fibres: None })
    }

    /// The same section with the given part of its inertia.
    #[must_use]
    pub fn with_inertia(self, inertia: Inertia) -> Uniform {
        Uniform { kept: inertia.of(self.full), ..self }
    }
}

impl Section for Uniform {
    fn resultants(&self, _x: f64) -> Resultants {
        self.kept
    }

    fn fibres(&self, _x: f64) -> Option<(f64, f64)> {
        self.fibres
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rectangle_of_aluminium_has_the_resultants_of_the_handbook() {
        // b = 0.1 m, h = 2.5 mm, E = 69 GPa, ρ = 2766 kg/m³: values computed by hand.
        let shape = Shape::Rectangle { width: 0.1, height: 2.5e-3 };
        let section = Uniform::from_material(69e9, 2766.0, shape).unwrap();
        let r = section.resultants(0.3);
        for (found, expected) in [
            (r.mass, 0.6915),
            (r.axial_stiffness, 17.25e6),
            (r.bending_stiffness, 8.984375),
            (r.coupling_stiffness, 0.0),
            (r.rotary_inertia, 0.0),
        ] {
            assert!((found - expected).abs() <= 1e-14 * expected, "{found} for {expected}");
        }
        let rotary = section.with_inertia(Inertia::Rotary).resultants(0.0).rotary_inertia;
        assert!((rotary - 2766.0 * 0.1 * 2.5e-3_f64.powi(3) / 12.0).abs() < 1e-20);
    }

    #[test]
    fn resultants_that_make_no_section_are_refused_by_name() {
        let good = Resultants {
            mass: 1.0,
            axial_stiffness: 4.0,
            bending_stiffness: 1.0,
            rotary_inertia: 0.1,
            ..Resultants::default()
        };
        assert!(Uniform::from_resultants(good).is_ok());
        for (bad, name) in [
            (Resultants { mass: 0.0, ..good }, "mass per length"),
            (Resultants { axial_stiffness: f64::NAN, ..good }, "axial stiffness"),
            (Resultants { bending_stiffness: -1.0, ..good }, "bending stiffness"),
            (Resultants { rotary_inertia: -0.1, ..good }, "rotary inertia"),
            (Resultants { coupling_stiffness: 2.0, ..good }, "coupling stiffness"),
            (Resultants { first_moment: 0.4, ..good }, "first mass moment"),
        ] {
            let message = Uniform::from_resultants(bad).unwrap_err().to_string();
            assert!(message.contains(name), "{message}");
        }
    }
}
