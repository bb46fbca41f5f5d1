//! What is observed of a model: recorded quantities, energies, shapes.

use super::{Channel, Dynamics, Limit, Sink, State};
use crate::linalg::{Mat3, Vec3};
use std::ops::Range;

/// What an unknown moves: for the shares of a mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Direction {
    /// The beam along its axis.
    Axial,
    /// The beam across, in the plane of rotation (lead–lag).
    Chord,
    /// The beam across, out of the plane of rotation.
    Flap,
    /// The beam across, where it rotates about itself: no direction is one of flap or of chord.
    Bending,
    /// The section about the axis.
    Torsion,
    /// The hub.
    Hub,
    /// A point along the first axis of space.
    X,
    /// Along the second.
    Y,
    /// Along the third.
    Z,
    /// A body about its centre of mass.
    Rotation,
    /// Something else, or several of these.
    Other,
    /// The beam along an axis of its section (tangent, height, across), beside the direction among the others.
    Section(usize),
}

/// Energies of a state, in joules.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Kinetic energy T, hub included.
    pub kinetic: f64,
    /// Strain energy U.
    pub strain: f64,
    /// Potential energy of gravity V.
    pub gravity: f64,
    /// Energy stored in contacts C.
    pub contact: f64,
}

impl Energy {
    /// Total mechanical energy T + U + V + C.
    pub fn total(&self) -> f64 {
        self.kinetic + self.strain + self.gravity + self.contact
    }
}

/// Power of everything that is not in [`Energy`], in watts: d(T + U + V + C)/dt = [`Power::total`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Power {
    /// Power of what moves the system: prescribed motions, motors.
    pub drive: f64,
    /// Power of the loads, gravity aside.
    pub loads: f64,
    /// Power lost in dampers (≥ 0).
    pub dissipated: f64,
    /// Power lost in contacts: friction and damping (≥ 0).
    pub contact: f64,
}

impl Power {
    /// Rate of the total energy: drive + loads − dissipated − contact.
    pub fn total(&self) -> f64 {
        self.drive + self.loads - self.dissipated - self.contact
    }
}

/// A section frame: where a station is and how its axes point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Frame {
    /// Position in the inertial frame \[m\].
    pub position: Vec3,
    /// Rotation matrix whose columns are the section's axes (tangent first) in the inertial frame.
    pub rotation: Mat3,
}

/// A beam so slender that rounding of its largest stiffness may hide that in bending.
#[derive(Clone, Debug, PartialEq)]
pub struct Slender {
    /// Its name.
    pub beam: String,
    /// L²GA/EI with shear, else L²EA/EI.
    pub ratio: f64,
    /// Whether it has shear.
    pub shear: bool,
}

impl std::fmt::Display for Slender {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Slender { beam, ratio, shear } = self;
        let (of, stiffness, cure) = if *shear {
            ("in shear", "GA", "leave the shear out, `shear = false` in a case")
        } else {
            ("along its axis", "EA", "use fewer elements, or lay it along an axis of space")
        };
        write!(
            f,
            "beam `{beam}` is so slender, L²{stiffness}/EI = {ratio:.1e}, that rounding of its stiffness {of} hides that in bending; {cure}"
        )
    }
}

/// A contact at a state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactInfo {
    /// Prefix of its columns.
    pub name: String,
    /// Row of its normal force; `None` for a continuous force.
    pub row: Option<usize>,
    /// Rows of its friction, one a direction of sliding.
    pub friction: Range<usize>,
    /// Number of the indicator of a continuous force.
    pub indicator: Option<usize>,
    /// Gap g \[m\].
    pub gap: f64,
    /// Its rate ġ \[m/s\].
    pub rate: f64,
    /// Speeds of the point and of the obstacle, summed, by whose rounding the rate is off [m/s].
    pub speed: f64,
    /// Whether the obstacle is a half-space, through which no way leads.
    pub flat: bool,
}

/// What presses at a contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactSample {
    /// Where its point is, in the axes in which its obstacle is given \[m\].
    pub place: Vec3,
    /// Gap g \[m\].
    pub gap: f64,
    /// Its rate ġ \[m/s\].
    pub rate: f64,
    /// Normal force \[N\].
    pub force: f64,
    /// Power lost in friction and damping \[W\].
    pub lost: f64,
}

/// A force and a couple at a point, of a load, a contact, a joint or a spring.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointForce {
    /// Name of the load, the contact, the joint or the spring.
    pub name: String,
    /// Where it acts, in the inertial frame \[m\].
    pub place: Vec3,
    /// The force on the model, inertial axes \[N\].
    pub force: Vec3,
    /// The couple on it [N·m].
    pub moment: Vec3,
    /// Whether it acts between two parts, or a part and the ground: what a joint or a spring transmits to the second.
    pub transmitted: bool,
}

/// A force per length along a beam, of a load.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LineForce {
    /// Name of the load.
    pub name: String,
    /// From one end of the load to the other: a place of the axis in the inertial frame \[m\], and the force on the beam there, inertial axes [N/m].
    pub points: Vec<[Vec3; 2]>,
}

/// What a model shows of itself. Nothing here changes what a run computes: work memory at most is written.
pub trait Observed: Dynamics {
    /// Kinetic, strain, gravity and contact energy.
    fn energy(&mut self, _s: &State) -> Energy {
        Energy::default()
    }

    /// Power of everything that is not in [`Observed::energy`].
    fn power(&mut self, _s: &State) -> Power {
        Power::default()
    }

    /// [`Observed::energy`] and [`Observed::power`] of one state, for systems in which they share their work.
    fn energy_and_power(&mut self, s: &State) -> (Energy, Power) {
        (self.energy(s), self.power(s))
    }

    /// Frames of the sections of body `body` at the given stations (arc lengths from its root, in metres).
    fn frames(&mut self, _body: usize, _s: &State, _stations: &[f64], _out: &mut [Frame]) {}

    /// Puts the recorded quantities of a state into a sink. Their number and order do not depend on the state.
    fn observe(&mut self, _s: &State, _sink: &mut Sink<'_>) {}

    /// What the recorded quantities are, in the order of [`Observed::record`].
    fn channels(&mut self) -> Vec<Channel> {
        let mut channels = Vec::new();
        let s = self.initial();
        self.observe(&s, &mut Sink::channels(&mut channels));
        channels
    }

    /// Writes one value for each channel.
    fn record(&mut self, s: &State, out: &mut [f64]) {
        self.observe(s, &mut Sink::row(out));
    }

    /// The contacts, in the order of their columns.
    fn contacts(&mut self, _s: &State) -> Vec<ContactInfo> {
        Vec::new()
    }

    /// Writes what presses at each of the [contacts](Observed::contacts), in their order.
    fn contact_samples(&mut self, _s: &State, out: &mut Vec<ContactSample>) {
        out.clear();
    }

    /// The forces and couples of loads, contacts, joints and springs, for pictures. Their number and order do not depend on the state. Loads that
    /// follow from the laws of a program are not among them, for such a law is asked once.
    fn point_forces(&mut self, _s: &State) -> Vec<PointForce> {
        Vec::new()
    }

    /// The forces per length of loads along beams, for pictures: gravity and loads that follow from a law of the motion are not among them. Their number,
    /// their order and the number of their points do not depend on the state.
    fn line_forces(&mut self, _s: &State) -> Vec<LineForce> {
        Vec::new()
    }

    /// What unknown `i` (a velocity) moves.
    fn direction(&self, _i: usize) -> Direction {
        Direction::Other
    }

    /// Calls `add` with the parts of xᵀ(Mx) of a motion x at a state, by what they move.
    fn shares(&self, _s: &State, x: &[f64], mx: &[f64], add: &mut dyn FnMut(Direction, f64)) {
        for (i, (x, mx)) in x.iter().zip(mx).enumerate() {
            add(self.direction(i), x * mx);
        }
    }

    /// The body whose stations show the shape of a mode, as [`Observed::frames`] numbers them.
    fn drawn(&self) -> usize {
        0
    }

    /// `Err` when the state has left what the model can represent.
    fn admissible(&mut self, _s: &State) -> Result<(), Limit> {
        Ok(())
    }

    /// What the model knows about why a run may break down at this state, for messages.
    fn explain(&mut self, _s: &State) -> Option<Limit> {
        None
    }

    /// The most slender beam, where it is so slender that rounding of its stiffness counts.
    fn slender(&self) -> Option<Slender> {
        None
    }

    /// Limits of the model that the reader of a run should know. `peaks` is the largest absolute value of each channel
    /// in the run; without a run it is empty.
    fn cautions(&self, _peaks: &[f64]) -> Vec<String> {
        Vec::new()
    }
}
