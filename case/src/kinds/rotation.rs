//! The axis about which a system in space rotates steadily: in `modes` and `campbell`, and at the start of a run.

use crate::fault::{Fault, Made};
use crate::keys::{keys, text, vector};
use crate::kind::{Of, Table};
use crate::run::cautions;
use crate::units::{FACTOR, LENGTH};
use flexion::analysis::periodic::{NoPeriodicMotion, circulate};
use flexion::analysis::rotation::rotate_stably;
use flexion::linalg::Vec3;
use flexion::multibody::{Axis, Model, Multibody, Rotating};
use flexion::system::{Dynamics, Fork, Parameter, State, Steady};
use flexion_results::nearest;
use std::f64::consts::TAU;

/// Differences of velocities, over the largest, that are rounding.
const SAME: f64 = 1e-9;

/// What a case says of the axis.
#[derive(Clone, Debug, PartialEq)]
pub enum About {
    /// That of the joint of this name.
    Joint(String),
    /// A line.
    Line(Axis),
}

keys! {
    /// What a case says of the axis.
    struct Written {
        /// name of a revolute or cylindrical joint with the ground: the system rotates about its axis
        about: Option<String> = text();
        /// direction of the axis, in the place of a joint
        axis: Option<Vec3> = vector(&FACTOR);
        /// a point of the axis, the origin if left out
        point: Option<Vec3> = vector(&LENGTH);
    }
}

/// The table `[rotation]`.
pub static ROTATION: Table<About> = Table::one(
    "rotation",
    "axis about which `modes` and `campbell` rotate the system, and the ground with it; that of the joint with the ground if left out",
    "rotation={axis=[0, 0.1, 1], point=[0, 0, '5 cm']}",
    &Of(|Written { about, axis, point }, _| match (about, axis) {
        (Some(_), Some(_)) => {
            let help = "leave `axis` and `point` out, or `about`";
            Err(Fault::new("axis", "`about` already says the axis: that of the joint").help(help).into())
        }
        (Some(_), None) if point.is_some() => {
            Err(Fault::new("point", "belongs to `axis`, and the axis is that of a joint").into())
        }
        (Some(name), None) => Ok(About::Joint(name)),
        (None, Some(axis)) => {
            let message = "has no direction: one of its components must not be zero";
            let axis = Axis::new(point.unwrap_or_default(), axis).ok_or_else(|| Fault::new("axis", message));
            Ok(About::Line(axis?))
        }
        (None, None) => {
            let help = "write `axis = [0, 0, 1]`, or `about` with the name of a joint";
            Err(Fault::new("", "says no axis").help(help).into())
        }
    }),
);

/// A steady rotation of a system in space.
#[derive(Clone, Debug, PartialEq)]
pub struct Rotation {
    /// The axis.
    pub axis: Axis,
    /// The joint with the ground that keeps its angle meanwhile, until the rigid motions are let go.
    pub keeps: Option<String>,
}

impl Rotation {
    /// The rotation of which a case says this.
    pub(crate) fn given(about: &About, model: &Model) -> Made<Rotation> {
        let axis = match about {
            About::Line(axis) => *axis,
            About::Joint(name) => {
                let hinges = model.hinges();
                let Some(axis) = model.axis_of(name) else {
                    let near = nearest(name, hinges.iter().copied());
                    let near = near.map_or(String::new(), |near| format!(": did you mean `{near}`?"));
                    let message = format!("there is no revolute or cylindrical joint `{name}`{near}");
                    let help = "any other axis is given by `axis` and `point`";
                    return Err(Fault::new("about", message).help(help).into());
                };
                if !hinges.contains(&name.as_str()) {
                    let message = format!(
                        "`{name}` is not a joint with the ground: modes and diagrams are of systems that rotate as a whole, and both \
                         parts of this joint would"
                    );
                    let help = "a rotor on a support that stands still is analysed in time, by `flexion run` with a `motion` of the \
                                joint; if all parts and the ground rotate, give the axis by `axis` and `point`";
                    return Err(Fault::new("about", message).help(help).into());
                }
                axis
            }
        };
        let rotation = Rotation { axis, keeps: model.hinge_about(&axis).map(str::to_owned) };
        rotation.of(model, true).map_err(|why| Fault::new("", why))?;
        Ok(rotation)
    }

    /// The rotation about the only axis that the joints with the ground leave, or why there is none.
    pub(crate) fn found(model: &Model) -> Result<Rotation, String> {
        let hinges = model.hinges();
        let Some(axis) = hinges.first().and_then(|name| model.axis_of(name)) else {
            return Err("the case has no axis of rotation, for no revolute or cylindrical joint is with the ground: write \
                        `rotation = { axis = [0, 0, 1] }` if all parts and the ground rotate as a whole"
                .to_owned());
        };
        match (model.against(&axis).first(), model.hinge_about(&axis)) {
            (None, Some(keeps)) => Ok(Rotation { axis, keeps: Some(keeps.to_owned()) }),
            (against, _) => Err(format!(
                "the case has no axis of rotation: `{}` is with the ground and does not rotate about that of `{}`; write \
                 `rotation = {{ about = \"{}\" }}` if the ground rotates with the system, or its `axis` and `point`",
                against.copied().unwrap_or_default(),
                hinges[0],
                hinges[0]
            )),
        }
    }

    /// A model that rotates, and what of its loads is left out; at rest it keeps its loads and the joints that nothing moves.
    fn of(&self, model: &Model, rotates: bool) -> Result<(Rotating, Vec<String>), String> {
        let mut model = model.clone();
        let left_out = if rotates { model.keep_along(&self.axis) } else { Vec::new() };
        if let Some(joint) = self.keeps.as_ref().filter(|joint| rotates || model.prescribes(joint)) {
            model.keep_angle(joint);
        }
        let multibody = Multibody::new(model).map_err(|error| error.to_string())?;
        Ok((Rotating::new(multibody, self.axis), left_out))
    }

    /// The state of a model in steady rotation at the speed with which the state `s` rotates, under loads of a fixed direction in their
    /// periodic motion, and what is to be said of these.
    ///
    /// # Errors
    /// Why there is none: its parts move otherwise, an equilibrium that is lost on the way to the speed.
    pub(crate) fn turning(&self, model: &Model, s: &State) -> Result<(State, Option<String>), String> {
        let (mean, left_out) = self.of(model, true)?;
        let mut mean = mean.at_an_instant();
        let mut at = mean.initial();
        // The velocities are Ω times those at 1 rad/s.
        mean.set(Parameter::Speed, 1.0).map_err(|error| error.to_string())?;
        let unit = mean.in_space(&at).v;
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let speed = dot(&s.v, &unit) / dot(&unit, &unit);
        let largest = s.v.iter().fold(0.0_f64, |largest, v| largest.max(v.abs()));
        if s.v.iter().zip(&unit).any(|(v, unit)| !((v - speed * unit).abs() <= SAME * largest)) {
            return Err(format!(
                "the parts do not begin as one that rotates about {}: give them the velocities of such a rotation, or leave out \
                 `velocity` and `spin`",
                self.described(false)
            ));
        }
        let mut loaded = self.loaded(model)?;
        let unsteady = if left_out.is_empty() { loaded.unsteady() } else { Some(left_out.join(" and ")) };
        let turned = rotate_stably(&mut mean, &mut at, 0.0, speed).map_err(|error| error.to_string());
        let Some(what) = unsteady.filter(|_| speed != 0.0) else {
            turned?;
            return Ok((mean.in_space(&at), None));
        };
        let periodic = match turned {
            Ok(_) if model.load_changes(TAU / speed.abs()) => Err(NoPeriodicMotion::Changing),
            Ok(_) => {
                loaded.set(Parameter::Speed, speed).map_err(|error| error.to_string())?;
                circulate([&mut mean, &mut loaded], &mut at, speed)
            }
            Err(_) => Err(NoPeriodicMotion::Far),
        };
        let said = cautions::unsteady(&what, &periodic);
        if periodic.is_err() {
            at = loaded.initial();
            rotate_stably(&mut loaded, &mut at, 0.0, speed).map_err(|error| error.to_string())?;
            return Ok((loaded.in_space(&at), Some(said)));
        }
        Ok((mean.in_space(&at), Some(said)))
    }

    /// A model that rotates with its loads across the axis as they stand at the start.
    fn loaded(&self, model: &Model) -> Result<Rotating, String> {
        let mut model = model.clone();
        if let Some(joint) = &self.keeps {
            model.keep_angle(joint);
        }
        let multibody = Multibody::new(model).map_err(|error| error.to_string())?;
        Ok(Rotating::new(multibody, self.axis).at_an_instant())
    }

    /// As it is said: direction, the point of the axis that is next to the origin, and the joint that keeps its angle, or is free.
    pub fn described(&self, free: bool) -> String {
        let Axis { point, direction: e } = self.axis;
        let along: f64 = point.dot(e);
        let foot: Vec3 = point - along * e;
        let text = |x: Vec3| x.0.map(|x| format!("{:.4}", x + 0.0)).join(", ");
        let how = if free { "is free" } else { "keeps its angle" };
        let keeps =
            self.keeps.as_ref().map_or(", with the ground".to_owned(), |joint| format!(", `{joint}` {how}"));
        format!("the axis ({}) through ({}) m{keeps}", text(e), text(foot))
    }
}

/// What vibrates, and what is left out of it.
pub(crate) fn vibrating(
    model: &Multibody,
    rotation: &Result<Rotation, String>,
    rotates: bool,
) -> Result<(Box<dyn Fork>, Vec<String>), String> {
    match rotation {
        Ok(rotation) => {
            let (system, left_out) = rotation.of(model.model(), rotates)?;
            Ok((Box::new(system), left_out))
        }
        Err(why) if rotates => Err(why.clone()),
        Err(_) => Ok((Box::new(model.clone()), Vec::new())),
    }
}
