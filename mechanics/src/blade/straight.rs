//! Strain energy of a blade that stays straight, to second order in the vibration: `linear` and `coupled`.
//!
//! With the foreshortening in the kinetic energy, w₁ the axial displacement, e = w₁′ = N₀/EA its steady value and θ the
//! angle of the section, per length
//!
//! ```text
//! ½EA u′² + ½f (EI_c κ₂² + EI_f κ₃²) + ½(N − EA g)(v′² + w′²) + ½GJ φ′² [+ ½(EI_c + EI_f)(e φ′² + 2θ′ u′φ′) + ½(EI_c + EI_f)²θ′²φ′²/EA]
//! κ₂ = v″ cos θ + w″ sin θ,   κ₃ = w″ cos θ − v″ sin θ,   f = 1 (+ 3e) (+ 3e²/2),   g = 0 (+ e²) (+ e³/2)
//! ```
//!
//! The terms in round brackets are those of [`Terms`](super::Terms), the one in square brackets the share of
//! the tension in the torsion. N is the tension of the unstretched blade, or of the stretched one.

use super::element::{Functions, Local, add_energy};
use super::jet::Jet;
use super::mesh::{Element, Point};
use super::model::{Model, Terms};
use crate::section::BladeResultants;

/// Energy per length at a point: `tension` holds N₀ and N.
fn energy(section: &BladeResultants, pitch: f64, tension: (f64, f64), terms: Terms, model: &Model) -> Jet<8> {
    let square = |v: usize, a: f64, w: usize, b: f64, factor: f64| {
        let e = Jet::<8>::variable(0.0, v).scaled(a) + Jet::variable(0.0, w).scaled(b);
        (e * e).scaled(0.5 * factor)
    };
    let on = |kept: bool, term: f64| if kept { term } else { 0.0 };
    let ea = section.axial_stiffness;
    let e = tension.0 / ea;
    let f = 1.0 + on(terms.bending_first, 3.0 * e) + on(terms.bending_second, 1.5 * e * e);
    let g = on(terms.axial_first, e * e) + on(terms.axial_second, 0.5 * e * e * e);
    let (sin, cos) = libm::sincos(pitch + section.twist);
    let mut sum = square(0, 1.0, 0, 0.0, ea)
        + square(4, cos, 5, sin, f * section.chord_stiffness)
        + square(4, -sin, 5, cos, f * section.flap_stiffness)
        + square(1, 1.0, 1, 0.0, tension.1 - ea * g)
        + square(2, 1.0, 2, 0.0, tension.1 - ea * g);
    if model.torsion {
        sum = sum + square(7, 1.0, 7, 0.0, section.torsional_stiffness);
        if model.tension_torsion {
            let polar = section.chord_stiffness + section.flap_stiffness;
            let both = Jet::variable(0.0, 0) * Jet::variable(0.0, 7);
            let lever = polar * section.twist_rate;
            sum = sum + square(7, 1.0, 7, 0.0, polar * e + lever * lever / ea) + both.scaled(lever);
        }
    }
    sum
}

impl Element {
    /// The points of the element and the energy per length there, at the speed whose square is `square`; `tension` holds
    /// C and D at the points.
    pub(super) fn straight_energies<'a>(
        &'a self,
        pitch: f64,
        square: f64,
        tension: &'a [(f64, f64)],
        terms: Terms,
        model: &'a Model,
    ) -> impl Iterator<Item = (&'a Point, Jet<8>)> {
        self.points.iter().zip(tension).map(move |(point, (c, d))| {
            let base = square * c;
            let full = if terms.stretched_inertia { base + square * square * d } else { base };
            (point, energy(&point.section, pitch, (base, full), terms, model))
        })
    }

    /// Adds the stiffness of the straight blade; arguments as of
    /// [`straight_energies`](Element::straight_energies).
    pub fn add_straight_strain(
        &self,
        pitch: f64,
        square: f64,
        tension: &[(f64, f64)],
        terms: Terms,
        model: &Model,
        out: &mut Local,
    ) {
        for (point, energy) in self.straight_energies(pitch, square, tension, terms, model) {
            add_energy(&Functions::of(point), point.weight, &energy, out);
        }
    }
}
