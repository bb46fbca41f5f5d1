//! The nearest valid name to a misspelt one.

/// The candidate within a small edit distance of `written`, the nearest first in order of `candidates`.
pub fn nearest<'c>(written: &str, candidates: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
    let written: Vec<char> = written.chars().take(64).flat_map(char::to_lowercase).collect();
    let limit = written.len().div_ceil(3);
    candidates
        .into_iter()
        .map(|candidate| (distance(&written, &candidate.chars().collect::<Vec<_>>()), candidate))
        .filter(|(distance, _)| *distance <= limit)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

/// Damerau–Levenshtein distance in the restricted form (optimal string alignment): insertions,
/// deletions, substitutions and swaps of neighbours. `_` and `-` count as equal.
fn distance(a: &[char], b: &[char]) -> usize {
    let same = |a: char, b: char| a == b || (matches!(a, '_' | ' ') && b == '-');
    let width = b.len() + 1;
    let mut rows = vec![0; (a.len() + 1) * width];
    for i in 0..=a.len() {
        for j in 0..width {
            rows[i * width + j] = if i == 0 || j == 0 {
                i + j
            } else {
                let cost = usize::from(!same(a[i - 1], b[j - 1]));
                let mut best = (rows[(i - 1) * width + j] + 1)
                    .min(rows[i * width + j - 1] + 1)
                    .min(rows[(i - 1) * width + j - 1] + cost);
                if i > 1 && j > 1 && same(a[i - 1], b[j - 2]) && same(a[i - 2], b[j - 1]) {
                    best = best.min(rows[(i - 2) * width + j - 2] + 1);
                }
                best
            };
        }
    }
    rows[rows.len() - 1]
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
