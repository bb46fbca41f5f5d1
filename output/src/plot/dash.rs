//! Cutting a curve into dashes.

use super::sketch::Point;

/// The dashes of a line: `lengths` [px] drawn and left out in turn, measured along it.
pub(super) fn dashes(points: &[Point], lengths: &[f64]) -> Vec<Vec<Point>> {
    let mut pattern = lengths.iter().copied().cycle();
    let mut out = Vec::new();
    let mut dash: Vec<Point> = points.first().map(|&p| vec![p]).unwrap_or_default();
    let (mut drawing, mut left) = (true, pattern.next().unwrap_or(f64::INFINITY));
    for (a, b) in points.iter().zip(points.iter().skip(1)) {
        let length = (b.0 - a.0).hypot(b.1 - a.1);
        let mut done = 0.0;
        while length - done > left {
            done += left;
            dash.push((a.0 + (b.0 - a.0) * done / length, a.1 + (b.1 - a.1) * done / length));
            let whole = std::mem::take(&mut dash);
            dash.extend(whole.last());
            out.extend(drawing.then_some(whole));
            drawing = !drawing;
            left = pattern.next().unwrap_or(f64::INFINITY);
        }
        left -= length - done;
        dash.push(*b);
    }
    out.extend(drawing.then_some(dash));
    out.retain(|dash| dash.len() > 1);
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_do_not_depend_on_how_finely_the_curve_is_sampled() {
        // 30 px by 40 px: 50 px long, so six dashes begin, at 0, 9, … 45 px.
        let line = |n: u32| -> Vec<Point> {
            (0..=n).map(|i| f64::from(i) / f64::from(n)).map(|x| (30.0 * x, 40.0 * x)).collect()
        };
        let ends = |n| -> Vec<(f64, f64)> {
            dashes(&line(n), &[6.0, 3.0]).iter().map(|d| (d[0].0 / 30.0, d[d.len() - 1].0 / 30.0)).collect()
        };
        let (coarse, fine) = (ends(1), ends(1000));
        assert_eq!((coarse.len(), fine.len()), (6, 6));
        for (i, (c, f)) in coarse.iter().zip(&fine).enumerate() {
            let start = 9.0 * i as f64 / 50.0;
            assert!((c.0 - start).abs() < 1e-12 && (c.1 - (start + 0.12).min(1.0)).abs() < 1e-12);
            assert!((c.0 - f.0).abs() < 1e-12 && (c.1 - f.1).abs() < 1e-12);
        }
    }

    #[test]
    fn dots_and_dashes_take_turns() {
        let line = dashes(&[(0.0, 0.0), (30.0, 0.0)], &[8.0, 2.0, 1.0, 2.0]);
        let ends: Vec<(f64, f64)> = line.iter().map(|d| (d[0].0, d[1].0)).collect();
        assert_eq!(ends, [(0.0, 8.0), (10.0, 11.0), (13.0, 21.0), (23.0, 24.0), (26.0, 30.0)]);
    }
}
