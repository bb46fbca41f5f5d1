//! What a run passes through between its records: extremes of the channels, and how fast it vibrates.

use super::Trajectory;
use flexion::system::{Side, State, System};
use std::f64::consts::TAU;

/// Most rows that are evaluated besides the records.
const MOST: f64 = 20_000.0;

/// Follows the accepted steps of a run.
pub(super) struct Passing {
    /// Shortest time between rows, and the time of the next \[s\].
    interval: f64,
    next: f64,
    /// The last three rows with their times, and how many of them belong to one smooth motion.
    rows: [(f64, Vec<f64>); 3],
    count: usize,
    /// Whether velocities may jump in any step.
    pub(super) rough: bool,
    last: State,
    /// Σ |Δv|² h² and Σ |Δq|² over the steps.
    sums: [f64; 2],
}

impl Passing {
    pub(super) fn new(system: &dyn System, state: &State, span: f64) -> Passing {
        let row = || (state.t, vec![0.0; system.channels().len()]);
        Passing {
            interval: span / MOST,
            next: f64::NEG_INFINITY,
            rows: [row(), row(), row()],
            count: 0,
            rough: false,
            last: state.clone(),
            sums: [0.0; 2],
        }
    }

    /// Takes a state; `trajectory` learns the extremes, also those of the parabola through three of them.
    pub(super) fn enter(&mut self, system: &mut dyn System, state: &State, trajectory: &mut Trajectory) {
        self.measure(state);
        let ends = state.side == Side::Left;
        let restarts = state.t == self.rows[2].0 && self.count > 0;
        if restarts {
            self.count = 0;
        } else if state.t < self.next && !ends {
            return;
        }
        self.next = state.t + self.interval;
        self.rows.rotate_left(1);
        let (time, row) = &mut self.rows[2];
        *time = state.t;
        system.record(state, row);
        self.count += 1;
        for (i, y) in self.rows[2].1.iter().enumerate() {
            trajectory.pass(i, state.t, *y);
        }
        if self.count > 2 && !self.rough {
            let [(t0, a), (t1, b), (t2, c)] = &self.rows;
            for (i, ((a, b), c)) in a.iter().zip(b).zip(c).enumerate() {
                if let Some((t, y)) = vertex([(*t0, *a), (*t1, *b), (*t2, *c)]) {
                    trajectory.pass(i, t, y);
                }
            }
        }
    }

    /// Steps a period of what the motion is most like: 2π (Σ|Δq|² / Σ|Δv|²h²)^½. `None` without a motion.
    pub(super) fn steps_a_period(&self) -> Option<f64> {
        let [by_velocity, by_configuration] = self.sums;
        let ratio = by_configuration / by_velocity;
        (!self.rough && ratio.is_finite() && ratio > 0.0).then(|| TAU * ratio.sqrt())
    }

    fn measure(&mut self, state: &State) {
        let h = state.t - self.last.t;
        if h > 0.0 && state.q.len() == state.v.len() {
            let square = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
            self.sums[0] += h * h * square(&state.v, &self.last.v);
            self.sums[1] += square(&state.q, &self.last.q);
        }
        self.last.copy_from(state);
    }
}

/// The vertex of the parabola through three points, if it lies between them.
fn vertex([(t0, a), (t1, b), (t2, c)]: [(f64, f64); 3]) -> Option<(f64, f64)> {
    let (first, second) = ((b - a) / (t1 - t0), (c - b) / (t2 - t1));
    let bend = (second - first) / (t2 - t0);
    let t = 0.5 * (t0 + t1) - 0.5 * first / bend;
    (first * second < 0.0 && t0 < t && t < t2).then_some((t, a + (t - t0) * (first + bend * (t - t1))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_vertex_of_a_parabola_is_found_and_that_of_a_line_is_not() {
        let at = |t: f64| (t, 3.0 - 2.0 * (t - 1.3) * (t - 1.3));
        let (t, y) = vertex([at(1.0), at(1.1), at(2.0)]).unwrap();
        assert!((t - 1.3).abs() < 1e-14 && (y - 3.0).abs() < 1e-14);
        assert_eq!(vertex([(0.0, 1.0), (1.0, 2.0), (2.0, 3.0)]), None);
        assert_eq!(vertex([(0.0, 1.0), (1.0, 1.0), (2.0, 1.0)]), None);
        assert_eq!(vertex([(0.0, 0.0), (1.0, 1.0), (2.0, 1.0)]), None);
    }
}
