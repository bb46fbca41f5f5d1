//! What is asked.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flexion_case::{Contents, Problems, Reading, parse_with};
use serde_json::{Map, Value};
use std::path::Path;

/// Memory of a request, if it says nothing else [bytes].
const MEMORY: f64 = 1e9;

/// A request: an object of JSON.
///
/// | key | meaning |
/// |---|---|
/// | `do` | what is asked |
/// | `case` | text of the case, TOML |
/// | `name` | name of its file; `case.toml` if left out |
/// | `files` | files that the case names: name and bytes in base64 |
/// | `set` | changes of keys as of `--set`: dotted paths with values as text, or a list of `KEY=VALUE` |
/// | `limits` | `work`: steps times unknowns, points times unknowns or speeds times unknowns; `memory`: bytes |
///
/// and the options of what is asked, under the names that the program has for them.
#[derive(Clone, Debug)]
pub struct Request {
    /// What is asked.
    pub what: String,
    /// Steps times unknowns after which it is given up.
    pub work: f64,
    /// Bytes after which it is given up.
    pub memory: f64,
    case: String,
    name: String,
    files: Contents,
    set: Vec<(String, String)>,
    options: Map<String, Value>,
}

impl Request {
    /// Takes up a request.
    ///
    /// # Errors
    /// What in it is of another type.
    pub fn of(value: Value) -> Result<Request, String> {
        let Value::Object(options) = value else { return Err("the request is no object".to_owned()) };
        let texts = |key: &str| -> Result<Vec<(String, String)>, String> {
            let table = match options.get(key) {
                None | Some(Value::Null) => return Ok(Vec::new()),
                Some(Value::Object(table)) => table,
                Some(_) => return Err(format!("`{key}` is no object")),
            };
            let text = |(name, value): (&String, &Value)| match value {
                Value::String(text) => Ok((name.clone(), text.clone())),
                _ => Err(format!("`{key}.{name}` is no text")),
            };
            table.iter().map(text).collect()
        };
        let decoded = |(name, text): (String, String)| {
            let bytes =
                STANDARD.decode(text).map_err(|error| format!("`files.{name}` is no base64: {error}"))?;
            Ok((name, bytes.into()))
        };
        let files = texts("files")?.into_iter().map(decoded).collect::<Result<_, String>>()?;
        let set = match options.get("set") {
            Some(Value::Array(list)) => {
                let pair = |value: &Value| {
                    let pair = value.as_str().and_then(|text| text.split_once('='));
                    pair.map(|(key, value)| (key.to_owned(), value.to_owned()))
                        .ok_or("`set` is a list of KEY=VALUE")
                };
                list.iter().map(pair).collect::<Result<_, _>>()?
            }
            _ => texts("set")?,
        };
        let limit =
            |key: &str| options.get("limits").and_then(|limits| limits.get(key)).and_then(Value::as_f64);
        let (work, memory) = (limit("work").unwrap_or(f64::INFINITY), limit("memory").unwrap_or(MEMORY));
        let text = |key: &str| options.get(key).and_then(Value::as_str).map(str::to_owned);
        let what = text("do").ok_or("`do` does not say what is asked")?;
        let (case, name) = (text("case").unwrap_or_default(), text("name").unwrap_or("case.toml".to_owned()));
        Ok(Request { what, work, memory, case, name, files, set, options })
    }

    /// Reads the case, with its changes.
    ///
    /// # Errors
    /// All that is wrong with it.
    pub fn read(&self) -> Result<Reading, Problems> {
        let set: Vec<String> = self.set.iter().map(|(key, value)| format!("{key}={value}")).collect();
        parse_with(self.case.clone(), Path::new(&self.name), &set, &self.files)
    }

    /// Reads the case as it is written.
    ///
    /// # Errors
    /// All that is wrong with it.
    pub fn unchanged(&self) -> Result<Reading, Problems> {
        self.read_text(&self.case)
    }

    /// Reads another case, beside the same files.
    ///
    /// # Errors
    /// All that is wrong with it.
    pub fn read_text(&self, text: &str) -> Result<Reading, Problems> {
        parse_with(text.to_owned(), Path::new(&self.name), &[], &self.files)
    }

    /// The text of the case.
    pub fn case(&self) -> &str {
        &self.case
    }

    /// The changes of the case: dotted path and value as text.
    pub fn changes(&self) -> &[(String, String)] {
        &self.set
    }

    /// An option that is given.
    pub fn option(&self, name: &str) -> Option<&Value> {
        self.options.get(name).filter(|value| !value.is_null())
    }

    /// An option that is given and true; `default` where it is left out.
    pub fn is(&self, name: &str, default: bool) -> bool {
        self.option(name).and_then(Value::as_bool).unwrap_or(default)
    }
}
