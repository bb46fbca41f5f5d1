//! Elastic bars and beams that strike rigid stops: published values and closed forms.

use super::models::{Linear, rest, steps};
use super::nonsmooth::methods;
use flexion::analysis::transient::{Ending, Observer, Plan, Step, transient};
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
    let plan = Plan { end: 5.0, step: Some(5e-4), longest_step: None, contact_step: None, sample: 1e-3 };
    let mut method = GeneralizedAlpha::newmark(0.25, 0.5).unwrap();
    let ending = transient(&mut bar, &mut method, &mut state, &plan, &mut watch);
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
