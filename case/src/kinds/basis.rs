//! The bases of a case: kinds, keys and makers.

use crate::declaration::Bound::*;
use crate::fault::{At, Fault, Made, both};
use crate::keys::{boolean, integer, keys, kind, number};
use crate::kind::{Choice, Context, Kind, Of};
use crate::values::join;
use flexion::analysis::error::SAFETY;
use flexion::basis::{
    self, BSpline, BasisError, Bezier, Field, Hermite, Lagrange, Modes, Polynomial, PolynomialParameters,
    Radial, RadialParameters, mesh,
};
use std::sync::Arc;

/// Largest matrices of a run: with its dozens of them it takes some 10 GB.
const MOST_ENTRIES: f64 = 5e7;
/// Memory of a run for each function, about, and most that is taken [bytes].
const BYTES: f64 = 3.5e3;
const MOST_BYTES: f64 = 4e9;
/// Vibration modes converge more slowly than that when the beam rotates fast, and so do functions that are smooth where the
/// curvature of the beam is not: order ½ at least.
const SAFETY_OF_SLOW: f64 = 4.0;

/// The bases of both fields.
#[derive(Clone, Debug)]
pub struct Bases {
    /// Basis of the axial field.
    pub axial: Arc<dyn basis::Basis>,
    /// Basis of the transverse field.
    pub transverse: Arc<dyn basis::Basis>,
    /// Basis of the transverse field for a tip without mass, where there is one.
    pub massless: Option<Arc<dyn basis::Basis>>,
    /// Number and axial degree of the elements, if both fields are of the same finite elements.
    pub elements: Option<(usize, usize)>,
    /// Width of the transverse functions \[m\] where they are no elements, which end at stations.
    pub width: Option<f64>,
    /// What makes twice the functions, with every element cut in two: dotted path within the table and value.
    pub finer: Vec<(String, usize)>,
    /// What makes about twice the functions by the number that a user would change, likewise.
    pub more: Vec<(String, usize)>,
    /// Factor between the error of a run and its difference from one with twice the functions.
    pub safety: f64,
}

/// The functions of one field, still to be built.
struct Functions {
    /// Number of functions, about, and the part of the beam on which each of them is not zero.
    extent: (f64, f64),
    /// Number and axial degree of finite elements.
    elements: Option<(usize, usize)>,
    /// The key that makes twice the functions, and its value then.
    finer: (&'static str, usize),
    /// The key of the number of functions, and twice its value.
    more: (&'static str, usize),
    /// As in [`Bases`].
    safety: f64,
    /// The key that most likely is to blame.
    blame: &'static str,
    build: Build,
    /// The same with a function for the tip alone, where `build` has none.
    massless: Option<Build>,
    /// The key of its table, if each field has its own.
    table: &'static str,
}

/// Builds a basis of the length of the beam \[m\] and the stations at which elements should end.
type Build = Box<dyn Fn(f64, &Stations<'_>) -> Result<Arc<dyn basis::Basis>, BasisError>>;

/// The stations at which so many equal elements should end, too \[m\].
type Stations<'a> = dyn Fn(usize) -> Vec<f64> + 'a;

/// What a kind gives: the functions of either field.
pub struct Either(Box<dyn Fn(Field) -> Functions>);

impl Either {
    fn new(functions: impl Fn(Field) -> Functions + 'static) -> Made<Either> {
        Ok(Either(Box::new(functions)))
    }
}

impl Functions {
    /// Functions of this extent, to be refined by this key.
    fn new(extent: (f64, f64), finer: (&'static str, usize), build: Build) -> Functions {
        Functions {
            extent,
            finer,
            more: finer,
            build,
            massless: None,
            elements: None,
            safety: SAFETY,
            blame: "kind",
            table: "",
        }
    }
}

/// The basis as what [`Functions`] build.
fn shared<B: basis::Basis + 'static>(
    basis: Result<B, BasisError>,
) -> Result<Arc<dyn basis::Basis>, BasisError> {
    basis.map(|basis| Arc::new(basis) as Arc<dyn basis::Basis>)
}

/// The bases of what the key `basis` of a case chooses; finite elements also end at `stations`.
pub fn make(Either(functions): &Either, c: &Context<'_>, stations: &Stations<'_>) -> Made<Bases> {
    built([functions(Field::Axial), functions(Field::Transverse)], c, stations)
        .map_err(|faults| faults.within("basis"))
}

fn built(fields: [Functions; 2], c: &Context<'_>, stations: &Stations<'_>) -> Made<Bases> {
    let length = c.length()?;
    let functions = fields[0].extent.0 + fields[1].extent.0;
    // A function that is not zero on a part s of the beam shares it with s n of all n functions.
    let entries = functions * (functions * fields[0].extent.1.max(fields[1].extent.1)).min(functions);
    if entries > MOST_ENTRIES {
        let message = format!(
            "a matrix of this basis has about {entries:.0e} entries, and a run needs some dozen of that size; at most \
             {MOST_ENTRIES:.0e} are tried: take fewer or narrower functions"
        );
        return Err(Fault::new("", message).into());
    }
    let bytes = BYTES * functions;
    if bytes > MOST_BYTES {
        let message = format!(
            "{functions:.1e} functions take about {:.0} GB of memory, and at most {:.0} GB are taken: take fewer",
            1e-9 * bytes,
            1e-9 * MOST_BYTES
        );
        return Err(Fault::new(join(fields[1].table, fields[1].more.0), message).into());
    }
    let made = |field: &Functions| (field.build)(length, stations).at(&join(field.table, field.blame));
    let (axial, transverse) = both(made(&fields[0]), made(&fields[1])).map_err(|mut faults| {
        // One basis for both fields is reported once.
        faults.0.dedup_by(|a, b| a.key == b.key);
        faults
    })?;
    let with_tip = fields[1].massless.as_ref().and_then(|build| build(length, stations).ok());
    let massless = with_tip.or_else(|| transverse.tip().map(|_| Arc::clone(&transverse)));
    let keys = |of: fn(&Functions) -> (&'static str, usize)| {
        let key = |f: &Functions| (join(f.table, of(f).0), of(f).1);
        let mut keys = fields.each_ref().map(key).to_vec();
        keys.dedup();
        keys
    };
    let within = stations(10).iter().any(|station| 0.0 < *station && *station < length);
    let safety = |f: &Functions| if within && f.elements.is_none() { SAFETY_OF_SLOW } else { f.safety };
    let safety = safety(&fields[0]).max(safety(&fields[1]));
    Ok(Bases {
        axial,
        transverse,
        massless,
        elements: fields[0].elements.filter(|(n, _)| fields[1].elements.is_some_and(|(m, _)| *n == m)),
        width: fields[1].elements.is_none().then(|| length / fields[1].extent.0),
        finer: keys(|f| f.finer),
        more: keys(|f| f.more),
        safety,
    })
}

/// Another basis for each field.
fn mixed(Mixed { axial, transverse }: Mixed, _: &Context<'_>) -> Made<Either> {
    Either::new(move |field| match field {
        Field::Axial => Functions { table: "axial", ..(axial.0)(field) },
        Field::Transverse => Functions { table: "transverse", ..(transverse.0)(field) },
    })
}

fn finite_elements(k: FiniteElements, _: &Context<'_>) -> Made<Either> {
    let FiniteElements { elements, refine: parts, axial_degree: degree } = k;
    Either::new(move |field| {
        let each = if field == Field::Axial { degree } else { 2 };
        let all = elements * parts;
        let extent = (all as f64 * each as f64, 2.0 / all as f64);
        let build: Build = Box::new(move |length, stations| {
            let ends = stations(elements);
            let cells = cut(&mesh(length, elements, &ends)?, parts);
            match field {
                Field::Axial => shared(Lagrange::on(cells, degree)),
                Field::Transverse => shared(Hermite::on(cells, field)),
            }
        });
        // Twice the number would leave an element beside a station as it is.
        let functions = Functions::new(extent, ("refine", 2 * parts), build);
        Functions { elements: Some((all, degree)), more: ("elements", 2 * elements), ..functions }
    })
}

/// Every cell in so many equal parts.
fn cut(cells: &[f64], parts: usize) -> Vec<f64> {
    let part = |i: usize| {
        let (cell, k) = (i / parts, i % parts);
        let from = cells[cell];
        if k == 0 { from } else { from + (cells[cell + 1] - from) * k as f64 / parts as f64 }
    };
    (0..=(cells.len() - 1) * parts).map(part).collect()
}

/// Vibration modes, with the keys and values of the numbers of axial and transverse ones.
fn modes(counts: [(&'static str, usize); 2]) -> Made<Either> {
    Either::new(move |field| {
        let (key, count) = counts[usize::from(field == Field::Transverse)];
        let build: Build = Box::new(move |length, _| shared(Modes::new(length, count, field)));
        let functions = Functions::new((count as f64, 1.0), (key, 2 * count), build);
        let massless: Build = Box::new(move |length, _| shared(Modes::with_residual(length, count)));
        Functions { safety: SAFETY_OF_SLOW, massless: Some(massless), ..functions }
    })
}

/// Extent and refinement of functions that interpolate on equally spaced nodes.
fn on_nodes(nodes: usize, support: f64, build: Build) -> Functions {
    let extent = (2.0 * nodes as f64, 2.0 * (support + 1.0) / nodes as f64);
    Functions::new(extent, ("nodes", 2 * nodes - 1), build)
}

fn radial(k: Multiquadrics, _: &Context<'_>) -> Made<Either> {
    let Multiquadrics { nodes, shape, exponent, support, degree, domain_per_point } = k;
    let degree = usize::try_from(degree).ok();
    let parameters =
        RadialParameters { nodes, shape, exponent, support, degree, per_point: domain_per_point };
    Either::new(move |field| {
        let build: Build = Box::new(move |length, _| shared(Radial::new(length, parameters, field)));
        Functions { blame: "shape", ..on_nodes(parameters.nodes, parameters.support, build) }
    })
}

fn polynomial(Points { nodes, support }: Points, _: &Context<'_>) -> Made<Either> {
    let parameters = PolynomialParameters { nodes, support };
    Either::new(move |field| {
        let build: Build = Box::new(move |length, _| shared(Polynomial::new(length, parameters, field)));
        Functions { blame: "support", ..on_nodes(parameters.nodes, parameters.support, build) }
    })
}

fn b_spline(Spans { elements, degree }: Spans, _: &Context<'_>) -> Made<Either> {
    let extent = ((elements + degree) as f64, (degree + 1) as f64 / elements as f64);
    Either::new(move |field| {
        let build: Build = Box::new(move |length, _| shared(BSpline::new(length, elements, degree, field)));
        Functions { blame: "degree", ..Functions::new(extent, ("elements", 2 * elements), build) }
    })
}

fn bezier(Joined { degree, elements }: Joined, _: &Context<'_>) -> Made<Either> {
    let extent = ((elements * degree) as f64, 2.0 / elements as f64);
    Either::new(move |field| {
        let build: Build = Box::new(move |length, _| shared(Bezier::new(length, elements, degree, field)));
        Functions { blame: "degree", ..Functions::new(extent, ("elements", 2 * elements), build) }
    })
}

const MOST: i64 = 1_000_000;

/// Largest number of modes.
const MOST_MODES: i64 = 200;

const NODES: crate::keys::Field<usize> =
    integer(2, MOST).or_count(11).called("nodes", "number of equally spaced nodes, ends included");

keys! {
    pub(crate) struct FiniteElements {
        /// number of equal elements over the length; they are cut where loads and masses are and the section jumps
        elements: usize = integer(1, MOST).or_count(10);
        /// into how many equal parts each element is cut, those beside loads, masses and jumps too
        refine: usize = integer(1, 1000).or_count(1);
        /// degree of the axial elements (the exact coupling is cubic and does without it)
        axial_degree: usize = integer(1, 2).or_count(1);
    }

    struct Numbers {
        /// number of axial modes
        axial: usize = integer(1, MOST_MODES).or_count(4);
        /// number of bending modes
        transverse: usize = integer(1, MOST_MODES).or_count(4);
    }

    struct Number {
        /// number of modes
        count: usize = integer(1, MOST_MODES);
    }

    struct Multiquadrics {
        nodes: usize = NODES;
        /// shape parameter α_c; 2 to 7 is accurate, above that the moment matrix becomes singular
        shape: f64 = number(Positive).or(4.0);
        /// exponent q; not an integer
        exponent: f64 = number(Positive).or(1.03);
        /// half width α_s of the support domain over the node spacing
        support: f64 = number(Positive).or(2.5);
        /// degree of the added polynomials, -1 for none
        degree: i64 = integer(-1, 9).or_integer(3);
        /// whether each point has a support domain of its own, and not each interval between two nodes: displacements then jump inside of the beam
        domain_per_point: bool = boolean().or_false();
    }

    struct Points {
        nodes: usize = NODES;
        /// half width α_s of the support domain over the node spacing; 0.5 gives finite elements
        support: f64 = number(Positive).or(1.5);
    }

    struct Spans {
        /// number of equal elements over the length
        elements: usize = integer(1, MOST).or_count(10);
        /// degree p; at least 2 for the transverse field
        degree: usize = integer(1, 15).or_count(3);
    }

    struct Joined {
        /// degree n; at least 2 for the transverse field
        degree: usize = integer(1, 27).or_count(10);
        /// number of equal elements, joined smoothly
        elements: usize = integer(1, MOST).or_count(1);
    }

    struct Mixed {
        /// basis of the axial displacement
        axial: Either = kind(&FIELD);
        /// basis of the transverse displacement
        transverse: Either = kind(&FIELD);
    }
}

const DU: &str = "Du, Zhang & Hong 2015, doi:10.6052/0459-1879-14-334";

const FINITE_ELEMENTS: Kind<Either> = Kind {
    name: "finite-elements",
    summary: "Lagrange elements (axial) and cubic Hermite elements (transverse)",
    source: DU,
    example: "basis={kind='finite-elements', elements=7, axial-degree=2}",
    make: &Of(finite_elements),
};

const MODES: Kind<Either> = Kind {
    name: "modes",
    summary: "vibration modes of the beam at rest (assumed modes)",
    source: DU,
    example: "basis={kind='modes', axial=2}",
    make: &Of(|k: Numbers, _| modes([("axial", k.axial), ("transverse", k.transverse)])),
};

/// Modes of one field.
const MODES_OF_FIELD: Kind<Either> = Kind {
    example: "basis={kind='mixed', axial={kind='modes', count=2}, transverse={kind='radial'}}",
    make: &Of(|k: Number, _| modes([("count", k.count); 2])),
    ..MODES
};

const RADIAL: Kind<Either> = Kind {
    name: "radial",
    summary: "radial point interpolation (RPIM) with multiquadrics",
    source: DU,
    example: "basis={kind='radial', nodes=9, degree=-1}",
    make: &Of(radial),
};

const POLYNOMIAL: Kind<Either> = Kind {
    name: "polynomial",
    summary: "meshfree point interpolation (PIM) with polynomials",
    source: "Du & Zhang 2015, doi:10.7498/aps.64.034501",
    example: "basis={kind='polynomial', nodes=9, support=2.5}",
    make: &Of(polynomial),
};

const B_SPLINE: Kind<Either> = Kind {
    name: "b-spline",
    summary: "B-splines of any degree on equal spans",
    source: "Fan & Zhang 2012, doi:10.3901/JME.2012.23.059",
    example: "basis={kind='b-spline', elements=8, degree=4}",
    make: &Of(b_spline),
};

const BEZIER: Kind<Either> = Kind {
    name: "bezier",
    summary: "Bézier curve over the whole beam, or smoothly joined ones",
    source: "Fan & Zhang 2014, doi:10.7498/aps.63.154501",
    example: "basis={kind='bezier', degree=6, elements=2}",
    make: &Of(bezier),
};

const MIXED: Kind<Either> = Kind {
    name: "mixed",
    summary: "another basis for each field",
    source: "",
    example: "basis={kind='mixed', axial={kind='b-spline', degree=1}, transverse={kind='bezier', degree=5, elements=2}}",
    make: &Of(mixed),
};

/// The kinds of basis for one field.
pub static FIELD: Choice<Either> = Choice {
    name: "field basis",
    path: "basis.axial",
    summary: "functions for one displacement field",
    kinds: &[FINITE_ELEMENTS, MODES_OF_FIELD, RADIAL, POLYNOMIAL, B_SPLINE, BEZIER],
};

/// The kinds of basis.
pub static BASIS: Choice<Either> = Choice {
    name: "basis",
    path: "basis",
    summary: "functions for the axial and transverse displacement",
    kinds: &[FINITE_ELEMENTS, MODES, RADIAL, POLYNOMIAL, B_SPLINE, BEZIER, MIXED],
};
