//! `scene.npz`: the motion of a system in space, for `flexion view` and for NumPy.
//!
//! A scene has named parts, and obstacles. With n times, a part has the arrays
//!
//! | name | shape | content |
//! |---|---|---|
//! | `NAME.pose` | (n, 7) | position \[m\] and quaternion (w, x, y, z) of the root section or of the body, inertial axes |
//! | `NAME.station` | (m) | of a beam: arc lengths of its sections from the root \[m\] |
//! | `NAME.displacement` | (n, m, 3) | of a beam: u, from the straight beam along the tangent of the root to the section, in the axes of the root \[m\] |
//! | `NAME.rotation` | (n, m, 3) | of a beam: θ, rotation vector of the section against the root, in the axes of the root \[rad\] |
//! | `NAME.section` | (2) | of a beam: size of the root section along its second and third axis \[m\] |
//! | `NAME.hub` | (1) | of a beam on a hub: radius from the axis of the hub to the root \[m\] |
//! | `NAME.box` | (6) | of a rigid body: centre in its axes, and edges \[m\] |
//! | `NAME.outline` | (n, p, 3) | of an obstacle: points of its outline \[m\], inertial axes |
//! | `NAME.force` | (n, 6) | of a load or a contact at a point that acts at some time: place \[m\] and force \[N\], inertial axes; of the largest 50 |
//! | `NAME.moment` | (n, 6) | of a load with a couple, likewise: place \[m\] and couple [N·m] |
//! | `NAME.line-force` | (n, p, 6) | of a force per length along a beam: places from one end of it to the other \[m\] and the force per length there [N/m] |
//! | `left-out` | (1) | number of forces, couples and forces per length that act and are not among them, where there are such: the smallest |
//!
//! and `time` (n) \[s\]. A section stands at p + R (x e₁ + u), with the pose p, R of the root. Displacements are kept apart from the pose
//! so that small ones keep their digits: what changes with time is stored in single precision.

use std::io;

use super::arrays::{Arrays, Numbers, list};
use super::contour::Contour;
use super::forces::Forces;
use super::obstacles::Drawn;
use super::shapes::stations;
use super::spring::Spring;
use flexion::linalg::{Mat3, Vec3};
use flexion::multibody::rotation::{Quaternion, about};
use flexion::section::Shape;
use flexion::system::{Frame, State, System};

/// Equal intervals along a beam between whose ends it is drawn: at least, and at most.
const INTERVALS: usize = 25;
const MOST_INTERVALS: usize = 100;
/// About the most times that are kept.
const MOST: usize = 300;
/// Most numbers of states that wait to be drawn.
const MOST_WAITING: usize = 1 << 22;

/// A part of a system that is drawn.
#[derive(Clone, Debug)]
pub struct Part {
    name: String,
    body: usize,
    form: Form,
    /// Contour of each section.
    contours: Vec<Contour>,
    /// Seven numbers a time.
    poses: Vec<f32>,
    /// Three numbers a time and station.
    displacements: Vec<f32>,
    rotations: Vec<f32>,
}

/// What a part looks like.
#[derive(Clone, Debug)]
enum Form {
    Beam { stations: Vec<f64>, hub: Option<f64> },
    Box { centre: Vec3, edges: [f64; 3] },
}

impl Part {
    /// Body number `body` of a system as a beam of this length \[m\], with so many elements, and of the contour at each of its
    /// stations \[m\], on a hub of this radius \[m\] if on one; drawn at equal intervals, about two an element, and at the stations
    /// `also` \[m\].
    pub fn beam(
        (name, body): (&str, usize),
        (length, elements): (f64, usize),
        contour: impl Fn(f64) -> Contour,
        hub: Option<f64>,
        also: &[f64],
    ) -> Part {
        let stations = stations(length, (2 * elements).clamp(INTERVALS, MOST_INTERVALS), also);
        let contours = stations.iter().map(|s| contour(*s)).collect();
        Part::new(name, body, Form::Beam { stations, hub }, contours)
    }

    /// Body number `body` of a system as a rigid box: its centre in the axes of the body, and its edges \[m\].
    pub fn rigid((name, body): (&str, usize), centre: Vec3, edges: [f64; 3]) -> Part {
        let contour = Contour::of(&Shape::Rectangle { height: edges[1], width: edges[2] });
        Part::new(name, body, Form::Box { centre, edges }, vec![contour; 2])
    }

    fn new(name: &str, body: usize, form: Form, contours: Vec<Contour>) -> Part {
        let (poses, displacements, rotations) = Default::default();
        Part { name: name.to_owned(), body, form, contours, poses, displacements, rotations }
    }

    /// Contours of its sections, from one end to the other.
    pub(super) fn contours(&self) -> &[Contour] {
        &self.contours
    }

    fn stations(&self) -> &[f64] {
        match &self.form {
            Form::Beam { stations, .. } => stations,
            Form::Box { .. } => &[0.0],
        }
    }

    /// Takes the frames at its stations.
    fn push(&mut self, frames: &[Frame]) {
        let Some(root) = frames.first() else { return };
        let turned = Quaternion::from(root.rotation);
        self.poses.extend(root.position.0.iter().chain(&turned.0).map(|x| *x as f32));
        let Form::Beam { stations, .. } = &self.form else { return };
        let mut last = Vec3::ZERO;
        for (x, frame) in stations.iter().zip(frames) {
            let mut u = root.rotation.transpose() * (frame.position - root.position);
            u[0] -= x - stations[0];
            // The rotation vector that is nearest to that of the section before, so that it may pass π.
            let principal = (turned.inverse() * Quaternion::from(frame.rotation)).logarithm();
            let (angle, along) = (principal.norm(), principal.dot(last));
            let whole = std::f64::consts::TAU;
            let turns = if angle > 0.0 { ((along / angle - angle) / whole).round() } else { 0.0 };
            let theta = if turns == 0.0 { principal } else { (1.0 + turns * whole / angle) * principal };
            last = theta;
            self.displacements.extend(u.0.map(|x| x as f32));
            self.rotations.extend(theta.0.map(|x| x as f32));
        }
    }
}

impl Part {
    /// Position and axes of the root section or of the body at a time.
    fn pose(&self, time: usize) -> (Vec3, Mat3) {
        let at = |i: usize| self.poses.get(7 * time + i).copied().map_or(0.0, f64::from);
        (Vec3([at(0), at(1), at(2)]), Quaternion([at(3), at(4), at(5), at(6)]).normalized().matrix())
    }

    /// Its sections at a time, from one end to the other.
    pub(super) fn sections(&self, time: usize) -> Vec<Frame> {
        let (position, axes) = self.pose(time);
        let in_space = |x: Vec3| position + axes * x;
        match &self.form {
            Form::Beam { stations, .. } => {
                let of = |list: &[f32], k: usize| {
                    Vec3([0, 1, 2].map(|i| {
                        list.get(3 * (time * stations.len() + k) + i).copied().map_or(0.0, f64::from)
                    }))
                };
                let section_at = |(k, x): (usize, &f64)| {
                    let u = of(&self.displacements, k);
                    let turned = about(of(&self.rotations, k));
                    let place = Vec3([x - stations[0] + u[0], u[1], u[2]]);
                    Frame { position: in_space(place), rotation: axes * turned }
                };
                stations.iter().enumerate().map(section_at).collect()
            }
            Form::Box { centre, edges } => {
                let end = |side: f64| {
                    let place = *centre + 0.5 * side * edges[0] * Vec3::AXES[0];
                    Frame { position: in_space(place), rotation: axes }
                };
                vec![end(-1.0), end(1.0)]
            }
        }
    }

    /// Lines that show it at a time: the centreline of a beam, the edges of a box.
    #[cfg(feature = "figures")]
    fn lines(&self, time: usize) -> Vec<Vec<Vec3>> {
        let sections = self.sections(time);
        if let Form::Beam { .. } = self.form {
            return vec![sections.iter().map(|section| section.position).collect()];
        }
        let rim = |(frame, contour): (&Frame, &Contour)| -> Vec<Vec3> {
            let corners = contour.outer.iter();
            corners.map(|[y, z]| frame.position + frame.rotation * Vec3([0.0, *y, *z])).collect()
        };
        let mut rims: Vec<Vec<Vec3>> = sections.iter().zip(&self.contours).map(rim).collect();
        let along = (0..rims[0].len()).map(|i| rims.iter().map(|rim| rim[i]).collect());
        let along: Vec<Vec<Vec3>> = along.collect();
        rims.iter_mut().for_each(|rim| rim.push(rim[0]));
        rims.into_iter().chain(along).collect()
    }
}

/// The motion of a system: its parts and the obstacles at a number of times.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    parts: Vec<Part>,
    obstacles: Vec<Outline>,
    /// Springs, with a line a time.
    springs: Vec<(Spring, Vec<[Vec3; 2]>)>,
    forces: Forces,
    every: usize,
    seen: usize,
    /// States that were sampled and whose frames are still to be found: a run is not to wait for its pictures.
    waiting: Vec<State>,
    times: Vec<f64>,
    frames: Vec<Frame>,
}

/// The outline of an obstacle.
#[derive(Clone, Debug)]
struct Outline {
    drawn: Drawn,
    /// Three numbers a time and point.
    points: Vec<f32>,
}

impl Scene {
    /// No time yet: for a run that records `records` times, of which some hundreds are taken.
    pub fn new(parts: Vec<Part>, obstacles: Vec<Drawn>, records: usize) -> Scene {
        let obstacles = obstacles.into_iter().map(|drawn| Outline { drawn, points: Vec::new() }).collect();
        Scene { parts, obstacles, every: records.div_ceil(MOST).max(1), ..Scene::default() }
    }

    /// The same with springs, for figures and ParaView's files.
    pub fn with_springs(self, springs: Vec<Spring>) -> Scene {
        Scene { springs: springs.into_iter().map(|spring| (spring, Vec::new())).collect(), ..self }
    }

    /// The same that takes every `every`-th recorded time.
    pub fn taken(self, every: usize) -> Scene {
        Scene { every: every.max(1), ..self }
    }

    /// Call it with every recorded state: it keeps some of them. [`Scene::draw`] takes those that it keeps.
    pub fn sample(&mut self, system: &mut dyn System, state: &State) {
        if self.shows_nothing() {
            return;
        }
        if self.seen.is_multiple_of(self.every.max(1)) {
            self.waiting.push(state.clone());
            if self.waiting.len() * (state.q.len() + 2 * state.v.len()) > MOST_WAITING {
                self.draw(system);
            }
        }
        self.seen += 1;
    }

    /// Whether there is nothing to be seen, as in `Scene::default()`.
    fn shows_nothing(&self) -> bool {
        self.parts.is_empty() && self.obstacles.is_empty()
    }

    /// Takes the sampled states that it has not taken yet.
    pub fn draw(&mut self, system: &mut dyn System) {
        for state in std::mem::take(&mut self.waiting) {
            self.take(state.t, system, &state);
        }
    }

    /// Takes the sampled states and the last one of a run, unless it was sampled.
    pub fn finish(&mut self, system: &mut dyn System, state: &State) {
        self.draw(system);
        if self.times.last() != Some(&state.t) && !self.shows_nothing() {
            self.take(state.t, system, state);
        }
    }

    /// Takes a state under a time, whatever its own is.
    pub fn take(&mut self, time: f64, system: &mut dyn System, state: &State) {
        self.times.push(time);
        for part in &mut self.parts {
            self.frames.clear();
            self.frames.resize(part.stations().len(), Frame::default());
            system.frames(part.body, state, part.stations(), &mut self.frames);
            part.push(&self.frames);
        }
        for (spring, lines) in &mut self.springs {
            lines.push(spring.line(system, state));
        }
        self.forces.take(system, state);
        for Outline { drawn, points } in &mut self.obstacles {
            let outline = drawn.outline(system, state, drawn.size);
            points.extend(outline.into_iter().flatten().map(|x| x as f32));
        }
    }

    /// The times that were taken \[s\].
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The parts.
    pub fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// The lines of each part and spring at the time of this number, with its name \[m\].
    #[cfg(feature = "figures")]
    pub(super) fn lines(&self, time: usize) -> Vec<(&str, Vec<Vec<Vec3>>)> {
        let parts = self.parts.iter().map(|part| (part.name.as_str(), part.lines(time)));
        let springs = self.springs.iter().zip(self.lines_of_springs(time));
        parts.chain(springs.map(|((spring, _), line)| (spring.name.as_str(), vec![line]))).collect()
    }

    /// The lines of the springs at the time of this number \[m\].
    pub(super) fn lines_of_springs(&self, time: usize) -> impl Iterator<Item = Vec<Vec3>> {
        self.springs.iter().map(move |(_, lines)| lines.get(time).map_or(Vec::new(), |line| line.to_vec()))
    }

    /// The obstacles.
    #[cfg(feature = "figures")]
    pub(super) fn obstacles(&self) -> impl Iterator<Item = &Drawn> {
        self.obstacles.iter().map(|obstacle| &obstacle.drawn)
    }

    /// The outlines of the obstacles at the time of this number \[m\].
    pub(super) fn outlines(&self, time: usize) -> Vec<Vec<Vec3>> {
        let at_time = |obstacle: &Outline| {
            let points = obstacle.points.as_chunks::<3>().0;
            let count = points.len() / self.times.len().max(1);
            let points = points.iter().skip(time * count).take(count);
            points.map(|point| Vec3(point.map(f64::from))).collect()
        };
        self.obstacles.iter().map(at_time).collect()
    }

    /// Whether there are obstacles or springs.
    pub(super) fn has_lines(&self) -> bool {
        !self.obstacles.is_empty() || !self.springs.is_empty()
    }

    /// Whether there is nothing to be drawn.
    pub fn is_empty(&self) -> bool {
        self.parts.is_empty() || self.times.is_empty()
    }

    /// Puts its arrays. The same scene gives the same bytes.
    ///
    /// # Errors
    /// Whatever `to` returns.
    pub fn put(&self, to: &mut dyn Arrays) -> io::Result<()> {
        let times = self.times.len() as u64;
        to.put("time", &[times], Numbers::Double(&self.times))?;
        for part in &self.parts {
            let name = |what: &str| format!("{}.{what}", part.name);
            to.put(&name("pose"), &[times, 7], Numbers::Single(&part.poses))?;
            let numbers: [(&str, Vec<f64>); 3] = match &part.form {
                Form::Beam { stations, hub } => {
                    let shape = [times, stations.len() as u64, 3];
                    let fields = [("displacement", &part.displacements), ("rotation", &part.rotations)];
                    for (what, values) in fields {
                        to.put(&name(what), &shape, Numbers::Single(values))?;
                    }
                    let hub = hub.iter().copied().collect();
                    let section = part.contours.first().map_or(Vec::new(), |contour| contour.size().to_vec());
                    [("station", stations.clone()), ("section", section), ("hub", hub)]
                }
                Form::Box { centre, edges } => {
                    [("box", [centre.0, *edges].concat()), ("", Vec::new()), ("", Vec::new())]
                }
            };
            for (what, values) in numbers.into_iter().filter(|(_, values)| !values.is_empty()) {
                list(to, &name(what), values.into_iter())?;
            }
        }
        for Outline { drawn, points } in &self.obstacles {
            let shape = [times, points.len() as u64 / (3 * times).max(1), 3];
            to.put(&format!("{}.outline", drawn.name), &shape, Numbers::Single(points))?;
        }
        self.forces.put(times, to)
    }
}

#[cfg(feature = "archives")]
#[cfg(test)]
mod tests {
    use super::*;
    use crate::archive;
    use flexion::contact::Plane;
    use flexion::multibody::rotation::{Quaternion, about};
    use flexion::system::{Dynamics, Events, LineForce, Observed, PointForce, Size, Steady, Weights};
    use std::collections::BTreeMap;
    use std::io::Cursor;
    use std::sync::Arc;

    /// A beam that is bent to an arc of the angle q per length about the third axis of its root, which is turned by the vector d
    /// and stands at p; every other body stands at p alone.
    struct Bent {
        p: Vec3,
        d: Vec3,
    }

    impl Dynamics for Bent {
        fn size(&self) -> Size {
            Size::default()
        }
        fn scales(&self) -> &[f64] {
            &[]
        }
        fn residual(&mut self, _: &State, _: &mut [f64]) {}
        fn tangent(&mut self, _: &State, _: Weights<'_>, _: &mut flexion::linalg::Matrix) {}
    }
    impl Events for Bent {}
    impl Steady for Bent {}
    impl Observed for Bent {
        /// Forces and couples that grow with q, one that is smaller first, and one that vanishes.
        fn point_forces(&mut self, s: &State) -> Vec<PointForce> {
            let force = |name: &str, x: f64, moment: f64| PointForce {
                name: name.into(),
                place: self.p,
                force: Vec3([0.0, x * s.q[0], 0.0]),
                moment: Vec3([moment * s.q[0], 0.0, 0.0]),
                transmitted: name == "joint",
            };
            let joint = force("joint", 100.0, 0.0);
            vec![force("push", 0.5, 0.0), force("push", 3.0, 0.0), force("twist", 0.0, -2.0), joint]
        }
        /// One of two points that grows with q.
        fn line_forces(&mut self, s: &State) -> Vec<LineForce> {
            let points = [1.0, 2.0].map(|x| [x * self.p, Vec3([0.0, 0.0, x * s.q[0]])]).to_vec();
            vec![LineForce { name: "wind".into(), points }]
        }
        fn frames(&mut self, body: usize, s: &State, stations: &[f64], out: &mut [Frame]) {
            let root = about(self.d);
            for (x, frame) in stations.iter().zip(out) {
                let angle = if body == 0 { s.q[0] * x } else { 0.0 };
                let place = if body == 0 { arc(s.q[0], *x) } else { Vec3::ZERO };
                let turned = about([0.0, 0.0, angle]);
                *frame = Frame { position: self.p + root * place, rotation: root * turned };
            }
        }
    }

    /// Where a section of an arc is: (sin κx, 1 − cos κx)/κ.
    fn arc(curvature: f64, x: f64) -> Vec3 {
        let half = 0.5 * curvature * x;
        let chord = half.sin() / (0.5 * curvature);
        Vec3([chord * half.cos(), chord * half.sin(), 0.0])
    }

    fn bytes(scene: &Scene) -> Vec<u8> {
        let mut out = Cursor::new(Vec::new());
        let mut archive = archive::archive(&mut out);
        scene.put(&mut archive).unwrap();
        archive::finish(archive).unwrap();
        out.into_inner()
    }

    fn written(scene: &Scene) -> BTreeMap<String, (Vec<u64>, Vec<f64>)> {
        let out = Cursor::new(bytes(scene));
        let mut all = BTreeMap::new();
        archive::arrays(out, |name, array| {
            let shape = array.shape().to_vec();
            let values = match array.try_data::<f32>() {
                Ok(values) => values.map(|x| f64::from(x.unwrap())).collect(),
                Err(array) => array.into_vec::<f64>()?,
            };
            all.insert(name.to_owned(), (shape, values));
            Ok(())
        })
        .unwrap();
        all
    }

    fn flat(_: f64) -> Contour {
        Contour::of(&Shape::Rectangle { height: 0.1, width: 0.2 })
    }

    fn at(curvature: f64) -> State {
        State { t: curvature, q: vec![curvature], ..State::default() }
    }

    #[test]
    fn small_displacements_keep_their_digits_far_from_the_origin() {
        let mut system = Bent { p: Vec3([300.0, -20.0, 7.0]), d: Vec3([0.3, -1.2, 2.0]) };
        let mut scene = Scene::new(vec![Part::beam(("arm", 0), (2.0, 1), flat, None, &[])], Vec::new(), 3);
        for curvature in [1e-7, 0.4] {
            scene.sample(&mut system, &at(curvature));
        }
        scene.draw(&mut system);
        let all = written(&scene);
        let m = INTERVALS + 1;
        assert_eq!(all["arm.displacement"].0, [2, m as u64, 3]);
        assert_eq!(all["arm.pose"].0, [2, 7]);
        assert_eq!(all["arm.pose"].1[..3], [300.0, -20.0, 7.0]);
        let quaternion = Quaternion::exponential(system.d).0;
        assert!(all["arm.pose"].1[3..7].iter().zip(quaternion).all(|(a, b)| (a - b).abs() < 1e-7));
        for (time, curvature) in [1e-7, 0.4].into_iter().enumerate() {
            let Vec3([along, across, _]) = arc(curvature, 2.0);
            let tip = |name: &str| &all[name].1[3 * (m * (time + 1) - 1)..3 * m * (time + 1)];
            let (u, theta) = (tip("arm.displacement"), tip("arm.rotation"));
            // Doubles at 300 m resolve 6e-14 m.
            assert!((u[1] - across).abs() < 1e-7 * across + 2e-13, "{u:?} {across}");
            assert!((u[0] - (along - 2.0)).abs() < 1e-7 * (2.0 - along) + 2e-13, "{u:?} {along}");
            assert!((theta[2] - 2.0 * curvature).abs() < 2e-7 * curvature + 1e-15, "{theta:?}");
        }
    }

    #[test]
    fn a_section_may_turn_by_more_than_half_a_revolution() {
        let mut system = Bent { p: Vec3([0.0; 3]), d: Vec3([0.0, 0.5, 0.0]) };
        let mut scene = Scene::new(vec![Part::beam(("arm", 0), (2.0, 1), flat, None, &[])], Vec::new(), 1);
        scene.sample(&mut system, &at(-5.0));
        scene.draw(&mut system);
        let (_, theta) = &written(&scene)["arm.rotation"];
        for (k, theta) in theta.chunks(3).enumerate() {
            let exact = -5.0 * 2.0 * k as f64 / INTERVALS as f64;
            assert!((theta[2] - exact).abs() < 1e-6, "section {k}: {theta:?} instead of {exact}");
        }
    }

    #[test]
    fn long_runs_are_thinned_and_keep_their_last_time() {
        let mut system = Bent { p: Vec3([1.0, 2.0, 3.0]), d: Vec3([0.0; 3]) };
        let body = Part::rigid(("body", 1), Vec3([0.1, 0.0, 0.0]), [1.0, 2.0, 3.0]);
        let mut scene = Scene::new(vec![body], Vec::new(), 10 * MOST);
        let states: Vec<State> = (1..=10 * MOST).map(|i| at(i as f64)).collect();
        states.iter().for_each(|state| scene.sample(&mut system, state));
        scene.finish(&mut system, &states[10 * MOST - 1]);
        let all = written(&scene);
        let times = &all["time"].1;
        assert_eq!((times.len(), times[0], times[MOST]), (MOST + 1, 1.0, 10.0 * MOST as f64));
        assert_eq!(all["body.pose"].1[..7], [1.0, 2.0, 3.0, 1.0, 0.0, 0.0, 0.0]);
        assert_eq!(all["body.box"].1, [0.1, 0.0, 0.0, 1.0, 2.0, 3.0]);
    }

    #[test]
    fn an_obstacle_is_seen_from_its_station() {
        let mut system = Bent { p: Vec3([0.0; 3]), d: Vec3([0.0; 3]) };
        let plane = Plane { point: Vec3([0.0, -1.0, 0.0]), normal: Vec3([0.0, 1.0, 0.0]), motion: None };
        let (name, obstacle) = ("floor".into(), Arc::new(plane));
        let drawn = Drawn {
            name,
            body: 0,
            station: 1.5,
            points: Vec::new(),
            size: 2.0,
            in_space: false,
            carrier: crate::Carrier::Ground,
            obstacle,
        };
        let beam = Part::beam(("arm", 0), (2.0, 1), flat, Some(0.5), &[1.5]);
        let mut scene = Scene::new(vec![beam], vec![drawn], 1);
        scene.sample(&mut system, &at(1e-9));
        scene.draw(&mut system);
        let all = written(&scene);
        let (shape, ends) = &all["floor.outline"];
        assert_eq!(shape, &[1, 2, 3]);
        assert!(
            (ends[0] - ends[3]).abs() == 4.0 && (0.5 * (ends[0] + ends[3]) - 1.5).abs() < 1e-6,
            "{ends:?}"
        );
        assert!(ends[1] == -1.0 && ends[4] == -1.0);
        assert_eq!(all["arm.hub"].1, [0.5]);
    }

    #[test]
    fn forces_that_act_are_drawn_the_largest_first() {
        let mut system = Bent { p: Vec3([1.0, 2.0, 3.0]), d: Vec3([0.0; 3]) };
        let mut scene = Scene::new(vec![Part::beam(("arm", 0), (2.0, 1), flat, None, &[])], Vec::new(), 2);
        [0.25, 0.5].iter().for_each(|q| scene.sample(&mut system, &at(*q)));
        scene.draw(&mut system);
        let all = written(&scene);
        let names: Vec<&String> =
            all.keys().filter(|name| !name.starts_with("arm.") && *name != "time").collect();
        assert_eq!(
            names,
            ["joint.transmitted-force", "push'.force", "push.force", "twist.moment", "wind.line-force"]
        );
        let times = |a: f64, b: f64| vec![1.0, 2.0, 3.0, 0.0, a, 0.0, 1.0, 2.0, 3.0, 0.0, b, 0.0];
        assert_eq!(all["push.force"], (vec![2, 6], times(0.75, 1.5)));
        assert_eq!(all["push'.force"], (vec![2, 6], times(0.125, 0.25)));
        assert_eq!(all["twist.moment"].1[3..6], [-0.5, 0.0, 0.0]);
        let (shape, last) = (&all["wind.line-force"].0, &all["wind.line-force"].1[18..]);
        assert_eq!((&shape[..], last), (&[2, 2, 6][..], &[2.0, 4.0, 6.0, 0.0, 0.0, 1.0][..]));
    }

    #[test]
    fn the_same_scene_gives_the_same_bytes() {
        let once = || {
            let mut system = Bent { p: Vec3([0.0; 3]), d: Vec3([0.1; 3]) };
            let mut scene =
                Scene::new(vec![Part::beam(("arm", 0), (2.0, 1), flat, None, &[])], Vec::new(), 1);
            scene.sample(&mut system, &at(0.3));
            scene.draw(&mut system);
            bytes(&scene)
        };
        assert!(once() == once());
    }
}
