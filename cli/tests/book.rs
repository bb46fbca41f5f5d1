//! The commands of the book: each block of them is run, page by page, in a folder of its own.

#![cfg(unix)]
#![allow(clippy::unwrap_used)] // in helpers of tests

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A block of a page: what stands behind the three marks, the line before it, and its text.
struct Block {
    info: String,
    before: String,
    text: String,
}

fn blocks(page: &str) -> Vec<Block> {
    let mut out = Vec::new();
    let mut open: Option<Block> = None;
    let mut before = String::new();
    for line in page.lines() {
        match (line.strip_prefix("```"), &mut open) {
            (Some(_), Some(_)) => out.extend(open.take()),
            (Some(info), None) => {
                open = Some(Block { info: info.to_owned(), before: before.clone(), text: String::new() });
            }
            (None, Some(block)) => block.text += &format!("{line}\n"),
            (None, None) if !line.is_empty() => before = line.to_owned(),
            (None, None) => {}
        }
    }
    out
}

fn pages(folder: &Path) -> Vec<PathBuf> {
    let mut out = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            out.extend(pages(&path));
        } else if path.extension().is_some_and(|end| end == "md") {
            out.push(path);
        }
    }
    out.sort();
    out
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        let to = to.join(path.file_name().unwrap());
        if path.is_dir() { copy(&path, &to) } else { fs::copy(&path, &to).map(|_| ()).unwrap() }
    }
}

/// The name between backquotes that ends a line: "…, `boom.toml`:".
fn file(line: &str) -> Option<&str> {
    line.strip_suffix("`:")?.rsplit('`').next()
}

#[test]
fn each_command_of_the_book_runs() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let program = Path::new(env!("CARGO_BIN_EXE_flexion")).parent().unwrap();
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap());
    let pages = Mutex::new(pages(&root.join("docs/src")));
    let next = || pages.lock().unwrap().pop();
    let run = AtomicUsize::new(0);
    let worker = || {
        while let Some(page) = next() {
            run.fetch_add(commands_of(&page, root, &path), Ordering::Relaxed);
        }
    };
    std::thread::scope(|scope| {
        (0..std::thread::available_parallelism().map_or(1, usize::from)).for_each(|_| {
            scope.spawn(worker);
        });
    });
    let run = run.into_inner();
    assert!(run > 20, "{run} blocks");
}

/// Runs the commands of a page, one after the other in a folder of its own that has the cases: how many they are.
fn commands_of(page: &Path, root: &Path, path: &str) -> usize {
    let blocks = blocks(&fs::read_to_string(page).unwrap());
    if !blocks.iter().any(|block| block.info.starts_with("sh")) {
        return 0;
    }
    let folder = tempfile::tempdir().unwrap();
    copy(&root.join("verification"), &folder.path().join("verification"));
    let mut run = 0;
    for block in blocks {
        if let ("toml", Some(name)) = (block.info.as_str(), file(&block.before)) {
            fs::write(folder.path().join(name), &block.text).unwrap();
        }
        let fails = match block.info.as_str() {
            "sh" => false,
            "sh fails" => true,
            _ => continue,
        };
        // The first run is spelt as someone types it who has not installed the program.
        let text = block.text.replace("cargo run --release -- ", "flexion ");
        let output = Command::new("sh")
            .args(["-e", "-c", &text])
            .env("PATH", path)
            .current_dir(folder.path())
            .output()
            .unwrap();
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.success(), !fails, "{}:\n{text}{message}", page.display());
        run += 1;
    }
    run
}
