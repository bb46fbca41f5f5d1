//! Sections whose stiffnesses are coupled, and beams with a pretwist.

use super::newton::{Statics, cantilever, distance, equal, orders};
use flexion::linalg::Vec3;
use flexion::multibody::slender::{Beam, Load, Properties, Station};

#[test]
fn a_tension_centre_off_the_axis_stretches_a_beam_that_a_couple_bends() {
    // (ε, κ₃) = C⁻¹ (0, M): an arc of curvature κ₃ per length without stress, stretched by ε.
    let (axial, coupling, bending) = (4000.0, 25.0, 1.0);
    let mut section = Properties::principal([axial, 1.0, 1.0, bending], 1.0, [1.0; 3]);
    (section.stiffness[0][3], section.stiffness[3][0]) = (coupling, coupling);
    let moment = 2.0;
    let determinant = axial * bending - coupling * coupling;
    let (strain, curvature) = (-coupling * moment / determinant, axial * moment / determinant);
    let mut statics = cantilever(1.0, 16, section);
    statics.loads.push((16, Load::Couple(Vec3([0.0, 0.0, moment]))));
    let radius = (1.0 + strain) / curvature;
    let expected = [radius * curvature.sin(), radius * (1.0 - curvature.cos()), 0.0];
    statics.load(4);
    let tip = statics.tip().0;
    assert!(distance(tip, Vec3(expected)) < 1e-5, "{tip:?} for {expected:?}");
    for sample in statics.beam.elements()[7].samples(statics.q[84..105].try_into().unwrap()) {
        let [axial, .., third] = sample.strain;
        assert!((axial - strain).abs() < 1e-5 && (third - curvature).abs() < 1e-4, "{sample:?}");
    }
}

/// A pretwisted bar under a tension F and a torque T: T = GJ (k − k₀) + F K² k, and F = EA (ε + ½K² (k² − k₀²)).
#[test]
fn tension_stiffens_torsion_and_untwists_and_twist_shortens() {
    let (stiffness, tension, torque, pretwist) = ([400.0, 0.7, 1.0, 9.0], 6.0, 0.5, 0.8);
    let curve = |s: f64| {
        let (sin, cos) = (pretwist * s).sin_cos();
        Station { position: s * Vec3::AXES[0], tangent: Vec3::AXES[0], normal: Vec3([0.0, cos, sin]) }
    };
    let section = Properties::principal(stiffness, 1.0, [1.0; 3]);
    let mut statics = Statics::clamped(Beam::new(&equal(1.0, 2), curve, |_| section).unwrap());
    let loads = [Load::Force(tension * Vec3::AXES[0]), Load::Couple(torque * Vec3::AXES[0])];
    statics.loads.extend(loads.map(|load| (2, load)));
    statics.load(4);
    let polar = (stiffness[2] + stiffness[3]) / stiffness[0];
    let twist = (torque + stiffness[1] * pretwist) / (stiffness[1] + tension * polar);
    let strain = tension / stiffness[0] - 0.5 * polar * (twist * twist - pretwist * pretwist);
    let (position, triad) = statics.tip();
    assert!((position[0] - 1.0 - strain).abs() < 1e-12, "{} for {strain}", position[0] - 1.0);
    let angle = triad.normal[2].atan2(triad.normal[1]);
    assert!((angle - twist).abs() < 1e-12, "{angle} for {twist}");
    for sample in statics.beam.elements()[1].samples(statics.q[12..33].try_into().unwrap()) {
        let off = [
            sample.strain[0] - strain,
            sample.strain[1] - (twist - pretwist),
            sample.winding - 0.5 * (twist * twist - pretwist * pretwist),
            sample.stress[0] - tension,
            sample.stress[1] - torque,
        ];
        assert!(off.iter().all(|off| off.abs() < 1e-11), "{off:?}");
    }
}

/// A flat beam along x with a pretwist of one radian under an oblique force: with axes that twist with the section, or with
/// straight axes against which the section is rolled. A thin section: K² is that of twisted fibres in the first alone.
fn pretwisted(elements: usize, axes_twist: bool) -> Statics {
    let section = Properties::principal([1e8, 0.5, 0.2, 4.0], 1.0, [1.0; 3]);
    let curve = |s: f64| {
        let (sin, cos) = if axes_twist { s.sin_cos() } else { (0.0, 1.0) };
        Station {
            position: Vec3([s, 0.0, 0.0]),
            tangent: Vec3([1.0, 0.0, 0.0]),
            normal: Vec3([0.0, cos, sin]),
        }
    };
    let section = |s: f64| if axes_twist { section } else { section.rolled(s) };
    let mut statics = Statics::clamped(Beam::new(&equal(1.0, elements), curve, section).unwrap());
    statics.loads.push((elements, Load::Force(Vec3([0.0, 0.5, 0.7]))));
    statics.load(4);
    statics
}

#[test]
fn a_pretwist_is_the_same_by_axes_that_twist_and_by_sections_that_are_rolled() {
    let fine = pretwisted(128, false).tip().0;
    for axes_twist in [false, true] {
        let errors = [8, 16, 32].map(|n| distance(pretwisted(n, axes_twist).tip().0, fine));
        let order = orders(&errors);
        assert!(errors[2] < 1e-6 && order.iter().all(|order| *order > 3.5), "{errors:?} of order {order:?}");
    }
}
