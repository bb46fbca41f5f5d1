//! `flexion reproduce`: figures, tables and claims of papers, computed again.

use crate::run::stop_on_ctrl_c;
use crate::{Outcome, screen};
use flexion_reproduce::{
    Answer, Counts, Described, Options, Progress, Reproduced, built_in, built_in_names, check, comparable,
    compute, expected, from_folder, identity_of_program, of_paper, write,
};
use flexion_results::{Artifact, Directory, try_file, write_file};
use indicatif::{ProgressBar, ProgressStyle};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

/// Papers, and what becomes of them.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  flexion reproduce
  flexion reproduce P1 P4/F9 --output results/reproduce
  flexion reproduce all --long
  flexion reproduce my_paper --output results/my_paper
  flexion reproduce P3 P5 --check

A paper is one of those that are built in, or a folder with a paper.toml; PAPER/ITEM is one figure or table of it. Runs that are done are kept in the
folder of the results, and the same program takes them up again. The page is report.html; the values are beside it as CSV. A new report takes the
place of a former one of the program, whole or not at all.

Exit codes: 0 all is computed (with --check: and as accepted); 1 a paper is rejected; 2 stopped, or with --check something has changed.")]
pub struct Arguments {
    /// Papers or items [default: all papers that are built in]
    #[arg(value_name = "PAPER")]
    papers: Vec<String>,
    /// Folder of the report
    #[arg(long, short, value_name = "DIR", default_value = "results/reproduce")]
    output: PathBuf,
    /// Compute the runs too that take long
    #[arg(long)]
    long: bool,
    /// Compare all values with those that were accepted, computing all anew, and write nothing
    #[arg(long)]
    check: bool,
    /// Write the values to expected.toml of a paper in a folder, for --check
    #[arg(long, conflicts_with = "check")]
    accept: bool,
    /// Number of threads [default: one for each processor]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    threads: usize,
    /// Write into a folder that holds other files too, which are left alone
    #[arg(long, conflicts_with = "check")]
    force: bool,
}

/// Where runs that are done are kept, within the folder of the report.
const KEPT: &str = "kept";
/// The accepted values of a paper, within its folder.
const EXPECTED: &str = "expected.toml";

/// A paper, where it is from, and its items that are asked for.
struct Asked {
    folder: Option<PathBuf>,
    paper: Described,
    items: Vec<String>,
}

/// Computes papers again.
pub fn reproduce(arguments: &Arguments) -> Outcome {
    let Some(papers) = asked(&arguments.papers) else { return Outcome::Rejected };
    if arguments.check || arguments.accept {
        let found = papers.iter().filter_map(|of| comparable(&of.paper, arguments.accept).err());
        let found: Vec<String> = found.map(|error| format!("error: {error}\n")).collect();
        if !found.is_empty() {
            screen::report(&found.concat());
            return Outcome::Rejected;
        }
    }
    if arguments.accept && papers.iter().any(|of| of.folder.is_none()) {
        screen::report(
            "error: --accept needs the folder of a paper, e.g. `flexion reproduce papers/P1 --accept`\n",
        );
        return Outcome::Rejected;
    }
    let stop = stop_on_ctrl_c();
    let stopped = || stop.load(Ordering::Relaxed);
    let common = Options {
        long: arguments.long,
        only: None,
        threads: arguments.threads,
        keep: (!arguments.check).then(|| arguments.output.join(KEPT)),
        identity: identity_of_program(),
    };
    let mut sound = true;
    for Asked { paper, items, .. } in &papers {
        if let Err(error) = flexion_reproduce::sound(paper, items, &common) {
            error.0.iter().for_each(|problem| screen::report(&format!("error: {problem}\n")));
            sound = false;
        }
    }
    if !sound {
        return Outcome::Rejected;
    }
    // What will be written is tried before anything is computed.
    let directory = match writable(arguments, &papers) {
        Ok(directory) => directory,
        Err(error) => {
            screen::report(&format!("error: {error}\n"));
            return Outcome::Rejected;
        }
    };
    let Some(answers) = computed(&papers, &common, &stopped) else {
        if let Some(directory) = &directory {
            directory.discard();
        }
        return Outcome::Incomplete;
    };
    let Some(directory) = directory else { return checked(&papers, &answers) };
    if arguments.accept
        && let Err(error) = accept(&papers, &answers)
    {
        screen::report(&format!("error: {error}\n"));
        directory.discard();
        return Outcome::Incomplete;
    }
    report(&papers, &answers, &directory)
}

/// The folder of the report, locked, after the accepted values of each paper have been tried; none with `--check`.
fn writable(
    arguments: &Arguments,
    papers: &[Asked],
) -> Result<Option<Directory>, flexion_results::OutputError> {
    if arguments.check {
        return Ok(None);
    }
    if arguments.accept {
        papers
            .iter()
            .filter_map(|of| of.folder.as_ref())
            .try_for_each(|folder| try_file(&folder.join(EXPECTED)))?;
    }
    Directory::renew(Artifact::REPORT, &arguments.output, arguments.force, KEPT).map(Some)
}

/// The answers of the runs of all papers; `None` where it was stopped, which is said.
fn computed(
    papers: &[Asked],
    common: &Options,
    stopped: &(dyn Fn() -> bool + Sync),
) -> Option<Vec<Vec<Option<Answer>>>> {
    let mut answers: Vec<Vec<Option<Answer>>> = Vec::new();
    for Asked { paper, items, .. } in papers {
        let (needs, numbers) = of_paper(paper);
        let only: BTreeSet<usize> =
            numbers.iter().filter(|((item, _), _)| items.contains(item)).map(|(_, number)| *number).collect();
        let options = Options { only: Some(only), ..common.clone() };
        let bar = ProgressBar::new(0);
        if let Ok(style) = ProgressStyle::with_template("{prefix} {wide_bar} {pos}/{len} runs  {eta} left") {
            bar.set_style(style);
        }
        bar.set_prefix(paper.name.clone());
        let computed = compute(&paper.cases, &needs, &options, stopped, &|Progress { done, of, .. }| {
            bar.set_length(of as u64);
            bar.set_position(done as u64);
        });
        bar.finish_and_clear();
        match computed {
            Ok(computed) => answers.push(computed),
            Err(error) => {
                screen::report(&format!("{error}\n"));
                return None;
            }
        }
    }
    Some(answers)
}

/// Writes what came out as the accepted values of papers in folders.
fn accept(papers: &[Asked], answers: &[Vec<Option<Answer>>]) -> Result<(), String> {
    for (of, answers) in papers.iter().zip(answers) {
        let Some(folder) = &of.folder else { continue };
        let text = expected(&of.paper, answers).map_err(|error| error.to_string())?;
        write_file(&folder.join(EXPECTED), text.as_bytes()).map_err(|error| error.to_string())?;
    }
    Ok(())
}

/// Writes the report and says what came out.
fn report(papers: &[Asked], answers: &[Vec<Option<Answer>>], directory: &Directory) -> Outcome {
    let reproduced: Vec<Reproduced<'_>> = papers
        .iter()
        .zip(answers)
        .map(|(of, answers)| Reproduced { paper: &of.paper, answers, items: of.items.clone() })
        .collect();
    let files = match write(&reproduced, directory) {
        Ok(files) => files,
        Err(error) => {
            directory.discard();
            screen::report(&format!("error: {error}\n"));
            return Outcome::Incomplete;
        }
    };
    let mut rows = vec![counted("paper", "results", Counts::NAMES.map(str::to_owned))];
    let of = |name: &str, counts: &Counts| {
        counted(name, &counts.results.to_string(), counts.paper.map(|n| n.to_string()))
    };
    let all: Vec<Counts> = reproduced.iter().map(Reproduced::counts).collect();
    rows.extend(reproduced.iter().zip(&all).map(|(paper, counts)| of(&paper.paper.name, counts)));
    let sum = all.iter().fold(Counts::default(), |sum, counts| sum.plus(*counts));
    if all.len() > 1 {
        rows.push(of("all", &sum));
    }
    screen::print(&screen::table(&rows));
    let beside: Vec<String> = Counts::NAMES
        .iter()
        .zip(sum.ours)
        .filter(|(_, n)| *n > 0)
        .map(|(name, n)| format!("{name} {n}"))
        .collect();
    if !beside.is_empty() {
        screen::print(&format!("\n  claims of ours beside the papers: {}\n", beside.join(", ")));
    }
    if let Some(report) = files.iter().find(|file| file.ends_with("report.html")) {
        screen::print(&format!("\n  report  {}\n", report.display()));
    }
    Outcome::Finished
}

/// A row of what came out.
fn counted(name: &str, results: &str, counts: [String; 5]) -> Vec<String> {
    [name.to_owned(), results.to_owned()].into_iter().chain(counts).collect()
}

/// The papers that these words name; what is wrong goes to standard error.
fn asked(words: &[String]) -> Option<Vec<Asked>> {
    let all = |word: &String| if word == "all" { built_in_names() } else { vec![word.clone()] };
    let names: Vec<String> =
        if words.is_empty() { built_in_names() } else { words.iter().flat_map(all).collect() };
    let mut out: Vec<Asked> = Vec::new();
    let mut sound = true;
    for word in &names {
        let Place { folder, name, item } = place(word);
        let read = folder.as_deref().map_or_else(|| built_in(&name), from_folder);
        match read {
            Ok(paper) => sound &= take(&mut out, folder, paper, item),
            Err(error) => {
                screen::report(&format!("error: {error}\n"));
                sound = false;
            }
        }
    }
    sound.then_some(out)
}

/// What a word names: a paper in a folder or one that is built in, and perhaps an item of it.
struct Place {
    folder: Option<PathBuf>,
    name: String,
    item: Option<String>,
}

fn place(word: &str) -> Place {
    let of = |name: &str, item: Option<&str>| {
        let built_in = built_in_names().iter().any(|built| built == name);
        let there = !built_in && Path::new(name).join("paper.toml").is_file();
        let item = item.map(str::to_owned);
        if built_in && Path::new(name).join("paper.toml").is_file() {
            screen::report(&format!("{name} is the paper that is built in; the folder is ./{name}\n"));
        }
        (built_in || there).then(|| Place { folder: there.then(|| name.into()), name: name.to_owned(), item })
    };
    let with_item = || word.rsplit_once('/').and_then(|(name, item)| of(name, Some(item)));
    of(word, None).or_else(with_item).unwrap_or_else(|| Place {
        // A folder without a paper.toml says so.
        folder: Path::new(word).is_dir().then(|| word.into()),
        name: word.to_owned(),
        item: None,
    })
}

/// Takes up a paper, or one item more of it; whether it has the item.
fn take(out: &mut Vec<Asked>, folder: Option<PathBuf>, paper: Described, item: Option<String>) -> bool {
    let there: Vec<String> = paper.items.iter().map(|(id, _)| id.clone()).collect();
    if let Some(item) = item.as_ref().filter(|item| !there.contains(item)) {
        let nearest = flexion_results::nearest(item, there.iter().map(String::as_str));
        let nearest = nearest.map_or(String::new(), |name| format!("; perhaps {name}"));
        screen::report(&format!(
            "error: {} has no item {item}{nearest}; it has {}\n",
            paper.name,
            there.join(", ")
        ));
        return false;
    }
    if out.iter().any(|of| of.paper.name == paper.name && of.folder != folder) {
        screen::report(&format!(
            "error: two papers are called {}: their results would replace each other\n",
            paper.name
        ));
        return false;
    }
    let items = item.map_or(there, |item| vec![item]);
    match out.iter_mut().find(|of| of.paper.name == paper.name && of.folder == folder) {
        Some(of) => of.items.extend(items),
        None => out.push(Asked { folder, paper, items }),
    }
    true
}

/// Compares with what was accepted.
fn checked(papers: &[Asked], answers: &[Vec<Option<Answer>>]) -> Outcome {
    let mut outcome = Outcome::Finished;
    for (of, answers) in papers.iter().zip(answers) {
        match check(&of.paper, answers) {
            Ok(found) => {
                found.listed.iter().for_each(|line| screen::print(&format!("{}: {line}\n", of.paper.name)));
                found.failed.iter().for_each(|line| screen::report(&format!("{}: {line}\n", of.paper.name)));
                let (compared, failed) = (found.compared, found.failed.len());
                screen::print(&format!(
                    "{}: {compared} values and verdicts compared, {failed} have changed by more than their errors\n",
                    of.paper.name
                ));
                if failed > 0 {
                    outcome = Outcome::Incomplete;
                }
            }
            Err(error) => {
                screen::report(&format!("error: {error}\n"));
                return Outcome::Rejected;
            }
        }
    }
    outcome
}
