//! The section of a case: kinds and their keys.

use super::declaration::{
    Bound::*,
    Key, Kind, Presence as Default,
    Presence::Required,
    Seam, Type,
    Type::{Boolean, Quantity},
    key,
};
use super::problem::{Problem, Problems};
use super::units::*;
use super::values::{Values, join};

/// The cross-section of the beam, in SI.
#[derive(Clone, Debug, PartialEq)]
pub enum Section {
    /// One material and one shape over the whole length.
    Uniform {
        /// Young's modulus E [Pa].
        modulus: f64,
        /// Density ρ [kg/m³].
        density: f64,
        /// The shape.
        shape: Shape,
        /// Whether ρI of the section is kept.
        rotary_inertia: bool,
    },
    /// The resultants themselves.
    Resultants {
        /// ρA [kg/m].
        mass: f64,
        /// EA [N].
        axial_stiffness: f64,
        /// EI [N·m²].
        bending_stiffness: f64,
        /// ρI [kg·m].
        rotary_inertia: f64,
    },
    /// A rectangle graded over its height from metal to ceramic.
    Graded {
        /// E of the ceramic [Pa].
        ceramic_modulus: f64,
        /// E of the metal [Pa].
        metal_modulus: f64,
        /// ρ of the ceramic [kg/m³].
        ceramic_density: f64,
        /// ρ of the metal [kg/m³].
        metal_density: f64,
        /// Width b [m].
        width: f64,
        /// Height h, in the plane of motion [m].
        height: f64,
        /// Exponent N of the power law.
        exponent: f64,
        /// Whether ρS is kept.
        first_moment: bool,
        /// Whether ρI is kept.
        rotary_inertia: bool,
    },
}

impl Section {
    /// Height in the plane of motion \[m\]; `None` when only resultants are known.
    pub fn height(&self) -> Option<f64> {
        match *self {
            Section::Uniform { shape: Shape::Rectangle { height, .. }, .. }
            | Section::Graded { height, .. } => Some(height),
            Section::Uniform { shape: Shape::Circle { radius }, .. } => Some(2.0 * radius),
            Section::Uniform { shape: Shape::Tube { outer_radius, .. }, .. } => Some(2.0 * outer_radius),
            Section::Uniform { shape: Shape::General { .. }, .. } | Section::Resultants { .. } => None,
        }
    }
}

/// The shape of a uniform section, in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// Area A [m²] and second moment I [m⁴] given directly.
    General {
        /// A [m²].
        area: f64,
        /// I [m⁴].
        second_moment: f64,
    },
    /// A rectangle.
    Rectangle {
        /// Width, normal to the plane of motion [m].
        width: f64,
        /// Height, in the plane of motion [m].
        height: f64,
    },
    /// A full circle.
    Circle {
        /// Radius [m].
        radius: f64,
    },
    /// A circular tube.
    Tube {
        /// Outer radius [m].
        outer_radius: f64,
        /// Inner radius [m].
        inner_radius: f64,
    },
}

const E: Key = key("modulus", Quantity(&MODULUS, Positive), Required, "Young's modulus E");
const RHO: Key = key("density", Quantity(&DENSITY, Positive), Required, "density ρ");
const ROTARY: Key =
    key("rotary-inertia", Boolean, Default::Boolean(false), "rotary inertia of the section, ρI, is kept");

/// The kinds of section.
pub(super) static SEAM: Seam = Seam {
    name: "section",
    path: "section",
    summary: "stiffness and mass of the cross-section",
    kinds: &[
        Kind {
            name: "uniform",
            summary: "one material; area and second moment given",
            source: "",
            keys: &[
                E,
                RHO,
                key("area", Quantity(&AREA, Positive), Required, "area A"),
                key(
                    "second-moment",
                    Quantity(&SECOND_MOMENT, Positive),
                    Required,
                    "second moment of area I for bending in the plane of motion",
                ),
                ROTARY,
            ],
        },
        Kind {
            name: "rectangle",
            summary: "one material; a rectangle",
            source: "",
            keys: &[
                E,
                RHO,
                key("width", Quantity(&LENGTH, Positive), Required, "width, normal to the plane of motion"),
                key("height", Quantity(&LENGTH, Positive), Required, "height, in the plane of motion"),
                ROTARY,
            ],
        },
        Kind {
            name: "circle",
            summary: "one material; a full circle",
            source: "",
            keys: &[E, RHO, key("radius", Quantity(&LENGTH, Positive), Required, "radius"), ROTARY],
        },
        Kind {
            name: "tube",
            summary: "one material; a circular tube",
            source: "",
            keys: &[
                E,
                RHO,
                key("outer-radius", Quantity(&LENGTH, Positive), Required, "outer radius"),
                key(
                    "inner-radius",
                    Quantity(&LENGTH, Positive),
                    Required,
                    "inner radius, less than the outer",
                ),
                ROTARY,
            ],
        },
        Kind {
            name: "resultants",
            summary: "mass and stiffnesses per length given directly",
            source: "",
            keys: &[
                key("mass-per-length", Quantity(&MASS_PER_LENGTH, Positive), Required, "mass per length ρA"),
                key("axial-stiffness", Quantity(&AXIAL_STIFFNESS, Positive), Required, "axial stiffness EA"),
                key(
                    "bending-stiffness",
                    Quantity(&BENDING_STIFFNESS, Positive),
                    Required,
                    "bending stiffness EI in the plane of motion",
                ),
                key(
                    "rotary-inertia",
                    Quantity(&ROTARY_INERTIA, NotNegative),
                    Default::Number(0.0),
                    "rotary inertia per length ρI",
                ),
            ],
        },
        Kind {
            name: "graded",
            summary: "a rectangle graded over its height by a power law, from metal (bottom) to ceramic (top)",
            source: "Reddy 2000, doi:10.1002/(SICI)1097-0207(20000110/30)47:1/3<663::AID-NME787>3.0.CO;2-8",
            keys: &[
                key(
                    "ceramic-modulus",
                    Quantity(&MODULUS, Positive),
                    Required,
                    "Young's modulus Eh of the ceramic",
                ),
                key(
                    "metal-modulus",
                    Quantity(&MODULUS, Positive),
                    Required,
                    "Young's modulus Et of the metal",
                ),
                key("ceramic-density", Quantity(&DENSITY, Positive), Required, "density ρh of the ceramic"),
                key("metal-density", Quantity(&DENSITY, Positive), Required, "density ρt of the metal"),
                key("width", Quantity(&LENGTH, Positive), Required, "width b, normal to the plane of motion"),
                key("height", Quantity(&LENGTH, Positive), Required, "height h, in the plane of motion"),
                key("exponent", Type::Number(NotNegative), Required, "exponent N of the power law"),
                key(
                    "first-moment",
                    Boolean,
                    Default::Boolean(false),
                    "first mass moment of the section, ρS, is kept",
                ),
                ROTARY,
            ],
        },
    ],
};

/// Reads the section and checks it across its keys.
pub(super) fn read(kind: &Kind, v: &Values, path: &str, problems: &mut Problems) -> Option<Section> {
    let shape = match kind.name {
        "resultants" => {
            return Some(Section::Resultants {
                mass: v.number("mass-per-length")?,
                axial_stiffness: v.number("axial-stiffness")?,
                bending_stiffness: v.number("bending-stiffness")?,
                rotary_inertia: v.number("rotary-inertia")?,
            });
        }
        "graded" => {
            if v.boolean("first-moment") == Some(true) && v.boolean("rotary-inertia") == Some(false) {
                let message = "the first mass moment cannot be kept without the rotary inertia: the kinetic energy of short waves would be negative";
                problems.push(
                    Problem::new(join(path, "first-moment"), v.place("first-moment"), message)
                        .help("add `rotary-inertia = true`"),
                );
            }
            return Some(Section::Graded {
                ceramic_modulus: v.number("ceramic-modulus")?,
                metal_modulus: v.number("metal-modulus")?,
                ceramic_density: v.number("ceramic-density")?,
                metal_density: v.number("metal-density")?,
                width: v.number("width")?,
                height: v.number("height")?,
                exponent: v.number("exponent")?,
                first_moment: v.boolean("first-moment")?,
                rotary_inertia: v.boolean("rotary-inertia")?,
            });
        }
        "rectangle" => Shape::Rectangle { width: v.number("width")?, height: v.number("height")? },
        "circle" => Shape::Circle { radius: v.number("radius")? },
        "tube" => {
            let (outer_radius, inner_radius) = (v.number("outer-radius")?, v.number("inner-radius")?);
            if inner_radius >= outer_radius {
                let message =
                    format!("must be less than the outer radius {outer_radius} m, but is {inner_radius} m");
                problems.push(Problem::new(join(path, "inner-radius"), v.place("inner-radius"), message));
                return None;
            }
            Shape::Tube { outer_radius, inner_radius }
        }
        _ => Shape::General { area: v.number("area")?, second_moment: v.number("second-moment")? },
    };
    Some(Section::Uniform {
        modulus: v.number("modulus")?,
        density: v.number("density")?,
        shape,
        rotary_inertia: v.boolean("rotary-inertia")?,
    })
}
