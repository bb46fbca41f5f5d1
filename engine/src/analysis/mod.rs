//! Analyses: plain functions over a system.
