//! What is wrong with the form of an item, whatever its runs give: times that are none, words that no rule fills, plots and tables of
//! nothing, and rules that are decided before anything is computed.

use crate::described::{As, Claim, Item, ItemKind, OfRun, Plot, Rule, Table, Template, Term};
use crate::need::{Key, named_by, of_rule, placeholders, runs};
use crate::rule::terms;
use crate::term::window;
use std::collections::BTreeMap;

/// All that is wrong, each with its line.
pub fn problems(file: &str, item: &Item) -> Vec<String> {
    let lines = &item.lines;
    let at =
        |line: usize, found: Vec<String>| found.into_iter().map(move |why| format!("{file}:{line}: {why}"));
    let mut out: Vec<String> = at(lines.of("kind").unwrap_or(1), of_kind(item)).collect();
    for (run, (line, ..)) in item.runs.iter().zip(&lines.runs) {
        out.extend(at(*line, of_template(run)));
    }
    for (plot, line) in item.plots.iter().zip(&lines.plots) {
        out.extend(at(*line, of_plot(plot)));
    }
    if let (Some(table), Some(line)) = (&item.table, lines.table) {
        out.extend(at(line, of_table(table)));
        for (column, line) in table.columns.iter().zip(&lines.columns) {
            out.extend(at(*line, of_times(&column.quantity, column.compared).into_iter().collect()));
        }
    }
    let keys = runs(item).into_iter().map(|run| (run.name, run.key)).collect();
    for (claim, line) in item.claims.iter().zip(&lines.claims) {
        out.extend(at(*line, of_claim(claim, &keys)));
    }
    out
}

fn of_kind(item: &Item) -> Vec<String> {
    let missing = match item.kind {
        ItemKind::Figure if item.plots.is_empty() => "a figure has a [[plot]]",
        ItemKind::Table if item.table.is_none() => "a table has a [table]",
        _ => return Vec::new(),
    };
    vec![missing.to_owned()]
}

/// Keys of `each` that make no difference to the run.
fn of_template(run: &Template) -> Vec<String> {
    let values = [&run.modes.as_ref().map(|of| &of.speed), &run.strain_energy.as_ref().map(|of| &of.speed)];
    let speeds = values.into_iter().flatten().filter_map(|speed| speed.as_str());
    let against = run.against.iter().flatten();
    let texts: Vec<&str> =
        run.set.iter().chain(against).map(String::as_str).chain([run.case.as_str()]).chain(speeds).collect();
    let unused = run.each.keys().filter(|key| !texts.iter().any(|text| text.contains(&format!("{{{key}}}"))));
    unused
        .map(|key| {
            format!("run `{}`: `each` gives values of `{key}`, and nothing of the run is {{{key}}}", run.name)
        })
        .collect()
}

fn of_plot(plot: &Plot) -> Vec<String> {
    let mut out = Vec::new();
    if plot.runs.as_ref().is_some_and(Vec::is_empty) {
        out.push("`runs` is empty: without it all runs are drawn".to_owned());
    }
    if plot.x.is_some() {
        if plot.from.is_some() {
            out.push("`from` is a time, and the plot is not over time".to_owned());
        }
        if plot.to.is_some() != plot.compared.is_some() {
            out.push("`to` and `as` belong together in a plot over what is varied".to_owned());
        }
        out.extend(of_times(&plot.y, plot.compared));
        return out;
    }
    if plot.compared.is_some() {
        out.push("`as` compares values over what is varied, and this plot is over time".to_owned());
    }
    let to = plot.to.as_ref().map(|_| plot.end());
    match to {
        Some(None) => out.push("`to` of a plot over time is a number of seconds".to_owned()),
        _ => {
            let (from, to) = (plot.from.unwrap_or(f64::NEG_INFINITY), to.flatten().unwrap_or(f64::INFINITY));
            if !(from < to) {
                out.push(format!("from {from} s to {to} s there is no time"));
            }
        }
    }
    out
}

fn of_table(table: &Table) -> Vec<String> {
    let empty = |is: bool, what: &str| is.then(|| what.to_owned());
    let runs = empty(
        table.runs.as_ref().is_some_and(Vec::is_empty),
        "`runs` is empty: without it all runs have a row",
    );
    runs.into_iter().chain(empty(table.columns.is_empty(), "`columns` is empty")).collect()
}

fn of_claim(claim: &Claim, keys: &BTreeMap<String, Key>) -> Vec<String> {
    let mut out = Vec::new();
    of_rule(&claim.rule, &mut |of: &OfRun| out.extend(of_times(&of.quantity, of.compared)));
    out.dedup();
    out.extend(silent(claim));
    out.extend(constant(&claim.rule));
    out.extend(with_itself(&claim.rule, keys));
    out.extend(unfilled(claim));
    out.into_iter().map(|problem| format!("{}: {problem}", claim.text)).collect()
}

/// A claim with a sentence for what never comes out.
fn silent(claim: &Claim) -> Option<String> {
    if !matches!(claim.rule, Rule::Lost { .. }) {
        return None;
    }
    let sentences = [("holds", &claim.holds), ("fails", &claim.fails), ("undecided", &claim.undecided)];
    let said = sentences.iter().find(|(_, sentence)| sentence.is_some());
    said.map(|(key, _)| format!("its rule is `lost`, and `{key}` is never said"))
}

/// What is wrong with the times to which a difference of curves is restricted; those of quantities are judged with their names.
fn of_times(quantity: &str, compared: Option<As>) -> Option<String> {
    if compared == Some(As::CurveDifference) { window(quantity).err() } else { None }
}

/// A rule that no run decides.
fn constant(rule: &Rule) -> Option<String> {
    match rule {
        Rule::Lost { .. } => None,
        Rule::All { rules } | Rule::Any { rules } => rules.iter().find_map(constant),
        _ => {
            let mut runs = named_by(rule).len();
            of_rule(rule, &mut |_| runs += 1);
            (runs == 0)
                .then(|| "its rule has no quantity of a run, and says the same whatever comes out".to_owned())
        }
    }
}

/// A quantity of a run that a rule compares with itself, perhaps under another name.
fn with_itself(rule: &Rule, keys: &BTreeMap<String, Key>) -> Option<String> {
    let same = |a: &str, b: &str| a == b || keys.get(a).zip(keys.get(b)).is_some_and(|(a, b)| a == b);
    let same_term = |a: &OfRun, b: &OfRun| {
        let to = match (&a.to, &b.to) {
            (Some(a), Some(b)) => same(a, b),
            (a, b) => a == b,
        };
        to && a.compared == b.compared && a.quantity == b.quantity && same(&a.run, &b.run)
    };
    let said = |quantity: &str, a: &str, b: &str| {
        let named = if a == b { String::new() } else { format!(", which is `{b}` too,") };
        format!(
            "its rule compares {quantity} of `{a}`{named} with itself: name another run or another quantity"
        )
    };
    let mut found = None;
    of_rule(rule, &mut |of: &OfRun| {
        if let Some(to) = of.to.as_ref().filter(|to| same(&of.run, to)) {
            found = found.take().or_else(|| Some(said(&of.quantity, &of.run, to)));
        }
    });
    let pair = |a: &OfRun, b: &OfRun| same_term(a, b).then(|| said(&a.quantity, &a.run, &b.run));
    found.or_else(|| match rule {
        Rule::Less { left: Term::Of(left), right: Term::Of(right), .. } => pair(left, right),
        Rule::Grows { .. } | Rule::Falls { .. } => {
            terms(rule).windows(2).find_map(|two| pair(&two[0], &two[1]))
        }
        Rule::All { rules } | Rule::Any { rules } => rules.iter().find_map(|rule| with_itself(rule, keys)),
        _ => None,
    })
}

/// The words between braces of the sentences of a claim that its rule does not fill.
fn unfilled(claim: &Claim) -> Vec<String> {
    let known = placeholders(&claim.rule);
    let allowed = if known.is_empty() {
        "it has none".to_owned()
    } else {
        format!("it has {{{}}}", known.join("}, {"))
    };
    let words = |text: &String| -> Vec<String> {
        text.split('{').skip(1).map(|rest| rest.split('}').next().unwrap_or(rest).to_owned()).collect()
    };
    let sentences = [&claim.holds, &claim.fails, &claim.undecided].into_iter().flatten();
    let unknown = sentences.flat_map(words).filter(|word| !known.contains(word));
    let unknown = unknown.map(|word| format!("its rule gives no {{{word}}} for a sentence; {allowed}"));
    // These stand as they are.
    let plain = claim.because.iter().chain([&claim.text]).flat_map(words);
    unknown
        .chain(plain.map(|word| format!("{{{word}}} is filled in `holds`, `fails` and `undecided` only")))
        .collect()
}
