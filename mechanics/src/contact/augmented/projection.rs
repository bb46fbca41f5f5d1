//! The sets of the multipliers of a contact, and the projection on them.
//!
//! ```text
//! Λₙ = max(0, zₙ),   Λₜ = zₜ min(1, μΛₙ/|zₜ|),   or  Λₜ = −s Λₙ  where it slips as given
//! ```
//!
//! A free row keeps its z.

use crate::contact::RowLaw;

/// A contact: its normal row, and those of its friction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Group {
    pub normal: usize,
    pub friction: [usize; 2],
    /// Rows of friction.
    pub count: usize,
}

impl Group {
    pub fn rows(&self) -> impl Iterator<Item = usize> + '_ {
        std::iter::once(self.normal).chain(self.friction[..self.count].iter().copied())
    }
}

/// What a contact does at the argument of its projection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum State {
    Open,
    Closed,
    Sticks,
    /// It slips with these multipliers over μΛₙ, and with this part |μΛₙ|/|z| of what it would take to stick.
    Slips([f64; 2], f64),
    /// It slips as given, Λ = −s Λₙ.
    Given([f64; 2]),
}

/// The projection of the argument z of a contact into `lambda`.
pub(super) fn projected(
    group: &Group,
    laws: &[RowLaw],
    z: impl Fn(usize) -> f64,
    lambda: &mut [f64],
) -> State {
    let friction = &group.friction[..group.count];
    let normal = z(group.normal);
    // NaN is not open.
    if normal <= 0.0 && laws[group.normal] != RowLaw::Free {
        lambda[group.normal] = 0.0;
        friction.iter().for_each(|i| lambda[*i] = 0.0);
        return State::Open;
    }
    lambda[group.normal] = normal;
    let mut values = [0.0; 2];
    let Some(first) = friction.first() else { return State::Closed };
    let coefficient = match laws[*first] {
        RowLaw::Friction { coefficient, .. } => coefficient,
        RowLaw::Slip { .. } => {
            for (i, value) in friction.iter().zip(&mut values) {
                if let RowLaw::Slip { slope, .. } = laws[*i] {
                    (*value, lambda[*i]) = (slope, -slope * normal);
                }
            }
            return State::Given(values);
        }
        _ => return State::Closed,
    };
    friction.iter().zip(&mut values).for_each(|(i, value)| *value = z(*i));
    let (size, radius) = (libm::hypot(values[0], values[1]), coefficient * normal);
    if size <= radius {
        friction.iter().zip(values).for_each(|(i, value)| lambda[*i] = value);
        return State::Sticks;
    }
    let along = values.map(|x| x / size);
    friction.iter().zip(along).for_each(|(i, along)| lambda[*i] = radius * along);
    State::Slips(along, radius / size)
}
