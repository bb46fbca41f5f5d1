//! Impacts of rigid bodies near records and within long steps, and friction that stops them.

use super::times::method;
use super::{Answer, Posed, exactly};
use crate::random::Random;
use crate::{Drawn, add};
use std::f64::consts::PI;

/// A ball falls and bounces once, with a record just before or behind the impact.
pub(super) fn record_before_impact(random: &mut Random) -> Posed {
    let (height, g, e) = (random.scale(0.01..10.0), random.scale(1.0..20.0), random.between(0.2..1.0));
    let (time, speed) = ((2.0 * height / g).sqrt(), (2.0 * height * g).sqrt());
    let flight = 2.0 * e * speed / g;
    let after = flight * random.between(0.1..0.9);
    let near = time * random.scale(1e-9..1e-2) * if random.coin() { 1.0 } else { -1.0 };
    let interval = (time - near) / random.count(1..200) as f64;
    let mut case = Drawn { length: height, ..Drawn::default() };
    add!(case, "gravity = [0, 0, -{g}]\nintegrator = {}", method(random, time / 300.0));
    add!(case, "run = {{ duration = {} }}\noutput = {{ step = {interval:e} }}", time + after);
    add!(
        case,
        "[[body]]\nname = 'b'\nmass = 1\ninertia = {{ kind = 'sphere', radius = 0.1 }}\nposition = [0, 0, {height}]"
    );
    add!(
        case,
        "[[contact]]\nname = 'k'\non = 'b'\nobstacle = {{ kind = 'plane', normal = [0, 0, 1] }}\nlaw = {{ kind = 'constraint', restitution = {e} }}"
    );
    let z = |t: f64| e * speed * t - 0.5 * g * t * t;
    let highest = if after > 0.5 * flight { z(0.5 * flight) } else { z(after) };
    let values = vec![
        exactly("b.position.z", "final", z(after)),
        exactly("b.position.z", "max", highest.max(height)),
        exactly("b.position.z", "min", 0.0),
        exactly("b.velocity.z", "final", e * speed - g * after),
        exactly("b.velocity.z", "max", e * speed),
        exactly("b.velocity.z", "min", -speed),
    ];
    Posed { case, answer: Answer::Known(values) }
}

/// A point on the rim of a rotor strikes a small ball, however long a step is, and the rotor turns back.
pub(super) fn rotor_meets_obstacle(random: &mut Random) -> Posed {
    let (speed, e) = (random.scale(0.5..500.0), random.between(0.3..1.0));
    let (radius, place) = (random.scale(1e-3..0.1), random.between(0.5..6.0));
    let distance = 1.0 + radius * random.between(-0.8..0.8);
    // Of the triangle with sides 1, `distance` and `radius`.
    let cosine = (1.0 + distance * distance - radius * radius) / (2.0 * distance);
    let angle = place - cosine.clamp(-1.0, 1.0).acos();
    // It then strikes the ball from the other side.
    let way = 2.0 * PI - 2.0 * (place - angle);
    let back = random.between(0.1..0.9) * way;
    let duration = angle / speed + back / (e * speed);
    let integrator = if random.coin() {
        let step = (random.scale(0.01..20.0) / speed).min(duration);
        method(random, step)
    } else {
        let kind = random.pick(&["moreau-jean", "nonsmooth-generalized-alpha"]);
        format!("{{ kind = '{kind}', step = {:e} }}", (random.scale(0.1..3.0) / speed).min(duration))
    };
    let mut case = Drawn { length: 1.0, ..Drawn::default() };
    add!(case, "integrator = {integrator}\nrun = {{ duration = {duration} }}");
    add!(case, "output = {{ step = {} }}", duration / random.scale(3.0..300.0));
    add!(
        case,
        "[[body]]\nname = 'b'\nmass = 1\ninertia = {{ kind = 'box', size = [1, 1, 0.1] }}\nspin = [0, 0, {speed}]"
    );
    add!(case, "[[joint]]\nname = 'j'\nkind = 'revolute'\nbetween = ['ground', 'b']\nat = [0, 0, 0]");
    let centre = [distance * place.cos(), distance * place.sin()];
    add!(case, "[[contact]]\nname = 'k'\non = 'b'\nat = [1, 0, 0]");
    add!(
        case,
        "obstacle = {{ kind = 'sphere', centre = [{}, {}, 0], radius = {radius} }}",
        centre[0],
        centre[1]
    );
    add!(case, "law = {{ kind = 'constraint', restitution = {e} }}");
    let last = angle - back;
    let values = vec![
        exactly("j.angle", "max", angle),
        exactly("j.angle", "final", last),
        exactly("j.angle", "min", last.min(0.0)),
        exactly("j.speed", "final", -e * speed),
    ];
    Posed { case, answer: Answer::Known(values) }
}

/// A block on a slide is stopped by the friction on a floor, and stays where it is: v²/(2a) further.
pub(super) fn friction_stops(random: &mut Random) -> Posed {
    let (slide, block) = (random.scale(0.1..10.0), random.scale(0.1..10.0));
    let (g, friction, speed) = (random.scale(1.0..20.0), random.between(0.05..0.9), random.scale(0.1..5.0));
    let slowing = friction * block * g / (slide + block);
    let stop = speed / slowing;
    let duration = stop * random.between(1.05..3.0);
    let kind = random.pick(&["moreau-jean", "nonsmooth-generalized-alpha"]);
    let step = duration / random.scale(50.0..1000.0);
    let mut case = Drawn { length: 1.0, ..Drawn::default() };
    add!(
        case,
        "gravity = [0, 0, -{g}]\nintegrator = {{ kind = '{kind}', step = {step:e} }}\nrun = {{ duration = {duration} }}"
    );
    for (name, mass) in [("slide", slide), ("block", block)] {
        add!(
            case,
            "[[body]]\nname = '{name}'\nmass = {mass}\ninertia = {{ kind = 'sphere', radius = 0.1 }}\nvelocity = [{speed}, 0, 0]"
        );
    }
    add!(case, "[[joint]]\nname = 'x'\nkind = 'prismatic'\nbetween = ['ground', 'slide']\naxis = [1, 0, 0]");
    add!(case, "[[joint]]\nname = 'z'\nkind = 'prismatic'\nbetween = ['slide', 'block']\naxis = [0, 0, 1]");
    add!(case, "[[contact]]\nname = 'k'\non = 'block'\nobstacle = {{ kind = 'plane', normal = [0, 0, 1] }}");
    add!(case, "law = {{ kind = 'constraint', restitution = 0, friction = {friction} }}");
    let way = 0.5 * speed * speed / slowing;
    let values = vec![exactly("x.displacement", "final", way), exactly("x.displacement", "max", way)];
    Posed { case, answer: Answer::Known(values) }
}
