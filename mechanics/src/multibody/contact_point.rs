//! A point of a body or a beam that may touch obstacles.

use super::marker::{Marker, Part};

/// A point that may touch obstacles.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContactPoint {
    /// The point, or the first section of the beam on whose axis it is.
    pub at: Marker,
    /// Radius of the ball about it, or of the beam \[m\].
    pub radius: f64,
    /// Where on the axis of a beam it is, which needs no node there; `None` of a point of a body or of a section.
    pub axis: Option<Along>,
    /// Frame, on another part, to which the obstacle is fixed; `None` of one that is given in space.
    pub carrier: Option<Marker>,
}

/// A point of the axis of a beam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Along {
    /// The one nearest to the obstacle.
    Nearest,
    /// That at an arc length \[m\].
    Station(f64),
}

impl ContactPoint {
    /// The beam on whose axis it is.
    pub fn beam(&self) -> Option<usize> {
        match self.at.part {
            Part::Section { beam, .. } if self.axis.is_some() => Some(beam),
            _ => None,
        }
    }
}
