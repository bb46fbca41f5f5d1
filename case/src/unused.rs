//! What a case contains and a command does not use.

use super::case::Case;
use super::fault::{Fault, Faults, Made};
use super::space::Space;
use super::values::item;
use flexion::linalg::Vec3;

/// Difference of velocities that count as those of one rotation, over their size.
const SAME: f64 = 1e-6;

impl Case {
    /// Cautions of a run.
    pub fn unused_by_run(&self) -> Vec<String> {
        let mut cautions = self.cautions.clone();
        cautions.extend(self.space().filter(|space| !space.flat).into_iter().flat_map(Space::torsion));
        cautions.extend(self.space().into_iter().flat_map(|space| space.spinning(self.duration)));
        cautions.extend(self.rotates_at().into_iter().flat_map(|speed| self.without_trapeze(speed)));
        let Some(beam) = self.hub_beam() else { return cautions };
        if beam.section.is_blade {
            cautions.push(
                "the beam moves in the plane of rotation: the section's stiffness out of it is used through its twist alone; \
                 `model.coupling = \"space\"` uses all of it"
                    .to_owned(),
            );
        }
        cautions
    }

    /// Cautions of modes and diagrams.
    pub fn unused_by_modes(&self) -> Vec<String> {
        let mut cautions = self.cautions.clone();
        cautions.extend(self.space().into_iter().flat_map(Space::torsion));
        cautions.extend(self.space().into_iter().flat_map(|space| space.spinning(self.duration)));
        let Some(beam) = self.hub_beam() else { return cautions };
        if beam.section.is_blade {
            cautions.push(
                "the section is one of a blade and the model one in the plane: half of its modes are missing, those out of the \
                 plane of rotation and of torsion; write `model.coupling = \"space\"` for all of them"
                    .to_owned(),
            );
        }
        cautions
    }

    /// Cautions for beams with shear whose torsion the tension of a rotation [rad/s] would stiffen.
    pub fn without_trapeze(&self, speed: f64) -> Vec<String> {
        self.space().map_or_else(Vec::new, |space| space.without_trapeze(speed))
    }

    /// The speed [rad/s] of the rotation about the axis of the case that its bodies and beams have at the start, where they have one.
    pub fn rotates_at(&self) -> Option<f64> {
        self.space().and_then(|space| space.rotates_at().ok().flatten())
    }
}

/// What is given of the motion of a part at the start: its table, its place, and its velocity and spin.
type Given = (String, Vec3, [Option<Vec3>; 2]);

impl Space {
    /// Cautions for beams whose torsion is wrong in rotation.
    fn torsion(&self) -> impl Iterator<Item = String> {
        let wrong = self.beams.iter().filter(|(beam, _)| self.rotation.is_ok() && beam.leaves_out_torsion());
        wrong.map(|(beam, _)| {
            format!(
                "in rotation the torsion of `{}` is wrong without its rotary inertia, which differs in both planes of bending: write \
                 `rotary-inertia = true` in its section",
                beam.name
            )
        })
    }

    fn given(&self) -> Vec<Given> {
        let bodies = self.bodies.iter().enumerate();
        let bodies = bodies.map(|(i, b)| (item("body", i), b.frame.position, [b.velocity, b.spin]));
        let beams = self.beams.iter().enumerate();
        let root = |(i, (beam, built)): (usize, &(_, flexion::multibody::Beam))| {
            let beam: &super::kinds::beam::Beam = beam;
            (item("beam", i), built.node(0, built.initial()).position, beam.motion)
        };
        bodies.chain(beams.map(root)).collect()
    }

    /// The speed of the rotation that the parts have at the start about the axis of the case, or where they have none.
    ///
    /// # Errors
    /// The key of a velocity that is not that of a rotation of the whole system about the axis.
    pub(super) fn rotates_at(&self) -> Made<Option<f64>> {
        let mut speed: Option<f64> = None;
        for (table, place, motion) in self.given() {
            for (key, given) in ["velocity", "spin"].into_iter().zip(motion) {
                let Some(given) = given.filter(|x| x.norm() > 0.0) else { continue };
                let about = self.rotation.as_ref().ok().map(|rotation| rotation.axis);
                // Of the unit speed.
                let unit = about.map(|axis| match key {
                    "spin" => axis.direction,
                    _ => axis.direction.cross(place - axis.point),
                });
                let own = unit.filter(|unit| unit.norm() > 0.0).map(|unit| {
                    let own = given.dot(unit) / unit.dot(unit);
                    (own, (given - own * unit).norm())
                });
                let same =
                    |own: f64| speed.is_none_or(|speed: f64| (own - speed).abs() <= SAME * speed.abs());
                match own {
                    Some((own, off)) if off <= SAME * given.norm() && same(own) => speed = Some(own),
                    _ => {
                        let message = "modes are those about rest or about a steady rotation of the whole system, and this motion is none";
                        let help = "leave it out (`--set` changes a case for one command); a system that rotates as a whole has its axis in \
                                    `[rotation]` and its speed from `--speed`";
                        return Err(Faults::from(Fault::new(key, message).help(help)).within(&table));
                    }
                }
            }
        }
        Ok(speed)
    }

    /// Whether the motion at the start is one about which there are modes.
    ///
    /// # Errors
    /// The key of the motion of a part or a joint.
    pub(super) fn moves_steadily(&self) -> Made<()> {
        self.rotates_at()?;
        let keeps = self.rotation.as_ref().ok().and_then(|rotation| rotation.keeps.as_deref());
        let moving = self.multibody.model().moving();
        let inside = |name: &str| moving.contains(&name) && Some(name) != keeps;
        match self.joints.iter().position(|link| inside(&link.name)) {
            Some(i) => {
                let message = format!(
                    "`{}` has a speed at the start: modes are those about rest or about a steady rotation of the whole system",
                    self.joints[i].name
                );
                let help = "a part that rotates against another has modes that change with its angle: analyse it in time by `flexion run`, \
                            or leave the motion out for modes at rest";
                Err(Faults::from(Fault::new("motion", message).help(help)).within(&item("joint", i)))
            }
            None => Ok(()),
        }
    }
}
