//! Forces and tangent of an element against automatic differentiation of its energies, which are written anew from the
//! definitions: rotation matrices, derivatives by the arc length, and no formula for a variation or for the tangent of a rotation.

use super::derivatives::{damping, far, general, mass, stiffness};
use super::nilpotent::{
    Matrix, Number, Vector, apply, logarithm, number, of_quaternion, product, rotation, skew, small_rotation,
    sum, transpose, vector,
};
use flexion::multibody::shear::{Beam, Element, Motion};
use flexion::section::Matrix6;
use flexion::system::Weights;

/// Unknowns of an element of four nodes.
const N: usize = 24;

/// Places and weights of Lobatto's rule of four points on [0, 1].
fn lobatto() -> [(f64, f64); 4] {
    let inner = 0.5 * (1.0 - 0.2_f64.sqrt());
    [(0.0, 1.0 / 12.0), (inner, 5.0 / 12.0), (1.0 - inner, 5.0 / 12.0), (1.0, 1.0 / 12.0)]
}

type Strain = [Number; 6];

/// Position and axes of the nodes, moved by d.
fn moved(q: &[f64], d: &[Number; N]) -> [(Vector, Matrix); 4] {
    std::array::from_fn(|i| {
        let (q, d) = (&q[7 * i..], &d[6 * i..]);
        let place = sum(vector([q[0], q[1], q[2]]), number(1.0), [d[0], d[1], d[2]]);
        let turned = small_rotation([d[3], d[4], d[5]]);
        (place, product(of_quaternion([q[3], q[4], q[5], q[6]]), turned))
    })
}

/// Places and weights of Gauss' rule of three points on [0, 1].
fn gauss() -> [(f64, f64); 3] {
    let outer = 0.5 * (1.0 - 0.6_f64.sqrt());
    [(outer, 5.0 / 18.0), (0.5, 8.0 / 18.0), (1.0 - outer, 5.0 / 18.0)]
}

/// Γ and κ at the place z of an element of the length h.
fn strain(nodes: &[(Vector, Matrix); 4], z: f64, h: f64) -> Strain {
    // z + e₃/h: the coefficient of e₃ is the derivative by the arc length.
    let mut z = number(z);
    z.0[4] = 1.0 / h;
    let back = transpose(nodes[2].1);
    let (mut place, mut turn) = ([number(0.0); 3], [number(0.0); 3]);
    for (i, (own, _)) in lobatto().into_iter().enumerate() {
        let others = lobatto().into_iter().filter(|(other, _)| *other != own);
        let l =
            others.fold(number(1.0), |l, (other, _)| l * (z - number(other)) * number(1.0 / (own - other)));
        place = sum(place, l, nodes[i].0);
        if i != 2 {
            turn = sum(turn, l, logarithm(product(back, nodes[i].1)));
        }
    }
    let axes = product(nodes[2].1, rotation(turn));
    let inward = transpose(axes).map(|row| row.map(plain));
    let slope = apply(inward, place.map(Number::third));
    let change = product(inward, axes.map(|row| row.map(Number::third)));
    [slope[0], slope[1], slope[2], change[2][1], change[0][2], change[1][0]]
}

/// The part without e₃.
fn plain(x: Number) -> Number {
    let [a, b, c, d, ..] = x.0;
    Number([a, b, c, d, 0.0, 0.0, 0.0, 0.0])
}

fn form(a: &Matrix6, x: &Strain, y: &Strain) -> Number {
    let mut out = number(0.0);
    for i in 0..6 {
        for j in 0..6 {
            out = out + x[i] * number(a[i][j]) * y[j];
        }
    }
    out
}

fn initial(beam: &Beam) -> [Strain; 3] {
    let nodes = moved(beam.initial(), &[number(0.0); N]);
    gauss().map(|(z, _)| strain(&nodes, z, beam.elements()[0].length()))
}

/// The strain energy at q ⊞ d.
fn energy(beam: &Beam, q: &[f64], d: &[Number; N], initial: &[Strain; 3]) -> Number {
    let h = beam.elements()[0].length();
    let nodes = moved(q, d);
    let mut out = number(0.0);
    for ((z, weight), rest) in gauss().into_iter().zip(initial) {
        let now = strain(&nodes, z, h);
        let e: Strain = std::array::from_fn(|k| now[k] - rest[k]);
        out = out + number(0.5 * weight * h) * form(&stiffness(z * h), &e, &e);
    }
    out
}

/// The unit vectors along `i` and `j` with the factors e₁ and e₂.
fn units(i: usize, j: usize) -> [Number; N] {
    std::array::from_fn(|k| {
        let unit = |l: usize| f64::from(u8::from(k == l));
        Number([0.0, unit(i), unit(j), 0.0, 0.0, 0.0, 0.0, 0.0])
    })
}

fn first(beam: &Beam) -> &Element {
    &beam.elements()[0]
}

fn head<const K: usize>(x: &[f64]) -> &[f64; K] {
    x[..K].try_into().unwrap()
}

fn forces(beam: &Beam, q: &[f64], v: &[f64], a: &[f64]) -> [f64; N] {
    let mut out = [0.0; N];
    first(beam).add_forces(&Motion { q: head(q), v: head(v), a: head(a) }, &mut out);
    out
}

#[test]
fn forces_and_tangent_are_the_derivatives_of_the_strain_energy() {
    let beam = general(false);
    let (q, ..) = far(&beam, 53);
    let initial = initial(&beam);
    let zero = [0.0; N];
    let force = forces(&beam, &q, &zero, &zero);
    let mut tangent = [[0.0; N]; N];
    let motion = Motion { q: head(&q), v: &zero, a: &zero };
    first(&beam).add_tangent(&motion, &Weights::new(0.0, 0.0, 1.0), &mut tangent);
    let largest = tangent.iter().flatten().fold(0.0, |a: f64, x| a.max(x.abs()));
    let found = first(&beam).strain_energy(head(&q));
    for i in 0..N {
        for j in 0..N {
            let [value, gradient, _, second, ..] = energy(&beam, &q, &units(i, j), &initial).0;
            assert!((found - value).abs() < 1e-13 * value);
            assert!((force[i] - gradient).abs() < 1e-13 * largest, "{i}: {} for {gradient}", force[i]);
            // The tangent is that of forces on velocities: with ∂U/∂d = T(d)ᵀ f it has −½ δφ × m beside the second derivative.
            let (node, other) = (i / 6, j / 6);
            let mut expected = second;
            if node == other && i % 6 >= 3 && j % 6 >= 3 {
                let (k, l) = (i % 3, j % 3);
                let moment = &force[6 * node + 3..];
                let cross = match (3 + k - l) % 3 {
                    1 => -moment[3 - k - l],
                    2 => moment[3 - k - l],
                    _ => 0.0,
                };
                expected -= 0.5 * cross;
            }
            let error = (tangent[i][j] - expected).abs() / largest;
            assert!(error < 1e-13, "({i}, {j}): {} for {expected}", tangent[i][j]);
        }
    }
}

#[test]
fn damping_has_the_stresses_of_the_rates_of_the_strains() {
    let (beam, elastic) = (general(true), general(false));
    let (q, v, _) = far(&beam, 59);
    let zero = [0.0; N];
    let h = first(&beam).length();
    let (with, without) = (forces(&beam, &q, &v, &zero), forces(&elastic, &q, &v, &zero));
    let mut dissipated = 0.0;
    for i in 0..N {
        // e₁ along the motion, e₂ along the unknown.
        let mut d = units(N, i);
        (0..N).for_each(|k| d[k].0[1] = v[k]);
        let nodes = moved(&q, &d);
        let mut expected = 0.0;
        dissipated = 0.0;
        for (z, weight) in gauss() {
            let now = strain(&nodes, z, h);
            let (rate, change) = (now.map(|e| number(e.0[1])), now.map(|e| number(e.0[2])));
            expected += weight * h * form(&damping(z * h), &rate, &change).0[0];
            dissipated += weight * h * form(&damping(z * h), &rate, &rate).0[0];
        }
        let found = with[i] - without[i];
        assert!((found - expected).abs() < 1e-12 * (1.0 + with[i].abs()), "{i}: {found} for {expected}");
    }
    let power = first(&beam).viscous_power(head(&q), head(&v));
    assert!((power - dissipated).abs() < 1e-12 * dissipated && dissipated > 0.0);
}

/// The kinetic energy at q ⊞ d and the rates ḋ, of the sections at the nodes by Lobatto's rule.
fn kinetic(beam: &Beam, q: &[f64], d: &[Number; N], rates: &[Number; N]) -> Number {
    let h = beam.elements()[0].length();
    let mut out = number(0.0);
    for (i, (_, axes)) in moved(q, d).into_iter().enumerate() {
        let turn = [d[6 * i + 3], d[6 * i + 4], d[6 * i + 5]];
        let (rate, spin) = ([0, 1, 2].map(|k| rates[6 * i + k]), [3, 4, 5].map(|k| rates[6 * i + k]));
        // exp(d)⁻¹ d(exp d)/dt, with t as e₃.
        let along: Vector = std::array::from_fn(|k| turn[k] + third(spin[k]));
        let change = small_rotation_to_third_order(along).map(|row| row.map(Number::third));
        let back = transpose(small_rotation_to_third_order(turn));
        let w = product(back, change);
        let u = apply(transpose(axes), rate);
        let velocities = [u[0], u[1], u[2], w[2][1], w[0][2], w[1][0]];
        let (z, weight) = lobatto()[i];
        let of = mass(z * h);
        out = out + number(0.5 * weight * h) * form(&of, &velocities, &velocities);
    }
    out
}

/// e₃ x
fn third(x: Number) -> Number {
    let [a, b, c, d, ..] = x.0;
    Number([0.0, 0.0, 0.0, 0.0, a, b, c, d])
}

fn small_rotation_to_third_order(x: Vector) -> Matrix {
    let (first, once) = (small_rotation(x), skew(x));
    let cube = product(once, product(once, once));
    std::array::from_fn(|i| std::array::from_fn(|j| first[i][j] + number(1.0 / 6.0) * cube[i][j]))
}

/// d/dt ∂T/∂ḋ − ∂T/∂d at d = 0, where Ω = ḋ and Ω̇ = d̈.
#[test]
fn forces_of_inertia_are_those_of_lagranges_equations() {
    let beam = general(false);
    let (q, v, a) = far(&beam, 61);
    let zero = [0.0; N];
    let (with, without) = (forces(&beam, &q, &v, &a), forces(&beam, &q, &zero, &zero));
    let largest = with.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    for i in 0..N {
        // e₁ along the rate i; e₂ along the motion, in d by v and in ḋ by a.
        let rate: [Number; N] = std::array::from_fn(|k| {
            let unit = f64::from(u8::from(k == i));
            Number([v[k], unit, a[k], 0.0, 0.0, 0.0, 0.0, 0.0])
        });
        let along: [Number; N] = std::array::from_fn(|k| Number([0.0, 0.0, v[k], 0.0, 0.0, 0.0, 0.0, 0.0]));
        let momentum_rate = kinetic(&beam, &q, &along, &rate).0[3];
        let rates: [Number; N] = std::array::from_fn(|k| number(v[k]));
        let [value, by_place, ..] = kinetic(&beam, &q, &units(i, N), &rates).0;
        let expected = momentum_rate - by_place;
        let found = with[i] - without[i];
        assert!((found - expected).abs() < 1e-13 * largest, "{i}: {found} for {expected}");
        let energy = first(&beam).kinetic_energy(head(&q), head(&v));
        assert!((energy - value).abs() < 1e-13 * value);
    }
}
