//! Case files: the only crate that knows every name.
//!
//! ```text
//! text ─▶ tree (spanned TOML) ─▶ values (by the declarations, in SI) ─▶ parts (by the makers) ─▶ systems and runs
//! ```
//!
//! A kind is one entry: its name, an example and the function that makes the part of a model of its [keys](mod@keys). Reading,
//! messages, the listing ([`choices`]), the JSON Schema ([`schema`]) and the resolved case ([`Reading::resolved`]) follow
//! from the entries. Reading runs every maker whose own keys have no problem; what a maker refuses is reported at the
//! key that it names, and what it makes is the part that is used. All problems of a case are reported at once, as
//! [`Problems`].
//!
//! To add a kind: write its code in a file of its own in `flexion`, then one entry in the file of its choice in
//! [`kinds`].

/// The examples of the book.
#[cfg(doctest)]
#[doc = include_str!("../../docs/src/tasks/library.md")]
pub struct Book;

mod blame;
mod case;
pub mod change;
pub mod declaration;
mod driven;
mod edit;
mod fault;
mod features;
mod files;
mod given;
mod hub_beam;
pub mod keys;
mod kind;
pub mod kinds;
mod laws;
mod layout;
mod length;
mod model;
pub mod places;
mod problem;
mod reader;
mod reading;
mod resolved;
mod run;
mod schema;
mod short;
mod sources;
mod space;
mod statics;
mod stations;
mod suggestion;
#[cfg(feature = "sweep")]
pub mod sweep;
mod template;
mod tree;
pub mod units;
mod unused;
mod values;
mod vibration;

pub use case::{Case, Output, Subject};
pub use fault::{Fault, Faults, Made};
pub use files::deck;
pub use flexion::analysis::error::Effort;
pub use given::Given;
pub use hub_beam::HubBeam;
pub use kind::{Choice, Context, Kind, Table};
pub use laws::{Law, Start};
pub use problem::{Place, Problem, Problems, Source};
pub use reading::{Live, Reading, parse, parse_with, read};
pub use run::advise::{Advice, AdviseError, Tried, Trusted, Untried};
pub use run::calculation::{Calculation, Request, Stage};
pub use run::clock::use_clock;
pub use run::quantity::{Collected, Quantity};
pub use run::refine::{RefineError, Refinement, Target};
pub use run::{Prepared, Run, Shown};
pub use schema::schema;
pub use sources::{Contents, Files, Folder, Sources};
pub use space::{Link, Space};
pub use statics::{StaticsError, StaticsRequest};
pub use template::{TEMPLATES, Template};
pub use values::Values;
pub use vibration::{
    Diagram, DiagramRequest, FoundModes, Linear, LinearRequest, ModesRequest, PlaceStiffness, Speed, Speeds,
    VibrationError, Wanted, campbell, moves,
};

/// Every place in a case where a kind is chosen, with the kinds.
pub fn choices() -> &'static [&'static dyn declaration::Kinds] {
    layout::CHOICES
}

/// What stands at the top of a case: keys and tables of a beam on a hub, and of a system in space.
pub fn keys() -> [(&'static str, &'static [declaration::Key]); 2] {
    [("a beam on a hub", layout::keys()), ("a system in space", layout::spatial_keys())]
}

/// Examples of the tables that a case may have and need not: `KEY = VALUE`, as on the command line.
pub fn examples_of_tables() -> Vec<&'static str> {
    use kinds::{beam, body, contact, damping, joint, load, mass, rotation, spring};
    let parts = [body::BODY.example, beam::BEAMS.example, joint::JOINTS.example, beam::FIBRES.example];
    let acting = [mass::MASS.example, spring::SPRING.example, load::LOAD.example, contact::CONTACT.example];
    let others = [damping::DAMPING.example, rotation::ROTATION.example];
    parts.into_iter().chain(acting).chain(others).collect()
}
