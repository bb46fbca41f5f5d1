//! The equations of motion of bodies, beams and joints.
//!
//! Unknowns: (ṙ, Ω) of the bodies, in the order of the tree of joints, and behind them the velocities of the
//! [beams](super::Beam); multipliers in the order of the joints. The configuration holds (r, p) of the bodies in the same order,
//! q of the beams, and behind them the angle of every revolute and cylindrical joint, counted on beyond a turn.
//!
//! ```text
//! r = ⎡ m r̈ + β m ṙ − m g          ⎤ − Σ Jᵀ w,     w: wrenches of joints (λ n), springs, actuators and loads
//!     ⎣ J Ω̇ + Ω × J Ω + β J Ω      ⎦
//! r of a beam: its forces of strain, inertia and damping, less its weight and the loads along it
//! ∂(Jᵀ w) = Jᵀ (∂w/∂x J + ∂w/∂ẋ B) + ∂Jᵀ w
//! ```

use super::bending::Bending;
use super::body::Placed;
use super::constants::Constants;
use super::contact_point::ContactPoint;
use super::error::{DependentRow, ModelError};
use super::force::Interaction;
use super::joint::Drive;
use super::line_law::Sampled;
use super::marker::{MOST, Part, Pose};
use super::model::Model;
use super::on_axis::OnAxis;
use super::rotation::{Quaternion, rate};
use super::row::{Row, Value, Wrench};
use super::{consistency, start};
use crate::contact::Variation;
use crate::linalg::{Mat3, Matrix, Structure, Vec3};
use crate::profile::HubKinematics;
use crate::system::{
    Corotation, Dynamics, NotSet, Parameter, RowWeights, Set, Size, State, Steady, StiffnessForm, VisitRow,
    Weights,
};
use std::sync::Arc;

/// Velocities that two markers can have together.
const PAIR: usize = 2 * MOST;

/// Rigid bodies and beams with joints.
#[derive(Clone, Debug)]
pub struct Multibody {
    pub(super) constants: Arc<Constants>,
    /// Velocities at the start.
    pub(super) velocities: Vec<f64>,
    /// What the joints have changed of those given.
    pub(super) changes: Arc<[String]>,
    /// Part of the loads that acts.
    pub(super) part: f64,
    /// Whether kept angles are held.
    held: bool,
    pub(super) placed: Vec<Placed>,
    pub(super) poses: Vec<Pose>,
    /// Prescribed motion of each joint, and the time for which it was computed.
    pub(super) motions: Vec<HubKinematics>,
    /// Of the contact points on the axis of a beam, where each is.
    pub(super) on_axis: Vec<OnAxis>,
    /// Force laws at the points of their beams.
    pub(super) sampled: Vec<Sampled>,
    /// Of the states that were judged.
    pub(super) bending: Bending,
    /// How a contact point moves, while its curvature is added.
    pub(super) moved: Vec<Variation>,
    time: f64,
}

impl Multibody {
    /// The system of a model. Bodies must fit their joints at the start; velocities that are not given are those of rigid motions that the joints ask
    /// for, and those that do not obey the joints are replaced by the nearest that do, in the norm of kinetic energy:
    /// [cautions](crate::system::Observed::cautions) tell which.
    ///
    /// # Errors
    /// [`ModelError`].
    pub fn new(model: Model) -> Result<Multibody, ModelError> {
        model.check()?;
        let mut system = Multibody::assembled(model)?;
        let assemble = |model| {
            let system = Multibody::assembled(model).ok()?;
            let constants = system.constants.clone();
            Some((Box::new(system) as Box<dyn Dynamics>, constants))
        };
        let constants = system.constants.clone();
        let (velocities, changes) = start::velocities(&mut system, &constants, assemble)?;
        Ok(Multibody { velocities, changes: changes.into(), ..system })
    }

    /// The system at rest.
    pub(super) fn assembled(model: Model) -> Result<Multibody, ModelError> {
        let rows: Vec<(usize, Row)> = model
            .joints
            .iter()
            .enumerate()
            .flat_map(|(k, joint)| joint.rows().into_iter().map(move |row| (k, row)))
            .collect();
        let (constants, in_tree) = Constants::new(model, rows, Vec::new());
        let mut system = Multibody::with(constants);
        let (constants, start) = (system.constants.clone(), system.constants.start(&[]));
        consistency::positions(&mut system, &constants, &start)?;
        let found = consistency::redundant(&mut system, &constants, &start, &in_tree)?;
        if !found.is_empty() {
            if !constants.model.drop_redundant {
                let freedoms = constants.size.v + found.len() - constants.size.lambda;
                let rows = found.into_iter().map(|found| found.of).collect();
                return Err(ModelError::Redundant { rows, freedoms });
            }
            let kept = constants.rows.iter().enumerate();
            let kept = kept.filter(|(i, _)| found.iter().all(|of| of.row != *i)).map(|(_, row)| *row);
            let dropped = found.iter().map(|found| (found.of.clone(), constants.rows[found.row])).collect();
            let (constants, _) = Constants::new(constants.model.clone(), kept.collect(), dropped);
            system = Multibody::with(constants);
        }
        Ok(system)
    }

    /// The system with these constants.
    fn with(constants: Constants) -> Multibody {
        let poses = constants.markers.iter().map(|(part, frame)| match part {
            Part::Ground => Pose::grounded(*frame),
            Part::Body(i) => Pose::moved(6 * constants.place[*i], 6),
            Part::Section { beam, node } => {
                let of = &constants.model.beams[*beam].beam;
                of.pose(constants.beams[*beam][1] + of.place(*node)[1])
            }
        });
        let poses = poses.collect();
        let (bodies, joints) = (constants.place.len(), constants.of_joint.len());
        let on_axis = |point: &ContactPoint| match (point.beam(), point.axis) {
            (Some(beam), Some(along)) => OnAxis::new(&constants.model.beams[beam].beam, along),
            _ => OnAxis::default(),
        };
        let on_axis = constants.model.points.iter().map(on_axis).collect();
        let beams = &constants.model.beams;
        let laws = constants.model.line_laws.iter();
        let sampled = laws.map(|law| Sampled::new(law, &beams[law.beam].beam)).collect();
        Multibody {
            velocities: Vec::new(),
            changes: Arc::default(),
            constants: Arc::new(constants),
            part: 1.0,
            held: true,
            placed: vec![Placed::default(); bodies],
            poses,
            motions: vec![HubKinematics::default(); joints],
            on_axis,
            sampled,
            bending: Bending::default(),
            moved: Vec::with_capacity(12),
            time: f64::NAN,
        }
    }

    /// The model that it is made of.
    pub fn model(&self) -> &Model {
        &self.constants.model
    }

    /// Rows that were left out because they follow from others, each with the joints that it follows from.
    pub fn dropped(&self) -> impl ExactSizeIterator<Item = &DependentRow> {
        self.constants.dropped.iter().map(|(of, _)| of)
    }

    /// The rows that were left out, with their values at the state for which markers are placed.
    pub(super) fn values_of_dropped(&self) -> impl Iterator<Item = (&DependentRow, Row, Value)> {
        self.constants.dropped.iter().map(|(of, (joint, row))| {
            let (a, b) = self.ends(*joint);
            (of, *row, row.value(a, b, &self.motions[*joint]))
        })
    }

    /// Number of degrees of freedom: velocities less rows.
    pub fn freedoms(&self) -> usize {
        self.constants.size.v - self.constants.size.lambda
    }

    /// Places bodies and markers, but for those of contact points and their obstacles, each of which is placed where it is looked at.
    pub(super) fn place(&mut self, s: &State) {
        let Multibody { constants, placed, poses, motions, time, .. } = self;
        let own = constants.first_point;
        for (i, placed) in placed.iter_mut().enumerate() {
            *placed = Placed::new(&s.q[7 * i..], &s.v[6 * i..], &s.a[6 * i..]);
        }
        for (pose, (part, frame)) in poses[..own].iter_mut().zip(&constants.markers) {
            match part {
                Part::Ground => {}
                Part::Body(i) => pose.place(&placed[constants.place[*i]], frame),
                Part::Section { beam, node } => {
                    let [q, v] = constants.beams[*beam];
                    let of = &constants.model.beams[*beam].beam;
                    of.place_marker(*node, [&s.q[q..], &s.v[v..], &s.a[v..]], frame, pose);
                }
            }
        }
        if s.time() != *time {
            *time = s.time();
            for (joint, motion) in constants.model.joints.iter().zip(motions) {
                if let Some(prescribed) = joint.prescribed() {
                    *motion = prescribed.at(*time);
                }
            }
        }
    }

    /// The markers of joint `k`.
    pub(super) fn ends(&self, k: usize) -> (&Pose, &Pose) {
        (&self.poses[2 * k], &self.poses[2 * k + 1])
    }

    /// The markers of spring `k`.
    pub(super) fn spring_ends(&self, k: usize) -> (&Pose, &Pose) {
        self.ends(self.motions.len() + k)
    }

    /// The marker of load `k`.
    pub(super) fn load_end(&self, k: usize) -> &Pose {
        &self.poses[2 * (self.motions.len() + self.constants.model.springs.len()) + k]
    }

    /// Writes the wrench of joint `k`, with its derivatives if asked.
    pub(super) fn interact_joint(&self, s: &State, k: usize, differentiate: bool, work: &mut Interaction) {
        let constants = &*self.constants;
        work.clear(differentiate);
        let ((a, b), motion) = (self.ends(k), &self.motions[k]);
        for i in constants.of_joint[k].clone() {
            let (row, lambda) = (constants.rows[i].1, s.lambda[i]);
            work.add(lambda, &row.normal(a, b, motion));
            if differentiate {
                row.add_gradient(lambda, (a, b), motion, &mut work.gradient);
            }
        }
        let joint = &constants.model.joints[k];
        if let (Drive::Actuated(actuator), Some(coordinate)) = (&joint.drive, constants.coordinates[k])
            && !(self.held && joint.kept.is_some())
        {
            let motion = coordinate.motion(a, b, constants.angle[k].map(|i| s.q[i]));
            coordinate.interact(actuator, (a, b), &motion, s.time(), work, differentiate);
        }
    }

    /// Calls `visit` for every joint, spring and load with its markers and its wrench.
    pub(super) fn interactions(
        &self,
        s: &State,
        differentiate: bool,
        mut visit: impl FnMut(Option<&Pose>, &Pose, &Interaction),
    ) {
        let model = &self.constants.model;
        let mut work = Interaction::new();
        for k in 0..model.joints.len() {
            self.interact_joint(s, k, differentiate, &mut work);
            let (a, b) = self.ends(k);
            visit(Some(a), b, &work);
        }
        for (k, spring) in model.springs.iter().enumerate() {
            work.clear(differentiate);
            let (a, b) = self.spring_ends(k);
            spring.interact(a, b, &mut work, differentiate);
            visit(Some(a), b, &work);
        }
        for (k, load) in model.loads.iter().enumerate() {
            work.clear(differentiate);
            let b = self.load_end(k);
            load.interact(b, (s.time(), self.part), &mut work);
            visit(None, b, &work);
        }
    }

    /// Writes the tangent, with the stiffness of the strains of beams or without.
    pub(super) fn assemble(&mut self, s: &State, w: Weights<'_>, strains: bool, out: &mut Matrix) {
        out.clear();
        self.place(s);
        let constants = self.constants.clone();
        let model = &constants.model;
        for (body, &place) in model.bodies.iter().zip(&constants.place) {
            let (at, spin) = (6 * place, self.placed[place].spin);
            let gyro = Mat3::skew(spin) * body.inertia;
            let momentum = Mat3::skew(body.inertia * spin);
            let inertia = w.a + w.v * body.damping;
            for i in 0..3 {
                out.add(at + i, at + i, inertia * body.mass);
                for j in 0..3 {
                    let x = inertia * body.inertia[i][j] + w.v * (gyro[i][j] - momentum[i][j]);
                    out.add(at + 3 + i, at + 3 + j, x);
                }
            }
        }
        for (of, &[i, j]) in model.beams.iter().zip(&constants.beams) {
            let within = Weights { increment: w.increment.map(|d| &d[j..]), ..w };
            let (motion, field) = ([&s.q[i..], &s.v[j..], &s.a[j..]], self.part * model.gravity);
            if strains {
                of.beam.add_tangent(motion, field, &within, (j, out));
            } else {
                of.beam.add_unstrained_stiffness(motion, field, (j, out));
            }
        }
        if w.q == 0.0 && w.v == 0.0 {
            return;
        }
        let lines = model.line_loads.iter().zip(&constants.lines);
        for (load, on) in lines.filter(|(load, _)| load.follows()) {
            let [i, j] = constants.beams[load.beam];
            let (force, d) = (load.at(s.time(), self.part), w.increment.map(|d| &d[j..]));
            let force = -w.q * force;
            let beam = &model.beams[load.beam].beam;
            beam.add_line_tangent(on, &s.q[i..], force, d, (j, out));
        }
        for (law, sampled) in model.line_laws.iter().zip(&mut self.sampled) {
            let [i, j] = constants.beams[law.beam];
            let acting = (law.law.as_ref(), s.time(), -self.part);
            sampled.add_tangent(acting, [&s.q[i..], &s.v[j..]], &w, (j, out));
        }
        let own = constants.first_point;
        self.poses[..own].iter_mut().for_each(|pose| pose.transport());
        let ground = Pose::default();
        self.interactions(s, true, |a, b, interaction| {
            add_tangent((a.unwrap_or(&ground), b), interaction, &w, out);
        });
    }
}

/// Adds to `out` −w.q ∂(Jᵀ w)/∂q − w.v ∂(Jᵀ w)/∂v of a pair of markers.
fn add_tangent((a, b): (&Pose, &Pose), interaction: &Interaction, w: &Weights<'_>, out: &mut Matrix) {
    let count = a.count + b.count;
    let number = |k: usize| if k < a.count { a.numbers[k] } else { b.numbers[k - a.count] };
    // ∂w by the velocities of both parts: by their positions, and by themselves.
    let (mut by_q, mut by_v) = ([[0.0; PAIR]; 12], [[0.0; PAIR]; 12]);
    for (pose, at, side) in [(a, 0, 0), (b, a.count, 6)] {
        for i in 0..12 {
            for l in 0..6 {
                let (stiffness, damping) =
                    (interaction.gradient[i][side + l], interaction.damping[i][side + l]);
                if stiffness != 0.0 {
                    (0..pose.count).for_each(|k| by_q[i][at + k] += stiffness * pose.jacobian[l][k]);
                }
                if damping != 0.0 {
                    (0..pose.count).for_each(|k| by_q[i][at + k] += damping * pose.transport[l][k]);
                    (0..pose.count).for_each(|k| by_v[i][at + k] += damping * pose.jacobian[l][k]);
                }
            }
        }
    }
    let (mut k_q, mut k_v) = ([[0.0; PAIR]; PAIR], [[0.0; PAIR]; PAIR]);
    for (pose, at, side) in [(a, 0, 0), (b, a.count, 6)] {
        for k in 0..pose.count {
            for l in 0..6 {
                let x = pose.jacobian[l][k];
                if x != 0.0 {
                    (0..count).for_each(|j| k_q[at + k][j] += x * by_q[side + l][j]);
                    if interaction.damps {
                        (0..count).for_each(|j| k_v[at + k][j] += x * by_v[side + l][j]);
                    }
                }
            }
        }
        let [force, moment] = [interaction.wrench[side / 3], interaction.wrench[side / 3 + 1]];
        pose.add_curvature(1.0, force, moment, at, &mut k_q);
    }
    if let Some(d) = w.increment {
        a.follow(d, 0, &mut k_q[..count]);
        b.follow(d, a.count, &mut k_q[..count]);
    }
    for i in 0..count {
        for j in 0..count {
            out.add(number(i), number(j), -w.q * k_q[i][j] - w.v * k_v[i][j]);
        }
    }
}

impl Dynamics for Multibody {
    fn size(&self) -> Size {
        self.constants.size
    }

    fn structure(&self, multipliers: usize) -> Structure {
        self.constants.structures[multipliers.min(2)].clone()
    }

    fn scales(&self) -> &[f64] {
        &self.constants.scales
    }

    fn unknown(&self, i: usize) -> String {
        let Constants { size, place, model, .. } = &*self.constants;
        if i >= size.v {
            return self.constants.row_name((i - size.v) % size.lambda.max(1));
        }
        let axis = ["x", "y", "z"][i % 3];
        if let Some(k) = self.constants.beams.iter().rposition(|[_, first]| *first <= i) {
            let (of, first) = (&model.beams[k], self.constants.beams[k][1]);
            return format!("{} of `{}`", of.beam.unknown(i - first), of.name);
        }
        let body = place.iter().position(|place| *place == i / 6).map_or("", |k| &model.bodies[k].name);
        let what = if i % 6 < 3 {
            format!("velocity along {axis}")
        } else {
            format!("angular velocity about its {axis}")
        };
        format!("{what} of `{body}`")
    }

    fn initial(&self) -> State {
        State { v: self.velocities.clone(), ..self.constants.start(&[]) }
    }

    fn across(&self) -> Vec<usize> {
        self.constants.across()
    }

    fn is_vector_space(&self) -> bool {
        false
    }

    fn retract(&self, q: &[f64], d: &[f64], out: &mut [f64]) {
        for i in 0..self.placed.len() {
            let (q, d, out) = (&q[7 * i..], &d[6 * i..], &mut out[7 * i..]);
            (Vec3::at(q, 0) + Vec3::at(d, 0)).put(out, 0);
            let turned = Quaternion::at(q, 3) * Quaternion::exponential(Vec3::at(d, 3));
            out[3..7].copy_from_slice(&turned.normalized().0);
        }
        for (of, &[i, j]) in self.constants.model.beams.iter().zip(&self.constants.beams) {
            of.beam.retract(&q[i..], &d[j..], &mut out[i..]);
        }
        self.constants.count_angles(q, d, out);
    }

    fn difference(&self, from: &[f64], to: &[f64], d: &mut [f64]) {
        for i in 0..self.placed.len() {
            let (from, to, d) = (&from[7 * i..], &to[7 * i..], &mut d[6 * i..]);
            (Vec3::at(to, 0) - Vec3::at(from, 0)).put(d, 0);
            (Quaternion::at(from, 3).inverse() * Quaternion::at(to, 3)).logarithm().put(d, 3);
        }
        for (of, &[i, j]) in self.constants.model.beams.iter().zip(&self.constants.beams) {
            of.beam.difference(&from[i..], &to[i..], &mut d[j..]);
        }
    }

    fn rate(&self, from: &[f64], d: &[f64], v: &[f64], out: &mut [f64]) {
        for i in 0..self.placed.len() {
            let (d, v, out) = (&d[6 * i..], &v[6 * i..], &mut out[6 * i..]);
            out[..3].copy_from_slice(&v[..3]);
            rate(Vec3::at(d, 3), Vec3::at(v, 3)).put(out, 3);
        }
        for (of, &[i, j]) in self.constants.model.beams.iter().zip(&self.constants.beams) {
            let end = j + of.beam.velocities();
            of.beam.rate(&from[i..], &d[j..], &v[j..end], &mut out[j..end]);
        }
    }

    fn residual(&mut self, s: &State, r: &mut [f64]) {
        self.place(s);
        let model = &self.constants.model;
        for (body, &place) in model.bodies.iter().zip(&self.constants.place) {
            let Placed { velocity, spin, acceleration, spin_rate, .. } = self.placed[place];
            let (m, beta) = (body.mass, body.damping);
            let force = m * (acceleration + beta * velocity - self.part * model.gravity);
            let moment = body.inertia * (spin_rate + beta * spin) + spin.cross(body.inertia * spin);
            force.put(r, 6 * place);
            moment.put(r, 6 * place + 3);
        }
        let beams = 6 * self.placed.len();
        for (r, weight) in r[beams..].iter_mut().zip(&self.constants.weight[beams..]) {
            *r = -self.part * weight;
        }
        for (of, &[i, j]) in model.beams.iter().zip(&self.constants.beams) {
            let motion = [&s.q[i..], &s.v[j..], &s.a[j..]];
            of.beam.add_forces(motion, self.part * model.gravity, &mut r[j..]);
        }
        for (load, on) in model.line_loads.iter().zip(&self.constants.lines) {
            let [i, j] = self.constants.beams[load.beam];
            let force = -load.at(s.time(), self.part);
            let beam = &model.beams[load.beam].beam;
            beam.add_line_load(on, &s.q[i..], force, load.follows(), &mut r[j..]);
        }
        for (law, sampled) in model.line_laws.iter().zip(&mut self.sampled) {
            let [i, j] = self.constants.beams[law.beam];
            let acting = (law.law.as_ref(), s.time(), -self.part);
            sampled.add_forces(acting, [&s.q[i..], &s.v[j..]], &mut r[j..]);
        }
        self.interactions(s, false, |a, b, interaction| {
            let [f_a, m_a, f_b, m_b] = interaction.wrench;
            if let Some(a) = a {
                a.add_force(-1.0, f_a, m_a, r);
            }
            b.add_force(-1.0, f_b, m_b, r);
        });
    }

    /// Velocities of bodies and nodes, ṙ′, and the forces of joints in a point rotate with their parts.
    fn corotate(&self, before: &State, now: &State, out: &mut Corotation) {
        let constants = &*self.constants;
        out.clear();
        for i in 0..self.placed.len() {
            let turned = Quaternion::at(&now.q, 7 * i + 3) * Quaternion::at(&before.q, 7 * i + 3).inverse();
            out.push_vectors::<1>(6 * i, turned.matrix().0);
        }
        for (of, &[q, v]) in constants.model.beams.iter().zip(&constants.beams) {
            of.beam.corotate([&before.q[q..], &now.q[q..]], v, out);
        }
        for (joint, rows) in constants.model.joints.iter().zip(&constants.of_joint) {
            let in_a_point = |k: usize| {
                let row = constants.rows[rows.clone()].get(k);
                row.is_some_and(|(_, row)| *row == Row::Point(k))
            };
            if !(0..3).all(in_a_point) {
                continue;
            }
            let part = if joint.to.part == Part::Ground { joint.from.part } else { joint.to.part };
            let turned = match part {
                Part::Ground => continue,
                Part::Body(i) => {
                    let at = 7 * constants.place[i] + 3;
                    (Quaternion::at(&now.q, at) * Quaternion::at(&before.q, at).inverse()).matrix()
                }
                Part::Section { beam, node } => {
                    let q = constants.beams[beam][0];
                    constants.model.beams[beam].beam.rotation(node, &before.q[q..], &now.q[q..])
                }
            };
            out.push_vectors::<1>(constants.size.v + rows.start, turned.0);
        }
    }

    fn rows(&self) -> &[Set] {
        &self.constants.sets[usize::from(!self.held)]
    }

    fn constraint(&mut self, s: &State, c: RowWeights, g: &mut [f64]) {
        self.place(s);
        for (g, (joint, row)) in g.iter_mut().zip(&self.constants.rows) {
            let (a, b) = self.ends(*joint);
            *g = row.value(a, b, &self.motions[*joint]).combine(c);
        }
    }

    fn dropped(&mut self, s: &State) -> [f64; 3] {
        if self.constants.dropped.is_empty() {
            return [0.0; 3];
        }
        self.place(s);
        self.values_of_dropped().fold([0.0; 3], |largest, (_, _, value)| {
            let [g, rate, acceleration] = largest;
            [g.max(value.g.abs()), rate.max(value.rate.abs()), acceleration.max(value.acceleration.abs())]
        })
    }

    fn jacobian(&mut self, s: &State, visit: &mut VisitRow<'_>) {
        self.place(s);
        for (i, (joint, row)) in self.constants.rows.iter().enumerate() {
            let (a, b) = self.ends(*joint);
            let normal: Wrench = row.normal(a, b, &self.motions[*joint]);
            let (mut numbers, mut entries) = ([0; PAIR], [0.0; PAIR]);
            for (pose, at, [force, moment]) in
                [(a, 0, [normal[0], normal[1]]), (b, a.count, [normal[2], normal[3]])]
            {
                for k in 0..pose.count {
                    numbers[at + k] = pose.numbers[k];
                    let column = |first: usize| [0, 1, 2].map(|l| pose.jacobian[first + l][k]);
                    entries[at + k] = force.dot(Vec3(column(0))) + moment.dot(Vec3(column(3)));
                }
            }
            let count = a.count + b.count;
            visit(i, &numbers[..count], &entries[..count]);
        }
    }

    fn tangent(&mut self, s: &State, w: Weights<'_>, out: &mut Matrix) {
        self.assemble(s, w, true, out);
    }

    fn stiffness_forms(&mut self, s: &State, vectors: &[Vec<f64>]) -> Option<Vec<StiffnessForm>> {
        let rest = self.unstrained_stiffness(s);
        Some(self.forms(s, &rest, vectors))
    }
}

impl Steady for Multibody {
    fn set(&mut self, parameter: Parameter, value: f64) -> Result<(), NotSet> {
        match parameter {
            Parameter::LoadFactor => self.part = value,
            Parameter::Speed | Parameter::Azimuth => return Err(NotSet::Unknown(parameter)),
        }
        Ok(())
    }

    fn hold(&mut self, held: bool) {
        self.held = held;
    }

    fn release(&mut self) {
        self.part = 1.0;
    }
}
