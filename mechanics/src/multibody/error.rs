//! What is wrong with a model or with a beam of it.

use std::fmt;

/// Why no beam can be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BeamError {
    /// The ends of the elements are not ascending, or fewer than two.
    #[error(
        "the elements of a beam must end at two or more ascending arc lengths: number {number} is {at} m"
    )]
    Ends {
        /// Number of the end.
        number: usize,
        /// Its arc length \[m\].
        at: f64,
    },
    /// The axes of a section are no rotation, or its position is not finite.
    #[error("the axes of the section at s = {at} m must be unit vectors at right angles, right-handed")]
    Axes {
        /// Arc length \[m\].
        at: f64,
    },
    /// The sections of an element are too far apart in orientation.
    #[error(
        "the beam turns by {angle:.0}° within the element from s = {at} m: it must stay below 90°; take more elements"
    )]
    Turned {
        /// Arc length of the element's begin \[m\].
        at: f64,
        /// Angle \[°\].
        angle: f64,
    },
    /// A quantity of a section is out of range.
    #[error("the section at s = {at} m: {what}")]
    Section {
        /// Arc length \[m\].
        at: f64,
        /// What is wrong.
        what: &'static str,
    },
}

impl BeamError {
    /// Refuses ends of elements \[m\] that do not ascend, or are fewer than two.
    pub(super) fn of_ends(ends: &[f64]) -> Result<(), BeamError> {
        let wrong = |i: &usize| !ends[*i].is_finite() || *i > 0 && !(ends[*i] > ends[i - 1]);
        match (0..ends.len()).find(wrong) {
            Some(number) => Err(BeamError::Ends { number, at: ends[number] }),
            None if ends.len() < 2 => {
                Err(BeamError::Ends { number: ends.len(), at: ends.first().copied().unwrap_or(0.0) })
            }
            None => Ok(()),
        }
    }
}

/// The ends of so many elements of equal length \[m\].
pub(super) fn equal_ends(length: f64, elements: usize) -> Vec<f64> {
    (0..=elements).map(|i| length * i as f64 / elements.max(1) as f64).collect()
}

/// What is wrong with a part of a model.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PartFault {
    /// A number is infinite or NaN.
    #[error("has a {0} that is not finite")]
    NotFinite(&'static str),
    /// A quantity is negative or not finite.
    #[error("has the {what} {value}{} and must have one ≥ 0", if unit.is_empty() { String::new() } else { format!(" {unit}") })]
    Negative {
        /// Name of the quantity.
        what: &'static str,
        /// Its value.
        value: f64,
        /// Its unit, if it is said.
        unit: &'static str,
    },
    /// A body has no mass.
    #[error("has the mass {0} kg and must have one > 0: join what has no mass to a body")]
    NoMass(f64),
    /// An inertia tensor is not one.
    #[error("has an inertia tensor that is not symmetric and positive definite")]
    Inertia,
    /// A principal moment of inertia exceeds the sum of the others.
    #[error("has principal moments of inertia of which one exceeds the sum of the others by {0:.3e} kg·m²")]
    Moments(f64),
    /// Axes are not orthonormal.
    #[error("has axes that are no rotation (R Rᵀ − I = {0:.1e})")]
    Axes(f64),
    /// A joint of this kind, by its name, has no coordinate that could be driven.
    #[error("is {0} and has a drive: only revolute, cylindrical and prismatic joints have")]
    Drive(String),
    /// A prescribed angle or displacement jumps.
    #[error(
        "has a prescribed angle or displacement that jumps by {jump:.3e} at t = {time} s, which is no motion: use a ramp or a smooth profile"
    )]
    Jump {
        /// Size \[rad\] or \[m\].
        jump: f64,
        /// Time \[s\].
        time: f64,
    },
    /// A station lies off the beam.
    #[error("has a station at {station} m, outside of {first} m to {last} m")]
    Station {
        /// The station \[m\].
        station: f64,
        /// The root \[m\].
        first: f64,
        /// The tip \[m\].
        last: f64,
    },
    /// Two fibres have one name.
    #[error("has two fibres with the name `{0}`")]
    Fibres(String),
    /// A fibre lies farther from the axis than the beam is long.
    #[error(
        "has the fibre `{name}` {distance:.3e} m from its axis, which is more than its length, {length} m: a fibre lies in the section"
    )]
    Fibre {
        /// Its name.
        name: String,
        /// Its distance from the axis \[m\].
        distance: f64,
        /// Length of the beam \[m\].
        length: f64,
    },
    /// A number of a spring is negative or not finite.
    #[error("has a stiffness, damping or length that is not a number ≥ 0")]
    Spring,
    /// A spring in all directions has a length without force.
    #[error("acts in all directions and has the length {0} m without force")]
    Length(f64),
    /// Its axis is zero.
    #[error("has an axis without direction")]
    NoDirection,
    /// Its body or node is not in the model.
    #[error("is on a body or a node that is not in the model")]
    NoPart,
    /// Its beam is not in the model.
    #[error("is on a beam that is not in the model")]
    NoBeam,
    /// It joins a part to itself.
    #[error("has both ends on the same part")]
    SamePart,
    /// It acts on the ground.
    #[error("is on the ground and moves nothing")]
    OnGround,
    /// Its name is taken.
    #[error("has a name that is already taken")]
    NameTaken,
}

/// A joint whose markers do not fit together at the start.
#[derive(Clone, Debug, PartialEq)]
pub struct Violation {
    /// Number of the joint in the model.
    pub number: usize,
    /// Name of the joint.
    pub joint: String,
    /// Largest displacement that it forbids \[m\].
    pub length: f64,
    /// Largest cosine of axes that must be perpendicular.
    pub angle: f64,
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` by {:.3e} m and {:.3e} rad", self.joint, self.length, self.angle)
    }
}

/// A row of a joint that the rows of other joints make.
#[derive(Clone, Debug, PartialEq)]
pub struct DependentRow {
    /// Number of its joint in the model.
    pub joint: usize,
    /// Name of its joint.
    pub name: String,
    /// What it keeps: `displacement along the first axis`.
    pub keeps: String,
    /// Numbers and names of the other joints.
    pub others: Vec<(usize, String)>,
}

impl DependentRow {
    fn names(&self) -> String {
        list(&self.others.iter().map(|(_, name)| format!("`{name}`")).collect::<Vec<_>>())
    }

    /// With the joints that it follows from, for messages.
    pub fn following(&self) -> String {
        format!("{self} (which follows from {})", self.names())
    }

    /// With the joints that are against it, for messages.
    pub fn opposed(&self) -> String {
        format!("{self} against {}", self.names())
    }
}

impl fmt::Display for DependentRow {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} in joint `{}`", self.keeps, self.name)
    }
}

/// Why a model has no equations of motion.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ModelError {
    /// A number or a reference is wrong.
    #[error("{kind} `{name}` {fault}")]
    Part {
        /// Body, beam, joint, spring or load.
        kind: &'static str,
        /// Which of its kind in the model: loads at points come before those along beams, and these before force laws.
        number: usize,
        /// Its name.
        name: String,
        /// What is wrong with it.
        fault: PartFault,
    },
    /// There is nothing that moves.
    #[error("the model has no body and no beam")]
    Empty,
    /// Markers of joints do not coincide at the start.
    #[error(
        "the bodies do not fit their joints at the start: {}; move the bodies or the markers",
        list(violations)
    )]
    Positions {
        /// The joints, the worst first.
        violations: Vec<Violation>,
    },
    /// Rows of joints follow from those of other joints.
    #[error(
        "{} redundant: the joints of a loop hold a motion twice, and {freedoms} degrees of freedom are left. Give a joint of the loop more freedom \
         (spherical, universal or cylindrical in the place of revolute), take away the prescribed motion of what is locked, or drop the rows \
         (`Model::drop_redundant_rows`): their forces are then zero",
        list(&rows.iter().map(DependentRow::following).collect::<Vec<_>>())
    )]
    Redundant {
        /// Each row with the joints that it follows from.
        rows: Vec<DependentRow>,
        /// Degrees of freedom.
        freedoms: usize,
    },
    /// Prescribed motions that cannot happen together.
    #[error(
        "joints that contradict each other: {}: what they prescribe at the start differs in velocity or acceleration; take away a prescribed motion, \
         let them agree, or give a joint more freedom",
        list(&rows.iter().map(DependentRow::opposed).collect::<Vec<_>>())
    )]
    Contradictory {
        /// Each row with the joints that it contradicts.
        rows: Vec<DependentRow>,
    },
    /// Rows that follow from others at the start only.
    #[error(
        "the start is a singular configuration of {}: bars that are stretched out or folded flat, which the joints let move on in more than one \
         way or in none; begin elsewhere, or give a joint more freedom",
        list(&rows.iter().map(DependentRow::opposed).collect::<Vec<_>>())
    )]
    Singular {
        /// Each row with the joints that it depends on.
        rows: Vec<DependentRow>,
    },
    /// No velocities obey the joints.
    #[error("the joints allow no velocities at the start: {0}")]
    Velocities(String),
}

fn list<T: fmt::Display>(of: &[T]) -> String {
    of.iter().map(|x| x.to_string()).collect::<Vec<_>>().join(", ")
}
