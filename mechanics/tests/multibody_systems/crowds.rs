//! Contacts by the hundred: a rod that falls flat on a floor.

use super::{GRAVITY, radau};
use flexion::analysis::transient::{Burst, Ending, Event, EventKind, Observer, Plan, Step, transient};
use flexion::contact::{Contact, Contacting, Law, Plane};
use flexion::integrator::{Integrator, MoreauJean, NonsmoothAlpha};
use flexion::linalg::Vec3;
use flexion::multibody::slender::{Beam, ELEMENT_VELOCITIES, Properties, Station};
use flexion::multibody::{Flexible, Model, Multibody};
use flexion::system::{Dynamics, RowWeights, Set, State, System};
use std::sync::Arc;

const LENGTH: f64 = 1.0;
const MASS: f64 = 0.094;
const HEIGHT: f64 = 0.02;
/// [m/s]
const SLIDES: f64 = 0.5;

/// A rod of 20 elements at a height above a floor, which it may touch at `parts` + 1 points.
fn rod(parts: usize, law: Law) -> Contacting<Multibody> {
    let properties = Properties::principal([1.6e5, 0.75, 0.98, 0.98], MASS / LENGTH, [1e-6, 0.0, 0.0]);
    let station = Station {
        position: Vec3([0.0, 0.0, HEIGHT]),
        tangent: Vec3([1.0, 0.0, 0.0]),
        normal: Vec3([0.0, 1.0, 0.0]),
    };
    let mut model = Model::new().with_gravity([0.0, 0.0, -GRAVITY]);
    let beam = Flexible::new("rod", Beam::straight(station, LENGTH, 20, properties).unwrap());
    let beam = model.beam(Flexible { velocity: Some(Vec3([SLIDES, 0.0, 0.0])), ..beam });
    let plane = Arc::new(Plane { point: Vec3::ZERO, normal: Vec3([0.0, 0.0, 1.0]), motion: None });
    let contact = |k: usize| {
        let point = model.contact_station(beam, LENGTH * k as f64 / parts as f64, 0.0);
        Contact { name: format!("floor.{k}"), point, obstacle: plane.clone(), law }
    };
    let contacts = (0..=parts).map(contact).collect();
    Contacting::new(Multibody::new(model).unwrap(), contacts)
}

#[derive(Default)]
struct Seen {
    /// Sum of the normal impulses of impacts.
    impulse: f64,
    deepest: f64,
    bursts: usize,
}

impl Observer for Seen {
    fn sample(&mut self, system: &mut dyn System, state: &State, _step: &Step) {
        let mut gaps = vec![0.0; state.lambda.len()];
        system.constraint(state, RowWeights::POSITION, &mut gaps);
        self.deepest = gaps.iter().fold(self.deepest, |least, gap| least.min(*gap));
    }
    fn event(&mut self, event: &Event) {
        if let EventKind::Impact { impulses, .. } = &event.kind {
            self.impulse += impulses.iter().step_by(3).sum::<f64>();
        }
    }
    fn burst(&mut self, _burst: &Burst) {
        self.bursts += 1;
    }
}

/// One hundred points with friction, more than the motions of 20 elements that they hold: the rod strikes flat, with m√(2gh), slides, and comes to rest
/// with its weight on them.
#[test]
fn a_rod_that_falls_flat_slides_and_rests_on_a_hundred_points() {
    for friction in [0.3, 0.8] {
        let methods: [Box<dyn Integrator>; 2] =
            [Box::new(NonsmoothAlpha::decoupled(0.8).unwrap()), Box::new(MoreauJean::new(0.5).unwrap())];
        for (k, method) in methods.into_iter().enumerate() {
            let mut system = rod(100, Law::Constraint { restitution: 0.0, friction });
            let (mut state, mut seen) = (system.initial(), Seen::default());
            let plan = Plan::new(0.08, 0.002).with_step(4e-4);
            let ending = transient(&mut system, method.as_ref(), &mut state, &plan, &mut seen);
            assert_eq!(ending, Ending::Finished);
            let weight = MASS * GRAVITY;
            let of = |first: usize| state.lambda.iter().skip(first).step_by(3).sum::<f64>();
            assert!((of(0) / weight - 1.0).abs() < 1e-6, "{} {}", of(0), weight);
            for disc in state.lambda.chunks_exact(3) {
                let [normal, x, y] = [disc[0], disc[1], disc[2]];
                assert!(normal >= 0.0 && x.hypot(y) <= friction * normal * (1.0 + 1e-9) + 1e-12, "{disc:?}");
            }
            // It has struck with m√(2gh), and the impulse of friction is μ times that, as long as it slides: with μ = 0.8 it stops at once.
            let struck = (2.0 * GRAVITY * HEIGHT).sqrt();
            let speed = state.v[0];
            let slides = SLIDES - friction * (struck + GRAVITY * (0.08 - struck / GRAVITY));
            assert!((speed - slides.max(0.0)).abs() < 2e-3, "{k}: {speed} {slides}");
            let lowest = if k == 0 { 1e-12 } else { 2.0 * struck * 4e-4 };
            assert!(seen.deepest > -lowest, "{k}: {:e}", seen.deepest);
            assert!(
                (seen.impulse / (MASS * struck) - 1.0).abs() < 0.05,
                "{} {}",
                seen.impulse,
                MASS * struck
            );
        }
    }
}

/// Without friction a run by events meets more of them than it could follow: it goes over to nonsmooth steps, says so, and comes to rest.
#[test]
fn a_rod_that_chatters_comes_to_rest_by_nonsmooth_steps() {
    let mut system = rod(20, Law::Constraint { restitution: 0.0, friction: 0.0 });
    let (mut state, mut seen) = (system.initial(), Seen::default());
    // One end comes first.
    state
        .v
        .iter_mut()
        .skip(2)
        .step_by(ELEMENT_VELOCITIES)
        .enumerate()
        .for_each(|(k, v)| *v = 0.05 * k as f64 / 20.0);
    state.v.iter_mut().skip(5).step_by(ELEMENT_VELOCITIES).for_each(|v| *v = 0.05);
    let plan = Plan::new(0.3, 0.002);
    assert!(system.rows().iter().all(|set| *set == Set::Unilateral { restitution: 0.0 }));
    assert_eq!(transient(&mut system, &radau(1e-4), &mut state, &plan, &mut seen), Ending::Finished);
    assert!(seen.bursts > 0);
    let force: f64 = state.lambda.iter().sum();
    let fastest = state.v.iter().skip(2).step_by(ELEMENT_VELOCITIES).fold(0.0_f64, |x, v| x.max(v.abs()));
    assert!(fastest < 1e-3, "{fastest}");
    assert!((force / (MASS * GRAVITY) - 1.0).abs() < 0.05, "{force}");
    // Between the ends of steps the error of the method.
    assert!(seen.deepest > -1e-4 * HEIGHT, "{:e}", seen.deepest);
}
