//! Reads the inputs of a sweep: what each key takes, its values in SI, and all that is wrong, before anything runs.

use super::distribution::{self, Distribution, SHAPE};
use super::inputs::{Cell, Inputs, Table};
use super::points::Levels;
use super::written::{self, Written, bare, number_end};
use crate::declaration::Type;
use crate::problem::{Place, Problem, Problems, Source};
use crate::reading::Reading;
use crate::units::{self, Measure};
use crate::values::{Filled, Value};

/// Rows that are read to find out what the keys take.
const TRIED: usize = 8;
/// Different texts of a key that are read.
const MOST_TEXTS: usize = 1000;
/// Problems with values that are looked for.
const MOST_PROBLEMS: usize = 60;

/// An input of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// Its dotted key, as it was written.
    pub key: String,
    /// The unit of its numbers; empty for a pure number, and for texts.
    pub unit: String,
    /// What it takes.
    pub(super) takes: Takes,
}

/// What a key takes, as far as a sweep tells apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Takes {
    Quantity(&'static Measure),
    Number,
    Integer,
    /// What is written as of `--set`.
    Text,
}

impl Takes {
    fn of(filled: &Filled) -> Takes {
        match filled.key.takes {
            Type::Quantity(measure, _) | Type::Moment(measure) => Takes::Quantity(measure),
            Type::Number(_) => Takes::Number,
            Type::Integer(..) => Takes::Integer,
            _ => Takes::Text,
        }
    }

    fn unit(self) -> String {
        if let Takes::Quantity(measure) = self { measure.unit.to_string() } else { String::new() }
    }

    /// The number of a text, if it is one as a matter of course.
    fn number(self, text: &str) -> Option<f64> {
        let x = match self {
            Takes::Text => return None,
            Takes::Integer => text.parse::<i64>().ok()? as f64,
            Takes::Number => text.parse().ok()?,
            Takes::Quantity(measure) => {
                let bare = bare(text);
                bare.parse().ok().or_else(|| units::parse(&bare, measure).ok())?
            }
        };
        x.is_finite().then_some(x)
    }
}

/// The values of a key as they are written.
enum Asked<'a> {
    Written(Written),
    /// A column of a table.
    Column(&'a Table, usize),
}

impl Asked<'_> {
    /// How many texts there are.
    fn count(&self) -> usize {
        match self {
            Asked::Written(Written::Values(list) | Written::Distribution(_, list)) => list.len(),
            Asked::Written(Written::Range(ends, _)) => ends.len(),
            Asked::Column(table, _) => table.rows.len(),
        }
    }

    /// A text, as of `--set`.
    fn text(&self, index: usize) -> String {
        match self {
            Asked::Written(Written::Values(list) | Written::Distribution(_, list)) => {
                list.get(index).cloned()
            }
            Asked::Written(Written::Range(ends, _)) => ends.get(index).cloned(),
            Asked::Column(table, number) => table.rows.get(index).map(|row| row[*number].text()),
        }
        .unwrap_or_default()
    }
}

/// The reader of the inputs of a sweep.
struct Reader<'a> {
    reading: &'a Reading,
    inputs: &'a Inputs,
    asked: Vec<(String, Asked<'a>)>,
    problems: Problems,
}

/// The inputs with their levels.
///
/// # Errors
/// All that is wrong with them.
pub(super) fn read(reading: &Reading, inputs: &Inputs) -> Result<Vec<(Input, Levels)>, Problems> {
    let problems = Problems { sources: reading.sources().to_vec(), ..Problems::default() };
    let mut reader = Reader { reading, inputs, asked: Vec::new(), problems };
    reader.collect();
    let takes = reader.takes();
    let mut out = Vec::new();
    for (number, takes) in takes.into_iter().enumerate() {
        // Of a key with a problem nothing more is known.
        let Some(takes) = takes else { continue };
        if let Some(levels) = reader.levels(number, takes) {
            let key = reader.asked[number].0.clone();
            out.push((Input { key, unit: takes.unit(), takes }, levels));
        }
    }
    let said = reader.problems;
    if said.list.is_empty() { Ok(out) } else { Err(said) }
}

/// The order in which the values of keys are laid over a case: tables before keys in them.
pub(super) fn order<'k>(keys: impl Iterator<Item = &'k str>) -> Vec<usize> {
    let mut order: Vec<(usize, usize)> =
        keys.enumerate().map(|(number, key)| (key.matches('.').count(), number)).collect();
    order.sort_unstable();
    order.into_iter().map(|(_, number)| number).collect()
}

impl<'a> Reader<'a> {
    /// Notes a problem with a text of the command line.
    fn refuse(&mut self, name: &str, text: String, message: String, help: Option<String>) {
        let place = Place::new(self.problems.sources.len(), 0..text.len());
        self.problems.sources.push(Source { name: name.to_owned(), text });
        let mut problem = Problem::new("", Some(place), message);
        problem.help.extend(help);
        self.problems.push(problem);
    }

    /// Notes a problem of the sweep as a whole.
    fn refuse_all(&mut self, message: &str) {
        self.problems.push(Problem::new("", None, message));
    }

    /// Takes up what is written.
    fn collect(&mut self) {
        let inputs = self.inputs;
        for argument in &inputs.vary {
            match written::read(argument) {
                Ok((key, values)) => {
                    let sampled = inputs.sample.is_some();
                    let wrong = match &values {
                        Written::Range(_, Some(_)) if sampled => {
                            Some("a range that is sampled is FIRST:LAST, without a number of values")
                        }
                        Written::Range(_, None) if !sampled => {
                            Some("a range is FIRST:LAST:COUNT where nothing is sampled")
                        }
                        Written::Distribution(..) if !sampled => {
                            Some("a distribution is sampled: add `--sample lhs --runs 100`")
                        }
                        _ => None,
                    };
                    if let Some(wrong) = wrong {
                        self.refuse("--vary", argument.clone(), wrong.to_owned(), None);
                    }
                    self.ask(key, Asked::Written(values), argument);
                }
                Err((message, help)) => self.refuse("--vary", argument.clone(), message, Some(help)),
            }
        }
        match &inputs.table {
            Some(_) if !inputs.vary.is_empty() => {
                self.refuse_all("a table holds all inputs of its runs: give `--table` or `--vary`, not both");
            }
            Some(_) if inputs.sample.is_some() => {
                self.refuse_all(
                    "the rows of a table are run as they are: give `--table` or `--sample`, not both",
                );
            }
            Some(table) => {
                for (number, key) in table.keys.iter().enumerate() {
                    self.ask(key.clone(), Asked::Column(table, number), key);
                }
                if table.rows.iter().any(|row| row.len() != table.keys.len()) {
                    self.refuse_all("a row of the table has not as many values as there are keys");
                    self.asked.clear();
                }
            }
            None if inputs.vary.is_empty() => {
                self.refuse_all("nothing is varied: give `--vary KEY=VALUES` or `--table FILE`");
            }
            None => {}
        }
    }

    fn ask(&mut self, key: String, asked: Asked<'a>, argument: &str) {
        if self.asked.iter().any(|(other, _)| *other == key) {
            self.refuse(self.name(), argument.to_owned(), format!("the key `{key}` is varied twice"), None);
        } else {
            self.asked.push((key, asked));
        }
    }

    /// What the inputs are called in messages.
    fn name(&self) -> &'a str {
        self.inputs.table.as_ref().map_or("--vary", |table| table.name.as_str())
    }

    /// Changes of the case: for each key the text of a number, or the last.
    fn changes(&self, index: impl Fn(usize) -> usize) -> Vec<String> {
        let change = |number: usize| {
            let (key, asked) = &self.asked[number];
            // The parameters of a distribution are no values of their key, but for the first.
            let index = if let Asked::Written(Written::Distribution(..)) = asked { 0 } else { index(number) };
            format!("{key}={}", asked.text(index.min(asked.count().saturating_sub(1))))
        };
        order(self.asked.iter().map(|(key, _)| key.as_str())).into_iter().map(change).collect()
    }

    /// What each key takes, where that is known: of the first of some rows that can be read.
    fn takes(&mut self) -> Vec<Option<Takes>> {
        let longest = self.asked.iter().map(|(_, asked)| asked.count()).max().unwrap_or(0);
        let mut rows: Vec<usize> = (0..TRIED).map(|k| k * longest / TRIED).collect();
        rows.dedup();
        let mut first = None;
        for row in rows {
            match self.reading.with(&self.changes(|_| row)) {
                Ok(read) => return self.found(&read),
                Err(problems) => {
                    first.get_or_insert(problems);
                }
            }
        }
        if let Some(problems) = first {
            self.merge(problems, 0);
        }
        vec![None; self.asked.len()]
    }

    /// What each key takes in a case in which all are set.
    fn found(&mut self, read: &Reading) -> Vec<Option<Takes>> {
        let before = self.reading.sources().len();
        let order = order(self.asked.iter().map(|(key, _)| key.as_str()));
        let mut out = vec![None; self.asked.len()];
        for (place, number) in order.into_iter().enumerate() {
            let key = self.asked[number].0.clone();
            let name = key.rsplit('.').next().unwrap_or(&key).trim();
            let filled = read.set_by(before + place, name);
            // Of a vector a sweep knows no more than its text.
            let asked = &self.asked[number].1;
            let is_list = (0..asked.count()).any(|index| asked.text(index).starts_with('['));
            out[number] = filled.map(|filled| if is_list { Takes::Text } else { Takes::of(filled) });
            if filled.is_none() {
                // A table of a list by its number, or a key that another one has set again.
                let again = (0..read.sources().len() - before).any(|other| {
                    other > place
                        && read.sources().get(before + other).is_some_and(|s| same_end(&s.text, &key))
                });
                if again {
                    let message = format!("the key `{key}` is varied twice");
                    self.refuse(self.name(), key, message, None);
                } else {
                    out[number] = Some(Takes::Text);
                }
            }
        }
        out
    }

    /// The problems of a row as those of the sweep.
    fn merge(&mut self, of: Problems, row: usize) {
        let before = self.reading.sources().len();
        let start = self.problems.sources.len();
        let name = match &self.inputs.table {
            Some(table) => format!("{}, row {}", table.name, row + 1),
            None => "--vary".to_owned(),
        };
        let further = of.sources.into_iter().skip(before);
        self.problems.sources.extend(further.map(|source| Source { name: name.clone(), ..source }));
        for mut problem in of.list {
            if let Some(place) = problem.place.as_mut().filter(|place| place.source >= before) {
                place.source = place.source - before + start;
            }
            let shown = |other: &Problem| (&other.key, &other.message) == (&problem.key, &problem.message);
            if !self.problems.list.iter().any(shown) {
                self.problems.push(problem);
            }
        }
    }

    /// The number of a text of a key, or `None` with its problems noted.
    fn number(&mut self, number: usize, index: usize, takes: Takes) -> Option<f64> {
        if let (_, Asked::Column(table, column)) = &self.asked[number]
            && let Some(Cell::Number(x)) = table.rows.get(index).and_then(|row| row.get(*column))
            && takes != Takes::Integer
        {
            return Some(*x);
        }
        let text = self.asked[number].1.text(index);
        let found = takes.number(&text);
        if found.is_some() || self.problems.list.len() > MOST_PROBLEMS {
            return found;
        }
        // As of `--set`.
        let mut changes =
            self.changes(|other| if other == number || self.inputs.table.is_some() { index } else { 0 });
        if let (key, Asked::Written(Written::Distribution(..))) = &self.asked[number] {
            changes = vec![format!("{key}={text}")];
        }
        let key = &self.asked[number].0;
        let place = changes.iter().position(|change| change.split('=').next() == Some(key.as_str()));
        match self.reading.with(&changes) {
            Ok(read) => {
                let name = key.rsplit('.').next().unwrap_or(key).trim();
                let source = self.reading.sources().len() + place.unwrap_or(0);
                match read.set_by(source, name).map(|filled| &filled.value) {
                    Some(Value::Number(x)) => Some(*x),
                    Some(Value::Integer(n)) => Some(*n as f64),
                    Some(Value::Numbers(list)) if list.len() == 1 => list.first().copied(),
                    _ => {
                        let message = format!("`{text}` is not the number that the key takes in other rows");
                        self.refuse(self.name(), format!("{key}={text}"), message, None);
                        None
                    }
                }
            }
            Err(problems) => {
                self.merge(problems, index);
                None
            }
        }
    }

    /// The levels of a key.
    fn levels(&mut self, number: usize, takes: Takes) -> Option<Levels> {
        let key = self.asked[number].0.clone();
        let count = self.asked[number].1.count();
        let texts: Vec<String> = (0..count).map(|index| self.asked[number].1.text(index)).collect();
        let values = match &self.asked[number].1 {
            Asked::Written(Written::Range(_, count)) => Some((None, *count)),
            Asked::Written(Written::Distribution(name, _)) => Some((Some(name.clone()), None)),
            _ => None,
        };
        let argument = || format!("{key}={}", texts.join(", "));
        let Some((distribution, steps)) = values else {
            if takes == Takes::Text {
                return self.texts(number, texts);
            }
            self.one_unit(takes, &argument, &texts)?;
            let numbers: Vec<Option<f64>> =
                (0..count).map(|index| self.number(number, index, takes)).collect();
            return numbers.into_iter().collect::<Option<_>>().map(Levels::Numbers);
        };
        if takes == Takes::Text || (takes == Takes::Integer && distribution.is_some()) {
            let what =
                if distribution.is_some() { "a distribution is of numbers" } else { "a range is of numbers" };
            let message = format!("{what}, and `{key}` takes other values: write a list A, B, C");
            self.refuse(self.name(), argument(), message, None);
            return None;
        }
        match distribution {
            Some(name) => {
                let names = distribution::parameters(&name).unwrap_or_default();
                if names.len() != texts.len() {
                    let message = format!("`{name}` has the parameters {}", names.join(", "));
                    self.refuse(self.name(), argument(), message, None);
                    return None;
                }
                let shapes = |index: usize| names[index] == SHAPE;
                let with_units: Vec<String> =
                    (0..count).filter(|index| !shapes(*index)).map(|index| texts[index].clone()).collect();
                self.one_unit(takes, &argument, &with_units)?;
                let parameter = |reader: &mut Reader<'_>, index: usize| {
                    if !shapes(index) {
                        return reader.number(number, index, takes);
                    }
                    let shape = Takes::Number.number(&texts[index]);
                    if shape.is_none() {
                        let message = format!("the {SHAPE} `{}` is no number", texts[index]);
                        reader.refuse(reader.name(), argument(), message, None);
                    }
                    shape
                };
                let parameters: Vec<Option<f64>> = (0..count).map(|index| parameter(self, index)).collect();
                let parameters: Vec<f64> = parameters.into_iter().collect::<Option<_>>()?;
                match Distribution::new(&name, &parameters) {
                    Ok(of) => Some(Levels::Distribution(of)),
                    Err(message) => {
                        self.refuse(
                            self.name(),
                            format!("{key}={name}({})", texts.join(", ")),
                            message,
                            None,
                        );
                        None
                    }
                }
            }
            None => {
                let ends = [self.number(number, 0, takes), self.number(number, 1, takes)];
                let ends = [ends[0]?, ends[1]?];
                self.range(takes, &argument, ends, steps)
            }
        }
    }

    /// Texts, each of which can be read but for reasons of other keys.
    fn texts(&mut self, number: usize, texts: Vec<String>) -> Option<Levels> {
        let before = self.problems.list.len();
        let key = self.asked[number].0.clone();
        let is_table = self.inputs.table.is_some();
        let mut seen = std::collections::BTreeSet::new();
        for (index, text) in texts.iter().enumerate() {
            // Each is read once, in its row or beside the first values of the other keys.
            if !seen.insert(text) || seen.len() > MOST_TEXTS {
                continue;
            }
            let changes = self.changes(|other| if is_table || other == number { index } else { 0 });
            if let Err(mut problems) = self.reading.with(&changes) {
                problems.list.retain(|problem| problem.key.starts_with(&key));
                self.merge(problems, index);
            }
        }
        (self.problems.list.len() == before).then_some(Levels::Texts(texts))
    }

    /// Refuses values of which some have a unit and others none.
    fn one_unit(&mut self, takes: Takes, argument: &dyn Fn() -> String, texts: &[String]) -> Option<()> {
        let Takes::Quantity(measure) = takes else { return Some(()) };
        let plain = |text: &str| {
            let end = number_end(text);
            end == text.len() && text.parse() != Ok(0.0)
        };
        let texts: Vec<String> = texts.iter().map(|text| bare(text)).collect();
        let without = texts.iter().filter(|text| plain(text)).count();
        let united = texts.iter().filter(|text| !plain(text) && text.parse::<f64>().is_err()).count();
        if without == 0 || united == 0 {
            return Some(());
        }
        let message = format!("some values have a unit and others none, which would be in {}", measure.unit);
        self.refuse(self.name(), argument(), message, Some("write the unit behind each value".to_owned()));
        None
    }

    fn range(
        &mut self,
        takes: Takes,
        argument: &dyn Fn() -> String,
        [from, to]: [f64; 2],
        count: Option<usize>,
    ) -> Option<Levels> {
        let whole = takes == Takes::Integer;
        let step = count.map(|count| (to - from) / (count - 1) as f64);
        let message = match step {
            None if !(from < to) => Some(format!("the first value {from} must be below the last, {to}")),
            Some(step) if step == 0.0 || !step.is_finite() => Some("the first value is the last".to_owned()),
            Some(step) if whole && step.fract() != 0.0 => Some(format!(
                "the key takes integers, and a step of {step} gives others: choose another number of values"
            )),
            _ => None,
        };
        if let Some(message) = message {
            self.refuse(self.name(), argument(), message, None);
            return None;
        }
        Some(Levels::Range { ends: [from, to], count, whole })
    }
}

/// Whether a change sets a key that ends as another does.
fn same_end(change: &str, key: &str) -> bool {
    let end = |key: &str| key.trim().rsplit('.').next().map(str::to_owned);
    change.split_once('=').is_some_and(|(other, _)| end(other) == end(key))
}
