//! The points of a reference line and the rows of its twist as a file has them, and what is unlikely of them.
//!
//! The lines of blades bend slowly, and mostly in one sense. A point that is shifted aside makes a zigzag, angles of three points in a row with
//! alternating signs. In ten published blades and in 200 drawn at random there is none, and neighbouring pieces of a line differ by at most 3°.

use super::line::Line;
use super::smooth::{is_smooth, leaving};
use flexion::linalg::Vec3;

/// The points and the rows of the twist, each with its line in the file.
#[derive(Default)]
pub(super) struct Keypoints {
    /// The file.
    pub name: String,
    /// Points, where the file has any.
    pub points: Vec<(usize, Vec3)>,
    /// Place along the line and angle \[°\] of the twist.
    pub twist: Vec<(usize, f64, f64)>,
}

/// Lengths \[m\].
const LENGTHS: [f64; 2] = [0.01, 300.0];
/// Angles of the twist \[°\], and of a twist that may be in radians.
const TWIST: [f64; 2] = [0.6, 90.0];
/// Angles \[°\] by which a row of the twist may leave both its neighbours where all others are smooth, and where they are not, and its one neighbour at
/// an end, there with so many times the rate beside it.
const TURNED: [f64; 4] = [1.5, 15.0, 8.0, 4.0];
/// Degrees by which the twist may grow towards the tip: in 18 published blades it falls by 13° to 25°.
const GROWN: f64 = 10.0;
/// Largest inclination of the line against z \[°\].
const INCLINED: f64 = 70.0;
/// Part of the length by which a line is swept that is not prebent.
const SWEPT: f64 = 0.01;
/// Part of the length by which a line may leave the z axis: published blades have up to 0.05.
const REACH: f64 = 0.2;
/// Least angle \[°\] of a zigzag, and of one at an end, and part of the length by which its point is aside.
const ZIGZAG: [f64; 2] = [0.3, 2.0];
const ASIDE: f64 = 2e-4;
/// Angle \[°\] at the last point before an end, and times those at other points, from which the end is shifted.
const BENT: [f64; 2] = [10.0, 5.0];

impl Keypoints {
    /// `FILE`, or `line 3 of FILE`.
    fn at(&self, line: usize) -> String {
        if line == 0 { self.name.clone() } else { format!("line {line} of {}", self.name) }
    }

    /// What is unlikely of a line with these points; whether its twist is positive as that of a rotor blade.
    pub fn cautions(&self, line: &Line, twists: bool) -> Vec<String> {
        let (mut out, length) = (Vec::new(), line.length());
        if !(LENGTHS[0]..=LENGTHS[1]).contains(&length) {
            let end = self.points.last().map_or(0, |point| point.0);
            out.push(format!(
                "{}: the line is {length:.4e} m long; are its coordinates in metres?",
                self.at(end)
            ));
        }
        out.extend(self.of_points(length));
        out.extend(self.of_twist());
        out.extend(self.grown().filter(|_| twists));
        out
    }

    fn of_points(&self, length: f64) -> Vec<String> {
        let (mut out, points) = (Vec::new(), &self.points);
        let Some((_, root)) = points.first() else { return out };
        let angles = [0, 1].map(|k| -> Vec<f64> {
            let angle = |d: Vec3| libm::atan2(d[k], d[2]).to_degrees();
            points.windows(2).map(|pair| angle(pair[1].1 - pair[0].1)).collect()
        });
        let steps = points.windows(2).map(|pair| pair[1].1 - pair[0].1);
        let inclined = steps.map(|step| libm::acos((step[2] / step.norm()).clamp(-1.0, 1.0)).to_degrees());
        let most = inclined.enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((i, angle)) = most.filter(|(_, angle)| *angle > INCLINED) {
            out.push(format!(
                "{}: before point {} the line is inclined by {angle:.0}° against z, which goes along the blade: are x and y in the units of z?",
                self.at(points[i + 1].0),
                i + 2
            ));
        }
        let reach = [0, 1].map(|k| {
            let aside =
                points.iter().map(|(line, place)| (*line, (place[k] - root[k]).abs(), place[k].abs()));
            aside.fold((0, 0.0, 0.0_f64), |most, next| {
                let far = most.2.max(next.2);
                if next.1 > most.1 { (next.0, next.1, far) } else { (most.0, most.1, far) }
            })
        });
        if reach[0].2 == 0.0 && reach[1].1 > SWEPT * length {
            out.push(format!(
                "{}: the line is swept by {:.3} m along y, edgewise, and not prebent along x: are both exchanged?",
                self.at(reach[1].0),
                reach[1].1
            ));
        }
        let farther =
            |k: &usize| reach[*k].1 > REACH * length && most.is_none_or(|(_, angle)| angle <= INCLINED);
        if let Some(k) = (0..2).find(farther) {
            let (line, aside, _) = reach[k];
            out.push(format!(
                "{}: the line leaves its root by {aside:.4e} m along {}, {:.0} % of its length, and those of blades by few per cent: is a unit or a \
                 factor of {} wrong?",
                self.at(line),
                ["x", "y"][k],
                100.0 * aside / length,
                ["x", "y"][k]
            ));
        }
        out.extend((0..2).find_map(|k| self.zigzag(k, &angles[k], length)));
        out
    }

    /// A point that is shifted along x or y, of the inclinations \[°\] of the pieces.
    fn zigzag(&self, k: usize, angles: &[f64], length: f64) -> Option<String> {
        let n = self.points.len();
        if n < 5 {
            return None;
        }
        let bend = |i: usize| angles[i] - angles[i - 1];
        let others = |but: &[usize]| {
            (1..n - 1).filter(|i| !but.contains(i)).fold(0.0_f64, |most, i| most.max(bend(i).abs()))
        };
        let turns = |i: usize, j: usize| bend(i) * bend(j) < 0.0;
        let piece = |i: usize| (self.points[i].1 - self.points[i - 1].1).norm();
        let aside =
            |i: usize| bend(i).to_radians().abs() * piece(i) * piece(i + 1) / (piece(i) + piece(i + 1));
        let is_zigzag = |i: &usize| {
            let least = bend(i - 1).abs().min(bend(*i).abs()).min(bend(i + 1).abs());
            turns(i - 1, *i) && turns(*i, i + 1) && least > ZIGZAG[0] && aside(*i) > ASIDE * length
        };
        let largest = (2..n - 2).filter(is_zigzag).max_by(|a, b| bend(*a).abs().total_cmp(&bend(*b).abs()));
        let at_end = || {
            [(1, 2), (n - 2, n - 3)].into_iter().find_map(|(i, next)| {
                let least = bend(i).abs().min(bend(next).abs());
                let is = turns(i, next) && least > ZIGZAG[1] && BENT[1] * others(&[i, next]) < bend(i).abs();
                is.then_some(i)
            })
        };
        let axis = ["x", "y"][k];
        if let Some(i) = largest.or_else(at_end) {
            let place = |i: usize| self.points[i].1[k];
            return Some(format!(
                "{}: point {} makes a zigzag of the line: its {axis} is {:.4} m, and {:.4} and {:.4} m at the points before and behind it, where the line bends \
                 the other way: is a digit, a sign or its z wrong?",
                self.at(self.points[i].0),
                i + 1,
                place(i),
                place(i - 1),
                place(i + 1)
            ));
        }
        let (i, end) = [(1, 0), (n - 2, n - 1)]
            .into_iter()
            .find(|(i, _)| bend(*i).abs() > BENT[0] && BENT[1] * others(&[*i]) < bend(*i).abs())?;
        Some(format!(
            "{}: the line bends by {:.1}° at point {} beside its end, and elsewhere by at most {:.1}°: is {axis} of point {} wrong? (A bend that is meant needs \
             more points, for the line is a spline.)",
            self.at(self.points[end].0),
            bend(i).abs(),
            i + 1,
            others(&[i]),
            end + 1
        ))
    }

    /// A twist that grows from root to tip. (That of a blade for the other sense of rotation has the other sign and falls in size.)
    fn grown(&self) -> Option<String> {
        let [(_, _, root), .., (line, _, tip)] = &self.twist[..] else { return None };
        (tip - root > GROWN && tip.abs() - root.abs() > GROWN).then(|| {
            format!(
                "{}: the twist grows from {root:.4}° at the root to {tip:.4}° here, at the tip, and that of rotor blades falls: is the column in the order from \
                 tip to root, or its sign another?",
                self.at(*line)
            )
        })
    }

    fn of_twist(&self) -> Vec<String> {
        let (mut out, rows) = (Vec::new(), &self.twist);
        let Some((line, _, twist)) = rows.iter().max_by(|a, b| a.2.abs().total_cmp(&b.2.abs())) else {
            return out;
        };
        let (most, n) = (twist.abs(), rows.len());
        if most > TWIST[1] {
            out.push(format!("{}: the twist reaches {twist:.4e}°: is it in another unit?", self.at(*line)));
        } else if most > 0.0 && most < TWIST[0] {
            out.push(format!(
                "{}: the twist reaches only {most:.4}°: were radians taken for degrees?",
                self.at(*line)
            ));
        }
        let v: Vec<f64> = rows.iter().map(|(.., angle)| *angle).collect();
        let leaves = |i: usize| leaving(&v, i, i);
        let is_turned = |i: &usize| {
            leaves(*i) > TURNED[1] || leaves(*i) > TURNED[0] && is_smooth(n, *i, leaves, leaves(*i))
        };
        let turned = (1..n.max(2) - 1).filter(is_turned).max_by(|a, b| leaves(*a).total_cmp(&leaves(*b)));
        if let Some(i) = turned {
            out.push(format!(
                "{}: the twist is {:.4}°, and {:.4}° and {:.4}° before and behind it: is a digit or a sign wrong?",
                self.at(rows[i].0),
                v[i],
                v[i - 1],
                v[i + 1]
            ));
            return out;
        }
        let rate = |i: usize| (v[i] - v[i - 1]) / (rows[i].1 - rows[i - 1].1).max(f64::MIN_POSITIVE);
        let ends = [(0, 1, 1, 2), (n.max(1) - 1, n.max(2) - 2, n.max(1) - 1, n.max(2) - 2)];
        let is_off = |(end, beside, step, next): &(usize, usize, usize, usize)| {
            (v[*end] - v[*beside]).abs() > TURNED[2] && rate(*step).abs() > TURNED[3] * rate(*next).abs()
        };
        if let Some((end, beside, ..)) = ends.into_iter().filter(|_| n >= 5).find(is_off) {
            out.push(format!(
                "{}: the twist is {:.4}° at this end and {:.4}° beside it, where it changes by less: is a digit or a sign wrong?",
                self.at(rows[end].0),
                v[end],
                v[beside]
            ));
        }
        out
    }
}
