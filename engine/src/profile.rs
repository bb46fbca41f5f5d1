//! Functions of time or of place.
