//! Writing to the terminal or to a pipe.

use flexion_results::{Artifact, Directory, OutputError};
use std::io::{ErrorKind, IsTerminal, Write};
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether something could not be written to standard output.
static INCOMPLETE: AtomicBool = AtomicBool::new(false);

/// Writes to standard output; a closed pipe is no error. Any other failure is reported once, and [`incomplete`] is true
/// from then on.
pub fn print(text: &str) {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe && !INCOMPLETE.swap(true, Ordering::Relaxed) => {
            report(&format!(
                "error: cannot write to standard output: {error}; the printed text is incomplete: make room \
                 where it is redirected to, or redirect it elsewhere\n"
            ));
        }
        _ => {}
    }
}

/// Whether something could not be [printed](fn@print).
pub fn incomplete() -> bool {
    INCOMPLETE.load(Ordering::Relaxed)
}

/// Writes to standard error.
pub fn report(text: &str) {
    let mut out = std::io::stderr().lock();
    let _ = out.write_all(text.as_bytes()).and_then(|()| out.flush());
}

/// Prints where the files of results are, or reports why they could not be written and removes them: whether they are
/// there.
pub fn files(directory: &Directory, written: Result<(), OutputError>, files: &[(&str, Artifact)]) -> bool {
    match &written {
        Ok(()) => {
            let place = |(what, artifact): &(&str, Artifact)| {
                vec![(*what).to_owned(), directory.file(*artifact).display().to_string()]
            };
            print(&table(&files.iter().map(place).collect::<Vec<_>>()));
        }
        Err(error) => {
            directory.discard();
            report(&format!("error: {error}\n"));
        }
    }
    written.is_ok()
}

/// Whether messages on standard error may use colours: a terminal, and no `NO_COLOR`.
pub fn colour() -> bool {
    std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}

/// A value with its error, e.g. `-0.400335 ± 2e-6`: the error rounded up to one digit, the value to the place of it, and to
/// ten digits at most.
pub fn with_error(value: f64, error: f64) -> String {
    if !(value.is_finite() && error.is_finite()) {
        return format!("{value:.6e} ± {error:.0e}");
    }
    let place = |x: f64| x.abs().log10().floor() as i32;
    let size = place(value.abs().max(error).max(f64::MIN_POSITIVE));
    let mut last = if error > 0.0 { place(error) } else { size - 9 };
    let scaled = error / 10f64.powi(last);
    let mut digit = (scaled - 1e-9).ceil();
    if digit >= 10.0 {
        (digit, last) = (1.0, last + 1);
    }
    let last_shown = last.max(size - 9);
    let number = if value == 0.0 {
        "0".to_owned()
    } else if (-4..7).contains(&size) {
        format!("{value:.*}", (-last_shown).max(0) as usize)
    } else {
        format!("{value:.*e}", (size - last_shown).max(0) as usize)
    };
    if error > 0.0 { format!("{number} ± {digit}e{last}") } else { number }
}

/// A row of a table of two columns.
pub fn row(name: &str, text: String) -> Vec<String> {
    vec![name.to_owned(), text]
}

/// A table of text with aligned columns, indented by two spaces.
pub fn table(rows: &[Vec<String>]) -> String {
    let width = |column: usize| {
        rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let mut out = String::new();
    for row in rows {
        let mut line = String::new();
        for (column, cell) in row.iter().enumerate() {
            let fill = width(column).saturating_sub(cell.chars().count());
            line.push_str("  ");
            line.push_str(cell);
            line.extend(std::iter::repeat_n(' ', fill));
        }
        out.push_str(line.trim_end());
        out.push('\n');
    }
    out
}

#[cfg(test)]
mod tests {
    use super::with_error;

    #[test]
    fn a_value_ends_at_the_place_of_its_error() {
        for (value, error, text) in [
            (-0.400_335_003, 1.35e-6, "-0.400335 ± 2e-6"),
            (-0.400_335_003, 9.6e-4, "-0.400 ± 1e-3"),
            (123.456, 0.5, "123.5 ± 5e-1"),
            (123.456, 40.0, "123 ± 4e1"),
            (1.5e9, 2e6, "1.500e9 ± 2e6"),
            (-2.4e-6, 3e-9, "-2.400e-6 ± 3e-9"),
            (4.0, 0.0, "4.000000000"),
            (0.0, 2e-7, "0 ± 2e-7"),
            (3.2e-5, 1e-3, "0.000 ± 1e-3"),
        ] {
            assert_eq!(with_error(value, error), text);
        }
    }
}
