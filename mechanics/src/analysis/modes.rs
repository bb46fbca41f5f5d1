//! Modes of vibration about an equilibrium.
//!
//! With M, C, K = ∂r/∂a, ∂r/∂v, ∂r/∂q of a [`System`] at the equilibrium, the modes are the solutions
//! δq = x e^{λt} of (λ² M + λ C + K) x = 0: angular frequency ω = |Im λ|, damping ratio ζ = −Re λ/|λ|. Everything goes
//! through the tangent, so every model has modes; how they are found is described in [`eigen`](crate::linalg::eigen).
//!
//! Rows of constraints that hold are part of K, [K −Gᵀ; −G 0], in which K has the multipliers of the equilibrium: a solution
//! with it is a motion that G allows, and the cost stays linear in the unknowns where the multipliers stand in the band.

use super::rigid::{
    BELOW, RIGID, RIGID_MOTIONS, beyond, elastic_frequency, has_rigid_motions, is_without_form, parts,
};
use super::stability::GROWTH;
use super::stiffness::{freedoms, matrices};
use crate::linalg::Matrix;
use crate::linalg::eigen::{EigenError, Kind, Pair, Pencil, UNCERTAIN};
use crate::linalg::vector::dot;
use crate::system::{Direction, Frame, Slender, State, System};
use num_complex::Complex64;

/// Residual above which a mode is refused, unless the rounding of the stiffness explains it.
const RESIDUAL: f64 = 1e-7;
/// The same of a conservative pencil: the error of its frequencies is the square of that of the vectors.
const CONSERVATIVE: f64 = 1e-5;

/// Residual from which on a pair has no digit.
const NOTHING: f64 = 0.1;

/// Distance, over the shift, of an eigenvalue from the same one as it is seen from another shift.
const AGAIN: f64 = 1e-4;

/// One mode.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// Eigenvalue λ [1/s], Im λ ≥ 0.
    pub eigenvalue: Complex64,
    /// Eigenvector x in the velocities of the system: modal mass xᴴ M x = 1, its largest entry (over the scale of its
    /// label) real and positive.
    pub vector: Vec<Complex64>,
    /// |Q(σ)⁻¹ Q(λ) x| / |x|, with Q(λ) = λ² M + λ C + K: error of the pair, seen through the inverse. Where the lowest
    /// mode is so soft against λ that K⁻¹ magnifies rounding errors along it, through Q(|λ|) or K + |λ|² M.
    pub residual: f64,
    /// Bound of the relative error of the frequency by rounding: δ = ½ ε |x|ᵀ|K||x| / |λ|² by that of the entries of K in
    /// doubles, and δ² where the frequency is corrected by the [strains](crate::system::Dynamics::stiffness_forms) of the mode.
    pub rounding: f64,
    /// Estimated error of the frequency by the mesh [rad/s], where the modes of a finer one were found.
    pub mesh: Option<f64>,
    /// Shares of the modal mass.
    pub shares: Shares,
    /// Displacements along the beam.
    pub shape: Shape,
    /// Number of nodes: places between root and tip at which the largest displacement, or the rotation where torsion has the largest
    /// share, changes its sign.
    pub nodes: usize,
}

impl Mode {
    /// Angular frequency ω = |Im λ| [rad/s]; zero for a motion that only grows or decays.
    pub fn frequency(&self) -> f64 {
        self.eigenvalue.im.abs()
    }

    /// Notes the frequency that a finer mesh has [rad/s], whose difference times `safety` estimates the error by the mesh.
    pub fn compare(&mut self, finer: f64, safety: f64) {
        self.mesh = Some(safety * (self.frequency() - finer).abs());
    }

    /// Damping ratio ζ = −Re λ/|λ|: positive decays, negative grows.
    pub fn damping_ratio(&self) -> f64 {
        let size = self.eigenvalue.norm();
        if size == 0.0 || self.eigenvalue.re == 0.0 { 0.0 } else { -self.eigenvalue.re / size }
    }

    /// Whether it grows, by more than rounding makes it.
    pub fn grows(&self) -> bool {
        self.damping_ratio() < -GROWTH
    }
}

/// Shares of the modal mass by what moves, Re(x_gᴴ (M x)_g) / xᴴ M x: their sum is one, but for [`Shares::section`], where what beams move
/// is told a second time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shares {
    /// Along the axis.
    pub axial: f64,
    /// Across, in the plane of rotation.
    pub chord: f64,
    /// Across, out of the plane of rotation.
    pub flap: f64,
    /// Across a beam that rotates about itself: a shaft.
    pub bending: f64,
    /// About the axis.
    pub torsion: f64,
    /// The hub.
    pub hub: f64,
    /// Along the first axis of space.
    pub x: f64,
    /// Along the second.
    pub y: f64,
    /// Along the third.
    pub z: f64,
    /// Rotations of bodies.
    pub rotation: f64,
    /// What the model does not distinguish.
    pub other: f64,
    /// Of beams in space, along the axes of the section: tangent, height, across. These and torsion sum to what beams move.
    pub section: [f64; 3],
}

impl Shares {
    /// Names and values.
    pub fn named(&self) -> [(&'static str, f64); 11] {
        [
            ("axial", self.axial),
            ("chord", self.chord),
            ("flap", self.flap),
            ("bending", self.bending),
            ("torsion", self.torsion),
            ("hub", self.hub),
            ("x", self.x),
            ("y", self.y),
            ("z", self.z),
            ("rotation", self.rotation),
            ("other", self.other),
        ]
    }

    /// Names and values in the axes of the section.
    pub fn in_section(&self) -> [(&'static str, f64); 3] {
        let [tangent, height, across] = self.section;
        [("tangent", tangent), ("height", height), ("across", across)]
    }

    /// Name of the largest share.
    pub fn dominant(&self) -> &'static str {
        let best = |a: (&'static str, f64), b: (&'static str, f64)| if b.1 > a.1 { b } else { a };
        self.named().into_iter().fold(("other", f64::NEG_INFINITY), best).0
    }

    /// Adds those of the parts x of a vector, each with M x, whose modal mass is `mass`.
    fn add(&mut self, system: &dyn System, state: &State, moved: &[[Vec<f64>; 2]; 2], mass: f64) {
        for [x, mx] in moved {
            system.shares(state, x, mx, &mut |direction, part| *self.of(direction) += part / mass);
        }
    }

    fn of(&mut self, direction: Direction) -> &mut f64 {
        match direction {
            Direction::Axial => &mut self.axial,
            Direction::Chord => &mut self.chord,
            Direction::Flap => &mut self.flap,
            Direction::Bending => &mut self.bending,
            Direction::Torsion => &mut self.torsion,
            Direction::Hub => &mut self.hub,
            Direction::X => &mut self.x,
            Direction::Y => &mut self.y,
            Direction::Z => &mut self.z,
            Direction::Rotation => &mut self.rotation,
            Direction::Other => &mut self.other,
            Direction::Section(axis) => &mut self.section[axis.min(2)],
        }
    }
}

/// How the stations move in a mode: the largest displacement is 1 m, or the largest rotation 1 rad where torsion has the largest share.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shape {
    /// Of each station: displacements along the axes of the equilibrium's section \[m\] (tangent, then the two others), and the
    /// rotation about the tangent \[rad\].
    pub movement: Vec<[Complex64; 4]>,
}

/// Modes of a state.
#[derive(Clone, Debug, PartialEq)]
pub struct Modes {
    /// The modes that vibrate, that grow, and that are without stiffness, ascending in |λ|.
    pub modes: Vec<Mode>,
    /// Overdamped motions, real λ < 0, with |λ| up to that of the last mode: as many as modes were asked for at most.
    pub overdamped: Vec<Mode>,
    /// What the matrices are.
    pub kind: Kind,
    /// Number of modes up to the last one as the inertia of K − ω² M + iω C counts them, where it can be
    /// counted: equal to the number of modes, or one was missed.
    pub counted: Option<usize>,
    /// Number of solutions with the factored matrix that it took: their cost is linear in the unknowns.
    pub solutions: usize,
}

/// Why there are no modes.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoModes {
    /// The eigenproblem was not solved.
    #[error("the eigenproblem was not solved: {0}")]
    Eigen(#[from] EigenError),
    /// A pair is not what it should be.
    #[error(
        "mode {number} at {frequency:.6} rad/s has a residual of {residual:.1e}, more than {allowed:.0e}: the matrices are too ill-conditioned; ask for \
         fewer modes than {number}, or coarsen the basis"
    )]
    Inaccurate {
        /// Number of the mode, from 1.
        number: usize,
        /// Its frequency [rad/s].
        frequency: f64,
        /// Its residual.
        residual: f64,
        /// The largest that is accepted.
        allowed: f64,
    },
    /// Rounding of the stiffness decides a frequency.
    #[error("mode {number} at {frequency:.3e} rad/s may be off by {:.0} % by rounding of the stiffness", 100.0 * rounding)]
    Rounded {
        /// Number of the mode, from 1.
        number: usize,
        /// Its frequency [rad/s].
        frequency: f64,
        /// Bound of its relative error.
        rounding: f64,
    },
    /// A beam is too slender for its stiffness.
    #[error("{slender} ({source})")]
    Slender {
        /// The beam.
        slender: Slender,
        /// What was not found.
        source: Box<NoModes>,
    },
    /// The count of frequencies found more.
    #[error(
        "{counted} modes lie below {frequency:.6} rad/s, but {found} were found; ask for a few more modes"
    )]
    Missed {
        /// Number by the inertia.
        counted: usize,
        /// Number found.
        found: usize,
        /// Bound of frequency [rad/s].
        frequency: f64,
    },
}

/// The `count` modes of smallest |λ| of `system` about `state`, or all that it has, with their shapes at `stations` \[m\]. Motions that
/// decay without vibrating are not counted among them.
///
/// The state is taken for an equilibrium as it stands: bring it there by
/// [`equilibrium`](super::equilibrium::equilibrium) or [`rotate`](super::rotation::rotate). With the hub
/// [held](crate::system::Steady::hold) the modes are those of a beam on a hub that keeps its motion; a hub that is free has
/// the rigid motion as a mode of frequency zero.
///
/// # Errors
/// [`NoModes`]; a mode whose residual is large, or a mode that was missed, is an error and no result.
pub fn modes(
    system: &mut dyn System,
    state: &State,
    count: usize,
    stations: &[f64],
) -> Result<Modes, NoModes> {
    let (all, multipliers) = matrices(system, state);
    modes_near(system, state, (&all, multipliers), count, stations, &[])
}

/// As [`modes`], with the [matrices] of the state, from approximate eigenvalues and vectors.
pub(super) fn modes_near(
    system: &mut dyn System,
    state: &State,
    matrices: (&[Matrix; 3], usize),
    count: usize,
    stations: &[f64],
    near: &[(Complex64, &[Complex64])],
) -> Result<Modes, NoModes> {
    find(system, state, matrices, count, stations, near).map_err(|source| match system.slender() {
        Some(slender) => NoModes::Slender { slender, source: Box::new(source) },
        None => source,
    })
}

fn find(
    system: &mut dyn System,
    state: &State,
    (all, multipliers): (&[Matrix; 3], usize),
    count: usize,
    stations: &[f64],
    near: &[(Complex64, &[Complex64])],
) -> Result<Modes, NoModes> {
    let size = system.size();
    let there = freedoms(system, &all[2]);
    let count = count.min(there);
    let mut rigid = 0.0;
    let direct = Pencil::new(all.clone(), multipliers, 0.0);
    let direct = direct.map(|mut pencil| (!has_rigid_motions(&mut pencil, system, state)).then_some(pencil));
    let mut pencil = match direct {
        Ok(Some(pencil)) => pencil,
        Err(error) if !matches!(error, EigenError::Singular(_)) => return Err(error.into()),
        // Rigid motions, or a band that only the border stiffens: the lowest frequency without them sets a shift.
        unsound => {
            let held = if unsound.is_err() { held_frequency(system, state) } else { None };
            let lowest = match held {
                Some(held) => held,
                None => elastic_frequency(all, multipliers, count.min(there))?,
            };
            rigid = RIGID * lowest;
            Pencil::new(all.clone(), multipliers, BELOW * lowest)?
        }
    };
    // A rigid motion that neither moves nor stops is an eigenvalue twice: as a place and as a speed.
    let asked = if rigid > 0.0 { (count + RIGID_MOTIONS).min(there) } else { count };
    let pairs = pencil.pairs(asked, near)?;
    let (mut modes, mut overdamped) = (Vec::with_capacity(count), Vec::new());
    let mut refused =
        accept([&mut modes, &mut overdamped], pairs, count, &pencil, system, state, rigid).err();
    let first = refused.clone();
    // Q(σ)⁻¹ magnifies the rounding of far softer modes. From a shift among the others it does not.
    while let Some(NoModes::Inaccurate { frequency, .. }) = refused {
        let shift = modes.last().map_or(0.0, Mode::frequency).max(BELOW * frequency);
        if shift <= 2.0 * pencil.shift() {
            break;
        }
        let again = Pencil::new(all.clone(), multipliers, shift);
        let again = again.and_then(|mut pencil| pencil.pairs(asked, &[]).map(|pairs| (pencil, pairs)));
        let Ok((shifted, pairs)) = again else { break };
        pencil = shifted;
        let before = std::mem::take(&mut modes);
        overdamped.clear();
        refused = accept([&mut modes, &mut overdamped], pairs, count, &pencil, system, state, rigid).err();
        let is_seen = |x: &Mode| modes.iter().any(|m| (m.eigenvalue - x.eigenvalue).norm() <= AGAIN * shift);
        // A shift far above the lowest no longer sees them.
        if !before.iter().all(is_seen) {
            refused = first.clone();
            break;
        }
    }
    if let (Some(first), Some(_)) = (first, refused) {
        return Err(first);
    }
    let counted = match complete(&pencil, &modes) {
        // Vectors to begin with may have nothing of a mode that is new among the lowest.
        Err(NoModes::Missed { .. }) if !near.is_empty() => {
            return find(system, state, (all, multipliers), count, stations, &[]);
        }
        counted => counted?,
    };
    modes.iter_mut().chain(&mut overdamped).for_each(|mode| mode.vector.truncate(size.v));
    correct(system, state, &pencil, &mut modes);
    let rounded = |(_, mode): &(usize, &Mode)| mode.rounding > UNCERTAIN;
    if let Some((number, mode)) = modes.iter().enumerate().find(rounded) {
        let (frequency, rounding) = (mode.eigenvalue.norm(), mode.rounding);
        return Err(NoModes::Rounded { number: number + 1, frequency, rounding });
    }
    let scale: Vec<f64> = system.scales().to_vec();
    for mode in modes.iter_mut().chain(&mut overdamped) {
        describe(mode, system, state, &scale, stations);
    }
    Ok(Modes { modes, overdamped, kind: pencil.kind(), counted, solutions: pencil.solutions() })
}

/// Appends the first `count` modes of the pairs, up to the first whose residual is too large, and the overdamped motions among them.
fn accept(
    [modes, overdamped]: [&mut Vec<Mode>; 2],
    pairs: Vec<Pair>,
    count: usize,
    pencil: &Pencil,
    system: &mut dyn System,
    state: &State,
    rigid: f64,
) -> Result<(), NoModes> {
    let residual = if pencil.kind() == Kind::General { RESIDUAL } else { CONSERVATIVE };
    let scale: Vec<f64> = system.scales().to_vec();
    for mut pair in pairs {
        let number = modes.len() + 1;
        if number > count {
            break;
        }
        // What errors of a vector in stiff directions make is no sign of a rigid motion.
        if pair.residual > RESIDUAL && pair.value.norm() > rigid {
            pair = pencil.purified_at_its_size(pair.value, pair.vector);
        }
        let mut mode = mode(system, state, pencil, pair, &scale, rigid);
        if mode.eigenvalue == Complex64::ZERO {
            // Each comes twice, in any combination.
            let known = modes.iter().filter(|m| m.eigenvalue == Complex64::ZERO).map(|m| m.vector.as_slice());
            if let Some(vector) = beyond(std::mem::take(&mut mode.vector), known, pencil) {
                let pair = Pair { value: mode.eigenvalue, vector, residual: mode.residual };
                modes.push(self::mode(system, state, pencil, pair, &scale, rigid));
            }
            continue;
        }
        let allowed = residual.max(mode.rounding);
        if mode.eigenvalue.im == 0.0 && mode.eigenvalue.re < 0.0 {
            if overdamped.len() < count && mode.residual <= allowed {
                overdamped.push(mode);
            }
            continue;
        }
        if !(mode.residual <= allowed) {
            let Pair { vector, residual, .. } =
                pencil.purified_at_its_size(mode.eigenvalue, std::mem::take(&mut mode.vector));
            (mode.vector, mode.residual) = (vector, residual);
        }
        // Behind the vibrations of a damped system are overdamped motions, and what rounding makes of motions without mass.
        if !overdamped.is_empty() && !pencil.is_conservative() && !(mode.residual <= NOTHING) {
            continue;
        }
        // Written so that NaN is refused too.
        if !(mode.residual <= allowed) {
            let frequency = mode.eigenvalue.norm();
            return Err(NoModes::Inaccurate { number, frequency, residual: mode.residual, allowed });
        }
        modes.push(mode);
    }
    Ok(())
}

/// The number of modes, if it can be counted.
fn complete(pencil: &Pencil, modes: &[Mode]) -> Result<Option<usize>, NoModes> {
    let rigid = |m: &Mode| pencil.kind() == Kind::Symmetric && m.eigenvalue == Complex64::ZERO;
    let steady = modes.iter().all(|m: &Mode| m.eigenvalue.re == 0.0 && m.eigenvalue.im > 0.0 || rigid(m));
    let Some(last) = modes.last().filter(|m| steady && m.eigenvalue.im > 0.0) else { return Ok(None) };
    // Just below the last, so that copies of it that were not asked for do not count.
    let limit = pencil.just_below(last.eigenvalue, &last.vector);
    let found = modes.iter().filter(|m| m.frequency() < limit).count();
    match pencil.count_below(limit) {
        Some(counted) if counted != found => Err(NoModes::Missed { counted, found, frequency: limit }),
        counted => Ok(counted.map(|_| modes.len())),
    }
}

/// The frequencies of a conservative system from the strains of its modes: right to the square of the error of the vectors,
/// which the rounding of K makes.
fn correct(system: &mut dyn System, state: &State, pencil: &Pencil, modes: &mut [Mode]) {
    if pencil.kind() == Kind::General {
        return;
    }
    let vectors: Vec<Vec<f64>> = modes.iter().flat_map(|mode| parts(&mode.vector)).collect();
    let Some(forms) = system.stiffness_forms(state, &vectors) else { return };
    let (pairs, _) = forms.as_chunks::<2>();
    for (mode, [re, im]) in modes.iter_mut().zip(pairs).filter(|(m, _)| m.eigenvalue != Complex64::ZERO) {
        if let Some(eigenvalue) = pencil.rayleigh(re.value + im.value, &mode.vector) {
            mode.eigenvalue = eigenvalue;
            // The modal mass is 1.
            let rest = 0.5 * (re.rounding + im.rounding) / eigenvalue.norm_sqr();
            mode.rounding = mode.rounding * mode.rounding + rest;
        }
    }
}

/// Lowest frequency of the system with its rigid motions held.
fn held_frequency(system: &mut dyn System, state: &State) -> Option<f64> {
    system.hold(true);
    let (mut held, multipliers) = matrices(system, state);
    system.hold(false);
    held[1].clear();
    let pairs = Pencil::new(held, multipliers, 0.0).and_then(|mut pencil| pencil.pairs(1, &[]));
    pairs.ok()?.first().map(|pair| pair.value.norm())
}

/// Shares of a vector x of modal mass 1, from x and M x.
pub(super) fn shares(system: &dyn System, state: &State, x: &[Complex64], mx: &[Complex64]) -> Shares {
    let ([x, imaginary], [mx, of_imaginary]) = (parts(x), parts(mx));
    let mut shares = Shares::default();
    shares.add(system, state, &[[x, mx], [imaginary, of_imaginary]], 1.0);
    shares
}

/// A mode from its eigenpair, without its shape.
fn mode(
    system: &mut dyn System,
    state: &State,
    pencil: &Pencil,
    pair: Pair,
    scale: &[f64],
    rigid: f64,
) -> Mode {
    let Pair { value: mut eigenvalue, mut vector, residual } = pair;
    let n = vector.len();
    let soft = eigenvalue.norm() < rigid || rigid > 0.0 && pencil.rounding(eigenvalue, &vector) > UNCERTAIN;
    if soft && is_without_form(system, state, pencil, &vector, rigid) {
        eigenvalue = Complex64::ZERO;
    }
    // Phase by the largest entry, size by the modal mass.
    let size = |i: usize| vector[i].norm() / scale[i];
    let largest =
        (0..scale.len()).fold(0, |best, i| if size(i) > size(best) * (1.0 + 1e-9) { i } else { best });
    let phase = vector.get(largest).map_or(Complex64::ONE, |x| x.conj() / x.norm());
    vector.iter_mut().for_each(|x| *x *= phase);
    let moved = parts(&vector).map(|part| {
        let mut mx = vec![0.0; n];
        pencil.mass().multiply(&part, &mut mx);
        [part, mx].map(|x| x[..scale.len()].to_vec())
    });
    let mass: f64 = moved.iter().map(|[x, mx]| dot(x, mx)).sum();
    let mut shares = Shares::default();
    if mass != 0.0 {
        let root = mass.abs().sqrt();
        vector.iter_mut().for_each(|x| *x /= root);
        shares.add(system, state, &moved, mass);
    }
    let rounding = if eigenvalue == Complex64::ZERO { 0.0 } else { pencil.rounding(eigenvalue, &vector) };
    Mode { eigenvalue, vector, residual, rounding, mesh: None, shares, shape: Shape::default(), nodes: 0 }
}

/// Gives a mode its displacements at the stations and its nodes.
pub(super) fn describe(
    mode: &mut Mode,
    system: &mut dyn System,
    state: &State,
    scale: &[f64],
    stations: &[f64],
) {
    let torsion = mode.shares.dominant() == "torsion";
    mode.shape = shape(system, state, &mode.vector, scale, stations, torsion);
    mode.nodes = nodes(&mode.shape, torsion);
}

/// Movement of the stations: central differences of the frames.
fn shape(
    system: &mut dyn System,
    state: &State,
    x: &[Complex64],
    scale: &[f64],
    stations: &[f64],
    torsion: bool,
) -> Shape {
    let count = stations.len();
    let largest = x.iter().zip(scale).map(|(x, s)| x.norm() / s).fold(0.0, f64::max);
    let mut movement = vec![[Complex64::ZERO; 4]; count];
    if largest == 0.0 || count == 0 {
        return Shape { movement };
    }
    let frames = |system: &mut dyn System, d: &[f64]| {
        let mut moved = state.clone();
        system.retract(&state.q, d, &mut moved.q);
        let mut frames = vec![Frame::default(); count];
        system.frames(system.drawn(), &moved, stations, &mut frames);
        frames
    };
    let still = frames(system, &vec![0.0; x.len()]);
    let step = 1e-5 / largest;
    for (part, unit) in [(0, Complex64::ONE), (1, Complex64::I)] {
        let d: Vec<f64> = x.iter().map(|x| step * if part == 0 { x.re } else { x.im }).collect();
        if d.iter().all(|d| *d == 0.0) {
            continue;
        }
        let ahead = frames(system, &d);
        let behind = frames(system, &d.iter().map(|d| -d).collect::<Vec<f64>>());
        for (out, ((still, ahead), behind)) in movement.iter_mut().zip(still.iter().zip(&ahead).zip(&behind))
        {
            for c in 0..3 {
                let axes = still.rotation[c];
                let moved = ahead.position[c] - behind.position[c];
                let turned: [f64; 3] = std::array::from_fn(|k| ahead.rotation[c][k] - behind.rotation[c][k]);
                (0..3).for_each(|axis| out[axis] += unit * axes[axis] * moved);
                out[3] += unit * 0.5 * (axes[2] * turned[1] - axes[1] * turned[2]);
            }
        }
    }
    let measured = if torsion { 3..4 } else { 0..3 };
    let size = movement.iter().flat_map(|u| &u[measured.clone()]).map(|u| u.norm()).fold(0.0, f64::max);
    if size > 0.0 {
        movement.iter_mut().flatten().for_each(|u| *u /= size);
    }
    Shape { movement }
}

/// Changes of sign of the largest displacement, or of the rotation, at the phase at which it is largest.
fn nodes(shape: &Shape, torsion: bool) -> usize {
    let peak = |axis: usize| {
        let sizes = shape.movement.iter().map(|u| u[axis]);
        sizes.fold(Complex64::ZERO, |best, u| if u.norm() > best.norm() { u } else { best })
    };
    let peaks = [0, 1, 2, 3].map(peak);
    let larger = |best: usize, axis: usize| if peaks[axis].norm() > peaks[best].norm() { axis } else { best };
    let axis = if torsion { 3 } else { (0..3).fold(0, larger) };
    if peaks[axis] == Complex64::ZERO {
        return 0;
    }
    let phase = peaks[axis].conj() / peaks[axis].norm();
    let values = shape.movement.iter().map(|u| (u[axis] * phase).re);
    let (mut sign, mut count) = (0.0, 0);
    for u in values.filter(|u| u.abs() > 1e-4) {
        if sign * u < 0.0 {
            count += 1;
        }
        sign = u;
    }
    count
}
