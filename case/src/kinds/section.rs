//! The section of a case: kinds, keys and makers.

use super::shape::{self, Read};
use crate::declaration::{
    Bound::*,
    Key, Presence as Default,
    Presence::Required,
    Type,
    Type::{Boolean, Quantities, Quantity},
    key,
};
use crate::fault::{At, Fault, Faults, Made};
use crate::files;
use crate::kind::{Choice, Context, Kind};
use crate::units::*;
use crate::values::Values;
use flexion::section::{
    self, BladeSection, Graded, HomogeneousBlade, Inertia, Material, Piecewise, PlanarBlade, Resultants,
    SectionError, Segment, Shape, Tapered, Uniform,
};
use std::fmt;
use std::sync::Arc;

/// Makes the section of a blade: of the share that a material's Poisson's ratio has in it.
type Spatial = Arc<dyn Fn(f64) -> Result<Box<dyn BladeSection>, SectionError> + Send + Sync>;

/// The cross-section of a beam.
#[derive(Clone)]
pub struct Section {
    /// For bending in the plane of motion.
    pub planar: Arc<dyn section::Section>,
    /// Height in the plane of motion \[m\], at the root if it tapers; `None` when only resultants are known.
    pub height: Option<f64>,
    /// Shape at root and tip, linear between; `None` when only resultants are known.
    pub shapes: Option<[Shape; 2]>,
    /// Whether it is known out of the plane, too.
    pub is_blade: bool,
    spatial: Spatial,
}

impl fmt::Debug for Section {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.planar.fmt(f)
    }
}

impl Section {
    /// A section known by its resultants in the plane: as that of a blade it is as stiff out of it.
    fn planar(section: impl section::Section + 'static) -> Section {
        let planar: Arc<dyn section::Section> = Arc::new(section);
        let blade = Arc::clone(&planar);
        let spatial: Spatial = Arc::new(move |_| Ok(Box::new(PlanarBlade(Box::new(Arc::clone(&blade))))));
        Section { planar, height: None, shapes: None, is_blade: false, spatial }
    }

    /// The section of a blade, of a material with this Poisson's ratio.
    ///
    /// # Errors
    /// [`SectionError`] when the section makes no blade.
    pub fn blade(&self, poisson_ratio: f64) -> Result<Box<dyn BladeSection>, SectionError> {
        (self.spatial)(poisson_ratio)
    }
}

const E: Key = key("modulus", Quantity(&MODULUS, Positive), Required, "Young's modulus E");
const RHO: Key = key("density", Quantity(&DENSITY, Positive), Required, "density ρ");
const ROTARY: Key =
    key("rotary-inertia", Boolean, Default::Boolean(false), "rotary inertia of the section, ρI, is kept");

const fn dimension(name: &'static str, doc: &'static str) -> Key {
    key(name, Quantity(&LENGTH, Positive), Required, doc)
}

fn kept(v: &Values) -> Made<Inertia> {
    Ok(if v.boolean("rotary-inertia")? { Inertia::Rotary } else { Inertia::Translation })
}

/// One material and one shape all along the beam.
fn homogeneous(v: &Values, c: &Context<'_>, shape: Read) -> Made<Section> {
    let (modulus, density, shape) = (v.number("modulus")?, v.number("density")?, shape(v, "")?);
    let planar = Uniform::from_material(modulus, density, shape).at("")?.with_inertia(kept(v)?);
    Ok(Section {
        height: height(shape),
        shapes: Some([shape; 2]),
        spatial: blade_of_shapes(v, c, shape, shape)?,
        ..Section::planar(planar)
    })
}

/// One material, and a shape whose dimensions change linearly from root to tip.
fn tapered(v: &Values, c: &Context<'_>, shape: Read) -> Made<Section> {
    let (root, tip) = (shape(v, "root-")?, shape(v, "tip-")?);
    let planar = Tapered::new(v.number("modulus")?, v.number("density")?, c.length()?, root, tip).at("")?;
    Ok(Section {
        height: height(root),
        shapes: Some([root, tip]),
        spatial: blade_of_shapes(v, c, root, tip)?,
        ..Section::planar(planar.with_inertia(kept(v)?))
    })
}

fn height(shape: Shape) -> Option<f64> {
    let (lower, upper) = shape.fibres();
    Some(upper - lower)
}

/// The blade whose shape changes from `root` to `tip`: it is stiff out of the plane as its shape says.
fn blade_of_shapes(v: &Values, c: &Context<'_>, root: Shape, tip: Shape) -> Made<Spatial> {
    let (modulus, density, length) = (v.number("modulus")?, v.number("density")?, c.length()?);
    Ok(Arc::new(move |poisson_ratio| {
        let along = Tapered::new(modulus, density, length, root, tip)?;
        Ok(Box::new(HomogeneousBlade::new(modulus, density, poisson_ratio, move |x| along.shape(x))?))
    }))
}

/// A homogeneous section of given area and second moment, with all inertia.
fn general(modulus: f64, density: f64, area: f64, second_moment: f64) -> Result<Uniform, SectionError> {
    Uniform::from_resultants(Resultants {
        mass: density * area,
        rotary_inertia: density * second_moment,
        axial_stiffness: modulus * area,
        bending_stiffness: modulus * second_moment,
        ..Resultants::default()
    })
}

/// How values between the rows of a table are found.
pub static INTERPOLATION: Choice<section::Interpolation> = Choice {
    name: "interpolation",
    path: "section.interpolation",
    summary: "values between the rows of a table",
    kinds: &[
        Kind {
            name: "linear",
            summary: "straight lines",
            source: "",
            keys: &[],
            example: r#"section={kind="table", file="section.csv", interpolation="linear"}"#,
            make: |_, _| Ok(section::Interpolation::Linear),
        },
        Kind {
            name: "cubic",
            summary: "monotone cubics, with continuous slopes",
            source: "Fritsch & Butland 1984, doi:10.1137/0905021",
            keys: &[],
            example: r#"section={kind="table", file="section.csv", interpolation="cubic"}"#,
            make: |_, _| Ok(section::Interpolation::Cubic),
        },
    ],
};

/// Formats of blade files.
pub static FORMAT: Choice<files::blade::Format> = Choice {
    name: "format",
    path: "section.format",
    summary: "format of a blade's file",
    kinds: &[
        Kind {
            name: "csv",
            summary: "SI, first line x, mass, EA, EI-flap, EI-chord and, if wanted, GJ, inertia-flap, inertia-chord, twist",
            source: "",
            keys: &[],
            example: r#"section={kind="blade", file="blade.csv", format="csv"}"#,
            make: |_, _| Ok(files::blade::csv),
        },
        Kind {
            name: "elastodyn",
            summary: "blade input file of ElastoDyn; without axial stiffness, one of slenderness 100 is taken",
            source: "OpenFAST",
            keys: &[],
            example: r#"section={kind="blade", file="elastodyn.dat", format="elastodyn"}"#,
            make: |_, _| Ok(files::blade::elastodyn),
        },
        Kind {
            name: "beamdyn",
            summary: "blade input file of BeamDyn; offsets of the mass centre are left out",
            source: "OpenFAST",
            keys: &[],
            example: r#"section={kind="blade", file="beamdyn.dat", format="beamdyn"}"#,
            make: |_, _| Ok(files::blade::beamdyn),
        },
    ],
};

/// The kinds of section.
pub static SECTION: Choice<Section> = Choice {
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
            example: r#"section={kind="uniform", modulus="7 GPa", density=2700, area="4 cm^2", second-moment="2e-8 m^4", rotary-inertia=true}"#,
            make: uniform,
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
            example: r#"section={kind="rectangle", modulus="70 GPa", density="2.7 g/cm^3", width="1 in", height="2 cm"}"#,
            make: |v, c| homogeneous(v, c, shape::rectangle),
        },
        Kind {
            name: "circle",
            summary: "one material; a full circle",
            source: "",
            keys: &[E, RHO, key("radius", Quantity(&LENGTH, Positive), Required, "radius"), ROTARY],
            example: r#"section={kind="circle", modulus="70 GPa", density=2700, radius="1 cm"}"#,
            make: |v, c| homogeneous(v, c, shape::circle),
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
            example: r#"section={kind="tube", modulus="70 GPa", density=2700, outer-radius="2 cm", inner-radius="1 cm"}"#,
            make: |v, c| homogeneous(v, c, shape::tube),
        },
        Kind {
            name: "ellipse",
            summary: "one material; a full ellipse",
            source: "",
            keys: &[
                E,
                RHO,
                dimension("semi-width", "semi-axis a, normal to the plane of motion"),
                dimension("semi-height", "semi-axis b, in the plane of motion"),
                ROTARY,
            ],
            example: r#"section={kind="ellipse", modulus="70 GPa", density=2700, semi-width="2 cm", semi-height="1 cm"}"#,
            make: |v, c| {
                homogeneous(v, c, |v, _| {
                    let (semi_width, semi_height) = (v.number("semi-width")?, v.number("semi-height")?);
                    Ok(Shape::Ellipse { semi_width, semi_height })
                })
            },
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
            example: r#"section={kind="resultants", mass-per-length="1.2 kg/m", axial-stiffness="28 MN", bending-stiffness="930 N m²", rotary-inertia=6e-4}"#,
            make: resultants,
        },
        Kind {
            name: "general",
            summary: "mass and stiffnesses per length for bending in two planes and torsion",
            source: "",
            keys: &[
                key("mass-per-length", Quantity(&MASS_PER_LENGTH, Positive), Required, "mass per length ρA"),
                key("axial-stiffness", Quantity(&AXIAL_STIFFNESS, Positive), Required, "axial stiffness EA"),
                key(
                    "torsional-stiffness",
                    Quantity(&BENDING_STIFFNESS, Positive),
                    Required,
                    "torsional stiffness GJ",
                ),
                key(
                    "bending-stiffness",
                    Quantity(&BENDING_STIFFNESS, Positive),
                    Required,
                    "bending stiffness EI in the direction of the height",
                ),
                key(
                    "bending-stiffness-across",
                    Quantity(&BENDING_STIFFNESS, Positive),
                    Required,
                    "bending stiffness EI in the direction across",
                ),
                key(
                    "rotary-inertia",
                    Quantity(&ROTARY_INERTIA, NotNegative),
                    Default::Number(0.0),
                    "rotary inertia per length in bending in the direction of the height",
                ),
                key(
                    "rotary-inertia-across",
                    Quantity(&ROTARY_INERTIA, NotNegative),
                    Default::Number(0.0),
                    "rotary inertia per length in bending in the direction across",
                ),
            ],
            example: r#"section={kind="general", mass-per-length="1.2 kg/m", axial-stiffness="28 MN", torsional-stiffness="700 N m²", bending-stiffness="930 N m²", bending-stiffness-across="800 N m²", rotary-inertia=1e-4}"#,
            make: general_section,
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
            example: r#"section={kind="graded", ceramic-modulus="151 GPa", metal-modulus="70 GPa", ceramic-density=3000, metal-density=2707, width="2 cm", height="2 cm", exponent=1.5}"#,
            make: graded,
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
            example: r#"section={kind="tapered-rectangle", modulus="70 GPa", density=2700, root-width="2 cm", tip-width="1 cm", root-height="3 cm", tip-height="1 cm"}"#,
            make: |v, c| tapered(v, c, shape::rectangle),
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
            example: r#"section={kind="tapered-circle", modulus="70 GPa", density=2700, root-radius="2 cm", tip-radius="1 cm", rotary-inertia=true}"#,
            make: |v, c| tapered(v, c, shape::circle),
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
            example: r#"section={kind="tapered-tube", modulus="70 GPa", density=2700, root-outer-radius="2 cm", root-inner-radius="1 cm", tip-outer-radius="15 mm", tip-inner-radius="1 cm"}"#,
            make: |v, c| tapered(v, c, shape::tube),
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
            example: r#"section={kind="piecewise", ends=["1 m", 2], modulus=["70 GPa", "60 GPa"], density=[2700, 2600], area=["4 cm^2", "3 cm^2"], second-moment=["2e-8 m^4", "1e-8 m^4"]}"#,
            make: piecewise,
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
                    "CSV file whose first line names the columns x, mass, EA, EI and, if wanted, ES, first-moment, rotary-inertia, in SI or as `x [mm]`",
                ),
                key(
                    "interpolation",
                    Type::Choice(&INTERPOLATION),
                    Default::Name("linear"),
                    "values between the rows",
                ),
            ],
            example: r#"section={kind="table", file="section.csv"}"#,
            make: table,
        },
        Kind {
            name: "blade",
            summary: "properties of a blade for bending in two planes and torsion, tabulated along its span",
            source: "",
            keys: &[
                key("file", Type::Path, Required, "file of the properties"),
                key("format", Type::Choice(&FORMAT), Default::Name("csv"), "format of the file"),
                key(
                    "ignore-coupling",
                    Boolean,
                    Default::Boolean(false),
                    "what couples stretch, bending and torsion in the file is left out: each stiffness is that at zero force of the others",
                ),
            ],
            example: r#"section={kind="blade", file="blade.csv", ignore-coupling=true}"#,
            make: blade,
        },
    ],
};

fn uniform(v: &Values, _: &Context<'_>) -> Made<Section> {
    let (area, second_moment) = (v.number("area")?, v.number("second-moment")?);
    let section = general(v.number("modulus")?, v.number("density")?, area, second_moment).at("")?;
    Ok(Section::planar(section.with_inertia(kept(v)?)))
}

fn resultants(v: &Values, _: &Context<'_>) -> Made<Section> {
    let section = Uniform::from_resultants(Resultants {
        mass: v.number("mass-per-length")?,
        rotary_inertia: v.number("rotary-inertia")?,
        axial_stiffness: v.number("axial-stiffness")?,
        bending_stiffness: v.number("bending-stiffness")?,
        ..Resultants::default()
    });
    Ok(Section::planar(section.at("")?))
}

fn general_section(v: &Values, c: &Context<'_>) -> Made<Section> {
    let resultants = section::BladeResultants {
        mass: v.number("mass-per-length")?,
        axial_stiffness: v.number("axial-stiffness")?,
        torsional_stiffness: v.number("torsional-stiffness")?,
        chord_stiffness: v.number("bending-stiffness")?,
        flap_stiffness: v.number("bending-stiffness-across")?,
        chord_inertia: v.number("rotary-inertia")?,
        flap_inertia: v.number("rotary-inertia-across")?,
        twist: 0.0,
        twist_rate: 0.0,
    };
    let length = c.length()?;
    let table = section::BladeTable::new(length, &[(0.0, resultants), (length, resultants)]).at("")?;
    let spatial = Arc::new(move |_| Ok(Box::new(resultants) as Box<dyn BladeSection>));
    Ok(Section { spatial, ..Section::planar(section::PlanarProjection(table)) })
}

fn graded(v: &Values, _: &Context<'_>) -> Made<Section> {
    let inertia = match (v.boolean("first-moment")?, v.boolean("rotary-inertia")?) {
        (true, false) => {
            let message = "the first mass moment cannot be kept without the rotary inertia: the kinetic energy of short waves would be negative";
            return Err(Fault::new("first-moment", message).help("add `rotary-inertia = true`").into());
        }
        (true, true) => Inertia::Full,
        (false, _) => kept(v)?,
    };
    let ceramic = Material { modulus: v.number("ceramic-modulus")?, density: v.number("ceramic-density")? };
    let metal = Material { modulus: v.number("metal-modulus")?, density: v.number("metal-density")? };
    let (width, height) = (v.number("width")?, v.number("height")?);
    let section = Graded::new(ceramic, metal, v.number("exponent")?, width, height).at("")?;
    Ok(Section {
        height: Some(height),
        spatial: Arc::new(|_| {
            let message = "a `graded` section, which bends and stretches together, belongs to the planar hub and beam: beams in space and \
                           blades do without; take `general` with the stiffnesses about its tension centre";
            Err(SectionError::Invalid(message.to_owned()))
        }),
        ..Section::planar(section.with_inertia(inertia))
    })
}

/// Segments from lists of equal length.
fn piecewise(v: &Values, c: &Context<'_>) -> Made<Section> {
    let ends = v.numbers("ends")?;
    let names = ["modulus", "density", "area", "second-moment"];
    let mut faults = Faults::default();
    for name in names {
        let count = v.numbers(name)?.len();
        if count != ends.len() {
            let message = format!("has {count} entries for the {} segments in `ends`", ends.len());
            faults.0.push(Fault::new(name, message));
        }
    }
    if !faults.0.is_empty() {
        return Err(faults);
    }
    let inertia = kept(v)?;
    let mut segments = Vec::with_capacity(ends.len());
    for (i, &end) in ends.iter().enumerate() {
        let at = |name: &str| v.numbers(name).map(|list| list[i]);
        let section = general(at("modulus")?, at("density")?, at("area")?, at("second-moment")?);
        segments.push(Segment { end, section: section.at("ends")?.with_inertia(inertia) });
    }
    let section = Piecewise::new(c.length()?, segments).at("ends")?;
    Ok(Section::planar(section))
}

fn table(v: &Values, c: &Context<'_>) -> Made<Section> {
    let (name, bytes) = c.file(v, "file")?;
    let rows = files::section::read(&bytes, name).at("file")?;
    let interpolation = INTERPOLATION.make(v, "interpolation", c)?;
    let section = section::Table::new(c.length()?, &rows, interpolation).at("file")?;
    Ok(Section::planar(section))
}

fn blade(v: &Values, c: &Context<'_>) -> Made<Section> {
    let (name, bytes) = c.file(v, "file")?;
    let length = c.length()?;
    let file = files::blade::read(&bytes, name, FORMAT.make(v, "format", c)?, length).at("file")?;
    match file.coupled {
        Some(coupled) if !v.boolean("ignore-coupling")? => {
            let help = "with `ignore-coupling = true` it is left out, and named among the warnings";
            return Err(Fault::new("file", coupled).help(help).into());
        }
        coupled => c.cautions.borrow_mut().extend(file.cautions.into_iter().chain(coupled)),
    }
    let table = section::BladeTable::new(length, &file.rows).at("file")?;
    let spatial = table.clone();
    Ok(Section {
        spatial: Arc::new(move |_| Ok(Box::new(spatial.clone()))),
        is_blade: true,
        ..Section::planar(section::PlanarProjection(table))
    })
}
