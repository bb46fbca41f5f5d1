//! The section and the axis of a blade by a deck.

use super::cross_section::Section;
use super::curve::Curve;
use crate::fault::{At, Fault, Made};
use crate::files::deck::{self, Deck, Format};
use crate::keys::{File, choice, integer, keys, path};
use crate::kind::{Choice, Context, Is, Kind};
use flexion::linalg::{Mat3, Vec3};
use flexion::multibody::slender::Station;
use flexion::section::{BladeResultants, BladeSection, Matrices, PlanarProjection};
use flexion::system::Frame;
use std::sync::Arc;

keys! {
    /// What a case says of a deck.
    pub struct OfDeck {
        /// file of the deck; of BeamDyn the primary file, which names that of the sections
        file: File = path();
        /// format of the deck
        format: Format = choice(&FORMAT).or_name("beamdyn");
        /// number of the set of a HAWC2 file, the first if left out
        set: Option<usize> = integer(1, 1000);
        /// number of the subset of a HAWC2 file, the first if left out
        subset: Option<usize> = integer(1, 1000);
    }
}

/// Formats of decks.
pub static FORMAT: Choice<Format> = Choice {
    name: "deck-format",
    path: "section.format",
    summary: "format of a blade deck",
    kinds: &[
        Kind {
            name: "beamdyn",
            summary: "primary file of BeamDyn, which names its blade file",
            source: "OpenFAST",
            example: r#"beam=[{up=[0, 0, 1], section={kind="deck", file="beamdyn_primary.dat", format="beamdyn"}, root="clamped", shear=true}]"#,
            make: &Is(Format::BeamDyn),
        },
        Kind {
            name: "hawc2",
            summary: "structural data (st) of HAWC2, with 6 × 6 stiffness or its classical columns; the axis is straight",
            source: "HAWC2",
            example: r#"beam=[{up=[0, 0, 1], section={kind="deck", file="hawc2.st", format="hawc2", set=1, subset=1}, root="clamped", shear=true}]"#,
            make: &Is(Format::Hawc2 { set: None, subset: None }),
        },
        Kind {
            name: "windio",
            summary: "the blade of a turbine of windIO",
            source: "IEA Wind Task 37 and 55",
            example: r#"beam=[{up=[0, 0, 1], section={kind="deck", file="windio.yaml", format="windio"}, root="clamped", shear=true}]"#,
            make: &Is(Format::WindIo),
        },
        Kind {
            name: "elastodyn",
            summary: "blade file of ElastoDyn: bending alone; the axis is straight, and hardly stretches where the file has no axial stiffness",
            source: "OpenFAST",
            example: r#"beam=[{length=10, up=[0, 0, 1], section={kind="deck", file="elastodyn.dat", format="elastodyn"}, root="clamped"}]"#,
            make: &Is(Format::ElastoDyn { length: None }),
        },
        Kind {
            name: "csv",
            summary: "a table with titles and units: 6 × 6 matrices, or stiffnesses with the places of centres or without; the axis is straight",
            source: "",
            example: r#"beam=[{up=[0, 0, 1], section={kind="deck", file="sections.csv", format="csv"}, root="clamped", shear=true}]"#,
            make: &Is(Format::Csv),
        },
    ],
};

/// The sections of a deck.
#[derive(Clone, Debug)]
struct Sections {
    deck: Arc<Deck>,
    breaks: Vec<f64>,
    /// Whether the axes of the line have the twist in them.
    has_line: bool,
}

impl BladeSection for Sections {
    fn resultants(&self, s: f64) -> BladeResultants {
        // The twist of a deck is about the axis towards the root.
        let line = &self.deck.line;
        let [twist, twist_rate] =
            if self.has_line { [0.0; 2] } else { [-line.twist(s), -line.twist_rate(s)] };
        let [_, flap_inertia, chord_inertia] = self.deck.inertia(s);
        let of = BladeResultants::from(&self.deck.matrices(s));
        let torsional_stiffness = if self.deck.silent.torsion { 0.0 } else { of.torsional_stiffness };
        BladeResultants { torsional_stiffness, flap_inertia, chord_inertia, twist, twist_rate, ..of }
    }

    fn matrices(&self, s: f64) -> Option<Matrices> {
        let (mut of, silent) = (self.deck.matrices(s), self.deck.silent);
        (0..3).filter(|k| silent.inertia[*k]).for_each(|k| of.mass[3 + k][3 + k] = 0.0);
        (!silent.shear).then_some(of)
    }

    fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    fn jumps(&self) -> &[f64] {
        self.deck.table.jumps()
    }
}

/// Whether decks of a format have a line of their own.
fn has_line(format: Format) -> bool {
    matches!(format, Format::BeamDyn | Format::WindIo)
}

/// The section of a deck.
pub fn section(OfDeck { file, format, set, subset }: OfDeck, c: &Context<'_>) -> Made<Section> {
    let format = match format {
        Format::Hawc2 { .. } => Format::Hawc2 { set, subset },
        other => {
            if let Some((key, _)) = [("set", set), ("subset", subset)].iter().find(|(_, n)| n.is_some()) {
                return Err(Fault::new(*key, "belongs to the format `hawc2`").into());
            }
            match other {
                Format::ElastoDyn { .. } => Format::ElastoDyn { length: c.length },
                other => other,
            }
        }
    };
    let find = |name: &str| c.files.bytes(name);
    let deck = Arc::new(deck::read(&find, &file.name, format).at("file")?);
    if let Some(length) = c.length {
        let message = format!(
            "the line of the deck is {:.6} m long, and the length of the beam {length} m",
            deck.length
        );
        if (length - deck.length).abs() > 1e-6 * deck.length {
            return Err(Fault::new("file", message).help("leave the length out").into());
        }
    }
    // Beams may share a deck.
    let mut said = c.cautions.borrow_mut();
    for caution in deck.cautions.iter().chain(&deck.notes) {
        if !said.contains(caution) {
            said.push(caution.clone());
        }
    }
    drop(said);
    let has_line = has_line(format);
    let sections = Sections { breaks: deck.breaks(), deck: Arc::clone(&deck), has_line };
    let spatial = sections.clone();
    Ok(Section {
        spatial: Arc::new(move |_| Ok(Box::new(spatial.clone()))),
        is_blade: true,
        length: Some(deck.length),
        deck: Some((deck, has_line)),
        ..Section::planar(PlanarProjection(sections))
    })
}

/// The axis of a deck with a line of its own whose z is along `tangent` and whose y along `normal`, by its arc length; it begins at the origin.
pub fn curve(deck: &Arc<Deck>, tangent: Vec3, normal: Vec3) -> Curve {
    // The axes x, y, z of the deck: x lies opposite to across.
    let axes = Mat3::columns([normal.cross(tangent), normal, tangent]);
    let deck = Arc::clone(deck);
    let root = deck.frame(0.0).position;
    Arc::new(move |s| {
        let Frame { position, rotation } = deck.frame(s);
        let (tangent, normal) = (axes * rotation.column(0), axes * rotation.column(1));
        Station { position: axes * (position - root), tangent, normal }
    })
}
