//! Sweeps: what is run, what is kept, and what is refused.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use flexion_case::sweep::{
    Chunk, Errors, How, Inputs, Method, Options, Outcome, Point, Row, Sample, Shard, Status, Stop, Sweep,
    SweepError, Table,
};
use flexion_case::{Reading, parse};
use std::fs;
use std::ops::ControlFlow;
use std::path::Path;

/// A short run of a beam that is spun up.
const CASE: &str = r#"
[beam]
length = "10 m"
[section]
kind = "uniform"
modulus = "70 GPa"
density = "3000 kg/m^3"
area = "4 cm^2"
second-moment = "2e-7 m^4"
[hub]
motion = { kind = "spin-up", speed = "4 rad/s", time = "15 s" }
[basis]
kind = "finite-elements"
elements = 4
[run]
duration = "1 s"
[output]
step = "0.02 s"
"#;

fn reading() -> Reading {
    parse(CASE.to_owned(), Path::new("case.toml"), &[]).unwrap()
}

fn vary(vary: &[&str]) -> Inputs {
    Inputs { vary: vary.iter().map(|s| (*s).to_owned()).collect(), ..Inputs::default() }
}

fn table(text: &str) -> Inputs {
    Inputs { table: Some(Table::parse("inputs.csv", text).unwrap()), ..Inputs::default() }
}

const PLAIN: Options = Options { errors: Errors::None, limit: None, part: None };

fn made(inputs: Inputs, options: Options) -> Result<Sweep, SweepError> {
    Sweep::new(
        reading(),
        inputs,
        &["tip.deflection.min".to_owned(), "tip.deflection.final".to_owned()],
        options,
    )
}

fn sweep(inputs: Inputs) -> Sweep {
    made(inputs, PLAIN).unwrap()
}

fn all(sweep: &Sweep) -> Vec<Row> {
    sweep.run(Chunk { first: 0, count: sweep.rows() }, &mut || ControlFlow::Continue(()))
}

fn kept(sweep: &Sweep, folder: &Path, how: How) -> Outcome {
    sweep.run_all(folder, &how, &|| ControlFlow::Continue(()), &|_| {}).unwrap()
}

fn number(point: &Point) -> f64 {
    if let Point::Number(x) = point { *x } else { panic!("{point:?}") }
}

/// Lines of the file of all rows without their wall times, which is the last but one column.
fn lines(folder: &Path) -> Vec<String> {
    let text = fs::read_to_string(folder.join("sweep.csv")).unwrap();
    let without = |line: &str| {
        let mut fields: Vec<&str> = line.rsplitn(3, ',').collect();
        fields.remove(1);
        fields.join(",")
    };
    text.lines().map(without).collect()
}

#[test]
fn a_row_has_the_bits_of_the_run_of_its_case() {
    let sweep = sweep(vary(&[
        "section.modulus=60 GPa:80 GPa:3",
        "hub.motion.speed=30 rpm, 40 rpm",
        "basis.elements=3:4:2",
    ]));
    assert_eq!(sweep.rows(), 12);
    let rows = all(&sweep);
    let sets = ["section.modulus=70 GPa", "hub.motion.speed=40 rpm", "basis.elements=3"].map(str::to_owned);
    let row = &rows[6];
    assert_eq!(
        row.inputs.iter().map(number).collect::<Vec<_>>(),
        [7e10, 40.0 * std::f64::consts::PI / 30.0, 3.0]
    );
    assert_eq!(sweep.inputs()[1].unit, "rad/s");
    let run = reading().with(&sets).unwrap().prepare().unwrap().run(&mut |_| ControlFlow::Continue(()));
    let index = run.trajectory.index("tip.deflection").unwrap();
    let of = run.trajectory.extremes(index);
    let collected = row.quantities[0].unwrap();
    assert_eq!((collected.value.to_bits(), collected.time.to_bits()), (of.min.to_bits(), of.t_min.to_bits()));
    assert_eq!(row.quantities[1].unwrap().value.to_bits(), of.last.to_bits());
    assert_eq!((row.status, row.reason.as_deref(), row.steps), (Status::Finished, None, run.counters.steps));
}

#[test]
fn a_row_does_not_depend_on_its_neighbours_order_or_chunk() {
    // The second row fails, and the fifth cannot be run.
    let rows = [
        "7e10,4 rad/s,first",
        "6e10,4 rad/s,zeroth",
        "60 GPa,3 rad/s,first",
        "-1,4 rad/s,first",
        "65 GPa,4 rad/s,exact",
    ];
    let head = "section.modulus,hub.motion.speed,model.coupling\n";
    let of = |order: &[usize]| {
        let text: Vec<&str> = order.iter().map(|i| rows[*i]).collect();
        let inputs = Inputs {
            table: Some(Table::parse("t.csv", &format!("{head}{}\n", text.join("\n"))).unwrap()),
            ..Inputs::default()
        };
        let case = parse(CASE.replace("\"1 s\"", "\"13 s\""), Path::new("case.toml"), &[]).unwrap();
        Sweep::new(case, inputs, &["tip.deflection.min".to_owned()], PLAIN)
    };
    // A bare number among numbers with units is refused.
    let Err(SweepError::Case(problems)) = of(&[0, 1, 2, 3, 4]) else { panic!() };
    assert!(problems.render(false).contains("some values have a unit and others none"), "{problems}");
    let rows =
        rows.map(|row| row.replace("7e10", "70 GPa").replace("6e10", "60 GPa").replace("-1", "-1 GPa"));
    let of = |order: &[usize]| {
        let text: Vec<&str> = order.iter().map(|i| rows[*i].as_str()).collect();
        let case = parse(CASE.replace("\"1 s\"", "\"13 s\""), Path::new("case.toml"), &[]).unwrap();
        Sweep::new(
            case,
            table(&format!("{head}{}\n", text.join("\n"))),
            &["tip.deflection.min".to_owned()],
            PLAIN,
        )
        .unwrap()
    };
    let whole = all(&of(&[0, 1, 2, 3, 4]));
    let statuses: Vec<&str> = whole.iter().map(|row| row.status.word()).collect();
    assert_eq!(statuses, ["finished", "failed", "finished", "rejected", "finished"]);
    assert!(whole[1].reason.as_ref().unwrap().contains("zeroth-order"), "{:?}", whole[1]);
    assert!(
        whole[3].reason.as_ref().unwrap().starts_with("section.modulus: must be positive"),
        "{:?}",
        whole[3]
    );
    assert!(whole[1].quantities[0].is_none() && whole[3].quantities[0].is_none());
    let order = [4, 3, 1, 0, 2];
    let shuffled = all(&of(&order));
    for (row, of) in shuffled.iter().zip(order) {
        assert!(Row { number: of, ..row.clone() }.is_same(&whole[of]), "{row:?}");
    }
    let alone = all(&of(&[2]));
    assert!(Row { number: 2, ..alone[0].clone() }.is_same(&whole[2]));
    let chunk = of(&[0, 1, 2, 3, 4]).run(Chunk { first: 2, count: 9 }, &mut || ControlFlow::Continue(()));
    assert!(chunk.len() == 3 && chunk.iter().zip(&whole[2..]).all(|(a, b)| a.is_same(b)));
}

#[test]
fn what_is_wrong_with_inputs_is_said_at_once_before_anything_runs() {
    let inputs = vary(&[
        "section.modlus=1:2:3",
        "section.density=3000 kg/m^3, 3 m",
        "section.area=1:2",
        "hub.motion.speed=normal(4 rad/s, 1 rad/s)",
        "beam.length",
    ]);
    let Err(SweepError::Case(problems)) = made(inputs, PLAIN) else { panic!() };
    let text = problems.render(false);
    for part in [
        "section.modlus: unknown key",
        "did you mean `modulus`?",
        "FIRST:LAST:COUNT",
        "a distribution is sampled",
        "KEY=VALUES",
        "--vary",
    ] {
        assert!(text.contains(part), "{part}\n{text}");
    }
    let refused = |of: &[&str]| match made(vary(of), PLAIN) {
        Err(SweepError::Case(problems)) => problems.render(false),
        other => panic!("{other:?}"),
    };
    let unit = refused(&["section.density=3000 kg/m^3, 3 m", "section.modulus=70 GPa, 80 Gpa"]);
    assert!(
        unit.contains("`m` is a unit of length, not of") && unit.contains("did you mean `GPa`?"),
        "{unit}"
    );
    // The very message of `--set`.
    let set = reading().with(&["section.density=3 m".to_owned()]).unwrap_err();
    assert!(unit.contains(&set.list[0].message), "{unit}\n{set}");
    assert!(refused(&["section.area=1:2:3", "section.area=5"]).contains("varied twice"));
    assert!(refused(&["model.coupling=first, frist"]).contains("did you mean `first`?"));
    assert!(refused(&["basis.elements=3:10:3"]).contains("takes integers"));
    assert!(refused(&["model.coupling=1:2:3"]).contains("is not what this key takes"));
    assert!(refused(&[]).contains("nothing is varied"));
    let Err(SweepError::Case(problems)) = made(table("model.coupling\nfirst\nfrist\n"), PLAIN) else {
        panic!()
    };
    assert!(problems.to_string().contains("inputs.csv, row 2"), "{problems}");
    let refined =
        parse(CASE.replace("duration =", "tolerance = 1e-4\nduration ="), Path::new("case.toml"), &[])
            .unwrap();
    let refined = Sweep::new(refined, vary(&["section.area=4 cm^2"]), &["tip.deflection".to_owned()], PLAIN);
    assert!(refined.unwrap_err().to_string().contains("does not refine"));
    let both = Inputs { vary: vec!["section.area=1:2:3".to_owned()], ..table("section.area\n1\n") };
    assert!(matches!(made(both, PLAIN), Err(SweepError::Case(_))));
    let Err(SweepError::Column(column)) =
        Sweep::new(reading(), vary(&["section.area=4 cm^2"]), &["tip.deflecton.min".to_owned()], PLAIN)
    else {
        panic!()
    };
    assert!(column.to_string().contains("tip.deflection"), "{column}");
    for text in ["a,b\n1,2,3\n", "a,b\n1,\n", "a,b\n"] {
        assert!(Table::parse("t.csv", text).is_err(), "{text}");
    }
}

#[test]
fn samples_are_those_of_their_seed_and_say_it() {
    let sample = |method, seed| Inputs {
        sample: Some(Sample { method, runs: 16, seed }),
        ..vary(&["section.modulus=lognormal(70 GPa, 1 GPa)", "hub.motion.speed=3:5 rad/s"])
    };
    for method in [Method::LatinHypercube, Method::Sobol] {
        let points = |seed| {
            let sweep = sweep(sample(method, seed));
            (0..16).map(|row| sweep.point(row)).collect::<Vec<_>>()
        };
        assert_eq!(points(1), points(1));
        assert_ne!(points(1), points(2));
        let mut parts: Vec<usize> =
            points(1).iter().map(|row| (8.0 * (number(&row[1]) - 3.0)) as usize).collect();
        parts.sort_unstable();
        assert_eq!(parts, (0..16).collect::<Vec<_>>());
        // The median of a lognormal distribution parts the sample in two.
        let median = 7e10 / (1.0f64 + (1.0f64 / 70.0).powi(2)).sqrt();
        assert_eq!(points(1).iter().filter(|row| number(&row[0]) < median).count(), 8);
    }
    let folder = tempfile::tempdir().unwrap();
    kept(&sweep(sample(Method::Sobol, 3)), folder.path(), How::default());
    let manifest = fs::read_to_string(folder.path().join("sweep.json")).unwrap();
    assert!(manifest.contains("\"seed\": 3") && manifest.contains("\"sobol\""), "{manifest}");
}

#[test]
fn shards_and_threads_and_torn_parts_leave_the_same_rows() {
    let inputs = || vary(&["section.modulus=60 GPa:80 GPa:5", "hub.motion.speed=3:5 rad/s:5"]);
    let sweep = made(inputs(), Options { part: Some(4), ..PLAIN }).unwrap();
    let folder = |name: &str| tempfile::Builder::new().prefix(name).tempdir().unwrap();
    let (whole, two, shards) = (folder("whole"), folder("two"), folder("shards"));
    let outcome = kept(&sweep, whole.path(), How { threads: 1, ..How::default() });
    assert_eq!((outcome.totals.rows, outcome.found, outcome.stop), (25, 0, None));
    kept(&sweep, two.path(), How { threads: 2, ..How::default() });
    assert_eq!(lines(whole.path()), lines(two.path()));
    // Shards share a folder; the last one that ends finds all rows.
    for number in [3, 1, 2] {
        let shard = Shard { number, of: 3 };
        let outcome = kept(&sweep, shards.path(), How { shard, ..How::default() });
        assert_eq!(outcome.csv.is_some(), number == 2);
    }
    assert_eq!(lines(whole.path()), lines(shards.path()));
    // Done again nothing is computed; a torn part and a missing one are.
    let parts = |folder: &Path| {
        let mut all: Vec<_> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
        all.retain(|path| path.extension().is_some_and(|end| end == "parquet"));
        all.sort();
        all
    };
    assert_eq!(kept(&sweep, two.path(), How::default()).found, 25);
    let torn = &parts(two.path())[2];
    let bytes = fs::read(torn).unwrap();
    fs::write(torn, &bytes[..bytes.len() / 2]).unwrap();
    fs::remove_file(&parts(two.path())[6]).unwrap();
    let left = two.path().join(format!(".{}-1.new", torn.file_name().unwrap().to_str().unwrap()));
    fs::write(&left, "half").unwrap();
    assert_eq!(kept(&sweep, two.path(), How::default()).found, 20);
    assert_eq!(lines(whole.path()), lines(two.path()));
    assert!(!left.exists());
    assert_eq!(parts(whole.path()).len(), 7);
}

/// A process may be ended at any byte of a part, its footer too, and before or behind the renaming.
#[test]
fn a_part_that_ends_at_any_byte_is_no_part_and_one_that_was_not_renamed_is_made_again() {
    let sweep = made(vary(&["section.modulus=60 GPa:80 GPa:6"]), Options { part: Some(3), ..PLAIN }).unwrap();
    let folder = tempfile::tempdir().unwrap();
    kept(&sweep, folder.path(), How::default());
    let rows = lines(folder.path());
    let all = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().path());
    let mut parts: Vec<_> = all.filter(|path| path.extension().is_some_and(|end| end == "parquet")).collect();
    parts.sort();
    let whole = fs::read(&parts[1]).unwrap();
    assert_eq!(sweep.kept_parts(folder.path()), [0, 1]);
    for end in 0..whole.len() {
        // What a file system has not written behind it is not there, or zeros.
        let mut zeros = whole[..end].to_vec();
        fs::write(&parts[1], &zeros).unwrap();
        assert_eq!(sweep.kept_parts(folder.path()), [0], "{end} of {} bytes", whole.len());
        if end < whole.len() - 8 {
            zeros.resize(whole.len(), 0);
            fs::write(&parts[1], &zeros).unwrap();
            assert_eq!(sweep.kept_parts(folder.path()), [0], "zeros behind {end} of {} bytes", whole.len());
        }
    }
    // Nor is one of which a bit has changed, wherever it is.
    for at in 0..whole.len() {
        let mut flipped = whole.clone();
        flipped[at] ^= 1 << (at % 8);
        fs::write(&parts[1], &flipped).unwrap();
        assert_eq!(sweep.kept_parts(folder.path()), [0], "bit {} of byte {at}", at % 8);
    }
    let name = parts[1].file_name().unwrap().to_str().unwrap();
    let left = folder.path().join(format!(".{name}-1.new"));
    fs::remove_file(&parts[1]).unwrap();
    for bytes in [&whole[..], &whole[..whole.len() / 2]] {
        fs::write(&left, bytes).unwrap();
        assert_eq!(kept(&sweep, folder.path(), How::default()).found, 3);
        assert_eq!((lines(folder.path()), left.exists()), (rows.clone(), false));
        fs::remove_file(&parts[1]).unwrap();
    }
}

#[test]
fn a_folder_of_another_sweep_is_refused_with_the_difference() {
    let folder = tempfile::tempdir().unwrap();
    let inputs = || vary(&["section.modulus=60 GPa:80 GPa:3"]);
    kept(&sweep(inputs()), folder.path(), How::default());
    let refused = |sweep: &Sweep| {
        let error = sweep.run_all(folder.path(), &How::default(), &|| ControlFlow::Continue(()), &|_| {});
        error.unwrap_err().to_string()
    };
    assert!(
        refused(&sweep(vary(&["section.modulus=60 GPa:81 GPa:3"])))
            .contains("the values of its inputs are others")
    );
    assert!(refused(&sweep(vary(&["section.modulus=60 GPa:80 GPa:5"]))).contains("its rows is 3 and not 5"));
    assert!(
        refused(&made(inputs(), Options { errors: Errors::Each, ..PLAIN }).unwrap())
            .contains("its errors is \"none\"")
    );
    let other = parse(CASE.replace("10 m", "9 m"), Path::new("case.toml"), &[]).unwrap();
    let other = Sweep::new(
        other,
        inputs(),
        &["tip.deflection.min".to_owned(), "tip.deflection.final".to_owned()],
        PLAIN,
    );
    assert!(refused(&other.unwrap()).contains("its case is another"));
    let seed = |seed| Inputs {
        sample: Some(Sample { method: Method::LatinHypercube, runs: 3, seed }),
        ..vary(&["section.modulus=60:80 GPa"])
    };
    let seeds = tempfile::tempdir().unwrap();
    kept(&sweep(seed(1)), seeds.path(), How::default());
    let error = sweep(seed(2)).run_all(seeds.path(), &How::default(), &|| ControlFlow::Continue(()), &|_| {});
    assert!(error.unwrap_err().to_string().contains("its seed is 1 and not 2"));
    let full = tempfile::tempdir().unwrap();
    fs::write(full.path().join("letter.txt"), "dear").unwrap();
    let error = sweep(inputs()).run_all(full.path(), &How::default(), &|| ControlFlow::Continue(()), &|_| {});
    assert!(error.unwrap_err().to_string().contains("letter.txt"));
}

#[test]
fn more_than_a_tenth_of_failures_stops_a_sweep_at_the_same_row_on_any_thread() {
    // Of the moduli from -5 GPa to 94 GPa the first six are none.
    let inputs = || vary(&["section.modulus=-5 GPa:94 GPa:100"]);
    let of = |how: How| {
        let folder = tempfile::tempdir().unwrap();
        let outcome = kept(&made(inputs(), Options { part: Some(2), ..PLAIN }).unwrap(), folder.path(), how);
        let again = kept(&made(inputs(), Options { part: Some(2), ..PLAIN }).unwrap(), folder.path(), how);
        assert_eq!(outcome.stop, again.stop);
        (outcome, again)
    };
    for threads in [1, 2] {
        let (outcome, again) = of(How { threads, ..How::default() });
        assert_eq!(outcome.stop, Some(Stop::Failures { failures: 6, rows: 20 }));
        assert!(outcome.totals.rows >= 20 && outcome.totals.rows < 40, "{}", outcome.totals.rows);
        assert_eq!(again.totals.rows, outcome.totals.rows);
    }
    let (outcome, _) = of(How { keep_going: true, ..How::default() });
    assert_eq!((outcome.stop, outcome.totals.rows, outcome.totals.rejected), (None, 100, 6));
    let (row, reason) = outcome.totals.first_failure.unwrap();
    assert!(row == 0 && reason.contains("section.modulus"), "{reason}");
}

#[test]
fn errors_are_estimated_of_twenty_rows_and_borrowed_by_none() {
    let short = parse(CASE.replace("\"1 s\"", "\"0.2 s\""), Path::new("case.toml"), &[]).unwrap();
    let inputs = || vary(&["section.modulus=60 GPa:80 GPa:6", "hub.motion.speed=3:5 rad/s:6"]);
    let of = |errors| {
        let options = Options { errors, ..PLAIN };
        Sweep::new(short.clone(), inputs(), &["tip.deflection.min".to_owned()], options).unwrap()
    };
    let (sample, each, none) = (all(&of(Errors::Sample)), all(&of(Errors::Each)), all(&of(Errors::None)));
    let estimated: Vec<&Row> =
        sample.iter().filter(|row| row.quantities[0].unwrap().error.is_some()).collect();
    assert_eq!((estimated.len(), of(Errors::Sample).estimated()), (20, 20));
    for corner in [0, 5, 30, 35] {
        assert!(estimated.iter().any(|row| row.number == corner), "{corner}");
    }
    for ((a, b), c) in sample.iter().zip(&each).zip(&none) {
        let (sampled, full, plain) =
            (a.quantities[0].unwrap(), b.quantities[0].unwrap(), c.quantities[0].unwrap());
        assert!(
            sampled.value.to_bits() == full.value.to_bits() && full.value.to_bits() == plain.value.to_bits()
        );
        assert!(sampled.error.is_none() || sampled.error == full.error);
        assert!(
            full.error.is_some()
                && plain.error.is_none()
                && full.trusted == Some(true)
                && plain.trusted.is_none()
        );
        assert!(b.trusted_until == Some(0.2) && c.trusted_until.is_none());
    }
}

#[test]
fn a_run_beyond_the_limit_of_its_steps_is_given_up() {
    let inputs = || vary(&["integrator={kind='newmark', step=0.01}, {kind='newmark', step=0.005}"]);
    let steps: Vec<u64> = all(&sweep(inputs())).iter().map(|row| row.steps).collect();
    assert_eq!(steps, [100, 200]);
    let limited = all(&made(inputs(), Options { limit: Some(steps[0]), ..PLAIN }).unwrap());
    assert_eq!((limited[0].status, limited[1].status), (Status::Finished, Status::GivenUp));
    let reason = limited[1].reason.as_ref().unwrap();
    assert!(reason.starts_with(&format!("given up: more than {} steps at t = ", steps[0])), "{reason}");
    assert!(limited[1].quantities.iter().all(Option::is_none));
}

#[test]
fn a_sweep_that_is_stopped_keeps_the_parts_that_are_whole() {
    let sweep = made(vary(&["section.modulus=60 GPa:80 GPa:9"]), Options { part: Some(2), ..PLAIN }).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let steps = std::sync::atomic::AtomicU64::new(0);
    let ordering = std::sync::atomic::Ordering::Relaxed;
    let row = all(&sweep)[0].steps;
    let watch = || {
        if steps.fetch_add(1, ordering) > 5 * row {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    };
    let how = How { threads: 1, ..How::default() };
    let outcome = sweep.run_all(folder.path(), &how, &watch, &|_| {}).unwrap();
    assert_eq!((outcome.stop, outcome.totals.rows, outcome.csv), (Some(Stop::Asked), 4, None));
    let outcome = kept(&sweep, folder.path(), how);
    assert_eq!((outcome.stop, outcome.totals.rows, outcome.found), (None, 9, 4));
}
