//! The section of a case: kinds and their keys.

use super::blade_file::BladeFormat;
use super::declaration::{
    Bound::*,
    Key, Kind, Presence as Default,
    Presence::Required,
    Seam, Type,
    Type::{Boolean, Quantities, Quantity},
    key,
};
use super::problem::{Problem, Problems};
use super::units::*;
use super::values::{Values, join};
use std::path::{Path, PathBuf};

/// The cross-section of the beam, in SI.
#[derive(Clone, Debug, PartialEq)]
pub enum Section {
    /// One material and one shape over the whole length.
    Uniform {
        /// Young's modulus E \[Pa\].
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
        /// EA \[N\].
        axial_stiffness: f64,
        /// EI [N·m²].
        bending_stiffness: f64,
        /// ρI [kg·m].
        rotary_inertia: f64,
    },
    /// A rectangle graded over its height from metal to ceramic.
    Graded {
        /// E of the ceramic \[Pa\].
        ceramic_modulus: f64,
        /// E of the metal \[Pa\].
        metal_modulus: f64,
        /// ρ of the ceramic [kg/m³].
        ceramic_density: f64,
        /// ρ of the metal [kg/m³].
        metal_density: f64,
        /// Width b \[m\].
        width: f64,
        /// Height h, in the plane of motion \[m\].
        height: f64,
        /// Exponent N of the power law.
        exponent: f64,
        /// Whether ρS is kept.
        first_moment: bool,
        /// Whether ρI is kept.
        rotary_inertia: bool,
    },
    /// One material; dimensions linear between root and tip.
    Tapered {
        /// Young's modulus E \[Pa\].
        modulus: f64,
        /// Density ρ [kg/m³].
        density: f64,
        /// The shape at the root.
        root: Shape,
        /// The shape at the tip, of the same kind.
        tip: Shape,
        /// Whether ρI of the section is kept.
        rotary_inertia: bool,
    },
    /// Uniform between jumps.
    Piecewise {
        /// Segments from the root.
        segments: Vec<Segment>,
        /// Whether ρI of the section is kept.
        rotary_inertia: bool,
    },
    /// Resultants in a file.
    Table {
        /// CSV file with named columns.
        file: PathBuf,
        /// Between the rows.
        interpolation: Interpolation,
    },
    /// Properties of a blade in a file.
    Blade {
        /// The file.
        file: PathBuf,
        /// Its format.
        format: BladeFormat,
    },
}

impl Section {
    /// Height in the plane of motion \[m\], at the root if it tapers; `None` when only resultants are known.
    pub fn height(&self) -> Option<f64> {
        let shape = match *self {
            Section::Graded { height, .. } => return Some(height),
            Section::Uniform { shape, .. } | Section::Tapered { root: shape, .. } => shape,
            Section::Resultants { .. }
            | Section::Piecewise { .. }
            | Section::Table { .. }
            | Section::Blade { .. } => return None,
        };
        match shape {
            Shape::Rectangle { height, .. } => Some(height),
            Shape::Circle { radius } => Some(2.0 * radius),
            Shape::Tube { outer_radius, .. } => Some(2.0 * outer_radius),
            Shape::General { .. } => None,
        }
    }
}

/// A part of a beam that is uniform, in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Station at which it ends \[m\].
    pub end: f64,
    /// Young's modulus E \[Pa\].
    pub modulus: f64,
    /// Density ρ [kg/m³].
    pub density: f64,
    /// A \[m²\].
    pub area: f64,
    /// I \[m⁴\].
    pub second_moment: f64,
}

/// How values between the rows of a table are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// Straight lines.
    Linear,
    /// Monotone cubics.
    Cubic,
}

/// The shape of a section, in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// Area A \[m²\] and second moment I \[m⁴\] given directly.
    General {
        /// A \[m²\].
        area: f64,
        /// I \[m⁴\].
        second_moment: f64,
    },
    /// A rectangle.
    Rectangle {
        /// Width, normal to the plane of motion \[m\].
        width: f64,
        /// Height, in the plane of motion \[m\].
        height: f64,
    },
    /// A full circle.
    Circle {
        /// Radius \[m\].
        radius: f64,
    },
    /// A circular tube.
    Tube {
        /// Outer radius \[m\].
        outer_radius: f64,
        /// Inner radius \[m\].
        inner_radius: f64,
    },
}

const E: Key = key("modulus", Quantity(&MODULUS, Positive), Required, "Young's modulus E");
const RHO: Key = key("density", Quantity(&DENSITY, Positive), Required, "density ρ");
const ROTARY: Key =
    key("rotary-inertia", Boolean, Default::Boolean(false), "rotary inertia of the section, ρI, is kept");

const fn dimension(name: &'static str, doc: &'static str) -> Key {
    key(name, Quantity(&LENGTH, Positive), Required, doc)
}

pub(super) static INTERPOLATION: Seam = Seam {
    name: "interpolation",
    path: "section.interpolation",
    summary: "values between the rows of a table",
    kinds: &[
        Kind { name: "linear", summary: "straight lines", source: "", keys: &[] },
        Kind {
            name: "cubic",
            summary: "monotone cubics, with continuous slopes",
            source: "Fritsch & Butland 1984, doi:10.1137/0905021",
            keys: &[],
        },
    ],
};

pub(super) static FORMAT: Seam = Seam {
    name: "format",
    path: "section.format",
    summary: "format of a blade's file",
    kinds: &[
        Kind {
            name: "csv",
            summary: "SI, first line x, mass, EA, EI-flap, EI-chord and, if wanted, GJ, inertia-flap, inertia-chord, twist",
            source: "",
            keys: &[],
        },
        Kind {
            name: "elastodyn",
            summary: "blade input file of ElastoDyn; without axial stiffness, one of slenderness 100 is taken",
            source: "OpenFAST",
            keys: &[],
        },
        Kind {
            name: "beamdyn",
            summary: "blade input file of BeamDyn; offsets of the mass centre are left out",
            source: "OpenFAST",
            keys: &[],
        },
    ],
};

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
        Kind {
            name: "tapered-rectangle",
            summary: "one material; a rectangle whose width and height change linearly from root to tip",
            source: "",
            keys: &[
                E,
                RHO,
                dimension("root-width", "width at the root, normal to the plane of motion"),
                dimension("tip-width", "width at the tip"),
                dimension("root-height", "height at the root, in the plane of motion"),
                dimension("tip-height", "height at the tip"),
                ROTARY,
            ],
        },
        Kind {
            name: "tapered-circle",
            summary: "one material; a full circle whose radius changes linearly from root to tip",
            source: "",
            keys: &[
                E,
                RHO,
                dimension("root-radius", "radius at the root"),
                dimension("tip-radius", "radius at the tip"),
                ROTARY,
            ],
        },
        Kind {
            name: "tapered-tube",
            summary: "one material; a circular tube whose radii change linearly from root to tip",
            source: "",
            keys: &[
                E,
                RHO,
                dimension("root-outer-radius", "outer radius at the root"),
                dimension("root-inner-radius", "inner radius at the root, less than the outer"),
                dimension("tip-outer-radius", "outer radius at the tip"),
                dimension("tip-inner-radius", "inner radius at the tip, less than the outer"),
                ROTARY,
            ],
        },
        Kind {
            name: "piecewise",
            summary: "uniform segments from the root to the tip: one entry a segment in every list",
            source: "",
            keys: &[
                key("ends", Quantities(&LENGTH, Positive), Required, "stations at which the segments end"),
                key("modulus", Quantities(&MODULUS, Positive), Required, "Young's moduli E"),
                key("density", Quantities(&DENSITY, Positive), Required, "densities ρ"),
                key("area", Quantities(&AREA, Positive), Required, "areas A"),
                key(
                    "second-moment",
                    Quantities(&SECOND_MOMENT, Positive),
                    Required,
                    "second moments of area I for bending in the plane of motion",
                ),
                ROTARY,
            ],
        },
        Kind {
            name: "table",
            summary: "mass and stiffnesses tabulated along the beam",
            source: "",
            keys: &[
                key(
                    "file",
                    Type::Path,
                    Required,
                    "CSV file in SI whose first line names the columns x, mass, EA, EI and, if wanted, ES, first-moment, rotary-inertia",
                ),
                key(
                    "interpolation",
                    Type::Choice(&INTERPOLATION),
                    Default::Name("linear"),
                    "values between the rows",
                ),
            ],
        },
        Kind {
            name: "blade",
            summary: "properties of a blade for bending in two planes and torsion, tabulated along its span",
            source: "",
            keys: &[
                key("file", Type::Path, Required, "file of the properties"),
                key("format", Type::Choice(&FORMAT), Default::Name("csv"), "format of the file"),
            ],
        },
    ],
};

/// Reads the section and checks it across its keys.
pub(super) fn read(
    kind: &Kind,
    v: &Values,
    path: &str,
    folder: &Path,
    problems: &mut Problems,
) -> Option<Section> {
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
        "tapered-rectangle" | "tapered-circle" | "tapered-tube" => {
            return Some(Section::Tapered {
                modulus: v.number("modulus")?,
                density: v.number("density")?,
                root: tapered(kind, v, "root")?,
                tip: tapered(kind, v, "tip")?,
                rotary_inertia: v.boolean("rotary-inertia")?,
            });
        }
        "piecewise" => return piecewise(v, path, problems),
        "table" => {
            let interpolation = match v.text("interpolation")? {
                "cubic" => Interpolation::Cubic,
                _ => Interpolation::Linear,
            };
            return Some(Section::Table { file: folder.join(v.text("file")?), interpolation });
        }
        "blade" => {
            let format = match v.text("format")? {
                "elastodyn" => BladeFormat::ElastoDyn,
                "beamdyn" => BladeFormat::BeamDyn,
                _ => BladeFormat::Csv,
            };
            return Some(Section::Blade { file: folder.join(v.text("file")?), format });
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

/// The shape of a tapered section at its `end`: `root` or `tip`.
fn tapered(kind: &Kind, v: &Values, end: &str) -> Option<Shape> {
    let at = |name: &str| v.number(&format!("{end}-{name}"));
    Some(match kind.name {
        "tapered-rectangle" => Shape::Rectangle { width: at("width")?, height: at("height")? },
        "tapered-circle" => Shape::Circle { radius: at("radius")? },
        _ => Shape::Tube { outer_radius: at("outer-radius")?, inner_radius: at("inner-radius")? },
    })
}

/// Segments from lists of equal length.
fn piecewise(v: &Values, path: &str, problems: &mut Problems) -> Option<Section> {
    let ends = v.numbers("ends")?;
    let mut uneven = false;
    let mut list = |name: &str| {
        let list = v.numbers(name)?;
        if list.len() != ends.len() {
            let message = format!("has {} entries for the {} segments in `ends`", list.len(), ends.len());
            problems.push(Problem::new(join(path, name), v.place(name), message));
            uneven = true;
        }
        Some(list)
    };
    let (modulus, density) = (list("modulus"), list("density"));
    let (area, second_moment) = (list("area"), list("second-moment"));
    let (modulus, density, area, second_moment) = (modulus?, density?, area?, second_moment?);
    if uneven {
        return None;
    }
    let segment = |i: usize| Segment {
        end: ends[i],
        modulus: modulus[i],
        density: density[i],
        area: area[i],
        second_moment: second_moment[i],
    };
    let segments = (0..ends.len()).map(segment).collect();
    Some(Section::Piecewise { segments, rotary_inertia: v.boolean("rotary-inertia")? })
}
