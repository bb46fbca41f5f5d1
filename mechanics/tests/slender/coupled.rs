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
    // r′ along the root's tangent is let go: the strain there is not zero.
    statics.fixed[3] = false;
    statics.load(4);
    let tip = statics.tip().0;
    assert!(distance(tip, Vec3(expected)) < 1e-5, "{tip:?} for {expected:?}");
    let (.., strains) = statics.beam.elements()[7].section(statics.q[84..105].try_into().unwrap(), 0.3);
    assert!((strains[0] - strain).abs() < 1e-5 && (strains[3] - curvature).abs() < 1e-4, "{strains:?}");
}

/// A flat beam along x with a pretwist of one radian under an oblique force: with axes that twist with the section, or with
/// straight axes against which the section is rolled.
fn pretwisted(elements: usize, axes_twist: bool) -> Statics {
    let section = Properties::principal([1e4, 0.5, 0.2, 4.0], 1.0, [1.0; 3]);
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
