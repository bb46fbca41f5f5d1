//! A panel whose axes are decided, with its curves in pixels from the upper left corner of its frame.

use super::axis::Resolved;
use super::decimate::decimate;
use super::sketch::Point;
use super::{Panel, Series};

/// A panel with its axes and the size of its frame decided.
pub(super) struct Placed<'a> {
    pub(super) panel: &'a Panel,
    pub(super) x: Resolved,
    pub(super) y: Resolved,
    /// Whether numbers and label stand below it.
    pub(super) x_labelled: bool,
    /// Width and height of the frame [px].
    pub(super) size: (f64, f64),
}

impl Placed<'_> {
    /// A point in the units of the axes, `None` where it cannot be drawn.
    pub(super) fn pixel(&self, (x, y): (f64, f64)) -> Option<Point> {
        let part = |axis: &Resolved, v: f64| {
            let (lo, hi) = axis.range;
            Some((axis.map(v)? - lo) / (hi - lo))
        };
        Some((self.size.0 * part(&self.x, x)?, self.size.1 * (1.0 - part(&self.y, y)?)))
    }

    /// What of a curve is in the frame, piece by piece.
    pub(super) fn strokes(&self, series: &Series) -> Vec<Vec<Point>> {
        let points: Vec<Option<Point>> = series.points.iter().map(|p| self.pixel(*p)).collect();
        let columns = 2 * self.size.0 as usize;
        let mut out = Vec::new();
        for piece in points.split(Option::is_none) {
            let piece: Vec<Point> = piece.iter().flatten().copied().collect();
            self.clip(&decimate(&piece, (0.0, self.size.0), columns), &mut out);
        }
        out
    }

    /// The outlines of the band about a curve, piece by piece, within the frame.
    pub(super) fn bands(&self, series: &Series) -> Vec<Vec<Point>> {
        let end = |(x, y): (f64, f64)| self.pixel((x, y)).map(|(x, y)| (x, y.clamp(0.0, self.size.1)));
        let limits = |((x, y), half): (&(f64, f64), &f64)| {
            let (high, low) = (end((*x, y + half))?, end((*x, y - half))?);
            (0.0..=self.size.0).contains(&high.0).then_some((high, low))
        };
        let limits: Vec<Option<(Point, Point)>> =
            series.points.iter().zip(&series.band).map(limits).collect();
        let mut out = Vec::new();
        for piece in limits.split(Option::is_none) {
            // The widest of those of one half of a pixel.
            let mut columns: Vec<(Point, Point)> = Vec::new();
            for (high, low) in piece.iter().flatten() {
                match columns.last_mut() {
                    Some((top, bottom)) if high.0 - top.0 < 0.5 => {
                        (top.1, bottom.1) = (top.1.min(high.1), bottom.1.max(low.1));
                    }
                    _ => columns.push((*high, *low)),
                }
            }
            if columns.len() > 1 {
                let upper = columns.iter().map(|(high, _)| *high);
                out.push(upper.chain(columns.iter().rev().map(|(_, low)| *low)).collect());
            }
        }
        out
    }

    /// The points of a series that are in the frame.
    pub(super) fn marks(&self, series: &Series) -> Vec<Point> {
        let inside = |(x, y): &Point| {
            let within = |v: f64, size: f64| (-1e-6..=size + 1e-6).contains(&v);
            within(*x, self.size.0) && within(*y, self.size.1)
        };
        series.points.iter().filter_map(|p| self.pixel(*p)).filter(inside).collect()
    }

    /// Adds the parts of a line that are in the frame.
    fn clip(&self, points: &[Point], out: &mut Vec<Vec<Point>>) {
        let mut last = None;
        for (a, b) in points.iter().zip(points.iter().skip(1)) {
            let Some((from, to)) = clipped(*a, *b, self.size) else { continue };
            match out.last_mut() {
                Some(stroke) if last == Some(from) => stroke.push(to),
                _ => out.push(vec![from, to]),
            }
            last = Some(to);
        }
    }
}

/// The part of a straight line in the rectangle from the origin to `size`.
fn clipped(a: Point, b: Point, size: (f64, f64)) -> Option<(Point, Point)> {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for (start, step, end) in [(a.0, dx, size.0), (a.1, dy, size.1)] {
        if step == 0.0 {
            if !(0.0..=end).contains(&start) {
                return None;
            }
            continue;
        }
        let (u, v) = (-start / step, (end - start) / step);
        (from, to) = (from.max(u.min(v)), to.min(u.max(v)));
    }
    let at = |t: f64| match t {
        0.0 => a,
        1.0 => b,
        _ => ((a.0 + t * dx).clamp(0.0, size.0), (a.1 + t * dy).clamp(0.0, size.1)),
    };
    (from <= to).then(|| (at(from), at(to)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_cut_where_it_leaves_the_frame() {
        let size = (10.0, 10.0);
        assert_eq!(clipped((-5.0, 5.0), (20.0, 5.0), size), Some(((0.0, 5.0), (10.0, 5.0))));
        assert_eq!(clipped((1.0, 1.0), (2.0, 2.0), size), Some(((1.0, 1.0), (2.0, 2.0))));
        assert_eq!(clipped((-5.0, 0.0), (5.0, -10.0), size), None);
        let (from, to) = clipped((2.0, -4.0), (2.0, 1e300), size).unwrap();
        assert!(from == (2.0, 0.0) && to.0 == 2.0 && (to.1 - 10.0).abs() < 1e-12, "{from:?} {to:?}");
    }
}
