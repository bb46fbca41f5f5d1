//! Forces and couples of loads, contacts, joints and springs, and forces per length, as they are drawn.

use std::io;

use super::arrays::{Arrays, Numbers};
use flexion::system::{LineForce, PointForce, State, System};

/// Most forces that are kept, and most couples.
const MOST: usize = 50;
/// Most points of forces per length that are kept.
const MOST_POINTS: usize = 200;

/// Forces and couples of loads and contacts, and those that joints and springs transmit, which are far larger.
const KINDS: [(bool, [&str; 2]); 2] =
    [(false, ["force", "moment"]), (true, ["transmitted-force", "transmitted-moment"])];

/// All that are drawn.
#[derive(Clone, Debug, Default)]
pub(super) struct Forces {
    /// By their names, whether they are transmitted, and with six numbers a time: the place, and the force or the couple.
    at_points: Vec<(String, bool, [Vec<f32>; 2])>,
    /// By their names and numbers of points, with six numbers a time and point.
    along: Vec<(String, usize, Vec<f32>)>,
}

impl Forces {
    /// Takes those of a state.
    pub(super) fn take(&mut self, system: &mut dyn System, state: &State) {
        for (i, PointForce { name, place, force, moment, transmitted }) in
            system.point_forces(state).into_iter().enumerate()
        {
            if self.at_points.len() == i {
                self.at_points.push((name, transmitted, Default::default()));
            }
            for (values, vector) in self.at_points[i].2.iter_mut().zip([force, moment]) {
                values.extend(place.0.iter().chain(&vector.0).map(|x| *x as f32));
            }
        }
        for (i, LineForce { name, points }) in system.line_forces(state).into_iter().enumerate() {
            if self.along.len() == i {
                self.along.push((name, points.len(), Vec::new()));
            }
            self.along[i].2.extend(points.iter().flatten().flat_map(|vector| vector.0).map(|x| x as f32));
        }
    }

    /// Puts the arrays of those that act, and how many smaller ones are left out.
    ///
    /// # Errors
    /// Whatever `to` returns.
    pub(super) fn put(&self, times: u64, to: &mut dyn Arrays) -> io::Result<()> {
        let mut left = 0;
        for (transmitted, kinds) in KINDS {
            for (i, what) in kinds.into_iter().enumerate() {
                let of = self.at_points.iter().filter(|of| of.1 == transmitted);
                let (kept, out) = largest(of.map(|(name, _, values)| (name, 1, &*values[i])), MOST);
                left += out;
                for (name, _, values) in kept {
                    to.put(&format!("{name}.{what}"), &[times, 6], Numbers::Single(values))?;
                }
            }
        }
        let along = self.along.iter().map(|(name, points, values)| (name, *points, &**values));
        let (kept, out) = largest(along, MOST_POINTS);
        left += out;
        for (name, points, values) in kept {
            to.put(&format!("{name}.line-force"), &[times, points as u64, 6], Numbers::Single(values))?;
        }
        if left > 0 { to.put("left-out", &[1], Numbers::Single(&[left as f32])) } else { Ok(()) }
    }
}

/// A force with its name and its number of points.
type Named<N, V> = (N, usize, V);

/// Those that act at some time, the largest of them with so many points in all, each with a name of its own, and how many are left out.
fn largest<'f>(
    all: impl Iterator<Item = Named<&'f String, &'f [f32]>>,
    most: usize,
) -> (Vec<Named<String, &'f [f32]>>, usize) {
    let size = |values: &[f32]| {
        let vectors = values.as_chunks::<6>().0.iter().flat_map(|at| &at[3..]);
        vectors.fold(0.0_f32, |most, x| most.max(x.abs()))
    };
    let mut acting: Vec<_> = all.filter(|(.., values)| size(values) > 0.0).collect();
    acting.sort_by(|a, b| size(b.2).total_cmp(&size(a.2)));
    let found = acting.len();
    let mut named: Vec<Named<String, &[f32]>> = Vec::new();
    let mut total = 0;
    for (name, points, values) in acting {
        total += points;
        if total > most {
            break;
        }
        let mut own = name.clone();
        while named.iter().any(|(taken, ..)| *taken == own) {
            own.push('\'');
        }
        named.push((own, points, values));
    }
    let left = found - named.len();
    (named, left)
}

#[cfg(test)]
mod tests {
    use super::largest;

    #[test]
    fn the_smallest_of_many_are_left_out_and_counted() {
        let name = "contact".to_owned();
        let values: Vec<[f32; 6]> = (0..60).map(|k| [0.0, 0.0, 0.0, 0.0, k as f32, 0.0]).collect();
        let (kept, left) = largest(values.iter().map(|values| (&name, 1, &values[..])), 50);
        // The first exerts nothing.
        assert_eq!((kept.len(), left), (50, 9));
        assert!(kept.iter().all(|(.., values)| values[4] >= 10.0));
    }
}
