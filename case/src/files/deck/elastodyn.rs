//! Blade files of ElastoDyn: stiffnesses about principal axes of a straight blade, without shear and offsets.
//!
//! Read are `BlFract`, `StrcTwst`, `BMassDen`, `FlpStff`, `EdgStff`, and of older files `GJStff`, `EAStff`, `FlpIner`, `EdgIner`; the factors
//! `AdjBlMs`, `AdjFlSt`, `AdjEdSt`. The twist is positive about the axis towards the root. Formats: OpenFAST up to 4
//! (`ElastoDyn_IO.f90`, Apache 2.0).

use super::fortran::{Text, number, words};
use super::{Deck, csv};
use flexion::section::MatrixTable;

/// Slenderness L√(EA/EI) of a blade whose file gives no axial stiffness and which does not stretch in ElastoDyn: its strain moves frequencies by
/// less than 1e-6.
const SLENDERNESS: f64 = 3000.0;
/// The same of a blade of an ordinary size, for what is unlikely of one.
const ORDINARY: f64 = 50.0;

/// Reads a blade file of ElastoDyn for a blade of the length \[m\], without its hub.
///
/// # Errors
/// What is wrong with it.
pub(super) fn read(bytes: &[u8], name: &str, length: Option<f64>) -> Result<Deck, String> {
    let Some(length) = length else {
        return Err(format!(
            "{name} gives its stations as parts of the blade: give the `length` of the beam, without the hub"
        ));
    };
    let text = Text::new(bytes, name);
    let (count, _) = text.count(&["NBlInpSt"], 2, "the number of stations")?;
    let before = |key: &str| -> Result<Option<f64>, String> {
        let Some((line, word)) = text.keyword(&[key]) else { return Ok(None) };
        let number = number(&word);
        number
            .map(Some)
            .ok_or_else(|| format!("line {line} of {name}: `{word}` before `{key}` is not a number"))
    };
    let factor = |key: &str| match before(key)? {
        Some(factor) if !(factor > 0.0) => {
            Err(format!("`{key}` of {name} is {factor}, and must be positive"))
        }
        Some(factor) => Ok(factor),
        None => Err(format!("{name} has no line with `{key}`, a factor of its table")),
    };
    let (mass, flap, edge) = (factor("AdjBlMs")?, factor("AdjFlSt")?, factor("AdjEdSt")?);
    let first =
        |i: &usize| words(text.line(*i)).first().is_some_and(|word| word.eq_ignore_ascii_case("BlFract"));
    let Some(header) = (1..=text.len()).find(first) else {
        return Err(format!("{name} has no line of column names that begins with `BlFract`"));
    };
    let titles = words(text.line(header));
    let place = |title: &str| titles.iter().position(|other| other.eq_ignore_ascii_case(title));
    let needed = |title: &str| place(title).ok_or_else(|| format!("{name} has no column `{title}`"));
    let (station, twist) = (needed("BlFract")?, needed("StrcTwst")?);
    let (density, flapwise, edgewise) = (needed("BMassDen")?, needed("FlpStff")?, needed("EdgStff")?);
    let (stretches, of_axial) = (place("EAStff").is_some(), place("EAStff").unwrap_or_default());
    let (mut rows, mut at) = (Vec::new(), header + 1);
    for number in 1..=count {
        let ends =
            text.next_with_number(at).is_none_or(|line| (at..line).any(|i| text.line(i).starts_with("---")));
        if ends {
            return Err(format!("{name} announces {count} stations and holds {}", number - 1));
        }
        let found = text.numbers(&mut at, titles.len(), &format!("station {number}"))?;
        let (line, row) = (found.line, found.values);
        let optional = |title: &str| place(title).map_or(0.0, |i| row[i]);
        let chord = edge * row[edgewise];
        let axial = if stretches { row[of_axial] } else { chord * (ORDINARY / length).powi(2) };
        let mut of = [0.0; 19];
        (of[0], of[1], of[8]) = (row[station] * length, mass * row[density], -row[twist].to_radians());
        (of[4], of[5]) = (optional("FlpIner"), optional("EdgIner"));
        (of[9], of[12], of[13], of[14]) = (axial, optional("GJStff"), flap * row[flapwise], chord);
        rows.push((line, of));
    }
    let mut cautions = Vec::new();
    if !stretches {
        cautions.push(format!(
            "{name} says no axial stiffness: the blade hardly stretches, as that of ElastoDyn, with EA = {SLENDERNESS}² EI/L² of the \
             edgewise stiffness"
        ));
    }
    let mut damped = Vec::new();
    for key in ["BldFlDmp(1)", "BldFlDmp(2)", "BldEdDmp(1)"] {
        if let Some(ratio) = before(key)?.filter(|ratio| *ratio != 0.0) {
            damped.push(format!("{key} = {ratio} %"));
        }
    }
    if !damped.is_empty() {
        cautions.push(format!(
            "the damping of {name} is of the assumed modes of ElastoDyn and is not used ({}): `damping.stiffness` = 2ζ/ω of the beam damps \
             one of them as much",
            damped.join(", ")
        ));
    }
    let deck = csv::of_centres(name, rows, cautions, !stretches)?;
    if stretches {
        return Ok(deck);
    }
    let mut rows = deck.table.rows().to_vec();
    rows.iter_mut().for_each(|(_, of)| of.stiffness[0][0] *= (SLENDERNESS / ORDINARY).powi(2));
    let table = MatrixTable::new(deck.length, &rows).map_err(|error| format!("{name}: {error}"))?;
    Ok(Deck { table, ..deck })
}

#[cfg(test)]
mod tests {
    use super::*;

    const ELASTODYN: &str = "--- header\ncomment\n--- PARAMETERS\n 2 NBlInpSt - stations\n 3 BldFlDmp(1) - %\n 0 BldFlDmp(2)\n\
        1.5 AdjBlMs - mass\n 1 AdjFlSt -\n2.0D0 AdjEdSt -\n--- DISTRIBUTED\n BlFract StrcTwst BMassDen FlpStff EdgStff\n\
        (-) (deg) (kg/m) (Nm^2) (Nm^2)\n0.0 13.308 678.9 1.8E+10 1.9D+10\n1.0 0.0 10.0 2e5 5e6\n--- MODE SHAPES\n0.06 BldFl1Sh(2)\n";

    fn read(text: &str) -> Result<Deck, String> {
        super::read(text.as_bytes(), "f", Some(50.0))
    }

    #[test]
    fn an_elastodyn_file_is_read_with_its_factors() {
        let found = read(ELASTODYN).unwrap();
        let root = found.matrices(0.0);
        assert!((root.mass[0][0] - 1018.35).abs() < 1e-9 && root.stiffness[4][4] == 1.8e10, "{root:?}");
        assert!(root.stiffness[5][5] == 3.8e10 && (root.stiffness[0][0] / 1.368e14 - 1.0).abs() < 1e-12);
        // The line's twist is about the axis towards the root.
        assert!((found.line.twist(0.0) - 0.232_268_4).abs() < 1e-6 && found.length == 50.0);
        assert!(found.silent.shear && found.silent.torsion && found.silent.inertia == [true; 3]);
        assert!(
            found.cautions.iter().any(|caution| caution.contains("(BldFlDmp(1) = 3 %)")),
            "{:?}",
            found.cautions
        );
        for (from, to, says) in [
            (" 2 NBlInpSt", " 3 NBlInpSt", "announces 3 stations and holds 2"),
            (" 2 NBlInpSt", " 0 NBlInpSt", "a whole number of at least 2"),
            (" 2 NBlInpSt", " 2 Stations", "no line with `NBlInpSt`"),
            ("FlpStff", "FlapStff", "no column `FlpStff`"),
            ("678.9", "67x8", "line 13 of f: `67x8`"),
            (" 5e6", "", "station 2"),
            ("1.5 AdjBlMs", "-1.5 AdjBlMs", "must be positive"),
            ("1.5 AdjBlMs - mass\n", "", "no line with `AdjBlMs`"),
            ("2.0D0 AdjEdSt -\n", "", "no line with `AdjEdSt`"),
            ("1.8E+10", "-1.8E+10", "the bending stiffness flapwise"),
        ] {
            let message = read(&ELASTODYN.replacen(from, to, 1)).unwrap_err();
            assert!(message.contains(says), "{message}");
        }
    }
}
