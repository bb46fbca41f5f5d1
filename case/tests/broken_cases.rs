//! Every broken case in `broken_cases/NAME.toml` is refused with exactly the report in `NAME.txt`.
//!
//! A line `# set: KEY=VALUE` of a case stands for `--set KEY=VALUE`. After a deliberate change of a
//! message, `FLEXION_ACCEPT=1 cargo test --test broken_cases` rewrites the reports: read the diff.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)] // in helpers of tests

use std::path::Path;

#[test]
fn every_broken_case_is_refused_with_its_report() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/broken_cases");
    let accept = std::env::var_os("FLEXION_ACCEPT").is_some();
    let mut names: Vec<String> = std::fs::read_dir(&folder)
        .unwrap()
        .filter_map(|entry| {
            entry.unwrap().file_name().into_string().unwrap().strip_suffix(".toml").map(String::from)
        })
        .collect();
    names.sort();
    assert!(names.len() >= 30, "{} cases", names.len());
    let mut wrong = Vec::new();
    for name in &names {
        let text = std::fs::read_to_string(folder.join(format!("{name}.toml"))).unwrap();
        let overrides: Vec<String> =
            text.lines().filter_map(|line| line.strip_prefix("# set: ").map(String::from)).collect();
        let report = match refusal(text, &folder, name, &overrides) {
            Some(report) => report,
            None => {
                wrong.push(format!("{name} is accepted"));
                continue;
            }
        };
        let expected = folder.join(format!("{name}.txt"));
        if accept {
            std::fs::write(&expected, &report).unwrap();
        } else if std::fs::read_to_string(&expected).ok().as_deref() != Some(&report) {
            wrong.push(format!("{name} reports\n{report}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The report of a case, with the folder left out of it.
fn refusal(text: String, folder: &Path, name: &str, overrides: &[String]) -> Option<String> {
    let file = folder.join(format!("{name}.toml"));
    let problems = match flexion_case::parse(text, &file, overrides) {
        Err(problems) => problems,
        Ok(_) => return None,
    };
    let trimmed: Vec<String> =
        problems.render(false).lines().map(|line| line.trim_end().to_owned()).collect();
    Some(without_condition_number(&trimmed.join("\n").replace(&format!("{}/", folder.display()), "")) + "\n")
}

/// The condition number of a nearly singular matrix is rounding noise, another on every processor.
fn without_condition_number(report: &str) -> String {
    const BEFORE: &str = "condition number ";
    let Some((head, tail)) = report.split_once(BEFORE) else { return report.to_owned() };
    let rest = tail.split_once(' ').map_or("", |(_, rest)| rest);
    format!("{head}{BEFORE}(large) {rest}")
}

#[test]
fn problems_stand_at_their_lines_and_columns() {
    let text = "[beam]\nlength = \"10 s\"\n[section]\nkind = \"circle\"\nmodulus = 1e9\ndensity = -1\nradius = \"1 cm\"\n[hub.motion]\nkind = \"constant\"\nspeed = \"4 Hz\"\n[run]\nduration = 1\n";
    let problems = flexion_case::parse(text.to_owned(), Path::new("case.toml"), &[]).unwrap_err();
    let places: Vec<_> =
        problems.list.iter().map(|p| (p.key.as_str(), problems.line_and_column(p))).collect();
    assert_eq!(
        places,
        [
            ("beam.length", Some((2, 14))),
            ("section.density", Some((6, 11))),
            ("hub.motion.speed", Some((10, 12)))
        ]
    );
}
