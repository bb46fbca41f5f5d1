//! Impacts: the velocities after an impulse, and whether contacts then are open, closed, stick or slip.
//!
//! All rows that are at g = 0 take part at once. With u = ġ, W = G M⁻¹ Gᵀ on the motions that joints allow, and p the
//! impulse of a prescribed velocity that jumps,
//!
//! ```text
//! M (v⁺ − v⁻) = p + Gᵀ Λ,     u⁺ = u⁻ + G (v⁺ − v⁻),     u⁺ + e u⁻ ⟂ Λ in the set of each row (Newton)
//! ```
//!
//! A joint whose prescribed speed ω jumps, or is held in an impact, gives the impulse Λ of its row, with G v⁺ = ω⁺, and does the work
//! ½ (ω⁺ + ω⁻) Λ.
//!
//! The contacts give the energy ½ Λᵀ(Gv⁺ + Gv⁻) to the system: −½ Λᵀ(u⁺ + u⁻) is lost, and what moving obstacles give is
//! −Λᵀ ∂g/∂t. Behind the impact the same problem for accelerations, g̈ ⟂ λ, says which contacts stay closed.
//!
//! A node without mass is given its part of ε K, ε → 0. While no force holds it, its velocity is that of equilibrium,
//! (M + εK) v = M v⁻, and it is stopped without an impulse.

use super::augmented::Augmented;
use super::cone::{Driven, FEW, RowLaw, Unresolved};
use super::few::Few;
use crate::linalg::{Matrix, Singular};
use crate::system::{Dynamics, Mode, RowWeights, Set, State, Weights};

/// Part of a closing speed that no impulse takes, from which on what closes is driven.
const DRIVEN: f64 = 0.1;
/// Speed over the largest of an impact, to which the problem of many contacts is solved.
const UNKNOWN: f64 = 1e-6;
/// Velocity after an impact, over the largest before it, below which a contact counts as closed.
const RESTING: f64 = 1e-12;
/// Part of the limit of friction by which a contact that sticks must stay below it.
const STICKING: f64 = 1e-9;
/// W over the inverse of the largest mass above which a point has no mass of its own.
const MASSLESS: f64 = 1e6;
/// Part of its W by which a row that is held must differ from what follows from the others.
const DEPENDENT: f64 = 1e-10;
/// Weight of K beside a singular M, in units of the ratio of their largest entries.
const REGULARIZATION: f64 = 1e-12;

/// What an impact did.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Impact {
    /// Impulse of every row [N·s, N·m·s].
    pub impulses: Vec<f64>,
    /// ġ of every row before the impact [m/s].
    pub rates: Vec<f64>,
    /// Effective mass 1/Wᵢᵢ \[kg\] of every row that takes part, with W = G M⁻¹ Gᵀ; 0 for the others.
    pub masses: Vec<f64>,
    /// Energy lost in the contacts \[J\].
    pub lost: f64,
    /// Work of moving obstacles and of prescribed motions that are rows \[J\].
    pub work: f64,
    /// What the contacts that closed too slowly for restitution would still have done.
    pub neglected: Neglected,
}

/// When an impact counts as one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bounds {
    /// Gap \[m\] up to which a contact touches.
    pub touching: f64,
    /// Closing speed \[m/s\] up to which a contact has no restitution.
    pub resting: f64,
    /// Contact force \[N\] that counts as zero.
    pub weak: f64,
}

/// Bounds of what is lost where bounces that accumulate are not followed, each contact taken by itself: one that closes
/// with v and is pressed by g̈ = −b would rebound with ev, e²v, … until it rests,
///
/// ```text
/// Δt = 2ev/(b(1 − e)),   Δg = (ev)²/(2b),   ΔE = ½ (ev)²/W,   W = G M⁻¹ Gᵀ
/// ```
///
/// ΔE is energy that is dissipated at once and not within Δt. With e = 1 the bounces never end and Δt is infinite; a
/// contact that is not pressed has no bounces to come, and only ΔE counts, of its rebound that is lost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Neglected {
    /// Number of contacts brought to rest.
    pub count: u64,
    /// Δt \[s\], summed.
    pub time: f64,
    /// Δg \[m\], summed.
    pub gap: f64,
    /// ΔE \[J\], summed.
    pub energy: f64,
}

impl Neglected {
    /// Adds another bound.
    pub fn add(&mut self, other: Neglected) {
        self.count += other.count;
        self.time += other.time;
        self.gap += other.gap;
        self.energy += other.energy;
    }

    /// Of a contact with restitution e that closes with v, presses with b and has W.
    pub fn of(e: f64, v: f64, b: f64, w: f64) -> Neglected {
        let rebound = e * v;
        let (time, gap) = if b > 0.0 && rebound > 0.0 {
            (2.0 * rebound / (b * (1.0 - e)), rebound * rebound / (2.0 * b))
        } else {
            (0.0, 0.0)
        };
        let energy = if w > 0.0 { 0.5 * rebound * rebound / w } else { 0.0 };
        Neglected { count: 1, time, gap, energy }
    }
}

/// Why an impact has no solution.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ImpactError {
    /// The mass matrix, with the joints, is singular.
    #[error("the mass matrix is singular at the {unknown}: {cause}")]
    Singular {
        /// Name of the unknown.
        unknown: String,
        /// Where elimination broke down.
        cause: Singular,
    },
    /// Nothing stops a contact.
    #[error(transparent)]
    Driven(#[from] Driven),
    /// The contacts were not resolved.
    #[error(transparent)]
    Unresolved(#[from] Unresolved),
}

/// Solves impacts of a system.
#[derive(Debug)]
pub struct ImpactMap {
    sets: Vec<Set>,
    matrix: Matrix,
    stiffness: Matrix,
    /// Jacobian, row by row.
    jacobian: Vec<f64>,
    /// M⁻¹ Gᵀ of each row that takes part.
    images: Vec<f64>,
    rhs: Vec<f64>,
    rates: Vec<f64>,
    /// −g̈ without contact forces, as [`ImpactMap::settle`] found it.
    pressing: Vec<f64>,
    /// Multipliers of the contacts that [`ImpactMap::settle`] left closed, of all rows; the other forces, and g̈ at rest.
    forces: Vec<f64>,
    loads: Vec<f64>,
    turning: Vec<f64>,
    velocities: usize,
    /// ε, where M is singular, and the largest entry of M then.
    weight: f64,
    inertia: f64,
    /// For many rows, whose products have room in M.
    many: Option<Augmented>,
    few: Few,
    /// Whether rows that [`ImpactMap::settle`] left closed follow from others: more are held than there are motions.
    dependent: bool,
}

/// The rows that take part in a problem, with their laws.
struct Part {
    rows: Vec<usize>,
    laws: Vec<RowLaw>,
}

impl ImpactMap {
    /// For `system`.
    pub fn new(system: &dyn Dynamics) -> ImpactMap {
        let size = system.size();
        let (n, m) = (size.v, size.lambda);
        ImpactMap {
            sets: system.rows().to_vec(),
            matrix: Matrix::new(&system.structure(1)),
            stiffness: Matrix::new(&system.structure(0)),
            jacobian: vec![0.0; n * m],
            images: vec![0.0; m * (n + m)],
            rhs: vec![0.0; n + m],
            rates: vec![0.0; m],
            pressing: vec![0.0; m],
            forces: vec![0.0; m],
            loads: vec![0.0; n],
            turning: vec![0.0; m],
            velocities: n,
            weight: 0.0,
            inertia: 0.0,
            many: (m > FEW && system.contacts_are_local()).then(Augmented::default),
            few: Few::new(0),
            dependent: false,
        }
    }

    /// Changes the velocities of `state` by the impulse and the jumps of rows in `p`, as [`Events::impulse`](crate::system::Events::impulse)
    /// writes them, and by the impulses of all rows that are closed or touch, and [sets the modes](ImpactMap::settle) of the rows.
    ///
    /// # Errors
    /// [`ImpactError`].
    pub fn strike(
        &mut self,
        system: &mut dyn Dynamics,
        state: &mut State,
        p: &[f64],
        Bounds { touching, resting, weak }: Bounds,
    ) -> Result<Impact, ImpactError> {
        self.factor(system, state)?;
        let n = self.velocities;
        if self.weight > 0.0
            && state.lambda.iter().zip(&self.sets).all(|(x, set)| *set == Set::Free || *x <= weak)
        {
            let (mut force, mut change) = (vec![0.0; n], vec![0.0; n]);
            self.stiffness.multiply(&state.v, &mut force);
            force.iter_mut().for_each(|f| *f *= -self.weight);
            self.respond(&force, |_| 0.0, &mut change);
            state.v.iter_mut().zip(&change).for_each(|(v, x)| *v += x);
        }
        let mut gaps = vec![0.0; self.sets.len()];
        system.constraint(state, RowWeights::POSITION, &mut gaps);
        let closed: Vec<bool> = state.mode.iter().map(|mode| *mode != Mode::Open).collect();
        let part = self.part(|i| gaps[i] <= touching || closed[i], |_| None);
        system.constraint(state, RowWeights::VELOCITY, &mut self.rates);
        let largest = self.largest(&self.rates).max(system.fastest(&state.v));
        // Rounding is no impact.
        let rounded = |rate: &f64| if rate.abs() <= RESTING * largest { 0.0 } else { *rate };
        let before: Vec<f64> = self.rates.iter().map(rounded).collect();
        // The change of velocity by p, with the joints.
        let mut change = vec![0.0; n];
        let (p, jumps) = p.split_at(n);
        self.respond(p, |i| jumps[i], &mut change);
        let w = self.delassus(&part);
        // u⁺ + e u⁻ = b + W Λ; e counts for contacts that close, and friction takes the sliding velocity itself.
        let target = |i: usize| match self.sets[i] {
            Set::Unilateral { restitution } if before[i] < -resting => restitution * before[i],
            _ => 0.0,
        };
        let b: Vec<f64> = part.rows.iter().map(|&i| before[i] + target(i) + self.along(i, &change)).collect();
        let mut impulses = vec![0.0; part.rows.len()];
        self.resolve(&part, &w, &b, &mut impulses)?;
        self.add_images(&part, &impulses, &mut change);
        let zeros = || vec![0.0; self.sets.len()];
        let mut impact = Impact { impulses: zeros(), masses: zeros(), ..Impact::default() };
        for (&i, x) in part.rows.iter().zip(&impulses) {
            impact.impulses[i] = *x;
            let after = before[i] + self.along(i, &change);
            let moving = before[i] - self.along(i, &state.v);
            impact.lost -= 0.5 * x * (after + before[i]);
            let closes = matches!(self.sets[i], Set::Unilateral { .. }) && before[i] < -resting;
            if closes && after < (DRIVEN * before[i]).min(-UNKNOWN * largest) {
                return Err(Driven { contact: system.unknown(n + i) }.into());
            }
            impact.work -= x * moving;
        }
        impact.work += self.work_of_joints(p, jumps, (&part, &impulses), &state.v, RESTING * largest);
        state.v.iter_mut().zip(&change).for_each(|(v, dv)| *v += dv);
        let struck: Vec<bool> = before.iter().map(|rate| *rate < -resting).collect();
        self.settle_after(system, state, touching, &struck, largest)?;
        let m = part.rows.len();
        for (k, &i) in part.rows.iter().enumerate() {
            if let Set::Unilateral { restitution } = self.sets[i]
                && restitution > 0.0
                && !closed[i]
                && before[i] < 0.0
                && before[i] >= -resting
            {
                let neglected = Neglected::of(restitution, -before[i], self.pressing[i], w[k * m + k]);
                impact.neglected.add(neglected);
            }
            impact.masses[i] = 1.0 / w[k * m + k];
        }
        impact.rates = before;
        Ok(impact)
    }

    /// Length of what the rows of friction of a contact have.
    fn along_disc(&self, normal: usize, of_row: impl Fn(usize) -> f64) -> f64 {
        let rows = (0..self.sets.len())
            .filter(|i| matches!(self.sets[*i], Set::Friction { normal: n, .. } if n == normal));
        rows.fold(0.0, |size, row| libm::hypot(size, of_row(row)))
    }

    /// The largest rate of a contact.
    fn largest(&self, rates: &[f64]) -> f64 {
        let contacts = rates.iter().zip(&self.sets).filter(|(_, set)| **set != Set::Free);
        contacts.fold(0.0_f64, |most, (rate, _)| most.max(rate.abs()))
    }

    /// Work −½ Λ (∂g/∂t⁺ + ∂g/∂t⁻) of the joints, whose ∂g/∂t jumps by `jumps`, with `v` before the impact; rates up to `least` are
    /// rounding.
    fn work_of_joints(
        &mut self,
        p: &[f64],
        jumps: &[f64],
        (part, impulses): (&Part, &[f64]),
        v: &[f64],
        least: f64,
    ) -> f64 {
        let joints = (0..self.sets.len()).filter(|i| self.sets[*i] == Set::Free);
        let moving = |i: usize| {
            let rate = 2.0 * (self.rates[i] - self.along(i, v)) - jumps[i];
            (i, if rate.abs() > least { rate } else { 0.0 })
        };
        let moving: Vec<(usize, f64)> = joints.map(moving).filter(|(_, rate)| *rate != 0.0).collect();
        if moving.is_empty() {
            return 0.0;
        }
        let n = self.velocities;
        let (mut f, mut change) = (p.to_vec(), vec![0.0; n]);
        for (&i, x) in part.rows.iter().zip(impulses) {
            f.iter_mut().zip(&self.jacobian[i * n..(i + 1) * n]).for_each(|(f, g)| *f += x * g);
        }
        self.respond(&f, |i| jumps[i], &mut change);
        moving.iter().map(|(i, rate)| -0.5 * self.rhs[n + i] * rate).sum()
    }

    /// Effective mass 1/(G M⁻¹ Gᵀ) \[kg\] of every contact at `state`, each by itself; 0 for other rows.
    ///
    /// # Errors
    /// [`ImpactError::Singular`].
    pub fn masses(&mut self, system: &mut dyn Dynamics, state: &State) -> Result<Vec<f64>, ImpactError> {
        self.factor(system, state)?;
        let part = self.part(|_| true, |_| None);
        let (w, m) = (self.delassus(&part), part.rows.len());
        let mut masses = vec![0.0; self.sets.len()];
        part.rows.iter().enumerate().for_each(|(k, &i)| masses[i] = 1.0 / w[k * m + k]);
        Ok(masses)
    }

    /// Sets the mode of every contact by the accelerations at `state`: those that touch and do not separate are closed if
    /// they carry force, and stick or slip. Those that carry none and do not separate either are closed if they were
    /// `struck`.
    ///
    /// # Errors
    /// [`ImpactError`].
    pub fn settle(
        &mut self,
        system: &mut dyn Dynamics,
        state: &mut State,
        touching: f64,
        struck: &[bool],
    ) -> Result<(), ImpactError> {
        self.settle_after(system, state, touching, struck, 0.0)
    }

    /// The same behind an impact: rounding is measured by the largest velocity before it, of which nothing may be left.
    fn settle_after(
        &mut self,
        system: &mut dyn Dynamics,
        state: &mut State,
        touching: f64,
        struck: &[bool],
        before: f64,
    ) -> Result<(), ImpactError> {
        self.factor(system, state)?;
        let n = self.velocities;
        let m = self.sets.len();
        let (mut gaps, mut rates, mut accelerations) = (vec![0.0; m], vec![0.0; m], vec![0.0; m]);
        system.constraint(state, RowWeights::POSITION, &mut gaps);
        system.constraint(state, RowWeights::VELOCITY, &mut rates);
        let largest = before.max(self.largest(&rates)).max(system.fastest(&state.v));
        let resting = RESTING * largest;
        let slip = |i: usize| match self.sets[i] {
            Set::Friction { coefficient, normal } => {
                let speed = self.along_disc(normal, |row| rates[row]);
                (speed > resting).then(|| coefficient * (rates[i] / speed))
            }
            _ => None,
        };
        let slips: Vec<Option<f64>> = (0..m).map(slip).collect();
        let closed: Vec<bool> = state.mode.iter().map(|mode| *mode != Mode::Open).collect();
        let part = self.part(|i| (gaps[i] <= touching || closed[i]) && rates[i] <= resting, |i| slips[i]);
        // Accelerations without contact forces.
        state.a.fill(0.0);
        for (lambda, set) in state.lambda.iter_mut().zip(&self.sets) {
            if *set != Set::Free {
                *lambda = 0.0;
            }
        }
        let mut force = vec![0.0; n];
        system.residual(state, &mut force);
        force.iter_mut().for_each(|r| *r = -*r);
        system.constraint(state, RowWeights::ACCELERATION, &mut accelerations);
        let free = accelerations.clone();
        let mut a = vec![0.0; n];
        self.respond(&force, |i| free[i], &mut a);
        let w = self.delassus(&part);
        let b: Vec<f64> = part.rows.iter().map(|&i| accelerations[i] + self.along(i, &a)).collect();
        self.pressing.fill(0.0);
        part.rows.iter().zip(&b).for_each(|(&i, b)| self.pressing[i] = -b);
        let (weight, inertia) = (self.weight, self.inertia);
        let massless = |k: usize| weight > 0.0 && w[k * part.rows.len() + k] * inertia > MASSLESS;
        let largest_acceleration = self.largest(&accelerations).max(system.fastest(&a));
        let mut forces = vec![0.0; part.rows.len()];
        self.resolve(&part, &w, &b, &mut forces)?;
        for (mode, set) in state.mode.iter_mut().zip(&self.sets) {
            *mode = if *set == Set::Free { Mode::Closed } else { Mode::Open };
        }
        for (k, &i) in part.rows.iter().enumerate() {
            state.mode[i] = match part.laws[k] {
                RowLaw::Free => Mode::Closed,
                RowLaw::Unilateral if forces[k] > 0.0 => Mode::Closed,
                // The force on a point without mass grows with its path, whatever its acceleration is.
                RowLaw::Unilateral
                    if struck.get(i) == Some(&true)
                        && (massless(k) || b[k] <= RESTING * largest_acceleration) =>
                {
                    Mode::Closed
                }
                RowLaw::Unilateral => Mode::Open,
                RowLaw::Slip { slope, .. } if slope > 0.0 => Mode::SlipForward,
                RowLaw::Slip { .. } => Mode::SlipBackward,
                RowLaw::Friction { coefficient, normal } => {
                    let limit = coefficient * forces[normal];
                    let of_row =
                        |row: usize| part.rows.iter().position(|i| *i == row).map_or(0.0, |k| forces[k]);
                    let size = self.along_disc(part.rows[normal], of_row);
                    if size < limit * (1.0 - STICKING) || limit == 0.0 {
                        Mode::Closed
                    } else if forces[k] < 0.0 {
                        Mode::SlipForward
                    } else {
                        Mode::SlipBackward
                    }
                }
            };
        }
        // Friction of a contact that is open is open too.
        for (i, set) in self.sets.iter().enumerate() {
            if let Set::Friction { normal, .. } = set
                && state.mode[*normal] == Mode::Open
            {
                state.mode[i] = Mode::Open;
            }
        }
        self.forces.fill(0.0);
        let closed = part.rows.iter().zip(&forces).filter(|(i, _)| state.mode[**i] != Mode::Open);
        closed.for_each(|(i, force)| self.forces[*i] = *force);
        (self.loads, self.turning) = (force, free);
        let held: Vec<usize> =
            (0..part.rows.len()).filter(|k| state.mode[part.rows[*k]] == Mode::Closed).collect();
        let m = part.rows.len();
        let entries: Vec<f64> =
            held.iter().flat_map(|k| held.iter().map(move |l| k * m + l)).map(|at| w[at]).collect();
        self.dependent = held.len() > n || self.few.are_dependent(&entries, held.len(), DEPENDENT);
        Ok(())
    }

    /// Gives `state`, which was [settled](ImpactMap::settle) last, the multipliers and accelerations that belong to its closed contacts: of least norm where rows follow from others.
    pub(crate) fn press(&mut self, state: &mut State) {
        let n = self.velocities;
        let mut f = std::mem::take(&mut self.loads);
        for (i, force) in self.forces.iter().enumerate().filter(|(_, force)| **force != 0.0) {
            f.iter_mut().zip(&self.jacobian[i * n..(i + 1) * n]).for_each(|(f, g)| *f += force * g);
        }
        let turning = std::mem::take(&mut self.turning);
        self.respond(&f, |i| turning[i], &mut state.a);
        for (i, lambda) in state.lambda.iter_mut().enumerate() {
            *lambda = if self.sets[i] == Set::Free { *lambda + self.rhs[n + i] } else { self.forces[i] };
        }
    }

    /// Whether rows that were left closed follow from others: they have no forces of their own.
    pub(crate) fn are_dependent(&self) -> bool {
        self.dependent
    }

    /// Λ of u = b + W Λ, from zero.
    fn resolve(&mut self, part: &Part, w: &[f64], b: &[f64], lambda: &mut [f64]) -> Result<(), Unresolved> {
        let n = self.velocities;
        if part.rows.len() > FEW
            && let Some(many) = &mut self.many
        {
            many.begin(&part.laws);
            for i in &part.rows {
                many.push(self.jacobian[i * n..(i + 1) * n].iter().copied().enumerate());
            }
            self.rhs.fill(0.0);
            if many.solve(&mut self.matrix, b, lambda, &mut self.rhs).is_ok() {
                return Ok(());
            }
        }
        self.few.solve(&part.laws, w, b, lambda).map(drop)
    }

    /// The contacts that `takes_part`, with their friction; `slip` gives ±μ of friction that slips.
    fn part(&self, takes_part: impl Fn(usize) -> bool, slip: impl Fn(usize) -> Option<f64>) -> Part {
        let mut part = Part { rows: Vec::new(), laws: Vec::new() };
        for (i, set) in self.sets.iter().enumerate() {
            if matches!(set, Set::Unilateral { .. }) && takes_part(i) {
                part.rows.push(i);
                part.laws.push(RowLaw::Unilateral);
            }
        }
        for (i, set) in self.sets.iter().enumerate() {
            if let Set::Friction { coefficient, normal } = *set
                && let Some(normal) = part.rows.iter().position(|&row| row == normal)
            {
                part.rows.push(i);
                part.laws.push(match slip(i) {
                    Some(slope) => RowLaw::Slip { slope, normal },
                    None => RowLaw::Friction { coefficient, normal },
                });
            }
        }
        part
    }

    /// Factors M with the joints, and stores the jacobian.
    fn factor(&mut self, system: &mut dyn Dynamics, state: &State) -> Result<(), ImpactError> {
        let (n, sets) = (self.velocities, &self.sets);
        self.jacobian.fill(0.0);
        let jacobian = &mut self.jacobian;
        system.jacobian(state, &mut |row, velocities, entries| {
            for (&j, &x) in velocities.iter().zip(entries) {
                jacobian[row * n + j] += x;
            }
        });
        // ε belongs to this state: a run that goes on from a checkpoint finds the same.
        self.weight = 0.0;
        loop {
            system.tangent(state, Weights::new(1.0, 0.0, self.weight), &mut self.matrix);
            for (i, set) in sets.iter().enumerate() {
                if *set == Set::Free {
                    for j in (0..n).filter(|j| self.jacobian[i * n + j] != 0.0) {
                        self.matrix.add(j, n + i, -self.jacobian[i * n + j]);
                        self.matrix.add(n + i, j, self.jacobian[i * n + j]);
                    }
                } else {
                    self.matrix.add(n + i, n + i, 1.0);
                }
            }
            if let Some(many) = &mut self.many {
                many.keep(&self.matrix, self.matrix.order());
            }
            match self.matrix.factor() {
                Ok(_) => return Ok(()),
                Err(cause) if self.weight > 0.0 || !cause.pivot.is_finite() => {
                    return Err(ImpactError::Singular { unknown: system.unknown(cause.index), cause });
                }
                Err(_) => {
                    let largest =
                        |matrix: &Matrix| (0..n).fold(0.0_f64, |x, i| x.max(matrix.get(i, i).abs()));
                    system.tangent(state, Weights::new(0.0, 0.0, 1.0), &mut self.stiffness);
                    system.tangent(state, Weights::new(1.0, 0.0, 0.0), &mut self.matrix);
                    self.inertia = largest(&self.matrix);
                    self.weight =
                        REGULARIZATION * self.inertia / largest(&self.stiffness).max(f64::MIN_POSITIVE);
                }
            }
        }
    }

    /// x of M x = f + Gᵀ λ with G x = −g of the joints.
    fn respond(&mut self, f: &[f64], g: impl Fn(usize) -> f64, x: &mut [f64]) {
        let n = self.velocities;
        self.rhs[..n].copy_from_slice(f);
        for (i, set) in self.sets.iter().enumerate() {
            self.rhs[n + i] = if *set == Set::Free { -g(i) } else { 0.0 };
        }
        self.matrix.solve(&mut self.rhs);
        x.copy_from_slice(&self.rhs[..n]);
    }

    /// W of the rows that take part, by rows; keeps M⁻¹ Gᵀ.
    fn delassus(&mut self, part: &Part) -> Vec<f64> {
        let (n, m) = (self.velocities, part.rows.len());
        let mut w = vec![0.0; m * m];
        let mut x = vec![0.0; n];
        for (k, &i) in part.rows.iter().enumerate() {
            let row = self.jacobian[i * n..(i + 1) * n].to_vec();
            self.respond(&row, |_| 0.0, &mut x);
            self.images[k * n..(k + 1) * n].copy_from_slice(&x);
            for (l, &j) in part.rows.iter().enumerate() {
                w[l * m + k] = self.along(j, &x);
            }
        }
        w
    }

    /// Row `i` of the jacobian times x.
    fn along(&self, i: usize, x: &[f64]) -> f64 {
        let n = self.velocities;
        self.jacobian[i * n..(i + 1) * n].iter().zip(x).map(|(g, x)| g * x).sum()
    }

    fn add_images(&self, part: &Part, impulses: &[f64], x: &mut [f64]) {
        let n = self.velocities;
        for k in 0..part.rows.len() {
            for (x, image) in x.iter_mut().zip(&self.images[k * n..(k + 1) * n]) {
                *x += impulses[k] * image;
            }
        }
    }
}
