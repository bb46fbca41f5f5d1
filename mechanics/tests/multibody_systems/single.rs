//! One body: free rotation, free flight, a rail, a motor, a spring.

use super::conformance::profile;
use super::{GRAVITY, channel, odd_rotation, radau, run};
use flexion::drive::{Actuator, Controller};
use flexion::integrator::{GeneralizedAlpha, RungeKutta};
use flexion::linalg::Vec3;
use flexion::multibody::{Axes, Body, Directions, Drive, Kind, Load, Marker, Model, Multibody, Part, Spring};
use flexion::profile::Motion;
use flexion::system::{Dynamics, Observed};

/// A body on a joint with the ground at the origin.
fn on_ground(body: Body, kind: Kind, axis: [f64; 3], drive: Drive) -> Multibody {
    let mut model = Model::new().with_gravity([0.0, 0.0, -GRAVITY]);
    let part = model.body(body);
    model.join("joint", kind, [Part::Ground, part], Vec3([0.0; 3]), (Vec3(axis), None)).unwrap().drive =
        drive;
    Multibody::new(model).unwrap()
}

/// Euler's equations of an asymmetric body that turns about nearly its middle axis: it tumbles, and keeps its energy and
/// its angular momentum in space.
#[test]
fn a_free_body_tumbles_and_keeps_energy_and_momentum() {
    let mut model = Model::new();
    let mut body = Body::new("book", 2.0, [0.1, 0.2, 0.25]);
    body.centre = Vec3([0.3, -0.2, 0.1]);
    body.frame.rotation = odd_rotation(0.4);
    body.spin = Some(body.frame.rotation * Vec3([0.05, 5.0, 0.02]));
    body.velocity = Some(Vec3([0.3, -0.1, 0.2]));
    model.body(body);
    let mut system = Multibody::new(model).unwrap();
    let start = system.initial();
    let (energy, [linear, angular]) = (system.energy(&start).total(), system.momenta(&start));
    let mut turned = false;
    let (end, _) = run(&mut system, &radau(1e-12), 10.0, None, |_, s| turned |= s.v[4] < -4.9);
    assert!(turned, "a body that turns about its middle axis turns over");
    let [p, l] = system.momenta(&end);
    assert!((system.energy(&end).total() / energy - 1.0).abs() < 1e-10);
    for i in 0..3 {
        assert!((p[i] - linear[i]).abs() < 1e-12, "{p:?} for {linear:?}");
        assert!((l[i] - angular[i]).abs() < 1e-10, "{l:?} for {angular:?}");
    }
}

/// A symmetric body in free flight: precession by Ω_n = (J₁ − J₃)/J₁ ω₃ in its own axes, and a parabola.
#[test]
fn a_symmetric_body_precesses_by_its_closed_form() {
    let mut model = Model::new().with_gravity([0.0, 0.0, -GRAVITY]);
    let mut body = Body::new("plate", 1.0, [0.2, 0.2, 0.35]).at([0.0, 0.0, 1.0]);
    let (along, across) = (3.0, 0.8);
    body.spin = Some(Vec3([across, 0.0, along]));
    body.velocity = Some(Vec3([1.0, 0.0, 2.0]));
    model.body(body);
    let mut system = Multibody::new(model).unwrap();
    let end = 1.7;
    let (s, _) = run(&mut system, &radau(1e-11), end, None, |_, _| {});
    let angle = (0.35 - 0.2) / 0.2 * along * end;
    for (x, exact) in s.v[3..6].iter().zip([across * angle.cos(), across * angle.sin(), along]) {
        assert!((x - exact).abs() < 1e-9, "{:?}", &s.v[3..]);
    }
    let height = 1.0 + 2.0 * end - 0.5 * GRAVITY * end * end;
    assert!((channel(&mut system, &s, "plate.position.x") - end).abs() < 1e-12);
    assert!((channel(&mut system, &s, "plate.position.z") - height).abs() < 1e-11);
}

/// On a rail with the slope n: u = ½ (g·n) t², and the forces of the rail hold the rest of the weight.
#[test]
fn a_body_slides_down_a_rail_without_friction() {
    let axis = [0.6, 0.0, 0.8];
    let mut body = Body::new("slider", 3.0, [0.1, 0.2, 0.3]);
    body.centre = Vec3([0.1, 0.2, -0.05]);
    let mut system = on_ground(body, Kind::Prismatic, axis, Drive::None);
    let methods: [(Box<dyn flexion::integrator::Integrator>, Option<f64>); 2] = [
        (Box::new(radau(1e-10)), None),
        (Box::new(GeneralizedAlpha::chung_hulbert(0.8).unwrap()), Some(1e-2)),
    ];
    for (mut method, step) in methods {
        let (s, imbalance) = run(&mut system, method.as_mut(), 1.0, step, |_, _| {});
        assert!((channel(&mut system, &s, "joint.displacement") + 0.5 * 0.8 * GRAVITY).abs() < 1e-10);
        let force = ["x", "y", "z"].map(|c| channel(&mut system, &s, &format!("joint.force.{c}")));
        // −m g + m (g·n) n
        let exact = [-3.0 * GRAVITY * 0.8 * 0.6, 0.0, 3.0 * GRAVITY * (1.0 - 0.64)];
        assert!((0..3).all(|i| (force[i] - exact[i]).abs() < 1e-7), "{force:?} for {exact:?}");
        assert!(imbalance < 1e-9, "{imbalance:e}");
    }
}

/// A hinge with a prescribed angle is the planar hub: the torque is (J + m a²) θ̈ + m g a cos θ, and the hinge holds the
/// centripetal force.
#[test]
fn a_prescribed_hinge_takes_the_torque_of_its_inertia() {
    let (mass, arm, inertia) = (2.0, 0.7, 0.3);
    let mut body = Body::new("arm", mass, [0.05, inertia, inertia]);
    body.centre = Vec3([arm, 0.0, 0.0]);
    // About −y, so that a positive angle lifts the arm.
    let motion = Motion::Angle(profile("1.5*t^2 + 0.2*sin(3*t)"));
    let mut system = on_ground(body, Kind::Revolute, [0.0, -1.0, 0.0], Drive::Prescribed(motion));
    let end = 2.6;
    let (s, imbalance) = run(&mut system, &radau(1e-11), end, None, |_, _| {});
    let (angle, speed) = (1.5 * end * end + 0.2 * (3.0 * end).sin(), 3.0 * end + 0.6 * (3.0 * end).cos());
    let acceleration = 3.0 - 1.8 * (3.0 * end).sin();
    let torque = (inertia + mass * arm * arm) * acceleration + mass * GRAVITY * arm * angle.cos();
    // The angle is counted on beyond a turn.
    assert!(angle > 10.0 && (channel(&mut system, &s, "joint.angle") - angle).abs() < 1e-9);
    assert!((channel(&mut system, &s, "joint.speed") - speed).abs() < 1e-8);
    let found = channel(&mut system, &s, "joint.torque");
    assert!((found / torque - 1.0).abs() < 1e-5, "{found} for {torque}");
    let axial = mass * (-speed * speed * arm * angle.cos() - acceleration * arm * angle.sin());
    let found = channel(&mut system, &s, "joint.force.x");
    assert!((found - axial).abs() < 1e-4 * axial.abs(), "{found} for {axial}");
    // Of 35 J: the balance takes multipliers as linear within a step.
    assert!(imbalance < 3e-4, "{imbalance:e}");
}

/// The moment m g a of the weight on an upright hinge turns with the arm and moves nothing: over ten turns with few tangents it neither
/// grows nor lags behind.
#[test]
fn an_upright_hinge_takes_the_moment_of_the_weight_over_many_turns() {
    let (mass, arm, speed) = (2.0, 0.7, 4.0);
    for sign in [1.0, -1.0] {
        let mut model = Model::new().with_gravity([0.0, 0.0, -GRAVITY]);
        let mut body = Body::new("arm", mass, [0.05, 0.3, 0.3]);
        body.centre = Vec3([arm, 0.0, 0.0]);
        let part = model.body(body);
        let parts = if sign > 0.0 { [Part::Ground, part] } else { [part, Part::Ground] };
        let axis = (Vec3([0.0, 0.0, 1.0]), None);
        let hinge = model.join("hinge", Kind::Revolute, parts, Vec3([0.0; 3]), axis).unwrap();
        hinge.drive = Drive::Prescribed(Motion::Angle(profile(&format!("{}*t", sign * speed))));
        let mut system = Multibody::new(model).unwrap();
        let method = GeneralizedAlpha::chung_hulbert(0.8).unwrap();
        let mut off = 0.0_f64;
        run(&mut system, &method, 16.0, Some(2e-3), |system, s| {
            let (channels, mut row) = (system.channels(), vec![0.0; system.channels().len()]);
            system.record(s, &mut row);
            let at =
                |axis: &str| channels.iter().position(|c| c.name == format!("hinge.moment.{axis}")).unwrap();
            let (sin, cos) = (speed * s.t).sin_cos();
            let moment = sign * mass * GRAVITY * arm;
            for (axis, exact) in [("x", moment * sin), ("y", -moment * cos), ("z", 0.0)] {
                off = off.max((row[at(axis)] - exact).abs());
            }
        });
        assert!(off < 1e-4, "{sign}: {off:e}");
    }
}

/// A rotor on a motor with spring, damper and controller against the same equation with one unknown:
/// J θ̈ = f(t) − c θ̇ − k (θ − θ_k) + K_p (θ_r − θ) + K_d (θ̇_r − θ̇), over several turns.
#[test]
fn a_motor_drives_a_rotor_as_its_equation_says() {
    let actuator = Actuator {
        torque: profile("0.4*sin(2*t)"),
        damping: 0.1,
        stiffness: 0.5,
        rest_angle: 0.2,
        controller: Some(Controller {
            proportional: 6.0,
            derivative: 1.5,
            reference: Motion::Angle(profile("6*t")),
            limit: f64::INFINITY,
        }),
    };
    let inertia = 0.4;
    let body = Body::new("rotor", 1.0, [0.3, 0.3, inertia]);
    let mut system = on_ground(body, Kind::Revolute, [0.0, 0.0, 1.0], Drive::Actuated(actuator));
    let end = 4.0;
    let (s, imbalance) = run(&mut system, &radau(1e-11), end, None, |_, _| {});
    let rate = |t: f64, x: f64, v: f64| {
        let torque =
            0.4 * (2.0 * t).sin() - 0.1 * v - 0.5 * (x - 0.2) + 6.0 * (6.0 * t - x) + 1.5 * (6.0 - v);
        torque / inertia
    };
    let (mut x, mut v) = (0.0, 0.0);
    let steps = 20_000;
    let h = end / steps as f64;
    for k in 0..steps {
        let t = k as f64 * h;
        let (x1, v1) = (v, rate(t, x, v));
        let (x2, v2) = (v + 0.5 * h * v1, rate(t + 0.5 * h, x + 0.5 * h * x1, v + 0.5 * h * v1));
        let (x3, v3) = (v + 0.5 * h * v2, rate(t + 0.5 * h, x + 0.5 * h * x2, v + 0.5 * h * v2));
        let (x4, v4) = (v + h * v3, rate(t + h, x + h * x3, v + h * v3));
        x += h / 6.0 * (x1 + 2.0 * x2 + 2.0 * x3 + x4);
        v += h / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4);
    }
    assert!(x > 15.0);
    let found = [channel(&mut system, &s, "joint.angle"), channel(&mut system, &s, "joint.speed")];
    assert!((found[0] - x).abs() < 1e-7 && (found[1] - v).abs() < 1e-6, "{found:?} for {x} {v}");
    assert!(imbalance < 1e-5, "{imbalance:e}");
}

/// A mass on a spring that acts in all directions: each of the three is a damped oscillator of its own, also through the anchor.
#[test]
fn a_mass_on_a_spring_in_all_directions_is_three_oscillators() {
    let (mass, stiffness, damping, end) = (1.5, 60.0, 1.2, 3.0);
    let anchor = Vec3([0.2, -0.1, 0.4]);
    let (place, velocity) = (Vec3([0.3, 0.0, -0.2]), Vec3([0.0, 1.1, -0.7]));
    let mut model = Model::new();
    let body = Body { velocity: Some(velocity), ..Body::new("mass", mass, [0.1; 3]) };
    let part = model.body(body.at(anchor + place));
    let [from, to] = [Marker::new(Part::Ground, anchor), Marker::new(part, [0.0; 3])];
    let directions = Directions::All;
    model.spring(Spring { name: "spring".into(), from, to, stiffness, damping, length: 0.0, directions });
    let mut system = Multibody::new(model).unwrap();
    let (s, imbalance) = run(&mut system, &RungeKutta::new(), end, Some(1e-3), |_, _| {});
    let decay = damping / (2.0 * mass);
    let omega = (stiffness / mass - decay * decay).sqrt();
    let (sin, cos) = (omega * end).sin_cos();
    let exact = (-decay * end).exp() * (cos * place + sin / omega * (velocity + decay * place));
    let found = Vec3::at(&s.q, 0) - anchor;
    assert!((found - exact).norm() < 1e-9, "{found:?} for {exact:?}");
    assert!(imbalance < 1e-7, "{imbalance:e}");
}

/// A mass on a spring to the ground, along a line that is no axis: ω = √(k/m), with damping.
#[test]
fn a_mass_on_a_spring_vibrates_by_its_closed_form() {
    let (mass, stiffness, damping) = (1.5, 60.0, 1.2);
    let direction = odd_rotation(0.3).column(0);
    let mut model = Model::new();
    let part = model.body(Body::new("mass", mass, [0.1; 3]).at(direction.map(|x| 1.3 * x)));
    let [from, to] = [Marker::new(Part::Ground, [0.0; 3]), Marker::new(part, [0.0; 3])];
    model.spring(Spring {
        name: "spring".into(),
        from,
        to,
        stiffness,
        damping,
        length: 1.0,
        directions: Directions::Line,
    });
    let mut system = Multibody::new(model).unwrap();
    let end = 3.0;
    let method = RungeKutta::new();
    let (s, imbalance) = run(&mut system, &method, end, Some(1e-3), |_, _| {});
    let decay = damping / (2.0 * mass);
    let omega = (stiffness / mass - decay * decay).sqrt();
    let (sin, cos) = (omega * end).sin_cos();
    let exact = 1.0 + 0.3 * (-decay * end).exp() * (cos + decay / omega * sin);
    let length = s.q[..3].iter().map(|x| x * x).sum::<f64>().sqrt();
    assert!((length - exact).abs() < 1e-9, "{length} for {exact}");
    let rate = -0.3 * (-decay * end).exp() * stiffness / (mass * omega) * sin;
    let force = stiffness * (exact - 1.0) + damping * rate;
    let found = ["spring.length", "spring.force"].map(|name| channel(&mut system, &s, name));
    assert!(
        (found[0] - exact).abs() < 1e-9 && (found[1] - force).abs() < 1e-7,
        "{found:?} for {exact} {force}"
    );
    assert!(imbalance < 1e-6, "{imbalance:e}");
}

/// A follower force through the centre of mass and a dead couple about an axis of symmetry.
#[test]
fn a_follower_force_turns_with_its_body_and_a_dead_couple_does_not() {
    let mut model = Model::new();
    let part = model.body(Body::new("disc", 2.0, [0.2, 0.2, 0.4]));
    let load = |name: &str, axes, force, moment| Load {
        name: name.to_owned(),
        at: Marker::new(part, [0.0; 3]),
        force,
        moment,
        axes,
        amplitude: None,
    };
    model.load(load("thrust", Axes::Follower, Vec3([4.0, 0.0, 0.0]), Vec3([0.0; 3])));
    model.load(load("couple", Axes::Dead, Vec3([0.0; 3]), Vec3([0.0, 0.0, 0.2])));
    let mut system = Multibody::new(model).unwrap();
    let end: f64 = 2.0;
    let (s, imbalance) = run(&mut system, &radau(1e-11), end, None, |_, _| {});
    assert!((s.v[5] - 0.5 * end).abs() < 1e-10);
    // v = ∫ F/m (cos, sin)(¼ t²) dt by Simpson's rule.
    let n = 2000;
    let weight = |k: usize| {
        if k == 0 || k == n {
            1.0
        } else if k % 2 == 1 {
            4.0
        } else {
            2.0
        }
    };
    let integral = |f: &dyn Fn(f64) -> f64| {
        (0..=n).map(|k| weight(k) * f(end * k as f64 / n as f64)).sum::<f64>() * end / (3 * n) as f64
    };
    let exact = [integral(&|t| 2.0 * (0.25 * t * t).cos()), integral(&|t| 2.0 * (0.25 * t * t).sin())];
    assert!((s.v[0] - exact[0]).abs() < 1e-9 && (s.v[1] - exact[1]).abs() < 1e-9, "{:?} {exact:?}", s.v);
    assert!(imbalance < 1e-8, "{imbalance:e}");
}
