//! Beams in space.

use super::cross_section::{Assumed, Section};
use super::curve::{Bent, CURVE, Curve, straight};
use super::damping::Damped;
use super::deck;
use super::name::name;
use super::section::SECTION;
use crate::declaration::Bound::*;
use crate::fault::{At, Fault, Faults, Made};
use crate::keys::{
    Later, boolean, choice, integer, keys, kind, number, place, quantities, quantity, table, text, vector,
};
use crate::kind::{Choice, Context, Is, Kind, Of, Table};
use crate::units::{ANGLE, ANGULAR_SPEED, BENDING_STIFFNESS, FACTOR, LENGTH, ROTARY_INERTIA, VELOCITY};
use flexion::linalg::Vec3;
use flexion::multibody::rotation::frame;
use flexion::multibody::slender::{Properties, Station};
use flexion::multibody::{self, BeamError, shear, slender};
use flexion::quadrature::Gauss;
use flexion::section::{AsStiffAcross, BladeResultants, BladeSection, Matrices, Shape};
use flexion_results::Contour;
use std::fmt;
use std::sync::Arc;

/// What holds an end of a beam.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// Nothing but the joints of the case.
    Free,
    /// It is clamped to the ground.
    Clamped,
    /// Its point is held.
    Hinged,
}

/// The ends of a beam.
pub static END: Choice<End> = Choice {
    name: "end",
    path: "beam.root",
    summary: "what holds an end of a beam in space, beside its joints",
    kinds: &[
        Kind {
            name: "free",
            summary: "nothing",
            source: "",
            example: "beam=[{length=1, section={kind='circle', modulus='70 GPa', density=2700, radius='1 cm'}, root='free'}]",
            make: &Is(End::Free),
        },
        Kind {
            name: "clamped",
            summary: "a fixed joint with the ground",
            source: "",
            example: "beam=[{length=1, section={kind='circle', modulus='70 GPa', density=2700, radius='1 cm'}, root='clamped', tip='free'}]",
            make: &Is(End::Clamped),
        },
        Kind {
            name: "hinged",
            summary: "a spherical joint with the ground",
            source: "",
            example: "beam=[{length=1, section={kind='circle', modulus='70 GPa', density=2700, radius='1 cm'}, root='hinged'}]",
            make: &Is(End::Hinged),
        },
    ],
};

/// A beam as a case describes it.
#[derive(Clone)]
pub struct Beam {
    /// Name.
    pub name: String,
    /// Length \[m\].
    pub length: f64,
    /// Centreline.
    pub curve: Curve,
    /// Angle of the tip section against the root that the case asks for \[rad\].
    pub twist: f64,
    /// The section.
    pub section: Section,
    /// The same with its stiffness out of the plane and in torsion.
    pub blade: Arc<dyn BladeSection>,
    /// Polar moment of inertia per length where it is given [kg·m].
    pub polar: Option<f64>,
    /// Number of elements.
    pub elements: usize,
    /// Whether it has shear strains.
    pub shear: bool,
    /// Whether it twists.
    pub torsion: bool,
    /// The shear factor that is given.
    pub shear_factor: Option<f64>,
    /// Place of the tension centre along n and b \[m\].
    pub tension_centre: [f64; 2],
    /// Stiffnesses that couple torsion and bending \[N·m²\].
    pub coupling: [f64; 3],
    /// Outline of the root section that is drawn, where one is given.
    pub outline: Option<Contour>,
    /// What holds root and tip.
    pub ends: [End; 2],
    /// Velocity of the root and angular velocity at the start.
    pub motion: [Option<Vec3>; 2],
    /// Damping in proportion to mass [1/s] and stiffness \[s\].
    pub damping: [f64; 2],
    /// Whether it stays in a plane, for its section is not known out of it.
    pub planar: bool,
    /// Recorded stations \[m\].
    pub stations: Vec<f64>,
    /// Recorded fibres: name, station, place.
    pub fibres: Vec<(String, f64, [f64; 2])>,
}

impl fmt::Debug for Beam {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name)
    }
}

/// Rows of a table for each element asked for up to which elements end at all of them.
const MOST_ROWS: usize = 4;
/// Poisson's ratio of a shape, if it is left out: that of most metals.
const POISSON_RATIO: f64 = 0.3;
/// Distance of a centre of mass from the axis, over the length, that is rounding.
/// Product of inertia about the centre of mass over the polar moment, from which on it is said that it is left out.
const TILTED: f64 = 1e-3;
const CENTRED: f64 = 1e-9;

impl Beam {
    /// The joints of its ends: name, kind, and the places that they join.
    pub fn held(&self) -> Vec<(String, String, [String; 2])> {
        let ends = self.ends.iter().zip(["root", "tip"]).filter(|(end, _)| **end != End::Free);
        let joint = |(end, name): (&End, &str)| {
            let kind = if *end == End::Clamped { "clamped" } else { "hinged" };
            (
                format!("{}-{name}", self.name),
                kind.to_owned(),
                ["ground".to_owned(), format!("{}.{name}", self.name)],
            )
        };
        ends.map(joint).collect()
    }

    /// Mass \[kg\].
    pub fn mass(&self) -> f64 {
        let mut ends = vec![0.0, self.length];
        ends.extend(self.blade.breaks());
        ends.sort_by(f64::total_cmp);
        let gauss = Gauss::new(8);
        let density = |s: f64| self.blade.resultants(s).mass;
        ends.windows(2).map(|range| gauss.integrate(range[0], range[1], density)).sum()
    }

    /// Outline of the section at a station: that of its shape; the given one, in proportion to the radii √(EI/EA) of the section;
    /// or that of the homogeneous rectangle of the same EA and EI.
    pub fn contour(&self, s: f64) -> Contour {
        let radii = |s: f64| {
            let of = self.blade.resultants(s);
            [of.chord_stiffness, of.flap_stiffness].map(|stiffness| (stiffness / of.axial_stiffness).sqrt())
        };
        let ([high, wide], [root_high, root_wide]) = (radii(s), radii(0.0));
        let shape = self.section.shapes.and_then(|[root, tip]| root.between(tip, s / self.length));
        match (&self.outline, shape) {
            (Some(outline), _) => outline.scaled([high / root_high, wide / root_wide]),
            (None, Some(shape)) => Contour::of(&shape),
            (None, None) => {
                Contour::of(&Shape::Rectangle { height: 12_f64.sqrt() * high, width: 12_f64.sqrt() * wide })
            }
        }
    }

    /// Whether its rotary inertia in bending is left out though it differs in both planes: in rotation Ω that leaves (I₂ − I₃) Ω² out of
    /// the stiffness of torsion.
    pub fn leaves_out_torsion(&self) -> bool {
        let of = self.blade.resultants(0.5 * self.length);
        let differ = (of.chord_inertia - of.flap_inertia).abs() > 0.01 * (of.chord_inertia + of.flap_inertia);
        differ && self.leaves_out_gyration()
    }

    /// Whether its rotary inertia in bending is left out, and that about its axis is not: half of the gyroscopic moment of a spin about it.
    pub fn leaves_out_gyration(&self) -> bool {
        let rotary = self.section.planar.resultants(0.5 * self.length).rotary_inertia;
        !self.planar && self.torsion && !self.shear && rotary == 0.0
    }

    /// Larger radius of gyration √(EI/EA) \[m\] in the middle.
    pub fn gyration(&self) -> f64 {
        let of = self.blade.resultants(0.5 * self.length);
        (of.chord_stiffness.max(of.flap_stiffness) / of.axial_stiffness).sqrt()
    }

    /// Stiffness and mass with shear at a station, of a section that says them.
    pub(super) fn matrices(&self, s: f64) -> Option<Matrices> {
        let mut of = self.blade.matrices(s)?.with_tension_centre(self.tension_centre);
        for ([i, j], c) in [[3, 4], [3, 5], [4, 5]].into_iter().zip(self.coupling) {
            of.stiffness[i][j] += c;
            of.stiffness[j][i] += c;
        }
        of.mass[3][3] = self.polar.unwrap_or(of.mass[3][3]);
        Some(of)
    }

    /// What a beam without shear leaves out of its section.
    pub fn left_out(&self) -> Option<String> {
        let deck = &self.section.deck.as_ref().filter(|_| !self.shear)?.0;
        let offset =
            |(_, of): &(f64, Matrices)| of.mass_centre().map(f64::abs).into_iter().fold(0.0, f64::max);
        let offset = deck.table.rows().iter().map(offset).fold(0.0, f64::max);
        let mut said = Vec::new();
        if !deck.silent.shear {
            said.push("the 6 × 6 sections of its deck are condensed at zero shear force".to_owned());
        }
        if deck.damping.is_some_and(|times| times.iter().any(|time| *time > 0.0)) {
            said.push("their damping is left out".to_owned());
        }
        if offset > CENTRED * deck.length {
            said.push(format!("the centres of mass, up to {offset:.4} m beside the axis, are put on it"));
        }
        let tilted = |(_, of): &(f64, Matrices)| {
            of.product_of_inertia().abs() > TILTED * (of.mass[4][4] + of.mass[5][5])
        };
        if deck.table.rows().iter().any(tilted) {
            said.push("the products of inertia of its sections are left out".to_owned());
        }
        let needed = if deck.silent.shear { "give the deck its stiffness in shear and " } else { "" };
        (!said.is_empty()).then(|| {
            let said = said.join("; ");
            format!(
                "beam `{}` is without shear: {said}; {needed}write `shear = true` to keep all of it",
                self.name
            )
        })
    }

    /// Stiffness and inertia without shear at a station.
    fn properties(&self, s: f64) -> Properties {
        let mut of = match &self.section.deck {
            Some((deck, _)) => {
                let (of, [polar, second, third]) = (Properties::from(&deck.matrices(s)), deck.inertia(s));
                // What turns about the axis leaves the plane: any inertia does.
                let polar = if self.planar { of.inertia[0] } else { polar };
                Properties { inertia: [polar, second, third], ..of }
            }
            None => Properties::from(&self.blade.resultants(s)),
        };
        if self.section.deck.is_none() && self.section.planar.resultants(s).rotary_inertia == 0.0 {
            of.inertia = [of.inertia[0], 0.0, 0.0];
        }
        of.inertia[0] = self.polar.unwrap_or(of.inertia[0]);
        let of = of.with_tension_centre(self.tension_centre).with_coupling(self.coupling);
        if self.torsion { of } else { of.without_torsion() }
    }

    /// The beam with elements that end where its section asks for it and at these stations \[m\], each cut into `parts`.
    pub fn built(&self, stations: &[f64], parts: usize) -> Made<multibody::Beam> {
        crate::features::apart(self.blade.jumps(), self.length)?;
        let mut ends = vec![0.0, self.length];
        // The sections of an element are seen at few points: it ends at every row, but for tables of very many rows of single numbers.
        if self.section.deck.is_some() || self.blade.breaks().len() <= MOST_ROWS * self.elements {
            ends.extend(self.blade.breaks());
        }
        let equal: Vec<f64> =
            (0..=self.elements).map(|i| self.length * (i as f64 / self.elements as f64)).collect();
        ends.extend(self.blade.ends(&equal, self.length / self.elements as f64));
        ends.extend(stations);
        ends.sort_by(f64::total_cmp);
        ends.dedup_by(|a, b| (*a - *b).abs() <= 1e-9 * self.length);
        let mut nodes = vec![0.0];
        for range in ends.windows(2) {
            let (from, to) = (range[0], range[1]);
            let share = (to - from) / self.length * self.elements as f64;
            let count = ((share - 1e-9).ceil() as usize).max(1) * parts;
            nodes.extend((1..count).map(|i| from + (to - from) * i as f64 / count as f64));
            nodes.push(to);
        }
        // A little inside its element, so that a section that jumps has the value of that element.
        let middle = |s: f64| s.clamp(1e-12 * self.length, (1.0 - 1e-12) * self.length);
        if self.shear_factor.is_some() && !(self.shear && self.section.shapes.is_some()) {
            let message = if self.shear {
                "is of a shape, which this section has not"
            } else {
                "is of a beam with shear"
            };
            let help = if self.shear { "leave it out" } else { "write `shear = true`, or leave it out" };
            return Err(Fault::new("shear-factor", message).help(help).into());
        }
        let built = if self.shear {
            self.says_shear()?;
            // The section says its matrices all along, or nowhere.
            let nothing = Matrices::principal([0.0; 6], 0.0, [0.0; 3]);
            let matrices = |s: f64| self.matrices(middle(s)).unwrap_or(nothing);
            shear::Beam::new(&nodes, |s| self.frame(s), matrices).map(multibody::Beam::from)
        } else {
            let properties = |s: f64| self.properties(middle(s));
            slender::Beam::new(&nodes, |s| (self.curve)(s), properties).map(multibody::Beam::from)
        };
        built.map_err(|error| self.blamed(&error))
    }

    /// Refuses a section that does not say how stiff it is in shear.
    fn says_shear(&self) -> Made<()> {
        if self.blade.matrices(0.5 * self.length).is_some() {
            return Ok(());
        }
        let message = format!("the section of beam `{}` does not say how stiff it is in shear", self.name);
        let help = if self.section.deck.is_some() {
            "give its table the columns `GA-chord` and `GA-flap`, or take a deck of 6 × 6 matrices; without shear, leave `shear` out"
        } else {
            "give a shape (`rectangle`, `circle`, `tube`, `ellipse`), `general` with `shear-stiffness` and \
             `shear-stiffness-across`, or matrices of 6 × 6; without shear, leave `shear` out"
        };
        Err(Fault::new("section", message).help(help).into())
    }

    /// Why no beam can be made, at the key that is to blame.
    fn blamed(&self, error: &BeamError) -> Faults {
        let key = match error {
            BeamError::Turned { .. } => "elements",
            BeamError::Section { .. } if self.coupling != [0.0; 3] => "coupling",
            BeamError::Section { .. } => "section",
            _ => "",
        };
        let fault = Fault::new(key, format!("beam `{}`: {error}", self.name));
        let middle = 0.5 * self.length;
        let of = self.blade.resultants(middle);
        match error {
            BeamError::Section { .. } if self.shear && !(of.flap_inertia > 0.0 && of.chord_inertia > 0.0) => {
                let [names, help] = self.section.lacks_inertia(&of);
                let message = format!(
                    "beam `{}` has shear, in which its sections turn on their own, and its section has no rotary inertia: {names} is 0",
                    self.name
                );
                Fault::new("section", message).help(help)
            }
            BeamError::Section { .. } if !self.shear && !(self.properties(middle).inertia[0] > 0.0) => fault.help(
                "give `polar-inertia` of the beam, the moment of inertia per length about the tangent [kg·m], which the section does not \
                 say: ρ (I₂ + I₃) of its shape",
            ),
            _ => fault,
        }
        .into()
    }
}

keys! {
    /// What a case says of the outline of a section.
    struct Outline {
        /// places of its corners along the height of the section
        y: Vec<f64> = quantities(&LENGTH, Any).or_empty();
        /// places across, along tangent × height
        z: Vec<f64> = quantities(&LENGTH, Any).or_empty();
    }

    /// What a case says of a beam.
    struct Written {
        /// name, which begins the names of its columns
        name: String = text().or_name("beam");
        /// length of its axis, which a curve through points and a deck say by themselves
        length: Option<f64> = quantity(&LENGTH, Positive);
        /// its root at the start, the origin if left out
        start: Option<Vec3> = vector(&LENGTH);
        /// direction from root to tip, [1, 0, 0] if left out
        direction: Option<Vec3> = vector(&FACTOR);
        /// direction of the height of the section, as far as the beam's allows; of a section as stiff along all axes
        /// [0, 0, 1] if left out, for an upright beam [1, 0, 0]
        up: Option<Vec3> = vector(&FACTOR);
        /// axis without stress, straight if left out; a deck has its own
        curve: Option<Bent> = kind(&CURVE);
        /// angle of the tip section against the root without stress, linear between
        twist: f64 = quantity(&ANGLE, Any).or(0.0);
        /// cross-section
        section: Later<Section> = kind(&SECTION).required();
        /// outline of its root section, for pictures; that of the shape if left out
        outline: Outline = table();
        /// it stays in the plane of x and y: a section that says nothing of torsion is as stiff in torsion and across as in the plane,
        /// and nothing acts out of it
        planar: bool = boolean().or_false();
        /// Poisson's ratio, for the stiffness of a shape in torsion and in shear, 0.3 if left out
        poisson_ratio: Option<f64> = number(Between(-0.99, 0.5));
        /// it has shear strains, by the stiffness GA of its section, and rotary inertia
        shear: bool = boolean().or_false();
        /// shear factor of a shape, Cowper's if left out
        shear_factor: Option<f64> = number(Positive);
        /// it twists; without, it is held so stiff in torsion that it hardly does; if left out, a deck that says too little of torsion is held
        torsion: Option<bool> = boolean();
        /// moment of inertia per length about the axis, that of the section if left out
        polar_inertia: Option<f64> = quantity(&ROTARY_INERTIA, Positive);
        /// place of the section's tension centre, [along the height, across], against the centreline, which goes through the centres of mass;
        /// bending stiffnesses are about axes through it
        tension_centre: Option<[f64; 2]> = quantities(&LENGTH, Any);
        /// stiffnesses that couple [torsion and bending across, torsion and bending along the height, the two bendings]
        coupling: Option<[f64; 3]> = quantities(&BENDING_STIFFNESS, Any);
        /// number of elements, if none end at other stations
        elements: usize = integer(1, 100_000).or_count(10);
        /// hold of the root, beside its joints
        root: End = choice(&END).or_name("free");
        /// hold of the tip, beside its joints
        tip: End = choice(&END).or_name("free");
        /// velocity of the root at the start; what joints and spin ask for, if left out
        velocity: Option<Vec3> = vector(&VELOCITY);
        /// angular velocity at the start, in the axes of space; what the joints ask for, if left out
        spin: Option<Vec3> = vector(&ANGULAR_SPEED);
        /// damping against the ground, of lumped masses on it too
        damping: Damped = table();
    }
}

/// The tables `[[beam]]`.
pub static BEAMS: Table<Beam> = Table::list(
    "beam",
    "beams",
    "beam=[{name='arm', length=1, start=[0, 0, 1], direction=[1, 1, 0], up=[0, 0, 1], twist='20 deg', root='clamped', elements=4, polar-inertia=1e-3, \
     section={kind='rectangle', modulus='70 GPa', density=2700, width='2 cm', height='1 cm', rotary-inertia=true}, \
     damping={mass=0.1, stiffness='1 ms'}, outline={y=['-5 mm', '5 mm', 0], z=[0, 0, '2 cm']}}]",
    &Of(make),
);

fn make(k: Written, c: &Context<'_>) -> Made<Beam> {
    let of_points = match &k.curve {
        Some(Bent::Through(points)) => Some(points.length()),
        _ => None,
    };
    let c = &Context { length: of_points.or(k.length), ..*c };
    let missing = || Fault::new("", "a beam needs a `length`");
    let section = match k.section.make("section", c) {
        // Sections that need a length have nothing else to say.
        Err(faults) if faults.0.is_empty() && c.length.is_none() && k.section.chosen() != Some("deck") => {
            return Err(missing().into());
        }
        made => made?.ok_or_else(Faults::default)?,
    };
    if let (Some(_), Some(length)) = (k.length, of_points) {
        let message = format!("the points make a curve of {length:.6} m: leave the length out");
        return Err(Fault::new("length", message).into());
    }
    if let (Some((_, true)), Some(_)) = (&section.deck, &k.curve) {
        return Err(Fault::new("curve", "the deck has a line of its own: leave the curve out").into());
    }
    let length = section.length.or(c.length).ok_or_else(missing)?;
    if k.poisson_ratio.is_some() && section.shapes.is_none() {
        let message = "is of a shape, which this section has not: it has no effect";
        return Err(Fault::new("poisson-ratio", message).help("leave it out").into());
    }
    let assumed =
        Assumed { poisson_ratio: k.poisson_ratio.unwrap_or(POISSON_RATIO), shear_factor: k.shear_factor };
    let mut blade: Arc<dyn BladeSection> = Arc::from(section.blade(assumed).at("section")?);
    let along =
        |of: &dyn Fn(&BladeResultants) -> bool| [0.0, length].iter().all(|s| of(&blade.resultants(*s)));
    let (stiff, heavy) = (
        along(&|of| of.torsional_stiffness > 0.0),
        k.polar_inertia.is_some() || along(&|of| of.flap_inertia + of.chord_inertia > 0.0),
    );
    let torsion = k.torsion.unwrap_or(k.shear || !section.is_blade || (stiff && heavy));
    if !torsion && k.shear {
        return Err(Fault::new("torsion", "a beam with shear twists")
            .help("leave `torsion` or `shear` out")
            .into());
    }
    if !torsion && k.torsion.is_none() {
        let lacks = if stiff { "rotary inertia about the axis" } else { "torsional stiffness GJ" };
        c.cautions.borrow_mut().push(format!(
            "the section of beam `{}` gives no {lacks}: its torsion is held, `torsion = false`",
            k.name
        ));
    }
    if k.shear && section.deck.as_ref().is_some_and(|(deck, _)| deck.silent.torsion && !deck.silent.shear) {
        return Err(Fault::new("section", "this deck says nothing of torsion, and a beam with shear twists")
            .help("give the deck its torsional stiffness GJ, or leave `shear` out: torsion is held then")
            .into());
    }
    // Another that is silent on torsion is refused for its shear.
    if !stiff && !k.shear && (torsion || !section.is_blade) {
        if !k.planar {
            let message = "this section says nothing of torsion, and a beam in space twists";
            let help = "give a shape (`rectangle`, `circle`, `tube`, `ellipse`), `general`, or a `deck` with GJ; for a motion in the plane \
                        of x and y write `planar = true` in [[beam]]";
            return Err(Fault::new("section", message).help(help).into());
        }
        blade = Arc::new(AsStiffAcross(blade));
        c.cautions.borrow_mut().push(format!(
            "the section of beam `{}` says nothing of torsion and of bending across: GJ and the stiffness across are taken as EI, which no \
             motion in the plane of x and y depends on",
            k.name
        ));
    }
    let name = name(Some(k.name), &["ground", "hub"])?;
    if of_points.is_some()
        && let Some((_, key)) =
            [(k.direction, "direction"), (k.start, "start")].iter().find(|(given, _)| given.is_some())
    {
        return Err(Fault::new(*key, "the points of the curve say it: leave it out").into());
    }
    let direction = match &k.curve {
        Some(Bent::Through(points)) => points.tangent(),
        _ => k.direction.unwrap_or(Vec3([1.0, 0.0, 0.0])),
    };
    let upright = direction[0] == 0.0 && direction[1] == 0.0;
    let usual = if upright { [1.0, 0.0, 0.0] } else { [0.0, 0.0, 1.0] };
    let up = k.up;
    let no_direction = |key| Fault::new(key, "has no direction: one of its components must not be zero");
    let axes = frame(direction, Some(up.unwrap_or(Vec3(usual)))).ok_or_else(|| no_direction("direction"))?;
    let (tangent, normal) = (axes.column(2), axes.column(0));
    if up.is_some_and(|up| up.cross(tangent).dot(up.cross(tangent)) <= 1e-12 * up.dot(up)) {
        let message = "is along the beam: the height of a section lies across";
        return Err(Fault::new("up", message).into());
    }
    let differ = |s: f64| {
        let r = blade.resultants(s);
        (r.flap_stiffness - r.chord_stiffness).abs() > 1e-9 * r.flap_stiffness.max(r.chord_stiffness)
    };
    if up.is_none() && [0.0, length].into_iter().any(differ) {
        let message = "is left out, and the section is stiffer along one of its axes than along the other";
        let help = "write the direction of its height, for example `up = [0, 0, 1]`";
        return Err(Fault::new("up", message).help(help).into());
    }
    let (start, twist) = (k.start.unwrap_or_default(), k.twist);
    let bent: Curve = match (k.curve, &section.deck) {
        (_, Some((deck, true))) => deck::curve(deck, tangent, normal),
        (None, _) => straight(tangent, normal),
        (Some(Bent::Along(curve)), _) => curve(length, tangent, normal),
        (Some(Bent::Through(points)), _) => Arc::new(points.stations(normal)),
    };
    let of = Arc::clone(&blade);
    let curve: Curve = Arc::new(move |s| {
        let at = bent(s);
        let (sin, cos) = libm::sincos(twist * s / length + of.resultants(s).twist);
        let across = at.tangent.cross(at.normal);
        Station { position: start + at.position, normal: cos * at.normal + sin * across, ..at }
    });
    Ok(Beam {
        name,
        length,
        curve,
        twist,
        section,
        blade,
        polar: k.polar_inertia,
        tension_centre: k.tension_centre.unwrap_or_default(),
        coupling: k.coupling.unwrap_or_default(),
        outline: outline(&k.outline)?,
        elements: k.elements,
        shear: k.shear,
        torsion,
        shear_factor: k.shear_factor,
        ends: [k.root, k.tip],
        motion: [k.velocity, k.spin],
        damping: [k.damping.mass, k.damping.stiffness],
        planar: k.planar,
        stations: vec![length],
        fibres: Vec::new(),
    })
}

/// The polygon through the corners that a case gives.
fn outline(Outline { y, z }: &Outline) -> Made<Option<Contour>> {
    if y.is_empty() && z.is_empty() {
        return Ok(None);
    }
    if y.len() != z.len() {
        let message = format!("there are {} values for {} corners", z.len(), y.len());
        return Err(Fault::new("outline.z", message).into());
    }
    let corners = y.iter().zip(z).map(|(y, z)| [*y, *z]).collect();
    let contour = Contour::through(corners);
    contour.map(Some).ok_or_else(|| Fault::new("outline", "its corners enclose no area").into())
}

/// A point of a section whose strain is recorded.
#[derive(Clone, Debug)]
pub struct Fibre {
    /// Name.
    pub name: String,
    /// Number of the beam, and arc length \[m\].
    pub on: (usize, f64),
    /// Place along the height and across \[m\].
    pub place: [f64; 2],
}

keys! {
    /// What a case says of a fibre.
    struct Point {
        /// name, which ends the name of its column
        name: String = text();
        /// station of a beam
        on: (usize, f64) = place();
        /// place along the height of the section
        y: f64 = quantity(&LENGTH, Any).or(0.0);
        /// place across, along tangent × height
        z: f64 = quantity(&LENGTH, Any).or(0.0);
    }
}

/// The tables `[[fibre]]`.
pub static FIBRES: Table<Fibre> = Table::list(
    "fibre",
    "points of sections of beams in space whose strain is recorded",
    "beam=[{length=1, section={kind='circle', modulus='70 GPa', density=2700, radius='1 cm'}, root='clamped'}]\n\
     load=[{on='tip', force=[0, 0, 1]}]\n\
     fibre=[{name='top', on='root', z='5 mm'}]",
    &Of(|k: Point, _| Ok(Fibre { name: name(Some(k.name), &[])?, on: k.on, place: [k.y, k.z] })),
);
