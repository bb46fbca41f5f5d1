//! Blade decks: a reference line with 6 × 6 sections along it.
//!
//! Each format is read into rows in its own axes and order, which its convention turns into those of this program. What no section
//! can be is refused (`rows`), what no blade is likely to be is a caution (`plausible`).
//!
//! | file | content |
//! |---|---|
//! | `beamdyn` | primary and blade file of BeamDyn, read and written |
//! | `hawc2` | structural data of HAWC2 (st), read and written |
//! | `windio`, `yaml` | blades of windIO |
//! | `csv` | tables with titles and units |
//! | `elastodyn` | blade files of ElastoDyn |
//! | `fortran` | list-directed input |
//! | `line` | the reference line |
//! | `rows` | matrices of a format into those of a section, and what makes none |
//! | `plausible` | cautions by physics |
//! | `measures` | what a station is like |
//! | `smooth` | values that leave their neighbours |
//! | `neighbours` | stations out of line with those beside them |
//! | `keypoints` | the points of the line, and its twist, as a file has them |

mod beamdyn;
mod csv;
mod elastodyn;
mod fortran;
mod hawc2;
mod keypoints;
mod line;
mod measures;
mod neighbours;
mod plausible;
mod rows;
mod smooth;
mod windio;
mod yaml;

use flexion::section::{Matrices, MatrixTable};
use flexion::system::Frame;
use std::sync::Arc;

pub use beamdyn::write as write_beamdyn;
pub(crate) use beamdyn::{blade_file, with_blade_file};
pub use hawc2::write as write_hawc2;
use keypoints::Keypoints;
pub use line::Line;
use rows::{Convention, Row};

/// The bytes of a file by its name, as a case gives it.
pub type Find<'a> = &'a dyn Fn(&str) -> Result<Arc<[u8]>, String>;

/// A blade as a deck has it.
#[derive(Clone, Debug)]
pub struct Deck {
    /// Length of the line \[m\].
    pub length: f64,
    /// The line, in the axes of the blade: x to the suction side, y edgewise, z along it.
    pub line: Line,
    /// The sections at the stations of the deck, by arc length, in axes tangent, height, across.
    pub table: MatrixTable,
    /// Damping times η \[s\] of the strains (see [`Matrices::with_damping_times`]); `None` where the format says nothing of damping.
    pub damping: Option<[f64; 6]>,
    /// What is unlikely of a blade, each in one sentence.
    pub cautions: Vec<String>,
    /// What the deck says and is not used, each in one sentence.
    pub notes: Vec<String>,
    /// What the deck does not say of its sections.
    pub silent: Silent,
    /// Parameters of the line at the rows of the table, by which matrices are linear.
    places: Vec<f64>,
}

/// What a table may leave out: numbers of an ordinary size stand for it in [`Deck::table`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Silent {
    /// The axial stiffness.
    pub axial: bool,
    /// The stiffness in shear.
    pub shear: bool,
    /// The stiffness in torsion.
    pub torsion: bool,
    /// The moments of inertia about tangent, height and across.
    pub inertia: [bool; 3],
}

impl Deck {
    /// The deck of a line and of sections without damping at ascending parameters of it.
    pub(crate) fn through(
        line: Line,
        rows: &[(f64, Matrices)],
        damping: Option<[f64; 6]>,
    ) -> Result<Deck, String> {
        let length = line.length();
        let damped = |of: &Matrices| damping.map_or(*of, |times| of.with_damping_times(times));
        let table: Vec<_> = rows.iter().map(|(place, of)| (line.arc(*place), damped(of))).collect();
        let table = MatrixTable::new(length, &table).map_err(|error| error.to_string())?;
        let places = rows.iter().map(|(place, _)| *place).collect();
        Ok(Deck {
            length,
            line,
            table,
            damping,
            cautions: Vec::new(),
            notes: Vec::new(),
            silent: Silent::default(),
            places,
        })
    }

    /// Place \[m\] and axes of the section at an arc length \[m\], in the axes of the blade.
    pub fn frame(&self, s: f64) -> Frame {
        self.line.frame(s)
    }

    /// The matrices at an arc length \[m\]: entries are linear in the coordinate by which the deck gives its stations, for BeamDyn z.
    pub fn matrices(&self, s: f64) -> Matrices {
        let i = self.table.interval(s);
        let (a, b) = (self.places[i], self.places[i + 1]);
        let share = if b > a { (self.line.parameter(s) - a) / (b - a) } else { 1.0 };
        self.table.between(i, share.clamp(0.0, 1.0))
    }

    /// Moments of inertia [kg·m] about the three axes of the section at an arc length \[m\], through its centre of mass; 0 where the deck is silent.
    pub fn inertia(&self, s: f64) -> [f64; 3] {
        let of = self.matrices(s).central_inertia();
        std::array::from_fn(|k| if self.silent.inertia[k] { 0.0 } else { of[k] })
    }

    /// Arc lengths \[m\] inside the blade at which elements end: stations, points of the line, rows of the twist.
    pub fn breaks(&self) -> Vec<f64> {
        let mut breaks = self.line.breaks();
        breaks.extend(self.table.breaks());
        breaks.sort_by(f64::total_cmp);
        breaks.dedup_by(|a, b| *a - *b <= 1e-7 * self.length);
        breaks
    }

    /// Mass \[kg\] and centre of mass \[m\] in the axes of the blade.
    pub fn mass(&self) -> (f64, flexion::linalg::Vec3) {
        let gauss = flexion::quadrature::Gauss::new(10);
        let mut ends = vec![0.0, self.length];
        ends.splice(1..1, self.breaks());
        let (mut mass, mut moment) = (0.0, flexion::linalg::Vec3::ZERO);
        for range in ends.windows(2) {
            for (s, weight) in gauss.on(range[0], range[1]) {
                let (m, frame) = (self.matrices(s).mass, self.frame(s));
                // M₁₆ = −μ y, M₁₅ = μ z of the centre (y, z).
                let first = -m[0][5] * frame.rotation.column(1) + m[0][4] * frame.rotation.column(2);
                mass += weight * m[0][0];
                moment += weight * (m[0][0] * frame.position + first);
            }
        }
        (mass, moment / mass)
    }
}

/// A format of decks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Format {
    /// The primary file of BeamDyn, which names a blade file.
    BeamDyn,
    /// A st file of HAWC2.
    Hawc2 {
        /// Number of the set; the first if not given.
        set: Option<usize>,
        /// Number of the subset; the first of the set if not given.
        subset: Option<usize>,
    },
    /// A turbine of windIO, versions 2 and 1.
    WindIo,
    /// A table in CSV.
    Csv,
    /// A blade file of ElastoDyn.
    ElastoDyn {
        /// Length of the blade without the hub \[m\].
        length: Option<f64>,
    },
}

/// Reads the deck that the case calls `name`; `find` gives its bytes, and those of a file that it names.
///
/// # Errors
/// What is wrong with it, in one sentence, with file and line.
pub fn read(find: Find<'_>, name: &str, format: Format) -> Result<Deck, String> {
    match format {
        Format::BeamDyn => beamdyn::read(find, name),
        Format::Hawc2 { set, subset } => hawc2::read(&find(name)?, name, set, subset),
        Format::WindIo => windio::read(&find(name)?, name),
        Format::Csv => csv::read(&find(name)?, name),
        Format::ElastoDyn { length } => elastodyn::read(&find(name)?, name, length),
    }
}

/// Largest coordinate \[m\] and twist \[°\] that is read.
const FARTHEST: f64 = 1e6;
const TURNED: f64 = 3.6e4;

/// Refuses a number that is no place, or no angle, of a structure.
fn within(line: usize, name: &str, what: &str, value: f64, most: f64) -> Result<(), String> {
    if value.abs() <= most {
        return Ok(());
    }
    Err(format!(
        "line {line} of {name}: {what} = {value:.4e} is beyond ±{most:e}: is its exponent, or are its digits, wrong?"
    ))
}

/// A deck in the axes and the order of its format.
struct Raw<'a> {
    /// The file of the stations.
    name: &'a str,
    convention: &'static Convention,
    line: Line,
    /// The points and the twist of the line as they stand in the file.
    keypoints: Keypoints,
    rows: Vec<Row>,
    /// Damping times \[s\] in the order of the format.
    damping: Option<[f64; 6]>,
    cautions: Vec<String>,
    notes: Vec<String>,
    silent: Silent,
}

impl Raw<'_> {
    /// The deck, or what is wrong with it.
    fn deck(self) -> Result<Deck, String> {
        let Raw { name, convention, line, keypoints, rows, damping, mut cautions, notes, silent } = self;
        let length = line.length();
        let damping = damping.map(|times| convention.place.map(|i| times[i]));
        let mut table = Vec::with_capacity(rows.len());
        for row in &rows {
            let mut section = row.section(name, convention)?;
            if let Some(times) = damping {
                section = section.with_damping_times(times);
            }
            table.push((line.arc(row.place), section));
        }
        let places = rows.iter().map(|row| row.place).collect();
        cautions.extend(keypoints.cautions(&line, convention.twists));
        cautions.extend(plausible::cautions(name, convention, &line, &rows, &table, (damping, silent)));
        let table = MatrixTable::new(length, &table).map_err(|error| format!("{name}: {error}"))?;
        Ok(Deck { length, line, table, damping, cautions, notes, silent, places })
    }
}
