//! Sections of a blade: stiffness and inertia for extension, bending in two planes and torsion.

use super::ends::ends;
use super::{Matrices, MatrixTable, Resultants, Section, SectionError, Shape, positive};
use std::sync::Arc;

/// Stiffness and inertia per length of a blade at a station, about its principal axes: η along the chord (at no
/// twist the direction of motion), ζ normal to it (at no twist along the axis of rotation). Centre of mass and
/// shear centre lie on the axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BladeResultants {
    /// Mass per length ρA [kg/m].
    pub mass: f64,
    /// Axial stiffness EA \[N\].
    pub axial_stiffness: f64,
    /// Stiffness against bending in the direction of ζ, ∫E ζ² dA [N·m²].
    pub flap_stiffness: f64,
    /// Stiffness against bending in the direction of η, ∫E η² dA [N·m²].
    pub chord_stiffness: f64,
    /// Torsional stiffness GJ [N·m²]; 0 where it is not known.
    pub torsional_stiffness: f64,
    /// ∫ρ ζ² dA [kg·m].
    pub flap_inertia: f64,
    /// ∫ρ η² dA [kg·m].
    pub chord_inertia: f64,
    /// Angle θ of η from the direction of motion, about the axis towards the tip \[rad\].
    pub twist: f64,
    /// dθ/dx [rad/m].
    pub twist_rate: f64,
}

impl BladeResultants {
    /// Whether the energies are positive: ρA, EA and both EI > 0, GJ and inertias ≥ 0, all finite.
    ///
    /// # Errors
    /// [`SectionError`] names the first quantity that is out of range.
    pub fn validate(&self) -> Result<(), SectionError> {
        positive("mass per length ρA", "kg/m", self.mass)?;
        positive("axial stiffness EA", "N", self.axial_stiffness)?;
        positive("flapwise bending stiffness", "N·m²", self.flap_stiffness)?;
        positive("chordwise bending stiffness", "N·m²", self.chord_stiffness)?;
        for (quantity, unit, value) in [
            ("torsional stiffness GJ", "N·m²", self.torsional_stiffness),
            ("flapwise rotary inertia", "kg·m", self.flap_inertia),
            ("chordwise rotary inertia", "kg·m", self.chord_inertia),
        ] {
            if !(value.is_finite() && value >= 0.0) {
                let needed = "zero or positive, and finite";
                return Err(SectionError::Quantity { quantity, unit, value, needed });
            }
        }
        if !self.twist.is_finite() {
            return Err(SectionError::Quantity {
                quantity: "twist",
                unit: "rad",
                value: self.twist,
                needed: "finite",
            });
        }
        Ok(())
    }

    /// The matrices of the section with the shear stiffnesses GA \[N\] along η and ζ.
    pub fn with_shear(&self, [along_chord, along_flap]: [f64; 2]) -> Matrices {
        let stiffness = [
            self.axial_stiffness,
            along_chord,
            along_flap,
            self.torsional_stiffness,
            self.flap_stiffness,
            self.chord_stiffness,
        ];
        let inertia = [self.flap_inertia + self.chord_inertia, self.flap_inertia, self.chord_inertia];
        Matrices::principal(stiffness, self.mass, inertia)
    }
}

/// The sections of a blade.
pub trait BladeSection: Send + Sync + std::fmt::Debug {
    /// Resultants at station `x` \[m\].
    fn resultants(&self, x: f64) -> BladeResultants;

    /// Stiffness, damping and mass with shear, of a section that says how stiff it is there; its twist is not applied.
    fn matrices(&self, _x: f64) -> Option<Matrices> {
        None
    }

    /// Stations inside (0, L) at which the resultants jump or kink, ascending.
    fn breaks(&self) -> &[f64] {
        &[]
    }

    /// Those of the breaks at which the resultants jump.
    fn jumps(&self) -> &[f64] {
        &[]
    }

    /// Stations inside the beam at which its elements should end, as [`Section::ends`] has them; the twist counts by the directions of the axes.
    fn ends(&self, cells: &[f64], h: f64) -> Vec<f64> {
        let values = |x: f64| {
            let r = self.resultants(x);
            [
                r.mass,
                r.axial_stiffness,
                r.flap_stiffness,
                r.chord_stiffness,
                r.torsional_stiffness,
                r.flap_inertia,
                r.chord_inertia,
                1.0 + r.twist,
            ]
        };
        ends(cells, h, (self.breaks(), self.jumps()), &values)
    }
}

/// The same resultants all along the blade.
impl BladeSection for BladeResultants {
    fn resultants(&self, _x: f64) -> BladeResultants {
        *self
    }
}

/// The section at zero shear force, bending about its tension centre and its inertia about its centre of mass: what a section has by itself, without what couples
/// its strains.
impl From<&Matrices> for BladeResultants {
    fn from(of: &Matrices) -> BladeResultants {
        let (c, [_, flap_inertia, chord_inertia]) = (of.condensed(), of.central_inertia());
        let about_centre = |k: usize| c[k][k] - c[0][k] * c[0][k] / c[0][0];
        BladeResultants {
            mass: of.mass[0][0],
            axial_stiffness: c[0][0],
            torsional_stiffness: c[1][1],
            flap_stiffness: about_centre(2),
            chord_stiffness: about_centre(3),
            flap_inertia,
            chord_inertia,
            twist: 0.0,
            twist_rate: 0.0,
        }
    }
}

impl BladeSection for MatrixTable {
    fn resultants(&self, x: f64) -> BladeResultants {
        BladeResultants::from(&self.at(x))
    }

    fn matrices(&self, x: f64) -> Option<Matrices> {
        Some(self.at(x))
    }

    fn breaks(&self) -> &[f64] {
        self.breaks()
    }

    fn jumps(&self) -> &[f64] {
        self.jumps()
    }
}

/// A homogeneous blade: a shape at every station, of one material.
pub struct HomogeneousBlade<F> {
    modulus: f64,
    density: f64,
    poisson_ratio: f64,
    shear_factor: Option<f64>,
    shape: F,
}

impl<F: Fn(f64) -> Shape + Send + Sync> HomogeneousBlade<F> {
    /// A blade of Young's modulus E \[Pa\], density ρ [kg/m³] and Poisson's ratio ν whose shape at x \[m\] is
    /// `shape(x)`; width across, height in the plane of motion. G = E/(2(1 + ν)).
    ///
    /// # Errors
    /// [`SectionError`] if E or ρ is not positive and finite, or ν not between −1 and 0.5.
    pub fn new(
        modulus: f64,
        density: f64,
        poisson_ratio: f64,
        shape: F,
    ) -> Result<HomogeneousBlade<F>, SectionError> {
        positive("Young's modulus", "Pa", modulus)?;
        positive("density", "kg/m³", density)?;
        if !(poisson_ratio > -1.0 && poisson_ratio <= 0.5) {
            return Err(SectionError::Quantity {
                quantity: "Poisson's ratio",
                unit: "",
                value: poisson_ratio,
                needed: "more than −1 and at most 0.5",
            });
        }
        Ok(HomogeneousBlade { modulus, density, poisson_ratio, shear_factor: None, shape })
    }

    /// The same blade with this shear factor in both directions, in place of those of its [shape](Shape::shear_factors).
    #[must_use]
    pub fn with_shear_factor(self, shear_factor: Option<f64>) -> HomogeneousBlade<F> {
        HomogeneousBlade { shear_factor, ..self }
    }

    fn shear_modulus(&self) -> f64 {
        self.modulus / (2.0 * (1.0 + self.poisson_ratio))
    }
}

impl<F> std::fmt::Debug for HomogeneousBlade<F> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("HomogeneousBlade")
            .field("modulus", &self.modulus)
            .field("density", &self.density)
            .field("poisson_ratio", &self.poisson_ratio)
            .finish_non_exhaustive()
    }
}

impl<F: Fn(f64) -> Shape + Send + Sync> BladeSection for HomogeneousBlade<F> {
    fn resultants(&self, x: f64) -> BladeResultants {
        let shape = (self.shape)(x);
        let area = shape.area();
        let chord = shape.second_moment();
        let flap = shape.flap_moment();
        BladeResultants {
            mass: self.density * area,
            axial_stiffness: self.modulus * area,
            flap_stiffness: self.modulus * flap,
            chord_stiffness: self.modulus * chord,
            torsional_stiffness: self.shear_modulus() * shape.torsion_constant(),
            flap_inertia: self.density * flap,
            chord_inertia: self.density * chord,
            twist: 0.0,
            twist_rate: 0.0,
        }
    }

    fn matrices(&self, x: f64) -> Option<Matrices> {
        let shape = (self.shape)(x);
        let factors = shape.shear_factors(self.poisson_ratio);
        let factors = self.shear_factor.map_or(factors, |factor| [factor; 2]);
        Some(self.resultants(x).with_shear(factors.map(|k| k * self.shear_modulus() * shape.area())))
    }
}

/// The same section all along a blade, with its shear stiffnesses GA \[N\] along η and ζ.
#[derive(Clone, Copy, Debug)]
pub struct UniformBlade {
    /// The resultants.
    pub resultants: BladeResultants,
    /// The shear stiffnesses, if they are known.
    pub shear: Option<[f64; 2]>,
}

impl BladeSection for UniformBlade {
    fn resultants(&self, _x: f64) -> BladeResultants {
        self.resultants
    }

    fn matrices(&self, _x: f64) -> Option<Matrices> {
        self.shear.map(|shear| self.resultants.with_shear(shear))
    }
}

/// A planar section as a blade that bends in both planes with the same stiffness: all that its resultants say.
#[derive(Debug)]
pub struct PlanarBlade(pub Box<dyn Section>);

impl BladeSection for PlanarBlade {
    fn resultants(&self, x: f64) -> BladeResultants {
        let r = self.0.resultants(x);
        BladeResultants {
            mass: r.mass,
            axial_stiffness: r.axial_stiffness,
            flap_stiffness: r.bending_stiffness,
            chord_stiffness: r.bending_stiffness,
            flap_inertia: r.rotary_inertia,
            chord_inertia: r.rotary_inertia,
            ..BladeResultants::default()
        }
    }

    fn breaks(&self) -> &[f64] {
        self.0.breaks()
    }

    fn jumps(&self) -> &[f64] {
        self.0.jumps()
    }
}

/// A section of which bending in the plane alone is known, for motions in that plane: in torsion and across it is as stiff, GJ = EI_f =
/// EI_c, with the inertia ρI of the plane in both directions, ρA EI/EA where it is left out.
#[derive(Debug)]
pub struct AsStiffAcross(pub Arc<dyn BladeSection>);

impl BladeSection for AsStiffAcross {
    fn resultants(&self, x: f64) -> BladeResultants {
        let of = self.0.resultants(x);
        let (stiffness, inertia) = (of.chord_stiffness, of.chord_inertia);
        let inertia = if inertia > 0.0 { inertia } else { of.mass * stiffness / of.axial_stiffness };
        BladeResultants {
            flap_stiffness: stiffness,
            torsional_stiffness: stiffness,
            flap_inertia: inertia,
            chord_inertia: inertia,
            ..of
        }
    }

    fn breaks(&self) -> &[f64] {
        self.0.breaks()
    }

    fn jumps(&self) -> &[f64] {
        self.0.jumps()
    }
}

/// A blade that is guided in the plane of rotation, as a planar section: EI = EI_c cos²θ + EI_f sin²θ.
#[derive(Debug)]
pub struct PlanarProjection<B>(pub B);

impl<B: BladeSection> Section for PlanarProjection<B> {
    fn resultants(&self, x: f64) -> Resultants {
        let r = self.0.resultants(x);
        let (sin, cos) = libm::sincos(r.twist);
        let in_plane = |chord: f64, flap: f64| chord * cos * cos + flap * sin * sin;
        Resultants {
            mass: r.mass,
            rotary_inertia: in_plane(r.chord_inertia, r.flap_inertia),
            axial_stiffness: r.axial_stiffness,
            bending_stiffness: in_plane(r.chord_stiffness, r.flap_stiffness),
            ..Resultants::default()
        }
    }

    fn breaks(&self) -> &[f64] {
        self.0.breaks()
    }

    fn jumps(&self) -> &[f64] {
        self.0.jumps()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn torsion_constants_are_those_of_the_handbook() {
        // Timoshenko & Goodier, table of k₁ in J = k₁ (2a)³(2b) for sides in the ratios 1, 1.5, 2, 10.
        for (ratio, k) in [(1.0, 0.1406), (1.5, 0.196), (2.0, 0.229), (10.0, 0.312)] {
            let j = Shape::Rectangle { width: 1.0, height: ratio }.torsion_constant();
            assert!((j / ratio - k).abs() < 6e-4, "{ratio}: {}", j / ratio);
        }
        let circle = Shape::Circle { radius: 2.0 }.torsion_constant();
        assert!((circle - PI * 16.0 / 2.0).abs() < 1e-12);
    }
}
