//! Rotations by more than half a turn in a step or between records, and spins.

use super::times::method;
use super::{Answer, Known, Posed, exactly};
use crate::random::Random;
use crate::{Drawn, add};
use std::f64::consts::PI;

/// Speed, duration, interval of recording and step of a rotation of up to a thousand turns, with up to a few turns in a step.
fn turning(random: &mut Random) -> (f64, f64, f64, f64) {
    let (speed, turns) = (random.scale(0.1..500.0), random.scale(1.0..1e3));
    let duration = 6.3 * turns / speed;
    (
        if random.coin() { speed } else { -speed },
        duration,
        duration / random.scale(10.0..500.0),
        (random.scale(0.05..20.0) / speed).min(duration),
    )
}

fn begin(drawn: &mut Drawn, integrator: &str, duration: f64, interval: f64) {
    add!(
        drawn,
        "integrator = {integrator}\nrun = {{ duration = {duration} }}\noutput = {{ step = {interval} }}"
    );
}

/// Name and moments of inertia of a body whose mass centre is on its axis.
fn body(drawn: &mut Drawn, name: &str, further: &str) {
    add!(
        drawn,
        "[[body]]\nname = '{name}'\nmass = 1\ninertia = {{ kind = 'box', size = [1, 1, 0.1] }}\n{further}"
    );
}

fn angles(speed: f64, duration: f64) -> Vec<Known> {
    let angle = speed * duration;
    vec![
        exactly("j.angle", "final", angle),
        exactly("j.angle", "max", angle.max(0.0)),
        exactly("j.angle", "min", angle.min(0.0)),
    ]
}

/// A hinge at a prescribed speed.
pub(super) fn prescribed_turns(random: &mut Random) -> Posed {
    let (speed, duration, interval, step) = turning(random);
    let mut case = Drawn::default();
    begin(&mut case, &method(random, step), duration, interval);
    body(&mut case, "b", &format!("spin = [0, 0, {speed}]"));
    let kind = random.pick(&["revolute", "cylindrical"]);
    let motion = match random.count(0..2) {
        0 => format!("kind = 'constant', speed = {speed}"),
        _ => format!("kind = 'expression', of = 'angle', formula = '{speed}*t'"),
    };
    add!(case, "[[joint]]\nname = 'j'\nkind = '{kind}'\nbetween = ['ground', 'b']\nmotion = {{ {motion} }}");
    Posed { case, answer: Answer::Known(angles(speed, duration)) }
}

/// A balanced body that goes on turning on its hinge.
pub(super) fn free_turns(random: &mut Random) -> Posed {
    let (speed, duration, interval, step) = turning(random);
    let mut case = Drawn::default();
    begin(&mut case, &method(random, step), duration, interval);
    body(&mut case, "b", &format!("spin = [0, 0, {speed}]"));
    let kind = random.pick(&["revolute", "cylindrical"]);
    add!(case, "[[joint]]\nname = 'j'\nkind = '{kind}'\nbetween = ['ground', 'b']");
    Posed { case, answer: Answer::Known(angles(speed, duration)) }
}

/// A hub at a prescribed speed, with a stiff beam.
pub(super) fn hub_turns(random: &mut Random) -> Posed {
    let (speed, turns) = (random.between(-3.0..3.0), random.scale(1.0..20.0));
    let duration = 6.3 * turns / speed.abs().max(0.1);
    let mut case = Drawn { length: 1.0, ..Drawn::default() };
    add!(
        case,
        "[beam]\nlength = 1\n[section]\nkind = 'rectangle'\nmodulus = 70e9\ndensity = 2700\nwidth = 0.05\nheight = 0.03"
    );
    add!(case, "[basis]\nkind = 'modes'\naxial = 1\ntransverse = 2");
    add!(
        case,
        "[hub]\nmotion = {{ kind = 'constant', speed = {speed} }}\n[initial]\nkind = 'steady-rotation'"
    );
    add!(
        case,
        "[integrator]\nkind = 'generalized-alpha'\nstep = {:e}\n[run]\nduration = {duration}",
        duration / 500.0
    );
    Posed { case, answer: Answer::Known(vec![exactly("hub.angle", "final", speed * duration)]) }
}

/// A body on a hinge of another, which turns about the same axis.
pub(super) fn relative_turns(random: &mut Random) -> Posed {
    let (speed, duration, interval, step) = turning(random);
    let inner = speed * random.between(-1.0..1.0);
    let mut case = Drawn::default();
    begin(&mut case, &method(random, step), duration, interval);
    body(&mut case, "a", &format!("spin = [0, 0, {inner}]"));
    body(&mut case, "b", &format!("spin = [0, 0, {}]", inner + speed));
    add!(case, "[[joint]]\nname = 'i'\nkind = 'revolute'\nbetween = ['ground', 'a']");
    add!(case, "[[joint]]\nname = 'j'\nkind = 'revolute'\nbetween = ['a', 'b']");
    Posed { case, answer: Answer::Known(angles(speed, duration)) }
}

/// The quaternion of a body that turns about an axis by up to three turns: (cos θ/2, n sin θ/2).
pub(super) fn quaternion(random: &mut Random) -> Posed {
    let axis = random.vector(1.0);
    let size = axis.iter().map(|x| x * x).sum::<f64>().sqrt().max(0.1);
    let (angle, speed) = (random.between(0.3..19.0), random.scale(0.1..10.0));
    let duration = angle / speed;
    let mut case = Drawn::default();
    begin(&mut case, &method(random, 0.05 / speed), duration, duration / random.scale(40.0..300.0));
    body(&mut case, "b", "");
    add!(case, "[[joint]]\nname = 'j'\nkind = 'revolute'\nbetween = ['ground', 'b']\naxis = {axis:?}");
    add!(case, "motion = {{ kind = 'constant', speed = {speed} }}");
    let half = 0.5 * angle;
    // The sine reaches 1 at π/2 and −1 at 3π/2, the cosine −1 at π.
    let highest = if half > 0.5 * PI { 1.0 } else { half.sin() };
    let lowest = if half > 1.5 * PI { -1.0 } else { half.sin().min(0.0) };
    let least = if half > PI { -1.0 } else { half.cos() };
    let mut values = vec![
        exactly("b.rotation.w", "max", 1.0),
        exactly("b.rotation.w", "min", least),
        exactly("b.rotation.w", "final", half.cos()),
    ];
    for (name, n) in ["x", "y", "z"].iter().zip(axis.map(|x| x / size)) {
        let column = format!("b.rotation.{name}");
        values.extend([
            exactly(&column, "max", (n * highest).max(n * lowest)),
            exactly(&column, "min", (n * highest).min(n * lowest)),
            exactly(&column, "final", n * half.sin()),
        ]);
    }
    Posed { case, answer: Answer::Known(values) }
}

/// A free body of any shape: its energy and its momenta stay, and its spin where that is about a principal axis.
pub(super) fn free_spin(random: &mut Random) -> Posed {
    let size = [0; 3].map(|_| random.scale(0.1..1.0));
    let mass = random.scale(0.1..10.0);
    let [a, b, c] = size.map(|x| x * x * mass / 12.0);
    let moments = [b + c, c + a, a + b];
    let principal = random.coin();
    let mut spin = random.vector(5.0);
    if principal {
        // About the axes of the largest and the least moment a rotation is stable.
        let largest = (0..3).max_by(|i, j| moments[*i].total_cmp(&moments[*j])).unwrap_or(0);
        spin = [0, 1, 2].map(|i| if i == largest { spin[i].abs() + 0.5 } else { 0.0 });
    }
    let velocity = random.vector(2.0);
    let duration = random.scale(0.3..10.0);
    let mut case = Drawn::default();
    begin(
        &mut case,
        &format!("{{ kind = 'radau', tolerance = {:e} }}", random.scale(1e-8..1e-5)),
        duration,
        duration / 200.0,
    );
    add!(
        case,
        "[[body]]\nname = 'b'\nmass = {mass}\ninertia = {{ kind = 'principal', moments = {moments:?} }}"
    );
    add!(case, "spin = {spin:?}\nvelocity = {velocity:?}");
    let all = |column: String, value: f64| ["min", "max", "final"].map(|part| exactly(&column, part, value));
    let mut values = Vec::new();
    for (k, name) in ["x", "y", "z"].iter().enumerate() {
        values.extend(all(format!("momentum.{name}"), mass * velocity[k]));
        values.extend(all(format!("angular_momentum.{name}"), moments[k] * spin[k]));
        values.push(exactly(&format!("b.position.{name}"), "final", velocity[k] * duration));
        if principal {
            values.extend(all(format!("b.spin.{name}"), spin[k]));
        }
    }
    let energy =
        (0..3).map(|k| 0.5 * (moments[k] * spin[k] * spin[k] + mass * velocity[k] * velocity[k])).sum();
    values.extend(all("energy.kinetic".to_owned(), energy));
    Posed { case, answer: Answer::Known(values) }
}
