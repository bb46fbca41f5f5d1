//! Contacts that rub in space: friction of two components.
//!
//! The friction of such a contact is opposite to its sliding, whose direction is another one at every time and none where it ends: events do not find that. The way
//! to the contact, its impact and the way behind it have a method's own steps; while such a contact is closed, the steps of a [burst](super::burst) resolve it.

use crate::system::{Mode, Set, State};

/// The rows of the normal forces of such contacts.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Rubbing(Vec<usize>);

impl Rubbing {
    pub(super) fn new(sets: &[Set]) -> Rubbing {
        let mut normals = Vec::new();
        let mut last = None;
        for set in sets {
            let Set::Friction { normal, .. } = *set else { continue };
            if last == Some(normal) && normals.last() != Some(&normal) {
                normals.push(normal);
            }
            last = Some(normal);
        }
        Rubbing(normals)
    }

    /// Whether one of them is closed.
    pub(super) fn is_on(&self, state: &State) -> bool {
        self.0.iter().any(|row| state.mode[*row] != Mode::Open)
    }
}
