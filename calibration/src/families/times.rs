//! What happens between two steps, two records, or right after the start.

use super::{Answer, Posed, Relation, exactly};
use crate::random::Random;
use crate::{Drawn, add};
use std::f64::consts::PI;

/// A method with steps of about that size, or `radau`.
pub(super) fn method(random: &mut Random, step: f64) -> String {
    match random.count(0..5) {
        0 => format!("{{ kind = 'newmark', step = {step:e} }}"),
        1 => format!("{{ kind = 'generalized-alpha', step = {step:e} }}"),
        2 => format!("{{ kind = 'hht', step = {step:e} }}"),
        _ => format!("{{ kind = 'radau', tolerance = {:e} }}", random.scale(1e-8..1e-4)),
    }
}

/// A hub whose speed is a table joined by straight lines, some of its rows close together: the angle is the sum of trapezoids.
pub(super) fn kinks_of_a_motion(random: &mut Random) -> Posed {
    let duration = random.between(0.5..2.0);
    let mut rows = vec![(0.0, 0.0)];
    let mut t = 0.0;
    for _ in 0..random.count(3..15) {
        t += duration * random.scale(1e-3..0.3);
        rows.push((t, random.between(-2.0..2.0)));
    }
    rows.push((t.max(duration) + 0.1, 0.0));
    let at = |t: f64, (t0, w0): (f64, f64), (t1, w1): (f64, f64)| w0 + (w1 - w0) * (t - t0) / (t1 - t0);
    let mut angle = 0.0;
    for pair in rows.windows(2) {
        let (from, to) = (pair[0].0.min(duration), pair[1].0.min(duration));
        angle += 0.5 * (to - from) * (at(from, pair[0], pair[1]) + at(to, pair[0], pair[1]));
    }
    let mut case = Drawn { length: 1.0, ..Drawn::default() };
    let text: String = rows.iter().map(|(t, w)| format!("{t:e},{w:e}\n")).collect();
    case.file("motion.csv", format!("t,value\n{text}"));
    add!(
        case,
        "[beam]\nlength = 1\n[section]\nkind = 'rectangle'\nmodulus = 70e9\ndensity = 2700\nwidth = 0.05\nheight = 0.03"
    );
    add!(
        case,
        "[hub]\nmotion = {{ kind = 'table', of = 'speed', file = 'motion.csv', interpolation = 'linear' }}"
    );
    add!(case, "[integrator]\nkind = 'radau'\ntolerance = 1e-5\n[run]\nduration = {duration}");
    Posed { case, answer: Answer::Known(vec![exactly("hub.angle", "final", angle)]) }
}

/// A free body under a force that lasts a small part of the run: F w √π of momentum.
pub(super) fn short_blow(random: &mut Random) -> Posed {
    let (mass, force, duration) = (random.scale(0.1..10.0), random.scale(1.0..1e3), random.scale(0.1..10.0));
    let (time, width) = (duration * random.between(0.2..0.8), duration * random.scale(1e-5..1e-2));
    let integrator = format!("{{ kind = 'radau', tolerance = {:e} }}", random.scale(1e-8..1e-4));
    let mut case = Drawn { length: 1.0, ..Drawn::default() };
    add!(
        case,
        "integrator = {integrator}\nrun = {{ duration = {duration} }}\n[[body]]\nname = 'b'\nmass = {mass}"
    );
    add!(case, "inertia = {{ kind = 'sphere', radius = 0.1 }}\n[[load]]\non = 'b'\nforce = [{force}, 0, 0]");
    add!(case, "amplitude = {{ kind = 'expression', formula = 'exp(-((t - {time})/{width:e})^2)' }}");
    let speed = force * width * PI.sqrt() / mass;
    // The rest of the blow before the start and behind the end is nothing.
    let values = vec![
        exactly("b.velocity.x", "final", speed),
        exactly("b.velocity.x", "max", speed),
        exactly("b.position.x", "final", speed * (duration - time)),
    ];
    Posed { case, answer: Answer::Known(values) }
}

/// An oscillator that ends shortly behind a peak, within the interval of the last record or of the last step.
pub(super) fn last_interval(random: &mut Random) -> Posed {
    let (mass, stiffness, g) = (random.scale(0.1..10.0), random.scale(1.0..1e4), random.scale(0.1..20.0));
    let frequency: f64 = (stiffness / mass).sqrt();
    // x = (g/ω²) (1 − cos ωt) has its peaks at odd multiples of half a period.
    // No record of an earlier one tells of the first.
    let earlier = if random.coin() { 0 } else { random.count(1..4) };
    let peak = PI / frequency * (2.0 * earlier as f64 + 1.0);
    let records = random.count(10..60) as f64;
    let behind = random.scale(0.01..0.98);
    // The peak lies that part of an interval before the end.
    let duration = peak / (1.0 - behind / records);
    let step = random.scale(0.01..0.3) / frequency;
    let integrator = method(random, step);
    let mut case = Drawn { length: 1.0, ..Drawn::default() };
    let free = random.coin();
    if free {
        add!(case, "gravity = [0, 0, -{g}]");
    }
    add!(
        case,
        "integrator = {integrator}\nrun = {{ duration = {duration} }}\noutput = {{ step = {} }}",
        duration / records
    );
    add!(
        case,
        "[[body]]\nname = 'b'\nmass = {mass}\ninertia = {{ kind = 'principal', moments = [{mass}, {mass}, {mass}] }}"
    );
    if free {
        add!(case, "[[joint]]\nname = 'j'\nkind = 'prismatic'\nbetween = ['ground', 'b']\naxis = [0, 0, -1]");
        add!(case, "travel = {{ kind = 'free', stiffness = {stiffness} }}");
    } else {
        add!(case, "[[joint]]\nname = 'j'\nkind = 'revolute'\nbetween = ['ground', 'b']");
        add!(
            case,
            "motion = {{ kind = 'free', stiffness = {stiffness}, torque = {{ kind = 'constant', torque = {} }} }}",
            mass * g
        );
    }
    let column = if free { "j.displacement" } else { "j.angle" };
    let size = g * mass / stiffness;
    let last = size * (1.0 - (frequency * duration).cos());
    let values =
        vec![exactly(column, "max", 2.0 * size), exactly(column, "min", 0.0), exactly(column, "final", last)];
    Posed { case, answer: Answer::Known(values) }
}

/// A beam on a hub, and `what` happens to it.
fn waiting(drawn: &mut Drawn, what: &str, duration: f64, integrator: &str) {
    add!(
        drawn,
        "[beam]\nlength = 2\n[section]\nkind = 'rectangle'\nmodulus = 70e9\ndensity = 2700\nwidth = 0.05\nheight = 0.04"
    );
    add!(drawn, "{what}\n[basis]\nkind = 'finite-elements'\nelements = 4");
    add!(
        drawn,
        "[integrator]\n{integrator}\n[run]\nduration = {duration}\n[output]\nstep = {}",
        duration / 100.0
    );
}

/// When it begins: from almost at once to a good part of the duration.
fn delay(random: &mut Random, duration: f64) -> f64 {
    duration * random.scale(1e-12..1.0)
}

/// The hub's speed jumps at a time after the start; that it does so right after the start moves the answer by that time.
pub(super) fn jump_after_the_start(random: &mut Random) -> Posed {
    let (duration, speed) = (random.between(0.05..0.2), random.scale(1e-3..0.3));
    let late = delay(random, duration);
    let coupling = random.pick(&["first", "high", "exact"]);
    let integrator = format!("kind = 'radau'\ntolerance = {:e}", random.scale(1e-7..1e-4));
    let of = |begin: f64| {
        let mut drawn = Drawn { length: 2.0, ..Drawn::default() };
        let what = format!(
            "[hub]\nmotion = {{ kind = 'expression', of = 'speed', formula = 'if(t > {begin:e}, {speed}, 0)' }}\n\
             [model]\ncoupling = '{coupling}'"
        );
        waiting(&mut drawn, &what, begin + duration, &integrator);
        drawn
    };
    Posed { case: of(0.0), answer: Answer::Other(Box::new(of(late)), Relation::Equal) }
}

/// The same of a load.
pub(super) fn load_after_the_start(random: &mut Random) -> Posed {
    let (duration, force) = (random.between(0.05..0.2), random.scale(1.0..1e3));
    let late = delay(random, duration);
    let integrator = format!("kind = 'radau'\ntolerance = {:e}", random.scale(1e-7..1e-4));
    let of = |amplitude: &str, duration: f64| {
        let mut drawn = Drawn { length: 2.0, ..Drawn::default() };
        let what = format!(
            "[hub]\nmotion = {{ kind = 'constant', speed = 0 }}\n[[load]]\non = 'tip'\nforce = [0, {force}]\namplitude = {amplitude}"
        );
        waiting(&mut drawn, &what, duration, &integrator);
        drawn
    };
    let other =
        of(&format!("{{ kind = 'expression', formula = 'if(t > {late:e}, 1, 0)' }}"), late + duration);
    Posed { case: of("'constant'", duration), answer: Answer::Other(Box::new(other), Relation::Equal) }
}
