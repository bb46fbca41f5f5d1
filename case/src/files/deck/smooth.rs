//! Values along a blade, and those that leave their neighbours.

/// A deck is smooth elsewhere where at least so many other stations leave their neighbours by less than this power less.
pub(super) const ELSEWHERE: (usize, f64) = (6, 2.5);

/// By how much the values from i to j are all above, or all below, those on both sides; 0 where they are not.
pub(super) fn leaving(v: &[f64], i: usize, j: usize) -> f64 {
    let (least, most) =
        v[i..=j].iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(*x), b.max(*x)));
    let [before, behind] = [v[i - 1], v[j + 1]];
    (least - before.max(behind)).max(before.min(behind) - most).max(0.0)
}

/// Whether stations apart from the i-th of n, enough of them, leave their neighbours by much less than `here`.
pub(super) fn is_smooth(n: usize, i: usize, leaves: impl Fn(usize) -> f64, here: f64) -> bool {
    let others = (1..n - 1).filter(|k| k.abs_diff(i) > 2);
    others.clone().count() >= ELSEWHERE.0
        && others.fold(0.0_f64, |most, k| most.max(leaves(k))) * ELSEWHERE.1 < here
}
