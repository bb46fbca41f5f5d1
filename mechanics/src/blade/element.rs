//! Force and tangent of one element of a blade that rotates steadily, and its mass and gyroscopic matrices.
//!
//! With q the unknowns in the blade's frame, which rotates with Ω = Ω (sin β, 0, cos β), T = T₂ + T₁ + T₀ by
//! degree in the velocities, and
//!
//! ```text
//! f = ∂(U − T₀)/∂q,   K = ∂f/∂q,   M = ∂²T₂/∂q̇²,   C = ∂²T₁/∂q̇∂q − (∂²T₁/∂q̇∂q)ᵀ
//! ```
//!
//! A mass m at r and a second moment P of mass along a unit axis d(q) of the section (t, d₂ or d₃) give
//!
//! ```text
//! M = m δ + P d_i·d_j,    C = 2m e_i·(Ω×e_j) + 2P d_i·(Ω×d_j),    T₀ = ½m |Ω×r|² + ½P |Ω×d|²
//! ```
//!
//! where d_i = ∂d/∂q_i. Propeller moment and spin softening are in the second derivatives of T₀.

use super::frame::{Tangent, axes, strains};
use super::jet::Jet;
use super::mesh::{Element, LOCAL, Point, SAMPLES, hermite};
use super::model::Model;
use crate::linalg::vector::{cross, inner};
use crate::section::BladeResultants;

/// Block of an element.
pub type Block = [[f64; LOCAL]; LOCAL];

/// Force and matrices of an element.
#[derive(Clone, Debug)]
pub struct Local {
    /// ∂(U − T₀)/∂q
    pub force: [f64; LOCAL],
    /// ∂²(U − T₀)/∂q²
    pub stiffness: Block,
    /// M
    pub mass: Block,
    /// C
    pub gyroscopic: Block,
}

impl Local {
    /// Zero.
    pub fn new() -> Local {
        let zero = [[0.0; LOCAL]; LOCAL];
        Local { force: [0.0; LOCAL], stiffness: zero, mass: zero, gyroscopic: zero }
    }
}

/// The rotation, as seen in the blade's frame.
#[derive(Clone, Copy, Debug)]
pub struct Rotation {
    /// Ω [rad/s].
    pub vector: [f64; 3],
    /// Distance a of the root along the blade's axis [m].
    pub hub_radius: f64,
    /// Pitch [rad].
    pub pitch: f64,
}

/// Place and orientation of a section as functions of the element's unknowns.
#[derive(Clone, Copy, Debug)]
pub struct Functions {
    /// Hermite functions, their first and second derivatives.
    pub n: [[f64; 4]; 3],
    /// Functions of the torsion and their first derivatives.
    pub m: [[f64; 3]; 2],
}

impl Functions {
    /// At a quadrature point.
    pub fn of(point: &Point) -> Functions {
        Functions { n: point.n, m: point.m }
    }

    /// Derivative `d` of u, v, w.
    pub fn field(&self, q: &[f64; LOCAL], d: usize) -> [f64; 3] {
        std::array::from_fn(|f| (0..4).map(|k| self.n[d][k] * q[4 * f + k]).sum())
    }

    /// Derivative `d` of φ.
    pub fn torsion(&self, q: &[f64; LOCAL], d: usize) -> f64 {
        (0..3).map(|k| self.m[d][k] * q[12 + k]).sum()
    }

    /// For an unknown: numbers among (u′, v′, w′, u″, v″, w″, φ, φ′) it moves, and by how much.
    fn of_strains(&self, i: usize) -> [(usize, f64); 2] {
        match (i / 4, i % 4) {
            (3, k) => [(6, self.m[0][k]), (7, self.m[1][k])],
            (f, k) => [(f, self.n[1][k]), (3 + f, self.n[2][k])],
        }
    }

    /// For an unknown: number among (u′, v′, w′, φ) it moves, and by how much.
    fn of_axes(&self, i: usize) -> (usize, f64) {
        match (i / 4, i % 4) {
            (3, k) => (3, self.m[0][k]),
            (f, k) => (f, self.n[1][k]),
        }
    }
}

/// Adds a mass at the point, and second moments of mass along the section's axes t, d₂, d₃.
///
/// `at` holds the displacements at which the axes are evaluated: those of the steady state, or none.
pub fn add_inertia(
    f: &Functions,
    x: f64,
    angle: f64,
    inertia: (f64, [f64; 3]),
    rotation: &Rotation,
    model: &Model,
    at: &[f64; LOCAL],
    out: &mut Local,
) {
    let (mass, second) = inertia;
    let omega = rotation.vector;
    let square = inner(omega, omega);
    if mass != 0.0 {
        let u = f.field(at, 0);
        let r = [rotation.hub_radius + x + u[0], u[1], u[2]];
        let along = inner(omega, r);
        for i in 0..12 {
            let (a, k) = (i / 4, i % 4);
            out.force[i] -= mass * f.n[0][k] * (square * r[a] - omega[a] * along);
            for j in 0..12 {
                let (b, l) = (j / 4, j % 4);
                let nn = mass * f.n[0][k] * f.n[0][l];
                let same = f64::from(a == b);
                out.mass[i][j] += nn * same;
                out.stiffness[i][j] -= nn * (square * same - omega[a] * omega[b]);
                // e_a · (Ω × e_b)
                let (c, sign) = match (a, b) {
                    (0, 1) => (2, -1.0),
                    (1, 0) => (2, 1.0),
                    (1, 2) => (0, -1.0),
                    (2, 1) => (0, 1.0),
                    (2, 0) => (1, -1.0),
                    (0, 2) => (1, 1.0),
                    _ => continue,
                };
                out.gyroscopic[i][j] += 2.0 * nn * sign * omega[c];
            }
        }
    }
    if second == [0.0; 3] || !(model.rotary_inertia || model.torsion) {
        return;
    }
    let slope = f.field(at, 1);
    let [x, y, z] = slope;
    let variables = [Jet::<4>::variable(1.0 + x, 0), Jet::variable(y, 1), Jet::variable(z, 2)];
    let rotated = Jet::variable(angle + f.torsion(at, 0), 3);
    let free = |v: usize| if v == 3 { model.torsion } else { model.rotary_inertia };
    for (axis, moment) in axes(&variables, &rotated).iter().zip(second) {
        if moment == 0.0 {
            continue;
        }
        let value = |pick: &dyn Fn(&Jet<4>) -> f64| [pick(&axis[0]), pick(&axis[1]), pick(&axis[2])];
        let d = value(&|j| j.x);
        let first: [[f64; 3]; 4] = std::array::from_fn(|v| value(&|j| j.g[v]));
        let swept = cross(omega, d);
        let mut force = [0.0; 4];
        let (mut mass, mut gyro, mut stiff) = ([[0.0; 4]; 4], [[0.0; 4]; 4], [[0.0; 4]; 4]);
        for v in (0..4).filter(|&v| free(v)) {
            force[v] = moment * inner(swept, cross(omega, first[v]));
            for w in (0..4).filter(|&w| free(w)) {
                let twice = value(&|j| j.h[v][w]);
                mass[v][w] = moment * inner(first[v], first[w]);
                gyro[v][w] = 2.0 * moment * inner(first[v], cross(omega, first[w]));
                stiff[v][w] = moment
                    * (inner(cross(omega, twice), swept)
                        + inner(cross(omega, first[v]), cross(omega, first[w])));
            }
        }
        for i in 0..LOCAL {
            let (v, a) = f.of_axes(i);
            out.force[i] -= a * force[v];
            for j in 0..LOCAL {
                let (w, b) = f.of_axes(j);
                out.mass[i][j] += a * b * mass[v][w];
                out.gyroscopic[i][j] += a * b * gyro[v][w];
                out.stiffness[i][j] -= a * b * stiff[v][w];
            }
        }
    }
}

/// Energy of bending and torsion per length at a point of the exact model, without that of the axial strain.
pub fn exact_energy(
    f: &Functions,
    pitch: f64,
    section: &BladeResultants,
    model: &Model,
    q: &[f64; LOCAL],
) -> Jet<8> {
    let (slope, bend) = (f.field(q, 1), f.field(q, 2));
    let shift = [1.0, 0.0, 0.0];
    // Functions of three variables are cheaper than of eight.
    let r1 = std::array::from_fn(|k| Jet::<3>::variable(shift[k] + slope[k], k));
    let r2 = std::array::from_fn(|k| Jet::variable(bend[k], 3 + k));
    let angle = Jet::variable(pitch + section.twist + f.torsion(q, 0), 6);
    let rate = Jet::variable(f.torsion(q, 1), 7);
    let e = strains(&Tangent::new(&r1).among(), &r2, &angle, &rate);
    let [chord, flap] = e.curvature;
    let mut energy = (chord * chord).scaled(0.5 * section.chord_stiffness)
        + (flap * flap).scaled(0.5 * section.flap_stiffness);
    if model.torsion {
        energy = energy + (e.twist * e.twist).scaled(0.5 * section.torsional_stiffness);
        if model.tension_torsion {
            let strain = e.stretch - Jet::constant(1.0);
            let square = e.twist * (e.twist + Jet::constant(2.0 * section.twist_rate));
            let polar = section.chord_stiffness + section.flap_stiffness;
            let whole = strain.scaled(section.axial_stiffness) + square.scaled(0.25 * polar);
            energy = energy + (whole * square).scaled(0.5 * polar / section.axial_stiffness);
        }
    }
    energy
}

impl Element {
    /// Adds force and stiffness of the exact strain energy at the unknowns `q`.
    pub fn add_exact_strain(&self, q: &[f64; LOCAL], pitch: f64, model: &Model, out: &mut Local) {
        for point in &self.points {
            let f = Functions::of(point);
            let energy = exact_energy(&f, pitch, &point.section, model, q);
            add_energy(&f, point.weight, &energy, out);
        }
        self.add_axial_strain(q, out);
    }

    /// Strain energy of the exact model.
    #[cfg(test)]
    pub fn exact_energy(&self, q: &[f64; LOCAL], pitch: f64, model: &Model) -> f64 {
        let at = |p: &Point| p.weight * exact_energy(&Functions::of(p), pitch, &p.section, model, q).x;
        let strain = self.samples(q).map(|(strain, ..)| strain);
        let mut sum: f64 = self.points.iter().map(at).sum();
        for i in 0..3 {
            for j in 0..3 {
                sum += 0.5 * self.axial[i][j] * strain[i] * strain[j];
            }
        }
        sum
    }

    /// ε = |r′| − 1, the stretch |r′|, the unit tangent and N′ at both nodes and the middle.
    pub fn samples(&self, q: &[f64; LOCAL]) -> [(f64, f64, [f64; 3], [f64; 4]); 3] {
        SAMPLES.map(|s| {
            let n = hermite(s, self.ends[1] - self.ends[0])[1];
            let slope: [f64; 3] = std::array::from_fn(|f| (0..4).map(|k| n[k] * q[4 * f + k]).sum());
            let r = [1.0 + slope[0], slope[1], slope[2]];
            let stretch = inner(r, r).sqrt();
            // λ − 1 without cancellation.
            let strain =
                (slope[0] * (2.0 + slope[0]) + slope[1] * slope[1] + slope[2] * slope[2]) / (stretch + 1.0);
            (strain, stretch, r.map(|r| r / stretch), n)
        })
    }

    /// ½ Σ ∫EA LᵢLⱼ εᵢ εⱼ: sampled, so that an inextensible blade can bend.
    fn add_axial_strain(&self, q: &[f64; LOCAL], out: &mut Local) {
        let samples = self.samples(q);
        let mut gradient = [[0.0; 12]; 3];
        let mut tension = [0.0; 3];
        for a in 0..3 {
            for b in 0..3 {
                tension[a] += self.axial[a][b] * samples[b].0;
            }
            let (_, _, t, n) = samples[a];
            for i in 0..12 {
                gradient[a][i] = t[i / 4] * n[i % 4];
            }
        }
        for i in 0..12 {
            for a in 0..3 {
                let (_, stretch, t, n) = samples[a];
                out.force[i] += tension[a] * gradient[a][i];
                for j in 0..12 {
                    let (f, g) = (i / 4, j / 4);
                    let bend = (f64::from(f == g) - t[f] * t[g]) / stretch;
                    let mut sum = tension[a] * bend * n[i % 4] * n[j % 4];
                    for b in 0..3 {
                        sum += self.axial[a][b] * gradient[a][i] * gradient[b][j];
                    }
                    out.stiffness[i][j] += sum;
                }
            }
        }
    }
}

/// Adds gradient and second derivatives of an energy per length by (u′, v′, w′, u″, v″, w″, φ, φ′).
pub fn add_energy(f: &Functions, weight: f64, energy: &Jet<8>, out: &mut Local) {
    for i in 0..LOCAL {
        let left = f.of_strains(i);
        for (v, a) in left {
            out.force[i] += weight * a * energy.g[v];
        }
        for j in 0..LOCAL {
            let right = f.of_strains(j);
            let mut sum = 0.0;
            for (v, a) in left {
                for (w, b) in right {
                    sum += a * b * energy.h[v][w];
                }
            }
            out.stiffness[i][j] += weight * sum;
        }
    }
}
