//! Homogeneous sections whose dimensions change linearly from the root to the tip.
//!
//! Every dimension is d(x) = d_root + (d_tip − d_root) x/L; area and second moment follow from it, so that a
//! rectangle of linear height has a linear ρA and EA and a cubic EI, and a circle ρA of degree 2 and EI of
//! degree 4.

use super::{Inertia, Resultants, Section, SectionError, Shape, positive};

/// A tapered section. Its formulas head the source file.
#[derive(Clone, Debug, PartialEq)]
pub struct Tapered {
    modulus: f64,
    density: f64,
    length: f64,
    root: Shape,
    tip: Shape,
    inertia: Inertia,
}

impl Tapered {
    /// A section of Young's modulus E \[Pa\] and density ρ [kg/m³] over a beam of the given length \[m\], between
    /// two shapes of the same kind. Rotary inertia is left out unless requested with
    /// [`Tapered::with_inertia`].
    ///
    /// # Errors
    /// [`SectionError::Quantity`] if a quantity is not positive and finite, [`SectionError::Invalid`] if the
    /// shapes are of two kinds.
    pub fn new(
        modulus: f64,
        density: f64,
        length: f64,
        root: Shape,
        tip: Shape,
    ) -> Result<Tapered, SectionError> {
        positive("Young's modulus", "Pa", modulus)?;
        positive("density", "kg/m³", density)?;
        positive("length of the beam", "m", length)?;
        root.validate()?;
        tip.validate()?;
        if std::mem::discriminant(&root) != std::mem::discriminant(&tip) {
            return Err(SectionError::Invalid(format!(
                "a section cannot taper from {root:?} to {tip:?}: root and tip must be of one kind"
            )));
        }
        let section = Tapered { modulus, density, length, root, tip, inertia: Inertia::Full };
        for x in [0.0, length] {
            section.resultants(x).validate()?;
        }
        Ok(section.with_inertia(Inertia::Translation))
    }

    /// The same section with the given part of its inertia.
    #[must_use]
    pub fn with_inertia(self, inertia: Inertia) -> Tapered {
        Tapered { inertia, ..self }
    }

    /// The shape at station `x` \[m\].
    pub fn shape(&self, x: f64) -> Shape {
        let s = (x / self.length).clamp(0.0, 1.0);
        // Two kinds are refused by `new`.
        self.root.between(self.tip, s).unwrap_or(self.root)
    }
}

impl Section for Tapered {
    fn resultants(&self, x: f64) -> Resultants {
        let shape = self.shape(x);
        let (area, second_moment) = (shape.area(), shape.second_moment());
        self.inertia.of(Resultants {
            mass: self.density * area,
            rotary_inertia: self.density * second_moment,
            axial_stiffness: self.modulus * area,
            bending_stiffness: self.modulus * second_moment,
            ..Resultants::default()
        })
    }

    fn fibres(&self, x: f64) -> Option<(f64, f64)> {
        Some(self.shape(x).fibres())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROOT: Shape = Shape::Rectangle { width: 0.04, height: 0.03 };
    const TIP: Shape = Shape::Rectangle { width: 0.02, height: 0.01 };

    #[test]
    fn root_and_tip_have_the_given_shapes_and_the_middle_their_mean() {
        let section = Tapered::new(70e9, 2700.0, 2.0, ROOT, TIP).unwrap();
        for (x, width, height) in [(0.0, 0.04, 0.03), (1.0, 0.03, 0.02), (2.0, 0.02, 0.01)] {
            let r = section.resultants(x);
            for (found, exact) in [
                (r.mass, 2700.0 * width * height),
                (r.axial_stiffness, 70e9 * width * height),
                (r.bending_stiffness, 70e9 * width * height * height * height / 12.0),
            ] {
                assert!((found / exact - 1.0).abs() < 1e-14, "{found} for {exact}");
            }
            assert_eq!(r.rotary_inertia, 0.0);
            let (low, high) = section.fibres(x).unwrap();
            assert!((high - low - height).abs() < 1e-16);
        }
        let rotary = section.with_inertia(Inertia::Rotary).resultants(1.0).rotary_inertia;
        assert!((rotary - 2700.0 * 0.03 * 8e-6 / 12.0).abs() < 1e-16);
    }

    #[test]
    fn the_mass_of_a_truncated_cone_is_that_of_geometry() {
        let (root, tip) = (Shape::Circle { radius: 0.05 }, Shape::Circle { radius: 0.02 });
        let section = Tapered::new(70e9, 2700.0, 3.0, root, tip).unwrap();
        let found = crate::quadrature::Gauss::new(3).integrate(0.0, 3.0, |x| section.resultants(x).mass);
        let exact = 2700.0 * std::f64::consts::PI * 3.0 / 3.0 * (0.0025 + 0.001 + 0.0004);
        assert!((found / exact - 1.0).abs() < 1e-14, "{found} for {exact}");
    }

    #[test]
    fn what_makes_no_taper_is_refused() {
        let point = Shape::Rectangle { width: 0.02, height: 0.0 };
        assert!(Tapered::new(70e9, 2700.0, 2.0, ROOT, point).is_err());
        assert!(Tapered::new(70e9, 2700.0, 0.0, ROOT, TIP).is_err());
        let message =
            Tapered::new(70e9, 2700.0, 2.0, ROOT, Shape::Circle { radius: 0.1 }).unwrap_err().to_string();
        assert!(message.contains("one kind"), "{message}");
    }
}
