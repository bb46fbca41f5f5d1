//! The tangent of the high-order coupling: a full matrix.
//!
//! With the derivatives of the foreshortening by the unknowns
//!
//! ```text
//! yᵢ = ∂w_c/∂qᵢ = −∫₀ˣ w₂′ φy′ᵢ dξ,   ẏᵢ = ∂ẇ_c/∂qᵢ = −∫₀ˣ ẇ₂′ φy′ᵢ dξ,   ÿᵢ = ∂ẅ_c/∂qᵢ = −∫₀ˣ ẅ₂′ φy′ᵢ dξ
//! ∂ẇ_c/∂q̇ᵢ = yᵢ,   ∂ẅ_c/∂q̇ᵢ = 2ẏᵢ,   ∂ẅ_c/∂q̈ᵢ = yᵢ
//! ```
//!
//! the force on unknown i is
//!
//! ```text
//! fᵢ = ∫ρA [ (ẅ_c − ω²w_c) φxᵢ + (ω̇ w_c + 2ω ẇ_c) φyᵢ + α yᵢ ] dx
//! ```
//!
//! and its derivative by unknown j, with the weights w_q, w_v, w_a of displacement, velocity and acceleration,
//!
//! ```text
//! Kᵢⱼ = ∫ρA [ φxᵢ z₁ⱼ + φyᵢ z₂ⱼ + yᵢ δαⱼ ] dx − w_q ∫ N φy′ᵢ φy′ⱼ dx
//! z₁ = (w_a − w_q ω²) y + 2w_v ẏ + w_q ÿ
//! z₂ = (w_q ω̇ + 2w_v ω) y + 2w_q ω ẏ
//! δα = z₁ + (w_a − w_q ω²) φx − (w_q ω̇ + 2w_v ω) φy
//! ```
//!
//! All rows (y, z₁, …) are sums over the same points as the forces. At a point of a cell y is its value at the start of
//! the cell and a part that only the functions of this cell have. O(n²) a cell, of n unknowns, and a factorisation
//! takes O(n³): hence the [largest number of elements](super::MOST_ELEMENTS).

use super::sums::{Rates, Sums};
use crate::linalg::Storage;
use crate::profile::HubKinematics;
use crate::system::Weights;

/// Scratch of the tangent: rows over the unknowns. See the [module documentation](self).
#[derive(Clone, Debug)]
pub struct Tangent {
    /// y, ẏ, ÿ at the start of a cell.
    start: Vec<Rates>,
    /// The same at a point.
    y: Vec<Rates>,
    z1: Vec<f64>,
    z2: Vec<f64>,
    /// δα at a point, and ∫ρA δα dx over a cell.
    acceleration: Vec<f64>,
    of_cell: Vec<f64>,
}

impl Tangent {
    /// Scratch for `n` unknowns.
    pub fn new(n: usize) -> Tangent {
        let zeros = || vec![0.0; n];
        let rates = || vec![[0.0; 3]; n];
        Tangent {
            start: rates(),
            y: rates(),
            z1: zeros(),
            z2: zeros(),
            acceleration: zeros(),
            of_cell: zeros(),
        }
    }

    /// Adds the tangent at the state that `sums` follow.
    pub fn add(&mut self, sums: &mut Sums, hub: &HubKinematics, w: &Weights<'_>, out: &mut Storage<f64>) {
        let (om, al) = (hub.speed, hub.acceleration);
        let (inertial, coriolis) = (w.a - w.q * om * om, w.q * al + 2.0 * w.v * om);
        self.start.fill([0.0; 3]);
        // Unknowns of the cells up to this one: behind them all rows are zero.
        let mut n = 0;
        for (c, cell) in sums.cells.iter().enumerate() {
            n = cell.axial.iter().chain(&cell.transverse).fold(n, |n, i| n.max(i + 1));
            self.of_cell[..n].fill(0.0);
            for (g, &m) in cell.mass.iter().enumerate() {
                let (phi_x, phi_y) = (cell.phi_x.at(g), cell.phi_y.at(g));
                self.y[..n].copy_from_slice(&self.start[..n]);
                sums.add_derivatives(c, sums.partial.at(g), &mut self.y);
                for (j, y) in self.y[..n].iter().enumerate() {
                    self.z1[j] = inertial * y[0] + 2.0 * w.v * y[1] + w.q * y[2];
                    self.z2[j] = coriolis * y[0] + 2.0 * om * w.q * y[1];
                }
                self.acceleration[..n].copy_from_slice(&self.z1[..n]);
                for (&j, phi) in cell.axial.iter().zip(phi_x.clone()) {
                    self.acceleration[j] += inertial * phi;
                }
                for (&j, phi) in cell.transverse.iter().zip(phi_y.clone()) {
                    self.acceleration[j] -= coriolis * phi;
                }
                for (&i, phi) in cell.axial.iter().zip(phi_x) {
                    out.add_row(i, m * phi, &self.z1[..n]);
                }
                for (&i, phi) in cell.transverse.iter().zip(phi_y) {
                    out.add_row(i, m * phi, &self.z2[..n]);
                    out.add_row(i, m * (self.y[i][0] - self.start[i][0]), &self.acceleration[..n]);
                }
                for (sum, x) in self.of_cell.iter_mut().zip(&self.acceleration[..n]) {
                    *sum += m * x;
                }
            }
            for (i, y) in self.start[..n].iter().enumerate().filter(|(_, y)| y[0] != 0.0) {
                out.add_row(i, y[0], &self.of_cell[..n]);
            }
            sums.add_derivatives(c, sums.weights.iter().copied(), &mut self.start);
        }
        sums.tails(
            |at| ([0.0; 2], [at.axial_acceleration(hub)]),
            |cell, _, tension, _| {
                for (k, [tension, ..]) in tension.iter().enumerate() {
                    let slope = cell.slope.at(k);
                    for (&i, phi) in cell.transverse.iter().zip(slope.clone()) {
                        let force = -w.q * cell.length * tension * phi;
                        for (&j, phi) in cell.transverse.iter().zip(slope.clone()) {
                            out.add(i, j, force * phi);
                        }
                    }
                }
            },
        );
    }
}
