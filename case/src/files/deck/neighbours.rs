//! Stations out of line with those beside them: a slip in a digit, an exponent or a sign, or rows that are exchanged.
//!
//! A blade changes from station to station by what its layers and its chord do, mostly in one direction. A station, or two in a row, that *leave*
//! both neighbours by a factor f have all of the larger, or the smaller, values: f = 1 wherever a quantity rises or falls. Of ten published blades
//! and five towers, most quantities leave by at most 1.3; the mass at a joint in the span by 3.6, and toward the tip stiffnesses fall by up to 2000 from
//! one station to the next. What the deck allows itself elsewhere counts, too, where it has stations enough to tell.
//!
//! Ratios say more than sizes: the speed of waves √(EA/m) and the radii of gyration of mass over those of stiffness depend on the materials alone, of
//! which no station has others than the next, and are held at both ends, too.

use super::Silent;
use super::measures::Measures;
use super::rows::{Convention, Row};
use super::smooth::{ELSEWHERE, is_smooth, leaving};
use flexion::section::Matrices;
use libm::log;

/// A value of a station, and whether a deck leaves it out.
type Value = fn(&Measures) -> f64;
type Left = fn(&Silent) -> bool;

/// A size or a ratio of a station.
struct Quantity {
    /// Its matrix and the row of this program that tells most of it.
    entry: (char, usize),
    /// What it is made of, where it is a ratio.
    parts: &'static [(char, usize)],
    /// What it is called, where it is a ratio.
    name: &'static str,
    of: Value,
    /// Whether the deck does not say it.
    silent: Left,
    /// Factor by which one station may leave both its neighbours, one in a deck that is smooth elsewhere, and two in a row.
    factors: [f64; 3],
    /// Factor of the first to the second station or its inverse, of the last to the last but one, and of that to the last.
    ends: [f64; 3],
}

const ROUGH: f64 = f64::INFINITY;

/// A size of one entry.
const fn size(
    letter: char,
    row: usize,
    factors: [f64; 3],
    ends: [f64; 3],
    (of, silent): (Value, Left),
) -> Quantity {
    Quantity { entry: (letter, row), parts: &[], name: "", of, silent, factors, ends }
}

static SIZES: [Quantity; 9] = [
    size('K', 0, [5.0, 3.0, 4.0], [1e3, 3.5, 1e3], (|m| m.axial, |s| s.axial)),
    size('M', 0, [5.0, ROUGH, 4.0], [1e3, ROUGH, 1e3], (|m| m.mass, |_| false)),
    size('K', 5, [5.0, 3.0, 4.0], [1e3, 3.5, 1e4], (|m| m.bending[0], |_| false)),
    size('K', 4, [5.0, 3.0, 4.0], [1e3, 3.5, 1e4], (|m| m.bending[1], |_| false)),
    size('M', 5, [5.0, 3.0, 4.0], [1e3, 3.5, 1e4], (|m| m.inertia[0], |s| s.inertia[2])),
    size('M', 4, [5.0, 3.0, 4.0], [1e3, 3.5, 1e4], (|m| m.inertia[1], |s| s.inertia[1])),
    size('K', 3, [30.0, 3.0, 15.0], [1e3, 12.0, 1e4], (|m| m.torsion, |s| s.torsion)),
    size('K', 1, [10.0, 3.0, 6.0], [1e3, 12.0, 1e3], (|m| m.shear[0], |s| s.shear)),
    size('K', 2, [10.0, 3.0, 6.0], [1e3, 12.0, 1e3], (|m| m.shear[1], |s| s.shear)),
];

static RATIOS: [Quantity; 6] = [
    Quantity {
        entry: ('K', 0),
        parts: &[('K', 0), ('M', 0)],
        name: "the speed of waves √(EA/m) [m/s]",
        of: Measures::speed,
        silent: |s| s.axial,
        factors: [2.25, ROUGH, 2.0],
        ends: [2.25; 3],
    },
    Quantity {
        entry: ('K', 5),
        parts: &[('K', 0), ('K', 5), ('M', 0), ('M', 5)],
        name: "the larger radius of gyration of the mass over that of the stiffness",
        of: |m| m.radii()[1][0] / m.radii()[0][0],
        silent: |s| s.axial || s.inertia[2],
        factors: [2.25, ROUGH, 2.0],
        ends: [2.25; 3],
    },
    Quantity {
        entry: ('K', 4),
        parts: &[('K', 0), ('K', 4), ('M', 0), ('M', 4)],
        name: "the smaller radius of gyration of the mass over that of the stiffness",
        of: |m| m.radii()[1][1] / m.radii()[0][1],
        silent: |s| s.axial || s.inertia[1],
        factors: [2.25, ROUGH, 2.0],
        ends: [2.25; 3],
    },
    Quantity {
        entry: ('K', 1),
        parts: &[('K', 1), ('K', 0)],
        name: "the shear stiffness edgewise over EA",
        of: |m| m.shear[0] / m.axial,
        silent: |s| s.shear || s.axial,
        factors: [6.0, 3.0, 5.0],
        ends: [8.0; 3],
    },
    Quantity {
        entry: ('K', 2),
        parts: &[('K', 2), ('K', 0)],
        name: "the shear stiffness flapwise over EA",
        of: |m| m.shear[1] / m.axial,
        silent: |s| s.shear || s.axial,
        factors: [6.0, 3.0, 5.0],
        ends: [8.0; 3],
    },
    Quantity {
        entry: ('K', 3),
        parts: &[('K', 3), ('K', 4), ('K', 5)],
        name: "GJ over the bending stiffnesses, GJ (1/EI₂ + 1/EI₃),",
        of: |m| m.torsion * (1.0 / m.bending[0] + 1.0 / m.bending[1]),
        silent: |s| s.torsion,
        factors: [12.0, 3.0, 8.0],
        ends: [25.0; 3],
    },
];

/// Part of √(Kᵢᵢ Kⱼⱼ), and of √(Mᵢᵢ Mⱼⱼ), by which an entry off the diagonal may leave those beside it in a deck that is smooth elsewhere: in published
/// blades 0.13, and at a joint with its own mass 0.2.
const COUPLED: [f64; 2] = [0.2, 0.3];
/// A part of the beam of its own, as between two steps, is so many times longer than the intervals on both its sides.
const OWN: f64 = 5.0;
/// Growth between two stations that are exchanged, and in how many of the six stiffnesses and inertias.
const EXCHANGED: (f64, usize) = (1.1, 5);

/// Stations of a deck with what they are like.
pub(super) struct Stations<'a> {
    pub name: &'a str,
    pub convention: &'a Convention,
    pub rows: &'a [Row],
    pub measures: &'a [Measures],
    pub silent: Silent,
}

impl Stations<'_> {
    /// What is out of line, each in one sentence.
    pub fn cautions(&self, table: &[(f64, Matrices)]) -> Vec<String> {
        let mut out = Vec::new();
        let mut named = vec![false; self.rows.len()];
        for of in SIZES.iter().chain(&RATIOS).filter(|of| !(of.silent)(&self.silent)) {
            let values: Vec<f64> = self.measures.iter().map(|m| log((of.of)(m))).collect();
            // A ratio tells nothing new of a station of which one of its sizes is told.
            let is_new = |range: &[usize; 2]| of.parts.is_empty() || (range[0]..=range[1]).all(|i| !named[i]);
            if let Some(range) = self.out_of_line(of, &values).filter(is_new) {
                out.push(self.sentence(of, range));
                named[range[0]..=range[1]].fill(true);
            }
        }
        if !named.contains(&true) {
            out.extend(self.exchanged());
            out.extend(self.coupling(table));
        }
        out
    }

    /// The first station, or two, that leave their neighbours.
    fn out_of_line(&self, of: &Quantity, v: &[f64]) -> Option<[usize; 2]> {
        let n = v.len();
        if n < 2 {
            return None;
        }
        let leaves = |i: usize, factor: f64| leaving(v, i, i) > log(factor);
        let single = (1..n - 1).find(|i| leaves(*i, of.factors[0])).or_else(|| {
            (1..n - 1).find(|i| {
                leaves(*i, of.factors[1]) && is_smooth(n, *i, |k| leaving(v, k, k), leaving(v, *i, *i))
            })
        });
        if let Some(i) = single {
            return Some([i, i]);
        }
        let pair = |i: &usize| leaving(v, *i, i + 1) > log(of.factors[2]) && !self.is_part(*i);
        if let Some(i) = (1..n.max(3) - 2).find(pair) {
            return Some([i, i + 1]);
        }
        let [first, last] = [v[1] - v[0], v[n - 1] - v[n - 2]];
        if first.abs() > log(of.ends[0]) {
            return Some([0, 0]);
        }
        if last > log(of.ends[1]) || -last > log(of.ends[2]) {
            return Some([n - 1, n - 1]);
        }
        // Two at an end tell by a ratio alone, which changes so much at a written jump at most.
        let is_step = |i: usize| {
            let is_jump = self.rows[i].place == self.rows[i + 1].place;
            !of.parts.is_empty() && !is_jump && (v[i + 1] - v[i]).abs() > log(of.ends[0])
        };
        if n < ELSEWHERE.0 {
            return None;
        }
        [(1, 0), (n - 3, n - 2)].into_iter().find(|(i, _)| is_step(*i)).map(|(_, from)| [from, from + 1])
    }

    /// Whether two stations bound a part of the beam that is meant to be another, between steps.
    fn is_part(&self, i: usize) -> bool {
        let at = |k: usize| self.rows[k].place;
        let own = at(i + 1) - at(i);
        OWN * (at(i) - at(i - 1)) <= own && OWN * (at(i + 2) - at(i + 1)) <= own
    }

    fn at(&self, i: usize, (letter, row): (char, usize)) -> String {
        let c = self.convention;
        self.rows[i].at(self.name, c, usize::from(letter == 'M'), c.place[row])
    }

    fn sentence(&self, of: &Quantity, [from, to]: [usize; 2]) -> String {
        let c = self.convention;
        let entry = |(letter, i): &(char, usize)| c.entry(*letter, *i, *i);
        let value = |i: usize| format!("{:.3e}", (of.of)(&self.measures[i]));
        let beside = match (from.checked_sub(1), self.rows.get(to + 1)) {
            (Some(before), Some(_)) => format!(
                "to {} and {} at the stations before and behind {}",
                value(before),
                value(to + 1),
                if from == to { "it" } else { "them" }
            ),
            (Some(before), None) => format!("to {} at the station before it, at this end", value(before)),
            _ => format!("to {} at the station behind it, at this end", value(to + 1)),
        };
        let here = if from == to { value(from) } else { format!("{} and {}", value(from), value(to)) };
        let next = if from == to { "" } else { ", and the next" };
        let station = self.at(from, of.entry);
        if of.parts.is_empty() {
            return format!(
                "{station}{next}: {} belongs to {here}, and {beside}: is a digit or an exponent wrong?",
                entry(&of.entry)
            );
        }
        let mut parts: Vec<String> = of.parts.iter().map(entry).collect();
        parts.dedup();
        let last = parts.pop().unwrap_or_default();
        format!(
            "{station}{next}: {} of {} and {last} comes to {here}, and {beside}: is a digit or an exponent of one of them wrong?",
            of.name,
            parts.join(", ")
        )
    }

    /// Two stations that are exchanged: nearly all sizes go back between them, and on both sides go on.
    fn exchanged(&self) -> Option<String> {
        let sizes: Vec<&Quantity> = SIZES[..6].iter().filter(|of| !(of.silent)(&self.silent)).collect();
        if sizes.len() < EXCHANGED.1 {
            return None;
        }
        let senses = |i: usize| -> f64 {
            let sense = |of: &&Quantity| {
                let v: [f64; 4] = std::array::from_fn(|k| log((of.of)(&self.measures[i - 1 + k])));
                let d: [f64; 3] = std::array::from_fn(|k| v[k + 1] - v[k]);
                let turns = d[0] * d[1] < 0.0 && d[1] * d[2] < 0.0;
                let is_back =
                    turns && d[1].abs() > log(EXCHANGED.0) && d[1].abs() < d[0].abs().min(d[2].abs());
                if is_back { d[1].signum() } else { 0.0 }
            };
            sizes.iter().map(sense).sum()
        };
        let i = (1..self.rows.len().max(3) - 2).find(|i| senses(*i).abs() >= EXCHANGED.1 as f64)?;
        Some(format!(
            "{}, and the next: stiffnesses and masses go back between both, and go on before and behind them: are the matrices of both exchanged?",
            self.at(i, ('K', 0))
        ))
    }

    /// A coupling, an entry off the diagonal, that leaves those of its neighbours.
    fn coupling(&self, table: &[(f64, Matrices)]) -> Option<String> {
        let (c, n) = (self.convention, table.len());
        let pairs = (0..72).map(|at| (at / 36, at / 6 % 6, at % 6)).filter(|(_, i, j)| i < j);
        pairs.into_iter().find_map(|(which, i, j)| {
            let v: Vec<f64> = table
                .iter()
                .map(|(_, section)| {
                    let of = if which == 0 { &section.stiffness } else { &section.mass };
                    of[i][j] / (of[i][i] * of[j][j]).sqrt()
                })
                .collect();
            let leaves = |k: usize| leaving(&v, k, k);
            let is_off = |k: &usize| leaves(*k) > COUPLED[which] && is_smooth(n, *k, leaves, leaves(*k));
            let k = (1..n.max(2) - 1).find(is_off)?;
            let letter = ['K', 'M'][which];
            let (a, b) = (c.entry(letter, i, i), c.entry(letter, j, j));
            Some(format!(
                "{}: {} belongs to {:.3} of √({a}·{b}), and to {:.3} and {:.3} at the stations before and behind it: is its sign or a digit wrong?",
                self.at(k, (letter, i)),
                c.upper(letter, i, j),
                c.sign[i] * c.sign[j] * v[k],
                c.sign[i] * c.sign[j] * v[k - 1],
                c.sign[i] * c.sign[j] * v[k + 1],
            ))
        })
    }
}
