//! `flexion advise`: the cheapest coupling, basis and integrator that hold a tolerance.

use crate::run::Progress;
use crate::{Outcome, case, screen};
use flexion_case::{Advice, AdviseError, RefineError, Target, Tried, Trusted, Untried};
use flexion_results::{Artifact, Directory, OutputError};
use std::path::{Path, PathBuf};

/// Most rows that are printed; all are in the files.
const PRINTED: usize = 12;

/// The case, and what is asked of it.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  flexion advise case.toml --tolerance 1e-3
  flexion advise case.toml --tolerance \"0.1 mm\" --quantity tip.deflection.min

First the case is run with the highest coupling whose data it gives, refined to a fifth of the tolerance: that is the trusted answer.
Then couplings from `zeroth` to that one, bases of growing size and integrators of shrinking steps are tried on the case, and held
against it; couplings that are not tried are listed with the key that is missing or refused. The cheapest run that holds is named, by evaluations of the residual times unknowns, with what to pass to `flexion run`. The ladder takes 3e8 steps times unknowns
at most, two minutes or so; the same case has the same advice everywhere.

Exit codes: 0 finished, 1 case or command line rejected, 2 stopped, nothing holds the tolerance, or there is no trusted
answer.")]
pub struct Arguments {
    #[command(flatten)]
    case: case::Selection,
    /// Largest error: a part of the largest value, \"1e-4\", or with a unit, \"0.1 mm\"
    #[arg(long, value_name = "ERROR")]
    tolerance: String,
    /// What the tolerance is for: a column, or its min, max or final value, e.g. tip.deflection.min [default: all
    /// principal columns]
    #[arg(long, value_name = "COLUMN")]
    quantity: Option<String>,
    /// Directory for advice.json and advice.csv [default: results/NAME-advice]
    #[arg(long, short, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Replace former results in that directory
    #[arg(long)]
    force: bool,
}

/// Looks for the cheapest run that holds, and writes what was tried.
pub fn advise(arguments: &Arguments) -> Outcome {
    let Some(reading) = arguments.case.read() else { return Outcome::Rejected };
    let named = format!("{}-advice", arguments.case.name());
    let output = arguments.output.clone().unwrap_or_else(|| Path::new("results").join(named));
    let directory = match Directory::create_for(Artifact::ADVICE, &output, arguments.force, &reading.inputs())
    {
        Ok(directory) => directory,
        Err(error) => {
            screen::report(&format!("error: {error}\n"));
            return Outcome::Rejected;
        }
    };
    let target = Target::new(arguments.tolerance.clone(), arguments.quantity.clone());
    let mut progress = Progress::new(reading.case.duration);
    let advice = reading.advise(&target, &mut |state| progress.show(state.t));
    progress.finish();
    let advice = match advice {
        Ok(advice) => advice,
        Err(error) => {
            directory.discard();
            return match error {
                AdviseError::Refine(RefineError::Case(problems)) => {
                    screen::report(&problems.render(screen::colour()));
                    Outcome::Rejected
                }
                AdviseError::Refine(other) => {
                    screen::report(&format!("error: {other}\n"));
                    Outcome::Rejected
                }
                AdviseError::NoAnswer(why) => {
                    screen::report(&format!("error: there is no trusted answer: {why}\n"));
                    Outcome::Incomplete
                }
            };
        }
    };
    screen::print(&described(&advice));
    let written = write(&directory, &reading.resolved(), &advice);
    let files = [("advice", Artifact::AdviceJson), ("all runs", Artifact::AdviceCsv)];
    if !screen::files(&directory, written, &files) {
        return Outcome::Incomplete;
    }
    if advice.bounded {
        screen::report("warning: the ladder ended early, for the work it takes; a cheaper run may hold\n");
    }
    if advice.stopped {
        screen::report("error: stopped by the user: runs that were not tried may hold, and be cheaper\n");
        return Outcome::Incomplete;
    }
    if advice.cheapest.is_some() {
        return Outcome::Finished;
    }
    screen::report(
        "error: nothing on the ladder holds the tolerance: `flexion run --tolerance` with the trusted coupling refines further\n",
    );
    Outcome::Incomplete
}

/// Difference over what is asked, or why there is none.
fn difference(tried: &Tried) -> String {
    match &tried.difference {
        Ok(difference) => format!("{difference:.2}"),
        Err(why) => why.clone(),
    }
}

/// Changes of a case as they are passed on.
fn set(changes: &[String]) -> String {
    changes.iter().map(|change| format!("--set \"{change}\"")).collect::<Vec<_>>().join(" ")
}

fn described(advice: &Advice) -> String {
    let mut out = String::from("asked:\n");
    let asked =
        advice.asked.iter().map(|(name, bound, unit)| vec![name.clone(), format!("± {bound:.3e} {unit}")]);
    out += &screen::table(&asked.collect::<Vec<_>>());
    let Trusted { coupling, changes, error } = &advice.trusted;
    out += &format!(
        "\nThe trusted answer is that of the coupling {coupling}, whose error is {error:.2} of what is asked:\n  {}\n\n",
        set(changes)
    );
    if !advice.untried.is_empty() {
        out += "Not tried:\n";
        let why = |of: &Untried| vec![of.coupling.to_owned(), of.key.clone(), of.why.clone()];
        out += &screen::table(&advice.untried.iter().map(why).collect::<Vec<_>>());
        out.push('\n');
    }
    let mut those: Vec<&Tried> = advice.tried.iter().filter(|tried| tried.difference.is_ok()).collect();
    those.sort_by(|a, b| b.holds().cmp(&a.holds()).then(a.work.total_cmp(&b.work)));
    let mut rows = vec![
        ["coupling", "basis", "integrator", "work", "difference over asked"].map(str::to_owned).to_vec(),
    ];
    for tried in those.into_iter().take(PRINTED) {
        rows.push(vec![
            tried.coupling.to_owned(),
            tried.basis.clone(),
            tried.integrator.clone(),
            format!("{:.2e}", tried.work),
            difference(tried),
        ]);
    }
    out += &screen::table(&rows);
    out += "\nA difference is that from the trusted answer, with the error of that added: of another coupling it is that of the models too.\n";
    if let Some(tried) = advice.cheapest.and_then(|index| advice.tried.get(index)) {
        let (count, set) = (advice.tried.len(), set(&tried.changes));
        out += &format!("\nThe cheapest of {count} runs that holds:\n  {set}\n");
    }
    out.push('\n');
    out
}

fn write(directory: &Directory, case: &str, advice: &Advice) -> Result<(), OutputError> {
    directory
        .write(Artifact::ResolvedCase, |f| f.write_all(flexion_results::resolved_case(case).as_bytes()))?;
    directory.write(Artifact::AdviceCsv, |f| {
        writeln!(f, "coupling,basis,integrator,work,difference-over-asked,holds")?;
        for tried in &advice.tried {
            let difference = tried.difference.as_ref().map_or(f64::NAN, |difference| *difference);
            let quoted = [&tried.basis, &tried.integrator].map(|text| format!("\"{text}\""));
            writeln!(
                f,
                "{},{},{:e},{difference:e},{}",
                tried.coupling,
                quoted.join(","),
                tried.work,
                u8::from(tried.holds())
            )?;
        }
        Ok(())
    })?;
    directory.write(Artifact::AdviceJson, |f| writeln!(f, "{:#}", advice.to_json()))?;
    directory.publish()
}
