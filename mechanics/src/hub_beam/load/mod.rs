//! Loads on the beam: gravity, forces, couples and forces per length, with their torque on the hub.
//!
//! A force with components F = (F_x, F_y) acts at the point r = (X, Y) of the axis. In the hub's frame its
//! components are d = R(−θ) F in inertial axes (`Dead`), F itself if it rotates with the hub (`Hub`), and
//! F_x t + F_y n if it rotates with the section (`Follower`, t and n tangent and normal). With p the force's share
//! at each point (a density, or 1 at one station) and f(t) its amplitude, virtual work gives
//!
//! ```text
//! Q_q = f [ d_x ∂C_x/∂q + d_y ∂C_y/∂q ],   Q_θ = f [ d_y C_x − d_x C_y ],   C_x = ∫p X dx,  C_y = ∫p Y dx
//! ```
//!
//! Each kind of load is made into a `Group` when a system is built: the shapes are
//! evaluated then and not in a run. A [`LineLaw`], whose force depends on place and velocity, is evaluated at the points of the
//! quadrature. How C depends on q is the coupling's [`Kinematics`]:
//!
//! | kinematics | X − a − x, Y | C | section |
//! |---|---|---|---|
//! | `Straight` | w₁, w₂ | linear | rotates by w₂′ |
//! | `Foreshortened` | w₁ − ½∫₀ˣ w₂′² dξ, w₂ | quadratic, banded: −½∫ P w₂′² dξ, P(ξ) = ∫_ξᴸ p dx | rotates by w₂′ |
//! | `Curve` | U, V | linear | rotates with the tangent (X′, Y′)/ℓ |

mod components;
mod couple;
mod damper;
mod distributed;
mod force;
mod gravity;
mod group;
mod line_law;
mod on_section;
mod site;
mod spring;
#[cfg(test)]
mod tests;

pub use components::{Amplitude, Axes};
pub use couple::Couple;
pub use damper::Damper;
pub use distributed::DistributedForce;
pub use force::Force;
pub use gravity::Gravity;
pub use line_law::{LineLaw, Sampled};
pub use site::{Kinematics, Site};
pub use spring::Spring;

use super::inertia::Border;
use crate::linalg::Storage;
use crate::profile::HubKinematics;
use crate::system::{Break, State, Weights};
use group::{Group, Store};

/// A load: what it does to a beam with the given kinematics. The kinds of loads are those of this module; a load of one's own is a
/// [force law](crate::law) on a [`LineLaw`].
pub trait Load: std::fmt::Debug + sealed::Sealed {
    /// Moments of the load over the shapes, times an amplitude: of loads that do not depend on velocities.
    fn group(&self, _site: &Site<'_>) -> Option<Group> {
        None
    }

    /// The force and the couple [N·m] of a load at a point.
    fn at_point(&self) -> Option<(Force, f64)> {
        None
    }

    /// The load itself, if it is a force per length.
    fn along(&self) -> Option<&DistributedForce> {
        None
    }

    /// The damper that comes with it.
    fn damper(&self, _site: &Site<'_>) -> Option<Damper> {
        None
    }

    /// A force law at the points of the beam.
    fn sampled(&self, _site: &Site<'_>) -> Option<Sampled> {
        None
    }
}

mod sealed {
    /// What the loads of this library alone are.
    pub trait Sealed {}

    impl Sealed for super::Couple {}
    impl Sealed for super::DistributedForce {}
    impl Sealed for super::Force {}
    impl Sealed for super::Gravity {}
    impl Sealed for super::LineLaw {}
    impl Sealed for super::Spring {}
}

/// The loads of a system. Empty, they cost nothing.
#[derive(Clone, Debug, Default)]
pub struct Loads {
    groups: Vec<Group>,
    dampers: Vec<Damper>,
    laws: Vec<Sampled>,
    points: Vec<(Force, f64)>,
    /// Forces per length, with the stations at which they are drawn \[m\].
    lines: Vec<(DistributedForce, Vec<f64>)>,
    breaks: Vec<Break>,
    /// Part of the loads that is not applied: 0 except during the continuation of an equilibrium.
    missing: f64,
    /// Forces, for their power.
    force: Vec<f64>,
}

impl Loads {
    /// Loads on the beam at `site`.
    pub fn new(site: &Site<'_>, loads: &[&dyn Load]) -> Loads {
        let groups: Vec<Group> = loads.iter().filter_map(|load| load.group(site)).collect();
        let breaks = groups.iter().flat_map(Group::breaks).collect();
        let dampers = loads.iter().filter_map(|load| load.damper(site)).collect();
        let laws = loads.iter().filter_map(|load| load.sampled(site)).collect();
        let points = loads.iter().filter_map(|load| load.at_point()).collect();
        let along = loads.iter().filter_map(|load| load.along());
        let lines = along.map(|load| (load.clone(), load.drawn(site.fields.length()))).collect();
        let force = vec![0.0; site.fields.len()];
        Loads { groups, dampers, laws, points, lines, breaks, missing: 0.0, force }
    }

    /// Whether there is no load.
    pub fn is_empty(&self) -> bool {
        self.groups.is_empty() && self.laws.is_empty()
    }

    /// Whether all forces are affine in displacements and velocities.
    pub fn is_affine(&self) -> bool {
        self.laws.iter().all(Sampled::is_affine)
    }

    /// Forces and couples at points.
    pub(super) fn points(&self) -> &[(Force, f64)] {
        &self.points
    }

    /// Forces per length, with the stations at which they are drawn \[m\].
    pub(super) fn lines(&self) -> &[(DistributedForce, Vec<f64>)] {
        &self.lines
    }

    /// Part of the loads that is applied.
    pub(super) fn part(&self) -> f64 {
        1.0 - self.missing
    }

    /// Whether gravity is among them.
    pub fn has_gravity(&self) -> bool {
        self.groups.iter().any(|g| g.store() == Some(Store::Gravity))
    }

    /// Applies a part of the loads, 0 … 1, from now on.
    pub fn set_part(&mut self, part: f64) {
        self.missing = 1.0 - part;
        self.groups.iter_mut().for_each(|group| group.set_part(part));
    }

    /// Times at which an amplitude is not smooth.
    pub fn breaks(&self) -> &[Break] {
        &self.breaks
    }

    /// Subtracts the forces Q_q from the residual `r`.
    pub fn subtract_forces(&mut self, s: &State, hub: &HubKinematics, r: &mut [f64]) {
        for group in &mut self.groups {
            group.add_force(s, hub, -1.0, r);
        }
        for damper in &self.dampers {
            damper.add_force(s, hub, self.missing - 1.0, r);
        }
        for law in &mut self.laws {
            law.add_force(s, hub, self.missing - 1.0, r);
        }
    }

    /// Subtracts ∂Q_q/∂q, weighted, from the tangent.
    pub fn subtract_tangent(
        &mut self,
        s: &State,
        hub: &HubKinematics,
        w: &Weights<'_>,
        out: &mut Storage<f64>,
    ) {
        if w.q != 0.0 {
            for group in &self.groups {
                group.add_tangent(s, hub, -w.q, out);
            }
        }
        for damper in &self.dampers {
            damper.add_tangent(hub, w, self.missing - 1.0, out);
        }
        for law in &mut self.laws {
            law.add_tangent(s, hub, w, self.missing - 1.0, out);
        }
    }

    /// Subtracts ∂Q_q/∂θ, ∂Q_θ/∂q and ∂Q_θ/∂θ, weighted, from the border of a free hub.
    pub fn subtract_border(&mut self, s: &State, hub: &HubKinematics, w: &Weights<'_>, out: &mut Border) {
        if w.q != 0.0 {
            for group in &mut self.groups {
                group.add_border(s, hub, -w.q, out);
            }
        }
        for damper in &self.dampers {
            damper.add_border(s, hub, w, self.missing - 1.0, out);
        }
        for law in &mut self.laws {
            law.add_border(s, hub, w, self.missing - 1.0, out);
        }
    }

    /// Torque Q_θ on the hub [N·m].
    pub fn torque(&mut self, s: &State, hub: &HubKinematics) -> f64 {
        let part = 1.0 - self.missing;
        let resisting: f64 = self.dampers.iter().map(|d| part * d.torque(s, hub)).sum();
        let of_laws: f64 = self.laws.iter_mut().map(|law| part * law.torque(s, hub)).sum();
        self.groups.iter_mut().map(|g| g.torque(s, hub)).sum::<f64>() + resisting + of_laws
    }

    /// Power lost in dampers and by force laws \[W\].
    pub fn dissipated(&mut self, s: &State, hub: &HubKinematics) -> f64 {
        let part = 1.0 - self.missing;
        let in_dampers: f64 = self.dampers.iter().map(|d| part * d.dissipated(s, hub)).sum();
        let laws = self.laws.iter_mut().filter(|law| law.dissipates());
        in_dampers - laws.map(|law| part * law.power(s, hub)).sum::<f64>()
    }

    /// Potential energy of gravity \[J\].
    pub fn gravity(&mut self, s: &State, hub: &HubKinematics) -> f64 {
        self.stored(Store::Gravity, s, hub)
    }

    /// Energy of springs \[J\].
    pub fn spring(&mut self, s: &State, hub: &HubKinematics) -> f64 {
        self.stored(Store::Spring, s, hub)
    }

    fn stored(&mut self, store: Store, s: &State, hub: &HubKinematics) -> f64 {
        let groups = self.groups.iter_mut().filter(|g| g.store() == Some(store));
        groups.map(|g| g.potential(s, hub)).sum()
    }

    /// Power of the loads, gravity and springs aside \[W\].
    pub fn power(&mut self, s: &State, hub: &HubKinematics) -> f64 {
        let part = 1.0 - self.missing;
        let laws = self.laws.iter_mut().filter(|law| !law.dissipates());
        let mut power: f64 = laws.map(|law| part * law.power(s, hub)).sum();
        if self.groups.iter().all(|g| g.store().is_some()) {
            return power;
        }
        self.force.fill(0.0);
        for group in self.groups.iter_mut().filter(|g| g.store().is_none()) {
            group.add_force(s, hub, 1.0, &mut self.force);
            power += group.torque(s, hub) * hub.speed;
        }
        power + self.force.iter().zip(&s.v).map(|(f, v)| f * v).sum::<f64>()
    }

    /// A number that identifies the stiffness of the loads at a time and an angle of the hub that moves as
    /// prescribed.
    pub fn stamp(&self, s: &State, hub: &HubKinematics) -> f64 {
        let stiff = || self.groups.iter().filter(|g| g.is_stiff());
        if self.missing != 0.0 {
            // No number: a tangent with part of the loads is never taken for another.
            f64::NAN
        } else if !self.dampers.is_empty() || !self.laws.is_empty() || stiff().any(Group::varies) {
            s.time()
        } else if stiff().any(|g| g.axes() == Axes::Dead) {
            hub.angle
        } else {
            0.0
        }
    }
}
