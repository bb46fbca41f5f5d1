//! Contacts of bodies and beams in space: several points, steps of many radians, and whole bursts of impacts.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use crate::written::{finished, outcome, reading};
use flexion_case::{Effort, Reading, Run};
use flexion_results::Status;
use std::f64::consts::PI;
use std::ops::ControlFlow;

/// A rod in space falls with its tip onto a floor: the mass that takes part there is one of the mesh, that of a body is not.
#[test]
fn restitution_of_a_point_of_a_beam_in_space_is_one_of_the_mesh() {
    let case = |more: &str, on: &str| {
        let text = format!(
            "run={{duration=0.01}}\ngravity=[0,0,-9.81]\n[[beam]]\nname='rod'\nlength=1\nroot='hinged'\nelements=4\n\
             section={{kind='circle',modulus=70e9,density=2700,radius=0.01}}\ndirection=[1,0,1]\n{more}\
             [[contact]]\nname='floor'\non='{on}'\nobstacle={{kind='plane',normal=[0,0,1]}}\nlaw={{kind='constraint',restitution=0.5}}\n"
        );
        let run = finished(&reading(&text, &[]));
        run.warnings
            .iter()
            .any(|w| w.contains("effective mass at floor") && w.contains("parameter of the mesh"))
    };
    assert!(case("", "rod.tip"));
    let ball = "[[body]]\nname='ball'\nmass=5\nposition=[0.7071067811865476,0,0.7071067811865476]\n\
                inertia={kind='sphere',radius=0.03}\n[[joint]]\nkind='fixed'\nbetween=['rod.tip','ball']\n";
    assert!(!case(ball, "ball"));
}

/// A ball that is set down on a floor, with a gap that is zero or rounding, touches without a speed: the law of Hunt and Crossley, whose damping is over the closing
/// speed, damps nothing then, and the ball goes to and fro between the height of the touch and 2mg/K below it.
#[test]
fn a_ball_that_is_set_down_is_not_damped_by_a_speed_that_is_rounding() {
    for height in ["0.1", "0.09999999999999999", "0.10000000000000002"] {
        let text = format!(
            "gravity=[0,0,-9.81]\nrun={{duration=0.2}}\noutput={{step='0.1 ms'}}\nintegrator={{kind='radau',tolerance=1e-9,absolute-tolerance=1e-13}}\n\
             [[body]]\nname='ball'\nmass=1\ninertia={{kind='sphere',radius=0.1}}\nposition=[0,0,{height}]\n\
             [[contact]]\nname='floor'\non='ball'\nradius=0.1\nobstacle={{kind='plane',normal=[0,0,1]}}\n\
             law={{kind='hunt-crossley',stiffness=1e5,exponent=1,restitution=0.5}}\n"
        );
        let run = finished(&reading(&text, &[]));
        let gap = run.trajectory.extremes(run.trajectory.index("floor.gap").unwrap());
        assert!((gap.min + 2.0 * 9.81 / 1e5).abs() < 1e-8, "{height}: {}", gap.min);
        let kinds: Vec<&str> = run.events.list.iter().map(|event| event.what).collect();
        assert_eq!(kinds.first(), Some(&"touched"), "{height}: {kinds:?}");
    }
}

/// What carries an obstacle is a part of another name than what touches it.
#[test]
fn what_carries_an_obstacle_is_said_by_its_name() {
    let refused = |mount: &str| {
        let text = format!(
            "run={{duration=0.01}}\n[[body]]\nname='ball'\nmass=1\nposition=[0,0,5]\ninertia={{kind='sphere',radius=0.1}}\n[[body]]\nname='anvil'\nmass=1\n\
             inertia={{kind='sphere',radius=0.1}}\nposition=[0,0,1]\n[[beam]]\nname='rod'\nstart=[0,0,2]\nlength=1\nelements=2\n\
             section={{kind='circle',modulus=70e9,density=2700,radius=0.01}}\n\
             [[contact]]\non='ball'\nmount='{mount}'\nobstacle={{kind='sphere',radius=0.1}}\nlaw={{kind='constraint',restitution=0.5}}\n"
        );
        let read = flexion_case::parse(text, std::path::Path::new("case.toml"), &[]);
        read.and_then(|reading| reading.prepare().map(drop)).map_err(|problems| problems.to_string())
    };
    for (mount, part) in [
        ("ball", "carries the obstacle, and does not touch it"),
        ("anvli", "did you mean `anvil`?"),
        ("rod", "write for example `rod.tip`"),
        ("hub", "fixed to the ground, or to a part, or moved"),
    ] {
        let message = refused(mount).unwrap_err();
        assert!(message.contains("contact[1].mount") && message.contains(part), "{mount}: {message}");
    }
    for mount in ["ground", "anvil", "rod.tip", "rod@0.3 m"] {
        assert_eq!(refused(mount), Ok(()));
    }
}

/// A box that falls flat on its four corners: the fourth force follows from the others.
#[test]
fn contacts_whose_forces_follow_from_each_other_are_left_to_nonsmooth_steps() {
    let mut text = "run={duration=1.5}\ngravity=[0,0,-9.81]\nintegrator={kind='generalized-alpha',step=1e-3}\n[[body]]\n\
                    name='brick'\nmass=2\ninertia={kind='box',size=[0.2,0.4,0.2]}\nposition=[0,0,0.5]\n"
        .to_owned();
    for [x, y] in [[-1, -2], [-1, 2], [1, -2], [1, 2]] {
        text += &format!(
            "[[contact]]\non='brick'\nat=[{}e-1,{}e-1,0.4]\nobstacle={{kind='plane',normal=[0,0,1]}}\nlaw={{kind='constraint',restitution=0.5}}\n",
            x, y
        );
    }
    for integrator in
        ["{kind='generalized-alpha',step=1e-3}", "{kind='radau'}", "{kind='moreau-jean',step=1e-3}"]
    {
        let run = finished(&reading(&text, &[&format!("integrator={integrator}")]));
        let last = |name: &str| *run.trajectory.column(name).unwrap().last().unwrap();
        let weight: f64 = ["contact", "contact2", "contact3", "contact4"]
            .map(|name| last(&format!("{name}.force")))
            .iter()
            .sum();
        assert!(
            (weight - 2.0 * 9.81).abs() < 1e-9 && (last("brick.position.z") - 0.1).abs() < 1e-6,
            "{integrator}: {weight}"
        );
        let left =
            run.warnings.iter().any(|w| w.contains("more of them than motions that they hold, are closed"));
        assert_eq!(left, !integrator.contains("moreau"), "{integrator}: {:?}", run.warnings);
    }
}

/// A point on the rim of a rotor, a ball of 1 cm in its way, and steps of many radians: it touches where 1 + d² − 2d sin θ = r². A method that
/// locates events finds it; one that locates none says that it may have stepped over.
#[test]
fn no_point_of_a_rotor_passes_an_obstacle_in_a_step_unseen() {
    let rotor = |integrator: &str, speed: f64| {
        format!(
            "integrator = {integrator}\nrun = {{ duration = 0.4 }}\noutput = {{ step = 0.05 }}\n\
             [[body]]\nname = 'b'\nmass = 1\ninertia = {{ kind = 'box', size = [1, 1, 0.1] }}\nspin = [0, 0, {speed}]\n\
             [[joint]]\nname = 'j'\nkind = 'revolute'\nbetween = ['ground', 'b']\nat = [0, 0, 0]\n\
             [[contact]]\nname = 'k'\non = 'b'\nat = [1, 0, 0]\n\
             obstacle = {{ kind = 'sphere', centre = [0, 1.005, 0], radius = 0.01 }}\n\
             law = {{ kind = 'constraint', restitution = 1 }}\n"
        )
    };
    let sine: f64 = (1.0 + 1.005_f64.powi(2) - 1e-4) / 2.01;
    for speed in [400.0, -400.0, 37.0] {
        // Backwards it arrives from the other side, at π − θ.
        let angle = if speed > 0.0 { sine.asin() } else { PI + sine.asin() };
        for integrator in [
            "{ kind = 'hht', step = 0.1, alpha = 0 }",
            "{ kind = 'generalized-alpha', step = 0.013 }",
            "{ kind = 'radau' }",
        ] {
            let run = finished(&reading(&rotor(integrator, speed), &[]));
            let found = run.events.impacts().next().map_or(f64::NAN, |first| first.time);
            let expected = angle / speed.abs();
            assert!(
                (found - expected).abs() < 1e-6 * expected,
                "{integrator} {speed}: {found} for {expected}"
            );
        }
        for kind in ["nonsmooth-generalized-alpha", "moreau-jean"] {
            let integrator = format!("{{ kind = '{kind}', step = 0.1 }}");
            let run = outcome(&reading(&rotor(&integrator, speed), &[]));
            if let Status::Failed = run.status {
                // Steps of six turns diverge at the impact: that is told.
                continue;
            }
            let warned = run.warnings.iter().any(|w| w.contains("may have passed through its obstacle"));
            assert!(warned || run.events.impacts().next().is_some(), "{kind} {speed}: {:?}", run.warnings);
        }
    }
    // The end of one step lies within the ball, and no step finds it on its way.
    let rotor = rotor("{ kind = 'moreau-jean', step = 8.944780596329235e-4 }", 161.63888793419412).replace(
        "centre = [0, 1.005, 0], radius = 0.01",
        "centre = [0.17781930615421235, -0.9732090940755899, 0], radius = 0.01439305013096359",
    );
    let run = finished(&reading(&rotor, &["run.duration=0.0588"]));
    assert!(
        run.warnings.iter().any(|w| w.contains("may have passed through its obstacle")),
        "{:?}",
        run.warnings
    );
}

/// A ball that falls from rest for 0.5 s to 5 m/s onto the floor, in a run of 2 s.
fn ball(integrator: &str, restitution: f64) -> Reading {
    let case = format!(
        "gravity = [0, 0, -10]\nintegrator = {integrator}\nrun = {{ duration = 2 }}\noutput = {{ step = 0.9 }}\n\
         [[body]]\nname = 'b'\nmass = 3\ninertia = {{ kind = 'box', size = [1, 1, 1] }}\nposition = [0, 0, 1.25]\n\
         [[contact]]\nname = 'k'\non = 'b'\nobstacle = {{ kind = 'plane', normal = [0, 0, 1] }}\n\
         law = {{ kind = 'constraint', restitution = {restitution} }}\n"
    );
    reading(&case, &[])
}

/// The momentum that it then takes from the floor, until the end of the run \[N·s\].
fn taken(run: &Run) -> f64 {
    3.0 * (5.0 + 10.0 * (2.0 - run.events.impacts().next().unwrap().time))
}

/// A ball that falls with v₁ onto the floor and comes to rest in a burst of impacts takes m v₁ + m g Δt from the first of them to the end of the
/// run: the impulses of its impacts and ∫λ dt while it rests.
#[test]
fn the_impulse_of_a_whole_burst_is_the_change_of_momentum() {
    // With e = ½ it bounces for another second.
    for restitution in [0.0, 0.5] {
        for (integrator, allowed) in [
            ("{ kind = 'radau' }", 1e-6),
            ("{ kind = 'generalized-alpha', step = 0.01 }", 1e-6),
            ("{ kind = 'moreau-jean', step = 1e-3 }", 5e-3),
            ("{ kind = 'nonsmooth-generalized-alpha', step = 1e-3 }", 5e-3),
        ] {
            let run = finished(&ball(integrator, restitution));
            let (first, expected) = (run.events.impacts().next().unwrap().time, taken(&run));
            let found: Vec<f64> = run.events.impulses().map(|(_, impulse)| impulse).collect();
            assert!((found[0] / expected - 1.0).abs() < allowed, "{integrator}: {found:?} for {expected}");
            let bursts: Vec<_> = run.events.list.iter().filter(|entry| entry.what == "burst").collect();
            let last = bursts.last().unwrap();
            assert!((last.impulse.unwrap() / expected - 1.0).abs() < allowed, "{integrator}: {last:?}");
            assert!((last.time - 2.0).abs() < 1e-9 && (last.duration.unwrap() - 2.0 + first).abs() < 1e-9);
        }
    }
}

/// The multipliers of a constant force are exact in fixed steps, whether velocities are held or positions alone: at the end of a step they are those of the
/// accelerations there.
#[test]
fn the_impulse_of_a_whole_burst_under_a_constant_force_is_exact_in_fixed_steps() {
    let off = |kind: &str, step: f64, more: &str| {
        let run = finished(&ball(&format!("{{ kind = '{kind}', step = {step}{more} }}"), 0.5));
        let burst = run.events.list.iter().rfind(|entry| entry.what == "burst").unwrap();
        (burst.impulse.unwrap() / taken(&run) - 1.0).abs()
    };
    for kind in ["generalized-alpha", "hht"] {
        let error = off(kind, 0.01, ", stabilized = false");
        assert!(error < 1e-8, "{kind}: {error}");
    }
    for kind in ["newmark", "hht", "generalized-alpha"] {
        let error = off(kind, 0.01, "");
        assert!(error < 1e-8, "{kind}: {error}");
    }
}

/// A ball falls, bounces and comes to rest while it turns by 4 rad in a step, alone or on an axis without friction: in the steps of an
/// impact too its rotation is ω t.
#[test]
fn a_body_that_turns_by_more_than_half_a_turn_in_a_step_bounces() {
    let speed = 400.0;
    for scheme in ["true", "false"] {
        for (joint, column) in [
            ("", "b.rotation.z"),
            ("[[joint]]\nname = 'j'\nkind = 'cylindrical'\nbetween = ['ground', 'b']", "j.angle"),
        ] {
            let case = format!(
                "gravity = [0, 0, -10]\nrun = {{ duration = 1.5 }}\noutput = {{ step = 2.5e-3 }}\n\
                 integrator = {{ kind = 'nonsmooth-generalized-alpha', step = 0.01, decoupled = {scheme} }}\n\
                 [[body]]\nname = 'b'\nmass = 3\ninertia = {{ kind = 'box', size = [1, 1, 1] }}\nposition = [0, 0, 1.25]\n\
                 spin = [0, 0, {speed}]\n{joint}\n\
                 [[contact]]\nname = 'k'\non = 'b'\nobstacle = {{ kind = 'plane', normal = [0, 0, 1] }}\n\
                 law = {{ kind = 'constraint', restitution = 0.5 }}\n"
            );
            let run = finished(&reading(&case, &[]));
            assert!(run.events.impacts().count() > 2);
            let times = run.trajectory.times();
            for (t, found) in times.iter().zip(run.trajectory.column(column).unwrap()) {
                let turned = speed * t;
                // The sign of a quaternion is free.
                let off = match joint {
                    "" => (found.abs() - (0.5 * turned).sin().abs()).abs(),
                    _ => (found - turned).abs(),
                };
                assert!(
                    off < 1e-8 * (1.0 + turned),
                    "{scheme} {column}: {found} at {t} s, turned by {turned}"
                );
            }
        }
    }
}

/// A point slides with friction over the top of a ball, over its side, where gravity presses as much, and past a pole of the tangents of spheres: the same motion.
#[test]
fn friction_on_a_ball_knows_no_poles() {
    // Along, up, across.
    let frames = [
        [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]],
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]],
        [[0.6, -0.48, 0.0].map(|x| x / 0.5904_f64.sqrt()), [0.48, 0.6, 0.64], {
            let x = [0.6, -0.48, 0.0].map(|x| x / 0.5904_f64.sqrt());
            [0.6 * x[2] - 0.64 * x[1], 0.64 * x[0] - 0.48 * x[2], 0.48 * x[1] - 0.6 * x[0]]
        }],
    ];
    for scheme in [false, true] {
        let ends = frames.map(|frame| {
            let place = |of: [f64; 3]| [0, 1, 2].map(|i| of.iter().zip(frame).map(|(x, e)| x * e[i]).sum::<f64>());
            let text = format!(
                "gravity = {:?}\nrun = {{ duration = 0.1 }}\noutput = {{ step = 0.01 }}\n\
                 integrator = {{ kind = 'nonsmooth-generalized-alpha', step = 1e-3, decoupled = {scheme} }}\n\
                 [[body]]\nname = 'p'\nmass = 1\ninertia = {{ kind = 'sphere', radius = 0.1 }}\nposition = {:?}\nvelocity = {:?}\n\
                 [[contact]]\non = 'p'\nobstacle = {{ kind = 'sphere', radius = 1 }}\n\
                 law = {{ kind = 'constraint', restitution = 0, friction = 0.2 }}\n",
                place([0.0, -9.81, 0.0]),
                place([-0.05, 1e-5 + (1.0_f64 - 0.05 * 0.05 - 0.0005 * 0.0005).sqrt(), 0.0005]),
                place([1.0, 0.05, 0.0]),
            );
            let run = finished(&reading(&text, &[]));
            let last = ["x", "y", "z"]
                .map(|axis| *run.trajectory.column(&format!("p.velocity.{axis}")).unwrap().last().unwrap());
            frame.map(|e| e.iter().zip(last).map(|(e, v)| e * v).sum::<f64>())
        });
        // A step without friction would be 2e-3 m/s.
        for other in &ends[1..] {
            for (a, b) in ends[0].iter().zip(other) {
                assert!((a - b).abs() < 2e-6, "{scheme}: {ends:?}");
            }
        }
    }
}

/// A solid ball that slides with a spin of its own about any axis: its contact moves with c = v − R ω × n, friction turns and slows both so that c keeps its direction,
/// ċ = −7/2 μg c/|c|, on a parabola. It rolls from t = 2|c|/(7μg) on, straight on with v − 2/7 c. The same where it falls first: of an impulse P = m(1 + e)v, friction takes
/// the smaller of μP and 2/7 m|c|.
#[test]
fn a_ball_with_a_spin_of_its_own_slides_on_a_parabola_and_rolls() {
    const G: f64 = 9.81;
    let (radius, friction, velocity, spin): (f64, f64, [f64; 2], [f64; 2]) =
        (0.05, 0.2, [2.0, -0.5], [30.0, 25.0]);
    // −R ω × n = R (−ω_y, ω_x)
    let sliding = [velocity[0] - radius * spin[1], velocity[1] + radius * spin[0]];
    let size = sliding[0].hypot(sliding[1]);
    let along = sliding.map(|c| c / size);
    for (height, e) in [(0.0, 0.0), (0.3, 0.0), (0.3, 0.4)] {
        let fall = (2.0_f64 * height / G).sqrt();
        // Sliding velocity behind each impact, until bounces have come to their end.
        let (mut left, mut speed, mut time) = (size, G * fall, fall);
        let mut place = velocity.map(|v| v * fall);
        let now = |left: f64| [0, 1].map(|i| velocity[i] - 2.0 / 7.0 * (size - left) * along[i]);
        while speed > 1e-12 {
            left = (left - 3.5 * friction * (1.0 + e) * speed).max(0.0);
            speed *= e;
            let flight = 2.0 * speed / G;
            place = [0, 1].map(|i| place[i] + now(left)[i] * flight);
            time += flight;
        }
        let slides = left / (3.5 * friction * G);
        let end: f64 = 1.5;
        assert!(time + slides < end, "it rolls");
        let (v, w) = (now(left), now(0.0));
        let place = [0, 1].map(|i| place[i] + 0.5 * (v[i] + w[i]) * slides + w[i] * (end - time - slides));
        for method in [
            "{ kind = 'radau' }",
            "{ kind = 'generalized-alpha', step = '4 ms' }",
            "{ kind = 'hht', step = '4 ms', alpha = 0 }",
        ] {
            let text = format!(
                "gravity = [0, 0, -{G}]\nintegrator = {method}\nrun = {{ duration = {end} }}\noutput = {{ step = 0.01 }}\n\
                 [[body]]\nname = 'b'\nmass = 3\ninertia = {{ kind = 'sphere', radius = {radius} }}\nposition = [0, 0, {}]\n\
                 velocity = [{}, {}, 0]\nspin = [{}, {}, 7]\n\
                 [[contact]]\nname = 'k'\non = 'b'\nradius = {radius}\nobstacle = {{ kind = 'plane', normal = [0, 0, 1] }}\n\
                 law = {{ kind = 'constraint', restitution = {e}, friction = {friction} }}\n",
                radius + height,
                velocity[0],
                velocity[1],
                spin[0],
                spin[1]
            );
            let case = reading(&text, &[]);
            let run = finished(&case);
            let estimate = case.estimate_errors(&run, Effort::Full, &mut |_| ControlFlow::Continue(()));
            assert!(run.warnings.iter().any(|w| w.contains("friction in space")), "{:?}", run.warnings);
            let exact = [place[0], place[1], -w[1] / radius, w[0] / radius, 7.0];
            let columns = ["b.position.x", "b.position.y", "b.spin.x", "b.spin.y", "b.spin.z"];
            for (column, exact) in columns.into_iter().zip(exact) {
                let found = *run.trajectory.column(column).unwrap().last().unwrap();
                let stated = estimate.columns.iter().find(|error| error.column == column).unwrap().last;
                let off = (found - exact).abs();
                assert!(
                    off <= stated + 1e-9 && stated < 3e-3 * exact.abs().max(1.0),
                    "{method} {height} {e}, {column}: {found}, {exact}: {off:e}, {stated:e}"
                );
            }
        }
    }
}
