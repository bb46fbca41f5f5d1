//! What a sweep varies: keys and their values, a table, or samples.

use crate::problem::{Place, Problem, Problems, Source};

/// What is varied: inputs on their own, or a table.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Inputs {
    /// `KEY=FIRST:LAST:COUNT`, `KEY=A, B, C` or `KEY=normal(MEAN, DEVIATION)`: without a sample all combinations are run, the last key
    /// changing fastest.
    pub vary: Vec<String>,
    /// One row a run.
    pub table: Option<Table>,
    /// How ranges and distributions are sampled.
    pub sample: Option<Sample>,
}

/// How many points are taken from ranges, lists and distributions, and how.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sample {
    /// The method.
    pub method: Method,
    /// Number of runs.
    pub runs: usize,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// A method that fills the unit cube with points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Latin hypercube: in every input each of N equal parts holds one point (McKay, Beckman & Conover 1979, doi:10.2307/1268522).
    LatinHypercube,
    /// Points of Sobol with the direction numbers of Joe & Kuo 2008, doi:10.1137/070709359, scrambled by Owen's method in the form of Burley
    /// 2020, <https://jcgt.org/published/0009/04/01/>.
    Sobol,
}

impl Method {
    /// Its name, as it is written.
    pub fn name(self) -> &'static str {
        match self {
            Method::LatinHypercube => "lhs",
            Method::Sobol => "sobol",
        }
    }

    /// The method of a name: `lhs` or `sobol`.
    pub fn of(name: &str) -> Option<Method> {
        [Method::LatinHypercube, Method::Sobol].into_iter().find(|method| method.name() == name)
    }
}

/// Values of some keys, one row a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Where it comes from, for messages.
    pub name: String,
    /// The dotted keys.
    pub keys: Vec<String>,
    /// A value for each key.
    pub rows: Vec<Vec<Cell>>,
}

/// A value of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// A number, in SI where its key has a unit.
    Number(f64),
    /// A text as of `--set`: a number with or without unit, a name.
    Text(String),
}

impl Cell {
    /// As of `--set`.
    pub(super) fn text(&self) -> String {
        match self {
            Cell::Number(x) => format!("{x:e}"),
            Cell::Text(text) => text.clone(),
        }
    }
}

impl Table {
    /// A table of the text of a CSV file with the keys in its first line; lines that begin with `#` are comments.
    ///
    /// # Errors
    /// At the line that is to blame.
    pub fn parse(name: &str, text: &str) -> Result<Table, Problems> {
        let mut problems = Problems::default();
        problems.sources.push(Source { name: name.to_owned(), text: text.to_owned() });
        let mut csv = csv::ReaderBuilder::new();
        let mut csv =
            csv.comment(Some(b'#')).trim(csv::Trim::All).flexible(true).from_reader(text.as_bytes());
        let fault = |error: csv::Error| Problem::new("", None, format!("not a CSV table: {error}"));
        let keys: Vec<String> = match csv.headers() {
            Ok(header) => header.iter().map(str::to_owned).collect(),
            Err(error) => {
                problems.push(fault(error));
                return Err(problems);
            }
        };
        let mut rows = Vec::new();
        for record in csv.records() {
            let record = match record {
                Ok(record) => record,
                Err(error) => {
                    problems.push(fault(error));
                    break;
                }
            };
            let start = record.position().map_or(0, |at| at.byte() as usize);
            let end = text.get(start..).and_then(|rest| rest.find('\n')).map_or(text.len(), |at| start + at);
            let place = || Some(Place::new(0, start..end));
            if record.len() != keys.len() {
                let message =
                    format!("this row has {} values, and there are {} keys", record.len(), keys.len());
                problems.push(Problem::new("", place(), message));
            } else if let Some(empty) = record.iter().position(str::is_empty) {
                problems.push(Problem::new(
                    keys[empty].as_str(),
                    place(),
                    "this row has no value of the key",
                ));
            }
            rows.push(record.iter().map(|cell| Cell::Text(cell.to_owned())).collect());
        }
        if rows.is_empty() && problems.list.is_empty() {
            let message =
                "the table has no row: its first line holds the keys, every other one the values of a run";
            problems.push(Problem::new("", None, message));
        }
        let table = Table { name: name.to_owned(), keys, rows };
        if problems.list.is_empty() { Ok(table) } else { Err(problems) }
    }
}
