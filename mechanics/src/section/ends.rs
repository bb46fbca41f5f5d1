//! Stations at which elements should end.

/// Area between the section and a straight line in an element, as a part of the section over the length of the elements asked for,
/// from which the element is divided.
const AREA: f64 = 1e-4;
/// Part of the largest value on the beam below which a resultant is measured by that.
const SMALL: f64 = 1e-2;
/// Ratio of a resultant at both ends of an interval of rows from which it is cut: curvatures are as the inverse of a stiffness, and those of
/// an element are straight.
const RATIO: f64 = 4.0;
/// Least part of the length that is cut off so: the stiffness of an element is as the inverse of the cube of its length, and rounding with it.
const LEAST: f64 = 2e-5;
/// Part of an interval by which the sides of a jump are told apart.
const INSIDE: f64 = 1e-9;

/// Stations inside a beam at which its elements with the ends `cells` should end where elements of the length `h` \[m\] were asked for: all
/// jumps, and of the other breaks those without which the section in an element would be far from a straight line. An element is divided at
/// the break that is farthest from the straight line through its ends, and its parts in turn, until for every resultant f
///
/// ```text
/// ∫ |f − line| / min(f, line) dx ≤ 1e-4 h
/// ```
///
/// and then cut where a resultant changes by more than a factor of 4 within it, halfway in its logarithm.
///
/// A notch that is far shorter than an element changes the flexibility by this area, and twice the elements would not show it; the many rows
/// of a smooth table have next to none and divide nothing. `values` are the resultants at a station; both lists ascend.
pub(crate) fn ends<const N: usize>(
    cells: &[f64],
    h: f64,
    (breaks, jumps): (&[f64], &[f64]),
    values: &dyn Fn(f64) -> [f64; N],
) -> Vec<f64> {
    let length = cells.last().copied().unwrap_or_default();
    let mut ends: Vec<f64> = jumps.iter().copied().filter(|x| 0.0 < *x && *x < length).collect();
    if breaks.len() > jumps.len() {
        let mut borders = cells.to_vec();
        borders.extend(&ends);
        borders.sort_by(f64::total_cmp);
        borders.dedup_by(|b, a| *b - *a <= INSIDE * length);
        let stations = || breaks.iter().copied().chain([0.0, length]);
        let largest = stations()
            .map(values)
            .fold([0.0_f64; N], |most, f| std::array::from_fn(|i| most[i].max(f[i].abs())));
        for pair in borders.windows(2) {
            let rows = &breaks[breaks.partition_point(|x| *x <= pair[0])..];
            let rows = &rows[..rows.partition_point(|x| *x < pair[1])];
            divide([pair[0], pair[1]], rows, [h, LEAST * length], &largest, values, &mut ends);
        }
    }
    ends.sort_by(f64::total_cmp);
    ends.dedup();
    ends
}

/// Divides an interval at one of the `rows` inside it, where it has to be, and its parts in turn.
fn divide<const N: usize>(
    [a, b]: [f64; 2],
    rows: &[f64],
    [h, least]: [f64; 2],
    largest: &[f64; N],
    values: &dyn Fn(f64) -> [f64; N],
    ends: &mut Vec<f64>,
) {
    let (first, last) = (values(a + INSIDE * (b - a)), values(b - INSIDE * (b - a)));
    let far = |x: f64| {
        let (s, f) = ((x - a) / (b - a), values(x));
        let of = |i: usize| {
            let line = first[i] + s * (last[i] - first[i]);
            let least = f[i].abs().min(line.abs()).max(SMALL * largest[i]);
            if least > 0.0 { (f[i] - line).abs() / least } else { 0.0 }
        };
        (0..N).map(of).fold(0.0, f64::max)
    };
    // By the trapezium rule through the rows.
    let (mut area, mut worst, mut before) = (0.0, (0, 0.0), (a, 0.0));
    for (i, &x) in rows.iter().enumerate() {
        let d = far(x);
        area += 0.5 * (x - before.0) * (before.1 + d);
        before = (x, d);
        if d > worst.1 {
            worst = (i, d);
        }
    }
    area += 0.5 * (b - before.0) * before.1;
    if area > AREA * h {
        let (i, x) = (worst.0, rows[worst.0]);
        ends.push(x);
        divide([a, x], &rows[..i], [h, least], largest, values, ends);
        divide([x, b], &rows[i + 1..], [h, least], largest, values, ends);
    } else if b - a < (1.0 - INSIDE) * h {
        let ratio = |i: usize| if first[i] * last[i] > 0.0 { last[i] / first[i] } else { 1.0 };
        let most = |i: usize| ratio(i).max(1.0 / ratio(i));
        let steepest = (0..N).fold(0, |best, i| if most(i) > most(best) { i } else { best });
        let parts = (libm::log(most(steepest)) / libm::log(RATIO) - INSIDE).ceil() as usize;
        let mut last = a;
        for k in 1..parts {
            let wanted = libm::pow(ratio(steepest), k as f64 / parts as f64);
            let rises = ratio(steepest) > 1.0;
            let (mut low, mut high) = (a, b);
            while high - low > 1e-6 * (b - a) {
                let x = 0.5 * (low + high);
                let beyond = values(x)[steepest] / first[steepest] > wanted;
                if beyond == rises { high = x } else { low = x }
            }
            let x = 0.5 * (low + high);
            if x - last >= least && b - x >= least {
                ends.push(x);
                last = x;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ends_of(h: f64, rows: &[(f64, f64)]) -> Vec<f64> {
        let breaks: Vec<f64> = rows.iter().map(|r| r.0).filter(|x| 0.0 < *x && *x < 10.0).collect();
        let line = |x: f64| {
            let i = rows.partition_point(|r| r.0 <= x).clamp(1, rows.len() - 1);
            let ((a, f), (b, g)) = (rows[i - 1], rows[i]);
            [f + (x - a) / (b - a) * (g - f)]
        };
        let cells: Vec<f64> = (0..=(10.0 / h) as usize).map(|i| h * i as f64).collect();
        ends(&cells, h, (&breaks, &[]), &line)
    }

    /// A notch of 6 cm, of a hundredth or to a hundredth of the section; one of a millionth is none.
    #[test]
    fn elements_end_at_a_notch_however_short() {
        let notch = |depth: f64| {
            ends_of(1.0, &[(0.0, 1.0), (6.14, 1.0), (6.17, 1.0 - depth), (6.20, 1.0), (10.0, 1.0)])
        };
        assert_eq!(notch(0.01), [6.14, 6.17, 6.20]);
        // 1 to a hundredth in four parts: each by √10.
        let cut = notch(0.99);
        assert!(cut.len() == 9 && [6.14, 6.17, 6.20].iter().all(|x| cut.contains(x)), "{cut:?}");
        let at = 6.14 + 0.03 * (1.0 - 0.1_f64.sqrt()) / 0.99;
        assert!((cut[1] - at).abs() < 1e-6, "{cut:?} {at}");
        assert!(notch(1e-6).is_empty());
    }

    /// The rows of (2 − x/10)² lie above their chords by w²/8·f″, the area of an element is w³/12·f″: 1/6 of the bound for 4 parts a
    /// metre, whatever the number of rows.
    #[test]
    fn many_rows_of_a_smooth_table_divide_few_elements() {
        let rows = |n: usize| -> Vec<(f64, f64)> {
            (0..=n).map(|i| 10.0 * i as f64 / n as f64).map(|x| (x, (2.0 - 0.1 * x).powi(2))).collect()
        };
        for n in [1000, 20_000] {
            let found = ends_of(1.0, &rows(n));
            assert!(found.len() <= 40, "{n}: {}", found.len());
        }
        // Elements that are as short as the rows need no further ends.
        assert!(ends_of(0.01, &rows(1000)).is_empty());
    }
}
