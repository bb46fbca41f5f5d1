//! The interface of a coupling, a kinematic model of the beam in the hub's frame.

use super::damping::Damping;
use super::fields::{Fields, Point};
use super::inertia::{Border, Inertia, Totals};
use super::load::Kinematics;
use super::station::{Placement, Station};
use crate::linalg::{Storage, Structure};
use crate::profile::HubKinematics;
use crate::system::{Corotation, Limit, State, Weights};

/// A kinematic model of the beam: everything that differs between `zeroth`, `first`, `high` and `exact`.
///
/// The hub–beam system is generic over its coupling, so these calls are static.
pub trait Coupling: Send {
    /// Name as in a case file.
    fn name(&self) -> &'static str;

    /// The displacement fields.
    fn fields(&self) -> &Fields;

    /// The constant matrices: the whole model if [`Coupling::is_affine`].
    fn inertia(&self) -> &Inertia;

    /// Structure of the tangent, with `border` unknowns of a hub behind.
    fn structure(&self, border: usize) -> Structure {
        self.fields().structure(border)
    }

    /// Whether [`Coupling::inertia`] is the whole model.
    fn is_affine(&self) -> bool;

    /// Adds to `r` the forces that are not in [`Coupling::inertia`].
    fn add_forces(&mut self, _s: &State, _hub: &HubKinematics, _r: &mut [f64]) {}

    /// Adds to `out` the tangent of [`Coupling::add_forces`].
    fn add_tangent(&mut self, _s: &State, _hub: &HubKinematics, _w: &Weights<'_>, _out: &mut Storage<f64>) {}

    /// Writes the rotation of each section from one state to another: see [`Dynamics::corotate`](crate::system::Dynamics::corotate).
    fn corotate(&self, _before: &State, _now: &State, out: &mut Corotation) {
        out.clear();
    }

    /// Adds to each of `out` the second variation of the strain energy by a vector, xᵀ(∂²U/∂q²)x, summed strain by strain.
    fn strain_forms(&mut self, s: &State, vectors: &[Vec<f64>], out: &mut [f64]);

    /// [`Coupling::add_tangent`] without the strain energy, for w = (0, 0, 1).
    fn add_unstrained_stiffness(&mut self, s: &State, hub: &HubKinematics, out: &mut Storage<f64>) {
        self.add_tangent(s, hub, &Weights::new(0.0, 0.0, 1.0), out);
    }

    /// Strain energy \[J\].
    fn strain(&mut self, s: &State) -> f64;

    /// Kinetic energy, angular momentum and torque that are not in [`Coupling::inertia`].
    fn extra_totals(&mut self, _s: &State, _hub: &HubKinematics) -> Totals {
        Totals::default()
    }

    /// The torque of [`Coupling::extra_totals`].
    fn extra_torque(&mut self, s: &State, hub: &HubKinematics) -> f64 {
        self.extra_totals(s, hub).torque
    }

    /// Adds to the border of a free hub what is not in [`Coupling::inertia`].
    fn add_border(&mut self, _s: &State, _hub: &HubKinematics, _w: &Weights<'_>, _out: &mut Border) {}

    /// The kinematics of the axis, for the loads.
    fn kinematics(&self) -> Kinematics {
        Kinematics::Foreshortened
    }

    /// Damps the deformation of the beam.
    fn damp(&mut self, damping: Damping);

    /// Power that [`Coupling::damp`] takes \[W\].
    fn dissipated(&mut self, s: &State) -> f64 {
        self.inertia().dissipated(&s.v)
    }

    /// Displacement and rotation of the section at each of the stations, which ascend along the beam.
    fn placements(&self, s: &State, stations: &[Station], out: &mut [Placement]);

    /// Axial strain ε and curvature κ at a point: w₁′ and w₂″ of small deflections.
    fn strains(&self, s: &State, point: &Point) -> (f64, f64) {
        (point.axial.field(1, &s.q), point.transverse.field(2, &s.q))
    }

    /// Whether the kinetic energy is positive however far the beam is bent, on a hub that is free too.
    fn has_positive_kinetic_energy(&self) -> bool {
        true
    }

    /// `Err` when the state is beyond what the model can represent.
    fn admissible(&mut self, s: &State) -> Result<(), Limit>;

    /// Limits of validity worth a warning at the largest tip deflection of a run (`deflection` \[m\]).
    fn cautions(&self, deflection: f64) -> Vec<String>;

    /// Hub speed [rad/s] at which the model's own stiffness is exhausted, if there is one below `speed`.
    fn critical_speed(&self, _speed: f64) -> Option<f64> {
        None
    }
}
