//! Elements of a blade: nodes, numbers of the unknowns, quadrature.
//!
//! Each node has u, u′, v, v′, w, w′ (cubic Hermite fields) and, with torsion, φ, which has a node in the middle
//! of each element too (quadratic). Unknowns are numbered node after node, so that the half bandwidth is 14
//! (11 without torsion) for any number of elements. Where the section jumps, or a body is, the strain u′ does too: the node has one
//! on either side.

use super::model::{BladeError, Body, Setting, Tip};
use crate::linalg::Structure;
use crate::quadrature::Gauss;
use crate::section::{BladeResultants, BladeSection};

/// Unknowns of an element: u, v, w with values and slopes at both nodes, then φ at both nodes and the middle.
pub const LOCAL: usize = 15;

/// Marks an unknown that the clamp removes, or that the model does not have.
pub const CLAMPED: usize = usize::MAX;

/// Gauss points between two breaks of the section: exact for linear mass and cubic stiffness.
const POINTS: usize = 4;

/// Fields of the displacement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Component {
    /// u, along the blade.
    Axial,
    /// v, in the direction of motion.
    Chordwise,
    /// w, towards the angular velocity.
    Flapwise,
    /// φ, about the axis towards the tip.
    Torsion,
}

/// A quadrature point.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// Station [m].
    pub x: f64,
    /// Weight [m].
    pub weight: f64,
    /// Hermite functions and their first two derivatives.
    pub n: [[f64; 4]; 3],
    /// Quadratic functions and their first derivatives.
    pub m: [[f64; 3]; 2],
    /// The section.
    pub section: BladeResultants,
}

/// An element.
#[derive(Clone, Debug)]
pub struct Element {
    /// Numbers of its unknowns.
    pub unknowns: [usize; LOCAL],
    /// Ends [m].
    pub ends: [f64; 2],
    /// Its quadrature.
    pub points: Vec<Point>,
    /// ∫EA LᵢLⱼ dx for the strain, sampled at both nodes and the middle.
    pub axial: [[f64; 3]; 3],
    /// The body at its outer end.
    pub body: Tip,
}

/// The mesh of a blade.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// Elements from the root.
    pub elements: Vec<Element>,
    /// Which field each unknown belongs to.
    pub components: Vec<Component>,
    /// Whether each unknown is a slope, and its station [m].
    places: Vec<(bool, f64)>,
    length: f64,
    /// Half bandwidth.
    pub half: usize,
}

/// Hermite functions of an element of length h at s ∈ [0, 1], and their first two derivatives.
pub fn hermite(s: f64, h: f64) -> [[f64; 4]; 3] {
    let r = 1.0 - s;
    [
        [(1.0 + 2.0 * s) * r * r, h * s * r * r, s * s * (3.0 - 2.0 * s), -h * s * s * r],
        [-6.0 * s * r / h, r * (1.0 - 3.0 * s), 6.0 * s * r / h, s * (3.0 * s - 2.0)],
        [(12.0 * s - 6.0) / (h * h), (6.0 * s - 4.0) / h, (6.0 - 12.0 * s) / (h * h), (6.0 * s - 2.0) / h],
    ]
}

/// Quadratic functions with nodes 0, 1, ½ and their derivatives.
pub fn quadratic(s: f64, h: f64) -> [[f64; 3]; 2] {
    [
        [(1.0 - s) * (1.0 - 2.0 * s), s * (2.0 * s - 1.0), 4.0 * s * (1.0 - s)],
        [(4.0 * s - 3.0) / h, (4.0 * s - 1.0) / h, (4.0 - 8.0 * s) / h],
    ]
}

/// Positions of the samples of the strain, in the order of [`quadratic`].
pub const SAMPLES: [f64; 3] = [0.0, 1.0, 0.5];

impl Mesh {
    /// So many equal elements, cut once more where the section [asks for it](BladeSection::ends) and where bodies are, and each of these into
    /// so many parts.
    ///
    /// # Errors
    /// [`BladeError::Invalid`] if the length is not positive, if there is no element, or if a section makes none.
    pub fn new(
        setting: &Setting,
        (elements, parts): (usize, usize),
        section: &dyn BladeSection,
        torsion: bool,
        bodies: &[Body],
    ) -> Result<Mesh, BladeError> {
        let length = setting.length;
        if !(length.is_finite() && length > 0.0) || elements == 0 || parts == 0 {
            let message = format!(
                "a blade needs a positive length and at least one element, and has {length} m and {elements}"
            );
            return Err(BladeError::Invalid(message));
        }
        let mut nodes: Vec<f64> = (0..=elements).map(|i| length * (i as f64 / elements as f64)).collect();
        let near = 1e-9 * length;
        if let Some(body) = bodies.iter().find(|body| !(body.station > near && body.station <= length + near))
        {
            let message = format!(
                "the body at {} m is not on a blade of {length} m, or sits in its clamp",
                body.station
            );
            return Err(BladeError::Invalid(message));
        }
        for end in section.ends(&nodes.clone(), length / elements as f64) {
            match nodes.iter_mut().find(|node| (**node - end).abs() < near) {
                Some(node) => *node = end,
                None => nodes.push(end),
            }
        }
        for body in bodies {
            if nodes.iter().all(|node| (node - body.station).abs() >= near) {
                nodes.push(body.station);
            }
        }
        nodes.sort_by(f64::total_cmp);
        let mut cut = vec![0.0];
        for ends in nodes.windows(2) {
            let part = |k: usize| {
                if k == parts { ends[1] } else { ends[0] + (ends[1] - ends[0]) * k as f64 / parts as f64 }
            };
            cut.extend((1..=parts).map(part));
        }
        let nodes = cut;
        let (elements, components, places) = (Vec::new(), Vec::new(), Vec::new());
        let mut mesh = Mesh { elements, components, places, length, half: 0 };
        let mut node = mesh.node(0.0, torsion, true, false);
        for ends in nodes.windows(2) {
            let middle = mesh.unknown(Component::Torsion, false, 0.5 * (ends[0] + ends[1]), torsion);
            // The axial force jumps at a body, and the strain with it.
            let here = |body: &&Body| (body.station - ends[1]).abs() < near;
            let jumps =
                section.jumps().contains(&ends[1]) || (bodies.iter().any(|b| here(&b)) && ends[1] < length);
            let next = mesh.node(ends[1], torsion, false, jumps);
            let mut unknowns = [CLAMPED; LOCAL];
            for field in 0..3 {
                unknowns[4 * field..4 * field + 2].copy_from_slice(&node[2 * field..2 * field + 2]);
                unknowns[4 * field + 2..4 * field + 4].copy_from_slice(&next[2 * field..2 * field + 2]);
            }
            // The strain right of a jump is the last number of a node.
            unknowns[1] = node[7];
            (unknowns[12], unknowns[13], unknowns[14]) = (node[6], next[6], middle);
            let mut element = Element::new([ends[0], ends[1]], unknowns, section)?;
            let at_tip = if ends[1] == length { setting.tip } else { Tip::default() };
            element.body = bodies.iter().filter(here).fold(at_tip, |sum, body| Tip {
                mass: sum.mass + body.of.mass,
                inertia: sum.inertia + body.of.inertia,
            });
            mesh.elements.push(element);
            node = next;
        }
        for element in &mesh.elements {
            let used = || element.unknowns.iter().copied().filter(|&i| i != CLAMPED);
            if let (Some(first), Some(last)) = (used().min(), used().max()) {
                mesh.half = mesh.half.max(last - first);
            }
        }
        Ok(mesh)
    }

    /// Number of unknowns.
    pub fn len(&self) -> usize {
        self.components.len()
    }

    /// Size by which each unknown is measured: the length \[m\], for slopes and torsion 1.
    pub fn scales(&self) -> Vec<f64> {
        let unknowns = self.components.iter().zip(&self.places);
        let is_angle = |component, slope| slope || component == Component::Torsion;
        unknowns.map(|(&c, &(slope, _))| if is_angle(c, slope) { 1.0 } else { self.length }).collect()
    }

    /// Name of unknown `i` for messages, if there is one.
    pub fn name(&self, i: usize) -> Option<String> {
        let (component, (slope, x)) = self.components.get(i).zip(self.places.get(i))?;
        let what = match component {
            Component::Axial => "axial displacement",
            Component::Chordwise => "chordwise displacement",
            Component::Flapwise => "flapwise displacement",
            Component::Torsion => "torsion",
        };
        let of = if *slope { "slope of the " } else { "" };
        Some(format!("{of}{what} at x = {x:.6} m"))
    }

    /// Structure of the tangent.
    pub fn structure(&self) -> Structure {
        Structure::band(self.len(), self.half, self.half, 0).cheaper()
    }

    /// Unknowns of a node: u, u′, v, v′, w, w′, φ, and u′ on its right side.
    fn node(&mut self, x: f64, torsion: bool, root: bool, jumps: bool) -> [usize; 8] {
        let fields = [Component::Axial, Component::Chordwise, Component::Flapwise];
        let mut out = [CLAMPED; 8];
        for (k, field) in fields.into_iter().enumerate() {
            if !root {
                out[2 * k] = self.unknown(field, false, x, true);
            }
            if !root || field == Component::Axial {
                out[2 * k + 1] = self.unknown(field, true, x, true);
            }
            if k == 0 {
                out[7] = if jumps { self.unknown(field, true, x, true) } else { out[1] };
            }
        }
        if !root {
            out[6] = self.unknown(Component::Torsion, false, x, torsion);
        }
        out
    }

    /// Number of a new unknown.
    fn unknown(&mut self, component: Component, slope: bool, x: f64, exists: bool) -> usize {
        if !exists {
            return CLAMPED;
        }
        self.components.push(component);
        self.places.push((slope, x));
        self.components.len() - 1
    }
}

impl Element {
    fn new(
        ends: [f64; 2],
        unknowns: [usize; LOCAL],
        section: &dyn BladeSection,
    ) -> Result<Element, BladeError> {
        let h = ends[1] - ends[0];
        let mut cuts = vec![ends[0]];
        cuts.extend(section.breaks().iter().copied().filter(|&x| x > ends[0] && x < ends[1]));
        cuts.push(ends[1]);
        let gauss = Gauss::new(POINTS);
        let mut points = Vec::new();
        let mut axial = [[0.0; 3]; 3];
        for piece in cuts.windows(2) {
            for (x, weight) in gauss.on(piece[0], piece[1]) {
                let s = (x - ends[0]) / h;
                let section = section.resultants(x);
                if let Err(error) = section.validate() {
                    return Err(BladeError::Invalid(format!("at x = {x:.4} m: {error}")));
                }
                let m = quadratic(s, h);
                for (i, row) in axial.iter_mut().enumerate() {
                    for (j, entry) in row.iter_mut().enumerate() {
                        *entry += weight * section.axial_stiffness * m[0][i] * m[0][j];
                    }
                }
                points.push(Point { x, weight, n: hermite(s, h), m, section });
            }
        }
        Ok(Element { unknowns, ends, points, axial, body: Tip::default() })
    }

    /// The element's unknowns.
    pub fn gather(&self, q: &[f64]) -> [f64; LOCAL] {
        self.unknowns.map(|i| if i == CLAMPED { 0.0 } else { q[i] })
    }
}
