//! Beams in space whose sections are known in the plane of x and y alone: whether a run takes them out of it.

use crate::case::Case;
use flexion::linalg::{Mat3, Vec3};
use flexion::system::{Frame, State, System};

/// Distance from the plane over the length of the beam, and sine of an angle to it, from which on a beam has left the plane.
const OUT: f64 = 1e-6;
/// Where a beam is looked at, over its length.
const PLACES: [f64; 3] = [0.0, 0.5, 1.0];

/// Watches the planar beams of a case.
pub(super) struct Plane {
    beams: Vec<Watched>,
    /// Where the one that has left it first was, and when \[s\].
    left: Option<(String, f64)>,
}

struct Watched {
    /// Its number among what is drawn.
    number: usize,
    name: String,
    length: f64,
    start: [Frame; 3],
}

impl Plane {
    /// Of a system that is where it was written.
    pub(super) fn new(case: &Case, system: &mut dyn System) -> Plane {
        let state = system.initial();
        let watched = case.space().into_iter().flat_map(|space| {
            let planar = space.beams.iter().enumerate().filter(|(_, (beam, _))| beam.planar);
            planar.map(|(i, (beam, _))| (space.bodies.len() + i, beam))
        });
        let beams = watched.map(|(number, beam)| Watched {
            number,
            name: beam.name.clone(),
            length: beam.length,
            start: frames(system, &state, (number, beam.length)),
        });
        Plane { beams: beams.collect(), left: None }
    }

    /// Looks at a state.
    pub(super) fn look(&mut self, system: &mut dyn System, state: &State) {
        if self.left.is_some() {
            return;
        }
        let out = self.beams.iter().find(|beam| {
            let now = frames(system, state, (beam.number, beam.length));
            now.iter().zip(&beam.start).any(|(now, start)| {
                let risen = (now.position - start.position)[2] / beam.length;
                let turned = (0..3).map(|k| (now.rotation[2][k].abs() - start.rotation[2][k].abs()).abs());
                risen.abs() > OUT || turned.fold(0.0, f64::max) > OUT
            })
        });
        self.left = out.map(|beam| (beam.name.clone(), state.t));
    }

    /// What is said of a run that leaves the plane.
    pub(super) fn warning(&self) -> Option<String> {
        let (name, time) = self.left.as_ref()?;
        Some(format!(
            "the beam `{name}` leaves the plane of x and y (at t = {time:.6} s), in which alone its section is known: torsion and bending across have \
             the stiffness EI, which nobody gave; give a section that says them: `rectangle`, `circle`, `tube`, `ellipse` or `general`"
        ))
    }
}

/// The frames of a beam at its places.
fn frames(system: &mut dyn System, state: &State, (number, length): (usize, f64)) -> [Frame; 3] {
    let mut out = [Frame { position: Vec3::ZERO, rotation: Mat3::IDENTITY }; 3];
    system.frames(number, state, &PLACES.map(|part| part * length), &mut out);
    out
}
