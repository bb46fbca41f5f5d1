//! Which terms of the strain energy matter for the frequencies of a rotating beam: a comparison.
//!
//! A uniform beam of length L rotates with Ω about an axis that its root is at the distance a from. It stays straight, is stretched by
//! w₁(x), and bends out of the plane of rotation by w, small. With e = w₁′, to second order in w
//!
//! ```text
//! U = ½ ∫ EI f w″² + (N − EA g) w′² dx,   T = ½ ∫ ρA ẇ² dx
//! ```
//!
//! | strain energy | f | g | N |
//! |---|---|---|---|
//! | [`Linear`](StrainEnergy::Linear) | 1 | 0 | N₀ = ρA Ω² ∫ₓᴸ a + ξ dξ |
//! | [`Coupled`](StrainEnergy::Coupled) | 1 + 3e + (3/2) e² | e² + ½ e³ | N₀ + ρA Ω² ∫ₓᴸ w₁ dξ, e = N₀/EA |
//!
//! [`Exact`](StrainEnergy::Exact) is the beam of exact geometry about its own steady stretch, λ = R′ with EA R″ = −ρA Ω² R, R(0) = a and
//! R′(L) = 1:
//!
//! ```text
//! U = ½ ∫ EI ((w′/λ)′)² + (N/λ) w′² dx,   N = EA (λ − 1)
//! ```
//!
//! In the plane of rotation, without Coriolis terms, ω² is less by Ω². Ritz's method with the functions x² P_k(2x/L − 1) of Legendre's
//! polynomials leaves less than 1e-9 of the first frequencies up to speeds of 12 √(EI/ρAL⁴).
//!
//! Source of the terms: Zhao & Wu 2015, doi:10.6052/0459-1879-14-207.

use crate::quadrature::Gauss;
use nalgebra::DMatrix;

/// Functions of Ritz's method.
const FUNCTIONS: usize = 20;
/// Points of Gauss's rule.
const POINTS: usize = 64;

/// A uniform beam that rotates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RotatingBeam {
    /// Length L \[m\].
    pub length: f64,
    /// Distance a of the root from the axis of rotation \[m\].
    pub hub_radius: f64,
    /// Mass per length ρA \[kg/m\].
    pub mass: f64,
    /// Axial stiffness EA \[N\].
    pub axial_stiffness: f64,
    /// Bending stiffness EI \[N·m²\].
    pub bending_stiffness: f64,
}

/// The strain energy. See the [module documentation](self).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StrainEnergy {
    /// Quadratic in axial strain and curvature, with foreshortening in the kinetic energy: the first-order coupling.
    Linear,
    /// As `Linear`, with terms of the Green strain that couple the steady axial strain and bending.
    Coupled(Terms),
    /// ½∫ EA (|r′| − 1)² + EI κ² of the exact curve.
    Exact,
}

/// Terms of the Green strain, each kept or not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Terms {
    /// ½∫EI · 3e w″²
    pub bending_first: bool,
    /// ½∫EI · (3/2) e² w″²
    pub bending_second: bool,
    /// −½∫EA e² w′²
    pub axial_first: bool,
    /// −½∫EA ½e³ w′²
    pub axial_second: bool,
    /// The centrifugal force of the stretched beam, x → x + w₁.
    pub stretched_inertia: bool,
}

impl Terms {
    /// All terms.
    pub const ALL: Terms = Terms {
        bending_first: true,
        bending_second: true,
        axial_first: true,
        axial_second: true,
        stretched_inertia: true,
    };
}

/// The beam has no steady stretch at this speed, or does not stay straight.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "at {speed} rad/s the beam has no steady stretch about which it vibrates: its strain at the root would be {strain:.3}"
)]
pub struct NotSteady {
    /// Ω \[rad/s\].
    pub speed: f64,
    /// Strain at the root of the linear steady state.
    pub strain: f64,
}

impl RotatingBeam {
    /// Strain N₀/EA at the root of the linear steady state at the speed Ω \[rad/s\].
    pub fn strain(&self, speed: f64) -> f64 {
        let RotatingBeam { length, hub_radius, mass, axial_stiffness, .. } = *self;
        mass * speed * speed * length * (hub_radius + 0.5 * length) / axial_stiffness
    }

    /// Factors at x \[m\] of the squares of w″, w′ and of twice their product in the strain energy.
    fn factors(&self, energy: StrainEnergy, speed: f64, x: f64) -> [f64; 3] {
        let RotatingBeam { length, hub_radius: a, mass, axial_stiffness: ea, bending_stiffness: ei } = *self;
        let square = mass * speed * speed;
        let terms = match energy {
            StrainEnergy::Linear => Terms::default(),
            StrainEnergy::Coupled(terms) => terms,
            StrainEnergy::Exact => {
                let k = (square / ea).sqrt();
                let (sin, cos) = libm::sincos(k * length);
                // R = a cos kx + b sin kx; kb → 1 at rest.
                let kb = (1.0 + a * k * sin) / cos;
                let (sin, cos) = libm::sincos(k * x);
                let (stretch, slope) = (kb * cos - a * k * sin, -k * (kb * sin + a * k * cos));
                // (w′/λ)′ = w″/λ − w′ λ′/λ².
                let (first, second) = (1.0 / stretch, -slope / (stretch * stretch));
                let tension = ea * (stretch - 1.0) / stretch;
                return [ei * first * first, tension + ei * second * second, ei * first * second];
            }
        };
        let on = |kept: bool, term: f64| if kept { term } else { 0.0 };
        // Integrals from x to L of a + ξ, and of w₁ = Ω²ρA/EA ∫₀ˣ ….
        let tension = square * ((a * length + 0.5 * length * length) - (a * x + 0.5 * x * x));
        let double = |x: f64| {
            let s = a * length + 0.5 * length * length;
            x * x * (0.5 * s - x * (a / 6.0 + x / 24.0))
        };
        let stretched = square * square / ea * (double(length) - double(x));
        let e = tension / ea;
        let f = 1.0 + on(terms.bending_first, 3.0 * e) + on(terms.bending_second, 1.5 * e * e);
        let g = on(terms.axial_first, e * e) + on(terms.axial_second, 0.5 * e * e * e);
        [ei * f, tension + on(terms.stretched_inertia, stretched) - ea * g, 0.0]
    }

    /// The first frequencies \[rad/s\] of bending out of the plane of rotation at the speed Ω \[rad/s\], ascending; at most ten.
    ///
    /// # Errors
    /// [`NotSteady`] beyond the speed that the beam can be held at.
    pub fn flapwise(&self, energy: StrainEnergy, speed: f64, count: usize) -> Result<Vec<f64>, NotSteady> {
        let not_steady = || NotSteady { speed, strain: self.strain(speed) };
        let RotatingBeam { length, mass, axial_stiffness, .. } = *self;
        let most = std::f64::consts::FRAC_PI_2 * (axial_stiffness / mass).sqrt();
        if energy == StrainEnergy::Exact && !((speed * length).abs() < most) {
            return Err(not_steady());
        }
        let zero = || DMatrix::<f64>::zeros(FUNCTIONS, FUNCTIONS);
        let (mut stiffness, mut inertia) = (zero(), zero());
        for (x, weight) in Gauss::new(POINTS).on(0.0, length) {
            let functions = functions(x / length);
            let [bending, tension, both] = self.factors(energy, speed, x).map(|factor| weight * factor);
            for i in 0..FUNCTIONS {
                let [u, du, ddu] = functions[i];
                let (du, ddu) = (du / length, ddu / (length * length));
                for j in 0..FUNCTIONS {
                    let [v, dv, ddv] = functions[j];
                    let (dv, ddv) = (dv / length, ddv / (length * length));
                    stiffness[(i, j)] +=
                        bending * ddu * ddv + tension * du * dv + both * (ddu * dv + du * ddv);
                    inertia[(i, j)] += weight * mass * u * v;
                }
            }
        }
        // The largest eigenvalues 1/ω² of L⁻¹ M L⁻ᵀ with K = L Lᵀ: the lowest frequencies are the precise ones.
        let lower = stiffness.cholesky().ok_or_else(not_steady)?.unpack();
        let solve = |of: &DMatrix<f64>| lower.solve_lower_triangular(of).ok_or_else(not_steady);
        let reduced = solve(&solve(&inertia)?.transpose())?;
        let mut values: Vec<f64> = reduced.symmetric_eigenvalues().iter().copied().collect();
        values.sort_by(|a, b| b.total_cmp(a));
        Ok(values.iter().take(count.min(FUNCTIONS / 2)).map(|value| 1.0 / value.sqrt()).collect())
    }
}

/// x² P_k(2x − 1) with two derivatives.
fn functions(x: f64) -> [[f64; 3]; FUNCTIONS] {
    let z = 2.0 * x - 1.0;
    let mut p = [[0.0; 3]; FUNCTIONS];
    (p[0], p[1]) = ([1.0, 0.0, 0.0], [z, 1.0, 0.0]);
    for k in 2..FUNCTIONS {
        let (n, a, b) = (k as f64, p[k - 1], p[k - 2]);
        // (n) Pₙ = (2n − 1) z Pₙ₋₁ − (n − 1) Pₙ₋₂, differentiated twice.
        let next = |d: usize, more: f64| ((2.0 * n - 1.0) * (z * a[d] + more) - (n - 1.0) * b[d]) / n;
        p[k] = [next(0, 0.0), next(1, a[0]), next(2, 2.0 * a[1])];
    }
    p.map(|[p, dp, ddp]| {
        let (dp, ddp) = (2.0 * dp, 4.0 * ddp);
        [x * x * p, 2.0 * x * p + x * x * dp, 2.0 * p + 4.0 * x * dp + x * x * ddp]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit(slenderness: f64) -> RotatingBeam {
        let axial_stiffness = slenderness * slenderness;
        RotatingBeam { length: 1.0, hub_radius: 0.0, mass: 1.0, axial_stiffness, bending_stiffness: 1.0 }
    }

    fn meets(found: &[f64], expected: &[f64], tolerance: f64) {
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(expected) {
            assert!((found / expected - 1.0).abs() < tolerance, "{found} for {expected}");
        }
    }

    #[test]
    fn linear_frequencies_are_those_of_the_series_with_any_hub() {
        for (speed, hub_radius) in [(0.0, 0.0), (5.0, 0.0), (12.0, 0.0), (4.0, 1.0), (12.0, 1.0)] {
            let beam = RotatingBeam { hub_radius, ..unit(100.0) };
            let expected =
                [1, 2, 3].map(|k| crate::exact::rotating::flapwise_frequency(k, speed, hub_radius));
            meets(&beam.flapwise(StrainEnergy::Linear, speed, 3).unwrap(), &expected, 1e-9);
        }
    }

    /// A beam stretched by 2 % at its root; by 96 cubic elements, coded apart, whose error is the tolerance.
    #[test]
    fn the_terms_are_those_of_hermite_elements() {
        // L = 1 m, a square of 50 mm, E = 10 MPa, ρ = 1000 kg/m³.
        let (area, second_moment) = (2.5e-3, 0.05_f64.powi(4) / 12.0);
        let beam = RotatingBeam {
            length: 1.0,
            hub_radius: 0.0,
            mass: 1e3 * area,
            axial_stiffness: 1e7 * area,
            bending_stiffness: 1e7 * second_moment,
        };
        assert!((beam.strain(20.0) - 0.02).abs() < 1e-12);
        for (energy, expected) in [
            (StrainEnergy::Linear, [21.660752, 59.871919, 122.198425]),
            (StrainEnergy::Coupled(Terms::default()), [21.660752, 59.871919, 122.198425]),
            (StrainEnergy::Coupled(Terms::ALL), [21.72434100, 60.34099928, 123.56768126]),
            (StrainEnergy::Exact, [21.63591423, 59.74109832, 121.45303875]),
        ] {
            meets(&beam.flapwise(energy, 20.0, 3).unwrap(), &expected, 3e-7);
        }
    }

    /// Each term alone, to first order in itself: λ₁ moves by the term on the mode of the linear beam, here by a difference.
    #[test]
    fn each_term_has_its_own_switch() {
        let (beam, speed) = (unit(20.0), 4.0);
        let linear = beam.flapwise(StrainEnergy::Linear, speed, 1).unwrap()[0];
        let of = |terms: Terms| beam.flapwise(StrainEnergy::Coupled(terms), speed, 1).unwrap()[0];
        let none = Terms::default();
        let alone = [
            of(Terms { bending_first: true, ..none }),
            of(Terms { bending_second: true, ..none }),
            of(Terms { axial_first: true, ..none }),
            of(Terms { axial_second: true, ..none }),
            of(Terms { stretched_inertia: true, ..none }),
        ];
        // The signs are those of the terms; e = 2 %, so that second terms are a hundredth of first ones.
        let moved = alone.map(|of| of - linear);
        assert!(
            moved[0] > 0.0 && moved[1] > 0.0 && moved[2] < 0.0 && moved[3] < 0.0 && moved[4] > 0.0,
            "{moved:?}"
        );
        assert!(
            (0.002..0.02).contains(&(moved[1] / moved[0])) && (0.002..0.02).contains(&(moved[3] / moved[2]))
        );
        let all = of(Terms::ALL) - linear;
        assert!((all - moved.iter().sum::<f64>()).abs() < 0.02 * all.abs(), "{all} for {moved:?}");
    }

    #[test]
    fn a_speed_that_tears_the_beam_is_refused() {
        let error = unit(20.0).flapwise(StrainEnergy::Exact, 32.0, 1).unwrap_err();
        assert!(error.to_string().contains("at 32 rad/s"), "{error}");
        assert!(unit(20.0).flapwise(StrainEnergy::Exact, 25.0, 1).is_ok());
        // Those of the axial strain alone take the stiffness away.
        let axial = Terms { axial_first: true, axial_second: true, ..Terms::default() };
        assert!(unit(5.0).flapwise(StrainEnergy::Coupled(axial), 20.0, 1).is_err());
    }
}
