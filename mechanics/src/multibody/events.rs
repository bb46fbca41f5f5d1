//! Known times, prescribed speeds that jump, and how fast parts rotate.

use super::system::Multibody;
use crate::system::{Break, Events, State};

/// Part of a prescribed speed by which it must change at one time to jump.
const SPEED: f64 = 1e-12;

impl Events for Multibody {
    fn breaks(&self) -> &[Break] {
        &self.constants.breaks
    }

    /// Of all bodies and nodes of beams.
    fn turning(&mut self, s: &State) -> f64 {
        let square = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>();
        let bodies = (0..self.placed.len()).map(|i| square(&s.v[6 * i + 3..6 * i + 6]));
        let beams = self.constants.model.beams.iter().zip(&self.constants.beams);
        let nodes = beams.map(|(of, &[_, j])| of.beam.turning(&s.v[j..]));
        nodes.fold(bodies.fold(0.0, f64::max).sqrt(), f64::max)
    }

    /// ∂g/∂t of a prescribed motion is −ω.
    fn impulse(&mut self, s: &State, p: &mut [f64]) -> bool {
        p.fill(0.0);
        self.place(s);
        let mut jumps = false;
        for (i, (joint, row)) in
            self.constants.rows.iter().enumerate().filter(|(_, (_, row))| row.is_prescribed())
        {
            let Some(motion) = self.constants.model.joints[*joint].prescribed() else { continue };
            let (a, b) = self.ends(*joint);
            let [before, after] = [s.t.next_down(), s.t].map(|t| row.value(a, b, &motion.at(t)).by_time);
            let jump = after - before;
            // A smooth motion changes by its rounding.
            if jump.abs() > SPEED * before.abs().max(after.abs()) {
                p[s.v.len() + i] = jump;
                jumps = true;
            }
        }
        jumps
    }
}
