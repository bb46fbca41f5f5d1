//! Papers computed again: `flexion reproduce`.
//!
//! A paper is a folder of data (`papers/` of the repository, or any other): what its figures and tables are made of, and what it claims of them. Nothing here
//! knows a paper.
//!
//! ```text
//! folder ─▶ Paper (described) ─▶ runs that it needs ─▶ answers (computed, kept) ─▶ figures, tables, verdicts ─▶ report.html, CSV
//! ```

mod answer;
mod check;
mod command;
mod compute;
mod described;
mod figure;
mod form;
mod html;
mod keep;
mod need;
mod paper;
mod report;
mod rule;
mod shared;
mod shown;
mod sound;
mod table;
mod term;
mod verdict;

pub use answer::{Answer, Curve, Valued};
pub use check::{CheckError, Checked, check, comparable, expected};
pub use compute::{Options, Progress, Stopped, compute};
pub use described::{Described, ItemKind};
pub use keep::identity_of_program;
pub use need::{Key, Named, Need, of_paper};
pub use paper::{PaperError, built_in, built_in_names, from_folder};
pub use report::{Counts, Reproduced, write};
pub use rule::Ruled;
pub use sound::sound;
pub use verdict::{Verdict, judged};
