//! Fuzzing of the case reader: mutated case files are either read or refused with a message, and never stop
//! the program. `FLEXION_FUZZ_SECONDS=600` fuzzes for ten minutes instead of a fixed small number of files.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use flexion_case::{choices, parse};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Files tried when no time is given.
const FILES: usize = 4000;

/// What a careless author may write.
const ODDITIES: &[&str] = &[
    "nan",
    "-inf",
    "1e400",
    "-0",
    "1e-320",
    "9223372036854775808",
    "0x10",
    "1_000",
    "\"\"",
    "\"1 furlong\"",
    "\"4 rad/s\"",
    "\"1e400 m\"",
    "\"-1 m\"",
    "\"sin(t)\"",
    "\"1/0\"",
    "\"((((t\"",
    "[]",
    "[[]]",
    "{}",
    "{ kind = 3 }",
    "true",
    "1979-05-27",
    "\u{0}",
    "\u{feff}",
    "µ",
    "é",
    "\"\"\"",
    "'''",
    "\\u0000",
    "[",
    "]",
    "[[",
    "=",
    "= =",
    ".",
    "#",
    "\n",
    "\r",
    "\t",
    "[beam]",
    "kind = \"",
];

fn cases() -> Vec<(PathBuf, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../verification");
    let mut cases: Vec<(PathBuf, String)> = std::fs::read_dir(folder)
        .unwrap()
        .filter_map(|entry| {
            let file = entry.unwrap().path().join("case.toml");
            std::fs::read_to_string(&file).ok().map(|text| (file, text))
        })
        .collect();
    cases.sort();
    cases
}

/// A place between two characters of `text`.
fn place(random: &mut fastrand::Rng, text: &str) -> usize {
    let mut at = random.usize(..=text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

fn span(random: &mut fastrand::Rng, text: &str) -> std::ops::Range<usize> {
    let (a, b) = (place(random, text), place(random, text));
    let end = a.max(b).min(a.min(b) + 40);
    let end = (a.min(b)..=end).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(a.min(b));
    a.min(b)..end
}

fn words() -> Vec<String> {
    let mut words: Vec<String> = ODDITIES.iter().map(|word| (*word).to_owned()).collect();
    for choice in choices() {
        for kind in choice.kinds() {
            words.push(format!("\"{}\"", kind.name));
            words.extend(kind.keys.iter().map(|key| key.name.to_owned()));
        }
    }
    words
}

fn mutate(random: &mut fastrand::Rng, text: &mut String, words: &[String], others: &[(PathBuf, String)]) {
    match random.u8(..8) {
        0 => {
            let range = span(random, text);
            text.replace_range(range, "");
        }
        1 => {
            let (range, at) = (span(random, text), place(random, text));
            let copy = text[range].to_owned();
            text.insert_str(at, &copy);
        }
        2 => {
            let at = place(random, text);
            text.insert_str(at, &words[random.usize(..words.len())]);
        }
        3 => {
            // A value for another: the likeliest mistake.
            let lines: Vec<&str> = text.lines().collect();
            let line = random.usize(..lines.len().max(1));
            let changed: Vec<String> = lines
                .iter()
                .enumerate()
                .map(|(k, old)| match old.split_once('=') {
                    Some((key, _)) if k == line => format!("{key}= {}", words[random.usize(..words.len())]),
                    _ => (*old).to_owned(),
                })
                .collect();
            *text = changed.join("\n");
        }
        4 => {
            let other = &others[random.usize(..others.len())].1;
            let (range, at) = (span(random, other), place(random, text));
            text.insert_str(at, &other[range]);
        }
        5 => {
            let at = place(random, text);
            text.insert(at, random.char(..));
        }
        6 => {
            // Digits make numbers that are too large or too many.
            let at = text.char_indices().filter(|(_, c)| c.is_ascii_digit()).map(|(k, _)| k);
            let digits: Vec<usize> = at.collect();
            if !digits.is_empty() {
                let at = digits[random.usize(..digits.len())];
                text.insert_str(at, ["9", "0", "-", ".", "e", "e9", "e-9", "00000000"][random.usize(..8)]);
            }
        }
        _ => {
            let mut lines: Vec<&str> = text.lines().collect();
            random.shuffle(&mut lines);
            *text = lines.join("\n");
        }
    }
}

#[test]
fn a_mutated_case_is_read_or_refused_with_a_message() {
    let (cases, words) = (cases(), words());
    assert!(cases.len() > 20, "the verification cases are the seeds");
    let seconds = std::env::var("FLEXION_FUZZ_SECONDS").ok().and_then(|text| text.parse::<u64>().ok());
    let until = seconds.map(|seconds| Instant::now() + Duration::from_secs(seconds));
    let seed = std::env::var("FLEXION_FUZZ_SEED").ok().and_then(|text| text.parse().ok()).unwrap_or(1);
    let mut random = fastrand::Rng::with_seed(seed);
    let (mut read, mut refused, mut slowest) = (0_usize, 0_usize, Duration::ZERO);
    for count in 0.. {
        if until.map_or(count >= FILES, |until| Instant::now() > until) {
            break;
        }
        let (file, text) = &cases[random.usize(..cases.len())];
        let mut text = text.clone();
        for _ in 0..[1, 1, 1, 2, 4][random.usize(..5)] {
            mutate(&mut random, &mut text, &words, &cases);
        }
        let begun = Instant::now();
        let shown = text.clone();
        let outcome = std::panic::catch_unwind(|| match parse(text, file, &[]) {
            Ok(reading) => reading.build().map(drop),
            Err(problems) => Err(problems),
        });
        if begun.elapsed() > slowest {
            slowest = begun.elapsed();
            if slowest > Duration::from_secs(20) {
                eprintln!("{slowest:?} for this case:\n{shown}");
            }
        }
        match outcome {
            Ok(Ok(())) => read += 1,
            Ok(Err(problems)) => {
                refused += 1;
                assert!(!problems.list.is_empty(), "refused without a reason:\n{shown}");
                for problem in &problems.list {
                    assert!(!problem.message.is_empty(), "a problem without a message:\n{shown}");
                }
                assert!(!problems.to_string().is_empty());
            }
            Err(_) => {
                panic!("reading stopped the program (seed {seed}, file {count}) on this case:\n{shown}")
            }
        }
    }
    eprintln!("{read} cases read, {refused} refused; the slowest took {slowest:?}");
    // Both ways must have been taken, or the mutations say nothing.
    assert!(read > 0 && refused > 0, "{read} read, {refused} refused");
}
