//! The columns of the rows of a sweep, whatever the format of their file.

use super::Sweep;
use super::row::{Point, Row, Status};
use crate::run::quantity::Collected;
use flexion_results::VERSION;

/// The values of a column, one a row.
#[derive(Clone, Debug, PartialEq)]
pub enum Data {
    /// Whole numbers.
    Whole(Vec<i64>),
    /// Numbers, where there are any.
    Numbers(Vec<Option<f64>>),
    /// Texts, where there are any.
    Texts(Vec<Option<String>>),
    /// Truths, where they are known.
    Booleans(Vec<Option<bool>>),
}

impl Data {
    pub(super) fn len(&self) -> usize {
        match self {
            Data::Whole(of) => of.len(),
            Data::Numbers(of) => of.len(),
            Data::Texts(of) => of.len(),
            Data::Booleans(of) => of.len(),
        }
    }
}

/// A column with its name, and its unit between brackets where it has one.
pub type Named = (String, Data);

/// A name with its unit.
fn with_unit(name: &str, unit: &str) -> String {
    if unit.is_empty() { name.to_owned() } else { format!("{name} [{unit}]") }
}

/// The rows as columns.
pub(super) fn columns(sweep: &Sweep, rows: &[Row]) -> Vec<Named> {
    let numbers = |of: &dyn Fn(&Row) -> Option<f64>| Data::Numbers(rows.iter().map(of).collect());
    let texts = |of: &dyn Fn(&Row) -> Option<String>| Data::Texts(rows.iter().map(of).collect());
    let whole = |of: &dyn Fn(&Row) -> i64| Data::Whole(rows.iter().map(of).collect());
    let mut out = vec![("row".to_owned(), whole(&|row| row.number as i64))];
    for (i, input) in sweep.inputs.iter().enumerate() {
        let truth = |text: &String| text.parse::<bool>().is_ok();
        let data = if let super::Column::Texts(all, _) = &sweep.columns[i]
            && all.iter().all(truth)
        {
            let of =
                |row: &Row| if let Point::Text(text) = &row.inputs[i] { text.parse().ok() } else { None };
            Data::Booleans(rows.iter().map(of).collect())
        } else if matches!(sweep.columns[i], super::Column::Texts(..)) {
            texts(&|row| if let Point::Text(text) = &row.inputs[i] { Some(text.clone()) } else { None })
        } else {
            numbers(&|row| if let Point::Number(x) = row.inputs[i] { Some(x) } else { None })
        };
        out.push((with_unit(&input.key, &input.unit), data));
    }
    out.push(("status".to_owned(), texts(&|row| Some(row.status.word().to_owned()))));
    out.push(("reason".to_owned(), texts(&|row| row.reason.clone())));
    for (i, quantity) in sweep.quantities.iter().enumerate() {
        let (name, unit) = (quantity.name(), quantity.unit.as_str());
        out.push((with_unit(name, unit), numbers(&|row| row.quantities[i].map(|of| of.value))));
        let error = numbers(&|row| row.quantities[i].and_then(|of| of.error));
        out.push((with_unit(&format!("{name}.error"), unit), error));
        out.push((
            with_unit(&format!("{name}.time"), "s"),
            numbers(&|row| row.quantities[i].map(|of| of.time)),
        ));
        let trusted = rows.iter().map(|row| row.quantities[i].and_then(|of| of.trusted)).collect();
        out.push((format!("{name}.trusted"), Data::Booleans(trusted)));
    }
    out.push((with_unit("trusted_until", "s"), numbers(&|row| row.trusted_until)));
    out.push(("warnings".to_owned(), whole(&|row| row.warnings as i64)));
    out.push(("steps".to_owned(), whole(&|row| row.steps as i64)));
    out.push((with_unit("wall_time", "s"), numbers(&|row| Some(row.wall_time))));
    out.push(("version".to_owned(), texts(&|_| Some(VERSION.to_owned()))));
    out
}

/// The rows of columns in their order.
pub(super) fn rows(sweep: &Sweep, columns: Vec<Data>) -> Option<Vec<Row>> {
    let count = columns.first()?.len();
    if columns.iter().any(|data| data.len() != count) {
        return None;
    }
    let mut columns = columns.into_iter();
    let numbers = whole(columns.next()?)?;
    let inputs: Vec<Data> = columns.by_ref().take(sweep.inputs.len()).collect();
    let (statuses, reasons) = (texts(columns.next()?)?, texts(columns.next()?)?);
    let mut quantities = Vec::new();
    for _ in &sweep.quantities {
        let values = [reals(columns.next()?)?, reals(columns.next()?)?, reals(columns.next()?)?];
        let Data::Booleans(trusted) = columns.next()? else { return None };
        quantities.push((values, trusted));
    }
    let until = reals(columns.next()?)?;
    let (warnings, steps) = (whole(columns.next()?)?, whole(columns.next()?)?);
    let wall_times = reals(columns.next()?)?;
    let row = |i: usize| {
        let point = |data: &Data| match data {
            Data::Numbers(of) => of[i].map(Point::Number),
            Data::Texts(of) => of[i].clone().map(Point::Text),
            Data::Booleans(of) => of[i].map(|truth| Point::Text(truth.to_string())),
            Data::Whole(_) => None,
        };
        let collected = |([values, errors, times], trusted): &([Vec<Option<f64>>; 3], Vec<Option<bool>>)| {
            Some(Collected {
                value: values[i]?,
                time: times[i]?,
                error: errors[i],
                records: 0.0,
                trusted: trusted[i],
            })
        };
        Some(Row {
            number: usize::try_from(numbers[i]).ok()?,
            inputs: inputs.iter().map(point).collect::<Option<_>>()?,
            status: Status::of(statuses[i].as_deref()?)?,
            reason: reasons[i].clone(),
            quantities: quantities.iter().map(collected).collect(),
            trusted_until: until[i],
            warnings: usize::try_from(warnings[i]).ok()?,
            steps: u64::try_from(steps[i]).ok()?,
            wall_time: wall_times[i]?,
        })
    };
    (0..count).map(row).collect()
}

fn whole(data: Data) -> Option<Vec<i64>> {
    if let Data::Whole(of) = data { Some(of) } else { None }
}

fn reals(data: Data) -> Option<Vec<Option<f64>>> {
    if let Data::Numbers(of) = data { Some(of) } else { None }
}

fn texts(data: Data) -> Option<Vec<Option<String>>> {
    if let Data::Texts(of) = data { Some(of) } else { None }
}
