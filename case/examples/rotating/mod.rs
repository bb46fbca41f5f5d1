//! The error of a basis in the frequency of a rotating beam, for the figure and the test of its convergence.

use flexion::basis::{Basis, Field, Lagrange};
use flexion::exact::rotating::flapwise_frequency;
use flexion::hub_beam::{Fields, Foreshortening, Hub, HubBeam, LinearCoupling};
use flexion::linalg::Matrix;
use flexion::profile::{Constant, Motion};
use flexion::section::{Resultants, Uniform};
use flexion::system::{Direction, Dynamics, Observed, State, Weights};
use nalgebra::{Cholesky, DMatrix};
use std::error::Error;
use std::sync::Arc;

/// Speed Ω √(ρA L⁴/EI).
pub const SPEED: f64 = 10.0;
/// The mode.
pub const MODE: usize = 2;

/// Relative error of the frequency of a mode at a speed, L = ρA = EI = 1, and the number of unknowns. The transverse
/// part of the first-order coupling is taken alone, for which ω_flap² = ω_chord² + Ω².
pub fn frequency_error(transverse: Box<dyn Basis>) -> Result<(usize, f64), Box<dyn Error>> {
    let unknowns = transverse.len();
    let resultants =
        Resultants { mass: 1.0, axial_stiffness: 1e4, bending_stiffness: 1.0, ..Resultants::default() };
    let section = Uniform::from_resultants(resultants)?;
    let profile = Arc::new(Constant::new(SPEED)?);
    let hub = Hub::prescribed(0.0, 0.0, Motion::Speed { profile, initial_angle: 0.0 });
    let axial = Box::new(Lagrange::new(1.0, 1, 1)?);
    let fields = Fields::new(1.0, axial, transverse, &[]);
    let coupling = LinearCoupling::new(fields, &section, &hub, Foreshortening::First);
    let mut system = HubBeam::new(hub, coupling, &[]);
    let state = State::zeros(system.size(), 0.0);
    let across: Vec<usize> =
        (0..system.size().v).filter(|&i| system.direction(i) == Direction::Chord).collect();
    let mut part = |weights: Weights<'_>| {
        let mut matrix = Matrix::new(&system.structure(0));
        system.tangent(&state, weights, &mut matrix);
        DMatrix::from_fn(unknowns, unknowns, |i, j| matrix.get(across[i], across[j]))
    };
    let (mass, stiffness) = (part(Weights::new(1.0, 0.0, 0.0)), part(Weights::new(0.0, 0.0, 1.0)));
    let root = Cholesky::new(mass).ok_or("the mass matrix is not positive definite")?.l();
    let half = root.solve_lower_triangular(&stiffness).ok_or("singular")?;
    let reduced = root.solve_lower_triangular(&half.transpose()).ok_or("singular")?;
    let mut squares: Vec<f64> = reduced.symmetric_eigenvalues().iter().copied().collect();
    squares.sort_by(f64::total_cmp);
    let found = (squares.get(MODE - 1).ok_or("too few unknowns")? + SPEED * SPEED).sqrt();
    Ok((unknowns, found / flapwise_frequency(MODE, SPEED, 0.0) - 1.0))
}

/// A basis of `n` cells, functions or nodes.
pub type Family = fn(usize) -> Result<Box<dyn Basis>, Box<dyn Error>>;

/// The bases, with the numbers of cells that the figure shows.
pub fn families() -> Vec<(&'static str, Family, Vec<usize>)> {
    use flexion::basis::{
        BSpline, Bezier, Hermite, Modes, Polynomial, PolynomialParameters, Radial, RadialParameters,
    };
    const ACROSS: Field = Field::Transverse;
    vec![
        ("Hermite elements", |n| Ok(Box::new(Hermite::new(1.0, n, ACROSS)?)), vec![2, 4, 8, 16, 32]),
        ("B-spline, degree 3", |n| Ok(Box::new(BSpline::new(1.0, n, 3, ACROSS)?)), vec![4, 8, 16, 32]),
        ("B-spline, degree 4", |n| Ok(Box::new(BSpline::new(1.0, n, 4, ACROSS)?)), vec![4, 8, 16, 24]),
        ("B-spline, degree 5", |n| Ok(Box::new(BSpline::new(1.0, n, 5, ACROSS)?)), vec![2, 4, 8, 12, 16]),
        ("Bézier elements, degree 5", |n| Ok(Box::new(Bezier::new(1.0, n, 5, ACROSS)?)), vec![1, 2, 4, 6, 8]),
        ("one Bézier curve", |n| Ok(Box::new(Bezier::new(1.0, 1, n, ACROSS)?)), vec![4, 6, 8, 10, 12, 14]),
        ("assumed modes", |n| Ok(Box::new(Modes::new(1.0, n, ACROSS)?)), vec![2, 4, 8, 16, 32, 64]),
        (
            "point interpolation",
            |n| {
                let parameters = PolynomialParameters { nodes: n + 1, support: 1.5 };
                Ok(Box::new(Polynomial::new(1.0, parameters, ACROSS)?))
            },
            vec![3, 4, 6, 8, 12, 16],
        ),
        (
            "radial point interpolation",
            |n| Ok(Box::new(Radial::new(1.0, RadialParameters::new(n + 1), ACROSS)?)),
            vec![4, 6, 8, 12, 16, 24, 32],
        ),
    ]
}
