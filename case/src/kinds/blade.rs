//! The blade of a case: a beam that also bends out of the plane and twists.

use super::section::Section;
use crate::declaration::{Bound::*, Key, Presence as Default, Presence::Optional, Type, Type::Quantity, key};
use crate::fault::{At, Fault, Faults, Made};
use crate::kind::{Choice, Context, Kind, Table};
use crate::units::{ANGLE, INERTIA, MASS};
use crate::values::Values;
use flexion::blade::{self, Body, Model, Setting, StrainEnergy, Terms, Tip};
use flexion::section::{BladeResultants, BladeSection, Twisted};

/// Pitch above which there is a caution: a feathered blade is pitched by a right angle \[rad\].
const LARGEST_PITCH: f64 = 1.7;

/// A blade, but for its section.
#[derive(Clone, Debug)]
pub struct Blade {
    /// Where it sits on the hub and how it is set; the radius of the hub is not yet known.
    setting: Setting,
    /// Angle of the tip section against the root [rad].
    twist: f64,
    /// The terms of its model.
    model: Model,
    /// Whether there is torsion; `None` if the section decides.
    torsion: Option<bool>,
    /// Poisson's ratio, from which the torsional stiffness of a material follows.
    poisson_ratio: f64,
    /// Number of elements.
    elements: usize,
}

impl Blade {
    /// Number of elements.
    pub fn elements(&self) -> usize {
        self.elements
    }

    /// The section with the twist of the table.
    ///
    /// # Errors
    /// A fault when the section makes no blade.
    pub fn section(&self, section: &Section) -> Made<Twisted> {
        let blade = section.blade(self.poisson_ratio).at("")?;
        Ok(Twisted { blade, rate: self.twist / self.setting.length })
    }

    /// Whether a blade of this section has torsion, and why.
    pub fn torsion(&self, section: &dyn BladeSection) -> (bool, &'static str) {
        // A section that says enough does so everywhere: at both ends and at every break.
        let mut stations = vec![0.0, self.setting.length];
        stations.extend(section.breaks());
        let lacks = |of: fn(&BladeResultants) -> bool| stations.iter().any(|&x| !of(&section.resultants(x)));
        match self.torsion {
            Some(true) => (true, "blade.torsion = true"),
            Some(false) => (false, "blade.torsion = false"),
            None if lacks(|r| r.torsional_stiffness > 0.0) => {
                (false, "the section gives no torsional stiffness GJ")
            }
            None if lacks(BladeResultants::has_torsion) => {
                (false, "the section gives no rotary inertia about its axis")
            }
            None => (true, "the section gives stiffness and inertia for it"),
        }
    }

    /// Mass of the body at the tip \[kg\].
    pub fn tip_mass(&self) -> f64 {
        self.setting.tip.mass
    }

    /// Pitch of the root section and precone \[rad\].
    pub fn angles(&self) -> [f64; 2] {
        [self.setting.pitch, self.setting.precone]
    }

    /// The blade with its section and the bodies on it, on a hub of the given radius \[m\], at rest.
    ///
    /// # Errors
    /// A fault of the table `blade` when section and setting make no blade.
    pub fn built(&self, section: &Section, hub_radius: f64, bodies: &[Body]) -> Made<blade::Blade> {
        let blade = self.section(section)?;
        let model = Model { torsion: self.torsion(&blade).0, ..self.model };
        let setting = Setting { hub_radius, ..self.setting };
        blade::Blade::carrying(setting, &blade, model, self.elements, bodies).at("")
    }
}

/// The kinds of strain energy.
pub static STRAIN_ENERGY: Choice<StrainEnergy> = Choice {
    name: "strain-energy",
    path: "blade.strain-energy",
    summary: "strain energy of a blade",
    kinds: &[
        Kind {
            name: "linear",
            summary: "quadratic in stretch and curvature, with foreshortening: the blade stays straight",
            source: "",
            keys: &[],
            example: "blade={pitch='5 deg', twist='-20 deg', strain-energy='linear', tip-mass='10 g'}",
            make: |_, _| Ok(StrainEnergy::Linear),
        },
        Kind {
            name: "coupled",
            summary: "linear, with the terms of the Green strain that couple stretch and bending, for comparison only",
            source: "Zhao & Wu 2015, doi:10.6052/0459-1879-14-207",
            keys: &[],
            example: "blade={strain-energy='coupled', bending-second=false, stretched-inertia=false}",
            make: |_, _| Ok(StrainEnergy::Coupled(Terms::ALL)),
        },
        Kind {
            name: "exact",
            summary: "geometrically exact, about its own steady state",
            source: "Meier, Popp & Wall 2014, doi:10.1016/j.cma.2014.05.017",
            keys: &[],
            example: "blade={precone='2 deg', strain-energy='exact', torsion=false}",
            make: |_, _| Ok(StrainEnergy::Exact),
        },
    ],
};

/// Keys of the terms of the strain energy `coupled`, e being the steady stretch w₁′.
static TERMS: [&str; 5] =
    ["bending-first", "bending-second", "axial-first", "axial-second", "stretched-inertia"];

/// The keys of `[blade]`.
static KEYS: &[Key] = &[
    key(
        "pitch",
        Quantity(&ANGLE, Any),
        Default::Number(0.0),
        "angle of the root section about the axis towards the tip; at 0 its height lies in the plane of rotation",
    ),
    key(
        "precone",
        Quantity(&ANGLE, Between(-1.5, 1.5)),
        Default::Number(0.0),
        "angle of the axis out of the plane of rotation, towards the vector of rotation",
    ),
    key(
        "twist",
        Quantity(&ANGLE, Any),
        Default::Number(0.0),
        "angle of the tip section against the root, linear between, added to a twist in the section's file",
    ),
    key("tip-mass", Quantity(&MASS, NotNegative), Default::Number(0.0), "mass of a body at the tip"),
    key(
        "tip-inertia",
        Quantity(&INERTIA, NotNegative),
        Default::Number(0.0),
        "moment of inertia of the body at the tip, the same about every axis",
    ),
    key("strain-energy", Type::Choice(&STRAIN_ENERGY), Default::Name("exact"), "strain energy"),
    key(TERMS[0], Type::Boolean, Optional, "of `coupled`, the term 3e of EI w″²; kept if left out"),
    key(TERMS[1], Type::Boolean, Optional, "of `coupled`, the term (3/2)e² of EI w″²; kept if left out"),
    key(TERMS[2], Type::Boolean, Optional, "of `coupled`, the term −e² of EA w′²; kept if left out"),
    key(TERMS[3], Type::Boolean, Optional, "of `coupled`, the term −½e³ of EA w′²; kept if left out"),
    key(
        TERMS[4],
        Type::Boolean,
        Optional,
        "of `coupled`, the centrifugal force of the stretched blade; kept if left out",
    ),
    key("gyroscopic", Type::Boolean, Default::Boolean(true), "gyroscopic (Coriolis) terms are kept"),
    key(
        "rotary-inertia",
        Type::Boolean,
        Default::Boolean(true),
        "rotary inertia of sections is kept where it is known",
    ),
    key("torsion", Type::Boolean, Optional, "torsion is kept; if left out, where the section says enough"),
    key(
        "poisson-ratio",
        Type::Number(Between(-0.99, 0.5)),
        Default::Number(0.3),
        "Poisson's ratio, for the torsional stiffness of a section of one material",
    ),
    key("elements", Type::Integer(1, 100_000), Default::Integer(40), "number of equal elements"),
];

/// The table `[blade]`.
pub static BLADE: Table<Blade> = Table {
    key: key(
        "blade",
        Type::Table(KEYS),
        Optional,
        "makes the beam a blade, which also bends out of the plane and twists",
    ),
    example: "blade={pitch='5 deg', tip-mass='10 g'}",
    make,
};

fn make(v: &Values, c: &Context<'_>) -> Made<Blade> {
    let pitch = v.number("pitch")?;
    if pitch.abs() > LARGEST_PITCH {
        c.cautions.borrow_mut().push(format!(
            "the blade is pitched by {:.1}°: where degrees are meant, write `pitch = \"{pitch} deg\"`",
            pitch.to_degrees()
        ));
    }
    Ok(Blade {
        setting: Setting {
            length: c.length()?,
            hub_radius: 0.0,
            precone: v.number("precone")?,
            pitch,
            tip: Tip { mass: v.number("tip-mass")?, inertia: v.number("tip-inertia")? },
        },
        twist: v.number("twist")?,
        model: Model {
            strain_energy: strain_energy(v, c)?,
            gyroscopic: v.boolean("gyroscopic")?,
            rotary_inertia: v.boolean("rotary-inertia")?,
            torsion: false,
            tension_torsion: true,
        },
        torsion: v.optional_boolean("torsion")?,
        poisson_ratio: v.number("poisson-ratio")?,
        elements: v.count("elements")?,
    })
}

/// The strain energy, with the terms that are kept of the coupled one.
fn strain_energy(v: &Values, c: &Context<'_>) -> Made<StrainEnergy> {
    let mut written = [None; TERMS.len()];
    for (written, term) in written.iter_mut().zip(TERMS) {
        *written = v.optional_boolean(term)?;
    }
    let kept = |term: usize| written[term].unwrap_or(true);
    match STRAIN_ENERGY.make(v, "strain-energy", c)? {
        StrainEnergy::Coupled(_) => Ok(StrainEnergy::Coupled(Terms {
            bending_first: kept(0),
            bending_second: kept(1),
            axial_first: kept(2),
            axial_second: kept(3),
            stretched_inertia: kept(4),
        })),
        energy => {
            let message = "a term of the strain energy `coupled`, which the blade does not have; write \
                           `strain-energy = \"coupled\"`, or leave the term out";
            let given = TERMS.iter().zip(written).filter(|(_, written)| written.is_some());
            let faults: Vec<Fault> = given.map(|(term, _)| Fault::new(*term, message)).collect();
            if faults.is_empty() { Ok(energy) } else { Err(Faults(faults)) }
        }
    }
}
