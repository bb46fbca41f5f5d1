//! Springs and dampers: along the line between two points, or towards one point in all directions.

use super::mass::station;
use super::name::{NAME, name};
use super::vector::optional_vector;
use crate::declaration::{Bound::*, Key, Presence as Default, Presence::*, Type, Type::Quantity, key};
use crate::fault::{Fault, Made, both};
use crate::kind::{Choice, Context, Kind, Table};
use crate::places::Place;
use crate::units::{DAMPING, FORCE_PER_LENGTH, LENGTH};
use crate::values::Values;
use flexion::linalg::Vec3;

/// A spring and a damper.
#[derive(Clone, Debug)]
pub struct Spring {
    /// Name; empty where none is given.
    pub name: String,
    /// Stiffness \[N/m\].
    pub stiffness: f64,
    /// Damping [N·s/m].
    pub damping: f64,
    /// What it joins.
    pub joins: Joins,
}

/// What a spring joins.
#[derive(Clone, Debug)]
pub enum Joins {
    /// A station of a beam and a point fixed in space: F = k (x₀ − x) − c ẋ.
    Point {
        /// Number of the beam, and arc length \[m\].
        on: (usize, f64),
        /// The point \[m\].
        to: Vec3,
    },
    /// Two points, with a force along the line between them.
    Line {
        /// The parts.
        between: [Place; 2],
        /// Points of space where its ends are fixed at the start \[m\].
        ends: [Option<Vec3>; 2],
        /// Length without force \[m\], that at the start where none is given.
        length: Option<f64>,
    },
}

/// Makes what a spring joins.
type Make = fn(&Values, &Context<'_>) -> Made<Joins>;

/// The kinds of spring.
pub static SPRING_KIND: Choice<Make> = Choice {
    name: "spring",
    path: "spring.kind",
    summary: "what a spring joins",
    kinds: &[
        Kind {
            name: "point",
            summary: "the station `on` of a beam and the point `to` fixed in space, with the same stiffness and damping in all \
                      directions and no force where both coincide",
            source: "",
            keys: &[],
            example: "spring=[{kind='point', on='tip', stiffness='200 N/m', damping='2 N s/m', to=['2.1 m', 0]}]",
            make: |_, _| Ok(point as Make),
        },
        Kind {
            name: "line",
            summary: "two parts, `between`, with a force along the line from one point to the other",
            source: "",
            keys: &[],
            example: "spring=[{kind='line', between=['ground', 'bar'], from=[0, 0, '1 m'], to=[1, 0, 0], stiffness='200 N/m'}]",
            make: |_, _| Ok(line as Make),
        },
    ],
};

/// The two places that a table joins.
pub(super) fn between(v: &Values, c: &Context<'_>) -> Made<[Place; 2]> {
    let (names, parts) = (v.texts("between")?, c.parts()?);
    let [a, b] = names else {
        let message = format!("takes two parts, not {}", names.len());
        let help = "write for example `between = [\"ground\", \"hub\"]`";
        return Err(Fault::new("between", message).help(help).into());
    };
    let find = |name: &String| {
        let place = parts.find(name).map_err(|fault| Fault { key: "between".to_owned(), ..fault })?;
        if let Place::Beam(i) = place {
            let name = &parts.beams[i].0;
            let fault =
                Fault::new("between", format!("`{name}` is a whole beam, and a place of it is meant"));
            return Err(fault.help(format!("write `{name}.root`, `{name}.tip` or `{name}@… m`")));
        }
        Ok(place)
    };
    let [a, b] = [find(a)?, find(b)?];
    if a == b {
        return Err(Fault::new("between", "both parts are the same").into());
    }
    Ok([a, b])
}

/// Refuses keys that a spring of this kind does not have.
fn without(v: &Values, keys: &[&str], kind: &str) -> Made<()> {
    for key in keys {
        if v.is_written(key) {
            let other = if kind == "point" { "line" } else { "point" };
            let message =
                format!("is a key of a spring of the kind `{other}`, and this one is of the kind `{kind}`");
            return Err(Fault::new(*key, message).into());
        }
    }
    Ok(())
}

/// That a key is missing.
fn missing(key: &str, kind: &str) -> Fault {
    Fault::new("", format!("a spring of the kind `{kind}` needs `{key}`"))
}

fn point(v: &Values, c: &Context<'_>) -> Made<Joins> {
    without(v, &["between", "from", "length"], "point")?;
    if v.optional("on")?.is_none() {
        return Err(missing("on", "point").into());
    }
    let (on, to) = both(station(v, "on", c), optional_vector(v, "to"))?;
    Ok(Joins::Point { on, to: to.ok_or_else(|| missing("to", "point"))? })
}

fn line(v: &Values, c: &Context<'_>) -> Made<Joins> {
    without(v, &["on"], "line")?;
    if v.optional("between")?.is_none() {
        return Err(missing("between", "line").into());
    }
    let ends = [optional_vector(v, "from")?, optional_vector(v, "to")?];
    Ok(Joins::Line { between: between(v, c)?, ends, length: v.optional_number("length")? })
}

const fn place(name: &'static str, doc: &'static str) -> Key {
    key(name, Type::Quantities(&LENGTH, Any), Empty, doc)
}

/// The tables `[[spring]]`.
pub static SPRING: Table<Spring> = Table {
    key: key(
        "spring",
        Type::Tables(&[
            NAME,
            key("kind", Type::Choice(&SPRING_KIND), Required, "what it joins"),
            key("on", Type::Place, Optional, "station of a beam, of a spring of the kind `point`"),
            key("between", Type::Texts, Optional, "the two parts, of a spring of the kind `line`"),
            place(
                "from",
                "point of space where it is fixed to the first part at the start; the part's own if left out",
            ),
            place("to", "the same of the second part; of the kind `point`, the point fixed in space"),
            key("stiffness", Quantity(&FORCE_PER_LENGTH, NotNegative), Required, "stiffness k"),
            key(
                "damping",
                Quantity(&DAMPING, NotNegative),
                Default::Number(0.0),
                "force over velocity, c: over the rate of the length in the kind `line`",
            ),
            key(
                "length",
                Quantity(&LENGTH, NotNegative),
                Optional,
                "length without force, that at the start if left out, of the kind `line`",
            ),
        ]),
        Empty,
        "springs and dampers",
    ),
    example: "spring=[{name='cord', kind='point', on='tip', stiffness='200 N/m', damping='2 N s/m', to=['2.1 m', 0]}]",
    make: |v, c| {
        let joins = SPRING_KIND.make(v, "kind", c)?(v, c)?;
        let (name, stiffness, damping) = (name(v, &[])?, v.number("stiffness")?, v.number("damping")?);
        Ok(Spring { name, stiffness, damping, joins })
    },
};
