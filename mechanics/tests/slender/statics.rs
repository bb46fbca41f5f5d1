//! Equilibria against closed forms and published values.

#![allow(clippy::unwrap_used)]

use super::newton::{Statics, cantilever, equal};
use flexion::multibody::slender::{Beam, Load, Properties, Station};

/// Bathe and Bolourchi's bend of 45°: radius 100, section 1 × 1, E 10⁷, ν 0, GJ of the polar moment; n across its plane.
pub fn bend(elements: usize) -> Statics {
    let curve = |s: f64| {
        let (sin, cos) = (s / 100.0).sin_cos();
        Station {
            position: [100.0 * sin, -100.0 * (1.0 - cos), 0.0],
            tangent: [cos, -sin, 0.0],
            normal: [0.0, 0.0, 1.0],
        }
    };
    let (ea, ei) = (1e7, 1e7 / 12.0);
    let section = Properties::principal([ea, ei, ei, ei], 1.0, [1.0; 3]);
    let nodes = equal(25.0 * std::f64::consts::PI, elements);
    Statics::clamped(Beam::new(&nodes, curve, |_| section).unwrap())
}

#[test]
fn bend_of_45_degrees() {
    let mut last: Option<[f64; 3]> = None;
    for n in [2, 4, 8, 16, 32, 64] {
        let mut statics = bend(n);
        statics.loads.push((n, Load::Force([0.0, 0.0, 600.0])));
        let iterations = statics.load(6);
        let tip = statics.tip().0;
        println!(
            "{n} {iterations} {tip:?} {:?}",
            last.map(|l| (0..3).map(|k| (l[k] - tip[k]).abs()).fold(0.0, f64::max))
        );
        last = Some(tip);
    }
    let mut last: Option<[f64; 3]> = None;
    for n in [2, 4, 8, 16, 32, 64] {
        let mut statics = cantilever(1.0, n, Properties::principal([1e8, 1.0, 1.0, 1.0], 1.0, [1.0; 3]));
        statics.loads.push((n, Load::Force([0.0, 6.0, 8.0])));
        let iterations = statics.load(5);
        let tip = statics.tip().0;
        println!(
            "{n} {iterations} {tip:?} {:?}",
            last.map(|l| (0..3).map(|k| (l[k] - tip[k]).abs()).fold(0.0, f64::max))
        );
        last = Some(tip);
    }
}
