//! Springs and dampers: along the line between two points, or towards one point in all directions.

use super::name::{NAME, name};
use crate::declaration::Bound::*;
use crate::fault::{Fault, Made};
use crate::keys::{choice, keys, place, quantity, texts, vector};
use crate::kind::{Choice, Context, Is, Kind, Of, Table};
use crate::places::Place;
use crate::units::{DAMPING, FORCE_PER_LENGTH, LENGTH};
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
type Make = fn(&Written, &Context<'_>) -> Made<Joins>;

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
            example: "spring=[{kind='point', on='tip', stiffness='200 N/m', damping='2 N s/m', to=['2.1 m', 0]}]",
            make: &Is(point as Make),
        },
        Kind {
            name: "line",
            summary: "two parts, `between`, with a force along the line from one point to the other",
            source: "",
            example: "spring=[{kind='line', between=['ground', 'bar'], from=[0, 0, '1 m'], to=[1, 0, 0], stiffness='200 N/m'}]",
            make: &Is(line as Make),
        },
    ],
};

/// The two places of these names, which a table joins.
pub(super) fn between(names: &[String], c: &Context<'_>) -> Made<[Place; 2]> {
    let parts = c.parts()?;
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
fn without(written: &[(bool, &str)], kind: &str, other: &str) -> Made<()> {
    let Some((_, key)) = written.iter().find(|(written, _)| *written) else { return Ok(()) };
    let message = format!("is a key of a spring of the kind `{other}`, and this one is of the kind `{kind}`");
    Err(Fault::new(*key, message).into())
}

/// That a key is missing.
fn missing(key: &str, kind: &str) -> Fault {
    Fault::new("", format!("a spring of the kind `{kind}` needs `{key}`"))
}

fn point(k: &Written, _: &Context<'_>) -> Made<Joins> {
    let of_line =
        [(k.between.is_some(), "between"), (k.from.is_some(), "from"), (k.length.is_some(), "length")];
    without(&of_line, "point", "line")?;
    let on = k.on.ok_or_else(|| missing("on", "point"))?;
    Ok(Joins::Point { on, to: k.to.ok_or_else(|| missing("to", "point"))? })
}

fn line(k: &Written, c: &Context<'_>) -> Made<Joins> {
    without(&[(k.on.is_some(), "on")], "line", "point")?;
    let names = k.between.as_ref().ok_or_else(|| missing("between", "line"))?;
    Ok(Joins::Line { between: between(names, c)?, ends: [k.from, k.to], length: k.length })
}

keys! {
    /// What a case says of a spring.
    pub struct Written {
        name: Option<String> = NAME;
        /// parts that it joins
        kind: Make = choice(&SPRING_KIND);
        /// station of a beam, of a spring of the kind `point`
        on: Option<(usize, f64)> = place();
        /// the two parts, of a spring of the kind `line`
        between: Option<Vec<String>> = texts();
        /// point of space where it is fixed to the first part at the start; the part's own if left out
        from: Option<Vec3> = vector(&LENGTH);
        /// the same of the second part; of the kind `point`, the point fixed in space
        to: Option<Vec3> = vector(&LENGTH);
        /// stiffness k
        stiffness: f64 = quantity(&FORCE_PER_LENGTH, NotNegative);
        /// force over velocity, c: over the rate of the length in the kind `line`
        damping: f64 = quantity(&DAMPING, NotNegative).or(0.0);
        /// length without force, that at the start if left out, of the kind `line`
        length: Option<f64> = quantity(&LENGTH, NotNegative);
    }
}

/// The tables `[[spring]]`.
pub static SPRING: Table<Spring> = Table::list(
    "spring",
    "springs and dampers",
    "spring=[{name='cord', kind='point', on='tip', stiffness='200 N/m', damping='2 N s/m', to=['2.1 m', 0]}]",
    &Of(|k: Written, c| {
        let joins = (k.kind)(&k, c)?;
        Ok(Spring { name: name(k.name, &[])?, stiffness: k.stiffness, damping: k.damping, joins })
    }),
);
