//! Laws of a program: torques of motors and factors of loads that its functions give. No file holds them.

use flexion::command::{Command, CommandFault, Input, LawState, Signal, Timing};
use flexion_results::nearest;
use std::sync::Arc;

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
    /// States that are integrated with the motion.
    pub states: Vec<LawState>,
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
            let Law { name, reads, states, timing, .. } = law.clone();
            let command = law.start.start().map_err(|why| format!("the law `{name}` {why}"))?;
            Ok(Input { unit: law.unit(), name, reads, states, timing, command, signal: Arc::clone(signal) })
        };
        self.0.iter().map(input).collect()
    }

    /// What laws give that are amplitudes of loads, in the order of these.
    pub(crate) fn loads(&self) -> impl DoubleEndedIterator<Item = &Arc<Signal>> {
        self.0.iter().filter(|(law, _)| law.load.is_some()).map(|(_, signal)| signal)
    }

    /// What laws give that drive a hub or a joint, with their names.
    pub(crate) fn torques(&self) -> impl Iterator<Item = (&str, &Arc<Signal>)> {
        self.0.iter().filter(|(law, _)| law.load.is_none()).map(|(law, signal)| (law.name.as_str(), signal))
    }
}

/// Why a model takes no law, with the nearest column.
pub(crate) fn said(fault: &CommandFault) -> String {
    let CommandFault::NoColumn { column, columns, .. } = fault else { return fault.to_string() };
    let near = nearest(column, columns.iter().map(String::as_str));
    near.map_or_else(|| fault.to_string(), |near| format!("{fault}; did you mean `{near}`?"))
}
