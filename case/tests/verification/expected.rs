//! What `expected.toml` says the runs of a folder of `verification` are held to, and `measured.toml`: where a difference was less than
//! 5 % of its tolerance, what it was. It may become [`GROWTH`] times as large, for a tolerance alone would let a mistake pass.

#![allow(dead_code)] // each program uses its part

use crate::run::{Run, Span, Variant, case, root, run};
use flexion::analysis::equilibrium::equilibrium;
use flexion::analysis::modes::modes;
use flexion::analysis::rotation::rotate_stably;
use std::path::Path;
use toml::{Table, Value};

/// The keys of `expected.toml` and of a variant in it.
const KEYS: &[&str] = &["reference", "until", "columns", "figures", "failure", "regression", "same", "modes"];
const MODES: &[&str] = &["speed", "free-hub", "frequencies", "tolerance", "absolute", "moves"];
/// Modes among which those that move one way are looked for, to each that is expected.
const AMONG: usize = 4;
/// Part of a tolerance below which a difference is held to what was measured.
const PART: f64 = 0.05;
/// By what it may grow, and the part of a tolerance that is rounding.
const GROWTH: f64 = 5.0;
const ROUNDING: f64 = 1e-3;
const FIGURE: &[&str] = &["column", "of", "from", "to", "value", "tolerance"];

/// One thing that was compared: what, how far it is off, how far it may be.
pub struct Comparison {
    pub what: String,
    pub off: f64,
    pub tolerance: f64,
    pub note: String,
    /// Whether the program is held to its own earlier result.
    pub regression: bool,
}

impl Comparison {
    /// Within the tolerance, and not far more than was measured.
    pub fn good(&self, measured: Option<f64>) -> bool {
        let most = measured.map_or(self.tolerance, |off| (GROWTH * off).max(ROUNDING * self.tolerance));
        self.off <= self.tolerance.min(most)
    }

    /// Whether the tolerance alone would let it grow much.
    pub fn is_loose(&self) -> bool {
        self.off < PART * self.tolerance && !self.regression
    }

    fn new(what: impl Into<String>, off: f64, tolerance: f64, note: String) -> Comparison {
        Comparison { what: what.into(), off, tolerance, note, regression: false }
    }
}

/// The differences of `measured.toml` of a variant, by what is compared.
pub fn measured(variant: &str) -> Table {
    let path = root().join("measured.toml");
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let mut all: Table = text.parse().unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    all.remove(variant).map_or_else(Table::new, |table| table.as_table().unwrap().clone())
}

/// What the run of a variant is held to.
pub struct Expected<'v> {
    variant: &'v Variant,
    table: &'v Table,
    name: &'v str,
}

impl Expected<'_> {
    pub fn new(variant: &Variant) -> Expected<'_> {
        let expected = Expected { variant, table: &variant.expected, name: &variant.name };
        expected.known("expected.toml", expected.table, KEYS);
        expected
    }

    /// Every way in which the run is compared.
    pub fn compare(&self, run: &Run) -> Vec<Comparison> {
        let mut all = Vec::new();
        self.failure(run);
        self.columns(run, &mut all);
        self.figures(run, &mut all);
        self.same(run, &mut all);
        self.modes(&mut all);
        self.regression(run, &mut all);
        assert!(!all.is_empty(), "{}: nothing is compared", self.name);
        all
    }

    /// Words of the message with which the run has to end before its time.
    fn failure(&self, run: &Run) {
        let words = self.table.get("failure").map(|words| words.as_array().unwrap());
        let (Some(words), Some(message)) = (words, &run.failure) else {
            assert!(words.is_none(), "{}: the run should fail, but ended", self.name);
            assert_eq!(run.failure, None, "{}", self.name);
            return;
        };
        for part in words.iter().map(|word| word.as_str().unwrap()) {
            assert!(message.contains(part), "{}: `{part}` is not in: {message}", self.name);
        }
    }

    /// The time at which the run fails, which no reference gives.
    fn regression(&self, run: &Run, all: &mut Vec<Comparison>) {
        let Some(regression) = self.table.get("regression").map(|r| r.as_table().unwrap()) else { return };
        self.known("regression", regression, &["breakdown", "tolerance"]);
        let off = (run.end - number(regression, "breakdown")).abs();
        let note = format!("{:.4} s", run.end);
        let comparison = Comparison::new("time of breakdown", off, number(regression, "tolerance"), note);
        all.push(Comparison { regression: true, ..comparison });
    }

    fn columns(&self, run: &Run, all: &mut Vec<Comparison>) {
        let Some(columns) = self.table.get("columns").map(|c| c.as_table().unwrap()) else { return };
        let file = self.table.get("reference").map_or("reference.csv", |f| f.as_str().unwrap());
        let reference = Reference::read(&root().join(&self.variant.folder).join(file));
        let until = self.table.get("until").map_or(f64::INFINITY, value);
        for (name, tolerance) in columns {
            let tolerance = value(tolerance);
            let column = run.column(name);
            let (mut worst, mut peak, mut rows) = ((0.0_f64, 0.0), 0.0_f64, 0);
            for (time, expected) in reference.column(name).filter(|(time, _)| *time <= until) {
                let row = run.trajectory.times().partition_point(|t| *t < time - 1e-9);
                let recorded = run.trajectory.times().get(row).filter(|t| (*t - time).abs() < 1e-9);
                assert!(recorded.is_some(), "{}: nothing is recorded at t = {time} s", self.name);
                peak = peak.max(expected.abs());
                rows += 1;
                let off = (column[row] - expected).abs();
                if off.is_nan() || off > worst.0 {
                    worst = (off, time);
                }
            }
            assert!(rows > 9, "{}: {name} is compared at {rows} times only", self.name);
            let note = format!("{rows} times, peak {peak:.6e}, worst at {:.3} s", worst.1);
            all.push(Comparison::new(format!("{name} / its peak"), worst.0 / peak, tolerance, note));
        }
    }

    fn figures(&self, run: &Run, all: &mut Vec<Comparison>) {
        let Some(figures) = self.table.get("figures").map(|c| c.as_table().unwrap()) else { return };
        for (name, figure) in figures {
            let figure = figure.as_table().unwrap();
            self.known(name, figure, FIGURE);
            let column = figure.get("column").map_or("", |column| column.as_str().unwrap());
            let first = || run.events.impacts().next().unwrap();
            let from = figure.get("from").map_or(0.0, value);
            let to = figure.get("to").map_or(run.end, value);
            let span = Span { from, to };
            let measured = match figure["of"].as_str().unwrap() {
                "min" => run.extreme(column, -1.0, span).0,
                "max" => run.extreme(column, 1.0, span).0,
                "time-of-min" => run.extreme(column, -1.0, span).1,
                "time-of-max" => run.extreme(column, 1.0, span).1,
                "amplitude" => run.amplitude(column, span),
                "middle" => 0.5 * (run.extreme(column, 1.0, span).0 + run.extreme(column, -1.0, span).0),
                "first-impact-time" => first().time,
                "first-impact-speed" => first().speed.unwrap(),
                "first-impact-impulse" => first().impulse.unwrap(),
                "first-impact-loss" => first().lost.unwrap(),
                other => panic!("{}: unknown figure `{other}`", self.name),
            };
            let (expected, tolerance) = (number(figure, "value"), number(figure, "tolerance"));
            let note = format!("{measured:.8e}, expected {expected:.8e}");
            all.push(Comparison::new(name, (measured - expected).abs(), tolerance, note));
        }
    }

    /// All of the motion, against that of the case as it stands.
    fn same(&self, run_here: &Run, all: &mut Vec<Comparison>) {
        let Some(tolerance) = self.table.get("same").map(value) else { return };
        let other = run(&self.variant.folder, &[]);
        assert_eq!(run_here.trajectory.times(), other.trajectory.times(), "{}", self.name);
        // `step.` tells of the integrator, and the balance of energy is the error of the run.
        let motion = |name: &str| !name.starts_with("step.") && name != "energy.balance";
        let channels = run_here.trajectory.channels().iter().enumerate();
        for (index, channel) in channels.filter(|(_, channel)| motion(&channel.name)) {
            let e = other.trajectory.extremes(index);
            let peak = e.min.abs().max(e.max.abs());
            let pairs = run_here.trajectory.values(index).zip(other.trajectory.values(index));
            let off = pairs.fold(0.0_f64, |worst, (a, b)| worst.max((a - b).abs()));
            let off = if peak == 0.0 { off } else { off / peak };
            let what = format!("{} / its peak in {}", channel.name, self.variant.folder);
            all.push(Comparison::new(what, off, tolerance, String::new()));
        }
    }

    /// Lowest frequencies at steady speeds, relative.
    fn modes(&self, all: &mut Vec<Comparison>) {
        let Some(speeds) = self.table.get("modes").map(|m| m.as_array().unwrap()) else { return };
        let case = case(self.name, &[]).unwrap().case;
        for table in speeds.iter().map(|table| table.as_table().unwrap()) {
            self.known("modes", table, MODES);
            let speed = number(table, "speed");
            // Relative, or of the last digit of a printed table [rad/s].
            let absolute = table.get("absolute").map(value);
            let expected: Vec<f64> = table["frequencies"].as_array().unwrap().iter().map(value).collect();
            let (mut system, _) = case.vibrating(speed > 0.0).unwrap();
            let mut state = system.initial();
            if case.space().is_some() && speed == 0.0 {
                equilibrium(system.as_mut(), &mut state).unwrap();
            } else {
                rotate_stably(system.as_mut(), &mut state, 0.0, speed).unwrap();
            }
            if table.get("free-hub").is_some_and(|free| free.as_bool().unwrap()) {
                system.hold(false);
            }
            let moves = table.get("moves").map(|moves| moves.as_str().unwrap());
            let count = expected.len() * moves.map_or(1, |_| AMONG);
            let mut found = modes(system.as_mut(), &state, count, &[]).unwrap().modes;
            found.retain(|mode| moves.is_none_or(|moves| mode.shares.dominant() == moves));
            assert!(found.len() >= expected.len(), "{}: {moves:?} modes are missing", self.name);
            for (index, (mode, expected)) in found.iter().zip(expected).enumerate() {
                let frequency = mode.frequency();
                let what = format!("frequency {} at {speed} rad/s, relative", index + 1);
                let note = format!("{frequency:.8}, expected {expected}");
                let tolerance = absolute.map_or_else(|| number(table, "tolerance"), |off| off / expected);
                all.push(Comparison::new(what, (frequency / expected - 1.0).abs(), tolerance, note));
            }
        }
    }

    fn known(&self, what: &str, table: &Table, keys: &[&str]) {
        for key in table.keys() {
            assert!(keys.contains(&key.as_str()), "{}: unknown key `{key}` in {what}", self.name);
        }
    }
}

fn value(value: &Value) -> f64 {
    value.as_float().or_else(|| value.as_integer().map(|i| i as f64)).unwrap()
}

fn number(table: &Table, key: &str) -> f64 {
    table.get(key).map_or_else(|| panic!("no key `{key}`"), value)
}

/// A reference history: comments `#` that say where it comes from, names with units, rows.
pub struct Reference {
    names: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Reference {
    pub fn read(path: &Path) -> Reference {
        let text = std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        assert!(text.starts_with("# "), "{} does not say where it comes from", path.display());
        let mut lines = text.lines().filter(|line| !line.starts_with('#'));
        let names: Vec<String> = lines.next().unwrap().split(',').map(str::to_owned).collect();
        assert_eq!(names[0], "time [s]", "{}", path.display());
        let rows = lines
            .map(|line| line.split(',').map(|number| number.trim().parse().unwrap()).collect())
            .collect();
        Reference { names, rows }
    }

    /// Times and values of a column, named without its unit.
    fn column(&self, name: &str) -> impl Iterator<Item = (f64, f64)> {
        let named = |column: &String| column.split(" [").next() == Some(name);
        let index = self.names.iter().position(named).unwrap_or_else(|| panic!("no column {name}"));
        self.rows.iter().map(move |row| (row[0], row[index]))
    }
}
