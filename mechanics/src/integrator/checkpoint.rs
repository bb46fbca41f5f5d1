//! What a run remembers, as named lists of numbers: enough to go on as if it had never stopped.

use crate::system::{Mode, Side, State};

/// The format of what methods and drivers keep: it changes when they keep something else.
const FORMAT: f64 = 8.0;

/// Lists in which NaN stands for what is not known yet: a step that was accepted, one before, factors; and what observers have seen.
const UNKNOWN: [&str; 3] = ["accepted", "control", "tangent"];
const OBSERVED: &str = "events.";

/// Named lists of numbers, in the order in which they were put.
///
/// A run that goes on from a checkpoint takes the very steps it would have taken without it, bit by bit: counts are
/// kept as numbers too, exact up to 2⁵³.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Checkpoint {
    entries: Vec<(String, Vec<f64>)>,
}

/// A checkpoint from which a run cannot go on.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NotResumed {
    /// It was written in another format.
    #[error(
        "the stored state is one of format {found}, and this version of the program goes on from format {needed}: run the case \
         from its start"
    )]
    Format {
        /// Its format; 1 where none is written.
        found: f64,
        /// The format of this version.
        needed: f64,
    },
    /// A list is missing.
    #[error(
        "the stored state lacks `{0}`: it was written by another method or another version of the program"
    )]
    Missing(String),
    /// A list has another length than the model or the method needs.
    #[error("the stored `{name}` has {found} entries, and {needed} are needed")]
    Length {
        /// Name of the list.
        name: String,
        /// Its length.
        found: usize,
        /// Length needed.
        needed: usize,
    },
    /// A list has numbers that are not finite, or not the ones of a run.
    #[error("the stored `{0}` has numbers that no run has")]
    Invalid(String),
    /// The method cannot take up its history again.
    #[error("{0}")]
    Failed(String),
}

impl Checkpoint {
    /// An empty checkpoint in the format of this version.
    pub fn of_this_format() -> Checkpoint {
        let mut checkpoint = Checkpoint::default();
        checkpoint.put("format", &[FORMAT]);
        checkpoint
    }

    /// Whether this version can go on from it.
    ///
    /// # Errors
    /// [`NotResumed::Format`].
    pub fn check_format(&self) -> Result<(), NotResumed> {
        let [found] = self.numbers("format").unwrap_or([1.0]);
        if found == FORMAT { Ok(()) } else { Err(NotResumed::Format { found, needed: FORMAT }) }
    }

    /// Whether all numbers are some: only lists that say so hold NaN for what is not known.
    ///
    /// # Errors
    /// [`NotResumed::Invalid`].
    pub fn check_numbers(&self) -> Result<(), NotResumed> {
        let last = |name: &str| name.rsplit('.').next().is_some_and(|last| UNKNOWN.contains(&last));
        let may_lack = |name: &str| last(name) || name.starts_with(OBSERVED);
        let wrong = |(name, list): &(&str, &[f64])| !may_lack(name) && list.iter().any(|x| x.is_nan());
        let found = self.entries().find(wrong);
        found.map_or(Ok(()), |(name, _)| Err(NotResumed::Invalid(name.to_owned())))
    }

    /// Adds the lists of another, under names that begin with `prefix`.
    pub fn put_all(&mut self, prefix: &str, other: &Checkpoint) {
        other.entries().for_each(|(name, values)| self.put(&format!("{prefix}{name}"), values));
    }

    /// The lists whose names begin with `prefix`, under what follows it.
    pub fn part(&self, prefix: &str) -> Checkpoint {
        let own =
            |(name, list): &(String, Vec<f64>)| Some((name.strip_prefix(prefix)?.to_owned(), list.clone()));
        Checkpoint { entries: self.entries.iter().filter_map(own).collect() }
    }

    /// Adds a list, or replaces it in its place.
    pub fn put(&mut self, name: &str, values: &[f64]) {
        match self.entries.iter_mut().find(|(known, _)| known == name) {
            Some((_, old)) => *old = values.to_vec(),
            None => self.entries.push((name.to_owned(), values.to_vec())),
        }
    }

    /// The lists with their names.
    pub fn entries(&self) -> impl Iterator<Item = (&str, &[f64])> {
        self.entries.iter().map(|(name, values)| (name.as_str(), values.as_slice()))
    }

    /// The list called `name`.
    ///
    /// # Errors
    /// [`NotResumed::Missing`].
    pub fn list(&self, name: &str) -> Result<&[f64], NotResumed> {
        let found = self.entries.iter().find(|(known, _)| known == name);
        found.map(|(_, values)| values.as_slice()).ok_or_else(|| NotResumed::Missing(name.to_owned()))
    }

    /// The list called `name`, of N numbers.
    ///
    /// # Errors
    /// [`NotResumed::Missing`] and [`NotResumed::Length`].
    pub fn numbers<const N: usize>(&self, name: &str) -> Result<[f64; N], NotResumed> {
        let list = self.list(name)?;
        list.try_into().map_err(|_| NotResumed::Length {
            name: name.to_owned(),
            found: list.len(),
            needed: N,
        })
    }

    /// As [`Checkpoint::numbers`], of finite numbers.
    ///
    /// # Errors
    /// [`NotResumed::Missing`], [`NotResumed::Length`] and [`NotResumed::Invalid`].
    pub fn finite<const N: usize>(&self, name: &str) -> Result<[f64; N], NotResumed> {
        let numbers = self.numbers(name)?;
        let finite = numbers.iter().all(|x: &f64| x.is_finite());
        finite.then_some(numbers).ok_or_else(|| NotResumed::Invalid(name.to_owned()))
    }

    /// Copies the list called `name` into `out`, whose length it must have.
    ///
    /// # Errors
    /// [`NotResumed::Missing`] and [`NotResumed::Length`].
    pub fn fill(&self, name: &str, out: &mut [f64]) -> Result<(), NotResumed> {
        let list = self.list(name)?;
        if list.len() != out.len() {
            let (name, found, needed) = (name.to_owned(), list.len(), out.len());
            return Err(NotResumed::Length { name, found, needed });
        }
        out.copy_from_slice(list);
        Ok(())
    }

    /// The work done until the checkpoint.
    ///
    /// # Errors
    /// [`NotResumed::Missing`] and [`NotResumed::Length`].
    pub fn counters(&self) -> Result<super::Counters, NotResumed> {
        let numbers: [f64; 7] = self.numbers("counters")?;
        let mut counters = super::Counters::default();
        counters.all().into_iter().zip(numbers).for_each(|(count, number)| *count = number as u64);
        Ok(counters)
    }

    /// Adds a state under names that begin with `prefix`.
    pub fn put_state(&mut self, prefix: &str, state: &State) {
        let left = f64::from(u8::from(state.side == Side::Left));
        self.put(&format!("{prefix}time"), &[state.t, left]);
        let mode: Vec<f64> = state.mode.iter().map(|mode| f64::from(*mode as u8)).collect();
        self.put(&format!("{prefix}mode"), &mode);
        let State { q, v, a, lambda, memory, .. } = state;
        for (name, list) in [("q", q), ("v", v), ("a", a), ("lambda", lambda), ("memory", memory)] {
            self.put(&format!("{prefix}{name}"), list);
        }
    }

    /// Reads what [`Checkpoint::put_state`] wrote into a state of the same sizes.
    ///
    /// # Errors
    /// [`NotResumed::Missing`] and [`NotResumed::Length`].
    pub fn fill_state(&self, prefix: &str, state: &mut State) -> Result<(), NotResumed> {
        let [time, left] = self.numbers(&format!("{prefix}time"))?;
        (state.t, state.side) = (time, if left != 0.0 { Side::Left } else { Side::Right });
        let mut mode = vec![0.0; state.mode.len()];
        self.fill(&format!("{prefix}mode"), &mut mode)?;
        state.mode = mode.into_iter().map(Mode::from_number).collect();
        self.fill(&format!("{prefix}q"), &mut state.q)?;
        self.fill(&format!("{prefix}v"), &mut state.v)?;
        self.fill(&format!("{prefix}a"), &mut state.a)?;
        self.fill(&format!("{prefix}lambda"), &mut state.lambda)?;
        self.fill(&format!("{prefix}memory"), &mut state.memory)
    }
}

impl super::Counters {
    fn all(&mut self) -> [&mut u64; 7] {
        let super::Counters { steps, rejected, iterations, residuals, tangents, factorizations, solves } =
            self;
        [steps, rejected, iterations, residuals, tangents, factorizations, solves]
    }

    /// As numbers, for a [`Checkpoint`].
    pub(super) fn to_numbers(mut self) -> [f64; 7] {
        self.all().map(|count| *count as f64)
    }

    /// Counts an iteration with one residual and one solution.
    pub(super) fn add_iteration(&mut self) {
        self.iterations += 1;
        self.residuals += 1;
        self.solves += 1;
    }

    /// Counts an iteration with a tangent of its own, factored, and the given number of solutions.
    pub(super) fn add_full_iteration(&mut self, solves: u64) {
        self.add_iteration();
        self.tangents += 1;
        self.factorizations += 1;
        self.solves += solves - 1;
    }
}
