//! The shapes for ParaView say what the trajectory says: read here as XML, and by VTK itself where Python can have it.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flexion_case::{Run, read};
use flexion_results::{Directory, Status};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;
use std::time::{Duration, Instant};

/// Largest difference, over the length of the beam or in rad: rounding.
const TOLERANCE: f64 = 1e-12;
/// How long Python may take to fetch VTK.
const PATIENCE: Duration = Duration::from_secs(45);
/// Python with VTK and NumPy, if one is at hand.
const PYTHON: &str = "FLEXION_VTK_PYTHON";

/// A beam that bends by more than half its length while it turns.
fn results(folder: &Path) -> (PathBuf, Run) {
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("../verification/p1_spin_up_4_at_5_gpa");
    let set =
        ["model.coupling=exact", "run.duration=6", "output={step=0.5,vtk=true,vtk-step=1,stations=[2.5,7]}"];
    let reading = read(&case, &set.map(str::to_owned)).unwrap();
    let run = reading.prepare().unwrap().run(&mut |_| ControlFlow::Continue(()));
    assert_eq!(run.status, Status::Finished, "{:?}", run.message);
    let out = folder.join("results");
    reading.write(&run, &Directory::create(&out, false).unwrap()).unwrap();
    (out, run)
}

/// The numbers of an array.
fn numbers(document: &roxmltree::Document<'_>, name: &str) -> Vec<f64> {
    let node = document.descendants().find(|n| n.attribute("Name") == Some(name)).unwrap();
    assert_eq!(
        (node.attribute("type"), node.attribute("format")),
        (Some("Float64"), Some("binary")),
        "{name}"
    );
    let block = STANDARD.decode(node.text().unwrap().trim()).unwrap();
    assert_eq!(u64::from_le_bytes(block[..8].try_into().unwrap()) as usize, block.len() - 8, "{name}");
    block[8..].chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect()
}

#[test]
fn points_and_arrays_of_every_frame_are_those_of_the_trajectory() {
    let folder = tempfile::tempdir().unwrap();
    let (out, run) = results(folder.path());
    let column = |name: &str| run.trajectory.column(name).unwrap();
    let index = std::fs::read_to_string(out.join("beam.pvd")).unwrap();
    let index = roxmltree::Document::parse(&index).unwrap();
    let sets: Vec<_> = index.descendants().filter(|n| n.has_tag_name("DataSet")).collect();
    assert_eq!(sets.len(), 7);
    let (angle, mut worst, mut bent) = (column("hub.angle"), 0.0_f64, 0.0_f64);
    for set in sets {
        let time: f64 = set.attribute("timestep").unwrap().parse().unwrap();
        let row = run.trajectory.times().iter().position(|t| *t == time).unwrap();
        let text = std::fs::read_to_string(out.join(set.attribute("file").unwrap())).unwrap();
        let grid = roxmltree::Document::parse(&text).unwrap();
        assert_eq!(numbers(&grid, "TimeValue"), [time]);
        let (points, stations) = (numbers(&grid, "Points"), numbers(&grid, "arc_length"));
        assert_eq!(points.len(), 3 * stations.len());
        let (sin, cos) = angle[row].sin_cos();
        for (name, at) in [("tip", 10.0), ("x=2.5", 2.5), ("x=7", 7.0)] {
            // Lower fibre, axis, upper fibre of each station.
            let i = (1..stations.len()).step_by(3).find(|&i| (stations[i] - at).abs() < 1e-9).unwrap();
            let [axial, deflection, rotation] =
                ["axial", "deflection", "rotation"].map(|of| column(&format!("{name}.{of}"))[row]);
            bent = bent.max(deflection.abs());
            let x = at + axial;
            let expected = [x * cos - deflection * sin, x * sin + deflection * cos, 0.0];
            for (c, expected) in expected.iter().enumerate() {
                worst = worst.max((points[3 * i + c] - expected).abs() / 10.0);
            }
            worst = worst.max((numbers(&grid, "axial")[i] - axial).abs() / 10.0);
            worst = worst.max((numbers(&grid, "deflection")[i] - deflection).abs() / 10.0);
            worst = worst.max((numbers(&grid, "rotation")[i] - rotation).abs());
        }
    }
    assert!(bent > 4.0, "{bent}");
    assert!(worst < TOLERANCE, "{worst:.1e}");
}

#[cfg(feature = "vtkhdf")]
#[test]
fn the_points_of_all_times_follow_one_another_in_one_file() {
    let folder = tempfile::tempdir().unwrap();
    let (out, _) = results(folder.path());
    let file = std::fs::read(out.join("beam.vtkhdf")).unwrap();
    assert!(file.starts_with(b"\x89HDF\r\n\x1a\n"));
    for name in ["Points", "displacement", "deflection", "axial", "rotation"] {
        let mut expected = Vec::new();
        for frame in 0..7 {
            let text = std::fs::read_to_string(out.join(format!("vtk/frame_{frame:05}.vtu"))).unwrap();
            let grid = roxmltree::Document::parse(&text).unwrap();
            expected.extend(numbers(&grid, name).into_iter().flat_map(f64::to_le_bytes));
        }
        assert!((0..file.len()).any(|at| file[at..].starts_with(&expected)), "{name}");
    }
}

/// Runs a command to its end, or kills it when it takes longer than `patience`; its output goes to `log`.
fn finish(command: &mut Command, log: &Path, patience: Duration) -> Result<(), String> {
    let file = std::fs::File::create(log).map_err(|e| e.to_string())?;
    let errors = file.try_clone().map_err(|e| e.to_string())?;
    let mut child = command
        .stdin(Stdio::null())
        .stdout(file)
        .stderr(errors)
        .spawn()
        .map_err(|e| format!("{command:?}: {e}"))?;
    let start = Instant::now();
    loop {
        match child.try_wait().map_err(|e| e.to_string())? {
            Some(status) if status.success() => return Ok(()),
            Some(status) => {
                let said = std::fs::read_to_string(log).unwrap_or_default();
                return Err(format!("{status}: {}", said.lines().last().unwrap_or_default()));
            }
            None if start.elapsed() > patience => {
                let _ = child.kill();
                let _ = child.wait();
                return Err(format!("not ready after {} s", patience.as_secs()));
            }
            None => std::thread::sleep(Duration::from_millis(100)),
        }
    }
}

/// Python with VTK: that of the environment, or one of a virtual environment that is made once beside the build.
fn python(logs: &Path) -> Result<PathBuf, String> {
    if let Some(given) = std::env::var_os(PYTHON) {
        return Ok(given.into());
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("vtk-python");
    let python = folder.join("bin/python");
    let has_vtk = |python: &Path| {
        let import = "import vtkmodules.vtkIOXML, vtkmodules.vtkFiltersVerdict, numpy";
        finish(Command::new(python).args(["-c", import]), &logs.join("import"), PATIENCE)
    };
    if has_vtk(&python).is_ok() {
        return Ok(python);
    }
    let venv = ["-m", "venv", "--clear"];
    finish(Command::new("python3").args(venv).arg(&folder), &logs.join("venv"), PATIENCE)
        .map_err(|e| format!("no virtual environment of Python: {e}"))?;
    let install = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "vtk", "numpy"];
    finish(Command::new(&python).args(install), &logs.join("pip"), PATIENCE)
        .map_err(|e| format!("VTK cannot be installed: {e}"))?;
    has_vtk(&python).map_err(|e| format!("VTK cannot be imported: {e}"))?;
    Ok(python)
}

/// Says `VTK: …` with what was compared, or why it was left out: a machine without Python or network has no VTK.
fn hold_against(script: &str) {
    // The environment is made by one test at a time.
    static FOUND: OnceLock<Result<PathBuf, String>> = OnceLock::new();
    let folder = tempfile::tempdir().unwrap();
    let python = match FOUND.get_or_init(|| python(folder.path())) {
        Ok(python) => python,
        Err(reason) => {
            eprintln!("VTK: left out, {reason}");
            return;
        }
    };
    let (out, _) = results(folder.path());
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/vtk").join(script);
    let log = folder.path().join("read");
    let read = finish(Command::new(python).arg(script).arg(&out), &log, PATIENCE);
    let said = std::fs::read_to_string(&log).unwrap();
    assert!(read.is_ok(), "{read:?}: {said}");
    eprintln!("VTK: {}", said.trim());
}

#[test]
fn vtk_itself_reads_the_shapes() {
    hold_against("read_back.py");
}

#[cfg(feature = "vtkhdf")]
#[test]
fn vtk_itself_reads_all_times_from_one_file() {
    hold_against("read_back_hdf.py");
}
