//! Loads on the beam: gravity, forces, couples and forces per length, with their torque on the hub.
//!
//! A force with components F = (F_x, F_y) acts on a place r = (X, Y) of the axis. In the hub's frame its
//! components are d = R(−θ) F in inertial axes (`Dead`), F itself if it turns with the hub (`Hub`), and
//! F_x t + F_y n if it turns with the section (`Follower`, t and n tangent and normal). With p the force's share
//! of each place (a density, or 1 at one station) and f(t) its amplitude, virtual work gives
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
//! | `Straight` | w₁, w₂ | linear | turns by w₂′ |
//! | `Foreshortened` | w₁ − ½∫₀ˣ w₂′² dξ, w₂ | quadratic, banded: −½∫ P w₂′² dξ, P(ξ) = ∫_ξᴸ p dx | turns by w₂′ |
//! | `Curve` | U, V | linear | turns with the tangent (X′, Y′)/ℓ |

mod couple;
mod distributed;
mod force;
mod gravity;
mod group;
mod on_section;
mod site;
#[cfg(test)]
mod tests;

pub use couple::Couple;
pub use distributed::DistributedForce;
pub use force::Force;
pub use gravity::Gravity;
pub use site::{Kinematics, Site};

use super::inertia::Border;
use crate::linalg::Storage;
use crate::profile::{HubKinematics, Profile};
use crate::system::{Break, State, Weights};
use group::Group;
use std::sync::Arc;

/// What the components of a force refer to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axes {
    /// The inertial axes: the force keeps its direction in space.
    Dead,
    /// The hub's axes, radial and transverse: the force turns with the hub.
    Hub,
    /// Tangent and normal of the section it acts on: the force turns with the section.
    Follower,
}

/// How a load changes with time: a factor f(t), or 1 where there is none.
pub type Amplitude = Option<Arc<dyn Profile>>;

/// A load: what it does to a beam with the given kinematics.
pub trait Load: std::fmt::Debug {
    /// The load on a beam, ready to be evaluated.
    fn group(&self, site: &Site<'_>) -> Group;
}

/// The loads of a system. Empty, they cost nothing.
#[derive(Debug, Default)]
pub struct Loads {
    groups: Vec<Group>,
    breaks: Vec<Break>,
    /// What is not there of the loads: 0 but while an equilibrium is followed.
    missing: f64,
    /// Forces, for their power.
    force: Vec<f64>,
}

impl Loads {
    /// Loads on the beam at `site`.
    pub fn new(site: &Site<'_>, loads: &[&dyn Load]) -> Loads {
        let groups: Vec<Group> = loads.iter().map(|load| load.group(site)).collect();
        let breaks = groups.iter().flat_map(Group::breaks).collect();
        Loads { groups, breaks, missing: 0.0, force: vec![0.0; site.fields.len()] }
    }

    /// Whether there is no load.
    pub fn is_empty(&self) -> bool {
        self.groups.is_empty()
    }

    /// Whether gravity is among them.
    pub fn has_gravity(&self) -> bool {
        self.groups.iter().any(|g| g.is_gravity())
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
    }

    /// Subtracts ∂Q_q/∂q, weighted, from the tangent.
    pub fn subtract_tangent(&self, s: &State, hub: &HubKinematics, w: &Weights<'_>, out: &mut Storage<f64>) {
        if w.q != 0.0 {
            for group in &self.groups {
                group.add_tangent(s, hub, -w.q, out);
            }
        }
    }

    /// Subtracts ∂Q_q/∂θ, ∂Q_θ/∂q and ∂Q_θ/∂θ, weighted, from the border of a free hub.
    pub fn subtract_border(&mut self, s: &State, hub: &HubKinematics, w: &Weights<'_>, out: &mut Border) {
        if w.q != 0.0 {
            for group in &mut self.groups {
                group.add_border(s, hub, -w.q, out);
            }
        }
    }

    /// Torque Q_θ on the hub [N·m].
    pub fn torque(&mut self, s: &State, hub: &HubKinematics) -> f64 {
        self.groups.iter_mut().map(|g| g.torque(s, hub)).sum()
    }

    /// Potential energy of gravity \[J\].
    pub fn gravity(&mut self, s: &State, hub: &HubKinematics) -> f64 {
        self.groups.iter_mut().map(|g| g.potential(s, hub)).sum()
    }

    /// Power of the loads, gravity aside \[W\].
    pub fn power(&mut self, s: &State, hub: &HubKinematics) -> f64 {
        let mut power = 0.0;
        if self.groups.iter().all(Group::is_gravity) {
            return power;
        }
        self.force.fill(0.0);
        for group in self.groups.iter_mut().filter(|g| !g.is_gravity()) {
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
        } else if stiff().any(Group::varies) {
            s.time()
        } else if stiff().any(|g| g.axes() == Axes::Dead) {
            hub.angle
        } else {
            0.0
        }
    }
}
