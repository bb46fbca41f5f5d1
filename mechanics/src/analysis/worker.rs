//! Modes at one speed after the other, from a system of its own.

use super::campbell::{Branch, Build, HubState, NoCampbell, Plan};
use super::follow::{Follower, Found};
use super::modes::{Mode, describe, modes};
use super::rotation::{negative_stiffness, rotate, rotate_stably};
use super::stiffness::tangent;
use crate::linalg::Matrix;
use crate::system::{Parameter, State, System, Weights};
use num_complex::Complex64;

/// Modes computed beyond those asked for, so that curves may cross the last one.
const SPARE: usize = 4;

/// Modes at one speed, with what the next one begins with.
#[derive(Clone, Debug)]
pub(super) struct Solved {
    pub speed: f64,
    /// The modes, ascending.
    pub modes: Vec<Mode>,
    /// M x of each mode.
    pub massed: Vec<Vec<Complex64>>,
    /// Of each mode, the number of the mode it was followed from; empty where all were found anew.
    origins: Vec<usize>,
    pub equilibrium: State,
}

/// A system of its own and its last equilibrium.
pub(super) struct Worker<'a> {
    system: Box<dyn System>,
    plan: &'a Plan,
    follower: Option<Follower>,
    scale: Vec<f64>,
    state: State,
    speed: f64,
}

impl<'a> Worker<'a> {
    pub(super) fn new(build: &Build<'_>, plan: &'a Plan) -> Result<Worker<'a>, NoCampbell> {
        let system = build().map_err(NoCampbell::Build)?;
        let state = system.initial();
        let scale = system.scales().to_vec();
        let follower = match plan.hub {
            HubState::Held => Follower::new(system.as_ref()),
            HubState::Free => None,
        };
        Ok(Worker { system, plan, follower, scale, state, speed: 0.0 })
    }

    pub(super) fn plan(&self) -> &'a Plan {
        self.plan
    }

    /// Begins anew from rest, whatever went before: the same speeds then give the same bytes.
    pub(super) fn rest(&mut self) {
        self.system.release();
        let _ = self.system.set(Parameter::Speed, 0.0);
        self.state = self.system.initial();
        self.speed = 0.0;
    }

    /// Begins anew from an equilibrium.
    pub(super) fn go_to(&mut self, from: &Solved) {
        self.state.copy_from(&from.equilibrium);
        self.speed = from.speed;
    }

    /// The modes at a speed, from those at up to two speeds before, the last one last.
    pub(super) fn solve(&mut self, speed: f64, before: &[Solved]) -> Result<Solved, NoCampbell> {
        let start = self.state.clone();
        let system = self.system.as_mut();
        rotate(system, &mut self.state, self.speed, speed)?;
        if let Some(follower) = &mut self.follower
            && let Some(starts) = starts(before, speed)
            && let Some(found) = follower.modes(system, &self.state, &starts, self.plan.count + 1)
        {
            self.speed = speed;
            let equilibrium = self.state.clone();
            let origins = found.iter().map(|f| f.origin).collect();
            let (modes, massed) = found.into_iter().map(|f| (f.mode, f.massed)).unzip();
            return Ok(Solved { speed, modes, massed, origins, equilibrium });
        }
        if negative_stiffness(system, &self.state) > 0 {
            self.state.copy_from(&start);
            rotate_stably(system, &mut self.state, self.speed, speed)?;
        }
        self.speed = speed;
        let mut state = self.state.clone();
        if self.plan.hub == HubState::Free {
            system.hold(false);
            state.v = system.initial().v;
        }
        let count = (self.plan.count + SPARE).min(system.size().v);
        let modes =
            modes(system, &state, count, &[]).map_err(|source| NoCampbell::Modes { speed, source })?.modes;
        let mass = tangent(system, &state, Weights::new(1.0, 0.0, 0.0));
        system.hold(true);
        let massed = modes.iter().map(|m| times(&mass, &m.vector)).collect();
        Ok(Solved { speed, modes, massed, origins: Vec::new(), equilibrium: self.state.clone() })
    }

    /// The one mode near a vector, at a speed next to a solved one.
    pub(super) fn mode_near(&mut self, speed: f64, from: &Solved, near: &[Complex64]) -> Option<Found> {
        self.go_to(from);
        let system = self.system.as_mut();
        rotate(system, &mut self.state, self.speed, speed).ok()?;
        self.speed = speed;
        let follower = self.follower.as_mut()?;
        follower.one(system, &self.state, near)
    }

    /// Gives the modes at both ends of each branch their shapes.
    pub(super) fn describe_ends(&mut self, solved: &[Solved], branches: &mut [Branch]) {
        for at in solved {
            let ends = branches.iter_mut().flat_map(|b| {
                let last = b.points.len().saturating_sub(1);
                b.points.iter_mut().enumerate().filter(move |(k, _)| *k == 0 || *k == last)
            });
            let mut here = ends.filter(|(_, p)| p.speed == at.speed).map(|(_, p)| p).peekable();
            if here.peek().is_some() {
                self.system.hold(true);
                let _ = self.system.set(Parameter::Speed, at.speed);
                for point in here {
                    let system = self.system.as_mut();
                    describe(&mut point.mode, system, &at.equilibrium, &self.scale, &self.plan.stations);
                }
            }
        }
    }
}

/// Vectors near those of the modes at a speed, extrapolated from one or two speeds before.
fn starts(before: &[Solved], speed: f64) -> Option<Vec<Vec<Complex64>>> {
    let last = before.last()?;
    let further = before.len().checked_sub(2).and_then(|k| before.get(k));
    let start = |i: usize| {
        let x = &last.modes[i].vector;
        let from = further.zip(last.origins.get(i)).and_then(|(s, &k)| Some((s.speed, s.modes.get(k)?)));
        match from {
            Some((earlier, mode)) => {
                let part = (speed - last.speed) / (last.speed - earlier);
                blend(x, &last.massed[i], &mode.vector, -part).unwrap_or_else(|| x.clone())
            }
            None => x.clone(),
        }
    };
    Some((0..last.modes.len()).map(start).collect())
}

/// x + part (y − x), y turned to the phase of x; `None` if they are not much alike.
pub(super) fn blend(x: &[Complex64], mx: &[Complex64], y: &[Complex64], part: f64) -> Option<Vec<Complex64>> {
    let alike: Complex64 = mx.iter().zip(y).map(|(mx, y)| mx.conj() * y).sum();
    let size = alike.norm();
    if !(size > 0.8) {
        return None;
    }
    let turn = alike.conj() / size * part;
    Some(x.iter().zip(y).map(|(x, y)| x * (1.0 - part) + turn * y).collect())
}

/// A z
fn times(a: &Matrix, z: &[Complex64]) -> Vec<Complex64> {
    let mut product = vec![0.0; z.len()];
    let mut part = |of: fn(&Complex64) -> f64| {
        a.multiply(&z.iter().map(of).collect::<Vec<f64>>(), &mut product);
        product.clone()
    };
    let (re, im) = (part(|z| z.re), part(|z| z.im));
    re.into_iter().zip(im).map(|(re, im)| Complex64::new(re, im)).collect()
}
