//! The nearest valid name to a misspelt one.

use strsim::osa_distance;

/// The candidate within a small edit distance of `written`, the nearest first in order of `candidates`. `_`, a space and `-` count as
/// equal.
pub fn nearest<'c>(written: &str, candidates: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
    let plain =
        |text: &str| text.chars().map(|c| if matches!(c, '_' | ' ') { '-' } else { c }).collect::<String>();
    let written: String = plain(written).chars().take(64).flat_map(char::to_lowercase).collect();
    let limit = written.chars().count().div_ceil(3);
    candidates
        .into_iter()
        .map(|candidate| (osa_distance(&written, &plain(candidate)), candidate))
        .filter(|(distance, _)| *distance <= limit)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_is_found_and_a_far_one_is_not() {
        let names = ["length", "density", "modulus", "second-moment"];
        assert_eq!(nearest("lenght", names), Some("length"));
        assert_eq!(nearest("Densty", names), Some("density"));
        assert_eq!(nearest("second_moment", names), Some("second-moment"));
        assert_eq!(nearest("rado", ["radau", "newmark"]), Some("radau"));
        assert_eq!(nearest("banana", names), None);
        assert_eq!(nearest("", names), None);
    }
}
