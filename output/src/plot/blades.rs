//! Blades in the figure of an assembly: chords, leading edge, flap direction and the axis of rotation in the three views; sections seen
//! from the root, twist and line in panels of their own.

use super::style::{PANEL_HEIGHT, PANEL_WIDTH, VIEWS};
use super::{Axis, Line, Marker, Panel, Series, Words};
use flexion::linalg::{Mat3, Vec3};
use flexion::multibody::rotation::about;
use flexion::system::Frame;

/// Sections that are drawn in the views, and seen from the root.
const SECTIONS: usize = 9;
const SEEN: usize = 5;
/// Over the length of the longest blade: a drawn chord, the arrow of the flap direction, the axis on both sides of its place, and the arc
/// about it.
const CHORD: f64 = 0.12;
const FLAP: f64 = 0.2;
const AXIS: [f64; 2] = [-0.12, 0.25];
const ARC: f64 = 0.1;
/// Where along a blade its flap direction and its motion are taken.
const OUTER: f64 = 0.75;
/// Chord of the tip over that of the root, seen from the root.
const TIP: f64 = 0.5;
/// Part of a direction in a view below which it is drawn as seen from its end.
const END_ON: f64 = 0.5;
/// Where the arrows of motion and axis begin, beside sections whose chords are 1 at the root.
const FOOT: (f64, f64) = (-0.75, -0.4);
/// Size of a head over its arrow.
const HEAD: f64 = 0.25;
/// Line and twist over the length, and directions, that count as none.
const SMALL: f64 = 1e-6;
/// Colours: of the edge, the flap direction, the rotation, sections between, the root, the tip.
const EDGE: usize = 1;
const GREEN: usize = 2;
const TURNS: usize = 3;
const BETWEEN: usize = 7;
const ROOT: usize = 6;
const LAST: usize = 0;

/// A blade, as a figure shows it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Blade {
    /// Its name.
    pub name: String,
    /// Arc lengths of its sections from root to tip \[m\].
    pub stations: Vec<f64>,
    /// Place \[m\] and axes of each: tangent, height, across.
    pub sections: Vec<Frame>,
    /// Twist of each \[rad\], about −z.
    pub twist: Vec<f64>,
    /// Its axes x, y, z, as columns.
    pub axes: Mat3,
    /// Whether it is that of a deck: the height of its sections points to the trailing edge, and across away from the suction side.
    pub is_deck: bool,
}

/// A line about which a system rotates: a point \[m\] and the direction of the angular velocity, a unit vector.
pub type Turning = (Vec3, Vec3);

impl Blade {
    fn length(&self) -> f64 {
        self.stations.last().copied().unwrap_or(0.0)
    }

    /// The numbers of `count` of its sections, about equally far from each other, the first that of the root and the last that of the tip.
    fn some(&self, count: usize) -> Vec<usize> {
        let last = self.stations.len().saturating_sub(1);
        let at = |k: usize| self.length() * k as f64 / (count - 1) as f64;
        let nearest = |s: f64| {
            let distance = |i: &usize| (self.stations[*i] - s).abs();
            (0..=last).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
        };
        let mut out: Vec<usize> = (0..count).map(|k| nearest(at(k))).collect();
        out.dedup();
        out
    }

    /// The end of a chord that is marked, from its middle: that at the leading edge, or that to which the height points.
    fn marked(&self, section: &Frame) -> Vec3 {
        if self.is_deck { -section.rotation.column(1) } else { section.rotation.column(1) }
    }

    /// The flap direction: to the suction side, or across.
    fn flap(&self, section: &Frame) -> Vec3 {
        if self.is_deck { -section.rotation.column(2) } else { section.rotation.column(2) }
    }

    fn edge(&self) -> &'static str {
        if self.is_deck { "leading edge" } else { "end of the height" }
    }

    fn outer(&self) -> Frame {
        let s = OUTER * self.length();
        let i = self.stations.iter().position(|of| *of >= s).unwrap_or(0);
        self.sections.get(i).copied().unwrap_or_default()
    }
}

/// What is drawn into the views: lines of space.
pub(super) struct Marks {
    size: f64,
    /// Chords, and the line along one of their ends.
    chords: Vec<[Vec3; 2]>,
    edges: Vec<(Vec<Vec3>, &'static str)>,
    /// Foot, and direction.
    flaps: Vec<(Vec3, Vec3, &'static str)>,
    /// Point nearest to the first root, direction, direction from it to the blade.
    turning: Option<(Vec3, Vec3, Vec3)>,
    words: Vec<(Vec3, &'static str)>,
}

impl Marks {
    pub(super) fn new(blades: &[Blade], turning: Option<Turning>) -> Marks {
        let size = blades.iter().map(Blade::length).fold(0.0, f64::max);
        let (mut chords, mut edges, mut flaps, mut words) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for (number, blade) in blades.iter().enumerate() {
            let ends = |i: &usize| {
                let of = &blade.sections[*i];
                let half = 0.5 * CHORD * size * blade.marked(of);
                [of.position + half, of.position - half]
            };
            let drawn: Vec<[Vec3; 2]> = blade.some(SECTIONS).iter().map(ends).collect();
            edges.push((drawn.iter().map(|[end, _]| *end).collect(), blade.edge()));
            if let (0, [first, .., last]) = (number, &drawn[..]) {
                words.extend([(first[1], "root"), (last[1], "tip")]);
            }
            chords.extend(drawn);
            let outer = blade.outer();
            let name = if blade.is_deck { "flap, to the suction side" } else { "flap, across" };
            flaps.push((outer.position, blade.flap(&outer), name));
        }
        let turning = blades.first().zip(turning).map(|(blade, (point, direction))| {
            let [root, outer] =
                [blade.sections.first().copied().unwrap_or_default(), blade.outer()].map(|of| of.position);
            let foot = point + (root - point).dot(direction) * direction;
            let out = (outer - foot) - (outer - foot).dot(direction) * direction;
            (foot, direction, if out.norm() > SMALL * size { out / out.norm() } else { Vec3::ZERO })
        });
        Marks { size, chords, edges, flaps, turning, words }
    }

    /// Points that the views are to show \[m\].
    pub(super) fn points(&self) -> Vec<Vec3> {
        let flaps = self.flaps.iter().map(|(at, direction, _)| *at + FLAP * self.size * *direction);
        let axis = self
            .turning
            .iter()
            .flat_map(|(at, direction, _)| AXIS.map(|part| *at + part * self.size * *direction));
        self.chords.iter().flatten().copied().chain(flaps).chain(axis).collect()
    }

    /// Adds them to the views; names are listed in the first.
    pub(super) fn draw(&self, panels: &mut [Panel]) {
        for (number, (panel, [i, j])) in panels.iter_mut().zip(VIEWS).enumerate() {
            let flat = |p: Vec3| (p[i], p[j]);
            // Towards the viewer.
            let toward = Vec3::AXES[i].cross(Vec3::AXES[j]);
            let named = |name: &'static str, first: bool| Some(name).filter(|_| first && number == 0);
            let line = |points: Vec<Vec3>, color: usize, name: Option<&str>| Series {
                color: Some(color),
                ..Series::line(name, points.into_iter().map(flat).collect())
            };
            for (k, pair) in self.chords.iter().enumerate() {
                panel.series.push(line(pair.to_vec(), BETWEEN, named("chords, not to scale", k == 0)));
            }
            let mut seen: Vec<&str> = Vec::new();
            let mut first = |name: &'static str| {
                let first = !seen.contains(&name);
                seen.push(name);
                named(name, first)
            };
            for (edge, name) in &self.edges {
                panel.series.push(line(edge.clone(), EDGE, first(name)));
            }
            let end_on = |at: Vec3, direction: Vec3, color: usize, name: Option<&str>| Series {
                marker: Some(if direction.dot(toward) > 0.0 { Marker::Toward } else { Marker::Away }),
                line: Line::None,
                color: Some(color),
                ..Series::line(name, vec![flat(at)])
            };
            let within = |direction: Vec3| {
                let (x, y) = flat(direction);
                x.hypot(y) > END_ON
            };
            for (at, direction, name) in &self.flaps {
                let name = first(name);
                panel.series.push(if within(*direction) {
                    let to = *at + FLAP * self.size * *direction;
                    Series { color: Some(GREEN), ..Series::line(name, arrow(flat(*at), flat(to))) }
                } else {
                    end_on(*at, *direction, GREEN, name)
                });
            }
            if let Some((at, direction, out)) = &self.turning {
                let name = first("axis of rotation");
                if within(*direction) {
                    let [from, to] = AXIS.map(|part| flat(*at + part * self.size * *direction));
                    let axis = Series::line(name, arrow(from, to));
                    panel.series.push(Series { color: Some(TURNS), ..axis });
                } else {
                    panel.series.push(end_on(*at, *direction, TURNS, name));
                    let angle = |k: i32| 0.35 + 0.1 * f64::from(k);
                    let on = |k: i32| flat(*at + ARC * self.size * (about(angle(k) * *direction) * *out));
                    let mut arc: Vec<(f64, f64)> = (0..=12).map(on).collect();
                    let last = arrow_of(on(12), (on(12).0 - on(8).0, on(12).1 - on(8).1), 0.6);
                    arc.extend(last);
                    panel.series.push(Series { color: Some(TURNS), ..Series::line(None, arc) });
                }
            }
            for (at, text) in &self.words {
                let points = vec![flat(*at)];
                panel.words.push(Words {
                    points,
                    text: (*text).to_owned(),
                    leader: true,
                    ..Words::default()
                });
            }
        }
    }
}

/// An arrow as one line.
fn arrow(from: (f64, f64), to: (f64, f64)) -> Vec<(f64, f64)> {
    let along = (to.0 - from.0, to.1 - from.1);
    [vec![from, to], arrow_of(to, along, HEAD)].concat()
}

/// The head of an arrow at its end, which points along a direction, of a size over that.
fn arrow_of(to: (f64, f64), (x, y): (f64, f64), size: f64) -> Vec<(f64, f64)> {
    let side = |sign: f64| (to.0 - size * (x - sign * 0.45 * y), to.1 - size * (y + sign * 0.45 * x));
    vec![side(1.0), to, side(-1.0)]
}

/// The panels of blades: of each that differs from those before, its sections seen from the root, its twist, and its line.
pub(super) fn panels(
    blades: &[Blade],
    turning: Option<Turning>,
    rows: impl Fn(usize) -> usize,
) -> Vec<Panel> {
    let mut groups: Vec<(Vec<&str>, Vec<Panel>)> = Vec::new();
    for blade in blades {
        let own = of_blade(blade, turning);
        match groups.iter_mut().find(|(_, panels)| alike(panels, &own)) {
            Some((names, _)) => names.push(&blade.name),
            None => groups.push((vec![&blade.name], own)),
        }
    }
    let several = groups.len() > 1;
    let mut out = Vec::new();
    for (names, panels) in groups {
        for mut panel in panels {
            for words in panel.words.iter_mut().filter(|words| several && words.points.is_empty()) {
                words.text = format!("{}: {}", names.join(", "), words.text);
            }
            out.push(panel);
        }
    }
    let height = PANEL_HEIGHT[(rows(out.len()).max(1) - 1).min(2)];
    for panel in &mut out {
        if let (false, Some(along), Some(across)) = (panel.equal, panel.x.range, panel.y.range) {
            let factor = (along.1 - along.0) / PANEL_WIDTH[1] * height / (across.1 - across.0);
            let words = panel.words.iter_mut().filter(|words| words.points.is_empty());
            words.for_each(|words| words.text += &format!(", drawn {factor:.1} times as large across"));
        }
    }
    out
}

fn alike(a: &[Panel], b: &[Panel]) -> bool {
    let points = |panels: &[Panel]| -> Vec<(f64, f64)> {
        panels.iter().flat_map(|panel| &panel.series).flat_map(|series| series.points.clone()).collect()
    };
    let (a, b) = (points(a), points(b));
    let size = a.iter().fold(1.0_f64, |size, (x, y)| size.max(x.abs()).max(y.abs()));
    let near = |(p, q): (&(f64, f64), &(f64, f64))| (p.0 - q.0).abs().max((p.1 - q.1).abs()) <= SMALL * size;
    a.len() == b.len() && a.iter().zip(&b).all(near)
}

fn heading(text: &str) -> Words {
    Words { text: text.to_owned(), ..Words::default() }
}

fn of_blade(blade: &Blade, turning: Option<Turning>) -> Vec<Panel> {
    let mut out = vec![along(blade, turning)];
    if blade.twist.iter().any(|twist| twist.abs() > SMALL) {
        let (sign, sense) = if blade.is_deck { (1.0, "Twist about −z") } else { (-1.0, "Twist about z") };
        let points =
            blade.stations.iter().zip(&blade.twist).map(|(s, twist)| (*s, sign * twist.to_degrees()));
        let tight = Axis { tight: true, ..Axis::new("Arc length s", "m") };
        let series = vec![Series { color: Some(LAST), ..Series::line(None, points.collect()) }];
        out.push(Panel {
            x: tight,
            y: Axis::new(sense, "°"),
            series,
            words: vec![heading("twist")],
            equal: false,
        });
    }
    let root = blade.sections.first().map_or(Vec3::ZERO, |of| of.position);
    let inward = blade.axes.transpose();
    let places: Vec<Vec3> = blade.sections.iter().map(|of| inward * (of.position - root)).collect();
    let bounds = |k: &[usize]| {
        let all = || places.iter().flat_map(|place| k.iter().map(|k| place[*k]));
        (all().fold(0.0, f64::min), all().fold(0.0, f64::max))
    };
    let ((from, to), (low, high)) = (bounds(&[2]), bounds(&[0, 1]));
    if high - low > SMALL * blade.length() {
        let margin = 0.15 * (high - low);
        let curve = |k: usize, number: usize, name: &str| {
            let points = places.iter().map(|place| (place[2], place[k])).collect();
            Series::line(Some(name), points).numbered(number)
        };
        let names = if blade.is_deck {
            ["x, to the suction side", "y, to the trailing edge"]
        } else {
            ["x, opposite to across", "y, along the height"]
        };
        out.push(Panel {
            x: Axis { range: Some((from, to)), ..Axis::new("z", "m") },
            y: Axis { range: Some((low - margin, high + margin)), ..Axis::new("x, y", "m") },
            series: vec![curve(0, 0, names[0]), curve(1, 1, names[1])],
            words: vec![heading("line")],
            equal: false,
        });
    }
    out
}

/// What is to the right and what is up where sections are looked at, with the names of both, and from where that is.
struct Seen {
    right: Vec3,
    up: Vec3,
    names: [&'static str; 3],
    /// Whether that is the motion, to the left, and the axis of rotation.
    turns: bool,
}

impl Seen {
    /// Of a blade that turns along the axis and against the motion, from its root; of any other along its own axes, so that its twist is positive to the left.
    fn new(blade: &Blade, turning: Option<Turning>) -> Seen {
        let out = turning.map_or(Vec3::ZERO, |(point, direction)| {
            let out = blade.outer().position - point;
            out - out.dot(direction) * direction
        });
        let [x, y] = [0, 1].map(|k| blade.axes.column(k));
        match turning {
            Some((_, up)) if out.norm() > SMALL * blade.length() => {
                let right = out.cross(up) / out.norm();
                let names = ["against the motion", "along the axis", "seen from the root"];
                Seen { right, up, names, turns: true }
            }
            _ if blade.is_deck => {
                let names = ["y, to the trailing edge", "x, to the suction side", "seen from the root"];
                Seen { right: y, up: x, names, turns: false }
            }
            _ => {
                let names = ["along the height of the root", "across", "seen from the tip"];
                Seen { right: y, up: -x, names, turns: false }
            }
        }
    }

    fn flat(&self, direction: Vec3) -> (f64, f64) {
        (direction.dot(self.right), direction.dot(self.up))
    }
}

/// The sections, looked at along the blade, with chords shorter towards the tip.
fn along(blade: &Blade, turning: Option<Turning>) -> Panel {
    let seen = Seen::new(blade, turning);
    let times = |size: f64, (x, y): (f64, f64)| (size * x, size * y);
    let [right, up, from] = seen.names;
    let (mut series, mut words) = (Vec::new(), vec![heading(from)]);
    let numbers = blade.some(SEEN);
    let mut edge = Vec::new();
    for (k, i) in numbers.iter().enumerate() {
        let part = k as f64 / (numbers.len().max(2) - 1) as f64;
        let end = times(0.5 * (1.0 - (1.0 - TIP) * part), seen.flat(blade.marked(&blade.sections[*i])));
        let (color, name) = match k {
            0 => (ROOT, Some("root")),
            _ if k + 1 == numbers.len() => (LAST, Some("tip")),
            _ => (BETWEEN, None),
        };
        series.push(Series { color: Some(color), ..Series::line(name, vec![end, times(-1.0, end)]) });
        edge.push(end);
    }
    series.push(Series {
        name: Some(blade.edge().to_owned()),
        points: edge,
        line: Line::None,
        marker: Some(Marker::Circle),
        color: Some(EDGE),
        band: Vec::new(),
    });
    let mut pointer = |from: (f64, f64), by: (f64, f64), color: usize, text: &str| {
        let to = (from.0 + by.0, from.1 + by.1);
        series.push(Series { color: Some(color), ..Series::line(None, arrow(from, to)) });
        let middle = (from.0 + 0.5 * by.0, from.1 + 0.5 * by.1);
        let points = if color == TURNS { vec![middle, to] } else { vec![to] };
        words.push(Words { points, text: text.to_owned(), leader: true, ..Words::default() });
    };
    pointer((0.0, 0.0), times(0.4, seen.flat(blade.flap(&blade.outer()))), GREEN, "flap");
    if seen.turns {
        pointer(FOOT, (-0.4, 0.0), TURNS, "motion");
        pointer(FOOT, (0.0, 0.4), TURNS, "axis");
    }
    let axis = |name: &str, half: f64| Axis { range: Some((-half, half)), ..Axis::new(name, "") };
    Panel { x: axis(right, 1.35), y: axis(up, 0.62), series, words, equal: true }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scene;
    use crate::plot::assembly_figure;

    /// A blade of the length 10 along X with y along Y whose deck has this twist at the tip, linear from none, and a prebend of 1 m.
    fn blade(twist: f64, prebend: f64) -> Blade {
        let axes = Mat3::columns([-Vec3::AXES[2], Vec3::AXES[1], Vec3::AXES[0]]);
        let stations: Vec<f64> = (0..=20).map(|k| 0.5 * f64::from(k)).collect();
        let at = |s: &f64| {
            // About −z of the blade, which is −X.
            let turned = about(-twist * s / 10.0 * Vec3::AXES[0]);
            let [height, across] = [Vec3::AXES[1], Vec3::AXES[2]].map(|axis| turned * axis);
            let position = *s * Vec3::AXES[0] + prebend * (s / 10.0).powi(2) * axes.column(0);
            Frame { position, rotation: Mat3::columns([Vec3::AXES[0], height, across]) }
        };
        Blade {
            name: "blade".to_owned(),
            sections: stations.iter().map(at).collect(),
            twist: stations.iter().map(|s| twist * s / 10.0).collect(),
            stations,
            axes,
            is_deck: true,
        }
    }

    fn angle(series: &Series) -> f64 {
        let [(x, y), (u, v)] = series.points[..] else { panic!("{series:?}") };
        (v - y).atan2(u - x)
    }

    fn named<'a>(panel: &'a Panel, name: &str) -> &'a Series {
        panel.series.iter().find(|series| series.name.as_deref() == Some(name)).unwrap()
    }

    /// The rotor of a deck turns about its x, and its leading edge goes ahead.
    #[test]
    fn the_chord_of_the_tip_is_turned_by_the_twist_and_the_leading_edge_goes_ahead() {
        let turning = Some((Vec3::ZERO, -Vec3::AXES[2]));
        for twist in [0.3, -0.3] {
            let figure = assembly_figure(&Scene::default(), &[], &[blade(twist, 1.0)], turning, None);
            let [_, _, across, seen, twists, line] = &figure.panels[..] else { panic!("{figure:?}") };
            // From the leading to the trailing edge, y to the right and x up: a twist about −z turns y towards x.
            let [root, tip] = ["root", "tip"].map(|name| angle(named(seen, name)));
            assert!(root.abs() < 1e-9 && (tip - twist).abs() < 1e-9, "{root} {tip}");
            // In the view of Y and Z, x of the blade is −Z.
            let chords: Vec<f64> =
                across.series.iter().filter(|series| series.color == Some(BETWEEN)).map(angle).collect();
            assert_eq!(chords.len(), SECTIONS);
            assert!((chords[SECTIONS - 1] - chords[0] + twist).abs() < 1e-9, "{chords:?}");
            let end = twists.series[0].points[20];
            assert!((end.1 - twist.to_degrees()).abs() < 1e-9 && end.0 == 10.0);
            let end = named(line, "x, to the suction side").points[20];
            assert!((end.0 - 10.0).abs() < 1e-12 && (end.1 - 1.0).abs() < 1e-12, "{end:?}");
            // The motion points to the leading edge, −y.
            let motion = seen.series.iter().find(|series| series.color == Some(TURNS)).unwrap();
            let edge = named(seen, "leading edge").points[0];
            assert!(motion.points[1].0 < motion.points[0].0 && edge.0 < 0.0, "{motion:?} {edge:?}");
        }
    }

    /// Against the other sense the same blade goes ahead with its trailing edge; turned by 90° its chords stand across its motion, and its flap direction along it.
    #[test]
    fn a_blade_mounted_wrong_is_seen() {
        let of = blade(0.0, 0.0);
        let edge = |direction: Vec3| {
            let panel = along(&of, Some((Vec3::ZERO, direction)));
            let motion = panel.series.iter().find(|series| series.color == Some(TURNS)).unwrap();
            assert!(motion.points[1].0 < motion.points[0].0, "{motion:?}");
            let flap = panel.series.iter().find(|series| series.color == Some(GREEN)).unwrap();
            (named(&panel, "leading edge").points[0], flap.points[1])
        };
        let near = |a: (f64, f64), b: (f64, f64)| (a.0 - b.0).abs().max((a.1 - b.1).abs()) < 1e-9;
        let [right, back, quarter] = [-Vec3::AXES[2], Vec3::AXES[2], Vec3::AXES[1]].map(edge);
        assert!(near(right.0, (-0.5, 0.0)) && near(right.1, (0.0, 0.4)), "{right:?}");
        assert!(near(back.0, (0.5, 0.0)) && near(back.1, (0.0, -0.4)), "{back:?}");
        assert!(near(quarter.0, (0.0, -0.5)) && near(quarter.1, (-0.4, 0.0)), "{quarter:?}");
    }

    #[test]
    fn a_straight_blade_has_neither_line_nor_twist_and_like_blades_are_drawn_once() {
        let figure = |blades: &[Blade]| assembly_figure(&Scene::default(), &[], blades, None, None);
        assert_eq!(figure(&[blade(0.0, 0.0)]).panels.len(), 4);
        assert_eq!(figure(&[]).panels.len(), 3);
        assert_eq!(figure(&[blade(0.2, 1.0), blade(0.2, 1.0)]).panels.len(), 6);
        let two = figure(&[blade(0.2, 1.0), blade(0.2, -1.0)]);
        assert_eq!(two.panels.len(), 9);
        // The factor by which the line is drawn larger across is that of its panel.
        let line = &two.panels[5];
        let (along, across) = (line.x.range.unwrap(), line.y.range.unwrap());
        let factor = (along.1 - along.0) / 250.0 * 125.0 / (across.1 - across.0);
        assert!(line.words[0].text.contains(&format!("{factor:.1} times")), "{:?}", line.words);
    }
}
