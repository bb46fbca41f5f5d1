//! Estimated errors of the columns of a run.

/// Estimated error of one column, in its unit.
#[derive(Clone, Debug, PartialEq)]
pub struct ColumnError {
    /// Name of the column.
    pub column: String,
    /// Error of mesh and time integration.
    pub discretization: f64,
    /// Difference to the exact coupling, where there is one.
    pub model: Option<f64>,
}

/// Estimated errors of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Errors {
    /// One entry for each column but those about the integrator.
    pub columns: Vec<ColumnError>,
    /// What could not be estimated, and why.
    pub warnings: Vec<String>,
}
