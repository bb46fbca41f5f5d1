//! Beams on many points of a floor.

use super::{
    Crowd, Held, Sum, about, begin, entered, known, method, plus, size, smooth_method, some, stepping,
};
use crate::families::exactly;
use crate::random::Random;
use crate::{Drawn, add};
use std::f64::consts::PI;

/// A round rod along x.
struct Rod {
    length: f64,
    radius: f64,
    modulus: f64,
    density: f64,
}

impl Rod {
    fn draw(random: &mut Random) -> Rod {
        let length = random.scale(0.2..2.0);
        Rod {
            length,
            radius: length * random.scale(3e-3..0.02),
            modulus: random.scale(1e9..1e11),
            density: random.scale(800.0..8000.0),
        }
    }

    fn mass(&self) -> f64 {
        self.density * PI * self.radius * self.radius * self.length
    }

    fn section(&self) -> String {
        let Rod { radius, modulus, density, .. } = self;
        format!("{{ kind = 'circle', modulus = {modulus}, density = {density}, radius = {radius:e} }}")
    }

    /// The first circular frequency of its bending when it is free \[1/s\].
    fn slowest(&self) -> f64 {
        22.37 / (self.length * self.length) * 0.5 * self.radius * (self.modulus / self.density).sqrt()
    }

    fn write(&self, case: &mut Drawn, height: f64, direction: [f64; 3], elements: usize, further: &str) {
        add!(
            case,
            "[[beam]]\nname = 'rod'\nstart = [0, 0, {height:e}]\nlength = {}\ndirection = {direction:?}\nelements = {elements}\nsection = {}\n{further}",
            self.length,
            self.section()
        );
    }
}

/// Contacts of the whole rod with a floor at that many points, and one at its root.
fn floor(case: &mut Drawn, points: usize, law: &str) {
    add!(
        case,
        "[[contact]]\nname = 'k'\non = 'rod'\npoints = {points}\nobstacle = {{ kind = 'plane', normal = [0, 0, 1] }}\nlaw = {law}"
    );
}

/// The sum of the last forces at those points.
fn weight(points: std::ops::Range<usize>, factor: impl Fn(usize) -> f64, value: f64, within: f64) -> Sum {
    let terms = points.map(|i| (format!("k.{i}.force"), factor(i))).collect();
    Sum { name: "sum of the forces", terms, value, within }
}

/// A rod strikes a floor flat, with four points in every element or more: its points rebound together, and it moves on without bending.
pub(super) fn flat(random: &mut Random) -> Crowd {
    let rod = Rod::draw(random);
    let elements = random.count(2..11);
    let points = random.count(4 * elements..51);
    let (e, friction) = (random.between(0.1..1.0), some(random, 3, 0.05..0.9));
    let (down, speed) = (random.scale(0.05..2.0), some(random, 3, 0.05..2.0));
    let [angle, course] = [random.between(-PI..PI), random.between(-PI..PI)];
    let height = random.scale(1e-3..0.1);
    let lands = height / down;
    let duration = lands * (1.0 + random.between(0.2..2.0));
    let method = method(random, duration, 100.0..1000.0);
    let mut case = Drawn { length: rod.length, ..Drawn::default() };
    begin(&mut case, [0.0; 3], &method.text, duration);
    let along = [course.cos(), course.sin(), 0.0];
    let velocity = plus([0.0, 0.0, -down], speed, along);
    let direction = [angle.cos(), angle.sin(), 0.0];
    rod.write(&mut case, height, direction, elements, &format!("velocity = {velocity:?}"));
    floor(&mut case, points, &format!("{{ kind = 'constraint', restitution = {e}, friction = {friction} }}"));
    let slides = (speed - friction * (1.0 + e) * down).max(0.0);
    let left = duration - lands;
    let tip = plus([0.0, 0.0, e * down * left], rod.length, direction);
    let tip = plus(tip, speed * lands + slides * left, along);
    let after = plus([0.0, 0.0, e * down], slides, along);
    let missed = method.slack * (1.0 + e) * (down + speed);
    let mass = rod.mass();
    let mut values = Vec::new();
    for (i, axis) in ["x", "y", "z"].into_iter().enumerate() {
        values.push(about(&format!("rod.tip.position.{axis}"), "final", tip[i], missed));
        values.push(about(
            &format!("momentum.{axis}"),
            "final",
            mass * after[i],
            1e-9 * mass * (down + speed),
        ));
    }
    let energy = 0.5 * mass * (down * down + speed * speed);
    let lost = energy - 0.5 * mass * size(after).powi(2);
    values.push(exactly("energy.contact_loss", "final", lost));
    let held = Held {
        energy,
        impulse: Some((mass * (1.0 + e) * down, 0.0)),
        entered: entered(rod.length, &method, down, 0.0),
        ..Held::default()
    };
    known(case, values, held)
}

/// A rod with damping falls flat and comes to rest: all impulses are the weight of the run, and all forces the weight.
pub(super) fn rest(random: &mut Random) -> Crowd {
    let rod = Rod::draw(random);
    let (elements, points) = (random.count(3..11), random.count(5..31));
    let (e, friction) = (some(random, 2, 0.0..0.6), some(random, 2, 0.05..0.9));
    let (g, height) = (9.81, rod.radius * random.scale(0.1..3.0));
    let damping = 0.1 / rod.slowest();
    let (first, fall) = ((2.0 * height / g).sqrt(), (2.0 * g * height).sqrt());
    let duration = first * (1.0 + 2.0 * e / (1.0 - e)) + random.between(0.1..0.3);
    let method = method(random, duration, 1000.0..3000.0);
    let mut case = Drawn { length: rod.length, ..Drawn::default() };
    begin(&mut case, [0.0, 0.0, -g], &method.text, duration);
    let further = format!("damping = {{ stiffness = {damping:e} }}");
    rod.write(&mut case, height, [1.0, 0.0, 0.0], elements, &further);
    floor(&mut case, points, &format!("{{ kind = 'constraint', restitution = {e}, friction = {friction} }}"));
    let mass = rod.mass();
    let values = vec![
        about("momentum.z", "final", 0.0, 0.01 * mass * fall),
        about("rod.tip.position.z", "final", 0.0, 0.02 * height),
        about("momentum.x", "final", 0.0, 0.01 * mass * fall),
    ];
    let held = Held {
        sums: vec![weight(1..points + 1, |_| 1.0, mass * g, 0.05 * mass * g)],
        impulse: Some((mass * g * duration, 0.01 * mass * fall)),
        energy: mass * g * height,
        entered: entered(rod.length, &method, fall, g),
    };
    known(case, values, held)
}

/// An arm in the plane on a hinge lies down on a floor: the moments of all forces about the hinge are that of its weight.
pub(super) fn arm(random: &mut Random) -> Crowd {
    let rod = Rod::draw(random);
    let (elements, points) = (random.count(4..16), random.count(5..31));
    let (g, angle) = (9.81, random.between(0.003..0.03));
    let low = 1e-3 * rod.length;
    let duration = random.between(0.8..1.5) * rod.length.sqrt();
    let mass = rod.mass();
    let force = random.one_in(3);
    let e = some(random, 2, 0.0..0.5);
    let law = if force {
        let deepest = 1e-3 * rod.length;
        let stiffness = mass * g / rod.length / deepest.powf(1.5);
        format!("{{ kind = 'hunt-crossley', restitution = 0.3, stiffness = {stiffness:e} }}")
    } else {
        let friction = some(random, 2, 0.05..0.5);
        format!("{{ kind = 'constraint', restitution = {e}, friction = {friction} }}")
    };
    let step = duration / random.scale(2000.0..5000.0);
    let method = stepping(random, step);
    let entered = entered(rod.length, &method, (3.0 * g * (angle + 1e-3) * rod.length).sqrt(), g);
    let integrator = if force { smooth_method(random, step, duration) } else { method.text };
    let mut case = Drawn { length: rod.length, ..Drawn::default() };
    add!(case, "gravity = [0, -{g}]\nintegrator = {integrator}\nrun = {{ duration = {duration:e} }}");
    add!(case, "output = {{ step = {:e} }}\nbeam = {{ length = {} }}", duration / 100.0, rod.length);
    add!(case, "damping = {{ stiffness = {:e} }}\nsection = {}", 0.05 / rod.slowest(), rod.section());
    add!(case, "hub = {{ motion = {{ kind = 'free', angle = {angle} }} }}");
    // A hub without inertia is beyond the first-order coupling.
    add!(case, "model = {{ coupling = '{}' }}", random.pick(&["exact", "high"]));
    add!(case, "basis = {{ kind = 'finite-elements', elements = {elements} }}");
    add!(case, "[[contact]]\nname = 'k'\non = 'beam'\npoints = {points}\nlaw = {law}");
    add!(case, "obstacle = {{ kind = 'plane', point = [0, -{low}] }}");
    let moment = 0.5 * mass * g * rod.length;
    let lever = |i: usize| rod.length * i as f64 / points as f64;
    // Arms slope by a hundredth, and vibrate.
    let rests = Sum { name: "moment of the forces", ..weight(1..points + 1, lever, moment, 0.05 * moment) };
    let fall = (angle + 1e-3) * rod.length;
    let held = Held {
        sums: vec![rests],
        impulse: None,
        energy: 0.5 * mass * g * fall,
        entered: entered.filter(|_| !force),
    };
    let values = vec![about("hub.angle", "final", -1e-3, if force { 0.02 } else { 5e-3 })];
    known(case, values, held)
}

/// The χ of a matched force gives back e: a rod without weight meets soft points, by which it hardly bends.
pub(super) fn soft(random: &mut Random) -> Crowd {
    let rod = Rod::draw(random);
    let (elements, points) = (random.count(2..9), random.count(20..51));
    let (e, down) = (random.between(0.3..1.0), random.scale(0.05..2.0));
    let mass = rod.mass();
    // A contact of ten periods of its first vibration, in which it goes down by a third of v T, and by no more than it is high.
    let lasts = 60.0 / rod.slowest();
    let down = down.min(rod.radius / lasts);
    let stiffness = 0.5 * mass * (3.2145 / lasts).powf(2.5) / down.sqrt() / rod.length;
    let height = down * lasts * random.between(0.1..1.0);
    let duration = 2.0 * height / down + 4.0 * lasts / e;
    let method = smooth_method(random, lasts / 300.0, duration);
    let mut case = Drawn { length: rod.length, ..Drawn::default() };
    begin(&mut case, [0.0; 3], &method, duration);
    let further = format!("velocity = [0, 0, -{down}]");
    rod.write(&mut case, height, [1.0, 0.0, 0.0], elements, &further);
    floor(
        &mut case,
        points,
        &format!("{{ kind = 'matched', restitution = {e}, stiffness = {stiffness:e} }}"),
    );
    let energy = 0.5 * mass * down * down;
    let values = vec![
        about("momentum.z", "final", mass * e * down, 0.01 * mass * down),
        about("energy.contact_loss", "final", energy * (1.0 - e * e), 0.02 * energy),
    ];
    known(case, values, Held { energy, ..Held::default() })
}
