//! The blade of a case: what turns its beam into one that also bends out of the plane and twists.

use super::declaration::{
    Bound::*, Key, Kind, Presence as Default, Presence::Optional, Seam, Type, Type::Quantity, key,
};
use super::units::{ANGLE, INERTIA, MASS};
use super::values::Values;
use flexion::blade::Terms;

/// The blade, in SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Blade {
    /// Angle of the root section \[rad\].
    pub pitch: f64,
    /// Angle out of the plane of rotation \[rad\].
    pub precone: f64,
    /// Angle of the tip section against the root \[rad\].
    pub twist: f64,
    /// Mass at the tip \[kg\].
    pub tip_mass: f64,
    /// Moment of inertia of the mass at the tip [kg·m²].
    pub tip_inertia: f64,
    /// The strain energy.
    pub strain_energy: StrainEnergy,
    /// Whether gyroscopic terms are kept.
    pub gyroscopic: bool,
    /// Whether the rotary inertia of sections is kept.
    pub rotary_inertia: bool,
    /// Whether there is torsion; `None` if the section decides.
    pub torsion: Option<bool>,
    /// Poisson's ratio, from which the torsional stiffness of a material follows.
    pub poisson_ratio: f64,
    /// Number of elements.
    pub elements: usize,
}

/// The strain energy of a blade.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StrainEnergy {
    /// Quadratic in stretch and curvature.
    Linear,
    /// With the coupling terms of the Green strain that are chosen.
    Coupled(Terms),
    /// Geometrically exact.
    Exact,
}

pub(super) static STRAIN_ENERGY: Seam = Seam {
    name: "strain-energy",
    path: "blade.strain-energy",
    summary: "strain energy of a blade",
    kinds: &[
        Kind {
            name: "linear",
            summary: "quadratic in stretch and curvature, with foreshortening: the blade stays straight",
            source: "",
            keys: &[],
        },
        Kind {
            name: "coupled",
            summary: "linear, with the terms of the Green strain that couple stretch and bending, for comparison only",
            source: "Zhao & Wu 2015, doi:10.6052/0459-1879-14-207",
            keys: &[],
        },
        Kind {
            name: "exact",
            summary: "geometrically exact, about its own steady state",
            source: "Meier, Popp & Wall 2014, doi:10.1016/j.cma.2014.05.017",
            keys: &[],
        },
    ],
};

/// Keys of the terms of the strain energy `coupled`, e being the steady stretch w₁′.
pub(super) static TERMS: [&str; 5] =
    ["bending-first", "bending-second", "axial-first", "axial-second", "stretched-inertia"];

/// The keys of `[blade]`.
pub(super) static KEYS: &[Key] = &[
    key(
        "pitch",
        Quantity(&ANGLE, Any),
        Default::Number(0.0),
        "angle of the root section about the axis towards the tip; at 0 its height lies in the plane of rotation",
    ),
    key(
        "precone",
        Quantity(&ANGLE, Between(-1.5, 1.5)),
        Default::Number(0.0),
        "angle of the axis out of the plane of rotation, towards the vector of rotation",
    ),
    key(
        "twist",
        Quantity(&ANGLE, Any),
        Default::Number(0.0),
        "angle of the tip section against the root, linear between, added to a twist in the section's file",
    ),
    key("tip-mass", Quantity(&MASS, NotNegative), Default::Number(0.0), "mass of a body at the tip"),
    key(
        "tip-inertia",
        Quantity(&INERTIA, NotNegative),
        Default::Number(0.0),
        "moment of inertia of the body at the tip, the same about every axis",
    ),
    key("strain-energy", Type::Choice(&STRAIN_ENERGY), Default::Name("exact"), "strain energy"),
    key(TERMS[0], Type::Boolean, Optional, "of `coupled`, the term 3e of EI w″²; kept if left out"),
    key(TERMS[1], Type::Boolean, Optional, "of `coupled`, the term (3/2)e² of EI w″²; kept if left out"),
    key(TERMS[2], Type::Boolean, Optional, "of `coupled`, the term −e² of EA w′²; kept if left out"),
    key(TERMS[3], Type::Boolean, Optional, "of `coupled`, the term −½e³ of EA w′²; kept if left out"),
    key(
        TERMS[4],
        Type::Boolean,
        Optional,
        "of `coupled`, the centrifugal force of the stretched blade; kept if left out",
    ),
    key("gyroscopic", Type::Boolean, Default::Boolean(true), "gyroscopic (Coriolis) terms are kept"),
    key(
        "rotary-inertia",
        Type::Boolean,
        Default::Boolean(true),
        "rotary inertia of sections is kept where it is known",
    ),
    key("torsion", Type::Boolean, Optional, "torsion is kept; if left out, where the section says enough"),
    key(
        "poisson-ratio",
        Type::Number(Between(-0.99, 0.5)),
        Default::Number(0.3),
        "Poisson's ratio, for the torsional stiffness of a section of one material",
    ),
    key("elements", Type::Integer(1, 100_000), Default::Integer(40), "number of equal elements"),
];

/// Reads the blade.
pub(super) fn read(v: &Values) -> Option<Blade> {
    let kept = |term: usize| v.boolean(TERMS[term]).unwrap_or(true);
    Some(Blade {
        pitch: v.number("pitch")?,
        precone: v.number("precone")?,
        twist: v.number("twist")?,
        tip_mass: v.number("tip-mass")?,
        tip_inertia: v.number("tip-inertia")?,
        strain_energy: match v.text("strain-energy")? {
            "linear" => StrainEnergy::Linear,
            "coupled" => StrainEnergy::Coupled(Terms {
                bending_first: kept(0),
                bending_second: kept(1),
                axial_first: kept(2),
                axial_second: kept(3),
                stretched_inertia: kept(4),
            }),
            _ => StrainEnergy::Exact,
        },
        gyroscopic: v.boolean("gyroscopic")?,
        rotary_inertia: v.boolean("rotary-inertia")?,
        torsion: v.boolean("torsion"),
        poisson_ratio: v.number("poisson-ratio")?,
        elements: v.count("elements")?,
    })
}
