//! What each integrator promises: order, stability, dissipation, dense output, messages.

mod adaptive;
mod constraints;
mod drive;
mod order;
mod stability;
mod systems;
