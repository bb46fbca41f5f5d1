//! A beam that moves as a rigid body obeys Newton's and Euler's equations.

use flexion::linalg::vector::cross;
use flexion::multibody::slender::{Beam, Properties, Station, Vector};

fn plus(x: Vector, y: Vector) -> Vector {
    std::array::from_fn(|k| x[k] + y[k])
}

#[test]
fn a_rigid_motion_needs_the_forces_of_a_rigid_body() {
    let (length, mass, inertia) = (1.7, 1.3, [0.31, 0.12, 0.19]);
    let root = Station { position: [0.4, -0.2, 0.7], tangent: [0.0, 0.6, 0.8], normal: [1.0, 0.0, 0.0] };
    let section = Properties::principal([10.0, 1.0, 2.0, 3.0], mass, inertia);
    let beam = Beam::straight(root, length, 3, section).unwrap();
    let q = beam.initial().to_vec();
    let (omega, alpha, lift) = ([0.7, -1.1, 0.4], [-0.3, 0.8, 1.9], [0.5, 0.1, -0.6]);
    let turning = |x: Vector| (cross(omega, x), plus(cross(alpha, x), cross(omega, cross(omega, x))));
    let n = beam.velocities();
    let (mut v, mut a) = (vec![0.0; n], vec![0.0; n]);
    let spin = |w: Vector, t: Vector| -> f64 { (0..3).map(|k| w[k] * t[k]).sum() };
    for node in 0..=3 {
        let (position, triad) = beam.node(node, &q);
        let (velocity, acceleration) = turning(position);
        let (rate, second) = turning(triad.tangent);
        for k in 0..3 {
            (v[8 * node + k], a[8 * node + k]) = (velocity[k], acceleration[k] + lift[k]);
            (v[8 * node + 3 + k], a[8 * node + 3 + k]) = (rate[k], second[k]);
        }
        for at in [8 * node + 6, 8 * node + 7] {
            if at < n {
                (v[at], a[at]) = (spin(omega, triad.tangent), spin(alpha, triad.tangent));
            }
        }
    }
    let mut r = vec![0.0; n];
    beam.add_forces(&q, &v, &a, &mut r);
    let (mut force, mut moment) = ([0.0; 3], [0.0; 3]);
    for node in 0..=3 {
        let (position, triad) = beam.node(node, &q);
        let of = |at: usize| [r[at], r[at + 1], r[at + 2]];
        force = plus(force, of(8 * node));
        moment = plus(moment, cross(position, of(8 * node)));
        moment = plus(moment, cross(triad.tangent, of(8 * node + 3)));
        for at in [8 * node + 6, 8 * node + 7] {
            if at < n {
                moment = plus(moment, triad.tangent.map(|t| t * r[at]));
            }
        }
    }
    // The rod: mass m L, moments of inertia J L and ρA L³/12 across the axis.
    let centre = plus(root.position, root.tangent.map(|t| 0.5 * length * t));
    let total = mass * length;
    let across = total * length * length / 12.0;
    let axes = [root.tangent, root.normal, cross(root.tangent, root.normal)];
    let moments = [inertia[0] * length, inertia[1] * length + across, inertia[2] * length + across];
    let by = |x: Vector| {
        (0..3).fold([0.0; 3], |sum, i| plus(sum, axes[i].map(|e| moments[i] * spin(x, axes[i]) * e)))
    };
    let acceleration = plus(turning(centre).1, lift);
    let expected = acceleration.map(|x| total * x);
    let about = plus(plus(by(alpha), cross(omega, by(omega))), cross(centre, expected));
    for k in 0..3 {
        assert!((force[k] - expected[k]).abs() < 1e-13 * total, "{force:?} for {expected:?}");
        assert!((moment[k] - about[k]).abs() < 1e-12 * total, "{moment:?} for {about:?}");
    }
    let energy = |x: Vector| 0.5 * (0..3).map(|k| x[k] * by(omega)[k]).sum::<f64>();
    let speed = turning(centre).0;
    let expected = energy(omega) + 0.5 * total * speed.iter().map(|v| v * v).sum::<f64>();
    assert!((beam.kinetic_energy(&q, &v) - expected).abs() < 1e-13 * expected);
}
