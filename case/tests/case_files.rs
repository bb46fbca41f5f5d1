//! Reading case files: what is accepted, what it means in SI, and how bad files are refused.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use flexion_case::{
    Basis, Case, Coupling, Integrator, Motion, Problems, Section, Shape, parse, read, schema, seams,
};
use std::path::Path;

const SPIN_UP: &str = r#"
title = "spin-up"
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
[run]
duration = "20 s"
"#;

fn parsed(text: &str, overrides: &[&str]) -> Result<Case, Problems> {
    let overrides: Vec<String> = overrides.iter().map(|text| (*text).to_owned()).collect();
    parse(text.to_owned(), Path::new("case.toml"), &overrides).map(|reading| reading.case)
}

#[test]
fn a_case_is_read_in_si_with_defaults() {
    let case = parsed(SPIN_UP, &[]).unwrap();
    assert_eq!(case.title, "spin-up");
    assert_eq!(case.length, 10.0);
    let shape = Shape::General { area: 4e-4, second_moment: 2e-7 };
    assert_eq!(
        case.section,
        Section::Uniform { modulus: 70e9, density: 3000.0, shape, rotary_inertia: false }
    );
    assert_eq!(case.hub.motion, Motion::SpinUp { speed: 4.0, time: 15.0 });
    assert_eq!((case.hub.radius, case.hub.inertia), (0.0, 0.0));
    assert_eq!(case.coupling, Coupling::First);
    assert_eq!(case.bases.axial, Basis::FiniteElements { elements: 10, axial_degree: 1 });
    assert!(matches!(case.integrator, Integrator::Radau { initial_step: None, max_step: None, .. }));
    assert_eq!((case.duration, case.output.step), (20.0, 0.02));
    assert!(case.output.stations.is_empty());
}

#[test]
fn overrides_replace_values_tables_and_defaults() {
    let overrides = [
        "section.modulus=30 GPa",
        "basis.elements = 20",
        "basis.kind=finite-elements",
        "model.coupling=exact",
        "integrator={ kind = \"newmark\", step = \"1 ms\" }",
        "output.stations=[\"2 m\", 5]",
        "title=one two",
        "title=two",
    ];
    let case = parsed(SPIN_UP, &overrides).unwrap();
    assert!(matches!(case.section, Section::Uniform { modulus: 30e9, .. }));
    assert_eq!(case.bases.transverse, Basis::FiniteElements { elements: 20, axial_degree: 1 });
    assert_eq!(case.coupling, Coupling::Exact);
    assert_eq!(case.integrator, Integrator::Newmark { step: 1e-3, beta: 0.25, gamma: 0.5 });
    assert_eq!(case.output.stations, [2.0, 5.0]);
    assert_eq!(case.title, "two");
}

/// One override for each kind of each seam.
const KINDS: &[&str] = &[
    "section={kind='uniform',modulus=1e9,density=1,area='1 mm^2',second-moment='3 mm^4',rotary-inertia=true}",
    "section={kind='rectangle',modulus='1 GPa',density='1 g/cm^3',width='1 in',height='2 in'}",
    "section={kind='circle',modulus='1 GPa',density='1 g/cm^3',radius='1 mm'}",
    "section={kind='tube',modulus='1 GPa',density='1 g/cm^3',outer-radius='2 mm',inner-radius='1 mm'}",
    "section={kind='resultants',mass-per-length='1.2 kg/m',axial-stiffness='28 MN',bending-stiffness='14 kN m²',rotary-inertia=6e-4}",
    "section={kind='graded',ceramic-modulus='151 GPa',metal-modulus='70 GPa',ceramic-density=3000,metal-density=2707,width='20 mm',height='20 mm',exponent=2}",
    "section={kind='tapered-rectangle',modulus=1e9,density=1,root-width='2 cm',tip-width='1 cm',root-height='3 cm',tip-height='5 mm'}",
    "section={kind='tapered-circle',modulus=1e9,density=1,root-radius='2 cm',tip-radius='1 cm',rotary-inertia=true}",
    "section={kind='tapered-tube',modulus=1e9,density=1,root-outer-radius='2 cm',root-inner-radius='1 cm',tip-outer-radius='9 mm',tip-inner-radius='8 mm'}",
    "section={kind='piecewise',ends=['4 m',10],modulus=[1e9,'2 GPa'],density=[1,2],area=['1 cm^2','2 cm^2'],second-moment=[1e-8,2e-8]}",
    "section={kind='table',file='broken_cases/../section.csv',interpolation='cubic'}",
    "section={kind='blade',file='broken_cases/../blade.csv'}",
    "blade={pitch='3 deg',precone='-2 deg',twist=0.1,tip-mass='1 kg',tip-inertia='2 kg*m^2',torsion=false}",
    "blade.strain-energy=linear",
    "blade={strain-energy='coupled',bending-first=false,axial-second=false}",
    "blade={strain-energy='exact',elements=3,gyroscopic=false,rotary-inertia=false,poisson-ratio=0.2}",
    "hub.motion={kind='spin-up',speed='3000 rpm',time='1 min'}",
    "hub.motion={kind='constant',speed='-90 deg/s'}",
    "hub.motion={kind='ramp',speed='0.1 rev/s',time=3}",
    "hub.motion={kind='table',file='broken_cases/../motion.csv',of='angle'}",
    "hub.motion={kind='expression',formula='4*sin(t) \"',of='speed'}",
    "model.coupling=zeroth",
    "model.coupling=first",
    "model.coupling=high",
    "model.coupling=exact",
    "basis={kind='finite-elements',elements=3,axial-degree=2}",
    "basis={kind='modes',axial=2,transverse=5}",
    "basis={kind='radial',nodes=9,degree=-1}",
    "basis={kind='polynomial',nodes=9,support=2.5}",
    "basis={kind='b-spline',elements=8,degree=4}",
    "basis={kind='bezier',degree=9}",
    "basis={kind='mixed',axial={kind='b-spline',degree=1},transverse={kind='bezier',degree=5,elements=2}}",
    "basis={kind='mixed',axial={kind='polynomial'},transverse={kind='b-spline'}}",
    "basis={kind='mixed',axial={kind='finite-elements'},transverse={kind='modes',count=3}}",
    "basis={kind='mixed',axial={kind='radial'},transverse={kind='finite-elements',elements=10}}",
    "initial.kind=undeformed",
    "initial.kind=steady-rotation",
    "initial.kind=static",
    "initial={kind='restart',file='state.npz'}",
    "initial={kind='modes',amplitudes=['10 mm',0],velocities=[0,'2 m/s']}",
    "hub.motion={kind='free',angle='10 deg',speed='1 rad/s',damping='0.1 N*m*s/rad',stiffness=2,rest-angle=0.1}",
    "hub.motion={kind='free',torque={kind='constant',torque='3 N*m'}}",
    "hub.motion={kind='free',torque={kind='ramp',torque='3 N*m',time='2 s'},controller={kind='none'}}",
    "hub.motion={kind='free',torque={kind='table',file='motion.csv'}}",
    "hub.motion={kind='free',torque={kind='expression',formula='2*sin(t)'}}",
    "hub.motion={kind='free',controller={kind='pd',proportional=20,derivative=4,target='90 deg',rate='60 deg/s',limit=9}}",
    "gravity={acceleration='9.81 m/s^2',direction='-90 deg'}",
    "mass=[{station='10 m',mass='300 g',inertia=2e-3},{station=5,mass=1}]",
    "force=[{station='10 m',force=['1 N',2],frame='dead'},{station=3,force=[1,0],frame='hub',amplitude={kind='constant'}}]",
    "force=[{station=10,force=[1,2],frame='follower',amplitude={kind='ramp',time='2 s'}}]",
    "couple=[{station=10,couple='3 N*m',amplitude={kind='table',times=[0,'10 s',30],factors=[0,1,0.5]}}]",
    "distributed-load=[{force=['0 N/m','-2 N/m'],from=1,to='5 m',distribution={kind='uniform'},amplitude={kind='expression',formula='sin(t)'}}]",
    "distributed-load=[{force=[0,1],distribution={kind='table',stations=[0,4,10],factors=[1,2,0]}},{force=[0,1],frame='hub',distribution={kind='expression',formula='x^2'}}]",
    "damping={mass-proportional='0.2 1/s',stiffness-proportional='1 ms'}",
    "integrator={kind='radau',max-step='0.1 s'}",
    "integrator.tolerance=1e-8",
    "integrator={kind='newmark',step='3 ms'}",
    "integrator={kind='hht',step='3 ms'}",
    "integrator={kind='generalized-alpha',step='3 ms'}",
    "integrator={kind='runge-kutta-4',step='1e-5 s'}",
    "integrator={kind='adams-4',step='1e-6 s'}",
];

#[test]
fn the_resolved_case_of_every_kind_reads_back_as_the_same_case_and_builds() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("case.toml");
    std::fs::write(folder.path().join("motion.csv"), "# a table\nt,angle\n0,0\n1,2\n10,3\n40,5\n").unwrap();
    let sections =
        "# SI\nx, EI, mass, EA, rotary-inertia\n0, 3, 1, 1e6, 0\n6, 2, 0.5, 1e6, 0\n10, 1, 0.5, 1e6, 0\n";
    std::fs::write(folder.path().join("section.csv"), sections).unwrap();
    let blade = "x, mass, EA, EI-flap, EI-chord, twist\n0, 3, 1e6, 2, 4, 0.1\n10, 1, 1e6, 1, 2, 0\n";
    std::fs::write(folder.path().join("blade.csv"), blade).unwrap();
    for kind in KINDS {
        let kind = kind.replace("broken_cases/../", "").replace(" \"", "");
        let reading = parse(SPIN_UP.to_owned(), &file, std::slice::from_ref(&kind))
            .unwrap_or_else(|e| panic!("{kind}: {e}"));
        let again = parse(reading.resolved(), &file, &[]).unwrap_or_else(|e| panic!("{kind}: {e}"));
        assert_eq!(again.case, reading.case, "{kind}");
        assert_eq!(again.resolved(), reading.resolved(), "{kind}");
        assert!(again.defaults().is_empty(), "{kind}: {:?}", again.defaults());
        let live = reading.build().unwrap_or_else(|e| panic!("{kind}: {e}"));
        assert!(live.system.size().v > 0 && live.integrator.info().order > 0, "{kind}");
    }
    for seam in seams() {
        for kind in seam.kinds {
            let tried =
                |text: &&&str| text.contains(&format!("='{0}'", kind.name)) || text.ends_with(kind.name);
            assert!(KINDS.iter().any(|text| tried(&text)), "{} {} is not tried", seam.name, kind.name);
        }
    }
}

#[test]
fn a_name_with_quotes_and_control_characters_survives_resolution() {
    let title = "a \"b\" \\ c\td\u{1}é\u{7f}";
    let text = SPIN_UP.replace("title = \"spin-up\"", "title = \"a \\\"b\\\" \\\\ c\\td\\u0001é\\u007f\"");
    let reading = parse(text, Path::new("case.toml"), &[]).unwrap();
    assert_eq!(reading.case.title, title);
    assert_eq!(parse(reading.resolved(), Path::new("case.toml"), &[]).unwrap().case.title, title);
}

#[test]
fn the_schema_in_the_documentation_is_the_one_of_the_declarations() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/flexion.schema.json");
    let committed = std::fs::read_to_string(file).unwrap();
    assert!(committed == schema(), "run `flexion schema > docs/flexion.schema.json`");
}

#[test]
fn an_explicit_step_beyond_stability_is_refused_at_its_key() {
    let set = "integrator={ kind = \"runge-kutta-4\", step = \"1 ms\" }".to_owned();
    let reading = parse(SPIN_UP.to_owned(), Path::new("case.toml"), &[set]).unwrap();
    let problems = reading.build().map(|_| ()).unwrap_err();
    assert_eq!(problems.list[0].key, "integrator.step");
    assert!(problems.list[0].message.contains("stability limit"), "{problems}");
    assert_eq!(problems.line_and_column(&problems.list[0]), Some((1, 45)));
}

fn refusal(path: &Path) -> String {
    read(path, &[]).map(|_| ()).unwrap_err().to_string()
}

#[test]
fn what_is_no_case_file_is_refused_with_the_reason() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    assert!(refusal(path).contains("holds no case.toml"), "{}", refusal(path));
    assert!(refusal(&path.join("missing.toml")).contains("or a folder that holds a case.toml"));
    std::fs::create_dir_all(path.join("nested/case.toml")).unwrap();
    assert!(refusal(&path.join("nested")).contains("is not a file"));
    std::fs::write(path.join("latin.toml"), b"title = 'ok'\n# caf\xe9\n").unwrap();
    assert!(refusal(&path.join("latin.toml")).contains("not UTF-8 text: byte 18, on line 2"));
    let huge = std::fs::File::create(path.join("huge.toml")).unwrap();
    huge.set_len(1 << 30).unwrap();
    assert!(refusal(&path.join("huge.toml")).contains("larger than 10 MB"));
    std::fs::write(path.join("case.toml"), SPIN_UP).unwrap();
    assert_eq!(read(path, &[]).unwrap().case, parsed(SPIN_UP, &[]).unwrap());
    if Path::new("/dev/zero").exists() {
        assert!(refusal(Path::new("/dev/zero")).contains("is not a file"));
    }
}

#[test]
fn hostile_nesting_is_refused_without_exhausting_the_stack() {
    let dotted = "a.".repeat(70) + "a";
    let mut inline = "1".to_owned();
    for _ in 0..70 {
        inline = format!("{{ {dotted} = {inline} }}");
    }
    let key = "a.".repeat(100_000) + "a";
    for text in [
        format!("x = {}", "[".repeat(1_000_000)),
        format!("x = {}", "{a=".repeat(300_000)),
        format!("x = {inline}"),
        format!("[{key}]\nb = 1"),
        format!("{key} = 1"),
        "[[a]]\n".repeat(100_000),
        "=\n".repeat(200_000),
    ] {
        let problems = parsed(&text, &[]).map(|_| ()).unwrap_err();
        assert!(problems.to_string().len() < 100_000);
    }
    let set = format!("{key}=1");
    assert!(parsed(SPIN_UP, &[&set]).is_err());
}

/// The default integrator must not pass over an event of the motion that is short against the run.
#[test]
fn a_short_event_of_the_motion_is_not_passed_over() {
    let tip = |overrides: &[&str]| {
        let overrides: Vec<String> = overrides.iter().map(|text| (*text).to_owned()).collect();
        let reading = parse(SPIN_UP.to_owned(), Path::new("case.toml"), &overrides).unwrap();
        let run = reading.prepare().unwrap().run(&mut |_| std::ops::ControlFlow::Continue(()));
        run.trajectory.column("tip.deflection").unwrap().iter().fold(0.0, |m: f64, x| m.max(x.abs()))
    };
    let event = "hub.motion={kind='expression',of='speed',formula='exp(-((t-10)/0.05)^2)'}";
    let small = tip(&[event, "integrator={kind='newmark',step='1 ms'}"]);
    let adaptive = tip(&[event]);
    assert!(small > 0.5 && (adaptive / small - 1.0).abs() < 1e-2, "{adaptive} {small}");
}

/// A station a rounding error before the tip is the tip.
#[test]
fn a_station_at_the_tip_is_not_recorded_twice() {
    let reading = parse(
        SPIN_UP.to_owned(),
        Path::new("case.toml"),
        &["output.stations=[\"9.999999999999999 m\", 5]".to_owned()],
    );
    let live = reading.unwrap().build().unwrap();
    let names: Vec<&str> = live.system.channels().iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names.iter().filter(|name| **name == "tip.deflection").count(), 1);
    assert!(names.contains(&"x=5.deflection"));
}
