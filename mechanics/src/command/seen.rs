//! The states of laws beside those of the model.

use crate::system::{Size, State};

/// States x of laws among the unknowns of a model with them: behind its velocities v, with X = ∫ x dt behind its coordinates.
pub(super) struct Seen {
    /// Size of the model.
    pub(super) model: Size,
    /// Number of states.
    pub(super) states: usize,
    state: State,
}

impl Seen {
    pub(super) fn new(model: Size, states: usize) -> Seen {
        Seen { model, states, state: State::zeros(model, 0.0) }
    }

    /// The state as the model sees it.
    pub(super) fn of<'a>(&'a mut self, s: &'a State) -> &'a State {
        if self.states == 0 {
            return s;
        }
        let Size { q, v, .. } = self.model;
        let seen = &mut self.state;
        (seen.t, seen.side) = (s.t, s.side);
        seen.q.copy_from_slice(&s.q[..q]);
        seen.v.copy_from_slice(&s.v[..v]);
        seen.a.copy_from_slice(&s.a[..v]);
        seen.lambda.clone_from(&s.lambda);
        seen.mode.clone_from(&s.mode);
        seen.memory.clone_from(&s.memory);
        seen
    }

    /// The same of a state that is written nowhere.
    pub(super) fn copy(&self, s: &State) -> State {
        Seen::new(self.model, self.states).of(s).clone()
    }

    /// Writes what the model has made of its state into the state.
    pub(super) fn put(&self, model: &State, s: &mut State) {
        let Size { q, v, .. } = self.model;
        (s.t, s.side) = (model.t, model.side);
        s.q[..q].copy_from_slice(&model.q);
        s.v[..v].copy_from_slice(&model.v);
        s.a[..v].copy_from_slice(&model.a);
        s.lambda.clone_from(&model.lambda);
        s.mode.clone_from(&model.mode);
        s.memory.clone_from(&model.memory);
    }

    /// The states of laws.
    pub(super) fn laws<'a>(&self, s: &'a State) -> &'a [f64] {
        &s.v[self.model.v..]
    }
}
