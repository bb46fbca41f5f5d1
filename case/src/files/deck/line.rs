//! The reference line of a blade, with the axes of its sections.
//!
//! The coordinates are natural cubic splines of a parameter u, the twist is linear in u between its rows, and s = ∫ |r′| du is the arc length.
//! In the axes of the blade, x to the suction side, y edgewise, z along it, with the unit tangent t of the line, the axes of a section without
//! twist are those of BeamDyn: the first is square to t and has no component along y, the second is t × the first. The twist φ turns both about
//! t by −φ:
//!
//! ```text
//! e = (t_z, 0, −t_x)/√(t_x² + t_z²),   g = t × e,   height = cos φ g + sin φ e,   across = t × height = sin φ g − cos φ e
//! ```

use flexion::linalg::{Mat3, Vec3};
use flexion::profile::{End, Profile, Table};
use flexion::quadrature::Gauss;
use flexion::system::Frame;

/// Points of Gauss's rule between two points of the line.
const GAUSS: usize = 20;
/// Corrections of Newton's method for the place of an arc length.
const CORRECTIONS: usize = 50;
/// Least part of the tangent in the plane of x and z.
const LEAST: f64 = 1e-3;

/// A reference line.
#[derive(Clone, Debug)]
pub struct Line {
    coordinates: [Table; 3],
    /// Parameter and arc length of the points.
    arcs: Vec<[f64; 2]>,
    /// Parameter and angle \[rad\].
    twist: Vec<[f64; 2]>,
    gauss: Gauss,
}

impl Line {
    /// The line through points (u, place \[m\]) of ascending u, with the twist at rows (u, angle \[rad\]) of ascending u.
    pub(crate) fn through(points: &[(f64, Vec3)], twist: &[[f64; 2]]) -> Result<Line, String> {
        let mut points = points.to_vec();
        let is_straight = points.len() == 2;
        if let [(u, a), (v, b)] = points[..] {
            points.insert(1, (0.5 * (u + v), 0.5 * (a + b)));
        }
        let table = |k: usize| {
            let rows: Vec<(f64, f64)> = points.iter().map(|(u, place)| (*u, place[k])).collect();
            Table::new(&rows, End::Natural).map_err(|error| error.to_string())
        };
        let coordinates = [table(0)?, table(1)?, table(2)?];
        let arcs = vec![[points[0].0, 0.0]];
        let mut line = Line { coordinates, arcs, twist: twist.to_vec(), gauss: Gauss::new(GAUSS) };
        let mut s = 0.0;
        for (number, pair) in points.windows(2).enumerate() {
            s += line.between(pair[0].0, pair[1].0);
            line.arcs.push([pair[1].0, s]);
            for u in [pair[0].0, 0.5 * (pair[0].0 + pair[1].0), pair[1].0] {
                let slope = line.slope(u);
                let size = slope.norm();
                if !(size > 0.0 && libm::hypot(slope[0], slope[2]) > LEAST * size) {
                    return Err(format!(
                        "between its points {} and {} the line goes along y, or nowhere, where the axes of sections are not defined",
                        number + 1,
                        number + 2
                    ));
                }
            }
        }
        if is_straight {
            // The point in the middle is for the spline alone: no element ends there.
            line.arcs.remove(1);
        }
        Ok(line)
    }

    /// A straight line along z of a length, with the twist at rows (s, angle \[rad\]).
    pub(crate) fn straight(length: f64, twist: &[[f64; 2]]) -> Result<Line, String> {
        let mut line = Line::through(&[(0.0, Vec3::ZERO), (length, Vec3([0.0, 0.0, length]))], twist)?;
        // The length to the last digit, as stations are given.
        line.arcs.iter_mut().for_each(|arc| arc[1] = arc[0]);
        Ok(line)
    }

    fn slope(&self, u: f64) -> Vec3 {
        Vec3([0, 1, 2].map(|k| self.coordinates[k].rate(u)))
    }

    fn between(&self, from: f64, to: f64) -> f64 {
        self.gauss.integrate(from, to, |u| self.slope(u).norm())
    }

    /// Its length \[m\].
    pub fn length(&self) -> f64 {
        self.arcs.last().map_or(0.0, |[_, s]| *s)
    }

    /// The interval of points in which the k-th number of `arcs` is.
    fn interval(&self, k: usize, x: f64) -> usize {
        self.arcs.partition_point(|arc| arc[k] <= x).clamp(1, self.arcs.len() - 1) - 1
    }

    /// Arc length \[m\] of a parameter.
    pub(super) fn arc(&self, u: f64) -> f64 {
        let [[from, s], [to, end]] = self.ends(self.interval(0, u));
        if u == to { end } else { s + self.between(from, u) }
    }

    fn ends(&self, interval: usize) -> [[f64; 2]; 2] {
        [self.arcs[interval], self.arcs[interval + 1]]
    }

    /// Parameter of an arc length \[m\].
    pub(super) fn parameter(&self, s: f64) -> f64 {
        let [[from, before], [to, behind]] = self.ends(self.interval(1, s));
        let mut u = from + (to - from) * ((s - before) / (behind - before)).clamp(0.0, 1.0);
        for _ in 0..CORRECTIONS {
            let step = (before + self.between(from, u) - s) / self.slope(u).norm().max(f64::MIN_POSITIVE);
            u = (u - step).clamp(from, to);
            if step.abs() <= 4.0 * f64::EPSILON * to.abs() {
                break;
            }
        }
        u
    }

    /// The rows of the twist on both sides of a parameter.
    fn twist_rows(&self, u: f64) -> Option<[[f64; 2]; 2]> {
        let last = self.twist.len().checked_sub(1).filter(|last| *last > 0)?;
        let i = self.twist.partition_point(|row| row[0] <= u).clamp(1, last) - 1;
        Some([self.twist[i], self.twist[i + 1]])
    }

    /// The twist \[rad\] at a parameter, in the sense of BeamDyn: positive about −z.
    fn twist_at(&self, u: f64) -> f64 {
        match self.twist_rows(u) {
            None => self.twist.first().map_or(0.0, |[_, only]| *only),
            Some([[a, f], [b, g]]) => f + (g - f) * ((u - a) / (b - a)).clamp(0.0, 1.0),
        }
    }

    /// The twist \[rad\] at an arc length, in the sense of BeamDyn: positive about −z.
    pub fn twist(&self, s: f64) -> f64 {
        self.twist_at(self.parameter(s))
    }

    /// Rate [rad/m] of the twist along the line at an arc length \[m\], in the same sense; at a row of the twist that behind it.
    pub fn twist_rate(&self, s: f64) -> f64 {
        let u = self.parameter(s);
        let inside = |[a, b]: &[[f64; 2]; 2]| a[0] < b[0] && (a[0]..=b[0]).contains(&u);
        let rate = |[a, b]: [[f64; 2]; 2]| (b[1] - a[1]) / (b[0] - a[0]) / self.slope(u).norm();
        self.twist_rows(u).filter(inside).map_or(0.0, rate)
    }

    /// The axes e and g of a section without twist, of the unit tangent of the line.
    pub(crate) fn untwisted(t: Vec3) -> (Vec3, Vec3) {
        let square = libm::hypot(t[0], t[2]);
        let e = Vec3([t[2] / square, 0.0, -t[0] / square]);
        (e, t.cross(e))
    }

    /// Place \[m\] and axes of the section at an arc length \[m\], in the axes of the blade: the columns are tangent, height, and
    /// across = tangent × height.
    pub fn frame(&self, s: f64) -> Frame {
        let u = self.parameter(s);
        let position = Vec3([0, 1, 2].map(|k| self.coordinates[k].value(u)));
        let slope = self.slope(u);
        let t = slope / slope.norm();
        let (e, g) = Line::untwisted(t);
        let (sin, cos) = libm::sincos(self.twist_at(u));
        let height = cos * g + sin * e;
        Frame { position, rotation: Mat3::columns([t, height, t.cross(height)]) }
    }

    /// Arc lengths of its points and of the rows of its twist, inside it: what is smooth ends there.
    pub fn breaks(&self) -> Vec<f64> {
        let length = self.length();
        let rows = self.twist.iter().map(|[u, _]| self.arc(*u));
        let mut breaks: Vec<f64> = self.arcs.iter().map(|[_, s]| *s).chain(rows).collect();
        breaks.retain(|s| *s > 0.0 && *s < length);
        breaks.sort_by(f64::total_cmp);
        breaks.dedup_by(|a, b| *a - *b <= 1e-9 * length);
        breaks
    }
}
