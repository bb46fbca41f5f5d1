//! The state of a system: the caller's memory.

/// The limit that a time stands for where a load or a motion jumps: a step that ends at a jump takes the left limit,
/// the step behind it begins with the right one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Side {
    /// The limit from before the time.
    Left,
    /// The limit from behind the time.
    #[default]
    Right,
}

/// What the row of a multiplier does: see [`Set`](super::Set).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Mode {
    /// The constraint holds: a joint, a closed contact, a contact that sticks.
    #[default]
    Closed,
    /// The contact is open: λ = 0.
    Open,
    /// The contact slips in the positive direction: λ = −μ λ_n.
    SlipForward,
    /// The contact slips in the negative direction: λ = +μ λ_n.
    SlipBackward,
}

impl Mode {
    /// From its number in a checkpoint.
    pub fn from_number(x: f64) -> Mode {
        [Mode::Closed, Mode::Open, Mode::SlipForward, Mode::SlipBackward][(x as usize).min(3)]
    }
}

/// Time, configuration, velocity, acceleration, multipliers, modes and memory of a system.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// Time t \[s\].
    pub t: f64,
    /// Which limit is meant where something jumps at t.
    pub side: Side,
    /// Configuration q, `Size::q` entries.
    pub q: Vec<f64>,
    /// Velocity v, `Size::v` entries, in the units of the system's [scales](super::Dynamics::scales) per second.
    pub v: Vec<f64>,
    /// Acceleration a = v̇, `Size::v` entries.
    pub a: Vec<f64>,
    /// Multipliers λ, `Size::lambda` entries: forces that hold the constraints.
    pub lambda: Vec<f64>,
    /// Mode of each row, `Size::lambda` entries.
    pub mode: Vec<Mode>,
    /// Quantities that only events change, `Size::memory` entries, e.g. the speed at which a contact closed.
    pub memory: Vec<f64>,
}

impl State {
    /// A state of zeros of the given size at time `t`, all rows closed.
    pub fn zeros(size: Size, t: f64) -> State {
        State {
            t,
            side: Side::Right,
            q: vec![0.0; size.q],
            v: vec![0.0; size.v],
            a: vec![0.0; size.v],
            lambda: vec![0.0; size.lambda],
            mode: vec![Mode::Closed; size.lambda],
            memory: vec![0.0; size.memory],
        }
    }

    /// The time at which functions of time are evaluated \[s\]: t, or for its left limit the number before it.
    pub fn time(&self) -> f64 {
        match self.side {
            Side::Left => self.t.next_down(),
            Side::Right => self.t,
        }
    }

    /// Copies `other` into `self` without allocating (the sizes must agree).
    pub fn copy_from(&mut self, other: &State) {
        (self.t, self.side) = (other.t, other.side);
        self.q.copy_from_slice(&other.q);
        self.v.copy_from_slice(&other.v);
        self.a.copy_from_slice(&other.a);
        self.lambda.copy_from_slice(&other.lambda);
        self.copy_modes(other);
    }

    /// Copies modes and memory, multipliers and accelerations.
    pub(crate) fn copy_forces(&mut self, other: &State) {
        self.copy_modes(other);
        self.lambda.copy_from_slice(&other.lambda);
        self.a.copy_from_slice(&other.a);
    }

    /// Copies what does not change in a step: modes and memory.
    pub fn copy_modes(&mut self, other: &State) {
        self.mode.copy_from_slice(&other.mode);
        self.memory.copy_from_slice(&other.memory);
    }

    /// Whether every entry is a finite number.
    pub fn is_finite(&self) -> bool {
        let finite = |x: &[f64]| x.iter().all(|x| x.is_finite());
        self.t.is_finite() && finite(&self.q) && finite(&self.v) && finite(&self.a) && finite(&self.lambda)
    }
}

/// Numbers of coordinates, velocities, multipliers and remembered quantities (nq ≥ nv).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Size {
    /// Number of configuration coordinates.
    pub q: usize,
    /// Number of velocities, and of equations of motion.
    pub v: usize,
    /// Number of constraints, and of multipliers: every contact that may ever close is counted.
    pub lambda: usize,
    /// Number of quantities that only events change.
    pub memory: usize,
}
