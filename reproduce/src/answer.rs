//! What a run says, of all that is asked of it.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// What a run says.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// `finished`, `failed` or `rejected`.
    pub status: String,
    /// Why it did not finish.
    pub message: Option<String>,
    /// What its reader should know.
    pub warnings: Vec<String>,
    /// The case as it is written, in SI.
    pub stated: String,
    /// The units of what is asked of it, whether there is a value or not.
    pub units: BTreeMap<String, String>,
    /// When it ends by its case, and the interval of its records \[s\], where it is a run in time.
    pub times: Option<[f64; 2]>,
    /// What the errors are from.
    pub errors: String,
    /// Its quantities, or why there is none.
    pub values: BTreeMap<String, Result<Valued, String>>,
    /// Its columns over time.
    pub curves: BTreeMap<String, Result<Curve, String>>,
    /// Time of computing \[s\], companions included: it differs from run to run.
    pub seconds: f64,
}

/// A value with its error.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Valued {
    /// In `unit`.
    pub value: f64,
    /// Its error ±, where it is known.
    pub error: Option<f64>,
    /// Its unit; empty for a pure number.
    pub unit: String,
    /// Whether it differs from run to run.
    pub varies: bool,
}

/// A column over time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// Its unit; empty for a pure number.
    pub unit: String,
    /// Times \[s\].
    #[serde(with = "packed")]
    pub t: Vec<f64>,
    /// Values.
    #[serde(with = "packed")]
    pub y: Vec<f64>,
    /// Their errors ±, NaN where they are not known; empty where none are.
    #[serde(with = "packed")]
    pub off: Vec<f64>,
}

impl Answer {
    /// Whether its case was refused.
    pub fn refused(&self) -> bool {
        self.status == "rejected"
    }

    /// A case that cannot be computed.
    pub fn rejected(message: String) -> Answer {
        Answer { status: "rejected".to_owned(), message: Some(message), ..Answer::default() }
    }

    /// Whether the run reached its end.
    pub fn finished(&self) -> bool {
        self.status == "finished"
    }

    /// Whether a quantity is what a run did until its end, wherever that is.
    fn counts(&self, quantity: &str) -> bool {
        quantity.starts_with("work.") || quantity.starts_with("run.")
    }

    /// A quantity, or why there is none.
    ///
    /// # Errors
    /// Why there is none.
    pub fn value(&self, quantity: &str) -> Result<&Valued, String> {
        match self.values.get(quantity) {
            // Of a part of a run nothing follows for the whole.
            Some(Ok(_)) if !self.finished() && !quantity.contains(['@']) && !self.counts(quantity) => {
                let why = self.message.as_deref().unwrap_or("it was stopped");
                Err(format!("the run ended early, and {quantity} is of the whole: {why}"))
            }
            Some(Ok(value)) => Ok(value),
            Some(Err(why)) => Err(why.clone()),
            None => Err(self.message.clone().unwrap_or_else(|| format!("{quantity} was not computed"))),
        }
    }

    /// A column, or why there is none.
    ///
    /// # Errors
    /// Why there is none.
    pub fn curve(&self, column: &str) -> Result<&Curve, String> {
        match self.curves.get(column) {
            Some(Ok(curve)) => Ok(curve),
            Some(Err(why)) => Err(why.clone()),
            None => Err(self.message.clone().unwrap_or_else(|| format!("{column} was not computed"))),
        }
    }
}

/// Numbers as the base 64 of their bytes: none is rounded, NaN included.
mod packed {
    use base64::Engine as _;
    use base64::prelude::BASE64_STANDARD;
    use serde::{Deserialize, Deserializer, Serializer};

    pub fn serialize<S: Serializer>(values: &[f64], to: S) -> Result<S::Ok, S::Error> {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        to.serialize_str(&BASE64_STANDARD.encode(bytes))
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<f64>, D::Error> {
        let bytes = BASE64_STANDARD.decode(String::deserialize(from)?).map_err(serde::de::Error::custom)?;
        let eight = |part: &[u8]| <[u8; 8]>::try_from(part).map(f64::from_le_bytes);
        bytes.chunks(8).map(eight).collect::<Result<_, _>>().map_err(serde::de::Error::custom)
    }
}
