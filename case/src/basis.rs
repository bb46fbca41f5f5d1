//! The bases of a case: kinds and their keys.

use super::declaration::{Bound::*, Key, Kind, Presence as Default, Presence::Required, Seam, Type, key};
use super::values::Values;
use flexion::basis::Field;

/// The bases of both fields.
#[derive(Clone, Debug, PartialEq)]
pub struct Bases {
    /// Basis of the axial field.
    pub axial: Basis,
    /// Basis of the transverse field.
    pub transverse: Basis,
}

/// The basis of one field.
#[derive(Clone, Debug, PartialEq)]
pub enum Basis {
    /// Finite elements: Lagrange for the axial field, cubic Hermite for the transverse one.
    FiniteElements {
        /// Number of equal elements.
        elements: usize,
        /// Degree of the axial elements, 1 or 2; the transverse ones are cubic.
        axial_degree: usize,
    },
    /// Vibration modes of the beam at rest.
    Modes {
        /// Number of modes.
        count: usize,
    },
    /// Radial point interpolation.
    Radial(RadialBasis),
    /// Point interpolation with polynomials.
    Polynomial {
        /// Number of equally spaced nodes, ends included.
        nodes: usize,
        /// Half width of the support domain over the node spacing, α_s.
        support: f64,
    },
    /// B-splines.
    BSpline {
        /// Number of equal spans.
        elements: usize,
        /// Degree p.
        degree: usize,
    },
    /// Bézier curves.
    Bezier {
        /// Number of equal elements, joined smoothly.
        elements: usize,
        /// Degree n.
        degree: usize,
    },
}

impl Bases {
    /// Entries in the band of a tangent, about: a function that is not zero on a part s of the beam shares it with
    /// s n of all n functions.
    pub fn entries(&self) -> f64 {
        let (axial, transverse) =
            (self.axial.extent(Field::Axial), self.transverse.extent(Field::Transverse));
        let functions = axial.0 + transverse.0;
        functions * (functions * axial.1.max(transverse.1)).min(functions)
    }
}

impl Basis {
    /// The key that sets the number of functions.
    pub(super) fn size_key(&self) -> &'static str {
        match self {
            Basis::FiniteElements { .. } | Basis::BSpline { .. } | Basis::Bezier { .. } => "elements",
            Basis::Modes { .. } => "count",
            Basis::Radial(_) | Basis::Polynomial { .. } => "nodes",
        }
    }

    /// Number of functions, about, and the part of the beam on which each of them is not zero.
    fn extent(&self, field: Field) -> (f64, f64) {
        match *self {
            Basis::FiniteElements { elements, axial_degree } => {
                let each = if field == Field::Axial { axial_degree } else { 2 };
                ((elements * each) as f64, 2.0 / elements as f64)
            }
            Basis::Modes { count } => (count as f64, 1.0),
            Basis::Radial(RadialBasis { nodes, support, .. }) | Basis::Polynomial { nodes, support } => {
                (2.0 * nodes as f64, 2.0 * (support + 1.0) / nodes as f64)
            }
            Basis::BSpline { elements, degree } => {
                ((elements + degree) as f64, (degree + 1) as f64 / elements as f64)
            }
            Basis::Bezier { elements, degree } => ((elements * degree) as f64, 2.0 / elements as f64),
        }
    }
}

/// Parameters of radial point interpolation with multiquadrics (r² + (α_c d_c)²)^q.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadialBasis {
    /// Number of equally spaced nodes, ends included.
    pub nodes: usize,
    /// Shape parameter α_c.
    pub shape: f64,
    /// Exponent q.
    pub exponent: f64,
    /// Half width of the support domain over the node spacing, α_s.
    pub support: f64,
    /// Degree of the added polynomials; `None` adds none.
    pub degree: Option<usize>,
}

const MOST: i64 = 1_000_000;

const ELEMENTS: Key =
    key("elements", Type::Integer(1, MOST), Default::Integer(10), "number of equal elements over the length");
const AXIAL_DEGREE: Key = key(
    "axial-degree",
    Type::Integer(1, 2),
    Default::Integer(1),
    "degree of the axial elements (the exact coupling is cubic and does without it)",
);
const DU: &str = "Du, Zhang & Hong 2015, doi:10.6052/0459-1879-14-334";

const NODES: Key = key(
    "nodes",
    Type::Integer(2, MOST),
    Default::Integer(11),
    "number of equally spaced nodes, ends included",
);

const POLYNOMIAL: Kind = Kind {
    name: "polynomial",
    summary: "meshfree point interpolation (PIM) with polynomials",
    source: "Du & Zhang 2015, doi:10.7498/aps.64.034501",
    keys: &[
        NODES,
        key(
            "support",
            Type::Number(Positive),
            Default::Number(1.5),
            "half width α_s of the support domain over the node spacing; 0.5 gives finite elements",
        ),
    ],
};

const B_SPLINE: Kind = Kind {
    name: "b-spline",
    summary: "B-splines of any degree on equal spans",
    source: "Fan & Zhang 2012, doi:10.3901/JME.2012.23.059",
    keys: &[
        ELEMENTS,
        key(
            "degree",
            Type::Integer(1, 15),
            Default::Integer(3),
            "degree p; at least 2 for the transverse field",
        ),
    ],
};

const BEZIER: Kind = Kind {
    name: "bezier",
    summary: "Bézier curve over the whole beam, or smoothly joined ones",
    source: "Fan & Zhang 2014, doi:10.7498/aps.63.154501",
    keys: &[
        key(
            "degree",
            Type::Integer(1, 27),
            Default::Integer(10),
            "degree n; at least 2 for the transverse field",
        ),
        key(
            "elements",
            Type::Integer(1, MOST),
            Default::Integer(1),
            "number of equal elements, joined smoothly",
        ),
    ],
};

const RADIAL: Kind = Kind {
    name: "radial",
    summary: "radial point interpolation (RPIM) with multiquadrics",
    source: DU,
    keys: &[
        NODES,
        key(
            "shape",
            Type::Number(Positive),
            Default::Number(4.0),
            "shape parameter α_c; 2 to 7 is accurate, above that the moment matrix becomes singular",
        ),
        key("exponent", Type::Number(Positive), Default::Number(1.03), "exponent q; not an integer"),
        key(
            "support",
            Type::Number(Positive),
            Default::Number(2.5),
            "half width α_s of the support domain over the node spacing",
        ),
        key(
            "degree",
            Type::Integer(-1, 9),
            Default::Integer(3),
            "degree of the added polynomials, -1 for none",
        ),
    ],
};

/// The kinds of basis for one field.
pub(super) static FIELD: Seam = Seam {
    name: "field basis",
    path: "basis.axial",
    summary: "functions for one displacement field",
    kinds: &[
        Kind {
            name: "finite-elements",
            summary: "Lagrange elements (axial) or cubic Hermite elements (transverse)",
            source: DU,
            keys: &[ELEMENTS, AXIAL_DEGREE],
        },
        Kind {
            name: "modes",
            summary: "vibration modes of the beam at rest (assumed modes)",
            source: DU,
            keys: &[key("count", Type::Integer(1, 100), Required, "number of modes")],
        },
        RADIAL,
        POLYNOMIAL,
        B_SPLINE,
        BEZIER,
    ],
};

/// The kinds of basis.
pub(super) static SEAM: Seam = Seam {
    name: "basis",
    path: "basis",
    summary: "functions for the axial and transverse displacement",
    kinds: &[
        Kind {
            name: "finite-elements",
            summary: "Lagrange elements (axial) and cubic Hermite elements (transverse)",
            source: DU,
            keys: &[ELEMENTS, AXIAL_DEGREE],
        },
        Kind {
            name: "modes",
            summary: "vibration modes of the beam at rest (assumed modes)",
            source: DU,
            keys: &[
                key("axial", Type::Integer(1, 100), Default::Integer(4), "number of axial modes"),
                key("transverse", Type::Integer(1, 100), Default::Integer(4), "number of bending modes"),
            ],
        },
        RADIAL,
        POLYNOMIAL,
        B_SPLINE,
        BEZIER,
        Kind {
            name: "mixed",
            summary: "another basis for each field",
            source: "",
            keys: &[
                key("axial", Type::Kind(&FIELD), Required, "basis of the axial displacement"),
                key("transverse", Type::Kind(&FIELD), Required, "basis of the transverse displacement"),
            ],
        },
    ],
};

/// Reads the bases of both fields.
pub(super) fn read(kind: &Kind, v: &Values) -> Option<Bases> {
    Some(match kind.name {
        "modes" => Bases {
            axial: Basis::Modes { count: v.count("axial")? },
            transverse: Basis::Modes { count: v.count("transverse")? },
        },
        "mixed" => {
            let (axial, transverse) = (v.kind("axial")?, v.kind("transverse")?);
            Bases { axial: field(axial.0, axial.1)?, transverse: field(transverse.0, transverse.1)? }
        }
        _ => {
            let both = field(kind, v)?;
            Bases { axial: both.clone(), transverse: both }
        }
    })
}

fn field(kind: &Kind, v: &Values) -> Option<Basis> {
    Some(match kind.name {
        "modes" => Basis::Modes { count: v.count("count")? },
        "radial" => Basis::Radial(RadialBasis {
            nodes: v.count("nodes")?,
            shape: v.number("shape")?,
            exponent: v.number("exponent")?,
            support: v.number("support")?,
            degree: v.integer("degree").map(|degree| usize::try_from(degree).ok())?,
        }),
        "polynomial" => Basis::Polynomial { nodes: v.count("nodes")?, support: v.number("support")? },
        "b-spline" => Basis::BSpline { elements: v.count("elements")?, degree: v.count("degree")? },
        "bezier" => Basis::Bezier { elements: v.count("elements")?, degree: v.count("degree")? },
        _ => Basis::FiniteElements { elements: v.count("elements")?, axial_degree: v.count("axial-degree")? },
    })
}
