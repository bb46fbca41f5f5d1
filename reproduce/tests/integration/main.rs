//! Papers as data: that they are whole, that verdicts follow from values, and that answers are kept.

#![allow(clippy::unwrap_used, clippy::panic)]

mod rejections;

use flexion_reproduce::{
    Answer, Described, Options, Reproduced, Stopped, built_in, built_in_names, check, compute, expected,
    from_folder, of_paper, sound, write,
};
use flexion_results::{Artifact, Directory};
use std::path::Path;

/// The numbered items of the five papers.
const ITEMS: [(&str, &[&str]); 5] = [
    ("P1", &["F1", "F2", "F3", "F4", "F5", "F6", "F7", "F8", "F9", "F10", "F11", "T1", "T2", "T3"]),
    ("P2", &["F1", "F2", "F3", "F4", "F5", "F6", "F7", "F8", "T1"]),
    ("P3", &["F1", "F2", "F3", "F4", "F5", "F6", "F7", "F8", "F9", "F10", "F11", "T1", "T2"]),
    ("P4", &["F1", "F2", "F3", "F4", "F5", "F6", "F7", "F8", "F9", "T1"]),
    ("P5", &["F1", "F2"]),
];

fn computed(paper: &Described, options: &Options) -> Vec<Option<Answer>> {
    compute(&paper.cases, &of_paper(paper).0, options, &|| false, &|_| ()).unwrap()
}

/// The answers of one item.
fn of_item(paper: &Described, item: &str) -> Vec<Option<Answer>> {
    let numbers = of_paper(paper).1;
    let only = numbers.iter().filter(|((of, _), _)| of == item).map(|(_, number)| *number).collect();
    computed(paper, &Options { only: Some(only), ..Options::default() })
}

fn verdicts(paper: &Described, item: &str) -> Vec<&'static str> {
    let answers = of_item(paper, item);
    let reproduced = Reproduced { paper, answers: &answers, items: vec![item.to_owned()] };
    reproduced.verdicts().iter().map(|(_, verdict)| verdict.word()).collect()
}

#[test]
fn all_items_of_the_five_papers_are_there() {
    assert_eq!(built_in_names(), ITEMS.map(|(name, _)| name));
    let (mut drawings, mut results) = (0, 0);
    for (name, items) in ITEMS {
        let paper = built_in(name).unwrap();
        let mut there: Vec<&str> = paper.items.iter().map(|(id, _)| id.as_str()).collect();
        let mut wanted = items.to_vec();
        there.sort_unstable();
        wanted.sort_unstable();
        assert_eq!(there, wanted, "{name}");
        for (id, item) in &paper.items {
            assert!(item.survives.is_some(), "{name} {id} does not say what of the paper survives");
            if item.kind == flexion_reproduce::ItemKind::Drawing {
                drawings += 1;
                assert!(paper.drawings.contains_key(item.drawing.as_ref().unwrap()), "{name} {id}");
            } else {
                results += 1;
                assert!(!item.claims.is_empty(), "{name} {id} has no verdict");
                assert!(item.table.is_some() || !item.plots.is_empty(), "{name} {id} has no value of ours");
            }
        }
    }
    assert_eq!((drawings, results), (11, 37));
}

/// Words of papers are in their data only.
#[test]
fn no_source_names_a_paper() {
    for file in std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("src")).unwrap() {
        let path = file.unwrap().path();
        let text = std::fs::read_to_string(&path).unwrap();
        for (name, _) in ITEMS {
            let named = text.split(|letter: char| !letter.is_alphanumeric()).any(|word| word == name);
            assert!(!named, "{} names {name}", path.display());
        }
    }
}

fn paper_of(folder: &Path, item: &str) -> Described {
    let put = |name: &str, text: &str| {
        let path = folder.join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    };
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("../verification/p1_spin_up_4/case.toml");
    put("cases/spin_up.toml", &std::fs::read_to_string(case).unwrap());
    put(
        "paper.toml",
        "title = 'Title <script>'\nauthors = 'A'\nsource = 'S'\nabout = 'About'\nitems = ['F1']\n",
    );
    put("F1.toml", item);
    from_folder(folder).unwrap()
}

const RUNS: &str = "title = 'Tip'
kind = 'figure'
[[run]]
name = 'few'
case = 'spin_up'
set = ['run.duration=6 s', 'basis={kind=\"modes\",axial=2,transverse=2}']
[[run]]
name = 'many'
case = 'spin_up'
set = ['run.duration=6 s', 'basis={kind=\"modes\",axial=4,transverse=4}']
[[run]]
name = 'breaks'
case = 'spin_up'
set = ['model.coupling=\"zeroth\"', 'hub.motion.speed=20 rad/s']
against = []
[[plot]]
y = 'tip.deflection'
[table]
columns = [{ title = 'smallest', quantity = 'tip.deflection.min', unit = 'mm' }]
";

/// Every kind of rule holds in one case and fails in another.
#[test]
fn each_kind_of_rule_is_flipped_by_a_changed_case() {
    let min = |run: &str| format!("{{ run = '{run}', quantity = 'tip.deflection.min' }}");
    let rules = [
        format!("{{ kind = 'less', left = {}, right = -0.3 }}", min("many")),
        format!("{{ kind = 'within', of = {}, low = -0.4, high = -0.3 }}", min("many")),
        "{ kind = 'agree', runs = ['many', 'few'], quantity = 'tip.deflection.min', within = 0.01 }".to_owned(),
        "{ kind = 'agree', runs = ['many', 'few'], quantity = 'tip.deflection@..5', within = 0.01, curves = true }".to_owned(),
        "{ kind = 'falls', runs = ['many', 'breaks'], quantity = 'run.end' }".to_owned(),
        "{ kind = 'grows', runs = ['breaks', 'many'], quantity = 'run.end' }".to_owned(),
        "{ kind = 'ends-early', runs = ['breaks'] }".to_owned(),
        "{ kind = 'finishes', runs = ['few', 'many'] }".to_owned(),
        format!("{{ kind = 'all', rules = [{{ kind = 'finishes', runs = ['few'] }}, {{ kind = 'less', left = {}, right = -0.3 }}] }}", min("few")),
        format!("{{ kind = 'less', left = {}, right = -3, times = 10 }}", min("many")),
        format!("{{ kind = 'any', rules = [{{ kind = 'ends-early', runs = ['few'] }}, {{ kind = 'less', left = {}, right = -0.3 }}] }}", min("many")),
        "{ kind = 'lost', because = 'It is lost.' }".to_owned(),
    ];
    let claims: Vec<String> = rules
        .iter()
        .map(|rule| format!("[[claim]]\ntext = 'T'\nholds = 'H'\nfails = 'F'\nrule = {rule}\n"))
        .collect();
    let text = format!("{RUNS}{}", claims.concat());
    let folder = tempfile::tempdir().unwrap();
    let found = verdicts(&paper_of(folder.path(), &text), "F1");
    assert_eq!(
        found,
        [
            "holds", "holds", "holds", "holds", "holds", "holds", "holds", "holds", "holds", "holds",
            "holds", "lost"
        ]
    );
    let many = "set = ['run.duration=6 s', 'basis={kind=\"modes\",axial=4,transverse=4}']";
    let stiff = "set = ['run.duration=6 s', 'section.modulus=700 GPa', 'basis={kind=\"modes\",axial=4,transverse=4}']";
    let breaks = "'model.coupling=\"zeroth\"', 'hub.motion.speed=20 rad/s'";
    type Changed<'a> = (&'a [(&'a str, &'a str)], [&'a str; 12]);
    let changes: [Changed<'_>; 2] = [
        (
            &[(many, stiff), (breaks, "'run.duration=7 s'")],
            [
                "fails", "fails", "fails", "fails", "fails", "fails", "fails", "holds", "holds", "fails",
                "fails", "lost",
            ],
        ),
        (
            &[(
                "'run.duration=6 s', 'basis={kind=\"modes\",axial=2",
                "'model.coupling=\"zeroth\"', 'hub.motion.speed=20 rad/s', 'basis={kind=\"modes\",axial=2",
            )],
            ["holds", "holds", "", "", "holds", "holds", "holds", "fails", "fails", "holds", "holds", "lost"],
        ),
    ];
    for (changes, expected) in changes {
        let changed = changes.iter().fold(text.clone(), |text, (from, to)| {
            assert!(text.contains(from), "{from}");
            text.replace(from, to)
        });
        let folder = tempfile::tempdir().unwrap();
        let found = verdicts(&paper_of(folder.path(), &changed), "F1");
        for (i, (found, expected)) in found.iter().zip(expected).enumerate() {
            assert!(expected.is_empty() || *found == expected, "rule {i}: {found}");
        }
    }
}

/// A claim of each paper is flipped by another case: a stiffer or a shorter beam, a coarse mesh, numerical damping.
#[test]
fn a_changed_case_flips_a_verdict_of_each_paper() {
    let changes = [
        ("P1", "F10", "modulus=5 GPa", "modulus=200 GPa"),
        ("P2", "F6", "elements={n}", "elements=2"),
        ("P3", "F11", "ceramic-modulus=15.1 GPa", "ceramic-modulus=151 GPa"),
        ("P4", "F6", "alpha=0,", "alpha=0.3333,"),
        ("P5", "F2", "400 N", "40000 N"),
    ];
    for (name, item, from, to) in changes {
        let mut paper = built_in(name).unwrap();
        // A second of a motion in space is enough.
        let short = (name == "P2").then(|| "run.duration=1 s".to_owned());
        for run in paper.items.iter_mut().flat_map(|(_, item)| &mut item.runs) {
            run.set.extend(short.clone());
        }
        let before = verdicts(&paper, item);
        let mut changed = paper.clone();
        let mut replaced = 0;
        for run in changed.items.iter_mut().filter(|(id, _)| id == item).flat_map(|(_, item)| &mut item.runs)
        {
            for set in &mut run.set {
                replaced += set.matches(from).count();
                *set = set.replace(from, to);
            }
        }
        assert!(replaced > 0, "{name} {item} has no {from}");
        assert_ne!(before, verdicts(&changed, item), "{name} {item}");
    }
}

#[test]
fn answers_are_kept_and_a_torn_one_is_computed_again() {
    let folder = tempfile::tempdir().unwrap();
    let paper = paper_of(folder.path(), RUNS);
    let keep = folder.path().join("kept");
    let options =
        Options { keep: Some(keep.clone()), identity: "this".to_owned(), threads: 1, ..Options::default() };
    let needs = of_paper(&paper).0;
    // Stopped behind the first run.
    let done = std::sync::atomic::AtomicUsize::new(0);
    let stop = || done.load(std::sync::atomic::Ordering::Relaxed) >= 1;
    let count = |_| {
        done.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
    };
    assert_eq!(compute(&paper.cases, &needs, &options, &stop, &count), Err(Stopped));
    let found = |options: &Options| {
        let found = std::sync::atomic::AtomicUsize::new(0);
        let answers = compute(&paper.cases, &needs, options, &|| false, &|progress| {
            found.fetch_max(progress.found, std::sync::atomic::Ordering::Relaxed);
        });
        (answers.unwrap(), found.into_inner())
    };
    let (answers, before) = found(&options);
    assert_eq!(before, 1);
    assert_eq!(found(&options), (answers.clone(), 3));
    let mut files: Vec<_> = std::fs::read_dir(&keep).unwrap().map(|file| file.unwrap().path()).collect();
    files.sort();
    let whole = std::fs::read(&files[0]).unwrap();
    std::fs::write(&files[0], &whole[..whole.len() / 2]).unwrap();
    let edited = std::fs::read_to_string(&files[1]).unwrap().replacen("value\":", "value\":1", 1);
    std::fs::write(&files[1], edited).unwrap();
    let (again, found_again) = found(&options);
    assert_eq!(found_again, 1);
    let timeless = |answers: &[Option<Answer>]| -> Vec<Option<Answer>> {
        answers.iter().cloned().map(|answer| answer.map(|answer| Answer { seconds: 0.0, ..answer })).collect()
    };
    assert_eq!(timeless(&again), timeless(&answers));
    // One under the name of another is none.
    std::fs::copy(&files[0], &files[2]).unwrap();
    assert_eq!(found(&options).1, 2);
    // Another program finds nothing.
    assert_eq!(found(&Options { identity: "other".to_owned(), ..options }).1, 0);
}

/// The page holds no mark that a paper has in its texts, asks for no other file, and is the same on any number of threads.
#[test]
fn the_page_is_the_same_twice_and_holds_no_foreign_mark() {
    let folder = tempfile::tempdir().unwrap();
    let paper = paper_of(folder.path(), RUNS);
    let page = |threads: usize| {
        let answers = computed(&paper, &Options { threads, ..Options::default() });
        let answers: Vec<Option<Answer>> = answers
            .into_iter()
            .map(|answer| answer.map(|answer| Answer { seconds: 0.0, ..answer }))
            .collect();
        let to = folder.path().join(format!("report{threads}"));
        let reproduced = Reproduced { paper: &paper, answers: &answers, items: vec!["F1".to_owned()] };
        let to = Directory::renew(Artifact::REPORT, to, false, "kept").unwrap();
        let files = write(&[reproduced], &to).unwrap();
        files.iter().map(|file| std::fs::read_to_string(file).unwrap()).collect::<Vec<_>>()
    };
    let pages = page(1);
    assert_eq!(pages, page(2));
    let report = pages.last().unwrap();
    assert!(report.contains("Title &lt;script&gt;") && report.matches("<script>").count() == 1);
    for foreign in ["src=", "url(", "@import", "<link"] {
        assert!(!report.contains(foreign), "{foreign}");
    }
    assert!(report.contains("<polygon") || report.contains("<polyline"));
}

#[test]
fn a_check_finds_changed_values_and_grown_errors() {
    let folder = tempfile::tempdir().unwrap();
    let mut paper = paper_of(
        folder.path(),
        &format!("{RUNS}[[claim]]\ntext = 'T'\nrule = {{ kind = 'finishes', runs = ['few'] }}\n"),
    );
    let answers = computed(&paper, &Options::default());
    assert!(check(&paper, &answers).unwrap_err().to_string().contains("--accept"));
    paper.expected = Some(expected(&paper, &answers).unwrap());
    let found = check(&paper, &answers).unwrap();
    assert!(found.failed.is_empty() && found.listed.is_empty() && found.compared >= 3, "{found:?}");
    let accepted = paper.expected.clone().unwrap();
    let changed = |change: &dyn Fn(&mut flexion_reproduce::Valued)| {
        let mut answers = answers.clone();
        let values = answers.iter_mut().flatten().flat_map(|answer| answer.values.values_mut()).flatten();
        values.take(1).for_each(change);
        check(&paper, &answers).unwrap()
    };
    let [far, near, grown] = [
        changed(&|value| value.value *= 1.5),
        changed(&|value| value.value += 0.5 * value.error.unwrap()),
        changed(&|value| value.error = value.error.map(|error| 20.0 * error)),
    ];
    assert_eq!((far.failed.len(), near.failed.len(), near.listed.len(), grown.failed.len()), (1, 0, 1, 1));
    let value = accepted.lines().find(|line| line.contains("deflection.min")).unwrap();
    let no_number = format!("{}= [nan, 1.0]", value.split("= ").next().unwrap());
    for error in ["[nan, 1.0]", "[1.0, nan]", "[1.0, inf]", "[1.0, -2.0]"] {
        paper.expected = Some(accepted.replace(value, &no_number.replace("[nan, 1.0]", error)));
        assert!(check(&paper, &answers).unwrap_err().to_string().contains("deflection.min"));
        assert!(expected(&paper, &answers).is_err());
    }
    paper.expected = Some(format!("{accepted}\n[curves]\n"));
    assert!(check(&paper, &answers).unwrap_err().to_string().contains("curves"));
    // An accepted error that lets anything pass.
    let lax = format!("{}, 1e300]", value.rsplit_once(", ").unwrap().0);
    paper.expected = Some(accepted.replace(value, &lax));
    assert!(check(&paper, &answers).unwrap().failed[0].contains("--accept"));
    paper.expected =
        Some(accepted.replace("\"F1.1\" = \"holds\"", "\"F1.1\" = \"holds\"\n\"F1.9\" = \"holds\""));
    assert_eq!(check(&paper, &answers).unwrap().failed, ["claim F1.9 is gone"]);
    paper.expected = Some(accepted.replace("\"holds\"", "\"fails\""));
    assert_eq!(check(&paper, &answers).unwrap().failed.len(), 1);
    // A value that a run has no more is missed though another run was left out, and so are runs and items that the paper has no more.
    let (mut some, less) = (answers.clone(), accepted.replace("deflection.min", "deflection.max"));
    assert!(some.len() > 1);
    some[1] = None;
    paper.expected = Some(accepted.clone());
    assert_eq!(check(&paper, &some).unwrap().failed, [""; 0]);
    paper.expected = Some(less);
    let found = check(&paper, &some).unwrap().failed;
    assert!(found.iter().any(|said| said.ends_with("deflection.max is gone")), "{found:?}");
    let other =
        accepted.replace("[values]", "\"F9.1\" = \"holds\"\n\n[values]\n\"nothing | run.end\" = [1.0, 0.0]");
    paper.expected = Some(other);
    let found = check(&paper, &some).unwrap().failed;
    assert_eq!(found, ["nothing | run.end is gone", "claim F9.1 is gone"]);
}

/// Runs that ended early are compared until a time that is said, and no run that ends before it agrees with any.
#[test]
fn runs_that_ended_early_do_not_agree_unsaid() {
    let folder = tempfile::tempdir().unwrap();
    let agree = |quantity: &str| {
        format!(
            "[[claim]]\ntext = 'T'\nrule = {{ kind = 'agree', runs = ['breaks', 'breaks'], quantity = '{quantity}', within = 0.01, curves = true }}\n"
        )
    };
    let claims: String =
        ["tip.deflection", "tip.deflection@0..0.5", "tip.deflection@0..19"].map(agree).concat();
    let found = verdicts(&paper_of(folder.path(), &format!("{RUNS}{claims}")), "F1");
    assert_eq!(found, ["undecided", "holds", "undecided"]);
}

/// A refusal that was kept is rejected once the paper does not ask for it any more.
#[test]
fn a_kept_refusal_is_judged_again() {
    let folder = tempfile::tempdir().unwrap();
    let refused = RUNS
        .replace("basis={kind=\"modes\",axial=4,transverse=4}", "basis={kind=\"radial\",nodes=11,shape=8}");
    let asked = refused.replace("name = 'many'", "name = 'many'\nrefused = true");
    let keep = Some(folder.path().join("kept"));
    let options = Options { keep, identity: "this".to_owned(), ..Options::default() };
    let items = ["F1".to_owned()];
    let paper = paper_of(folder.path(), &asked);
    sound(&paper, &items, &options).unwrap();
    assert!(computed(&paper, &options).iter().flatten().any(Answer::refused));
    sound(&paper, &items, &options).unwrap();
    let paper = paper_of(folder.path(), &refused);
    assert!(sound(&paper, &items, &options).unwrap_err().to_string().contains("refused = true"));
}

/// A rule that fails while another has no values leaves no word of a sentence open.
#[test]
fn a_sentence_has_no_word_left_open() {
    let rule = "{ kind = 'all', rules = [{ kind = 'less', left = { run = 'breaks', quantity = 'tip.deflection.min' }, right = 0 }, { kind = 'less', left = 0, right = { run = 'many', quantity = 'tip.deflection.min' } }] }";
    let item =
        format!("{RUNS}[[claim]]\ntext = 'T'\nfails = '{{left}} {{left1}} {{right2}}'\nrule = {rule}\n");
    let folder = tempfile::tempdir().unwrap();
    let paper = paper_of(folder.path(), &item);
    let answers = of_item(&paper, "F1");
    let reproduced = Reproduced { paper: &paper, answers: &answers, items: vec!["F1".to_owned()] };
    let verdicts = reproduced.verdicts();
    let sentence = &verdicts[0].1.sentence;
    assert_eq!(verdicts[0].1.word(), "fails");
    assert!(
        sentence.starts_with("an unknown value an unknown value -0.") && sentence.contains(" ± "),
        "{sentence}"
    );
}

/// What is accepted of a part of a paper holds at once, whatever stood there of what the paper no longer asks.
#[test]
fn what_was_just_accepted_holds() {
    let folder = tempfile::tempdir().unwrap();
    let claim = "[[claim]]\ntext = 'T'\nrule = { kind = 'finishes', runs = ['few'] }\n";
    let mut paper = paper_of(folder.path(), &format!("{RUNS}{claim}"));
    let mut answers = computed(&paper, &Options::default());
    let whole = expected(&paper, &answers).unwrap();
    let stale =
        whole.replace("[verdicts]", "[verdicts]\n\"F1.2\" = \"holds\"\n\"F9.1\" = \"holds\"").replace(
            "[values]",
            "[values]\n\"nothing | run.end\" = [1.0, 0.0]\n\"F1: a to b | x curve-difference\" = [1.0, 0.0]",
        );
    paper.expected = Some(stale);
    answers[1] = None;
    assert_eq!(check(&paper, &answers).unwrap().failed.len(), 4);
    let accepted = expected(&paper, &answers).unwrap();
    assert_eq!(accepted, whole);
    paper.expected = Some(accepted);
    assert_eq!(check(&paper, &answers).unwrap().failed, [""; 0]);
    // What cannot be read is not thrown away.
    paper.expected = Some("[values".to_owned());
    assert!(expected(&paper, &answers).unwrap_err().to_string().contains("mend it"));
}

/// Claims of ours are counted beside those of the paper.
#[test]
fn claims_of_ours_are_counted_apart() {
    let rule = "rule = { kind = 'less', left = 1, right = 2 }\n";
    let lost = "rule = { kind = 'lost', because = 'B' }\n";
    let item = format!(
        "{RUNS}[[claim]]\ntext = 'T'\n{rule}[[claim]]\ntext = 'T'\n{lost}[[claim]]\nours = true\ntext = 'U'\n{rule}"
    );
    let folder = tempfile::tempdir().unwrap();
    let paper = paper_of(folder.path(), &item);
    let answers = vec![None; of_paper(&paper).0.len()];
    let reproduced = Reproduced { paper: &paper, answers: &answers, items: vec!["F1".to_owned()] };
    let counts = reproduced.counts();
    assert_eq!((counts.results, counts.paper, counts.ours), (1, [1, 0, 0, 1, 0], [1, 0, 0, 0, 0]));
    let to = Directory::renew(Artifact::REPORT, folder.path().join("report"), false, "kept").unwrap();
    let files = write(&[reproduced], &to).unwrap();
    let report = std::fs::read_to_string(files.last().unwrap()).unwrap();
    assert!(report.contains("Ours, beside the paper:") && report.matches("data-whose=ours").count() == 2);
    // The five papers say of no claim of theirs that it is ours in words alone.
    for (name, _) in ITEMS {
        for (id, item) in &built_in(name).unwrap().items {
            let marked = item.claims.iter().all(|claim| claim.ours || !claim.text.starts_with("Ours"));
            assert!(marked, "{name} {id}");
        }
    }
}

/// Differences of curves are held as values are.
#[test]
fn a_changed_curve_fails_the_check() {
    let folder = tempfile::tempdir().unwrap();
    let item = format!(
        "{RUNS}[[claim]]\ntext = 'T'\nrule = {{ kind = 'agree', runs = ['many', 'few'], quantity = 'tip.deflection@..5', within = 0.01, curves = true }}\n"
    );
    let mut paper = paper_of(folder.path(), &item);
    let answers = computed(&paper, &Options::default());
    let accepted = expected(&paper, &answers).unwrap();
    assert!(accepted.contains("F1: few to many | tip.deflection@..5 curve-difference"), "{accepted}");
    paper.expected = Some(accepted);
    assert!(check(&paper, &answers).unwrap().failed.is_empty());
    let mut changed = answers;
    let curve = changed[0].as_mut().unwrap().curves.get_mut("tip.deflection").unwrap().as_mut().unwrap();
    curve.y.iter_mut().for_each(|y| *y *= 1.5);
    let failed = check(&paper, &changed).unwrap().failed;
    assert!(failed.iter().any(|line| line.contains("curve-difference")), "{failed:?}");
    // Of curves that change alike the differences stay.
    for answer in changed[1..].iter_mut().flatten() {
        let curve = answer.curves.get_mut("tip.deflection").unwrap().as_mut().unwrap();
        curve.y.iter_mut().for_each(|y| *y *= 1.5);
    }
    let failed = check(&paper, &changed).unwrap().failed;
    assert!(!failed.iter().any(|line| line.contains("curve-difference")), "{failed:?}");
    assert_eq!(failed.iter().filter(|line| line.contains("root-mean-square")).count(), 3, "{failed:?}");
    // Curves that are mirrored have the same differences and the same root mean squares.
    for answer in changed.iter_mut().flatten() {
        let curve = answer.curves.get_mut("tip.deflection").unwrap().as_mut().unwrap();
        curve.y.iter_mut().for_each(|y| *y /= -1.5);
    }
    let failed = check(&paper, &changed).unwrap().failed;
    assert!(failed.len() == 3 && failed.iter().all(|line| line.contains("moment")), "{failed:?}");
}

/// Of a run with which another is compared and that ends before it no error follows.
#[test]
fn a_run_that_ends_before_the_other_says_nothing_of_its_errors() {
    let folder = tempfile::tempdir().unwrap();
    let item = RUNS.replace("name = 'few'", "name = 'few'\nagainst = ['run.duration=3 s']");
    let answers = computed(&paper_of(folder.path(), &item), &Options::default());
    let answer = answers[0].as_ref().unwrap();
    assert_eq!(answer.errors, "not known: the run of `against` ends at t = 3 s, before this one at 6 s");
    assert_eq!(answer.values["tip.deflection.min"].as_ref().unwrap().error, None);
}

/// The studies of the repository, and the papers, can be computed, but for what time shows.
#[test]
fn all_studies_and_papers_are_sound() {
    let studies = Path::new(env!("CARGO_MANIFEST_DIR")).join("../studies");
    let mut all: Vec<Described> = built_in_names().iter().map(|name| built_in(name).unwrap()).collect();
    for folder in std::fs::read_dir(studies).unwrap() {
        let study = from_folder(&folder.unwrap().path()).unwrap();
        assert!(
            study.items.iter().flat_map(|(_, item)| &item.claims).all(|claim| claim.ours),
            "{}",
            study.name
        );
        all.push(study);
    }
    assert_eq!(all.len(), 8);
    for paper in all {
        let items: Vec<String> = paper.items.iter().map(|(id, _)| id.clone()).collect();
        if let Err(error) = sound(&paper, &items, &Options { long: true, ..Options::default() }) {
            panic!("{}:\n{error}", paper.name);
        }
    }
}

/// A changed case says in its title what was changed.
#[test]
fn a_changed_case_says_so_in_its_title() {
    let folder = tempfile::tempdir().unwrap();
    let paper = paper_of(folder.path(), RUNS);
    let answers = computed(&paper, &Options::default());
    let stated = &answers[0].as_ref().unwrap().stated;
    let title = stated.lines().find(|line| line.starts_with("title = ")).unwrap();
    assert!(
        title.contains(", with run.duration = 6 s, basis = {kind='modes',axial=2,transverse=2}"),
        "{title}"
    );
}
