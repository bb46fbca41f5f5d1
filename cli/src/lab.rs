//! `flexion lab`: cases in the browser, offline.

use crate::{Outcome, screen};
use base64::Engine;
use base64::engine::general_purpose::URL_SAFE_NO_PAD;
use flate2::Compression;
use flate2::write::DeflateEncoder;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The page with the engine within.
const PAGE: &str = "lab.html";
/// Largest case in a link [bytes, compressed].
const LARGEST: usize = 64_000;
/// What makes the page.
const BUILD: &str = "cargo build --profile wasm -p flexion-lab --target wasm32-unknown-unknown && cd lab && npm ci && npm run pages";

/// The case to begin with.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  flexion lab
  flexion lab case.toml
  flexion lab verification/falling_pendulum --print

The lab is one page, which computes in the browser and needs neither a server nor a network. It is looked for beside the program, and
in lab/dist of the folder in which the program is called or of the one that it was built in.

Exit codes: 0 opened or printed, 1 no such case, or no page of the lab: what makes it is said.")]
pub struct Arguments {
    /// Case file, or a folder that holds a case.toml, to begin with; the files that it names are chosen in the page
    #[arg(value_name = "CASE")]
    case: Option<PathBuf>,
    /// Print the link, and open nothing
    #[arg(long)]
    print: bool,
}

/// Opens the lab.
pub fn lab(arguments: &Arguments) -> Outcome {
    match link(arguments.case.as_deref(), &places()) {
        Ok(link) => {
            screen::print(&format!("{link}\n"));
            if !arguments.print && !opened(&link) {
                screen::report("warning: no browser could be opened: open the link in one\n");
            }
            Outcome::Finished
        }
        Err(message) => {
            screen::report(&format!("error: {message}\n"));
            Outcome::Rejected
        }
    }
}

/// Where the page may be: beside the program, in `share/flexion` beside its folder, and in the sources.
fn places() -> Vec<PathBuf> {
    let program = std::env::current_exe().ok().and_then(|program| Some(program.parent()?.to_owned()));
    let beside = program.into_iter().flat_map(|folder| [folder.clone(), folder.join("../share/flexion")]);
    let sources =
        [Path::new("lab/dist").to_owned(), Path::new(env!("CARGO_MANIFEST_DIR")).join("../lab/dist")];
    beside.chain(sources).collect()
}

/// The link of the page, with a case in it.
fn link(case: Option<&Path>, places: &[PathBuf]) -> Result<String, String> {
    let page = places.iter().map(|folder| folder.join(PAGE)).find(|page| page.is_file());
    let page = page.ok_or_else(|| {
        format!("there is no page of the lab ({PAGE}) beside the program or in lab/dist; in the sources this makes it:\n  {BUILD}")
    })?;
    let page = page.canonicalize().map_err(|error| format!("cannot read {}: {error}", page.display()))?;
    let fragment = case.map_or(Ok(String::new()), fragment)?;
    Ok(format!("file://{}{fragment}", escaped(&page)))
}

/// The case in a link: deflated, in base64 of URLs.
fn fragment(case: &Path) -> Result<String, String> {
    let file = if case.is_dir() { case.join("case.toml") } else { case.to_owned() };
    let text = std::fs::read(&file).map_err(|error| format!("cannot read {}: {error}", file.display()))?;
    let mut deflated = DeflateEncoder::new(Vec::new(), Compression::best());
    let deflated = deflated.write_all(&text).and_then(|()| deflated.finish());
    let deflated = deflated.map_err(|error| format!("{}: {error}", file.display()))?;
    if deflated.len() > LARGEST {
        return Err(format!("{} is too large for a link: open it in the page", file.display()));
    }
    Ok(format!("#c={}", URL_SAFE_NO_PAD.encode(deflated)))
}

/// A path in a link: with `/`, and what is no plain letter as bytes in hexadecimal.
fn escaped(path: &Path) -> String {
    let text = path.to_string_lossy().replace('\\', "/");
    // Of Windows: `//?/C:/…`.
    let text = text.strip_prefix("//?/").map_or(text.clone(), |rest| format!("/{rest}"));
    let one = |byte: u8| match byte {
        b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'/' | b'.' | b'-' | b'_' | b'~' | b':' => {
            char::from(byte).to_string()
        }
        byte => format!("%{byte:02X}"),
    };
    text.bytes().map(one).collect()
}

/// Opens a link by the program that the system has for that.
fn opened(link: &str) -> bool {
    let (program, words): (&str, &[&str]) = match std::env::consts::OS {
        "macos" => ("open", &[]),
        // Its first word is the title of a window.
        "windows" => ("cmd", &["/C", "start", ""]),
        _ => ("xdg-open", &[]),
    };
    let mut command = Command::new(program);
    command.args(words).arg(link).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.spawn().is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::read::DeflateDecoder;
    use std::io::Read;

    #[test]
    fn the_link_holds_the_case() {
        let folder = tempfile::tempdir().unwrap();
        let error = link(None, &[folder.path().to_owned()]).unwrap_err();
        assert!(error.contains("npm run pages"), "{error}");
        let place = folder.path().join("with space");
        std::fs::create_dir(&place).unwrap();
        std::fs::write(place.join(PAGE), "page").unwrap();
        let places = [folder.path().to_owned(), place];
        assert!(link(None, &places).unwrap().ends_with("with%20space/lab.html"));
        let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("../verification/p1_spin_up_4");
        let link = link(Some(&case), &places).unwrap();
        let deflated = URL_SAFE_NO_PAD.decode(link.split("#c=").nth(1).unwrap()).unwrap();
        let mut text = String::new();
        DeflateDecoder::new(deflated.as_slice()).read_to_string(&mut text).unwrap();
        assert_eq!(text, std::fs::read_to_string(case.join("case.toml")).unwrap());
        assert!(super::link(Some(Path::new("nothing.toml")), &places).unwrap_err().contains("cannot read"));
    }
}
