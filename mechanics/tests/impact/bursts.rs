//! The first burst of impacts of P4's pendulum and its second touch, against an independent program
//! (`references/impact`: other equations, other integrator, other search for events).
#![allow(missing_docs)]

use super::falling_pendulum::{hub, pendulum, run, section, with_ground};
use flexion::analysis::transient::{Ending, Event, EventKind, Observer, Plan, Step, transient};
use flexion::contact::Law;
use flexion::hub_beam::ExactCoupling;
use flexion::integrator::{Radau, Tolerance};
use flexion::system::{Dynamics, Mode, State, System};
use std::ops::ControlFlow;

/// Time, impulse and loss of the impacts with more than 1e-4 N·s, and times at which the contact opens.
fn events(modes: usize, restitution: f64, tolerance: f64, end: f64) -> (Vec<[f64; 3]>, Vec<f64>) {
    let mut system = pendulum(modes, Law::Constraint { restitution, friction: 0.0 });
    let method = Radau::new(Tolerance::uniform(tolerance)).unwrap();
    let plan = Plan::new(end, 0.01);
    let (watch, _, ending) = run(&mut system, &method, &plan);
    assert_eq!(ending, Ending::Finished, "{:?}", watch.events);
    let (mut strikes, mut openings) = (Vec::new(), Vec::new());
    for event in &watch.events {
        match &event.kind {
            EventKind::Impact { impulses, lost, .. } if impulses[0] > 1e-4 => {
                strikes.push([event.time, impulses[0], *lost]);
            }
            EventKind::Switch if event.modes[0] == Mode::Open => openings.push(event.time),
            _ => {}
        }
    }
    (strikes, openings)
}

fn compare(found: &[[f64; 3]], expected: &[[f64; 3]], time: f64, impulse: f64) {
    assert!(found.len() >= expected.len(), "{found:?}");
    for (found, expected) in found.iter().zip(expected) {
        let part = |k: usize| (found[k] / expected[k] - 1.0).abs();
        assert!(part(0) < time && part(1) < impulse && part(2) < 2.0 * impulse, "{found:?} {expected:?}");
    }
}

/// N = 1, e = 0: one impact, a contact that lasts, a flight, the second touch.
#[test]
fn one_mode_without_restitution() {
    let expected =
        [[0.370001290051, 0.665990469917, 1.51617066949], [0.687134160001, 0.529578102979, 0.958814838425]];
    let (strikes, openings) = events(1, 0.0, 1e-10, 0.6872);
    compare(&strikes, &expected, 1e-7, 1e-5);
    assert_eq!(openings.len(), 1);
    assert!((openings[0] - 0.378713366621).abs() < 1e-8, "{openings:?}");
}

/// N = 2, e = 0, with both tolerances: three impacts, each with a contact that lasts, then the second touch.
#[test]
fn two_modes_without_restitution_whatever_the_tolerance() {
    let expected = [
        [0.370010052116, 0.429184146751, 0.981371260015],
        [0.374436102453, 0.142297238625, 0.107897217689],
        [0.382777778444, 0.111896342913, 0.0667078556399],
        [0.778915922491, 0.197216838063, 0.207235749932],
    ];
    for (tolerance, time, impulse) in [(1e-9, 1e-6, 5e-4), (1e-10, 1e-6, 1e-4)] {
        let (strikes, openings) = events(2, 0.0, tolerance, 0.779);
        compare(&strikes, &expected, time, impulse);
        assert_eq!((strikes.len(), openings.len()), (4, 3));
        for (found, expected) in openings.iter().zip([0.372291273319, 0.38020670139, 0.383333999435]) {
            assert!((found - expected).abs() < 1e-6, "{openings:?}");
        }
    }
}

/// N = 1, e = ½: three impacts and the second touch.
#[test]
fn one_mode_with_restitution() {
    let expected = [
        [0.370001290051, 0.998985704875, 1.13712800212],
        [0.374436865181, 0.735325577492, 0.616290716733],
        [0.377220065569, 0.264437475994, 0.079679500972],
        [0.683420348057, 0.813759377447, 0.754572836232],
    ];
    let (strikes, _) = events(1, 0.5, 1e-10, 0.6835);
    compare(&strikes, &expected, 1e-6, 1e-4);
    assert_eq!(strikes.len(), 4);
}

/// N = 2, e = ½: bounces that accumulate, are cut off and go over into a contact that lasts.
#[test]
fn two_modes_with_restitution_in_the_first_burst() {
    let expected = [
        [0.370010052116, 0.643776220126, 0.736028445012],
        [0.37221826421, 0.186509445647, 0.0617924233933],
        [0.374793436311, 0.479016094942, 0.407609783665],
        [0.376964641745, 0.160994355765, 0.0460500841691],
        [0.377619673608, 0.104454079017, 0.0193807724352],
        [0.377884879384, 0.0556255542416, 0.00549591825393],
        [0.378012725121, 0.0282745554309, 0.00141994819083],
        [0.37807437578, 0.0142841345643, 0.000362395768654],
    ];
    let (strikes, openings) = events(2, 0.5, 1e-10, 0.383);
    compare(&strikes, &expected, 1e-7, 2e-4);
    let (last, opened) = (strikes[strikes.len() - 1], openings[openings.len() - 1]);
    assert!((opened - 0.379784003445).abs() < 1e-6, "{openings:?}");
    assert!(
        (last[0] - 0.382716975361).abs() < 1e-6 && (last[1] / 0.0214599559629 - 1.0).abs() < 1e-3,
        "{last:?}"
    );
}

/// N = 3, e = 0.
#[test]
fn three_modes_without_restitution_in_the_first_burst() {
    let expected = [
        [0.370010386339, 0.307540153414, 0.702881861406],
        [0.376208883319, 0.0617607742232, 0.0283583128441],
    ];
    let (strikes, openings) = events(3, 0.0, 1e-10, 0.381);
    compare(&strikes, &expected, 1e-7, 1e-4);
    for (found, expected) in openings.iter().zip([0.374166825488, 0.379385760296]) {
        assert!((found - expected).abs() < 1e-6, "{openings:?}");
    }
}

/// The coupling `exact` at loose tolerances: iteration errors, which extrapolation multiplies from step to step, neither stop
/// a run nor, where the tolerance is well below the axial displacements, add energy. Each length of the run has other steps;
/// in those of 0.86 s a step by which an event is looked for does not converge.
#[test]
fn iteration_errors_of_loose_tolerances_neither_stop_a_run_nor_add_energy() {
    let start = 0.5 * 9.81 * std::f64::consts::FRAC_1_SQRT_2 * 2766.7 * 3.14e-4;
    for (tolerance, end) in [
        (1e-4, 0.85),
        (1e-4, 0.86),
        (1e-4, 1.0),
        (3e-5, 0.856),
        (3e-5, 0.86),
        (1e-5, 0.83),
        (1e-5, 0.856),
        (1e-5, 1.0),
    ] {
        let coupling = ExactCoupling::new(1.0, 4, &section(), &hub()).unwrap();
        let mut system = with_ground(coupling, Law::Constraint { restitution: 0.0, friction: 0.0 });
        let method = Radau::new(Tolerance::uniform(tolerance)).unwrap();
        let plan = Plan::new(end, 0.005);
        let (watch, _, ending) = run(&mut system, &method, &plan);
        assert_eq!(ending, Ending::Finished, "{tolerance} {end}");
        let most = watch.energies[80..].iter().map(|energy| energy.total()).fold(0.0, f64::max);
        assert!(most < 0.8 * start, "{tolerance} {end}: {most}");
    }
}

/// N = 2, e = ½, up to the second burst: what an impact sees is a velocity, and steps that resolve the axial vibrations
/// (23 524 rad/s here) give it whatever the tolerance.
#[test]
fn second_touch_and_second_burst_with_restitution_in_steps_that_resolve_the_axial_waves() {
    let expected = [
        [0.769707666549, 0.346531172407],
        [0.770593782331, 0.189031488656],
        [0.771105352405, 0.0808325466525],
        [0.771479428655, 0.0327629894882],
    ];
    for tolerance in [1e-8, 1e-10] {
        let mut system = pendulum(2, Law::Constraint { restitution: 0.5, friction: 0.0 });
        let method = Radau::new(Tolerance::uniform(tolerance)).unwrap();
        let plan = Plan::new(0.7717, 0.01).with_longest_step(1e-5);
        let (watch, _, ending) = run(&mut system, &method, &plan);
        assert_eq!(ending, Ending::Finished, "{:?}", watch.events);
        let second = watch.events.iter().filter(|event| event.time > 0.6);
        let found: Vec<[f64; 2]> = second
            .filter_map(|event| match &event.kind {
                EventKind::Impact { impulses, .. } => Some([event.time, impulses[0]]),
                _ => None,
            })
            .collect();
        for (found, expected) in found.iter().zip(expected) {
            let [time, impulse] = [0, 1].map(|k| (found[k] / expected[k] - 1.0).abs());
            assert!(time < 1e-6 && impulse < 1e-3, "{tolerance}: {found:?} {expected:?}");
        }
        assert!(found.len() >= expected.len());
    }
}

/// N = 5, e = 0: a step under control is not longer than `contact_step` from the first impact on, in flight too, and then keeps
/// the energy of the bending modes though the tolerance is loose. Second touch and energy at 0.6 s against the tolerance 1e-10.
#[test]
fn steps_behind_the_first_impact_keep_the_energy_of_bending() {
    #[derive(Default)]
    struct Steps {
        times: Vec<f64>,
        energy: f64,
        second: Option<f64>,
    }
    impl Observer for Steps {
        fn sample(&mut self, system: &mut dyn System, state: &State, _: &Step) {
            if state.t < 0.6 {
                self.energy = system.energy(state).total();
            }
        }
        fn step(&mut self, state: &State) -> ControlFlow<()> {
            self.times.push(state.t);
            ControlFlow::Continue(())
        }
        fn event(&mut self, event: &Event) {
            if event.time > 0.6 {
                self.second.get_or_insert(event.time);
            }
        }
    }
    let first = 0.3700103;
    let run = |contact_step: Option<f64>| {
        let mut system = pendulum(5, Law::Constraint { restitution: 0.0, friction: 0.0 });
        let method = Radau::new(Tolerance::uniform(5e-4)).unwrap();
        let plan =
            Plan { end: 0.8, step: None, contact_step, longest_step: None, break_steps: 1, sample: 0.005 };
        let (mut state, mut seen) = (system.initial(), Steps::default());
        let ending = transient(&mut system, &method, &mut state, &plan, &mut seen);
        assert_eq!(ending, Ending::Finished);
        seen
    };
    let longest = |seen: &Steps, after: f64, before: f64| {
        let inside = seen.times.windows(2).filter(|w| w[0] > after && w[1] < before);
        inside.map(|w| w[1] - w[0]).fold(0.0, f64::max)
    };
    let (short, long) = (run(Some(4.5e-4)), run(None));
    assert!(longest(&short, 0.0, first) > 5e-3 && longest(&long, first, 0.7) > 1e-3);
    assert!(longest(&short, first + 1e-6, 0.8) < 4.5e-4 * (1.0 + 1e-9));
    let lost = |seen: &Steps| 1.0 - seen.energy / 2.127437;
    assert!(lost(&short) < 0.05 && lost(&long) > 0.1, "{} {}", lost(&short), lost(&long));
    assert!((short.second.unwrap() / 0.787736 - 1.0).abs() < 0.015, "{:?}", short.second);
}
