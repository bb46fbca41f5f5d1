//! Runs every case of `verification` and writes what was measured, as Markdown:
//! `cargo run --release --example verification_report > docs/src/verification.md`.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

#[path = "../tests/verification/folder.rs"]
mod folder;
#[path = "../tests/verification/run.rs"]
mod run;

use folder::Expected;

const HEAD: &str = "# Verification

Each folder of [verification](../../verification) is a case (`case.toml`), what its run is held to (`expected.toml`, and
`reference.csv` where there is a reference history), and where that comes from (`README.md`). `cargo test --test
verification` runs them all; a case can be run like any other: `flexion run verification/p1_spin_up_4`. To add one,
add a folder: the test finds it, and asks for a folder for every kind that a case may choose.

This page is written by `cargo run --release --example verification_report`. *Off* is the largest difference from the
reference: over the largest size of the column for a history (*/ its peak*), in the unit of the column for a figure.
The tables of P1 and P3 are on [a page of their own](verification_tables.md), and their transients in every basis and coupling
on [another](basis_coupling_tables.md).

| case | what is compared | off | allowed |
|---|---|---|---|";

const ORDERS: &str = "
## Orders of convergence

Measured by `cargo test --test convergence` on P1's beam, spun up to 4 rad/s in 5 s; errors are the largest of the tip's
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

fn main() {
    println!("{HEAD}");
    let mut folders: Vec<String> = std::fs::read_dir(run::root())
        .unwrap()
        .filter_map(|entry| entry.ok().filter(|entry| entry.path().is_dir()))
        .map(|entry| entry.file_name().into_string().unwrap())
        .collect();
    folders.sort();
    for folder in folders {
        let run = run::run(&folder, &[]);
        let title = run::case(&folder, &[]).unwrap().case.title;
        let mut first = format!("[{folder}](../../verification/{folder}/README.md): {title}");
        for c in Expected::read(&folder).compare(&run, |other| run::run(other, &[])) {
            // One row says it for a case that must be the same as another.
            if c.note.is_empty() && c.what.contains(" in ") && !c.what.starts_with("tip.deflection /") {
                continue;
            }
            println!("| {first} | {} | {:.1e} | {:.1e} |", c.what, c.off, c.tolerance);
            first.clear();
        }
    }
    println!("{ORDERS}");
}
