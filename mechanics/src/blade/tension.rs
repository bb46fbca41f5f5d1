//! The steady tension of a straight blade, and its steady axial strain.
//!
//! ```text
//! N(x) = Ω² [C(x) + Ω² D(x)],   C = ∫ₓᴸ ρA (a + ξ) dξ + Σ m (a + s),   D = ∫ₓᴸ ρA W dξ + Σ m W(s)
//! w₁(x) = Ω² W(x),              W = ∫₀ˣ C/EA dξ
//! ```
//!
//! The sums are over the bodies, m at stations s ≥ x. C is the tension of the unstretched blade, D the part of its elongation.

use super::mesh::Mesh;
use super::model::Setting;
use crate::quadrature::Gauss;
use crate::section::BladeSection;

/// C and D at every quadrature point, element after element.
#[derive(Clone, Debug)]
pub struct Tension {
    /// C and D [kg·m, kg·m·s²].
    pub at: Vec<Vec<(f64, f64)>>,
}

impl Tension {
    /// Integrates over the blade, piece by piece between the breaks of the section.
    pub fn new(mesh: &Mesh, section: &dyn BladeSection, setting: &Setting) -> Tension {
        let (a, length) = (setting.hub_radius, setting.length);
        let mut cuts: Vec<f64> = mesh.elements.iter().flat_map(|e| e.ends).collect();
        cuts.extend(section.breaks().iter().copied().filter(|&x| x > 0.0 && x < length));
        cuts.sort_by(f64::total_cmp);
        cuts.dedup();
        let gauss = Gauss::new(5);
        let pieces = cuts.len() - 1;
        let piece = |x: f64| cuts[1..pieces].partition_point(|&end| end <= x);
        let force = |x: f64| section.resultants(x).mass * (a + x);
        // Bodies sit at ends of elements.
        let mut bodies = vec![0.0; pieces + 1];
        for element in &mesh.elements {
            let at = cuts.partition_point(|&x| x < element.ends[1]);
            bodies[at] = element.body.mass;
        }
        let mut c = vec![0.0; pieces + 1];
        c[pieces] = bodies[pieces] * (a + length);
        for i in (0..pieces).rev() {
            let at_body = bodies[i] * (a + cuts[i]);
            c[i] = c[i + 1] + gauss.integrate(cuts[i], cuts[i + 1], force) + at_body;
        }
        let c_at = |i: usize, x: f64| c[i + 1] + gauss.integrate(x, cuts[i + 1], force);
        let strain = |i: usize, x: f64| c_at(i, x) / section.resultants(x).axial_stiffness;
        let mut w = vec![0.0; pieces + 1];
        for i in 0..pieces {
            w[i + 1] = w[i] + gauss.integrate(cuts[i], cuts[i + 1], |x| strain(i, x));
        }
        let more = |i: usize, x: f64| {
            section.resultants(x).mass * (w[i] + gauss.integrate(cuts[i], x, |y| strain(i, y)))
        };
        let mut d = vec![0.0; pieces + 1];
        d[pieces] = bodies[pieces] * w[pieces];
        for i in (0..pieces).rev() {
            d[i] = d[i + 1] + gauss.integrate(cuts[i], cuts[i + 1], |x| more(i, x)) + bodies[i] * w[i];
        }
        let at = |x: f64| {
            let i = piece(x);
            (c_at(i, x), d[i + 1] + gauss.integrate(x, cuts[i + 1], |y| more(i, y)))
        };
        let of = |points: &[super::mesh::Point]| points.iter().map(|p| at(p.x)).collect();
        Tension { at: mesh.elements.iter().map(|e| of(&e.points)).collect() }
    }
}
