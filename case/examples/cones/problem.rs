//! A stored cone problem of contacts.

use flexion::contact::{Augmented, RowLaw};
use flexion::linalg::{Matrix, Structure};
use serde_json::Value;
use std::error::Error;

/// A problem as it is stored in `benches/cones/problems`.
pub struct Problem {
    /// A, in its first `order` unknowns.
    pub matrix: Matrix,
    pub order: usize,
    /// Entries of G that are not zero, row after row.
    pub rows: Vec<Vec<(usize, f64)>>,
    pub laws: Vec<RowLaw>,
    pub b: Vec<f64>,
    /// Λ₀.
    pub start: Vec<f64>,
}

impl Problem {
    /// From the text of a file.
    pub fn read(text: &str) -> Result<Problem, Box<dyn Error>> {
        let problem: Value = serde_json::from_str(text)?;
        let numbers = |name: &str| -> Result<Vec<f64>, serde_json::Error> {
            serde_json::from_value(problem[name].clone())
        };
        let order = problem["order"].as_u64().ok_or("no order")? as usize;
        let entries: Vec<(usize, usize, f64)> = serde_json::from_value(problem["matrix"].clone())?;
        let mut matrix = Matrix::new(&Structure::dense(order));
        entries.iter().for_each(|(i, j, x)| matrix.add(*i, *j, *x));
        let law = |law: &Value| match (law[0].as_str(), law[1].as_f64(), law[2].as_u64()) {
            (Some("unilateral"), ..) => Ok(RowLaw::Unilateral),
            (Some("friction"), Some(coefficient), Some(normal)) => {
                Ok(RowLaw::Friction { coefficient, normal: normal as usize })
            }
            _ => Err("a law is [\"unilateral\"] or [\"friction\", coefficient, normal row]"),
        };
        let laws = problem["laws"].as_array().ok_or("no laws")?;
        Ok(Problem {
            matrix,
            order,
            rows: serde_json::from_value(problem["rows"].clone())?,
            laws: laws.iter().map(law).collect::<Result<_, _>>()?,
            b: numbers("b")?,
            start: numbers("start")?,
        })
    }

    /// The motion y by `many`, with the factors of A, and Λ.
    pub fn solve(
        &self,
        many: &mut Augmented,
        factored: &mut Matrix,
    ) -> Result<[Vec<f64>; 2], Box<dyn Error>> {
        many.begin(&self.laws);
        self.rows.iter().for_each(|row| many.push(row.iter().copied()));
        let (mut multipliers, mut motion) = (self.start.clone(), vec![0.0; self.order]);
        many.solve(factored, &self.b, &mut multipliers, &mut motion)?;
        Ok([motion, multipliers])
    }
}
