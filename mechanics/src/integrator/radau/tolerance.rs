//! The tolerance of local errors.

/// What local errors are measured against: absolute·scaleᵢ + relative·|qᵢ|.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Relative to the unknown.
    pub relative: f64,
    /// Relative to the scale of the unknown's label.
    pub absolute: f64,
}

impl Tolerance {
    /// The same relative to the unknown and to its scale.
    pub fn uniform(tolerance: f64) -> Tolerance {
        Tolerance { relative: tolerance, absolute: tolerance }
    }

    /// The larger of the two.
    pub fn size(&self) -> f64 {
        self.relative.max(self.absolute)
    }
}
