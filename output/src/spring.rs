//! Springs beside the parts of a scene.

use flexion::linalg::Vec3;
use flexion::system::{Frame, State, System};

/// A spring to be drawn, as a line between its ends.
#[derive(Clone, Debug)]
pub struct Spring {
    /// Its name.
    pub name: String,
    /// Of each end what it is fixed to, the number of a body and a station \[m\], or nothing that moves; and its place in the axes
    /// there \[m\].
    pub ends: [(Option<(usize, f64)>, Vec3); 2],
}

impl Spring {
    /// Its line in a state.
    pub(super) fn line(&self, system: &mut dyn System, state: &State) -> [Vec3; 2] {
        self.ends.map(|(fixed, place)| {
            let Some((body, station)) = fixed else { return place };
            let mut frame = [Frame::default()];
            system.frames(body, state, &[station], &mut frame);
            frame[0].position + frame[0].rotation * place
        })
    }
}
