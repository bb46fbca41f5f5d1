//! Functionally graded rectangular sections: two materials mixed by a power law over the height.
//!
//! ```text
//! E(y) = (E_h − E_t) (y/h + ½)ᴺ + E_t,   ρ(y) alike,   −h/2 ≤ y ≤ h/2
//! ```
//!
//! h: ceramic, at y = +h/2; t: metal, at y = −h/2. With s = y/h + ½,
//!
//! ```text
//! I0 = ∫ sᴺ ds        = 1/(N+1)
//! I1 = ∫ sᴺ (s−½) ds  = N/(2 (N+1)(N+2))
//! I2 = ∫ sᴺ (s−½)² ds = (N²+N+2)/(4 (N+1)(N+2)(N+3))
//!
//! EA = b h (ΔE I0 + E_t),   ES = b h² ΔE I1,   EI = b h³ (ΔE I2 + E_t/12)
//! ρA = b h (Δρ I0 + ρ_t),   ρS = b h² Δρ I1,   ρI = b h³ (Δρ I2 + ρ_t/12)
//! ```
//!
//! valid for every real N ≥ 0. Their first three are E1, E2, E3 (times b) of the dynamics of rotating
//! graded beams in the literature, which drops ρS and ρI; so does [`Graded::new`].

use super::{Inertia, Resultants, Section, SectionError, positive};

/// A homogeneous elastic material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Young's modulus E \[Pa\].
    pub modulus: f64,
    /// Density ρ [kg/m³].
    pub density: f64,
}

/// A graded rectangular section. The law and its resultants head the source file.
#[derive(Clone, Debug, PartialEq)]
pub struct Graded {
    ceramic: Material,
    metal: Material,
    exponent: f64,
    height: f64,
    full: Resultants,
    kept: Resultants,
}

impl Graded {
    /// A section of the given width b and height h \[m\], `ceramic` at the top, `metal` at the bottom,
    /// mixed by the power `exponent` N ≥ 0. First mass moment and rotary inertia are left out unless requested
    /// for with [`Graded::with_inertia`].
    ///
    /// # Errors
    /// [`SectionError::Quantity`] if a quantity is not positive and finite (N may be 0).
    pub fn new(
        ceramic: Material,
        metal: Material,
        exponent: f64,
        width: f64,
        height: f64,
    ) -> Result<Graded, SectionError> {
        positive("Young's modulus of the ceramic", "Pa", ceramic.modulus)?;
        positive("density of the ceramic", "kg/m³", ceramic.density)?;
        positive("Young's modulus of the metal", "Pa", metal.modulus)?;
        positive("density of the metal", "kg/m³", metal.density)?;
        positive("width of the section", "m", width)?;
        positive("height of the section", "m", height)?;
        if !(exponent.is_finite() && exponent >= 0.0) {
            return Err(SectionError::Quantity {
                quantity: "grading exponent",
                unit: "",
                value: exponent,
                needed: "zero or positive, and finite",
            });
        }
        let moments = |ceramic: f64, metal: f64| {
            let (n, step) = (exponent, ceramic - metal);
            let i0 = 1.0 / (n + 1.0);
            let i1 = n / (2.0 * (n + 1.0) * (n + 2.0));
            let i2 = (n * n + n + 2.0) / (4.0 * (n + 1.0) * (n + 2.0) * (n + 3.0));
            [
                width * height * (step * i0 + metal),
                width * height * height * step * i1,
                width * height.powi(3) * (step * i2 + metal / 12.0),
            ]
        };
        let [axial_stiffness, coupling_stiffness, bending_stiffness] =
            moments(ceramic.modulus, metal.modulus);
        let [mass, first_moment, rotary_inertia] = moments(ceramic.density, metal.density);
        let full = Resultants {
            mass,
            first_moment,
            rotary_inertia,
            axial_stiffness,
            coupling_stiffness,
            bending_stiffness,
        };
        full.validate()?;
        let kept = Inertia::Translation.of(full);
        Ok(Graded { ceramic, metal, exponent, height, full, kept })
    }

    /// The same section with the given part of its inertia.
    #[must_use]
    pub fn with_inertia(self, inertia: Inertia) -> Graded {
        Graded { kept: inertia.of(self.full), ..self }
    }

    /// Young's modulus E \[Pa\] at height `y` \[m\], |y| ≤ h/2.
    pub fn modulus(&self, y: f64) -> f64 {
        (self.ceramic.modulus - self.metal.modulus) * self.share(y) + self.metal.modulus
    }

    /// Density ρ [kg/m³] at height `y` \[m\], |y| ≤ h/2.
    pub fn density(&self, y: f64) -> f64 {
        (self.ceramic.density - self.metal.density) * self.share(y) + self.metal.density
    }

    /// Volume share of the ceramic (y/h + ½)ᴺ.
    fn share(&self, y: f64) -> f64 {
        libm::pow((y / self.height + 0.5).clamp(0.0, 1.0), self.exponent)
    }
}

impl Section for Graded {
    fn resultants(&self, _x: f64) -> Resultants {
        self.kept
    }

    fn fibres(&self, _x: f64) -> Option<(f64, f64)> {
        Some((-0.5 * self.height, 0.5 * self.height))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quadrature::Gauss;

    const CERAMIC: Material = Material { modulus: 151e9, density: 3000.0 };
    const METAL: Material = Material { modulus: 70e9, density: 2707.0 };
    const WIDTH: f64 = 0.02;
    const HEIGHT: f64 = 0.05;

    /// b ∫ f(y) yᵏ dy, with s = z¹⁶ so that any power of s is smooth enough.
    fn moment(power: i32, f: impl Fn(f64) -> f64) -> f64 {
        Gauss::new(90).integrate(0.0, 1.0, |z: f64| {
            let y = HEIGHT * (z.powi(16) - 0.5);
            WIDTH * HEIGHT * f(y) * y.powi(power) * 16.0 * z.powi(15)
        })
    }

    #[test]
    fn resultants_are_the_integrals_of_the_power_law_for_any_exponent() {
        for exponent in [0.0, 0.2, 0.5, 1.0, 1.7, 2.0, 5.0, 10.0] {
            let section = Graded::new(CERAMIC, METAL, exponent, WIDTH, HEIGHT).unwrap();
            let full = section.clone().with_inertia(Inertia::Full).resultants(0.0);
            let [e0, e1, e2] = [0, 1, 2].map(|k| moment(k, |y| section.modulus(y)));
            let [r0, r1, r2] = [0, 1, 2].map(|k| moment(k, |y| section.density(y)));
            let (e, r) = (CERAMIC.modulus * WIDTH, CERAMIC.density * WIDTH);
            for (name, found, expected, scale) in [
                ("EA", full.axial_stiffness, e0, e * HEIGHT),
                ("ES", full.coupling_stiffness, e1, e * HEIGHT.powi(2)),
                ("EI", full.bending_stiffness, e2, e * HEIGHT.powi(3)),
                ("ρA", full.mass, r0, r * HEIGHT),
                ("ρS", full.first_moment, r1, r * HEIGHT.powi(2)),
                ("ρI", full.rotary_inertia, r2, r * HEIGHT.powi(3)),
            ] {
                let error = (found - expected).abs() / scale;
                assert!(error < 1e-13, "N = {exponent}: {name} is off by {error:.1e}");
            }
        }
    }

    #[test]
    fn exponent_zero_is_the_homogeneous_ceramic() {
        let r = Graded::new(CERAMIC, METAL, 0.0, WIDTH, HEIGHT).unwrap().resultants(0.0);
        assert!((r.axial_stiffness / (151e9 * WIDTH * HEIGHT) - 1.0).abs() < 1e-15);
        assert!((r.bending_stiffness / (151e9 * WIDTH * HEIGHT.powi(3) / 12.0) - 1.0).abs() < 1e-15);
        assert_eq!((r.coupling_stiffness, r.first_moment, r.rotary_inertia), (0.0, 0.0, 0.0));
    }

    #[test]
    fn inertia_is_left_out_until_asked_for() {
        let section = Graded::new(CERAMIC, METAL, 2.0, WIDTH, HEIGHT).unwrap();
        let inertia =
            |s: &Graded| (s.resultants(0.0).first_moment > 0.0, s.resultants(0.0).rotary_inertia > 0.0);
        assert_eq!(inertia(&section), (false, false));
        assert_eq!(inertia(&section.clone().with_inertia(Inertia::Rotary)), (false, true));
        assert_eq!(inertia(&section.with_inertia(Inertia::Full)), (true, true));
    }

    #[test]
    fn a_negative_exponent_is_refused() {
        let message = Graded::new(CERAMIC, METAL, -1.0, WIDTH, HEIGHT).unwrap_err().to_string();
        assert!(message.contains("grading exponent") && message.contains("-1"), "{message}");
    }
}
