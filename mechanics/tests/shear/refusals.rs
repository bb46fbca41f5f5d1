//! Beams that cannot be made.

use flexion::linalg::{Mat3, Vec3};
use flexion::multibody::BeamError;
use flexion::multibody::rotation::about;
use flexion::multibody::shear::Beam;
use flexion::section::Matrices;
use flexion::system::Frame;

fn section(_: f64) -> Matrices {
    Matrices::principal([1.0; 6], 1.0, [1.0; 3])
}

fn straight(s: f64) -> Frame {
    Frame { position: Vec3([s, 0.0, 0.0]), rotation: Mat3::IDENTITY }
}

#[test]
fn meshes_axes_and_sections_that_make_no_beam_are_refused() {
    assert!(Beam::new(&[0.0, 1.0, 2.0], straight, section).is_ok());
    for ends in [&[0.0][..], &[0.0, 1.0, 1.0], &[0.0, f64::NAN]] {
        assert!(matches!(Beam::new(ends, straight, section), Err(BeamError::Ends { .. })), "{ends:?}");
    }
    let skewed = |s: f64| Frame { rotation: 1.1 * Mat3::IDENTITY, ..straight(s) };
    assert!(matches!(Beam::new(&[0.0, 1.0], skewed, section), Err(BeamError::Axes { .. })));
    let left = |s: f64| Frame { rotation: -1.0 * Mat3::IDENTITY, ..straight(s) };
    assert!(matches!(Beam::new(&[0.0, 1.0], left, section), Err(BeamError::Axes { .. })));
    let twisted = |s: f64| Frame { rotation: about([4.0 * s, 0.0, 0.0]), ..straight(s) };
    assert!(matches!(Beam::new(&[0.0, 1.0], twisted, section), Err(BeamError::Turned { .. })));
    assert!(Beam::new(&[0.0, 0.5, 1.0], twisted, section).is_ok());
    let weak = |s: f64| {
        let mut of = section(s);
        of.stiffness[1][1] = if s > 1.2 { 0.0 } else { 1.0 };
        of
    };
    let fault = Beam::new(&[0.0, 1.0, 2.0], straight, weak).unwrap_err();
    assert!(matches!(fault, BeamError::Section { at, .. } if at == 1.25), "{fault}");
}

/// Where sections jump at the end of an element, each side has its own.
#[test]
fn sections_may_jump_between_elements() {
    let jump = |s: f64| Matrices::principal([1.0; 6], if s < 1.0 { 1.0 } else { 3.0 }, [1.0; 3]);
    let beam = Beam::new(&[0.0, 1.0, 2.0], straight, jump).unwrap();
    assert!((beam.mass() - 4.0).abs() < 1e-14);
    assert!((beam.first_moment(beam.initial())[0] - 5.0).abs() < 1e-14);
}
