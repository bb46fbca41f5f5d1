//! A paper as its folder describes it. See `docs/src/tasks/paper.md`.

use serde::Deserialize;
use std::collections::BTreeMap;

/// A paper with its items and cases.
#[derive(Clone, Debug)]
pub struct Described {
    /// The name of its folder, by which it is called.
    pub name: String,
    /// Where its folder is, for commands and messages.
    pub place: String,
    /// What it is.
    pub paper: Paper,
    /// Its items in the order of the paper.
    pub items: Vec<(String, Item)>,
    /// The texts of its cases, by their names.
    pub cases: BTreeMap<String, String>,
    /// Its drawings, by the names of their files.
    pub drawings: BTreeMap<String, String>,
    /// The values that `--check` compares with.
    pub expected: Option<String>,
}

/// `paper.toml`
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Paper {
    pub title: String,
    pub authors: String,
    pub source: String,
    pub doi: Option<String>,
    pub about: String,
    pub items: Vec<String>,
    #[serde(default)]
    pub notes: Vec<String>,
}

/// What an item is.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum ItemKind {
    /// Curves or points.
    Figure,
    /// Numbers.
    Table,
    /// A sketch of what is computed.
    Drawing,
}

/// A figure or a table of the paper.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Item {
    pub title: String,
    pub kind: ItemKind,
    pub survives: Option<String>,
    pub chosen: Option<String>,
    pub drawing: Option<String>,
    #[serde(default, rename = "run")]
    pub runs: Vec<Template>,
    #[serde(default, rename = "plot")]
    pub plots: Vec<Plot>,
    pub table: Option<Table>,
    #[serde(default, rename = "claim")]
    pub claims: Vec<Claim>,
    /// The lines of its file.
    #[serde(skip)]
    pub lines: Lines,
}

/// Where the parts of an item stand in its file, in lines from 1.
#[derive(Clone, Debug, Default)]
pub struct Lines {
    /// Of each run: its name, its changes, those of the run with which it is compared.
    pub runs: Vec<(usize, Vec<usize>, Vec<usize>)>,
    /// Of the rule of each claim.
    pub claims: Vec<usize>,
    /// Of each plot.
    pub plots: Vec<usize>,
    /// Of the table.
    pub table: Option<usize>,
    /// Of each column of the table.
    pub columns: Vec<usize>,
    /// The text of the file.
    pub text: String,
}

impl Lines {
    /// The first line in which some words stand.
    pub fn of(&self, words: &str) -> Option<usize> {
        self.text.lines().position(|line| line.contains(words)).map(|line| line + 1)
    }
}

/// Runs, one for every combination of the values of `each`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Template {
    pub name: String,
    pub case: String,
    #[serde(default)]
    pub set: Vec<String>,
    #[serde(default)]
    pub each: BTreeMap<String, Vec<toml::Value>>,
    pub against: Option<Vec<String>>,
    pub seconds: Option<f64>,
    /// Whether its case may be refused, since that is what is asked.
    #[serde(default)]
    pub refused: bool,
    pub modes: Option<OfModes>,
    pub strain_energy: Option<OfEnergy>,
}

/// Frequencies in steady rotation.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct OfModes {
    pub speed: toml::Value,
    pub count: usize,
    #[serde(default)]
    pub transverse: bool,
    pub unit: Option<toml::Value>,
}

/// Frequencies by a strain energy.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct OfEnergy {
    pub energy: Energy,
    pub speed: toml::Value,
    pub count: usize,
    #[serde(default)]
    pub terms: Vec<EnergyTerm>,
    #[serde(default)]
    pub chordwise: bool,
    pub unit: Option<toml::Value>,
}

/// A strain energy of a rotating beam.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum Energy {
    Linear,
    Coupled,
    Exact,
}

/// A term of the coupled strain energy.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum EnergyTerm {
    BendingFirst,
    BendingSecond,
    AxialFirst,
    AxialSecond,
    StretchedInertia,
}

/// How a quantity is compared with that of another run.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, PartialOrd, Ord)]
#[serde(rename_all = "kebab-case")]
pub enum As {
    Difference,
    Ratio,
    RelativeDifference,
    CurveDifference,
}

/// A number, or a quantity of a run.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged, expecting = "a number, or a table with `run`, `quantity`, and perhaps `to` and `as`")]
pub enum Term {
    Number(f64),
    Of(OfRun),
}

/// A quantity of a run, perhaps compared with another run.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct OfRun {
    pub run: String,
    pub quantity: String,
    pub to: Option<String>,
    #[serde(rename = "as")]
    pub compared: Option<As>,
}

/// A panel of a figure.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Plot {
    pub title: Option<String>,
    pub x: Option<String>,
    pub y: String,
    pub runs: Option<Vec<String>>,
    pub from: Option<f64>,
    pub to: Option<toml::Value>,
    #[serde(rename = "as")]
    pub compared: Option<As>,
    #[serde(default)]
    pub log: bool,
    pub label: Option<String>,
}

impl Plot {
    /// Until when it is drawn, where it is over time \[s\].
    pub fn end(&self) -> Option<f64> {
        let to = self.to.as_ref()?;
        to.as_float().or(to.as_integer().map(|to| to as f64))
    }
}

/// A table with a row for each run.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Table {
    pub runs: Option<Vec<String>>,
    pub columns: Vec<Column>,
}

/// A column of a table.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Column {
    pub title: String,
    pub quantity: String,
    pub to: Option<String>,
    #[serde(rename = "as")]
    pub compared: Option<As>,
    pub unit: Option<String>,
}

/// A claim of the paper.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Claim {
    pub text: String,
    /// Whether it is ours, and not the paper's.
    #[serde(default)]
    pub ours: bool,
    pub place: Option<String>,
    pub value: Option<String>,
    pub rule: Rule,
    pub holds: Option<String>,
    pub fails: Option<String>,
    pub undecided: Option<String>,
    pub because: Option<String>,
}

/// What decides a claim.
#[derive(Clone, Debug, Deserialize)]
#[serde(tag = "kind", deny_unknown_fields, rename_all = "kebab-case")]
pub enum Rule {
    Less {
        left: Term,
        right: Term,
        /// A factor of `left`.
        times: Option<f64>,
    },
    Within {
        of: Term,
        low: f64,
        high: f64,
    },
    Agree {
        runs: Vec<String>,
        quantity: String,
        within: f64,
        #[serde(default)]
        curves: bool,
    },
    Grows {
        runs: Vec<String>,
        quantity: String,
    },
    Falls {
        runs: Vec<String>,
        quantity: String,
    },
    EndsEarly {
        runs: Vec<String>,
    },
    Finishes {
        runs: Vec<String>,
    },
    All {
        rules: Vec<Rule>,
    },
    Any {
        rules: Vec<Rule>,
    },
    Lost {
        because: String,
    },
}
