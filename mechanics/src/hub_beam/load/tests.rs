//! Loads against virtual work, potentials and finite differences.

use super::*;
use crate::hub_beam::tests::{
    LENGTH, RADIUS, TwoFibres, at, check_power, check_tangent, fibre, free_hub, hub, inertia_forces,
    relative, residual, state, without_strain,
};
use crate::hub_beam::{
    Beam, Coupling, Damping, ExactCoupling, Foreshortening, HighCoupling, Hub, HubBeam, LinearCoupling, Mass,
    Placement, Station,
};
use crate::law::{ForceLaw, LinearDrag, Place, Response};
use crate::linalg::Vec3;
use crate::profile::Expression;
use crate::system::{Observed, System};
use std::sync::Arc;

const FORCE: [f64; 2] = [-3.0, 5.0];
/// A station inside the second of three cells, which it cuts.
const STATION: f64 = 0.45 * LENGTH;

fn profile(text: &str) -> Amplitude {
    Some(Arc::new(Expression::new(text, "t", 10.0).unwrap()))
}

fn force(axes: Axes, station: f64) -> Force {
    Force { station, force: FORCE, axes, amplitude: profile("1 + t^2") }
}

fn distributed(axes: Axes) -> DistributedForce {
    DistributedForce {
        force: FORCE,
        axes,
        distribution: profile("1 + 0.5*t"),
        range: (0.2 * LENGTH, STATION),
        amplitude: None,
    }
}

const SPRING: Spring = Spring { station: STATION, stiffness: 40.0, damping: 0.0, anchor: [1.3, -0.7] };
const GRAVITY: Gravity = Gravity { acceleration: 9.81, direction: -1.2 };
const AXES: [Axes; 3] = [Axes::Dead, Axes::Hub, Axes::Follower];

/// A law that depends on all that it may depend on.
#[derive(Debug)]
struct Swirl;

impl ForceLaw for Swirl {
    fn response(&self, place: &Place) -> Response {
        let ([x, y, _], [u, v, _], f) = (place.position, place.velocity, 1.0 + place.time);
        Response {
            force: [f * (x * v - y), f * (x * x - u * v), 0.0],
            by_position: [[f * v, -f, 0.0], [2.0 * f * x, 0.0, 0.0], [0.0; 3]],
            by_velocity: [[0.0, f * x, 0.0], [-f * v, -f * u, 0.0], [0.0; 3]],
        }
    }
}

fn laws() -> [Arc<dyn ForceLaw>; 2] {
    [Arc::new(LinearDrag { coefficient: 0.8 }), Arc::new(Swirl)]
}

/// One load of each kind and axes.
fn loads() -> Vec<Box<dyn Load>> {
    let mut loads: Vec<Box<dyn Load>> = vec![
        Box::new(GRAVITY),
        Box::new(Couple { station: STATION, couple: 2.0, amplitude: profile("cos(t)") }),
        Box::new(SPRING),
        Box::new(Spring { station: LENGTH, anchor: [0.0, 0.0], ..SPRING }),
        Box::new(Spring { damping: 3.0, ..SPRING }),
    ];
    for law in laws() {
        loads.push(Box::new(LineLaw { law, range: (0.2 * LENGTH, STATION) }));
    }
    for axes in AXES {
        loads.push(Box::new(force(axes, LENGTH)));
        loads.push(Box::new(force(axes, STATION)));
        loads.push(Box::new(distributed(axes)));
    }
    loads
}

const MASSES: [Mass; 2] =
    [Mass { station: STATION, mass: 0.7, inertia: 0.02 }, Mass { station: LENGTH, mass: 0.4, inertia: 0.05 }];

fn beam(masses: &[Mass]) -> Beam<'static> {
    Beam::new(&TwoFibres, masses.to_vec(), &distributed(Axes::Dead).stations())
}

fn linear(hub: Hub, beam: &Beam<'_>, foreshortening: Foreshortening) -> HubBeam<LinearCoupling> {
    let axial = Box::new(crate::basis::Lagrange::new(LENGTH, 3, 2).unwrap());
    let transverse =
        Box::new(crate::basis::Hermite::new(LENGTH, 3, crate::basis::Field::Transverse).unwrap());
    let fields = crate::hub_beam::Fields::new(LENGTH, axial, transverse, &beam.breaks);
    let coupling = LinearCoupling::new(fields, beam, &hub, foreshortening);
    HubBeam::new(hub, coupling, &[])
}

fn high(hub: Hub, beam: &Beam<'_>, elements: usize) -> HubBeam<HighCoupling> {
    let axial = Box::new(crate::basis::Lagrange::new(LENGTH, elements, 1).unwrap());
    let transverse =
        Box::new(crate::basis::Hermite::new(LENGTH, elements, crate::basis::Field::Transverse).unwrap());
    let fields = crate::hub_beam::Fields::new(LENGTH, axial, transverse, &beam.breaks);
    let coupling = HighCoupling::new(fields, beam, &hub).unwrap();
    HubBeam::new(hub, coupling, &[])
}

fn exact(hub: Hub, beam: &Beam<'_>) -> HubBeam<ExactCoupling> {
    let coupling = ExactCoupling::new(LENGTH, 3, beam, &hub).unwrap();
    HubBeam::new(hub, coupling, &[])
}

/// Every coupling on both hubs, with the given loads, masses and damping.
fn systems(loads: &[&dyn Load], masses: &[Mass], damping: Damping) -> Vec<Box<dyn System>> {
    let beam = beam(masses);
    let mut systems: Vec<Box<dyn System>> = Vec::new();
    for hub in [hub(), free_hub()] {
        for foreshortening in [Foreshortening::None, Foreshortening::First] {
            let system = linear(hub.clone(), &beam, foreshortening);
            systems.push(Box::new(system.with_loads(&beam, loads).with_damping(damping)));
        }
        let system = high(hub.clone(), &beam, 3);
        systems.push(Box::new(system.with_loads(&beam, loads).with_damping(damping)));
        let system = exact(hub, &beam);
        systems.push(Box::new(system.with_loads(&beam, loads).with_damping(damping)));
    }
    systems
}

#[test]
fn tangents_of_every_load_equal_finite_differences() {
    for load in loads() {
        for mut system in systems(&[&*load], &[], Damping::default()) {
            let s = state(&*system, 0.15);
            check_tangent(&mut *system, &s);
        }
        // The band matrices of a load are added to a full one.
        let beam = beam(&MASSES);
        for hub in [hub(), free_hub()] {
            let mut system = high(hub, &beam, 12).with_loads(&beam, &[&*load]);
            let s = state(&system, 0.15);
            check_tangent(&mut system, &s);
        }
    }
}

#[test]
fn tangents_of_masses_and_damping_equal_finite_differences() {
    let damped = Damping { mass: 0.3, stiffness: 0.02 };
    for (masses, damping) in [(&MASSES[..], Damping::default()), (&[], damped), (&MASSES, damped)] {
        for mut system in systems(&[&GRAVITY], masses, damping) {
            let s = state(&*system, 0.15);
            check_tangent(&mut *system, &s);
        }
    }
}

#[test]
fn a_stamped_tangent_is_never_taken_for_another() {
    // The same matrix at other times, angles and weights: it is written again.
    let damping = Damping { mass: 0.3, stiffness: 0.02 };
    for load in loads() {
        let build = || systems(&[&*load], &[], damping);
        for (mut kept, mut fresh) in build().into_iter().zip(build()) {
            let mut matrix = crate::linalg::Matrix::new(&kept.structure(0));
            for (t, w) in [(0.2, (1.0, 0.5, 0.2)), (0.7, (1.0, 0.5, 0.2)), (0.7, (1.0, 0.4, 0.2))] {
                let s = State { t, ..state(&*kept, 0.1) };
                let w = Weights::new(w.0, w.1, w.2);
                kept.tangent(&s, w, &mut matrix);
                let mut other = crate::linalg::Matrix::new(&fresh.structure(0));
                fresh.tangent(&s, w, &mut other);
                let n = matrix.order();
                let all = (0..n * n).map(|k| (k / n, k % n));
                assert!(all.clone().all(|(i, j)| matrix.get(i, j) == other.get(i, j)), "{load:?}");
            }
        }
    }
}

#[test]
fn energy_changes_by_the_power_of_loads_drives_and_dampers() {
    let damping = Damping { mass: 0.3, stiffness: 0.02 };
    for load in loads() {
        for mut system in systems(&[&*load], &MASSES, damping) {
            check_power(&mut *system);
        }
    }
}

/// Placement at `x` of the beam with unknowns `q`.
fn placement<C: Coupling>(coupling: &C, q: &[f64], x: f64) -> Placement {
    let mut out = [Placement::default()];
    let s = State { q: q.to_vec(), v: vec![0.0; q.len()], a: vec![0.0; q.len()], ..State::default() };
    coupling.placements(&s, &[Station::new(coupling.fields(), x)], &mut out);
    out[0]
}

/// Σ F·∂r/∂q and torque of forces at stations, by finite differences of nothing but placements.
fn virtual_work<C: Coupling>(
    coupling: &C,
    q: &[f64],
    angle: f64,
    axes: Axes,
    shares: &[(f64, f64)],
) -> (Vec<f64>, f64) {
    let (mut forces, mut torque) = (vec![0.0; q.len()], 0.0);
    for &(x, share) in shares {
        let here = placement(coupling, q, x);
        let turn = match axes {
            Axes::Dead => -angle,
            Axes::Hub => 0.0,
            Axes::Follower => here.rotation,
        };
        let (sin, cos) = turn.sin_cos();
        let f = [FORCE[0] * cos - FORCE[1] * sin, FORCE[0] * sin + FORCE[1] * cos].map(|f| share * f);
        torque += (RADIUS + x + here.axial) * f[1] - here.deflection * f[0];
        for (k, force) in forces.iter_mut().enumerate() {
            let h = 1e-3;
            for (c, by) in [(1.0, -2.0), (-8.0, -1.0), (8.0, 1.0), (-1.0, 2.0)] {
                let mut moved = q.to_vec();
                moved[k] += by * h;
                let p = placement(coupling, &moved, x);
                *force += c * (f[0] * p.axial + f[1] * p.deflection) / (12.0 * h);
            }
        }
    }
    (forces, torque)
}

/// Forces and torque that `load` adds to a system.
fn added<C: Coupling>(
    build: &dyn Fn() -> HubBeam<C>,
    beam: &Beam<'_>,
    load: &dyn Load,
    s: &State,
) -> (Vec<f64>, f64) {
    let (mut without, mut with) = (build(), build().with_loads(beam, &[load]));
    let r = residual(&mut without, s);
    let forces = r.iter().zip(residual(&mut with, s)).map(|(a, b)| a - b).collect();
    (forces, without.torque(s) - with.torque(s))
}

/// The shares of a force per length, by Gauss's rule of its range.
fn shares(load: &DistributedForce, cells: &[f64]) -> Vec<(f64, f64)> {
    let gauss = crate::quadrature::Gauss::new(8);
    let mut shares = Vec::new();
    for ends in cells.windows(2).filter(|c| c[0] >= load.range.0 && c[1] <= load.range.1) {
        shares.extend(gauss.on(ends[0], ends[1]).map(|(x, w)| (x, w * (1.0 + 0.5 * x))));
    }
    shares
}

#[test]
fn the_energy_of_a_spring_is_half_its_stiffness_times_its_length_squared() {
    let beam = beam(&[]);
    let (mut without, mut with) = (exact(hub(), &beam), exact(hub(), &beam).with_loads(&beam, &[&SPRING]));
    let s = state(&without, 0.15);
    let (sin, cos) = at(&without, s.t).angle.sin_cos();
    let p = placement(without.coupling(), &s.q, STATION);
    let (x, y) = (RADIUS + STATION + p.axial, p.deflection);
    let length = [x * cos - y * sin - SPRING.anchor[0], x * sin + y * cos - SPRING.anchor[1]];
    let expected = 0.5 * SPRING.stiffness * (length[0].powi(2) + length[1].powi(2));
    let found = with.energy(&s).strain - without.energy(&s).strain;
    assert!((found / expected - 1.0).abs() < 1e-10, "{found} for {expected}");
    // Force and torque on the undeformed beam: −k (r − A), seen from the hub.
    let forces = added(&|| exact(hub(), &beam), &beam, &SPRING, &s).1;
    let torque =
        SPRING.stiffness * ((x * cos - y * sin) * SPRING.anchor[1] - (x * sin + y * cos) * SPRING.anchor[0]);
    assert!((forces / torque - 1.0).abs() < 1e-10, "{forces} for {torque}");
}

#[test]
fn forces_and_torque_are_those_of_virtual_work_at_large_rotations() {
    let beam = beam(&[]);
    let build = || exact(hub(), &beam);
    let system = build();
    let s = state(&system, 0.15);
    let angle = at(&system, s.t).angle;
    for axes in AXES {
        let factor = 1.0 + s.t * s.t;
        for station in [STATION, LENGTH] {
            let expected = virtual_work(system.coupling(), &s.q, angle, axes, &[(station, factor)]);
            let found = added(&build, &beam, &force(axes, station), &s);
            assert!(relative(&found.0, &expected.0) < 1e-8, "{axes:?}");
            assert!((found.1 - expected.1).abs() < 1e-9 * expected.1.abs(), "{axes:?}");
        }
        let load = distributed(axes);
        let expected = virtual_work(
            system.coupling(),
            &s.q,
            angle,
            axes,
            &shares(&load, system.coupling().fields().cells()),
        );
        let found = added(&build, &beam, &load, &s);
        // The direction of a follower is no polynomial: its quadrature has fewer points than the check's.
        let tolerance = if axes == Axes::Follower { 1e-4 } else { 1e-8 };
        assert!(relative(&found.0, &expected.0) < tolerance, "{axes:?} {}", relative(&found.0, &expected.0));
        assert!((found.1 - expected.1).abs() < tolerance * expected.1.abs(), "{axes:?}");
    }
}

#[test]
fn a_force_that_is_drawn_does_the_work_of_its_load() {
    let beam = beam(&[]);
    let build = || exact(hub(), &beam);
    for axes in AXES {
        let load = force(axes, STATION);
        let mut system = build().with_loads(&beam, &[&load]);
        let s = state(&system, 0.15);
        let drawn = system.point_forces(&s)[0].clone();
        // The place is linear in the coordinates of this coupling: the difference has errors of rounding alone.
        let step = 1e-3;
        let mut place = |i: usize, by: f64| {
            let mut moved = s.clone();
            moved.q[i] += by;
            system.point_forces(&moved)[0].place
        };
        let work = |i: usize| drawn.force.dot(place(i, step) - place(i, -step)) / (2.0 * step);
        let expected: Vec<f64> = (0..s.q.len()).map(work).collect();
        let (forces, torque) = added(&build, &beam, &load, &s);
        assert!(relative(&expected, &forces) < 1e-9, "{axes:?}: {expected:?} {forces:?}");
        let moment = drawn.place.cross(drawn.force)[2];
        assert!((moment / torque - 1.0).abs() < 1e-9, "{axes:?}: {moment} {torque}");
    }
}

/// By Simpson's rule over the places at which it is drawn, three within an element: its error, by the bending of the element, is 7e-5 of loads that
/// keep their direction, and 4e-4 of one that follows a section.
#[test]
fn a_force_per_length_that_is_drawn_does_the_work_of_its_load() {
    let beam = beam(&[]);
    let build = || exact(hub(), &beam);
    for axes in AXES {
        let from = LENGTH / 3.0;
        let load =
            DistributedForce { amplitude: profile("1 + t^2"), range: (from, STATION), ..distributed(axes) };
        let point = force(axes, LENGTH);
        let mut system = build().with_loads(&beam, &[&point, &load]);
        let s = state(&system, 0.05);
        let all = system.line_forces(&s);
        assert_eq!((all.len(), all[0].points.len()), (1, 3));
        let drawn = all[0].points.clone();
        let third = (STATION - from) / 6.0;
        let forces = drawn.iter().zip([1.0, 4.0, 1.0]).map(|([_, f], weight)| weight * third * *f);
        let forces: Vec<Vec3> = forces.collect();
        let step = 1e-3;
        let mut places = |i: usize, by: f64| {
            let mut moved = s.clone();
            moved.q[i] += by;
            system.line_forces(&moved)[0].points.iter().map(|[place, _]| *place).collect::<Vec<_>>()
        };
        let mut work = |i: usize| {
            let [after, before] = [step, -step].map(|by| places(i, by));
            let moved = after.iter().zip(&before).map(|(a, b)| (0.5 / step) * (*a - *b));
            moved.zip(&forces).map(|(by, f)| f.dot(by)).sum::<f64>()
        };
        let expected: Vec<f64> = (0..s.q.len()).map(&mut work).collect();
        let (found, torque) = added(&build, &beam, &load, &s);
        let error = relative(&expected, &found);
        assert!(error < 1e-3, "{axes:?}: {error} of {expected:?} {found:?}");
        let moment: f64 = drawn.iter().zip(&forces).map(|([place, _], f)| place.cross(*f)[2]).sum();
        assert!((moment / torque - 1.0).abs() < 1e-3, "{axes:?}: {moment} {torque}");
    }
}

#[test]
fn a_couple_that_is_drawn_turns_as_its_section_does() {
    let beam = beam(&[]);
    let load = Couple { station: STATION, couple: -4.0, amplitude: profile("1 + t^2") };
    let mut system = exact(hub(), &beam).with_loads(&beam, &[&load]);
    let s = state(&system, 0.15);
    let drawn = system.point_forces(&s);
    let mut frame = [crate::system::Frame::default()];
    system.frames(0, &s, &[STATION], &mut frame);
    assert_eq!((drawn[0].place, drawn[0].force), (frame[0].position, Default::default()));
    assert_eq!(drawn[0].moment.0, [0.0, 0.0, -4.0 * (1.0 + s.t * s.t)]);
}

#[test]
fn linear_couplings_have_the_linearised_forces_of_virtual_work() {
    let beam = beam(&[]);
    for foreshortening in [Foreshortening::None, Foreshortening::First] {
        let build = || linear(hub(), &beam, foreshortening);
        let system = build();
        let angle = at(&system, 0.6).angle;
        let cells = system.coupling().fields().cells().to_vec();
        for axes in AXES {
            let spread = distributed(axes);
            let point = force(axes, STATION);
            type Shares = Vec<(f64, f64)>;
            let list: [(&dyn Load, Shares); 2] =
                [(&spread, shares(&spread, &cells)), (&point, vec![(STATION, 1.36)])];
            for (load, shares) in list {
                // The odd part is the linear one, to second order in the size.
                let size = 1e-4;
                let both = [1.0, -1.0].map(|sign| {
                    let s = state(&system, sign * size);
                    (
                        virtual_work(system.coupling(), &s.q, angle, axes, &shares),
                        added(&build, &beam, load, &s),
                    )
                });
                let odd = |a: &[f64], b: &[f64]| -> Vec<f64> {
                    a.iter().zip(b).map(|(a, b)| (a - b) / (2.0 * size)).collect()
                };
                let expected = odd(&both[0].0.0, &both[1].0.0);
                let found = odd(&both[0].1.0, &both[1].1.0);
                let largest = expected.iter().fold(0.0f64, |m, x| m.max(x.abs()));
                let error = found.iter().zip(&expected).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
                assert!(error <= 1e-6 * largest.max(1.0), "{axes:?} {foreshortening:?}: {error:e} {largest}");
                let torque = (both[0].0.1 - both[1].0.1, both[0].1.1 - both[1].1.1);
                assert!((torque.0 - torque.1).abs() < 1e-6 * torque.0.abs(), "{axes:?} {torque:?}");
                // The even part at rest.
                let zero = state(&system, 0.0);
                let expected = virtual_work(system.coupling(), &zero.q, angle, axes, &shares);
                let found = added(&build, &beam, load, &zero);
                assert!(relative(&found.0, &expected.0) < 1e-8);
                assert!((found.1 - expected.1).abs() < 1e-9 * expected.1.abs());
            }
        }
    }
}

/// V of the fibres and masses of a beam, written particle by particle.
fn potential<C: Coupling>(coupling: &C, q: &[f64], angle: f64, masses: &[Mass]) -> f64 {
    let (sin, cos) = (GRAVITY.direction - angle).sin_cos();
    let mut sum = 0.0;
    let mut particle = |x: f64, y: f64, m: f64| {
        let p = fibre(&placement(coupling, q, x), x, y);
        sum -= m * GRAVITY.acceleration * (p[0] * cos + p[1] * sin);
    };
    for ends in coupling.fields().cells().windows(2) {
        for (x, w) in coupling.fields().gauss().on(ends[0], ends[1]) {
            for (y, m, _) in TwoFibres::fibres(x) {
                particle(x, y, w * m);
            }
        }
    }
    for m in masses {
        particle(m.station, 0.0, m.mass);
    }
    sum
}

/// −∂V/∂q and −∂V/∂θ by finite differences.
fn gradient<C: Coupling>(coupling: &C, q: &[f64], angle: f64, masses: &[Mass]) -> (Vec<f64>, f64) {
    let h = 1e-3;
    let along = |f: &dyn Fn(f64) -> f64| -(f(-2.0 * h) - 8.0 * f(-h) + 8.0 * f(h) - f(2.0 * h)) / (12.0 * h);
    let forces = (0..q.len())
        .map(|k| {
            along(&|d| {
                let mut moved = q.to_vec();
                moved[k] += d;
                potential(coupling, &moved, angle, masses)
            })
        })
        .collect();
    (forces, along(&|d| potential(coupling, q, angle + d, masses)))
}

#[test]
fn gravity_is_the_gradient_of_the_height_of_all_particles() {
    let beam = beam(&MASSES);
    let build = || exact(hub(), &beam);
    let system = build();
    let s = state(&system, 0.15);
    let angle = at(&system, s.t).angle;
    let expected = gradient(system.coupling(), &s.q, angle, &MASSES);
    let found = added(&build, &beam, &GRAVITY, &s);
    assert!(relative(&found.0, &expected.0) < 1e-8, "{}", relative(&found.0, &expected.0));
    assert!((found.1 - expected.1).abs() < 1e-8 * expected.1.abs());
    let energy = build().with_loads(&beam, &[&GRAVITY]).energy(&s).gravity;
    let expected = potential(system.coupling(), &s.q, angle, &MASSES);
    assert!((energy - expected).abs() < 1e-12 * expected.abs(), "{energy} {expected}");

    for foreshortening in [Foreshortening::None, Foreshortening::First] {
        let build = || linear(hub(), &beam, foreshortening);
        let system = build();
        let size = 1e-4;
        let both = [1.0, -1.0].map(|sign| {
            let s = state(&system, sign * size);
            (gradient(system.coupling(), &s.q, angle, &MASSES), added(&build, &beam, &GRAVITY, &s))
        });
        let odd = |a: &[f64], b: &[f64]| -> Vec<f64> {
            a.iter().zip(b).map(|(a, b)| (a - b) / (2.0 * size)).collect()
        };
        let expected = odd(&both[0].0.0, &both[1].0.0);
        let found = odd(&both[0].1.0, &both[1].1.0);
        let error = relative(&found, &expected);
        assert!(error < 1e-5, "{foreshortening:?}: {error:e}");
        let even =
            |a: &[f64], b: &[f64]| -> Vec<f64> { a.iter().zip(b).map(|(a, b)| 0.5 * (a + b)).collect() };
        let error = relative(&even(&both[0].1.0, &both[1].1.0), &even(&both[0].0.0, &both[1].0.0));
        assert!(error < 1e-6, "{foreshortening:?}: {error:e}");
        let torque = (both[0].0.1 - both[1].0.1, both[0].1.1 - both[1].1.1);
        assert!((torque.0 - torque.1).abs() < 1e-6 * torque.0.abs(), "{torque:?}");
    }
}

#[test]
fn masses_obey_dalembert() {
    let beam = beam(&MASSES);
    let mut system = exact(hub(), &beam);
    let s = state(&system, 0.15);
    let kinematics = at(&system, s.t);
    let (forces, torque) = inertia_forces(system.coupling(), &s, &kinematics, &MASSES);
    // As without masses: the element's rule of three points against the check's eight.
    let error = relative(&without_strain(&mut system, &s), &forces);
    assert!(error < 2e-3, "forces {error:e}");
    assert!((system.torque(&s) / torque - 1.0).abs() < 2e-3);
    // The masses alone, free of that difference.
    let plain = self::beam(&[]);
    let mut bare = exact(hub(), &plain);
    let own: Vec<f64> =
        residual(&mut system, &s).iter().zip(residual(&mut bare, &s)).map(|(a, b)| a - b).collect();
    let (all, all_torque) = inertia_forces(system.coupling(), &s, &kinematics, &MASSES);
    let (none, none_torque) = inertia_forces(bare.coupling(), &s, &kinematics, &[]);
    let expected: Vec<f64> = all.iter().zip(&none).map(|(a, b)| a - b).collect();
    assert!(relative(&own, &expected) < 1e-6, "{:e}", relative(&own, &expected));
    let (own, expected) = (system.torque(&s) - bare.torque(&s), all_torque - none_torque);
    assert!((own / expected - 1.0).abs() < 1e-6, "{own} {expected}");

    for foreshortening in [Foreshortening::None, Foreshortening::First] {
        let mut system = linear(hub(), &beam, foreshortening);
        let size = 1e-3;
        let mut odd: [Vec<f64>; 2] = [vec![], vec![]];
        for sign in [1.0, -1.0] {
            let s = state(&system, sign * size);
            let expected = inertia_forces(system.coupling(), &s, &kinematics, &MASSES).0;
            let found = without_strain(&mut system, &s);
            for (odd, new) in odd.iter_mut().zip([expected, found]) {
                odd.resize(new.len(), 0.0);
                odd.iter_mut().zip(new).for_each(|(odd, x)| *odd += sign * x / (2.0 * size));
            }
        }
        let error = relative(&odd[1], &odd[0]);
        // Of second order in the size.
        assert!(error < 1e-5, "{foreshortening:?} {error:e}");
    }
}

#[test]
fn dissipation_is_that_of_the_rates_of_strain() {
    // From rest, U = ½ t² ėᵀSė + …: η ėᵀSė is the second derivative of the strain energy there.
    let beam = beam(&[]);
    let eta = 0.1;
    let mut system = exact(hub(), &beam).with_damping(Damping { mass: 0.0, stiffness: eta });
    let s = state(&system, 0.15);
    let mut energy = |t: f64| {
        let moved = State { q: s.v.iter().map(|v| t * v).collect(), ..s.clone() };
        system.energy(&moved).strain
    };
    let h = 1e-3;
    let second = (-energy(-2.0 * h) + 16.0 * energy(-h) - 30.0 * energy(0.0) + 16.0 * energy(h)
        - energy(2.0 * h))
        / (12.0 * h * h);
    let rest = State { q: vec![0.0; s.q.len()], ..s.clone() };
    let dissipated = system.power(&rest).dissipated;
    assert!((dissipated / (eta * second) - 1.0).abs() < 1e-8, "{dissipated} {second}");
}
