//! Equilibria by Newton's method, and frequencies.

use flexion::linalg::vector::noise;
use flexion::linalg::{Mat3, Matrix, Structure, Vec3};
use flexion::multibody::shear::{Beam, NODE_VELOCITIES, VELOCITIES};
use flexion::section::Matrices;
use flexion::system::{Frame, Weights};
use nalgebra::DMatrix;

/// A beam with held unknowns and forces on the others, in space, and couples in the axes of the sections.
pub struct Chain {
    pub beam: Beam,
    pub q: Vec<f64>,
    pub fixed: Vec<bool>,
    pub forces: Vec<f64>,
}

/// n equal steps from 0 to the end.
pub fn equal(length: f64, n: usize) -> Vec<f64> {
    (0..=n).map(|i| length * i as f64 / n as f64).collect()
}

/// A straight beam along x with its height along y, clamped at its root.
pub fn cantilever(length: f64, elements: usize, section: Matrices) -> Chain {
    let root = Frame { position: Vec3::ZERO, rotation: Mat3::IDENTITY };
    Chain::clamped(Beam::straight(root, length, elements, section).unwrap())
}

impl Chain {
    pub fn free(beam: Beam) -> Chain {
        let n = beam.velocities();
        Chain { q: beam.initial().to_vec(), fixed: vec![false; n], forces: vec![0.0; n], beam }
    }

    /// A beam that is clamped at its first node.
    pub fn clamped(beam: Beam) -> Chain {
        let mut out = Chain::free(beam);
        out.fixed[..NODE_VELOCITIES].fill(true);
        out
    }

    pub fn tip(&self) -> Frame {
        self.beam.node(self.beam.nodes().len() - 1, &self.q)
    }

    /// Force and couple on the last node.
    pub fn load_tip(&mut self, force: Vec3, couple: Vec3) {
        let at = self.forces.len() - NODE_VELOCITIES;
        force.put(&mut self.forces, at);
        couple.put(&mut self.forces, at + 3);
    }

    pub fn residual(&self, factor: f64) -> Vec<f64> {
        let n = self.beam.velocities();
        let (rest, mut r) = (vec![0.0; n], vec![0.0; n]);
        self.beam.add_forces([&self.q, &rest, &rest], Vec3::ZERO, &mut r);
        r.iter_mut().zip(&self.forces).for_each(|(r, f)| *r -= factor * f);
        r.iter_mut().zip(&self.fixed).filter(|(_, fixed)| **fixed).for_each(|(r, _)| *r = 0.0);
        r
    }

    /// The tangent, with ones in the place of held unknowns.
    fn tangent(&self) -> Matrix {
        let (n, width) = (self.beam.velocities(), self.beam.half_bandwidth());
        let mut matrix = Matrix::new(&Structure::band(n, width, width, 0).cheaper());
        let rest = vec![0.0; n];
        self.beam.add_tangent(
            [&self.q, &rest, &rest],
            Vec3::ZERO,
            &Weights::new(0.0, 0.0, 1.0),
            |at, block| {
                for i in (0..VELOCITIES).filter(|i| !self.fixed[at + i]) {
                    for j in (0..VELOCITIES).filter(|j| !self.fixed[at + j]) {
                        matrix.add(at + i, at + j, block[i][j]);
                    }
                }
            },
        );
        (0..n).filter(|i| self.fixed[*i]).for_each(|i| matrix.add(i, i, 1.0));
        matrix
    }

    /// Solves for `factor` times the loads; gives the number of iterations, or nothing and leaves the configuration where Newton's
    /// method does not converge.
    pub fn solve(&mut self, factor: f64) -> Option<usize> {
        let start = self.q.clone();
        let mut last = f64::INFINITY;
        for iteration in 1..=25 {
            let mut d = self.residual(factor);
            let mut matrix = self.tangent();
            if matrix.factor().is_err() {
                break;
            }
            matrix.solve(&mut d);
            d.iter_mut().for_each(|d| *d = -*d);
            let mut to = self.q.clone();
            self.beam.retract(&self.q, &d, &mut to);
            self.q = to;
            let size = d.iter().fold(0.0, |a: f64, d| a.max(d.abs()));
            // Quadratic convergence ends in rounding.
            if size < 1e-12 || size < 1e-6 && size > 0.1 * last {
                return Some(iteration);
            }
            last = size;
        }
        self.q = start;
        None
    }

    /// Solves in steps of the load, which are halved where one is too large and doubled again; gives the number of iterations of all.
    pub fn load(&mut self, steps: usize) -> usize {
        let (mut factor, mut step, mut iterations) = (0.0, 1.0 / steps as f64, 0);
        while factor < 1.0 {
            let to = if factor + 1.01 * step > 1.0 { 1.0 } else { factor + step };
            match self.solve(to) {
                Some(count) => {
                    (factor, step, iterations) = (to, 2.0 * step, iterations + count);
                }
                None => step *= 0.5,
            }
            assert!(step > 1e-6, "no convergence from the load factor {factor} on");
        }
        iterations
    }

    /// ∂r/∂a, ∂r/∂v and ∂r/∂q of the unknowns that are not held, at rest.
    pub fn matrices(&self) -> [DMatrix<f64>; 3] {
        let n = self.beam.velocities();
        let free: Vec<usize> = (0..n).filter(|i| !self.fixed[*i]).collect();
        let rest = vec![0.0; n];
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|[a, v, q]| {
            let mut full = DMatrix::zeros(n, n);
            self.beam.add_tangent(
                [&self.q, &rest, &rest],
                Vec3::ZERO,
                &Weights::new(a, v, q),
                |at, block| {
                    for i in 0..VELOCITIES {
                        (0..VELOCITIES).for_each(|j| full[(at + i, at + j)] += block[i][j]);
                    }
                },
            );
            DMatrix::from_fn(free.len(), free.len(), |i, j| full[(free[i], free[j])])
        })
    }

    /// The angular frequencies at rest, ascending.
    pub fn frequencies(&self) -> Vec<f64> {
        let [m, _, k] = self.matrices();
        let l = m.cholesky().unwrap().l();
        let inner = l.solve_lower_triangular(&k).unwrap();
        let c = l.solve_lower_triangular(&inner.transpose()).unwrap();
        let symmetric: DMatrix<f64> = 0.5 * (&c + c.transpose());
        let mut squares: Vec<f64> = symmetric.symmetric_eigenvalues().iter().copied().collect();
        squares.sort_by(f64::total_cmp);
        squares.into_iter().map(|x| x.max(0.0).sqrt()).collect()
    }
}

/// Orders of convergence from one to the next of errors on meshes of twice the elements.
pub fn orders(errors: &[f64]) -> Vec<f64> {
    errors.windows(2).map(|e| (e[0] / e[1]).log2()).collect()
}

/// A symmetric matrix with the diagonal `scales` and couplings of up to a fraction of their means.
pub fn coupled(scales: [f64; 6], part: f64) -> [[f64; 6]; 6] {
    let x = noise(36, 5);
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let c = if i == j { 1.0 } else { part * x[6 * i.min(j) + i.max(j)] };
            c * (scales[i] * scales[j]).sqrt()
        })
    })
}
