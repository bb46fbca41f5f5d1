//! Tapered sections against Bessel functions and closed forms, for several bases.

#![allow(clippy::unwrap_used)] // in helpers of tests

use flexion::basis::{BSpline, Basis, Bezier, Field, Hermite, Polynomial, PolynomialParameters};
use flexion::exact::taper::{Taper, bending_frequency, tip_deflection};
use flexion::linalg::Dense;
use flexion::quadrature::Gauss;
use flexion::section::{Resultants, Section, Shape, Tapered};

const LENGTH: f64 = 2.0;

/// ∫ weight(section) φᵢ⁽ᵈ⁾ φⱼ⁽ᵈ⁾ dx
fn gram(basis: &dyn Basis, derivative: usize, weight: impl Fn(f64) -> f64) -> Dense<f64> {
    let (gauss, cells) = (Gauss::new(basis.points_per_cell() + 2), basis.cells());
    let (mut matrix, mut phi) = (Dense::new(basis.len()), vec![0.0; basis.max_support()]);
    for c in 0..cells.len() - 1 {
        for (x, w) in gauss.on(cells[c], cells[c + 1]) {
            let support = basis.eval(c, x, derivative, &mut phi);
            for (k, i) in support.clone().enumerate() {
                for (l, j) in support.clone().enumerate() {
                    matrix.add(i, j, w * weight(x) * phi[k] * phi[l]);
                }
            }
        }
    }
    matrix
}

/// Tip deflection under a unit tip load, and bending frequency number `mode` near `exact`.
fn measured(basis: &dyn Basis, section: &dyn Section, exact: f64) -> (f64, f64) {
    let n = basis.len();
    let stiffness = gram(basis, 2, |x| section.resultants(x).bending_stiffness);
    let mass = gram(basis, 0, |x| section.resultants(x).mass);
    let mut load = vec![0.0; n];
    let last = basis.cells().len() - 2;
    let support = basis.support(last);
    basis.eval(last, LENGTH, 0, &mut load[support]);
    let (mut factored, mut deflected) = (stiffness.clone(), load.clone());
    factored.factor().unwrap();
    factored.solve(&mut deflected);
    let deflection = load.iter().zip(&deflected).map(|(a, b)| a * b).sum();
    let mut shifted = Dense::new(n);
    for (i, (k, m)) in stiffness.data().iter().zip(mass.data()).enumerate() {
        shifted.add(i / n, i % n, k - 0.95 * exact * exact * m);
    }
    shifted.factor().unwrap();
    let (mut x, mut y, mut square) = (deflected, vec![0.0; n], 0.0);
    x[0] += 0.1 * x[n - 1].abs();
    for _ in 0..30 {
        mass.multiply(&x, &mut y);
        shifted.solve(&mut y);
        let (mut my, mut ky) = (vec![0.0; n], vec![0.0; n]);
        mass.multiply(&y, &mut my);
        stiffness.multiply(&y, &mut ky);
        let inertia: f64 = y.iter().zip(&my).map(|(a, b)| a * b).sum();
        square = y.iter().zip(&ky).map(|(a, b)| a * b).sum::<f64>() / inertia;
        x.copy_from_slice(&y);
        x.iter_mut().for_each(|x| *x /= inertia.sqrt());
    }
    (deflection, square.sqrt())
}

fn bases() -> Vec<(&'static str, Box<dyn Basis>, f64)> {
    let parameters = PolynomialParameters { nodes: 31, support: 1.5 };
    vec![
        ("Bézier", Box::new(Bezier::new(LENGTH, 1, 16, Field::Transverse).unwrap()), 1e-9),
        ("B-spline", Box::new(BSpline::new(LENGTH, 24, 5, Field::Transverse).unwrap()), 1e-8),
        ("PIM", Box::new(Polynomial::new(LENGTH, parameters, Field::Transverse).unwrap()), 1e-8),
        ("Hermite", Box::new(Hermite::new(LENGTH, 80, Field::Transverse).unwrap()), 1e-5),
    ]
}

#[test]
fn wedges_and_cones_vibrate_and_bend_as_the_closed_forms_say() {
    let wedge = |ratio: f64| {
        let root = Shape::Rectangle { width: 0.03, height: 0.05 };
        (root, Shape::Rectangle { width: 0.03, height: 0.05 * ratio })
    };
    let cone = |ratio: f64| (Shape::Circle { radius: 0.03 }, Shape::Circle { radius: 0.03 * ratio });
    let pyramid = |ratio: f64| {
        let root = Shape::Rectangle { width: 0.03, height: 0.05 };
        (root, Shape::Rectangle { width: 0.03 * ratio, height: 0.05 * ratio })
    };
    let tube = |ratio: f64| {
        let at = |s: f64| Shape::Tube { outer_radius: 0.03 * s, inner_radius: 0.025 * s };
        (at(1.0), at(ratio))
    };
    type Shapes<'a> = &'a dyn Fn(f64) -> (Shape, Shape);
    let kinds: [(Taper, Shapes<'_>); 4] =
        [(Taper::Wedge, &wedge), (Taper::Cone, &cone), (Taper::Cone, &pyramid), (Taper::Cone, &tube)];
    for (taper, shapes) in kinds {
        for ratio in [0.3, 0.5, 0.9] {
            let (root, tip) = shapes(ratio);
            let section = Tapered::new(70e9, 2700.0, LENGTH, root, tip).unwrap();
            let Resultants { mass, bending_stiffness, .. } = section.resultants(0.0);
            let static_exact = tip_deflection(taper, ratio, 1.0, bending_stiffness, LENGTH);
            for mode in [1, 2, 3] {
                let exact = bending_frequency(taper, ratio, mode, bending_stiffness, mass, LENGTH).unwrap();
                for (name, basis, tolerance) in bases() {
                    let (deflection, frequency) = measured(&*basis, &section, exact);
                    let (d, f) = (deflection / static_exact - 1.0, frequency / exact - 1.0);
                    assert!(
                        d.abs() < tolerance && f.abs() < tolerance,
                        "{taper:?} {root:?} {ratio} {name} mode {mode}: deflection {d:.1e}, frequency {f:.1e}"
                    );
                }
            }
        }
    }
}
