//! No integrator allocates in a step, an acceptance or an interpolation, and a fork of a system only its work memory.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)] // in helpers of tests
#![allow(unsafe_code)]

#[path = "../../mechanics/tests/integrators/multibody.rs"]
mod multibody;
#[path = "verification/run.rs"]
mod run;
#[path = "../../mechanics/tests/integrators/systems.rs"]
mod systems;

use flexion::analysis::transient::{Ending, Observer, Plan, Step, transient};
use flexion::drive::Actuator;
use flexion::integrator::{
    Adams, GeneralizedAlpha, Integrator, MoreauJean, NonsmoothAlpha, Radau, RungeKutta, Span, StepControl,
    Tolerance,
};
use flexion::law::LinearDrag;
use flexion::linalg::{Mat3, Vec3};
use flexion::multibody::slender::{self, Beam, Properties, Station};
use flexion::multibody::{
    Axes, Body, Drive, Flexible, Kind, LineLaw, LineLoad, Marker, Model, Multibody, Part, Spring, shear,
};
use flexion::profile::Constant;
use flexion::section::Matrices;
use flexion::system::{Dynamics, Frame, Mode, Parameter, State, System};
use flexion_case::parse;
use std::alloc::{GlobalAlloc, Layout, System as Heap};
use std::cell::Cell;
use std::sync::Arc;
use systems::{CartesianPendulum, Chain, SpringPendulum, state, wide_chain};

/// Counts the allocations of the thread, their bytes, and the bytes that were given back.
struct Counting;

thread_local! {
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
    static BYTES: Cell<usize> = const { Cell::new(0) };
    static FREED: Cell<usize> = const { Cell::new(0) };
}

fn count(bytes: usize) {
    let _ = ALLOCATIONS.try_with(|n| n.set(n.get() + 1));
    let _ = BYTES.try_with(|n| n.set(n.get() + bytes));
}

fn free(bytes: usize) {
    let _ = FREED.try_with(|n| n.set(n.get() + bytes));
}

// SAFETY: every call is passed on unchanged to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size());
        unsafe { Heap.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        free(layout.size());
        unsafe { Heap.dealloc(pointer, layout) }
    }
    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count(size);
        free(layout.size());
        unsafe { Heap.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Every integrator, for systems without constraints.
fn integrators() -> Vec<Box<dyn Integrator>> {
    vec![
        Box::new(GeneralizedAlpha::newmark(0.25, 0.5).unwrap()),
        Box::new(GeneralizedAlpha::hht(0.1).unwrap()),
        Box::new(GeneralizedAlpha::chung_hulbert(0.5).unwrap()),
        Box::new(RungeKutta::new()),
        Box::new(Adams::new()),
        Box::new(Radau::new(Tolerance::uniform(1e-6)).unwrap()),
    ]
}

/// Steps `system` 20 times with each of `integrators` and asserts that nothing is allocated, from the
/// first step on, repeated attempts and changes of step included.
fn assert_no_allocation(
    what: &str,
    system: &mut dyn System,
    from: &State,
    h: f64,
    integrators: Vec<Box<dyn Integrator>>,
) {
    for integrator in integrators {
        let mut from = from.clone();
        let mut integrator = integrator.start(system, &mut from, h).unwrap();
        let (mut to, mut inside) = (from.clone(), from.clone());
        let mut control = StepControl::new(3, 1.0, h);
        let before = ALLOCATIONS.with(Cell::get);
        let mut failures = 0;
        for k in 0..20 {
            let h = if k == 10 { 0.5 * h } else { h };
            failures +=
                u32::from(integrator.step(system, &from, Span::new(from.t, 0.7 * h), &mut to).is_err());
            control.rejected(0.7 * h, 2.0, 1);
            match integrator.step(system, &from, Span::new(from.t, h), &mut to) {
                Ok(report) => control.accepted(h, report.error.unwrap_or(0.5), report.iterations),
                Err(_) => failures += 1,
            }
            integrator.accept(&from, &to);
            integrator.interpolate(system, &from, &to, from.t + 0.5 * h, &mut inside);
            std::mem::swap(&mut from, &mut to);
        }
        let after = ALLOCATIONS.with(Cell::get);
        let name = integrator.info().name;
        assert_eq!(failures, 0, "{what} with {name}: steps failed");
        assert_eq!(after - before, 0, "{what} with {name}: allocations in 20 steps");
    }
}

#[test]
fn no_step_allocates() {
    let mut chain = wide_chain(30);
    let from = state(&chain, &[0.01; 30], &[0.0; 30]);
    assert_no_allocation("chain", &mut chain, &from, 1e-4, integrators());

    let mut oscillator = Chain::oscillator(1.0, 0.1);
    let from = state(&oscillator, &[1.0], &[0.0]);
    assert_no_allocation("oscillator", &mut oscillator, &from, 1e-2, integrators());

    let mut pendulum = SpringPendulum::new(9.0);
    let from = state(&pendulum, &[0.1, 1.2], &[0.0, 0.0]);
    assert_no_allocation("spring pendulum", &mut pendulum, &from, 1e-2, integrators());

    let mut constrained = CartesianPendulum::new();
    let from = state(&constrained, &[1.0, 0.0], &[0.0, 0.0]);
    let only: Vec<Box<dyn Integrator>> = vec![Box::new(GeneralizedAlpha::chung_hulbert(0.5).unwrap())];
    assert_no_allocation("pendulum with a constraint", &mut constrained, &from, 1e-2, only);
}

/// A chain of bodies with a loop over the ground, a motor, a spring and a load.
#[test]
fn no_step_of_joined_bodies_allocates() {
    let mut model = Model::new().with_gravity([0.0, 0.0, -9.81]);
    let mut last = Part::Ground;
    for i in 0..8 {
        let x = f64::from(i);
        let next = model.body(Body::new(&format!("link {i}"), 1.0, [0.01, 0.1, 0.1]).at([x + 0.5, 0.0, 0.0]));
        let axis = ([0.0, 1.0, (1.7 * x).sin()], None);
        let hinge =
            model.join(&format!("hinge {i}"), Kind::Revolute, [last, next], [x, 0.0, 0.0], axis).unwrap();
        if i == 2 {
            let torque = Arc::new(Constant::new(0.3).unwrap());
            hinge.drive = Drive::Actuated(Actuator {
                torque,
                damping: 0.2,
                stiffness: 1.0,
                rest_angle: 0.1,
                controller: None,
            });
        }
        last = next;
    }
    // Not a ball: a straight chain holds its length by itself.
    model
        .join("end", Kind::Cylindrical, [Part::Ground, last], [8.0, 0.0, 0.0], ([1.0, 0.0, 0.0], None))
        .unwrap();
    let [from, to] = [Marker::new(Part::Ground, [2.0, 1.0, 1.0]), Marker::new(last, [0.1, 0.0, 0.0])];
    model.spring(Spring {
        name: "spring".into(),
        from,
        to,
        stiffness: 30.0,
        damping: 0.5,
        length: 1.0,
        directions: flexion::multibody::Directions::Line,
    });
    let mut system = Multibody::new(model).unwrap();
    let start = system.initial();
    let methods: Vec<Box<dyn Integrator>> = vec![
        Box::new(GeneralizedAlpha::chung_hulbert(0.5).unwrap()),
        Box::new(GeneralizedAlpha::chung_hulbert(0.5).unwrap().stabilized()),
        Box::new(Radau::new(Tolerance::uniform(1e-6)).unwrap()),
    ];
    assert_no_allocation("joined bodies", &mut system, &start, 1e-3, methods);
}

/// A beam without shear and one with it, hinged to each other, with loads along both and damping.
#[test]
fn no_step_of_beams_in_space_allocates() {
    let mut model = Model::new().with_gravity([0.0, 0.0, -9.81]);
    let along = Station {
        position: [0.0; 3].into(),
        tangent: [1.0, 0.0, 0.0].into(),
        normal: [0.0, 1.0, 0.0].into(),
    };
    let section = slender::Properties::principal([1e4, 20.0, 30.0, 40.0], 1.3, [0.02, 0.01, 0.01]);
    let first = slender::Beam::straight(along, 1.0, 4, section).unwrap();
    let section = Matrices::principal([1e4, 4e3, 3e3, 20.0, 30.0, 40.0], 1.3, [0.02, 0.01, 0.01]);
    let root = Frame { position: [1.0, 0.0, 0.0].into(), rotation: Mat3::IDENTITY };
    let second = shear::Beam::straight(root, 1.0, 3, section.with_mass_centre([0.02, 0.01])).unwrap();
    let beams = [
        Flexible::new("first", first).viscous(1e-4),
        Flexible::new("second", second).damped(0.2).viscous(1e-4),
    ];
    for (number, beam) in beams.into_iter().enumerate() {
        let beam = model.beam(beam);
        model.line_load(LineLoad {
            name: format!("load {number}"),
            beam,
            elements: None,
            distribution: None,
            force: [0.0, 1.0, 2.0].into(),
            axes: Axes::Follower,
            amplitude: None,
        });
        let law = Arc::new(LinearDrag { coefficient: 0.3 });
        model.line_law(LineLaw { name: format!("drag {number}"), beam, elements: None, law });
    }
    let section = |beam, node| Part::Section { beam, node };
    let axis = ([0.0, 1.0, 0.0], None);
    model.join("hinge", Kind::Revolute, [Part::Ground, section(0, 0)], [0.0; 3], axis).unwrap();
    model.join("elbow", Kind::Universal, [section(0, 4), section(1, 0)], [1.0, 0.0, 0.0], axis).unwrap();
    let mut system = Multibody::new(model).unwrap();
    let start = system.initial();
    let methods: Vec<Box<dyn Integrator>> = vec![
        Box::new(GeneralizedAlpha::chung_hulbert(0.5).unwrap()),
        Box::new(Radau::new(Tolerance::uniform(1e-6)).unwrap()),
    ];
    assert_no_allocation("beams in space", &mut system, &start, 1e-4, methods);
}

/// Two balls that fall, strike, bounce and slide, with a rod between them.
#[test]
fn no_nonsmooth_step_allocates() {
    let mut balls = multibody::BallsOnWall::new(0.5, [0.2, 0.3]);
    let mut from = balls.initial();
    let r = balls.radius;
    from.q = vec![0.0, r + 0.01, 0.0, balls.length, r + 0.01, 0.0];
    from.v = vec![1.0, -1.0, 0.0, 1.0, -1.0, 0.0];
    from.mode[..4].fill(Mode::Open);
    let all: Vec<Box<dyn Integrator>> = vec![
        Box::new(MoreauJean::new(0.5).unwrap()),
        Box::new(NonsmoothAlpha::decoupled(0.8).unwrap()),
        Box::new(NonsmoothAlpha::coupled(0.8).unwrap()),
    ];
    assert_no_allocation("two balls", &mut balls, &from, 2e-3, all);
}

/// A box that slides and comes down on its four corners: twelve rows with friction, six of which follow from the others.
#[test]
fn no_nonsmooth_step_of_a_box_on_its_corners_allocates() {
    let mut text = "
gravity = [0, 0, -9.81]
run = { duration = 1 }
integrator = { kind = 'moreau-jean', step = 0.001 }
[[body]]
name = 'box'
mass = 1
inertia = { kind = 'box', size = [0.3, 0.2, 0.1] }
position = [0, 0, 0.0501]
velocity = [0.5, 0.2, -0.1]
"
    .to_owned();
    for (i, [x, y]) in [[0.15, 0.1], [0.15, -0.1], [-0.15, 0.1], [-0.15, -0.1]].iter().enumerate() {
        text += &format!(
            "[[contact]]\nname = 'c{i}'\non = 'box'\nat = [{x}, {y}, 1e-4]\nobstacle = {{ kind = 'plane', normal = [0, 0, 1] }}\n\
             law = {{ kind = 'constraint', restitution = 0.5, friction = 0.3 }}\n"
        );
    }
    let reading = parse(text, std::path::Path::new("case.toml"), &[]).unwrap();
    let mut live = reading.build().unwrap();
    let from = live.system.initial();
    let all: Vec<Box<dyn Integrator>> = vec![
        Box::new(MoreauJean::new(0.5).unwrap()),
        Box::new(NonsmoothAlpha::decoupled(0.8).unwrap()),
        Box::new(NonsmoothAlpha::coupled(0.8).unwrap()),
    ];
    assert_no_allocation("a box", live.system.as_mut(), &from, 2e-3, all);
}

/// Every coupling on every basis it can use, uniform and graded, bands and dense matrices.
#[test]
fn no_step_of_a_hub_and_beam_allocates() {
    let elements = "basis={kind='finite-elements',elements=8}";
    let quadratic = "basis={kind='finite-elements',elements=2,axial-degree=2}";
    let modes = "basis={kind='modes',axial=3,transverse=3}";
    let radial = "basis={kind='radial',nodes=7}";
    let polynomial = "basis={kind='polynomial',nodes=9}";
    let splines = "basis={kind='b-spline',elements=6,degree=3}";
    let bezier = "basis={kind='bezier',elements=2,degree=4}";
    let mixed = "basis={kind='mixed',axial={kind='radial',nodes=7},transverse={kind='modes',count=2}}";
    let linear = [elements, quadratic, modes, radial, polynomial, splines, bezier, mixed];
    let many = "basis={kind='finite-elements',elements=20}";
    let high = [many, quadratic, modes, radial, polynomial, splines, bezier, mixed];
    let couplings: [(&str, &[&str]); 4] = [
        ("zeroth", &linear),
        ("first", &linear),
        ("high", &high),
        ("exact", &[elements, "basis.elements=2"]),
    ];
    for folder in ["p1_spin_up_4", "p3_spin_up"] {
        for (coupling, bases) in couplings {
            for basis in bases {
                let rotary = "section.rotary-inertia=true";
                // It rotates from the start, so that the steps have something to do.
                let motion = "hub.motion={kind='constant',speed='40 rad/s'}";
                let overrides = [&format!("model.coupling={coupling}"), *basis, motion, rotary];
                let what = format!("{folder} {overrides:?}");
                let mut live = run::case(folder, &overrides).unwrap().build().unwrap();
                let from = live.system.initial();
                assert_no_allocation(&what, live.system.as_mut(), &from, 5e-7, integrators());
                let free = "hub.motion={kind='free',speed='40 rad/s',damping=1,stiffness=2,\
                            controller={kind='pd',proportional=3,derivative=1,target='1 rad'}}";
                let overrides =
                    [&format!("model.coupling={coupling}"), *basis, free, rotary, "hub.inertia=5"];
                let mut live = run::case(folder, &overrides).unwrap().build().unwrap();
                let from = live.system.initial();
                assert_no_allocation(
                    &format!("{what} free"),
                    live.system.as_mut(),
                    &from,
                    1e-6,
                    integrators(),
                );
            }
        }
    }
}

/// The result of a function, and the bytes that it allocates.
fn bytes<T>(f: impl FnOnce() -> T) -> (T, usize) {
    let before = BYTES.with(Cell::get);
    let result = f();
    (result, BYTES.with(Cell::get) - before)
}

/// The bits of states and records of ten steps.
fn steps(system: &mut dyn System) -> Vec<u64> {
    let integrator = Radau::new(Tolerance::uniform(1e-6)).unwrap();
    let mut from = system.initial();
    from.v.iter_mut().for_each(|v| *v += 1e-3);
    let mut integrator = integrator.start(system, &mut from, 1e-5).unwrap();
    let (mut to, mut row) = (from.clone(), vec![0.0; system.channels().len()]);
    let mut out = Vec::new();
    for _ in 0..10 {
        integrator.step(system, &from, Span::new(from.t, 1e-5), &mut to).unwrap();
        integrator.accept(&from, &to);
        system.record(&to, &mut row);
        out.extend([&to.q, &to.v, &to.a, &row].into_iter().flatten().map(|x| x.to_bits()));
        std::mem::swap(&mut from, &mut to);
    }
    out
}

/// A fork computes the same bytes as its original, whatever either has done before, and takes a tenth of the memory that a
/// system takes to build; less than all of it for a beam in space, which hardly has constants.
#[test]
fn a_fork_is_independent_and_shares_the_constants() {
    for coupling in ["zeroth", "first", "high", "exact", "space"] {
        let model = format!("model.coupling={coupling}");
        let free = "hub.motion={kind='free',speed='40 rad/s',damping=1,stiffness=2}";
        let loads = [
            "gravity=[0, -9.81]",
            "load=[{on='5 m',force=['0 N','2 N'],axes='follower'}]",
            "spring=[{kind='point',on='10 m',stiffness='20 N/m',to=['10 m','0 m']}]",
        ];
        let planar = [
            &model,
            "basis={kind='finite-elements',elements=40}",
            free,
            "hub.inertia=5",
            loads[0],
            loads[1],
            loads[2],
            "output.stations=['2 m', '4 m']",
            "output.section-forces=true",
        ];
        let blade = ["basis.elements=40", "hub.motion={kind='constant',speed='1 rad/s'}"];
        let case = match coupling {
            "space" => run::case("modes_blade_nrel_5mw", &blade).unwrap(),
            _ => run::case("p1_spin_up_4", &planar).unwrap(),
        };
        let (system, whole) = bytes(|| case.case.vibrating(true).unwrap().0);
        let (mut fork, own) = bytes(|| system.fork());
        let mut original = system;
        let expected = steps(&mut *original);
        fork.set(Parameter::Speed, 3.0).unwrap();
        assert_eq!(fork.set(Parameter::LoadFactor, 0.5), Ok(()));
        assert!(steps(&mut *fork) != expected, "{coupling}: the fork rotates steadily");
        assert!(steps(&mut *original) == expected, "{coupling}: the original does not");
        let (mut later, again) = bytes(|| original.fork());
        assert!(steps(&mut *later) == expected, "{coupling}: a fork of a system that has run");
        let share = if coupling == "space" { 1 } else { 9 };
        assert!(share * own.max(again) < whole, "{coupling}: {own} bytes of {whole}");
    }
}

/// The bytes of a beam of `n` elements in space, and the most that are held in a run of four steps, the system included.
fn of_a_run(n: usize) -> [usize; 2] {
    let held = || BYTES.with(Cell::get) - FREED.with(Cell::get);
    let before = held();
    let section = Properties::principal([1e6, 1e2, 1e2, 1e2], 1.0, [0.01; 3]);
    let root =
        Station { position: Vec3([0.0; 3]), tangent: Vec3([1.0, 0.0, 0.0]), normal: Vec3([0.0, 0.0, 1.0]) };
    let mut model = Model::new().with_gravity([0.0, 0.0, -9.81]);
    let beam = Beam::straight(root, 0.1 * n as f64, n, section).unwrap();
    let beam = model.beam(Flexible::new("beam", beam));
    let clamped = Part::Section { beam, node: 0 };
    model.join("clamp", Kind::Fixed, [Part::Ground, clamped], [0.0; 3], ([0.0, 0.0, 1.0], None)).unwrap();
    let mut system = Multibody::new(model).unwrap();
    let built = held() - before;
    struct Most<F: Fn() -> usize>(F, usize);
    impl<F: Fn() -> usize> Observer for Most<F> {
        fn sample(&mut self, _: &mut dyn System, _: &State, _: &Step) {
            self.1 = self.1.max((self.0)());
        }
    }
    let mut most = Most(held, 0);
    let method = GeneralizedAlpha::chung_hulbert(0.8).unwrap();
    let mut state = system.initial();
    let plan = Plan {
        end: 4e-3,
        step: Some(1e-3),
        longest_step: None,
        break_steps: 1,
        contact_step: None,
        sample: 1e-3,
    };
    assert_eq!(transient(&mut system, &method, &mut state, &plan, &mut most), Ending::Finished);
    [built, most.1 - before]
}

/// Twice the elements, twice the memory: that of an element. Some 170 bytes are velocities by which the method lets dampers act, for the balance of energy.
#[test]
fn an_element_in_space_takes_little_memory_of_a_run() {
    let [small, large] = [200, 400].map(of_a_run);
    let [built, run] = [0, 1].map(|i| (large[i] - small[i]) as f64 / 200.0);
    println!("an element: {built} bytes of the system, {run} in a run of generalized-alpha");
    assert!(run <= 4200.0, "{run} bytes an element, {built} of them in the system");
}

/// The counter itself counts.
#[test]
fn the_counter_sees_an_allocation() {
    let before = ALLOCATIONS.with(Cell::get);
    let boxed = std::hint::black_box(Box::new(1.0));
    assert!(ALLOCATIONS.with(Cell::get) > before && *boxed == 1.0);
}
