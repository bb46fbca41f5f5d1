//! What does not change in a run: the model, the order of its unknowns, and what follows from both.

use super::body::Twist;
use super::contact_point::ContactPoint;
use super::error::DependentRow;
use super::force::angle_between;
use super::joint::Coordinate;
use super::layout::{Link, layout};
use super::line_load::LineDistribution;
use super::marker::Part;
use super::model::Model;
use super::rotation::Quaternion;
use super::row::Row;
use crate::drive::force_breaks;
use crate::linalg::{Mat3, Structure, Vec3};
use crate::system::{Break, Frame, Set, Size, State, ordered};
use std::ops::Range;

/// Part of a row in a combination of rows that counts.
const COUNTS: f64 = 1e-6;
/// How far the cosine of two axes that count as one may be from one.
const ALIGNED: f64 = 1e-12;

/// What does not change in a run.
#[derive(Debug)]
pub(super) struct Constants {
    pub(super) model: Model,
    /// Place of each body in the order of the unknowns.
    pub(super) place: Vec<usize>,
    /// Number of the first coordinate and of the first velocity of each beam.
    pub(super) beams: Vec<[usize; 2]>,
    /// Of each load along a beam where and with which weights it acts.
    pub(super) lines: Vec<LineDistribution>,
    /// Forces of gravity on the beams.
    pub(super) weight: Vec<f64>,
    /// Number of the marker of the first contact point.
    pub(super) first_point: usize,
    /// Of each contact point the marker that carries its obstacle.
    pub(super) carriers: Vec<Option<usize>>,
    /// Part of each marker, and its frame from the centre of mass.
    pub(super) markers: Vec<(Part, Frame)>,
    /// Rows that are kept: joint and constraint.
    pub(super) rows: Vec<(usize, Row)>,
    /// The rows of each joint.
    pub(super) of_joint: Vec<Range<usize>>,
    pub(super) coordinates: Vec<Option<Coordinate>>,
    /// Number in q of each joint's angle.
    pub(super) angle: Vec<Option<usize>>,
    /// The sets of the multipliers, and the same with the [kept angles](super::joint::Joint) free.
    pub(super) sets: [Vec<Set>; 2],
    pub(super) scales: Vec<f64>,
    pub(super) structures: [Structure; 3],
    pub(super) breaks: Vec<Break>,
    /// Rows that are left out.
    pub(super) dropped: Vec<(DependentRow, (usize, Row))>,
    pub(super) size: Size,
}

impl Constants {
    /// The velocities across the plane of x and y, in which the model stays: along z, and about the tangents and the axes of bodies that
    /// lie in it. None of a model that is not in the plane, or has a body of which no axis is that of z.
    pub(super) fn across(&self) -> Vec<usize> {
        let mut across = Vec::new();
        if !self.model.in_plane {
            return across;
        }
        for (body, place) in self.model.bodies.iter().zip(&self.place) {
            let normal = body.frame.rotation[2];
            let Some(about) = (0..3).find(|k| normal[*k].abs() > 1.0 - ALIGNED) else { return Vec::new() };
            across.push(6 * place + 2);
            across.extend((0..3).filter(|k| *k != about).map(|k| 6 * place + 3 + k));
        }
        for (of, [_, first]) in self.model.beams.iter().zip(&self.beams) {
            if !of.beam.put_across(*first, &mut across) {
                return Vec::new();
            }
        }
        across
    }

    /// Of a model with the given rows; and which joints belong to the tree.
    pub(super) fn new(
        model: Model,
        rows: Vec<(usize, Row)>,
        dropped: Vec<(DependentRow, (usize, Row))>,
    ) -> (Constants, Vec<bool>) {
        let mut model = model;
        let bodies = model.bodies.len();
        // Bodies and nodes of beams as the nodes of a graph.
        let (mut sizes, mut chains, mut elements) = (vec![6; bodies], Vec::new(), Vec::new());
        let (mut q, mut v, mut beams) = (7 * bodies, 6 * bodies, Vec::new());
        for of in &mut model.beams {
            of.beam.damp(of.damping, of.viscosity);
            chains.push(sizes.len());
            beams.push([q, v]);
            elements.extend(of.beam.links(sizes.len()));
            sizes.extend(of.beam.sizes());
            (q, v) = (q + of.beam.coordinates(), v + of.beam.velocities());
        }
        let body = |part| match part {
            Part::Ground => None,
            Part::Body(i) => Some(i),
            Part::Section { beam, node } => Some(chains[beam] + node),
        };
        let range = |k: usize| {
            let first = rows.partition_point(|(joint, _)| *joint < k);
            first..rows.partition_point(|(joint, _)| *joint <= k)
        };
        let of_joint: Vec<Range<usize>> = (0..model.joints.len()).map(range).collect();
        let joints = model.joints.iter().zip(&of_joint);
        let mut links: Vec<Link> =
            joints.map(|(j, rows)| Link::new([body(j.from.part), body(j.to.part)], rows.len())).collect();
        links.extend(elements);
        links.extend(model.springs.iter().map(|s| Link::new([body(s.from.part), body(s.to.part)], 0)));
        for point in &model.points {
            let Some(carrier) = point.carrier.and_then(|on| body(on.part)) else { continue };
            // Any point of an axis may be the one that touches.
            match point.beam() {
                Some(beam) => {
                    let nodes = chains[beam]..chains[beam] + model.beams[beam].beam.nodes().len();
                    let link = |node| Link { nodes: [Some(node), Some(carrier)], rows: 0, along: false };
                    links.extend(nodes.map(link));
                }
                None => links.push(Link::new([body(point.at.part), Some(carrier)], 0)),
            }
        }
        let plan = layout(&sizes, bodies, &links);
        let place: Vec<usize> = plan.first[..bodies].iter().map(|first| first / 6).collect();
        let coordinates: Vec<_> = model.joints.iter().map(|joint| joint.kind.coordinate()).collect();
        let angle: Vec<Option<usize>> = coordinates
            .iter()
            .map(|coordinate| {
                (*coordinate == Some(Coordinate::Angle)).then(|| {
                    q += 1;
                    q - 1
                })
            })
            .collect();
        // Two markers for each joint, two for each spring, one for each load and each contact point, and one for each obstacle that a part carries.
        let joints = model.joints.iter().flat_map(|j| [j.from, j.to]);
        let springs = model.springs.iter().flat_map(|s| [s.from, s.to]);
        let markers = joints
            .chain(springs)
            .chain(model.loads.iter().map(|load| load.at))
            .chain(model.points.iter().map(|point| point.at))
            .chain(model.points.iter().filter_map(|point| point.carrier));
        let markers: Vec<(Part, Frame)> = markers
            .map(|marker| {
                let centre = match marker.part {
                    Part::Body(i) => model.bodies[i].centre,
                    _ => Vec3::ZERO,
                };
                let position = marker.frame.position - centre;
                (marker.part, Frame { position, ..marker.frame })
            })
            .collect();
        let arms = markers.iter().filter(|(part, _)| *part != Part::Ground);
        let length = arms.map(|(_, f)| f.position.dot(f.position).sqrt());
        let spans = model.beams.iter().map(|of| (0..of.beam.elements()).map(|e| of.beam.length(e)).sum());
        let length = length.chain(spans).fold(0.0, f64::max);
        let length = if length > 0.0 { length } else { 1.0 };
        let mut breaks: Vec<Break> = model.joints.iter().flat_map(|joint| joint.breaks()).collect();
        let amplitudes = model.loads.iter().map(|load| &load.amplitude);
        let amplitudes = amplitudes.chain(model.line_loads.iter().map(|load| &load.amplitude));
        breaks.extend(amplitudes.flatten().flat_map(|amplitude| force_breaks(amplitude.as_ref())));
        let mut weight = vec![0.0; v];
        for (of, [_, at]) in model.beams.iter().zip(&beams) {
            of.beam.add_weight(model.gravity, &mut weight[*at..]);
        }
        let joints = model.joints.len();
        let mut scales: Vec<f64> = (0..6 * bodies).map(|i| if i % 6 < 3 { length } else { 1.0 }).collect();
        for of in &model.beams {
            scales.extend(of.beam.scales(length));
        }
        let constants = Constants {
            size: Size { q, v, lambda: rows.len(), memory: 0 },
            sets: [true, false].map(|held| sets(&model, &rows, held)),
            scales,
            beams,
            lines: model
                .line_loads
                .iter()
                .map(|load| model.beams[load.beam].beam.distribution(load))
                .collect(),
            weight,
            structures: plan.structures,
            breaks: ordered(breaks),
            place,
            first_point: 2 * (model.joints.len() + model.springs.len()) + model.loads.len(),
            carriers: carriers(&model, markers.len()),
            markers,
            rows,
            of_joint,
            coordinates,
            angle,
            dropped,
            model,
        };
        (constants, plan.in_tree[..joints].to_vec())
    }

    /// The state of the bodies and beams as the model has them; what it does not give of their velocities is that of these twists, bodies
    /// first, or zero.
    pub(super) fn start(&self, twists: &[Twist]) -> State {
        let mut s = State::zeros(self.size, 0.0);
        let bodies = self.model.bodies.len();
        let twist = |i: usize, velocity: Option<Vec3>, spin: Option<Vec3>| {
            let [v, w] = twists.get(i).copied().unwrap_or_default();
            [velocity.unwrap_or(v), spin.unwrap_or(w)]
        };
        for (i, (body, place)) in self.model.bodies.iter().zip(&self.place).enumerate() {
            let [velocity, spin] = twist(i, body.velocity, body.spin);
            let r = body.frame.rotation;
            let arm = r * body.centre;
            let (q, v) = (&mut s.q[7 * place..], &mut s.v[6 * place..]);
            (body.frame.position + arm).put(q, 0);
            q[3..7].copy_from_slice(&Quaternion::from(r).0);
            (velocity + spin.cross(arm)).put(v, 0);
            (r.transpose() * spin).put(v, 3);
        }
        for (i, (of, &[q, v])) in self.model.beams.iter().zip(&self.beams).enumerate() {
            let n = of.beam.coordinates();
            s.q[q..q + n].copy_from_slice(of.beam.initial());
            let [velocity, spin] = twist(bodies + i, of.velocity, of.spin);
            of.beam.move_rigidly(velocity, spin, &s.q[q..q + n], &mut s.v[v..]);
        }
        let mut q = s.q.clone();
        self.count_angles(&s.q, &vec![0.0; s.v.len()], &mut q);
        // A prescribed angle begins in its own turn.
        for (joint, angle) in self.model.joints.iter().zip(&self.angle) {
            if let (Some(motion), Some(i)) = (joint.prescribed(), *angle) {
                q[i] = nearest_turn(q[i], motion.at(0.0).angle);
            }
        }
        State { q, ..s }
    }

    /// The joints whose rows have more than `least` in a combination of rows.
    pub(super) fn joints_in(&self, combination: &[f64], least: f64) -> Vec<usize> {
        let parts = self.rows.iter().zip(combination).filter(|(_, c)| c.abs() > least);
        let mut joints: Vec<usize> = parts.map(|((joint, _), _)| *joint).collect();
        joints.dedup();
        joints
    }

    /// A row that a combination of rows makes.
    pub(super) fn dependent_row(&self, i: usize, combination: &[f64]) -> DependentRow {
        let ((joint, row), name) = (self.rows[i], |joint: usize| self.model.joints[joint].name.clone());
        let others = self.joints_in(combination, COUNTS).into_iter().filter(|other| *other != joint);
        let others = others.map(|other| (other, name(other))).collect();
        DependentRow { joint, name: name(joint), keeps: row.describe(), others }
    }

    /// A row, for messages.
    pub(super) fn row_name(&self, i: usize) -> String {
        self.rows.get(i).map_or_else(String::new, |(joint, row)| {
            format!("{} in joint `{}`", row.describe(), self.model.joints[*joint].name)
        })
    }

    /// Writes the angles of joints into `to` = `from` ⊞ `d`. The rotations of both parts give an angle but for whole turns; these are
    /// those that bring it nearest to θ + a·(δθ_B − δθ_A), with the axis a of the joint at `from` and the rotation vectors of the
    /// increment, which may be of several turns.
    pub(super) fn count_angles(&self, from: &[f64], d: &[f64], to: &mut [f64]) {
        let count = self.angle.iter().flatten().count();
        let before = to.len() - count;
        let (to, angles) = to.split_at_mut(before);
        for (k, angle) in self.angle.iter().enumerate() {
            if let Some(i) = *angle {
                let (a, b) = (self.axes_of(2 * k, to), self.axes_of(2 * k + 1, to));
                let found = angle_between(a.column(0), a.column(1), b.column(0));
                angles[i - before] = nearest_turn(found, from[i] + self.turned(k, from, d, to));
            }
        }
    }

    /// The axes of a marker.
    fn axes_of(&self, marker: usize, q: &[f64]) -> Mat3 {
        let (part, frame) = &self.markers[marker];
        match part {
            Part::Ground => frame.rotation,
            Part::Section { beam, node } => {
                let section = self.model.beams[*beam].beam.node(*node, &q[self.beams[*beam][0]..]);
                section.rotation * frame.rotation
            }
            Part::Body(i) => Quaternion::at(q, 7 * self.place[*i] + 3).matrix() * frame.rotation,
        }
    }

    /// a·(δθ_B − δθ_A) of a joint, 0 where less than a radian.
    fn turned(&self, k: usize, from: &[f64], d: &[f64], to: &[f64]) -> f64 {
        let increment = |marker: usize| match self.markers[marker].0 {
            Part::Ground => None,
            Part::Body(i) => {
                let vector = Vec3::at(d, 6 * self.place[i] + 3);
                let turns = vector.dot(vector) > 1.0;
                turns.then(|| Quaternion::at(from, 7 * self.place[i] + 3).matrix() * vector)
            }
            Part::Section { beam, node } => {
                let [q, v] = self.beams[beam];
                self.model.beams[beam].beam.turned(node, &from[q..], &d[v..], &to[q..])
            }
        };
        let (a, b) = (increment(2 * k), increment(2 * k + 1));
        if a.is_none() && b.is_none() {
            return 0.0;
        }
        let axis = self.axes_of(2 * k, from).column(2);
        axis.dot(b.unwrap_or_default()) - axis.dot(a.unwrap_or_default())
    }
}

/// The number of the marker that carries the obstacle of each contact point, the last of so many.
fn carriers(model: &Model, markers: usize) -> Vec<Option<usize>> {
    let mut next = markers - model.points.iter().filter(|point| point.carrier.is_some()).count();
    let mut number = |point: &ContactPoint| {
        point.carrier.map(|_| {
            next += 1;
            next - 1
        })
    };
    model.points.iter().map(&mut number).collect()
}

/// The sets of multipliers. A kept angle that is not held has none of the rows of a joint: its equation is λ = 0, as that of friction
/// with the coefficient zero.
fn sets(model: &Model, rows: &[(usize, Row)], held: bool) -> Vec<Set> {
    let is_free =
        |(joint, row): &(usize, Row)| !held && *row == Row::Angle && model.joints[*joint].kept.is_some();
    let friction = |normal| Set::Friction { coefficient: 0.0, normal };
    let set = |(i, row)| if is_free(row) { friction(i) } else { Set::Free };
    rows.iter().enumerate().map(set).collect()
}

/// `angle` with the number of turns that brings it nearest to `to`.
pub(super) fn nearest_turn(angle: f64, to: f64) -> f64 {
    angle + std::f64::consts::TAU * libm::round((to - angle) / std::f64::consts::TAU)
}
