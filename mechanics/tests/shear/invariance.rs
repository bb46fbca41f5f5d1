//! What must not matter: a rigid motion, and the way to a configuration.

use super::derivatives::{far, general};
use flexion::linalg::Vec3;
use flexion::linalg::vector::noise;
use flexion::multibody::rotation::Quaternion;
use flexion::multibody::shear::Beam;

/// The whole beam rotated by `turn` about the origin and moved.
fn moved(beam: &Beam, q: &[f64], turn: Quaternion, by: Vec3) -> Vec<f64> {
    let mut out = q.to_vec();
    for i in (0..beam.coordinates()).step_by(7) {
        (turn.matrix() * Vec3::at(q, i) + by).put(&mut out, i);
        out[i + 3..i + 7].copy_from_slice(&(turn * Quaternion::at(q, i + 3)).0);
    }
    out
}

fn strains(beam: &Beam, q: &[f64]) -> Vec<f64> {
    let elements = beam.elements().iter().enumerate();
    let of = elements.flat_map(|(e, element)| element.samples(q[21 * e..21 * e + 28].try_into().unwrap()));
    of.flat_map(|sample| sample.strain).collect()
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn strains_are_the_same_after_any_rigid_motion() {
    let beam = general(true);
    let n = beam.velocities();
    let (q, ..) = far(&beam, 41);
    let rest = vec![0.0; n];
    let forces = |q: &[f64]| {
        let mut r = vec![0.0; n];
        beam.add_forces([q, &rest, &rest], Vec3::ZERO, &mut r);
        r
    };
    let force = forces(&q);
    let largest = force.iter().fold(0.0, |a: f64, f| a.max(f.abs()));
    for turn in [[0.1, 0.0, 0.0], [1.3, -0.7, 2.2], [0.0, 3.1, 0.0], [40.0, -90.0, 60.0]] {
        let turn = Quaternion::exponential(Vec3(turn));
        let by = Vec3([0.5, -0.3, 0.2]);
        let there = moved(&beam, &q, turn, by);
        // The rounding of coordinates of the size 1 over elements of the length 0.6.
        assert!(apart(&strains(&beam, &there), &strains(&beam, &q)) < 2e-14, "{turn:?}");
        let found = forces(&there);
        for i in (0..n).step_by(6) {
            let expected = turn.matrix() * Vec3::at(&force, i);
            assert!((Vec3::at(&found, i) - expected).norm() < 1e-13 * largest, "{turn:?}");
            let moment = Vec3::at(&found, i + 3) - Vec3::at(&force, i + 3);
            assert!(moment.norm() < 1e-13 * largest, "{turn:?}");
        }
        // Without deformation there is no force in any place and orientation.
        let rigid = moved(&beam, beam.initial(), turn, by);
        assert!(forces(&rigid).iter().all(|f| f.abs() < 1e-13));
    }
}

#[test]
fn strains_do_not_depend_on_the_way_to_a_configuration() {
    let beam = general(false);
    let n = beam.velocities();
    let mut q = beam.initial().to_vec();
    let mut way = vec![q.clone()];
    let mut to = q.clone();
    for k in 0..50 {
        let d: Vec<f64> = noise(n, k).iter().map(|x| 0.05 * x).collect();
        beam.retract(&q, &d, &mut to);
        q.copy_from_slice(&to);
        way.push(q.clone());
    }
    // The same configuration in one increment.
    let mut d = vec![0.0; n];
    beam.difference(beam.initial(), &q, &mut d);
    beam.retract(beam.initial(), &d, &mut to);
    assert!(apart(&strains(&beam, &to), &strains(&beam, &q)) < 1e-13);
    // And back by another way: nothing is left.
    for back in way.iter().rev().step_by(3).chain([&way[0]]) {
        beam.difference(&q, back, &mut d);
        beam.retract(&q, &d, &mut to);
        q.copy_from_slice(&to);
    }
    assert!(apart(&strains(&beam, &q), &vec![0.0; 36]) < 1e-13);
}

/// The other sign of a quaternion is the same rotation.
#[test]
fn the_sign_of_a_quaternion_does_not_matter() {
    let beam = general(false);
    let (q, ..) = far(&beam, 43);
    let mut turned = q.clone();
    (0..4).for_each(|k| turned[7 + 3 + k] *= -1.0);
    (0..4).for_each(|k| turned[35 + 3 + k] *= -1.0);
    assert_eq!(beam.strain_energy(&q).to_bits(), beam.strain_energy(&turned).to_bits());
}
