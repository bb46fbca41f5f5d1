//! Contacts of the hub–beam and of small systems, against closed forms, published numbers and independent programs.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)] // in helpers of tests

mod accumulation;
mod balance;
mod bars;
mod bursts;
mod conformance;
pub mod falling_pendulum;
mod massless;
mod models;
mod nonsmooth;
mod properties;
mod published;
