//! Force, stiffness and inertia against energies that are coded apart from the model.

use super::*;
use crate::quadrature::Gauss;
use crate::section::BladeSection;

/// A blade with everything: twist, taper, both inertias.
#[derive(Debug)]
struct General;

impl BladeSection for General {
    fn resultants(&self, x: f64) -> BladeResultants {
        let s = 1.0 - 0.4 * x;
        BladeResultants {
            mass: 1.3 * s,
            axial_stiffness: 900.0 * s,
            flap_stiffness: 0.7 * s * s * s,
            chord_stiffness: 2.1 * s * s,
            torsional_stiffness: 0.9 * s,
            flap_inertia: 0.01 * s,
            chord_inertia: 0.04 * s,
            twist: 0.5 - 0.8 * x,
            twist_rate: -0.8,
        }
    }
}

fn general() -> Setting {
    Setting { length: 1.0, hub_radius: 0.3, precone: 0.15, pitch: 0.2, tip: Tip { mass: 0.2, inertia: 0.01 } }
}

/// A vector rotated about an axis (unit) by an angle: Rodrigues.
fn turned(v: [f64; 3], axis: [f64; 3], angle: f64) -> [f64; 3] {
    let (s, c) = angle.sin_cos();
    let cross =
        [axis[1] * v[2] - axis[2] * v[1], axis[2] * v[0] - axis[0] * v[2], axis[0] * v[1] - axis[1] * v[0]];
    let along: f64 = (0..3).map(|k| axis[k] * v[k]).sum();
    std::array::from_fn(|k| c * v[k] + s * cross[k] + (1.0 - c) * along * axis[k])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Axes of the section at x by rotating e₁ to the tangent about e₁ × t, then about the tangent.
fn frame(blade: &Blade, q: &[f64], x: f64) -> [[f64; 3]; 3] {
    let (_, slope, torsion) = blade.displacement(q, x);
    let r = [1.0 + slope[0], slope[1], slope[2]];
    let t = r.map(|c| c / dot(r, r).sqrt());
    let (across, size) = ([0.0, -t[2], t[1]], t[1].hypot(t[2]));
    let move_ = |v: [f64; 3]| {
        if size < 1e-14 { v } else { turned(v, across.map(|c| c / size), size.atan2(t[0])) }
    };
    let angle = general().pitch + General.resultants(x).twist + torsion;
    [t, turned(move_([0.0, 1.0, 0.0]), t, angle), turned(move_([0.0, 0.0, 1.0]), t, angle)]
}

/// T₀: ½∫ρA|Ω×r|² + second moments of mass along the axes.
fn centrifugal(blade: &Blade, q: &[f64], speed: f64) -> f64 {
    let setting = general();
    let omega = [speed * setting.precone.sin(), 0.0, speed * setting.precone.cos()];
    let swept = |d: [f64; 3]| dot(omega, omega) * dot(d, d) - dot(omega, d).powi(2);
    let place = |x: f64| {
        let (u, ..) = blade.displacement(q, x);
        [setting.hub_radius + x + u[0], u[1], u[2]]
    };
    let at = |x: f64| {
        let (r, [_, d2, d3]) = (General.resultants(x), frame(blade, q, x));
        0.5 * (r.mass * swept(place(x)) + r.chord_inertia * swept(d2) + r.flap_inertia * swept(d3))
    };
    let tip = frame(blade, q, 1.0).map(swept).iter().sum::<f64>();
    let gauss = Gauss::new(4);
    let elements = 3;
    let body: f64 =
        (0..elements).map(|e| gauss.integrate(f64::from(e) / 3.0, f64::from(e + 1) / 3.0, at)).sum();
    body + 0.5 * setting.tip.mass * swept(place(1.0)) + 0.25 * setting.tip.inertia * tip
}

/// U with curvatures and twist from differences of the frame, at the same quadrature points.
fn strain(blade: &Blade, q: &[f64]) -> f64 {
    let gauss = Gauss::new(4);
    let d = 1e-4;
    let stretch = |x: f64| {
        let (_, s, _) = blade.displacement(q, x);
        ((1.0 + s[0]).powi(2) + s[1] * s[1] + s[2] * s[2]).sqrt() - 1.0
    };
    let rate = |x: f64, k: usize| -> [f64; 3] {
        let at = |x: f64| frame(blade, q, x)[k];
        let (a, b, c, e) = (at(x - 2.0 * d), at(x - d), at(x + d), at(x + 2.0 * d));
        std::array::from_fn(|i| (a[i] - 8.0 * b[i] + 8.0 * c[i] - e[i]) / (12.0 * d))
    };
    let mut sum = 0.0;
    for e in 0..3 {
        let (a, b) = (f64::from(e) / 3.0, f64::from(e + 1) / 3.0);
        let (start, end, middle) = (stretch(a), stretch(b - 1e-13), stretch(0.5 * (a + b)));
        sum += gauss.integrate(a, b, |x| {
            let s = (x - a) / (b - a);
            let sampled = start * (1.0 - s) * (1.0 - 2.0 * s)
                + middle * 4.0 * s * (1.0 - s)
                + end * s * (2.0 * s - 1.0);
            let r = General.resultants(x);
            let [_, d2, d3] = frame(blade, q, x);
            let whole = dot(rate(x, 1), d3);
            let twist = whole - r.twist_rate;
            let polar = r.chord_stiffness + r.flap_stiffness;
            let wound = 0.5 * polar / r.axial_stiffness * (whole * whole - r.twist_rate * r.twist_rate);
            0.5 * (r.axial_stiffness * (sampled * sampled + wound * (2.0 * stretch(x) + wound))
                + r.chord_stiffness * dot(rate(x, 0), d2).powi(2)
                + r.flap_stiffness * dot(rate(x, 0), d3).powi(2)
                + r.torsional_stiffness * twist * twist)
        });
    }
    sum
}

fn bent(n: usize) -> Vec<f64> {
    (0..n).map(|i| 0.08 * ((i * i) as f64 * 0.7 + 0.3).sin()).collect()
}

#[test]
fn strain_energy_is_that_of_a_curve_whose_frame_turns() {
    let mut blade = Blade::new(general(), &General, Model::default(), 3).unwrap();
    let q = bent(blade.size().q);
    let (found, expected) = (blade.matrices().strain_energy(&q), strain(&blade, &q));
    assert!((found / expected - 1.0).abs() < 1e-8, "{found} for {expected}");
}

#[test]
fn forces_are_the_gradient_of_the_energy_and_stiffness_of_the_forces() {
    let mut blade = Blade::new(general(), &General, Model::default(), 3).unwrap();
    let n = blade.size().q;
    let (q, speed) = (bent(n), 4.0);
    blade.matrices().assemble(speed, &q);
    let force = blade.matrices().force().to_vec();
    let stiffness = blade.matrices().stiffness.clone();
    let largest = force.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
    let d = 1e-3;
    let moved = |i: usize, d: f64| {
        let mut q = q.clone();
        q[i] += d;
        q
    };
    let energy = |q: &[f64]| strain(&blade, q) - centrifugal(&blade, q, speed);
    for i in 0..n {
        let at = |k: f64| energy(&moved(i, k * d));
        let slope = (at(-2.0) - 8.0 * at(-1.0) + 8.0 * at(1.0) - at(2.0)) / (12.0 * d);
        assert!((force[i] - slope).abs() < 1e-7 * largest, "unknown {i}: {} for {slope}", force[i]);
    }
    for j in 0..n {
        let mut at = |k: f64| {
            blade.matrices().assemble(speed, &moved(j, k * d));
            blade.matrices().force().to_vec()
        };
        let (a, b, c, e) = (at(-2.0), at(-1.0), at(1.0), at(2.0));
        for i in 0..n {
            let slope = (a[i] - 8.0 * b[i] + 8.0 * c[i] - e[i]) / (12.0 * d);
            let found = stiffness.get(i, j);
            assert!((found - slope).abs() < 1e-7 * largest.max(900.0), "{i} {j}: {found} for {slope}");
        }
    }
}

#[test]
fn inertia_is_that_of_the_motion_of_masses() {
    // Lagrange's equations of T(q, q̇), its derivatives by differences, of a blade at a bent state: C = T₁ part.
    let mut blade = Blade::new(general(), &General, Model::default(), 2).unwrap();
    let n = blade.size().q;
    let (q, speed) = (bent(n), 1.7);
    blade.matrices().assemble(speed, &q);
    let (mass, gyroscopic) = (blade.matrices().mass.clone(), blade.matrices().gyroscopic.clone());
    let setting = general();
    let omega = [speed * setting.precone.sin(), 0.0, speed * setting.precone.cos()];
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let d = 1e-4;
    let along =
        |q: &[f64], v: &[f64], k: f64| -> Vec<f64> { q.iter().zip(v).map(|(q, v)| q + k * d * v).collect() };
    // Rate of a vector that depends on q, seen from rest.
    let rate = |of: &dyn Fn(&[f64]) -> [f64; 3], q: &[f64], v: &[f64]| -> [f64; 3] {
        let at = |k: f64| of(&along(q, v, k));
        let (a, b, c, e, here) = (at(-2.0), at(-1.0), at(1.0), at(2.0), cross(omega, of(q)));
        std::array::from_fn(|i| (a[i] - 8.0 * b[i] + 8.0 * c[i] - e[i]) / (12.0 * d) + here[i])
    };
    let square = |a: [f64; 3]| dot(a, a);
    let kinetic = |q: &[f64], v: &[f64]| {
        let place = |x: f64| {
            let blade = &blade;
            move |q: &[f64]| {
                let (u, ..) = blade.displacement(q, x);
                [setting.hub_radius + x + u[0], u[1], u[2]]
            }
        };
        let axis = |x: f64, k: usize| {
            let blade = &blade;
            move |q: &[f64]| frame(blade, q, x)[k]
        };
        let gauss = Gauss::new(4);
        let at = |x: f64| {
            let r = General.resultants(x);
            0.5 * (r.mass * square(rate(&place(x), q, v))
                + r.chord_inertia * square(rate(&axis(x, 1), q, v))
                + r.flap_inertia * square(rate(&axis(x, 2), q, v)))
        };
        let body = gauss.integrate(0.0, 0.5, at) + gauss.integrate(0.5, 1.0, at);
        let tip: f64 = (0..3).map(|k| square(rate(&axis(1.0, k), q, v))).sum();
        body + 0.5 * setting.tip.mass * square(rate(&place(1.0), q, v)) + 0.25 * setting.tip.inertia * tip
    };
    let unit =
        |i: usize, size: f64| -> Vec<f64> { (0..n).map(|k| if k == i { size } else { 0.0 }).collect() };
    let sum = |a: Vec<f64>, b: Vec<f64>| -> Vec<f64> { a.iter().zip(&b).map(|(a, b)| a + b).collect() };
    // T₁(q, eᵢ) = ½[T(q, eᵢ) − T(q, −eᵢ)], and its gradient by qⱼ.
    let first = |q: &[f64], i: usize| 0.5 * (kinetic(q, &unit(i, 1.0)) - kinetic(q, &unit(i, -1.0)));
    let by = |i: usize, j: usize| {
        let h = 1e-3;
        let at = |k: f64| first(&sum(q.clone(), unit(j, k * h)), i);
        (at(-2.0) - 8.0 * at(-1.0) + 8.0 * at(1.0) - at(2.0)) / (12.0 * h)
    };
    let largest = (0..n).map(|i| mass.get(i, i)).fold(0.0_f64, f64::max);
    for (i, j) in
        [(0, 5), (2, 4), (3, 5), (4, 9), (6, 8), (7, 11), (8, 10), (10, 12), (5, 13), (13, 9), (14, 11)]
    {
        let t = |a: f64, b: f64| kinetic(&q, &sum(unit(i, a), unit(j, b)));
        let m = 0.25 * (t(1.0, 1.0) - t(1.0, -1.0) - t(-1.0, 1.0) + t(-1.0, -1.0));
        assert!((mass.get(i, j) - m).abs() < 1e-8 * largest, "M {i} {j}: {} for {m}", mass.get(i, j));
        let c = by(i, j) - by(j, i);
        assert!(
            (gyroscopic.get(i, j) - c).abs() < 1e-7 * largest,
            "C {i} {j}: {} for {c}",
            gyroscopic.get(i, j)
        );
    }
}

#[test]
fn a_steady_state_carries_its_own_centrifugal_force() {
    let mut blade = Blade::new(general(), &General, Model::default(), 8).unwrap();
    blade.set_speed(3.0).unwrap();
    let steady = blade.steady().to_vec();
    // The precone is bent back towards the plane of rotation.
    let (tip, ..) = blade.displacement(&steady, 1.0);
    assert!(tip[2] < -0.01, "{tip:?}");
    blade.matrices().assemble(3.0, &steady);
    let force = blade.matrices().force().iter().fold(0.0_f64, |m, f| m.max(f.abs()));
    assert!(force < 1e-10, "{force:e}");
    // Another way there ends in the same state.
    blade.set_speed(-2.0).unwrap();
    blade.set_speed(3.0).unwrap();
    for (a, b) in blade.steady().iter().zip(&steady) {
        assert!((a - b).abs() < 1e-12);
    }
}

#[test]
fn vibrations_keep_their_energy_and_the_shape_turns_with_the_hub() {
    let mut blade = Blade::new(general(), &General, Model::default(), 4).unwrap();
    blade.set_speed(2.0).unwrap();
    let [_, c, _] = matrices(&mut blade, |_| true);
    for (i, row) in c.iter().enumerate() {
        for (j, entry) in row.iter().enumerate() {
            assert!((entry + c[j][i]).abs() < 1e-13, "{i} {j}");
        }
    }
    let mut frames = [crate::system::Frame::default(); 2];
    let mut state = State::zeros(blade.size(), 0.0);
    blade.frames(0, &state, &[0.0, 1.0], &mut frames);
    let setting = general();
    let root = [setting.hub_radius * setting.precone.cos(), 0.0, setting.hub_radius * setting.precone.sin()];
    assert!((0..3).all(|k| (frames[0].position[k] - root[k]).abs() < 1e-14));
    let tip = frames[1].position;
    state.t = std::f64::consts::PI / 4.0;
    blade.frames(0, &state, &[0.0, 1.0], &mut frames);
    let turned = [-tip[1], tip[0], tip[2]];
    assert!((0..3).all(|k| (frames[1].position[k] - turned[k]).abs() < 1e-14));
}
