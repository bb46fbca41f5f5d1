//! Forces and couples of loads, contacts, joints and springs, as they are drawn.

use std::io;

use super::arrays::{Arrays, Numbers};
use flexion::system::{PointForce, State, System};

/// Most forces that are kept, and most couples.
const MOST: usize = 50;

/// Forces and couples of loads and contacts, and those that joints and springs transmit, which are far larger.
const KINDS: [(bool, [&str; 2]); 2] =
    [(false, ["force", "moment"]), (true, ["transmitted-force", "transmitted-moment"])];

/// All by their names, whether they are transmitted, and with six numbers a time: the place, and the force or the couple.
#[derive(Clone, Debug, Default)]
pub(super) struct Forces(Vec<(String, bool, [Vec<f32>; 2])>);

impl Forces {
    /// Takes those of a state.
    pub(super) fn take(&mut self, system: &mut dyn System, state: &State) {
        for (i, PointForce { name, place, force, moment, transmitted }) in
            system.point_forces(state).into_iter().enumerate()
        {
            if self.0.len() == i {
                self.0.push((name, transmitted, Default::default()));
            }
            for (values, vector) in self.0[i].2.iter_mut().zip([force, moment]) {
                values.extend(place.0.iter().chain(&vector.0).map(|x| *x as f32));
            }
        }
    }

    /// Puts the arrays of those that act.
    ///
    /// # Errors
    /// Whatever `to` returns.
    pub(super) fn put(&self, times: u64, to: &mut dyn Arrays) -> io::Result<()> {
        for (transmitted, kinds) in KINDS {
            for (i, what) in kinds.into_iter().enumerate() {
                for (name, values) in self.acting(transmitted, i) {
                    to.put(&format!("{name}.{what}"), &[times, 6], Numbers::Single(values))?;
                }
            }
        }
        Ok(())
    }

    /// Those that act at some time, the largest of them, each with a name of its own.
    fn acting(&self, transmitted: bool, i: usize) -> Vec<(String, &[f32])> {
        let size = |values: &[f32]| {
            let vectors = values.as_chunks::<6>().0.iter().flat_map(|at| &at[3..]);
            vectors.fold(0.0_f32, |most, x| most.max(x.abs()))
        };
        let of = self.0.iter().filter(|of| of.1 == transmitted);
        let all = of.map(|(name, _, values)| (name, &*values[i]));
        let mut acting: Vec<_> = all.filter(|(_, values)| size(values) > 0.0).collect();
        acting.sort_by(|(_, a), (_, b)| size(b).total_cmp(&size(a)));
        acting.truncate(MOST);
        let mut named: Vec<(String, &[f32])> = Vec::new();
        for (name, values) in acting {
            let mut own = name.clone();
            while named.iter().any(|(taken, _)| *taken == own) {
                own.push('\'');
            }
            named.push((own, values));
        }
        named
    }
}
