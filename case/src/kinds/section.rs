//! The section of a case: kinds, keys and makers.

use super::cross_section::{Assumed, Section, Spatial};
use super::deck;
use crate::declaration::Bound::*;
use crate::fault::{At, Fault, Faults, Made};
use crate::files;
use crate::keys::{Field, File, boolean, choice, keys, number, path, quantities, quantity};
use crate::kind::{Choice, Context, Is, Kind, Of};
use crate::units::*;
use flexion::section::{
    self, BladeSection, Graded, HomogeneousBlade, Inertia, Material, Piecewise, Resultants, SectionError,
    Segment, Shape, Tapered, Uniform, UniformBlade,
};
use std::sync::Arc;

const E: Field<f64> = quantity(&MODULUS, Positive).called("modulus", "Young's modulus E");
const RHO: Field<f64> = quantity(&DENSITY, Positive).called("density", "density ρ");
const ROTARY: Field<bool> =
    boolean().or_false().called("rotary-inertia", "rotary inertia of the section, ρI, is kept");
const MASS_OF_LENGTH: Field<f64> =
    quantity(&MASS_PER_LENGTH, Positive).called("mass-per-length", "mass per length ρA");
const AXIAL: Field<f64> =
    quantity(&AXIAL_STIFFNESS, Positive).called("axial-stiffness", "axial stiffness EA");
const DIMENSION: Field<f64> = quantity(&LENGTH, Positive);
const EI: Field<f64> = quantity(&BENDING_STIFFNESS, Positive);

keys! {
    struct General {
        modulus: f64 = E;
        density: f64 = RHO;
        /// area A
        area: f64 = quantity(&AREA, Positive);
        /// second moment of area I for bending in the plane of motion
        second_moment: f64 = quantity(&SECOND_MOMENT, Positive);
        rotary_inertia: bool = ROTARY;
    }

    struct Rectangle {
        modulus: f64 = E;
        density: f64 = RHO;
        /// width, normal to the plane of motion
        width: f64 = DIMENSION;
        /// height, in the plane of motion
        height: f64 = DIMENSION;
        rotary_inertia: bool = ROTARY;
    }

    struct Circle {
        modulus: f64 = E;
        density: f64 = RHO;
        /// radius
        radius: f64 = DIMENSION;
        rotary_inertia: bool = ROTARY;
    }

    struct Tube {
        modulus: f64 = E;
        density: f64 = RHO;
        /// outer radius
        outer_radius: f64 = DIMENSION;
        /// inner radius, less than the outer
        inner_radius: f64 = DIMENSION;
        rotary_inertia: bool = ROTARY;
    }

    struct Ellipse {
        modulus: f64 = E;
        density: f64 = RHO;
        /// semi-axis a, normal to the plane of motion
        semi_width: f64 = DIMENSION;
        /// semi-axis b, in the plane of motion
        semi_height: f64 = DIMENSION;
        rotary_inertia: bool = ROTARY;
    }

    struct InPlane {
        mass_per_length: f64 = MASS_OF_LENGTH;
        axial_stiffness: f64 = AXIAL;
        /// bending stiffness EI in the plane of motion
        bending_stiffness: f64 = EI;
        /// rotary inertia per length ρI
        rotary_inertia: f64 = quantity(&ROTARY_INERTIA, NotNegative).or(0.0);
    }

    struct InTwoPlanes {
        mass_per_length: f64 = MASS_OF_LENGTH;
        axial_stiffness: f64 = AXIAL;
        /// torsional stiffness GJ
        torsional_stiffness: f64 = EI;
        /// bending stiffness EI in the direction of the height
        bending_stiffness: f64 = EI;
        /// bending stiffness EI in the direction across
        bending_stiffness_across: f64 = EI;
        /// rotary inertia per length in bending in the direction of the height
        rotary_inertia: f64 = quantity(&ROTARY_INERTIA, NotNegative).or(0.0);
        /// rotary inertia per length in bending in the direction across
        rotary_inertia_across: f64 = quantity(&ROTARY_INERTIA, NotNegative).or(0.0);
        /// shear stiffness GA in the direction of the height, for beams with shear
        shear_stiffness: Option<f64> = quantity(&AXIAL_STIFFNESS, Positive);
        /// shear stiffness GA in the direction across
        shear_stiffness_across: Option<f64> = quantity(&AXIAL_STIFFNESS, Positive);
    }

    struct PowerLaw {
        /// Young's modulus Eh of the ceramic
        ceramic_modulus: f64 = quantity(&MODULUS, Positive);
        /// Young's modulus Et of the metal
        metal_modulus: f64 = quantity(&MODULUS, Positive);
        /// density ρh of the ceramic
        ceramic_density: f64 = quantity(&DENSITY, Positive);
        /// density ρt of the metal
        metal_density: f64 = quantity(&DENSITY, Positive);
        /// width b, normal to the plane of motion
        width: f64 = DIMENSION;
        /// height h, in the plane of motion
        height: f64 = DIMENSION;
        /// exponent N of the power law
        exponent: f64 = number(NotNegative);
        /// first mass moment of the section, ρS, is kept
        first_moment: bool = boolean().or_false();
        rotary_inertia: bool = ROTARY;
    }

    struct TaperedRectangle {
        modulus: f64 = E;
        density: f64 = RHO;
        /// width at the root, normal to the plane of motion
        root_width: f64 = DIMENSION;
        /// width at the tip
        tip_width: f64 = DIMENSION;
        /// height at the root, in the plane of motion
        root_height: f64 = DIMENSION;
        /// height at the tip
        tip_height: f64 = DIMENSION;
        rotary_inertia: bool = ROTARY;
    }

    struct TaperedCircle {
        modulus: f64 = E;
        density: f64 = RHO;
        /// radius at the root
        root_radius: f64 = DIMENSION;
        /// radius at the tip
        tip_radius: f64 = DIMENSION;
        rotary_inertia: bool = ROTARY;
    }

    struct TaperedTube {
        modulus: f64 = E;
        density: f64 = RHO;
        /// outer radius at the root
        root_outer_radius: f64 = DIMENSION;
        /// inner radius at the root, less than the outer
        root_inner_radius: f64 = DIMENSION;
        /// outer radius at the tip
        tip_outer_radius: f64 = DIMENSION;
        /// inner radius at the tip, less than the outer
        tip_inner_radius: f64 = DIMENSION;
        rotary_inertia: bool = ROTARY;
    }

    struct Segments {
        /// stations at which the segments end
        ends: Vec<f64> = quantities(&LENGTH, Positive);
        /// Young's moduli E
        modulus: Vec<f64> = quantities(&MODULUS, Positive);
        /// densities ρ
        density: Vec<f64> = quantities(&DENSITY, Positive);
        /// areas A
        area: Vec<f64> = quantities(&AREA, Positive);
        /// second moments of area I for bending in the plane of motion
        second_moment: Vec<f64> = quantities(&SECOND_MOMENT, Positive);
        rotary_inertia: bool = ROTARY;
    }

    struct Rows {
        /// CSV file whose first line names the columns x, mass, EA, EI and, if wanted, ES, first-moment, rotary-inertia, in SI or as `x [mm]`
        file: File = path();
        /// values between the rows
        interpolation: section::Interpolation = choice(&INTERPOLATION).or_name("linear");
    }
}

fn kept(rotary: bool) -> Inertia {
    if rotary { Inertia::Rotary } else { Inertia::Translation }
}

/// One material and one shape all along the beam.
fn homogeneous(of: Material, rotary: bool, shape: Shape, c: &Context<'_>) -> Made<Section> {
    let planar = Uniform::from_material(of.modulus, of.density, shape).at("")?.with_inertia(kept(rotary));
    Ok(Section {
        height: height(shape),
        shapes: Some([shape; 2]),
        spatial: blade_of_shapes(of, c, [shape; 2])?,
        ..Section::planar(planar)
    })
}

/// One material, and a shape whose dimensions change linearly from root to tip.
fn tapered(of: Material, rotary: bool, shapes: [Shape; 2], c: &Context<'_>) -> Made<Section> {
    let [root, tip] = shapes;
    let planar = Tapered::new(of.modulus, of.density, c.length()?, root, tip).at("")?;
    Ok(Section {
        height: height(root),
        shapes: Some(shapes),
        spatial: blade_of_shapes(of, c, shapes)?,
        ..Section::planar(planar.with_inertia(kept(rotary)))
    })
}

/// A tube whose inner radius is that of `key`.
fn tube(outer_radius: f64, inner_radius: f64, key: &str) -> Made<Shape> {
    if inner_radius >= outer_radius {
        let message = format!("must be less than the outer radius {outer_radius} m, but is {inner_radius} m");
        return Err(Fault::new(key, message).into());
    }
    Ok(Shape::Tube { outer_radius, inner_radius })
}

fn height(shape: Shape) -> Option<f64> {
    let (lower, upper) = shape.fibres();
    Some(upper - lower)
}

/// The blade whose shape changes from root to tip: it is stiff out of the plane as its shape says.
fn blade_of_shapes(of: Material, c: &Context<'_>, [root, tip]: [Shape; 2]) -> Made<Spatial> {
    let (Material { modulus, density }, length) = (of, c.length()?);
    Ok(Arc::new(move |Assumed { poisson_ratio, shear_factor }| {
        let along = Tapered::new(modulus, density, length, root, tip)?;
        let blade = HomogeneousBlade::new(modulus, density, poisson_ratio, move |x| along.shape(x))?;
        Ok(Box::new(blade.with_shear_factor(shear_factor)))
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
            example: r#"section={kind="table", file="section.csv", interpolation="linear"}"#,
            make: &Is(section::Interpolation::Linear),
        },
        Kind {
            name: "cubic",
            summary: "monotone cubics, with continuous slopes",
            source: "Fritsch & Butland 1984, doi:10.1137/0905021",
            example: r#"section={kind="table", file="section.csv", interpolation="cubic"}"#,
            make: &Is(section::Interpolation::Cubic),
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
            example: r#"section={kind="uniform", modulus="7 GPa", density=2700, area="4 cm^2", second-moment="2e-8 m^4", rotary-inertia=true}"#,
            make: &Of(uniform),
        },
        Kind {
            name: "rectangle",
            summary: "one material; a rectangle",
            source: "",
            example: r#"section={kind="rectangle", modulus="70 GPa", density="2.7 g/cm^3", width="1 in", height="2 cm"}"#,
            make: &Of(|Rectangle { modulus, density, width, height, rotary_inertia }, c| {
                homogeneous(
                    Material { modulus, density },
                    rotary_inertia,
                    Shape::Rectangle { width, height },
                    c,
                )
            }),
        },
        Kind {
            name: "circle",
            summary: "one material; a full circle",
            source: "",
            example: r#"section={kind="circle", modulus="70 GPa", density=2700, radius="1 cm"}"#,
            make: &Of(|Circle { modulus, density, radius, rotary_inertia }, c| {
                homogeneous(Material { modulus, density }, rotary_inertia, Shape::Circle { radius }, c)
            }),
        },
        Kind {
            name: "tube",
            summary: "one material; a circular tube",
            source: "",
            example: r#"section={kind="tube", modulus="70 GPa", density=2700, outer-radius="2 cm", inner-radius="1 cm"}"#,
            make: &Of(|Tube { modulus, density, outer_radius, inner_radius, rotary_inertia }, c| {
                let shape = tube(outer_radius, inner_radius, "inner-radius")?;
                homogeneous(Material { modulus, density }, rotary_inertia, shape, c)
            }),
        },
        Kind {
            name: "ellipse",
            summary: "one material; a full ellipse",
            source: "",
            example: r#"section={kind="ellipse", modulus="70 GPa", density=2700, semi-width="2 cm", semi-height="1 cm"}"#,
            make: &Of(|Ellipse { modulus, density, semi_width, semi_height, rotary_inertia }, c| {
                let shape = Shape::Ellipse { semi_width, semi_height };
                homogeneous(Material { modulus, density }, rotary_inertia, shape, c)
            }),
        },
        Kind {
            name: "resultants",
            summary: "mass and stiffnesses per length given directly",
            source: "",
            example: r#"section={kind="resultants", mass-per-length="1.2 kg/m", axial-stiffness="28 MN", bending-stiffness="930 N m²", rotary-inertia=6e-4}"#,
            make: &Of(resultants),
        },
        Kind {
            name: "general",
            summary: "mass and stiffnesses per length for bending in two planes and torsion",
            source: "",
            example: r#"section={kind="general", mass-per-length="1.2 kg/m", axial-stiffness="28 MN", torsional-stiffness="700 N m²", bending-stiffness="930 N m²", bending-stiffness-across="800 N m²", rotary-inertia=1e-4, rotary-inertia-across=1e-4, shear-stiffness="10 MN", shear-stiffness-across="10 MN"}"#,
            make: &Of(general_section),
        },
        Kind {
            name: "graded",
            summary: "a rectangle graded over its height by a power law, from metal (bottom) to ceramic (top)",
            source: "Reddy 2000, doi:10.1002/(SICI)1097-0207(20000110/30)47:1/3<663::AID-NME787>3.0.CO;2-8",
            example: r#"section={kind="graded", ceramic-modulus="151 GPa", metal-modulus="70 GPa", ceramic-density=3000, metal-density=2707, width="2 cm", height="2 cm", exponent=1.5}"#,
            make: &Of(graded),
        },
        Kind {
            name: "tapered-rectangle",
            summary: "one material; a rectangle whose width and height change linearly from root to tip",
            source: "",
            example: r#"section={kind="tapered-rectangle", modulus="70 GPa", density=2700, root-width="2 cm", tip-width="1 cm", root-height="3 cm", tip-height="1 cm"}"#,
            make: &Of(|k: TaperedRectangle, c| {
                let root = Shape::Rectangle { width: k.root_width, height: k.root_height };
                let tip = Shape::Rectangle { width: k.tip_width, height: k.tip_height };
                let material = Material { modulus: k.modulus, density: k.density };
                tapered(material, k.rotary_inertia, [root, tip], c)
            }),
        },
        Kind {
            name: "tapered-circle",
            summary: "one material; a full circle whose radius changes linearly from root to tip",
            source: "",
            example: r#"section={kind="tapered-circle", modulus="70 GPa", density=2700, root-radius="2 cm", tip-radius="1 cm", rotary-inertia=true}"#,
            make: &Of(|k: TaperedCircle, c| {
                let shapes = [k.root_radius, k.tip_radius].map(|radius| Shape::Circle { radius });
                tapered(Material { modulus: k.modulus, density: k.density }, k.rotary_inertia, shapes, c)
            }),
        },
        Kind {
            name: "tapered-tube",
            summary: "one material; a circular tube whose radii change linearly from root to tip",
            source: "",
            example: r#"section={kind="tapered-tube", modulus="70 GPa", density=2700, root-outer-radius="2 cm", root-inner-radius="1 cm", tip-outer-radius="15 mm", tip-inner-radius="1 cm"}"#,
            make: &Of(|k: TaperedTube, c| {
                let root = tube(k.root_outer_radius, k.root_inner_radius, "root-inner-radius")?;
                let tip = tube(k.tip_outer_radius, k.tip_inner_radius, "tip-inner-radius")?;
                let material = Material { modulus: k.modulus, density: k.density };
                tapered(material, k.rotary_inertia, [root, tip], c)
            }),
        },
        Kind {
            name: "piecewise",
            summary: "uniform segments from the root to the tip: one entry a segment in every list",
            source: "",
            example: r#"section={kind="piecewise", ends=["1 m", 2], modulus=["70 GPa", "60 GPa"], density=[2700, 2600], area=["4 cm^2", "3 cm^2"], second-moment=["2e-8 m^4", "1e-8 m^4"]}"#,
            make: &Of(piecewise),
        },
        Kind {
            name: "table",
            summary: "mass and stiffnesses tabulated along the beam",
            source: "",
            example: r#"section={kind="table", file="section.csv"}"#,
            make: &Of(table),
        },
        Kind {
            name: "deck",
            summary: "a blade deck: sections of a blade along its span, by 6 × 6 matrices along a reference line, which is the axis of its beam, \
                      or by stiffnesses about principal axes",
            source: "",
            example: r#"beam=[{up=[0, 0, 1], section={kind="deck", file="beamdyn_primary.dat"}, root="clamped", shear=true}]"#,
            make: &Of(deck::section),
        },
    ],
};

fn uniform(k: General, _: &Context<'_>) -> Made<Section> {
    let section = general(k.modulus, k.density, k.area, k.second_moment).at("")?;
    Ok(Section::planar(section.with_inertia(kept(k.rotary_inertia))))
}

fn resultants(k: InPlane, _: &Context<'_>) -> Made<Section> {
    let section = Uniform::from_resultants(Resultants {
        mass: k.mass_per_length,
        rotary_inertia: k.rotary_inertia,
        axial_stiffness: k.axial_stiffness,
        bending_stiffness: k.bending_stiffness,
        ..Resultants::default()
    });
    Ok(Section::planar(section.at("")?))
}

fn general_section(k: InTwoPlanes, _: &Context<'_>) -> Made<Section> {
    let resultants = section::BladeResultants {
        mass: k.mass_per_length,
        axial_stiffness: k.axial_stiffness,
        torsional_stiffness: k.torsional_stiffness,
        chord_stiffness: k.bending_stiffness,
        flap_stiffness: k.bending_stiffness_across,
        chord_inertia: k.rotary_inertia,
        flap_inertia: k.rotary_inertia_across,
        twist: 0.0,
        twist_rate: 0.0,
    };
    resultants.validate().at("")?;
    let shear = match (k.shear_stiffness, k.shear_stiffness_across) {
        (None, None) => None,
        (Some(along), Some(across)) => Some([along, across]),
        (Some(_), None) | (None, Some(_)) => {
            let [given, other] = match k.shear_stiffness {
                Some(_) => ["shear-stiffness", "shear-stiffness-across"],
                None => ["shear-stiffness-across", "shear-stiffness"],
            };
            return Err(Fault::new(given, format!("needs `{other}` beside it")).into());
        }
    };
    let blade = UniformBlade { resultants, shear };
    let spatial = Arc::new(move |_| Ok(Box::new(blade) as Box<dyn BladeSection>));
    Ok(Section { spatial, ..Section::planar(section::PlanarProjection(resultants)) })
}

fn graded(k: PowerLaw, _: &Context<'_>) -> Made<Section> {
    let inertia = match (k.first_moment, k.rotary_inertia) {
        (true, false) => {
            let message = "the first mass moment cannot be kept without the rotary inertia: the kinetic energy of short waves would be negative";
            return Err(Fault::new("first-moment", message).help("add `rotary-inertia = true`").into());
        }
        (true, true) => Inertia::Full,
        (false, rotary) => kept(rotary),
    };
    let ceramic = Material { modulus: k.ceramic_modulus, density: k.ceramic_density };
    let metal = Material { modulus: k.metal_modulus, density: k.metal_density };
    let section = Graded::new(ceramic, metal, k.exponent, k.width, k.height).at("")?;
    Ok(Section {
        height: Some(k.height),
        spatial: Arc::new(|_| {
            let message = "a `graded` section, which bends and stretches together, belongs to the planar hub and beam: beams in space and \
                           blades do without; take `general` with the stiffnesses about its tension centre";
            Err(SectionError::Invalid(message.to_owned()))
        }),
        ..Section::planar(section.with_inertia(inertia))
    })
}

/// Segments from lists of equal length.
fn piecewise(k: Segments, c: &Context<'_>) -> Made<Section> {
    let lists = [
        ("modulus", &k.modulus),
        ("density", &k.density),
        ("area", &k.area),
        ("second-moment", &k.second_moment),
    ];
    let mut faults = Faults::default();
    for (name, count) in lists.map(|(name, list)| (name, list.len())) {
        if count != k.ends.len() {
            let message = format!("has {count} entries for the {} segments in `ends`", k.ends.len());
            faults.0.push(Fault::new(name, message));
        }
    }
    if !faults.0.is_empty() {
        return Err(faults);
    }
    let mut segments = Vec::with_capacity(k.ends.len());
    for (i, &end) in k.ends.iter().enumerate() {
        let section = general(k.modulus[i], k.density[i], k.area[i], k.second_moment[i]);
        segments.push(Segment { end, section: section.at("ends")?.with_inertia(kept(k.rotary_inertia)) });
    }
    let section = Piecewise::new(c.length()?, segments).at("ends")?;
    Ok(Section::planar(section))
}

fn table(Rows { file, interpolation }: Rows, c: &Context<'_>) -> Made<Section> {
    let rows = files::section::read(&file.bytes, &file.name).at("file")?;
    let section = section::Table::new(c.length()?, &rows, interpolation).at("file")?;
    Ok(Section::planar(section))
}
