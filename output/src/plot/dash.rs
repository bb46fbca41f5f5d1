//! Cutting a curve into dashes.

/// A step longer than this leaves the drawing by far [px]: it is left out.
const LONGEST: f64 = 1e5;

/// The dashes of a curve: `on` pixels drawn, `off` pixels left out, measured along the curve, with
/// `scale` pixels for each unit of x and y. The library begins its pattern anew at every point, so that
/// a finely sampled curve would come out solid; here the pattern runs through.
pub(super) fn dashes(points: &[(f64, f64)], scale: (f64, f64), on: f64, off: f64) -> Vec<Vec<(f64, f64)>> {
    let mut out = Vec::new();
    let mut dash: Vec<(f64, f64)> = points.first().map(|&p| vec![p]).unwrap_or_default();
    let (mut drawing, mut left) = (true, on);
    for w in points.windows(2) {
        let (a, b) = (w[0], w[1]);
        let length = ((b.0 - a.0) * scale.0).hypot((b.1 - a.1) * scale.1);
        if length.is_nan() || length > LONGEST {
            out.push(std::mem::replace(&mut dash, vec![b]));
            (drawing, left) = (true, on);
            continue;
        }
        let mut done = 0.0;
        while length - done > left {
            done += left;
            let p = (a.0 + (b.0 - a.0) * done / length, a.1 + (b.1 - a.1) * done / length);
            dash.push(p);
            if drawing {
                out.push(std::mem::take(&mut dash));
            }
            drawing = !drawing;
            left = if drawing { on } else { off };
        }
        left -= length - done;
        if drawing {
            dash.push(b);
        }
    }
    out.push(dash);
    out.retain(|dash| dash.len() > 1);
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_do_not_depend_on_how_finely_the_curve_is_sampled() {
        let line = |n: u32| -> Vec<(f64, f64)> {
            (0..=n).map(|i| f64::from(i) / f64::from(n)).map(|x| (x, 2.0 * x)).collect()
        };
        // 30 px by 40 px: 50 px long, so six dashes begin, at 0, 9, … 45 px.
        let ends = |n| -> Vec<(f64, f64)> {
            dashes(&line(n), (30.0, 20.0), 6.0, 3.0).iter().map(|d| (d[0].0, d[d.len() - 1].0)).collect()
        };
        let (coarse, fine) = (ends(1), ends(1000));
        assert_eq!((coarse.len(), fine.len()), (6, 6));
        for (i, (c, f)) in coarse.iter().zip(&fine).enumerate() {
            let start = 9.0 * i as f64 / 50.0;
            assert!((c.0 - start).abs() < 1e-12 && (c.1 - (start + 0.12).min(1.0)).abs() < 1e-12);
            assert!((c.0 - f.0).abs() < 1e-12 && (c.1 - f.1).abs() < 1e-12);
        }
    }
}
