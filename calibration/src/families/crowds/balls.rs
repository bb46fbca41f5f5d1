//! Balls on planes, and against each other.

use super::{
    Crowd, ENTERED, Held, Method, about, begin, count, cross, dot, entered, known, method, plus, size,
    smooth_method, some, stepping,
};
use crate::families::{Known, exactly};
use crate::random::Random;
use crate::{Drawn, add};
use std::f64::consts::PI;

/// A ball of even density on a plane through the origin.
#[derive(Clone, Copy, Debug)]
struct Ball {
    mass: f64,
    radius: f64,
    friction: f64,
    restitution: f64,
    position: [f64; 3],
    velocity: [f64; 3],
    spin: [f64; 3],
}

impl Ball {
    /// On the plane at `place`, at that height over it.
    fn draw(random: &mut Random, normal: [f64; 3], place: [f64; 3], height: f64) -> Ball {
        let radius = random.scale(0.01..0.2);
        Ball {
            mass: random.scale(0.05..5.0),
            radius,
            friction: some(random, 5, 0.02..0.9),
            restitution: 0.0,
            position: plus(place, radius + height, normal),
            velocity: [0.0; 3],
            spin: [0.0; 3],
        }
    }

    fn write(&self, case: &mut Drawn, k: usize, normal: [f64; 3]) {
        let Ball { mass, radius, friction, restitution, position, velocity, spin } = self;
        add!(
            case,
            "[[body]]\nname = 'b{k}'\nmass = {mass}\ninertia = {{ kind = 'sphere', radius = {radius} }}\nposition = {position:?}\n\
             velocity = {velocity:?}\nspin = {spin:?}"
        );
        add!(
            case,
            "[[contact]]\nname = 'k{k}'\non = 'b{k}'\nradius = {radius}\nobstacle = {{ kind = 'plane', normal = {normal:?} }}"
        );
        add!(case, "law = {{ kind = 'constraint', restitution = {restitution}, friction = {friction} }}");
    }

    /// Velocity of its lowest point along a plane: v + ω × (−R n).
    fn slip(&self, normal: [f64; 3]) -> [f64; 3] {
        let u = plus(self.velocity, -self.radius, cross(self.spin, normal));
        plus(u, -dot(u, normal), normal)
    }

    /// Takes an impulse p m of friction at its lowest point: J = ⅖ m R².
    fn rub(&mut self, normal: [f64; 3], p: [f64; 3]) {
        self.velocity = plus(self.velocity, 1.0, p);
        self.spin = plus(self.spin, -2.5 / self.radius, cross(normal, p));
    }

    /// Friction of an impulse m `normal_part` of its plane: what ends its slip, ²⁄₇ m u, or μ of that impulse.
    fn strike(&mut self, normal: [f64; 3], normal_part: f64) {
        let slip = self.slip(normal);
        let (needed, most) = (2.0 / 7.0 * size(slip), self.friction * normal_part);
        let part = if needed > most { -2.0 / 7.0 * most / needed } else { -2.0 / 7.0 };
        self.rub(normal, slip.map(|u| part * u));
        self.velocity = plus(self.velocity, normal_part, normal);
    }

    /// The values at the end, and its energy of motion.
    fn values(&self, k: usize, missed: f64) -> Vec<Known> {
        let mut values = Vec::new();
        for (i, axis) in ["x", "y", "z"].into_iter().enumerate() {
            // Impacts are found, and directions known, to a part of 1e-9 of the motion.
            let v = size(self.velocity) + self.radius * size(self.spin);
            let w = v / self.radius;
            let missed = missed + 1e-9 * (self.radius + size(self.position));
            values.push(about(&format!("b{k}.position.{axis}"), "final", self.position[i], missed));
            values.push(about(&format!("b{k}.velocity.{axis}"), "final", self.velocity[i], 1e-9 * v));
            values.push(about(&format!("b{k}.spin.{axis}"), "final", self.spin[i], 1e-9 * w));
        }
        values
    }

    fn energy(&self) -> f64 {
        let (v, w) = (size(self.velocity), self.radius * size(self.spin));
        0.5 * self.mass * (v * v + 0.4 * w * w)
    }
}

const UP: [f64; 3] = [0.0, 0.0, 1.0];

/// A vector along the floor.
fn flat(random: &mut Random, size: f64) -> [f64; 3] {
    let angle = random.between(-PI..PI);
    [size * angle.cos(), size * angle.sin(), 0.0]
}

/// Balls fall from heights of their own, with spins about any axis, and bounce: each impact ends the slip of a ball, or takes μ of its impulse.
pub(super) fn bounce(random: &mut Random) -> Crowd {
    let g = random.scale(1.0..20.0);
    let mut balls = Vec::new();
    for k in 0..count(random) {
        let height = random.scale(0.01..1.0);
        let mut ball = Ball::draw(random, UP, [k as f64, 0.0, 0.0], height);
        ball.restitution = random.between(0.2..1.0);
        ball.velocity = flat(random, 2.0);
        ball.spin = random.vector(30.0);
        balls.push((ball, height));
    }
    // Up to the sixth impact of any ball.
    let until = |(ball, height): &(Ball, f64)| {
        let first = (2.0 * height / g).sqrt();
        let flights: f64 = (1..6).map(|k| 2.0 * first * ball.restitution.powi(k)).sum();
        first + flights
    };
    let duration = balls.iter().map(until).fold(f64::INFINITY, f64::min) * random.between(0.2..0.99);
    let method = method(random, duration, 300.0..3000.0);
    let mut case = Drawn { length: 1.0, ..Drawn::default() };
    begin(&mut case, [0.0, 0.0, -g], &method.text, duration);
    let (mut values, mut energy, mut fastest) = (Vec::new(), 0.0, 0.0_f64);
    for (k, (ball, height)) in balls.iter().enumerate() {
        ball.write(&mut case, k, UP);
        energy += ball.energy() + ball.mass * g * height;
        let (mut ball, mut left) = (*ball, duration);
        let (mut lands, fall) = ((2.0 * height / g).sqrt(), (2.0 * g * height).sqrt());
        fastest = fastest.max(fall);
        while lands < left {
            fly(&mut ball, lands, g);
            left -= lands;
            let down = -ball.velocity[2];
            ball.strike(UP, (1.0 + ball.restitution) * down);
            ball.position[2] = ball.radius;
            lands = 2.0 * ball.velocity[2] / g;
        }
        fly(&mut ball, left, g);
        // The times of up to six impacts are known to a step each.
        let sideways = size(ball.velocity).max(2.0) + ball.radius * 30.0;
        let missed = 6.0 * method.slack * (2.0 * fall + sideways);
        let mut of = ball.values(k, missed);
        // So is the vertical speed behind them.
        let late = 12.0 * method.slack * g + 1e-9 * fall;
        of.iter_mut().filter(|v| v.column.ends_with("velocity.z")).for_each(|v| v.within = late);
        values.extend(of);
        // A ball that has not landed has its least height at the end.
        let least = if left < duration { ball.radius } else { ball.position[2] };
        values.push(about(&format!("b{k}.position.z"), "min", least, missed));
    }
    let entered = entered(1.0, &method, fastest, g);
    known(case, values, Held { energy, entered, ..Held::default() })
}

/// A flight.
fn fly(ball: &mut Ball, time: f64, g: f64) {
    ball.position = plus(plus(ball.position, time, ball.velocity), -0.5 * g * time * time, UP);
    ball.velocity[2] -= g * time;
}

/// What holds of balls that stay on what bears them: the impulse of all contacts is that of the weight.
fn borne(energy: f64, weight: f64, method: &Method, g: f64) -> Held {
    Held { energy, entered: entered(1.0, method, 0.0, g), impulse: Some((weight, 0.0)), ..Held::default() }
}

/// Balls set down on a floor with velocities and spins of their own slip for 2 u/(7 μ g), on parabolas, and then roll.
pub(super) fn roll(random: &mut Random) -> Crowd {
    let g = random.scale(1.0..20.0);
    let mut balls = Vec::new();
    let e = some(random, 2, 0.0..0.9);
    for k in 0..count(random) {
        let mut ball = Ball::draw(random, UP, [k as f64, 0.0, 0.0], 0.0);
        ball.restitution = e;
        let speed = random.between(0.1..2.0);
        ball.velocity = flat(random, speed);
        ball.spin = random.vector(20.0);
        balls.push(ball);
    }
    let duration = random.scale(0.1..2.0);
    let method = method(random, duration, 300.0..3000.0);
    let mut case = Drawn { length: 1.0, ..Drawn::default() };
    begin(&mut case, [0.0, 0.0, -g], &method.text, duration);
    let (mut values, mut energy) = (Vec::new(), 0.0);
    for (k, ball) in balls.iter().enumerate() {
        ball.write(&mut case, k, UP);
        energy += ball.energy();
        let mut ball = *ball;
        let slip = ball.slip(UP);
        let limit = ball.friction * g;
        let slips = if limit > 0.0 { (2.0 / 7.0 * size(slip) / limit).min(duration) } else { duration };
        let pull = slip.map(|u| -limit * u / size(slip));
        ball.position = plus(plus(ball.position, slips, ball.velocity), 0.5 * slips * slips, pull);
        ball.rub(UP, pull.map(|a| a * slips));
        ball.position = plus(ball.position, duration - slips, ball.velocity);
        values.extend(ball.values(k, 0.0));
        values.push(exactly(&format!("k{k}.force"), "final", ball.mass * g));
    }
    let weight = balls.iter().map(|ball| ball.mass * g * duration).sum();
    known(case, values, borne(energy, weight, &method, g))
}

/// Balls let go on an incline roll with ⁵⁄₇ g sin α, where μ ≥ ²⁄₇ tan α, or slip with g (sin α − μ cos α).
pub(super) fn incline(random: &mut Random) -> Crowd {
    let (g, slope, towards) = (random.scale(1.0..20.0), random.between(0.02..1.2), random.between(-PI..PI));
    let normal = [slope.sin() * towards.cos(), slope.sin() * towards.sin(), slope.cos()];
    let down = plus([0.0, 0.0, -1.0], slope.cos(), normal).map(|x| x / slope.sin());
    let aside = cross(normal, down);
    let duration = random.scale(0.1..2.0);
    let method = method(random, duration, 300.0..3000.0);
    let mut case = Drawn { length: 1.0, ..Drawn::default() };
    begin(&mut case, [0.0, 0.0, -g], &method.text, duration);
    let (mut values, mut energy, mut weight) = (Vec::new(), 0.0, 0.0);
    for k in 0..count(random) {
        let mut ball = Ball::draw(random, normal, aside.map(|x| x * k as f64), 0.0);
        ball.restitution = some(random, 2, 0.0..0.9);
        ball.write(&mut case, k, normal);
        let pull = if ball.friction >= 2.0 / 7.0 * slope.tan() {
            2.0 / 7.0 * slope.sin()
        } else {
            ball.friction * slope.cos()
        } * g;
        let speed = (g * slope.sin() - pull) * duration;
        energy += ball.mass * g * slope.sin() * 0.5 * speed * duration;
        ball.position = plus(ball.position, 0.5 * speed * duration, down);
        ball.rub(normal, down.map(|x| -x * pull * duration));
        ball.velocity = down.map(|x| x * speed);
        values.extend(ball.values(k, 0.0));
        values.push(exactly(&format!("k{k}.force"), "final", ball.mass * g * slope.cos()));
        weight += ball.mass * g * slope.cos() * duration;
    }
    known(case, values, borne(energy, weight, &method, g))
}

/// Balls on one line, each of which strikes its neighbours.
#[derive(Clone, Debug)]
struct Line {
    masses: Vec<f64>,
    radii: Vec<f64>,
    places: Vec<f64>,
    speeds: Vec<f64>,
    direction: [f64; 3],
}

/// What becomes of them.
struct Struck {
    /// The shortest time between two impacts, and from the last one to the end.
    apart: f64,
    /// The least closing speed.
    slowest: f64,
    impacts: usize,
}

impl Line {
    fn draw(random: &mut Random) -> Line {
        let balls = count(random) + 1;
        let alike = random.coin();
        let one = (random.scale(0.1..5.0), random.scale(0.02..0.1));
        let of = |random: &mut Random| {
            if alike { one } else { (random.scale(0.1..5.0), random.scale(0.02..0.1)) }
        };
        let (masses, radii): (Vec<f64>, Vec<f64>) = (0..balls).map(|_| of(random)).unzip();
        let mut places = vec![0.0];
        for i in 1..balls {
            places.push(places[i - 1] + radii[i - 1] + radii[i] + random.scale(0.005..0.1));
        }
        // One that strikes a row at rest, or all on their ways.
        let cradle = random.coin();
        let speeds = (0..balls)
            .map(|i| match (cradle, i) {
                (true, 0) => random.between(0.2..2.0),
                (true, _) => 0.0,
                (false, _) => random.between(-1.0..1.0),
            })
            .collect();
        let direction = random.vector(1.0);
        let length = size(direction);
        Line { masses, radii, places, speeds, direction: direction.map(|x| x / length) }
    }

    /// The pair that touches next, and when.
    fn next(&self) -> Option<(f64, usize)> {
        let when = |i: usize| {
            let gap = self.places[i + 1] - self.places[i] - self.radii[i] - self.radii[i + 1];
            let closing = self.speeds[i] - self.speeds[i + 1];
            (closing > 1e-12).then(|| (gap.max(0.0) / closing, i))
        };
        (0..self.places.len() - 1).filter_map(when).min_by(|a, b| a.0.total_cmp(&b.0))
    }

    fn go(&mut self, time: f64) {
        self.places.iter_mut().zip(&self.speeds).for_each(|(x, v)| *x += v * time);
    }

    /// Moves on through that many impacts at most, and half the way to the next; the time that it takes.
    fn run(&mut self, e: f64, most: usize) -> (f64, Struck) {
        let mut struck = Struck { apart: f64::INFINITY, slowest: f64::INFINITY, impacts: 0 };
        let mut all = 0.0;
        while let Some((time, i)) = self.next() {
            if struck.impacts == most {
                self.go(0.5 * time);
                struck.apart = struck.apart.min(0.5 * time);
                return (all + 0.5 * time, struck);
            }
            self.go(time);
            all += time;
            struck.apart = struck.apart.min(time);
            struck.impacts += 1;
            let (m, n) = (self.masses[i], self.masses[i + 1]);
            let closing = self.speeds[i] - self.speeds[i + 1];
            struck.slowest = struck.slowest.min(closing);
            let impulse = (1.0 + e) * closing * m * n / (m + n);
            self.speeds[i] -= impulse / m;
            self.speeds[i + 1] += impulse / n;
        }
        let further = 0.1 * all + 0.1;
        self.go(further);
        (all + further, struck)
    }

    /// The same through fewer impacts, where some follow each other within a part of the time.
    fn run_apart(&mut self, e: f64, most: usize, part: f64) -> (f64, Struck) {
        let before = self.clone();
        let (mut duration, mut struck) = self.run(e, most);
        for fewer in [40, 20, 10, 6, 5] {
            if struck.apart > part * duration {
                break;
            }
            if fewer < struck.impacts {
                self.clone_from(&before);
                (duration, struck) = self.run(e, fewer);
            }
        }
        (duration, struck)
    }

    fn energy(&self) -> f64 {
        self.masses.iter().zip(&self.speeds).map(|(m, v)| 0.5 * m * v * v).sum()
    }

    fn write(&self, case: &mut Drawn, law: &str) {
        for (k, (mass, radius)) in self.masses.iter().zip(&self.radii).enumerate() {
            let [position, velocity] =
                [&self.places, &self.speeds].map(|of| self.direction.map(|x| x * of[k]));
            add!(
                case,
                "[[body]]\nname = 'b{k}'\nmass = {mass}\ninertia = {{ kind = 'sphere', radius = {radius} }}\n\
                 position = {position:?}\nvelocity = {velocity:?}"
            );
        }
        for (k, radii) in self.radii.windows(2).enumerate() {
            add!(
                case,
                "[[contact]]\nname = 'k{k}'\non = 'b{k}'\nradius = {}\nmount = 'b{}'\nobstacle = {{ kind = 'sphere', radius = {} }}\nlaw = {law}",
                radii[0],
                k + 1,
                radii[1]
            );
        }
    }
}

/// Balls that strike their neighbours one after the other: each impact is that of two bodies.
pub(super) fn line(random: &mut Random) -> Crowd {
    let mut line = Line::draw(random);
    let e = if random.one_in(3) { 1.0 } else { random.between(0.2..1.0) };
    let before = line.clone();
    let most = line.places.len() * random.count(1..3);
    let (duration, struck) = line.run_apart(e, most, 2e-4);
    // Impacts in one step are not one after the other: steps are shorter than what lies between.
    let step = (duration / 500.0).min(0.2 * struck.apart).max(duration / 20_000.0);
    let method = stepping(random, step);
    let mut case = Drawn { length: 1.0, ..Drawn::default() };
    begin(&mut case, [0.0; 3], &method.text, duration);
    // Friction has nothing to hold where all is on one line.
    let friction = some(random, 2, 0.05..0.9);
    before.write(&mut case, &format!("{{ kind = 'constraint', restitution = {e}, friction = {friction} }}"));
    let mut values = Vec::new();
    let missed = method.slack * 10.0 * before.speeds.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    for k in 0..line.places.len() {
        for (i, axis) in ["x", "y", "z"].into_iter().enumerate() {
            let d = line.direction[i];
            values.push(about(&format!("b{k}.velocity.{axis}"), "final", d * line.speeds[k], 1e-6));
            values.push(about(&format!("b{k}.position.{axis}"), "final", d * line.places[k], missed + 1e-6));
        }
    }
    let lost = before.energy() - line.energy();
    values.push(about("energy.contact_loss", "final", lost, 1e-6 * before.energy()));
    let entered = Some(ENTERED + missed);
    known(case, values, Held { energy: before.energy(), entered, ..Held::default() })
}

/// The same with forces that last a twentieth of the time between two impacts: velocities are those of impacts.
pub(super) fn elastic_line(random: &mut Random) -> Crowd {
    let mut line = Line::draw(random);
    let e = if random.coin() { 1.0 } else { random.between(0.6..1.0) };
    let before = line.clone();
    let most = line.places.len().min(20);
    let (duration, struck) = line.run_apart(e, most, 1e-3);
    let lasts = (struck.apart / 20.0).min(duration / 100.0);
    let heaviest = before.masses.iter().fold(0.0_f64, |a, b| a.max(*b));
    // Hertz: a contact of two bodies lasts 3.2145 (m²/(K² v))^⅕, with their reduced mass.
    let stiffness = 0.5 * heaviest * (3.2145 / lasts).powf(2.5) / struck.slowest.sqrt();
    let method = smooth_method(random, lasts / 15.0, duration);
    let mut case = Drawn { length: 1.0, ..Drawn::default() };
    begin(&mut case, [0.0; 3], &method, duration);
    let law = if e < 1.0 {
        format!("{{ kind = 'matched', restitution = {e}, stiffness = {stiffness:e} }}")
    } else {
        format!("{{ kind = 'hertz', stiffness = {stiffness:e} }}")
    };
    before.write(&mut case, &law);
    let mut values = Vec::new();
    for k in 0..line.places.len() {
        for (i, axis) in ["x", "y", "z"].into_iter().enumerate() {
            let value = line.direction[i] * line.speeds[k];
            values.push(about(&format!("b{k}.velocity.{axis}"), "final", value, 1e-6));
        }
    }
    let lost = before.energy() - line.energy();
    values.push(about("energy.contact_loss", "final", lost, 1e-6 * before.energy()));
    known(case, values, Held { energy: before.energy(), ..Held::default() })
}
