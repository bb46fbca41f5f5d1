//! Contact: points of a model that touch obstacles, and what multipliers of rows with sets are.
//!
//! | file | content |
//! |---|---|
//! | `obstacle.rs` | rigid surfaces, at rest or moved |
//! | `force.rs` | continuous contact forces |
//! | `points.rs` | what a model says of its points |
//! | `law.rs` | a contact: point, obstacle, and what happens at a touch |
//! | `contacting/` | a model with contacts: rows, forces, energies |
//! | `cone.rs` | multipliers in their sets: u = b + W Λ, u and Λ complementary |
//! | `few.rs` | the same where W is formed: relaxed, or of least norm where rows follow from each other |
//! | `augmented.rs` | the same of many rows, by Newton's method for the motion that they make |
//! | `impact.rs` | velocities behind an impact, and the modes of the rows then |

mod augmented;
mod cone;
mod contacting;
mod few;
mod force;
mod impact;
mod law;
mod obstacle;
mod points;

pub use augmented::Augmented;
pub use cone::{Driven, FEW, RowLaw, Unresolved};
pub use contacting::Contacting;
pub use few::Few;
pub use force::{ContactForce, Dissipation, Response, delivered};
pub use impact::{Bounds, Impact, ImpactError, ImpactMap, Neglected};
pub use law::{Contact, Law};
pub use obstacle::{Circle, Obstacle, Plane, Sphere, Surface, Translation};
pub(crate) use points::TOUCHING;
pub use points::{Curve, PointMotion, Points, Variation};
