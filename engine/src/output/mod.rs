//! Files: trajectory, summary, plots. Everything is written whole or not at all.
