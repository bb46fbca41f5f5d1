//! Plates and blocks on many points of one plane.
//!
//! A plate whose points touch at once, with the closing speed v each, moves on without turning: all points rebound with e v, and friction along the plane acts on the plate as on one
//! particle, as long as the centre of pressure stays among the points.

use super::{
    Crowd, Held, Sum, about, begin, count, cross, dot, entered, known, method, plus, size, smooth_method,
    some, weight,
};
use crate::families::{Answer, Known, Posed, Relation, exactly};
use crate::random::Random;
use crate::{Drawn, add};
use std::f64::consts::{PI, TAU};

/// A plate and the plane under it.
struct Plate {
    mass: f64,
    size: [f64; 3],
    points: Vec<[f64; 2]>,
    /// First, second and third axis of the plate; the third is the normal of the plane.
    axes: [[f64; 3]; 3],
    /// Its centre on the plane.
    foot: [f64; 3],
}

/// A plate with four points near its corners and the others anywhere, turned about the normal of the plane.
fn plate(random: &mut Random, normal: [f64; 3]) -> Plate {
    let (width, depth) = (random.scale(0.05..1.0), random.scale(0.05..1.0));
    let thickness = width.min(depth) * random.between(0.02..0.2);
    let mut points: Vec<[f64; 2]> = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]]
        .map(|[a, b]| [a * width * random.between(0.35..0.5), b * depth * random.between(0.35..0.5)])
        .into();
    for _ in 4..count(random) {
        points.push([width * random.between(-0.5..0.5), depth * random.between(-0.5..0.5)]);
    }
    let turned = random.between(-PI..PI);
    let [first, second] = across(normal, turned);
    Plate {
        mass: random.scale(0.1..10.0),
        size: [width, depth, thickness],
        points,
        axes: [first, second, normal],
        foot: if random.coin() { [0.0; 3] } else { plus([0.0; 3], 1.0, along(random, normal, 1.0)) },
    }
}

/// Two directions at right angles along a plane.
fn across(normal: [f64; 3], angle: f64) -> [[f64; 3]; 2] {
    let aside = if normal[0].abs() < 0.6 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let first = plus(aside, -dot(aside, normal), normal);
    let first = first.map(|x| x / dot(first, first).sqrt());
    let second = cross(normal, first);
    let turned = |a: f64| plus(first.map(|x| x * a.cos()), a.sin(), second);
    [turned(angle), turned(angle + 0.5 * PI)]
}

/// A vector along a plane.
fn along(random: &mut Random, normal: [f64; 3], size: f64) -> [f64; 3] {
    let angle = random.between(-PI..PI);
    across(normal, angle)[0].map(|x| x * size)
}

impl Plate {
    /// Its centre of mass when its points are at that height over the plane.
    fn centre(&self, height: f64) -> [f64; 3] {
        plus(self.foot, height + 0.5 * self.size[2], self.axes[2])
    }

    fn write(&self, case: &mut Drawn, height: f64, velocity: [f64; 3], obstacle: &str, law: &str) {
        let [first, second, normal] = self.axes;
        add!(
            case,
            "[[body]]\nname = 'b'\nmass = {}\ninertia = {{ kind = 'box', size = {:?} }}\nposition = {:?}\nvelocity = {velocity:?}\n\
             axis = {normal:?}\nacross = {first:?}",
            self.mass,
            self.size,
            self.centre(height),
        );
        for (i, [a, b]) in self.points.iter().enumerate() {
            let at = plus(plus(plus(self.foot, height, normal), *a, first), *b, second);
            add!(case, "[[contact]]\nname = 'k{i}'\non = 'b'\nat = {at:?}\nlaw = {law}");
            add!(
                case,
                "obstacle = {{ kind = 'plane', point = {:?}, normal = {normal:?}{obstacle} }}",
                self.foot
            );
        }
    }

    fn held(&self, sums: Vec<Sum>, energy: f64, entered: Option<f64>) -> Held {
        Held { sums, impulse: None, energy, entered }
    }
}

const UP: [f64; 3] = [0.0, 0.0, 1.0];
const NAMES: [&str; 3] = ["x", "y", "z"];

fn places(of: &str, part: &'static str, value: [f64; 3], within: f64) -> Vec<Known> {
    let within = within + 1e-9 * size(value);
    let one = |i: usize| about(&format!("b.{of}.{}", NAMES[i]), part, value[i], within);
    (0..3).map(one).collect()
}

/// A plate falls on a floor, bounces to rest, and slides until friction has stopped it: each impulse takes μ of itself from its momentum along the floor.
pub(super) fn falls(random: &mut Random) -> Crowd {
    let g = random.scale(1.0..20.0);
    let height = if random.one_in(3) { 0.0 } else { random.scale(1e-3..0.1) };
    let (e, friction) = (some(random, 3, 0.0..0.8), some(random, 4, 0.05..0.9));
    let plate = plate(random, UP);
    let speed = some(random, 3, 0.05..3.0);
    let velocity = along(random, UP, speed);
    let (first, fall) = ((2.0 * height / g).sqrt(), (2.0 * height * g).sqrt());
    // Until the bounces have come to rest, and until it stops: μ g t = v, for the impulses of a fall and of all bounces are the weight of that time.
    let rests = first * (1.0 + 2.0 * e / (1.0 - e));
    let stops = if friction > 0.0 { speed / (friction * g) } else { 0.0 };
    let duration = random.between(1.05..2.0) * (rests.max(stops) + 0.02);
    let method = method(random, duration, 200.0..2000.0);
    let (mut t, mut way, mut along, mut rebound) = (first, speed * first, speed, fall);
    while rebound > 1e-9 * fall {
        along = (along - friction * (1.0 + e) * rebound).max(0.0);
        rebound *= e;
        let flight = 2.0 * rebound / g;
        (t, way) = (t + flight, way + along * flight);
    }
    // It slides on.
    let left = if friction > 0.0 { (along / (friction * g)).min(duration - t) } else { duration - t };
    way += along * left - 0.5 * friction * g * left * left;
    let last = along - friction * g * left;
    let mut case = Drawn { length: 1.0, ..Drawn::default() };
    begin(&mut case, [0.0, 0.0, -g], &method.text, duration);
    plate.write(
        &mut case,
        height,
        velocity,
        "",
        &format!("{{ kind = 'constraint', restitution = {e}, friction = {friction} }}"),
    );
    let way = if speed > 0.0 { way / speed } else { 0.0 };
    // The time of an impact is known to a step.
    let missed = method.slack * fall * (1.0 + e) / (1.0 - e);
    let mut values = places("position", "final", plus(plate.centre(0.0), way, velocity), friction * missed);
    let part = if speed > 0.0 { last / speed } else { 0.0 };
    values.extend(places("velocity", "final", velocity.map(|x| x * part), 0.0));
    values.push(exactly("b.position.z", "max", plate.centre(height)[2]));
    let weight = weight(plate.points.len(), plate.mass * g, 0.0);
    let energy = plate.mass * (g * height + 0.5 * speed * speed) + 1e-3 * plate.mass * g * plate.size[0];
    let mut held =
        plate.held(vec![weight], energy, entered(plate.size[0].max(plate.size[1]), &method, fall, g));
    held.impulse = Some((plate.mass * g * duration, 0.0));
    known(case, values, held)
}

/// A plate on an incline slides by g (sin α − μ cos α), or sticks.
pub(super) fn incline(random: &mut Random) -> Crowd {
    let (g, slope, towards) = (random.scale(1.0..20.0), random.between(0.02..1.0), random.between(-PI..PI));
    let normal = [slope.sin() * towards.cos(), slope.sin() * towards.sin(), slope.cos()];
    let friction = some(random, 5, 0.05..0.9);
    let e = some(random, 2, 0.0..0.9);
    let plate = plate(random, normal);
    let down = plus([0.0, 0.0, -1.0], slope.cos(), normal).map(|x| x / slope.sin());
    let speed = some(random, 2, 0.05..2.0);
    let pull = g * (slope.sin() - friction * slope.cos());
    let duration = random.scale(0.1..1.5);
    let (way, last) = if pull > 0.0 {
        (speed * duration + 0.5 * pull * duration * duration, speed + pull * duration)
    } else {
        let stops = (-speed / pull).min(duration);
        (speed * stops + 0.5 * pull * stops * stops, speed + pull * stops)
    };
    let method = method(random, duration, 200.0..2000.0);
    let mut case = Drawn { length: 1.0, ..Drawn::default() };
    begin(&mut case, [0.0, 0.0, -g], &method.text, duration);
    plate.write(
        &mut case,
        0.0,
        down.map(|x| x * speed),
        "",
        &format!("{{ kind = 'constraint', restitution = {e}, friction = {friction} }}"),
    );
    let mut values = places("position", "final", plus(plate.centre(0.0), way, down), 0.0);
    values.extend(places("velocity", "final", down.map(|x| x * last), 0.0));
    let normal = plate.mass * g * slope.cos();
    // A first step from rest falls before it presses.
    let first = 1e-4 * plate.mass * g * plate.size[0];
    let slid = about("energy.contact_loss", "final", friction * normal * way, first);
    values.push(slid);
    let energy =
        plate.mass * (0.5 * speed * speed + g * way * slope.sin()) + 1e-3 * plate.mass * g * plate.size[0];
    let entered = entered(plate.size[0].max(plate.size[1]), &method, 0.0, g);
    let mut held = plate.held(vec![weight(plate.points.len(), normal, 0.0)], energy, entered);
    held.impulse = Some((normal * duration, 0.0));
    known(case, values, held)
}

/// A plate on a floor that goes up and down by A (1 − cos ωt), more slowly than it would leave it: it follows, and bears m (g + A ω² cos ωt).
pub(super) fn lift(random: &mut Random) -> Crowd {
    let (g, most) = (random.scale(1.0..20.0), random.between(0.1..0.9));
    let frequency = random.scale(2.0..50.0);
    let amplitude = most * g / (frequency * frequency);
    let friction = some(random, 2, 0.05..0.9);
    let e = some(random, 2, 0.0..0.9);
    let plate = plate(random, UP);
    let duration = TAU / frequency * random.between(0.3..2.0);
    let method = method(random, duration, 400.0..3000.0);
    let mut case = Drawn { length: 1.0, ..Drawn::default() };
    begin(&mut case, [0.0, 0.0, -g], &method.text, duration);
    let motion = format!(
        ", motion = {{ displacement = [0, 0, {amplitude:e}], amplitude = {{ kind = 'expression', formula = '1 - cos({frequency}*t)' }} }}"
    );
    let law = format!("{{ kind = 'constraint', restitution = {e}, friction = {friction} }}");
    plate.write(&mut case, 0.0, [0.0; 3], &motion, &law);
    let angle = frequency * duration;
    let up = amplitude * (1.0 - angle.cos());
    let values = places("position", "final", plus(plate.centre(0.0), up, UP), 0.0);
    let force = plate.mass * (g + amplitude * frequency * frequency * angle.cos());
    let energy = plate.mass * g * amplitude;
    let entered = entered(plate.size[0].max(plate.size[1]), &method, amplitude * frequency, g);
    let mut held = plate.held(vec![weight(plate.points.len(), force, 0.0)], energy, entered);
    held.impulse = Some((plate.mass * (g * duration + amplitude * frequency * angle.sin()), 0.0));
    known(case, values, held)
}

/// A plate on a belt is taken along by μ g until it has the belt's speed.
pub(super) fn belt(random: &mut Random) -> Crowd {
    let (g, friction) = (random.scale(1.0..20.0), random.between(0.05..0.9));
    let plate = plate(random, UP);
    let speed = random.scale(0.05..3.0);
    let velocity = along(random, UP, speed);
    let taken = speed / (friction * g);
    let duration = taken * random.between(0.3..3.0);
    let method = method(random, duration, 200.0..2000.0);
    let mut case = Drawn { length: 1.0, ..Drawn::default() };
    begin(&mut case, [0.0, 0.0, -g], &method.text, duration);
    let motion = format!(
        ", motion = {{ displacement = {velocity:?}, amplitude = {{ kind = 'expression', formula = 't' }} }}"
    );
    let e = some(random, 2, 0.0..0.9);
    let law = format!("{{ kind = 'constraint', restitution = {e}, friction = {friction} }}");
    plate.write(&mut case, 0.0, [0.0; 3], &motion, &law);
    let slides = taken.min(duration);
    let way = 0.5 * friction * g * slides * slides + speed * (duration - slides);
    let mut values = places("position", "final", plus(plate.centre(0.0), way / speed, velocity), 0.0);
    let part = (duration / taken).min(1.0);
    values.extend(places("velocity", "final", velocity.map(|x| x * part), 0.0));
    let weight = weight(plate.points.len(), plate.mass * g, 0.0);
    let held = plate.held(
        vec![weight],
        plate.mass * speed * speed,
        entered(plate.size[0].max(plate.size[1]), &method, 0.0, g),
    );
    known(case, values, held)
}

/// A flat ring on points of one circle spins until friction stops it: μ m g R is its moment, however the points share the weight. That a share
/// is uneven moves the ring; by symmetry it need not be.
pub(super) fn ring(random: &mut Random) -> Crowd {
    let (g, friction) = (random.scale(1.0..20.0), random.between(0.05..0.9));
    let (mass, radius, spin) = (random.scale(0.1..10.0), random.scale(0.05..0.5), random.scale(1.0..30.0));
    // A cylinder of that radius whose points lie on a circle within: J = m r²/2.
    let (rim, thickness) = (radius * random.between(0.4..1.0), 0.02 * radius);
    let moment = 0.5 * mass * radius * radius;
    let slowing = friction * mass * g * rim / moment;
    let stops = spin / slowing;
    let duration = stops * random.between(0.3..1.8);
    let method = method(random, duration, 200.0..2000.0);
    let points = count(random);
    let mut case = Drawn { length: 1.0, ..Drawn::default() };
    begin(&mut case, [0.0, 0.0, -g], &method.text, duration);
    add!(
        case,
        "[[body]]\nname = 'b'\nmass = {mass}\ninertia = {{ kind = 'cylinder', radius = {radius}, length = {thickness} }}\n\
         position = [0, 0, {}]\naxis = [0, 0, 1]\nspin = [0, 0, {spin}]",
        0.5 * thickness
    );
    let turned = random.between(-PI..PI);
    for i in 0..points {
        let angle = turned + TAU * i as f64 / points as f64;
        let at = [rim * angle.cos(), rim * angle.sin(), 0.0];
        add!(case, "[[contact]]\nname = 'k{i}'\non = 'b'\nat = {at:?}");
        add!(case, "obstacle = {{ kind = 'plane', normal = [0, 0, 1] }}");
        add!(case, "law = {{ kind = 'constraint', restitution = 0, friction = {friction} }}");
    }
    let last = (spin - slowing * duration).max(0.0);
    // Friction that is not the same all around makes up to a hundredth of another moment.
    let values = vec![
        about("b.spin.z", "final", last, 1e-3 * spin),
        exactly("b.position.z", "final", 0.5 * thickness),
        about("b.position.x", "final", 0.0, 1e-3 * radius),
        about("b.position.y", "final", 0.0, 1e-3 * radius),
    ];
    let energy = 0.5 * moment * spin * spin;
    let held = Held {
        sums: vec![weight(points, mass * g, 0.0)],
        impulse: Some((mass * g * duration, 0.0)),
        energy,
        entered: entered(radius, &method, 0.0, g),
    };
    known(case, values, held)
}

/// A plate falls on n elastic points evenly about its centre: ½ m v² + m g δ = n K δᵖ⁺¹/(p + 1) is how far it goes down, and nothing is lost.
pub(super) fn elastic(random: &mut Random) -> Crowd {
    let (g, height, power) = (
        random.scale(1.0..20.0),
        random.scale(1e-3..0.1),
        if random.coin() { 1.5 } else { random.between(1.0..2.5) },
    );
    let mut plate = plate(random, UP);
    even(&mut plate);
    let (points, mass) = (plate.points.len(), plate.mass);
    // Softer than ten indentations of its own height would take.
    let deepest = plate.size[0] * random.scale(1e-4..1e-2);
    let stiffness =
        mass * g * (height + deepest) * (power + 1.0) / (points as f64 * deepest.powf(power + 1.0));
    let (first, speed) = ((2.0 * height / g).sqrt(), (2.0 * g * height).sqrt());
    let lasts = 4.0 * deepest / speed;
    let duration = (2.0 * first + lasts) * random.between(1.0..3.0);
    let method = smooth_method(random, lasts / 200.0, duration);
    let mut case = Drawn { length: 1.0, ..Drawn::default() };
    begin(&mut case, [0.0, 0.0, -g], &method, duration);
    let law = format!("{{ kind = 'hertz', stiffness = {stiffness:e}, exponent = {power} }}");
    plate.write(&mut case, height, [0.0; 3], "", &law);
    let values = vec![
        about("b.position.z", "min", plate.centre(-deepest)[2], 1e-9 * deepest),
        exactly("b.position.z", "max", plate.centre(height)[2]),
        exactly("k0.force", "max", stiffness * deepest.powf(power)),
        about("energy.contact_loss", "final", 0.0, 1e-9 * mass * g * height),
    ];
    let held = Held { energy: mass * g * height, ..Held::default() };
    known(case, values, held)
}

/// Points by pairs opposite each other, by which a plate does not turn.
fn even(plate: &mut Plate) {
    let half = plate.points.len().div_ceil(2).max(3);
    plate.points.truncate(half);
    plate.points[1][0] *= 0.9;
    for i in 0..half {
        let [a, b] = plate.points[i];
        plate.points.push([-a, -b]);
    }
}

/// The χ of a law of force, and the part e′ of a closing speed that it gives back: χ (1 + e′) = ln[(1 + χ)/(1 − χ e′)].
fn rebound(law: &str, e: f64) -> f64 {
    let chi = match law {
        "hunt-crossley" => 1.5 * (1.0 - e),
        "lankarani-nikravesh" => 0.75 * (1.0 - e * e),
        "flores" => 1.6 * (1.0 - e) / e,
        "gonthier" => (1.0 - e * e) / e,
        _ => return e,
    };
    let (mut low, mut high) = (0.0, 1.0_f64.min(1.0 / chi));
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        let more = (1.0 + chi).ln() - (1.0 - chi * middle).ln() - chi * (1.0 + middle);
        if more < 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// A plate without weight strikes damped points, and has the rebound of their law.
pub(super) fn damped(random: &mut Random) -> Crowd {
    let law = random.pick(&["hunt-crossley", "lankarani-nikravesh", "flores", "gonthier", "matched"]);
    let (e, speed) = (random.between(0.2..0.95), random.scale(0.05..3.0));
    let power = if random.coin() { 1.5 } else { random.between(1.0..2.5) };
    let mut plate = plate(random, UP);
    even(&mut plate);
    let (points, mass) = (plate.points.len(), plate.mass);
    let deepest = plate.size[0] * random.scale(1e-4..1e-2);
    let stiffness = 0.5 * mass * speed * speed * (power + 1.0) / (points as f64 * deepest.powf(power + 1.0));
    let height = deepest * random.scale(0.1..100.0);
    let back = rebound(law, e);
    let lasts = 4.0 * deepest / speed;
    let duration = height / speed + (lasts + height / speed) / back.max(0.1) * random.between(1.5..3.0);
    let method = smooth_method(random, lasts / 400.0, duration);
    let mut case = Drawn { length: 1.0, ..Drawn::default() };
    begin(&mut case, [0.0; 3], &method, duration);
    let text =
        format!("{{ kind = '{law}', restitution = {e}, stiffness = {stiffness:e}, exponent = {power} }}");
    plate.write(&mut case, height, [0.0, 0.0, -speed], "", &text);
    let lost = 0.5 * mass * speed * speed * (1.0 - back * back);
    let values = vec![
        exactly("b.velocity.z", "final", back * speed),
        exactly("energy.contact_loss", "final", lost),
        about("b.velocity.x", "final", 0.0, 1e-9 * speed),
    ];
    let held = Held { energy: 0.5 * mass * speed * speed, ..Held::default() };
    known(case, values, held)
}

/// Blocks on three feet each slide and turn to rest: what each foot bears is well-posed, and another method with steps of its own finds the same.
pub(super) fn feet(random: &mut Random) -> Crowd {
    let (g, friction) = (random.scale(1.0..20.0), random.between(0.05..0.5));
    let blocks = random.count(2..17);
    let mut tables = String::new();
    let (mut energy, mut stops) = (0.0, 0.0_f64);
    for k in 0..blocks {
        let (mass, radius) = (random.scale(0.1..5.0), random.between(0.1..0.3));
        let height = 0.2 * radius;
        let (speed, spin) = (random.between(0.1..1.0), random.between(-10.0..10.0));
        let velocity = along(random, UP, speed);
        let place = [2.0 * k as f64, 0.0, height];
        tables += &format!(
            "[[body]]\nname = 'b{k}'\nmass = {mass}\ninertia = {{ kind = 'cylinder', radius = {radius}, length = {height} }}\nposition = {place:?}\n\
             axis = [0, 0, 1]\nvelocity = {velocity:?}\nspin = [0, 0, {spin}]\n"
        );
        let turned = random.between(-PI..PI);
        for i in 0..3 {
            let angle = turned + TAU * i as f64 / 3.0 + random.between(-0.2..0.2);
            let at = [place[0] + radius * angle.cos(), radius * angle.sin(), 0.0];
            tables += &format!(
                "[[contact]]\nname = 'k{}'\non = 'b{k}'\nat = {at:?}\nobstacle = {{ kind = 'plane', normal = [0, 0, 1] }}\n\
                 law = {{ kind = 'constraint', restitution = 0, friction = {friction} }}\n",
                3 * k + i
            );
        }
        energy += 0.5 * mass * (speed * speed + 0.5 * radius * radius * spin * spin);
        stops = stops.max((speed + radius * spin.abs()) / (friction * g));
    }
    let duration = stops * random.between(0.3..1.2);
    let one = method(random, duration, 400.0..2000.0);
    let kind = random.pick(&["moreau-jean", "nonsmooth-generalized-alpha"]);
    let other = format!("{{ kind = '{kind}', step = {:e} }}", duration / 1500.0);
    let entered = entered(1.0, &one, 0.0, g);
    let [case, other] = [one.text, other].map(|integrator| {
        let mut case = Drawn { length: 1.0, ..Drawn::default() };
        begin(&mut case, [0.0, 0.0, -g], &integrator, duration);
        case.text += &tables;
        case
    });
    let held = Held { energy, entered, ..Held::default() };
    Crowd { posed: Posed { case, answer: Answer::Other(Box::new(other), Relation::Equal) }, held }
}
