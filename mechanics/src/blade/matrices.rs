//! Matrices of a blade about its steady state, and the iteration that finds the state.

use super::element::{Functions, Local, Rotation, add_inertia};
use super::mesh::{CLAMPED, Element, LOCAL, Mesh, hermite, quadratic};
use super::model::{Model, Setting, StrainEnergy};
use super::tension::Tension;
use super::terms::form;
use crate::linalg::Matrix;
use std::sync::Arc;

/// Iterations of Newton's method before a speed is approached in smaller increments.
const ITERATIONS: usize = 25;

/// Increment, over the scale of its unknown, at which the next one is below rounding.
const SMALL: f64 = 1e-8;

/// Increment at which the matrices are those of the state already.
const TINY: f64 = 1e-15;

/// Smallest increment of the speed, over the speed.
const FINEST: f64 = 1.0 / 256.0;

/// The parts of a blade's model that do not change with the speed, and its matrices at one speed.
#[derive(Clone, Debug)]
pub struct Matrices {
    mesh: Arc<Mesh>,
    tension: Arc<Tension>,
    scales: Arc<[f64]>,
    setting: Setting,
    model: Model,
    /// M about the steady state.
    pub mass: Matrix,
    /// C about the steady state.
    pub gyroscopic: Matrix,
    /// K about the steady state.
    pub stiffness: Matrix,
    /// ∂(U − T₀)/∂q at the state last assembled.
    force: Vec<f64>,
}

impl Matrices {
    /// Matrices of zeros.
    pub fn new(mesh: Mesh, setting: Setting, model: Model, tension: Tension) -> Matrices {
        let matrix = Matrix::new(&mesh.structure());
        let force = vec![0.0; mesh.len()];
        Matrices {
            mass: matrix.clone(),
            gyroscopic: matrix.clone(),
            stiffness: matrix,
            force,
            scales: mesh.scales().into(),
            mesh: Arc::new(mesh),
            tension: Arc::new(tension),
            setting,
            model,
        }
    }

    /// The mesh.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Size by which each unknown is measured.
    pub fn scales(&self) -> &[f64] {
        &self.scales
    }

    /// Assembles force and matrices at the speed and the state `q` of the exact model; a straight blade is
    /// straight.
    pub fn assemble(&mut self, speed: f64, q: &[f64]) {
        let rotation = self.rotation(speed);
        self.force.fill(0.0);
        for matrix in [&mut self.mass, &mut self.gyroscopic, &mut self.stiffness] {
            matrix.clear();
        }
        for (element, tension) in self.mesh.elements.iter().zip(&self.tension.at) {
            let mut local = Local::new();
            let at = element.gather(q);
            let (pitch, model) = (rotation.pitch, &self.model);
            match self.model.strain_energy.terms() {
                None => element.add_exact_strain(&at, pitch, model, &mut local),
                Some(terms) => {
                    element.add_straight_strain(pitch, speed * speed, tension, terms, model, &mut local);
                }
            }
            self.add_masses(element, &rotation, &at, &mut local);
            for (i, &row) in element.unknowns.iter().enumerate().filter(|(_, row)| **row != CLAMPED) {
                self.force[row] += local.force[i];
                for (j, &column) in element.unknowns.iter().enumerate().filter(|(_, c)| **c != CLAMPED) {
                    self.mass.add(row, column, local.mass[i][j]);
                    self.stiffness.add(row, column, local.stiffness[i][j]);
                    if self.model.gyroscopic {
                        self.gyroscopic.add(row, column, local.gyroscopic[i][j]);
                    }
                }
            }
        }
    }

    /// Adds the inertia of an element, and of the body at its outer end.
    fn add_masses(&self, element: &Element, rotation: &Rotation, at: &[f64; LOCAL], out: &mut Local) {
        for point in &element.points {
            let (s, w) = (&point.section, point.weight);
            let inertia = (w * s.mass, [0.0, w * s.chord_inertia, w * s.flap_inertia]);
            let angle = rotation.pitch + s.twist;
            add_inertia(&Functions::of(point), point.x, angle, inertia, rotation, &self.model, at, out);
        }
        let body = element.body;
        if body.mass > 0.0 || body.inertia > 0.0 {
            let h = element.ends[1] - element.ends[0];
            let f = Functions { n: hermite(1.0, h), m: quadratic(1.0, h) };
            // Second moments P along the axes give moments of inertia 2P about them.
            let inertia = (body.mass, [0.5 * body.inertia; 3]);
            add_inertia(&f, element.ends[1], rotation.pitch, inertia, rotation, &self.model, at, out);
        }
    }

    /// xᵀKx of each vector with the stiffness K at `q` and `speed`, strain by strain.
    pub fn stiffness_forms(&self, speed: f64, q: &[f64], vectors: &[Vec<f64>]) -> Vec<f64> {
        let (rotation, square) = (self.rotation(speed), speed * speed);
        let mut out = vec![0.0; vectors.len()];
        for (element, tension) in self.mesh.elements.iter().zip(&self.tension.at) {
            let at = element.gather(q);
            let (pitch, model) = (rotation.pitch, &self.model);
            let x: Vec<[f64; LOCAL]> = vectors.iter().map(|x| element.gather(x)).collect();
            match self.model.strain_energy.terms() {
                None => element.exact_forms(&at, pitch, model, &x, &mut out),
                Some(terms) => element.straight_forms(pitch, square, tension, terms, model, &x, &mut out),
            }
            let mut local = Local::new();
            self.add_masses(element, &rotation, &at, &mut local);
            for (x, out) in x.iter().zip(&mut out) {
                *out += form(x, |i, j| local.stiffness[i][j]);
            }
        }
        out
    }

    /// The rotation at a speed.
    fn rotation(&self, speed: f64) -> Rotation {
        let (sin, cos) = libm::sincos(self.setting.precone);
        Rotation {
            vector: [speed * sin, 0.0, speed * cos],
            hub_radius: self.setting.hub_radius,
            pitch: self.setting.pitch,
        }
    }

    /// Moves `q` from the steady state at speed `from` to the one at `to`, assembled; the largest speed reached
    /// if there is none.
    pub fn follow(&mut self, from: f64, to: f64, q: &mut [f64]) -> Result<(), f64> {
        if self.model.strain_energy != StrainEnergy::Exact {
            self.assemble(to, q);
            return Ok(());
        }
        let (mut reached, mut part) = (from, to - from);
        let mut trial = q.to_vec();
        loop {
            let goal = if (to - reached).abs() <= part.abs() * (1.0 + 1e-9) { to } else { reached + part };
            trial.copy_from_slice(q);
            if self.newton(goal, &mut trial) {
                q.copy_from_slice(&trial);
                reached = goal;
                if goal == to {
                    return Ok(());
                }
            } else {
                part *= 0.5;
                if part.abs() < FINEST * (to - from).abs() || part == 0.0 {
                    return Err(reached);
                }
            }
        }
    }

    /// Moves `q`, which is near the steady state at a speed, to it, assembled; `false` if it is not near enough, or if there is no
    /// steady state.
    pub fn settle(&mut self, speed: f64, q: &mut [f64]) -> bool {
        self.model.strain_energy == StrainEnergy::Exact && self.newton(speed, q)
    }

    /// Newton's method at one speed; leaves the matrices of the state it finds.
    fn newton(&mut self, speed: f64, q: &mut [f64]) -> bool {
        let mut solver = self.stiffness.clone();
        for _ in 0..ITERATIONS {
            self.assemble(speed, q);
            solver.clone_from(&self.stiffness);
            let mut step: Vec<f64> = self.force.iter().map(|f| -f).collect();
            if solver.factor().is_err() {
                return false;
            }
            solver.solve(&mut step);
            let size =
                step.iter().zip(&*self.scales).fold(0.0_f64, |most, (d, scale)| most.max((d / scale).abs()));
            // NaN is refused too.
            if !(size < 10.0) {
                return false;
            }
            // The tangent is not valid for a rotation of more than half a radian in one iteration.
            let factor = (0.5 / size).min(1.0);
            for (q, d) in q.iter_mut().zip(&step) {
                *q += factor * d;
            }
            if size < TINY {
                return true;
            }
            if size < SMALL {
                self.assemble(speed, q);
                return true;
            }
        }
        false
    }

    /// Strain energy of the exact model at `q`, for tests of its derivatives.
    #[cfg(test)]
    pub fn strain_energy(&self, q: &[f64]) -> f64 {
        let of = |e: &Element| e.exact_energy(&e.gather(q), self.setting.pitch, &self.model);
        self.mesh.elements.iter().map(of).sum()
    }

    /// ∂(U − T₀)/∂q as last assembled.
    #[cfg(test)]
    pub fn force(&self) -> &[f64] {
        &self.force
    }
}
