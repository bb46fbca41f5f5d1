use super::super::{Basis, Role, checks};
use super::*;

fn with(shape: f64, support: f64, degree: Option<usize>) -> RadialParameters {
    RadialParameters { nodes: 11, shape, exponent: 1.03, support, degree, per_point: false }
}

#[test]
fn it_is_a_basis_of_its_field() {
    for field in [Field::Axial, Field::Transverse] {
        for nodes in [2, 3, 5, 11] {
            checks::all(&Radial::new(3.7, RadialParameters::new(nodes), field).unwrap(), field);
        }
        for (shape, support, degree) in [(1.0, 1.5, None), (2.0, 2.5, Some(1)), (7.0, 2.5, None)] {
            checks::all(&Radial::new(3.7, with(shape, support, degree), field).unwrap(), field);
        }
    }
}

#[test]
fn it_reproduces_clamped_polynomials_of_its_degree() {
    for shape in [2.0, 4.0, 7.0] {
        let derivatives: [&dyn Fn(f64) -> f64; 3] =
            [&|x| 2.0 * x * x - 0.7 * x * x * x, &|x| 4.0 * x - 2.1 * x * x, &|x| 4.0 - 4.2 * x];
        let basis = Radial::new(3.7, with(shape, 2.5, Some(3)), Field::Transverse).unwrap();
        let nodal: Vec<f64> = (0..basis.len())
            .map(|i| derivatives[(basis.role(i) == Role::Slope) as usize](basis.anchor(i)))
            .collect();
        checks::reproduces(&basis, &nodal, derivatives);
        let basis = Radial::new(3.7, with(shape, 2.5, Some(1)), Field::Axial).unwrap();
        let nodal: Vec<f64> = (0..basis.len()).map(|i| 3.0 * basis.anchor(i)).collect();
        checks::reproduces(&basis, &nodal, [&|x: f64| 3.0 * x, &|_| 3.0]);
    }
}

#[test]
fn values_and_slopes_at_the_nodes_are_the_unknowns() {
    for field in [Field::Axial, Field::Transverse] {
        let basis = Radial::new(3.7, with(5.0, 3.5, None), field).unwrap();
        let mut out = vec![0.0; basis.max_support()];
        for cell in 0..10 {
            for x in [basis.cells()[cell], basis.cells()[cell + 1]] {
                for derivative in 0..if field == Field::Axial { 1 } else { 2 } {
                    for (i, &found) in basis.eval(cell, x, derivative, &mut out).zip(&out) {
                        let role = if derivative == 0 { Role::Value } else { Role::Slope };
                        let here = (basis.anchor(i) - x).abs() < 1e-12 && basis.role(i) == role;
                        let unit = if here { 1.0 } else { 0.0 };
                        assert!((found - unit).abs() < 1e-12, "{field:?} function {i} at {x}: {found}");
                    }
                }
            }
        }
    }
}

/// Errors of a cantilever with 11 nodes, α_s = 2.5 and no polynomials, as measured; the error falls as α_c grows.
#[test]
fn flatter_radial_functions_bend_more_accurately_from_1_to_7() {
    let mut last = 1.0;
    for (shape, deflection, frequency) in
        [(1.0, 1.2e-3, 9e-4), (2.0, 8e-6, 1e-5), (4.0, 4e-9, 1.2e-8), (7.0, 1e-10, 1e-10)]
    {
        let basis = Radial::new(10.0, with(shape, 2.5, None), Field::Transverse).unwrap();
        let (d, f) = checks::cantilever_errors(&basis);
        assert!(d.abs() < deflection && f.abs() < frequency, "α_c = {shape}: {d:.1e} {f:.1e}");
        assert!(f > -1e-10, "a conforming field cannot vibrate below the exact frequency: {f:e}");
        assert!(f.abs() < last);
        last = f.abs();
    }
}

#[test]
fn the_defaults_beat_hermite_elements_on_the_same_nodes() {
    let radial = Radial::new(10.0, RadialParameters::new(11), Field::Transverse).unwrap();
    let (deflection, frequency) = checks::cantilever_errors(&radial);
    let hermite = super::super::Hermite::new(10.0, 10, Field::Transverse).unwrap();
    let (_, elements) = checks::cantilever_errors(&hermite);
    assert!(deflection.abs() < 1e-10, "{deflection:e}");
    assert!(frequency.abs() < 1e-2 * elements, "{frequency:e} against {elements:e}");
}

#[test]
fn the_moment_matrix_becomes_singular_beyond_a_shape_parameter_of_7() {
    // P1's limit, for a support of 6 nodes, with and without polynomials.
    for degree in [None, Some(3)] {
        let basis = |shape| Radial::new(10.0, with(shape, 2.5, degree), Field::Transverse);
        assert!(basis(7.0).unwrap().conditioning().number * f64::EPSILON < 1.0);
        for shape in [7.5, 8.0, 10.0] {
            assert!(matches!(basis(shape), Err(BasisError::Singular { .. })), "{shape} {degree:?}");
        }
    }
}

#[test]
fn a_singular_moment_matrix_is_refused_with_its_numbers() {
    for parameters in [
        with(8.0, 10.0, None),
        with(20.0, 2.5, Some(1)),
        RadialParameters { exponent: 1.0, ..with(4.0, 2.5, None) },
        RadialParameters { exponent: 2.0, ..with(4.0, 2.5, Some(1)) },
    ] {
        match Radial::new(10.0, parameters, Field::Transverse) {
            Err(error @ BasisError::Singular { number, .. }) => {
                assert!(number > 1e15, "{parameters:?}: {number:e}");
                assert!(error.to_string().contains("shape"), "{error}");
            }
            other => panic!("{parameters:?}: {other:?}"),
        }
    }
}

#[test]
fn parameters_out_of_range_are_refused() {
    for parameters in [
        with(0.0, 2.5, None),
        with(f64::NAN, 2.5, None),
        with(4.0, 0.4, None),
        with(4.0, f64::INFINITY, None),
        with(4.0, 0.5, Some(4)),
        with(4.0, 0.5, Some(usize::MAX)),
        with(1e-3, 2.5, None),
        RadialParameters { exponent: f64::NAN, ..with(4.0, 2.5, None) },
        RadialParameters { nodes: 100, ..with(1.0, 100.0, None) },
        RadialParameters { nodes: 1, ..with(4.0, 2.5, None) },
        RadialParameters { nodes: 0, ..with(4.0, 2.5, None) },
    ] {
        let error = Radial::new(10.0, parameters, Field::Transverse).unwrap_err();
        assert!(matches!(error, BasisError::Invalid(_)), "{parameters:?}: {error}");
    }
}

/// Where each point has a domain of its own its functions are those of the nodes within α_s spacings of it, and reproduce what they did; with a whole α_s no node enters or
/// leaves between two nodes, and the domains are those of the cells.
#[test]
fn a_domain_for_each_point_holds_the_nodes_about_it() {
    let per_point = |shape, support| RadialParameters { per_point: true, ..with(shape, support, Some(1)) };
    let basis = Radial::new(1.0, per_point(2.0, 2.3), Field::Axial).unwrap();
    assert_eq!((basis.len(), basis.cells().len()), (10, 31));
    for i in 0..300 {
        let x = (f64::from(i) + 0.5) / 300.0;
        let cell = basis.cells().partition_point(|end| *end <= x) - 1;
        let mut values = vec![0.0; 10];
        let support = basis.eval(cell, x, 0, &mut values);
        let about: Vec<usize> = (1..=10).filter(|node| (x - 0.1 * *node as f64).abs() < 0.23).collect();
        assert_eq!(support, about[0] - 1..about[about.len() - 1], "x = {x}");
        let sum: f64 =
            support.clone().zip(&values).map(|(node, value)| 0.1 * (node + 1) as f64 * value).sum();
        assert!((sum - x).abs() < 1e-9, "{sum} at {x}");
    }
    let [whole, cells] = [true, false].map(|per_point| {
        let parameters = RadialParameters { per_point, ..with(2.0, 2.0, Some(1)) };
        Radial::new(1.0, parameters, Field::Transverse).unwrap()
    });
    assert_eq!(whole.cells(), cells.cells());
}
