//! What a case contains and a command does not use.

use super::case::Case;

impl Case {
    /// Cautions of a run.
    pub fn unused_by_run(&self) -> Vec<String> {
        let mut cautions = self.cautions.clone();
        let Some(beam) = self.hub_beam() else { return cautions };
        if beam.blade.is_some() {
            cautions.push(
                "[blade] is for `modes` and `campbell`: a run is of the beam in the plane of rotation, without its pitch, \
                 precone, twist and tip mass"
                    .to_owned(),
            );
        } else if beam.section.is_blade {
            cautions.push(
                "a run is of the beam in the plane of rotation: the section's stiffness out of it is used through its twist \
                 alone"
                    .to_owned(),
            );
        }
        cautions
    }

    /// Cautions of modes and diagrams.
    pub fn unused_by_modes(&self) -> Vec<String> {
        let mut cautions = self.cautions.clone();
        let Some(beam) = self.hub_beam() else { return cautions };
        if beam.blade.is_none() {
            if beam.section.is_blade {
                cautions.push(
                    "the section is one of a blade and the case has no [blade]: half of its modes are missing, those out of \
                     the plane of rotation and of torsion; write [blade] for all of them"
                        .to_owned(),
                );
            }
            return cautions;
        }
        if beam.loads.iter().any(|load| load.fixed_in_space == Some("gravity")) {
            cautions.push(
                "without `gravity`: the blade is about its steady rotation alone, and undeformed at rest"
                    .to_owned(),
            );
        }
        cautions
    }
}
