//! A beam as a blade: its axes and its twist as a deck has them, and the deck of any beam.

use super::beam::Beam;
use crate::files::deck::{Deck, Line};
use flexion::linalg::{Mat3, Vec3};
use flexion::multibody::rotation::Quaternion;
use flexion::multibody::slender::Station;
use flexion::section::Matrices;
use flexion::system::Frame;

/// Part of the length by which a section before a jump lies before it.
const BEFORE: f64 = 2e-12;
/// Part of the length within which stations are one.
const SAME: f64 = 1e-9;

/// How far a deck is from its beam at most, between its stations.
#[derive(Clone, Copy, Debug, Default)]
pub struct Between {
    /// Of an entry of stiffness or mass, over the root of the product of its diagonal entries.
    pub section: f64,
    /// Of the line over the length.
    pub place: f64,
    /// Of the axes of a section \[rad\].
    pub turn: f64,
}

impl Beam {
    /// Place \[m\] and axes of a section without stress: tangent, height, and across = tangent × height.
    pub fn frame(&self, s: f64) -> Frame {
        let Station { position, tangent, normal } = (self.curve)(s);
        Frame { position, rotation: Mat3::columns([tangent, normal, tangent.cross(normal)]) }
    }

    /// Whether its section is that of a deck, or it is twisted.
    pub fn is_blade(&self) -> bool {
        let twisted = |s: &f64| self.blade.resultants(*s).twist != 0.0;
        self.section.length.is_some() || self.twist != 0.0 || [0.0, self.length].iter().any(twisted)
    }

    /// The axes x, y, z of its blade, as columns: of a deck with a line those of the deck; of any other z along the tangent of the root, y along
    /// the height of a section without twist, and x opposite to across.
    pub fn axes(&self) -> Mat3 {
        let root = self.frame(0.0).rotation;
        if let Some((deck, true)) = &self.section.deck {
            return root * deck.frame(0.0).rotation.transpose();
        }
        let (sin, cos) = libm::sincos(self.blade.resultants(0.0).twist);
        let (tangent, height) = (root.column(0), cos * root.column(1) - sin * root.column(2));
        Mat3::columns([height.cross(tangent), height, tangent])
    }

    /// The sections at stations \[m\] against the root, in the axes of its blade, with the twist \[rad\] of each about −z, as decks of BeamDyn have it; it
    /// goes on beyond a turn.
    pub fn twisted(&self, stations: &[f64]) -> Vec<(Frame, f64)> {
        let (inward, root) = (self.axes().transpose(), self.frame(0.0).position);
        let mut last = 0.0_f64;
        let section = |s: &f64| {
            let of = self.frame(*s);
            let of = Frame { position: inward * (of.position - root), rotation: inward * of.rotation };
            let (e, g) = Line::untwisted(of.rotation.column(0));
            let height = of.rotation.column(1);
            let turns = std::f64::consts::TAU;
            let twist = libm::atan2(height.dot(e), height.dot(g));
            last = twist + turns * ((last - twist) / turns).round();
            (of, last)
        };
        stations.iter().map(section).collect()
    }

    /// The deck of the beam, with stations and keypoints where its elements end, at `ends` \[m\]; that of a deck with a line keeps its own. A
    /// `straight` one has neither line nor twist.
    ///
    /// # Errors
    /// What of the beam no deck has, in one sentence.
    pub fn deck(&self, ends: &[f64], straight: bool) -> Result<(Deck, Between), String> {
        let own = self.section.deck.as_ref().filter(|(_, has_line)| *has_line);
        let with_ends = |breaks: &[f64]| [&[0.0], breaks, &[self.length]].concat();
        let [points, stations] = own.map_or([ends.to_vec(), ends.to_vec()], |(deck, _)| {
            [with_ends(&deck.line.breaks()), with_ends(deck.table.breaks())]
        });
        let matrices = |s: f64| {
            self.matrices(s).map(|of| Matrices { damping: [[0.0; 6]; 6], ..of }).ok_or_else(|| {
                format!(
                    "the section of beam `{}` does not say how stiff it is in shear, which a deck does: give a shape (`rectangle`, `circle`, `tube`, \
                     `ellipse`), `general` with `shear-stiffness` and `shear-stiffness-across`, or matrices of 6 × 6",
                    self.name
                )
            })
        };
        let line = if straight {
            Line::straight(self.length, &[])?
        } else {
            let sections = self.twisted(&points);
            let z: Vec<f64> = sections.iter().map(|(of, _)| of.position[2]).collect();
            if let Some(k) = (1..z.len()).find(|k| !(z[*k] > z[k - 1])) {
                return Err(format!(
                    "z of beam `{}` does not ascend at {:.4} m along it, as keypoints of BeamDyn do",
                    self.name, points[k]
                ));
            }
            let places: Vec<(f64, Vec3)> =
                z.iter().zip(&sections).map(|(z, (of, _))| (*z, of.position)).collect();
            let twist: Vec<[f64; 2]> = z.iter().zip(&sections).map(|(z, (_, twist))| [*z, *twist]).collect();
            Line::through(&places, &twist).map_err(|error| format!("beam `{}`: {error}", self.name))?
        };
        let mut rows = Vec::with_capacity(stations.len());
        let near = BEFORE * self.length;
        for (s, (of, _)) in stations.iter().zip(self.twisted(&stations)) {
            let place = if straight { *s } else { of.position[2] };
            let jump = self.blade.jumps().iter().find(|jump| (*jump - s).abs() <= SAME * self.length);
            if let Some(jump) = jump {
                rows.push((place, matrices(jump - near)?));
            }
            rows.push((place, matrices(jump.map_or(s.clamp(near, self.length - near), |jump| jump + near))?));
        }
        let times = match self.section.deck.as_ref().and_then(|(deck, _)| deck.damping) {
            Some(times) => Some(times),
            None => Some([self.damping[1]; 6]).filter(|_| self.damping[1] > 0.0),
        };
        let deck = Deck::through(line, &rows, times).map_err(|error| {
            let help = "a section of a deck has rotary inertia about all axes (`rotary-inertia`, `rotary-inertia-across`, `polar-inertia`)";
            format!("beam `{}`: {error}; {help}", self.name)
        })?;
        let mut all = [points, stations].concat();
        all.sort_by(f64::total_cmp);
        all.dedup_by(|a, b| *a - *b <= SAME * self.length);
        let between = self.between(&deck, &all, straight);
        Ok((deck, between))
    }

    /// How far a deck is from the beam in the middle between stations.
    fn between(&self, deck: &Deck, stations: &[f64], straight: bool) -> Between {
        let middles: Vec<f64> = stations.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect();
        let mut most = Between::default();
        for (s, (frame, _)) in middles.iter().zip(self.twisted(&middles)) {
            let at = s * (deck.length / self.length);
            if let Some(own) = self.matrices(*s) {
                let of = deck.matrices(at);
                for (a, b) in [(of.stiffness, own.stiffness), (of.mass, own.mass)] {
                    let entry = |i: usize, j: usize| (a[i][j] - b[i][j]).abs() / (b[i][i] * b[j][j]).sqrt();
                    let entries = (0..6).flat_map(|i| (0..6).map(move |j| entry(i, j)));
                    most.section = entries.fold(most.section, f64::max);
                }
            }
            if !straight {
                let of = deck.frame(at);
                let turned = Quaternion::from(of.rotation * frame.rotation.transpose()).logarithm();
                most.place = most.place.max((of.position - frame.position).norm() / self.length);
                most.turn = most.turn.max(turned.norm());
            }
        }
        most
    }

    /// What the deck of the beam does not say of it, each in one sentence.
    pub fn not_in_deck(&self, straight: bool) -> Vec<String> {
        let mut out = Vec::new();
        let mut say = |is: bool, what: &str| out.extend(is.then(|| what.to_owned()));
        let [mass, stiffness] = self.damping;
        let has_times = self.section.deck.as_ref().is_some_and(|(deck, _)| deck.damping.is_some());
        let tip = self.twisted(&[0.0, self.length]);
        let is_straight = tip.iter().all(|(of, twist)| {
            libm::hypot(of.position[0], of.position[1]) <= 1e-9 * self.length && twist.abs() <= 1e-9
        });
        say(mass > 0.0, "damping in proportion to the mass");
        if straight {
            say(!is_straight, "line and twist, which HAWC2 has in `c2_def`");
            say(has_times || stiffness > 0.0, "damping, which HAWC2 has in the file of the turbine");
        } else {
            say(
                has_times && stiffness > 0.0,
                "`damping.stiffness` of the beam: the times of its deck are written",
            );
        }
        say(!self.torsion, "`torsion = false`: the deck twists");
        say(!self.shear, "that the beam has no shear strains: the deck has them");
        out
    }
}
