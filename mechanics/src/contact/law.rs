//! A contact: a point, the obstacle that it may touch, and what happens then.

use super::force::ContactForce;
use super::obstacle::Obstacle;
use std::sync::Arc;

/// What happens when a point touches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// The point cannot enter: impulse and momentum, then a constraint until it would pull.
    Constraint {
        /// Newton's coefficient of restitution e, 0 … 1.
        restitution: f64,
        /// Coefficient of Coulomb's friction μ ≥ 0.
        friction: f64,
    },
    /// A continuous force.
    Force(ContactForce),
}

impl Law {
    /// Whether it has friction.
    pub fn has_friction(&self) -> bool {
        match self {
            Law::Constraint { friction, .. } => *friction > 0.0,
            Law::Force(force) => force.friction > 0.0,
        }
    }
}

/// A point and the obstacle that it may touch.
#[derive(Clone, Debug)]
pub struct Contact {
    /// Prefix of its columns.
    pub name: String,
    /// Number of the point.
    pub point: usize,
    /// What it may touch.
    pub obstacle: Arc<dyn Obstacle>,
    /// What happens then.
    pub law: Law,
}
