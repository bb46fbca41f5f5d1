//! Forces and tangents against differences.

use flexion::linalg::Vec3;
use flexion::linalg::vector::noise;
use flexion::multibody::slender::{Beam, Load, Properties, Station};
use flexion::system::Weights;

/// A curved and twisted beam of three unequal elements, all stiffnesses coupled, with rotary inertia.
pub fn general() -> Beam {
    let curve = |s: f64| {
        let (sin, cos) = s.sin_cos();
        let root = 0.5_f64.sqrt();
        // A helix of radius ½, and its principal normal turned about the tangent by s/2.
        let (t, n) = (Vec3([-sin * root, cos * root, root]), Vec3([-cos, -sin, 0.0]));
        let b = t.cross(n);
        let (c, d) = ((0.5 * s).cos(), (0.5 * s).sin());
        Station { position: Vec3([root * cos, root * sin, root * s]), tangent: t, normal: c * n + d * b }
    };
    Beam::new(&[0.0, 0.5, 0.9, 1.6], curve, |s| Properties {
        stiffness: stiffness(s),
        mass: 1.3 + 0.1 * s,
        inertia: [0.05, 0.03, 0.04],
    })
    .unwrap()
}

/// C of its section at the arc length s.
pub fn stiffness(s: f64) -> [[f64; 4]; 4] {
    [[50.0, 0.4, -1.1, 0.7], [0.4, 1.3, 0.2, -0.1], [-1.1, 0.2, 2.0, 0.3], [0.7, -0.1, 0.3, 0.9]]
        .map(|row| row.map(|c| c * (1.0 - 0.2 * s)))
}

/// A configuration far from the one without stress, velocities and accelerations.
pub fn far(beam: &Beam, seed: u64) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
    let n = beam.velocities();
    let d: Vec<f64> = noise(n, seed).iter().map(|x| 0.25 * x).collect();
    let mut q = beam.initial().to_vec();
    beam.retract(beam.initial(), &d, &mut q);
    (q, noise(n, seed + 1), noise(n, seed + 2))
}

fn forces(beam: &Beam, q: &[f64], v: &[f64], a: &[f64]) -> Vec<f64> {
    let mut r = vec![0.0; beam.velocities()];
    beam.add_forces(q, v, a, &mut r);
    r
}

/// ⟨f(h) − f(−h)⟩/2h with the error of h² removed.
fn slope(f: impl Fn(f64) -> Vec<f64>, h: f64) -> Vec<f64> {
    let central = |h: f64| -> Vec<f64> {
        f(h).iter().zip(f(-h)).map(|(plus, minus)| (plus - minus) / (2.0 * h)).collect()
    };
    central(h).iter().zip(central(2.0 * h)).map(|(one, two)| (4.0 * one - two) / 3.0).collect()
}

fn tangent(beam: &Beam, q: &[f64], v: &[f64], a: &[f64], w: &Weights<'_>) -> Vec<Vec<f64>> {
    let n = beam.velocities();
    let mut out = vec![vec![0.0; n]; n];
    beam.add_tangent(q, v, a, w, |at, block| {
        (0..15).for_each(|i| (0..15).for_each(|j| out[at + i][at + j] += block[i][j]));
    });
    out
}

fn close(found: &[Vec<f64>], expected: impl Fn(usize) -> Vec<f64>, tolerance: f64, what: &str) {
    let largest = found.iter().flatten().fold(0.0, |a: f64, x| a.max(x.abs()));
    for j in 0..found.len() {
        for (i, expected) in expected(j).into_iter().enumerate() {
            let error = (found[i][j] - expected).abs() / largest;
            assert!(error < tolerance, "{what} ({i}, {j}): {} for {expected}", found[i][j]);
        }
    }
}

#[test]
fn tangents_are_those_of_the_forces_by_differences() {
    let mut beam = general();
    beam.damp(0.3);
    let n = beam.velocities();
    let (q, v, a) = far(&beam, 7);
    let unit = |j: usize, h: f64| -> Vec<f64> { (0..n).map(|i| if i == j { h } else { 0.0 }).collect() };
    let moved = |j: usize, h: f64| {
        let mut to = q.clone();
        beam.retract(&q, &unit(j, h), &mut to);
        to
    };
    let plus =
        |x: &[f64], j: usize, h: f64| -> Vec<f64> { x.iter().zip(unit(j, h)).map(|(x, d)| x + d).collect() };
    let h = 1e-3;
    let by_q = |j: usize| slope(|h| forces(&beam, &moved(j, h), &v, &a), h);
    let by_v = |j: usize| slope(|h| forces(&beam, &q, &plus(&v, j, h), &a), h);
    let by_a = |j: usize| slope(|h| forces(&beam, &q, &v, &plus(&a, j, h)), h);
    close(&tangent(&beam, &q, &v, &a, &Weights::new(0.0, 0.0, 1.0)), by_q, 1e-8, "by q");
    close(&tangent(&beam, &q, &v, &a, &Weights::new(0.0, 1.0, 0.0)), by_v, 1e-8, "by v");
    close(&tangent(&beam, &q, &v, &a, &Weights::new(1.0, 0.0, 0.0)), by_a, 1e-8, "by a");
    // About an increment d since the retracted configuration.
    let d: Vec<f64> = noise(n, 3).iter().map(|x| 0.3 * x).collect();
    let at = |d: &[f64]| {
        let mut to = q.clone();
        beam.retract(&q, d, &mut to);
        to
    };
    let w = Weights { q: 1.0, v: 0.0, a: 0.0, increment: Some(&d) };
    let by_d = |j: usize| slope(|h| forces(&beam, &at(&plus(&d, j, h)), &v, &a), h);
    close(&tangent(&beam, &at(&d), &v, &a, &w), by_d, 1e-8, "by d");
    let together = Weights { q: 0.7, v: 0.4, a: -0.2, increment: Some(&d) };
    let parts = [
        tangent(&beam, &at(&d), &v, &a, &w),
        tangent(&beam, &at(&d), &v, &a, &Weights::new(0.0, 1.0, 0.0)),
        tangent(&beam, &at(&d), &v, &a, &Weights::new(1.0, 0.0, 0.0)),
    ];
    let sum = |j: usize| {
        (0..n).map(|i| 0.7 * parts[0][i][j] + 0.4 * parts[1][i][j] - 0.2 * parts[2][i][j]).collect()
    };
    close(&tangent(&beam, &at(&d), &v, &a, &together), sum, 1e-13, "weights");
}

#[test]
fn forces_are_the_gradient_of_the_strain_energy() {
    let beam = general();
    let n = beam.velocities();
    let (q, ..) = far(&beam, 11);
    let rest = vec![0.0; n];
    let force = forces(&beam, &q, &rest, &rest);
    for j in 0..n {
        let energy = |h: f64| {
            let d: Vec<f64> = (0..n).map(|i| if i == j { h } else { 0.0 }).collect();
            let mut to = q.clone();
            beam.retract(&q, &d, &mut to);
            vec![beam.strain_energy(&to)]
        };
        let expected = slope(energy, 1e-3)[0];
        assert!((force[j] - expected).abs() < 1e-9 * 50.0, "{j}: {} for {expected}", force[j]);
    }
}

#[test]
fn the_forces_of_inertia_do_the_work_of_the_kinetic_energy() {
    // With f = M a + h(q, v): v·f = dT/dt along the motion q ⊞ (t v + …), v + t a.
    let beam = general();
    let (q, v, a) = far(&beam, 5);
    let n = beam.velocities();
    let rest = vec![0.0; n];
    let strain = forces(&beam, &q, &rest, &rest);
    let power: f64 =
        forces(&beam, &q, &v, &a).iter().zip(&strain).zip(&v).map(|((f, s), v)| (f - s) * v).sum();
    let energy = |t: f64| {
        let d: Vec<f64> = v.iter().map(|v| t * v).collect();
        let mut to = q.clone();
        beam.retract(&q, &d, &mut to);
        let v: Vec<f64> = v.iter().zip(&a).map(|(v, a)| v + t * a).collect();
        vec![beam.kinetic_energy(&to, &v)]
    };
    let expected = slope(energy, 1e-4)[0];
    assert!((power - expected).abs() < 1e-8 * expected.abs(), "{power} for {expected}");
}

#[test]
fn increments_and_their_rates_belong_together() {
    let beam = general();
    let n = beam.velocities();
    let (q, v, _) = far(&beam, 23);
    let d: Vec<f64> = noise(n, 29).iter().map(|x| 0.4 * x).collect();
    let (mut to, mut back) = (q.clone(), vec![0.0; n]);
    beam.retract(&q, &d, &mut to);
    beam.difference(&q, &to, &mut back);
    for (d, back) in d.iter().zip(&back) {
        assert!((d - back).abs() < 1e-14, "{back} for {d}");
    }
    // The rate of the increment where the velocity is v: the difference of the configurations q ⊞ d ⊞ ±h v.
    let mut rate = vec![0.0; n];
    beam.rate(&q, &d, &v, &mut rate);
    let along = |h: f64| {
        let step: Vec<f64> = v.iter().map(|v| h * v).collect();
        let (mut there, mut d) = (q.clone(), vec![0.0; n]);
        beam.retract(&to, &step, &mut there);
        beam.difference(&q, &there, &mut d);
        d
    };
    for (found, expected) in rate.iter().zip(slope(along, 1e-3)) {
        assert!((found - expected).abs() < 1e-9, "{found} for {expected}");
    }
}

#[test]
fn loads_have_the_derivatives_of_their_forces() {
    let beam = general();
    let (q, ..) = far(&beam, 31);
    let n = beam.velocities();
    for load in [
        Load::Force(Vec3([0.3, -0.8, 0.5])),
        Load::FollowerForce(Vec3([0.3, -0.8, 0.5])),
        Load::Couple(Vec3([-0.6, 0.2, 0.9])),
        Load::FollowerCouple(Vec3([-0.6, 0.2, 0.9])),
    ] {
        let block = load.derivative(&beam.node(2, &q).1);
        for j in 0..7 {
            let at = |h: f64| {
                let d: Vec<f64> = (0..n).map(|i| if i == 16 + j { h } else { 0.0 }).collect();
                let mut to = q.clone();
                beam.retract(&q, &d, &mut to);
                load.forces(&beam.node(2, &to).1).to_vec()
            };
            for (i, expected) in slope(at, 1e-3).into_iter().enumerate() {
                assert!((block[i][j] - expected).abs() < 1e-9, "{load:?} ({i}, {j})");
            }
        }
    }
}
