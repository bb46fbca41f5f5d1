//! Equilibria along a path of loads.

use flexion::analysis::Stability;
use flexion::analysis::path::Critical;
use flexion::system::{Channel, Role};

/// Equilibria under growing loads, in their order along the path.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LoadPath {
    /// The recorded quantities.
    pub channels: Vec<Channel>,
    /// The equilibria.
    pub points: Vec<LoadPoint>,
    /// Load factor to which the path is followed.
    pub to: f64,
    /// Why the path ends before, if it does.
    pub end: Option<String>,
    /// Why its errors are not known, where they are not.
    pub unknown: Option<String>,
    /// What its reader should know about the validity of the model.
    pub cautions: Vec<String>,
}

/// An equilibrium on a path.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadPoint {
    /// Factor of the loads.
    pub factor: f64,
    /// Length of the path to it: of displacements over their scales, and of the factor.
    pub length: f64,
    /// Its stability; `None` where it was not found.
    pub stability: Option<Stability>,
    /// What it is, if it is critical.
    pub critical: Option<Critical>,
    /// Value of each channel.
    pub values: Vec<f64>,
    /// Estimated errors, where they are known: of the critical states and the last point.
    pub error: Option<PointError>,
}

/// Estimated errors of an equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct PointError {
    /// Of the load factor.
    pub factor: f64,
    /// Of each channel.
    pub values: Vec<f64>,
}

impl LoadPath {
    /// The channels that are printed and change along the path, and their numbers.
    pub fn printed(&self) -> impl Iterator<Item = (usize, &Channel)> {
        let main = |role| matches!(role, Role::Primary | Role::Secondary);
        let printed = self.channels.iter().enumerate().filter(move |(_, channel)| main(channel.role));
        printed.filter(|(i, _)| self.changes(*i))
    }

    /// Whether a channel changes along the path.
    pub(super) fn changes(&self, i: usize) -> bool {
        self.points.windows(2).any(|pair| pair[0].values[i] != pair[1].values[i])
    }

    /// The critical states.
    pub fn critical(&self) -> impl Iterator<Item = (&LoadPoint, Critical)> {
        self.points.iter().filter_map(|point| point.critical.map(|critical| (point, critical)))
    }
}
