//! What is wrong with a paper, said before any run of it is computed.

use super::{RUNS, paper_of};
use flexion_reproduce::{Options, Reproduced, built_in, from_folder, sound};

#[test]
fn everything_wrong_with_a_paper_is_said_at_once() {
    let folder = tempfile::tempdir().unwrap();
    paper_of(folder.path(), RUNS);
    let item = format!(
        "{}[[claim]]\ntext = 'T'\nrule = {{ kind = 'finishes', runs = ['fev'] }}\n",
        RUNS.replace(
            "case = 'spin_up'\nset = ['run.duration=6 s', 'basis={kind=\"modes\",axial=4",
            "case = 'spin_down'\nset = ['run.duration=6 s', 'basis={kind=\"modes\",axial=4"
        )
    );
    std::fs::write(folder.path().join("F1.toml"), item).unwrap();
    std::fs::write(folder.path().join("F9.toml"), RUNS).unwrap();
    let message = from_folder(folder.path()).unwrap_err().to_string();
    for part in ["cases/spin_down.toml does not exist", "perhaps `few`", "F9.toml is no item"] {
        assert!(message.contains(part), "{message}");
    }
    std::fs::write(folder.path().join("F1.toml"), RUNS.replace("[table]", "[tabel]")).unwrap();
    let message = from_folder(folder.path()).unwrap_err().to_string();
    assert!(
        ["tabel", "F1.toml", "line", "perhaps `table`"].iter().all(|part| message.contains(part)),
        "{message}"
    );
    // A case that two runs name and that is not there is said once.
    std::fs::write(folder.path().join("F1.toml"), RUNS.replace("'spin_up'", "'spin_upp'")).unwrap();
    let message = from_folder(folder.path()).unwrap_err().to_string();
    assert_eq!(message.matches("spin_upp.toml does not exist").count(), 1, "{message}");
    assert!(message.contains("perhaps") && message.contains("cases/spin_up.toml"), "{message}");
    assert!(built_in("P9").unwrap_err().to_string().contains("P1, P2, P3, P4, P5"));
}

/// Runs that contradict themselves, or that there are none of, and an item that stands twice.
#[test]
fn runs_that_say_nothing_are_rejected() {
    let folder = tempfile::tempdir().unwrap();
    paper_of(folder.path(), RUNS);
    let message = |item: &str| {
        std::fs::write(folder.path().join("F1.toml"), item).unwrap();
        from_folder(folder.path()).map_or_else(|error| error.to_string(), |_| String::new())
    };
    let with = |more: &str| RUNS.replace("name = 'few'\n", &format!("name = 'few'\n{more}\n"));
    let modes =
        "modes = { speed = 4, count = 1 }\nstrain-energy = { energy = 'linear', speed = 4, count = 1 }";
    assert!(message(&with(modes)).contains("run `few`: `modes` and `strain-energy`"));
    assert!(message(&with("each = { n = [] }")).contains("run `few`: `each` has no value of `n`"));
    for seconds in ["-1", "0", "nan"] {
        assert!(message(&with(&format!("seconds = {seconds}"))).contains("a positive time"));
    }
    let named = RUNS.replace("name = 'few'", "name = 'few {m}'");
    assert!(message(&named).contains("run `few {m}`: `{m}` is no key of its `each`"));
    assert_eq!(message(RUNS), "");
    let paper = std::fs::read_to_string(folder.path().join("paper.toml")).unwrap();
    std::fs::write(folder.path().join("paper.toml"), paper.replace("['F1']", "['F1', 'F1']")).unwrap();
    assert!(message(RUNS).contains("`items` has F1 twice"));
    std::fs::write(folder.path().join("paper.toml"), paper.replace("['F1']", "['F01']")).unwrap();
    assert!(message(RUNS).contains("`F01` of `items` is no F or T with a number"));
    std::fs::write(folder.path().join("paper.toml"), &paper).unwrap();
    std::fs::write(folder.path().join("F1.svg"), "not a drawing").unwrap();
    assert!(message(&format!("drawing = 'F1.svg'\n{RUNS}")).contains("F1.svg is no drawing in SVG"));
}

/// Two items ask of the same run: what is wrong is said of that which asks it, and how long it takes holds for both.
#[test]
fn a_run_of_two_items_is_judged_for_each() {
    let folder = tempfile::tempdir().unwrap();
    paper_of(folder.path(), RUNS);
    let paper = std::fs::read_to_string(folder.path().join("paper.toml")).unwrap();
    std::fs::write(folder.path().join("paper.toml"), paper.replace("['F1']", "['F1', 'F2']")).unwrap();
    let other = RUNS.replace("tip.deflection.min", "tip.deflection.mini");
    std::fs::write(folder.path().join("F2.toml"), &other).unwrap();
    let items = ["F1".to_owned(), "F2".to_owned()];
    let message =
        sound(&from_folder(folder.path()).unwrap(), &items, &Options::default()).unwrap_err().to_string();
    assert!(message.contains("F2.toml:") && !message.contains("F1.toml:"), "{message}");
    let long = RUNS.replace("name = 'few'", "name = 'few'\nseconds = 40");
    std::fs::write(folder.path().join("F1.toml"), long).unwrap();
    let claim = "[[claim]]\ntext = 'T'\nrule = { kind = 'finishes', runs = ['few'] }\n";
    std::fs::write(folder.path().join("F2.toml"), format!("{RUNS}{claim}")).unwrap();
    let paper = from_folder(folder.path()).unwrap();
    let answers = super::of_item(&paper, "F2");
    let reproduced = Reproduced { paper: &paper, answers: &answers, items: vec!["F2".to_owned()] };
    assert_eq!(reproduced.verdicts()[0].1.sentence, "Not run: 40 s, `--long`.");
}

/// What a run of a paper cannot be is said before any is computed, at its line, with the nearest name; a refusal that is asked for is none.
#[test]
fn what_runs_cannot_be_is_rejected_at_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let found = |item: &str| {
        let paper = paper_of(folder.path(), item);
        match sound(&paper, &["F1".to_owned()], &Options::default()) {
            Ok(()) => String::new(),
            Err(error) => error.to_string(),
        }
    };
    let line = |item: &str, words: &str| {
        let line = item.lines().position(|line| line.contains(words)).unwrap() + 1;
        format!("F1.toml:{line}: ")
    };
    assert_eq!(found(RUNS), "");
    let many = "axial=4,transverse=4}";
    let claim = |rule: &str| format!("{RUNS}[[claim]]\ntext = 'T'\nrule = {rule}\n");
    let refused = "basis={kind=\"radial\",nodes=11,shape=8}";
    let own = "basis={kind=\"modes\",axial=4,transverse=4}";
    let cases = [
        (RUNS.replace(many, "axial=4,transvers=4}"), "transvers=4", "transverse"),
        (RUNS.replace("\"modes\",axial=4", "\"mods\",axial=4"), "\"mods\"", "`modes`"),
        (
            RUNS.replace(
                "duration=6 s', 'basis={kind=\"modes\",axial=4",
                "duration=6 m', 'basis={kind=\"modes\",axial=4",
            ),
            "6 m'",
            "run.duration",
        ),
        (RUNS.replace(own, refused), "shape=8", "refused = true"),
        (
            RUNS.replace("y = 'tip.deflection'", "y = 'tip.deflektion'"),
            "deflektion",
            "perhaps `tip.deflection`",
        ),
        (
            RUNS.replace("quantity = 'tip.deflection.min'", "quantity = 'tip.deflection.mini'"),
            "mini",
            "tip.deflection",
        ),
        (RUNS.replace("unit = 'mm'", "unit = 'rad'"), "unit = 'rad'", "rad"),
        (
            claim(
                "{ kind = 'less', left = { run = 'few', quantity = 'tip.deflection.min' }, right = { run = 'many', quantity = 'run.end' } }",
            ),
            "kind = 'less'",
            "in `m`, with run.end of `many`, in `s`",
        ),
        (
            claim(
                "{ kind = 'all', rules = [{ kind = 'less', left = { run = 'few', quantity = 'tip.deflection.min' }, right = { run = 'many', quantity = 'tip.deflection.min', to = 'few', as = 'ratio' } }] }",
            ),
            "kind = 'all'",
            "pure numbers",
        ),
        (
            claim(
                "{ kind = 'less', left = { run = 'few', quantity = 'tip.deflection.amplitude@5..7' }, right = 1 }",
            ),
            "kind = 'less'",
            "asks for t = 7 s of `few`, which ends at 6 s: ask for times until then, or make `run.duration` longer",
        ),
        (
            claim(
                "{ kind = 'any', rules = [{ kind = 'less', left = 1, right = { run = 'many', quantity = 'tip.deflection.at@6.01' } }] }",
            ),
            "kind = 'any'",
            "t = 6.01 s of `many`",
        ),
        (
            claim(
                "{ kind = 'agree', runs = ['breaks', 'few'], quantity = 'tip.deflection@5..8', within = 0.01, curves = true }",
            ),
            "kind = 'agree'",
            "t = 8 s of `few`",
        ),
        (
            RUNS.replace("quantity = 'tip.deflection.min'", "quantity = 'tip.deflection.min@9..'"),
            "min@9..",
            "t = 9 s of `few`",
        ),
        (
            RUNS.replace("y = 'tip.deflection'", "y = 'tip.deflection'\nfrom = 7"),
            "y = 'tip.deflection'",
            "`from` of the plot of tip.deflection asks for t = 7 s",
        ),
        (
            RUNS.replace("y = 'tip.deflection'", "y = 'tip.deflection'\nto = 7"),
            "y = 'tip.deflection'",
            "`to` of the plot of tip.deflection asks for t = 7 s",
        ),
        (
            RUNS.replace("quantity = 'tip.deflection.min'", "quantity = 'tip.deflection.at@-1'"),
            "at@-1",
            "asks for t = -1 s of `few`, which begins at 0 s",
        ),
        (
            RUNS.replace("quantity = 'tip.deflection.min'", "quantity = 'tip.deflection.mean@1.0001..2'"),
            "mean@",
            "which has no record there, but every",
        ),
        (
            RUNS.replace("unit = 'mm'", "to = 'few', as = 'relative-difference', unit = 'deg'"),
            "unit = 'deg'",
            "`deg` is a unit of angle",
        ),
        (
            claim(
                "{ kind = 'agree', runs = ['few', 'many'], quantity = 'tip.deflection', within = 0.01, curves = true }",
            )
            .replacen("duration=6 s'", "duration=6 s', 'output.step=0.97 s'", 1),
            "'tip.deflection'",
            "with records every 0.02 s, is compared with that of `few`, with records every 0.97 s",
        ),
        (
            format!("{}holds = 'H'\n", claim("{ kind = 'lost', because = 'It is.' }")),
            "kind = 'lost'",
            "`holds` is never said",
        ),
    ];
    for (item, words, said) in cases {
        let message = found(&item);
        assert!(message.contains(&line(&item, words)) && message.contains(said), "{words}: {message}");
    }
    // A misspelt key is never what is asked.
    let asked = |set: &str| RUNS.replace(own, set).replace("name = 'many'", "name = 'many'\nrefused = true");
    assert_eq!(found(&asked(refused)), "");
    assert!(found(&asked("basis={kind=\"radal\",nodes=11}")).contains("radial"));
    let many_wrong = RUNS.replace(many, "axial=4,transvers=4}").replace("axial=2", "axal=2");
    assert_eq!(found(&many_wrong).lines().filter(|line| line.contains("unknown key")).count(), 2);
}

/// What says nothing whatever its runs give, and what would be read as something else, is rejected at its line.
#[test]
fn items_that_say_nothing_are_rejected_at_their_line() {
    let folder = tempfile::tempdir().unwrap();
    let found = |item: &str| {
        let paper = paper_of(folder.path(), item);
        sound(&paper, &["F1".to_owned()], &Options::default())
            .map_or_else(|error| error.to_string(), |()| String::new())
    };
    let claim = |rule: &str| format!("{RUNS}[[claim]]\ntext = 'T'\nrule = {rule}\n");
    let curves = |times: &str| {
        claim(&format!(
            "{{ kind = 'agree', runs = ['many', 'few'], quantity = 'tip.deflection{times}', within = 0.01, curves = true }}"
        ))
    };
    let finishes = claim("{ kind = 'finishes', runs = ['few'] }");
    let plot = "y = 'tip.deflection'";
    let table = "[table]\ncolumns = [{ title = 'smallest', quantity = 'tip.deflection.min', unit = 'mm' }]\n";
    assert!(RUNS.contains(table));
    let min = "{ run = 'few', quantity = 'tip.deflection.min'";
    // A run under another name.
    let few =
        &RUNS[RUNS.find("[[run]]\nname = 'few'").unwrap()..RUNS.find("[[run]]\nname = 'many'").unwrap()];
    let twice = format!(
        "{}{}[[claim]]\ntext = 'T'\nrule = {{ kind = 'less', left = {min} }}, right = RIGHT }} }}\n",
        RUNS,
        few.replace("'few'", "'other'")
    );
    let cases = [
        (curves("@0..0,75"), "rule =", "0,75"),
        (curves("@1"), "rule =", "@FROM..TO"),
        (curves("@1.5..1"), "rule =", "ends before it begins"),
        (curves("@nan..1"), "rule =", "no time"),
        (format!("{finishes}holds = '{{left1}}'\n"), "rule =", "{left1}"),
        (format!("{finishes}because = 'It is {{of}}.'\n"), "rule =", "{of}"),
        (claim("{ kind = 'less', left = 1, right = 2 }"), "rule =", "no quantity"),
        (
            claim(
                "{ kind = 'all', rules = [{ kind = 'finishes', runs = ['few'] }, { kind = 'within', of = 1, low = 0, high = 2 }] }",
            ),
            "rule =",
            "no quantity",
        ),
        (
            claim(&format!("{{ kind = 'less', left = {min}, to = 'few', as = 'ratio' }}, right = 1 }}")),
            "rule =",
            "compares tip.deflection.min of `few` with itself: name another run",
        ),
        (
            claim(&format!("{{ kind = 'less', left = {min} }}, right = {min} }}, times = 2 }}")),
            "rule =",
            "with itself",
        ),
        (
            claim(
                "{ kind = 'all', rules = [{ kind = 'agree', runs = ['few', 'many', 'few'], quantity = 'tip.deflection.min', within = 0.01 }] }",
            ),
            "rule =",
            "with itself",
        ),
        (
            claim("{ kind = 'grows', runs = ['few', 'few'], quantity = 'tip.deflection.min' }"),
            "rule =",
            "with itself",
        ),
        (
            twice.replace("RIGHT", &min.replace("'few'", "'other'")),
            "rule =",
            "of `few`, which is `other` too, with itself",
        ),
        (RUNS.replace(plot, "y = 'tip.deflection'\nfrom = 3\nto = 2"), plot, "from 3 s to 2 s"),
        (RUNS.replace(plot, "y = 'tip.deflection'\nto = 'few'"), plot, "seconds"),
        (RUNS.replace(plot, "y = 'tip.deflection'\nruns = []"), plot, "`runs` is empty"),
        (RUNS.replace("[table]", "[table]\nruns = []"), "[table]", "`runs` is empty"),
        (RUNS.replace("[[plot]]\ny = 'tip.deflection'\n", ""), "kind = ", "[[plot]]"),
        (RUNS.replace("kind = 'figure'", "kind = 'table'").replace(table, ""), "kind = ", "[table]"),
        (RUNS.replace("name = 'few'", "name = 'few'\neach = { n = [3] }"), "name = 'few'", "`n`"),
    ];
    for (item, words, said) in cases {
        let line = item.lines().position(|line| line.contains(words)).unwrap() + 1;
        let message = found(&item);
        assert!(
            message.contains(&format!("F1.toml:{line}: ")) && message.contains(said),
            "{said}: {message}"
        );
    }
    for item in [curves("@..5"), curves("@1..1.5"), finishes] {
        assert_eq!(found(&item), "");
    }
}
