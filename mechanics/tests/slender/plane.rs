//! Large bending in a plane: rolling up by a couple, and the elastica.

use super::newton::{Statics, cantilever, distance, orders};
use flexion::linalg::Vec3;
use flexion::multibody::slender::{Load, Properties};
use std::f64::consts::TAU;

/// EI = GJ = 1 and EA = λ² for the slenderness λ of a beam of length 1.
fn section(slenderness: f64) -> Properties {
    Properties::principal([slenderness * slenderness, 1.0, 1.0, 1.0], 1.0, [1.0; 3])
}

fn rolled(elements: usize, turns: f64) -> Statics {
    let mut statics = cantilever(1.0, elements, section(1e3));
    statics.loads.push((elements, Load::Couple(Vec3([0.0, 0.0, TAU * turns]))));
    statics.load(2 + (8.0 * turns) as usize);
    statics
}

/// The end of an arc of the length 1 that turns by θ from x towards y.
fn arc(angle: f64) -> Vec3 {
    Vec3([angle.sin() / angle, (1.0 - angle.cos()) / angle, 0.0])
}

#[test]
fn a_couple_rolls_the_beam_up_at_every_load() {
    for turns in [0.1, 0.5, 1.0, 2.0] {
        let angle = TAU * turns;
        let errors = [16, 32, 64].map(|n| distance(rolled(n, turns).tip().0, arc(angle)));
        assert!(errors[2] < 2e-6 * angle.powi(2), "{turns} turns: {errors:?}");
        // Where the error is not that of rounding.
        if turns >= 0.5 {
            let order = orders(&errors);
            assert!(order.iter().all(|order| *order > 3.8), "{turns} turns: {errors:?} of order {order:?}");
        }
        let triad = rolled(32, turns).tip().1;
        assert!(distance(triad.tangent, Vec3([angle.cos(), angle.sin(), 0.0])) < 1e-3 * angle, "{triad:?}");
        assert!(distance(triad.binormal, Vec3([0.0, 0.0, 1.0])) < 1e-12);
    }
}

#[test]
fn a_couple_that_follows_bends_in_a_plane_like_one_that_does_not() {
    let mut statics = cantilever(1.0, 8, section(1e2));
    statics.loads.push((8, Load::FollowerCouple(Vec3([0.0, 0.0, 3.0]))));
    statics.load(4);
    let mut dead = cantilever(1.0, 8, section(1e2));
    dead.loads.push((8, Load::Couple(Vec3([0.0, 0.0, 3.0]))));
    dead.load(4);
    assert!(distance(statics.tip().0, dead.tip().0) < 1e-12);
}

/// (w/L, u/L) of the elastica under a transverse force P with PL²/EI: by elliptic integrals.
const ELASTICA: [(f64, f64, f64); 4] = [
    (1.0, 0.301721, 0.056433),
    (2.0, 0.493457, 0.160642),
    (4.0, 0.669964, 0.328941),
    (10.0, 0.810609, 0.554996),
];

fn pulled(elements: usize, slenderness: f64, direction: Vec3, force: f64) -> Statics {
    let mut statics = cantilever(1.0, elements, section(slenderness));
    let force = direction.map(|x| force * x);
    statics.loads.push((elements, Load::Force(force)));
    statics.load(5);
    statics
}

#[test]
fn a_force_makes_the_elastica_in_any_plane() {
    for (force, deflection, shortening) in ELASTICA {
        for angle in [0.0_f64, 1.1, 2.7] {
            let (sin, cos) = angle.sin_cos();
            let tip = pulled(32, 1e4, Vec3([0.0, cos, sin]), force).tip().0;
            let expected = [1.0 - shortening, deflection * cos, deflection * sin];
            // Six digits are given.
            assert!(distance(tip, Vec3(expected)) < 1.2e-6, "{force}: {tip:?} for {expected:?}");
        }
    }
}

#[test]
fn slender_beams_do_not_lock() {
    for force in [1.0, 10.0] {
        let error = |slenderness: f64| {
            let fine = pulled(64, slenderness, Vec3([0.0, 1.0, 0.0]), force).tip().0;
            distance(pulled(8, slenderness, Vec3([0.0, 1.0, 0.0]), force).tip().0, fine)
        };
        let errors = [1e2, 1e3, 1e4].map(error);
        assert!(errors[2] < 1.05 * errors[0] && errors[2] < 6e-4, "{force}: {errors:?}");
    }
}

#[test]
fn the_tip_under_a_force_converges_with_the_fourth_power_of_the_element() {
    let fine = pulled(128, 1e3, Vec3([0.0, 0.6, 0.8]), 10.0).tip().0;
    let errors = [8, 16, 32].map(|n| distance(pulled(n, 1e3, Vec3([0.0, 0.6, 0.8]), 10.0).tip().0, fine));
    let order = orders(&errors);
    assert!(order.iter().all(|order| (3.7..4.3).contains(order)), "{errors:?} of order {order:?}");
}

#[test]
fn iterations_depend_little_on_the_axial_stiffness() {
    let iterations = [1e1, 1e2, 1e3, 1e4].map(|slenderness| {
        let mut statics = cantilever(1.0, 16, section(slenderness));
        statics.loads.push((16, Load::Force(Vec3([0.0, 10.0, 0.0]))));
        statics.load(5)
    });
    assert!(iterations.iter().all(|i| *i <= 50), "{iterations:?}");
}
