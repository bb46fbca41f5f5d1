//! Tables: a row for each run, a column for each quantity.

use crate::described::{Column, Item, OfRun};
use crate::need::{filled as filled_in, named, runs};
use crate::shown::unit_shown;
use crate::term::{Answers, Missing, Number, of_run};
use flexion_case::units;

/// A table with its values.
pub struct Filled {
    /// The titles of its columns, with units.
    pub titles: Vec<String>,
    /// The names of its runs with their cells.
    pub rows: Vec<(String, Vec<Result<Number, Missing>>)>,
}

/// The table of an item, where it has one.
pub fn filled(item: &Item, answers: &Answers<'_>) -> Option<Filled> {
    let table = item.table.as_ref()?;
    let all = runs(item);
    let rows: Vec<(String, Vec<Result<Number, Missing>>)> = named(item, table.runs.as_ref())
        .into_iter()
        .map(|name| {
            let of = all.iter().find(|run| run.name == name).map(|run| run.of.clone()).unwrap_or_default();
            let to = |column: &Column| column.to.as_ref().map(|to| filled_in(to, &of));
            let cells = table.columns.iter().map(|column| cell(&name, to(column), column, answers)).collect();
            (name, cells)
        })
        .collect();
    let title = |(i, column): (usize, &Column)| {
        let numbers = rows.iter().filter_map(|(_, cells)| cells[i].as_ref().ok());
        let unit =
            numbers.map(|number| if number.part { "%" } else { &number.unit }).find(|unit| !unit.is_empty());
        unit.map_or(column.title.clone(), |unit| format!("{} [{}]", column.title, unit_shown(unit)))
    };
    Some(Filled { titles: table.columns.iter().enumerate().map(title).collect(), rows })
}

fn cell(run: &str, to: Option<String>, column: &Column, answers: &Answers<'_>) -> Result<Number, Missing> {
    let of = OfRun { run: run.to_owned(), quantity: column.quantity.clone(), to, compared: column.compared };
    let number = of_run(&of, answers)?;
    let Some(unit) = column.unit.as_ref().filter(|unit| **unit != number.unit) else { return Ok(number) };
    let one = units::parse_in(&format!("1 {unit}"), &number.unit);
    let of_one = one.map_err(|error| Missing::Because(error.message))?;
    Ok(Number {
        value: number.value / of_one,
        error: number.error.map(|error| error / of_one),
        unit: unit.clone(),
        ..number
    })
}
