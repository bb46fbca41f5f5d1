//! Cross-sections: each a file; all give [`Resultants`] along the beam.

/// Stiffness and inertia resultants of a planar section at a station. y is the height over the
/// reference axis, in the plane of motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Resultants {
    /// Mass per length ρA = ∫ρ dA [kg/m].
    pub mass: f64,
    /// First mass moment ρS = ∫ρ y dA [kg]; 0 where it is left out.
    pub first_moment: f64,
    /// Rotary inertia ρI = ∫ρ y² dA [kg·m]; 0 where it is left out.
    pub rotary_inertia: f64,
    /// Axial stiffness EA = ∫E dA [N].
    pub axial_stiffness: f64,
    /// Coupling stiffness ES = ∫E y dA [N·m].
    pub coupling_stiffness: f64,
    /// Bending stiffness EI = ∫E y² dA [N·m²].
    pub bending_stiffness: f64,
}

/// A cross-section along the beam.
pub trait Section: Send + Sync + std::fmt::Debug {
    /// Resultants at station `x` [m].
    fn resultants(&self, x: f64) -> Resultants;

    /// Stations inside (0, L) at which the resultants jump or kink: cells end there.
    fn breaks(&self) -> &[f64] {
        &[]
    }

    /// Heights of the lower and upper fibre [m] where the section knows its shape.
    fn fibres(&self, _x: f64) -> Option<(f64, f64)> {
        None
    }
}
