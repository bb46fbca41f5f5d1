//! Beams that cannot be made.

use super::newton::equal;
use flexion::linalg::Vec3;
use flexion::multibody::BeamError;
use flexion::multibody::slender::{Beam, Properties, Station};

fn section() -> Properties {
    Properties::principal([1e4, 1.0, 1.0, 2.0], 1.0, [0.1, 0.0, 0.0])
}

fn straight(s: f64) -> Station {
    Station { position: Vec3([s, 0.0, 0.0]), tangent: Vec3([1.0, 0.0, 0.0]), normal: Vec3([0.0, 1.0, 0.0]) }
}

#[test]
fn nodes_must_ascend() {
    for (nodes, number) in [(vec![], 0), (vec![0.0], 1), (vec![0.0, 1.0, 1.0], 2), (vec![0.0, f64::NAN], 1)] {
        let error = Beam::new(&nodes, straight, |_| section()).unwrap_err();
        assert!(matches!(error, BeamError::Ends { number: n, .. } if n == number), "{error}");
    }
}

#[test]
fn axes_must_be_axes() {
    let skew = |s: f64| Station { normal: Vec3([0.1, 1.0, 0.0]), ..straight(s) };
    let error = Beam::new(&equal(1.0, 2), skew, |_| section()).unwrap_err();
    assert!(matches!(error, BeamError::Axes { at: 0.0 }), "{error}");
}

#[test]
fn an_element_must_not_turn_by_a_right_angle() {
    let circle = |s: f64| Station {
        position: Vec3([s.sin(), 1.0 - s.cos(), 0.0]),
        tangent: Vec3([s.cos(), s.sin(), 0.0]),
        normal: Vec3([0.0, 0.0, 1.0]),
    };
    assert!(Beam::new(&equal(3.0, 2), circle, |_| section()).is_ok());
    let error = Beam::new(&equal(3.3, 2), circle, |_| section()).unwrap_err();
    assert!(error.to_string().contains("95°") && error.to_string().contains("more elements"), "{error}");
    // Axes that twist by as much.
    let screw = |s: f64| Station { normal: Vec3([0.0, s.cos(), s.sin()]), ..straight(s) };
    let error = Beam::new(&equal(4.0, 2), screw, |_| section()).unwrap_err();
    assert!(matches!(error, BeamError::Turned { .. }), "{error}");
}

#[test]
fn energies_must_be_positive() {
    let refused = |change: &dyn Fn(&mut Properties)| {
        let mut section = section();
        change(&mut section);
        let error = Beam::new(&equal(1.0, 2), straight, |_| section).unwrap_err();
        assert!(matches!(error, BeamError::Section { at: 0.0, .. }), "{error}");
    };
    refused(&|s| s.stiffness[1][1] = 0.0);
    refused(&|s| s.stiffness[0][3] = 1.0);
    refused(&|s| (s.stiffness[2][3], s.stiffness[3][2]) = (1.5, 1.5));
    refused(&|s| s.mass = f64::NAN);
    refused(&|s| s.inertia[0] = 0.0);
    refused(&|s| s.inertia[2] = -0.1);
}
