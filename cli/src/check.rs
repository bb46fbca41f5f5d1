//! `flexion check`: validates a case and shows what would be run.

use crate::{Outcome, case, screen};
use flexion::basis::Basis;
use flexion::hub_beam::Drive;
use flexion::integrator::{Adams, Integrator, RungeKutta, StabilityLimit, StepError};
use flexion::linalg::Structure;
use flexion::system::{State, System};
use flexion_case::kinds::initial::Initial;
use flexion_case::{Case, Live, Problems, Reading};

/// The case to check.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  flexion check verification/p1_spin_up_4\n  flexion check case.toml --set basis.elements=40"
)]
pub struct Arguments {
    #[command(flatten)]
    case: case::Selection,
}

/// Validates a case and describes it.
pub fn check(arguments: &Arguments) -> Outcome {
    let Some(reading) = arguments.case.read() else { return Outcome::Rejected };
    match describe(&reading) {
        Ok(text) => {
            screen::print(&text);
            Outcome::Finished
        }
        Err(problems) => {
            screen::report(&problems.render(screen::colour()));
            Outcome::Rejected
        }
    }
}

fn describe(reading: &Reading) -> Result<String, Problems> {
    let case = &reading.case;
    let Live { mut system, integrator } = reading.build()?;
    if !matches!(case.initial, Initial::Undeformed) {
        reading.prepare()?;
    }
    let mut out = String::new();
    if !case.title.is_empty() {
        out.push_str(&format!("{}\n", case.title));
    }
    let mut rows = beam(case);
    rows.extend(equations(system.as_ref(), integrator.as_ref()));
    rows.extend(conditioning(case));
    for t in [0.0, case.duration] {
        rows.extend(stability(system.as_mut(), t));
    }
    let of_modes =
        case.blade.iter().flat_map(|_| case.unused_by_modes().into_iter().skip(case.cautions.len()));
    let cautions = case.unused_by_run().into_iter().chain(of_modes).chain(system.cautions(&[]));
    rows.extend(cautions.map(|caution| row("caution", caution)));
    out.push_str(&screen::table(&rows));
    let defaults = reading.defaults();
    if !defaults.is_empty() {
        out.push_str("\ndefaults in force\n");
        let rows: Vec<Vec<String>> = defaults.into_iter().map(|(key, value)| vec![key, value]).collect();
        out.push_str(&screen::table(&rows));
    }
    out.push_str(&format!("\n{} is valid\n", reading.file.display()));
    Ok(out)
}

fn row(name: &str, text: String) -> Vec<String> {
    vec![name.to_owned(), text]
}

/// Resultants at the root and the largest speed.
fn beam(case: &Case) -> Vec<Vec<String>> {
    let mut rows = vec![row("length", format!("{} m", case.length))];
    let r = case.section.planar.resultants(0.0);
    rows.push(row("mass per length ρA", format!("{:.6} kg/m", r.mass)));
    rows.push(row("axial stiffness EA", format!("{:.6e} N", r.axial_stiffness)));
    if r.coupling_stiffness != 0.0 {
        rows.push(row("coupling stiffness ES", format!("{:.6e} N·m", r.coupling_stiffness)));
    }
    rows.push(row("bending stiffness EI", format!("{:.6e} N·m²", r.bending_stiffness)));
    if r.rotary_inertia != 0.0 {
        rows.push(row("rotary inertia ρI", format!("{:.6e} kg·m", r.rotary_inertia)));
    }
    if let Drive::Prescribed(motion) = &case.hub.drive {
        rows.push(row("largest hub speed", format!("{:.6} rad/s", motion.max_speed(case.duration))));
    }
    rows
}

/// Sizes and structure.
fn equations(system: &dyn System, integrator: &dyn Integrator) -> Vec<Vec<String>> {
    let structure = system.structure(1);
    let structure = match structure {
        Structure::Dense { order } => format!("dense, order {order}"),
        _ => format!(
            "band, order {}, half-bandwidth {}, border {}",
            structure.order() - structure.border(),
            structure.half_bandwidth(),
            structure.border()
        ),
    };
    let info = integrator.info();
    let kind = if info.implicit { "implicit" } else { "explicit" };
    let steps = if info.estimate_order.is_some() { "step control" } else { "fixed step" };
    vec![
        row("unknowns", system.size().v.to_string()),
        row("tangent", structure),
        row("recorded channels", system.channels().len().to_string()),
        row("integrator", format!("{}, {kind}, order {}, {steps}", info.name, info.order)),
    ]
}

/// Conditioning of the bases; the exact coupling has its own.
fn conditioning(case: &Case) -> Vec<Vec<String>> {
    if case.coupling.whole_curve {
        return Vec::new();
    }
    let row_of = |(name, basis): (&str, &std::sync::Arc<dyn Basis>)| {
        let conditioning = basis.conditioning();
        let text = if conditioning.number > 1.0 {
            format!(
                "{} functions, condition number {:.2e} of {}",
                basis.len(),
                conditioning.number,
                conditioning.of
            )
        } else {
            format!("{} functions, nothing to invert", basis.len())
        };
        row(&format!("{name} basis"), text)
    };
    [("axial", &case.bases.axial), ("transverse", &case.bases.transverse)].map(row_of).to_vec()
}

/// Largest stable steps of the explicit integrators about the undeformed beam at time `t`.
fn stability(system: &mut dyn System, t: f64) -> Vec<Vec<String>> {
    let mut state = State::zeros(system.size(), t);
    let (mut runge_kutta, mut adams) = (RungeKutta::new(), Adams::new());
    let limit = |started: Result<(), StepError>, limit: Option<StabilityLimit>| {
        let at = format!("t = {t} s");
        match (started, limit) {
            (Ok(()), Some(limit)) if limit.step.is_finite() => {
                let text =
                    format!("{:.4e} s at {at} (largest frequency {:.4e} rad/s)", limit.step, limit.frequency);
                row(&format!("stable step, {}", limit.method), text)
            }
            (Err(error), _) => row("stable step", format!("none at {at}: {error}")),
            (Ok(()), _) => row(
                "stable step",
                format!(
                    "unknown at {at}: no frequency above zero, the centrifugal force outgrows the stiffness"
                ),
            ),
        }
    };
    let started = runge_kutta.start(system, &mut state, f64::MIN_POSITIVE);
    let first = limit(started, runge_kutta.stability_limit());
    let started = adams.start(system, &mut state, f64::MIN_POSITIVE);
    let second = limit(started, adams.stability_limit());
    vec![first, second]
}
