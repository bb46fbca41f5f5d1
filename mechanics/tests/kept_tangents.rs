//! Tangents that are kept from step to step, and carried along with the rotating sections.
#![allow(missing_docs, clippy::unwrap_used)]

use flexion::hub_beam::{Drive, ExactCoupling, Hub, HubBeam};
use flexion::integrator::{Counters, GeneralizedAlpha, Integrator, Radau, Span, Tolerance};
use flexion::linalg::Matrix;
use flexion::profile::{Motion, SpinUp};
use flexion::section::{Resultants, Uniform};
use flexion::system::{Corotation, Dynamics, State, System, Weights};
use std::sync::Arc;

const LENGTH: f64 = 10.0;
const ELEMENTS: usize = 6;

/// Wu and Haug's spin-up (1988, doi 10.1002/nme.1620260202): EA is 2e5 times EI/L².
fn beam() -> HubBeam<ExactCoupling> {
    let resultants =
        Resultants { mass: 1.2, axial_stiffness: 2.8e7, bending_stiffness: 1.4e4, ..Default::default() };
    let section = Uniform::from_resultants(resultants).unwrap();
    let profile = Arc::new(SpinUp::new(4.0, 15.0).unwrap());
    let drive = Drive::Prescribed(Motion::Speed { profile, initial_angle: 0.0 });
    let hub = Hub { radius: 0.0, inertia: 0.0, drive };
    let coupling = ExactCoupling::new(LENGTH, ELEMENTS, &section, &hub).unwrap();
    HubBeam::new(hub, coupling, &[])
}

fn stiffness(system: &mut dyn System, s: &State) -> Matrix {
    let mut out = Matrix::new(&system.structure(0));
    system.tangent(s, Weights::new(0.0, 0.0, 1.0), &mut out);
    out
}

/// The unknowns behind the root are U, U′, V, V′ of one node after another.
const ROOT: usize = 1;

/// A bent beam, and the same with everything behind the root turned about the hub by `angle`.
fn bent_and_turned(system: &dyn System, angle: f64) -> (State, State) {
    let mut bent = State::zeros(system.size(), 0.0);
    let mut turned = bent.clone();
    let (sin, cos) = angle.sin_cos();
    let turn = |(x, y): (f64, f64)| (cos * x - sin * y, sin * x + cos * y);
    for node in 1..=ELEMENTS {
        let (i, x) = (ROOT + 4 * (node - 1), LENGTH * node as f64 / ELEMENTS as f64);
        let (slope, bow) = (0.02 * x, 0.01 * x * x);
        let (u, du) = (-1e-4 * x * x, -2e-4 * x);
        bent.q[i..i + 4].copy_from_slice(&[u, du, bow, slope]);
        let (px, py) = turn((x + u, bow));
        let (tx, ty) = turn((1.0 + du, slope));
        turned.q[i..i + 4].copy_from_slice(&[px - x, tx - 1.0, py, ty]);
    }
    (bent, turned)
}

#[test]
fn stiffness_turns_with_a_beam_that_turns_as_a_whole() {
    let mut system = beam();
    let (bent, turned) = bent_and_turned(&system, 0.7);
    let before = stiffness(&mut system, &bent);
    let now = stiffness(&mut system, &turned);
    let mut rotation = Corotation::default();
    system.corotate(&bent, &turned, &mut rotation);
    let n = bent.q.len();
    // The first two nodes belong to the element at the root, which does not rotate.
    let free = ROOT + 4..n;
    let mut largest: f64 = 0.0;
    for j in free.clone() {
        let (mut unit, mut column, mut expected) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
        unit[j] = 1.0;
        now.multiply(&unit, &mut expected);
        rotation.rotate_back(&mut unit);
        before.multiply(&unit, &mut column);
        rotation.rotate(&mut column);
        for i in free.clone() {
            largest = largest.max(expected[i].abs());
            assert!(
                (column[i] - expected[i]).abs() < 1e-9 * 2.8e7,
                "({i}, {j}): {} {}",
                column[i],
                expected[i]
            );
        }
    }
    assert!(largest > 1e7, "the stretching stiffness is among the entries");
}

#[test]
fn turning_back_undoes_turning() {
    let system = beam();
    let (bent, turned) = bent_and_turned(&system, -1.2);
    let mut rotation = Corotation::default();
    system.corotate(&bent, &turned, &mut rotation);
    let x: Vec<f64> = (0..bent.q.len()).map(|i| (1.0 + i as f64).sin()).collect();
    let mut y = x.clone();
    rotation.rotate(&mut y);
    assert!(x.iter().zip(&y).any(|(x, y)| (x - y).abs() > 0.1));
    rotation.rotate_back(&mut y);
    assert!(x.iter().zip(&y).all(|(x, y)| (x - y).abs() < 1e-14));
}

/// Work of twelve seconds of the spin-up in equal steps of `h`.
fn work(integrator: impl Integrator, h: f64) -> Counters {
    let mut system = beam();
    let mut from = system.initial();
    let mut to = from.clone();
    let mut integrator = integrator.start(&mut system, &mut from, h).unwrap();
    for _ in 0..(12.0 / h).round() as usize {
        integrator.step(&mut system, &from, Span::new(from.t, h), &mut to).unwrap();
        integrator.accept(&from, &to);
        std::mem::swap(&mut from, &mut to);
    }
    integrator.counters()
}

/// A tangent that is kept as it stands takes 2.8 iterations a step here with Newmark's method, and 2.9 with Radau
/// IIA, for which a new one is made every other step.
#[test]
fn a_bending_beam_takes_few_iterations_and_tangents() {
    let newmark = work(GeneralizedAlpha::newmark(0.25, 0.5).unwrap(), 0.01);
    assert!(newmark.iterations * 10 < newmark.steps * 13, "{newmark:?}");
    assert!(newmark.tangents * 8 < newmark.steps, "{newmark:?}");
    let radau = work(Radau::new(Tolerance::uniform(1e-4)).unwrap(), 0.1);
    assert!(radau.iterations * 10 < radau.steps * 24, "{radau:?}");
    // M, C and K count one each.
    assert!(radau.tangents < radau.steps, "{radau:?}");
}
