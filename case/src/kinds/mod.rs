//! The kinds of every choice: each with its keys, an example and the maker of its part.

pub mod amplitude;
pub mod basis;
pub mod beam;
pub mod blade;
pub mod body;
pub mod centreline;
pub mod contact;
pub mod coupling;
pub mod cross_section;
pub mod curve;
pub mod damping;
pub mod deck;
pub mod force_law;
pub mod initial;
pub mod integrator;
pub mod joint;
pub mod load;
pub mod mass;
pub mod motion;
pub mod name;
pub mod obstacle;
mod profile;
pub mod rotation;
pub mod section;
pub mod spring;
pub mod torque;
pub mod vector;
