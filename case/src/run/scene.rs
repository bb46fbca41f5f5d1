//! What is drawn of a case.

use crate::case::{Case, Subject};
use crate::hub_beam::HubBeam;
use crate::kinds::beam::Beam;
use crate::kinds::contact::{Mount, OnBeam};
use crate::kinds::cross_section::Section;
use crate::space::Space;
use flexion::multibody::{self, Body, Marker};
use flexion::section::Shape;
#[cfg(feature = "figures")]
use flexion_results::plot::Blade;
use flexion_results::{Carrier, Contour, Drawn, Part, Scene, Spring};
use std::sync::Arc;

/// Length over height of a beam drawn without knowing its height.
const SLENDERNESS: f64 = 50.0;
/// Equal intervals between the sections of a blade that are drawn, beside those at which it breaks.
#[cfg(feature = "figures")]
const SECTIONS: usize = 40;
/// Least edge of the box of a body over its largest.
const THINNEST: f64 = 0.02;

impl Case {
    /// Its motion in space, not yet taken.
    pub fn scene(&self) -> Scene {
        let (parts, obstacles) = match &self.subject {
            // The beam is as wide as high, for a model in a plane knows no width.
            Subject::HubBeam(of) => {
                let contacts = of.drawn();
                let also: Vec<f64> = contacts.iter().map(|drawn| drawn.station).collect();
                let section = Shape::Rectangle { height: of.height(), width: of.height() };
                let contour = |_: f64| Contour::of(&section);
                let beam = Part::beam(("beam", 0), (of.length, 1), contour, Some(of.hub.radius), &also);
                (vec![beam], contacts)
            }
            Subject::Space(of) => (of.parts(), of.drawn()),
        };
        let scene = Scene::new(parts, obstacles, (self.duration / self.output.step) as usize);
        let Subject::Space(of) = &self.subject else { return scene };
        let scene = scene.with_springs(of.springs());
        match self.output.vtk {
            Some(interval) => scene.taken((interval / self.output.step).round() as usize),
            None => scene,
        }
    }
}

/// Height of a beam, as it is drawn \[m\].
pub(super) fn drawn_height(section: &Section, length: f64) -> f64 {
    section.height.unwrap_or(length / SLENDERNESS)
}

impl HubBeam {
    /// Height of the beam, as it is drawn \[m\].
    pub(super) fn height(&self) -> f64 {
        drawn_height(&self.section, self.length)
    }

    /// The obstacles, as they are drawn.
    pub(super) fn drawn(&self) -> Vec<Drawn> {
        let stations = |of: &OnBeam| of.points.iter().map(|(_, station, _)| *station).collect::<Vec<_>>();
        let drawn = |of: &OnBeam| Drawn {
            name: of.contact.name.clone(),
            body: 0,
            size: self.length,
            in_space: false,
            station: stations(of).last().copied().unwrap_or(self.length),
            points: if of.points.len() > 1 { stations(of) } else { Vec::new() },
            carrier: if of.contact.mount == Mount::Hub { Carrier::Hub } else { Carrier::Ground },
            obstacle: Arc::clone(&of.contact.obstacle.obstacle),
        };
        self.contacts.iter().map(drawn).collect()
    }
}

impl Space {
    /// The obstacles, as they are drawn: once each, however many points of a beam may touch it.
    fn drawn(&self) -> Vec<Drawn> {
        let mut first = 0;
        let drawn = |count: &usize| {
            let points = self.touching.get(first..first + count)?;
            let contact = self.contacts.get(first)?;
            let carrier =
                self.carriers.get(first)?.map_or(Carrier::Ground, |(part, at)| Carrier::Part(part, at));
            first += count;
            let (body, station) = *points.get(count / 2)?;
            // A point along the whole beam has its number behind the name of the contact.
            let (name, points) = match contact.name.split_once('.') {
                Some((name, _)) => (name, points.iter().map(|(_, station)| *station).collect()),
                None => (contact.name.as_str(), Vec::new()),
            };
            Some(Drawn {
                name: name.to_owned(),
                body,
                station,
                points,
                size: 0.5 * self.size,
                in_space: true,
                carrier,
                obstacle: Arc::clone(&contact.obstacle),
            })
        };
        self.points.iter().filter_map(drawn).collect()
    }

    /// The springs, as they are drawn.
    fn springs(&self) -> Vec<Spring> {
        let end = |marker: &Marker| {
            let fixed = match marker.part {
                multibody::Part::Ground => None,
                multibody::Part::Body(i) => Some((i, 0.0)),
                multibody::Part::Section { beam, node } => {
                    let station = self.beams.get(beam).and_then(|(_, built)| built.nodes().get(node));
                    Some((self.bodies.len() + beam, station.copied().unwrap_or(0.0)))
                }
            };
            (fixed, marker.frame.position)
        };
        let springs = self.multibody.model().springs().iter();
        springs.map(|s| Spring { name: s.name.clone(), ends: [end(&s.from), end(&s.to)] }).collect()
    }

    /// Its blades, as they are drawn.
    #[cfg(feature = "figures")]
    pub fn blades(&self) -> Vec<Blade> {
        let blade = |beam: &Beam| {
            let mut stations: Vec<f64> =
                (0..=SECTIONS).map(|k| beam.length * k as f64 / SECTIONS as f64).collect();
            stations.extend(beam.blade.breaks());
            stations.sort_by(f64::total_cmp);
            let twist = beam.twisted(&stations).into_iter().map(|(_, twist)| twist).collect();
            Blade {
                name: beam.name.clone(),
                sections: stations.iter().map(|s| beam.frame(*s)).collect(),
                twist,
                stations,
                axes: beam.axes(),
                is_deck: beam.section.deck.is_some(),
            }
        };
        self.beams.iter().map(|(beam, _)| beam).filter(|beam| beam.is_blade()).map(blade).collect()
    }

    /// Its bodies as boxes, and its beams.
    fn parts(&self) -> Vec<Part> {
        let bodies = self.bodies.iter().enumerate();
        let bodies = bodies.map(|(i, body)| Part::rigid((&body.name, i), body.centre, edges(body)));
        let beams = self.beams.iter().zip(self.bodies.len()..);
        let beam = |((beam, _), i): (&(Beam, _), usize)| {
            let also = [beam.blade.breaks(), &beam.stations].concat();
            Part::beam((&beam.name, i), (beam.length, beam.elements), |s| beam.contour(s), None, &also)
        };
        bodies.chain(beams.map(beam)).collect()
    }
}

/// Edges of the homogeneous box with the moments of inertia of a body: a² = 6 (J₂ + J₃ − J₁)/m and so on.
fn edges(body: &Body) -> [f64; 3] {
    let [x, y, z] = [0, 1, 2].map(|i| body.inertia[i][i]);
    let edge = |square: f64| (6.0 * square / body.mass).max(0.0).sqrt();
    let edges = [edge(y + z - x), edge(x + z - y), edge(x + y - z)];
    let largest = edges.iter().copied().fold(0.0, f64::max);
    edges.map(|edge| edge.max(THINNEST * largest))
}
