//! Laws of one's own: against the controller of a motor, against closed forms, and what they may not be.

#![allow(clippy::unwrap_used)] // in helpers of tests

use flexion::analysis::recording::{Record, record};
use flexion::analysis::transient::{Ending, Plan};
use flexion::command::{Command, CommandFault, Commanded, Input, LawState, Signal, Timing};
use flexion::drive::{Actuator, Controller};
use flexion::hub_beam::load::{self, Axes};
use flexion::hub_beam::{Drive, ExactCoupling, FreeHub, Hub, HubBeam};
use flexion::integrator::{GeneralizedAlpha, Integrator, MoreauJean, Radau, RungeKutta, Tolerance};
use flexion::multibody::{Body, Drive as OfJoint, Joint, Kind, Marker, Model, Multibody, Part};
use flexion::profile::{Constant, Motion, Profile};
use flexion::section::{Resultants, Uniform};
use flexion::system::{Events as _, State, System};
use flexion::verify;
use std::sync::{Arc, Mutex};

const LENGTH: f64 = 2.0;
const GAINS: [f64; 2] = [40.0, 12.0];
const TARGET: f64 = 0.8;

type Value = Result<f64, String>;

/// A law that is a function.
struct Function<F>(F);

impl<F: FnMut(f64, &[f64]) -> Value + Send> Command for Function<F> {
    fn value(&mut self, t: f64, y: &[f64], _rates: &mut [f64]) -> Value {
        (self.0)(t, y)
    }
}

fn input(
    name: &str,
    reads: &[&str],
    timing: Timing,
    signal: &Arc<Signal>,
    law: impl FnMut(f64, &[f64]) -> Value + Send + 'static,
) -> Input {
    let reads = reads.iter().map(|name| (*name).to_owned()).collect();
    let (name, command) = (name.to_owned(), Box::new(Function(law)));
    Input { name, unit: "N*m", reads, states: Vec::new(), timing, command, signal: Arc::clone(signal) }
}

fn continuous() -> Timing {
    Timing::Continuous { breaks: Vec::new() }
}

fn constant(value: f64) -> Arc<dyn Profile> {
    Arc::new(Constant::new(value).unwrap())
}

/// A beam on a free hub under a torque, with a controller, and under a force at the tip that a signal gives.
fn arm(
    torque: Arc<dyn Profile>,
    controller: Option<Controller>,
    force: &Arc<Signal>,
) -> HubBeam<ExactCoupling> {
    let resultants =
        Resultants { mass: 1.5, axial_stiffness: 1e5, bending_stiffness: 60.0, ..Default::default() };
    let section = Uniform::from_resultants(resultants).unwrap();
    let actuator = Actuator { torque, damping: 0.0, stiffness: 0.0, rest_angle: 0.0, controller };
    let drive = Drive::Free(FreeHub { angle: 0.1, speed: 0.0, actuator });
    let hub = Hub { radius: 0.0, inertia: 2.0, drive };
    let coupling = ExactCoupling::new(LENGTH, 3, &section, &hub).unwrap();
    let force = load::Force {
        station: LENGTH,
        force: [0.0, 1.0],
        axes: Axes::Follower,
        amplitude: Some(force.clone()),
    };
    HubBeam::new(hub, coupling, &[]).with_loads(&section, &[&force])
}

fn radau(tolerance: f64) -> Radau {
    Radau::new(Tolerance { relative: tolerance, absolute: 1e-2 * tolerance }).unwrap()
}

fn run(system: &mut dyn System, integrator: &dyn Integrator, end: f64) -> Record {
    let step = if integrator.info().estimate_order.is_none() { Some(1e-3) } else { None };
    record(system, integrator, &Plan { step, ..Plan::new(end, 0.05) })
}

fn difference(a: &Record, b: &Record, name: &str) -> f64 {
    let (a, b) = (a.column(name).unwrap(), b.column(name).unwrap());
    a.iter().zip(&b).fold(0.0, |most, (a, b)| f64::max(most, (a - b).abs()))
}

fn commanded(inputs: Vec<Input>, torque: &Arc<Signal>, force: &Arc<Signal>) -> Commanded {
    let model = arm(Arc::clone(torque) as Arc<dyn Profile>, None, force);
    Commanded::new(Box::new(model), inputs, 1.0).unwrap()
}

#[test]
fn a_law_that_is_a_controller_moves_as_the_controller_does() {
    let pd = |_: f64, y: &[f64]| Ok(GAINS[0] * (TARGET - y[0]) + GAINS[1] * (0.0 - y[1]));
    let reference = Motion::Angle(constant(TARGET));
    let [proportional, derivative] = GAINS;
    let controller = Controller { proportional, derivative, reference, limit: f64::INFINITY };
    let methods: [(Box<dyn Integrator>, f64); 3] = [
        (Box::new(radau(1e-9)), 1e-7),
        (Box::new(GeneralizedAlpha::chung_hulbert(0.9).unwrap()), 1e-9),
        (Box::new(radau(1e-5)), 1e-3),
    ];
    for (method, allowed) in methods {
        let force = Arc::new(Signal::default());
        let torque = Arc::new(Signal::default());
        let mut own = arm(constant(0.0), Some(controller.clone()), &force);
        let law = input("torque", &["hub.angle", "hub.speed"], continuous(), &torque, pd);
        let mut commanded = commanded(vec![law], &torque, &force);
        let (own, by_law) = (run(&mut own, &*method, 1.0), run(&mut commanded, &*method, 1.0));
        assert_eq!([&own.ending, &by_law.ending], [&Ending::Finished; 2]);
        let most = difference(&own, &by_law, "hub.angle");
        assert!(most < allowed, "{}: {most}", method.info().name);
        assert!(difference(&own, &by_law, "hub.torque") < 1e3 * allowed);
        // Newton's method takes as many iterations: the slopes of the law are those of the controller.
        let [a, b] = [&own, &by_law].map(|run| run.counters.iterations as f64);
        assert!((a - b).abs() <= 0.03 * a, "{}: {a} and {b} iterations", method.info().name);
    }
}

#[test]
fn a_law_of_time_alone_gives_the_bits_of_its_formula() {
    let force = Arc::new(Signal::default());
    let torque = Arc::new(Signal::default());
    let law = input("torque", &[], continuous(), &torque, |_, _| Ok(3.0));
    let mut by_law = commanded(vec![law], &torque, &force);
    let mut own = arm(constant(3.0), None, &force);
    let (own, by_law) = (run(&mut own, &radau(1e-6), 1.0), run(&mut by_law, &radau(1e-6), 1.0));
    assert_eq!(own.column("tip.deflection"), by_law.column("tip.deflection"));
    assert!(own.column("hub.angle").unwrap().last().unwrap() > &0.2);
}

#[test]
fn tangents_with_laws_are_the_derivatives_of_their_residuals() {
    let (force, torque) = (Arc::new(Signal::default()), Arc::new(Signal::default()));
    let of_tip = input("force", &["tip.deflection", "hub.speed"], continuous(), &force, |t, y| {
        Ok(t - 70.0 * y[0] * (1.0 + y[0]) - 3.0 * y[1] * y[0])
    });
    let of_hub = input("torque", &["tip.deflection_velocity", "hub.angle"], continuous(), &torque, |_, y| {
        Ok(5.0 * y[0] - 20.0 * y[1].sin())
    });
    let mut system = commanded(vec![of_tip, of_hub], &torque, &force);
    let mut s = verify_state(&system);
    system.pass(&s).unwrap();
    assert_eq!(verify::dynamics(&mut system, &s), []);
    s.t = 0.7;
    assert_eq!(verify::dynamics(&mut system, &s), []);
}

/// A state that is not special.
fn verify_state(system: &dyn System) -> State {
    let mut s = system.initial();
    let some = |i: usize| (1.0 + 2.3 * i as f64).sin();
    s.q.iter_mut().enumerate().for_each(|(i, q)| *q += 0.02 * some(i));
    s.v.iter_mut().enumerate().for_each(|(i, v)| *v = 0.3 * some(2 * i));
    s.a.iter_mut().enumerate().for_each(|(i, a)| *a = some(3 * i));
    s
}

/// A rigid arm on a hinge, J θ̈ = u.
fn rigid(torque: &Arc<Signal>) -> Multibody {
    let mut model = Model::new();
    let body = model.body(Body::new("bar", 3.0, [0.5; 3]));
    let [ground, end] = [Part::Ground, body].map(|part| Marker::new(part, [0.0; 3]));
    let torque: Arc<dyn Profile> = torque.clone();
    let actuator = Actuator { torque, damping: 0.0, stiffness: 0.0, rest_angle: 0.0, controller: None };
    model.joint(Joint::new("hinge", Kind::Revolute, ground, end).driven(OfJoint::Actuated(actuator)));
    Multibody::new(model).unwrap()
}

/// With the torque u held over a period T, θ and θ̇ at the samples follow from those before: θ + T θ̇ + T² u/2J, θ̇ + T u/J.
#[test]
fn a_sampled_law_is_asked_once_a_sample_in_order_of_time_and_held() {
    const PERIOD: f64 = 0.03;
    let methods: [Box<dyn Integrator>; 2] =
        [Box::new(radau(1e-8)), Box::new(GeneralizedAlpha::chung_hulbert(0.9).unwrap())];
    for method in methods {
        let torque = Arc::new(Signal::default());
        let asked: Arc<Mutex<Vec<(f64, f64)>>> = Arc::default();
        let (seen, mut sum) = (Arc::clone(&asked), 0.0);
        let law = input(
            "u",
            &["hinge.angle", "hinge.speed"],
            Timing::Sampled { period: PERIOD },
            &torque,
            move |t, y| {
                sum += (1.0 - y[0]) * PERIOD;
                seen.lock().unwrap().push((t, y[0]));
                Ok(6.0 * (1.0 - y[0]) - 2.0 * y[1] + 2.0 * sum)
            },
        );
        let mut system = Commanded::new(Box::new(rigid(&torque)), vec![law], 1.5).unwrap();
        let by_law = run(&mut system, &*method, 1.5);
        assert_eq!(by_law.ending, Ending::Finished);
        let asked = asked.lock().unwrap();
        // 1.5 s is the end, behind which there is nothing to be held.
        assert_eq!(asked.len(), 50);
        let (mut angle, mut speed, mut sum) = (0.0_f64, 0.0_f64, 0.0);
        for (k, (t, found)) in asked.iter().enumerate() {
            assert!((t - k as f64 * PERIOD).abs() < 1e-12, "{k}: {t}");
            assert!((found - angle).abs() < 1e-9, "{}: {found} at {t}, and {angle}", method.info().name);
            sum += (1.0 - angle) * PERIOD;
            let u = 6.0 * (1.0 - angle) - 2.0 * speed + 2.0 * sum;
            angle += PERIOD * speed + 0.5 * PERIOD * PERIOD * u / 0.5;
            speed += PERIOD * u / 0.5;
        }
        let column = by_law.column("hinge.angle").unwrap();
        assert!((column.last().unwrap() - angle).abs() < 1e-9);
        assert!(angle > 0.5);
    }
}

/// A law with states: u(t, y, x), and the rates of x.
struct WithStates<F>(F);

impl<F: FnMut(f64, &[f64], &mut [f64]) -> f64 + Send> Command for WithStates<F> {
    fn value(&mut self, t: f64, y: &[f64], rates: &mut [f64]) -> Value {
        Ok((self.0)(t, y, rates))
    }
}

fn with_states(
    reads: &[&str],
    states: &[(&str, f64)],
    signal: &Arc<Signal>,
    law: impl FnMut(f64, &[f64], &mut [f64]) -> f64 + Send + 'static,
) -> Input {
    let states =
        states.iter().map(|(name, start)| LawState { name: (*name).to_owned(), start: *start, size: 1.0 });
    let states = states.collect();
    Input {
        command: Box::new(WithStates(law)),
        states,
        ..input("u", reads, continuous(), signal, |_, _| Ok(0.0))
    }
}

/// J θ̈ = u = k_i x − k_p θ − k_d θ̇ with ẋ = 1 − θ and the roots −1, −2, −3: θ = 1 − 3 e⁻ᵗ + 3 e⁻²ᵗ − e⁻³ᵗ.
#[test]
fn a_state_of_a_law_is_integrated_with_the_motion_by_every_method() {
    const J: f64 = 0.5;
    let exact = |t: f64| 1.0 - 3.0 * (-t).exp() + 3.0 * (-2.0 * t).exp() - (-3.0 * t).exp();
    // x − 11/6 = ∫ (1 − θ) from ∞ on.
    let integral = |t: f64| 11.0 / 6.0 - 3.0 * (-t).exp() + 1.5 * (-2.0 * t).exp() - (-3.0 * t).exp() / 3.0;
    let methods: [(Box<dyn Integrator>, f64); 4] = [
        (Box::new(radau(1e-9)), 1e-8),
        (Box::new(GeneralizedAlpha::chung_hulbert(0.9).unwrap()), 2e-6),
        (Box::new(GeneralizedAlpha::newmark(0.25, 0.5).unwrap()), 2e-6),
        (Box::new(MoreauJean::new(0.5).unwrap()), 2e-3),
    ];
    for (method, allowed) in methods {
        let torque = Arc::new(Signal::default());
        let law = with_states(&["hinge.angle", "hinge.speed"], &[("sum", 0.0)], &torque, |_, y, rates| {
            rates[0] = 1.0 - y[0];
            J * (6.0 * y[2] - 11.0 * y[0] - 6.0 * y[1])
        });
        let mut system = Commanded::new(Box::new(rigid(&torque)), vec![law], 4.0).unwrap();
        let by_law = run(&mut system, &*method, 4.0);
        let name = method.info().name;
        assert_eq!(by_law.ending, Ending::Finished, "{name}");
        let times = by_law.trajectory.times();
        for (column, exact) in [("hinge.angle", &exact as &dyn Fn(f64) -> f64), ("law.u.sum", &integral)] {
            let values = by_law.column(column).unwrap();
            let most =
                times.iter().zip(&values).fold(0.0, |most, (t, x)| f64::max(most, (x - exact(*t)).abs()));
            assert!(most < allowed, "{name}, {column}: {most}");
        }
    }
}

/// A beam on a free hub: an explicit method and one under error control give the same.
#[test]
fn explicit_methods_integrate_states() {
    let by = |method: &dyn Integrator, step: Option<f64>| {
        let (force, torque) = (Arc::new(Signal::default()), Arc::new(Signal::default()));
        let law = with_states(&["hub.angle", "hub.speed"], &[("sum", 0.2)], &torque, |_, y, rates| {
            rates[0] = TARGET - y[0];
            30.0 * y[2] - 40.0 * y[0] - 12.0 * y[1]
        });
        let mut system = commanded(vec![law], &torque, &force);
        let run = record(&mut system, method, &Plan { step, ..Plan::new(0.4, 0.05) });
        assert_eq!(run.ending, Ending::Finished);
        run
    };
    let (explicit, implicit) = (by(&RungeKutta::new(), Some(2e-5)), by(&radau(1e-10), None));
    for (column, allowed) in [("law.u.sum", 1e-9), ("hub.angle", 1e-8)] {
        let most = difference(&explicit, &implicit, column);
        assert!(most < allowed, "{column}: {most}");
    }
}

#[test]
fn tangents_of_laws_with_states_are_the_derivatives_of_their_residuals() {
    let (force, torque) = (Arc::new(Signal::default()), Arc::new(Signal::default()));
    let of_tip = with_states(&["tip.deflection"], &[("a", 0.3), ("b", -0.2)], &force, |t, y, rates| {
        rates[0] = y[0] * y[2] + t;
        rates[1] = (y[1] * y[2]).sin() - 2.0 * y[2];
        t - 70.0 * y[0] * y[1] + y[2]
    });
    let of_hub = with_states(&["hub.angle"], &[("c", 1.0)], &torque, |_, y, rates| {
        rates[0] = -y[1] * y[1];
        y[0] * y[1]
    });
    let of_hub = Input { name: "torque".to_owned(), ..of_hub };
    let mut system = commanded(vec![of_tip, of_hub], &torque, &force);
    let mut s = verify_state(&system);
    assert_eq!(verify::dynamics(&mut system, &s), []);
    system.pass(&s).unwrap();
    s.t = 0.7;
    assert_eq!(verify::dynamics(&mut system, &s), []);
}

/// A double pendulum, whose rows stand behind the states: with a filter of the angle that takes no time, the torque is that of the angle.
#[test]
fn states_stand_beside_rows_of_constraints() {
    let links = |torque: &Arc<Signal>| {
        let mut model = Model::new();
        let bars = ["first", "second"].map(|name| model.body(Body::new(name, 3.0, [0.5; 3])));
        let at = |part, x: f64| Marker::new(part, [x, 0.0, 0.0]);
        let torque: Arc<dyn Profile> = torque.clone();
        let actuator = Actuator { torque, damping: 0.4, stiffness: 0.0, rest_angle: 0.0, controller: None };
        let driven = OfJoint::Actuated(actuator);
        let ground = at(Part::Ground, -1.0);
        model.joint(Joint::new("hinge", Kind::Revolute, ground, at(bars[0], -1.0)).driven(driven));
        model.joint(Joint::new("elbow", Kind::Spherical, at(bars[0], 1.0), at(bars[1], 1.0)));
        Multibody::new(model).unwrap()
    };
    let by = |states: &[(&str, f64)], method: &dyn Integrator| {
        let torque = Arc::new(Signal::default());
        let filtered = !states.is_empty();
        let law = with_states(&["hinge.angle"], states, &torque, move |_, y, rates| {
            if filtered {
                rates[0] = 1e4 * (y[0] - y[1]);
            }
            8.0 * (1.0 - y[usize::from(filtered)])
        });
        let mut system = Commanded::new(Box::new(links(&torque)), vec![law], 1.0).unwrap();
        run(&mut system, method, 1.0)
    };
    let exact = by(&[], &radau(1e-9));
    let methods: [(Box<dyn Integrator>, f64); 2] =
        [(Box::new(radau(1e-8)), 2e-4), (Box::new(GeneralizedAlpha::chung_hulbert(0.8).unwrap()), 2e-4)];
    for (method, allowed) in methods {
        let found = by(&[("filtered", 0.0)], &*method);
        assert_eq!(found.ending, Ending::Finished);
        for column in ["hinge.angle", "elbow.force.x"] {
            let largest = exact.column(column).unwrap().iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            let most = difference(&exact, &found, column);
            assert!(most < allowed * largest && largest > 0.1, "{column}: {most} of {largest}");
        }
    }
}

#[test]
fn states_that_cannot_be_integrated_are_refused_by_name() {
    let fault = |change: &dyn Fn(&mut Input)| {
        let torque = Arc::new(Signal::default());
        let mut law = with_states(&["hinge.angle"], &[("sum", 0.0)], &torque, |_, _, _| 0.0);
        change(&mut law);
        Commanded::new(Box::new(rigid(&torque)), vec![law], 1.0).err().unwrap().to_string()
    };
    let sampled = fault(&|law| law.timing = Timing::Sampled { period: 0.1 });
    assert!(sampled.contains("a sampled law has a memory of its own"), "{sampled}");
    assert!(fault(&|law| law.states[0].start = f64::NAN).contains("`sum` of the law `u` begins with NaN"));
    assert!(fault(&|law| law.states[0].size = 0.0).contains("has the size 0"));
    assert!(fault(&|law| law.states[0].name = "hinge.angle".to_owned()).contains("a name of its own"));
    assert!(fault(&|law| law.states.push(law.states[0].clone())).contains("a name of its own"));
}

#[test]
fn a_rate_that_is_no_number_ends_the_run() {
    let torque = Arc::new(Signal::default());
    let law = with_states(&[], &[("x", 0.0)], &torque, |t, _, rates| {
        rates[0] = if t > 0.4 { f64::NAN } else { 1.0 };
        1.0
    });
    let mut system = Commanded::new(Box::new(rigid(&torque)), vec![law], 1.0).unwrap();
    let by_law = run(&mut system, &radau(1e-6), 1.0);
    let Ending::Failed(error) = &by_law.ending else { panic!("it finished") };
    assert!(error.to_string().contains("gives the rate NaN of `x` at t = 0.4"), "{error}");
}

#[test]
fn a_continuous_law_with_memory_ends_the_run() {
    for (name, method) in
        [("radau", Box::new(radau(1e-6)) as Box<dyn Integrator>), ("explicit", Box::new(RungeKutta::new()))]
    {
        let (force, torque) = (Arc::new(Signal::default()), Arc::new(Signal::default()));
        let (mut sum, mut last) = (0.0, 0.0);
        // No time passes between two calls at once, and the sum stays as it is.
        let law = input("torque", &["hub.angle"], continuous(), &torque, move |t, y| {
            sum += (TARGET - y[0]) * (t - last);
            last = t;
            Ok(sum)
        });
        let mut system = commanded(vec![law], &torque, &force);
        let plan = Plan { step: Some(1e-4), ..Plan::new(1.0, 0.05) };
        let by_law = record(&mut system, &*method, &plan);
        let Ending::Failed(error) = by_law.ending else { panic!("{name} finished") };
        assert!(error.to_string().contains("what has memory is sampled"), "{name}: {error}");
    }
}

#[test]
fn a_law_that_gives_no_number_ends_the_run_and_what_was_recorded_is_kept() {
    type Law = (fn(f64) -> Value, &'static str);
    let laws: [Law; 2] = [
        (|t| Ok(if t > 0.4 { f64::NAN } else { 1.0 }), "the law `torque` gives NaN at t = 0.4"),
        (|t| if t > 0.4 { Err("raised".to_owned()) } else { Ok(1.0) }, "the law `torque` raised"),
    ];
    for (law, said) in laws {
        for timing in [continuous(), Timing::Sampled { period: 0.01 }] {
            let (force, torque) = (Arc::new(Signal::default()), Arc::new(Signal::default()));
            let law = input("torque", &["hub.angle"], timing, &torque, move |t, _| law(t));
            let by_law = run(&mut commanded(vec![law], &torque, &force), &radau(1e-6), 1.0);
            let Ending::Failed(error) = &by_law.ending else { panic!("it finished") };
            assert!(error.to_string().contains(said), "{error}");
            assert!((by_law.state.t - 0.4).abs() < 0.02 && by_law.column("hub.angle").unwrap().len() >= 8);
        }
    }
}

#[test]
fn laws_read_no_accelerations_no_reactions_and_nothing_that_is_not_there() {
    let fault = |reads: &str, timing: Timing| {
        let (force, torque) = (Arc::new(Signal::default()), Arc::new(Signal::default()));
        let law = input("torque", &[reads], timing, &torque, |_, _| Ok(0.0));
        let model = arm(torque, None, &force);
        Commanded::new(Box::new(model), vec![law], 1.0).err()
    };
    for column in ["hub.acceleration", "hub.torque"] {
        assert!(matches!(fault(column, continuous()), Some(CommandFault::Reaction { .. })), "{column}");
    }
    assert!(matches!(fault("hub.angel", continuous()), Some(CommandFault::NoColumn { .. })));
    for column in ["hub.angle", "tip.rotation_velocity", "energy.kinetic"] {
        assert_eq!(fault(column, continuous()), None, "{column}");
    }
    for period in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(fault("hub.angle", Timing::Sampled { period }), Some(CommandFault::Time { .. })));
    }
    assert!(matches!(
        fault("hub.angle", Timing::Sampled { period: 1e-9 }),
        Some(CommandFault::Samples { .. })
    ));
}
