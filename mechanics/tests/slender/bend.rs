//! The bend of 45° out of its plane (Bathe and Bolourchi 1979, doi 10.1002/nme.1620140703).

use super::newton::{Statics, distance, equal, orders_of};
use flexion::linalg::Vec3;
use flexion::multibody::slender::{Beam, Load, Properties, Station};

/// Radius 100, section 1 × 1, E 10⁷, ν 0, GJ of the polar moment of area; n at `angle` to the normal of its plane.
fn bend(elements: usize, angle: f64, stiffness: [f64; 4]) -> Statics {
    let curve = |s: f64| {
        let ((sin, cos), (across, out)) = ((s / 100.0).sin_cos(), angle.sin_cos());
        Station {
            position: Vec3([100.0 * sin, -100.0 * (1.0 - cos), 0.0]),
            tangent: Vec3([cos, -sin, 0.0]),
            normal: Vec3([across * sin, across * cos, out]),
        }
    };
    let section = Properties::principal(stiffness, 1.0, [1.0; 3]);
    let nodes = equal(25.0 * std::f64::consts::PI, elements);
    let mut statics = Statics::clamped(Beam::new(&nodes, curve, |_| section).unwrap());
    statics.loads.push((elements, Load::Force(Vec3([0.0, 0.0, 600.0]))));
    statics
}

const SQUARE: [f64; 4] = [1e7, 1e7 / 12.0, 1e7 / 12.0, 1e7 / 12.0];

#[test]
fn the_tip_is_that_of_the_literature() {
    let mut statics = bend(32, 0.0, SQUARE);
    statics.load(6);
    let tip = statics.tip().0;
    // Displacements: of 1979, and of a shear-deformable code.
    let undeformed = 100.0 * 0.5_f64.sqrt();
    let moved = Vec3([tip[0] - undeformed, tip[1] + 100.0 - undeformed, tip[2]]);
    assert!(distance(moved, Vec3([-23.5, 13.4, 53.4])) < 0.25, "{moved:?}");
    assert!(distance(moved, Vec3([-23.545, 13.577, 53.458])) < 0.03, "{moved:?}");
}

#[test]
fn the_tip_converges_with_the_fourth_power_of_the_element() {
    // Isotropic; a flat section, edgewise, flat, and oblique.
    let flat = [1e7, 2e5, 1e7 / 12.0, 2e5];
    for (stiffness, angle) in [(SQUARE, 0.0), (flat, 0.0), (flat, 1.57), (flat, 0.6)] {
        let tip = |n| {
            let mut statics = bend(n, angle, stiffness);
            statics.load(8);
            statics.tip().0
        };
        let tips = [16, 32, 64, 128].map(tip);
        let order = orders_of(&tips);
        assert!(order.iter().all(|order| (3.7..4.3).contains(order)), "{tips:?} of order {order:?}");
    }
}
