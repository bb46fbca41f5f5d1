//! What must not matter: a rigid motion, and the way to a load.

use super::derivatives::{far, general};
use super::newton::{Statics, cantilever, distance};
use flexion::linalg::Vec3;
use flexion::linalg::vector::noise;
use flexion::multibody::slender::{Beam, Load, Properties, Triad};

/// The rotation by |ω| about ω, by Rodrigues' formula.
fn rotated(omega: Vec3, x: Vec3) -> Vec3 {
    let angle = omega.norm();
    let k = omega / angle;
    let (sin, cos) = angle.sin_cos();
    cos * x + sin * k.cross(x) + (1.0 - cos) * k.dot(x) * k
}

fn moved(beam: &Beam, q: &[f64], omega: Vec3, by: Vec3) -> Vec<f64> {
    let mut out = q.to_vec();
    for e in 0..=beam.elements().len() {
        // r, r′, n of the node and n of the middle behind it.
        for k in 0..4 {
            let at = 12 * e + 3 * k;
            if at + 3 > q.len() {
                break;
            }
            let x = rotated(omega, Vec3::at(q, at));
            let shift = if k == 0 { by } else { Vec3([0.0; 3]) };
            (0..3).for_each(|i| out[at + i] = x[i] + shift[i]);
        }
    }
    out
}

#[test]
fn energy_and_forces_are_objective() {
    let beam = general();
    let n = beam.velocities();
    let rest = vec![0.0; n];
    let (q, ..) = far(&beam, 41);
    let forces = |q: &[f64]| {
        let mut r = vec![0.0; n];
        beam.add_forces(q, &rest, &rest, &mut r);
        r
    };
    let (energy, force) = (beam.strain_energy(&q), forces(&q));
    let largest = force.iter().fold(0.0, |a: f64, f| a.max(f.abs()));
    for omega in [[0.1, 0.0, 0.0], [1.3, -0.7, 2.2], [0.0, 3.1, 0.0], [40.0, -90.0, 60.0]].map(Vec3) {
        let there = moved(&beam, &q, omega, Vec3([5.0, -3.0, 2.0]));
        assert!((beam.strain_energy(&there) - energy).abs() < 1e-12 * energy, "{omega:?}");
        let found = forces(&there);
        for e in 0..=beam.elements().len() {
            for at in [8 * e, 8 * e + 3] {
                let expected = rotated(omega, Vec3::at(&force, at));
                assert!(distance(Vec3::at(&found, at), expected) < 1e-12 * largest, "{omega:?}");
            }
            assert!((found[8 * e + 6] - force[8 * e + 6]).abs() < 1e-12 * largest, "{omega:?}");
        }
        // Without deformation there is no force in any place and orientation.
        let rigid = moved(&beam, beam.initial(), omega, Vec3([5.0, -3.0, 2.0]));
        assert!(beam.strain_energy(&rigid) < 1e-24 && forces(&rigid).iter().all(|f| f.abs() < 1e-11));
    }
}

#[test]
fn energy_does_not_depend_on_the_way_to_a_configuration() {
    // The same centreline and sections, once in one increment and once in many; and back to the beginning.
    let beam = general();
    let n = beam.velocities();
    let mut q = beam.initial().to_vec();
    let mut way = vec![q.clone()];
    for k in 0..50 {
        let d: Vec<f64> = noise(n, k).iter().map(|x| 0.05 * x).collect();
        let mut to = q.clone();
        beam.retract(&q, &d, &mut to);
        q = to;
        way.push(q.clone());
    }
    let (mut d, mut to) = (vec![0.0; n], q.clone());
    beam.difference(beam.initial(), &q, &mut d);
    beam.retract(beam.initial(), &d, &mut to);
    let far = q.iter().zip(&to).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(far < 1e-13, "{far}");
    for back in way.iter().rev() {
        beam.difference(&q, back, &mut d);
        beam.retract(&q, &d, &mut to);
        q.copy_from_slice(&to);
    }
    let far = q.iter().zip(beam.initial()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(far < 1e-13, "{far}");
    // Axes stay axes.
    let Triad { tangent, normal, binormal, .. } = beam.node(3, &q).1;
    assert!(distance(rotated(tangent.map(|t| 0.5 * std::f64::consts::PI * t), normal), binormal) < 1e-14);
}

fn oblique() -> Statics {
    cantilever(1.0, 8, Properties::principal([1e4, 0.4, 0.3, 2.0], 1.0, [1.0; 3]))
}

#[test]
fn a_closed_cycle_of_loads_returns_and_ways_to_a_load_agree() {
    let (force, couple) = (Load::Force(Vec3([-0.4, 0.9, 0.8])), Load::FollowerCouple(Vec3([0.5, 0.2, -0.6])));
    let scaled = |loads: &[(usize, Load)], factor: f64| -> Vec<(usize, Load)> {
        let one = |load: &Load| match load {
            Load::Force(x) => Load::Force(factor * *x),
            Load::FollowerForce(x) => Load::FollowerForce(factor * *x),
            Load::Couple(x) => Load::Couple(factor * *x),
            Load::FollowerCouple(x) => Load::FollowerCouple(factor * *x),
        };
        loads.iter().map(|(node, load)| (*node, one(load))).collect()
    };
    // From the loads of one stage to those of the next in eight steps.
    let run = |stages: &[Vec<(usize, Load)>]| {
        let mut statics = oblique();
        let mut last: &[(usize, Load)] = &[];
        for stage in stages {
            for part in (1..=8).map(|k| f64::from(k) / 8.0) {
                statics.loads = [scaled(last, 1.0 - part), scaled(stage, part)].concat();
                statics.solve(1.0);
            }
            last = stage;
        }
        statics
    };
    let both = vec![(8, force), (8, couple)];
    let one = run(&[vec![(8, force)], both.clone()]);
    let other = run(&[vec![(8, couple)], both.clone()]);
    let apart = one.q.iter().zip(&other.q).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(apart < 1e-11, "{apart}");
    assert!(distance(one.tip().0, Vec3([1.0, 0.0, 0.0])) > 0.5);
    let back = run(&[vec![(8, force)], both, vec![(8, couple)], vec![]]);
    let apart = back.q.iter().zip(back.beam.initial()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(apart < 1e-11, "{apart}");
}
