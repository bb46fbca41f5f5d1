//! `case.resolved.toml`: the case a run really used, with every default written out.

use super::VERSION;

/// The resolved case `text` (TOML) below a comment that says which version resolved it, so that the
/// run can be repeated from this file alone.
pub fn resolved_case(text: &str) -> String {
    let end = if text.is_empty() || text.ends_with('\n') { "" } else { "\n" };
    format!("# The case as it was run, every default written out, by Flexion {VERSION}.\n\n{text}{end}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_resolved_case_is_the_same_toml_and_names_the_version() {
        let text = resolved_case("[beam]\nlength = 8.0");
        assert!(text.starts_with('#') && text.contains(VERSION) && text.ends_with("8.0\n"));
        let table: toml::Table = text.parse().unwrap();
        assert_eq!(table["beam"]["length"].as_float(), Some(8.0));
    }
}
