//! What a blade is and which terms its model keeps.

/// Position and orientation of a blade on its hub.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Setting {
    /// Length L \[m\].
    pub length: f64,
    /// Distance a of the root from the axis of rotation, along the blade's axis \[m\].
    pub hub_radius: f64,
    /// Angle β of the blade's axis out of the plane of rotation, towards the angular velocity \[rad\].
    pub precone: f64,
    /// Angle of the root section, about the axis towards the tip, added to the twist of the sections \[rad\].
    pub pitch: f64,
    /// A body at the tip.
    pub tip: Tip,
}

/// A body at the tip, its centre of mass on the axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tip {
    /// Mass \[kg\].
    pub mass: f64,
    /// Moment of inertia about any axis through its centre, as of a sphere [kg·m²].
    pub inertia: f64,
}

/// A body on the blade, its centre of mass on the axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Body {
    /// Station \[m\], greater than zero and at most the length.
    pub station: f64,
    /// Mass and moment of inertia.
    pub of: Tip,
}

/// Which terms a blade's model keeps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Model {
    /// The strain energy and the steady state that follows from it.
    pub strain_energy: StrainEnergy,
    /// Gyroscopic (Coriolis) terms 2Ω: they couple axial, chordwise and flapwise motion.
    pub gyroscopic: bool,
    /// Inertia of sections that rotate with the slopes of the axis.
    pub rotary_inertia: bool,
    /// Torsion φ, with its inertia and the propeller moment.
    pub torsion: bool,
    /// The axial force's share in the torsional stiffness: twist lengthens fibres off the axis, on the mean by
    /// w = ½K² ((θ′ + τ)² − θ′²), K² = (EI_c + EI_f)/EA. The energy ½EA (ε + w)² stands in place of ½EA ε².
    pub tension_torsion: bool,
}

impl Default for Model {
    fn default() -> Model {
        Model {
            strain_energy: StrainEnergy::Exact,
            gyroscopic: true,
            rotary_inertia: true,
            torsion: true,
            tension_torsion: true,
        }
    }
}

/// The strain energy of a rotating blade.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StrainEnergy {
    /// Quadratic in axial strain and curvature, ½∫EA w₁′² + EI w₂″², with foreshortening in the kinetic energy: the
    /// first-order coupling. The blade is straight at any speed.
    Linear,
    /// As `Linear`, with terms of the Green strain that couple the steady axial strain and bending.
    Coupled(Terms),
    /// Geometrically exact, ½∫EA (|r′|−1)² + EI κ² + GJ τ², about its own steady state.
    Exact,
}

impl StrainEnergy {
    /// The terms about the straight blade; `None` for the exact energy.
    pub(super) fn terms(self) -> Option<Terms> {
        match self {
            StrainEnergy::Linear => Some(Terms::NONE),
            StrainEnergy::Coupled(terms) => Some(terms),
            StrainEnergy::Exact => None,
        }
    }
}

/// Terms of the Green strain, w₁′ being the steady axial strain: Zhao & Wu 2015, doi:10.6052/0459-1879-14-207.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Terms {
    /// ½∫EI · 3w₁′ w₂″²
    pub bending_first: bool,
    /// ½∫EI · (3/2) w₁′² w₂″²
    pub bending_second: bool,
    /// −½∫EA w₁′² w₂′²
    pub axial_first: bool,
    /// −½∫EA ½w₁′³ w₂′²
    pub axial_second: bool,
    /// The centrifugal force of the stretched blade, x → x + w₁.
    pub stretched_inertia: bool,
}

impl Terms {
    /// All terms.
    pub const ALL: Terms = Terms {
        bending_first: true,
        bending_second: true,
        axial_first: true,
        axial_second: true,
        stretched_inertia: true,
    };

    /// None of them: what `Linear` is.
    pub const NONE: Terms = Terms {
        bending_first: false,
        bending_second: false,
        axial_first: false,
        axial_second: false,
        stretched_inertia: false,
    };
}

/// Why there is no blade, or no steady state of it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BladeError {
    /// The quantities make no blade.
    #[error("{0}")]
    Invalid(String),
    /// No steady state was found.
    #[error(
        "no steady state at {speed} rad/s: the iterations end at {reached:.6} rad/s; the blade is too soft to be held \
         at this speed, or its precone bends it too far. Check stiffness, mass and speed and their units"
    )]
    NoSteadyState {
        /// Requested speed [rad/s].
        speed: f64,
        /// Largest speed at which a steady state was found [rad/s].
        reached: f64,
    },
}
