//! A beam that moves as a rigid body obeys Newton's and Euler's equations.

use flexion::linalg::Vec3;
use flexion::multibody::slender::{Beam, Properties, Station};

#[test]
fn a_rigid_motion_needs_the_forces_of_a_rigid_body() {
    let (length, mass, inertia) = (1.7, 1.3, [0.31, 0.12, 0.19]);
    let root = Station {
        position: Vec3([0.4, -0.2, 0.7]),
        tangent: Vec3([0.0, 0.6, 0.8]),
        normal: Vec3([1.0, 0.0, 0.0]),
    };
    let section = Properties::principal([10.0, 1.0, 2.0, 3.0], mass, inertia);
    let beam = Beam::straight(root, length, 3, section).unwrap();
    let q = beam.initial().to_vec();
    let (omega, alpha) = (Vec3([0.7, -1.1, 0.4]), Vec3([-0.3, 0.8, 1.9]));
    let lift = Vec3([0.5, 0.1, -0.6]);
    let turning = |x: Vec3| (omega.cross(x), alpha.cross(x) + omega.cross(omega.cross(x)));
    let n = beam.velocities();
    let (mut v, mut a) = (vec![0.0; n], vec![0.0; n]);
    for node in 0..=3 {
        let (position, triad) = beam.node(node, &q);
        let (velocity, acceleration) = turning(position);
        let (rate, second) = turning(triad.tangent);
        velocity.put(&mut v, 8 * node);
        (acceleration + lift).put(&mut a, 8 * node);
        rate.put(&mut v, 8 * node + 3);
        second.put(&mut a, 8 * node + 3);
        for at in [8 * node + 6, 8 * node + 7] {
            if at < n {
                (v[at], a[at]) = (omega.dot(triad.tangent), alpha.dot(triad.tangent));
            }
        }
    }
    let mut r = vec![0.0; n];
    beam.add_forces(&q, &v, &a, &mut r);
    let (mut force, mut moment) = (Vec3::ZERO, Vec3::ZERO);
    for node in 0..=3 {
        let (position, triad) = beam.node(node, &q);
        let of = |at: usize| Vec3::at(&r, at);
        force += of(8 * node);
        moment += position.cross(of(8 * node)) + triad.tangent.cross(of(8 * node + 3));
        for at in [8 * node + 6, 8 * node + 7] {
            if at < n {
                moment += r[at] * triad.tangent;
            }
        }
    }
    // The rod: mass m L, moments of inertia J L and ρA L³/12 across the axis.
    let centre = root.position + 0.5 * length * root.tangent;
    let total = mass * length;
    let across = total * length * length / 12.0;
    let axes = [root.tangent, root.normal, root.tangent.cross(root.normal)];
    let moments = [inertia[0] * length, inertia[1] * length + across, inertia[2] * length + across];
    let by = |x: Vec3| (0..3).map(|i| moments[i] * x.dot(axes[i]) * axes[i]).sum::<Vec3>();
    let expected = total * (turning(centre).1 + lift);
    let about = by(alpha) + omega.cross(by(omega)) + centre.cross(expected);
    for k in 0..3 {
        assert!((force[k] - expected[k]).abs() < 1e-13 * total, "{force:?} for {expected:?}");
        assert!((moment[k] - about[k]).abs() < 1e-12 * total, "{moment:?} for {about:?}");
    }
    let speed = turning(centre).0;
    let expected = 0.5 * omega.dot(by(omega)) + 0.5 * total * speed.dot(speed);
    assert!((beam.kinetic_energy(&q, &v) - expected).abs() < 1e-13 * expected);
}
