//! Impacts of beams against what is computed here from M and G, and two laws of the beam itself.
#![allow(missing_docs)]

use super::falling_pendulum::section;
use flexion::analysis::transient::{Ending, Observer, Plan, Step, transient};
use flexion::basis::{Field, Hermite, Modes};
use flexion::contact::{Bounds, Contact, Contacting, ImpactMap, Law, Obstacle, Plane, Points, Translation};
use flexion::drive::Actuator;
use flexion::hub_beam::{
    Coupling, Drive, ExactCoupling, Fields, Foreshortening, FreeHub, HighCoupling, Hub, HubBeam,
    LinearCoupling, Mount,
};
use flexion::integrator::{Radau, Tolerance};
use flexion::linalg::{Matrix, Vec3};
use flexion::profile::{Constant, Expression, Motion};
use flexion::system::{Dynamics, Mode, Observed, State, System, Weights};
use std::sync::Arc;

/// Numbers between −1 and 1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

fn free_hub(inertia: f64) -> Hub {
    let torque = Arc::new(Constant::new(0.0).unwrap());
    let actuator = Actuator { torque, damping: 0.0, stiffness: 0.0, rest_angle: 0.0, controller: None };
    Hub { radius: 0.0, inertia, drive: Drive::Free(FreeHub { angle: 0.0, speed: 0.0, actuator }) }
}

fn modes(count: usize) -> Fields {
    let basis = |field| Box::new(Modes::new(1.0, count, field).unwrap());
    Fields::new(1.0, basis(Field::Axial), basis(Field::Transverse), &[])
}

fn elements(count: usize) -> Fields {
    let basis = |field| Box::new(Hermite::new(1.0, count, field).unwrap());
    Fields::new(1.0, basis(Field::Axial), basis(Field::Transverse), &[])
}

fn with_plane<C: Coupling>(model: HubBeam<C>, plane: Plane, restitution: f64) -> Contacting<HubBeam<C>> {
    let law = Law::Constraint { restitution, friction: 0.0 };
    let obstacle: Arc<dyn Obstacle> = Arc::new(plane);
    Contacting::new(model, vec![Contact { name: "tip".into(), point: 0, obstacle, law }])
}

/// M of the velocities.
fn mass(system: &mut dyn Dynamics, s: &State) -> Vec<Vec<f64>> {
    let n = s.v.len();
    let mut matrix = Matrix::new(&system.structure(0));
    system.tangent(s, Weights::new(1.0, 0.0, 0.0), &mut matrix);
    (0..n).map(|i| (0..n).map(|j| matrix.get(i, j)).collect()).collect()
}

/// Solves A x = b by elimination with pivots in columns.
fn solve(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|i, j| a[*i][k].abs().total_cmp(&a[*j][k].abs())).unwrap();
        a.swap(k, pivot);
        b.swap(k, pivot);
        for i in k + 1..n {
            let factor = a[i][k] / a[k][k];
            for j in k..n {
                a[i][j] -= factor * a[k][j];
            }
            b[i] -= factor * b[k];
        }
    }
    for k in (0..n).rev() {
        b[k] = (b[k] - (k + 1..n).map(|j| a[k][j] * b[j]).sum::<f64>()) / a[k][k];
    }
    b
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// One impact of a model in a random state on a random plane that moves.
fn check<C: Coupling>(mut model: HubBeam<C>, random: &mut Random) {
    let mut s = Dynamics::initial(&model);
    s.q.iter_mut().for_each(|q| *q += 0.01 * random.next());
    s.v.iter_mut().for_each(|v| *v += random.next());
    let (n, e, wall) = (s.v.len(), 0.5 * (1.0 + random.next()), random.next());
    let motion = model.motion(0, &s);
    let (sin, cos) = (3.0 * random.next()).sin_cos();
    let closing = cos * motion.velocity[0] + sin * motion.velocity[1] - wall;
    // The wall comes along its normal, which points so that the point closes.
    let side = -closing.signum();
    let normal = [side * cos, side * sin, 0.0];
    let displacement = Arc::new(Expression::new(&format!("{:e}*t", side * wall), "t", 1.0).unwrap());
    let plane = Plane {
        point: motion.position,
        normal: Vec3(normal),
        motion: Some(Translation { direction: Vec3(normal), displacement }),
    };
    let mut system = with_plane(model, plane, e);
    let mut row = vec![0.0; n];
    let mut before = Dynamics::initial(&system);
    before.q.copy_from_slice(&s.q);
    before.v.copy_from_slice(&s.v);
    before.mode.fill(Mode::Open);
    system.jacobian(&before, &mut |_, velocities, entries| {
        velocities.iter().zip(entries).for_each(|(j, x)| row[*j] += x);
    });
    let m = mass(&mut system, &before);
    let image = solve(m.clone(), row.clone());
    let effective = 1.0 / dot(&row, &image);
    let speed = closing.abs();
    let (impulse, lost) = ((1.0 + e) * effective * speed, 0.5 * (1.0 - e * e) * effective * speed * speed);
    let mut after = before.clone();
    let bounds = Bounds { touching: 1e-12, ..Bounds::default() };
    let impact = ImpactMap::new(&system)
        .strike(&mut system, &mut after, &vec![0.0; n + before.lambda.len()], bounds)
        .unwrap();
    let [start, end] = [&before, &after].map(|s| system.energy(s).total());
    let size = start.abs() + end.abs() + lost;
    assert!((impact.impulses[0] - impulse).abs() <= 1e-11 * impulse, "{} {impulse}", impact.impulses[0]);
    assert!((impact.lost - lost).abs() <= 1e-11 * (lost + speed * impulse), "{} {lost}", impact.lost);
    assert!((impact.work - side * wall * impulse).abs() <= 1e-11 * (wall * impulse).abs(), "{}", impact.work);
    assert!((end - start - impact.work + impact.lost).abs() <= 1e-12 * size, "{start} {end} {impact:?}");
    // M (v⁺ − v⁻) = Gᵀ Λ and the velocities of the impact.
    let change: Vec<f64> = after.v.iter().zip(&before.v).map(|(a, b)| a - b).collect();
    let largest = row.iter().fold(0.0_f64, |m, x| m.max(x.abs())) * impulse;
    for (m, g) in m.iter().zip(&row) {
        assert!((dot(m, &change) - g * impulse).abs() <= 1e-11 * largest);
    }
    let rate = dot(&row, &after.v) - side * wall;
    assert!((rate - e * speed).abs() <= 1e-11 * speed, "{rate} {e} {speed}");
}

/// Impulse, loss, work of a moving wall, momentum and energy with M⁻¹ computed here; Newton's law of restitution.
#[test]
fn impacts_are_those_of_the_mass_matrix_for_every_coupling() {
    let section = section();
    let point = [(1.0, Mount::Ground)];
    let mut random = Random(1);
    for count in 1..=6 {
        for kept in [Foreshortening::None, Foreshortening::First] {
            for fields in [modes(count), elements(count)] {
                let hub = free_hub(2.0);
                let coupling = LinearCoupling::new(fields, &section, &hub, kept);
                check(HubBeam::new(hub, coupling, &[]).with_contact_points(&point), &mut random);
            }
        }
        let hub = free_hub(0.0);
        let coupling = HighCoupling::new(modes(count), &section, &hub).unwrap();
        check(HubBeam::new(hub, coupling, &[]).with_contact_points(&point), &mut random);
        let hub = free_hub(0.0);
        let coupling = ExactCoupling::new(1.0, count, &section, &hub).unwrap();
        check(HubBeam::new(hub, coupling, &[]).with_contact_points(&point), &mut random);
    }
}

/// ρAL/(4N): ∫φᵢφⱼ = L δᵢⱼ and φᵢ(L) = 2 for the modes of a clamped–free beam. The mass that e acts on falls with N.
#[test]
fn the_effective_mass_of_the_tip_falls_with_the_number_of_modes() {
    for count in 1..=9 {
        let still = Arc::new(Constant::new(0.0).unwrap());
        let hub = Hub { radius: 0.0, inertia: 0.0, drive: Drive::Prescribed(Motion::Angle(still)) };
        let coupling = LinearCoupling::new(modes(count), &section(), &hub, Foreshortening::None);
        let model = HubBeam::new(hub, coupling, &[]).with_contact_points(&[(1.0, Mount::Ground)]);
        let plane = Plane { point: Vec3([0.0; 3]), normal: Vec3([0.0, 1.0, 0.0]), motion: None };
        let mut system = with_plane(model, plane, 0.0);
        let s = Dynamics::initial(&system);
        let found = ImpactMap::new(&system).masses(&mut system, &s).unwrap()[0];
        let expected = 2766.7 * 3.14e-4 / (4.0 * count as f64);
        assert!((found / expected - 1.0).abs() < 1e-11, "{count}: {found} {expected}");
    }
}

/// Σ J √t and Σ t over the samples from half of the time on, and J at the last one: J is the change of the angular momentum
/// of the hinge, on an arm of 1 m.
#[derive(Default)]
struct Impulse {
    before: Option<f64>,
    sums: [f64; 2],
    last: f64,
}

impl Observer for Impulse {
    fn sample(&mut self, system: &mut dyn System, state: &State, _: &Step) {
        let momentum = dot(&mass(system, state)[state.v.len() - 1], &state.v);
        self.last = momentum - *self.before.get_or_insert(momentum);
        if state.t > 5e-5 {
            self.sums = [self.sums[0] + self.last * state.t.sqrt(), self.sums[1] + state.t];
        }
    }
}

/// A beam that swings rigidly about its hinge meets a stop that holds its tip: until its other end is reached, the beam is
/// a semi-infinite one whose end is brought from V to rest. With the similarity solution of EI w⁗ + ρA ẅ = 0 for a step of
/// the end's velocity, J(t) = V EI^¼ (ρA)^¾ √(2t/π). The wave is 5 cm long at the end, 0.1 ms: of 16 elements the one at
/// the tip is 2 cm long, and each is 1.15 times as long as its neighbour. J rises in micro-impacts, by some percent of it
/// each, so that single values scatter, with other ratios by up to 4 %: √t is fitted to the second half too.
#[test]
fn a_stop_that_is_held_begins_with_the_root_of_time() {
    let (speed, time, start) = (0.1, 1e-4, 1e-9);
    let equal = |count: u32| (0..=count).map(|k| f64::from(k) / f64::from(count)).collect::<Vec<f64>>();
    let graded = |ratio: f64| -> Vec<f64> {
        (0..=16).map(|k| 1.0 - (ratio.powi(16 - k) - 1.0) / (ratio.powi(16) - 1.0)).collect()
    };
    for cells in [graded(1.15), equal(32), equal(64)] {
        let (count, hub) = (cells.len() - 1, free_hub(0.0));
        let basis = |field| Box::new(Hermite::on(cells.clone(), field).unwrap());
        let fields = Fields::new(1.0, basis(Field::Axial), basis(Field::Transverse), &[]);
        let coupling = LinearCoupling::new(fields, &section(), &hub, Foreshortening::None);
        let model = HubBeam::new(hub, coupling, &[]).with_contact_points(&[(1.0, Mount::Ground)]);
        let plane = Plane { point: Vec3([0.0; 3]), normal: Vec3([0.0, 1.0, 0.0]), motion: None };
        let mut system = with_plane(model, plane, 0.0);
        let mut s = Dynamics::initial(&system);
        let n = s.v.len();
        (s.q[n - 1], s.v[n - 1]) = (speed * start, -speed);
        let method = Radau::new(Tolerance::uniform(1e-10)).unwrap();
        let plan = Plan::new(start + time, 1e-6);
        let mut impulse = Impulse::default();
        assert_eq!(transient(&mut system, &method, &mut s, &plan, &mut impulse), Ending::Finished);
        let (ei, mass) = (6.8952e10_f64 * 7.85e-9, 2766.7_f64 * 3.14e-4);
        let expected = speed * ei.powf(0.25) * mass.powf(0.75) * (2.0 / std::f64::consts::PI).sqrt();
        let fitted = impulse.sums[0] / impulse.sums[1] / expected - 1.0;
        let last = impulse.last / time.sqrt() / expected - 1.0;
        assert!(fitted.abs() < 0.01 && last.abs() < 0.01, "{count}: {fitted} {last}");
    }
}
