//! One Hermite element of the exact coupling: its unknowns, its section, and their assembly. Symbols as in
//! [`super::exact`]. Its forces: `elastic`, `viscous`, `inertial`.
//!
//! Local unknowns d = (U, U′ at both nodes; V, V′ at both nodes); N, N′, N″ the four Hermite functions;
//! L the three quadratic Lagrange functions of the strain's samples; ℓ = |p′|.

mod elastic;
mod inertial;
mod viscous;

use super::fields::Fields;
use super::rule::{POINTS, Rule, RulePoint, lagrange};
use crate::linalg::Storage;
use crate::quadrature::Gauss;
use crate::section::Section;
use crate::system::{Corotation, State};

/// Marks an unknown that the clamp removes.
const CLAMPED: usize = usize::MAX;

/// Number of each local unknown among the eight consecutive unknowns of an element away from the clamp:
/// U, U′, V, V′ node after node.
const ORDER: [usize; 8] = [0, 1, 4, 5, 2, 3, 6, 7];

/// A vector of an element in the order of [`ORDER`], which is its own inverse.
#[inline(always)]
fn ordered([a, b, c, d, e, f, g, h]: &[f64; 8]) -> [f64; 8] {
    [*a, *b, *e, *f, *c, *d, *g, *h]
}

/// An element: its unknowns and its section.
#[derive(Clone, Debug)]
pub struct Element {
    unknowns: [usize; 8],
    /// First unknown, if the unknowns are consecutive in the order of [`ORDER`].
    first_unknown: Option<usize>,
    start: f64,
    end: f64,
    /// ∫ EA L_i L_j dx
    axial: [[f64; 3]; 3],
    /// EI and ES times the quadrature weight.
    bending: [f64; POINTS],
    coupling: [f64; POINTS],
    /// ρI and ρS times the quadrature weight.
    rotary: [f64; POINTS],
    first: [f64; POINTS],
    has_coupling: bool,
    has_section_inertia: bool,
}

/// Unknowns, velocities and accelerations of an element.
#[derive(Clone, Copy, Debug)]
pub struct Local {
    q: [f64; 8],
    v: [f64; 8],
    a: [f64; 8],
    /// X of the undeformed first node.
    origin: f64,
}

/// The axial and the transverse part of a local vector.
#[inline(always)]
fn components(d: &[f64; 8]) -> [[f64; 4]; 2] {
    let [u0, u1, u2, u3, v0, v1, v2, v3] = *d;
    [[u0, u1, u2, u3], [v0, v1, v2, v3]]
}

impl Element {
    /// Element `e` of the mesh `nodes`.
    pub fn new(fields: &Fields, section: &dyn Section, nodes: &[f64], e: usize) -> Element {
        let (start, end) = (nodes[e], nodes[e + 1]);
        let (axial_index, transverse_index) = fields.indices();
        // Functions of an element, the clamped ones in front of the first element missing.
        let (a, t) = (fields.axial().support(e), fields.transverse().support(e));
        let mut unknowns = [CLAMPED; 8];
        unknowns[4 - a.len()..4].copy_from_slice(&axial_index[a]);
        unknowns[8 - t.len()..8].copy_from_slice(&transverse_index[t]);
        let mut axial = [[0.0; 3]; 3];
        for (x, w) in Gauss::new(4).on(start, end) {
            let l = lagrange((x - start) / (end - start));
            let stiffness = w * section.resultants(x).axial_stiffness;
            for i in 0..3 {
                for j in 0..3 {
                    axial[i][j] += stiffness * l[i] * l[j];
                }
            }
        }
        let rule = Rule::new(end - start);
        let at = |p: &RulePoint| section.resultants(start + p.s * (end - start));
        let coupling = rule.points.map(|p| p.weight * at(&p).coupling_stiffness);
        let rotary = rule.points.map(|p| p.weight * at(&p).rotary_inertia);
        let first = rule.points.map(|p| p.weight * at(&p).first_moment);
        let first_unknown = Some(unknowns[0]).filter(|i| unknowns == ORDER.map(|p| i.wrapping_add(p)));
        Element {
            unknowns,
            first_unknown,
            start,
            end,
            axial,
            bending: rule.points.map(|p| p.weight * at(&p).bending_stiffness),
            coupling,
            rotary,
            first,
            has_coupling: coupling.iter().any(|x| *x != 0.0),
            has_section_inertia: rotary.iter().chain(&first).any(|x| *x != 0.0),
        }
    }

    /// Station of the far node \[m\].
    pub fn end(&self) -> f64 {
        self.end
    }

    /// Whether the section has rotary inertia or a first mass moment here.
    pub fn has_section_inertia(&self) -> bool {
        self.has_section_inertia
    }

    /// U′ and V′ at the far node.
    pub fn end_slopes(&self, q: &[f64]) -> (f64, f64) {
        (q[self.unknowns[3]], q[self.unknowns[7]])
    }

    /// The rotation of the far node from `before` to `now`, for its displacement and its slope.
    #[inline]
    pub fn end_rotation(&self, before: &[f64], now: &[f64], out: &mut Corotation) {
        let slopes = |q| {
            let (u, v) = self.end_slopes(q);
            (1.0 + u, v)
        };
        let ((x, y), (x1, y1)) = (slopes(before), slopes(now));
        let (along, across) = (x * x1 + y * y1, x * y1 - y * x1);
        let scale = 1.0 / (along * along + across * across).sqrt();
        let [_, _, u, du, _, _, v, dv] = self.unknowns;
        out.push([u, v], along * scale, across * scale);
        out.push([du, dv], along * scale, across * scale);
    }

    /// The element's part of a vector.
    #[inline]
    pub fn part(&self, x: &[f64]) -> [f64; 8] {
        match self.first_unknown.and_then(|first| x[first..].first_chunk()) {
            Some(x) => ordered(x),
            None => self.unknowns.map(|i| if i == CLAMPED { 0.0 } else { x[i] }),
        }
    }

    /// The element's part of a state; `radius` is the hub's.
    pub fn gather(&self, s: &State, radius: f64) -> Local {
        let [q, v, a] = [&s.q, &s.v, &s.a].map(|x| self.part(x));
        Local { q, v, a, origin: radius + self.start }
    }

    /// Adds a local vector to a global one.
    #[inline]
    pub fn scatter(&self, local: &[f64; 8], out: &mut [f64]) {
        if let Some(out) = self.first_unknown.and_then(|first| out[first..].first_chunk_mut::<8>()) {
            let local: [f64; 8] = ordered(local);
            for k in 0..8 {
                out[k] += local[k];
            }
            return;
        }
        for (&i, x) in self.unknowns.iter().zip(local) {
            if i != CLAMPED {
                out[i] += x;
            }
        }
    }

    /// Adds a local matrix to a global one.
    #[inline]
    pub fn assemble(&self, local: &[[f64; 8]; 8], out: &mut Storage<f64>) {
        if let Some(first) = self.first_unknown {
            for (p, row) in ORDER.into_iter().zip(local) {
                let out = out.run_mut::<8>(first + p, first);
                // ORDER is its own inverse.
                for (out, p) in out.iter_mut().zip(ORDER) {
                    *out += row[p];
                }
            }
            return;
        }
        for (&i, row) in self.unknowns.iter().zip(local) {
            for (&j, x) in self.unknowns.iter().zip(row) {
                if i != CLAMPED && j != CLAMPED {
                    out.add(i, j, *x);
                }
            }
        }
    }
}
