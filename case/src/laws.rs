//! Laws of a program: torques of motors and factors of loads that its functions give. No file holds them.

use crate::fault::{Fault, Made};
use crate::kinds::joint::Joint;
use crate::kinds::load::Load;
use crate::kinds::name::numbered;
use flexion::command::{Added, Command, CommandFault, Input, Signal, Timing};
use flexion::drive::Actuator;
use flexion::hub_beam::{self, Hub};
use flexion::multibody::{Drive, Kind};
use flexion::profile::Profile;
use flexion_results::nearest;
use std::sync::Arc;

/// The torque on the free hub of a beam.
const HUB: &str = "hub.torque";

/// Makes a law for every run: a companion has one of its own, with a memory of its own.
pub trait Start: std::fmt::Debug + Send + Sync {
    /// A law that has not been asked yet.
    ///
    /// # Errors
    /// Why there is none.
    fn start(&self) -> Result<Box<dyn Command>, String>;
}

/// A law of a program.
#[derive(Clone, Debug)]
pub struct Law {
    /// Its name. Without a load it is the column of what it drives: `hub.torque` of a free hub, `NAME.torque` or `NAME.thrust` of a joint.
    pub name: String,
    /// The load whose amplitude it is, a table of TOML: `{on = "tip", force = [0, 1]}`.
    pub load: Option<String>,
    /// Columns that it reads: positions, velocities and what follows from them.
    pub reads: Vec<String>,
    /// When it is asked.
    pub timing: Timing,
    /// What makes it.
    pub start: Arc<dyn Start>,
}

impl Law {
    fn unit(&self) -> &'static str {
        match &self.load {
            Some(_) => "",
            None if self.name.ends_with(".thrust") => "N",
            None => "N*m",
        }
    }
}

/// What the laws of a case command, in their order.
#[derive(Clone, Debug, Default)]
pub(crate) struct Signals(Vec<(Law, Arc<Signal>)>);

impl Signals {
    pub(crate) fn new(laws: &[Law]) -> Signals {
        Signals(laws.iter().map(|law| (law.clone(), Arc::default())).collect())
    }

    /// The laws of a run.
    pub(crate) fn inputs(&self) -> Result<Vec<Input>, String> {
        let input = |(law, signal): &(Law, Arc<Signal>)| {
            let (name, reads, timing) = (law.name.clone(), law.reads.clone(), law.timing.clone());
            let command = law.start.start().map_err(|why| format!("the law `{name}` {why}"))?;
            Ok(Input { unit: law.unit(), name, reads, timing, command, signal: Arc::clone(signal) })
        };
        self.0.iter().map(input).collect()
    }

    /// Makes laws the amplitudes of the last loads, which are theirs.
    pub(crate) fn on_loads(&self, loads: &mut [Load]) {
        let of_loads = self.0.iter().filter(|(law, _)| law.load.is_some());
        for (load, (_, signal)) in loads.iter_mut().rev().zip(of_loads.rev()) {
            load.amplitude = Some(Arc::clone(signal) as Arc<dyn Profile>);
        }
    }

    fn torques(&self) -> impl Iterator<Item = (&str, &Arc<Signal>)> {
        self.0.iter().filter(|(law, _)| law.load.is_none()).map(|(law, signal)| (law.name.as_str(), signal))
    }

    /// Adds laws to the torque on a hub.
    pub(crate) fn on_hub(&self, hub: &mut Hub) -> Made<()> {
        for (name, signal) in self.torques() {
            match &mut hub.drive {
                hub_beam::Drive::Free(free) if name == HUB => add(&mut free.actuator, signal),
                hub_beam::Drive::Free(_) => return Err(unknown(name, &[HUB.to_owned()])),
                hub_beam::Drive::Prescribed(_) => {
                    let message = format!(
                        "the law `{name}` has nothing to drive: the hub moves as prescribed; a free one is written \
                         `hub.motion = {{ kind = \"free\" }}`, and a law of a load needs the load"
                    );
                    return Err(Fault::new("", message).into());
                }
            }
        }
        Ok(())
    }

    /// Adds laws to what drives joints.
    pub(crate) fn on_joints(&self, joints: &mut [Joint]) -> Made<()> {
        for (name, signal) in self.torques() {
            let named = |(i, joint): (usize, &Joint)| {
                let effort = match joint.kind {
                    Kind::Revolute | Kind::Cylindrical => "torque",
                    Kind::Prismatic => "thrust",
                    _ => return None,
                };
                Some((i, format!("{}.{effort}", numbered(&joint.name, "joint", i))))
            };
            let all: Vec<(usize, String)> = joints.iter().enumerate().filter_map(named).collect();
            let Some((i, _)) = all.iter().find(|(_, known)| known == name) else {
                let names: Vec<String> = all.into_iter().map(|(_, name)| name).collect();
                return Err(unknown(name, &names));
            };
            match &mut joints[*i].drive {
                Drive::Actuated(actuator) => add(actuator, signal),
                Drive::Prescribed(_) => {
                    let message =
                        format!("the law `{name}` has nothing to drive: the joint moves as prescribed");
                    return Err(Fault::new("", message).into());
                }
                drive @ Drive::None => {
                    let torque = Arc::clone(signal) as Arc<dyn Profile>;
                    let free =
                        Actuator { torque, damping: 0.0, stiffness: 0.0, rest_angle: 0.0, controller: None };
                    *drive = Drive::Actuated(free);
                }
            }
        }
        Ok(())
    }
}

/// Adds a law to the torque of a motor.
fn add(actuator: &mut Actuator, signal: &Arc<Signal>) {
    let to = Arc::clone(&actuator.torque);
    actuator.torque = Arc::new(Added { to, signal: Arc::clone(signal) });
}

fn unknown(name: &str, names: &[String]) -> crate::fault::Faults {
    let near = nearest(name, names.iter().map(String::as_str));
    let there = match (near, names) {
        (Some(near), _) => format!("; did you mean `{near}`?"),
        (None, []) => "; no joint is free to be driven".to_owned(),
        (None, names) => format!("; there is `{}`", names.join("`, `")),
    };
    let message = format!("the law `{name}` names nothing that can be driven, and has no load{there}");
    Fault::new("", message).into()
}

/// Why a model takes no law, with the nearest column.
pub(crate) fn said(fault: &CommandFault) -> String {
    let CommandFault::NoColumn { column, columns, .. } = fault else { return fault.to_string() };
    let near = nearest(column, columns.iter().map(String::as_str));
    near.map_or_else(|| fault.to_string(), |near| format!("{fault}; did you mean `{near}`?"))
}
