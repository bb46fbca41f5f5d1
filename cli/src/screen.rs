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

/// A row of a table of two columns.
pub fn row(name: &str, text: String) -> Vec<String> {
    vec![name.to_owned(), text]
}

/// A table of text with aligned columns, indented by two spaces.
pub fn table(rows: &[Vec<String>]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut out = String::new();
    for row in rows {
        let mut line = String::new();
        for (column, cell) in row.iter().enumerate() {
            let fill = widths[column].saturating_sub(cell.chars().count());
            line.push_str("  ");
            line.push_str(cell);
            line.extend(std::iter::repeat_n(' ', fill));
        }
        out.push_str(line.trim_end());
        out.push('\n');
    }
    out
}
