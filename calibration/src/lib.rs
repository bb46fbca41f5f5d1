//! Calibration: the stated errors of cases at random against the errors that they have.
//!
//! A case is [drawn](draw) over all kinds, run with its estimate, and run again far more finely. The finer run has four times
//! the functions and a tolerance of 10⁻⁸ or a hundredth of the case's; where a value is off by more than is stated, one of eight times
//! the functions and a tenth of that tolerance decides. A case of a coupling with foreshortening is held against the exact coupling as well: off by
//! no more than discretization + model.
//!
//! Cases of [families] are held against answers that are known without any run, or by another case.

mod beam;
pub mod families;
mod outcome;
mod random;
mod space;
mod study;

pub use outcome::{Compared, Ending, Outcome, judge};
pub use study::{Counts, figure};

use flexion_case::{Contents, Problems, Reading, parse_with};
use random::Random;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

/// A case and what is known of it.
#[derive(Clone, Debug, Default)]
pub struct Drawn {
    /// What it is of: `beam`, `space`, with contacts or without.
    pub subject: &'static str,
    /// The case file.
    pub text: String,
    /// The files that it names.
    pub files: Contents,
    /// Length of the beam \[m\], or 1 m for a system in space.
    pub length: f64,
}

/// Adds a line to the text of a case.
macro_rules! add {
    ($drawn:expr, $($text:tt)*) => {{
        $drawn.text += &format!($($text)*);
        $drawn.text.push('\n');
    }};
}
use add;

impl Drawn {
    fn file(&mut self, name: &str, text: String) {
        self.files.insert(name.to_owned(), text.into_bytes().into());
    }

    /// The case with changes `KEY=VALUE`.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn read(&self, changes: &[String]) -> Result<Reading, Problems> {
        parse_with(self.text.clone(), Path::new("case.toml"), changes, &self.files)
    }
}

/// The valid case of a number, in a sequence that a seed begins: of twenty cases thirteen are of beams, three of
/// beams with contacts, three of systems in space and one of a system in space with a contact.
pub fn draw(seed: u64, number: u64) -> Drawn {
    let random = &mut Random::new(seed.wrapping_mul(1_000_003).wrapping_add(number));
    match number % 20 {
        3 | 10 | 17 => beam::case(random, true),
        5 | 12 | 18 => space::case(random, false),
        19 => space::case(random, true),
        _ => beam::case(random, false),
    }
}

/// The outcomes of cases of a sequence by `judge`, in the order of their numbers, on so many threads, 0 for as many as the machine has.
pub fn study(
    numbers: std::ops::Range<u64>,
    threads: usize,
    judge: &(dyn Fn(u64) -> Outcome + Sync),
) -> Vec<Outcome> {
    let threads = match threads {
        0 => std::thread::available_parallelism().map_or(1, std::num::NonZero::get),
        threads => threads,
    };
    let (next, outcomes) = (AtomicU64::new(numbers.start), Mutex::new(Vec::new()));
    let work = || {
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            if number >= numbers.end {
                break;
            }
            let outcome = judge(number);
            if let Ok(mut outcomes) = outcomes.lock() {
                outcomes.push(outcome);
            }
        }
    };
    std::thread::scope(|scope| (0..threads).for_each(|_| drop(scope.spawn(work))));
    let mut outcomes = outcomes.into_inner().unwrap_or_default();
    outcomes.sort_by_key(|outcome| outcome.number);
    outcomes
}

/// The case of a beam with contacts of a seed.
pub fn draw_with_contacts(seed: u64) -> Drawn {
    beam::case(&mut Random::new(seed), true)
}
