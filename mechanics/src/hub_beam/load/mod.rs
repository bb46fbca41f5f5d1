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
//! evaluated then and not in a run. How C depends on q is the coupling's [`Kinematics`]:
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
pub use site::{Kinematics, Site};
pub use spring::Spring;

use super::inertia::Border;
use crate::linalg::Storage;
use crate::profile::HubKinematics;
use crate::system::{Break, State, Weights};
use group::{Group, Store};

/// A load: what it does to a beam with the given kinematics.
pub trait Load: std::fmt::Debug {
    /// The load on a beam, ready to be evaluated.
    fn group(&self, site: &Site<'_>) -> Group;

    /// The damper that comes with it, if there is one.
    fn damper(&self, _site: &Site<'_>) -> Option<Damper> {
        None
    }
}

/// The loads of a system. Empty, they cost nothing.
#[derive(Clone, Debug, Default)]
pub struct Loads {
    groups: Vec<Group>,
    dampers: Vec<Damper>,
    breaks: Vec<Break>,
    /// Part of the loads that is not applied: 0 except during the continuation of an equilibrium.
    missing: f64,
    /// Forces, for their power.
    force: Vec<f64>,
}

impl Loads {
    /// Loads on the beam at `site`.
    pub fn new(site: &Site<'_>, loads: &[&dyn Load]) -> Loads {
        let groups: Vec<Group> = loads.iter().map(|load| load.group(site)).collect();
        let breaks = groups.iter().flat_map(Group::breaks).collect();
        let dampers = loads.iter().filter_map(|load| load.damper(site)).collect();
        Loads { groups, dampers, breaks, missing: 0.0, force: vec![0.0; site.fields.len()] }
    }

    /// Whether there is no load.
    pub fn is_empty(&self) -> bool {
        self.groups.is_empty()
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
    }

    /// Subtracts ∂Q_q/∂q, weighted, from the tangent.
    pub fn subtract_tangent(&self, s: &State, hub: &HubKinematics, w: &Weights<'_>, out: &mut Storage<f64>) {
        if w.q != 0.0 {
            for group in &self.groups {
                group.add_tangent(s, hub, -w.q, out);
            }
        }
        for damper in &self.dampers {
            damper.add_tangent(hub, w, self.missing - 1.0, out);
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
    }

    /// Torque Q_θ on the hub [N·m].
    pub fn torque(&mut self, s: &State, hub: &HubKinematics) -> f64 {
        let resisting: f64 = self.dampers.iter().map(|d| (1.0 - self.missing) * d.torque(s, hub)).sum();
        self.groups.iter_mut().map(|g| g.torque(s, hub)).sum::<f64>() + resisting
    }

    /// Power lost in dampers \[W\].
    pub fn dissipated(&self, s: &State, hub: &HubKinematics) -> f64 {
        self.dampers.iter().map(|d| (1.0 - self.missing) * d.dissipated(s, hub)).sum()
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
        let mut power = 0.0;
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
        } else if !self.dampers.is_empty() || stiff().any(Group::varies) {
            s.time()
        } else if stiff().any(|g| g.axes() == Axes::Dead) {
            hub.angle
        } else {
            0.0
        }
    }
}
