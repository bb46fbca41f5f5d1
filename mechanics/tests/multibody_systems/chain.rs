//! Chains and trees of bodies: the cost of a step is linear, and the numbers are those of a dense matrix.

use super::{GRAVITY, odd_body, wave};
use flexion::integrator::{Counters, GeneralizedAlpha, Integrator, Radau, Span, Tolerance};
use flexion::linalg::{Matrix, Structure, Vec3};
use flexion::multibody::{Body, Kind, Model, Multibody, Part};
use flexion::system::{Dynamics, RowWeights, Set, Size, State, VisitRow, Weights};

/// Pendulums of length 1 on a line along x, hinged about axes that alternate.
fn chain(n: usize) -> Multibody {
    let mut model = Model::new().with_gravity([0.0, 0.0, -GRAVITY]);
    let mut last = Part::Ground;
    for i in 0..n {
        let body = Body::new(&format!("link {i}"), 1.0, [0.01, 0.1, 0.1]).at([i as f64 + 0.5, 0.0, 0.0]);
        let next = model.body(body);
        let axis = if i % 2 == 0 { [0.0, 1.0, 0.0] } else { [0.0, 0.6, 0.8] };
        model
            .join(
                &format!("hinge {i}"),
                Kind::Revolute,
                [last, next],
                Vec3([i as f64, 0.0, 0.0]),
                (Vec3(axis), None),
            )
            .unwrap();
        last = next;
    }
    Multibody::new(model).unwrap()
}

/// A tree of odd bodies with a closed loop and a loop over the ground.
fn tree() -> Multibody {
    let mut model = Model::new().with_gravity([0.0, 0.0, -GRAVITY]);
    let bodies: Vec<Part> = (0..14).map(|i| model.body(odd_body(&format!("body {i}"), i as f64))).collect();
    let mut join = |name: &str, kind, parts, k: usize| {
        let axis = ([wave(k, 0.1), wave(k, 1.2), wave(k, 2.3)], None);
        model.join(name, kind, parts, [wave(k, 3.0), wave(k, 4.0), wave(k, 5.0)], axis).unwrap();
    };
    join("ground", Kind::Spherical, [Part::Ground, bodies[0]], 0);
    for i in 1..bodies.len() {
        join(&format!("joint {i}"), Kind::Revolute, [bodies[(i - 1) / 2], bodies[i]], i);
    }
    join("loop", Kind::Spherical, [bodies[7], bodies[13]], 40);
    join("other ground", Kind::Universal, [bodies[10], Part::Ground], 41);
    Multibody::new(model).unwrap()
}

/// The same system with dense matrices.
struct Dense(Multibody);

impl Dynamics for Dense {
    fn size(&self) -> Size {
        self.0.size()
    }
    fn scales(&self) -> &[f64] {
        self.0.scales()
    }
    fn is_vector_space(&self) -> bool {
        false
    }
    fn retract(&self, q: &[f64], d: &[f64], out: &mut [f64]) {
        self.0.retract(q, d, out);
    }
    fn rate(&self, from: &[f64], d: &[f64], v: &[f64], out: &mut [f64]) {
        self.0.rate(from, d, v, out);
    }
    fn residual(&mut self, s: &State, r: &mut [f64]) {
        self.0.residual(s, r);
    }
    fn rows(&self) -> &[Set] {
        self.0.rows()
    }
    fn constraint(&mut self, s: &State, c: RowWeights, g: &mut [f64]) {
        self.0.constraint(s, c, g);
    }
    fn jacobian(&mut self, s: &State, visit: &mut VisitRow<'_>) {
        self.0.jacobian(s, visit);
    }
    fn tangent(&mut self, s: &State, w: Weights<'_>, out: &mut Matrix) {
        self.0.tangent(s, w, out);
    }
}

fn steps(
    system: &mut dyn Dynamics,
    mut from: State,
    method: &dyn Integrator,
    h: f64,
    n: usize,
) -> (State, Counters) {
    let mut method = method.start(system, &mut from, h).unwrap();
    let mut to = from.clone();
    for _ in 0..n {
        method.step(system, &from, Span::new(from.t, h), &mut to).unwrap();
        method.accept(&from, &to);
        std::mem::swap(&mut from, &mut to);
    }
    (from, method.counters())
}

fn methods() -> [(Box<dyn Integrator>, &'static str); 3] {
    [
        (Box::new(GeneralizedAlpha::chung_hulbert(0.8).unwrap()), "index 3"),
        (Box::new(GeneralizedAlpha::chung_hulbert(0.8).unwrap().stabilized()), "stabilized"),
        (Box::new(Radau::new(Tolerance::uniform(1e-9)).unwrap()), "radau"),
    ]
}

/// Accelerations, increments and multipliers of all methods, for a chain and for a tree with loops.
#[test]
fn the_band_gives_the_numbers_of_a_dense_matrix() {
    for (what, system) in [("chain", chain(25)), ("tree", tree())] {
        assert!(
            matches!(system.structure(1), Structure::Ordered { .. }),
            "{what}: {:?}",
            system.structure(1)
        );
        let start = system.initial();
        for ((banded, name), (dense, _)) in methods().into_iter().zip(methods()) {
            let a = steps(&mut system.clone(), start.clone(), banded.as_ref(), 1e-3, 3).0;
            let b = steps(&mut Dense(system.clone()), start.clone(), dense.as_ref(), 1e-3, 3).0;
            for (x, y, of) in [(&a.q, &b.q, "q"), (&a.v, &b.v, "v"), (&a.lambda, &b.lambda, "λ")] {
                let size = y.iter().fold(1.0_f64, |m, y| m.max(y.abs()));
                let far = x.iter().zip(y).fold(0.0_f64, |m, (x, y)| m.max((x - y).abs()));
                // The dense solution of the tree is right to 2e-12, and index 3 divides the rounding of g by h².
                let allowed = match of {
                    "q" => 1e-11,
                    "v" => 1e-9,
                    _ => 1e-7,
                };
                assert!(far < allowed * size, "{what}, {name}, {of}: {far:e} of {size:e}");
            }
        }
    }
}

/// One solution with the matrix of a step, against the dense one, to rounding.
#[test]
fn the_matrix_of_a_step_is_solved_to_rounding() {
    for (what, mut system, allowed) in [("chain", chain(200), 1e-12), ("tree", tree(), 1e-12)] {
        let mut s = system.initial();
        GeneralizedAlpha::newmark(0.25, 0.5).unwrap().start(&mut system, &mut s, 1e-3).unwrap();
        let (n, m) = (s.v.len(), s.lambda.len());
        let fill = |system: &mut Multibody, structure: &Structure| {
            let mut matrix = Matrix::<f64>::new(structure);
            system.tangent(&s, Weights::new(1.0, 5e-4, 2.5e-7), &mut matrix);
            system.jacobian(&s, &mut |row, velocities, entries| {
                for (&j, &x) in velocities.iter().zip(entries) {
                    matrix.add(n + row, j, x);
                    matrix.add(j, n + row, -x);
                }
            });
            matrix
        };
        let structure = system.structure(1);
        let mut banded = fill(&mut system, &structure);
        let mut dense = fill(&mut system, &Structure::dense(n + m));
        let entries = dense.clone();
        let x: Vec<f64> = (0..n + m).map(|i| wave(i, 0.2)).collect();
        let mut right = vec![0.0; n + m];
        banded.multiply(&x, &mut right);
        banded.factor().unwrap();
        dense.factor().unwrap();
        let error = |matrix: &mut Matrix| {
            let (mut y, mut product) = (right.clone(), vec![0.0; n + m]);
            matrix.solve(&mut y);
            entries.multiply(&y, &mut product);
            let far = |a: &[f64], b: &[f64]| {
                let size = b.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
                a.iter().zip(b).fold(0.0_f64, |m, (x, y)| m.max((x - y).abs())) / size
            };
            [far(&y, &x), far(&product, &right)]
        };
        let (banded, dense) = (error(&mut banded), error(&mut dense));
        println!("{what}: error and residual {banded:?}, dense {dense:?}");
        assert!(banded[1] < allowed && banded[0] < 1e-12 + 10.0 * dense[0], "{what}: {banded:?} {dense:?}");
    }
}

/// The work of a step: entries that are stored, and iterations, which do not grow.
#[test]
fn the_cost_of_a_step_is_linear_in_the_pendulums() {
    let stored = |n: usize| {
        let matrix: Matrix = Matrix::new(&chain(n).structure(1));
        matrix.storage().entries().len()
    };
    // 11 unknowns a pendulum in rows of 3·16 + 1.
    assert_eq!([50, 100, 200].map(stored), [50, 100, 200].map(|n| 11 * n * 49));
    for (method, name) in methods() {
        let iterations = [50, 200].map(|n| {
            let mut system = chain(n);
            let start = system.initial();
            steps(&mut system, start, method.as_ref(), 1e-3, 10).1.iterations
        });
        println!("{name}: {iterations:?} iterations in 10 steps of 50 and 200 pendulums");
        assert!(iterations[1] <= iterations[0] + 2, "{name}: {iterations:?}");
    }
}
