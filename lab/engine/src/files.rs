//! The files that the program writes, pictures and archives aside.

use crate::request::Request;
use crate::work::{Found, Progress, rejected};
use crate::{ran, vibrating};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flexion_results::{Artifact, Directory, OutputError, write_statics};
use serde_json::{Map, Value, json};

/// What writes files: nothing, why they could not be written, or the reply in their place.
type Write = fn(&Request, &Directory, &mut Progress<'_>) -> Found<Result<(), OutputError>>;

/// The files of a run, or of what `of` says: `modes`, `campbell`, `statics`.
pub(crate) fn files(request: &Request, progress: &mut Progress<'_>) -> Result<Value, String> {
    let of = request.option("of").and_then(Value::as_str).unwrap_or("run");
    let (own, write): (_, Write) = match of {
        "run" => (Artifact::RUN, run),
        "modes" => (Artifact::MODES, modes),
        "campbell" => (Artifact::CAMPBELL, campbell),
        "statics" => (Artifact::STATICS, statics),
        other => return Err(format!("`of` is one of run, modes, campbell, statics, and not `{other}`")),
    };
    let directory = Directory::in_memory(own);
    Ok(match write(request, &directory, progress) {
        Ok(Ok(())) => {
            let files = directory.into_files().into_iter();
            let files = files.map(|(name, bytes)| (name, STANDARD.encode(bytes).into()));
            json!({ "status": "finished", "files": files.collect::<Map<_, Value>>() })
        }
        Ok(Err(error)) => json!({ "status": "failed", "message": error.to_string() }),
        Err(reply) => reply,
    })
}

fn run(
    request: &Request,
    directory: &Directory,
    progress: &mut Progress<'_>,
) -> Found<Result<(), OutputError>> {
    let reading = request.read().map_err(|problems| rejected(&problems))?;
    let ran = ran::calculate(request, &reading, progress)?;
    Ok(ran.of.reading.write(&ran.of.run, directory).map(|_| ()))
}

fn modes(request: &Request, directory: &Directory, _: &mut Progress<'_>) -> Found<Result<(), OutputError>> {
    let reading = request.read().map_err(|problems| rejected(&problems))?;
    let found = vibrating::modes(request, &reading)?;
    Ok(reading.write_modes(&found, reading.title(), directory))
}

fn campbell(
    request: &Request,
    directory: &Directory,
    progress: &mut Progress<'_>,
) -> Found<Result<(), OutputError>> {
    let reading = request.read().map_err(|problems| rejected(&problems))?;
    let found = vibrating::campbell(request, &reading, progress)?;
    Ok(reading.write_campbell(&found, reading.title(), directory))
}

fn statics(
    request: &Request,
    directory: &Directory,
    progress: &mut Progress<'_>,
) -> Found<Result<(), OutputError>> {
    let reading = request.read().map_err(|problems| rejected(&problems))?;
    let (path, _) = vibrating::statics(request, &reading, progress)?;
    Ok(write_statics(directory, &path, &reading.resolved(), reading.title(), &path.cautions))
}
