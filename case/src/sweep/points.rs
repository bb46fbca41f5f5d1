//! The points of a sweep: the values of all inputs, row by row.

use super::distribution::Distribution;
use super::inputs::{Inputs, Method, Sample};
use super::random::Random;

/// Most rows of a sweep.
pub(super) const MOST: usize = 10_000_000;
/// Most points of Sobol, and most inputs of them, that the crate `sobol_burley` has.
pub(super) const MOST_SOBOL: usize = 1 << 16;
pub(super) const MOST_SOBOL_INPUTS: usize = sobol_burley::NUM_DIMENSIONS as usize;
/// Half the distance of the numbers that `sobol_burley` gives, which are the lower ends of 2²³ parts.
const HALF: f64 = 0.5 / (1u64 << 23) as f64;

/// The values that an input takes.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Levels {
    /// Numbers in SI, one after another.
    Numbers(Vec<f64>),
    /// Texts as of `--set`.
    Texts(Vec<String>),
    /// From, to and how many: x = x₀ + (x₁ − x₀) i/(n − 1); without a number uniform between the ends, which are integers if so asked.
    Range { ends: [f64; 2], count: Option<usize>, whole: bool },
    /// Of a distribution.
    Distribution(Distribution),
}

impl Levels {
    /// How many there are; `None` of a continuum.
    fn count(&self) -> Option<usize> {
        match self {
            Levels::Numbers(list) => Some(list.len()),
            Levels::Texts(list) => Some(list.len()),
            Levels::Range { count, .. } => *count,
            Levels::Distribution(_) => None,
        }
    }

    /// The level of a number below the count.
    fn level(&self, index: usize) -> Level {
        match self {
            Levels::Numbers(list) => Level::Number(list[index]),
            Levels::Texts(_) => Level::Text(index as u32),
            Levels::Range { ends: [from, to], count, .. } => {
                let last = count.unwrap_or(2) - 1;
                // The last value is the one that is written.
                Level::Number(if index == last {
                    *to
                } else {
                    from + (to - from) * index as f64 / last as f64
                })
            }
            Levels::Distribution(of) => Level::Number(of.quantile(0.5)),
        }
    }

    /// The level below which the part u, 0 < u < 1, of all lies.
    fn quantile(&self, u: f64) -> Level {
        match self {
            Levels::Distribution(of) => Level::Number(of.quantile(u)),
            Levels::Range { ends: [from, to], whole: true, .. } => {
                Level::Number((from + (u * (to - from + 1.0)).floor()).min(*to))
            }
            Levels::Range { ends: [from, to], .. } => Level::Number(from + u * (to - from)),
            list => {
                let count = list.count().unwrap_or(1);
                list.level(((u * count as f64) as usize).min(count - 1))
            }
        }
    }
}

/// A value of an input: a number, or the number of a text.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Level {
    Number(f64),
    Text(u32),
}

/// The values of an input in all rows.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Column {
    /// Numbers in SI.
    Numbers(Vec<f64>),
    /// Texts, and which of them each row has.
    Texts(Vec<String>, Vec<u32>),
}

impl Column {
    /// The column of levels, one for each row.
    fn new(levels: &Levels, of_rows: impl Iterator<Item = Level>) -> Column {
        if let Levels::Texts(texts) = levels {
            let number = |level| if let Level::Text(number) = level { number } else { 0 };
            return Column::Texts(texts.clone(), of_rows.map(number).collect());
        }
        let number = |level| if let Level::Number(x) = level { x } else { f64::NAN };
        Column::Numbers(of_rows.map(number).collect())
    }
}

/// How many rows there are of these levels, or why there are none.
pub(super) fn count(inputs: &Inputs, levels: &[(String, Levels)]) -> Result<usize, String> {
    let too_many = |count: f64| format!("{count:.1e} runs are more than {MOST:.0e}, which a sweep may have");
    match (&inputs.table, inputs.sample) {
        (Some(table), _) => {
            if table.rows.len() > MOST {
                Err(too_many(table.rows.len() as f64))
            } else {
                Ok(table.rows.len())
            }
        }
        (None, Some(Sample { method, runs, .. })) => {
            if runs == 0 {
                return Err("a sample has at least one run".to_owned());
            }
            if method == Method::Sobol && (runs > MOST_SOBOL || levels.len() > MOST_SOBOL_INPUTS) {
                return Err(format!(
                    "there are points of Sobol for {MOST_SOBOL} runs of {MOST_SOBOL_INPUTS} inputs at most, not for {runs} runs of {}: \
                     write `lhs` for a Latin hypercube",
                    levels.len()
                ));
            }
            if runs > MOST { Err(too_many(runs as f64)) } else { Ok(runs) }
        }
        (None, None) => {
            let all: f64 = levels.iter().map(|(_, levels)| levels.count().unwrap_or(1) as f64).product();
            if all > MOST as f64 { Err(too_many(all)) } else { Ok(all as usize) }
        }
    }
}

/// The values of all inputs in all of these rows.
pub(super) fn columns(inputs: &Inputs, levels: &[(String, Levels)], rows: usize) -> Vec<Column> {
    let mut columns = Vec::with_capacity(levels.len());
    let mut repeated = rows;
    for (number, (_, levels)) in levels.iter().enumerate() {
        columns.push(match (&inputs.table, inputs.sample) {
            (Some(_), _) => Column::new(levels, (0..rows).map(|row| levels.level(row))),
            (None, Some(Sample { method: Method::LatinHypercube, seed, .. })) => {
                let mut random = Random::new(seed, number);
                let order = random.order(rows);
                let unit = order.into_iter().map(|part| (f64::from(part) + random.unit()) / rows as f64);
                Column::new(levels, unit.map(|u| levels.quantile(u)))
            }
            (None, Some(Sample { method: Method::Sobol, seed, .. })) => {
                let seed = (seed ^ (seed >> 32)) as u32;
                let unit =
                    |row: usize| f64::from(sobol_burley::sample(row as u32, number as u32, seed)) + HALF;
                Column::new(levels, (0..rows).map(|row| levels.quantile(unit(row))))
            }
            (None, None) => {
                let count = levels.count().unwrap_or(1);
                repeated /= count;
                Column::new(levels, (0..rows).map(|row| levels.level(row / repeated % count)))
            }
        });
    }
    columns
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(levels: Vec<Levels>, sample: Option<Sample>) -> Vec<Column> {
        let inputs = Inputs { sample, ..Inputs::default() };
        let levels: Vec<_> = levels.into_iter().map(|levels| ("key".to_owned(), levels)).collect();
        let rows = count(&inputs, &levels).unwrap();
        columns(&inputs, &levels, rows)
    }

    fn numbers(column: &Column) -> &[f64] {
        if let Column::Numbers(of) = column { of } else { panic!("{column:?}") }
    }

    fn range(from: f64, to: f64, count: Option<usize>) -> Levels {
        Levels::Range { ends: [from, to], count, whole: false }
    }

    #[test]
    fn a_grid_holds_all_combinations_and_the_last_input_changes_fastest() {
        let texts = Levels::Texts(["a", "b"].map(str::to_owned).to_vec());
        let grid = of(vec![range(1.0, 2.0, Some(3)), texts, Levels::Numbers(vec![5.0, 7.0])], None);
        assert_eq!(numbers(&grid[0]), [1.0, 1.0, 1.0, 1.0, 1.5, 1.5, 1.5, 1.5, 2.0, 2.0, 2.0, 2.0]);
        let Column::Texts(_, which) = &grid[1] else { panic!() };
        assert_eq!(which, &[0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1]);
        assert_eq!(numbers(&grid[2]), [5.0, 7.0, 5.0, 7.0, 5.0, 7.0, 5.0, 7.0, 5.0, 7.0, 5.0, 7.0]);
    }

    #[test]
    fn each_part_of_an_input_of_a_latin_hypercube_holds_one_point() {
        let sample = |seed| Some(Sample { method: Method::LatinHypercube, runs: 500, seed });
        let cube = of(vec![range(0.0, 1.0, None), range(0.0, 1.0, None)], sample(7));
        for column in &cube {
            let mut parts: Vec<usize> = numbers(column).iter().map(|x| (x * 500.0) as usize).collect();
            parts.sort_unstable();
            assert!(parts.iter().enumerate().all(|(i, part)| i == *part));
        }
        // The inputs are not in step with one another, and a seed is a sample.
        let correlation: f64 = numbers(&cube[0])
            .iter()
            .zip(numbers(&cube[1]))
            .map(|(x, y)| 12.0 * (x - 0.5) * (y - 0.5) / 500.0)
            .sum();
        assert!(correlation.abs() < 0.15, "{correlation}");
        let again = |seed| of(vec![range(0.0, 1.0, None)], sample(seed));
        assert_eq!(again(7), again(7));
        assert_ne!(again(7), again(8));
    }

    #[test]
    fn points_of_sobol_are_a_net_in_every_pair_of_inputs() {
        let sample = |seed| Some(Sample { method: Method::Sobol, runs: 256, seed });
        let points = of(vec![range(0.0, 1.0, None), range(0.0, 1.0, None)], sample(3));
        // Of a net of base 2 every box of 2⁻ᵃ × 2⁻ᵇ, a + b = 8, holds one point of 256.
        for a in 0..=8u32 {
            let (across, up) = (2f64.powi(a as i32), 2f64.powi(8 - a as i32));
            let mut boxes: Vec<usize> = (0..256)
                .map(|i| {
                    let (x, y) = (numbers(&points[0])[i], numbers(&points[1])[i]);
                    (x * across) as usize + ((y * up) as usize) * across as usize
                })
                .collect();
            boxes.sort_unstable();
            assert!(boxes.iter().enumerate().all(|(i, of)| i == *of), "{a}");
        }
        assert_ne!(of(vec![range(0.0, 1.0, None)], sample(3)), of(vec![range(0.0, 1.0, None)], sample(4)));
        let too_many = Inputs {
            sample: Some(Sample { method: Method::Sobol, runs: 70_000, seed: 0 }),
            ..Inputs::default()
        };
        assert!(count(&too_many, &[]).unwrap_err().contains("Latin hypercube"));
    }

    #[test]
    fn samples_of_lists_and_integers_take_each_value_as_often() {
        let whole = Levels::Range { ends: [3.0, 6.0], count: None, whole: true };
        let sample = Some(Sample { method: Method::LatinHypercube, runs: 40, seed: 1 });
        let both = of(vec![whole, Levels::Texts(["a", "b"].map(str::to_owned).to_vec())], sample);
        for value in [3.0, 4.0, 5.0, 6.0] {
            assert_eq!(numbers(&both[0]).iter().filter(|x| **x == value).count(), 10);
        }
        let Column::Texts(_, which) = &both[1] else { panic!() };
        assert_eq!(which.iter().filter(|i| **i == 0).count(), 20);
    }
}
