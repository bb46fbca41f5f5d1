//! Contact: what multipliers of rows with sets are, at an impact and while a contact is closed.
//!
//! | file | content |
//! |---|---|
//! | `cone.rs` | multipliers in their sets: u = b + W Λ, u and Λ complementary |
//! | `impact.rs` | velocities behind an impact, and the modes of the rows then |

mod cone;
mod impact;

pub use cone::{Law, Unresolved, solve};
pub use impact::{Bounds, Impact, ImpactError, ImpactMap, Neglected};
