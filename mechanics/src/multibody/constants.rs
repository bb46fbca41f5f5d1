//! What does not change in a run: the model, the order of its unknowns, and what follows from both.

use super::body::four;
use super::channels::channels;
use super::force::angle_between;
use super::joint::{Coordinate, Drive};
use super::layout::{Link, layout};
use super::marker::Part;
use super::model::Model;
use super::rotation::{apply, apply_transposed, column, matrix, plus, product, quaternion};
use super::row::Row;
use crate::drive::force_breaks;
use crate::linalg::Structure;
use crate::linalg::vector::{cross, inner};
use crate::system::{Break, Channel, Frame, Set, Size, State, ordered};
use std::ops::Range;

/// What does not change in a run.
#[derive(Debug)]
pub(super) struct Constants {
    pub(super) model: Model,
    /// Place of each body in the order of the unknowns.
    pub(super) place: Vec<usize>,
    /// Part of each marker, and its frame from the centre of mass.
    pub(super) markers: Vec<(Part, Frame)>,
    /// Rows that are kept: joint and constraint.
    pub(super) rows: Vec<(usize, Row)>,
    /// The rows of each joint.
    pub(super) of_joint: Vec<Range<usize>>,
    pub(super) coordinates: Vec<Option<Coordinate>>,
    /// Number in q of each joint's angle.
    pub(super) angle: Vec<Option<usize>>,
    pub(super) sets: Vec<Set>,
    pub(super) scales: Vec<f64>,
    pub(super) structures: [Structure; 3],
    pub(super) breaks: Vec<Break>,
    pub(super) channels: Vec<Channel>,
    pub(super) dropped: Vec<String>,
    pub(super) size: Size,
}

impl Constants {
    /// Of a model with the given rows; and which joints belong to the tree.
    pub(super) fn new(model: Model, rows: Vec<(usize, Row)>, dropped: Vec<String>) -> (Constants, Vec<bool>) {
        let body = |part| match part {
            Part::Ground => None,
            Part::Body(i) => Some(i),
        };
        let range = |k: usize| {
            let first = rows.partition_point(|(joint, _)| *joint < k);
            first..rows.partition_point(|(joint, _)| *joint <= k)
        };
        let of_joint: Vec<Range<usize>> = (0..model.joints.len()).map(range).collect();
        let joints = model.joints.iter().zip(&of_joint);
        let mut links: Vec<Link> = joints
            .map(|(j, rows)| Link { nodes: [body(j.from.part), body(j.to.part)], rows: rows.len() })
            .collect();
        links.extend(
            model.springs.iter().map(|s| Link { nodes: [body(s.from.part), body(s.to.part)], rows: 0 }),
        );
        let plan = layout(&vec![6; model.bodies.len()], &links);
        let place: Vec<usize> = plan.first.iter().map(|first| first / 6).collect();
        let mut q = 7 * model.bodies.len();
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
        // Two markers for each joint, two for each spring, one for each load and each contact point.
        let joints = model.joints.iter().flat_map(|j| [j.from, j.to]);
        let springs = model.springs.iter().flat_map(|s| [s.from, s.to]);
        let markers = joints
            .chain(springs)
            .chain(model.loads.iter().map(|load| load.at))
            .chain(model.points.iter().copied());
        let markers: Vec<(Part, Frame)> = markers
            .map(|marker| {
                let centre = body(marker.part).map_or([0.0; 3], |i| model.bodies[i].centre);
                let position = plus(marker.frame.position, -1.0, centre);
                (marker.part, Frame { position, ..marker.frame })
            })
            .collect();
        let arms = markers.iter().filter(|(part, _)| *part != Part::Ground);
        let length = arms.map(|(_, f)| inner(f.position, f.position).sqrt()).fold(0.0, f64::max);
        let length = if length > 0.0 { length } else { 1.0 };
        let mut breaks: Vec<Break> = model.joints.iter().flat_map(|joint| joint.breaks()).collect();
        let amplitudes = model.loads.iter().filter_map(|load| load.amplitude.as_ref());
        breaks.extend(amplitudes.flat_map(|amplitude| force_breaks(amplitude.as_ref())));
        let (bodies, joints) = (model.bodies.len(), model.joints.len());
        let mut constants = Constants {
            size: Size { q, v: 6 * bodies, lambda: rows.len(), memory: 0 },
            sets: vec![Set::Free; rows.len()],
            scales: (0..6 * bodies).map(|i| if i % 6 < 3 { length } else { 1.0 }).collect(),
            structures: plan.structures,
            breaks: ordered(breaks),
            channels: Vec::new(),
            place,
            markers,
            rows,
            of_joint,
            coordinates,
            angle,
            dropped,
            model,
        };
        constants.channels = channels(&constants.model, &constants.coordinates);
        (constants, plan.in_tree[..joints].to_vec())
    }

    /// The state of the bodies as the model has them.
    pub(super) fn start(&self) -> State {
        let mut s = State::zeros(self.size, 0.0);
        for (body, place) in self.model.bodies.iter().zip(&self.place) {
            let r = &body.frame.rotation;
            let arm = apply(r, body.centre);
            let (q, v) = (&mut s.q[7 * place..], &mut s.v[6 * place..]);
            q[..3].copy_from_slice(&plus(body.frame.position, 1.0, arm));
            q[3..7].copy_from_slice(&quaternion(r));
            v[..3].copy_from_slice(&plus(body.velocity, 1.0, cross(body.spin, arm)));
            v[3..6].copy_from_slice(&apply_transposed(r, body.spin));
        }
        let mut q = s.q.clone();
        self.count_angles(&s.q, &mut q);
        // A prescribed angle begins in its own turn.
        for (joint, angle) in self.model.joints.iter().zip(&self.angle) {
            if let (Drive::Prescribed(motion), Some(i)) = (&joint.drive, *angle) {
                q[i] = nearest_turn(q[i], motion.at(0.0).angle);
            }
        }
        State { q, ..s }
    }

    /// A row, for messages.
    pub(super) fn row_name(&self, i: usize) -> String {
        self.rows.get(i).map_or_else(String::new, |(joint, row)| {
            format!("{} in joint `{}`", row.describe(), self.model.joints[*joint].name)
        })
    }

    /// Writes the angles of joints into `to`, each the nearest to that in `from`.
    pub(super) fn count_angles(&self, from: &[f64], to: &mut [f64]) {
        let bodies = 7 * self.place.len();
        let (to, angles) = to.split_at_mut(bodies);
        let rotation = |marker: usize| {
            let (part, frame) = &self.markers[marker];
            match part {
                Part::Ground => frame.rotation,
                Part::Body(i) => product(&matrix(four(to, 7 * self.place[*i] + 3)), &frame.rotation),
            }
        };
        for (k, angle) in self.angle.iter().enumerate() {
            if let Some(i) = *angle {
                let (a, b) = (rotation(2 * k), rotation(2 * k + 1));
                let axis = column;
                angles[i - bodies] =
                    nearest_turn(angle_between(axis(&a, 0), axis(&a, 1), axis(&b, 0)), from[i]);
            }
        }
    }
}

/// `angle` with the number of turns that brings it nearest to `to`.
fn nearest_turn(angle: f64, to: f64) -> f64 {
    angle + std::f64::consts::TAU * libm::round((to - angle) / std::f64::consts::TAU)
}
