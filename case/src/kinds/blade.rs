//! The blade of a case: a beam that also bends out of the plane and twists.

use super::cross_section::{Assumed, Section};
use crate::declaration::Bound::*;
use crate::fault::{At, Fault, Faults, Made};
use crate::keys::{boolean, choice, integer, keys, number, quantity};
use crate::kind::{Choice, Context, Is, Kind, Of, Table};
use crate::units::{ANGLE, INERTIA, MASS};
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
    /// Into how many parts each is cut.
    refine: usize,
}

impl Blade {
    /// Number of elements, if none end at other stations.
    pub fn elements(&self) -> usize {
        self.elements * self.refine
    }

    /// Into how many parts each element is cut.
    pub fn refine(&self) -> usize {
        self.refine
    }

    /// The section with the twist of the table.
    ///
    /// # Errors
    /// A fault when the section makes no blade.
    pub fn section(&self, section: &Section) -> Made<Twisted> {
        let blade =
            section.blade(Assumed { poisson_ratio: self.poisson_ratio, shear_factor: None }).at("")?;
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
        blade::Blade::carrying(setting, &blade, model, (self.elements, self.refine), bodies).at("")
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
            example: "blade={pitch='5 deg', twist='-20 deg', strain-energy='linear', tip-mass='10 g'}",
            make: &Is(StrainEnergy::Linear),
        },
        Kind {
            name: "coupled",
            summary: "linear, with the terms of the Green strain that couple stretch and bending, for comparison only",
            source: "Zhao & Wu 2015, doi:10.6052/0459-1879-14-207",
            example: "blade={strain-energy='coupled', bending-second=false, stretched-inertia=false}",
            make: &Is(StrainEnergy::Coupled(Terms::ALL)),
        },
        Kind {
            name: "exact",
            summary: "geometrically exact, about its own steady state",
            source: "Meier, Popp & Wall 2014, doi:10.1016/j.cma.2014.05.017",
            example: "blade={precone='2 deg', strain-energy='exact', torsion=false}",
            make: &Is(StrainEnergy::Exact),
        },
    ],
};

keys! {
    /// What a case says of a blade; e is the steady stretch w₁′.
    struct Written {
        /// angle of the root section about the axis towards the tip; at 0 its height lies in the plane of rotation
        pitch: f64 = quantity(&ANGLE, Any).or(0.0);
        /// angle of the axis out of the plane of rotation, towards the vector of rotation
        precone: f64 = quantity(&ANGLE, Between(-1.5, 1.5)).or(0.0);
        /// angle of the tip section against the root, linear between, added to a twist in the section's file
        twist: f64 = quantity(&ANGLE, Any).or(0.0);
        /// mass of a body at the tip
        tip_mass: f64 = quantity(&MASS, NotNegative).or(0.0);
        /// moment of inertia of the body at the tip, the same about every axis
        tip_inertia: f64 = quantity(&INERTIA, NotNegative).or(0.0);
        /// strain energy
        strain_energy: StrainEnergy = choice(&STRAIN_ENERGY).or_name("exact");
        /// of `coupled`, the term 3e of EI w″²; kept if left out
        bending_first: Option<bool> = boolean();
        /// of `coupled`, the term (3/2)e² of EI w″²; kept if left out
        bending_second: Option<bool> = boolean();
        /// of `coupled`, the term −e² of EA w′²; kept if left out
        axial_first: Option<bool> = boolean();
        /// of `coupled`, the term −½e³ of EA w′²; kept if left out
        axial_second: Option<bool> = boolean();
        /// of `coupled`, the centrifugal force of the stretched blade; kept if left out
        stretched_inertia: Option<bool> = boolean();
        /// gyroscopic (Coriolis) terms are kept
        gyroscopic: bool = boolean().or_true();
        /// rotary inertia of sections is kept where it is known
        rotary_inertia: bool = boolean().or_true();
        /// torsion is kept; if left out, where the section says enough
        torsion: Option<bool> = boolean();
        /// Poisson's ratio, for the torsional stiffness of a section of one material
        poisson_ratio: f64 = number(Between(-0.99, 0.5)).or(0.3);
        /// number of equal elements
        elements: usize = integer(1, 100_000).or_count(40);
        /// into how many equal parts each element is cut, those between the rows of its section too
        refine: usize = integer(1, 1000).or_count(1);
    }
}

/// The table `[blade]`.
pub static BLADE: Table<Blade> = Table::one(
    "blade",
    "makes the beam a blade, which also bends out of the plane and twists",
    "blade={pitch='5 deg', tip-mass='10 g'}",
    &Of(make),
);

fn make(k: Written, c: &Context<'_>) -> Made<Blade> {
    let pitch = k.pitch;
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
            precone: k.precone,
            pitch,
            tip: Tip { mass: k.tip_mass, inertia: k.tip_inertia },
        },
        twist: k.twist,
        model: Model {
            strain_energy: strain_energy(&k)?,
            gyroscopic: k.gyroscopic,
            rotary_inertia: k.rotary_inertia,
            torsion: false,
            tension_torsion: true,
        },
        torsion: k.torsion,
        poisson_ratio: k.poisson_ratio,
        elements: k.elements,
        refine: k.refine,
    })
}

/// The strain energy, with the terms that are kept of the coupled one.
fn strain_energy(k: &Written) -> Made<StrainEnergy> {
    let terms = [
        ("bending-first", k.bending_first),
        ("bending-second", k.bending_second),
        ("axial-first", k.axial_first),
        ("axial-second", k.axial_second),
        ("stretched-inertia", k.stretched_inertia),
    ];
    let [bending_first, bending_second, axial_first, axial_second, stretched_inertia] =
        terms.map(|(_, written)| written.unwrap_or(true));
    match k.strain_energy {
        StrainEnergy::Coupled(_) => Ok(StrainEnergy::Coupled(Terms {
            bending_first,
            bending_second,
            axial_first,
            axial_second,
            stretched_inertia,
        })),
        energy => {
            let message = "a term of the strain energy `coupled`, which the blade does not have; write \
                           `strain-energy = \"coupled\"`, or leave the term out";
            let given = terms.iter().filter(|(_, written)| written.is_some());
            let faults: Vec<Fault> = given.map(|(term, _)| Fault::new(*term, message)).collect();
            if faults.is_empty() { Ok(energy) } else { Err(Faults(faults)) }
        }
    }
}
