//! Joints as lists of scalar constraints, with their drives.

use super::error::PartFault;
use super::marker::{Marker, Part};
use super::row::Row;
use crate::drive::{Actuator, motion_breaks};
use crate::profile::Motion;
use crate::system::{Break, Jump};

/// What a joint leaves free. Axes are those of its markers, A of `from` and B of `to`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Nothing: the markers are one frame. Six rows.
    Fixed,
    /// A rotation about the common third axis. Five rows.
    Revolute,
    /// A displacement along the common third axis. Five rows.
    Prismatic,
    /// A rotation about the common third axis and a displacement along it. Four rows.
    Cylindrical,
    /// The rotations about the first axis of A and the second of B, the arms of a cross. Four rows.
    Universal,
    /// All rotations about the common point. Three rows.
    Spherical,
    /// Displacements in the plane of the first two axes of A, and rotations about its third. Three rows.
    Planar,
}

/// What moves a joint about its third axis (revolute, cylindrical) or along it (prismatic): the angle from the first axis of A to that of
/// B, or the displacement of B.
#[derive(Clone, Debug, Default)]
pub enum Drive {
    /// Nothing.
    #[default]
    None,
    /// A prescribed motion. A displacement \[m\] takes the place of the angle in a prismatic joint.
    Prescribed(Motion),
    /// A motor with spring, damper and controller: torques [N·m], or forces \[N\] in a prismatic joint.
    Actuated(Actuator),
}

/// A joint of two markers.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Name, unique in its model.
    pub name: String,
    /// What it leaves free.
    pub kind: Kind,
    /// Marker A.
    pub from: Marker,
    /// Marker B.
    pub to: Marker,
    /// What moves it.
    pub drive: Drive,
    /// The angle that it keeps in the place of its drive while the [rigid motions](crate::system::Steady::hold) are held.
    pub(super) kept: Option<Motion>,
}

/// Smallest jump of an angle \[rad\] or a displacement \[m\] that is one.
const STEP: f64 = 1e-9;

/// The coordinate of a joint's third axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Coordinate {
    Angle,
    Displacement,
}

impl Kind {
    fn rows(self) -> &'static [Row] {
        use Row::{Across, Along, Point};
        match self {
            Kind::Fixed => &[Point(0), Point(1), Point(2), Across(0, 1), Across(1, 2), Across(2, 0)],
            Kind::Revolute => &[Point(0), Point(1), Point(2), Across(2, 0), Across(2, 1)],
            Kind::Prismatic => &[Along(0), Along(1), Across(0, 1), Across(1, 2), Across(2, 0)],
            Kind::Cylindrical => &[Along(0), Along(1), Across(2, 0), Across(2, 1)],
            Kind::Universal => &[Point(0), Point(1), Point(2), Across(0, 1)],
            Kind::Spherical => &[Point(0), Point(1), Point(2)],
            Kind::Planar => &[Along(2), Across(2, 0), Across(2, 1)],
        }
    }

    /// The coordinate that a drive moves and a run records.
    pub(super) fn coordinate(self) -> Option<Coordinate> {
        match self {
            Kind::Revolute | Kind::Cylindrical => Some(Coordinate::Angle),
            Kind::Prismatic => Some(Coordinate::Displacement),
            _ => None,
        }
    }
}

impl Joint {
    /// A joint without drive.
    pub fn new(name: &str, kind: Kind, from: Marker, to: Marker) -> Joint {
        Joint { name: name.to_owned(), kind, from, to, drive: Drive::None, kept: None }
    }

    /// The same joint with a drive.
    pub fn driven(self, drive: Drive) -> Joint {
        Joint { drive, ..self }
    }

    /// Its rows. The axes that are square to the common third one are those of the part that moves: about a joint with the ground the
    /// multipliers of a steady rotation are constant, and kept tangents stay right.
    pub(super) fn rows(&self) -> Vec<Row> {
        let mut rows = self.kind.rows().to_vec();
        if self.to.part == Part::Ground {
            let turned = |row: &Row| if let Row::Across(2, j) = *row { Row::Across(j, 2) } else { *row };
            rows = rows.iter().map(turned).collect();
        }
        if self.prescribed().is_some() {
            rows.extend(self.kind.coordinate().map(|coordinate| match coordinate {
                Coordinate::Angle => Row::Angle,
                Coordinate::Displacement => Row::Displacement,
            }));
        }
        rows
    }

    /// The motion of its last row.
    pub(super) fn prescribed(&self) -> Option<&Motion> {
        match &self.drive {
            Drive::Prescribed(motion) => Some(motion),
            _ => self.kept.as_ref(),
        }
    }

    /// Times at which its drive is not smooth.
    pub(super) fn breaks(&self) -> Vec<Break> {
        match &self.drive {
            Drive::None => Vec::new(),
            Drive::Prescribed(motion) => motion_breaks(motion),
            Drive::Actuated(actuator) => actuator.breaks(),
        }
    }

    /// What is wrong with the drive, if anything.
    pub(super) fn fault(&self) -> Option<PartFault> {
        if !matches!(self.drive, Drive::None) && self.kind.coordinate().is_none() {
            return Some(PartFault::Drive(format!("{:?}", self.kind)));
        }
        let motion = self.prescribed()?;
        let step = |t: f64| motion.at(t).angle - motion.at(t.next_down()).angle;
        let mut struck = self.breaks().into_iter().filter(|b| b.time > 0.0 && b.jump == Jump::Velocity);
        let jump = struck.find(|b| step(b.time).abs() > STEP)?;
        Some(PartFault::Jump { jump: step(jump.time), time: jump.time })
    }
}
