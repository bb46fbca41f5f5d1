//! Advice on a case: the couplings, bases and integrators of its ladder, and what is said of them.
//!
//! [`flexion::analysis::error::advise`](fn@advise) climbs it.

use super::refine::{RefineError, Target, refused};
use crate::kinds::coupling::{SPACE, SPACE_WITH_SHEAR};
use crate::layout;
use crate::problem::Problems;
use crate::reading::Reading;
use crate::values::Value;
use flexion::analysis::error::{
    Choice, Goal, Ladder, Mesh, NoAdvice, NoDifference, NotTrusted, Variant, advise,
};
use flexion::analysis::recording::Watch;
use flexion::integrator::Tolerance;
use flexion::system::Channel;
use serde_json::{Value as Json, json};
use std::borrow::Cow;

/// The couplings: the first leaves out most, the last least.
const COUPLINGS: [&str; 6] = ["zeroth", "first", "high", "exact", SPACE, SPACE_WITH_SHEAR];
/// The coupling that describes the whole curve of the beam, by finite elements, as those in space do.
const EXACT: &str = "exact";
/// The bases with the keys of their coarsest meshes; finite elements come first.
const BASES: [(&str, &[(&str, usize)]); 6] = [
    (ELEMENTS, &[("elements", 2)]),
    ("modes", &[("axial", 1), ("transverse", 1)]),
    ("b-spline", &[("elements", 2)]),
    ("bezier", &[("degree", 4)]),
    ("polynomial", &[("nodes", 5)]),
    ("radial", &[("nodes", 6)]),
];
const ELEMENTS: &str = "finite-elements";
/// Elements from which the trusted answer is refined where the case has none.
const OWN: usize = 10;
/// The methods with fixed steps.
const FIXED: [&str; 4] = ["newmark", "generalized-alpha", "runge-kutta-4", "adams-4"];
/// Tolerance from which the trusted answer is refined.
const TOLERANCE: Tolerance = Tolerance { relative: 1e-6, absolute: 1e-7 };

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
    /// Its difference from the trusted answer over the bound, the largest of all quantities, with the error of that answer; or why there is
    /// none. That of another coupling than the trusted one is a difference of the models too.
    pub difference: Result<f64, String>,
}

impl Tried {
    /// Whether the difference is below what is asked.
    pub fn holds(&self) -> bool {
        self.difference.as_ref().is_ok_and(|difference| *difference <= 1.0)
    }
}

/// The answer that runs are held against.
#[derive(Clone, Debug)]
pub struct Trusted {
    /// The coupling.
    pub coupling: &'static str,
    /// What makes its run of the case.
    pub changes: Vec<String>,
    /// Its estimated error over the bound.
    pub error: f64,
}

/// A coupling that was not tried.
#[derive(Clone, Debug)]
pub struct Untried {
    /// The coupling.
    pub coupling: &'static str,
    /// The key whose value is missing, or is not carried by the coupling.
    pub key: String,
    /// Why.
    pub why: String,
}

/// What came of a ladder.
#[derive(Clone, Debug)]
pub struct Advice {
    /// The trusted answer.
    pub trusted: Trusted,
    /// The quantities with their bounds: name, bound, unit.
    pub asked: Vec<(String, f64, Cow<'static, str>)>,
    /// The couplings that were not tried.
    pub untried: Vec<Untried>,
    /// All runs, in the order in which they were tried.
    pub tried: Vec<Tried>,
    /// The number of the cheapest that holds among them.
    pub cheapest: Option<usize>,
    /// Whether the ladder ended early for the work it takes.
    pub bounded: bool,
    /// Whether it was stopped.
    pub stopped: bool,
}

impl Advice {
    /// All of it for programs to read, as `advice.json` states it.
    pub fn to_json(&self) -> Json {
        let row = |tried: &Tried| {
            json!({
                "coupling": tried.coupling, "basis": tried.basis, "integrator": tried.integrator, "set": tried.changes,
                "work": tried.work, "difference": tried.difference.as_ref().ok(), "why": tried.difference.as_ref().err(),
                "holds": tried.holds(),
            })
        };
        let asked: Json = self
            .asked
            .iter()
            .map(|(name, bound, unit)| json!({ "quantity": name, "error": bound, "unit": unit }))
            .collect();
        let trusted = &self.trusted;
        let why = |of: &Untried| json!({ "coupling": of.coupling, "key": of.key, "why": of.why });
        let untried: Json = self.untried.iter().map(why).collect();
        json!({
            "asked": asked,
            "trusted": { "coupling": trusted.coupling, "set": trusted.changes, "error": trusted.error },
            "untried": untried,
            "cheapest": self.cheapest.and_then(|index| self.tried.get(index)).map(row),
            "bounded": self.bounded,
            "stopped": self.stopped,
            "tried": self.tried.iter().map(row).collect::<Json>(),
        })
    }
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

/// The ladder of a case.
struct Rungs<'r> {
    reading: &'r Reading,
    /// Whether its spelling is that of a beam on a hub, which every coupling knows.
    short: bool,
}

impl Rungs<'_> {
    /// The basis of a coupling on a mesh that begins a family, or on that from which the trusted answer is refined.
    fn basis(&self, family: Option<usize>) -> (&'static str, Vec<(String, usize)>) {
        let own = || self.reading.written().inner("basis").filter(|_| self.short);
        match family {
            Some(family) => {
                let (basis, keys) = BASES[family];
                (basis, keys.iter().map(|(key, n)| ((*key).to_owned(), *n)).collect())
            }
            None => {
                let elements = match own().and_then(|basis| basis.get("elements")).map(|filled| &filled.value)
                {
                    Some(Value::Integer(n)) => usize::try_from(*n).unwrap_or(OWN),
                    _ => OWN,
                };
                (ELEMENTS, vec![("elements".to_owned(), elements)])
            }
        }
    }

    /// What makes a run of the case: coupling, basis and integrator. The functions are those of the basis and of `mesh`, changes that make
    /// its mesh of that.
    fn changes(&self, choice: Choice, mesh: &[String], integrator: &str) -> Vec<String> {
        let mut changes = Vec::new();
        if self.short {
            let (basis, mut keys) = self.basis(choice.family);
            for (key, n) in mesh.iter().filter_map(|change| functions(change)) {
                match keys.iter_mut().find(|(known, _)| *known == key) {
                    Some((_, before)) => *before = n,
                    None => keys.push((key, n)),
                }
            }
            let keys: Vec<String> = keys.into_iter().map(|(key, n)| format!("{key}={n}")).collect();
            changes.push(format!("model.coupling={}", COUPLINGS[choice.model]));
            changes.push(table("basis", basis, &keys.join(",")));
        } else {
            changes.push(format!("model.coupling={}", COUPLINGS[choice.model]));
            changes.extend(choice.family.is_some().then(|| "model.refine=1".to_owned()));
        }
        changes.extend(mesh.iter().filter(|change| functions(change).is_none()).cloned());
        changes.push(integrator.to_owned());
        changes
    }

    /// The case by a choice, on the coarsest mesh.
    fn at(&self, choice: Choice) -> Result<Reading, Problems> {
        let step = self.reading.case.duration / 100.0;
        let integrator = match choice.method {
            None => radau(TOLERANCE),
            Some(method) => table("integrator", FIXED[method], &format!("step={step:e}")),
        };
        self.reading.with(&self.changes(choice, &[], &integrator))
    }

    /// A run as it is told.
    fn tried(&self, of: flexion::analysis::error::Tried<Problems>) -> Tried {
        let (changes, basis, integrator) = self.told(of.choice, &of.variant);
        let difference = of.difference.map_err(|why| match why {
            NoDifference::Costlier => "costlier than the cheapest that holds".to_owned(),
            NoDifference::Failed(error) => error.to_string(),
            NoDifference::Refused(problems) => problems.reason(),
            NoDifference::NoColumn(column) => format!("it has no column `{column}`"),
            _ => "it was not compared".to_owned(),
        });
        Tried { coupling: COUPLINGS[of.choice.model], basis, integrator, changes, work: of.work, difference }
    }

    /// What makes a run of the case, its basis and its integrator in words.
    fn told(&self, choice: Choice, variant: &Variant) -> (Vec<String>, String, String) {
        let mesh = if variant.mesh == Mesh::default() { Ok(Vec::new()) } else { self.mesh(choice, variant) };
        let integrator = match (variant.tolerance, choice.method) {
            (None, Some(method)) => {
                let step = variant.plan.step.unwrap_or(f64::NAN);
                table("integrator", FIXED[method], &format!("step={step:e}"))
            }
            (tolerance, _) => radau(tolerance.unwrap_or(TOLERANCE)),
        };
        let changes = self.changes(choice, &mesh.unwrap_or_default(), &integrator);
        let of_mesh: Vec<String> = changes.iter().filter_map(|change| words(change, "basis")).collect();
        let refined = changes.iter().filter(|change| change.starts_with("model.refine")).cloned();
        let basis = of_mesh.into_iter().chain(refined).collect::<Vec<_>>().join(" ");
        let basis = if basis.is_empty() { "its own".to_owned() } else { basis };
        (changes, basis, words(&integrator, "integrator").unwrap_or_default())
    }

    fn mesh(&self, choice: Choice, variant: &Variant) -> Result<Vec<String>, Problems> {
        let changes = self.at(Choice { method: None, ..choice })?.mesh_changes(variant.mesh)?;
        Ok(changes.iter().map(ToString::to_string).collect())
    }
}

impl Ladder for Rungs<'_> {
    type Motion = Reading;

    fn models(&self) -> usize {
        COUPLINGS.len()
    }

    fn model(&self, model: usize) -> Result<Reading, Problems> {
        if !self.short {
            // Says which couplings there are not.
            self.reading.with(&[format!("model.coupling={}", COUPLINGS[model])])?;
        }
        let reading = self.at(Choice { model, family: None, method: None })?;
        let silent = |space: &crate::space::Space| space.beams.iter().any(|(beam, _)| beam.planar);
        if self.short && reading.case.space().is_some_and(silent) {
            let message = "says nothing of torsion and of bending across, on which a motion in space depends";
            return Err(self.reading.problem("section", message));
        }
        if COUPLINGS[model] == SPACE_WITH_SHEAR {
            let without = self.at(Choice { model: model - 1, family: None, method: None })?;
            let adds = |space: &crate::space::Space| space.beams.iter().any(|(beam, _)| !beam.shear);
            if !without.case.space().is_some_and(adds) {
                let message = format!("no beam is without shear, and `{SPACE}` is the same");
                return Err(self.reading.problem("model.coupling", message));
            }
        }
        Ok(reading)
    }

    fn families(&self, model: usize) -> Vec<Result<Reading, Problems>> {
        let count =
            if [EXACT, SPACE, SPACE_WITH_SHEAR].contains(&COUPLINGS[model]) { 1 } else { BASES.len() };
        (0..count).map(|k| self.at(Choice { model, family: Some(k), method: None })).collect()
    }

    fn methods(&self, model: usize, family: usize) -> Vec<Result<Reading, Problems>> {
        let of = |method| Choice { model, family: Some(family), method: Some(method) };
        (0..FIXED.len()).map(|method| self.at(of(method))).collect()
    }
}

/// The change of a basis or an integrator to this kind and keys.
fn table(table: &str, kind: &str, keys: &str) -> String {
    format!("{table}={{kind='{kind}',{keys}}}")
}

/// Kind and keys of such a change, in words.
fn words(change: &str, table: &str) -> Option<String> {
    let (kind, keys) = change.strip_prefix(table)?.strip_prefix("={kind='")?.split_once("',")?;
    Some(format!("{kind} {}", keys.trim_end_matches('}')))
}

/// The key of a basis and its number that a change `basis.KEY=NUMBER` gives.
fn functions(change: &str) -> Option<(String, usize)> {
    let (key, n) = change.strip_prefix("basis.")?.split_once('=')?;
    Some((key.to_owned(), n.parse().ok()?))
}

fn radau(Tolerance { relative, absolute }: Tolerance) -> String {
    table("integrator", "radau", &format!("tolerance={relative:e},absolute-tolerance={absolute:e}"))
}

impl Reading {
    /// Climbs the ladder of couplings, bases and integrators for the cheapest run with which what is asked holds.
    ///
    /// # Errors
    /// [`AdviseError`]: what is asked cannot be read, or the highest coupling whose data are given cannot be refined to a fifth of it.
    pub fn advise(&self, target: &Target, watch: &mut Watch<'_>) -> Result<Advice, AdviseError> {
        if self.case.has_contacts() {
            let message = "advice is for cases without contacts: impacts amplify every difference";
            return Err(self.problem("contact", message).into());
        }
        self.has_errors()?;
        self.missing_for_run()?;
        let plain = self.with(&["output.vtk=false".to_owned(), "output.plots=false".to_owned()])?;
        let rungs = Rungs { reading: &plain, short: !layout::is_spatial(self.written().keys) };
        let goals = |trajectory: &flexion_results::Trajectory| target.goals(trajectory, self.case.size());
        let found = advise(&rungs, &goals, watch).map_err(|why| match why {
            NoAdvice::Asked(error) => AdviseError::Refine(error),
            NoAdvice::NoModel(mut untried) => match untried.pop() {
                Some((_, problems)) => problems.into(),
                None => AdviseError::NoAnswer("there is no coupling".to_owned()),
            },
            NoAdvice::NotTrusted(why) => AdviseError::NoAnswer(not_trusted(&why)),
            _ => AdviseError::NoAnswer("the ladder ended".to_owned()),
        })?;
        let choice = Choice { model: found.trusted, family: None, method: None };
        let (changes, ..) = rungs.told(choice, &found.variant);
        let trajectory = &found.record.trajectory;
        let channel = |goal: &Goal| trajectory.index(&goal.column).map(|i| &trajectory.channels()[i]);
        let asked = |goal: &Goal| {
            channel(goal).map(|Channel { unit, .. }| (goal.quantity(), goal.bound, unit.clone()))
        };
        let untried = found.untried.into_iter().map(|(model, problems)| Untried {
            coupling: COUPLINGS[model],
            key: problems.list.first().map_or(String::new(), |problem| problem.key.clone()),
            why: problems.reason(),
        });
        Ok(Advice {
            trusted: Trusted { coupling: COUPLINGS[found.trusted], changes, error: found.error },
            asked: found.goals.iter().filter_map(asked).collect(),
            untried: untried.collect(),
            tried: found.tried.into_iter().map(|of| rungs.tried(of)).collect(),
            cheapest: found.cheapest,
            bounded: found.bounded,
            stopped: found.stopped,
        })
    }
}

/// Why an answer is not trusted.
fn not_trusted(why: &NotTrusted<Problems>) -> String {
    let NotTrusted { model, error, last, ended, .. } = why;
    let coupling = COUPLINGS[*model];
    match refused(ended, last.as_ref()) {
        Some(reason) => format!("that of the coupling `{coupling}` is not refined: {reason}"),
        None => format!("the error of the coupling `{coupling}` is {error:.1} of what is asked"),
    }
}
