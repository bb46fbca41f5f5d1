//! Thinning of long curves to what a drawing can show.

/// The points of one unbroken piece of a curve, thinned to at most four for each of `columns` equal
/// slices of [`from`, `to`] in x: the first, lowest, highest and last of a slice, in their order, so
/// that neither a peak nor a jump is lost. A piece short enough is returned as it is, and so is one
/// whose x does not ascend.
pub(super) fn decimate(points: &[(f64, f64)], (from, to): (f64, f64), columns: usize) -> Vec<(f64, f64)> {
    let ascending = points.windows(2).all(|w| w[0].0 <= w[1].0);
    if points.len() <= 4 * columns || !ascending || to <= from {
        return points.to_vec();
    }
    let column = |x: f64| (((x - from) / (to - from) * columns as f64) as usize).min(columns);
    let mut out = Vec::with_capacity(4 * columns + 4);
    for slice in points.chunk_by(|a, b| column(a.0) == column(b.0)) {
        let by_y = |a: &usize, b: &usize| slice[*a].1.total_cmp(&slice[*b].1);
        let indices = 0..slice.len();
        let lowest = indices.clone().min_by(by_y).unwrap_or(0);
        let highest = indices.max_by(by_y).unwrap_or(0);
        let mut kept = [0, lowest.min(highest), lowest.max(highest), slice.len() - 1];
        kept.sort_unstable();
        for (k, &i) in kept.iter().enumerate() {
            if k == 0 || kept[k - 1] != i {
                out.push(slice[i]);
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_single_spike_among_a_million_points_survives() {
        let n = 1_000_000;
        let mut points: Vec<(f64, f64)> = (0..n).map(|i| (f64::from(i), 0.0)).collect();
        points[123_456].1 = 7.0;
        points[654_321].1 = -3.0;
        let thin = decimate(&points, (0.0, f64::from(n - 1)), 700);
        assert!(thin.len() <= 4 * 701, "{}", thin.len());
        assert!(thin.contains(&(123_456.0, 7.0)) && thin.contains(&(654_321.0, -3.0)));
        assert_eq!((thin.first(), thin.last()), (points.first(), points.last()));
        assert!(thin.windows(2).all(|w| w[0].0 < w[1].0));
    }

    #[test]
    fn a_short_curve_and_a_closed_one_are_left_alone() {
        let short = vec![(0.0, 1.0), (1.0, 2.0)];
        assert_eq!(decimate(&short, (0.0, 1.0), 10), short);
        let circle: Vec<(f64, f64)> =
            (0..1000).map(|i| (f64::from(i) * 0.01).sin_cos()).map(|(s, c)| (c, s)).collect();
        assert_eq!(decimate(&circle, (-1.0, 1.0), 10), circle);
    }
}
