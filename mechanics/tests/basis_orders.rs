//! Orders of convergence of the bases, measured on a uniform cantilever against closed forms.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // in helpers of tests

use flexion::basis::{
    BSpline, Basis, Bezier, Field, Hermite, Polynomial, PolynomialParameters, Radial, RadialParameters,
};
use flexion::exact::cantilever::bending_frequency;
use flexion::linalg::Dense;
use flexion::quadrature::Gauss;

/// Length of the beam; EI = ρA = 1.
const LENGTH: f64 = 2.0;

/// ∫ f(φᵢ⁽ᵈ⁾, φⱼ⁽ᵈ⁾) over the beam.
fn gram(basis: &dyn Basis, derivative: usize) -> Dense<f64> {
    let (gauss, cells) = (Gauss::new(basis.points_per_cell()), basis.cells());
    let (mut matrix, mut phi) = (Dense::new(basis.len()), vec![0.0; basis.max_support()]);
    for c in 0..cells.len() - 1 {
        for (x, w) in gauss.on(cells[c], cells[c + 1]) {
            let support = basis.eval(c, x, derivative, &mut phi);
            for (k, i) in support.clone().enumerate() {
                for (l, j) in support.clone().enumerate() {
                    matrix.add(i, j, w * phi[k] * phi[l]);
                }
            }
        }
    }
    matrix
}

/// Root mean square of the error of the deflection under the load eˣ, over the largest deflection.
///
/// w⁗ = eˣ, w(0) = w′(0) = w″(L) = w‴(L) = 0: w = eˣ − 1 − x − e^L [(1 − L)x²/2 + x³/6].
fn deflection_error(basis: &dyn Basis) -> f64 {
    let exact = |x: f64| x.exp() - 1.0 - x - LENGTH.exp() * ((1.0 - LENGTH) * x * x / 2.0 + x * x * x / 6.0);
    let (gauss, cells) = (Gauss::new(basis.points_per_cell() + 8), basis.cells());
    let (mut load, mut phi) = (vec![0.0; basis.len()], vec![0.0; basis.max_support()]);
    for c in 0..cells.len() - 1 {
        for (x, w) in gauss.on(cells[c], cells[c + 1]) {
            for (i, phi) in basis.eval(c, x, 0, &mut phi).zip(&phi) {
                load[i] += w * x.exp() * phi;
            }
        }
    }
    let mut stiffness = gram(basis, 2);
    stiffness.factor().unwrap();
    stiffness.solve(&mut load);
    let mut square = 0.0;
    for c in 0..cells.len() - 1 {
        for (x, w) in gauss.on(cells[c], cells[c + 1]) {
            let found: f64 = basis.eval(c, x, 0, &mut phi).zip(&phi).map(|(i, phi)| load[i] * phi).sum();
            square += w * (found - exact(x)).powi(2);
        }
    }
    (square / LENGTH).sqrt() / exact(LENGTH)
}

/// Relative error of the second bending frequency: inverse iteration with a shift just below the exact one,
/// closed by the Rayleigh quotient.
fn frequency_error(basis: &dyn Basis) -> f64 {
    let (stiffness, mass, n) = (gram(basis, 2), gram(basis, 0), basis.len());
    let exact = bending_frequency(2, 1.0, 1.0, LENGTH);
    let mut shifted = Dense::new(n);
    for (i, (k, m)) in stiffness.data().iter().zip(mass.data()).enumerate() {
        shifted.add(i / n, i % n, k - 0.9 * exact * exact * m);
    }
    shifted.factor().unwrap();
    let mut x: Vec<f64> = (0..n).map(|i| 1.0 + (i as f64).sin()).collect();
    let (mut y, mut square) = (vec![0.0; n], 0.0);
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
    square.sqrt() / exact - 1.0
}

/// Order between the two finest of `sizes` (numbers of cells), with the errors there.
fn order(sizes: [usize; 2], error: impl Fn(usize) -> f64) -> f64 {
    let [coarse, fine] = sizes.map(&error);
    let order = (coarse / fine).abs().ln() / (sizes[1] as f64 / sizes[0] as f64).ln();
    println!("    {sizes:?}: {coarse:.2e} {fine:.2e} order {order:.2}");
    order
}

/// Checks both orders. `within` says how near the asymptote the sizes are.
fn orders(
    name: &str,
    sizes: [usize; 2],
    expected: (f64, f64),
    within: f64,
    basis: impl Fn(usize) -> Box<dyn Basis>,
) {
    println!("{name}");
    let deflection = order(sizes, |cells| deflection_error(&*basis(cells)));
    let frequency = order(sizes, |cells| frequency_error(&*basis(cells)));
    assert!((deflection - expected.0).abs() < within, "{name}: deflection of order {deflection:.2}");
    assert!((frequency - expected.1).abs() < within, "{name}: frequency of order {frequency:.2}");
}

#[test]
fn hermite_elements_converge_with_order_4() {
    orders("Hermite", [8, 16], (4.0, 4.0), 0.15, |n| {
        Box::new(Hermite::new(LENGTH, n, Field::Transverse).unwrap())
    });
}

#[test]
fn b_splines_converge_with_order_p_plus_1_and_their_frequencies_with_2p_minus_2() {
    for (degree, sizes, deflection) in
        [(2, [16, 32], 2.0), (3, [16, 32], 4.0), (4, [16, 24], 5.0), (5, [12, 16], 6.0), (6, [8, 12], 7.0)]
    {
        let frequency = 2.0 * (degree as f64 - 1.0);
        orders(&format!("B-spline {degree}"), sizes, (deflection, frequency), 0.5, |n| {
            Box::new(BSpline::new(LENGTH, n, degree, Field::Transverse).unwrap())
        });
    }
}

#[test]
fn bezier_elements_converge_with_order_p_plus_1_and_their_frequencies_with_2p_minus_2() {
    for (degree, sizes, deflection) in
        [(2, [16, 32], 2.0), (3, [8, 16], 4.0), (4, [8, 12], 5.0), (5, [4, 6], 6.0)]
    {
        let frequency = 2.0 * (degree as f64 - 1.0);
        orders(&format!("Bézier {degree}"), sizes, (deflection, frequency), 0.3, |n| {
            Box::new(Bezier::new(LENGTH, n, degree, Field::Transverse).unwrap())
        });
    }
}

#[test]
fn one_bezier_curve_converges_faster_than_any_power() {
    let mut last = (1.0_f64, 100.0_f64);
    for degree in [4, 6, 8, 10, 12, 16, 20, 24, 27] {
        let basis = Bezier::new(LENGTH, 1, degree, Field::Transverse).unwrap();
        let (d, f) = (deflection_error(&basis), frequency_error(&basis).abs());
        println!(
            "Bézier n = {degree}: deflection {d:.1e} frequency {f:.1e} κ {:.1e}",
            basis.conditioning().number
        );
        if degree <= 12 {
            assert!(d < 0.03 * last.0 || d < 1e-13, "{d:.1e} after {:.1e}", last.0);
            assert!(f < 0.03 * last.1 || f < 1e-11, "{f:.1e} after {:.1e}", last.1);
        }
        last = (d, f);
    }
    // A condition number of 4e15 could cost all digits; it costs five.
    assert!(last.0 < 1e-10 && last.1 < 1e-10, "rounding at the highest degree: {last:?}");
}

/// With α_s = 1.5 a support holds four nodes (degree 7), three in the two end cells (degree d = 5). These set
/// the order, and there are only two of them: their share of the energy norm is h^{d−1} h^{1/2}.
#[test]
fn point_interpolation_converges_with_the_degree_of_its_end_cells_and_half_an_order_more() {
    let point = |support| {
        move |cells: usize| -> Box<dyn Basis> {
            let parameters = PolynomialParameters { nodes: cells + 1, support };
            Box::new(Polynomial::new(LENGTH, parameters, Field::Transverse).unwrap())
        }
    };
    orders("PIM, support 0.5", [8, 16], (4.0, 4.0), 0.15, point(0.5));
    println!("PIM, support 1.5");
    let deflection = order([8, 12], |cells| deflection_error(&*point(1.5)(cells)));
    assert!((deflection - 6.5).abs() < 0.3, "deflection of order {deflection:.2}");
    // 2(d − 1) + 1 = 9 is reached late, from below: 7.6 for [8, 12], 8.1 for [12, 16], 9.4 for [16, 20].
    let frequency = order([12, 20], |cells| frequency_error(&*point(1.5)(cells)));
    assert!((8.0..9.5).contains(&frequency), "frequency of order {frequency:.2}");
    let wide = point(2.5)(8);
    let (d, f) = (deflection_error(&*wide), frequency_error(&*wide));
    println!("PIM, support 2.5, 8 cells: {d:.1e} {f:.1e}");
    assert!(d < 1e-10 && f.abs() < 1e-11, "{d:.1e} {f:.1e}");
}

#[test]
fn point_interpolation_outruns_radial_interpolation_of_the_same_nodes() {
    for cells in [8, 10] {
        let parameters = PolynomialParameters { nodes: cells + 1, support: 2.5 };
        let polynomial = Polynomial::new(LENGTH, parameters, Field::Transverse).unwrap();
        let radial = Radial::new(LENGTH, RadialParameters::new(cells + 1), Field::Transverse).unwrap();
        let (p, r) = (frequency_error(&polynomial).abs(), frequency_error(&radial).abs());
        println!("{cells} cells: PIM {p:.1e}, RPIM {r:.1e}");
        assert!(p < 1e-2 * r, "{p:.1e} {r:.1e}");
    }
}
