//! Answers kept in a folder: a file each, named by the hash of all that it depends on, with the hash of its own bytes.

use crate::answer::Answer;
use crate::need::Need;
use sha2::{Digest, Sha256};
use std::io::Read;
use std::path::{Path, PathBuf};

/// Answers in a folder.
pub struct Kept {
    folder: PathBuf,
    identity: String,
}

impl Kept {
    /// Those of this folder that were computed by this program.
    pub fn new(folder: &Path, identity: &str) -> Kept {
        Kept { folder: folder.to_owned(), identity: identity.to_owned() }
    }

    fn file(&self, text: &str, need: &Need) -> PathBuf {
        let asked = format!("{:?}", (&self.identity, text, &need.run.key, &need.quantities, &need.columns));
        self.folder.join(format!("{}.json", hash(asked.as_bytes())))
    }

    /// The answer of an earlier call; a file that is torn or was changed is none.
    pub fn find(&self, text: &str, need: &Need) -> Option<Answer> {
        let file = self.file(text, need);
        let whole = std::fs::read_to_string(&file).ok()?;
        let (sum, body) = whole.split_once('\n')?;
        if sum != sum_of(&file, body) {
            return None;
        }
        serde_json::from_str(body).ok()
    }

    /// Keeps an answer, whole or not at all: what cannot be kept is computed again.
    pub fn keep(&self, text: &str, need: &Need, answer: &Answer) {
        let Ok(body) = serde_json::to_string(answer) else { return };
        let file = self.file(text, need);
        let whole = format!("{}\n{body}", sum_of(&file, &body));
        let _ = std::fs::create_dir_all(&self.folder);
        let _ = flexion_results::write_file(&file, whole.as_bytes());
    }
}

/// The hash of an answer with the name of its file: one under the name of another is none.
fn sum_of(file: &Path, body: &str) -> String {
    let name = file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    hash(format!("{name}\n{body}").as_bytes())
}

/// The hash of the program that runs, by which an answer is known to be its own.
pub fn identity_of_program() -> String {
    let hashed = std::env::current_exe().and_then(std::fs::File::open).and_then(|mut file| {
        let (mut digest, mut part) = (Sha256::new(), vec![0; 1 << 16]);
        loop {
            match file.read(&mut part)? {
                0 => return Ok(hex(&digest.finalize())),
                read => digest.update(&part[..read]),
            }
        }
    });
    hashed.unwrap_or_else(|_| flexion_results::VERSION.to_owned())
}

fn hash(bytes: &[u8]) -> String {
    hex(&Sha256::digest(bytes))
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
