//! Crowds of contacts: five to fifty of them at once, on bodies, balls and beams, by every kind of law and of method.
//!
//! What each contact bears is not well-posed where there are more of them than the motion asks for. What is, and is held: the motion, the sum of all forces, the momentum that
//! all impulses make, and the two laws that no run may break, by which a rigid point does not enter its obstacle and energy is not made.

mod balls;
mod beams;
mod plates;

use super::{Answer, Known, Posed};
use crate::add;
use crate::outcome::Outcome;
use crate::random::Random;
use std::time::Duration;

/// A case of a crowd and what is held of it besides its answer.
#[derive(Clone, Debug)]
pub struct Crowd {
    /// The case and its answer.
    pub posed: Posed,
    /// What holds for it as for every crowd.
    pub held: Held,
}

/// What holds for a crowd of contacts.
#[derive(Clone, Debug, Default)]
pub struct Held {
    /// Sums of last values of several columns.
    pub sums: Vec<Sum>,
    /// Impulse of all rigid contacts \[N·s\], and the error of that closed form.
    pub impulse: Option<(f64, f64)>,
    /// Energy in play \[J\].
    pub energy: f64,
    /// How far a rigid contact may enter its obstacle \[m\].
    pub entered: Option<f64>,
}

/// A sum of last values of columns, each with a factor.
#[derive(Clone, Debug)]
pub struct Sum {
    /// What it is.
    pub name: &'static str,
    /// The columns and their factors.
    pub terms: Vec<(String, f64)>,
    /// Its value.
    pub value: f64,
    /// Error of the closed form.
    pub within: f64,
}

/// A run is ended after that time: nobody waits longer for a case of a few parts.
pub(super) const LONGEST: Duration = Duration::from_secs(60);
/// Part of the size of a model by which a rigid contact may enter its obstacle.
const ENTERED: f64 = 1e-6;

/// Most steps of equal size of a case.
const MOST_STEPS: f64 = 10_000.0;

/// A family: its name, and how a case of it is drawn.
type Family = (&'static str, fn(&mut Random) -> Crowd);

/// The families.
const FAMILIES: &[Family] = &[
    ("a plate falls and slides", plates::falls),
    ("a plate on an incline", plates::incline),
    ("a plate on a lift", plates::lift),
    ("a plate on a belt", plates::belt),
    ("a ring that spins", plates::ring),
    ("a plate on elastic points", plates::elastic),
    ("a plate on damped points", plates::damped),
    ("feet of sliding and turning blocks", plates::feet),
    ("balls that bounce and spin", balls::bounce),
    ("balls that begin to roll", balls::roll),
    ("balls on an incline", balls::incline),
    ("balls on a line", balls::line),
    ("elastic balls on a line", balls::elastic_line),
    ("a rod that falls flat", beams::flat),
    ("a rod that comes to rest", beams::rest),
    ("an arm that lies down", beams::arm),
    ("a rod on soft points", beams::soft),
];

/// Number of the families.
pub const COUNT: u64 = FAMILIES.len() as u64;

/// The case of a number, in a sequence that a seed begins, with the name of its family: the families follow one another.
pub fn pose(seed: u64, number: u64) -> Crowd {
    let random = &mut Random::new(seed.wrapping_mul(1_000_003).wrapping_add(number));
    let (name, draw) = FAMILIES[(number % FAMILIES.len() as u64) as usize];
    let mut crowd = draw(random);
    crowd.posed.case.subject = name;
    crowd
}

/// Runs a case as `flexion run` does, and holds it against its answer and the laws of contacts.
pub fn judge(crowd: &Crowd, number: u64) -> Outcome {
    super::judge::judge_crowd(crowd, number)
}

/// A method and the step by which it may miss an impact \[s\]: none where it locates events.
struct Method {
    text: String,
    slack: f64,
}

/// One of the four methods, with so many steps where it has a step.
fn method(random: &mut Random, duration: f64, steps: std::ops::Range<f64>) -> Method {
    let step = duration / random.scale(steps);
    stepping(random, step)
}

/// One of the four methods, with that step where it has any.
fn stepping(random: &mut Random, step: f64) -> Method {
    let of = |text: String, slack: f64| Method { text, slack };
    match random.count(0..4) {
        0 => of(format!("{{ kind = 'radau', tolerance = {:e} }}", random.scale(1e-7..1e-4)), 0.0),
        1 => {
            let kind = random.pick(&["generalized-alpha", "hht"]);
            of(format!("{{ kind = '{kind}', step = {step:e} }}"), 0.0)
        }
        2 => of(format!("{{ kind = 'nonsmooth-generalized-alpha', step = {step:e} }}"), step),
        _ => of(format!("{{ kind = 'moreau-jean', step = {step:e} }}"), step),
    }
}

/// A method for a continuous force, with steps of that size where it has any; none of so many steps that it takes long by what it was asked.
fn smooth_method(random: &mut Random, step: f64, duration: f64) -> String {
    let kinds = ["radau", "radau", "generalized-alpha", "hht", "nonsmooth-generalized-alpha", "moreau-jean"];
    match random.pick(&kinds) {
        kind if kind == "radau" || duration > MOST_STEPS * step => {
            format!("{{ kind = 'radau', tolerance = {:e} }}", random.scale(1e-10..1e-6))
        }
        kind => format!("{{ kind = '{kind}', step = {step:e} }}"),
    }
}

/// Number of contacts.
fn count(random: &mut Random) -> usize {
    random.count(5..51)
}

/// Nothing in some cases, and a number in the others.
fn some(random: &mut Random, nothing: usize, range: std::ops::Range<f64>) -> f64 {
    if random.one_in(nothing) { 0.0 } else { random.between(range) }
}

fn begin(case: &mut crate::Drawn, gravity: [f64; 3], integrator: &str, duration: f64) {
    add!(case, "gravity = {gravity:?}\nintegrator = {integrator}\nrun = {{ duration = {duration:e} }}");
    add!(case, "output = {{ step = {:e} }}", duration / 100.0);
}

/// How far a step that resolves contacts lets a point enter: the way of that step with its closing speed, and the ways that gravity makes of a step before a contact presses, of a
/// few of them.
fn entered(size: f64, method: &Method, speed: f64, g: f64) -> Option<f64> {
    Some(ENTERED * size + method.slack * (speed + 4.0 * g * method.slack))
}

/// A closed form with an error of its own.
fn about(column: &str, part: &'static str, value: f64, within: f64) -> Known {
    Known { column: column.to_owned(), part, value, within }
}

/// The sum of the forces of contacts `k0`, `k1`, … at the end.
fn weight(contacts: usize, value: f64, within: f64) -> Sum {
    let terms = (0..contacts).map(|i| (format!("k{i}.force"), 1.0)).collect();
    Sum { name: "sum of the forces", terms, value, within }
}

fn known(case: crate::Drawn, values: Vec<Known>, held: Held) -> Crowd {
    Crowd { posed: Posed { case, answer: Answer::Known(values) }, held }
}

/// a + f b.
fn plus(a: [f64; 3], f: f64, b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] + f * b[i])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn size(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}
