//! Advice: the cheapest model and method with which a case is as accurate as is asked.
//!
//! The trusted answer is that of the exact coupling, refined until its estimated error is a fifth of what is asked. Then the ladder is
//! climbed: each coupling on the trusted mesh; of those that hold, each basis with more and more functions, integrated
//! accurately; of those that hold, each integrator with smaller and smaller steps. The error of a run is its difference from
//! the trusted answer, and the error of that is added. Work is counted, evaluations of the residual times unknowns, so that the
//! advice is the same everywhere; a run that becomes costlier than the cheapest that holds is given up.

use super::Run;
use super::refine::{RefineError, Target};
use crate::problem::Problems;
use crate::reading::Reading;
use flexion::analysis::error::{Goal, Pair};
use flexion::analysis::recording::Watch;
use flexion::system::State;
use flexion_results::Status;
use std::borrow::Cow;
use std::ops::ControlFlow;

/// Error of the trusted answer over what is asked.
const TRUSTED: f64 = 0.2;
/// Steps times unknowns of all runs of the ladder, about two minutes of computing.
const MOST_WORK: f64 = 3e8;
/// Tolerance of runs that tell the errors of meshes, over what is asked of the largest value.
const ACCURATE: f64 = 1e-2;

/// The couplings, the cheapest first; `zeroth` is for comparison only.
const COUPLINGS: [&str; 3] = ["first", "high", "exact"];
/// The bases with what they are refined by.
const BASES: [(&str, &[&str]); 6] = [
    ("finite-elements", &["elements=2", "elements=4", "elements=8", "elements=16", "elements=32"]),
    (
        "modes",
        &["axial=1,transverse=1", "axial=2,transverse=2", "axial=4,transverse=4", "axial=8,transverse=8"],
    ),
    ("b-spline", &["elements=2", "elements=4", "elements=8", "elements=16"]),
    ("bezier", &["degree=4", "degree=6", "degree=8", "degree=12"]),
    ("polynomial", &["nodes=5", "nodes=9", "nodes=17"]),
    ("radial", &["nodes=6", "nodes=9", "nodes=17"]),
];
/// The methods with control of their steps, and their tolerances; those with fixed steps, and how many make the run.
const TOLERANCES: [f64; 5] = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7];
const FIXED: [&str; 4] = ["newmark", "generalized-alpha", "runge-kutta-4", "adams-4"];
const STEPS: [f64; 7] = [50.0, 200.0, 800.0, 3200.0, 12_800.0, 51_200.0, 204_800.0];

/// A run of the ladder.
#[derive(Clone, Debug)]
pub struct Tried {
    /// The coupling.
    pub coupling: &'static str,
    /// The basis and its functions.
    pub basis: String,
    /// The integrator and its step or tolerance.
    pub integrator: String,
    /// What makes this run of the case.
    pub changes: Vec<String>,
    /// Evaluations of the residual times unknowns.
    pub work: f64,
    /// Its error over the bound, the largest of all quantities; `None` where there is none, and why.
    pub error: Result<f64, String>,
}

impl Tried {
    /// Whether the error is below what is asked.
    pub fn holds(&self) -> bool {
        self.error.as_ref().is_ok_and(|error| *error <= 1.0)
    }
}

/// What came of a ladder.
#[derive(Clone, Debug)]
pub struct Advice {
    /// The case of the trusted answer, as changes, and its estimated error over the bound.
    pub trusted: (Vec<String>, f64),
    /// The quantities with their bounds: name, bound, unit.
    pub asked: Vec<(String, f64, Cow<'static, str>)>,
    /// All runs, in the order in which they were tried.
    pub tried: Vec<Tried>,
    /// The number of the cheapest that holds among them.
    pub cheapest: Option<usize>,
    /// Whether the ladder ended early for the work it takes.
    pub bounded: bool,
    /// Whether it was stopped.
    pub stopped: bool,
}

/// Why there is no advice.
#[derive(Debug, thiserror::Error)]
pub enum AdviseError {
    /// The case or what is asked is to blame.
    #[error(transparent)]
    Refine(#[from] RefineError),
    /// There is no answer to trust.
    #[error("there is no trusted answer: {0}")]
    NoAnswer(String),
}

impl From<Problems> for AdviseError {
    fn from(problems: Problems) -> AdviseError {
        AdviseError::Refine(problems.into())
    }
}

/// The climb of one ladder.
struct Climb<'a, 'b> {
    reading: &'a Reading,
    target: &'a Target,
    trusted: Run,
    error: f64,
    tried: Vec<Tried>,
    /// Work of the cheapest run that holds.
    least: f64,
    left: f64,
    /// Whether `watch` has asked for the end.
    stopped: bool,
    watch: &'a mut Watch<'b>,
}

/// The change of a basis or an integrator of this kind and keys.
fn kind(table: &str, kind: &str, keys: &str) -> String {
    format!("{table}={{kind='{kind}',{keys}}}")
}

fn radau(tolerance: f64) -> String {
    kind(
        "integrator",
        "radau",
        &format!("tolerance={tolerance:.0e},absolute-tolerance={:.0e}", 0.1 * tolerance),
    )
}

impl Reading {
    /// Climbs the ladder of couplings, bases and integrators for the cheapest run with which what is asked holds.
    ///
    /// # Errors
    /// [`AdviseError`]: what is asked cannot be read, or the exact coupling cannot be refined to a fifth of it.
    pub fn advise(&self, target: &Target, watch: &mut Watch<'_>) -> Result<Advice, AdviseError> {
        if self.case.hub_beam().is_none() || self.case.has_contacts() {
            let message = "advice is for beams on a hub without contacts: couplings and bases are theirs alone, and impacts amplify \
                           every difference";
            return Err(self.problem("", message).into());
        }
        let elements = self.case.hub_beam().and_then(|beam| beam.bases.elements).map_or(10, |(n, _)| n);
        let plain = self.with(&["output.vtk=false".to_owned(), "output.plots=false".to_owned()])?;
        let begin = plain.with(&[
            "model.coupling=exact".to_owned(),
            kind("basis", "finite-elements", &format!("elements={elements}")),
            radau(1e-6),
        ])?;
        let found = begin.refine(&target.times(TRUSTED), watch, &mut |_| {})?;
        let goals = target.goals(&found.run.trajectory, self.case.size())?;
        if found.run.status != Status::Finished {
            return Err(AdviseError::NoAnswer(found.run.message.unwrap_or_default()));
        }
        let errors = found.run.errors.as_ref();
        let part = |goal: &Goal| Some(goal.reached(&found.run.trajectory, &errors?.columns)?.1 / goal.bound);
        let error = goals.iter().filter_map(part).fold(0.0, f64::max);
        if !(error <= 0.5) {
            return Err(AdviseError::NoAnswer(found.refused.unwrap_or_else(|| {
                format!("the error of the exact coupling is {error:.1} of what is asked")
            })));
        }
        let trajectory = &found.run.trajectory;
        let unit =
            |goal: &Goal| trajectory.index(&goal.column).map(|i| trajectory.channels()[i].unit.clone());
        let asked = |goal: &Goal| Some((goal.quantity(), goal.bound, unit(goal)?));
        let asked = goals.iter().filter_map(asked).collect();
        let trusted = found.reading.mesh_and_steps();
        let mut climb = Climb {
            reading: &plain,
            target,
            trusted: found.run,
            error,
            tried: Vec::new(),
            least: f64::INFINITY,
            left: MOST_WORK,
            stopped: false,
            watch,
        };
        climb.couplings(&found.reading);
        let holds = climb.tried.iter().enumerate().filter(|(_, tried)| tried.holds());
        let cheapest = holds.min_by(|a, b| a.1.work.total_cmp(&b.1.work)).map(|(index, _)| index);
        Ok(Advice {
            trusted: (trusted, error),
            asked,
            cheapest,
            bounded: climb.left < 0.0,
            stopped: climb.stopped,
            tried: climb.tried,
        })
    }
}

impl Climb<'_, '_> {
    fn couplings(&mut self, trusted: &Reading) {
        let elements = trusted.case.hub_beam().and_then(|beam| beam.bases.elements).map_or(10, |(n, _)| n);
        let accurate = self.accurate();
        for coupling in COUPLINGS {
            let mesh = ("finite-elements", format!("elements={elements}"));
            if !self.run(coupling, (mesh.0, &mesh.1), ("radau", radau(accurate))) {
                continue;
            }
            let bases = if coupling == "exact" { &BASES[..1] } else { &BASES[..] };
            for (basis, sizes) in bases {
                let enough = |climb: &mut Self, size: &str| {
                    let integrator = ("radau", radau(accurate));
                    climb.run(coupling, (basis, size), integrator)
                };
                let Some(size) = sizes.iter().copied().find(|size| enough(self, size)) else { continue };
                self.integrators(coupling, (basis, size));
            }
        }
    }

    /// Each integrator with smaller and smaller steps, until it holds or becomes too costly.
    fn integrators(&mut self, coupling: &'static str, basis: (&str, &str)) {
        for tolerance in TOLERANCES {
            if self.run(coupling, basis, ("radau", radau(tolerance))) {
                break;
            }
        }
        for method in FIXED {
            for count in STEPS {
                let step = self.reading.case.duration / count;
                let integrator = (method, kind("integrator", method, &format!("step={step:e}")));
                if self.run(coupling, basis, integrator) || self.costlier() {
                    break;
                }
            }
        }
    }

    /// A tolerance at which the error of the steps does not count.
    fn accurate(&self) -> f64 {
        let of = &self.trusted.trajectory;
        let largest = |goal: &Goal| of.index(&goal.column).map_or(f64::NAN, |i| of.extremes(i).largest());
        let bound = |goal: &Goal| goal.bound / largest(goal);
        let goals = self.target.goals(&self.trusted.trajectory, self.reading.case.size()).unwrap_or_default();
        (ACCURATE * goals.iter().map(bound).fold(1.0, f64::min)).clamp(1e-10, 1e-5)
    }

    /// Whether the last run was given up for its work.
    fn costlier(&self) -> bool {
        self.tried.last().is_some_and(|tried| tried.work >= self.least)
    }

    /// Runs one rung, unless the work is used up: whether it holds.
    fn run(&mut self, coupling: &'static str, basis: (&str, &str), integrator: (&str, String)) -> bool {
        if self.left < 0.0 || self.stopped {
            return false;
        }
        let (method, integrator) = integrator;
        let changes =
            vec![format!("model.coupling={coupling}"), kind("basis", basis.0, basis.1), integrator.clone()];
        let keys = integrator.split_once(',').map_or("", |(_, keys)| keys.trim_end_matches('}'));
        let (least, mut steps) = (self.least, 0.0);
        let run = self.reading.with(&changes).and_then(|reading| reading.prepare()).map(|prepared| {
            prepared.run(&mut |state: &State| {
                steps += state.v.len() as f64;
                self.stopped |= (self.watch)(state).is_break();
                if steps > least || self.stopped { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            })
        });
        self.left -= steps;
        if self.stopped {
            return false;
        }
        let work = run.as_ref().map_or(0.0, |run| run.counters.residuals as f64 * run.size.unknowns as f64);
        let error = match &run {
            Ok(run) if run.status == Status::Finished => Ok(self.error_of(run)),
            Ok(run) if run.status == Status::Stopped => {
                Err("costlier than the cheapest that holds".to_owned())
            }
            Ok(run) => Err(run.message.clone().unwrap_or_default()),
            Err(problems) => {
                Err(problems.list.first().map_or(String::new(), |problem| problem.message.clone()))
            }
        };
        let tried = Tried {
            coupling,
            basis: format!("{} {}", basis.0, basis.1),
            integrator: format!("{method} {keys}"),
            changes,
            work: work.max(steps),
            error,
        };
        let holds = tried.holds();
        if holds {
            self.least = self.least.min(tried.work);
        }
        self.tried.push(tried);
        holds
    }

    /// The largest error over its bound.
    fn error_of(&self, run: &Run) -> f64 {
        let goals = self.target.goals(&self.trusted.trajectory, self.reading.case.size()).unwrap_or_default();
        let part = |goal: &Goal| {
            let pair = Pair::new(&run.trajectory, &self.trusted.trajectory, &goal.column);
            // What stands still has a bound of zero.
            let off = pair.map_or(f64::NAN, |pair| goal.off(&pair));
            if off == 0.0 { 0.0 } else { off / goal.bound }
        };
        // Written so that NaN is kept.
        let worse = |a: f64, b: f64| if a.is_nan() || b <= a { a } else { b };
        let largest = goals.iter().map(part).fold(0.0, worse);
        largest + self.error
    }
}
