//! Equilibria that are one of many, for some motion has no stiffness.

use super::GRAVITY;
use flexion::analysis::equilibrium::{equilibrium, stable_equilibrium};
use flexion::analysis::modes::modes;
use flexion::linalg::Vec3;
use flexion::multibody::slender::{Beam, Properties, Station};
use flexion::multibody::{Body, Flexible, Kind, Model, Multibody, Part};
use flexion::system::Dynamics;
use std::ops::ControlFlow;

const LENGTH: f64 = 2.0;

/// A soft beam on a ball joint at its first end, along `tangent`; gravity along `down`.
fn mast(tangent: [f64; 3], normal: [f64; 3], down: [f64; 3]) -> Multibody {
    let section = Properties::principal([1e5, 0.2, 1e-4, 1e-4], 0.08, [2e-6, 1e-6, 1e-6]);
    let root = Station { position: Vec3([0.0; 3]), tangent: Vec3(tangent), normal: Vec3(normal) };
    let mut model = Model::new().with_gravity(down.map(|x| GRAVITY * x));
    model.beam(Flexible::new("mast", Beam::straight(root, LENGTH, 12, section).unwrap()));
    let parts = [Part::Ground, Part::Section { beam: 0, node: 0 }];
    model.join("ball", Kind::Spherical, parts, Vec3([0.0; 3]), (Vec3([0.0, 0.0, 1.0]), None)).unwrap();
    Multibody::new(model).unwrap()
}

/// ω = j √(g/L)/2 with the zeros j of J₀, Bernoulli's hanging chain: its bending stiffness is 10⁻⁵ m g L². The rotation about the axis
/// has no stiffness, and nothing says which of these equilibria is meant: the one that is written.
#[test]
fn a_hanging_beam_on_a_ball_joint_vibrates_as_a_chain_and_spins_freely() {
    let third = 1.0 / 3.0;
    let odd = ([2.0 * third, -third, 2.0 * third], [third, -2.0 * third, -2.0 * third]);
    for (down, normal) in [([0.0, 0.0, -1.0], [1.0, 0.0, 0.0]), odd] {
        let mut system = mast(down, normal, down);
        let mut s = system.initial();
        assert!(stable_equilibrium(&mut system, &mut s, &mut |_| ControlFlow::Continue(())).unwrap().neutral);
        // The weight of what hangs below stretches it.
        let found = modes(&mut system, &s, 5, &[]).unwrap().modes;
        assert_eq!(found[0].frequency(), 0.0);
        assert!(found[0].shares.torsion > 0.999, "{:?}", found[0].shares);
        for (pair, zero) in [(1, 2.404_825_557_695_773), (3, 5.520_078_110_286_311)] {
            let chain = 0.5 * zero * (GRAVITY / LENGTH).sqrt();
            for mode in &found[pair..pair + 2] {
                assert!((mode.frequency() / chain - 1.0).abs() < 5e-3, "{} {chain}", mode.frequency());
            }
        }
    }
}

#[test]
fn a_mast_that_stands_on_a_ball_joint_is_found_and_is_unstable() {
    let mut system = mast([0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]);
    let mut s = system.initial();
    let found = stable_equilibrium(&mut system, &mut s, &mut |_| ControlFlow::Continue(())).unwrap();
    assert!(found.neutral);
    assert!(found.stability.is_some_and(|stability| stability.divergent >= 2), "{found:?}");
}

/// Without gravity all six rigid motions of a body are neutral; with it nothing carries the body.
#[test]
fn a_free_body_rests_without_gravity_alone() {
    let free = |g: f64| {
        let mut model = Model::new().with_gravity([0.0, 0.0, -g]);
        model.body(Body::new("body", 1.0, [0.1, 0.2, 0.3]));
        Multibody::new(model).unwrap()
    };
    let mut system = free(0.0);
    let mut s = system.initial();
    equilibrium(&mut system, &mut s).unwrap();
    let found = modes(&mut system, &s, 6, &[]).unwrap().modes;
    assert!(found.iter().all(|mode| mode.frequency() == 0.0), "{found:?}");
    let mut system = free(GRAVITY);
    let mut s = system.initial();
    assert!(equilibrium(&mut system, &mut s).is_err());
}
