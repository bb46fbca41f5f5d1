//! A model seen from a frame that rotates steadily.
//!
//! The frame rotates at Ω about an axis through c with the unit vector e. With x′ for what it sees, at the instant at which its
//! axes are the inertial ones, the motion in inertial axes is
//!
//! ```text
//! frames    ṙ = ṙ′ + Ω e × (r − c),   r̈ = r̈′ + 2Ω e × ṙ′ + Ω² e × (e × (r − c))
//!           ω = ω′ + Ω Rᵀe,           ω̇ = ω̇′ + Ω Rᵀe × ω′        (own axes)
//! slender   r and r′ alike, c = 0 for r′;   w = w′ + Ω e·t,   ẇ = ẇ′ + Ω e·ṫ′
//! ```
//!
//! for the frames of bodies and of the sections of beams with shear, and for slender beams,
//!
//! so that the forces of inertia, centrifugal and Coriolis forces among them, are those of the model in inertial axes. Their
//! derivatives follow by the chain rule: with v = v′ + A(q) and a = a′ + B(q, v′),
//!
//! ```text
//! M′ = M,    C′ = C + M ∂B/∂v′,    K′ = K + C ∂A/∂q + M ∂B/∂q
//! ```
//!
//! The ground rotates with the frame, and so do loads whose components are given in fixed axes: they must lie along the axis, or are
//! taken as they stand at one [instant](Rotating::at_an_instant).

use super::axis::Axis;
use super::beam::Beam;
use super::constants::Constants;
use super::force::Axes;
use super::slender::{self, Triad};
use super::system::Multibody;
use crate::linalg::{Mat3, Matrix, Structure, Vec3};
use crate::system::{
    Direction, Dynamics, Energy, Events, Frame, Limit, NotSet, Observed, Parameter, RowWeights, Set, Sink,
    Size, Slender, State, Steady, StiffnessForm, VisitRow, Weights,
};
use std::sync::Arc;

/// Part of a load across the axis, over the load, that counts as rounding.
const ACROSS: f64 = 1e-9;

/// A model in a frame that rotates: for equilibria and modes, whose tangents are right at rest in the frame, v′ = a′ = 0.
#[derive(Clone, Debug)]
pub struct Rotating {
    inner: Multibody,
    axis: Axis,
    speed: f64,
    /// Whether loads across the axis are taken as they stand.
    instant: bool,
    /// What it stands on before loads of a fixed direction are turned.
    level: Option<Arc<Constants>>,
}

/// A row of the derivatives of v and a: the unknown, and for others ∂A/∂q, ∂B/∂q and ∂B/∂v′.
type Row = (usize, Vec<(usize, [f64; 3])>);

impl Rotating {
    /// The model in a frame that rotates about an axis, at rest to begin with.
    pub fn new(inner: Multibody, axis: Axis) -> Rotating {
        Rotating { inner, axis, speed: 0.0, instant: false, level: None }
    }

    /// The model with the loads across the axis that a frame sees at the instant at which its axes are the inertial ones. An equilibrium
    /// under them is none of the motion, in which they rotate against the frame: it is what a slow rotation passes through.
    #[must_use]
    pub fn at_an_instant(mut self) -> Rotating {
        self.instant = true;
        self
    }

    /// The model.
    pub fn model(&mut self) -> &mut Multibody {
        &mut self.inner
    }

    /// The state in inertial axes, which are those of the frame at this instant: the configuration `s` with the velocities and
    /// accelerations of the rotation added. A [`Multibody`] that begins with it goes on as the frame sees `s`, with drives that hold the speed.
    pub fn in_space(&mut self, s: &State) -> State {
        self.place(s);
        self.inertial(s)
    }

    /// Turns gravity and loads of a fixed direction to where the frame sees them at an azimuth \[rad\], and all else not.
    fn turn_loads(&mut self, azimuth: f64) {
        let level = self.level.get_or_insert_with(|| self.inner.constants.clone());
        let mut model = level.model.clone();
        model.turn_loads(&self.axis, -azimuth);
        let (constants, _) = Constants::new(model, level.rows.clone(), level.dropped.clone());
        self.inner.constants = Arc::new(constants);
    }

    /// The name of a load that the frame sees rotate, for a message: it keeps its direction in space, across the axis.
    pub fn unsteady(&self) -> Option<String> {
        let across = |x: Vec3| self.axis.direction.cross(x).norm() > ACROSS * x.norm();
        let model = &self.inner.constants.model;
        let fixed = model.loads.iter().filter(|load| load.axes == Axes::Dead);
        let load = fixed.filter(|load| across(load.force) || across(load.moment)).map(|load| &load.name);
        let lines = model.line_loads.iter().filter(|load| load.axes == Axes::Dead && across(load.force));
        match load.chain(lines.map(|load| &load.name)).next() {
            Some(name) => Some(format!("the load `{name}`")),
            None if model.line_laws.iter().any(|of| !of.law.is_isotropic()) => Some("a force law".to_owned()),
            None if across(model.gravity) => Some("gravity".to_owned()),
            None => None,
        }
    }

    /// The state in inertial axes.
    fn inertial(&self, s: &State) -> State {
        let mut out = s.clone();
        let (e, speed) = (self.axis.direction, self.speed);
        let point = |out: &mut State, q: usize, v: usize, from: Vec3| {
            let (x, rate) = (Vec3::at(&s.q, q) - from, Vec3::at(&s.v, v));
            let carried = speed * e.cross(x);
            let change = 2.0 * e.cross(rate) + e.cross(carried);
            for k in 0..3 {
                out.v[v + k] += carried[k];
                out.a[v + k] += speed * change[k];
            }
        };
        self.frames(s, |q, v, rotation| {
            point(&mut out, q, v, self.axis.point);
            let own = self.own_axis(&rotation);
            let change = own.cross(Vec3::at(&s.v, v + 3));
            for k in 0..3 {
                out.v[v + 3 + k] += speed * own[k];
                out.a[v + 3 + k] += speed * change[k];
            }
        });
        self.slender_nodes(|q, v| {
            point(&mut out, q, v, self.axis.point);
            point(&mut out, q + 3, v + 3, Vec3::ZERO);
        });
        self.slender_sections(s, |unknown, triad, slope_of| {
            let along = across_tangent(e, &triad);
            let rate: Vec3 = slope_of.iter().fold(Vec3::ZERO, |sum, (c, v)| sum + *c * Vec3::at(&s.v, *v));
            out.v[unknown] += speed * e.dot(triad.tangent);
            out.a[unknown] += speed * along.dot(rate);
        });
        out
    }

    /// Rᵀe
    fn own_axis(&self, rotation: &Mat3) -> Vec3 {
        rotation.transpose() * self.axis.direction
    }

    /// Calls `visit` with the first coordinate, the first velocity and the axes of every body and of every section of a beam with shear.
    fn frames(&self, s: &State, mut visit: impl FnMut(usize, usize, Mat3)) {
        for (i, placed) in self.inner.placed.iter().enumerate() {
            visit(7 * i, 6 * i, placed.rotation);
        }
        let constants = &self.inner.constants;
        for (of, &[first_q, first_v]) in constants.model.beams.iter().zip(&constants.beams) {
            if of.beam.has_shear() {
                for node in 0..of.beam.nodes().len() {
                    let [q, v] = of.beam.place(node);
                    visit(first_q + q, first_v + v, of.beam.node(node, &s.q[first_q..]).rotation);
                }
            }
        }
    }

    /// The slender beams, and where their coordinates and velocities begin.
    fn slender(&self) -> impl Iterator<Item = (&slender::Beam, &Beam, [usize; 2])> {
        let constants = &self.inner.constants;
        constants.model.beams.iter().zip(&constants.beams).filter_map(|(of, first)| match &of.beam {
            Beam::Slender(beam) => Some((beam, &of.beam, *first)),
            Beam::Shear(_) => None,
        })
    }

    /// Calls `visit` with the first coordinate and the first velocity of every node of a slender beam.
    fn slender_nodes(&self, mut visit: impl FnMut(usize, usize)) {
        for (beam, of, [q, v]) in self.slender() {
            (0..beam.nodes().len()).for_each(|node| visit(q + of.place(node)[0], v + of.place(node)[1]));
        }
    }

    /// Calls `visit` for every section with a spin: its unknown, its axes, and r′ there as a sum of three velocities each, with
    /// the factors and the numbers of the first.
    fn slender_sections(&self, s: &State, mut visit: impl FnMut(usize, Triad, &[(f64, usize)])) {
        for (beam, of, [first_q, first_v]) in self.slender() {
            for node in 0..beam.nodes().len() {
                let [q, v] = of.place(node);
                let (q, v) = (first_q + q, first_v + v);
                let triad = Triad::new(Vec3::at(&s.q, q + 3), Vec3::at(&s.q, q + 6));
                visit(v + 6, triad, &[(1.0, v + 3)]);
                let Some(element) = beam.elements().get(node) else { continue };
                // The slope in the middle is linear in r and r′ of both nodes.
                let supports = of.supports(node);
                let numbers = supports.map(|[_, v]| first_v + v);
                let factor = |k: usize| {
                    let mut unit = [Vec3::ZERO; 4];
                    unit[k][0] = 1.0;
                    element.middle_slope(&unit)[0]
                };
                let slope_of = [0, 1, 2, 3].map(|k| (factor(k), numbers[k]));
                let slope = element.middle_slope(&supports.map(|[q, _]| Vec3::at(&s.q, first_q + q)));
                visit(v + 7, Triad::new(slope, Vec3::at(&s.q, q + 9)), &slope_of);
            }
        }
    }

    /// The derivatives of v and a at rest in the frame.
    fn derivatives(&self, s: &State) -> Vec<Row> {
        let (speed, turn) = (self.speed, Mat3::skew(self.axis.direction));
        let twice = turn * turn;
        let mut rows: Vec<Row> = Vec::with_capacity(s.v.len());
        let point = |rows: &mut Vec<Row>, v: usize| {
            for i in 0..3 {
                let entry =
                    |j: usize| [speed * turn[i][j], speed * speed * twice[i][j], 2.0 * speed * turn[i][j]];
                rows.push((v + i, (0..3).map(|j| (v + j, entry(j))).collect()));
            }
        };
        self.frames(s, |_, v, rotation| {
            point(&mut rows, v);
            let own = Mat3::skew(speed * self.own_axis(&rotation));
            for i in 0..3 {
                let entry = |j: usize| (v + 3 + j, [own[i][j], 0.0, own[i][j]]);
                rows.push((v + 3 + i, (0..3).map(entry).collect()));
            }
        });
        self.slender_nodes(|_, v| {
            point(&mut rows, v);
            point(&mut rows, v + 3);
        });
        self.slender_sections(s, |unknown, triad, slope_of| {
            let along = speed * across_tangent(self.axis.direction, &triad);
            let entries = slope_of
                .iter()
                .flat_map(|(c, v)| (0..3).map(move |k| (v + k, [c * along[k], 0.0, c * along[k]])));
            rows.push((unknown, entries.collect()));
        });
        rows
    }

    /// Places the bodies of the model, whose rotations are needed.
    fn place(&mut self, s: &State) {
        self.inner.place(s);
    }
}

/// (e − (e·t) t)/|r′|: e·δt for a change δr′ of the slope.
fn across_tangent(e: Vec3, triad: &Triad) -> Vec3 {
    1.0 / triad.length * e.across(triad.tangent)
}

impl Dynamics for Rotating {
    fn size(&self) -> Size {
        self.inner.size()
    }

    fn structure(&self, multipliers: usize) -> Structure {
        self.inner.structure(multipliers)
    }

    fn scales(&self) -> &[f64] {
        self.inner.scales()
    }

    fn unknown(&self, i: usize) -> String {
        self.inner.unknown(i)
    }

    /// At rest in the frame.
    fn initial(&self) -> State {
        let mut s = self.inner.initial();
        s.v.fill(0.0);
        s
    }

    fn across(&self) -> Vec<usize> {
        self.inner.across()
    }

    fn is_vector_space(&self) -> bool {
        false
    }

    fn retract(&self, q: &[f64], d: &[f64], out: &mut [f64]) {
        self.inner.retract(q, d, out);
    }

    fn difference(&self, from: &[f64], to: &[f64], d: &mut [f64]) {
        self.inner.difference(from, to, d);
    }

    fn rate(&self, from: &[f64], d: &[f64], v: &[f64], out: &mut [f64]) {
        self.inner.rate(from, d, v, out);
    }

    fn residual(&mut self, s: &State, r: &mut [f64]) {
        self.place(s);
        let s = self.inertial(s);
        self.inner.residual(&s, r);
    }

    fn rows(&self) -> &[Set] {
        self.inner.rows()
    }

    fn constraint(&mut self, s: &State, c: RowWeights, g: &mut [f64]) {
        self.inner.constraint(s, c, g);
    }

    fn jacobian(&mut self, s: &State, visit: &mut VisitRow<'_>) {
        self.inner.jacobian(s, visit);
    }

    fn tangent(&mut self, s: &State, w: Weights<'_>, out: &mut Matrix) {
        let moved = self.in_space(s);
        self.inner.tangent(&moved, w, out);
        self.add_carried([s, &moved], w, out);
    }

    fn stiffness_forms(&mut self, s: &State, vectors: &[Vec<f64>]) -> Option<Vec<StiffnessForm>> {
        let moved = self.in_space(s);
        let mut rest = self.inner.unstrained_stiffness(&moved);
        self.add_carried([s, &moved], Weights::new(0.0, 0.0, 1.0), &mut rest);
        Some(self.inner.forms(s, &rest, vectors))
    }
}

impl Rotating {
    /// Adds w.v M ∂B/∂v′ + w.q (C ∂A/∂q + M ∂B/∂q) of a state and the same in inertial axes.
    fn add_carried(&mut self, [s, moved]: [&State; 2], w: Weights<'_>, out: &mut Matrix) {
        if self.speed == 0.0 || w.q == 0.0 && w.v == 0.0 {
            return;
        }
        let rows = self.derivatives(s);
        let mut of = |a, v| {
            let mut matrix = Matrix::new(&self.inner.structure(0));
            self.inner.tangent(moved, Weights::new(a, v, 0.0), &mut matrix);
            matrix
        };
        let mut of_unknown: Vec<&[(usize, [f64; 3])]> = vec![&[]; s.v.len()];
        rows.iter().for_each(|(j, entries)| of_unknown[*j] = entries);
        of(1.0, 0.0).visit(|i, j, m| {
            of_unknown[j]
                .iter()
                .for_each(|(k, [_, by_q, by_v])| out.add(i, *k, m * (w.q * by_q + w.v * by_v)));
        });
        if w.q != 0.0 {
            of(0.0, 1.0).visit(|i, j, c| {
                of_unknown[j].iter().for_each(|(k, [a, ..])| out.add(i, *k, c * w.q * a));
            });
        }
    }
}

impl Events for Rotating {}

impl Steady for Rotating {
    fn set(&mut self, parameter: Parameter, value: f64) -> Result<(), NotSet> {
        match parameter {
            Parameter::LoadFactor => self.inner.set(parameter, value),
            Parameter::Azimuth
                if self.inner.constants.model.line_laws.iter().any(|of| !of.law.is_isotropic()) =>
            {
                Err(NotSet::Lost("a force law is no load that could be turned".to_owned()))
            }
            Parameter::Azimuth => {
                self.turn_loads(value);
                Ok(())
            }
            Parameter::Speed => match self.unsteady().filter(|_| value != 0.0 && !self.instant) {
                Some(what) => Err(NotSet::Lost(format!(
                    "{what} keeps its direction in space, across the axis: seen from a frame that rotates it changes with every \
                     revolution, and there is no steady state; leave it out, let it act along the axis, or let it follow its part"
                ))),
                None => {
                    self.speed = value;
                    Ok(())
                }
            },
        }
    }

    fn hold(&mut self, held: bool) {
        self.inner.hold(held);
    }

    fn release(&mut self) {
        self.speed = 0.0;
        if let Some(level) = self.level.take() {
            self.inner.constants = level;
        }
        self.inner.release();
    }
}

impl Observed for Rotating {
    fn energy(&mut self, s: &State) -> Energy {
        self.place(s);
        let s = self.inertial(s);
        self.inner.energy(&s)
    }

    fn frames(&mut self, body: usize, s: &State, stations: &[f64], out: &mut [Frame]) {
        self.inner.frames(body, s, stations, out);
    }

    fn observe(&mut self, s: &State, sink: &mut Sink<'_>) {
        self.inner.observe(s, sink);
    }

    fn drawn(&self) -> usize {
        self.inner.drawn()
    }

    fn shares(&self, s: &State, x: &[f64], mx: &[f64], add: &mut dyn FnMut(Direction, f64)) {
        self.inner.shares_about(s, Some(&self.axis), [x, mx], add);
    }

    fn admissible(&mut self, s: &State) -> Result<(), Limit> {
        self.inner.admissible(s)
    }

    fn slender(&self) -> Option<Slender> {
        self.inner.slender()
    }
}
