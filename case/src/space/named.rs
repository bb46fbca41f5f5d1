//! The places that the parts of a case name, at which elements end.

use crate::kinds::joint::Joint;
use crate::kinds::load::{Acts, Load};
use crate::kinds::mass::Mass;
use crate::kinds::spring::{Joins, Spring};
use crate::places::Place;

/// What places the parts of a case name.
#[derive(Default)]
pub(super) struct Named(Vec<Place>);

impl Named {
    /// Of joints, springs, loads, masses and points that touch.
    pub(super) fn of(
        joints: &[Joint],
        springs: &[Spring],
        loads: &[Load],
        masses: &[Mass],
        touching: Vec<Place>,
    ) -> Named {
        let mut all = touching;
        all.extend(joints.iter().flat_map(|joint| joint.between));
        for spring in springs {
            match spring.joins {
                Joins::Line { between, .. } => all.extend(between),
                Joins::Point { on: (beam, s), .. } => all.push(Place::Station { beam, s }),
            }
        }
        all.extend(masses.iter().map(|mass| Place::Station { beam: mass.beam, s: mass.station }));
        for load in loads {
            match load.acts {
                Acts::At { on, .. } => all.push(on),
                Acts::Along { beam, range, .. } | Acts::By { beam, range, .. } => {
                    all.extend([range.0, range.1].map(|s| Place::Station { beam, s }));
                }
            }
        }
        Named(all)
    }

    /// The stations on a beam \[m\].
    pub(super) fn on(&self, number: usize) -> Vec<f64> {
        let station = |place: &Place| match *place {
            Place::Station { beam, s } if beam == number => Some(s),
            _ => None,
        };
        self.0.iter().filter_map(station).collect()
    }
}
