//! A centreline through points.
//!
//! A cubic spline r(u) in each coordinate, without a break of r‴ at the second and the last but one point, with u the sum of the
//! chords up to a point: r and its curvature are of order 4 and 2 in the distance of the points. The arc length
//! s = ∫|r′| du is integrated by Gauss's rule and inverted by Newton's method. The height of the section follows the tangent without
//! turning about it, by double reflection:
//!
//! ```text
//! c = r₁ − r₀,   n* = n − 2 (c·n) c/c²,   t* = t − 2 (c·t) c/c²,   d = t₁ − t*,   n₁ = n* − 2 (d·n*) d/d²
//! ```
//!
//! Source of the double reflection, of order 4: Wang, Jüttler, Zheng & Liu (2008, doi 10.1145/1330511.1330513).

use crate::declaration::Bound::Any;
use crate::fault::{At, Fault, Made};
use crate::files;
use crate::keys::{File, keys, quantities, text};
use crate::units::LENGTH;
use flexion::linalg::Vec3;
use flexion::multibody::slender::Station;
use flexion::profile::{End, Profile, Table};
use flexion::quadrature::Gauss;

/// Pieces between two points for lengths and for the height of the section.
const PIECES: usize = 16;
/// Points of Gauss's rule in a piece.
const GAUSS: usize = 6;
/// Corrections of Newton's method for the place of an arc length.
const CORRECTIONS: usize = 50;

keys! {
    /// What a case says of the points of a curve.
    pub(super) struct Points {
        /// x of the points, from the root to the tip
        x: Vec<f64> = quantities(&LENGTH, Any).or_empty();
        /// their y
        y: Vec<f64> = quantities(&LENGTH, Any).or_empty();
        /// their z
        z: Vec<f64> = quantities(&LENGTH, Any).or_empty();
        /// CSV file of x, y and z of the points, in m or with the units in their titles, in place of the lists
        file: Option<File> = text();
    }
}

/// A curve through points, which begins in the first of them.
#[derive(Clone, Debug)]
pub struct Centreline {
    coordinates: [Table; 3],
    /// u and s at the ends of the pieces.
    ends: Vec<[f64; 2]>,
}

impl Centreline {
    /// The curve through the points of a case: `x`, `y` and `z`, or those of `file`.
    pub(super) fn of(Points { x, y, z, file }: Points) -> Made<Centreline> {
        let lists = [x, y, z];
        let written = lists.iter().any(|list| !list.is_empty());
        let (points, key) = match (file, written) {
            (Some(_), true) => {
                return Err(Fault::new("file", "the points are written as `x`, `y` and `z` too").into());
            }
            (Some(file), false) => {
                let what = "three numbers: x, y and z";
                let columns = [["x"], ["y"], ["z"]].each_ref().map(|name| (&name[..], &LENGTH));
                let rows = files::rows::read(&file.bytes, &file.name, what, columns).at("file")?;
                (rows.into_iter().map(Vec3).collect::<Vec<_>>(), "file")
            }
            (None, _) => {
                let count = lists[0].len();
                let other = lists.iter().zip(["x", "y", "z"]).find(|(list, _)| list.len() != count);
                if let Some((list, key)) = other {
                    let message = format!("there are {} values for {count} points", list.len());
                    return Err(Fault::new(key, message).into());
                }
                ((0..count).map(|i| Vec3([0, 1, 2].map(|k| lists[k][i]))).collect(), "x")
            }
        };
        Centreline::through(&points).at(key)
    }

    /// The curve through three points or more.
    fn through(points: &[Vec3]) -> Result<Centreline, String> {
        if points.len() < 3 {
            let count = points.len();
            return Err(format!("a curve needs three points or more, not {count}: two make a straight beam"));
        }
        let mut u = vec![0.0];
        for (i, pair) in points.windows(2).enumerate() {
            let chord = (pair[1] - pair[0]).norm();
            if !(chord > 0.0 && chord.is_finite()) {
                return Err(format!("points {} and {} are the same, or no numbers", i + 1, i + 2));
            }
            u.push(u[i] + chord);
        }
        let rows = |k: usize| u.iter().zip(points).map(|(u, x)| (*u, x[k])).collect::<Vec<_>>();
        let table = |k: usize| Table::new(&rows(k), End::default()).map_err(|error| error.to_string());
        let mut curve = Centreline { coordinates: [table(0)?, table(1)?, table(2)?], ends: vec![[0.0; 2]] };
        let mut s = 0.0;
        for pair in u.windows(2) {
            for k in 0..PIECES {
                let [from, to] = [k, k + 1].map(|k| pair[0] + (pair[1] - pair[0]) * k as f64 / PIECES as f64);
                s += curve.between(from, to);
                curve.ends.push([to, s]);
            }
        }
        Ok(curve)
    }

    fn position(&self, u: f64) -> Vec3 {
        Vec3([0, 1, 2].map(|k| self.coordinates[k].value(u)))
    }

    fn slope(&self, u: f64) -> Vec3 {
        Vec3([0, 1, 2].map(|k| self.coordinates[k].rate(u)))
    }

    /// The unit tangent; of a curve that turns back in itself, that of a chord.
    fn direction(&self, u: f64) -> Vec3 {
        let slope = self.slope(u);
        1.0 / slope.norm().max(f64::MIN_POSITIVE) * slope
    }

    /// Arc length between two places.
    fn between(&self, from: f64, to: f64) -> f64 {
        Gauss::new(GAUSS).integrate(from, to, |u| self.slope(u).norm())
    }

    /// Its length \[m\].
    pub(super) fn length(&self) -> f64 {
        self.ends.last().map_or(0.0, |[_, s]| *s)
    }

    /// The tangent of its root.
    pub(super) fn tangent(&self) -> Vec3 {
        self.direction(0.0)
    }

    /// The piece and the place u of an arc length.
    fn place(&self, s: f64) -> (usize, f64) {
        let piece = self.ends.partition_point(|[_, end]| *end <= s).clamp(1, self.ends.len() - 1) - 1;
        let ([from, before], [to, behind]) = (self.ends[piece], self.ends[piece + 1]);
        let mut u = from + (to - from) * ((s - before) / (behind - before)).clamp(0.0, 1.0);
        for _ in 0..CORRECTIONS {
            let step = (before + self.between(from, u) - s) / self.slope(u).norm().max(f64::MIN_POSITIVE);
            u = (u - step).clamp(from, to);
            if step.abs() <= 4.0 * f64::EPSILON * to {
                break;
            }
        }
        (piece, u)
    }

    /// Its stations by the arc length, if the height begins along `normal`.
    pub(super) fn stations(self, normal: Vec3) -> impl Fn(f64) -> Station + Send + Sync {
        let at = |curve: &Centreline, u: f64| (curve.position(u), curve.direction(u));
        let mut normals = vec![normal];
        for pair in self.ends.windows(2) {
            let last = normals[normals.len() - 1];
            normals.push(carried(last, at(&self, pair[0][0]), at(&self, pair[1][0])));
        }
        move |s| {
            let (piece, u) = self.place(s);
            let (position, tangent) = at(&self, u);
            let normal = carried(normals[piece], at(&self, self.ends[piece][0]), (position, tangent));
            // Rounding aside, it is across.
            let normal = normal.across(tangent);
            Station { position, tangent, normal: 1.0 / normal.norm() * normal }
        }
    }
}

/// `x` reflected at the plane across `by`; `x` itself where that has no direction.
fn reflected(x: Vec3, by: Vec3) -> Vec3 {
    let square = by.dot(by);
    if square > 0.0 { x - 2.0 * by.dot(x) / square * by } else { x }
}

/// The normal at one place, carried to another.
fn carried(normal: Vec3, (r, t): (Vec3, Vec3), (to, tangent): (Vec3, Vec3)) -> Vec3 {
    let chord = to - r;
    if chord.dot(chord) == 0.0 {
        return normal;
    }
    let [n, t] = [normal, t].map(|x| reflected(x, chord));
    reflected(n, tangent - t)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A helix: its arc length, its curvature, and the angle about the tangent by which the height falls behind its
    /// principal normal, which turns by the torsion.
    #[test]
    fn a_curve_through_the_points_of_a_helix_is_the_helix() {
        let (radius, rise): (f64, f64) = (0.5, 0.1);
        let scale = radius.hypot(rise);
        let at = |x: f64| Vec3([radius * x.cos(), radius * x.sin(), rise * x]);
        let error = |count: usize| {
            let points: Vec<Vec3> = (0..=count).map(|i| at(6.0 * i as f64 / count as f64)).collect();
            let curve = Centreline::through(&points).unwrap();
            let whole = curve.length();
            let inward = |x: f64| Vec3([-x.cos(), -x.sin(), 0.0]);
            let start = inward(0.0).across(curve.tangent());
            let stations = curve.stations(1.0 / start.norm() * start);
            let (mut place, mut angle) = ((whole - 6.0 * scale).abs(), 0.0_f64);
            for k in 0..=20 {
                let x = 6.0 * f64::from(k) / 20.0;
                let station = stations(x * scale);
                place = place.max((station.position - at(x)).norm());
                let turned = station.normal.dot(inward(x)).clamp(-1.0, 1.0).acos();
                let torsion = rise / (scale * scale);
                angle = angle.max((turned - torsion * x * scale).abs());
            }
            [place, angle]
        };
        let (coarse, fine) = (error(24), error(48));
        let order = [0, 1].map(|i| (coarse[i] / fine[i]).log2());
        assert!(fine[0] < 1e-5 && fine[1] < 1e-3, "{coarse:?} {fine:?}");
        assert!(order[0] > 3.5, "{order:?} of {coarse:?} {fine:?}");
    }

    #[test]
    fn points_that_make_no_curve_are_refused() {
        assert!(
            Centreline::through(&[Vec3([0.0; 3]), Vec3([1.0, 0.0, 0.0])])
                .unwrap_err()
                .contains("three points")
        );
        let twice = [Vec3::ZERO, Vec3::AXES[0], Vec3::AXES[0]];
        assert!(Centreline::through(&twice).unwrap_err().contains("points 2 and 3 are the same"));
    }
}
