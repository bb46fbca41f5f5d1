//! A flexible beam on a hub that turns about a fixed axis, in the hub's frame.
