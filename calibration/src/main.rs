//! Stated against true errors of cases at random: `cargo run --release -p flexion-calibration -- --cases 100 --seed 2`.

use clap::Parser as _;
use flexion_calibration::families::{self, Answer, crowds, pose};
use flexion_calibration::{Counts, Drawn, Ending, Outcome, draw, figure, judge, study};
use serde_json::{Value, json};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Holds the stated errors of cases at random against their true errors
///
/// Draws legal cases over all kinds, runs each as `flexion run` does, and again far more finely; the true error of the min, max and
/// final value of every column is held against the stated one. The same seed gives the same cases.
#[derive(clap::Parser)]
struct Arguments {
    /// Number of cases
    #[arg(long, value_name = "N", default_value = "100")]
    cases: u64,
    /// Number of the first case
    #[arg(long, value_name = "N", default_value = "0")]
    first: u64,
    /// Seed of the sequence of cases
    #[arg(long, value_name = "N", default_value = "1")]
    seed: u64,
    /// Draw cases whose answer is known, by families, and hold them against it
    #[arg(long)]
    families: bool,
    /// Draw cases of five to fifty contacts whose answer is known, by families, and hold them against it and the laws of contacts
    #[arg(long, conflicts_with = "families")]
    crowds: bool,
    /// Print the case of this number, and the files that it names, and run nothing
    #[arg(long, value_name = "N")]
    show: Option<u64>,
    /// Directory for calibration.json, .csv and the picture, which replace former ones
    #[arg(long, short, value_name = "DIR", default_value = "results/calibration")]
    output: PathBuf,
    /// Number of threads [default: one a processor]
    #[arg(long, value_name = "N", default_value = "0", hide_default_value = true)]
    threads: usize,
}

fn main() -> io::Result<()> {
    let arguments = Arguments::parse();
    if let Some(number) = arguments.show {
        if !arguments.families && !arguments.crowds {
            return show(&draw(arguments.seed, number));
        }
        let posed = if arguments.crowds {
            crowds::pose(arguments.seed, number).posed
        } else {
            pose(arguments.seed, number)
        };
        show(&posed.case)?;
        return match &posed.answer {
            Answer::Other(other, relation) => {
                writeln!(io::stdout(), "# {relation:?}:")?;
                show(other)
            }
            answer => writeln!(io::stdout(), "# {answer:?}"),
        };
    }
    std::fs::create_dir_all(&arguments.output)?;
    let numbers = arguments.first..arguments.first.saturating_add(arguments.cases);
    let outcomes = study(numbers, arguments.threads, &|number| {
        let outcome = if arguments.crowds {
            crowds::judge(&crowds::pose(arguments.seed, number), number)
        } else if arguments.families {
            families::judge(&pose(arguments.seed, number), number)
        } else {
            judge(&draw(arguments.seed, number), number)
        };
        // A study whose progress cannot be shown goes on.
        let _ = progress(&outcome);
        outcome
    });
    let counts = Counts::of(&outcomes);
    for [what, count, asked] in counts.rows() {
        writeln!(io::stdout(), "  {what:<52} {count:<28} {asked}")?;
    }
    write(&arguments, &outcomes, &counts)
}

/// One line for a case, and one for each value that is wrong in silence.
fn progress(outcome: &Outcome) -> io::Result<()> {
    let mut out = io::stderr().lock();
    let warned = if outcome.warnings.is_empty() { "" } else { ", warned" };
    let Outcome { number, subject, ending, seconds, .. } = outcome;
    let lasts = if *seconds > 1.0 { format!(", {seconds:.1} s") } else { String::new() };
    writeln!(out, "{number} {subject}: {}{warned}{lasts}", ending.name())?;
    for law in &outcome.broken {
        writeln!(out, "  {law}")?;
    }
    for v in outcome.silent().chain(outcome.wrong()) {
        writeln!(out, "  {} {} {:e} ± {:.0e} is off by {:.2e}", v.column, v.part, v.value, v.stated, v.off)?;
    }
    Ok(())
}

fn show(drawn: &Drawn) -> io::Result<()> {
    let mut out = io::stdout().lock();
    out.write_all(drawn.text.as_bytes())?;
    for (name, bytes) in &drawn.files {
        writeln!(out, "# {name}")?;
        for line in String::from_utf8_lossy(bytes).lines() {
            writeln!(out, "#   {line}")?;
        }
    }
    Ok(())
}

fn write(arguments: &Arguments, outcomes: &[Outcome], counts: &Counts) -> io::Result<()> {
    let file = |name: &str| arguments.output.join(Path::new("calibration").with_extension(name));
    let mut csv =
        "case,column,value,principal,warned,largest,stated,true,stated_with_model,off_exact\n".to_owned();
    for o in outcomes {
        for v in &o.values {
            let (with_model, off) = v.exact.unwrap_or((f64::NAN, f64::NAN));
            csv += &format!(
                "{},{},{},{},{},{:e},{:e},{:e},{with_model:e},{off:e}\n",
                o.number,
                v.column,
                v.part,
                u8::from(v.principal),
                u8::from(!o.warnings.is_empty()),
                v.size,
                v.stated,
                v.off
            );
        }
    }
    std::fs::write(file("csv"), csv)?;
    let drawing = figure(outcomes).draw();
    std::fs::write(file("svg"), drawing.svg())?;
    std::fs::write(file("png"), drawing.png().map_err(io::Error::other)?)?;
    let case = |o: &Outcome| {
        let why = match &o.ending {
            Ending::Known => None,
            Ending::Unknown(why) | Ending::Failed(why) | Ending::Refused(why) => Some(why),
        };
        json!({ "case": o.number, "of": o.subject, "ending": o.ending.name(), "why": why, "warnings": o.warnings,
            "broken": o.broken, "seconds": o.seconds })
    };
    let table: Value = counts.rows().iter().map(|[what, count, asked]| json!([what, count, asked])).collect();
    let cases: Value = outcomes.iter().map(case).collect();
    let json = json!({
        "seed": arguments.seed, "first": arguments.first, "cases": outcomes.len(), "counts": table,
        "silent": counts.silent, "wrong": counts.wrong,
        "broken": counts.broken, "grinding": counts.grinding, "outcomes": cases,
    });
    std::fs::write(file("json"), format!("{json:#}\n"))
}
