//! Tables in files that a case names: each format a file.

pub mod columns;
pub mod deck;
pub mod rows;
pub mod section;
