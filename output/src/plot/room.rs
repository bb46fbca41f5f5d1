//! Free places in a frame: where no curve, mark or word is.

use super::sketch::{Point, Rectangle};

/// Side of the cells into which a frame is divided [px].
const CELL: f64 = 2.0;

/// What of a frame is taken, cell by cell.
pub(super) struct Room {
    size: (f64, f64),
    columns: usize,
    rows: usize,
    taken: Vec<bool>,
}

impl Room {
    /// A free frame of the given size [px].
    pub(super) fn new(size: (f64, f64)) -> Room {
        let count = |length: f64| (length / CELL).ceil() as usize + 1;
        let (columns, rows) = (count(size.0), count(size.1));
        Room { size, columns, rows, taken: vec![false; columns * rows] }
    }

    /// Takes the cells along a line.
    pub(super) fn take_line(&mut self, points: &[Point]) {
        along(points).for_each(|(x, y)| self.take([x, y, x, y]));
    }

    /// Whether a line meets nothing that is taken.
    pub(super) fn is_clear(&self, points: &[Point]) -> bool {
        along(points).all(|(x, y)| !self.cells([x, y, x, y]).any(|cell| self.taken[cell]))
    }

    /// Takes a rectangle.
    pub(super) fn take(&mut self, rectangle: Rectangle) {
        for cell in self.cells(rectangle) {
            self.taken[cell] = true;
        }
    }

    /// Whether a rectangle lies in the frame, and nothing that is taken is nearer than `distance` [px].
    pub(super) fn is_free(&self, [left, top, right, bottom]: Rectangle, distance: f64) -> bool {
        let inside = left >= 0.0 && top >= 0.0 && right <= self.size.0 && bottom <= self.size.1;
        let wide = [left - distance, top - distance, right + distance, bottom + distance];
        inside && !self.cells(wide).any(|cell| self.taken[cell])
    }

    fn cells(&self, [left, top, right, bottom]: Rectangle) -> impl Iterator<Item = usize> + use<> {
        let range = |lo: f64, hi: f64, count: usize| {
            let end = ((hi / CELL).floor() + 1.0).max(0.0) as usize;
            ((lo / CELL).floor().max(0.0) as usize)..end.min(count)
        };
        let (columns, rows) = (range(left, right, self.columns), range(top, bottom, self.rows));
        let width = self.columns;
        rows.flat_map(move |row| columns.clone().map(move |column| row * width + column))
    }
}

/// Points of a line, no further apart than a cell.
fn along(points: &[Point]) -> impl Iterator<Item = Point> {
    points.iter().zip(points.iter().skip(1)).flat_map(|(a, b)| {
        let pieces = ((b.0 - a.0).abs().max((b.1 - a.1).abs()) / CELL).ceil().max(1.0);
        (0..=pieces as usize).map(move |i| {
            let part = i as f64 / pieces;
            (a.0 + part * (b.0 - a.0), a.1 + part * (b.1 - a.1))
        })
    })
}

/// Places along an edge for things of given sizes, as near as possible to where they are wanted, in ascending order,
/// without overlapping, and within [`from`, `to`] if they fit.
///
/// The least squares of the distances: with the sizes summed up and taken off, an isotonic regression.
pub(super) fn spread(wanted: &[f64], sizes: &[f64], from: f64, to: f64) -> Vec<f64> {
    let mut offsets = Vec::with_capacity(wanted.len());
    let mut sum = 0.0;
    for (i, size) in sizes.iter().enumerate() {
        sum += if i == 0 { 0.0 } else { 0.5 * (sizes[i - 1] + size) };
        offsets.push(sum);
    }
    // Blocks of things that touch: the sum of their places, and their number.
    let mut blocks: Vec<(f64, usize)> = Vec::new();
    for (place, offset) in wanted.iter().zip(&offsets) {
        let mut block = (place - offset, 1);
        while let Some(last) = blocks.pop_if(|last| last.0 / last.1 as f64 > block.0 / block.1 as f64) {
            block = (last.0 + block.0, last.1 + block.1);
        }
        blocks.push(block);
    }
    let means = blocks.iter().flat_map(|(sum, count)| std::iter::repeat_n(sum / *count as f64, *count));
    let half = |size: Option<&f64>| 0.5 * size.copied().unwrap_or(0.0);
    let (first, last) = (from + half(sizes.first()), to - half(sizes.last()) - sum);
    means.zip(&offsets).map(|(mean, offset)| mean.min(last).max(first) + offset).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_takes_the_room_along_it() {
        let mut room = Room::new((100.0, 50.0));
        room.take_line(&[(0.0, 0.0), (100.0, 50.0)]);
        assert!(!room.is_free([45.0, 20.0, 55.0, 30.0], 0.0));
        assert!(room.is_free([60.0, 5.0, 90.0, 20.0], 2.0));
        assert!(!room.is_clear(&[(0.0, 50.0), (100.0, 0.0)]) && room.is_clear(&[(20.0, 0.0), (100.0, 40.0)]));
        assert!(!room.is_free([60.0, 5.0, 90.0, 29.0], 20.0) && !room.is_free([90.0, 5.0, 101.0, 20.0], 0.0));
    }

    #[test]
    fn things_on_an_edge_move_apart_and_no_further() {
        assert_eq!(spread(&[10.0, 50.0], &[12.0, 12.0], 0.0, 100.0), [10.0, 50.0]);
        assert_eq!(spread(&[40.0, 42.0, 90.0], &[12.0, 12.0, 12.0], 0.0, 100.0), [35.0, 47.0, 90.0]);
        assert_eq!(spread(&[98.0, 99.0], &[12.0, 12.0], 0.0, 100.0), [82.0, 94.0]);
        assert_eq!(spread(&[1.0, 1.0, 1.0], &[10.0, 20.0, 10.0], 0.0, 100.0), [5.0, 20.0, 35.0]);
    }
}
