//! Speeds at which a frequency is near a multiple of the speed.

use super::diagram::{Campbell, Point};
use super::polynomial::Polynomial;
use crate::linalg::eigen::UNCERTAIN;

/// Relative distance of two speeds that count as one: the slope between nearer ones would be rounding.
const ONE: f64 = 1e-6;

/// A range of speeds in which a mode is near a line ω = k Ω.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resonance {
    /// Number of the branch, from 0.
    pub branch: usize,
    /// k
    pub revolutions: u32,
    /// First and last speed \[rad/s\].
    pub from: f64,
    /// See `from`.
    pub to: f64,
}

/// The ranges of speeds in which |ω − k Ω| ≤ `margin` · k Ω, for k from 1 to `revolutions`.
///
/// ω² is the polynomial of Ω through the two points of the branch on either side and its crossings between them, of degree three but for
/// crossings: that of a stiffness which grows with the centrifugal force, ω² = a + b Ω², and that of a whirl, ω² = (a ± Ω)², are
/// quadratic. Through two points it is linear in Ω².
pub fn resonances(campbell: &Campbell, revolutions: u32, margin: f64) -> Vec<Resonance> {
    let mut out: Vec<Resonance> = Vec::new();
    for (branch, b) in campbell.branches.iter().enumerate() {
        for k in 1..=revolutions {
            let crossings = campbell.crossings.iter().filter(|c| (c.branch, c.revolutions) == (branch, k));
            let crossings = crossings.map(|c| [c.speed, square(f64::from(k) * c.speed)]);
            let points =
                b.points.iter().map(|p| [p.speed, if rests(p) { 0.0 } else { square(p.mode.frequency()) }]);
            let mut points: Vec<[f64; 2]> = points.chain(crossings).collect();
            points.sort_by(|a, b| a[0].total_cmp(&b[0]));
            points.dedup_by(|b, a| b[0] - a[0] <= ONE * b[0]);
            let mut open = false;
            for i in 1..points.len() {
                let Some((from, to)) = near(&points, i, f64::from(k), margin) else {
                    open = false;
                    continue;
                };
                match out.last_mut() {
                    Some(last) if open && from <= points[i - 1][0] => last.to = to,
                    _ => out.push(Resonance { branch, revolutions: k, from, to }),
                }
                open = to >= points[i][0];
            }
        }
    }
    out
}

/// Whether a point is at rest, and its frequency zero but for rounding: there all lines begin.
pub(super) fn rests(point: &Point) -> bool {
    point.speed == 0.0 && !(point.mode.frequency() > 0.0 && point.mode.rounding < UNCERTAIN)
}

fn square(x: f64) -> f64 {
    x * x
}

/// The speeds between the point before `i` and that at which ω lies between (1 ± `margin`) k Ω.
fn near(points: &[[f64; 2]], i: usize, k: f64, margin: f64) -> Option<(f64, f64)> {
    let (mut from, mut to) = (points[i - 1][0], points[i][0]);
    let around = &points[i.saturating_sub(2)..(i + 2).min(points.len())];
    for (sign, side) in [(1.0, 1.0 - margin), (-1.0, 1.0 + margin)] {
        // What has to be positive.
        let inside = |[speed, frequency]: [f64; 2]| sign * (frequency - square(side * k * speed));
        let zero = || match around {
            [a, b] => {
                let (first, last) = (inside(*a), inside(*b));
                (square(a[0]) + first / (first - last) * (square(b[0]) - square(a[0]))).sqrt()
            }
            _ => {
                let values: Vec<_> = around.iter().map(|p| (p[0], inside(*p))).collect();
                Polynomial::through(&values).zero(points[i - 1][0], points[i][0])
            }
        };
        let before = if points[i - 1] == [0.0; 2] { points[i] } else { points[i - 1] };
        match (inside(before) >= 0.0, inside(points[i]) >= 0.0) {
            (true, true) => {}
            (true, false) => to = to.min(zero()),
            (false, true) => from = from.max(zero()),
            (false, false) => return None,
        }
    }
    (from < to).then_some((from, to))
}

#[cfg(test)]
mod tests {
    use super::super::diagram::{Branch, Point};
    use super::super::modes::{Mode, Shape, Shares};
    use super::*;
    use num_complex::Complex64;

    fn diagram(frequency: impl Fn(f64) -> f64) -> Campbell {
        let speeds: Vec<f64> = (0..=20).map(|i| 0.5 * f64::from(i)).collect();
        let mode = |speed: f64| Mode {
            eigenvalue: Complex64::new(0.0, frequency(speed)),
            vector: Vec::new(),
            residual: 0.0,
            rounding: 0.0,
            mesh: None,
            shares: Shares::default(),
            shape: Shape::default(),
            nodes: 0,
        };
        let points =
            speeds.iter().map(|&speed| Point { speed, mode: mode(speed), number: 0, assurance: 1.0 });
        let branches = vec![Branch { points: points.collect() }];
        Campbell {
            speeds,
            branches,
            crossings: Vec::new(),
            criticals: Vec::new(),
            instabilities: Vec::new(),
            unestimated: None,
        }
    }

    #[test]
    fn the_range_of_a_resonance_is_that_of_its_definition() {
        // |10 − kΩ| = kΩ/10 at Ω = 10/1.1 k and 10/0.9 k; that of k = 1 is cut off at the last speed.
        let found = resonances(&diagram(|_| 10.0), 2, 0.1);
        let ends: Vec<(u32, f64, f64)> = found.iter().map(|r| (r.revolutions, r.from, r.to)).collect();
        let expected = [(1, 10.0 / 1.1, 10.0), (2, 10.0 / 2.2, 10.0 / 1.8)];
        assert_eq!(ends.len(), 2, "{ends:?}");
        for (a, b) in ends.iter().zip(expected) {
            assert!(a.0 == b.0 && (a.1 - b.1).abs() < 1e-12 && (a.2 - b.2).abs() < 1e-12, "{a:?} {b:?}");
        }
    }

    #[test]
    fn the_range_of_a_stiffening_blade_needs_few_speeds() {
        // ω² = 9 + 1.2 Ω² is (0.95 · 2 Ω)² and (1.05 · 2 Ω)² at the ends.
        let mut few = diagram(|speed| (9.0 + 1.2 * speed * speed).sqrt());
        few.branches[0].points.retain(|p| [0.0, 10.0].contains(&p.speed));
        let found = resonances(&few, 2, 0.05);
        let end = |k: f64| (9.0 / (k * k - 1.2)).sqrt();
        let second = found.iter().find(|r| r.revolutions == 2).unwrap();
        assert!((second.from - end(2.1)).abs() < 1e-12 && (second.to - end(1.9)).abs() < 1e-12, "{second:?}");
    }

    #[test]
    fn a_rigid_motion_is_near_a_line_everywhere_or_nowhere() {
        let hinged = |frequency: f64| {
            let mut diagram = diagram(|speed| frequency * speed);
            let first = &mut diagram.branches[0].points[0].mode;
            (first.eigenvalue.im, first.rounding) = (1e-6, 1.0);
            resonances(&diagram, 4, 0.05)
        };
        assert_eq!(hinged(1.0724), []);
        let found = hinged(1.04);
        assert!(found.len() == 1 && (found[0].from, found[0].to) == (0.0, 10.0), "{found:?}");
    }

    #[test]
    fn a_mode_that_passes_twice_has_two_ranges_and_a_far_one_none() {
        let found = resonances(&diagram(|speed| 2.0 * speed + 3.0 * (speed - 3.0) * (speed - 7.0)), 2, 0.02);
        assert_eq!(found.iter().filter(|r| r.revolutions == 2).count(), 2, "{found:?}");
        assert!(resonances(&diagram(|_| 100.0), 3, 0.05).is_empty());
    }
}
