//! Coupling `high`: the foreshortening kept to every order in the kinetic energy.
//!
//! The kinematics are those of the first-order coupling, X = R + w₁ + w_c, Y = w₂, R = a + x,
//! w_c = −½ ∫₀ˣ w₂′² dξ; but nothing of ½∫ρA [(Ẋ − ωY)² + (Ẏ + ωX)²] dx is dropped (P3 equations 28–36). The
//! part that is quadratic in the unknowns is [`Inertia`]; what is beyond it is
//!
//! ```text
//! T − T_first = ∫ρA [ ẇ₁ẇ_c + ½ẇ_c² + ω (w_c ẇ₂ − w₂ ẇ_c) + ½ω² (2w₁w_c + w_c²) ] dx
//! ```
//!
//! and its forces, with α = Ẍ − ω̇Y − 2ωẎ − ω²(X − R) and its tail N = ∫ₓᴸ ρA α dξ,
//!
//! ```text
//! on w₁    ∫ρA (ẅ_c − ω²w_c) φx dx
//! on w₂    ∫ρA (ω̇ w_c + 2ω ẇ_c) φy dx − ∫ N w₂′ φy′ dx
//! on θ     ∫ρA [ ω̇ (2w₁w_c + w_c²) + 2ω (ẇ₁w_c + w₁ẇ_c + w_cẇ_c) + w_cẅ₂ − w₂ẅ_c ] dx
//! ```
//!
//! w_c and its rates are running sums over the quadrature points from the root to the tip, N is one from the
//! tip to the root: the forces take O(n). The [`tangent`] is full. A lumped mass is a point of ∫ρA … dx. Rotary
//! inertia ρI and first mass moment ρS are kept to second order, as in the first-order coupling.

mod sums;
mod table;
mod tangent;
#[cfg(test)]
mod tests;

use super::beam::Beam;
use super::coupling::Coupling;
use super::damping::Damping;
use super::fields::Fields;
use super::hub::Hub;
use super::inertia::{Border, Foreshortening, Inertia, Totals};
use super::linear::LinearCoupling;
use super::station::{Placement, Station};
use crate::basis::{Basis, BasisError};
use crate::linalg::{Storage, Structure};
use crate::profile::HubKinematics;
use crate::system::{Limit, State, Weights};
use sums::{Point, Sums};
use tangent::Tangent;

/// Largest number of elements or cells of a basis: the full tangent of 300 has about a million entries.
pub const MOST_ELEMENTS: usize = 300;

/// A beam with the foreshortening to every order. Its formulas head the source file.
#[derive(Clone, Debug)]
pub struct HighCoupling {
    /// The part that is quadratic in the unknowns.
    linear: LinearCoupling,
    sums: Sums,
    tangent: Tangent,
}

impl HighCoupling {
    /// The coupling over `fields`, on a hub.
    ///
    /// # Errors
    /// [`BasisError`] if a basis has more than 300 elements.
    pub fn new<'a>(fields: Fields, beam: impl Into<Beam<'a>>, hub: &Hub) -> Result<HighCoupling, BasisError> {
        let beam = beam.into();
        HighCoupling::validate(fields.axial())?;
        HighCoupling::validate(fields.transverse())?;
        let sums = Sums::new(fields.inertial(), &beam);
        let tangent = Tangent::new(fields.len());
        let linear = LinearCoupling::new(fields, beam, hub, Foreshortening::First).named("high");
        Ok(HighCoupling { linear, sums, tangent })
    }

    /// Whether a basis has few enough elements for a full tangent.
    ///
    /// # Errors
    /// [`BasisError`] if it has more than `MOST_ELEMENTS`.
    pub fn validate(basis: &dyn Basis) -> Result<(), BasisError> {
        let elements = basis.cells().len().saturating_sub(1);
        if elements <= MOST_ELEMENTS {
            return Ok(());
        }
        Err(BasisError::Invalid(format!(
            "the basis has {elements} elements; the coupling `high` has a full tangent matrix and takes at most \
             {MOST_ELEMENTS}: take fewer, or the coupling `first` or `exact`"
        )))
    }
}

impl Coupling for HighCoupling {
    fn name(&self) -> &'static str {
        "high"
    }

    fn strain_forms(&mut self, s: &State, vectors: &[Vec<f64>], out: &mut [f64]) {
        self.linear.strain_forms(s, vectors, out);
    }

    fn fields(&self) -> &Fields {
        self.linear.fields()
    }

    fn inertia(&self) -> &Inertia {
        self.linear.inertia()
    }

    fn is_affine(&self) -> bool {
        false
    }

    fn structure(&self, border: usize) -> Structure {
        Structure::dense(self.fields().len() + border)
    }

    fn add_forces(&mut self, s: &State, hub: &HubKinematics, r: &mut [f64]) {
        let (om, al) = (hub.speed, hub.acceleration);
        self.linear.add_forces(s, hub, r);
        self.sums.follow(s);
        self.sums.scatter(r, |p| {
            let on_axial = p.wc[2] - om * om * p.wc[0];
            let on_transverse = al * p.wc[0] + 2.0 * om * p.wc[1];
            ([on_axial, on_transverse], [p.axial_acceleration(hub)])
        });
    }

    fn add_tangent(&mut self, s: &State, hub: &HubKinematics, w: &Weights<'_>, out: &mut Storage<f64>) {
        self.sums.follow(s);
        self.tangent.add(&mut self.sums, hub, w, out);
    }

    fn strain(&mut self, s: &State) -> f64 {
        self.linear.strain(s)
    }

    fn extra_totals(&mut self, s: &State, hub: &HubKinematics) -> Totals {
        let (om, al) = (hub.speed, hub.acceleration);
        self.sums.follow(s);
        let [mut kinetic, mut momentum, mut torque] = [0.0; 3];
        self.sums.each(|m, Point { w1, w2, wc }| {
            let moment = (2.0 * w1[0] + wc[0]) * wc[0];
            let relative = wc[0] * w2[1] - w2[0] * wc[1];
            let rate = w1[1] * wc[0] + (w1[0] + wc[0]) * wc[1];
            kinetic += m * ((w1[1] + 0.5 * wc[1]) * wc[1] + om * relative + 0.5 * om * om * moment);
            momentum += m * (relative + om * moment);
            torque += m * (al * moment + 2.0 * om * rate + wc[0] * w2[2] - w2[0] * wc[2]);
        });
        Totals { kinetic, momentum, torque }
    }

    fn add_border(&mut self, s: &State, hub: &HubKinematics, w: &Weights<'_>, out: &mut Border) {
        let (om, al) = (hub.speed, hub.acceleration);
        self.sums.follow(s);
        // The forces by ω and ω̇.
        self.sums.scatter(&mut out.column, |p| {
            let on_axial = -2.0 * om * w.v * p.wc[0];
            let on_transverse = w.a * p.wc[0] + 2.0 * w.v * p.wc[1];
            let axial = -w.a * p.w2[0] - 2.0 * w.v * p.w2[1] - 2.0 * om * w.v * (p.w1[0] + p.wc[0]);
            ([on_axial, on_transverse], [axial])
        });
        // The torque by w₁, w₂ and by w_c, ẇ_c, ẅ_c, whose increments are −∫ w₂′δw₂′, −∫ ẇ₂′δw₂′ + w₂′δẇ₂′,
        // −∫ ẅ₂′δw₂′ + 2ẇ₂′δẇ₂′ + w₂′δẅ₂′.
        self.sums.scatter(&mut out.row, |Point { w1, w2, wc }| {
            let by_axial = 2.0 * w.q * (al * wc[0] + om * wc[1]) + 2.0 * w.v * om * wc[0];
            let by_transverse = w.a * wc[0] - w.q * wc[2];
            let by_position = 2.0 * (al * (w1[0] + wc[0]) + om * (w1[1] + wc[1])) + w2[2];
            let by_speed = 2.0 * om * (w1[0] + wc[0]);
            let by_acceleration = -w2[0];
            let tails = [
                w.q * by_position + w.v * by_speed + w.a * by_acceleration,
                w.q * by_speed + 2.0 * w.v * by_acceleration,
                w.q * by_acceleration,
            ];
            ([by_axial, by_transverse], tails)
        });
        let corner = &mut out.corner;
        self.sums.each(|m, Point { w1, wc, .. }| {
            let rate = w1[1] * wc[0] + (w1[0] + wc[0]) * wc[1];
            *corner += m * (2.0 * w.v * rate + w.a * (2.0 * w1[0] + wc[0]) * wc[0]);
        });
    }

    fn damp(&mut self, damping: Damping) {
        self.linear.damp(damping);
    }

    fn placements(&self, s: &State, stations: &[Station], out: &mut [Placement]) {
        self.linear.placements(s, stations, out);
    }

    fn admissible(&mut self, s: &State) -> Result<(), Limit> {
        self.linear.admissible(s)
    }

    fn cautions(&self, deflection: f64) -> Vec<String> {
        self.linear.cautions(deflection)
    }

    fn critical_speed(&self, speed: f64) -> Option<f64> {
        self.linear.critical_speed(speed)
    }
}
