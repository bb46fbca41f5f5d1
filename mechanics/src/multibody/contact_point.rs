//! A point of a body or a beam that may touch obstacles.

use super::marker::{Marker, Part};

/// A point that may touch obstacles.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContactPoint {
    /// The point, or any point on the beam of this node.
    pub at: Marker,
    /// Radius of the ball about it, or of the beam \[m\].
    pub radius: f64,
    /// Whether it is the point of the beam nearest to the obstacle.
    pub anywhere: bool,
}

impl ContactPoint {
    /// The beam of which it is any point.
    pub fn beam(&self) -> Option<usize> {
        match self.at.part {
            Part::Section { beam, .. } if self.anywhere => Some(beam),
            _ => None,
        }
    }
}
