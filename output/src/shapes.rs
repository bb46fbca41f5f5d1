//! The shape of the beam at some of the recorded times, for pictures in space.

use super::obstacles::Drawn;
use flexion::linalg::Vec3;
use flexion::system::{Frame, State, System};

/// Equal intervals along the beam between whose ends it is drawn.
const INTERVALS: usize = 100;

/// Section frames along the beam at a number of times.
#[derive(Clone, Debug, Default)]
pub struct Shapes {
    stations: Vec<f64>,
    height: f64,
    every: usize,
    seen: usize,
    times: Vec<f64>,
    frames: Vec<Frame>,
    obstacles: Vec<Drawn>,
    /// Outlines of the obstacles at each time.
    outlines: Vec<Vec<Vec<Vec3>>>,
}

/// The shape at one time.
#[derive(Clone, Copy, Debug)]
pub struct Shape<'a> {
    /// Time t \[s\].
    pub time: f64,
    /// Arc lengths from the root, ascending \[m\].
    pub stations: &'a [f64],
    /// Section frame at each of them.
    pub frames: &'a [Frame],
    /// Height of the section, in the plane of motion \[m\].
    pub height: f64,
}

impl Shapes {
    /// No shape yet: of a beam of the given length and height \[m\], at equal intervals and at the given
    /// stations \[m\], to be taken at every `every`-th recorded time (0 counts as 1).
    pub fn new(length: f64, stations: &[f64], height: f64, every: usize) -> Shapes {
        let stations = self::stations(length, INTERVALS, stations);
        Shapes { stations, height, every: every.max(1), ..Shapes::default() }
    }

    /// The same with obstacles.
    pub fn with_obstacles(self, obstacles: Vec<Drawn>) -> Shapes {
        Shapes { obstacles, ..self }
    }

    /// Call it with every recorded state: it takes the shape of every `every`-th of them.
    pub fn sample(&mut self, system: &mut dyn System, state: &State) {
        if self.seen.is_multiple_of(self.every) {
            self.push(system, state);
        }
        self.seen += 1;
    }

    /// Takes the last state of a run, unless it was taken.
    pub fn finish(&mut self, system: &mut dyn System, state: &State) {
        if self.times.last() != Some(&state.t) {
            self.push(system, state);
        }
    }

    fn push(&mut self, system: &mut dyn System, state: &State) {
        let start = self.frames.len();
        self.times.push(state.t);
        self.frames.resize(start + self.stations.len(), Frame::default());
        system.frames(0, state, &self.stations, &mut self.frames[start..]);
        if !self.obstacles.is_empty() {
            let size = 0.5 * self.stations.last().copied().unwrap_or(0.0);
            let mut outline = |drawn: &Drawn| drawn.outline(system, state, size);
            self.outlines.push(self.obstacles.iter().map(&mut outline).collect());
        }
    }

    /// The shapes taken, in order of time.
    pub fn iter(&self) -> impl Iterator<Item = Shape<'_>> {
        let shape = |(&time, frames)| Shape { time, stations: &self.stations, frames, height: self.height };
        self.times.iter().zip(self.frames.chunks_exact(self.stations.len().max(1))).map(shape)
    }

    /// The outlines of all obstacles at each time \[m\]; nothing without obstacles.
    pub fn outlines(&self) -> &[Vec<Vec<Vec3>>] {
        &self.outlines
    }

    /// The times at which they were taken \[s\].
    pub fn times(&self) -> &[f64] {
        &self.times
    }
}

/// Equal intervals along a beam of this length \[m\], and further stations \[m\], ascending, each once.
pub(super) fn stations(length: f64, intervals: usize, also: &[f64]) -> Vec<f64> {
    let equal = (0..=intervals).map(|i| length * i as f64 / intervals as f64);
    let mut all: Vec<f64> = equal.chain(also.iter().copied()).collect();
    all.sort_by(f64::total_cmp);
    all.dedup_by(|a, b| (*a - *b).abs() <= 1e-9 * length);
    all
}
