//! Families of cases whose answer is known without the code that is tested: by a closed form, or because another case has the
//! same one.
//!
//! Each family aims at one way of being wrong that random cases do not meet: a feature shorter than an element, more than half a turn in a
//! step, an extreme behind the last record, a jump right after the start.

mod beams;
mod contacts;
pub mod crowds;
mod judge;
mod rotations;
mod symmetry;
mod times;

use crate::Drawn;
use crate::random::Random;
pub use judge::judge;

/// A case and what is known of its answer.
#[derive(Clone, Debug)]
pub struct Posed {
    /// The case.
    pub case: Drawn,
    /// Its answer.
    pub answer: Answer,
}

/// How the answer of a case is known.
#[derive(Clone, Debug)]
pub enum Answer {
    /// Values of its columns by closed forms.
    Known(Vec<Known>),
    /// The columns of another case, by what joins them.
    Other(Box<Drawn>, Relation),
    /// Pairs of columns of the case itself that are equal: those that begin with the one name, and with the other.
    Pairs(&'static str, &'static str),
}

/// A value known by a closed form.
#[derive(Clone, Debug)]
pub struct Known {
    /// The column.
    pub column: String,
    /// `min`, `max` or `final`.
    pub part: &'static str,
    /// The value.
    pub value: f64,
    /// Error of the closed form, as far as it leaves something out.
    pub within: f64,
}

/// A closed form that leaves nothing out.
fn exactly(column: &str, part: &'static str, value: f64) -> Known {
    Known { column: column.to_owned(), part, value, within: 0.0 }
}

/// What joins the columns of two cases.
#[derive(Clone, Copy, Debug)]
pub enum Relation {
    /// They are the same.
    Equal,
    /// Each is the same or its negative.
    Mirrored,
    /// Those of the other case are larger by the factors of their units, which follow from those of length, mass and time.
    Scaled([f64; 3]),
}

/// A family: its name, and how a case of it is drawn.
type Family = (&'static str, fn(&mut Random) -> Posed);

/// The families.
const FAMILIES: &[Family] = &[
    ("thin segment", beams::thin_segment),
    ("thin segment in space", beams::thin_segment_in_space),
    ("kinks of a section", beams::kinks),
    ("kinks of a motion", times::kinks_of_a_motion),
    ("a short blow", times::short_blow),
    ("an extreme in the last interval", times::last_interval),
    ("a jump after the start", times::jump_after_the_start),
    ("a load after the start", times::load_after_the_start),
    ("several turns, prescribed", rotations::prescribed_turns),
    ("several turns, free", rotations::free_turns),
    ("turns of the hub", rotations::hub_turns),
    ("turns of one body against another", rotations::relative_turns),
    ("signs of a quaternion", rotations::quaternion),
    ("a spin without torque", rotations::free_spin),
    ("a record just before an impact", contacts::record_before_impact),
    ("a rotor meets an obstacle", contacts::rotor_meets_obstacle),
    ("friction stops a block", contacts::friction_stops),
    ("two equal bodies", symmetry::two_equal_bodies),
    ("two equal beams", symmetry::two_equal_beams),
    ("one thing in two halves", symmetry::halves),
    ("one obstacle twice", symmetry::obstacle_twice),
    ("another order, in the plane", symmetry::another_order),
    ("another order, in space", symmetry::another_order_in_space),
    ("mirrored", symmetry::mirrored),
    ("other units", symmetry::other_units),
    ("other units, in space", symmetry::other_units_in_space),
];

/// Number of the families.
pub const COUNT: u64 = FAMILIES.len() as u64;

/// The case of a number, in a sequence that a seed begins, with the name of its family: the families follow one another.
pub fn pose(seed: u64, number: u64) -> Posed {
    let random = &mut Random::new(seed.wrapping_mul(1_000_003).wrapping_add(number));
    let (name, draw) = FAMILIES[(number % FAMILIES.len() as u64) as usize];
    let mut posed = draw(random);
    posed.case.subject = name;
    posed
}
