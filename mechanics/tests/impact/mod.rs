//! Impacts and contacts: nonsmooth and event-driven integration against closed forms and published numbers, and contacts of
//! the hub–beam.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)] // in helpers of tests

mod accumulation;
mod bars;
mod conformance;
mod falling_pendulum;
mod models;
mod nonsmooth;
