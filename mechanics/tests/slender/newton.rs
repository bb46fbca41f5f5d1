//! Equilibria of a beam by Newton's method.

use flexion::linalg::{Matrix, Structure, Vec3};
use flexion::multibody::slender::{Beam, Load, Properties, Station, Triad};
use flexion::system::Weights;

/// The unknowns of a node that a clamp of a tangent along x holds. The length of r′ is the axial strain and not held.
pub const CLAMP: [usize; 6] = [0, 1, 2, 4, 5, 6];

/// A beam with held unknowns, loads at nodes and a configuration.
pub struct Statics {
    pub beam: Beam,
    pub q: Vec<f64>,
    pub fixed: Vec<bool>,
    pub loads: Vec<(usize, Load)>,
    /// Further constant forces on the unknowns.
    pub forces: Vec<f64>,
}

/// n equal steps from 0 to the end.
pub fn equal(length: f64, n: usize) -> Vec<f64> {
    (0..=n).map(|i| length * i as f64 / n as f64).collect()
}

/// A straight beam along x with n along y, clamped at its root.
pub fn cantilever(length: f64, elements: usize, section: Properties) -> Statics {
    let root =
        Station { position: Vec3([0.0; 3]), tangent: Vec3([1.0, 0.0, 0.0]), normal: Vec3([0.0, 1.0, 0.0]) };
    Statics::clamped(Beam::straight(root, length, elements, section).unwrap())
}

impl Statics {
    /// A beam that is clamped at its first node.
    pub fn clamped(beam: Beam) -> Statics {
        let n = beam.velocities();
        let mut out = Statics {
            q: beam.initial().to_vec(),
            fixed: vec![false; n],
            loads: Vec::new(),
            forces: vec![0.0; n],
            beam,
        };
        out.hold(0, &CLAMP);
        out
    }

    pub fn last(&self) -> usize {
        self.beam.elements().len()
    }

    /// Holds unknowns of a node.
    pub fn hold(&mut self, node: usize, unknowns: &[usize]) {
        unknowns.iter().for_each(|k| self.fixed[8 * node + k] = true);
    }

    pub fn tip(&self) -> (Vec3, Triad) {
        self.beam.node(self.last(), &self.q)
    }

    /// Forces of strain less `factor` times the loads; held unknowns read 0.
    pub fn residual(&self, factor: f64) -> Vec<f64> {
        let n = self.beam.velocities();
        let (rest, mut r) = (vec![0.0; n], vec![0.0; n]);
        self.beam.add_forces(&self.q, &rest, &rest, &mut r);
        r.iter_mut().zip(&self.forces).for_each(|(r, f)| *r -= factor * f);
        for (node, load) in &self.loads {
            let forces = load.forces(&self.beam.node(*node, &self.q).1);
            (0..7).for_each(|k| r[8 * node + k] -= factor * forces[k]);
        }
        r.iter_mut().zip(&self.fixed).filter(|(_, fixed)| **fixed).for_each(|(r, _)| *r = 0.0);
        r
    }

    /// The tangent, with ones in the place of held unknowns.
    pub fn tangent(&self, factor: f64) -> Matrix {
        let (n, width) = (self.beam.velocities(), self.beam.half_bandwidth());
        let mut matrix = Matrix::new(&Structure::band(n, width, width, 0).cheaper());
        let rest = vec![0.0; n];
        let mut add = |i: usize, j: usize, x: f64| {
            if !self.fixed[i] && !self.fixed[j] {
                matrix.add(i, j, x);
            }
        };
        self.beam.add_tangent(&self.q, &rest, &rest, &Weights::new(0.0, 0.0, 1.0), |at, block| {
            (0..15).for_each(|i| (0..15).for_each(|j| add(at + i, at + j, block[i][j])));
        });
        for (node, load) in &self.loads {
            let block = load.derivative(&self.beam.node(*node, &self.q).1);
            (0..7).for_each(|i| (0..7).for_each(|j| add(8 * node + i, 8 * node + j, -factor * block[i][j])));
        }
        (0..n).filter(|i| self.fixed[*i]).for_each(|i| matrix.add(i, i, 1.0));
        matrix
    }

    /// Solves for `factor` times the loads; gives the number of iterations.
    pub fn solve(&mut self, factor: f64) -> usize {
        let mut last = f64::INFINITY;
        for iteration in 1..=60 {
            let mut d = self.residual(factor);
            let mut matrix = self.tangent(factor);
            matrix.factor().unwrap();
            matrix.solve(&mut d);
            d.iter_mut().for_each(|d| *d = -*d);
            let mut to = self.q.clone();
            self.beam.retract(&self.q, &d, &mut to);
            self.q = to;
            let size = d.iter().fold(0.0, |a: f64, d| a.max(d.abs()));
            // Quadratic convergence ends in rounding.
            if size < 1e-13 || size < 1e-7 && size > 0.1 * last {
                return iteration;
            }
            last = size;
        }
        panic!("no convergence at the load factor {factor}: {last:e}");
    }

    /// Solves in equal steps of the load; gives the number of iterations of all.
    pub fn load(&mut self, steps: usize) -> usize {
        (1..=steps).map(|k| self.solve(k as f64 / steps as f64)).sum()
    }
}

/// Largest difference of the components.
pub fn distance(a: Vec3, b: Vec3) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max)
}

/// Orders of convergence from one to the next of errors on meshes of twice the elements.
pub fn orders(errors: &[f64]) -> Vec<f64> {
    errors.windows(2).map(|e| (e[0] / e[1]).log2()).collect()
}

/// Orders from solutions on meshes of twice the elements alone, by the ratios of their differences.
pub fn orders_of(tips: &[Vec3]) -> Vec<f64> {
    orders(&tips.windows(2).map(|t| distance(t[0], t[1])).collect::<Vec<_>>())
}
