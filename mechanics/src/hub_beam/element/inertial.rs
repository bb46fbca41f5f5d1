//! Inertia of the rotation of an element's section: rotary inertia ρI and first mass moment ρS.

use super::{Element, Local, components};
use crate::hub_beam::inertia::Totals;
use crate::hub_beam::rule::{Rule, RulePoint};
use crate::hub_beam::section_rotation::SectionRotation;
use crate::linalg::vector::inner;
use crate::profile::HubKinematics;
use crate::system::Weights;

impl Element {
    /// Kinematics of the section's rotation at quadrature point `g`.
    fn rotation(&self, p: &RulePoint, local: &Local, hub: &HubKinematics, rule: &Rule) -> SectionRotation {
        let at = |n: &[f64; 4], d: &[f64; 8]| components(d).map(|d| inner(*n, d));
        let [u, v] = at(&p.n, &local.q);
        let slope = at(&p.n1, &local.q);
        SectionRotation::new(
            [local.origin + p.s * rule.length + u, v],
            [1.0 + slope[0], slope[1]],
            [at(&p.n, &local.v), at(&p.n1, &local.v)],
            [at(&p.n, &local.a), at(&p.n1, &local.a)],
            hub,
        )
    }

    /// Adds the forces of rotary inertia and first mass moment to `f`.
    #[inline]
    pub fn section_force(&self, rule: &Rule, local: &Local, hub: &HubKinematics, f: &mut [f64; 8]) {
        if !self.has_section_inertia {
            return;
        }
        for (g, p) in rule.points.iter().enumerate() {
            let (on_value, on_slope) =
                self.rotation(p, local, hub, rule).force(self.rotary[g], self.first[g]);
            for c in 0..2 {
                for k in 0..4 {
                    f[4 * c + k] += on_value[c] * p.n[k] + on_slope[c] * p.n1[k];
                }
            }
        }
    }

    /// Adds the tangent of [`Element::section_force`] to `out`.
    #[inline]
    pub fn section_tangent(
        &self,
        rule: &Rule,
        local: &Local,
        hub: &HubKinematics,
        w: &Weights<'_>,
        out: &mut [[f64; 8]; 8],
    ) {
        if !self.has_section_inertia {
            return;
        }
        for (g, p) in rule.points.iter().enumerate() {
            let rotation = self.rotation(p, local, hub, rule);
            for c in 0..2 {
                let mut seed = [0.0; 2];
                seed[c] = 1.0;
                // A unit of p, and of p′, in direction c, with the integrator's weights.
                for (slope, shape) in [(false, &p.n), (true, &p.n1)] {
                    let (dv, ds) = rotation.derivative(seed, slope, hub, w, self.rotary[g], self.first[g]);
                    for r in 0..2 {
                        for i in 0..4 {
                            let row = dv[r] * p.n[i] + ds[r] * p.n1[i];
                            for j in 0..4 {
                                out[4 * r + i][4 * c + j] += row * shape[j];
                            }
                        }
                    }
                }
            }
        }
    }

    /// Kinetic energy, angular momentum and hub torque of rotary inertia and first mass moment.
    pub fn section_totals(&self, rule: &Rule, local: &Local, hub: &HubKinematics) -> Totals {
        let mut sum = Totals::default();
        if self.has_section_inertia {
            for (g, p) in rule.points.iter().enumerate() {
                sum = sum + self.rotation(p, local, hub, rule).totals(self.rotary[g], self.first[g], hub);
            }
        }
        sum
    }

    /// Adds to the border of a free hub: `column` and `row` are the element's, the corner is returned.
    pub fn section_border(
        &self,
        rule: &Rule,
        local: &Local,
        hub: &HubKinematics,
        w: &Weights<'_>,
        (column, row): (&mut [f64; 8], &mut [f64; 8]),
    ) -> f64 {
        let mut corner = 0.0;
        if !self.has_section_inertia {
            return corner;
        }
        for (g, p) in rule.points.iter().enumerate() {
            let rotation = self.rotation(p, local, hub, rule);
            let (rotary, first) = (self.rotary[g], self.first[g]);
            let (value, slope, torque) = rotation.by_hub(hub, w, rotary, first);
            corner += torque;
            for c in 0..2 {
                let mut seed = [0.0; 2];
                seed[c] = 1.0;
                let on_value = rotation.torque_derivative(seed, false, hub, w, rotary, first);
                let on_slope = rotation.torque_derivative(seed, true, hub, w, rotary, first);
                for k in 0..4 {
                    column[4 * c + k] += value[c] * p.n[k] + slope[c] * p.n1[k];
                    row[4 * c + k] += on_value * p.n[k] + on_slope * p.n1[k];
                }
            }
        }
        corner
    }
}
