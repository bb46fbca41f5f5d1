//! Large displacements: a cantilever rolled up, the bend of 45°, and no locking.

use super::chain::{Chain, cantilever, equal, orders};
use flexion::linalg::{Mat3, Vec3};
use flexion::multibody::rotation::about;
use flexion::multibody::shear::Beam;
use flexion::section::Matrices;
use flexion::system::Frame;
use std::f64::consts::PI;

/// A square section of the side `depth` with E = 12/depth⁴, that is EI = 1, and ν = 0, shear factor 5/6.
fn square(depth: f64) -> Matrices {
    let axial = 12.0 / (depth * depth);
    let shear = 5.0 / 6.0 * 0.5 * axial;
    Matrices::principal([axial, shear, shear, 0.846, 1.0, 1.0], 1.0, [2e-3, 1e-3, 1e-3])
}

/// A name, and the loaded beam of so many elements and a slenderness.
type Case<'a> = (&'a str, &'a dyn Fn(usize, f64) -> Chain);

const SLENDERNESS: [f64; 4] = [10.0, 1e2, 1e3, 1e4];

/// A couple of 2π EI/L makes a circle of the cantilever, and half of it half a circle, whatever its slenderness.
#[test]
fn a_couple_rolls_the_cantilever_up_to_a_circle() {
    for slenderness in SLENDERNESS {
        let tip = |n: usize, couple: f64| {
            let mut chain = cantilever(1.0, n, square(1.0 / slenderness));
            chain.load_tip(Vec3::ZERO, Vec3([0.0, 0.0, couple]));
            chain.load(8);
            chain.tip()
        };
        // A constant bending is exact, and with it the rotation: to the rounding of angles and of strains that are small
        // against the axial stiffness, a part 10⁻¹⁶ of which is slenderness² of the bending stiffness.
        let rounding = 1e-14 * (10.0 + slenderness);
        for n in [2, 4, 8] {
            let Frame { position, rotation } = tip(n, 2.0 * PI);
            assert!((rotation.column(0) - Vec3::AXES[0]).norm() < rounding, "{slenderness} {n}");
            // All chords of the elements of a whole circle add up to nothing.
            assert!(position.norm() < rounding, "{slenderness} {n}: {position:?}");
        }
        let errors = [2, 4, 8].map(|n| (tip(n, PI).position - Vec3([0.0, 2.0 / PI, 0.0])).norm());
        println!("half a circle, slenderness {slenderness:e}: {errors:?} {:?}", orders(&errors));
        assert!(orders(&errors).iter().all(|order| (5.9..6.1).contains(order)), "{errors:?}");
    }
}

/// The error of a mesh does not grow with the slenderness: the plane cantilever under a transverse force of 8 EI/L², and a
/// quarter of a circle, whose sections are twisted by 60° beside, under a force oblique to its plane.
#[test]
fn elements_do_not_lock_however_slender_the_beam() {
    let straight = |n: usize, slenderness: f64| {
        let mut chain = cantilever(1.0, n, square(1.0 / slenderness));
        chain.load_tip(Vec3([0.0, 8.0, 0.0]), Vec3::ZERO);
        chain
    };
    let curved = |n: usize, slenderness: f64| {
        let radius = 2.0 / PI;
        let curve = |s: f64| {
            let (sin, cos) = (s / radius).sin_cos();
            let axes = Mat3::columns([Vec3([cos, sin, 0.0]), Vec3([-sin, cos, 0.0]), Vec3::AXES[2]]);
            Frame {
                position: Vec3([radius * sin, radius * (1.0 - cos), 0.0]),
                rotation: axes * about([s * PI / 3.0, 0.0, 0.0]),
            }
        };
        // A section three times as stiff in one bending as in the other.
        let mut section = square(1.0 / slenderness);
        section.stiffness[4][4] = 3.0;
        let mut chain = Chain::clamped(Beam::new(&equal(1.0, n), curve, |_| section).unwrap());
        chain.load_tip(Vec3([1.0, -2.0, 3.0]), Vec3::ZERO);
        chain
    };
    let cases: [Case<'_>; 2] = [("straight", &straight), ("curved", &curved)];
    for (name, of) in cases {
        let mut coarse = Vec::new();
        for slenderness in SLENDERNESS {
            let tip = |n: usize| {
                let mut chain = of(n, slenderness);
                chain.load(10);
                chain.tip().position
            };
            let exact = tip(32);
            let errors = [3, 6, 12].map(|n| (tip(n) - exact).norm());
            println!("{name}, slenderness {slenderness:e}: {errors:?} {:?}", orders(&errors));
            assert!(orders(&errors).iter().all(|order| *order > 5.7), "{name} {slenderness}: {errors:?}");
            coarse.push(errors[1]);
        }
        // From 100 on slenderness has no influence.
        assert!(coarse[1..].iter().all(|error| (error / coarse[1] - 1.0).abs() < 0.05), "{name}: {coarse:?}");
        assert!(coarse[1] < 1.5 * coarse[0] && coarse[1] < 1e-6, "{name}: {coarse:?}");
    }
}

/// Radius 100, section 1 × 1, E 10⁷, ν 0; the force 600 out of the plane.
fn bend(elements: usize, shear: f64) -> Chain {
    let curve = |s: f64| {
        let (sin, cos) = (s / 100.0).sin_cos();
        let axes = Mat3::columns([Vec3([cos, -sin, 0.0]), Vec3::AXES[2], Vec3([-sin, -cos, 0.0])]);
        Frame { position: Vec3([100.0 * sin, -100.0 * (1.0 - cos), 0.0]), rotation: axes }
    };
    let inertia = 1e7 / 12.0;
    let section = Matrices::principal([1e7, shear, shear, inertia, inertia, inertia], 1.0, [1.0; 3]);
    let mut chain = Chain::clamped(Beam::new(&equal(25.0 * PI, elements), curve, |_| section).unwrap());
    chain.load_tip(Vec3([0.0, 0.0, 600.0]), Vec3::ZERO);
    chain
}

/// Bathe & Bolourchi 1979, doi 10.1002/nme.1620140703, and Simo & Vu-Quoc 1986, doi 10.1016/0045-7825(86)90079-4, whose tips are at
/// (15.9, 47.2, 53.4) and (15.79, 47.23, 53.37) with eight straight elements.
#[test]
fn the_tip_of_the_bend_is_that_of_the_literature() {
    let tip = |n: usize| {
        let mut chain = bend(n, 5e6);
        chain.load(6);
        chain.tip().position
    };
    let tips = [2, 4, 8, 16].map(tip);
    println!("bend: {tips:?}");
    // The axes of the literature: y along the root, x towards the centre.
    let Vec3([along, inwards, out]) = tips[3];
    for (place, allowed) in [([15.9, 47.2, 53.4], 0.25), ([15.79, 47.23, 53.37], 0.12)] {
        let found = [-inwards, along, out];
        for k in 0..3 {
            assert!((found[k] - place[k]).abs() < allowed, "{found:?} for {place:?}");
        }
    }
    let differences: Vec<f64> = tips.windows(2).map(|t| (t[0] - t[1]).norm()).collect();
    assert!(orders(&differences).iter().all(|order| *order > 5.5), "{differences:?}");
}

/// Without shear it is the slender beam, whose element has nothing in common with this one.
#[test]
fn a_beam_stiff_in_shear_is_the_slender_beam() {
    use flexion::multibody::slender;
    let mut chain = bend(16, 1e9);
    chain.load(6);
    let inertia = 1e7 / 12.0;
    let section = slender::Properties::principal([1e7, inertia, inertia, inertia], 1.0, [1.0; 3]);
    let curve = |s: f64| {
        let (sin, cos) = (s / 100.0).sin_cos();
        slender::Station {
            position: Vec3([100.0 * sin, -100.0 * (1.0 - cos), 0.0]),
            tangent: Vec3([cos, -sin, 0.0]),
            normal: Vec3::AXES[2],
        }
    };
    let nodes = equal(25.0 * PI, 64);
    let mut statics =
        crate::slender::newton::Statics::clamped(slender::Beam::new(&nodes, curve, |_| section).unwrap());
    statics.loads.push((64, slender::Load::Force(Vec3([0.0, 0.0, 600.0]))));
    statics.load(6);
    let apart = (statics.tip().0 - chain.tip().position).norm();
    println!("without shear: {apart:e}");
    // Left of tension and torsion, which the slender beam couples: ½ K² κ₁² of its length.
    assert!(apart < 3e-3, "{apart}");
}
