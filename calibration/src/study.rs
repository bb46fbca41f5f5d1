//! Counts and figure of a study.

use super::outcome::{Compared, Ending, Outcome};
use flexion_results::plot::{Axis, Figure, Line, Marker, Panel, Series};

/// Stated over true error beyond which the statement is of little use.
const FAR: f64 = 10.0;
/// Part of the largest value to which a case is right that needs no warning.
const RIGHT: f64 = 1e-3;
/// Most points of the figure.
const POINTS: usize = 4000;

/// Counts of a study. A value is `min`, `max` or `final` of a column; of each the largest value is that of its column.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Counts {
    /// Cases.
    pub cases: usize,
    /// Cases whose errors are known.
    pub known: usize,
    /// Cases of which no finer run tells the error.
    pub unknown: usize,
    /// Cases that ended with an error.
    pub failed: usize,
    /// Legal cases that were refused.
    pub refused: usize,
    /// Values with a stated and a known error.
    pub values: usize,
    /// Values off by no more than is stated.
    pub held: usize,
    /// Values off by more than rounding, with a statement.
    pub measured: usize,
    /// Of these, values with a stated error of at most ten times the true one.
    pub near: usize,
    /// Median of stated over true error.
    pub median: f64,
    /// Values of foreshortened couplings, and those off by no more than discretization + model from the exact coupling.
    pub exact: (usize, usize),
    /// Cases with a value off by more than ten times what is stated, and no warning.
    pub silent: Vec<u64>,
    /// Cases with a principal value off by more than a hundredth of the largest value and by more than is stated, and no warning.
    pub wrong: Vec<u64>,
    /// Cases that break a law of contacts, and no warning.
    pub broken: Vec<u64>,
    /// Cases that take long, and no warning.
    pub grinding: Vec<u64>,
    /// Cases right to a thousandth.
    pub right: usize,
    /// Of these, cases with a warning.
    pub warned: usize,
}

impl Counts {
    /// The counts of outcomes.
    pub fn of(outcomes: &[Outcome]) -> Counts {
        let ended = |is: fn(&Ending) -> bool| outcomes.iter().filter(|o| is(&o.ending)).count();
        let values = || outcomes.iter().flat_map(|o| &o.values).filter(|v| v.stated.is_finite());
        let mut quotients: Vec<f64> = values().filter_map(Compared::quotient).collect();
        quotients.sort_by(f64::total_cmp);
        let exact = || values().filter_map(|v| Some((v.exact?, v.rounding())));
        let right = || outcomes.iter().filter(|o| o.right_to(RIGHT));
        let numbers = |is: &dyn Fn(&Outcome) -> bool| {
            outcomes.iter().filter(|o| is(o)).map(|o| o.number).collect::<Vec<_>>()
        };
        Counts {
            cases: outcomes.len(),
            known: ended(|e| *e == Ending::Known),
            unknown: ended(|e| matches!(e, Ending::Unknown(_))),
            failed: ended(|e| matches!(e, Ending::Failed(_))),
            refused: ended(|e| matches!(e, Ending::Refused(_))),
            values: values().count(),
            held: values().filter(|v| v.holds()).count(),
            measured: quotients.len(),
            near: quotients.iter().filter(|q| **q <= FAR).count(),
            median: quotients.get(quotients.len() / 2).copied().unwrap_or(f64::NAN),
            exact: (
                exact().count(),
                exact().filter(|((stated, off), rounding)| *off <= stated + rounding).count(),
            ),
            silent: numbers(&|o| o.silent().next().is_some()),
            wrong: numbers(&|o| o.wrong().next().is_some()),
            broken: numbers(&|o| !o.broken.is_empty() && o.warnings.is_empty()),
            grinding: numbers(&Outcome::grinds),
            right: right().count(),
            warned: right().filter(|o| !o.warnings.is_empty()).count(),
        }
    }

    /// Rows of a table: what is counted, the count, and what is asked.
    pub fn rows(&self) -> Vec<[String; 3]> {
        let part = |a: usize, b: usize| format!("{a} of {b} ({:.1} %)", 100.0 * a as f64 / b.max(1) as f64);
        let row = |what: &str, count: String, asked: &str| [what.to_owned(), count, asked.to_owned()];
        vec![
            row("cases whose errors are known", part(self.known, self.cases), ""),
            row("no finer run tells the error", self.unknown.to_string(), ""),
            row("ended with an error", self.failed.to_string(), ""),
            row("legal and refused", self.refused.to_string(), "0"),
            row("values off by no more than is stated", part(self.held, self.values), "≥ 95 %"),
            row("stated error at most 10 × the true one", part(self.near, self.measured), "≥ 80 %"),
            row("median of stated over true error", format!("{:.2}", self.median), "≤ 5"),
            row(
                "within discretization + model of the exact coupling",
                part(self.exact.1, self.exact.0),
                "≥ 95 %",
            ),
            row("silent, and off by more than 10 × what is stated", self.silent.len().to_string(), "0"),
            row("silent, off by more than 1 % and than is stated", self.wrong.len().to_string(), "0"),
            row("silent, and a contact entered or energy made", self.broken.len().to_string(), "0"),
            row("silent, and longer than 20 s", self.grinding.len().to_string(), "0"),
            row("right to 0.1 %, and warned", part(self.warned, self.right), "≤ 5 %"),
        ]
    }
}

/// Stated against true errors of the principal columns, both over the largest value of the column.
pub fn figure(outcomes: &[Outcome]) -> Figure {
    let of = |v: &Compared| (v.off / v.size, v.stated / v.size);
    let shown = |(x, y): &(f64, f64)| (1e-10..1e2).contains(x) && (1e-10..1e2).contains(y);
    let points = |warned: bool| -> Vec<(f64, f64)> {
        let those = outcomes.iter().filter(|o| o.warnings.is_empty() != warned);
        let values = those.flat_map(|o| &o.values).filter(|v| v.principal);
        values.map(of).filter(shown).take(POINTS).collect()
    };
    let marks = |name: &str, warned, marker, color| Series {
        name: Some(name.to_owned()),
        points: points(warned),
        line: Line::None,
        marker: Some(marker),
        color: Some(color),
        ..Series::default()
    };
    let line = |name: &str, factor: f64, line| Series {
        name: Some(name.to_owned()),
        points: vec![(1e-10, 1e-10 * factor), (1e1, 1e1 * factor)],
        line,
        color: Some(2),
        ..Series::default()
    };
    let panel = Panel {
        x: Axis { range: Some((1e-10, 1e1)), ..Axis::logarithmic("True error over largest value", "") },
        y: Axis { range: Some((1e-10, 1e2)), ..Axis::logarithmic("Stated error over largest value", "") },
        series: vec![
            marks("values without a warning", false, Marker::Circle, 0),
            marks("with a warning", true, Marker::Cross, 1),
            line("stated = true", 1.0, Line::Solid),
            line("stated = 10 × true", 10.0, Line::Dashed),
        ],
        ..Panel::default()
    };
    Figure { panels: vec![panel], columns: 1, ..Figure::default() }
}
