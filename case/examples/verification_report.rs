//! The one way in which `docs/src/verification.md` and what tests are held to are written.
//!
//! Runs every case of `verification` and writes what was measured: the page `docs/src/verification.md`, and
//! `verification/measured.toml`, to which later differences are held: `cargo run --release --example verification_report`.

#![allow(clippy::unwrap_used, clippy::panic)]

#[path = "../tests/verification/expected.rs"]
mod expected;
#[path = "../tests/verification/run.rs"]
mod run;

use expected::{Comparison, Expected};
use run::Variant;
use std::fmt::Write;

const HEAD: &str = "# Verification

Each folder of [verification](../../verification/README.md) is a case, what its run and those of its variants are held to,
and where that comes from. `cargo test --release --test verification` runs them all.

This page is written by `cargo run --release --example verification_report`. *Off* is the largest difference from the
reference: over the largest size of the column for a history (*/ its peak*), in the unit of the column for a figure.
Where it is less than 5 % of what is allowed, it is held to five times what was measured (`verification/measured.toml`).
What papers claim is judged by `flexion reproduce` ([page](tasks/paper.md)).

| case | what is compared | off | allowed |
|---|---|---|---|";

const ORDERS: &str = "
## Orders of convergence

Measured by `cargo test --release --test integration convergence` on P1's beam, spun up to 4 rad/s in 5 s; errors are the largest of the tip's
deflection in 6 s.

| what is refined | order | expected |
|---|---|---|
| elements 10 → 20, `first` | 3.8 (3.9 from 5 to 10) | 4 |
| elements 10 → 20, `exact` | 4.0 | 4 |
| stretch of linear axial elements, 4 → 8 | 1.98 | 2 |
| stretch of quadratic axial elements, 4 → 8 | 4.00 | 4 |
| assumed modes 6 → 12 | 4.9 | at least 4 |
| RPIM nodes 11 → 21 | 3.9 | none known |
| `newmark`, `hht`, `generalized-alpha`, `first` | 1.99 | 2 |
| `newmark`, `hht`, `generalized-alpha`, `exact` | 2.00 | 2 |
| `runge-kutta-4` | 4.00 | 4 |
| `adams-4` | 4.1 | 4 |

The error of `radau` follows its tolerance: from 1e-4 to 1e-8, by tens, 3e-5, 6e-6, 7e-7, 6e-8, 8e-9 m for `first` and 1e-5, 1e-6,
2e-7, 3e-8, 3e-9 m for `exact`, of a deflection of about 1 m.";

const REGRESSIONS: &str = "
## Regressions

No reference gives these numbers: they are the program's own, held so that a change of them is seen. They verify nothing.

| case | what is compared | changed by | allowed |
|---|---|---|---|";

const MEASURED: &str = "# Differences that use less than 5 % of their tolerances, when they were last measured: case, what is compared, difference.
# Written by `cargo run --release --example verification_report`, which is run where a difference may change.
";

fn main() {
    let (mut page, mut measured) = (format!("{HEAD}\n"), MEASURED.to_owned());
    let mut regressions = String::new();
    for variant in run::all() {
        let Variant { name, folder, .. } = &variant;
        let run = run::run(name, &[]);
        let title = variant.title.clone().unwrap_or_else(|| run::case(name, &[]).unwrap().case.title);
        let mut first = format!("[{name}](../../verification/{folder}/README.md): {title}");
        let comparisons = Expected::new(&variant).compare(&run);
        if comparisons.iter().any(Comparison::is_loose) {
            let _ = writeln!(measured, "\n[\"{name}\"]");
        }
        for c in comparisons {
            let (what, off, tolerance) = (&c.what, c.off, c.tolerance);
            if c.is_loose() {
                let _ = writeln!(measured, "\"{what}\" = {off:.1e}");
            }
            if c.regression {
                let _ = writeln!(regressions, "| {name} | {what} | {off:.1e} | {tolerance:.1e} |");
                continue;
            }
            // One row says it for a case that must be the same as another.
            if c.note.is_empty() && what.contains(" in ") && !what.starts_with("tip.deflection /") {
                continue;
            }
            let _ = writeln!(page, "| {first} | {what} | {off:.1e} | {tolerance:.1e} |");
            first.clear();
        }
    }
    let _ = writeln!(page, "{REGRESSIONS}\n{regressions}{ORDERS}");
    std::fs::write(run::root().join("../docs/src/verification.md"), page).unwrap();
    std::fs::write(run::root().join("measured.toml"), measured).unwrap();
}
