//! **Flexion**: rigid–flexible coupled dynamics of rotating and slender beams, in the plane of rotation.
//!
//! From a section to the history of the tip: a beam of 10 m is clamped to a hub that spins up to 4 rad/s in 15 s, and
//! lags behind by 0.4 m (Wu & Haug 1988, doi 10.1002/nme.1620260202).
//!
//! ```
//! use flexion::analysis::transient::{Ending, Observer, Plan, Step, transient};
//! use flexion::basis::{Field, Hermite, Lagrange};
//! use flexion::hub_beam::{Drive, Fields, Foreshortening, Hub, HubBeam, LinearCoupling};
//! use flexion::integrator::{Radau, Tolerance};
//! use flexion::profile::{Motion, SpinUp};
//! use flexion::section::{Resultants, Uniform};
//! use flexion::system::{Dynamics, State, System};
//! struct Tip(Vec<(f64, f64)>);
//! impl Observer for Tip {
//!     fn sample(&mut self, system: &mut dyn System, state: &State, _step: &Step) {
//!         let mut row = vec![0.0; system.channels().len()];
//!         system.record(state, &mut row); // `tip.deflection [m]` is the first of the channels.
//!         self.0.push((state.t, row[0]));
//!     }
//! }
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let (mass, axial_stiffness, bending_stiffness) = (1.2, 2.8e7, 1.4e4); // kg/m, N, N·m²
//! let section = Uniform::from_resultants(Resultants { mass, axial_stiffness, bending_stiffness, ..Default::default() })?;
//! let (axial, transverse) = (Lagrange::new(10.0, 10, 1)?, Hermite::new(10.0, 10, Field::Transverse)?);
//! let fields = Fields::new(10.0, Box::new(axial), Box::new(transverse), &[]);
//! let motion = Motion::Speed { profile: std::sync::Arc::new(SpinUp::new(4.0, 15.0)?), initial_angle: 0.0 };
//! let hub = Hub { radius: 0.0, inertia: 0.0, drive: Drive::Prescribed(motion) }; // m, kg·m²
//! let coupling = LinearCoupling::new(fields, &section, &hub, Foreshortening::First);
//! let mut system = HubBeam::new(hub, coupling, &[]);
//! let mut radau = Radau::new(Tolerance { relative: 1e-6, absolute: 1e-8 })?;
//! let (mut state, mut tip) = (system.initial(), Tip(Vec::new()));
//! let plan = Plan { end: 20.0, step: None, longest_step: None, contact_step: None, sample: 0.02 }; // s
//! assert_eq!(transient(&mut system, &mut radau, &mut state, &plan, &mut tip), Ending::Finished);
//! let &(time, peak) = tip.0.iter().min_by(|a, b| a.1.total_cmp(&b.1)).ok_or("no sample")?;
//! assert!((peak + 0.40034).abs() < 1e-5 && (time - 6.95).abs() < 0.02, "{peak} m at {time} s");
//! # Ok(())
//! # }
//! ```
//!
//! Every quantity is in SI units. A model and a method know each other only through the traits of [`system`].
//!
//! | to | see | trait to implement |
//! |---|---|---|
//! | describe a cross-section | [`section`] | [`section::Section`] |
//! | choose the functions of a displacement field | [`basis`] | [`basis::Basis`] |
//! | prescribe a motion, a torque or a load in time | [`profile`] | [`profile::Profile`] |
//! | make a beam on a rotating hub, with its loads | [`hub_beam`] | [`hub_beam::Coupling`], [`hub_beam::load::Load`] |
//! | find the small vibrations of a rotating blade in space | [`blade`] | [`section::BladeSection`] |
//! | join and drive rigid bodies in space | [`multibody`] | |
//! | compute a slender beam in space, large rotations and all | [`multibody::slender`] | |
//! | write a model of one's own | [`system`] | [`system::Dynamics`], [`system::Events`], [`system::Steady`], [`system::Observed`] |
//! | integrate in time | [`integrator`] | [`integrator::Integrator`] |
//! | run, record, find equilibria, modes and Campbell diagrams | [`analysis`] | [`analysis::transient::Observer`] |
//! | check what one has written | [`verify`] | |
//! | compare with closed forms | [`exact`] | |
//! | compute impulses of contacts with friction | [`contact`] | |
//! | solve band matrices and eigenproblems, integrate over a cell | [`linalg`], [`quadrature`] | |
//!
//! What the library does not do: a beam on a hub has no shear and moves in one plane; a blade in space has only small
//! vibrations about its steady rotation; bodies with joints are rigid; materials are linear and
//! elastic. Nothing here reads a case, writes a file, asks for the time or starts a thread: that is left to the
//! program.

pub mod analysis;
pub mod basis;
pub mod blade;
pub mod contact;
pub mod drive;
pub mod exact;
pub mod hub_beam;
pub mod integrator;
pub mod linalg;
pub mod multibody;
pub mod profile;
pub mod quadrature;
pub mod section;
pub mod system;
pub mod verify;
