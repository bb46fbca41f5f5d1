//! A beam in free flight, by the integrators of the library.

use super::derivatives::{Free, general};
use crate::integrators::drive::fixed;
use flexion::integrator::{GeneralizedAlpha, Integrator, Radau, Tolerance};
use flexion::linalg::Vec3;
use flexion::system::{Dynamics, Observed, State};

/// The system, and the states at begin and end of equal steps.
fn fly(method: &dyn Integrator, damped: bool, end: f64, steps: usize) -> (Free, State, State) {
    let mut system = Free::new(general(damped));
    let mut begin = system.initial();
    let mut v = vec![0.0; begin.v.len()];
    system.beam.move_rigidly(Vec3([0.3, -0.1, 0.2]), Vec3([1.0, -2.0, 3.0]), &begin.q, &mut v);
    begin.v = v;
    let end = fixed(method, &mut system, begin.clone(), end, steps, |_, _, _, _| {}).unwrap();
    (system, begin, end)
}

/// The changes of energy, momentum and angular momentum, and the distance of the centre of mass from its straight way, in units of the
/// kinetic energy, the angular momentum and the length.
fn changes(damped: bool, steps: usize) -> [f64; 4] {
    let method = Radau::new(Tolerance::uniform(1e-12)).unwrap();
    let (mut system, begin, end) = fly(&method, damped, 0.5, steps);
    let (before, after) = (system.energy(&begin), system.energy(&end));
    assert!(after.strain > 0.01 * before.kinetic, "it deforms: {after:?}");
    let momenta = |s: &State| system.beam.momenta(&s.q, &s.v);
    let ([p, l], [p_end, l_end]) = (momenta(&begin), momenta(&end));
    let centre = |s: &State| 1.0 / system.beam.mass() * system.beam.first_moment(&s.q);
    let flown = centre(&begin) + 0.5 / system.beam.mass() * p;
    let change = (after.total() - before.total()) / before.kinetic;
    [change, (p_end - p).norm() / l.norm(), (l_end - l).norm() / l.norm(), (centre(&end) - flown).norm()]
}

/// Energy is kept but for the error of the method, which falls with a high power of the step; momenta and the way of the centre of mass
/// but for what the iterations of each step leave.
#[test]
fn a_free_beam_keeps_its_energy_and_its_momenta() {
    for damped in [false, true] {
        let [coarse, fine] = [100, 200].map(|steps| changes(damped, steps));
        if damped {
            assert!(fine[0] < -1e-3, "{fine:?}");
        } else {
            assert!(fine[0].abs() < 1e-10 && fine[0].abs() < coarse[0].abs() / 16.0, "{coarse:?} {fine:?}");
        }
        for (changes, steps) in [(coarse, 100.0), (fine, 200.0)] {
            assert!(changes[1..].iter().all(|change| *change < 1e-12 * steps), "{changes:?}");
        }
    }
}

#[test]
fn integrators_agree_and_keep_their_orders() {
    let apart = |a: &State, b: &State| {
        a.q.iter().zip(&b.q).chain(a.v.iter().zip(&b.v)).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
    };
    let fine = fly(&Radau::new(Tolerance::uniform(1e-12)).unwrap(), true, 0.1, 800).2;
    let alpha = |steps| fly(&GeneralizedAlpha::chung_hulbert(0.8).unwrap(), true, 0.1, steps).2;
    let errors = [800, 1600].map(|n| apart(&alpha(n), &fine));
    let order = (errors[0] / errors[1]).log2();
    assert!((1.8..2.2).contains(&order), "{errors:?} of order {order}");
}
