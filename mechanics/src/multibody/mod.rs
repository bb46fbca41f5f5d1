//! Rigid bodies and slender beams in space, joined and driven.
//!
//! A body has the configuration (r, p) on ℝ³ × SO(3): the position r of its centre of mass in the inertial axes and the
//! unit quaternion p of its rotation R; its velocity is (ṙ, Ω) with ṙ in the inertial axes and the angular velocity Ω in
//! its own axes, Ṙ = R Ω̃. Increments d = (d_r, d_φ) act by r + d_r and p exp(d_φ). With the mass m, the inertia J about
//! the centre of mass, and forces F and moments L,
//!
//! ```text
//! m r̈ = F,     J Ω̇ + Ω × J Ω = Rᵀ L
//! ```
//!
//! A beam, [slender] or with [shear], adds its own unknowns. Joints, springs and loads act between [markers](Marker): frames that are fixed to bodies
//! or to the sections of beams at their nodes, of which a joint knows
//! position, axes, velocities, accelerations and their derivatives by the velocities of the part, and nothing else.
//! Constraints use the axes of markers, a·b = 0 and a·(x_B − x_A) = 0, so that no angle is singular.
//!
//! | file | content |
//! |---|---|
//! | `rotation` | quaternions, rotation vectors |
//! | `body` | a rigid body |
//! | `beam` | a beam of either kind: its unknowns, and what the others need of it |
//! | `station` | what is at a station of a beam |
//! | `flexible` | a beam as a part |
//! | `line_load` | loads along beams |
//! | `marker` | frames of parts, and their kinematics |
//! | `row` | scalar constraints between two markers |
//! | `joint` | joints as lists of rows, with their drives |
//! | `force` | springs, dampers, actuators and loads as forces between two markers |
//! | `contact_point`, `on_axis` | a point that may touch obstacles; one on the axis of a beam, at a station or nearest to an obstacle |
//! | `contact_points` | what contacts ask of them |
//! | `mounted` | the same of obstacles that parts carry |
//! | `layout` | order of bodies, nodes of beams and multipliers along the tree |
//! | `model` | what a user builds, with its faults |
//! | `consistency` | positions, ranks and velocities at the start |
//! | `constants` | what does not change in a run |
//! | `slender` | the geometrically exact slender beam |
//! | `shear` | the geometrically exact beam with shear |
//! | `system` | the equations of motion |
//! | `events` | breaks, and the jumps of prescribed speeds |
//! | `axis` | axes of rotation, and what on the ground allows it |
//! | `rotating` | the same in a frame that rotates, for steady rotation and its modes |
//! | `line_law` | force laws along beams |
//! | `observed`, `channels` | energies, power, recorded quantities |
//! | `root_axes` | a beam as its root sees it |
//! | `shares` | what a small motion moves |
//! | `reason` | why a run may have failed |

mod axis;
mod beam;
mod bending;
mod body;
mod channels;
mod consistency;
mod constants;
mod contact_point;
mod contact_points;
mod error;
mod events;
mod flexible;
mod force;
mod joint;
mod layout;
mod line_law;
mod line_load;
mod marker;
mod model;
mod mounted;
mod net;
mod observed;
mod on_axis;
mod reason;
mod root_axes;
mod rotating;
pub mod rotation;
mod row;
mod shares;
pub mod shear;
pub mod slender;
mod start;
mod station;
mod strain_forms;
mod system;

pub use axis::Axis;
pub use beam::Beam;
pub use body::Body;
pub use error::{BeamError, DependentRow, ModelError, PartFault, Violation};
pub use flexible::{Fibre, Flexible};
pub use force::{Axes, Directions, Load, Spring};
pub use joint::{Drive, Joint, Kind};
pub use line_law::LineLaw;
pub use line_load::LineLoad;
pub use marker::{Marker, Part};
pub use model::Model;
pub use rotating::Rotating;
pub use system::Multibody;
