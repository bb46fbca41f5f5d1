//! Crossings of the modes with the lines of whole revolutions.
//!
//! Between two speeds of the diagram f(Ω) = ω(Ω) − k Ω changes its sign. Its zero is enclosed by regula falsi with
//! halved ordinates (Illinois), with the modes computed at each speed.
//!
//! Source: M. Dowell & P. Jarratt, *BIT* 11 (1971) 168–174, doi:10.1007/BF01934364.

use super::diagram::{Branch, Crossing, Point};
use super::solved::Solved;
use super::speeds::Speeds;
use num_complex::Complex64;

/// Relative accuracy of a speed.
const ACCURACY: f64 = 1e-9;
/// Modes computed for a crossing.
const EVALUATIONS: usize = 30;

/// All crossings, ascending in the speed. Where the mode cannot be identified in between, the place is interpolated.
pub(super) fn crossings(
    system: &mut Speeds<'_>,
    solved: &[Solved],
    branches: &[Branch],
    revolutions: u32,
) -> Vec<Crossing> {
    let mut out = Vec::new();
    for (branch, b) in branches.iter().enumerate() {
        for k in 1..=revolutions {
            for (w, at) in b.points.windows(2).zip(solved) {
                let (a, c) = (above(&w[0], k), above(&w[1], k));
                // At rest the lines all begin: a rigid motion crosses none of them there.
                if (a > 0.0) != (c > 0.0) && w[0].mode.frequency().max(w[1].mode.frequency()) > 0.0 {
                    let speed = located(system, at, [&w[0], &w[1]], k)
                        .unwrap_or_else(|| w[0].speed + (w[1].speed - w[0].speed) * a / (a - c));
                    out.push(Crossing { branch, revolutions: k, speed });
                }
            }
        }
    }
    out.sort_by(|a, b| a.speed.total_cmp(&b.speed));
    out
}

/// ω − k Ω
fn above(point: &Point, k: u32) -> f64 {
    point.mode.frequency() - f64::from(k) * point.speed
}

/// The speed at which a mode crosses a line between two points of its branch, of which the first is among those `at`.
fn located(system: &mut Speeds<'_>, at: &Solved, ends: [&Point; 2], k: u32) -> Option<f64> {
    let x = &ends[0].mode.vector;
    let number = at.modes.iter().position(|m| m.vector == *x)?;
    let mx = at.massed.get(number)?;
    let mut low = (ends[0].speed, above(ends[0], k));
    let mut high = (ends[1].speed, above(ends[1], k));
    let mut last_side = 0;
    for _ in 0..EVALUATIONS {
        let speed = low.0 - low.1 * (high.0 - low.0) / (high.1 - low.1);
        let part = (speed - ends[0].speed) / (ends[1].speed - ends[0].speed);
        let near = blend(x, mx, &ends[1].mode.vector, part)?;
        // Some modes beyond it, so that it may cross them.
        let (mode, mac) = system.mode_like(speed, at, number + 2, (&near, f64::from(k) * speed))?;
        if mac < 0.8 {
            return None;
        }
        let value = mode.frequency() - f64::from(k) * speed;
        if value.abs() <= ACCURACY * f64::from(k) * speed || high.0 - low.0 <= ACCURACY * high.0 {
            return Some(speed);
        }
        if (value > 0.0) == (low.1 > 0.0) {
            low = (speed, value);
            if last_side == -1 {
                high.1 *= 0.5;
            }
            last_side = -1;
        } else {
            high = (speed, value);
            if last_side == 1 {
                low.1 *= 0.5;
            }
            last_side = 1;
        }
    }
    None
}

/// x + part (y − x), y rotated to the phase of x; `None` if they are not much alike.
fn blend(x: &[Complex64], mx: &[Complex64], y: &[Complex64], part: f64) -> Option<Vec<Complex64>> {
    let alike: Complex64 = mx.iter().zip(y).map(|(mx, y)| mx.conj() * y).sum();
    let size = alike.norm();
    if !(size > 0.8) {
        return None;
    }
    let turn = alike.conj() / size * part;
    Some(x.iter().zip(y).map(|(x, y)| x * (1.0 - part) + turn * y).collect())
}
