//! What the rows of a sweep depend on: two sweeps with the same identity have the same rows.

use super::Sweep;
use super::points::Column;
use super::written::bare;
use flexion_results::VERSION;
use serde_json::{Map, Value, json};
use sha2::{Digest, Sha256};
use std::fmt::Write as _;

/// Digits of the name of a sweep in the names of its parts.
const DIGITS: usize = 16;

impl Sweep {
    /// What the rows depend on, entry by entry.
    pub(super) fn identity(&self) -> Map<String, Value> {
        let mut case = Sha256::new();
        field(&mut case, self.reading.resolved().as_bytes());
        for (name, bytes) in &self.reading.files {
            field(&mut case, name.as_bytes());
            field(&mut case, bytes);
        }
        let mut inputs = Sha256::new();
        for (input, column) in self.inputs.iter().zip(&self.columns) {
            field(&mut inputs, input.key.as_bytes());
            match column {
                Column::Numbers(of) => of.iter().for_each(|x| inputs.update(x.to_bits().to_le_bytes())),
                Column::Texts(texts, of) => {
                    of.iter().for_each(|text| field(&mut inputs, bare(&texts[*text as usize]).as_bytes()));
                }
            }
        }
        let keys: Vec<&str> = self.inputs.iter().map(|input| input.key.as_str()).collect();
        let quantities: Vec<String> =
            self.quantities.iter().map(|quantity| quantity.name().to_owned()).collect();
        let mut out = Map::new();
        let mut put = |key: &str, value: Value| out.insert(key.to_owned(), value);
        put("version", VERSION.into());
        put("case", digits(case).into());
        put("keys", keys.into());
        put("rows", self.rows.into());
        put("sample", self.given.sample.map(|sample| sample.method.name()).into());
        put("seed", self.seed().into());
        put("inputs", digits(inputs).into());
        put("quantities", quantities.into());
        put("errors", self.options.errors.name().into());
        put("limit", self.options.limit.into());
        put("rows of a part", self.part().into());
        out
    }

    /// What the sweep is, for the folder of its parts.
    pub(super) fn manifest(&self, identity: &Map<String, Value>) -> Value {
        let table = self.given.table.as_ref().map(|table| table.name.as_str());
        let column = |name: &str, unit: &str| json!({ "name": name, "unit": unit });
        let inputs: Vec<Value> = self.inputs.iter().map(|input| column(&input.key, &input.unit)).collect();
        let quantities: Vec<Value> = self.quantities.iter().map(|of| column(of.name(), &of.unit)).collect();
        json!({
            "kind": "sweep",
            "file": self.reading.file.file_name().map(|name| name.to_string_lossy()),
            "vary": self.given.vary,
            "table": table,
            "inputs": inputs,
            "quantities": quantities,
            "name": name(identity),
            "identity": identity,
        })
    }
}

/// The name of an identity.
pub(super) fn name(identity: &Map<String, Value>) -> String {
    let mut hash = Sha256::new();
    field(&mut hash, Value::Object(identity.clone()).to_string().as_bytes());
    digits(hash)
}

/// What differs between two identities, of which `there` is that of a folder: the first entry, in words.
pub(super) fn difference(there: &Map<String, Value>, here: &Map<String, Value>) -> Option<String> {
    let differs = |key: &&String| there.get(*key) != here.get(*key);
    let key = here.keys().chain(there.keys()).find(differs)?;
    let text = |of: &Map<String, Value>| of.get(key).map_or("none".to_owned(), Value::to_string);
    Some(match key.as_str() {
        "case" => "its case is another, or a file that the case names".to_owned(),
        "inputs" => "the values of its inputs are others".to_owned(),
        key => format!("its {key} is {} and not {}", text(there), text(here)),
    })
}

/// Adds bytes with their number, so that no two lists of them are the same.
fn field(hash: &mut Sha256, bytes: &[u8]) {
    hash.update((bytes.len() as u64).to_le_bytes());
    hash.update(bytes);
}

fn digits(hash: Sha256) -> String {
    let mut out = String::new();
    for byte in hash.finalize().iter().take(DIGITS / 2) {
        let _ = write!(out, "{byte:02x}");
    }
    out
}
