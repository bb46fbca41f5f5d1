//! Band, border and deflation against the dense factorisation.

use super::*;
use num_complex::Complex64;

/// A small deterministic generator of numbers in (−1, 1).
struct Numbers(u64);
impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// A matrix of the structure with random entries (`diagonal` added on the diagonal) and its dense twin.
fn random_pair(structure: &Structure, diagonal: f64, seed: u64) -> (Matrix, Matrix) {
    let n = structure.order();
    let mut numbers = Numbers(seed);
    let mut a = Matrix::new(structure);
    let mut b = Matrix::new(&Structure::dense(n));
    let Structure::Band { order, lower, upper, .. } = *structure else { panic!("a band is asked for") };
    for i in 0..n {
        for j in 0..n {
            let in_band = i < order && j < order && j + lower >= i && j <= i + upper;
            if in_band || i >= order || j >= order {
                let x = numbers.next() + if i == j { diagonal } else { 0.0 };
                a.add(i, j, x);
                b.add(i, j, x);
            }
        }
    }
    (a, b)
}

fn solve_error(mut a: Matrix, mut b: Matrix) -> f64 {
    let n = a.order();
    let mut numbers = Numbers(7);
    let rhs: Vec<f64> = (0..n).map(|_| numbers.next()).collect();
    let (mut x, mut y) = (rhs.clone(), rhs);
    assert!(a.factor().unwrap() && !a.factor().unwrap());
    b.factor().unwrap();
    a.solve(&mut x);
    b.solve(&mut y);
    let scale = y.iter().fold(0.0, |m: f64, y| m.max(y.abs()));
    x.iter().zip(&y).fold(0.0, |m: f64, (x, y)| m.max((x - y).abs())) / scale
}

#[test]
fn band_and_dense_give_the_same_solution() {
    for (n, lower, upper, border) in
        [(33, 5, 5, 0), (40, 7, 7, 1), (12, 3, 1, 2), (9, 0, 0, 1), (25, 1, 4, 3), (6, 5, 5, 0), (1, 0, 0, 1)]
    {
        for (diagonal, seed) in [(0.0, 3), (4.0, 5), (0.0, 11)] {
            let (a, b) = random_pair(&Structure::band(n, lower, upper, border), diagonal, seed);
            let error = solve_error(a, b);
            assert!(error < 1e-10, "n {n} bands {lower} {upper} border {border}: {error:e}");
        }
    }
}

/// Rows are eliminated in place up to the first exchange, and in the order of the exchanges from there on.
#[test]
fn exchanges_may_begin_anywhere() {
    for (lower, upper) in [(3, 3), (5, 5), (15, 15), (23, 23), (15, 4), (2, 9)] {
        for start in [1, 20, 33, 49] {
            let (mut a, mut b) = random_pair(&Structure::band(50, lower, upper, 0), 8.0, 17);
            for i in start..50 {
                a.add(i, i, -8.0);
                b.add(i, i, -8.0);
            }
            let error = solve_error(a, b);
            assert!(error < 1e-11, "bands {lower} {upper}, exchanges from {start} on: {error:e}");
        }
    }
}

#[test]
fn multipliers_inside_the_band_survive_pivoting() {
    // Saddle point [[2, 1], [1, 0]] blocks chained: zero diagonals at every second unknown.
    let n = 24;
    let structure = Structure::band(n, 3, 3, 0);
    let (mut a, mut b) = (Matrix::new(&structure), Matrix::new(&Structure::dense(n)));
    let mut add = |i: usize, j: usize, x: f64| {
        a.add(i, j, x);
        b.add(i, j, x);
    };
    for i in (0..n).step_by(2) {
        add(i, i, 2.0);
        add(i, i + 1, 1.0);
        add(i + 1, i, 1.0);
        if i + 2 < n {
            add(i, i + 2, -0.9);
            add(i + 2, i, -0.7);
        }
    }
    assert!(solve_error(a, b) < 1e-12);
}

/// A chain that resists bending, k (xᵢ₋₁ − 2xᵢ + xᵢ₊₁), with its first two places held by rows of one: the deflection under a load k is the same
/// for any k.
#[test]
fn rows_of_joints_hold_a_beam_of_any_stiffness() {
    let places = 30;
    let n = places + 2;
    // λ₀, x₀, λ₁, x₁, x₂ …
    let of = |i: usize| if i < 2 { 2 * i + 1 } else { i + 2 };
    let deflection = |k: f64| {
        let (mut a, mut b) = (Matrix::new(&Structure::band(n, 3, 3, 0)), vec![0.0; n]);
        for i in 1..places - 1 {
            let row = [(of(i - 1), 1.0), (of(i), -2.0), (of(i + 1), 1.0)];
            row.iter().for_each(|(p, x)| row.iter().for_each(|(q, y)| a.add(*p, *q, k * x * y)));
        }
        for i in [0, 1] {
            a.add(2 * i, of(i), -1.0);
            a.add(of(i), 2 * i, -1.0);
        }
        b[n - 1] = k;
        a.factor_equilibrated().unwrap();
        a.solve(&mut b);
        b[n - 1]
    };
    // The moment is k (n − 1 − i) at place i, and so is the second difference.
    let expected: f64 = (1..places - 1).map(|i| ((places - 1 - i) as f64).powi(2)).sum();
    for k in [1e-12, 1e-6, 1.0, 1e6, 1e12] {
        let found = deflection(k);
        assert!((found / expected - 1.0).abs() < 1e-10, "k = {k:e}: {found} and {expected}");
    }
}

/// A chain of masses with a multiplier between neighbours, which joins them, and one that joins the ends: in the order
/// x, λ all the multipliers are far from their masses, in the order of the chain they lie in the band.
fn chain<T: Scalar>(masses: usize, structure: &Structure) -> Matrix<T> {
    let mut a = Matrix::new(structure);
    for i in 0..masses {
        a.add(i, i, T::real(1.0 + 0.1 * i as f64));
        if i + 1 < masses {
            a.add(i, i + 1, T::real(0.2));
            a.add(i + 1, i, T::real(-0.3));
        }
        let (row, next) = (masses + i, (i + 1) % masses);
        let part = if i + 1 < masses { -1.0 } else { 0.5 };
        for (j, x) in [(i, 1.0), (next, part)] {
            a.add(row, j, T::real(x));
            a.add(j, row, T::real(-x));
        }
        a.add(row, row, T::real(if i + 1 < masses { 0.0 } else { 1.0 }));
    }
    a
}

#[test]
fn multipliers_are_placed_between_the_bodies_that_they_join() {
    let masses = 40;
    // Mass i at 2i, the multiplier to the next at 2i + 1, the last one in the border.
    let places: Vec<usize> =
        (0..2 * masses).map(|i| if i < masses { 2 * i } else { 2 * (i - masses) + 1 }).collect();
    let ordered = Structure::ordered(
        places.into_iter().map(|place| place as u32).collect(),
        Structure::band(2 * masses - 1, 2, 2, 1),
        false,
    );
    let dense = Structure::dense(2 * masses);
    assert_eq!((ordered.order(), ordered.half_bandwidth(), ordered.border()), (2 * masses, 2, 1));
    let (mut a, b) = (chain::<f64>(masses, &ordered), chain::<f64>(masses, &dense));
    let entries = b.clone();
    for (i, j) in [(0, 0), (3, 4), (4, 3), (masses + 3, 4), (5, masses + 5), (2 * masses - 1, 0)] {
        assert_eq!(a.get(i, j), b.get(i, j));
    }
    for j in [0, 7, masses + 3, 2 * masses - 1] {
        let column = |a: &Matrix| {
            let mut column = vec![0.0; 2 * masses];
            a.column(j, |i, x| column[i] += x);
            column
        };
        assert_eq!(column(&a), column(&b));
        assert_eq!(column(&a)[5], a.get(5, j));
    }
    let x: Vec<f64> = (0..2 * masses).map(|i| (0.7 * i as f64).sin()).collect();
    let (mut y, mut z) = (vec![0.0; 2 * masses], vec![0.0; 2 * masses]);
    a.multiply(&x, &mut y);
    b.multiply(&x, &mut z);
    assert!(y.iter().zip(&z).all(|(y, z)| (y - z).abs() < 1e-14));
    assert!(solve_error(a.clone(), b) < 1e-12);
    a.factor().unwrap();
    a.solve(&mut y);
    assert!(y.iter().zip(&x).all(|(y, x)| (y - x).abs() < 1e-12));
    // A combination keeps the order, in complex numbers too.
    let terms = [&chain(masses, &ordered), &chain(masses, &ordered), &chain(masses, &ordered)];
    let weights = [Complex64::ONE, Complex64::new(0.3, 0.4), Complex64::new(-0.1, 0.2)];
    let mut sum = Matrix::<Complex64>::new(&ordered);
    sum.combine(terms, weights);
    let total = weights.iter().sum::<Complex64>();
    let mut product: Vec<Complex64> = z.iter().map(|z| total * z).collect();
    sum.factor().unwrap();
    sum.solve(&mut product);
    assert!(product.iter().zip(&x).all(|(y, x)| (y - x).norm() < 1e-12));
    // Further unknowns between the masses and the multipliers.
    let wide = ordered.clone().widened(masses, 2);
    assert_eq!((wide.order(), wide.half_bandwidth(), wide.border()), (2 * masses + 2, 2, 3));
    let number = |i: usize| if i < masses { i } else { i + 2 };
    let [mut more, mut dense] = [&wide, &Structure::dense(2 * masses + 2)].map(|structure| {
        let mut more = Matrix::<f64>::new(structure);
        for i in 0..2 * masses {
            for j in 0..2 * masses {
                let x = entries.get(i, j);
                if x != 0.0 {
                    more.add(number(i), number(j), x);
                }
            }
        }
        for k in 0..2 {
            more.add(masses + k, masses + k, 3.0);
            more.add(7 * k, masses + k, 0.4);
            more.add(masses + k, 9 + k, -0.2);
        }
        more
    });
    assert_eq!(more.get(masses + 1, 10), -0.2);
    more.factor().unwrap();
    dense.factor().unwrap();
    let mut right: Vec<f64> = (0..2 * masses + 2).map(|i| (0.3 * i as f64).cos()).collect();
    let mut other = right.clone();
    more.solve(&mut right);
    dense.solve(&mut other);
    assert!(right.iter().zip(&other).all(|(x, y)| (x - y).abs() < 1e-12));
    // What is singular is named by its own number, not by its place.
    let mut empty: Matrix =
        Matrix::new(&Structure::ordered(vec![2, 0, 1].into(), Structure::band(3, 1, 1, 0), true));
    empty.add(0, 0, 1.0);
    empty.add(1, 1, 1.0);
    assert_eq!(empty.factor().unwrap_err().index, 2);
}

#[test]
fn a_singular_band_held_by_its_border_is_solved() {
    // A free chain of springs (rigid translation) whose mean the border fixes.
    for n in [5, 30] {
        let structure = Structure::band(n, 1, 1, 1);
        let (mut a, mut b) = (Matrix::new(&structure), Matrix::new(&Structure::dense(n + 1)));
        for i in 0..n {
            for (j, x) in [(i.wrapping_sub(1), -1.0), (i, 2.0), (i + 1, -1.0)] {
                if j < n {
                    let x = if i == j && (i == 0 || i == n - 1) { 1.0 } else { x };
                    a.add(i, j, 1e6 * x);
                    b.add(i, j, 1e6 * x);
                }
            }
            for m in [&mut a, &mut b] {
                m.add(i, n, 1.0);
                m.add(n, i, 1.0);
            }
        }
        assert!(solve_error(a, b) < 1e-9);
    }
}

/// A free beam of second differences moves and turns; rounding leaves less on the diagonal of the last pivots than below it. (It
/// grows with n³: a longer beam has pivots that no longer vanish.)
#[test]
fn a_band_that_is_singular_twice_is_held_by_its_border() {
    for n in [5, 6, 7, 8] {
        let structure = Structure::band(n, 2, 2, 2);
        let (mut a, mut b) = (Matrix::new(&structure), Matrix::new(&Structure::dense(n + 2)));
        for m in [&mut a, &mut b] {
            for k in 0..n - 2 {
                let stiffness = 1e6 * (1.0 + 0.37 * (k as f64).sin());
                for (i, x) in [1.0, -2.0, 1.0].into_iter().enumerate() {
                    for (j, y) in [1.0, -2.0, 1.0].into_iter().enumerate() {
                        m.add(k + i, k + j, stiffness * x * y);
                    }
                }
            }
            for i in 0..n {
                for (k, x) in [1.0, 0.3 * i as f64].into_iter().enumerate() {
                    m.add(i, n + k, x);
                    m.add(n + k, i, x);
                }
            }
        }
        assert!(solve_error(a, b) < 1e-8);
    }
}

#[test]
fn a_singular_matrix_is_refused_with_its_unknown() {
    let mut a: Matrix = Matrix::new(&Structure::band(4, 1, 1, 0));
    for i in [0, 1, 3] {
        a.add(i, i, 1.0);
    }
    assert_eq!(a.factor().unwrap_err().index, 2);
    let mut nan: Matrix = Matrix::new(&Structure::band(3, 1, 1, 1));
    nan.add(0, 0, f64::NAN);
    assert!(nan.factor().is_err());
    let mut empty: Matrix = Matrix::new(&Structure::dense(2));
    assert_eq!(empty.factor().unwrap_err().index, 0);
}

#[test]
fn multiplication_inverts_the_solution() {
    let (mut a, _) = random_pair(&Structure::band(20, 2, 3, 2), 3.0, 17);
    let x: Vec<f64> = (0..22).map(|i| (i as f64).sin()).collect();
    let mut y = vec![0.0; 22];
    a.multiply(&x, &mut y);
    a.factor().unwrap();
    a.solve(&mut y);
    assert!(x.iter().zip(&y).all(|(x, y)| (x - y).abs() < 1e-12));
}

#[test]
fn a_combination_is_kept_while_stamps_and_weights_stay() {
    let structure = Structure::band(12, 2, 2, 1);
    let [mut a, mut b, mut c] =
        [(3.0, 1), (1.0, 2), (2.0, 3)].map(|(d, seed)| random_pair(&structure, d, seed).0);
    for (k, term) in [&mut a, &mut b, &mut c].into_iter().enumerate() {
        term.set_stamp(Some([k as f64; 6]));
    }
    let weights = [Complex64::ONE, Complex64::new(0.3, 0.4), Complex64::new(-0.1, 0.2)];
    let mut sum = Matrix::<Complex64>::new(&structure);
    sum.combine([&a, &b, &c], weights);
    for (i, j) in [(0, 0), (3, 4), (5, 3), (12, 7), (2, 12), (12, 12)] {
        let expected: Complex64 = [&a, &b, &c].iter().zip(weights).map(|(a, w)| w * a.get(i, j)).sum();
        assert!((sum.get(i, j) - expected).norm() < 1e-14);
    }
    let x: Vec<Complex64> = (0..13).map(|i| Complex64::new((i as f64).cos(), (i as f64).sin())).collect();
    let mut y = vec![Complex64::ZERO; 13];
    sum.multiply(&x, &mut y);
    assert!(sum.factor().unwrap());
    sum.combine([&a, &b, &c], weights);
    assert!(sum.is_factored(), "the same stamps and weights: the factors are kept");
    sum.solve(&mut y);
    assert!(x.iter().zip(&y).all(|(x, y)| (x - y).norm() < 1e-12));
    sum.combine([&a, &b, &c], [weights[0], weights[1], Complex64::ONE]);
    assert!(!sum.is_factored(), "another weight");
    sum.factor().unwrap();
    b.set_stamp(Some([3.0; 6]));
    sum.combine([&a, &b, &c], [weights[0], weights[1], Complex64::ONE]);
    assert!(!sum.is_factored(), "another term");
}

/// Of many border unknowns a few couple to others, as contacts that are closed among those that are open.
#[test]
fn border_unknowns_that_couple_to_nothing_are_their_diagonal_alone() {
    let (n, border) = (30, 40);
    let structure = Structure::band(n, 2, 2, border);
    for coupled in [0, 3, 25] {
        let mut numbers = Numbers(coupled as u64 + 5);
        let mut a: Matrix = Matrix::new(&structure);
        let mut b: Matrix = Matrix::new(&Structure::dense(n + border));
        // The second time in the memory of other unknowns.
        for first in [1, 7] {
            a.clear();
            b.clear();
            let mut add = |i: usize, j: usize, x: f64| {
                a.add(i, j, x);
                b.add(i, j, x);
            };
            for i in 0..n {
                (i.saturating_sub(2)..(i + 3).min(n)).for_each(|j| add(i, j, numbers.next()));
                add(i, i, 5.0);
            }
            for k in 0..border {
                add(n + k, n + k, 2.0 + numbers.next());
            }
            for k in (first..border).take(coupled) {
                add(k % n, n + k, numbers.next());
                add(n + k, (3 * k) % n, numbers.next());
                add(n + k, n + (k + 1) % border, 0.3 * numbers.next());
            }
            let x: Vec<f64> = (0..n + border).map(|_| numbers.next()).collect();
            let (mut ax, mut bx) = (vec![0.0; n + border], vec![0.0; n + border]);
            a.multiply(&x, &mut ax);
            b.multiply(&x, &mut bx);
            let mut copy = a.clone();
            copy.copy_from(&a);
            a.factor().unwrap();
            a.solve(&mut ax);
            copy.factor().unwrap();
            copy.solve(&mut bx);
            for ((x, a), b) in x.iter().zip(&ax).zip(&bx) {
                assert!((x - a).abs() < 1e-11 && (x - b).abs() < 1e-11, "{coupled}: {x} {a} {b}");
            }
        }
    }
    let mut alone: Matrix = Matrix::new(&Structure::band(2, 1, 1, 2));
    (0..3).for_each(|i| alone.add(i, i, 1.0));
    assert_eq!(alone.factor().unwrap_err().index, 3);
}

/// Unknowns at the end that couple to nothing change no bit of the others, and one between that does is no end.
#[test]
fn unknowns_of_a_dense_matrix_that_stand_alone_are_divided() {
    let entry = |i: usize, j: usize| ((3 * i + 7 * j) % 11) as f64 - 4.0;
    for coupled in [0, 3, 5] {
        let (mut small, mut large) = (Dense::new(coupled), Dense::new(8));
        for i in 0..coupled {
            for j in 0..coupled {
                small.set(i, j, entry(i, j));
                large.set(i, j, entry(i, j));
            }
        }
        (coupled..8).for_each(|i| large.set(i, i, 4.0));
        small.factor().unwrap();
        large.factor().unwrap();
        let mut x: Vec<f64> = (0..8).map(|i| 1.0 / (1.0 + i as f64)).collect();
        let mut y = x.clone();
        small.solve(&mut x[..coupled]);
        x[coupled..].iter_mut().for_each(|x| *x /= 4.0);
        large.solve(&mut y);
        assert_eq!(x, y);
    }
    // The last is nothing.
    let mut singular = Dense::<f64>::new(2);
    singular.set(0, 0, 1.0);
    assert_eq!(singular.factor().unwrap_err().index, 1);
    let mut last = Dense::<f64>::new(3);
    [(0, 2), (2, 0), (1, 1)].into_iter().for_each(|(i, j)| last.set(i, j, 2.0));
    last.factor().unwrap();
    let mut x = [2.0, 4.0, 6.0];
    last.solve(&mut x);
    assert_eq!(x, [3.0, 2.0, 1.0]);
}
