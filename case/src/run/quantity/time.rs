//! The error of the time of an extreme.
//!
//! At an extreme of y, ẏ(t₀) = 0. An error δ(t) of y moves it by
//!
//! ```text
//! Δt = −δ̇(t₀)/ÿ(t₀)
//! ```
//!
//! where the extreme is curved. It stays among the times at which y comes as near to its extreme as the errors e of both values allow,
//! y(t) − y(t₀) ≤ e(t) + e(t₀): this bounds Δt of an extreme that is flat, and where several valleys are equally deep it may be in any of them.
//! δ is the difference from a more accurate run times a factor of safety; the largest of a few records stands for e and δ̇, since differences pass through zero.
//!
//! Of records with the distance h the vertex of a parabola through three is h²y‴/(6ÿ) beside the extreme. With the distance 2h it
//! is four times as far, so that the difference of the two vertices is three times the error.

use flexion_results::Trajectory;

/// Records on either side of an extreme that show its error.
const BESIDE: usize = 3;

/// A column of a run, and that of a more accurate run with a factor of safety.
pub struct Compared<'a> {
    pub ours: &'a Trajectory,
    pub theirs: &'a Trajectory,
    pub column: &'a str,
    pub safety: f64,
}

impl Compared<'_> {
    /// The error \[s\] of the time t₀ of the largest value, or of the smallest, within some times; `None` where nothing says how large it is.
    pub fn error_of_time(&self, largest: bool, time: f64, (from, to): (f64, f64)) -> Option<f64> {
        let (index, other) = (self.ours.index(self.column)?, self.theirs.index(self.column)?);
        let sign = if largest { -1.0 } else { 1.0 };
        let inside = self.ours.times().iter().zip(self.ours.values(index));
        // A smallest value of y, whatever was asked.
        let (t, y): (Vec<f64>, Vec<f64>) =
            inside.filter(|(t, _)| (from..=to).contains(*t)).map(|(t, y)| (*t, sign * y)).unzip();
        let off = |k: usize| Some(self.safety * (y[k] - sign * self.theirs.at(other, t[k])?));
        let nearest = (0..t.len()).min_by(|a, b| (t[*a] - time).abs().total_cmp(&(t[*b] - time).abs()))?;
        let (first, last) = (nearest.saturating_sub(BESIDE), (nearest + BESIDE).min(t.len() - 1));
        let beside: Vec<f64> = (first..=last).map(off).collect::<Option<_>>()?;
        let error = beside.iter().fold(0.0_f64, |most, off| most.max(off.abs()));
        let slopes = (first..last).zip(beside.windows(2));
        let slope =
            slopes.fold(0.0_f64, |most, (k, off)| most.max(((off[1] - off[0]) / (t[k + 1] - t[k])).abs()));
        let least = y[nearest];
        let spacing = (first..last).map(|k| t[k + 1] - t[k]).fold(0.0, f64::max);
        let narrow = vertex(&t, &y, nearest, 1);
        // A record is up to ÿh²/8 above its vertex.
        let above = narrow.map_or(0.0, |(_, curvature)| curvature * spacing * spacing / 8.0);
        // The errors of both values, each the largest of a few records.
        let around = |k: usize| (k.saturating_sub(BESIDE)..=(k + BESIDE).min(t.len() - 1)).filter_map(off);
        let error_at = |k: usize| around(k).fold(0.0_f64, |most, off| most.max(off.abs()));
        let near = |k: usize| y[k] - least <= error + error_at(k) + above;
        // The valley of the extreme, and the others that may be deeper.
        let left = (0..=nearest).rev().take_while(|k| near(*k)).last()?;
        let right = (nearest..t.len()).take_while(|k| near(*k)).last()?;
        let reach = (time - t[left]).max(t[right] - time) + spacing;
        let elsewhere = (0..t.len()).filter(|k| !(left..=right).contains(k) && near(*k));
        let elsewhere = elsewhere.map(|k| (t[k] - time).abs() + spacing).fold(0.0, f64::max);
        let moved = narrow.map_or(f64::INFINITY, |(_, curvature)| slope / curvature).min(reach);
        let of_records = match (narrow, vertex(&t, &y, nearest, 2)) {
            (Some((narrow, _)), Some((wide, _))) => (narrow - wide).abs() + (narrow - time).abs(),
            _ => spacing,
        };
        Some(elsewhere.max(moved + of_records.min(reach)))
    }
}

/// The vertex of the parabola through a record and those `step` beside it, and its curvature, where it opens upwards.
fn vertex(t: &[f64], y: &[f64], at: usize, step: usize) -> Option<(f64, f64)> {
    let (a, b) = (at.checked_sub(step)?, at + step);
    let (before, behind) = (t[at] - t[a], t.get(b)? - t[at]);
    let (down, up) = ((y[at] - y[a]) / before, (y[b] - y[at]) / behind);
    let curvature = 2.0 * (up - down) / (before + behind);
    let slope = (down * behind + up * before) / (before + behind);
    (curvature > 0.0).then(|| (t[at] - slope / curvature, curvature))
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexion_results::Trajectory;

    fn of(f: impl Fn(f64) -> f64, spacing: f64) -> Trajectory {
        let channel = flexion::system::Channel { name: "y".into(), ..Default::default() };
        let mut out = Trajectory::new(vec![channel]);
        for k in 0..=(2.0 / spacing) as usize {
            let t = k as f64 * spacing;
            out.push(t, |row| row[0] = f(t));
        }
        out
    }

    fn error(ours: &Trajectory, theirs: &Trajectory) -> (f64, f64) {
        let extremes = ours.extremes_within(0, 0.0, 2.0);
        let compared = Compared { ours, theirs, column: "y", safety: 2.0 };
        (extremes.t_min, compared.error_of_time(false, extremes.t_min, (0.0, 2.0)).unwrap())
    }

    /// y = 1 − cos(t − 1) + δ: the smallest value moves by δ̇/ÿ.
    #[test]
    fn a_slope_of_the_error_moves_a_curved_extreme() {
        let exact = of(|t| 1.0 - (t - 1.0).cos(), 0.01);
        for slope in [1e-6, 1e-4, 1e-2] {
            let (time, error) = error(&of(|t| 1.0 - (t - 1.0).cos() + slope * t, 0.01), &exact);
            let off = (time - 1.0).abs();
            assert!(off <= error && error < 4.0 * off + 1e-5, "{slope}: {off:.2e} {error:.2e}");
        }
    }

    /// y = (t − 1)⁴: a small error moves it far.
    #[test]
    fn a_flat_extreme_is_where_the_error_of_the_value_allows() {
        let exact = of(|t| (t - 1.0).powi(4), 0.01);
        let (time, error) = error(&of(|t| (t - 1.0).powi(4) + 1e-6 * t, 0.01), &exact);
        let off = (time - 1.0).abs();
        assert!(off > 4e-3 && off <= error && error < 0.05, "{off:.2e} {error:.2e}");
    }

    /// Two valleys as deep as each other within the error: it may be either.
    #[test]
    fn of_two_valleys_it_may_be_either() {
        let two = |t: f64| ((t - 0.5) * (t - 1.5)).powi(2);
        let (time, error) = error(&of(|t| two(t) + 1e-4 * t, 0.01), &of(|t| two(t) - 1e-4 * t, 0.01));
        assert!((time - 0.5).abs() < 0.01 && error > 0.99, "{time} {error}");
    }

    /// Without an error of the values that of the records is left.
    #[test]
    fn records_far_apart_leave_an_error() {
        let y = |t: f64| (-3.0 * t).exp() + t;
        for spacing in [0.05, 0.02, 0.01] {
            let run = of(y, spacing);
            let (time, error) = error(&run, &run);
            let off = (time - 3.0_f64.ln() / 3.0).abs();
            assert!(off <= error && error < 8.0 * off + 1e-9, "{spacing}: {off:.2e} {error:.2e}");
        }
    }
}
