//! Modes at one speed after the other.

use super::diagram::{Branch, HubState, NoCampbell, Plan};
use super::mac::{assurance, gyroscopic};
use super::modes::{Mode, NoModes, describe, modes_near, shares};
use super::rotation::{NoRotation, rotate};
use super::solved::Solved;
use super::stability::{Stability, judge, judge_by};
use super::stiffness::matrices;
use crate::linalg::Matrix;
use crate::linalg::eigen::{EigenError, Sparse};
use crate::system::{Parameter, State, System};
use num_complex::Complex64;

/// Modes computed beyond those asked for, so that curves may cross the last one.
const SPARE: usize = 4;
/// Difference of two assurances that does not tell which of two modes it is.
const AMBIGUOUS: f64 = 0.1;
/// Relative accuracy of a speed at which stability or the sign of the stiffness changes.
const ACCURACY: f64 = 1e-7;
/// Speeds in a block.
const BLOCK: usize = 25;

/// The modes at the speeds of a block, up to the first failure.
#[derive(Debug)]
pub struct Block {
    pub(super) solved: Vec<Solved>,
    pub(super) failure: Option<NoCampbell>,
}

impl Block {
    /// Whether it ends before its last speed: what lies beyond is not in the diagram.
    pub fn ends(&self) -> bool {
        self.failure.is_some()
    }

    /// The modes at its speeds, up to the first failure.
    pub fn modes(&self) -> impl Iterator<Item = &[Mode]> {
        self.solved.iter().map(|solved| solved.modes.as_slice())
    }

    /// Why it ends before its last speed.
    pub fn failure(&self) -> Option<&NoCampbell> {
        self.failure.as_ref()
    }
}

/// A system that rotates at the speeds of a [`Plan`], and its last equilibrium.
pub struct Speeds<'a> {
    system: Box<dyn System>,
    plan: &'a Plan,
    goes_on: &'a (dyn Fn() -> bool + Sync),
    state: State,
    speed: f64,
}

impl<'a> Speeds<'a> {
    /// For the speeds of a plan. `goes_on` is asked where the equilibrium at a speed takes more than one level of the loads, and ends
    /// the search for it by `false`.
    ///
    /// # Errors
    /// [`NoCampbell::Speeds`].
    pub fn new(
        system: Box<dyn System>,
        plan: &'a Plan,
        goes_on: &'a (dyn Fn() -> bool + Sync),
    ) -> Result<Speeds<'a>, NoCampbell> {
        let speeds = &plan.speeds;
        let ascending =
            speeds.windows(2).all(|w| w[0] < w[1]) && speeds.iter().all(|s| s.is_finite() && *s >= 0.0);
        if speeds.len() < 2 || !ascending {
            return Err(NoCampbell::Speeds);
        }
        let state = system.initial();
        Ok(Speeds { system, plan, goes_on, state, speed: 0.0 })
    }

    /// Number of blocks of speeds, each of which begins at rest.
    pub fn blocks(plan: &Plan) -> usize {
        plan.speeds.len().div_ceil(BLOCK)
    }

    /// The modes at the speeds of block `number`, up to the first failure. `next` is called after each speed and stops by
    /// `false`, which counts as one. The result does not depend on what was computed before.
    pub fn block(&mut self, number: usize, mut next: impl FnMut() -> bool) -> Block {
        self.rest();
        let mut block = Block { solved: Vec::with_capacity(BLOCK), failure: None };
        for &speed in self.plan.speeds.chunks(BLOCK).nth(number).unwrap_or_default() {
            match self.solve(speed, self.plan.count + SPARE, block.solved.last()) {
                Ok(solved) => block.solved.push(solved),
                Err(failure) => block.failure = Some(failure),
            }
            if !next() {
                block.failure.get_or_insert(NoCampbell::Stopped);
            }
            if block.ends() {
                break;
            }
        }
        block
    }

    pub(super) fn plan(&self) -> &'a Plan {
        self.plan
    }

    /// Returns to the undeformed system at rest.
    pub(super) fn rest(&mut self) {
        self.system.release();
        let _ = self.system.set(Parameter::Speed, 0.0);
        self.state = self.system.initial();
        self.speed = 0.0;
    }

    /// The modes at a speed between those computed, from the ones at a lower speed.
    pub(super) fn between(&mut self, speed: f64, from: &Solved) -> Result<Solved, NoCampbell> {
        self.state.copy_from(&from.equilibrium);
        self.speed = from.speed;
        self.solve(speed, self.plan.count + SPARE, Some(from))
    }

    /// The mode at a speed, among those up to `number`, that is like the vector `near`, and its assurance; of several, that
    /// with a frequency next to `frequency` [rad/s].
    pub(super) fn mode_like(
        &mut self,
        speed: f64,
        from: &Solved,
        number: usize,
        (near, frequency): (&[Complex64], f64),
    ) -> Option<(Mode, f64)> {
        self.state.copy_from(&from.equilibrium);
        self.speed = from.speed;
        let held = self.turn(speed).ok()?;
        let (modes, mass, _) = self.vibrate(speed, held, number + 1, Some(from)).ok()?;
        let mac: Vec<f64> = modes.iter().map(|m| assurance(near, &mass.times(&m.vector))).collect();
        let most = mac.iter().fold(0.0_f64, |most, x| most.max(*x));
        let alike = modes.into_iter().zip(mac).filter(|(_, x)| *x > most - AMBIGUOUS);
        let off = |mode: &Mode| (mode.frequency() - frequency).abs();
        alike.min_by(|a, b| off(&a.0).total_cmp(&off(&b.0)))
    }

    /// The lowest modes at a speed, from those at another.
    fn solve(&mut self, speed: f64, count: usize, from: Option<&Solved>) -> Result<Solved, NoCampbell> {
        let held = self.turn(speed)?;
        let judged = judge_by(self.system.as_ref(), &held.0, held.1);
        let (stability, negative) =
            judged.map_err(|source| NoRotation::Undecided { asked: speed, source })?;
        let (modes, mass, damping) = self.vibrate(speed, held, count, from)?;
        let massed = modes.iter().map(|m| mass.times(&m.vector)).collect();
        let gyroscopic = gyroscopic(&damping, modes.iter().map(|m| m.vector.as_slice()));
        Ok(Solved { speed, modes, massed, gyroscopic, equilibrium: self.state.clone(), stability, negative })
    }

    /// Brings the system to a speed, with its hub held: its [matrices].
    fn turn(&mut self, speed: f64) -> Result<([Matrix; 3], usize), NoCampbell> {
        let turned =
            rotate(self.system.as_mut(), &mut self.state, self.speed, speed, &mut watch(self.goes_on));
        turned.map_err(|error| match error {
            NoRotation::Stopped { .. } => NoCampbell::Stopped,
            error => error.into(),
        })?;
        self.speed = speed;
        Ok(matrices(self.system.as_mut(), &self.state))
    }

    /// The lowest modes about the state, with M and C, from the [matrices] of the system with its hub held.
    fn vibrate(
        &mut self,
        speed: f64,
        held: ([Matrix; 3], usize),
        count: usize,
        from: Option<&Solved>,
    ) -> Result<(Vec<Mode>, Sparse, Matrix), NoCampbell> {
        let system = self.system.as_mut();
        let (mut state, (mut all, mut multipliers)) = (self.state.clone(), held);
        if self.plan.hub == HubState::Free {
            system.hold(false);
            state.v = system.initial().v;
            (all, multipliers) = matrices(system, &state);
        }
        let near: Vec<_> = from.map_or(&[][..], |s| &s.modes).iter().take(count).collect();
        let near: Vec<_> = near.iter().map(|m| (m.eigenvalue, m.vector.as_slice())).collect();
        let mut modes = modes_near(system, &state, (&all, multipliers), count, &[], &near);
        let good = match modes {
            Err(NoModes::Inaccurate { number, .. }) => number - 1,
            Err(NoModes::Eigen(EigenError::NotConverged { converged, .. })) => converged,
            _ => 0,
        };
        if good >= self.plan.count {
            // One that is not was not asked for.
            let near = &near[..near.len().min(good)];
            modes = modes_near(system, &state, (&all, multipliers), good, &[], near);
        }
        system.hold(true);
        let modes = modes.map_err(|source| NoCampbell::Modes { speed, source })?.modes;
        let [mass, damping, _] = all;
        Ok((modes, Sparse::of(&mass), damping))
    }

    /// The speeds between those of two solutions at which a number that depends on the equilibrium changes, each with the numbers below
    /// and above it: by bisection. About a critical speed of a shaft that lies a little beside its axis the equilibria that are followed from
    /// below and from above are two: from there on the number is that of their mean. Ends early where there is no equilibrium in between.
    pub(super) fn changes(
        &mut self,
        [from, to]: [&Solved; 2],
        number: impl Fn(Stability, usize) -> usize,
    ) -> Vec<(f64, [usize; 2])> {
        let of = |solved: &Solved| number(solved.stability, solved.negative);
        let (mut low, mut at, last) = ((from.speed, of(from)), from.equilibrium.clone(), of(to));
        let mut found = Vec::new();
        while low.1 != last {
            let mut high = (to.speed, last);
            let mut beyond = to.equilibrium.clone();
            let mut apart = false;
            while high.0 - low.0 > ACCURACY * high.0 {
                let middle = 0.5 * (low.0 + high.0);
                let next =
                    if apart { Some(self.mean(&at, &beyond)) } else { self.followed(&at, low.0, middle) };
                let Some((next, n)) = next.and_then(|next| self.counted(next, middle, &number)) else {
                    return found;
                };
                if n != low.1 {
                    (high, beyond) = ((middle, n), next);
                    continue;
                }
                if !apart {
                    let down = self.followed(&beyond, high.0, middle);
                    let down = down.and_then(|down| self.counted(down, middle, &number));
                    if down.is_some_and(|(_, m)| m != n) {
                        apart = true;
                        continue;
                    }
                }
                (low.0, at) = (middle, next);
            }
            found.push((0.5 * (low.0 + high.0), [low.1, high.1]));
            (low, at) = (high, beyond);
        }
        found
    }

    /// The equilibrium at a speed that is followed from that at another.
    fn followed(&mut self, at: &State, from: f64, to: f64) -> Option<State> {
        let mut next = at.clone();
        rotate(self.system.as_mut(), &mut next, from, to, &mut watch(self.goes_on)).ok()?;
        Some(next)
    }

    /// The configuration in the middle of two.
    fn mean(&self, a: &State, b: &State) -> State {
        let mut out = a.clone();
        let mut d = vec![0.0; a.v.len()];
        self.system.difference(&a.q, &b.q, &mut d);
        d.iter_mut().for_each(|d| *d *= 0.5);
        self.system.retract(&a.q, &d, &mut out.q);
        out.lambda.iter_mut().zip(&b.lambda).for_each(|(a, b)| *a = 0.5 * (*a + b));
        out
    }

    /// A state, and the number that depends on it.
    fn counted(
        &mut self,
        state: State,
        speed: f64,
        number: &impl Fn(Stability, usize) -> usize,
    ) -> Option<(State, usize)> {
        self.system.set(Parameter::Speed, speed).ok()?;
        let (stability, negative) = judge(self.system.as_mut(), &state).ok()?;
        Some((state, number(stability, negative)))
    }

    /// Gives the modes of all branches their shapes.
    pub(super) fn describe(&mut self, solved: &[Solved], branches: &mut [Branch]) {
        let scale: Vec<f64> = self.system.scales().to_vec();
        for (number, at) in solved.iter().enumerate() {
            self.system.hold(true);
            let _ = self.system.set(Parameter::Speed, at.speed);
            for point in branches.iter_mut().filter_map(|branch| branch.points.get_mut(number)) {
                let system = self.system.as_mut();
                // Degenerate modes have been chosen since.
                system.hold(self.plan.hub == HubState::Held);
                point.mode.shares =
                    shares(system, &at.equilibrium, &point.mode.vector, &at.massed[point.number]);
                system.hold(true);
                describe(&mut point.mode, system, &at.equilibrium, &scale, &self.plan.stations);
            }
        }
    }
}

/// Asks from the second level of the loads on.
fn watch(goes_on: &dyn Fn() -> bool) -> impl FnMut() -> bool {
    let mut first = true;
    move || std::mem::take(&mut first) || goes_on()
}
