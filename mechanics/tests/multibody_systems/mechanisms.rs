//! Mechanisms against closed forms and independent equations.

use super::conformance::profile;
use super::{GRAVITY, channel, radau, run};
use flexion::integrator::{GeneralizedAlpha, Integrator, Radau, Tolerance};
use flexion::linalg::Vec3;
use flexion::multibody::slender::{Beam, Properties, Station};
use flexion::multibody::{Body, Drive, Flexible, Kind, Model, Multibody, Part};
use flexion::profile::Motion;
use flexion::system::{Dynamics, RowWeights, State};
use flexion::verify::dynamics;

fn methods(step: f64) -> [(Box<dyn Integrator>, Option<f64>, &'static str); 3] {
    [
        (Box::new(Radau::new(Tolerance::uniform(1e-10)).unwrap()), None, "radau"),
        (Box::new(GeneralizedAlpha::chung_hulbert(0.8).unwrap()), Some(step), "index 3"),
        (Box::new(GeneralizedAlpha::chung_hulbert(0.8).unwrap().stabilized()), Some(step), "stabilized"),
    ]
}

/// A state with accelerations of no account, so that no equation is zero.
fn pushed(s: &State) -> State {
    let mut s = s.clone();
    s.a.iter_mut().enumerate().for_each(|(i, a)| *a += 3.0 * super::wave(i, 4.0));
    s
}

/// Duration of the swing of the double pendulum \[s\].
const SWING: f64 = 1.5;

/// Angles of two uniform rods below the horizontal and their rates after the swing, released along a horizontal line.
fn two_angles(length: f64, mass: f64) -> [f64; 4] {
    let inertia = mass * length * length / 12.0;
    let rate = |x: [f64; 4]| {
        let [a, b, u, v] = x;
        let (cos, sin) = ((a - b).cos(), (a - b).sin());
        let half = 0.5 * mass * length * length;
        let m = [
            [inertia + 1.25 * mass * length * length, half * cos],
            [half * cos, inertia + 0.25 * mass * length * length],
        ];
        let f = [
            -half * sin * v * v + 1.5 * mass * GRAVITY * length * a.cos(),
            half * sin * u * u + 0.5 * mass * GRAVITY * length * b.cos(),
        ];
        let det = m[0][0] * m[1][1] - m[0][1] * m[1][0];
        [u, v, (m[1][1] * f[0] - m[0][1] * f[1]) / det, (m[0][0] * f[1] - m[1][0] * f[0]) / det]
    };
    let steps = 20_000;
    let h = SWING / steps as f64;
    let mut x = [0.0; 4];
    let ahead = |x: [f64; 4], k: [f64; 4], c: f64| [0, 1, 2, 3].map(|i| x[i] + c * k[i]);
    for _ in 0..steps {
        let k1 = rate(x);
        let k2 = rate(ahead(x, k1, 0.5 * h));
        let k3 = rate(ahead(x, k2, 0.5 * h));
        let k4 = rate(ahead(x, k3, h));
        x = [0, 1, 2, 3].map(|i| x[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
    }
    x
}

/// Two uniform rods on hinges about y, in the plane of x and z, against Lagrange's equations in two angles.
#[test]
fn a_double_pendulum_moves_as_its_two_angles() {
    let (length, mass) = (1.0, 1.0);
    let inertia = mass * length * length / 12.0;
    let mut model = Model::new().with_gravity([0.0, 0.0, -GRAVITY]);
    let y = ([0.0, 1.0, 0.0], None);
    let one = model.body(Body::new("one", mass, [0.001, inertia, inertia]).at([0.5, 0.0, 0.0]));
    let two = model.body(Body::new("two", mass, [0.001, inertia, inertia]).at([1.5, 0.0, 0.0]));
    model.join("root", Kind::Revolute, [Part::Ground, one], [0.0; 3], y).unwrap();
    model.join("elbow", Kind::Revolute, [one, two], [1.0, 0.0, 0.0], y).unwrap();
    let mut system = Multibody::new(model).unwrap();
    let (end, x) = (SWING, two_angles(length, mass));
    for (mut method, step, name) in methods(1e-3) {
        let allowed = if step.is_some() { 2e-4 } else { 1e-7 };
        let (s, imbalance) = run(&mut system, method.as_mut(), end, step, |_, _| {});
        let angles = [channel(&mut system, &s, "root.angle"), channel(&mut system, &s, "elbow.angle")];
        let far = (angles[0] - x[0]).abs().max((angles[0] + angles[1] - x[1]).abs());
        println!("double pendulum, {name}: {far:.1e}, imbalance {imbalance:.1e}");
        assert!(far < allowed, "{name}: {angles:?} for {x:?}");
        assert!(imbalance < 10.0 * allowed, "{name}: {imbalance:e}");
    }
}

/// Two slender beams on hinges in the place of the rods: they come to the same place as they become stiffer, in proportion to their
/// flexibility.
#[test]
fn a_double_pendulum_of_beams_becomes_that_of_rods() {
    let x = two_angles(1.0, 1.0);
    let expected = [x[0].cos() + x[1].cos(), -x[0].sin() - x[1].sin()];
    let far = |stiffness: f64| {
        let mut model = Model::new().with_gravity([0.0, 0.0, -GRAVITY]);
        let elements = 4;
        let beams = [0.0, 1.0].map(|x| {
            let root = Station {
                position: Vec3([x, 0.0, 0.0]),
                tangent: Vec3([1.0, 0.0, 0.0]),
                normal: Vec3([0.0, 0.0, 1.0]),
            };
            let section =
                Properties::principal([1e3, 1.0, 1.0, 1.0].map(|x| stiffness * x), 1.0, [1e-3, 0.0, 0.0]);
            let beam = Beam::straight(root, 1.0, elements, section).unwrap();
            model.beam(Flexible::new(&format!("beam {x}"), beam))
        });
        let [one, two] = beams.map(|beam| [0, elements].map(|node| Part::Section { beam, node }));
        let y = ([0.0, 1.0, 0.0], None);
        model.join("root", Kind::Revolute, [Part::Ground, one[0]], [0.0; 3], y).unwrap();
        model.join("elbow", Kind::Revolute, [one[1], two[0]], [1.0, 0.0, 0.0], y).unwrap();
        let mut system = Multibody::new(model).unwrap();
        let method = GeneralizedAlpha::chung_hulbert(0.6).unwrap();
        let (s, _) = run(&mut system, &method, SWING, Some(2.5e-4), |_, _| {});
        let tip = ["x", "z"].map(|axis| channel(&mut system, &s, &format!("beam 1.tip.position.{axis}")));
        (tip[0] - expected[0]).hypot(tip[1] - expected[1])
    };
    let [soft, stiff] = [2e3, 1e4].map(far);
    println!("double pendulum of beams: {soft:.1e}, {stiff:.1e}");
    assert!(stiff < 5e-3 && (3.5..7.0).contains(&(soft / stiff)), "{soft:e} {stiff:e}");
}

/// A hinge, a ball, a cross and a hinge make a plane four-bar without redundant rows; a parallelogram of cranks (m, a) and
/// a coupler (M) is the pendulum (⅔ m + M) a² θ̈ = −(m + M) g a sin θ. With four hinges and dropped rows it is the same.
#[test]
fn a_closed_four_bar_swings_like_its_pendulum() {
    let (a, b, m, coupler) = (0.4_f64, 0.9, 0.8, 1.8);
    let theta: f64 = 0.8;
    let (sin, cos) = theta.sin_cos();
    let build = |kinds: [Kind; 4], drop: bool| {
        let mut model = Model::new().with_gravity([0.0, 0.0, -GRAVITY]);
        let crank = m * a * a / 12.0;
        let mut body =
            |name: &str, mass, inertia, x, z| model.body(Body::new(name, mass, [inertia; 3]).at([x, 0.0, z]));
        let parts = [
            body("left", m, crank, 0.5 * a * sin, -0.5 * a * cos),
            body("coupler", coupler, coupler * b * b / 12.0, a * sin + 0.5 * b, -a * cos),
            body("right", m, crank, b + 0.5 * a * sin, -0.5 * a * cos),
        ];
        for ((name, ends, point), kind) in [
            ("A", [Part::Ground, parts[0]], [0.0, 0.0, 0.0]),
            ("B", [parts[0], parts[1]], [a * sin, 0.0, -a * cos]),
            ("C", [parts[1], parts[2]], [a * sin + b, 0.0, -a * cos]),
            ("D", [Part::Ground, parts[2]], [b, 0.0, 0.0]),
        ]
        .into_iter()
        .zip(kinds)
        {
            // The arms of the cross lie in the plane of its bars and across it.
            model
                .join(name, kind, ends, Vec3(point), (Vec3([0.0, -1.0, 0.0]), Some(Vec3([1.0, 0.0, 0.0]))))
                .unwrap();
        }
        Multibody::new(if drop { model.drop_redundant_rows() } else { model }).unwrap()
    };
    let end = 1.2;
    let square = (m + coupler) * GRAVITY / ((2.0 / 3.0 * m + coupler) * a);
    let (mut x, mut v, steps) = (theta, 0.0, 20_000);
    let h = end / steps as f64;
    let f = |x: f64| -square * x.sin();
    for _ in 0..steps {
        let (x1, v1) = (v, f(x));
        let (x2, v2) = (v + 0.5 * h * v1, f(x + 0.5 * h * x1));
        let (x3, v3) = (v + 0.5 * h * v2, f(x + 0.5 * h * x2));
        let (x4, v4) = (v + h * v3, f(x + h * x3));
        x += h / 6.0 * (x1 + 2.0 * x2 + 2.0 * x3 + x4);
        v += h / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4);
    }
    for (kinds, drop) in [
        ([Kind::Revolute, Kind::Cylindrical, Kind::Spherical, Kind::Revolute], false),
        ([Kind::Revolute; 4], true),
    ] {
        let mut system = build(kinds, drop);
        assert_eq!(system.freedoms(), 1);
        for (mut method, step, name) in methods(1e-3) {
            let allowed = if step.is_some() { 2e-5 } else { 1e-8 };
            let mut worst = 0.0_f64;
            let (s, imbalance) = run(&mut system, method.as_mut(), end, step, |system, s| {
                let mut g = vec![0.0; s.lambda.len()];
                system.constraint(s, RowWeights::POSITION, &mut g);
                worst = g.iter().fold(worst, |m, g| m.max(g.abs()));
            });
            let angle = theta + channel(&mut system, &s, "A.angle");
            if name == "radau" {
                assert_eq!(dynamics(&mut system, &pushed(&s)), []);
            }
            println!("four-bar, {name}: {:.1e}, g {worst:.1e}, imbalance {imbalance:.1e}", angle - x);
            assert!((angle - x).abs() < allowed, "{name}: {angle} for {x}");
            assert!(worst < 1e-6 && imbalance < 100.0 * allowed, "{name}: {worst:e} {imbalance:e}");
        }
    }
}

/// Two shafts at the angle β on a cross: tan θ₂ = tan θ₁/cos β, ω₂/ω₁ = cos β/(1 − sin²β cos²θ₁), through whole turns.
#[test]
fn a_universal_joint_turns_its_shafts_at_the_ratio_of_its_angle() {
    let beta: f64 = 0.6;
    let (sin, cos) = beta.sin_cos();
    let mut model = Model::new();
    let out_axis = [cos, 0.0, sin];
    let input = model.body(Body::new("input", 1.0, [0.1; 3]).at([-0.5, 0.0, 0.0]));
    let output = model.body(Body::new("output", 1.0, [0.1; 3]).at([0.5 * cos, 0.0, 0.5 * sin]));
    let motor = model.join(
        "motor",
        Kind::Revolute,
        [Part::Ground, input],
        Vec3([-1.0, 0.0, 0.0]),
        (Vec3([1.0, 0.0, 0.0]), None),
    );
    motor.unwrap().drive = Drive::Prescribed(Motion::Angle(profile("2*t + 0.3*t^2")));
    let bearing = [cos, 0.0, sin];
    model
        .join("bearing", Kind::Cylindrical, [Part::Ground, output], Vec3(bearing), (Vec3(out_axis), None))
        .unwrap();
    // Arms: along y on the input, in the plane of the shafts and across the output on the other.
    let normal = [-cos, 0.0, -sin];
    model
        .join(
            "cross",
            Kind::Universal,
            [input, output],
            Vec3([0.0; 3]),
            (Vec3(normal), Some(Vec3([0.0, 1.0, 0.0]))),
        )
        .unwrap();
    // The cross holds a point of the output shaft, so that the bearing holds its direction twice.
    let mut system = Multibody::new(model.drop_redundant_rows()).unwrap();
    assert_eq!((system.freedoms(), system.dropped().len()), (0, 2));
    let start = pushed(&system.initial());
    assert_eq!(dynamics(&mut system, &start), []);
    let (s, _) = run(&mut system, &radau(1e-11), 4.0, None, |_, _| {});
    let angle: f64 = 2.0 * 4.0 + 0.3 * 16.0;
    let speed = 2.0 + 0.6 * 4.0;
    // The arm of the input starts across the plane of the shafts: tan θ₂ = cos β tan θ₁.
    let turned = (cos * angle.sin()).atan2(angle.cos());
    let found = channel(&mut system, &s, "bearing.angle");
    let turns = ((found - turned) / std::f64::consts::TAU).round();
    assert!(turns == 2.0, "{turns}");
    assert!((found - turned - turns * std::f64::consts::TAU).abs() < 1e-9, "{found} for {turned}");
    let ratio = cos / (1.0 - sin * sin * angle.sin().powi(2));
    let found = channel(&mut system, &s, "bearing.speed");
    assert!((found / (ratio * speed) - 1.0).abs() < 1e-9, "{found} for {}", ratio * speed);
}

/// A crank of length r that turns as prescribed, a rod of length l, and a slider: x = r cos θ + √(l² − r² sin² θ).
#[test]
fn a_slider_crank_moves_by_its_closed_form() {
    let (r, l): (f64, f64) = (0.15, 0.4);
    let theta: f64 = 0.3;
    let place = |theta: f64| r * theta.cos() + (l * l - (r * theta.sin()).powi(2)).sqrt();
    let pin = [r * theta.cos(), r * theta.sin(), 0.0];
    let x = place(theta);
    let mut model = Model::new();
    let crank = model.body(Body::new("crank", 1.0, [0.01; 3]).at(pin.map(|x| 0.5 * x)));
    let rod = model.body(Body::new("rod", 0.5, [0.02; 3]).at([0.5 * (pin[0] + x), 0.5 * pin[1], 0.0]));
    let slider = model.body(Body::new("slider", 0.8, [0.01; 3]).at([x, 0.0, 0.0]));
    let z = ([0.0, 0.0, 1.0], None);
    let motor = model.join("motor", Kind::Revolute, [Part::Ground, crank], [0.0; 3], z).unwrap();
    motor.drive = Drive::Prescribed(Motion::Angle(profile("5*t")));
    model
        .join(
            "pin",
            Kind::Universal,
            [crank, rod],
            Vec3(pin),
            (Vec3([1.0, 0.0, 0.0]), Some(Vec3([0.0, 0.0, 1.0]))),
        )
        .unwrap();
    model.join("wrist", Kind::Spherical, [rod, slider], [x, 0.0, 0.0], z).unwrap();
    model
        .join(
            "guide",
            Kind::Prismatic,
            [Part::Ground, slider],
            Vec3([x, 0.0, 0.0]),
            (Vec3([1.0, 0.0, 0.0]), None),
        )
        .unwrap();
    let mut system = Multibody::new(model).unwrap();
    assert_eq!(system.freedoms(), 0);
    let end = 2.0;
    for (mut method, step, name) in methods(1e-3) {
        let (s, imbalance) = run(&mut system, method.as_mut(), end, step, |_, _| {});
        let exact = place(theta + 5.0 * end) - x;
        let found = channel(&mut system, &s, "guide.displacement");
        assert!((found - exact).abs() < 1e-9, "{name}: {found} for {exact}");
        assert!(imbalance < 1e-3, "{name}: {imbalance:e}");
    }
}

/// A body of 2 kg that rotates evenly about a hinge, with its centre of mass off the axis and its weight along it: the hinge
/// takes up the moment m g r across the axis, which moves nothing.
#[test]
fn the_moment_that_a_hinge_takes_up_is_that_of_the_weight() {
    let (mass, arm, speed) = (2.0, 0.5, 3.0);
    let mut model = Model::new().with_gravity([0.0, 0.0, -GRAVITY]);
    let mut body = Body::new("arm", mass, [0.01, 0.1, 0.1]);
    body.frame.position = Vec3([arm, 0.0, 0.0]);
    let body = model.body(body);
    let hinge = model.join(
        "hinge",
        Kind::Revolute,
        [Part::Ground, body],
        Vec3([0.0; 3]),
        (Vec3([0.0, 0.0, 1.0]), None),
    );
    hinge.unwrap().drive = Drive::Prescribed(Motion::Speed { profile: profile("3"), initial_angle: 0.0 });
    let mut system = Multibody::new(model).unwrap();
    for tolerance in [1e-6, 1e-8] {
        let mut furthest = 0.0_f64;
        let (end, imbalance) = run(&mut system, &radau(tolerance), 20.0, None, |system, s| {
            let channels = system.channels();
            let mut values = vec![0.0; channels.len()];
            system.record(s, &mut values);
            let of = |name: &str| values[channels.iter().position(|c| c.name == name).unwrap()];
            // The moment lies along the tangent of the circle.
            let (sin, cos) = (speed * s.t).sin_cos();
            let moment = mass * GRAVITY * arm;
            let [x, y] = [of("hinge.moment.x") / moment, of("hinge.moment.y") / moment];
            furthest = furthest.max((x.abs() - sin.abs()).abs().max((y.abs() - cos.abs()).abs()));
        });
        // λ is that of a stage: of order 3.
        assert!(furthest < 5e-3, "{furthest:e} at {tolerance:e}");
        assert!(imbalance < 1e-3 && end.t == 20.0, "{imbalance:e}");
    }
}
