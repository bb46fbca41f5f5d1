//! A case that was drawn, run and held against a finer run.

use super::Drawn;
use flexion::analysis::error::{Refinable, before_impacts};
use flexion::system::{Role, State};
use flexion_case::{Effort, Problems, Reading, Run};
use flexion_results::{ColumnError, Status};
use std::ops::ControlFlow;

/// Work that a finer run may take: steps times (unknowns + 30).
const BUDGET: f64 = 3e6;
/// Errors below this part of the largest value of a column are those of rounding.
const ROUNDING: f64 = 1e-9;
/// Part of an error by which two finer runs may differ, so that the error is known.
const KNOWN: f64 = 0.3;
/// True over stated error that nobody may hide.
const FAR: f64 = 10.0;
/// Part of the largest value by which a case is wrong that says nothing.
const WRONG: f64 = 1e-2;
/// Wall time of a case of a few parts beyond which a run should have said so \[s\].
const PATIENCE: f64 = 20.0;
/// Smallest factor on an explicit step that is refused for its stability.
const SHORTEST: f64 = 1e-6;

/// How a case ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// It ran to its end, and its errors are known.
    Known,
    /// It ran to its end, and no finer run tells its errors: why.
    Unknown(String),
    /// The run ended with an error.
    Failed(String),
    /// It is a legal case and was refused.
    Refused(String),
}

impl Ending {
    /// One word for it.
    pub fn name(&self) -> &'static str {
        match self {
            Ending::Known => "known",
            Ending::Unknown(_) => "unknown",
            Ending::Failed(_) => "failed",
            Ending::Refused(_) => "refused",
        }
    }
}

/// A value with its stated and its true error.
#[derive(Clone, Debug)]
pub struct Compared {
    /// The column.
    pub column: String,
    /// `min`, `max` or `final`.
    pub part: &'static str,
    /// Whether the column is a principal one.
    pub principal: bool,
    /// The value.
    pub value: f64,
    /// The largest value of the column.
    pub size: f64,
    /// The error that is stated; not finite where there is no statement.
    pub stated: f64,
    /// The error.
    pub off: f64,
    /// Stated errors of mesh and model together, and the difference to the exact coupling, where there is one.
    pub exact: Option<(f64, f64)>,
}

impl Compared {
    /// Whether the error is no larger than is stated, but for rounding.
    pub fn holds(&self) -> bool {
        self.off <= self.stated + self.rounding()
    }

    /// Stated over true error, where that is more than rounding.
    pub fn quotient(&self) -> Option<f64> {
        (self.off > self.rounding() && self.stated.is_finite()).then(|| self.stated / self.off)
    }

    /// An error that nobody asks for.
    pub fn rounding(&self) -> f64 {
        ROUNDING * self.size
    }
}

/// What became of a case.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Its number in the sequence.
    pub number: u64,
    /// What it is of.
    pub subject: &'static str,
    /// How it ended.
    pub ending: Ending,
    /// What it was warned of, but for what its case contains and is not used.
    pub warnings: Vec<String>,
    /// Its values.
    pub values: Vec<Compared>,
    /// Laws of contacts that it does not keep, and by how much.
    pub broken: Vec<String>,
    /// Wall time of the run itself \[s\].
    pub seconds: f64,
}

impl Outcome {
    /// Nothing yet of a case.
    pub(crate) fn of(number: u64, subject: &'static str) -> Outcome {
        Outcome {
            number,
            subject,
            ending: Ending::Known,
            warnings: Vec::new(),
            values: Vec::new(),
            broken: Vec::new(),
            seconds: 0.0,
        }
    }

    /// Whether it takes long without a word.
    pub fn grinds(&self) -> bool {
        self.seconds > PATIENCE && self.warnings.is_empty()
    }

    /// Values off by more than ten times what is stated, of a case without a warning.
    pub fn silent(&self) -> impl Iterator<Item = &Compared> {
        // Written so that NaN is counted.
        self.unwarned().filter(|v| !(v.off <= FAR * v.stated + v.rounding()))
    }

    /// Principal values off by more than a hundredth of the largest value and by more than is stated, of a case without a warning.
    pub fn wrong(&self) -> impl Iterator<Item = &Compared> {
        self.unwarned().filter(|v| v.principal && !(v.off <= v.stated.max(WRONG * v.size)))
    }

    fn unwarned(&self) -> impl Iterator<Item = &Compared> {
        self.values.iter().filter(|_| self.warnings.is_empty())
    }

    /// Whether all principal values are right to this part of the largest value of their columns, by the exact coupling where
    /// there is one.
    pub fn right_to(&self, part: f64) -> bool {
        let off = |value: &Compared| value.exact.map_or(value.off, |(_, off)| off.max(value.off));
        self.ending == Ending::Known
            && self.values.iter().filter(|v| v.principal).all(|v| off(v) <= part * v.size)
    }
}

/// Counts the work of a run, and stops it when it is used up.
struct Work(f64);

impl Work {
    fn watch(&mut self, state: &State) -> ControlFlow<()> {
        self.0 -= state.q.len() as f64 + 30.0;
        if self.0 < 0.0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// Runs a case, with a limit of work.
pub(crate) fn run(reading: &Reading) -> Result<Run, Problems> {
    let mut work = Work(BUDGET);
    Ok(reading.prepare()?.run(&mut |state| work.watch(state)))
}

/// Runs a case as `flexion run` does, and more finely.
pub fn judge(drawn: &Drawn, number: u64) -> Outcome {
    let mut outcome = Outcome::of(number, drawn.subject);
    outcome.ending = match judged(drawn, &mut outcome) {
        Ok(ending) => ending,
        // No key alone tells whether there is an equilibrium to begin with.
        Err(problems) if problems.list.iter().all(|p| p.message.contains("no equilibrium")) => {
            Ending::Failed(problems.to_string())
        }
        Err(problems) => Ending::Refused(problems.to_string()),
    };
    outcome
}

fn judged(drawn: &Drawn, outcome: &mut Outcome) -> Result<Ending, Problems> {
    let reading = admitted(drawn)?;
    let ours = run(&reading)?;
    match ours.status {
        Status::Finished => {}
        Status::Stopped => return Ok(Ending::Unknown("the run itself takes too long".to_owned())),
        Status::Failed => return Ok(Ending::Failed(ours.message.unwrap_or_default())),
    }
    let errors = reading.estimate_errors(&ours, Effort::Auto, &mut |_| ControlFlow::Continue(()));
    // What the case contains and a run does not use is said of the right answer too.
    let facts = reading.case.unused_by_run();
    let doubts = ours.warnings.iter().filter(|warning| !facts.contains(warning));
    outcome.warnings.extend(doubts.chain(&errors.warnings).chain(&errors.unknown).cloned());
    if errors.unknown.is_none() && errors.trusted < ours.state.t {
        outcome.warnings.push(format!("trusted until t = {} s", errors.trusted));
    }
    // Errors are stated until the first impact only.
    let end = before_impacts(&reading, &reading.variant().plan, ours.as_ref());
    let step = format!("output.step={:e}", reading.case.output.step);
    let until = end.map(|end| vec![format!("run.duration={end:e}"), step]).unwrap_or_default();
    let finest = match finer(&reading, 2, &until) {
        Ok(finest) => finest,
        Err(why) => return Ok(Ending::Unknown(why)),
    };
    let whole = reading.case.hub_beam().is_none_or(|beam| beam.coupling.whole_curve);
    let exact =
        if whole { None } else { finer(&reading, 1, &[exact(&reading), until.clone()].concat()).ok() };
    let stated = |column: &str| errors.columns.iter().find(|error| error.column == column);
    let compare = |finest: &Run| compared(&ours, &stated, finest, exact.as_ref());
    outcome.values = compare(&finest);
    let beyond = |v: &Compared| v.stated.is_finite() && !v.holds();
    if outcome.values.iter().any(beyond) {
        // It may be the finer run that is wrong.
        match finer(&reading, 3, &until) {
            Ok(finer) => {
                let other = compare(&finer);
                let pairs = outcome.values.iter().zip(other);
                let known = |(a, b): (&Compared, Compared)| {
                    ((a.off - b.off).abs() <= KNOWN * b.off.max(b.stated) + b.rounding()).then_some(b)
                };
                outcome.values = pairs.filter_map(known).collect();
            }
            Err(_) => outcome.values.retain(|v| !beyond(v)),
        }
    }
    Ok(Ending::Known)
}

/// The case, with the smaller step that the message asks for if it was refused.
fn admitted(drawn: &Drawn) -> Result<Reading, Problems> {
    let mut factor = 1.0;
    let mut reading = drawn.read(&[])?;
    loop {
        let step = reading.case.steps.step();
        match reading.prepare().map(drop) {
            Err(problems)
                if factor > SHORTEST
                    && problems.list.iter().all(|p| p.message.contains("stability limit")) =>
            {
                factor *= 0.5;
                let shorter = step.map(|step| format!("integrator.step={:e}", 0.5 * step));
                reading = reading.with(&shorter.into_iter().collect::<Vec<_>>())?;
            }
            prepared => return prepared.map(|()| reading),
        }
    }
}

/// The run with 2ᵏ times the functions, accurate steps and further changes; or why there is none.
fn finer(reading: &Reading, doublings: usize, further: &[String]) -> Result<Run, String> {
    let mut finer = reading.with(further).map_err(|problems| problems.to_string())?;
    for _ in 0..doublings {
        finer = finer.changed(&finer.case.finer()).map_err(|problems| problems.to_string())?;
    }
    let tightest = if doublings > 2 { 1e-9 } else { 1e-8 };
    let tolerance = 0.01 * reading.variant().tolerance.map_or(1e-6, |tolerance| tolerance.relative);
    let tolerance = tolerance.min(tightest).max(1e-2 * tightest);
    let integrator =
        format!("integrator={{kind='radau',tolerance={tolerance:e},absolute-tolerance={tolerance:e}}}");
    let run = run(&finer.with(&[integrator]).map_err(|problems| problems.to_string())?);
    match run {
        Ok(run) if run.status == Status::Finished => Ok(run),
        Ok(run) if run.status == Status::Stopped => Err("a finer run takes too long".to_owned()),
        Ok(run) => Err(format!("a finer run fails: {}", run.message.unwrap_or_default())),
        Err(problems) => Err(problems.to_string()),
    }
}

/// The exact coupling, on elements.
fn exact(reading: &Reading) -> Vec<String> {
    let elements = reading.case.hub_beam().and_then(|beam| beam.bases.elements).map_or(12, |_| 24);
    vec!["model.coupling=exact".to_owned(), format!("basis={{kind='finite-elements',elements={elements}}}")]
}

fn compared<'a>(
    ours: &Run,
    stated: &dyn Fn(&str) -> Option<&'a ColumnError>,
    finest: &Run,
    exact: Option<&Run>,
) -> Vec<Compared> {
    let mut out = Vec::new();
    for (index, channel) in ours.trajectory.channels().iter().enumerate() {
        let values = |run: &Run| {
            let e = run.trajectory.extremes(run.trajectory.index(&channel.name)?);
            Some([e.min, e.max, e.last])
        };
        let (Some(theirs), Some(mine)) = (values(finest), values(ours)) else { continue };
        if matches!(channel.role, Role::Integration | Role::Imbalance) {
            continue;
        }
        let error = stated(&channel.name);
        let errors = error.map_or([f64::NAN; 3], |error| [error.min, error.max, error.last]);
        let other = exact.and_then(values).zip(error.and_then(|error| error.model));
        let size = ours.trajectory.extremes(index).largest();
        for (k, part) in ["min", "max", "final"].into_iter().enumerate() {
            out.push(Compared {
                column: channel.name.clone(),
                part,
                principal: channel.role == Role::Primary,
                value: mine[k],
                size,
                stated: errors[k],
                off: (mine[k] - theirs[k]).abs(),
                exact: other.map(|(values, model)| (errors[k] + model, (mine[k] - values[k]).abs())),
            });
        }
    }
    out
}
