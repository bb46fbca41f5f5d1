//! Frequencies against published ones, closed forms and collocation.

use super::*;
use crate::section::BladeSection;

/// Flapwise frequencies of a uniform beam, hub radius 0, γ = Ω√(ρAL⁴/EI): A. D. Wright, C. E. Smith, R. W. Thresher &
/// J. L. C. Wang, *J. Appl. Mech.* 49 (1982) 197–202, doi:10.1115/1.3161966.
const WRIGHT: [(f64, [f64; 3]); 10] = [
    (0.0, [3.516, 22.035, 61.697]),
    (1.0, [3.682, 22.181, 61.842]),
    (2.0, [4.137, 22.615, 62.273]),
    (3.0, [4.797, 23.320, 62.985]),
    (4.0, [5.585, 24.273, 63.967]),
    (5.0, [6.450, 25.446, 65.205]),
    (6.0, [7.360, 26.809, 66.684]),
    (8.0, [9.257, 29.995, 70.293]),
    (10.0, [11.202, 33.640, 74.649]),
    (12.0, [13.170, 37.603, 79.615]),
];

#[test]
fn flapwise_frequencies_are_those_of_wright_to_the_last_digit() {
    let mut blade = Blade::new(setting(), &unit(), linear(), 48).unwrap();
    for (gamma, published) in WRIGHT {
        blade.set_speed(gamma).unwrap();
        let found = frequencies(&mut blade, flapwise);
        for (found, published) in found.into_iter().zip(published) {
            assert!((found - published).abs() < 6e-4, "γ = {gamma}: {found:.5} for {published}");
        }
    }
}

#[test]
fn chordwise_and_flapwise_frequencies_differ_by_the_square_of_the_speed() {
    for radius in [0.0, 1.0, 5.0] {
        let setting = Setting { hub_radius: radius, ..setting() };
        let mut blade = Blade::new(setting, &unit(), linear(), 8).unwrap();
        blade.set_speed(7.0).unwrap();
        let flap = frequencies(&mut blade, flapwise);
        let chord = frequencies(&mut blade, chordwise);
        for (flap, chord) in flap.into_iter().zip(chord).take(5) {
            let difference = (flap * flap - chord * chord) / 49.0 - 1.0;
            assert!(difference.abs() < 1e-10 * (flap * flap / 49.0).max(1.0), "{radius}: {difference:e}");
        }
    }
}

#[test]
fn chordwise_frequencies_with_gyroscopic_coupling_are_the_published_ones() {
    // S. Hamza-cherif & A. Houmat 2004: slenderness √(AL²/I) = 70, hub radius 0, first chordwise frequency; and the
    // same by collocation of the two equations of motion. The published digits are cut, not rounded, and their
    // last one is not converged.
    let section = BladeResultants { axial_stiffness: 4900.0, ..unit() };
    let model = Model { gyroscopic: true, ..linear() };
    for (gamma, published, collocation) in [
        (2.0, 3.6195, 3.619566),
        (4.0, 3.888, 3.888068),
        (6.0, 4.2393, 4.239333),
        (8.0, 4.6105, 4.610583),
        (10.0, 4.97, 4.970022),
        (50.0, 7.3362, 7.333589),
    ] {
        // The layer at the root in which a fast blade bends is 1/γ long.
        let elements = if gamma > 10.0 { 48 } else { 20 };
        let mut blade = Blade::new(setting(), &section, model, elements).unwrap();
        blade.set_speed(gamma).unwrap();
        let in_plane = |c| matches!(c, Component::Axial | Component::Chordwise);
        let found = gyroscopic_frequencies(&mut blade, in_plane)[0];
        assert!((found / published - 1.0).abs() < 5e-4, "γ = {gamma}: {found:.5} for {published}");
        let tolerance = if gamma > 10.0 { 2e-4 } else { 1e-5 };
        assert!((found / collocation - 1.0).abs() < tolerance, "γ = {gamma}: {found:.6} for {collocation}");
    }
}

#[test]
fn torsional_frequencies_are_those_of_the_closed_form() {
    // GJ φ″ = (i_c + i_f) φ̈ + (i_c − i_f) Ω² φ: ω² = ω₀² + Ω² (i_c − i_f)/(i_c + i_f).
    let section =
        BladeResultants { torsional_stiffness: 3.0, flap_inertia: 0.002, chord_inertia: 0.03, ..unit() };
    for energy in [StrainEnergy::Linear, StrainEnergy::Exact] {
        let model = Model { torsion: true, rotary_inertia: true, strain_energy: energy, ..linear() };
        let mut blade = Blade::new(setting(), &section, model, 20).unwrap();
        for speed in [0.0, 9.0] {
            blade.set_speed(speed).unwrap();
            let found = frequencies(&mut blade, |c| c == Component::Torsion);
            for (k, found) in found.into_iter().take(3).enumerate() {
                let rest = (k as f64 + 0.5) * std::f64::consts::PI * (3.0_f64 / 0.032).sqrt();
                let expected = (rest * rest + speed * speed * 0.028 / 0.032).sqrt();
                assert!((found / expected - 1.0).abs() < 2e-5, "{speed} {k}: {found} for {expected}");
            }
        }
    }
}

/// Frequencies of the tests below were found by collocation of the equations of motion at 25 and at 31 Chebyshev
/// points, in a program apart from this one: the difference of the two is below the tolerance.
fn compare(found: &[f64], expected: &[f64], tolerance: f64, what: &str) {
    for (found, expected) in found.iter().zip(expected) {
        assert!((found / expected - 1.0).abs() < tolerance, "{what}: {found} for {expected}");
    }
}

#[test]
fn a_hub_stiffens_the_blade_as_collocation_finds() {
    for (radius, gamma, expected) in [
        (1.0, 4.0, [7.4750478, 26.957262, 66.986772]),
        (1.0, 12.0, [19.721542, 51.070134, 98.526797]),
        (5.0, 4.0, [12.381903, 35.608504, 77.702555]),
        (5.0, 12.0, [35.20815, 84.91416, 149.18308]),
    ] {
        let mut blade =
            Blade::new(Setting { hub_radius: radius, ..setting() }, &unit(), linear(), 48).unwrap();
        blade.set_speed(gamma).unwrap();
        compare(&frequencies(&mut blade, flapwise), &expected, 2e-5, &format!("a {radius} γ {gamma}"));
    }
}

#[test]
fn a_tip_mass_slows_the_blade_as_closed_form_and_collocation_say() {
    // At rest 1 + cos z cosh z + z (cos z sinh z − sin z cosh z) = 0 for a tip mass equal to the blade's.
    let tip = Tip { mass: 1.0, inertia: 0.0 };
    let mut blade = Blade::new(Setting { tip, ..setting() }, &unit(), linear(), 32).unwrap();
    let found = frequencies(&mut blade, flapwise);
    for frequency in &found[..3] {
        let z = frequency.sqrt();
        let equation = |z: f64| 1.0 / z.cosh() + z.cos() + z * (z.cos() * z.tanh() - z.sin());
        assert!(equation(z * (1.0 - 1e-5)) * equation(z * (1.0 + 1e-5)) < 0.0, "{frequency}");
    }
    compare(&found, &[1.5572979, 16.250085, 50.895843], 1e-5, "rest");
    blade.set_speed(6.0).unwrap();
    compare(&frequencies(&mut blade, flapwise), &[6.5090559, 29.291671, 68.327869], 1e-5, "γ = 6");
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
    let bending = |c| flapwise(c) || chordwise(c);
    for (angle, expected) in [
        (30.0, [3.5266058, 13.133182, 23.667757, 58.67932]),
        (60.0, [3.5579637, 11.468551, 27.314224, 52.951471]),
        (90.0, [3.6087719, 9.961236, 31.646239, 47.617798]),
    ] {
        let mut blade = Blade::new(setting(), &Twisted(angle), linear(), 32).unwrap();
        compare(&frequencies(&mut blade, bending), &expected, 2e-5, &format!("{angle}°"));
    }
    let setting = Setting { hub_radius: 0.5, pitch: 20.0_f64.to_radians(), ..setting() };
    let mut blade = Blade::new(setting, &Twisted(45.0), linear(), 24).unwrap();
    blade.set_speed(5.0).unwrap();
    compare(&frequencies(&mut blade, bending), &[7.4264305, 14.014513, 29.822756, 60.82202], 2e-5, "turning");
}

#[test]
fn the_exact_blade_becomes_the_linear_one_as_its_strain_vanishes() {
    // Slenderness 1000: the strain of the rotation at γ = 5 is 1.25e-5, and so is the share it has in ω².
    let section = BladeResultants { axial_stiffness: 1e6, ..unit() };
    let setting = Setting { hub_radius: 0.2, pitch: 0.3, tip: Tip { mass: 0.1, inertia: 0.01 }, ..setting() };
    let exact = Model { strain_energy: StrainEnergy::Exact, rotary_inertia: true, ..linear() };
    let linear = Model { rotary_inertia: true, ..linear() };
    let found = [exact, linear].map(|model| {
        let mut blade = Blade::new(setting, &section, model, 24).unwrap();
        blade.set_speed(5.0).unwrap();
        frequencies(&mut blade, |c| flapwise(c) || chordwise(c))
    });
    compare(&found[0][..6], &found[1][..6], 3e-5, "exact");
}

#[test]
fn a_jump_of_the_section_keeps_the_order_of_convergence() {
    // Axial frequencies of a bar whose half at the tip has a quarter of EA and of mass, clamped and free:
    // tan(z/2)² = EA₁k₁/(EA₂k₂) = 4, z = ωL√(ρA/EA).
    let rows = |x: f64, size: f64| {
        let r = BladeResultants { mass: size, axial_stiffness: 1e3 * size, ..unit() };
        (x, r)
    };
    let table = crate::section::BladeTable::new(
        1.0,
        &[rows(0.0, 1.0), rows(0.37, 1.0), rows(0.37, 0.25), rows(1.0, 0.25)],
    )
    .unwrap();
    let mut blade = Blade::new(setting(), &table, linear(), 9).unwrap();
    let found = frequencies(&mut blade, |c| c == Component::Axial)[0] / 1e3_f64.sqrt();
    let equation = |z: f64| (0.37 * z).tan() * (0.63 * z).tan() - 4.0;
    assert!(equation(found * (1.0 - 1e-6)) * equation(found * (1.0 + 1e-6)) < 0.0, "{found}");
}
