//! `--check`: the values of a paper against those that were accepted.

use crate::answer::{Answer, Curve};
use crate::described::{As, Described};
use crate::need::{Asks, Need, of_paper};
use crate::rule::Ruled;
use crate::term::{Answers, of_run};
use crate::verdict::judged;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Relative change of a value that is listed.
const LISTED: f64 = 1e-9;
/// Factor by which a stated error may grow.
const GROWN: f64 = 10.0;
/// Error over its value below which its growth is rounding.
const SMALL: f64 = 1e-9;

/// What was accepted of a paper.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
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
#[error("{paper} has no expected.toml that can be read{why}: `flexion reproduce FOLDER --accept` writes it")]
pub struct CheckError {
    paper: String,
    why: String,
}

/// The answers of an item by the names of its runs.
pub fn of_item<'a>(
    id: &str,
    item: &crate::described::Item,
    numbers: &BTreeMap<(String, String), usize>,
    answers: &'a [Option<Answer>],
) -> Answers<'a> {
    let runs = crate::need::runs(item).into_iter();
    runs.map(|run| {
        let number = numbers.get(&(id.to_owned(), run.name.clone()));
        let answer = number.and_then(|number| answers.get(*number)).and_then(Option::as_ref);
        (run.name, (answer, run.seconds))
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
        }
    }
    for (id, item) in &described.items {
        let answers = of_item(id, item, &numbers, answers);
        // Curves are compared by their differences.
        for of in crate::need::terms(item).iter().filter(|of| of.compared == Some(As::CurveDifference)) {
            if let (Ok(value), Some(to)) = (of_run(of, &answers), &of.to) {
                let name = format!("{id}: {} to {to} | {} curve-difference", of.run, of.quantity);
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

/// The largest stated error of a curve, -1 where it is not known.
fn largest_error(curve: &Curve) -> f64 {
    let known = !curve.off.is_empty() && curve.off.iter().all(|off| off.is_finite());
    if known { curve.off.iter().copied().fold(0.0, f64::max) } else { -1.0 }
}

/// The text of `expected.toml` for these answers; what was not run is kept as it stands.
pub fn expected(described: &Described, answers: &[Option<Answer>]) -> String {
    let mut out: Expected =
        described.expected.as_deref().and_then(|text| toml::from_str(text).ok()).unwrap_or_default();
    let now = found(described, answers);
    if answers.iter().all(Option::is_some) {
        out = now;
    } else {
        out.values.extend(now.values);
        out.verdicts.extend(now.verdicts);
    }
    let body = toml::to_string(&out).unwrap_or_default();
    format!(
        "# Values with their errors, and verdicts, for `flexion reproduce --check`; written by `flexion reproduce FOLDER --accept`.\n{body}"
    )
}

/// Compares answers with those that were accepted; what was not run is not compared.
///
/// # Errors
/// [`CheckError`]
pub fn check(described: &Described, answers: &[Option<Answer>]) -> Result<Checked, CheckError> {
    let error = |why: String| CheckError { paper: described.name.clone(), why };
    let text = described.expected.as_deref().ok_or_else(|| error(String::new()))?;
    let expected: Expected =
        toml::from_str(text).map_err(|problem| error(format!(" ({})", problem.to_string().trim_end())))?;
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
    out.failed.extend(gone(described, answers, &expected, &now));
    Ok(out)
}

/// What was accepted and is not there any more, of runs that are computed and of claims whose runs are, and of what the paper no longer has.
fn gone(
    described: &Described,
    answers: &[Option<Answer>],
    expected: &Expected,
    now: &Expected,
) -> Vec<String> {
    let (needs, numbers) = of_paper(described);
    let computed: BTreeMap<String, bool> =
        needs.iter().zip(answers).map(|(need, answer)| (of_need(need), answer.is_some())).collect();
    let whole = |id: &str| {
        described.items.iter().find(|(own, _)| own.as_str() == id).is_none_or(|(id, item)| {
            of_item(id, item, &numbers, answers).values().all(|(answer, _)| answer.is_some())
        })
    };
    let is_gone = |name: &&String| {
        let run = name.rsplit_once(" | ").map_or(name.as_str(), |(run, _)| run);
        let item = run.split_once(": ").map(|(item, _)| item);
        let looked_for = match (computed.get(run), item) {
            (Some(computed), _) => *computed,
            (None, Some(item)) => whole(item),
            (None, None) => true,
        };
        looked_for && !now.values.contains_key(*name)
    };
    let values = expected.values.keys().filter(is_gone).map(|name| format!("{name} is gone"));
    let claim = |name: &&String| {
        let item = name.rsplit_once('.').map_or(name.as_str(), |(item, _)| item);
        whole(item) && !now.verdicts.contains_key(*name)
    };
    values.chain(expected.verdicts.keys().filter(claim).map(|name| format!("claim {name} is gone"))).collect()
}
