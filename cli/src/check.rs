//! `flexion check`: validates a case and shows what would be run.

use crate::run::Progress;
use crate::screen::row;
use crate::{Outcome, assembly, case, screen};
use flexion::basis::Basis;
use flexion::hub_beam::Drive;
use flexion::integrator::{Adams, Integrator, RungeKutta, StabilityLimit, StepError};
use flexion::linalg::Structure;
use flexion::system::{State, System};
use flexion_case::{HubBeam, Live, Problems, Reading, Subject};
use std::path::PathBuf;

/// The case to check.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  flexion check verification/p1_spin_up_4\n  flexion check case.toml --set basis.elements=40\n  flexion check arm.toml --draw arm.svg\n  flexion check verification/p1_spin_up_4 --set model.coupling=space --long > long.toml"
)]
pub struct Arguments {
    #[command(flatten)]
    case: case::Selection,
    /// Draw a system in space in three views with the names of its parts, .svg or .png
    #[arg(long, value_name = "FILE")]
    draw: Option<PathBuf>,
    /// Print nothing but the case in the long spelling of a system in space, which gives the same bytes
    #[arg(long, conflicts_with = "draw")]
    long: bool,
}

/// Validates a case and describes it.
pub fn check(arguments: &Arguments) -> Outcome {
    let Some(reading) = arguments.case.read() else { return Outcome::Rejected };
    let text = if arguments.long { reading.long() } else { describe(&reading) };
    match text {
        Ok(text) => {
            screen::print(&text);
            match arguments.draw.as_ref().map_or(Ok(()), |file| assembly::draw(&reading, file)) {
                Ok(()) => Outcome::Finished,
                Err(message) => {
                    screen::report(&format!("error: {message}\n"));
                    Outcome::Rejected
                }
            }
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
    let incomplete = reading.missing_for_run().err();
    if incomplete.is_none() {
        // What only the start shows: contacts that begin inside obstacles, an equilibrium that is not found.
        let mut progress = Progress::new(case.duration);
        let prepared = reading.prepare_watched(&mut |factor| progress.show_search(factor));
        progress.finish();
        prepared?;
    }
    let mut out = String::new();
    if !case.title.is_empty() {
        out.push_str(&format!("{}\n", case.title));
    }
    let mut rows = Vec::new();
    match &case.subject {
        Subject::HubBeam(of) => {
            rows.extend(beam(of, case.duration));
            rows.extend(equations(system.as_mut(), integrator.as_ref()));
            rows.extend(conditioning(of));
            let ends = if case.duration > 0.0 { vec![0.0, case.duration] } else { vec![0.0] };
            for t in ends {
                rows.extend(stability(system.as_mut(), t));
            }
        }
        Subject::Space(space) => {
            out.push_str(&assembly::tree(space));
            out.push('\n');
            rows.extend(assembly::described(space));
            rows.extend(equations(system.as_mut(), integrator.as_ref()));
        }
    }
    if let Some(missing) = &incomplete {
        rows.push(row("run", missing.without_run()));
    }
    let of_run = if incomplete.is_none() { case.unused_by_run() } else { case.cautions.clone() };
    let cautions = of_run.into_iter().chain(system.cautions(&[]));
    rows.extend(cautions.map(|caution| row("caution", caution)));
    out.push_str(&screen::table(&rows));
    // An empty list says nothing.
    let defaults: Vec<_> = reading.defaults().into_iter().filter(|(_, value)| value != "[]").collect();
    if !defaults.is_empty() {
        out.push_str("\ndefaults in force\n");
        let rows: Vec<Vec<String>> = defaults.into_iter().map(|(key, value)| vec![key, value]).collect();
        out.push_str(&screen::table(&rows));
    }
    out.push_str(&format!("\n{} is valid\n", reading.file.display()));
    Ok(out)
}

/// Resultants at the root and the largest speed.
fn beam(of: &HubBeam, duration: f64) -> Vec<Vec<String>> {
    let mut rows = vec![row("length", format!("{} m", of.length))];
    let r = of.section.planar.resultants(0.0);
    rows.push(row("mass per length ρA", format!("{:.6} kg/m", r.mass)));
    rows.push(row("axial stiffness EA", format!("{:.6e} N", r.axial_stiffness)));
    if r.coupling_stiffness != 0.0 {
        rows.push(row("coupling stiffness ES", format!("{:.6e} N·m", r.coupling_stiffness)));
    }
    rows.push(row("bending stiffness EI", format!("{:.6e} N·m²", r.bending_stiffness)));
    if r.rotary_inertia != 0.0 {
        rows.push(row("rotary inertia ρI", format!("{:.6e} kg·m", r.rotary_inertia)));
    }
    if let Drive::Prescribed(motion) = &of.hub.drive {
        rows.push(row("largest hub speed", format!("{:.6} rad/s", motion.max_speed(duration))));
    }
    rows
}

/// Sizes and structure.
fn equations(system: &mut dyn System, integrator: &dyn Integrator) -> Vec<Vec<String>> {
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
fn conditioning(of: &HubBeam) -> Vec<Vec<String>> {
    if of.coupling.whole_curve {
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
    [("axial", &of.bases.axial), ("transverse", &of.bases.transverse)].map(row_of).to_vec()
}

/// Largest stable steps of the explicit integrators about the undeformed beam at time `t`.
fn stability(system: &mut dyn System, t: f64) -> Vec<Vec<String>> {
    let mut state = State::zeros(system.size(), t);
    let (runge_kutta, adams) = (RungeKutta::new(), Adams::new());
    let limit = |found: Result<StabilityLimit, StepError>| {
        let at = format!("t = {t} s");
        match found {
            Ok(limit) if limit.step.is_finite() => {
                let text =
                    format!("{:.4e} s at {at} (largest frequency {:.4e} rad/s)", limit.step, limit.frequency);
                row(&format!("stable step, {}", limit.method), text)
            }
            Err(error) => row("stable step", format!("none at {at}: {error}")),
            Ok(_) => row(
                "stable step",
                format!(
                    "unknown at {at}: no frequency above zero, the centrifugal force outgrows the stiffness"
                ),
            ),
        }
    };
    let first = limit(runge_kutta.stability_limit(system, &mut state));
    let second = limit(adams.stability_limit(system, &mut state));
    vec![first, second]
}
