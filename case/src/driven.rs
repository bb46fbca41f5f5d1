//! What laws of a program drive: the signals of laws in motors and loads.

use crate::fault::{Fault, Made};
use crate::kinds::joint::Joint;
use crate::kinds::load::Load;
use crate::kinds::name::numbered;
use crate::laws::Signals;
use flexion::command::{Added, Signal};
use flexion::drive::Actuator;
use flexion::hub_beam::{self, Hub};
use flexion::multibody::{Drive, Kind};
use flexion::profile::Profile;
use flexion_results::nearest;
use std::sync::Arc;

/// The torque on the free hub of a beam.
const HUB: &str = "hub.torque";

/// Makes laws the amplitudes of the last loads, which are theirs.
pub(crate) fn on_loads(signals: &Signals, loads: &mut [Load]) {
    for (load, signal) in loads.iter_mut().rev().zip(signals.loads().rev()) {
        load.amplitude = Some(Arc::clone(signal) as Arc<dyn Profile>);
    }
}

/// Adds laws to the torque on a hub.
pub(crate) fn on_hub(signals: &Signals, hub: &mut Hub) -> Made<()> {
    for (name, signal) in signals.torques() {
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
pub(crate) fn on_joints(signals: &Signals, joints: &mut [Joint]) -> Made<()> {
    for (name, signal) in signals.torques() {
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
                let message = format!("the law `{name}` has nothing to drive: the joint moves as prescribed");
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
