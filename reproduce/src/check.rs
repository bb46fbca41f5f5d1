//! `--check`: the values of a paper against those that were accepted.

use crate::answer::{Answer, Curve};
use crate::described::{As, Described, OfRun};
use crate::need::{Asks, Need, of_paper};
use crate::rule::Ruled;
use crate::term::{Answers, of_run};
use crate::verdict::judged;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// Relative change of a value that is listed.
const LISTED: f64 = 1e-9;
/// Factor by which a stated error may grow.
const GROWN: f64 = 10.0;
/// Factor by which an accepted error may be larger than one that is found: beyond it a check would let anything pass.
const SHRUNK: f64 = 1e3;
/// What the moment of a curve is called.
const MOMENT: &str = "moment";
/// Error over its value below which its growth is rounding.
const SMALL: f64 = 1e-9;

/// What was accepted of a paper.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Expected {
    /// Verdicts by item and number of the claim.
    #[serde(default)]
    verdicts: BTreeMap<String, String>,
    /// Values with their errors by run and quantity; an error that is not known is -1.
    #[serde(default)]
    values: BTreeMap<String, [f64; 2]>,
}

/// What a check found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Checked {
    /// Values and verdicts that were compared.
    pub compared: usize,
    /// What has changed by no more than its error.
    pub listed: Vec<String>,
    /// What has changed by more, or is gone.
    pub failed: Vec<String>,
}

/// There is nothing to compare with.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CheckError {
    /// Nothing was accepted.
    #[error("{paper} has no expected.toml: `flexion reproduce FOLDER --accept` writes it")]
    None {
        /// The paper.
        paper: String,
    },
    /// What was accepted cannot be read.
    #[error(
        "expected.toml of {paper} cannot be read ({why}): mend it, or remove it and let `flexion reproduce FOLDER --accept` write it anew"
    )]
    Unreadable {
        /// The paper.
        paper: String,
        /// What is wrong.
        why: String,
    },
}

/// What was accepted of a paper, where it has something.
///
/// # Errors
/// [`CheckError::Unreadable`]
fn accepted(described: &Described) -> Result<Option<Expected>, CheckError> {
    let Some(text) = &described.expected else { return Ok(None) };
    let unreadable = |why: String| CheckError::Unreadable { paper: described.name.clone(), why };
    let read: Expected =
        toml::from_str(text).map_err(|problem| unreadable(problem.to_string().trim_end().to_owned()))?;
    let known = |error: f64| error.is_finite() && (error >= 0.0 || error == -1.0);
    match read.values.iter().find(|(_, [value, error])| !value.is_finite() || !known(*error)) {
        Some((name, [value, error])) => {
            Err(unreadable(format!("{name}: {value} ± {error} is no value with an error")))
        }
        None => Ok(Some(read)),
    }
}

/// Whether what was accepted of a paper can be compared with, or with `accept` replaced.
///
/// # Errors
/// [`CheckError`]
pub fn comparable(described: &Described, accept: bool) -> Result<(), CheckError> {
    match accepted(described)? {
        None if !accept => Err(CheckError::None { paper: described.name.clone() }),
        _ => Ok(()),
    }
}

/// The answers of an item by the names of its runs.
pub fn of_item<'a>(
    id: &str,
    item: &crate::described::Item,
    (needs, numbers): (&[Need], &BTreeMap<(String, String), usize>),
    answers: &'a [Option<Answer>],
) -> Answers<'a> {
    let runs = crate::need::runs(item).into_iter();
    runs.map(|run| {
        let number = numbers.get(&(id.to_owned(), run.name.clone()));
        let answer = number.and_then(|number| answers.get(*number)).and_then(Option::as_ref);
        // Another item may say how long the same run takes.
        let seconds = number.and_then(|number| needs[*number].run.seconds);
        (run.name, (answer, seconds))
    })
    .collect()
}

/// What is computed, under which its values are kept.
fn of_need(need: &Need) -> String {
    let key = &need.run.key;
    let run = format!("{} {}", key.case, key.set.join(" "));
    let against = key.against.as_ref().map(|against| format!(" against {}", against.join(" ")));
    let asks = match &key.asks {
        Asks::Run => String::new(),
        Asks::Modes(asks) | Asks::Energy(asks) => format!(" {asks}"),
    };
    format!("{}{}{asks}", run.trim_end(), against.unwrap_or_default())
}

fn found(described: &Described, answers: &[Option<Answer>]) -> Expected {
    let (needs, numbers) = of_paper(described);
    let mut out = Expected::default();
    for (need, answer) in needs.iter().zip(answers) {
        let Some(answer) = answer else { continue };
        let run = of_need(need);
        for (quantity, value) in &answer.values {
            let Ok(value) = value else { continue };
            if !value.varies {
                let name = format!("{run} | {quantity}");
                out.values.insert(name, [value.value, value.error.unwrap_or(-1.0)]);
            }
        }
        for (column, curve) in &answer.curves {
            let Ok(curve) = curve else { continue };
            let name = format!("{run} | {column} root-mean-square");
            out.values.insert(name, [root_mean_square(&curve.y), largest_error(curve)]);
            let name = format!("{run} | {column} {MOMENT}");
            out.values.insert(name, [moment(&curve.y), largest_error(curve)]);
        }
        // What is no number agrees with nothing.
        out.values.retain(|_, [value, _]| value.is_finite());
    }
    for (id, item) in &described.items {
        let answers = of_item(id, item, (&needs, &numbers), answers);
        // Curves are compared by their differences.
        for of in &crate::need::terms(item) {
            if let Some(name) = of_curves(id, of)
                && let Ok(value) = of_run(of, &answers)
            {
                out.values.insert(name, [value.value, value.error.unwrap_or(-1.0)]);
            }
        }
        for (i, claim) in item.claims.iter().enumerate() {
            let verdict = judged(claim, &answers);
            if !matches!(verdict.ruled, Ruled::NotRun(_)) && !crate::need::varies(&claim.rule) {
                out.verdicts.insert(format!("{id}.{}", i + 1), verdict.word().to_owned());
            }
        }
    }
    out
}

/// √(Σyᵢ²/n) of the records of a curve, whose error is at most the largest error of y.
fn root_mean_square(y: &[f64]) -> f64 {
    let largest = y.iter().fold(0.0_f64, |most, y| most.max(y.abs()));
    if largest == 0.0 {
        return 0.0;
    }
    largest * (y.iter().map(|y| (y / largest).powi(2)).sum::<f64>() / y.len() as f64).sqrt()
}

/// Σ wᵢyᵢ/n of the records of a curve, with wᵢ from 0 at its first to 1 at its last and at most the largest error of y: it has a sense, and knows
/// when what is.
fn moment(y: &[f64]) -> f64 {
    let last = y.len().saturating_sub(1).max(1) as f64;
    y.iter().enumerate().map(|(i, y)| i as f64 / last * y).sum::<f64>() / y.len().max(1) as f64
}

/// The largest stated error of a curve, -1 where it is not known.
fn largest_error(curve: &Curve) -> f64 {
    let known = !curve.off.is_empty() && curve.off.iter().all(|off| off.is_finite());
    if known { curve.off.iter().copied().fold(0.0, f64::max) } else { -1.0 }
}

/// The text of `expected.toml` for these answers; what was not run is kept as it stands, and what is gone is left out.
///
/// # Errors
/// [`CheckError::Unreadable`]
pub fn expected(described: &Described, answers: &[Option<Answer>]) -> Result<String, CheckError> {
    let mut out = accepted(described)?.unwrap_or_default();
    let now = found(described, answers);
    let (values, verdicts) = gone(described, answers, &out, &now);
    out.values.retain(|name, _| !values.contains(name));
    out.verdicts.retain(|name, _| !verdicts.contains(name));
    out.values.extend(now.values);
    out.verdicts.extend(now.verdicts);
    let body = toml::to_string(&out).unwrap_or_default();
    Ok(format!(
        "# Values with their errors, and verdicts, for `flexion reproduce --check`; written by `flexion reproduce FOLDER --accept`.\n{body}"
    ))
}

/// Compares answers with those that were accepted; what was not run is not compared.
///
/// # Errors
/// [`CheckError`]
pub fn check(described: &Described, answers: &[Option<Answer>]) -> Result<Checked, CheckError> {
    let expected = accepted(described)?.ok_or_else(|| CheckError::None { paper: described.name.clone() })?;
    let now = found(described, answers);
    let mut out = Checked::default();
    let mut compare = |name: &str, before: Option<&[f64; 2]>, after: [f64; 2]| {
        out.compared += 1;
        let Some([value, error]) = before else {
            out.failed.push(format!("{name}: {} is new; `--accept` takes it up", after[0]));
            return;
        };
        let change = (after[0] - value).abs();
        let allowed = error.max(0.0) + after[1].max(0.0);
        let relative = change / value.abs().max(f64::MIN_POSITIVE);
        // What is no number is no agreement.
        if !(change <= allowed.max(LISTED * value.abs())) {
            out.failed.push(format!("{name}: {value} ± {error} has become {} ± {}", after[0], after[1]));
        } else if after[1] > GROWN * error.max(SMALL * value.abs()) || (*error >= 0.0 && after[1] < 0.0) {
            out.failed.push(format!("{name}: its error {error} has become {}", after[1]));
        } else if *error > SHRUNK * after[1].max(SMALL * value.abs()) && after[1] >= 0.0 {
            out.failed
                .push(format!("{name}: its error {error} has become {}; `--accept` takes it up", after[1]));
        } else if relative > LISTED {
            out.listed.push(format!("{name}: {value} has become {}, within the error", after[0]));
        }
    };
    for (name, value) in &now.values {
        compare(name, expected.values.get(name), *value);
    }
    for (name, verdict) in &now.verdicts {
        out.compared += 1;
        match expected.verdicts.get(name) {
            Some(before) if before == verdict => {}
            Some(before) => out.failed.push(format!("claim {name}: {before} has become {verdict}")),
            None => out.failed.push(format!("claim {name}: {verdict} is new; `--accept` takes it up")),
        }
    }
    let (values, verdicts) = gone(described, answers, &expected, &now);
    out.failed.extend(values.into_iter().map(|name| format!("{name} is gone")));
    out.failed.extend(verdicts.into_iter().map(|name| format!("claim {name} is gone")));
    Ok(out)
}

/// The values and the verdicts that were accepted and are not there any more: of runs that are computed and of claims whose runs are, and of
/// what the paper no longer asks.
fn gone(
    described: &Described,
    answers: &[Option<Answer>],
    expected: &Expected,
    now: &Expected,
) -> (Vec<String>, Vec<String>) {
    let (needs, numbers) = of_paper(described);
    let computed: BTreeMap<String, (&Need, bool)> =
        needs.iter().zip(answers).map(|(need, answer)| (of_need(need), (need, answer.is_some()))).collect();
    let whole = |id: &str| {
        described.items.iter().find(|(own, _)| own.as_str() == id).is_none_or(|(id, item)| {
            of_item(id, item, (&needs, &numbers), answers).values().all(|(answer, _)| answer.is_some())
        })
    };
    let terms = |(id, item): &(String, crate::described::Item)| {
        crate::need::terms(item).iter().filter_map(|of| of_curves(id, of)).collect::<Vec<_>>()
    };
    let compared: BTreeSet<String> = described.items.iter().flat_map(terms).collect();
    let is_gone = |name: &&String| {
        let (run, what) = name.rsplit_once(" | ").unwrap_or((name.as_str(), ""));
        let item = run.split_once(": ").map(|(item, _)| item);
        let looked_for = match (computed.get(run), item) {
            (Some((need, computed)), _) => *computed || !is_asked(need, what),
            (None, Some(item)) => whole(item) || !compared.contains(*name),
            (None, None) => true,
        };
        looked_for && !now.values.contains_key(*name)
    };
    let claim = |name: &&String| {
        let (item, number) = name.rsplit_once('.').unwrap_or((name.as_str(), ""));
        let there = described.items.iter().find(|(id, _)| id == item).is_some_and(|(_, item)| {
            number.parse::<usize>().is_ok_and(|number| (1..=item.claims.len()).contains(&number))
        });
        (whole(item) || !there) && !now.verdicts.contains_key(*name)
    };
    let values = expected.values.keys().filter(is_gone).cloned().collect();
    (values, expected.verdicts.keys().filter(claim).cloned().collect())
}

/// Whether a value of this name is asked of a run.
fn is_asked(need: &Need, what: &str) -> bool {
    let column = what.strip_suffix(" root-mean-square").or(what.strip_suffix(MOMENT).map(str::trim_end));
    need.run.key.asks != Asks::Run
        || need.quantities.contains(what)
        || column.is_some_and(|column| need.columns.contains(column))
}

/// The name of a difference of curves of an item, where a term is one.
fn of_curves(id: &str, of: &OfRun) -> Option<String> {
    let to = of.to.as_ref().filter(|_| of.compared == Some(As::CurveDifference))?;
    Some(format!("{id}: {} to {to} | {} curve-difference", of.run, of.quantity))
}
