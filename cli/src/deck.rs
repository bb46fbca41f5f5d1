//! `flexion deck`: a beam of a case as a blade deck of another program.

use crate::screen::row;
use crate::vibration::report;
use crate::{Outcome, case, screen};
use flexion::linalg::Vec3;
use flexion_case::kinds::beam::{Beam, End};
use flexion_case::{Reading, deck};
use flexion_results::{Artifact, Directory};
use std::path::PathBuf;

/// Difference between stations from which on it is said: parts, and angles [rad].
const SAID: f64 = 1e-6;

/// The case, the beam and the program.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  flexion deck verification/space_blade --format hawc2 --output results/deck
  flexion deck verification/space_twisted --format beamdyn --output results/deck --set beam.elements=64

The deck has the stations of the deck that the beam is of, or else one where each element ends; between them sections are linear: what that
makes of the beam is printed, and more elements make it less. What the format does not say is printed too.

Exit codes: 0 written, 1 case or command line rejected, 2 the files could not be written.")]
pub struct Arguments {
    #[command(flatten)]
    case: case::Selection,
    /// Program for which the deck is
    #[arg(long, value_enum, value_name = "FORMAT")]
    format: Format,
    /// Name of the beam, where the case has several
    #[arg(long, value_name = "NAME")]
    beam: Option<String>,
    /// Directory for the files
    #[arg(long, short, value_name = "DIR")]
    output: PathBuf,
    /// Replace a former deck of this format in that directory
    #[arg(long)]
    force: bool,
}

/// A program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Format {
    /// Primary and blade file of BeamDyn
    #[value(name = "beamdyn")]
    BeamDyn,
    /// A st file of HAWC2 with full matrices
    #[value(name = "hawc2")]
    Hawc2,
}

/// Writes a deck.
pub fn deck(arguments: &Arguments) -> Outcome {
    let Some(reading) = arguments.case.read() else { return Outcome::Rejected };
    match written(arguments, &reading) {
        Ok(true) => Outcome::Finished,
        Ok(false) => Outcome::Incomplete,
        Err(message) => {
            report(&message);
            Outcome::Rejected
        }
    }
}

/// Whether the deck is written; an error is one of the case.
fn written(arguments: &Arguments, reading: &Reading) -> Result<bool, String> {
    let Some(space) = reading.case.space() else {
        return Err(
            "decks are of beams in space, and the case is of a beam in the plane: compute it in space by \
                    --set model.coupling=space"
                .to_owned(),
        );
    };
    let names =
        || space.beams.iter().map(|(beam, _)| format!("`{}`", beam.name)).collect::<Vec<_>>().join(", ");
    let (beam, built) = match (&arguments.beam, &space.beams[..]) {
        (None, [only]) => only,
        (None, []) => return Err("the case has no beam".to_owned()),
        (None, _) => return Err(format!("the case has several beams: name one of {} by --beam", names())),
        (Some(name), all) => all
            .iter()
            .find(|(beam, _)| beam.name == *name)
            .ok_or_else(|| format!("the case has no beam `{name}`; it has {}", names()))?,
    };
    let straight = arguments.format == Format::Hawc2;
    let ends: Vec<f64> = (0..=built.elements()).map(|i| built.end(i)).collect();
    let (made, between) = beam.deck(&ends, straight)?;
    let title = format!("{}: beam {}", reading.case.title, beam.name);
    let title: String = title.trim_start_matches(": ").split_whitespace().collect::<Vec<_>>().join(" ");
    let mut left_out = [0.0; 2];
    let (own, texts) = match arguments.format {
        Format::BeamDyn => {
            let texts = deck::write_beamdyn(&made, &title, &Artifact::BeamDynBlade.file_name())?;
            (Artifact::BEAMDYN, texts.to_vec())
        }
        Format::Hawc2 => {
            let (text, of_inertia) = deck::write_hawc2(&made, &title);
            left_out = of_inertia;
            (Artifact::HAWC2, vec![text])
        }
    };
    let directory = Directory::create_for(own, &arguments.output, arguments.force, &reading.inputs())
        .map_err(|error| error.to_string())?;
    let write = |(artifact, text): (&Artifact, &String)| {
        directory.write(*artifact, |to| to.write_all(text.as_bytes()))
    };
    let result = own.iter().zip(&texts).try_for_each(write).and_then(|()| directory.publish());
    let whole = screen::files(&directory, result, &own.iter().map(|of| ("deck", *of)).collect::<Vec<_>>());
    if !whole {
        return Ok(false);
    }
    let (mass, _) = made.mass();
    let mut rows = vec![
        row("beam", format!("{}, {:.6} m, {mass:.6} kg", beam.name, made.length)),
        row("stations", made.table.rows().len().to_string()),
    ];
    if between.section.max(between.place).max(between.turn) > SAID {
        let more =
            if beam.section.deck.is_some() { "" } else { ": more `elements` of the beam make that less" };
        let line = if straight {
            String::new()
        } else {
            format!(
                ", its place by {:.1e} of the length, its axes by {:.1e}°",
                between.place,
                between.turn.to_degrees()
            )
        };
        let text = format!("an entry of a section is off by up to {:.1e}{line}{more}", between.section);
        rows.push(row("between stations", text));
    }
    rows.extend(beam.not_in_deck(straight).into_iter().map(|what| row("not written", what)));
    let of_inertia = [
        "the product of inertia about the axes of bending",
        "what the polar moment of inertia has beside their sum",
    ];
    for (what, part) in of_inertia.into_iter().zip(left_out).filter(|(_, part)| *part > SAID) {
        rows.push(row(
            "not written",
            format!("{what}, up to {part:.1e} of the sum of both moments: a st file has no column for it"),
        ));
    }
    screen::print(&format!("{}\n{}", screen::table(&rows), again(beam, arguments.format)));
    Ok(true)
}

/// The table of a case that has this deck in the place of the beam.
fn again(beam: &Beam, format: Format) -> String {
    let (axes, root) = (beam.axes(), beam.frame(0.0).position);
    let list = |of: Vec3| {
        // Cosines have no more digits.
        let numbers = of.0.map(|x| ((x * 1e15).round() / 1e15 + 0.0).to_string());
        format!("[{}]", numbers.join(", "))
    };
    let (name, file) = match format {
        Format::BeamDyn => ("beamdyn", Artifact::BeamDynPrimary.file_name()),
        Format::Hawc2 => ("hawc2", Artifact::Hawc2Sections.file_name()),
    };
    let hold = |(key, end): (&str, &End)| match end {
        End::Free => String::new(),
        End::Clamped => format!("{key} = \"clamped\"\n"),
        End::Hinged => format!("{key} = \"hinged\"\n"),
    };
    let held: String = ["root", "tip"].into_iter().zip(&beam.ends).map(hold).collect();
    format!(
        "[[beam]]\nname = \"{}\"\nstart = {}\ndirection = {}\nup = {}\n{held}shear = true\nsection = {{ kind = \"deck\", file = \"{file}\", format = \"{name}\" }}\n",
        beam.name,
        list(root),
        list(axes.column(2)),
        list(axes.column(1))
    )
}
