//! Sections that change within a length far shorter than an element.

use super::{Answer, Known, Posed};
use crate::random::Random;
use crate::{Drawn, add};

/// A slender beam: length, bending stiffness, axial stiffness, mass per length.
struct Slender {
    length: f64,
    bending: f64,
    axial: f64,
    mass: f64,
}

fn slender(random: &mut Random) -> Slender {
    let length = random.scale(0.3..30.0);
    let height = length * random.scale(0.003..0.02);
    let (modulus, density, area) = (70e9, 2700.0, height * height);
    let bending = modulus * area * height * height / 12.0;
    Slender { length, bending, axial: modulus * area, mass: density * area }
}

/// The force that deflects the tip by about a thousandth of the length; of the deflection it then leaves out a part of about the square of that.
fn small(force: f64, deflection: f64, beam: &Slender) -> (f64, f64, f64) {
    let factor = 1e-3 * beam.length / deflection;
    (force * factor, 1e-3 * beam.length, 1e-5 * 1e-3 * beam.length)
}

/// The known deflection of the tip in equilibrium.
fn tip(column: &str, value: f64, within: f64) -> Answer {
    let of = |part| Known { column: column.to_owned(), part, value, within };
    Answer::Known(vec![of("min"), of("max"), of("final")])
}

fn model(random: &mut Random, drawn: &mut Drawn) {
    let coupling = random.pick(&["first", "high", "exact"]);
    let elements = random.count(2..20);
    add!(drawn, "[model]\ncoupling = '{coupling}'\n[basis]\nkind = 'finite-elements'\nelements = {elements}");
    add!(
        drawn,
        "[hub]\nmotion = {{ kind = 'constant', speed = 0 }}\n[initial]\nkind = 'static'\n[run]\nduration = 0"
    );
}

/// Tip deflection under a unit force, ∫ (L − x)²/EI dx, of a uniform beam that has EI/k from a to b.
fn notched(beam: &Slender, k: f64, a: f64, b: f64) -> f64 {
    let cube = |x: f64| (beam.length - x).powi(3);
    (cube(0.0) + (k - 1.0) * (cube(a) - cube(b))) / (3.0 * beam.bending)
}

/// A segment from a to b whose flexibility is up to that of the whole beam, and the factor of its softness.
fn segment(random: &mut Random, beam: &Slender) -> (f64, f64, f64) {
    let a = beam.length * random.between(0.05..0.8);
    let width = beam.length * random.scale(1e-4..0.03);
    let softness = 1.0 + beam.length / width * random.scale(0.05..2.0);
    (a, a + width, softness)
}

/// A soft segment of a beam in the plane.
pub(super) fn thin_segment(random: &mut Random) -> Posed {
    let beam = slender(random);
    let (a, b, k) = segment(random, &beam);
    let (force, value, within) = small(1.0, notched(&beam, k, a, b), &beam);
    let mut case = Drawn { length: beam.length, ..Drawn::default() };
    let (area, density) = (beam.axial / 70e9, beam.mass * 70e9 / beam.axial);
    let second = beam.bending / 70e9;
    add!(
        case,
        "[beam]\nlength = {}\n[section]\nkind = 'piecewise'\nends = [{a}, {b}, {}]",
        beam.length,
        beam.length
    );
    add!(
        case,
        "modulus = [70e9, 70e9, 70e9]\ndensity = [{density}, {density}, {density}]\narea = [{area}, {area}, {area}]"
    );
    add!(case, "second-moment = [{second:e}, {:e}, {second:e}]", second / k);
    add!(case, "[[load]]\non = 'tip'\nforce = [0, {force}]");
    model(random, &mut case);
    Posed { case, answer: tip("tip.deflection", value, within) }
}

/// The same in space, by a file of a blade.
pub(super) fn thin_segment_in_space(random: &mut Random) -> Posed {
    let beam = slender(random);
    let (a, b, k) = segment(random, &beam);
    let (force, value, within) = small(1.0, notched(&beam, k, a, b), &beam);
    let mut case = Drawn { length: beam.length, ..Drawn::default() };
    let row = |x: f64, soft: f64| {
        let (ei, gj) = (beam.bending / soft, beam.bending);
        format!("{x},{:e},{:e},{ei:e},{ei:e},{gj:e},1e-6,1e-6\n", beam.mass, beam.axial)
    };
    let rows = [(0.0, 1.0), (a, 1.0), (a, k), (b, k), (b, 1.0), (beam.length, 1.0)];
    let table: String = rows.iter().map(|(x, soft)| row(*x, *soft)).collect();
    case.file("section.csv", format!("x,mass,EA,EI-flap,EI-chord,GJ,inertia-flap,inertia-chord\n{table}"));
    let elements = random.count(2..12);
    add!(
        case,
        "initial = {{ kind = 'static' }}\nrun = {{ duration = 0 }}\n[[beam]]\nname = 'b'\nlength = {}\nup = [0, 0, 1]\nroot = 'clamped'",
        beam.length
    );
    add!(case, "elements = {elements}\nsection = {{ kind = 'deck', format = 'csv', file = 'section.csv' }}");
    add!(case, "[[load]]\non = 'b.tip'\nforce = [0, 0, {force}]");
    Posed { case, answer: tip("b.tip.displacement.z", value, within) }
}

/// A table of a section with a notch like a V, or with rows at random, joined by straight lines.
pub(super) fn kinks(random: &mut Random) -> Posed {
    let beam = slender(random);
    let mut rows = vec![(0.0, 1.0)];
    if random.coin() {
        let (a, b, k) = segment(random, &beam);
        rows.extend([(a, 1.0), (0.5 * (a + b), 1.0 / k), (b, 1.0)]);
    } else {
        let mut x = 0.0;
        for _ in 0..random.count(3..30) {
            x += beam.length * random.scale(1e-4..0.1);
            if x < 0.98 * beam.length {
                rows.push((x, random.scale(0.1..2.0)));
            }
        }
    }
    rows.push((beam.length, 1.0));
    let unit: f64 =
        rows.windows(2).map(|pair| flexibility(beam.length, pair[0], pair[1])).sum::<f64>() / beam.bending;
    let (force, value, within) = small(1.0, unit, &beam);
    let mut case = Drawn { length: beam.length, ..Drawn::default() };
    let row = |(x, s): &(f64, f64)| format!("{x},{:e},{:e},{:e}\n", beam.mass, beam.axial, beam.bending * s);
    case.file("section.csv", "x,mass,EA,EI\n".to_owned() + &rows.iter().map(row).collect::<String>());
    add!(
        case,
        "[beam]\nlength = {}\n[section]\nkind = 'table'\nfile = 'section.csv'\ninterpolation = 'linear'",
        beam.length
    );
    add!(case, "[[load]]\non = 'tip'\nforce = [0, {force}]");
    model(random, &mut case);
    Posed { case, answer: tip("tip.deflection", value, within) }
}

/// ∫ (L − x)²/s dx between two rows, s linear: with s as the variable where it changes, an elementary integral of
/// (A + B s)²/s = A²/s + 2AB + B² s.
fn flexibility(length: f64, (x0, s0): (f64, f64), (x1, s1): (f64, f64)) -> f64 {
    let slope = (s1 - s0) / (x1 - x0);
    if (s1 - s0).abs() < 1e-9 {
        return ((length - x0).powi(3) - (length - x1).powi(3)) / (3.0 * s0);
    }
    let (b, a) = (-1.0 / slope, length - x0 + s0 / slope);
    (a * a * (s1 / s0).ln() + 2.0 * a * b * (s1 - s0) + 0.5 * b * b * (s1 * s1 - s0 * s0)) / slope
}
