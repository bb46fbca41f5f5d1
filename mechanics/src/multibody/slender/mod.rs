//! Slender beams in space.

mod beam;
mod element;
mod inertia;
mod loads;
mod pair;
mod properties;
mod shapes;
mod stiffness;
mod strain;
mod triad;

pub use beam::{Beam, BeamError, ELEMENT_COORDINATES, ELEMENT_VELOCITIES, Station};
pub use element::{Element, Motion, Tangent};
pub use loads::{Load, SectionForces};
pub use pair::Pair;
pub use properties::Properties;
pub use strain::{COORDINATES, VELOCITIES};
pub use triad::{Triad, Vector};
