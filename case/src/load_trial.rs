//! Checks what acts on the beam across its keys, and builds its profiles on trial.

use super::integrator::Integrator;
use super::load_build;
use super::loads::{Amplitude, Distribution, Loads};
use super::problem::{Problem, Problems};
use super::values::{Values, item, join};

/// Stations outside the beam, lists of wrong length, profiles that cannot be built, and combinations without sense.
pub(super) fn loads(
    loads: &Loads,
    (length, duration): (Option<f64>, Option<f64>),
    integrator: Option<&Integrator>,
    values: &Values,
    problems: &mut Problems,
) {
    for list in ["mass", "force", "couple", "distributed-load"] {
        for (number, v) in values.tables(list).iter().enumerate() {
            let path = item(list, number);
            let mut refuse = |key: &str, message: String| {
                problems.push(Problem::new(join(&path, key), v.place(key), message));
            };
            for key in ["station", "from", "to"] {
                if let (Some(station), Some(length)) = (v.number(key), length)
                    && station > length
                {
                    refuse(
                        key,
                        format!("the station {station} m lies beyond the end of the beam at {length} m"),
                    );
                }
            }
            if let (Some(from), Some(to)) = (v.number("from"), v.number("to").or(length))
                && from >= to
            {
                refuse("from", format!("the load begins at {from} m and ends at {to} m: it has no length"));
            }
            if let Some(components) = v.numbers("force").filter(|c| c.len() != 2) {
                let message = format!("a force in the plane has 2 components, not {}", components.len());
                refuse("force", message);
            }
            for (key, places) in [("amplitude", "times"), ("distribution", "stations")] {
                let Some((_, table)) = v.kind(key) else { continue };
                if let (Some(places), Some(factors)) = (table.numbers(places), table.numbers("factors"))
                    && places.len() != factors.len()
                {
                    let message = format!("there are {} factors for {} rows", factors.len(), places.len());
                    let path = join(&join(&path, key), "factors");
                    problems.push(Problem::new(path, table.place("factors"), message));
                }
            }
        }
    }
    // One after the other, as long as each was read whole.
    let amplitudes = [
        ("force", loads.forces.iter().map(|l| &l.amplitude).collect::<Vec<_>>()),
        ("couple", loads.couples.iter().map(|l| &l.amplitude).collect()),
        ("distributed-load", loads.distributed.iter().map(|l| &l.amplitude).collect()),
    ];
    for (list, amplitudes) in amplitudes {
        let tables = values.tables(list);
        for (number, (amplitude, v)) in amplitudes.iter().zip(tables).enumerate() {
            let Some(Err(error)) = duration.map(|t| load_build::amplitude(amplitude, t)) else { continue };
            let key = match amplitude {
                Amplitude::Expression(_) => "formula",
                Amplitude::Table(_) => "times",
                _ => "time",
            };
            report(v, (list, number), ("amplitude", key), error.to_string(), problems);
        }
    }
    for (number, (load, v)) in loads.distributed.iter().zip(values.tables("distributed-load")).enumerate() {
        let Some(Err(error)) = length.map(|x| load_build::distribution(&load.distribution, x)) else {
            continue;
        };
        let key = if matches!(load.distribution, Distribution::Table(_)) { "stations" } else { "formula" };
        report(v, ("distributed-load", number), ("distribution", key), error.to_string(), problems);
    }
    let explicit = matches!(integrator, Some(Integrator::RungeKutta4 { .. } | Integrator::Adams4 { .. }));
    if explicit && loads.damping.stiffness > 0.0 {
        let message = "damping in proportion to the stiffness overdamps the shortest waves, and no explicit method \
                       follows them: use an implicit one, `radau` or `generalized-alpha`";
        let place = values.table("damping").and_then(|v| v.place("stiffness-proportional"));
        problems.push(Problem::new("damping.stiffness-proportional", place, message));
    }
}

fn report(
    v: &Values,
    (list, number): (&str, usize),
    (kind, key): (&str, &str),
    message: String,
    problems: &mut Problems,
) {
    let place = v.kind(kind).and_then(|(_, table)| table.place(key));
    let path = join(&join(&item(list, number), kind), key);
    problems.push(Problem::new(path, place, message));
}
