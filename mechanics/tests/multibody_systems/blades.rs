//! Frequencies of rotating blades against published ones, closed forms and collocation.

use flexion::analysis::modes::{Mode, modes};
use flexion::analysis::rotation::rotate_stably;
use flexion::exact::rotating::flapwise_frequency;
use flexion::linalg::{Mat3, Vec3};
use flexion::multibody::slender::{Beam, Properties, Station};
use flexion::multibody::{Axis, Body, Flexible, Kind, Model, Multibody, Part, Rotating, shear};
use flexion::section::{BladeResultants, BladeSection, Matrices};
use flexion::system::{Frame, System};
use std::f64::consts::PI;

const Z: [f64; 3] = [0.0, 0.0, 1.0];

/// Position and orientation of a blade on its hub.
#[derive(Clone, Copy, Debug, Default)]
pub struct Setting {
    pub length: f64,
    /// Distance of the root from the axis of rotation, along the blade.
    pub hub_radius: f64,
    /// Angle of the blade out of the plane of rotation.
    pub precone: f64,
    /// Angle of the root section about the blade.
    pub pitch: f64,
    /// Mass and moment of inertia of a body at the tip.
    pub tip: [f64; 2],
}

/// A blade on the ground, which rotates about z with the frame; a section without torsional stiffness is held in torsion.
pub fn blade(setting: Setting, section: &dyn BladeSection, elements: usize) -> Rotating {
    let (sin, cos) = setting.precone.sin_cos();
    let (axis, out) = ([cos, 0.0, sin], [-sin, 0.0, cos]);
    let curve = |s: f64| {
        let (sine, cosine) = (setting.pitch + section.resultants(s).twist).sin_cos();
        Station {
            position: Vec3(axis.map(|t| (setting.hub_radius + s) * t)),
            tangent: Vec3(axis),
            normal: Vec3([sine * out[0], cosine, sine * out[2]]),
        }
    };
    let mut nodes: Vec<f64> = (0..=elements).map(|i| setting.length * i as f64 / elements as f64).collect();
    nodes.extend(section.breaks());
    nodes.sort_by(f64::total_cmp);
    nodes.dedup_by(|a, b| *a - *b < 1e-9);
    let properties = |s: f64| {
        let of = section.resultants(s);
        let properties = Properties::from(&of);
        if of.torsional_stiffness > 0.0 { properties } else { properties.without_torsion() }
    };
    let beam = Beam::new(&nodes, curve, properties).unwrap();
    let mut model = Model::new();
    let beam = model.beam(Flexible::new("blade", beam));
    let section = |node| Part::Section { beam, node };
    let root = axis.map(|t| setting.hub_radius * t);
    model.join("root", Kind::Fixed, [Part::Ground, section(0)], Vec3(root), (Vec3(Z), None)).unwrap();
    let [mass, inertia] = setting.tip;
    if mass > 0.0 {
        let end = axis.map(|t| (setting.hub_radius + setting.length) * t);
        let tip = model.body(Body::new("tip", mass, [inertia; 3]).at(end));
        let last = section(nodes.len() - 1);
        model.join("hold", Kind::Fixed, [last, tip], Vec3(end), (Vec3(Z), None)).unwrap();
    }
    Rotating::new(Multibody::new(model).unwrap(), Axis::new([0.0; 3], Z).unwrap())
}

/// Modes in steady rotation.
pub fn found(system: &mut dyn System, speed: f64, count: usize, stations: &[f64]) -> Vec<Mode> {
    let mut s = system.initial();
    rotate_stably(system, &mut s, 0.0, speed).unwrap();
    modes(system, &s, count, stations).unwrap().modes
}

/// Frequencies in steady rotation.
pub fn frequencies(system: &mut dyn System, speed: f64, count: usize) -> Vec<f64> {
    found(system, speed, count, &[]).iter().map(Mode::frequency).collect()
}

/// Those of the modes whose share of a direction is the largest.
fn of_direction(system: &mut dyn System, speed: f64, count: usize, direction: &str) -> Vec<f64> {
    let found = found(system, speed, count, &[]);
    found.iter().filter(|mode| mode.shares.dominant() == direction).map(Mode::frequency).collect()
}

/// ρA = EI = L = 1, and hardly any stretch: γ is the speed itself.
fn unit() -> BladeResultants {
    BladeResultants {
        mass: 1.0,
        axial_stiffness: 1e9,
        flap_stiffness: 1.0,
        chord_stiffness: 1.0,
        ..BladeResultants::default()
    }
}

fn setting() -> Setting {
    Setting { length: 1.0, ..Setting::default() }
}

fn compare(found: &[f64], expected: &[f64], tolerance: f64, what: &str) {
    assert!(found.len() >= expected.len(), "{what}: {found:?}");
    for (found, expected) in found.iter().zip(expected) {
        assert!((found / expected - 1.0).abs() < tolerance, "{what}: {found} for {expected}");
    }
}

#[test]
fn chordwise_and_flapwise_frequencies_differ_by_the_square_of_the_speed() {
    for radius in [0.0, 1.0, 5.0] {
        let mut blade = blade(Setting { hub_radius: radius, ..setting() }, &unit(), 32);
        let flap = of_direction(&mut blade, 7.0, 10, "flap");
        let chord = of_direction(&mut blade, 7.0, 10, "chord");
        for (k, (flap, chord)) in flap.iter().zip(&chord).take(4).enumerate() {
            let difference = (flap * flap - chord * chord) / 49.0 - 1.0;
            assert!(difference.abs() < 1e-6 * (flap * flap / 49.0).max(1.0), "{radius}, {k}: {difference:e}");
        }
        assert!(flap.len() >= 4 && chord.len() >= 4, "{flap:?} {chord:?}");
    }
}

#[test]
fn torsional_frequencies_are_those_of_the_closed_form() {
    // GJ φ″ = (i_c + i_f) φ̈ + (i_c − i_f) Ω² φ: ω² = ω₀² + Ω² (i_c − i_f)/(i_c + i_f).
    let section =
        BladeResultants { torsional_stiffness: 3.0, flap_inertia: 0.002, chord_inertia: 0.03, ..unit() };
    // Far stiffer in bending, which rotary inertia slows.
    let section =
        BladeResultants { flap_stiffness: 1e5, chord_stiffness: 1e5, axial_stiffness: 1e11, ..section };
    for speed in [0.0, 9.0] {
        let found = of_direction(&mut blade(setting(), &section, 20), speed, 5, "torsion");
        for (k, found) in found.iter().take(3).enumerate() {
            let rest = (k as f64 + 0.5) * PI * (3.0_f64 / 0.032).sqrt();
            let expected = (rest * rest + speed * speed * 0.028 / 0.032).sqrt();
            assert!((found / expected - 1.0).abs() < 2e-5, "{speed} {k}: {found} for {expected}");
        }
        assert!(found.len() >= 3, "{found:?}");
    }
}

/// Collocation of the equations of motion at 25 and at 31 Chebyshev points, in a program apart from this one; both agree to 2e-6.
#[test]
fn a_hub_stiffens_the_blade_as_collocation_and_series_find() {
    for (radius, gamma, expected) in [
        (1.0, 4.0, [7.4750478, 26.957262, 66.986772]),
        (1.0, 12.0, [19.721542, 51.070134, 98.526797]),
        (5.0, 4.0, [12.381903, 35.608504, 77.702555]),
        (5.0, 12.0, [35.20815, 84.91416, 149.18308]),
    ] {
        let what = format!("a {radius} γ {gamma}");
        let setting = Setting { hub_radius: radius, ..setting() };
        compare(&of_direction(&mut blade(setting, &unit(), 48), gamma, 6, "flap"), &expected, 2e-5, &what);
        let series = [1, 2, 3].map(|k| flapwise_frequency(k, gamma, radius));
        compare(&series, &expected, 2e-6, &what);
    }
}

#[test]
fn a_tip_mass_slows_the_blade_as_closed_form_and_collocation_say() {
    // At rest 1 + cos z cosh z + z (cos z sinh z − sin z cosh z) = 0 for a tip mass equal to the blade's.
    let section = BladeResultants { chord_stiffness: 1e4, ..unit() };
    let mut blade = blade(Setting { tip: [1.0, 1e-12], ..setting() }, &section, 64);
    let found = frequencies(&mut blade, 0.0, 3);
    for frequency in &found {
        let z = frequency.sqrt();
        let equation = |z: f64| 1.0 / z.cosh() + z.cos() + z * (z.cos() * z.tanh() - z.sin());
        assert!(equation(z * (1.0 - 1e-6)) * equation(z * (1.0 + 1e-6)) < 0.0, "{frequency}");
    }
    compare(&found, &[1.5572979, 16.250085, 50.895843], 1e-6, "rest");
    compare(&frequencies(&mut blade, 6.0, 3), &[6.5090559, 29.291671, 68.327869], 1e-6, "γ = 6");
}

/// A million times as heavy as the beam: the tip alone moves at √(3EI/m) and √(EA/m), and stands in the others.
#[test]
fn a_tip_mass_that_is_huge_leaves_the_modes_of_a_beam_clamped_and_pinned() {
    let section = BladeResultants { axial_stiffness: 1e6, ..unit() };
    for elements in [12, 80] {
        let mut blade = blade(Setting { tip: [1e6, 1e-9], ..setting() }, &section, elements);
        let found = frequencies(&mut blade, 0.0, 7);
        let bending = [3.926602312_f64, 7.068582746].map(|z| z * z);
        let (soft, [a, b]) = (3e-6_f64.sqrt(), bending);
        compare(&found, &[soft, soft, 1.0, a, a, b, b], 2e-4, &format!("{elements} elements"));
    }
}

#[test]
fn twist_and_pitch_couple_both_planes_as_collocation_finds() {
    #[derive(Debug)]
    struct Twisted(f64);
    impl BladeSection for Twisted {
        fn resultants(&self, x: f64) -> BladeResultants {
            let twist = self.0.to_radians();
            BladeResultants { chord_stiffness: 16.0, twist: twist * x, twist_rate: twist, ..unit() }
        }
    }
    for (angle, expected) in [
        (30.0, [3.5266058, 13.133182, 23.667757, 58.67932]),
        (60.0, [3.5579637, 11.468551, 27.314224, 52.951471]),
        (90.0, [3.6087719, 9.961236, 31.646239, 47.617798]),
    ] {
        let mut blade = blade(setting(), &Twisted(angle), 32);
        compare(&frequencies(&mut blade, 0.0, 4), &expected, 2e-5, &format!("{angle}°"));
    }
    let setting = Setting { hub_radius: 0.5, pitch: 20.0_f64.to_radians(), ..setting() };
    let mut blade = blade(setting, &Twisted(45.0), 24);
    compare(&frequencies(&mut blade, 5.0, 4), &[7.4264305, 14.014513, 29.822756, 60.82202], 2e-5, "rotating");
}

/// Axial frequencies of a bar whose part at the tip has a quarter of EA and of mass, clamped and free: tan z₁ tan z₂ = 4. The strain jumps,
/// which nodes of beams with shear let it.
#[test]
fn a_jump_of_the_section_keeps_the_order_of_convergence() {
    let section = |s: f64| {
        let size = if s < 0.37 { 1.0 } else { 0.25 };
        Matrices::principal([1e3 * size, 1e5, 1e5, 1e5, 1e5, 1e5], size, [1.0; 3])
    };
    let frame = |s: f64| Frame { position: Vec3([s, 0.0, 0.0]), rotation: Mat3::IDENTITY };
    let mut ends: Vec<f64> = (0..=9).map(|i| f64::from(i) / 9.0).collect();
    ends.insert(4, 0.37);
    let beam = shear::Beam::new(&ends, frame, section).unwrap();
    let mut model = Model::new();
    let beam = model.beam(Flexible::new("bar", beam));
    let root = [Part::Ground, Part::Section { beam, node: 0 }];
    model.join("root", Kind::Fixed, root, [0.0; 3], (Vec3(Z), None)).unwrap();
    let mut system = Rotating::new(Multibody::new(model).unwrap(), Axis::new([0.0; 3], Z).unwrap());
    let found = frequencies(&mut system, 0.0, 1)[0] / 1e3_f64.sqrt();
    let equation = |z: f64| (0.37 * z).tan() * (0.63 * z).tan() - 4.0;
    assert!(equation(found * (1.0 - 1e-6)) * equation(found * (1.0 + 1e-6)) < 0.0, "{found}");
}

#[test]
fn a_torsional_mode_has_the_shape_of_the_torsion() {
    let section = BladeResultants {
        mass: 1.0,
        axial_stiffness: 1e6,
        flap_stiffness: 1.0,
        chord_stiffness: 4.0,
        torsional_stiffness: 0.5,
        flap_inertia: 1e-3,
        chord_inertia: 4e-3,
        ..BladeResultants::default()
    };
    let stations: Vec<f64> = (0..=20).map(|i| 0.1 * f64::from(i)).collect();
    let found = found(&mut blade(Setting { length: 2.0, ..setting() }, &section, 24), 0.0, 10, &stations);
    let torsional: Vec<&Mode> = found.iter().filter(|m| m.shares.torsion > 0.999).collect();
    assert!(torsional.len() > 1);
    for (number, mode) in torsional.iter().enumerate() {
        assert_eq!(mode.nodes, number);
        let expected = (number as f64 + 0.5) * PI / 2.0 * (0.5_f64 / 5e-3).sqrt();
        // Elements of the length h leave (kh)⁴/2880 of a wave number k.
        let missed = ((number as f64 + 0.5) * PI / 2.0 / 12.0).powi(4) / 2880.0;
        let off = (mode.frequency() / expected - 1.0).abs();
        assert!(off < 1.2 * missed + 1e-7, "{} for {expected}: {off:e} of {missed:e}", mode.frequency());
    }
}

/// A round cantilever with a mass at its tip a hundred times its own: soft modes far below the others, each twice. With z⁴ = ω² and
/// μ = 100 they are the roots of 1 + cos z cosh z + μ z (cos z sinh z − sin z cosh z) = 0.
#[test]
fn modes_far_apart_are_all_found_twice() {
    let equation = |z: f64| 1.0 + z.cos() * z.cosh() + 100.0 * z * (z.cos() * z.sinh() - z.sin() * z.cosh());
    // One root below 1, and one in each interval (nπ, nπ + π/2).
    let root = |(mut low, mut high): (f64, f64)| {
        let sign = equation(low) > 0.0;
        while high - low > 1e-14 * high {
            let middle = 0.5 * (low + high);
            if (equation(middle) > 0.0) == sign { low = middle } else { high = middle }
        }
        low * low
    };
    let expected = [(0.1, 1.0), (PI, 1.5 * PI), (2.0 * PI, 2.5 * PI), (3.0 * PI, 3.5 * PI)].map(root);
    let section = BladeResultants { axial_stiffness: 1e8, ..unit() };
    for elements in [20, 32, 36, 40, 44, 48, 64] {
        let mut blade = blade(Setting { tip: [100.0, 1e-9], ..setting() }, &section, elements);
        for count in 1..=8 {
            let found = frequencies(&mut blade, 0.0, count);
            assert_eq!(found.len(), count);
            for (i, found) in found.iter().enumerate() {
                let off = found / expected[i / 2] - 1.0;
                // Cubic elements miss (z/n)⁴/720 of ω², and rounding of K some more.
                let missed = expected[i / 2].powi(2) / (elements as f64).powi(4) / 720.0;
                assert!(off.abs() < missed + 1e-6, "{elements} elements, mode {}: {found}", i + 1);
            }
        }
    }
}

#[test]
fn equal_frequencies_of_a_round_blade_are_both_found() {
    let mut blade = blade(setting(), &unit(), 40);
    let still = frequencies(&mut blade, 0.0, 4);
    let [a, b] = [1, 2].map(|k| flapwise_frequency(k, 0.0, 0.0));
    compare(&still, &[a, a, b, b], 1e-6, "at rest");
    // In rotation, the direction of motion is softer: ω_chord² = ω_flap² − Ω².
    let rotating = found(&mut blade, 2.0, 2, &[]);
    assert_eq!((rotating[0].shares.dominant(), rotating[1].shares.dominant()), ("chord", "flap"));
    let softer = (rotating[1].frequency().powi(2) - 4.0).sqrt();
    assert!((rotating[0].frequency() / softer - 1.0).abs() < 1e-6, "{} {softer}", rotating[0].frequency());
}

/// The discretization of two hundred elements leaves 1e-8, and what rounding leaves of a thousand is said.
#[test]
fn frequencies_are_right_within_their_rounding_up_to_a_thousand_elements() {
    let section = BladeResultants {
        axial_stiffness: 1e4,
        chord_stiffness: 16.0,
        torsional_stiffness: 0.8,
        flap_inertia: 1e-4,
        chord_inertia: 1e-4,
        twist: 0.3,
        ..unit()
    };
    for (precone, speed) in [(0.0, 0.0), (0.0, 3.0), (0.1, 3.0)] {
        let setting = Setting { hub_radius: 0.1, precone, ..setting() };
        let [coarse, fine] = [200, 1000].map(|n| found(&mut blade(setting, &section, n), speed, 3, &[]));
        for (coarse, fine) in coarse.iter().zip(&fine) {
            let off = (fine.frequency() / coarse.frequency() - 1.0).abs();
            let rounding = coarse.rounding + fine.rounding;
            assert!(
                off < 1e-8 + rounding && rounding < 1e-2,
                "precone {precone}, Ω {speed}: {off:e}, {rounding:e}"
            );
        }
    }
}
