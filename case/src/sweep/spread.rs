//! Rows that lie far apart among the inputs, of which errors are estimated.

use super::points::Column;
use std::cmp::Ordering;

/// Picks `count` of `rows` rows: the first is the nearest to the middle of all inputs, each further one the farthest from those
/// picked before (Gonzalez 1985, doi:10.1016/0304-3975(85)90224-5). Distances are taken over the range of each input; two texts are one apart.
/// Of rows as far the one with the smaller inputs is taken, so that the order of rows does not matter.
pub(super) fn spread(columns: &[Column], rows: usize, count: usize) -> Vec<bool> {
    if count >= rows {
        return vec![true; rows];
    }
    let mut picked = vec![false; rows];
    let scales: Vec<[f64; 2]> = columns.iter().map(range).collect();
    let part = |column: usize, row: usize| match &columns[column] {
        Column::Numbers(of) => {
            let [low, range] = scales[column];
            if range > 0.0 { (of[row] - low) / range } else { 0.5 }
        }
        Column::Texts(_, of) => f64::from(of[row]),
    };
    let between = |a: usize, b: usize| {
        let squares = (0..columns.len()).map(|column| match &columns[column] {
            Column::Numbers(_) => (part(column, a) - part(column, b)).powi(2),
            Column::Texts(texts, of) => f64::from(u8::from(texts[of[a] as usize] != texts[of[b] as usize])),
        });
        squares.sum::<f64>()
    };
    let from_middle = |row: usize| {
        let squares = (0..columns.len()).map(|column| match &columns[column] {
            Column::Numbers(_) => (part(column, row) - 0.5).powi(2),
            Column::Texts(..) => 0.0,
        });
        squares.sum::<f64>()
    };
    let before = |a: usize, b: usize| {
        let order = columns.iter().map(|column| match column {
            Column::Numbers(of) => of[a].total_cmp(&of[b]),
            Column::Texts(texts, of) => texts[of[a] as usize].cmp(&texts[of[b] as usize]),
        });
        order.fold(Ordering::Equal, Ordering::then).then(a.cmp(&b)).is_lt()
    };
    let mut next = 0;
    let mut nearest = vec![f64::INFINITY; rows];
    for row in 1..rows {
        let (own, best) = (from_middle(row), from_middle(next));
        if own < best || own == best && before(row, next) {
            next = row;
        }
    }
    for _ in 0..count {
        picked[next] = true;
        let last = next;
        let mut found: Option<usize> = None;
        for row in 0..rows {
            nearest[row] = nearest[row].min(between(row, last));
            if picked[row] {
                continue;
            }
            let better = |best: usize| {
                nearest[row] > nearest[best] || nearest[row] == nearest[best] && before(row, best)
            };
            if found.is_none_or(better) {
                found = Some(row);
            }
        }
        let Some(found) = found else { break };
        next = found;
    }
    picked
}

/// The smallest value and the range of an input.
fn range(column: &Column) -> [f64; 2] {
    let Column::Numbers(of) = column else { return [0.0, 0.0] };
    let finite = || of.iter().copied().filter(|x| x.is_finite());
    let (low, high) = (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
    [low, high - low]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn picked_rows_are_spread_over_a_grid_and_not_over_its_rows() {
        // Every 21st row of a grid of 21 × 21 would have one value of the last input.
        let first: Vec<f64> = (0..441).map(|i| 1e9 * f64::from(i / 21)).collect();
        let last: Vec<f64> = (0..441).map(|i| 1e-3 * f64::from(i % 21)).collect();
        let columns = [Column::Numbers(first.clone()), Column::Numbers(last.clone())];
        let picked = spread(&columns, 441, 20);
        let rows: Vec<usize> = (0..441).filter(|i| picked[*i]).collect();
        assert_eq!(rows.len(), 20);
        let corners = [0, 20, 420, 440];
        assert!(corners.iter().all(|corner| picked[*corner]), "{rows:?}");
        for a in &rows {
            let near = |b: &&usize| {
                *b != a && ((first[*a] - first[**b]) / 2e10).hypot((last[*a] - last[**b]) / 2e-2) < 0.2
            };
            assert!(rows.iter().find(near).is_none(), "{rows:?}");
        }
    }

    #[test]
    fn the_order_of_rows_does_not_matter() {
        let numbers: Vec<f64> = (0..100).map(|i| f64::from(i * 37 % 101)).collect();
        let texts = |of: &[f64]| of.iter().map(|x| u32::from(*x > 50.0)).collect::<Vec<_>>();
        let names = ["a", "b"].map(str::to_owned).to_vec();
        let of = |numbers: Vec<f64>| {
            let columns = [Column::Texts(names.clone(), texts(&numbers)), Column::Numbers(numbers.clone())];
            let picked = spread(&columns, 100, 20);
            let mut values: Vec<f64> =
                numbers.into_iter().zip(picked).filter(|(_, p)| *p).map(|(x, _)| x).collect();
            values.sort_by(f64::total_cmp);
            values
        };
        let mut turned = numbers.clone();
        turned.reverse();
        assert_eq!(of(numbers), of(turned));
    }
}
