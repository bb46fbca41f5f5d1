//! Impacts: nonsmooth and event-driven integration against closed forms and published numbers.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)] // in helpers of tests

mod accumulation;
mod bars;
mod models;
mod nonsmooth;
