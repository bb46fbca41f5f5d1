//! What is wrong with the runs of a paper, found before any is computed: cases that cannot be read or are refused, names that are
//! none, units that do not go together.

use crate::compute::{Options, scale, times};
use crate::described::{As, Described, Item, OfRun, Rule, Term};
use crate::keep::Kept;
use crate::need::{Asks, Named, Need, asked, of_paper, runs};
use crate::paper::PaperError;
use crate::term::column;
use flexion_case::{Contents, Problem, Problems, Reading, parse_with, units};
use flexion_results::nearest;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// The units of what is asked of a run, by its names.
type Of = BTreeMap<String, String>;

/// Judges the runs that are computed of a paper; what is kept has been judged.
///
/// # Errors
/// Everything that is wrong, each with file and line.
pub fn sound(described: &Described, items: &[String], options: &Options) -> Result<(), PaperError> {
    let (needs, numbers) = of_paper(described);
    let kept = options.keep.as_ref().map(|folder| Kept::new(folder, &options.identity));
    let wanted = |number: &usize| {
        let asked = numbers.iter().any(|((item, _), of)| of == number && items.contains(item));
        asked && (options.long || needs[*number].run.seconds.is_none())
    };
    let order: Vec<usize> = (0..needs.len()).filter(wanted).collect();
    let none = String::new();
    let judged = |need: &Need| {
        let text = described.cases.get(&need.run.key.case).unwrap_or(&none);
        let before = kept.as_ref().and_then(|kept| kept.find(text, need));
        // A refusal was judged by what the paper asked then.
        let before = before.filter(|answer| need.run.refused || !answer.refused());
        before.map_or_else(
            || of_need(described, need),
            |answer| Sound { units: answer.units, times: answer.times, ..Sound::default() },
        )
    };
    let found: Mutex<BTreeMap<usize, Sound>> = Mutex::default();
    let next = AtomicUsize::new(0);
    let threads = std::thread::available_parallelism().map_or(1, std::num::NonZeroUsize::get);
    std::thread::scope(|scope| {
        for _ in 0..threads.min(order.len()) {
            scope.spawn(|| {
                while let Some(&number) = order.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let judged = judged(&needs[number]);
                    found.lock().unwrap_or_else(PoisonError::into_inner).insert(number, judged);
                }
            });
        }
    });
    let found = found.into_inner().unwrap_or_else(PoisonError::into_inner);
    let mut problems: Vec<String> = found.values().flat_map(|of| of.problems.clone()).collect();
    for (id, item) in described.items.iter().filter(|(id, _)| items.contains(id)) {
        let of = |run: &str| found.get(numbers.get(&(id.clone(), run.to_owned()))?);
        let unit = |run: &str, what: &str| of(run)?.units.get(what).cloned();
        let file = format!("{}/{id}.toml", described.place);
        problems.extend(crate::form::problems(&file, item));
        let (quantities, columns) = asked(item);
        for run in runs(item) {
            let (Some(judged), Some((line, ..))) = (of(&run.name), item.lines.runs.get(run.template)) else {
                continue;
            };
            // Another item may ask more of the same run.
            let own = |words: &str| {
                let asks = (run.name.clone(), words.to_owned());
                words == SPEED || quantities.contains(&asks) || columns.contains(&asks)
            };
            problems.extend(judged.wrong.iter().filter(|(words, _)| own(words)).map(|(words, why)| {
                format!("{file}:{}: run `{}`: {why}", item.lines.of(words).unwrap_or(*line), run.name)
            }));
        }
        problems.extend(of_units(&file, item, &unit));
        problems.extend(of_times(&file, item, &|run| of(run)?.times));
        problems.extend(of_records(&file, item, &|run| of(run)?.times));
    }
    // What is wrong with a line is wrong with each run that is made of it.
    let mut seen = Vec::new();
    problems.retain(|problem| {
        let new = !seen.contains(problem);
        seen.push(problem.clone());
        new
    });
    if problems.is_empty() { Ok(()) } else { Err(PaperError(problems)) }
}

/// What is known of a run before it is computed.
#[derive(Default)]
struct Sound {
    /// The units of what is asked of it.
    units: Of,
    /// When it ends, and the interval of its records \[s\].
    times: Option<[f64; 2]>,
    /// What is wrong with its case.
    problems: Vec<String>,
    /// What is wrong with which words that are asked of it.
    wrong: Vec<(String, String)>,
}

/// The key of a run that is wrong itself.
const SPEED: &str = "speed";

fn of_need(described: &Described, need: &Need) -> Sound {
    let Some((_, item)) = described.items.iter().find(|(id, _)| *id == need.item) else {
        return Default::default();
    };
    let file = format!("{}/{}.toml", described.place, need.item);
    let run = &need.run;
    let Some((line, set, against)) = item.lines.runs.get(run.template) else { return Default::default() };
    let case = format!("{}/cases/{}.toml", described.place, run.key.case);
    let text = described.cases.get(&run.key.case).cloned().unwrap_or_default();
    let told = |found: &Problems, own: &[usize], before: usize| -> Vec<String> {
        let place = |problem: &Problem| match problem.place.as_ref() {
            Some(place) if place.source > before => {
                format!("{file}:{}", own.get(place.source - before - 1).unwrap_or(line))
            }
            Some(place) if place.source > 0 => format!("{file}:{line}"),
            _ => {
                found.line_and_column(problem).map_or_else(|| case.clone(), |(at, _)| format!("{case}:{at}"))
            }
        };
        let say = |problem: &Problem| {
            let key = if problem.key.is_empty() { String::new() } else { format!("{}: ", problem.key) };
            let more: Vec<&str> = std::iter::once(problem.label.as_str())
                .chain(problem.help.iter().map(String::as_str))
                .filter(|text| !text.is_empty())
                .collect();
            let more = if more.is_empty() { String::new() } else { format!("; {}", more.join("; ")) };
            let allowed = if found.misread || problem.place.is_none() {
                ""
            } else {
                "; where a refusal is what is asked, the run says `refused = true`"
            };
            format!("{}: {key}{}{more}{allowed}", place(problem), problem.message)
        };
        found.list.iter().map(say).collect()
    };
    let meant = |problems: &Problems| run.refused && !problems.misread;
    let mut problems = Vec::new();
    let reading = match parse_with(text, Path::new(&case), &run.key.set, &Contents::new()) {
        Ok(reading) => reading,
        Err(found) if meant(&found) => return Default::default(),
        Err(found) => return Sound { problems: told(&found, set, 0), ..Sound::default() },
    };
    if let Some(Err(found)) = run.key.against.as_ref().map(|changes| reading.with(changes))
        && !meant(&found)
    {
        problems.extend(told(&found, against, run.key.set.len()));
    }
    let (units, wrong) = match &run.key.asks {
        Asks::Run => match in_time(&reading, need) {
            Ok(found) => found,
            Err(found) if meant(&found) => Default::default(),
            Err(found) => {
                problems.extend(told(&found, set, 0));
                Default::default()
            }
        },
        Asks::Modes(_) | Asks::Energy(_) => of_frequencies(run, need),
    };
    Sound { units, times: times(&reading, need), problems, wrong }
}

/// Units, and what is wrong with which words.
type Judged = (Of, Vec<(String, String)>);

fn in_time(reading: &Reading, need: &Need) -> Result<Judged, Problems> {
    let mut prepared = reading.prepare()?.without_pictures();
    let (mut units, mut wrong) = (Of::new(), Vec::new());
    for name in &need.quantities {
        match prepared.quantities(std::slice::from_ref(name)).map(|mut read| (read.pop(), read.is_empty())) {
            Ok((Some(quantity), true)) => drop(units.insert(name.clone(), quantity.unit)),
            Ok(_) => wrong.push((
                name.clone(),
                format!("{name} is several quantities: add `.min`, `.max` or `.final`"),
            )),
            Err(error) => wrong.push((name.clone(), error.to_string())),
        }
    }
    let channels = prepared.channels();
    for name in &need.columns {
        match channels.iter().find(|channel| channel.name == *name) {
            Some(channel) => drop(units.insert(name.clone(), channel.unit.to_string())),
            None => {
                let nearest = nearest(name, channels.iter().map(|channel| channel.name.as_str()));
                let nearest = nearest.map_or(String::new(), |name| format!("; perhaps `{name}`"));
                wrong.push((name.clone(), format!("there is no column `{name}`{nearest}")));
            }
        }
    }
    Ok((units, wrong))
}

fn of_frequencies(run: &Named, need: &Need) -> Judged {
    let modes = run.modes.as_ref().map(|of| (of.unit.as_ref(), &of.speed, of.count));
    let energy = run.energy.as_ref().map(|of| (of.unit.as_ref(), &of.speed, of.count));
    let Some((unit, speed, count)) = modes.or(energy) else { return Default::default() };
    let (mut units, mut wrong) = (Of::new(), Vec::new());
    if let Err(why) = scale(unit, speed) {
        wrong.push((SPEED.to_owned(), why));
    }
    let of = if unit.is_some() { "" } else { "rad/s" };
    for name in &need.quantities {
        let number = name.strip_prefix("frequency-").and_then(|number| number.parse::<usize>().ok());
        if number.is_some_and(|number| (1..=count).contains(&number)) {
            units.insert(name.clone(), of.to_owned());
        } else {
            wrong.push((
                name.clone(),
                format!("there is no quantity `{name}`; there are frequency-1 to frequency-{count}"),
            ));
        }
    }
    let none = |name: &String| (name.clone(), format!("frequencies have no column `{name}` over time"));
    wrong.extend(need.columns.iter().map(none));
    (units, wrong)
}

/// What is wrong with the units of an item, where they are known.
fn of_units(file: &str, item: &Item, unit: &dyn Fn(&str, &str) -> Option<String>) -> Vec<String> {
    let mut out = Vec::new();
    for (claim, line) in item.claims.iter().zip(&item.lines.claims) {
        let mut wrong = Vec::new();
        of_rule(&claim.rule, unit, &mut wrong);
        out.extend(wrong.into_iter().map(|why| format!("{file}:{line}: {why}")));
    }
    for (column, line) in item.table.iter().flat_map(|table| &table.columns).zip(&item.lines.columns) {
        let known = item.table.iter().flat_map(|table| crate::need::named(item, table.runs.as_ref()));
        let known = known.filter_map(|run| unit(&run, &column.quantity)).next();
        let own = match column.compared {
            None | Some(As::Difference) => known,
            Some(_) => Some(String::new()),
        };
        if let (Some(wanted), Some(own)) = (&column.unit, own)
            && *wanted != own
            && let Err(error) = units::parse_in(&format!("1 {wanted}"), &own)
        {
            out.push(format!("{file}:{line}: {}: {}", column.title, error.message));
        }
    }
    out
}

/// The times of an item that lie before the start or behind the end of a run, and those of quantities at which it has no record.
fn of_times(file: &str, item: &Item, times: &dyn Fn(&str) -> Option<[f64; 2]>) -> Vec<String> {
    let wrong = |what: &str, run: &str, time: f64, at_records: bool| {
        let [end, step] = times(run)?;
        let asks = format!("{what} asks for t = {time} s of `{run}`");
        let off = (time / step - (time / step).round()).abs() * step;
        if time < 0.0 {
            Some(format!("{asks}, which begins at 0 s"))
        } else if time > end * (1.0 + 1e-9) {
            Some(format!(
                "{asks}, which ends at {end} s: ask for times until then, or make `run.duration` longer"
            ))
        } else if at_records && off > 1e-6 * step && (time - end).abs() > 1e-6 * step {
            Some(format!(
                "{asks}, which has no record there, but every {step} s: ask for such a time, or set `output.step`"
            ))
        } else {
            None
        }
    };
    let mut out = Vec::new();
    let mut say = |line: usize, found: Option<String>| {
        out.extend(found.map(|why| format!("{file}:{line}: {why}")));
    };
    for (claim, line) in item.claims.iter().zip(&item.lines.claims) {
        crate::need::of_rule(&claim.rule, &mut |of: &OfRun| {
            let curve = of.compared == Some(As::CurveDifference);
            for time in restricted(&of.quantity) {
                let mut runs = std::iter::once(&of.run).chain(&of.to);
                say(*line, runs.find_map(|run| wrong(&of.quantity, run, time, !curve)));
            }
        });
    }
    for (column, line) in item.table.iter().flat_map(|table| &table.columns).zip(&item.lines.columns) {
        let curve = column.compared == Some(As::CurveDifference);
        for time in restricted(&column.quantity) {
            let mut runs = item.table.iter().flat_map(|table| crate::need::named(item, table.runs.as_ref()));
            say(*line, runs.find_map(|run| wrong(&column.quantity, &run, time, !curve)));
        }
    }
    for (plot, line) in item.plots.iter().zip(&item.lines.plots) {
        let over_time =
            |(key, time): (&str, Option<f64>)| Some((format!("`{key}` of the plot of {}", plot.y), time?));
        let all: Vec<(String, f64)> = match plot.x {
            Some(_) => restricted(&plot.y).into_iter().map(|time| (plot.y.clone(), time)).collect(),
            None => [("from", plot.from), ("to", plot.end())].into_iter().filter_map(over_time).collect(),
        };
        let curve = plot.x.is_none() || plot.compared == Some(As::CurveDifference);
        for (what, time) in all {
            let mut runs = crate::need::named(item, plot.runs.as_ref()).into_iter();
            say(*line, runs.find_map(|run| wrong(&what, &run, time, !curve)));
        }
    }
    out
}

/// Times the interval of records by which those of a curve that is compared may be apart.
const SPARSER: f64 = 10.0 + 1e-6;

/// Curves that are compared and have records at other times, or few in common.
fn of_records(file: &str, item: &Item, times: &dyn Fn(&str) -> Option<[f64; 2]>) -> Vec<String> {
    let mut out = Vec::new();
    for of in crate::need::terms(item).iter().filter(|of| of.compared == Some(As::CurveDifference)) {
        let Some(to) = &of.to else { continue };
        if let Some(([_, a], [_, b])) = times(&of.run).zip(times(to))
            && let ratio = a.max(b) / a.min(b)
            && (ratio > SPARSER || (ratio - ratio.round()).abs() > 1e-6)
        {
            let line = item.lines.of(&of.quantity).unwrap_or(1);
            out.push(format!(
                "{file}:{line}: {} of `{}`, with records every {a} s, is compared with that of `{to}`, with records every {b} s: give both one `output.step`",
                of.quantity, of.run
            ));
        }
    }
    out
}

/// The times \[s\] to which a quantity or a column is restricted; what is no time is judged with its name.
fn restricted(quantity: &str) -> Vec<f64> {
    let Some((_, times)) = quantity.split_once('@') else { return Vec::new() };
    let times = times.split("..").filter_map(|time| time.trim().parse::<f64>().ok());
    times.filter(|time| time.is_finite()).collect()
}

/// The unit of a term, where it is known; `None` for a number, which has any.
fn of_term(
    of: &OfRun,
    unit: &dyn Fn(&str, &str) -> Option<String>,
    wrong: &mut Vec<String>,
) -> Option<String> {
    let what = if of.compared == Some(As::CurveDifference) { column(&of.quantity) } else { &of.quantity };
    let own = unit(&of.run, what);
    let (Some(to), Some(compared)) = (&of.to, of.compared) else { return own };
    if let (Some(own), Some(other)) = (&own, unit(to, what))
        && *own != other
    {
        wrong.push(format!("{what} is in {} of `{}` and in {} of `{to}`", said(own), of.run, said(&other)));
    }
    if compared == As::Difference { own } else { Some(String::new()) }
}

fn said(unit: &str) -> String {
    if unit.is_empty() { "pure numbers".to_owned() } else { format!("`{unit}`") }
}

fn of_rule(rule: &Rule, unit: &dyn Fn(&str, &str) -> Option<String>, wrong: &mut Vec<String>) {
    let mut all: Vec<(String, String)> = Vec::new();
    let mut take = |of: &OfRun| {
        if let Some(unit) = of_term(of, unit, wrong) {
            all.push((format!("{} of `{}`", of.quantity, of.run), unit));
        }
    };
    match rule {
        Rule::Less { left, right, .. } => {
            for term in [left, right] {
                if let Term::Of(of) = term {
                    take(of);
                }
            }
        }
        Rule::Within { of, .. } => {
            if let Term::Of(of) = of {
                take(of);
            }
        }
        Rule::Agree { .. } | Rule::Grows { .. } | Rule::Falls { .. } => {
            crate::rule::terms(rule).iter().for_each(take);
        }
        Rule::All { rules } | Rule::Any { rules } => {
            return rules.iter().for_each(|rule| of_rule(rule, unit, wrong));
        }
        Rule::EndsEarly { .. } | Rule::Finishes { .. } | Rule::Lost { .. } => {}
    }
    if let Some((first, of)) = all.first()
        && let Some((other, differs)) = all.iter().find(|(_, unit)| unit != of)
    {
        wrong.push(format!(
            "the rule compares {first}, in {}, with {other}, in {}: what is compared has one unit",
            said(of),
            said(differs)
        ));
    }
}
