//! Orders of convergence in frequency of the bases on a rotating beam, against the power series of its deflection.

#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

#[path = "../examples/rotating/mod.rs"]
mod rotating;

use rotating::{families, frequency_error};

/// Errors of a family at two numbers of cells, and the order between them in the cells.
fn order(name: &str, sizes: [usize; 2]) -> (f64, [f64; 2]) {
    let (_, family, _) = families().into_iter().find(|f| f.0 == name).unwrap();
    let errors = sizes.map(|cells| frequency_error(family(cells).unwrap()).unwrap().1.abs());
    let order = (errors[0] / errors[1]).ln() / (sizes[1] as f64 / sizes[0] as f64).ln();
    println!("{name} {sizes:?}: {errors:?} order {order:.2}");
    (order, errors)
}

/// ω² is a Rayleigh quotient: its error is the square of that of the curvature, 2(p − 1) for the degree p.
#[test]
fn piecewise_polynomials_of_degree_p_converge_with_order_2p_minus_2_in_a_rotating_beam_too() {
    for (name, sizes, degree, within) in [
        ("Hermite elements", [16, 32], 3.0, 0.1),
        ("B-spline, degree 3", [16, 32], 3.0, 0.1),
        ("B-spline, degree 4", [16, 24], 4.0, 0.4),
        ("B-spline, degree 5", [12, 16], 5.0, 0.8),
        ("Bézier elements, degree 5", [6, 8], 5.0, 0.4),
    ] {
        let order = order(name, sizes).0;
        let expected = 2.0 * degree - 2.0;
        assert!((order - expected).abs() < within, "{name}: order {order:.2}, not {expected}");
    }
}

/// A polynomial of the whole beam gains a factor with every degree: the deflection is an entire function.
#[test]
fn one_curve_converges_faster_than_any_power() {
    for sizes in [[6, 8], [8, 10], [10, 12]] {
        let errors = order("one Bézier curve", sizes).1;
        assert!(errors[1] < 0.003 * errors[0] || errors[1] < 1e-11, "{errors:?}");
    }
}

/// w⁗ = (T w′)′ + ω² w is T w″ ≠ 0 at the root, where w⁗ₖ of the modes at rest vanishes. Parts integrated, this leaves
/// f(0) w‴ₖ(0) / ωₖ⁴ ~ k³/k⁸ in the coefficients cₖ of w = Σ cₖ wₖ (ωₖ² ~ k⁴), and Σ ωₖ² cₖ² beyond N, the error of ω², falls
/// like N⁻⁵: not spectrally.
#[test]
fn modes_of_the_beam_at_rest_converge_with_order_5_once_it_rotates() {
    let order = order("assumed modes", [32, 64]).0;
    assert!((order - 5.0).abs() < 0.2, "order {order:.2}");
}

/// Point interpolation has the degree of its end cells and half an order of the curvature more, 9 when very fine; the
/// radial functions with fixed supports have an order of about four and a small factor.
#[test]
fn point_interpolation_reaches_the_order_of_its_end_cells() {
    let (polynomial, _) = order("point interpolation", [12, 16]);
    assert!((7.5..9.5).contains(&polynomial), "order {polynomial:.2}");
    let (radial, errors) = order("radial point interpolation", [24, 32]);
    assert!((3.8..5.2).contains(&radial), "order {radial:.2}");
    assert!(errors[1] < 3e-9, "{errors:?}");
}
