//! The precomputed generalized forces of one load: moments of its density over the shape functions.
//!
//! With g_x, g_y the vectors and G_x, G_y the symmetric matrices of C (see [`super`]),
//!
//! ```text
//! C_x = c_x + g_xᵀq + ½ qᵀG_x q,   C_y = c_y + g_yᵀq + ½ qᵀG_y q
//! Q_q = f [ d_x (g_x + G_x q) + d_y (g_y + G_y q) + N q ],  Q_θ = f [ d_y C_x − d_x C_y + hᵀq ]
//! ```
//!
//! N = ∫p (−F_y Φ_x + F_x Φ_y) Φ_y′ᵀ dx and h = ∫p (a + x) F_x Φ_y′ dx are a follower's change of direction, to first
//! order; both vanish for other forces. Couples have Q_q = f m, Q_θ = f M. Forces and couples on the sections of a curve
//! are [`OnSection`](super::on_section::OnSection).

use super::components::Components;
use super::on_section::{Nature, OnSection};
use super::{Amplitude, Axes};
use crate::drive::force_breaks;
use crate::hub_beam::fields::Point;
use crate::hub_beam::inertia::Border;
use crate::hub_beam::product::Bundle;
use crate::hub_beam::vectors::{Entry, Vectors};
use crate::linalg::{Matrix, Storage, Structure};
use crate::profile::HubKinematics;
use crate::system::{Break, State};
use std::sync::Arc;

/// Where the work of a conservative load is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Store {
    /// In the field of gravity.
    Gravity,
    /// In a spring.
    Spring,
}

/// One load, ready to be evaluated. See the [module documentation](self).
#[derive(Clone, Debug)]
pub struct Group {
    force: [f64; 2],
    axes: Axes,
    amplitude: Amplitude,
    /// Where its work is stored, if it is, and the energy there at r = 0 and q = 0 \[J\].
    store: Option<(Store, f64)>,
    /// Part of the load that is applied.
    part: f64,
    /// c_x and c_y
    pub(super) c_x: f64,
    pub(super) c_y: f64,
    /// g_x and g_y
    pub(super) g_x: Vec<f64>,
    pub(super) g_y: Vec<f64>,
    /// h
    pub(super) h: Vec<f64>,
    /// m and M \[N·m\]
    pub(super) m: Vec<f64>,
    pub(super) moment: f64,
    /// G_x, G_y and N, if one of them is there.
    stiffness: Option<(Bundle, Vectors, Vec<Entry>)>,
    sections: Arc<Vec<OnSection>>,
}

impl Group {
    /// A load of force `force` for `n` unknowns that acts nowhere yet.
    pub(super) fn new(n: usize, force: [f64; 2], axes: Axes, amplitude: Amplitude) -> Group {
        let zero = || vec![0.0; n];
        Group {
            force,
            axes,
            amplitude,
            store: None,
            part: 1.0,
            c_x: 0.0,
            c_y: 0.0,
            g_x: zero(),
            g_y: zero(),
            h: zero(),
            m: zero(),
            moment: 0.0,
            stiffness: None,
            sections: Arc::default(),
        }
    }

    /// Sets G_x, G_y and N.
    pub(super) fn stiffen(
        &mut self,
        structure: &Structure,
        g_x: Option<&Matrix>,
        g_y: Option<&Matrix>,
        follower: Option<&Matrix>,
    ) {
        self.stiffness = (g_x.is_some() || g_y.is_some() || follower.is_some()).then(|| {
            let bundle = Bundle::new(structure, self.g_x.len(), [g_x, g_y, follower, None]);
            let vectors = bundle.vectors();
            (bundle, vectors, vec![[0.0; 4]; self.g_x.len()])
        });
    }

    /// A share `p` of a follower at a point of a curve.
    pub(super) fn push_follower(&mut self, point: &Point, p: f64, radius: f64) {
        Arc::make_mut(&mut self.sections).push(OnSection::new(point, Nature::Follower, p, radius));
    }

    /// A couple on the section at a point of a curve.
    pub(super) fn push_couple(&mut self, point: &Point, moment: f64, radius: f64) {
        Arc::make_mut(&mut self.sections).push(OnSection::new(point, Nature::Couple, moment, radius));
    }

    /// A force that acts off the axis: first moment `p` about it.
    pub(super) fn push_eccentric(&mut self, point: &Point, p: f64, radius: f64) {
        Arc::make_mut(&mut self.sections).push(OnSection::new(point, Nature::Eccentric, p, radius));
    }

    /// Its work is stored; `energy` \[J\] is there at r = 0 and q = 0.
    pub(super) fn set_store(&mut self, store: Store, energy: f64) {
        self.store = Some((store, energy));
    }

    pub(super) fn set_part(&mut self, part: f64) {
        self.part = part;
    }

    pub(super) fn store(&self) -> Option<Store> {
        self.store.map(|(store, _)| store)
    }

    pub(super) fn is_stiff(&self) -> bool {
        self.stiffness.is_some()
    }

    pub(super) fn varies(&self) -> bool {
        self.amplitude.is_some()
    }

    pub(super) fn axes(&self) -> Axes {
        self.axes
    }

    pub(super) fn breaks(&self) -> Vec<Break> {
        self.amplitude.as_ref().map_or_else(Vec::new, |amplitude| force_breaks(amplitude.as_ref()))
    }

    fn components(&self, t: f64, hub: &HubKinematics) -> Components {
        let factor = self.part * self.amplitude.as_ref().map_or(1.0, |f| f.value(t));
        Components::new(self.force, self.axes, factor, hub)
    }

    /// d_x G_x q, d_y G_y q and f N q, row after row; nothing if there are no such matrices.
    fn products(&mut self, q: &[f64], d: [f64; 2], factor: f64) -> &[Entry] {
        let Some((bundle, x, products)) = &mut self.stiffness else { return &[] };
        x.set(|i| [d[0] * q[i], d[1] * q[i], factor * q[i], 0.0]);
        bundle.products(x, products);
        products
    }

    /// out += c Q_q
    pub(super) fn add_force(&mut self, s: &State, hub: &HubKinematics, c: f64, out: &mut [f64]) {
        let now = self.components(s.time(), hub);
        let d = now.d.map(|d| c * d);
        let m = c * now.factor;
        for (i, out) in out.iter_mut().enumerate().take(self.g_x.len()) {
            *out += d[0] * self.g_x[i] + d[1] * self.g_y[i] + m * self.m[i];
        }
        for (out, [gx, gy, n, _]) in out.iter_mut().zip(self.products(&s.q, d, m)) {
            *out += gx + gy + n;
        }
        for section in self.sections.iter() {
            section.add_force(s, &now, c, out);
        }
    }

    /// out += c ∂Q_q/∂q
    pub(super) fn add_tangent(&self, s: &State, hub: &HubKinematics, c: f64, out: &mut Storage<f64>) {
        if self.stiffness.is_none() && self.sections.is_empty() {
            return;
        }
        let now = self.components(s.time(), hub);
        if let Some((bundle, ..)) = &self.stiffness {
            bundle.add_sum([c * now.d[0], c * now.d[1], c * now.factor, 0.0], out);
        }
        for section in self.sections.iter() {
            section.add_tangent(s, &now, c, out);
        }
    }

    /// C_x and C_y.
    fn moments(&mut self, q: &[f64]) -> [f64; 2] {
        let n = self.g_x.len();
        let inner = |a: &[f64]| a.iter().zip(&q[..n]).map(|(a, b)| a * b).sum::<f64>();
        let mut c = [self.c_x + inner(&self.g_x), self.c_y + inner(&self.g_y)];
        for (q, [gx, gy, ..]) in q.iter().zip(self.products(q, [1.0; 2], 0.0)) {
            c[0] += 0.5 * q * gx;
            c[1] += 0.5 * q * gy;
        }
        c
    }

    /// Q_θ
    pub(super) fn torque(&mut self, s: &State, hub: &HubKinematics) -> f64 {
        let now = self.components(s.time(), hub);
        let [x, y] = self.moments(&s.q);
        let follower: f64 = self.h.iter().zip(&s.q).map(|(h, q)| h * q).sum();
        let sections: f64 = self.sections.iter().map(|section| section.torque(s, &now)).sum();
        now.d[1] * x - now.d[0] * y + now.factor * (follower + self.moment) + sections
    }

    /// −f [d·C + mᵀq + ½ qᵀN q] and the energy at r = 0 and q = 0, for a load whose work is stored; 0 for others.
    pub(super) fn potential(&mut self, s: &State, hub: &HubKinematics) -> f64 {
        let Some((_, energy)) = self.store else { return 0.0 };
        let now = self.components(s.time(), hub);
        let mut own: f64 = self.m.iter().zip(&s.q).map(|(m, q)| m * q).sum();
        for (q, [.., n, _]) in s.q.iter().zip(self.products(&s.q, [0.0; 2], 1.0)) {
            own += 0.5 * q * n;
        }
        let own = now.factor * (energy - own);
        let [x, y] = self.moments(&s.q);
        let sections: f64 = self.sections.iter().map(|section| section.potential(s, &now)).sum();
        sections - now.d[0] * x - now.d[1] * y + own
    }

    /// Adds c times the derivatives of Q_q by θ and of Q_θ by q and θ.
    pub(super) fn add_border(&mut self, s: &State, hub: &HubKinematics, c: f64, out: &mut Border) {
        let now = self.components(s.time(), hub);
        let dead = if self.axes == Axes::Dead { 1.0 } else { 0.0 };
        // Q_θ by q: as the force with the components (d_y, −d_x), for all axes.
        let normal = [c * now.d[1], -c * now.d[0]];
        for i in 0..self.g_x.len() {
            let rotated = normal[0] * self.g_x[i] + normal[1] * self.g_y[i];
            out.column[i] += dead * rotated;
            out.row[i] += rotated + c * now.factor * self.h[i];
        }
        for (i, [gx, gy, ..]) in self.products(&s.q, normal, 0.0).iter().enumerate() {
            out.column[i] += dead * (gx + gy);
            out.row[i] += gx + gy;
        }
        if dead != 0.0 {
            let [x, y] = self.moments(&s.q);
            out.corner -= c * (now.d[0] * x + now.d[1] * y);
        }
        for section in self.sections.iter() {
            section.add_border(s, &now, c, out);
        }
    }
}
