//! What a run says of the steps that events of rigid contacts cut: forces of contacts, friction and the torque of a clamp.

#![allow(clippy::unwrap_used)] // in helpers of tests

use crate::written::{finished, reading};

/// A metre of steel strip with 0.2 kg at its tip falls by 5 cm onto a rough plane without restitution: it strikes, slides, sticks and slides again.
/// Largest contact force 507.88 N, right behind the impact, and torque of the clamp by Radau's method at all tolerances and by the α methods with
/// steps down to 20 μs.
const STRIP: &str = r#"
gravity = [0, "-9.81 m/s^2"]
[beam]
length = "1 m"
[section]
kind = "rectangle"
modulus = "200 GPa"
density = "7800 kg/m^3"
width = "3 cm"
height = "3 mm"
[hub]
motion = { kind = "constant", speed = 0 }
[[mass]]
on = "tip"
mass = "0.2 kg"
[[contact]]
name = "stop"
on = "tip"
obstacle = { kind = "plane", point = [0, "-5 cm"], normal = [0, 1] }
law = { kind = "constraint", restitution = 0, friction = 0.3 }
[damping]
stiffness = "2e-4 s"
[model]
coupling = "exact"
[run]
duration = "0.31 s"
"#;

/// Largest force of the stop, extremes of the torque of the hub, and largest friction and speed along the stop of a run of the strip.
fn of_strip(set: &[&str]) -> [f64; 5] {
    let run = finished(&reading(STRIP, set));
    let of = |name: &str| run.trajectory.index(name).map(|index| run.trajectory.extremes(index));
    let [force, torque, speed] =
        ["stop.force", "hub.torque", "tip.axial_velocity"].map(|name| of(name).unwrap());
    let friction = of("stop.friction").map_or(0.0, |friction| friction.max.max(-friction.min));
    [force.max, torque.min, torque.max, friction, speed.max.max(-speed.min)]
}

#[test]
fn radau_holds_the_torque_of_a_clamp_behind_events_at_every_tolerance() {
    for (coupling, force, torque) in
        [("exact", 507.88, [-0.1696, 6.249]), ("first", 333.64, [-0.1662, 6.237])]
    {
        for tolerance in ["1e-5", "1e-6", "1e-7", "1e-8", "1e-9"] {
            let method = format!("integrator.tolerance={tolerance}");
            let [largest, least, most, friction, _] =
                of_strip(&[&method, &format!("model.coupling={coupling}")]);
            let what = format!("{coupling} {tolerance}: {largest} {least} {most}");
            assert!((largest / force - 1.0).abs() < 1e-3, "{what}");
            assert!((least - torque[0]).abs() < 2e-3 && (most / torque[1] - 1.0).abs() < 5e-3, "{what}");
            assert!(friction <= 0.3 * largest * (1.0 + 1e-9), "{what}: {friction}");
        }
    }
}

/// An implicit Euler start behind the impact brings to rest what the trapezium would let ring, 16 kN at 0.5 ms.
#[test]
fn fixed_steps_hold_the_force_of_a_stop_behind_events() {
    for kind in ["newmark", "hht", "generalized-alpha"] {
        for (step, off) in [("5e-4", 0.02), ("2e-4", 0.01), ("1e-4", 0.005)] {
            let method = format!("integrator={{kind='{kind}',step={step}}}");
            let [largest, least, most, friction, slid] = of_strip(&[&method]);
            let what = format!("{kind} {step}: {largest} {least} {most} {friction} {slid}");
            assert!((largest / 507.88 - 1.0).abs() < 1e-3 && friction <= 0.3001 * largest, "{what}");
            assert!((least + 0.1696).abs() < off && (most / 6.249 - 1.0).abs() < off, "{what}");
            assert!((slid / 0.05294 - 1.0).abs() < 1e-3, "{what}");
        }
        let method = format!("integrator={{kind='{kind}',step=1e-4}}");
        let smooth = ["contact.law.friction=0", "model.coupling=space", "run.duration=0.2", &method];
        let [largest, least, most, _, slid] = of_strip(&smooth);
        let what = format!("{kind} in space: {largest} {least} {most} {slid}");
        assert!((largest / 1184.27 - 1.0).abs() < 1e-3 && (slid / 0.05294 - 1.0).abs() < 1e-3, "{what}");
        assert!((least + 0.1872).abs() < 5e-3 && (most / 6.254 - 1.0).abs() < 5e-3, "{what}");
    }
}

/// A pendulum without damping that bounces from the ground (P4): its vibrations keep their energy behind impacts, in steps in which they
/// are followed and in larger ones, and the largest deflection is that of `radau` to a part of the step.
#[test]
fn fixed_steps_keep_the_energy_of_undamped_vibrations_behind_impacts() {
    let text = include_str!("../../verification/falling_pendulum/case.toml");
    let of = |method: &str| {
        let set = [
            "contact.law.restitution=0.5",
            "basis={kind='modes',axial=3,transverse=3}",
            "run.duration=0.5",
            method,
        ]
        .map(str::to_owned);
        let reading = flexion_case::parse(text.to_owned(), "case.toml".as_ref(), &set).unwrap();
        let run = reading.prepare().unwrap().run(&mut |_| std::ops::ControlFlow::Continue(()));
        let column = |name: &str| run.trajectory.extremes(run.trajectory.index(name).unwrap());
        (column("tip.deflection").max, column("energy.balance").min)
    };
    let (right, _) = of("integrator={kind='radau',tolerance=1e-7}");
    // The methods with dissipation lose what theirs is at high frequencies: 2 % of 3 J at most.
    for (method, off, lost) in [
        ("integrator={kind='newmark',step=2e-4}", 0.01, 0.01),
        ("integrator={kind='newmark',step=1e-4}", 0.003, 0.01),
        ("integrator={kind='generalized-alpha',step=1e-4}", 0.003, 0.03),
    ] {
        let (most, balance) = of(method);
        assert!((most / right - 1.0).abs() < off, "{method}: {most} for {right}");
        assert!(balance > -lost, "{method}: {balance}");
    }
}
