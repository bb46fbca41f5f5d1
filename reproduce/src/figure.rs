//! Figures: the curves of runs over time, or quantities over what is varied, with the bands of their errors.

use crate::answer::Curve;
use crate::described::{As, Item, OfRun, Plot};
use crate::need::{Named, plain, runs};
use crate::term::{Answers, Number, answer, of_run};
use flexion_results::plot::{Axis, Figure, Marker, Panel, Series, Words};

/// The figure of an item, where it has one.
pub fn figure(item: &Item, answers: &Answers<'_>) -> Option<Figure> {
    let panels: Vec<Panel> = item
        .plots
        .iter()
        .map(|plot| panel(item, plot, answers))
        .filter(|panel| !panel.series.is_empty())
        .collect();
    let drawn = !panels.is_empty();
    let columns = if panels.len() > 1 { 2 } else { 1 };
    drawn.then_some(Figure { title: None, columns, panels, share_x: false })
}

/// A curve of an item, for a table: the run, the column, its values.
pub struct Drawn<'a> {
    /// Name of the run.
    pub run: String,
    /// Name of the column.
    pub column: &'a str,
    /// The column.
    pub curve: &'a Curve,
}

/// The curves over time that an item draws.
pub fn curves<'a>(item: &'a Item, answers: &Answers<'a>) -> Vec<Drawn<'a>> {
    let mut out: Vec<Drawn<'a>> = Vec::new();
    for plot in item.plots.iter().filter(|plot| plot.x.is_none()) {
        for run in of_plot(item, plot) {
            let curve = answer(answers, &run.name).ok().and_then(|answer| answer.curve(&plot.y).ok());
            let twice = out.iter().any(|drawn| drawn.run == run.name && drawn.column == plot.y);
            out.extend(curve.filter(|_| !twice).map(|curve| Drawn { run: run.name, column: &plot.y, curve }));
        }
    }
    out
}

/// The values over what is varied that an item draws: the run, what it is of, the value.
pub fn points(item: &Item, plot: &Plot, answers: &Answers<'_>) -> Vec<(Named, Result<Number, String>)> {
    let to = plot.to.as_ref().filter(|_| plot.compared.is_some()).map(plain);
    let value = |run: Named| {
        let of = OfRun {
            run: run.name.clone(),
            quantity: plot.y.clone(),
            to: to.as_ref().map(|to| crate::need::filled(to, &run.of)),
            compared: plot.compared,
        };
        let number = of_run(&of, answers).map_err(|missing| format!("{missing:?}"));
        (run, number)
    };
    of_plot(item, plot).into_iter().map(value).collect()
}

fn of_plot(item: &Item, plot: &Plot) -> Vec<Named> {
    let wanted = |run: &Named| plot.runs.as_ref().is_none_or(|names| names.contains(&run.name));
    let mut all: Vec<Named> = runs(item).into_iter().filter(wanted).collect();
    if let Some(names) = &plot.runs {
        all.sort_by_key(|run| names.iter().position(|name| *name == run.name));
    }
    all
}

fn panel(item: &Item, plot: &Plot, answers: &Answers<'_>) -> Panel {
    let mut panel = match &plot.x {
        None => over_time(item, plot, answers),
        Some(x) => over(item, plot, x, answers),
    };
    if let Some(label) = &plot.label {
        // A label may have its unit in it.
        match label.strip_suffix(']').and_then(|label| label.rsplit_once(" [")) {
            Some((quantity, unit)) => {
                (panel.y.quantity, panel.y.unit) = (quantity.to_owned(), unit.to_owned())
            }
            None => panel.y.quantity.clone_from(label),
        }
    }
    if plot.log {
        panel.y.scale = flexion_results::plot::Scale::Logarithmic;
    }
    panel.words.extend(plot.title.as_ref().map(|title| Words {
        text: unlettered(title).to_owned(),
        outside: true,
        ..Words::default()
    }));
    shorten(&mut panel);
    panel
}

/// The endings of quantities in words.
const ENDINGS: [(&str, &str); 15] = [
    (".time-of-min", "time of the smallest"),
    (".time-of-max", "time of the largest"),
    (".root-mean-square", "root mean square"),
    (".mean", "mean"),
    (".min", "smallest"),
    (".max", "largest"),
    (".final", "last"),
    (".amplitude", "amplitude"),
    (".middle", "middle"),
    (".largest", "largest absolute"),
    (".at", "at the time"),
    (".first-touch", "first touch"),
    (".impulse", "impulse"),
    (".impacts", "impacts"),
    (".loss", "energy lost in impacts"),
];

/// A quantity in words: `Tip deflection, amplitude, 15 to 20 s`.
pub fn in_words(quantity: &str) -> String {
    let (name, times) =
        quantity.split_once('@').map_or((quantity, None), |(name, times)| (name, Some(times)));
    let ending = ENDINGS.iter().find_map(|(end, words)| Some((name.strip_suffix(end)?, *words)));
    let (name, ending) = ending.map_or((name, String::new()), |(name, words)| (name, format!(", {words}")));
    let named =
        if name.is_empty() { String::new() } else { Axis::of_column(&name.replace('-', " "), "").quantity };
    let times = times.map_or(String::new(), |times| match times.split_once("..") {
        Some(("", to)) => format!(", until {to} s"),
        Some((from, "")) => format!(", from {from} s on"),
        Some((from, to)) => format!(", {from} to {to} s"),
        None => format!(", {times} s"),
    });
    format!("{named}{ending}{times}")
}

/// Takes what all names of a panel have in common from them, and into its heading where it does not stand there.
fn shorten(panel: &mut Panel) {
    let names: Vec<Vec<String>> = panel
        .series
        .iter()
        .filter_map(|series| series.name.as_ref())
        .map(|name| name.split(", ").map(str::to_owned).collect())
        .collect();
    let Some(first) = names.first().filter(|_| names.len() > 1) else { return };
    let common: Vec<String> =
        first.iter().filter(|part| names.iter().all(|name| name.contains(part))).cloned().collect();
    if common.is_empty() || names.iter().any(|name| name.len() <= common.len()) {
        return;
    }
    for (series, name) in panel.series.iter_mut().filter(|series| series.name.is_some()).zip(&names) {
        let own: Vec<&str> = name.iter().filter(|part| !common.contains(part)).map(String::as_str).collect();
        series.name = Some(own.join(", "));
    }
    match panel.words.first_mut() {
        Some(heading) => {
            let missing: Vec<&str> = common
                .iter()
                .map(String::as_str)
                .filter(|part| !heading.text.split(", ").any(|there| there == *part))
                .collect();
            if !missing.is_empty() {
                heading.text = format!("{}, {}", heading.text, missing.join(", "));
            }
        }
        None => panel.words.push(Words { text: common.join(", "), outside: true, ..Words::default() }),
    }
}

fn over_time(item: &Item, plot: &Plot, answers: &Answers<'_>) -> Panel {
    let mut panel = Panel { x: Axis::time(), ..Panel::default() };
    let (from, to) = (plot.from.unwrap_or(f64::NEG_INFINITY), plot.end().unwrap_or(f64::INFINITY));
    for run in of_plot(item, plot) {
        let Ok(curve) = answer(answers, &run.name)
            .and_then(|answer| answer.curve(&plot.y).map_err(crate::term::Missing::Because))
        else {
            continue;
        };
        panel.y = Axis::of_column(&plot.y, &curve.unit);
        let inside: Vec<usize> = (0..curve.t.len()).filter(|i| (from..=to).contains(&curve.t[*i])).collect();
        let points = inside.iter().map(|i| (curve.t[*i], curve.y[*i])).collect();
        // A run without an error has no band.
        let band = inside.iter().map(|i| curve.off.get(*i).copied().unwrap_or(f64::NAN)).collect();
        let number = panel.series.len();
        panel.series.push(Series { band, ..Series::line(Some(&run.name), points).numbered(number) });
    }
    panel
}

/// The name of a curve, its points, and their errors.
type Group = (String, Vec<(f64, f64)>, Vec<f64>);

fn over(item: &Item, plot: &Plot, x: &str, answers: &Answers<'_>) -> Panel {
    let mut panel = Panel { x: Axis::new(x, ""), ..Panel::default() };
    let mut groups: Vec<Group> = Vec::new();
    let mut unit = String::new();
    for (run, number) in points(item, plot, answers) {
        let Some(at) = run.of.get(x).and_then(value_of) else { continue };
        let (mut name, label) = without(&run, x);
        (panel.x.quantity, panel.x.unit) =
            label.unwrap_or_else(|| (capitalised(&x.replace(['-', '_'], " ")), String::new()));
        if name.is_empty() {
            let others = run.of.iter().filter(|(key, _)| *key != x);
            name = others.map(|(_, value)| plain(value)).collect::<Vec<_>>().join(", ");
        }
        let Ok(number) = number else { continue };
        let factor = if number.part { 100.0 } else { 1.0 };
        unit = if number.part { "%".to_owned() } else { crate::shown::unit_shown(&number.unit) };
        let group = match groups.iter().position(|(group, ..)| *group == name) {
            Some(group) => group,
            None => {
                groups.push((name, Vec::new(), Vec::new()));
                groups.len() - 1
            }
        };
        groups[group].1.push((at, factor * number.value));
        groups[group].2.push(number.error.map_or(f64::NAN, |error| factor * error));
    }
    let words = in_words(&plot.y);
    let quantity = match plot.compared {
        Some(As::RelativeDifference | As::CurveDifference) => format!("{words}, difference"),
        Some(As::Ratio) => format!("{words}, ratio"),
        _ => words,
    };
    panel.y = Axis::new(quantity, unit);
    let alone = groups.len() == 1;
    for (number, (name, points, band)) in groups.into_iter().enumerate() {
        let name = (!alone).then_some(name);
        let line = Series::line(name.as_deref(), points).numbered(number);
        panel.series.push(Series { band, marker: Some(Marker::Circle), ..line });
    }
    panel
}

/// The parts of the name of a run without that which names the value of `x`, which is given apart with its unit: of `Ω = {x} rad/s`, Ω and rad/s.
fn without(run: &Named, x: &str) -> (String, Option<(String, String)>) {
    let key = format!("{{{x}}}");
    let (with, others): (Vec<&str>, Vec<&str>) =
        run.pattern.split(", ").partition(|part| part.contains(&key));
    let label = with.first().and_then(|part| part.split_once(&key)).and_then(|(before, behind)| {
        let (quantity, unit) = (before.trim_matches([' ', '=']), behind.trim());
        // `{n} modes` is a number of modes.
        let label = if quantity.is_empty() { (unit, "") } else { (quantity, unit) };
        (!label.0.is_empty()).then(|| (label.0.to_owned(), label.1.to_owned()))
    });
    (crate::need::filled(&others.join(", "), &run.of), label)
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

fn value_of(value: &toml::Value) -> Option<f64> {
    match value {
        toml::Value::Integer(number) => Some(*number as f64),
        toml::Value::Float(number) => Some(*number),
        toml::Value::String(text) => text.split_whitespace().next()?.parse().ok(),
        _ => None,
    }
}

/// A title without its letter: panels have one.
fn unlettered(title: &str) -> &str {
    let rest = title.strip_prefix('(').and_then(|rest| rest.split_once(')'));
    rest.filter(|(letter, _)| letter.len() == 1).map_or(title, |(_, rest)| rest.trim_start())
}
