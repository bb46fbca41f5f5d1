//! Figures and pages of results.

#![allow(clippy::unwrap_used)] // in helpers of tests

mod program;

use program::{flexion, folder, text};

#[test]
fn results_are_plotted_as_svg_and_png() {
    let folder = folder();
    for (name, elements) in [("a", "basis={kind='modes'}"), ("b", "basis={kind='radial'}")] {
        assert_eq!(
            flexion(folder.path(), &["run", "spin-up", "-o", name, "--set", elements]).status.code(),
            Some(0)
        );
    }
    let read = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    let plot = |arguments: &[&str]| {
        let output = flexion(folder.path(), &[&["plot"], arguments].concat());
        (output.status.code(), text(&output.stderr))
    };
    assert_eq!(
        plot(&["a", "b", "-c", "tip.*", "--title", "Meshes", "-o", "tip.svg"]),
        (Some(0), String::new())
    );
    // In the files columns have names only, and yet the figure is that of the run.
    assert_eq!(plot(&["a", "--title", "spin-up", "-o", "a.svg"]), (Some(0), String::new()));
    assert!(read("a.svg") == read("a/plot.svg"));
    let svg = String::from_utf8(read("tip.svg")).unwrap();
    assert!(svg.contains("Meshes") && svg.contains("(f)") && !svg.contains("(g)"), "six panels");
    assert_eq!(plot(&["a", "-o", "figures/a.png"]), (Some(0), String::new()));
    assert!(read("figures/a.png").starts_with(b"\x89PNG"));
    let (code, message) = plot(&["a", "-o", "figures/a.png"]);
    assert!(code == Some(1) && message.contains("--force"), "{message}");
    let (code, message) = plot(&["a", "--columns", "tip.defelction", "-o", "x.svg"]);
    assert!(code == Some(1) && message.contains("did you mean `tip.deflection`?"), "{message}");
    let (code, message) = plot(&["a", "-o", "x.jpg"]);
    assert!(code == Some(1) && message.contains(".svg, .png or .pdf"), "{message}");
    assert_eq!(plot(&["a", "-o", "a.pdf"]), (Some(0), String::new()));
    assert!(read("a.pdf").starts_with(b"%PDF"));
    let limits = ["a", "-c", "tip.deflection", "--xlim", "0:0.5", "--ylim", "-3:1", "-o", "part.svg"];
    assert_eq!(plot(&limits), (Some(0), String::new()));
    let part = String::from_utf8(read("part.svg")).unwrap();
    assert!(part.contains(">0.5<") && part.contains(">−3<"), "{part}");
    let (code, message) = plot(&["a", "--xlim", "1e3:1e4", "-o", "y.svg"]);
    assert!(code == Some(1) && message.contains("no records from 1000 to 10000 s"), "{message}");
    assert_eq!(plot(&["a", "-c", "energy.kinetic", "--log", "-o", "log.svg"]), (Some(0), String::new()));
    assert!(String::from_utf8(read("log.svg")).unwrap().contains("10⁻"));
    let (code, message) = plot(&["a", "--xlim", "2:1", "-o", "y.svg"]);
    assert!(code == Some(1) && message.contains("ascending"), "{message}");
    // Results without a summary are plotted, with a warning.
    std::fs::remove_file(folder.path().join("b/summary.json")).unwrap();
    let (code, message) = plot(&["b", "-o", "b.svg"]);
    assert!(code == Some(0) && message.contains("incomplete"), "{message}");
}

#[test]
fn motion_and_modes_become_pages() {
    let folder = folder();
    let view = |arguments: &[&str]| {
        let output = flexion(folder.path(), &[&["view"], arguments].concat());
        (output.status.code(), text(&output.stderr))
    };
    let read = |file: &str| std::fs::read_to_string(folder.path().join(file)).unwrap();
    for result in [
        &["run", "spin-up", "-o", "run"][..],
        &["modes", "spin-up", "--speed", "4", "--count", "3", "-o", "modes"],
        &["campbell", "spin-up", "--speeds", "0:4:2", "-o", "campbell"],
    ] {
        assert_eq!(flexion(folder.path(), result).status.code(), Some(0), "{result:?}");
    }
    // What stands in the page, with as many frames as NumPy reads.
    let data = |page: &str| -> serde_json::Value {
        let text = read(page);
        let (_, rest) = text.split_once(r#"<script type="application/json" id="results">"#).unwrap();
        serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap()
    };
    assert_eq!(view(&["run", "-o", "run.html", "-c", "tip.*"]), (Some(0), String::new()));
    let run = data("run.html");
    assert_eq!(run["title"], "spin-up");
    let frames = run["scene"]["time"]["shape"][0].as_u64().unwrap();
    assert!((200..=302).contains(&frames), "{frames}");
    assert_eq!(run["scene"]["beam.displacement"]["shape"], serde_json::json!([frames, 26, 3]));
    let columns = run["curves"]["columns"].as_array().unwrap();
    let shown: Vec<&str> =
        columns.iter().filter(|c| c["shown"] == true).map(|c| c["name"].as_str().unwrap()).collect();
    assert!(shown.len() >= 3 && shown.iter().all(|name| name.starts_with("tip.")), "{shown:?}");
    assert!(columns.iter().any(|c| c["name"] == "hub.speed"));

    assert_eq!(view(&["modes", "-o", "pages/modes.html"]), (Some(0), String::new()));
    let modes = data("pages/modes.html");
    assert_eq!(modes["modes"]["table"]["modes"].as_array().unwrap().len(), 3);
    assert_eq!(modes["modes"]["shapes"]["mode3.chord.real"]["shape"], serde_json::json!([201]));
    // The equilibrium, and two displaced states for each mode.
    assert_eq!(modes["scene"]["beam.pose"]["shape"], serde_json::json!([7, 7]));

    for (arguments, complaint) in [
        (&["run", "-o", "run.html"][..], "--force"),
        (&["run", "-o", "run.svg"], ".html"),
        (&["run", "-o", "x.html", "-c", "tip.defelction"], "did you mean `tip.deflection`"),
        (&["campbell", "-o", "x.html"], "holds no motion and no modes"),
        (&["nowhere", "-o", "x.html"], "nowhere holds no motion and no modes"),
    ] {
        let (code, message) = view(arguments);
        assert!(code == Some(1) && message.contains(complaint), "{arguments:?}: {code:?} {message}");
    }
    std::fs::write(folder.path().join("run/scene.npz"), "cut short").unwrap();
    let (code, message) = view(&["run", "-o", "x.html"]);
    assert!(code == Some(1) && message.contains("scene.npz"), "{message}");
    assert!(!folder.path().join("x.html").exists());
}
