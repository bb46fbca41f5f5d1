//! What the engine replies.

#![allow(clippy::unwrap_used, clippy::panic)]

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flexion_lab::reply;
use serde_json::{Value, json};

const SPIN_UP: &str = include_str!("../../../verification/p1_spin_up_4/case.toml");
const PENDULUM: &str = include_str!("../../../verification/falling_pendulum/case.toml");

/// The reply, and what was shown meanwhile.
fn shown(request: &Value) -> (Value, Vec<Value>) {
    let mut all = Vec::new();
    let text = reply(&request.to_string(), &mut |text| all.push(serde_json::from_str(text).unwrap()));
    (serde_json::from_str(&text).unwrap(), all)
}

fn ask(request: Value) -> Value {
    shown(&request).0
}

fn numbers(array: &Value) -> Vec<f64> {
    let bytes = STANDARD.decode(array["values"].as_str().unwrap().strip_prefix("f8:").unwrap()).unwrap();
    bytes.as_chunks::<8>().0.iter().map(|x| f64::from_le_bytes(*x)).collect()
}

#[test]
fn a_case_is_checked_with_its_values_and_problems_at_their_lines() {
    let good = ask(json!({ "do": "check", "case": SPIN_UP }));
    assert_eq!((&good["status"], &good["kind"]), (&json!("valid"), &json!("run")));
    let modulus =
        good["tables"].as_array().unwrap().iter().find(|of| of["path"] == "section.modulus").unwrap();
    assert_eq!(
        (&modulus["number"], &modulus["unit"], &modulus["written"]),
        (&json!(7e10), &json!("Pa"), &json!("\"70 GPa\""))
    );
    assert_eq!(modulus["range"], json!({ "least": 0, "most": null, "above": true }));
    let bad = ask(json!({ "do": "check", "case": SPIN_UP.replace("elements = ", "elemnts = ") }));
    let problem = &bad["problems"][0];
    let line = SPIN_UP.lines().position(|line| line.starts_with("elements")).unwrap() + 1;
    assert_eq!((&bad["status"], &problem["line"]), (&json!("rejected"), &json!(line)));
    let set = ask(json!({ "do": "check", "case": SPIN_UP, "set": { "basis.elements": "-1" } }));
    let list = ask(json!({ "do": "check", "case": SPIN_UP, "set": ["basis.elements=-1"] }));
    assert_eq!(list["problems"], set["problems"]);
    assert_eq!((&set["problems"][0]["line"], &set["problems"][0]["set"]), (&Value::Null, &json!("--set")));
}

#[test]
fn a_run_gives_its_columns_errors_and_scene() {
    let set = json!({ "run.duration": "80 s" });
    let request =
        json!({ "do": "run", "case": SPIN_UP, "set": set, "errors": true, "columns": true, "rows": true });
    let (run, shown) = shown(&request);
    assert_eq!(run["status"], "finished");
    let deflection = numbers(&run["columns"]["tip.deflection"]);
    let least = run["summary"]["columns"]["tip.deflection"]["min"].as_f64().unwrap();
    // `verification/p1_spin_up_4/expected.toml`.
    assert!((least + 0.400337212).abs() < 1e-6, "{least}");
    assert!(run["summary"]["columns"]["tip.deflection"]["error"]["min"].as_f64().unwrap() < 1e-6);
    let curve = &run["results"]["curves"]["columns"][0];
    assert!(curve["error"].as_str().unwrap().starts_with("f4:"), "{curve}");
    assert!(run["results"]["scene"]["beam.pose"].is_object());
    // Records are shown while the run goes on: each once, in their order.
    let rows = shown.iter().filter(|of| of["phase"] == "run").map(|of| &of["rows"]);
    let times: Vec<f64> = rows.clone().flat_map(|of| numbers(&of["time"])).collect();
    let early: Vec<f64> = rows.flat_map(|of| numbers(&of["tip.deflection"])).collect();
    assert!(times.len() > 100 && times == numbers(&run["columns"]["time"])[..times.len()], "{}", times.len());
    assert!(early == deflection[..early.len()]);
}

#[test]
fn work_and_memory_have_limits() {
    let run = ask(json!({ "do": "run", "case": SPIN_UP, "limits": { "work": 3000 } }));
    assert_eq!(run["status"], "given-up");
    assert!(run["message"].as_str().unwrap().contains("work"), "{}", run["message"]);
    // What was computed until then is there.
    assert!(run["summary"]["end_time"].as_f64().unwrap() > 0.0);
    let modes = ask(json!({ "do": "modes", "case": SPIN_UP, "limits": { "work": 10 } }));
    assert_eq!(modes["status"], "given-up");
    // Modes of 12,000 elements take several seconds on a common machine, where two are two million of work.
    let many = json!({ "basis.elements": "12000" });
    let modes = ask(json!({ "do": "modes", "case": SPIN_UP, "set": many, "limits": { "work": 2e6 } }));
    assert_eq!(modes["status"], "given-up", "{modes}");
    // The limit ended them, and no user.
    let case = include_str!("../../../verification/space_statics/case.toml");
    let of = |work: f64| ask(json!({ "do": "statics", "case": case, "limits": { "work": work } }));
    let refused = [1e3, 2e3, 5e3, 1e4, 2e4, 5e4].map(of);
    let paths: Vec<_> = refused.iter().filter(|reply| reply["results"].is_object()).collect();
    assert!(paths.iter().any(|path| path["status"] == "given-up"), "{refused:?}");
    assert!(paths.iter().all(|path| !path["message"].to_string().contains("user")), "{paths:?}");
    // It says what it ended: the path, or its errors alone.
    let whole = |path: &Value| path["status"] == "finished" && path["summary"]["errors"]["estimated"] == true;
    assert!(paths.iter().all(|path| path["message"].is_null() == whole(path)), "{paths:?}");
    let without_errors = |path: &&&Value| path["status"] == "finished" && path["message"].is_string();
    assert!(paths.iter().filter(without_errors).count() > 0, "{paths:?}");
}

#[test]
fn files_are_those_of_the_program() {
    let reply = ask(json!({ "do": "files", "case": PENDULUM, "errors": true }));
    let text = |name: &str| {
        String::from_utf8(STANDARD.decode(reply["files"][name].as_str().unwrap()).unwrap()).unwrap()
    };
    let case = flexion_case::parse(PENDULUM.to_owned(), "case.toml".as_ref(), &[]).unwrap();
    let run = case.prepare().unwrap().run(&mut |_| std::ops::ControlFlow::Continue(()));
    let mut csv = Vec::new();
    flexion_results::write_csv(&run.trajectory, &mut csv).unwrap();
    assert!(text("trajectory.csv").into_bytes() == csv);
    assert!(text("events.csv").contains("impact") && text("summary.json").contains("\"finished\""));
    assert!(text("case.resolved.toml").contains("coupling = \"high\""));
}

#[test]
fn modes_diagrams_and_equilibria_are_found() {
    let modes = ask(json!({ "do": "modes", "case": SPIN_UP, "speed": "40 rpm", "count": 3 }));
    assert_eq!((&modes["status"], &modes["summary"]["unit"]), (&json!("finished"), &json!("Hz")));
    assert!(modes["results"]["modes"]["shapes"]["mode3.chord.real"].is_object());
    let diagram = ask(json!({ "do": "campbell", "case": SPIN_UP, "speeds": "0:4:3", "modes": 2 }));
    let curves = &diagram["results"]["curves"];
    assert_eq!(numbers(&curves["speed"]), [0.0, 2.0, 4.0]);
    assert!(numbers(&curves["mode1.frequency"])[2] > 0.0, "{diagram}");
    let case = include_str!("../../../verification/space_statics/case.toml");
    let path = ask(json!({ "do": "statics", "case": case }));
    assert_eq!(numbers(&path["results"]["curves"]["load_factor"]).last(), Some(&1.0), "{path}");
}

#[test]
fn a_case_is_changed_and_told_apart() {
    let changed = ask(json!({ "do": "change", "case": SPIN_UP, "set": { "section.modulus": "30 GPa" } }));
    let text = changed["case"].as_str().unwrap();
    assert_eq!(text, SPIN_UP.replace("\"70 GPa\"", "\"30 GPa\""));
    let told = ask(json!({ "do": "difference", "case": text, "from": SPIN_UP }));
    assert_eq!(told["set"], json!({ "section.modulus": "\"30 GPa\"" }));
    assert_eq!(ask(json!({ "do": "difference", "case": PENDULUM, "from": SPIN_UP }))["set"], Value::Null);
}

#[test]
fn what_cannot_be_asked_is_refused() {
    for request in [
        "",
        "[]",
        "{}",
        r#"{"do":1}"#,
        r#"{"do":"dance"}"#,
        r#"{"do":"run","files":{"a":"!"}}"#,
        r#"{"do":"run","set":3}"#,
    ] {
        let reply: Value = serde_json::from_str(&reply(request, &mut |_| {})).unwrap();
        assert_eq!(reply["status"], "refused", "{request}");
    }
    assert!(ask(json!({ "do": "keys" }))["schema"]["anyOf"].is_array());
}
