//! The values of functions at the points of a cell, and the two sums that they enter: over the functions at each point, and
//! over the points with each function. Four points lie side by side, so that both sums take four at a time; behind the
//! last point are zeros.

/// Points that lie side by side.
pub const LANES: usize = 4;

/// φᵢ(x_g) of every function i at every point g.
#[derive(Clone, Debug, Default)]
pub struct Table {
    points: usize,
    functions: usize,
    /// Entry `g / LANES`·functions + i holds φᵢ at `LANES` points.
    data: Vec<[f64; LANES]>,
}

impl Table {
    /// A table without points of so many functions.
    pub fn new(functions: usize) -> Table {
        Table { points: 0, functions, data: Vec::new() }
    }

    /// Adds a point, with a value of each function.
    pub fn push(&mut self, values: &[f64]) {
        let lane = self.points % LANES;
        if lane == 0 {
            self.data.resize(self.data.len() + self.functions, [0.0; LANES]);
        }
        let first = self.data.len() - self.functions;
        for (entry, value) in self.data[first..].iter_mut().zip(values) {
            entry[lane] = *value;
        }
        self.points += 1;
    }

    /// The values of all functions at point `g`.
    pub fn at(&self, g: usize) -> impl Iterator<Item = f64> + Clone + '_ {
        let first = g / LANES * self.functions;
        self.data[first..first + self.functions].iter().map(move |entry| entry[g % LANES])
    }

    /// Calls `put` with Σᵢ φᵢ(x_g) cᵢ at every point g, for three sets of coefficients at once.
    #[inline(always)]
    pub fn values(&self, coefficients: &[[f64; 3]], mut put: impl FnMut(usize, [f64; 3])) {
        for (b, block) in self.data.chunks_exact(self.functions.max(1)).enumerate() {
            let [mut s0, mut s1, mut s2] = [[0.0; LANES]; 3];
            for (phi, &[c0, c1, c2]) in block.iter().zip(coefficients) {
                for lane in 0..LANES {
                    s0[lane] += phi[lane] * c0;
                    s1[lane] += phi[lane] * c1;
                    s2[lane] += phi[lane] * c2;
                }
            }
            for lane in 0..LANES.min(self.points - b * LANES) {
                put(b * LANES + lane, [s0[lane], s1[lane], s2[lane]]);
            }
        }
    }

    /// Calls `put` with Σ_g φᵢ(x_g) f_g of every function i; `forces` holds `LANES` points each.
    #[inline(always)]
    pub fn moments(&self, forces: &[[f64; LANES]], mut put: impl FnMut(usize, f64)) {
        for i in 0..self.functions {
            let (mut sum, mut entry) = ([0.0; LANES], i);
            for f in forces {
                let Some(phi) = self.data.get(entry) else { break };
                for lane in 0..LANES {
                    sum[lane] += phi[lane] * f[lane];
                }
                entry += self.functions;
            }
            put(i, (sum[0] + sum[1]) + (sum[2] + sum[3]));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_sums_are_those_of_the_values_that_were_put_in() {
        let value = |g: usize, i: usize| ((3 * g + 5 * i) as f64).sin();
        for (points, functions) in [(1, 1), (4, 3), (6, 2), (9, 5)] {
            let mut table = Table::new(functions);
            for g in 0..points {
                let row: Vec<f64> = (0..functions).map(|i| value(g, i)).collect();
                table.push(&row);
                assert_eq!(table.at(g).collect::<Vec<_>>(), row);
            }
            let c: Vec<[f64; 3]> = (0..functions).map(|i| [1.0, i as f64, -0.5 * i as f64]).collect();
            let mut count = 0;
            table.values(&c, |g, found| {
                for (r, found) in found.iter().enumerate() {
                    let expected: f64 = (0..functions).map(|i| value(g, i) * c[i][r]).sum();
                    assert!((found - expected).abs() < 1e-14);
                }
                count += 1;
            });
            assert_eq!(count, points);
            let mut forces = vec![[0.0; LANES]; points.div_ceil(LANES)];
            (0..points).for_each(|g| forces[g / LANES][g % LANES] = 0.3 * g as f64 - 1.0);
            table.moments(&forces, |i, found| {
                let expected: f64 = (0..points).map(|g| value(g, i) * (0.3 * g as f64 - 1.0)).sum();
                assert!((found - expected).abs() < 1e-13);
            });
        }
    }
}
