//! The tests of the package, which Python runs: in an environment under `target/` that is made once. Without Python or a network they
//! are left out, which is said; with FLEXION_CI=complete that is a failure.

#![allow(clippy::print_stdout)] // The harness of the tests of Rust shows nothing of a test that passes.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The program that makes the environment.
const ENVIRONMENT: &str = "import sys, venv; sys.exit('it is older than 3.10') if sys.version_info < (3, 10) else venv.create(sys.argv[1], with_pip=True, clear=True)";

fn main() -> ExitCode {
    // As the harness of the tests of Rust, which lists what it has.
    if std::env::args().any(|word| word == "--list") {
        println!("python: test");
        return ExitCode::SUCCESS;
    }
    let outcome = environment().map(|python| tests(&python));
    match outcome {
        Ok(Ok(passed)) => {
            println!("\ntest result: ok. {passed} passed; 0 failed; of the package for Python");
            ExitCode::SUCCESS
        }
        Ok(Err(why)) => {
            println!("\ntest result: FAILED. 0 passed; 1 failed; of the package for Python: {why}");
            ExitCode::FAILURE
        }
        Err(why) => {
            println!("\nTHE TESTS OF THE PACKAGE FOR PYTHON ARE LEFT OUT: {why}");
            let complete = std::env::var_os("FLEXION_CI").is_some_and(|value| value == "complete");
            if complete { ExitCode::FAILURE } else { ExitCode::SUCCESS }
        }
    }
}

/// The folder of what is built.
fn target() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    folder.parent().unwrap_or(folder).to_owned()
}

fn sources() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Runs a command; what it said where it failed.
fn run(command: &mut Command) -> Result<String, String> {
    let name = command.get_program().to_string_lossy().into_owned();
    let output = command.output().map_err(|error| format!("{name}: {error}"))?;
    let said =
        [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned()).concat();
    if output.status.success() { Ok(said) } else { Err(said) }
}

fn last_line(said: &str) -> String {
    said.trim_end().lines().next_back().unwrap_or("no reason was given").to_owned()
}

/// Python of an environment that has what the tests need.
fn environment() -> Result<PathBuf, String> {
    let folder = target().join("python");
    let python = folder.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    let requirements = sources().join("tests/requirements.txt");
    let (wanted, stamp) =
        (std::fs::read(&requirements).map_err(|e| e.to_string())?, folder.join("requirements.txt"));
    if std::fs::read(&stamp).is_ok_and(|made| made == wanted) {
        return Ok(python);
    }
    println!("making an environment of Python for the tests of the package, once");
    let host = if cfg!(windows) { "python" } else { "python3" };
    run(Command::new(host).args(["-c", ENVIRONMENT]).arg(&folder))
        .map_err(|said| format!("no Python 3.10 or later with venv: {}", last_line(&said)))?;
    let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--timeout", "20", "-r"];
    run(Command::new(&python).args(pip).arg(&requirements))
        .map_err(|said| format!("what they need could not be installed: {}", last_line(&said)))?;
    std::fs::write(&stamp, wanted).map_err(|error| error.to_string())?;
    Ok(python)
}

/// Runs the tests of the package and what holds its types: the number of tests that passed.
fn tests(python: &Path) -> Result<u32, String> {
    let site = target().join("python/site");
    let package = site.join("flexion");
    installed(&package).map_err(|error| format!("{}: {error}", package.display()))?;
    let with = |words: &[&str]| {
        let mut command = Command::new(python);
        command.args(words).env("PYTHONPATH", &site).current_dir(&site);
        command
    };
    let passed = in_files(|file| {
        let file = sources().join("tests").join(file);
        run(with(&["-m", "pytest", "-p", "no:cacheprovider", "-W", "ignore"]).arg(file))
    })?;
    let examples = run(with(&["-m", "doctest"]).arg(package.join("_value.py")));
    examples.map_err(|said| format!("\n{said}"))?;
    let settings = sources().join("pyproject.toml");
    let strict = run(with(&["-m", "mypy", "--strict", "-p", "flexion", "--config-file"]).arg(&settings));
    strict.map_err(|said| format!("\n{said}"))?;
    run(&mut with(&["-m", "mypy.stubtest", "flexion._core"])).map_err(|said| format!("\n{said}"))?;
    Ok(passed)
}

/// Runs the files of tests, one a processor at a time: the number of tests that passed.
fn in_files(test: impl Fn(&str) -> Result<String, String> + Sync) -> Result<u32, String> {
    let names = std::fs::read_dir(sources().join("tests")).map_err(|error| error.to_string())?;
    let names = names.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned());
    let mut files: Vec<String> =
        names.filter(|name| name.starts_with("test_") && name.ends_with(".py")).collect();
    files.sort();
    let (left, sums) = (Mutex::new(files), Mutex::new((0, String::new())));
    let worker = || {
        while let Some(file) = locked(&left).pop() {
            let said = test(&file);
            let text = said.as_ref().unwrap_or_else(|said| said);
            let counted = text.lines().rev().find_map(|line| line.split_once(" passed"));
            let count = counted.and_then(|(before, _)| before.rsplit([' ', ',']).next()?.parse::<u32>().ok());
            let mut sums = locked(&sums);
            sums.0 += count.unwrap_or(0);
            if said.is_err() || count.is_none() {
                sums.1 += &format!("\n{file}:\n{text}");
            }
        }
    };
    std::thread::scope(|scope| {
        (0..std::thread::available_parallelism().map_or(1, usize::from)).for_each(|_| {
            scope.spawn(worker);
        });
    });
    let (passed, failed) = &*locked(&sums);
    if failed.is_empty() { Ok(*passed) } else { Err(failed.clone()) }
}

fn locked<T>(of: &Mutex<T>) -> MutexGuard<'_, T> {
    of.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Copies the sources of the package, and the library that was built beside this test, to where Python finds them.
fn installed(package: &Path) -> std::io::Result<()> {
    if package.exists() {
        std::fs::remove_dir_all(package)?;
    }
    std::fs::create_dir_all(package)?;
    for entry in std::fs::read_dir(sources().join("flexion"))? {
        let entry = entry?;
        if entry.file_type()?.is_file() {
            std::fs::copy(entry.path(), package.join(entry.file_name()))?;
        }
    }
    let (library, extension) = match std::env::consts::OS {
        "windows" => ("_core.dll", "_core.pyd"),
        "macos" => ("lib_core.dylib", "_core.abi3.so"),
        _ => ("lib_core.so", "_core.abi3.so"),
    };
    let test = std::env::current_exe()?;
    let built = test.parent().unwrap_or(&test);
    std::fs::copy(built.join(library), package.join(extension)).map(drop)
}
