//! Static starts of what contacts alone hold: without them it is a mechanism.

#![allow(clippy::unwrap_used)] // in helpers of tests

use super::verification::run::integrate;
use flexion_case::{Reading, parse};
use std::path::Path;

const WEIGHT: f64 = 9.81 * 0.4;

/// A beam of 1 kg/m and 0.4 m along x, `height` above a floor.
fn beam(height: f64, stiffness: f64, contact: &str) -> String {
    format!(
        "gravity = [0, 0, -9.81]\nrun = {{ duration = 0 }}\ninitial.kind = 'static'\n\
         [[beam]]\nname = 'rod'\nstart = [0, 0, {height}]\nlength = 0.4\nup = [0, 0, 1]\nelements = 10\npolar-inertia = 1e-4\n\
         section = {{ kind = 'general', mass-per-length = 1, axial-stiffness = 1e8, torsional-stiffness = {stiffness}, bending-stiffness = \
         {stiffness}, bending-stiffness-across = {stiffness} }}\n\
         [[contact]]\nname = 'floor'\n{contact}\n"
    )
}

fn hinge(height: f64) -> String {
    format!(
        "[[joint]]\nname = 'hinge'\nkind = 'revolute'\nbetween = ['ground', 'rod.root']\nat = [0, 0, {height}]\naxis = [0, -1, 0]\n"
    )
}

const FLOOR: &str = "obstacle = { kind = 'plane', normal = [0, 0, 1] }";
const RIGID: &str = "law = { kind = 'constraint', restitution = 0 }";

fn read(text: &str) -> Reading {
    parse(text.to_owned(), Path::new("case.toml"), &[]).unwrap()
}

fn found<const N: usize>(text: &str, columns: [&str; N]) -> [f64; N] {
    let run = integrate(&read(text)).unwrap();
    assert!(!run.warnings.iter().any(|warning| warning.contains("unstable")), "{:?}", run.warnings);
    columns.map(|name| run.column(name)[0])
}

/// It lies with its end on the floor: its chord is inclined by asin(h/L), its root by qL³/(24EI) more, and hinge and floor bear half of the weight each.
#[test]
fn a_beam_on_a_hinge_lies_with_its_end_on_the_floor() {
    for stiffness in [1e2, 1e4] {
        for height in [0.0, 1e-6, 1e-4, 0.01, 0.05, 0.2, 0.39, -0.001] {
            let text = beam(height, stiffness, &format!("on = 'rod.tip'\n{FLOOR}\n{RIGID}")) + &hinge(height);
            let columns = ["hinge.angle", "hinge.force.z", "floor.force", "floor.gap"];
            let [angle, hinge, floor, gap] = found(&text, columns);
            let chord = (height / 0.4).asin();
            let slope = 9.81 * chord.cos() * 0.4_f64.powi(3) / (24.0 * stiffness);
            assert!((angle + chord + slope).abs() < 0.01 * slope, "{height} {stiffness}: {angle}");
            // But for rounding of EA.
            assert!(
                (hinge + floor - WEIGHT).abs() < 1e8 * f64::EPSILON,
                "{height} {stiffness}: {hinge} {floor}"
            );
            // Its centre is off the chord by less than L times the slope.
            assert!(
                (floor / WEIGHT - 0.5).abs() < slope * (chord.tan().abs() + slope) + 1e-9,
                "{height} {stiffness}: {floor}"
            );
            assert!(gap.abs() < 1e-12, "{gap}");
        }
    }
}

/// The same on a floor that gives way, N = k δ^{3/2}.
#[test]
fn a_beam_on_a_hinge_sinks_into_a_soft_floor() {
    for (stiffness, height) in [(1e3, 0.0), (1e3, 0.1), (1e8, 0.0), (1e8, 0.1)] {
        let law = format!("law = {{ kind = 'hertz', stiffness = {stiffness}, exponent = 1.5 }}");
        let text = beam(height, 1e4, &format!("on = 'rod.tip'\n{FLOOR}\n{law}")) + &hinge(height);
        let [angle, floor, gap] = found(&text, ["hinge.angle", "floor.force", "floor.gap"]);
        let depth = (0.5 * WEIGHT / stiffness).powf(2.0 / 3.0);
        assert!((floor / WEIGHT - 0.5).abs() < 1e-6, "{stiffness} {height}: {floor}");
        assert!((gap / depth + 1.0).abs() < 1e-6, "{stiffness} {height}: {gap} {depth}");
        assert!((angle + ((height + depth) / 0.4).asin()).abs() < 5e-6, "{stiffness} {height}: {angle}");
    }
}

/// Its centre is 6 cm from one support and 10 cm from the other.
#[test]
fn a_beam_that_lies_on_two_supports_gives_each_its_part_of_the_weight() {
    for height in [0.0, 0.001, 0.3] {
        let text = beam(height, 100.0, &format!("on = ['rod@0.1 m', 'rod@0.26 m']\n{FLOOR}\n{RIGID}"));
        let [first, second] = found(&text, ["floor.1.force", "floor.2.force"]);
        assert!((first - 0.375 * WEIGHT).abs() < 1e-6 * WEIGHT, "{first}");
        assert!((second - 0.625 * WEIGHT).abs() < 1e-6 * WEIGHT, "{second}");
    }
}

#[test]
fn what_falls_past_its_contacts_is_refused() {
    let past = "obstacle = { kind = 'cylinder', axis = [0, 1, 0], centre = [0.1, 0, -0.5], radius = 0.05 }";
    let text = beam(0.0, 100.0, &format!("on = 'rod'\n{past}\n{RIGID}"));
    let refused = integrate(&read(&text)).err().unwrap();
    assert!(format!("{refused:?}").contains("comes to no rest"), "{refused:?}");
    // Deep inside an obstacle.
    let text = beam(-0.05, 100.0, &format!("on = 'rod.tip'\n{FLOOR}\n{RIGID}")) + &hinge(-0.05);
    let refused = integrate(&read(&text)).err().unwrap();
    assert!(format!("{refused:?}").contains("inside an obstacle"), "{refused:?}");
}
