//! The energy balance of a run: work of drives and loads, energy lost in dampers and contacts.
//!
//! ```text
//! W_d(t) = ∫ P_d dt,   W_l(t) = ∫ P_l dt,   D(t) = ∫ P_D dt,   D_c(t) = ∫ P_c dt
//! imbalance = E − E(0) − W_d − W_l + D + D_c,   E = T + U + V + C
//! ```
//!
//! Impulses add to W_d and D_c at once: a prescribed velocity that jumps, a moving obstacle, an impact.
//!
//! In each step the power is taken at one to three times, as a polynomial of time between them, and the polynomial is
//! integrated: to the end of the step, and at no further cost to every recorded time inside it. With s from 0 to 1,
//!
//! | order of the method | s | order of the integral | evaluations of the power a step |
//! |---|---|---|---|
//! | up to 2 | ½ (means of the step) | 2 | 1 |
//! | 3, 4 | 0, ½, 1 (Simpson) | 4 | 2 |
//! | 5 | 0 (of no weight at the end), (4 ∓ √6)/10, 1 (Radau) | 5 | 3 |
//!
//! Between the times the dense output is used; at (4 ∓ √6)/10 that of Radau's method is its stages. The power at the start is that at the end of the step before, or that
//! behind a jump; the end of a step takes the left limit. The balance closes to the order of the method (tested), and
//! what is left is the error of the run: its truncation, and the numerical dissipation of methods that have some.
//!
//! Methods of order up to 2 take steps in which vibrations jump or decay, and the power at the ends of these tells nothing. What the forces of a step do is their impulse
//! times its mean velocity v̄: the change of the kinetic energy. Dampers act by an impulse −hC w ([`Stepper::middle`](crate::integrator::Stepper::middle)), contacts of a nonsmooth method by that
//! which it has found. Their work follows from the power P of dampers, a quadratic form,
//!
//! ```text
//! h v̄ᵀC w = h (P(v̄) + ½ P(v̄ + ½δ) − ½ P(v̄ − ½δ)),   δ = w − v̄
//! ```
//!
//! In [bursts](super::transient) the steps of a nonsmooth method follow contacts that chatter, and do not resolve the vibrations that impacts excite and dampers take
//! within a step: the mean velocity does not have them, and the power at both ends of the step is too large. It is taken by the trapezium rule, and where the balance would
//! leave more energy than there is, dampers have taken that much less.
//!
//! A nonsmooth method knows no time of an impact within its step. It counts at the end of the step, and so does what the step does and loses:
//! states recorded inside the step are those before the impact, to which the power of the step before belongs.

use super::stiffness;
use crate::integrator::{Checkpoint, Integration, NotResumed};
use crate::system::{Energy, Power, RowWeights, Set, State, System};

/// What has been done to a system and lost by it since the start, in joules.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnergyBalance {
    /// Total energy at the start.
    pub initial: f64,
    /// Work of what moves the system.
    pub drive: f64,
    /// Work of the loads, gravity aside.
    pub loads: f64,
    /// Energy lost in dampers.
    pub dissipated: f64,
    /// Energy lost in contacts.
    pub contact: f64,
}

impl EnergyBalance {
    /// What a total energy `total` has more than it should: 0 for an exact solution.
    pub fn imbalance(&self, total: f64) -> f64 {
        total - self.initial - self.drive - self.loads + self.dissipated + self.contact
    }

    fn add(&mut self, weight: f64, power: &Power) {
        self.drive += weight * power.drive;
        self.loads += weight * power.loads;
        self.dissipated += weight * power.dissipated;
        self.contact += weight * power.contact;
    }
}

/// Most times in a step at which the power is taken.
const MOST: usize = 4;
const MIDDLE: &[f64] = &[0.5];
const SIMPSON: &[f64] = &[0.0, 0.5, 1.0];
/// 0, (4 − √6)/10, (4 + √6)/10, 1
const RADAU: &[f64; MOST] = &[0.0, 0.155_051_025_721_682_2, 0.644_948_974_278_317_8, 1.0];

/// ∫₀ˢ of the polynomials that are 1 at one of the `nodes` and 0 at the others.
fn weights(nodes: &[f64], s: f64) -> [f64; MOST] {
    let mut weights = [0.0; MOST];
    for (i, (weight, own)) in weights.iter_mut().zip(nodes).enumerate() {
        // Coefficients from the constant on.
        let mut polynomial = [1.0, 0.0, 0.0, 0.0];
        for (_, other) in nodes.iter().enumerate().filter(|(j, _)| *j != i) {
            let scale = 1.0 / (own - other);
            for k in (0..MOST).rev() {
                let below = if k > 0 { polynomial[k - 1] } else { 0.0 };
                polynomial[k] = scale * (below - other * polynomial[k]);
            }
        }
        let [c0, c1, c2, c3] = polynomial;
        *weight = s * (c0 + s * (c1 / 2.0 + s * (c2 / 3.0 + s * c3 / 4.0)));
    }
    weights
}

/// Largest rise of the imbalance that a run may show without a warning, over the largest strain energy: it ends in
/// vibrations, which have no more energy than that.
const EXCESS: f64 = 0.2;
/// The same over the energy that gravity has exchanged: a pendulum too stiff to bend has next to no strain energy, but
/// the truncation error of its swing.
const SWING: f64 = 0.05;
/// The same over the kinetic energy. A system whose strain energy is less than that moves rigidly, and its kinetic energy
/// counts as that of a swing.
const RIGID: f64 = 1e-6;

/// The same over the potential of gravity, which rounding takes of a body that stays where it is; and displacement over its scale that
/// rounding makes.
const ROUNDING: f64 = 1e-12;

/// The same for steps that place what stands again and again.
const STANDING: f64 = 1e-10;

/// Work of the loads along the scales of the unknowns, over what of it is rounding.
const WORK: f64 = 1e-13;

/// Energy that rounding makes of a system at rest \[J\]: Σ ½ Kᵢᵢ (10⁻¹² wᵢ)² + 10⁻¹³ |fᵢ| wᵢ, with the stiffness K and the loads f at `state`, and the scales w of the
/// unknowns.
pub fn rounding_energy(system: &mut dyn System, state: &State) -> f64 {
    let stiffness = stiffness::stiffness(system, state);
    let mut free = state.clone();
    free.lambda.fill(0.0);
    free.a.fill(0.0);
    let mut forces = vec![0.0; state.v.len()];
    system.residual(&free, &mut forces);
    let scales = system.scales().iter().zip(&forces).enumerate();
    let of_unknown = |(i, (scale, force)): (usize, (&f64, &f64))| {
        0.5 * stiffness.get(i, i).abs() * (ROUNDING * scale) * (ROUNDING * scale) + WORK * force.abs() * scale
    };
    scales.map(of_unknown).sum()
}

/// Steps from one in which the energy is weighed to the next, at most: a gain stays.
const WEIGHED: u64 = 100;

/// Integrates the energy balance along a run.
#[derive(Clone, Debug)]
pub(super) struct Integral {
    /// At the last accepted step, and the power there; of methods of order up to 2 the mean power of that step.
    balance: EnergyBalance,
    power: Power,
    /// At the end of the step that was entered; the power there.
    end: (EnergyBalance, Power),
    /// Times in the step that was entered, as fractions of it, and the power there.
    nodes: &'static [f64],
    powers: [Power; MOST],
    /// Whether velocities jump at its end.
    impact: bool,
    gain: Gain,
    /// In a burst, the imbalance at the last accepted step, and what dampers have taken less than by their power \[J\].
    burst: Option<[f64; 2]>,
    /// The latter in the step that was entered.
    less: f64,
    /// Dense output, the velocities by which dampers act, and rates of rows.
    middle: State,
    damped: Vec<f64>,
    rates: Vec<f64>,
}

/// What decides whether a run has gained energy from nowhere.
#[derive(Clone, Copy, Debug, Default)]
struct Gain {
    /// Least imbalance so far, and the largest rise above the least one before it: numerical dissipation before a gain
    /// does not hide it.
    low: f64,
    rise: f64,
    strain: f64,
    gravity: [f64; 2],
    kinetic: f64,
}

impl Gain {
    fn enter(&mut self, energy: &Energy, imbalance: f64) {
        self.low = self.low.min(imbalance);
        self.rise = self.rise.max(imbalance - self.low);
        self.strain = self.strain.max(energy.strain + energy.contact);
        self.kinetic = self.kinetic.max(energy.kinetic);
        let [low, high] = self.gravity;
        self.gravity = [low.min(energy.gravity), high.max(energy.gravity)];
    }

    fn beyond_bounds(&self) -> Option<f64> {
        let Gain { strain, gravity, kinetic, .. } = self;
        let moving = if *strain < RIGID * kinetic { SWING } else { RIGID };
        let [low, high] = *gravity;
        let rounding = STANDING * low.abs().max(high.abs());
        let bound = EXCESS * strain + SWING * (high - low) + moving * kinetic + rounding;
        (self.rise > bound.max(f64::MIN_POSITIVE)).then_some(self.rise)
    }
}

impl Integral {
    /// Begins at the start of a run.
    pub(super) fn new(system: &mut dyn System, state: &State) -> Integral {
        let (energy, power) = system.energy_and_power(state);
        let balance = EnergyBalance { initial: energy.total(), ..EnergyBalance::default() };
        let (nodes, powers) = (MIDDLE, [power; MOST]);
        let gain = Gain { gravity: [energy.gravity; 2], ..Gain::default() };
        let end = (balance, power);
        Integral {
            balance,
            power,
            end,
            nodes,
            powers,
            impact: false,
            gain,
            burst: None,
            less: 0.0,
            middle: state.clone(),
            damped: vec![0.0; state.v.len()],
            rates: vec![0.0; state.lambda.len()],
        }
    }

    /// At the last accepted step.
    pub(super) fn balance(&self) -> EnergyBalance {
        self.balance
    }

    /// At the end of the step that was entered.
    pub(super) fn end(&self) -> EnergyBalance {
        self.end.0
    }

    /// The energy \[J\] that the run has gained beyond the work done, where it is more than its steps explain.
    pub(super) fn gain(&self, system: &mut dyn System, state: &State) -> Option<f64> {
        self.gain.beyond_bounds().filter(|gain| *gain > rounding_energy(system, state))
    }

    /// At time `t`, inside the step from `from` to `to` that was entered.
    pub(super) fn until(&self, (from, to): (&State, &State), t: f64) -> EnergyBalance {
        let (h, passed) = (to.t - from.t, t - from.t);
        let mut balance = self.balance;
        if self.impact {
            balance.add(passed, &self.power);
        } else if h > 0.0 {
            self.add_powers(&mut balance, h, passed / h);
            balance.dissipated -= self.less * passed / h;
        }
        balance
    }

    /// Adds the part `s` of the step h that was entered.
    fn add_powers(&self, balance: &mut EnergyBalance, h: f64, s: f64) {
        let weights = weights(self.nodes, s);
        for (weight, power) in weights.iter().zip(&self.powers).take(self.nodes.len()) {
            balance.add(h * weight, power);
        }
    }

    /// Enters the accepted step from `from` to `to`, in which contacts have `lost` an energy \[J\] that a nonsmooth method knows, at the end where it
    /// has an `impact`. The energy itself is weighed where a row is `recorded` in the step, and in every hundredth step.
    pub(super) fn enter(
        &mut self,
        system: &mut dyn System,
        integrator: &Integration,
        (from, to): (&State, &State),
        (lost, impact): (Option<f64>, bool),
        recorded: bool,
    ) {
        let weighed = recorded || self.burst.is_some() || integrator.counters().steps.is_multiple_of(WEIGHED);
        let order = integrator.info().order;
        self.impact = impact;
        let (energy, at_end) = if order <= 2 {
            let mean = self.mean_power(system, integrator, (from, to), lost);
            (self.nodes, self.powers[0]) = (MIDDLE, mean);
            (weighed.then(|| system.energy(to)), mean)
        } else {
            self.nodes = if order <= 4 { SIMPSON } else { RADAU };
            let (energy, at_end) = if weighed {
                let (energy, power) = system.energy_and_power(to);
                (Some(energy), power)
            } else {
                (None, system.power(to))
            };
            for (s, at) in self.nodes.iter().zip(&mut self.powers) {
                *at = if *s == 0.0 {
                    self.power
                } else if *s == 1.0 {
                    at_end
                } else {
                    integrator.interpolate(system, from, to, from.t + s * (to.t - from.t), &mut self.middle);
                    system.power(&self.middle)
                };
            }
            (energy, at_end)
        };
        self.less = 0.0;
        let mut end = self.balance;
        self.add_powers(&mut end, to.t - from.t, 1.0);
        if let (Some([before, less]), Some(energy)) = (&mut self.burst, &energy) {
            let excess = end.imbalance(energy.total()) - *before;
            self.less = excess.clamp(0.0, (end.dissipated - self.balance.dissipated).max(0.0));
            end.dissipated -= self.less;
            *less += self.less;
            *before = end.imbalance(energy.total());
        }
        self.end = (end, at_end);
        if let Some(energy) = energy {
            self.gain.enter(&energy, self.end.0.imbalance(energy.total()));
        }
    }

    /// Mean power in a step of a method of order up to 2.
    fn mean_power(
        &mut self,
        system: &mut dyn System,
        integrator: &Integration,
        (from, to): (&State, &State),
        lost: Option<f64>,
    ) -> Power {
        let Integral { middle, damped, rates, .. } = self;
        integrator.middle(system, from, to, middle, damped);
        let mut power = system.power(middle);
        if let Some(lost) = lost {
            power.contact += lost / (to.t - from.t) - rubbing(system, middle, rates);
        }
        if power.dissipated != 0.0 && self.burst.is_some() {
            power.dissipated = 0.5 * [from, to].map(|s| system.power(s).dissipated).iter().sum::<f64>();
        } else if power.dissipated != 0.0 && *damped != middle.v {
            damped.iter_mut().zip(&middle.v).for_each(|(w, v)| *w -= v);
            for (part, weight) in [(0.5, 0.5), (-1.0, -0.5)] {
                middle.v.iter_mut().zip(damped.iter()).for_each(|(v, delta)| *v += part * delta);
                power.dissipated += weight * system.power(middle).dissipated;
            }
        }
        power
    }

    /// Ends the step: the next one begins at its end.
    pub(super) fn close(&mut self) {
        (self.balance, self.power) = self.end;
    }

    /// Adds the work and the loss of an impulse.
    pub(super) fn add_impulse(&mut self, work: f64, lost: f64) {
        self.balance.drive += work;
        self.balance.contact += lost;
    }

    /// Begins a burst at a state.
    pub(super) fn begin_burst(&mut self, system: &mut dyn System, state: &State) {
        self.burst = Some([self.balance.imbalance(system.energy(state).total()), 0.0]);
    }

    /// What dampers have taken less in it than by their power \[J\].
    pub(super) fn burst_less(&self) -> f64 {
        self.burst.map_or(0.0, |[_, less]| less)
    }

    /// Ends it.
    pub(super) fn end_burst(&mut self) {
        self.burst = None;
    }

    /// Takes the power behind a jump.
    pub(super) fn restart(&mut self, system: &mut dyn System, state: &State) {
        self.power = system.power(state);
        self.end = (self.balance, self.power);
    }

    /// Adds the balance to a checkpoint.
    pub(super) fn save(&self, out: &mut Checkpoint) {
        let EnergyBalance { initial, drive, loads, dissipated, contact } = self.balance;
        out.put("energy.balance", &[initial, drive, loads, dissipated, contact]);
        let Power { drive, loads, dissipated, contact } = self.power;
        out.put("energy.power", &[drive, loads, dissipated, contact]);
        let Gain { low, rise, strain, gravity: [bottom, top], kinetic } = self.gain;
        out.put("energy.gain", &[low, rise, strain, bottom, top, kinetic]);
        if let Some([imbalance, _]) = self.burst {
            out.put("energy.burst", &[imbalance]);
        }
    }

    /// Continues the balance of an earlier run, if it kept one.
    pub(super) fn recall(&mut self, from: &Checkpoint) -> Result<(), NotResumed> {
        if from.list("energy.balance").is_err() {
            return Ok(());
        }
        let [initial, drive, loads, dissipated, contact] = from.numbers("energy.balance")?;
        self.balance = EnergyBalance { initial, drive, loads, dissipated, contact };
        let [drive, loads, dissipated, contact] = from.numbers("energy.power")?;
        self.power = Power { drive, loads, dissipated, contact };
        let [low, rise, strain, bottom, top, kinetic] = from.numbers("energy.gain")?;
        self.gain = Gain { low, rise, strain, gravity: [bottom, top], kinetic };
        self.end = (self.balance, self.power);
        if from.list("energy.burst").is_ok() {
            let [imbalance] = from.numbers("energy.burst")?;
            self.burst = Some([imbalance, 0.0]);
        }
        Ok(())
    }
}

/// Power that rows of friction take.
fn rubbing(system: &mut dyn System, s: &State, rates: &mut [f64]) -> f64 {
    let rubs = |(set, force): (&Set, &f64)| matches!(set, Set::Friction { .. }) && *force != 0.0;
    if !system.rows().iter().zip(&s.lambda).any(rubs) {
        return 0.0;
    }
    system.constraint(s, RowWeights::VELOCITY, rates);
    let rows = system.rows().iter().zip(&s.lambda).zip(rates);
    rows.filter(|(row, _)| rubs(*row)).map(|((_, force), rate)| -force * *rate).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Monomials up to one degree below the order, to the end of the step; and up to the number of nodes inside it.
    #[test]
    fn the_rules_have_their_orders() {
        for (nodes, order) in [(MIDDLE, 2), (SIMPSON, 4), (RADAU, 5), (&RADAU[1..], 5)] {
            for (s, exact) in [(1.0, order), (0.3, nodes.len())] {
                for k in 0..exact {
                    let weights = weights(nodes, s);
                    let sum: f64 = nodes.iter().zip(weights).map(|(x, w)| w * x.powi(k as i32)).sum();
                    let integral = f64::powi(s, k as i32 + 1) / (k as f64 + 1.0);
                    assert!((sum - integral).abs() < 1e-15, "{nodes:?} {s} {k}: {sum} {integral}");
                }
            }
        }
        assert!(weights(RADAU, 1.0)[0].abs() < 1e-15);
    }

    fn gain(samples: &[(f64, f64, f64)]) -> Option<f64> {
        let mut gain = Gain::default();
        for (kinetic, strain, imbalance) in samples {
            gain.enter(&Energy { kinetic: *kinetic, strain: *strain, ..Energy::default() }, *imbalance);
        }
        gain.beyond_bounds()
    }

    /// The energy that is gained is strain energy too, and may follow a loss: a pendulum of 3.01 J that has lost 0.15 J
    /// between two bursts of impacts and gains 1.71 J in the second one. That a rigid body's motion misses a thousandth of
    /// its energy is an error and no gain.
    #[test]
    fn a_gain_is_found_behind_a_loss_and_beside_the_strain_it_makes() {
        let impacts = [(2.1, 0.0, 0.0), (0.3, 2.25, -0.05), (1.2, 1.0, -0.15), (1.5, 3.2, 1.556)];
        assert!(gain(&impacts).is_some_and(|gain| (gain - 1.706).abs() < 1e-12));
        assert_eq!(gain(&impacts[..3]), None);
        assert_eq!(gain(&[(20.0, 0.0, -1e-4), (48.0, 0.0, 0.044)]), None);
        assert_eq!(gain(&[(48.0, 0.0, 5.0)]), Some(5.0));
        let mut still = Gain::default();
        still.enter(&Energy { gravity: -4.0, ..Energy::default() }, 4.4e-16);
        assert_eq!(still.beyond_bounds(), None);
        // A spin-up: 1000 times the strain energy is kinetic.
        assert_eq!(gain(&[(3.2e3, 3.5, 1.0)]), Some(1.0));
        assert_eq!(gain(&[(3.2e3, 3.5, 0.5)]), None);
    }
}
