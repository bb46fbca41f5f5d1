//! The Princeton beam: a flat cantilever under a force at its tip, oblique to its section (Dowell and Traybar 1975).

use super::newton::{cantilever, orders_of};
use flexion::linalg::Vec3;
use flexion::multibody::slender::{Load, Properties};

/// Length, height and thickness \[m\], Young's modulus \[Pa\], force \[N\].
const LENGTH: f64 = 0.508;
const HEIGHT: f64 = 12.3777e-3;
const THICKNESS: f64 = 3.2024e-3;
const MODULUS: f64 = 71.7e9;
const FORCE: f64 = 8.896;

/// Displacement of the tip, the force at `angle` \[°\] to the height; GJ = `factor` G J.
fn tip(elements: usize, angle: f64, factor: f64) -> Vec3 {
    let [high, flat] = [THICKNESS * HEIGHT.powi(3) / 12.0, HEIGHT * THICKNESS.powi(3) / 12.0];
    let torsion = factor * MODULUS / (2.0 * 1.31) * 0.198 * (high + flat);
    let stiffness = [MODULUS * HEIGHT * THICKNESS, torsion, MODULUS * flat, MODULUS * high];
    let mut statics = cantilever(LENGTH, elements, Properties::principal(stiffness, 1.0, [1.0; 3]));
    let (sin, cos) = angle.to_radians().sin_cos();
    statics.loads.push((elements, Load::Force(Vec3([0.0, FORCE * cos, FORCE * sin]))));
    statics.load(4);
    let tip = statics.tip().0;
    Vec3([tip[0] - LENGTH, tip[1], tip[2]])
}

#[test]
fn the_tip_is_that_of_other_codes_at_every_angle() {
    let (edgewise, flatwise) = (tip(16, 0.0, 1.0), tip(16, 90.0, 1.0));
    // A shear-deformable code, whose shear adds F L/GA.
    let shear = FORCE * LENGTH * 2.0 * 1.31 / (MODULUS * HEIGHT * THICKNESS);
    assert!((edgewise[1] + shear - 0.0107128).abs() < 1e-6, "{edgewise:?} and {shear}");
    assert!((flatwise[2] + shear - 0.1462524).abs() < 1e-6, "{flatwise:?} and {shear}");
    // Obrezkov et al. 2022; their torsional stiffness is higher by 1.31/1.198.
    let published = [
        (15.0, 0.010613, 0.042082),
        (30.0, 0.010112, 0.079395),
        (45.0, 0.008837, 0.108988),
        (60.0, 0.006605, 0.129888),
        (75.0, 0.003539, 0.142194),
    ];
    for (angle, y, z) in published {
        let found = tip(16, angle, 1.31 / 1.198);
        assert!(
            (found[1] - y).abs() < 2e-5 && (found[2] - z).abs() < 2e-5,
            "{angle}°: {found:?} for {y}, {z}"
        );
    }
}

#[test]
fn bending_in_two_planes_with_torsion_converges_with_the_fourth_power_of_the_element() {
    let tips = [4, 8, 16, 32].map(|n| tip(n, 45.0, 1.0));
    let order = orders_of(&tips);
    assert!(order.iter().all(|order| (3.6..4.4).contains(order)), "{tips:?} of order {order:?}");
}

#[test]
fn a_ribbon_that_is_stiff_edgewise_does_not_lock() {
    for ratio in [1.0, 16.0, 2500.0] {
        let tip = |n: usize| {
            let section = Properties::principal([1e6, 0.7, 1.0, ratio], 1.0, [1.0; 3]);
            let mut statics = cantilever(1.0, n, section);
            statics.loads.push((n, Load::Force(Vec3([0.0, 1.0, 1.0]))));
            statics.load(8);
            statics.tip().0
        };
        let order = orders_of(&[2, 4, 8, 16].map(tip));
        assert!(order.iter().all(|order| (3.6..4.4).contains(order)), "{ratio}: order {order:?}");
    }
}
