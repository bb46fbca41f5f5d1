//! Contacts of the hub–beam.

mod conformance;
mod falling_pendulum;
