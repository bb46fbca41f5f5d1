//! The section of a blade by a file of numbers along its span.

use super::cross_section::Section;
use crate::fault::{At, Fault, Made};
use crate::files;
use crate::keys::{File, boolean, choice, keys, path};
use crate::kind::{Choice, Context, Is, Kind};
use flexion::section;
use std::sync::Arc;

keys! {
    /// What a case says of it.
    pub struct OfBlade {
        /// file of the properties
        file: File = path();
        /// format of the file
        format: files::blade::Format = choice(&FORMAT).or_name("csv");
        /// what couples stretch, bending and torsion in the file is left out: each stiffness is that at zero force of the others
        ignore_coupling: bool = boolean().or_false();
    }
}

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
            example: r#"section={kind="blade", file="blade.csv", format="csv"}"#,
            make: &Is(files::blade::csv as files::blade::Format),
        },
        Kind {
            name: "elastodyn",
            summary: "blade input file of ElastoDyn; without axial stiffness, one of slenderness 100 is taken",
            source: "OpenFAST",
            example: r#"section={kind="blade", file="elastodyn.dat", format="elastodyn"}"#,
            make: &Is(files::blade::elastodyn as files::blade::Format),
        },
        Kind {
            name: "beamdyn",
            summary: "blade input file of BeamDyn; offsets of the mass centre are left out",
            source: "OpenFAST",
            example: r#"section={kind="blade", file="beamdyn.dat", format="beamdyn"}"#,
            make: &Is(files::blade::beamdyn as files::blade::Format),
        },
    ],
};

/// The section of the rows of a file.
pub fn section(OfBlade { file, format, ignore_coupling }: OfBlade, c: &Context<'_>) -> Made<Section> {
    let length = c.length()?;
    let file = files::blade::read(&file.bytes, &file.name, format, length).at("file")?;
    match file.coupled {
        Some(coupled) if !ignore_coupling => {
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
