//! Decks of BeamDyn: a primary file with the keypoints of the line, and a blade file with the sections.
//!
//! The line is a natural cubic spline in z through the keypoints and the twist linear in z between them; OpenFAST fits a polynomial instead. The
//! stations η are fractions of z, which is what OpenFAST does for a blade of one member, and not of the arc length, as its manual says.
//! Formats: OpenFAST 4 and 5 (`BeamDyn_IO.f90`, Apache 2.0).

use super::fortran::{Text, number};
use super::rows::{BEAMDYN, Row};
use super::{Deck, FARTHEST, Find, Keypoints, Line, Raw, Silent, TURNED, within};
use flexion::linalg::Vec3;
use flexion::section::Matrix6;
use std::fmt::Write;

/// Settings of the mesh and the steps of BeamDyn.
const SETTINGS: [&str; 11] = [
    "rhoinf",
    "quadrature",
    "refine",
    "n_fact",
    "DTBeam",
    "load_retries",
    "NRMax",
    "stop_tol",
    "tngt_stf_pert",
    "tngt_stf_difftol",
    "order_elem",
];
/// Distance of the first and the last station from 0 and 1.
const ENDS: f64 = 1e-4;
/// Distance of the first keypoint from the origin over that of the last, up to which it is rounding.
const ROOT: f64 = 1e-9;
/// Longest damping time \[s\].
pub(super) const LONGEST: f64 = 1e6;

/// Reads the deck of a primary file and the blade file that it names.
pub(super) fn read(find: Find<'_>, name: &str) -> Result<Deck, String> {
    let bytes = find(name)?;
    let text = Text::new(&bytes, name);
    if text.keyword(&["kp_total"]).is_none() && text.keyword(&["station_total"]).is_some() {
        return Err(format!(
            "{name} is a blade file of BeamDyn and has no reference line: give the primary file that names it as `BldFile`"
        ));
    }
    let notes = vec![settings(&text)?];
    let mut cautions = Vec::new();
    let points = keypoints(&text, &mut cautions)?;
    let Some((line, file)) = text.keyword(&["BldFile"]) else {
        return Err(format!("{name} has no line with `BldFile`, the name of the blade file"));
    };
    let file = beside(name, &file);
    let bytes = find(&file).map_err(|error| format!("line {line} of {name}, `BldFile`: {error}"))?;
    let text = Text::new(&bytes, &file);
    let (rows, damping) = stations(&text, [points[0].1[2], points[points.len() - 1].1[2]], &mut cautions)?;
    let places: Vec<(f64, Vec3)> = points.iter().map(|(_, place, _)| (place[2], *place)).collect();
    let twist: Vec<[f64; 2]> =
        points.iter().map(|(_, place, twist)| [place[2], twist.to_radians()]).collect();
    let line = Line::through(&places, &twist).map_err(|error| format!("{name}: {error}"))?;
    let keypoints = Keypoints {
        name: name.to_owned(),
        points: points.iter().map(|(line, place, _)| (*line, *place)).collect(),
        twist: points.iter().map(|(line, place, twist)| (*line, place[2], *twist)).collect(),
    };
    let silent = Silent::default();
    Raw { name: &file, convention: &BEAMDYN, line, keypoints, rows, damping, cautions, notes, silent }.deck()
}

/// The name of the blade file that the text of a primary file names.
pub fn blade_file(bytes: &[u8], name: &str) -> Option<String> {
    Text::new(bytes, name).keyword(&["BldFile"]).map(|(_, file)| beside(name, &file))
}

/// The text of a primary file with another name for its blade file.
pub fn with_blade_file(bytes: &[u8], file: &str) -> String {
    let text = Text::new(bytes, "");
    let line = text.keyword(&["BldFile"]).map(|(line, _)| line);
    let lines = (1..=text.len()).map(|i| match line {
        Some(line) if line == i => {
            format!("\"{file}\"    BldFile - Name of file containing properties for blade\n")
        }
        _ => format!("{}\n", text.line(i)),
    });
    lines.collect()
}

/// The name of a file that is written in another.
fn beside(name: &str, file: &str) -> String {
    let file = file.replace('\\', "/");
    let absolute = file.starts_with('/') || file.chars().nth(1) == Some(':');
    match name.rfind(['/', '\\']) {
        Some(at) if !absolute => format!("{}{file}", &name[..=at]),
        _ => file,
    }
}

/// A sentence of the settings that are not used.
fn settings(text: &Text<'_>) -> Result<String, String> {
    let name = text.name;
    let mut found = Vec::new();
    for key in SETTINGS {
        let Some((line, value)) = text.keyword(&[key]) else { continue };
        let is_default = value.get(..7).is_some_and(|word| word.eq_ignore_ascii_case("default"));
        if !is_default && !number(&value).is_some_and(|x| x >= 0.0) {
            return Err(format!(
                "line {line} of {name}: `{key}` is a number, not negative, or DEFAULT, and not `{value}`"
            ));
        }
        found.push(format!("{key} {value}"));
    }
    if let Some((_, value)) = text.keyword(&["UsePitchAct"])
        && value.trim_start_matches('.').starts_with(['T', 't'])
    {
        found.push("the pitch actuator".to_owned());
    }
    Ok(format!(
        "{name}: settings of BeamDyn's own mesh, steps and actuator are not used: {}",
        found.join(", ")
    ))
}

/// Line, place and twist \[°\] of the keypoints.
fn keypoints(text: &Text<'_>, cautions: &mut Vec<String>) -> Result<Vec<(usize, Vec3, f64)>, String> {
    let name = text.name;
    let (members, line) = text.count(&["member_total"], 1, "the number of members")?;
    if members != 1 {
        return Err(format!(
            "line {line} of {name}: `member_total` is {members}: a line of several members, with kinks between them, is not read; join the \
             keypoints into one member"
        ));
    }
    let (count, line) = text.count(&["kp_total"], 3, "the number of keypoints")?;
    let mut at = line + 1;
    let member = text.numbers(&mut at, 2, "the number of the member and of its keypoints")?;
    if member.values[1] != count as f64 {
        return Err(format!(
            "line {} of {name}: the one member has {} keypoints and `kp_total`, in line {line}, is {count}",
            member.line, member.values[1]
        ));
    }
    let mut points: Vec<(usize, Vec3, f64)> = Vec::new();
    for number in 1..=count {
        let what = format!("keypoint {number} of {count}: x, y, z, twist");
        let found = if number == 1 { text.numbers(&mut at, 4, &what)? } else { text.row(&mut at, 4, &what)? };
        if found.surplus > 0 {
            cautions.push(format!(
                "line {} of {name}: keypoint {number} has {} numbers, of which x, y, z and twist are read",
                found.line,
                4 + found.surplus
            ));
        }
        let [x, y, z, twist] = found.values[..] else { continue };
        for (value, most, what) in [
            (x, FARTHEST, "kp_xr"),
            (y, FARTHEST, "kp_yr"),
            (z, FARTHEST, "kp_zr"),
            (twist, TURNED, "initial_twist"),
        ] {
            within(found.line, name, what, value, most)?;
        }
        if let Some((_, before, _)) = points.last()
            && !(z > before[2])
        {
            return Err(format!(
                "line {} of {name}: kp_zr of keypoint {number} is {z} m and that before it {} m; keypoints ascend along z",
                found.line, before[2]
            ));
        }
        points.push((found.line, Vec3([x, y, z]), twist));
    }
    let origin = ROOT * points.last().map_or(0.0, |(_, place, _)| place.norm());
    if let Some((line, root, _)) = points.first().filter(|(_, place, _)| place.norm() > origin) {
        return Err(format!(
            "line {line} of {name}: the first keypoint is at ({}, {}, {}) m and must be at the origin, which is the root of the blade, as OpenFAST demands: take \
             its coordinates off those of all keypoints, and add them to the `start` of the beam",
            root[0], root[1], root[2]
        ));
    }
    if let Some(next) =
        text.next_with_number(at).filter(|next| text.numbers(&mut { *next }, 4, "").is_ok() && *next == at)
    {
        return Err(format!(
            "line {next} of {name}: there are more keypoints than the {count} of `kp_total`"
        ));
    }
    Ok(points)
}

/// The stations of a blade file, and the damping times \[s\] in its order; `ends` are z of the first and the last keypoint.
fn stations(
    text: &Text<'_>,
    ends: [f64; 2],
    cautions: &mut Vec<String>,
) -> Result<(Vec<Row>, Option<[f64; 6]>), String> {
    let name = text.name;
    let (count, _) = text.count(&["station_total"], 2, "the number of stations")?;
    let (damped, line) = text.count(&["damp_type", "damp_flag"], 0, "the kind of damping")?;
    if damped > 1 {
        return Err(format!(
            "line {line} of {name}: `damp_type` is {damped}; 0, no damping, and 1, in proportion to the stiffness by mu, are read"
        ));
    }
    let mut at = line + 1;
    let found = text.numbers(&mut at, 6, "mu1 to mu6")?;
    if let Some(k) = found.values.iter().position(|mu| !(0.0..=LONGEST).contains(mu)) {
        return Err(format!(
            "line {} of {name}: mu{} = {:e} s is negative or longer than {LONGEST:e} s",
            found.line,
            k + 1,
            found.values[k]
        ));
    }
    // OpenFAST 5 has the ratios of modal damping behind them, for damp_type 2.
    if let Some((line, _)) = text.keyword(&["n_modes"]) {
        let (modes, _) = text.count(&["n_modes"], 0, "the number of modes")?;
        at = line + 1;
        if modes > 0 {
            text.numbers(&mut at, modes, "zeta of the modes")?;
        } else if text.keyword(&["zeta"]).is_some_and(|(zeta, _)| zeta == at) {
            at += 1;
        }
    }
    let damping = (damped == 1).then(|| std::array::from_fn(|k| found.values[k]));
    let mut rows: Vec<Row> = Vec::new();
    for number in 1..=count {
        let found = text.numbers(&mut at, 1, &format!("the place of station {number} of {count}"))?;
        let eta = found.values[0];
        if found.surplus > 0 {
            return Err(format!(
                "line {} of {name} has {} numbers where station {number} has its place alone: is a row of a matrix too much before it?",
                found.line,
                1 + found.surplus
            ));
        }
        if let Some(before) = rows.last().map(|row| row.written)
            && !(eta >= before)
        {
            return Err(format!(
                "line {} of {name}: station {number} is at eta = {eta} and that before it at {before}; stations ascend from 0 to 1",
                found.line
            ));
        }
        let mut lines = [[0; 6]; 2];
        let mut matrices = [[[0.0; 6]; 6]; 2];
        for (matrix, letter) in [(0, "stiffness"), (1, "mass")] {
            for i in 0..6 {
                let what = format!("row {} of the {letter} matrix of station {number}", i + 1);
                // A comment may stand between the two matrices.
                let is_free = (matrix, i) == (1, 0);
                let row =
                    if is_free { text.numbers(&mut at, 6, &what)? } else { text.row(&mut at, 6, &what)? };
                if row.surplus >= 6 {
                    return Err(format!(
                        "line {} of {name} has {} numbers for {what}, which has six: write decimals with a point, for a comma separates numbers",
                        row.line,
                        6 + row.surplus
                    ));
                }
                if row.surplus > 0 {
                    cautions.push(format!(
                        "line {} of {name} has {} numbers for {what}, of which six are read",
                        row.line,
                        6 + row.surplus
                    ));
                }
                lines[matrix][i] = row.line;
                matrices[matrix][i].copy_from_slice(&row.values);
            }
        }
        let [stiffness, mass] = matrices;
        rows.push(Row {
            number,
            written: eta,
            place: ends[0] + eta * (ends[1] - ends[0]),
            lines,
            stiffness,
            mass,
        });
    }
    let (first, last) = (rows[0].written, rows[count - 1].written);
    if !(first.abs() <= ENDS && (last - 1.0).abs() <= ENDS) {
        let length = ends[1] - ends[0];
        let guess = if (last - 100.0).abs() < 1.0 {
            ": are they in per cent?"
        } else if (last - length).abs() < 0.1 * length {
            ": are they in metres?"
        } else {
            ""
        };
        return Err(format!(
            "the stations of {name} run from eta = {first} to {last}, and must run from 0 to 1, as fractions of the length along z{guess}"
        ));
    }
    rows[0].place = ends[0];
    rows[count - 1].place = ends[1];
    if let Some(next) = text.next_with_number(at) {
        cautions.push(format!(
            "line {next} of {name}: what follows the {count} stations of `station_total` is not read"
        ));
    }
    Ok((rows, damping))
}

/// A row of numbers.
fn line_of(values: &[f64]) -> String {
    values.iter().map(|x| format!("{x:20.12e}")).collect::<Vec<_>>().join(" ")
}

/// The primary file and the blade file, which the former calls `blade`, of a deck.
///
/// # Errors
/// Where z does not ascend along the line, for BeamDyn's keypoints do.
pub fn write(deck: &Deck, title: &str, blade: &str) -> Result<[String; 2], String> {
    let mut ends = vec![0.0];
    ends.extend(deck.line.breaks());
    ends.push(deck.length);
    if ends.len() == 2 {
        ends.insert(1, 0.5 * deck.length);
    }
    let root = deck.frame(0.0).position;
    let mut points = Vec::with_capacity(ends.len());
    for s in ends {
        let place = deck.frame(s).position - root;
        if points.last().is_some_and(|before: &[f64; 4]| !(place[2] > before[2])) {
            return Err(format!(
                "z of the line does not ascend at {s:.4} m along it: BeamDyn has no keypoints for it"
            ));
        }
        points.push([place[0], place[1], place[2], deck.line.twist(s).to_degrees()]);
    }
    let (from, to) = (points[0][2], points[points.len() - 1][2]);
    let keypoints: Vec<String> = points.iter().map(|point| line_of(point)).collect();
    let primary = PRIMARY
        .replace("{title}", title)
        .replace("{count}", &points.len().to_string())
        .replace("{keypoints}", &keypoints.join("\n"))
        .replace("{blade}", blade);
    let rows = deck.table.rows();
    let times = deck.damping.map_or([0.0; 6], |times| {
        let mut out = [0.0; 6];
        (0..6).for_each(|k| out[BEAMDYN.place[k]] = times[k]);
        out
    });
    let mut stations = String::new();
    let matrix =
        |of: &Matrix6| BEAMDYN.outward(of).iter().map(|row| line_of(row)).collect::<Vec<_>>().join("\n");
    for (s, section) in rows {
        let eta = (deck.frame(*s).position[2] - root[2] - from) / (to - from);
        // Writing to a string cannot fail.
        let _ =
            write!(stations, "{eta:.15}\n{}\n\n{}\n\n", matrix(&section.stiffness), matrix(&section.mass));
    }
    let blade = BLADE
        .replace("{title}", title)
        .replace("{count}", &rows.len().to_string())
        .replace("{damped}", if deck.damping.is_some() { "1" } else { "0" })
        .replace("{mu}", &line_of(&times))
        .replace("{stations}", &stations);
    Ok([primary, blade])
}

const PRIMARY: &str = r#"--------- BEAMDYN with OpenFAST INPUT FILE -------------------------------------------
{title}
---------------------- SIMULATION CONTROL --------------------------------------
False         Echo             - Echo input data (flag)
True          QuasiStaticInit  - Use quasi-static pre-conditioning in initialization (flag)
          0   rhoinf           - Numerical damping parameter for generalized-alpha integrator
          2   quadrature       - Quadrature method: 1=Gaussian; 2=Trapezoidal (switch)
"DEFAULT"     refine           - Refinement factor for trapezoidal quadrature (-)
"DEFAULT"     n_fact           - Factorization frequency for the Jacobian (-)
"DEFAULT"     DTBeam           - Time step size (s)
"DEFAULT"     load_retries     - Number of factored load retries before quitting
"DEFAULT"     NRMax            - Max number of iterations in Newton-Raphson algorithm (-)
"DEFAULT"     stop_tol         - Tolerance for stopping criterion (-)
"DEFAULT"     tngt_stf_fd      - Use finite differenced tangent stiffness matrix? (flag)
"DEFAULT"     tngt_stf_comp    - Compare analytical finite differenced tangent stiffness matrix? (flag)
"DEFAULT"     tngt_stf_pert    - Perturbation size for finite differencing (-)
"DEFAULT"     tngt_stf_difftol - Maximum allowable relative difference between analytical and fd tangent stiffness (-)
True          RotStates        - Orient states in the rotating frame during linearization? (flag)
---------------------- GEOMETRY PARAMETER --------------------------------------
          1   member_total     - Total number of members (-)
         {count}   kp_total         - Total number of key points (-)
     1     {count}                 - Member number; Number of key points in this member
   kp_xr  kp_yr  kp_zr  initial_twist
   (m)    (m)    (m)    (deg)
{keypoints}
---------------------- MESH PARAMETER ------------------------------------------
          5   order_elem       - Order of interpolation (basis) function (-)
---------------------- MATERIAL PARAMETER --------------------------------------
"{blade}"    BldFile - Name of file containing properties for blade (quoted string)
---------------------- PITCH ACTUATOR PARAMETERS -------------------------------
False         UsePitchAct      - Whether a pitch actuator should be used (flag)
          1   PitchJ           - Pitch actuator inertia (kg-m^2)
          0   PitchK           - Pitch actuator stiffness (kg-m^2/s^2)
          0   PitchC           - Pitch actuator damping (kg-m^2/s)
---------------------- OUTPUTS -------------------------------------------------
False         SumPrint         - Print summary data to "<RootName>.sum" (flag)
"ES10.3E2"    OutFmt           - Format used for text tabular output, excluding the time channel
          0   NNodeOuts        - Number of nodes to output to file [0 - 9] (-)
          0   OutNd            - Nodes whose values will be output (-)
          OutList              - The next line(s) contains a list of output parameters
END of input file (the word "END" must appear in the first 3 columns of this last OutList line)
---------------------------------------------------------------------------------------
"#;

const BLADE: &str = " ------- BEAMDYN V1.00.* INDIVIDUAL BLADE INPUT FILE --------------------------
 {title}
 ---------------------- BLADE PARAMETERS --------------------------------------
{count}   station_total    - Number of blade input stations (-)
 {damped}   damp_type        - Damping type: 0: no damping; 1: damped
  ---------------------- DAMPING COEFFICIENT------------------------------------
   mu1        mu2        mu3        mu4        mu5        mu6
   (s)        (s)        (s)        (s)        (s)        (s)
{mu}
 ---------------------- DISTRIBUTED PROPERTIES---------------------------------
{stations}";
