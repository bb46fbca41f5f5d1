//! Elastic bars and beams that strike rigid stops: published values and closed forms.

use super::models::{Linear, steps};
use super::nonsmooth::methods;
use flexion::analysis::transient::{Ending, Event, Observer, Plan, Step, transient};
use flexion::integrator::{GeneralizedAlpha, Integrator, MoreauJean};
use flexion::system::{Dynamics, Mode, Observed, State, System};
use std::f64::consts::PI;

fn nonsmooth() -> Vec<Box<dyn Integrator>> {
    let mut all: Vec<Box<dyn Integrator>> = vec![Box::new(MoreauJean::new(0.5).unwrap())];
    all.extend(methods(0.8));
    all
}

fn moving(system: &Linear, velocity: f64) -> State {
    let mut start = system.initial();
    start.v.fill(velocity);
    start.mode.fill(Mode::Open);
    start
}

/// An elastic rod on a rigid wall: 10 × 1 × 1 in, E = 3e7 psi, ρ = 0.73e-3, gap 0.01 in, v₀ = 202.2 in/s. It touches at
/// 4.94e-5 s, leaves at 1.481e-4 s = 4.94e-5 s + 2L/c, and the force between is ρcAv₀ = 2.992e4 lb.
///
/// Source: Hughes, Taylor, Sackman, Curnier & Kanoknukulchai (1976, doi 10.1016/0045-7825(76)90018-9), and many after them.
#[test]
fn an_elastic_rod_strikes_a_wall_with_the_force_of_a_plane_wave() {
    let (n, length, [modulus, density]) = (100, 10.0, [3e7, 0.73e-3]);
    let speed = 202.2;
    let wave = f64::sqrt(modulus / density);
    for mut method in nonsmooth() {
        let mut rod = Linear::bar(n, length, [modulus, density], true).with_stop(0, -0.01, 0.0);
        let h = 0.5 * length / n as f64 / wave;
        let (mut first, mut last_time, mut sum, mut count) = (f64::NAN, 0.0, 0.0, 0);
        let start = moving(&rod, -speed);
        let energy = rod.energy(&start).total();
        let last = steps(method.as_mut(), &mut rod, start, ((2.2e-4 / h).round() * h, h), |_, _, to| {
            if to.lambda[0] > 0.0 {
                first = first.min(to.t);
                last_time = to.t;
            }
            if to.t > 6e-5 && to.t < 1.3e-4 {
                (sum, count) = (sum + to.lambda[0], count + 1);
            }
        });
        assert!((first - 4.945e-5).abs() < 2.0 * h, "{first:e}");
        assert!((last_time - 1.481e-4).abs() < 1.5e-6, "{last_time:e}");
        let force = sum / f64::from(count);
        assert!((force / 2.992e4 - 1.0).abs() < 1e-3, "{force:e}");
        let mean = (0..=n).map(|i| rod.mass[i][i] * last.v[i]).sum::<f64>() / (density * length);
        assert!((mean / speed - 1.0).abs() < 0.02, "{mean}");
        let kept = rod.energy(&last).total() / energy;
        assert!(kept > 0.985 && kept <= 1.0 + 1e-12, "{kept}");
    }
}

/// The bouncing bar: L 10, E 900, ρ 1, A 1, g 10, released at the height 5. In contact 1–5/3 s and 11/3–13/3 s: it falls,
/// is in contact for 2L/c, and flies for 2 s.
///
/// Source: Doyen, Ern & Piperno (2011, doi 10.1137/100791440).
fn bouncing(massless: bool) -> (Linear, State) {
    let mut bar = Linear::bar(100, 10.0, [900.0, 1.0], true).with_gravity(10.0);
    if massless {
        // All mass of the node in contact goes to its neighbour.
        bar.mass[1][1] += std::mem::take(&mut bar.mass[0][0]);
        bar.force[1] += std::mem::take(&mut bar.force[0]);
    }
    let bar = bar.with_stop(0, -5.0, 0.0);
    let start = moving(&bar, 0.0);
    (bar, start)
}

/// Times at which a contact has closed and opened, but for interruptions shorter than 0.1 s.
#[derive(Default)]
struct Phases(Vec<[f64; 2]>);

impl Phases {
    fn see(&mut self, t: f64, closed: bool) {
        if !closed {
            return;
        }
        match self.0.last_mut() {
            Some(last) if t - last[1] < 0.1 => last[1] = t,
            _ => self.0.push([t; 2]),
        }
    }
}

#[test]
fn a_bouncing_bar_keeps_the_published_times_over_two_bounces() {
    for mut method in nonsmooth() {
        let (mut bar, start) = bouncing(false);
        let h = 1.0 / 600.0;
        let energy = bar.energy(&start).total() + 500.0;
        let mut phases = Phases::default();
        let mut least = f64::INFINITY;
        steps(method.as_mut(), &mut bar, start, (5.0, h), |bar, _, to| {
            phases.see(to.t, to.lambda[0] > 0.0);
            let now = bar.energy(to).total() + 500.0;
            least = least.min(now / energy);
            assert!(now <= energy * (1.0 + 1e-9), "{now} {energy}");
        });
        let exact = [[1.0, 5.0 / 3.0], [11.0 / 3.0, 13.0 / 3.0]];
        assert_eq!(phases.0.len(), 2, "{:?}", phases.0);
        for (found, exact) in phases.0.iter().zip(exact) {
            let far = (found[0] - exact[0]).abs().max((found[1] - exact[1]).abs());
            assert!(far < 0.05, "{} {:?}", method.info().name, phases.0);
        }
        assert!(least > 0.97, "{} {least}", method.info().name);
    }
}

/// Watches energy and contact.
struct Watch {
    phases: Phases,
    energies: [f64; 2],
}

impl Observer for Watch {
    fn sample(&mut self, system: &mut dyn System, state: &State, _step: &Step) {
        self.phases.see(state.t, state.mode[0] == Mode::Closed);
        let energy = system.energy(state).total();
        self.energies = [self.energies[0].min(energy), self.energies[1].max(energy)];
    }
}

/// With the mass of the node in contact moved into the bar the impact needs no law: no energy is lost.
///
/// Source: Khenous, Laborde & Renard (2008, doi 10.1016/j.euromechsol.2008.01.001); Dabaghi, Petrov, Pousin & Renard,
/// arXiv 1601.00778.
#[test]
fn a_bar_whose_contact_node_has_no_mass_keeps_its_energy() {
    let (mut bar, mut state) = bouncing(true);
    let mut watch = Watch { phases: Phases::default(), energies: [f64::INFINITY, f64::NEG_INFINITY] };
    let plan = Plan::new(5.0, 1e-3).with_step(5e-4);
    let method = GeneralizedAlpha::newmark(0.25, 0.5).unwrap();
    let ending = transient(&mut bar, &method, &mut state, &plan, &mut watch);
    assert_eq!(ending, Ending::Finished);
    // E − E(0) over the energy of the fall.
    let [low, high] = watch.energies;
    assert!((high - low) / 500.0 < 1e-3, "{low} {high}");
    assert_eq!(watch.phases.0.len(), 2, "{:?}", watch.phases.0);
    for (found, exact) in watch.phases.0.iter().zip([[1.0, 5.0 / 3.0], [11.0 / 3.0, 13.0 / 3.0]]) {
        assert!(
            (found[0] - exact[0]).abs() < 0.02 && (found[1] - exact[1]).abs() < 0.03,
            "{:?}",
            watch.phases.0
        );
    }
}

/// A free beam that moves with V across its axis when its end is stopped: until waves return from the other end, the
/// impulse of the stop is J(t) = V EI^¼ (ρA)^¾ √(2t/π).
///
/// Derivation: with κ⁴ = ρA s²/EI the transform of what the stop adds is w = (V/2s²) (e^(px) + e^(p̄x)), p = κ(−1 + i)/√2,
/// for which w(0) = V/s² and w″(0) = 0; the force is EI w‴(0) = V EI^¼ (ρA)^¾ / √(2s).
#[test]
fn the_impulse_of_a_beam_on_a_stop_grows_with_the_root_of_time() {
    let (length, ei, mass, speed): (f64, f64, f64, f64) = (20.0, 3.0, 2.0, 1.5);
    for mut method in nonsmooth() {
        let mut beam = Linear::beam(100, length, [ei, mass], false).with_stop(0, 0.0, 0.0);
        let mut start = moving(&beam, 0.0);
        start.v.iter_mut().step_by(2).for_each(|v| *v = -speed);
        let (mut impulse, mut worst) = (0.0, 0.0_f64);
        steps(method.as_mut(), &mut beam, start, (2.0, 4e-3), |_, from, to| {
            impulse += to.lambda[0] * (to.t - from.t);
            let exact = speed * ei.powf(0.25) * mass.powf(0.75) * (2.0 * to.t / PI).sqrt();
            if to.t > 0.5 {
                worst = worst.max((impulse / exact - 1.0).abs());
            }
        });
        assert!(worst < 0.02, "{} {worst}", method.info().name);
    }
}

/// Deflections of the tip at each quarter of a second, and the time of the first event.
#[derive(Default)]
struct Tip {
    unknown: usize,
    deflections: Vec<f64>,
    first: Option<f64>,
}

impl Observer for Tip {
    fn sample(&mut self, _system: &mut dyn System, state: &State, _step: &Step) {
        self.deflections.push(state.q[self.unknown]);
    }
    fn event(&mut self, event: &Event) {
        self.first.get_or_insert(event.time);
    }
}

/// A cantilever under its weight, held straight and released above a stop: the nonsmooth schemes find the event-driven
/// motion until the second touch, and never penetrate, or by O(h). (What follows depends on every micro-impact.)
#[test]
fn a_cantilever_is_released_above_a_stop() {
    let (n, h) = (4, 1e-4);
    let (tip, place) = (2 * n - 2, -0.05);
    let make = || Linear::beam(n, 1.0, [1.0, 1.0], true).with_gravity_across(1.0).with_stop(tip, place, 0.0);
    let run = |method: &dyn Integrator| {
        let mut beam = make();
        let mut state = moving(&beam, 0.0);
        let mut watch = Tip { unknown: tip, ..Tip::default() };
        let plan = Plan::new(0.75, 0.25).with_step(h);
        assert_eq!(transient(&mut beam, method, &mut state, &plan, &mut watch), Ending::Finished);
        watch
    };
    let events = run(&mut GeneralizedAlpha::chung_hulbert(0.8).unwrap());
    for mut method in nonsmooth() {
        let found = run(method.as_mut());
        for k in 1..4 {
            let (x, exact) = (found.deflections[k], events.deflections[k]);
            assert!((x - exact).abs() < 5e-4, "{} {k}: {x} for {exact}", method.info().name);
        }
        let mut beam = make();
        let (mut first, mut least, start) = (f64::INFINITY, f64::INFINITY, moving(&beam, 0.0));
        steps(method.as_mut(), &mut beam, start, (0.75, h), |_, _, to| {
            least = least.min(to.q[tip] - place);
            if to.lambda[0] > 0.0 {
                first = first.min(to.t);
            }
        });
        assert!((first - events.first.unwrap()).abs() < 2.0 * h, "{first} {:?}", events.first);
        assert!(least > if method.info().order == 2 { -1e-13 } else { -h }, "{least:e}");
    }
}

/// Energy of a linear system in a step of Moreau–Jean's scheme, with u = ġ:
///
/// ```text
/// E₁ − E₀ = P (θ u₁ + (1 − θ) u₀) − (θ − ½) (Δvᵀ M Δv + Δqᵀ K Δq)
/// ```
///
/// from v_θ times the equation of the step. It cannot grow where the contact closes (u₀ ≤ 0) and ½ ≤ θ ≤ 1/(1 + e).
///
/// Source: Acary, arXiv 1410.2499.
#[test]
fn the_energy_balance_of_a_step_of_moreau_and_jean_is_exact() {
    for (restitution, theta) in [(0.0, 0.5), (0.0, 1.0), (0.5, 2.0 / 3.0), (0.5, 0.5), (1.0, 0.5)] {
        let mut bar =
            Linear::bar(20, 1.0, [1.0, 1.0], false).with_gravity(0.3).with_stop(0, -0.01, restitution);
        let start = moving(&bar, -1.0);
        let method = MoreauJean::new(theta).unwrap();
        let mut energy = bar.energy(&start).total();
        let (initial, mut touched) = (energy, 0);
        steps(&method, &mut bar, start, (4.0, 0.01), |bar, from, to| {
            let now = bar.energy(to).total();
            let impulse = 0.01 * to.lambda[0];
            let change = State {
                q: to.q.iter().zip(&from.q).map(|(a, b)| a - b).collect(),
                v: to.v.iter().zip(&from.v).map(|(a, b)| a - b).collect(),
                ..to.clone()
            };
            let of_change = bar.energy(&change);
            let dissipated = (2.0 * theta - 1.0) * (of_change.kinetic + of_change.strain);
            let work = impulse * (theta * to.v[0] + (1.0 - theta) * from.v[0]);
            assert!(
                (now - energy - work + dissipated).abs() < 1e-11 * initial,
                "{restitution} {theta} {}",
                to.t
            );
            if from.v[0] <= 0.0 {
                assert!(now <= energy + 1e-12 * initial, "{restitution} {theta} {}: {now} {energy}", to.t);
            }
            touched += u32::from(impulse > 0.0);
            energy = now;
        });
        assert!(touched > 20);
    }
}
