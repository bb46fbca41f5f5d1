//! The one seam: what a mechanical model shows to an integrator or an analysis.
//!
//! A [`System`] is a set of equations of motion in second-order form with constraints,
//!
//! ```text
//! r(t, q, v, a, λ) = M(q) a − f(t, q, v) + G(q)ᵀ λ = 0,     g(t, q) = 0,     q̇ = v,  v̇ = a
//! ```
//!
//! The integrator never sees M, C or K: it hands over three scalar [`Weights`] and the system
//! writes the one weighted tangent `w.a ∂r/∂a + w.v ∂r/∂v + w.q ∂r/∂q`. Rotations belong to the
//! system (through [`System::retract`]), never to the integrator.
//!
//! The trait is object-safe and every virtual call is made at system level: never inside a
//! loop over elements, where it would cost more than the element.

use crate::linalg::{Matrix, Scalar, Structure};

/// Time, configuration, velocity, acceleration and multipliers of a system: the caller's memory.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// Time t [s].
    pub t: f64,
    /// Configuration q, `Size::q` entries, in the units of the system's labels.
    pub q: Vec<f64>,
    /// Velocity v, `Size::v` entries.
    pub v: Vec<f64>,
    /// Acceleration a = v̇, `Size::v` entries.
    pub a: Vec<f64>,
    /// Constraint multipliers λ, `Size::lambda` entries.
    pub lambda: Vec<f64>,
}

impl State {
    /// A state of zeros of the given size at time `t`.
    pub fn zeros(size: Size, t: f64) -> State {
        State {
            t,
            q: vec![0.0; size.q],
            v: vec![0.0; size.v],
            a: vec![0.0; size.v],
            lambda: vec![0.0; size.lambda],
        }
    }

    /// Copies `other` into `self` without allocating (the sizes must agree).
    pub fn copy_from(&mut self, other: &State) {
        self.t = other.t;
        self.q.copy_from_slice(&other.q);
        self.v.copy_from_slice(&other.v);
        self.a.copy_from_slice(&other.a);
        self.lambda.copy_from_slice(&other.lambda);
    }

    /// Whether every entry is a finite number.
    pub fn is_finite(&self) -> bool {
        let finite = |x: &[f64]| x.iter().all(|x| x.is_finite());
        self.t.is_finite() && finite(&self.q) && finite(&self.v) && finite(&self.a) && finite(&self.lambda)
    }
}

/// Numbers of coordinates, velocities and multipliers (nq ≥ nv).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Size {
    /// Number of configuration coordinates.
    pub q: usize,
    /// Number of velocities, and of equations of motion.
    pub v: usize,
    /// Number of constraints, and of multipliers.
    pub lambda: usize,
}

/// Scalar weights of the tangent w.a M + w.v C + w.q K.
#[derive(Clone, Copy, Debug)]
pub struct Weights<'a> {
    /// Weight of K = ∂r/∂q.
    pub q: f64,
    /// Weight of C = ∂r/∂v.
    pub v: f64,
    /// Weight of M = ∂r/∂a.
    pub a: f64,
    /// The increment since the last step at which the configuration is retracted, for systems
    /// whose configuration is not a vector space; `None` where it is zero or irrelevant.
    pub increment: Option<&'a [f64]>,
    /// The level at which constraints are differentiated.
    pub level: Level,
}

impl Weights<'_> {
    /// Weights of an unconstrained tangent on a vector space.
    pub fn new(a: f64, v: f64, q: f64) -> Weights<'static> {
        Weights { q, v, a, increment: None, level: Level::Position }
    }
}

/// Level at which a constraint is imposed: g, ġ or g̈.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// g(t, q) = 0
    Position,
    /// ġ = G v + ∂g/∂t = 0
    Velocity,
    /// g̈ = 0
    Acceleration,
}

/// Name, unit and scale of one unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// What it is and where, e.g. `deflection at x = 4 m`.
    pub name: String,
    /// SI unit, empty for pure numbers.
    pub unit: &'static str,
    /// Size by which errors and increments of this unknown are measured (> 0).
    pub scale: f64,
}

/// What an unknown moves: for the shares of a mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Direction {
    /// The beam along its axis.
    Axial,
    /// The beam across, in the plane of rotation (lead–lag).
    Chord,
    /// The beam across, out of the plane of rotation.
    Flap,
    /// The section about the axis.
    Torsion,
    /// The hub.
    Hub,
    /// Something else, or several of these.
    Other,
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
}

impl Energy {
    /// Total mechanical energy T + U + V.
    pub fn total(&self) -> f64 {
        self.kinetic + self.strain + self.gravity
    }
}

/// Power of everything that is not in [`Energy`], in watts: d(T + U + V)/dt = [`Power::total`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Power {
    /// Power of what moves the system: prescribed motions, motors.
    pub drive: f64,
    /// Power of the loads, gravity aside.
    pub loads: f64,
    /// Power lost in dampers (≥ 0).
    pub dissipated: f64,
}

impl Power {
    /// Rate of the total energy: drive + loads − dissipated.
    pub fn total(&self) -> f64 {
        self.drive + self.loads - self.dissipated
    }
}

/// A section frame: where a station is and how it is turned.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Frame {
    /// Position in the inertial frame [m].
    pub position: [f64; 3],
    /// Rotation matrix whose columns are the section's axes (tangent first) in the inertial frame.
    pub rotation: [[f64; 3]; 3],
}

/// One recorded quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Column name, e.g. `tip.deflection`.
    pub name: String,
    /// SI unit, e.g. `m`.
    pub unit: &'static str,
    /// One line for people: what it is.
    pub meaning: String,
}

/// How the sections turn from one state to another: rotations of pairs of unknowns, which are the components of
/// a vector in the plane.
#[derive(Clone, Debug, Default)]
pub struct Turns {
    pairs: Vec<Turned>,
}

/// A pair of unknowns and the cosine and sine of its rotation.
#[derive(Clone, Copy, Debug)]
struct Turned {
    unknowns: [usize; 2],
    cos: f64,
    sin: f64,
}

impl Turns {
    /// No rotations, with room for those of `n` unknowns.
    pub fn with_room(n: usize) -> Turns {
        Turns { pairs: Vec::with_capacity(n / 2) }
    }

    /// Forgets all rotations.
    pub fn clear(&mut self) {
        self.pairs.clear();
    }

    /// Turns the vector with the components `unknowns` by the angle with this cosine and sine.
    #[inline]
    pub fn push(&mut self, unknowns: [usize; 2], cos: f64, sin: f64) {
        self.pairs.push(Turned { unknowns, cos, sin });
    }

    /// x ← R x
    pub fn turn<T: Scalar>(&self, x: &mut [T]) {
        for &Turned { unknowns: [i, j], cos, sin } in &self.pairs {
            (x[i], x[j]) = (x[i].times(cos) - x[j].times(sin), x[i].times(sin) + x[j].times(cos));
        }
    }

    /// x ← Rᵀ x
    pub fn turn_back<T: Scalar>(&self, x: &mut [T]) {
        for &Turned { unknowns: [i, j], cos, sin } in &self.pairs {
            (x[i], x[j]) = (x[i].times(cos) + x[j].times(sin), x[j].times(cos) - x[i].times(sin));
        }
    }
}

/// A mechanical model. See the [module documentation](self) for the equations.
pub trait System {
    /// Numbers of coordinates, velocities and multipliers.
    fn size(&self) -> Size;

    /// Structure of the tangent: order, bandwidth, border, storage.
    fn structure(&self) -> Structure;

    /// One label for each velocity, then one for each multiplier.
    fn labels(&self) -> &[Label];

    /// The state at t = 0 without deformation, its accelerations still to be found.
    fn initial(&self) -> State {
        State::zeros(self.size(), 0.0)
    }

    /// Holds rigid motions (a hub that is free to turn) at the values they have: for an equilibrium in a frame
    /// that moves steadily. The equation of a held unknown is that it does not change.
    fn hold(&mut self, _held: bool) {}

    /// Applies `part` of the loads from now on, 0 … 1: an equilibrium is followed as they grow. Nothing to do for a
    /// system that carries none.
    fn load(&mut self, _part: f64) {}

    /// `out` = q ⊞ d: the configuration q moved by the increment d (`Size::v` entries).
    /// On a vector space, q + d.
    fn retract(&self, q: &[f64], d: &[f64], out: &mut [f64]) {
        for ((out, q), d) in out.iter_mut().zip(q).zip(d) {
            *out = q + d;
        }
    }

    /// `r` = M a − f + Gᵀ λ, `Size::v` entries.
    fn residual(&mut self, s: &State, r: &mut [f64]);

    /// `g` = g, ġ or g̈, `Size::lambda` entries. Nothing to do for a system without constraints.
    fn constraint(&mut self, _s: &State, _level: Level, _g: &mut [f64]) {}

    /// Writes w.a ∂r/∂a + w.v ∂r/∂v + w.q ∂r/∂q, bordered by G and Gᵀ, into `out`, whose former
    /// content is discarded. A system may leave a factored `out` as it is when it recognises, by the
    /// matrix's [stamp](crate::linalg::Matrix::stamp), that it already holds the very same tangent.
    fn tangent(&mut self, s: &State, w: Weights<'_>, out: &mut Matrix);

    /// Writes how the sections turn from `before` to `now`: with the rotations R, ∂r/∂q(now) is near R ∂r/∂q(before) Rᵀ
    /// though the stretching stiffness of a slender beam outweighs all others. Nothing for a system whose stiffness
    /// does not turn with the sections.
    fn turns(&self, _before: &State, _now: &State, out: &mut Turns) {
        out.clear();
    }

    /// Turns the hub at a steady speed [rad/s] from now on, whatever drove it: a prescribed motion is replaced, a hub
    /// that is free gets it as the speed of its [initial](System::initial) and [held](System::hold) state.
    /// `false` for a system that does not turn, which stays as it is.
    fn turn_steadily(&mut self, _speed: f64) -> bool {
        false
    }

    /// xᵀ (∂r/∂q) x of each of the vectors, the strain energy summed strain by strain, Σ w (bᵀx)². `None` for a model that
    /// has its stiffness as a matrix only.
    ///
    /// The condition number of the stiffness of n bending elements grows like n⁴: its entries, rounded to doubles, lose
    /// the lowest frequencies, but not the strains, which lose n²ε.
    fn stiffness_forms(&mut self, _s: &State, _vectors: &[Vec<f64>]) -> Option<Vec<f64>> {
        None
    }

    /// What unknown `i` (a velocity) moves.
    fn direction(&self, _i: usize) -> Direction {
        Direction::Other
    }

    /// Whether r is affine in (q, v, a) at fixed t: Newton then needs one iteration.
    fn is_affine(&self) -> bool {
        false
    }

    /// Kinetic, strain and gravity energy.
    fn energy(&mut self, s: &State) -> Energy;

    /// Power of everything that is not in [`System::energy`]: drives, loads and dampers.
    fn power(&mut self, s: &State) -> Power;

    /// [`System::energy`] and [`System::power`] of one state, for systems in which they share their work.
    fn energy_and_power(&mut self, s: &State) -> (Energy, Power) {
        (self.energy(s), self.power(s))
    }

    /// Frames of the sections at the given stations (arc lengths from the root, in metres).
    fn shape(&mut self, s: &State, stations: &[f64], out: &mut [Frame]);

    /// The recorded quantities, in the order in which [`System::record`] writes them.
    fn channels(&self) -> &[Channel];

    /// Writes one value for each channel.
    fn record(&mut self, s: &State, out: &mut [f64]);

    /// Times at which the right-hand side loses smoothness, ascending: steps end there.
    fn breaks(&self) -> &[f64] {
        &[]
    }

    /// `Err` when the state has left what the model can represent, with the reason.
    fn admissible(&mut self, _s: &State) -> Result<(), String> {
        Ok(())
    }

    /// What the model knows about why a run may break down at this state, for messages.
    fn explain(&mut self, _s: &State) -> Option<String> {
        None
    }

    /// What the reader of a run should know about the validity of the model, from all that was recorded.
    fn cautions(&self) -> Vec<String> {
        Vec::new()
    }
}
