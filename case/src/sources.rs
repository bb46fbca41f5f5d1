//! The files that a case names: read once, and kept in memory.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Largest file that is read [bytes].
const LARGEST: u64 = 1_000_000_000;

/// Where the files come from that a case names.
pub trait Sources {
    /// The bytes of the file that the case calls `name`.
    ///
    /// # Errors
    /// Why there are none, in one sentence.
    fn bytes(&self, name: &str) -> Result<Arc<[u8]>, String>;
}

/// Files in memory, by the names that a case gives them.
pub type Contents = BTreeMap<String, Arc<[u8]>>;

impl Sources for Contents {
    fn bytes(&self, name: &str) -> Result<Arc<[u8]>, String> {
        self.get(name).cloned().ok_or_else(|| format!("there is no file {name}"))
    }
}

/// A folder of the file system, to which names are relative. The name of a folder of results stands for the state in it.
#[derive(Clone, Debug)]
pub struct Folder(pub PathBuf);

impl Folder {
    /// The folder of a case, to which the names in it are relative.
    pub fn of(case: &Path) -> Folder {
        Folder(case.parent().unwrap_or(Path::new("")).to_owned())
    }

    /// The file that a name stands for.
    pub fn file(&self, name: &str) -> PathBuf {
        let path = self.0.join(name);
        let state = path.join(&*flexion_results::Artifact::State.file_name());
        if path.is_dir() && state.is_file() { state } else { path }
    }
}

impl Sources for Folder {
    fn bytes(&self, name: &str) -> Result<Arc<[u8]>, String> {
        let path = self.file(name);
        if path.is_dir() {
            return Err(format!("{} is a folder, not a file", path.display()));
        }
        if path.exists() && !path.is_file() {
            return Err(format!("{} is not a regular file", path.display()));
        }
        let mut bytes = Vec::new();
        let read = std::fs::File::open(&path).and_then(|file| file.take(LARGEST + 1).read_to_end(&mut bytes));
        read.map_err(|error| format!("cannot read {}: {error}", path.display()))?;
        if bytes.len() as u64 > LARGEST {
            return Err(format!("{} is larger than {LARGEST} bytes", path.display()));
        }
        Ok(bytes.into())
    }
}

/// The files of one reading: each is read when it is first asked for.
pub struct Files<'s> {
    sources: &'s dyn Sources,
    read: RefCell<Contents>,
}

impl<'s> Files<'s> {
    /// Nothing read yet.
    pub fn new(sources: &'s dyn Sources) -> Files<'s> {
        Files { sources, read: RefCell::default() }
    }

    /// The bytes of a file.
    pub fn bytes(&self, name: &str) -> Result<Arc<[u8]>, String> {
        if let Some(bytes) = self.read.borrow().get(name) {
            return Ok(Arc::clone(bytes));
        }
        let bytes = self.sources.bytes(name)?;
        self.read.borrow_mut().insert(name.to_owned(), Arc::clone(&bytes));
        Ok(bytes)
    }

    /// What was read.
    pub fn into_contents(self) -> Contents {
        self.read.into_inner()
    }
}
