//! **Flexion**: rigid–flexible coupled dynamics of rotating and slender beams, in the plane and in space.
//!
//! From a section to the history of the tip: a beam of 10 m is clamped to a hub that spins up to 4 rad/s in 15 s, and
//! lags behind by 0.4 m (Wu & Haug 1988, doi 10.1002/nme.1620260202).
//!
//! ```
//! use flexion::analysis::recording::record;
//! use flexion::analysis::transient::{Ending, Plan};
//! use flexion::basis::{Field, Hermite, Lagrange};
//! use flexion::hub_beam::{Drive, Fields, Foreshortening, Hub, HubBeam, LinearCoupling};
//! use flexion::integrator::{Radau, Tolerance};
//! use flexion::profile::{Motion, SpinUp};
//! use flexion::section::{Resultants, Uniform};
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
//! let radau = Radau::new(Tolerance { relative: 1e-6, absolute: 1e-8 })?;
//! let run = record(&mut system, &radau, &Plan::new(20.0, 0.02)); // s
//! assert_eq!(run.ending, Ending::Finished);
//! let index = run.trajectory.index("tip.deflection").ok_or("no such column")?;
//! let tip = run.trajectory.extremes(index); // `run.column("tip.deflection")` has all values.
//! assert!((tip.min + 0.40034).abs() < 1e-5 && (tip.t_min - 6.95).abs() < 0.02, "{tip:?}");
//! # Ok(())
//! # }
//! ```
//!
//! In space a model has bodies, beams and joints. A stiff rod of length L that hangs on a ball joint and begins to fall from the
//! horizontal comes to its lowest place after K(½)/√(3g/2L) = 0.4834 s. What can be run on other meshes has its error beside every value:
//!
//! ```
//! use flexion::analysis::error::{Effort, Refinable, Variant, estimate};
//! use flexion::multibody::slender::{Beam, Properties, Station};
//! use flexion::multibody::{Flexible, Joint, Kind, Marker, Model, Multibody, Part};
//! use flexion::prelude::*;
//! use std::{error::Error, ops::ControlFlow};
//!
//! struct Rod;
//!
//! impl Refinable for Rod {
//!     type Run = Record;
//!     type Fault = Box<dyn Error>;
//!
//!     fn variant(&self) -> Variant {
//!         Variant::new(Plan::new(0.6, 0.005)).with_tolerance(Tolerance { relative: 1e-6, absolute: 1e-8 })
//!     }
//!
//!     fn run(&self, variant: &Variant, watch: &mut Watch<'_>) -> Result<Record, Box<dyn Error>> {
//!         let section = Properties::principal([1e7, 800.0, 1e3, 1e3], 0.8, [1e-4, 0.0, 0.0]); // EA, GJ, EI₂, EI₃, ρA, inertia
//!         let root = Station { position: [0.0; 3].into(), tangent: [1.0, 0.0, 0.0].into(), normal: [0.0, 1.0, 0.0].into() };
//!         let mut model = Model::new().with_gravity([0.0, 0.0, -9.81]);
//!         let beam = model.beam(Flexible::new("rod", Beam::straight(root, 1.0, variant.mesh.cells(4), section)?));
//!         let [ground, end] = [Part::Ground, Part::Section { beam, node: 0 }].map(|part| Marker::new(part, [0.0; 3]));
//!         model.joint(Joint::new("ball", Kind::Spherical, ground, end));
//!         Ok(variant.record(&mut Multibody::new(model)?, watch)?)
//!     }
//! }
//!
//! # fn main() -> Result<(), Box<dyn Error>> {
//! let mut watch = |_: &State| ControlFlow::Continue(());
//! let run = Rod.run(&Rod.variant(), &mut watch)?;
//! let errors = estimate(&Rod, &Rod.variant(), &run, Effort::Full, &mut watch)?;
//! let height = run.trajectory.index("rod.tip.position.z").ok_or("no such column")?;
//! let (tip, error) = (run.trajectory.extremes(height), errors.of("rod.tip.position.z").ok_or("no error")?);
//! println!("{:.6} ± {:.0e} m", tip.min, error.min);
//! assert!((tip.min + 1.0).abs() < 1e-3 && (tip.t_min - 0.4834).abs() < 2e-3, "{tip:?}");
//! assert!(error.min < 1e-4 && errors.doubts.is_empty(), "{errors:?}");
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
//! | make a beam on a rotating hub, with its loads | [`hub_beam`] | [`hub_beam::Coupling`] |
//! | let forces depend on place and velocity | [`law`] | [`law::ForceLaw`] |
//! | let torques and loads follow from the motion | [`command`] | [`command::Command`] |
//! | join and drive bodies and beams in space | [`multibody`] | [`section::BladeSection`] |
//! | write a model of one's own | [`system`] | [`system::Dynamics`], [`system::Events`], [`system::Steady`], [`system::Observed`] |
//! | integrate in time | [`integrator`] | [`integrator::Integrator`], [`integrator::Stepper`] |
//! | run, find equilibria, modes and Campbell diagrams | [`analysis`] | [`analysis::transient::Observer`] |
//! | have the columns of a run | [`analysis::recording`] | |
//! | have the error of every value, and refine to a tolerance | [`analysis::error`] | [`analysis::error::Refinable`] |
//! | check what one has written | [`verify`] | |
//! | compare with closed forms | [`exact`] | |
//! | compare strain energies of a rotating beam by its frequencies | [`strain_energy`] | |
//! | compute impulses of contacts with friction | [`contact`] | |
//! | solve band matrices and eigenproblems, integrate over a cell | [`linalg`], [`quadrature`] | |
//!
//! What the library does not do: a beam on a hub moves in one plane, and beams there have no shear; sections keep their shape; materials are
//! linear and elastic. Nothing here reads a case, writes a file, asks for the time or starts a
//! thread: that is left to the
//! program.

pub mod analysis;
pub mod basis;
pub mod command;
pub mod contact;
pub mod drive;
pub mod exact;
pub mod hub_beam;
pub mod integrator;
pub mod law;
pub mod linalg;
pub mod multibody;
pub mod profile;
pub mod quadrature;
pub mod section;
pub mod strain_energy;
pub mod system;
pub mod verify;

/// What most programs need: the traits of a system and of a method, runs and their records.
pub mod prelude {
    pub use crate::analysis::recording::{Record, Trajectory, Watch, record, record_from};
    pub use crate::analysis::transient::{Ending, Observer, Plan, Step, resume, transient};
    pub use crate::integrator::{GeneralizedAlpha, Integrator, Radau, Tolerance};
    pub use crate::system::{Dynamics, Events, Observed, State, Steady, System};
}
