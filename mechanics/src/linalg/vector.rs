//! Sums and products of vectors.

use super::Scalar;

/// aᵀ b, in four sums side by side.
#[inline]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (a4, a_rest) = a.as_chunks::<4>();
    let (b4, b_rest) = b.as_chunks::<4>();
    for (a, b) in a4.iter().zip(b4) {
        for k in 0..4 {
            sums[k] += a[k] * b[k];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

/// aᵀ b of short vectors, summed in their order.
#[inline(always)]
pub fn inner<const N: usize>(a: [f64; N], b: [f64; N]) -> f64 {
    let mut sum = -0.0;
    for k in 0..N {
        sum += a[k] * b[k];
    }
    sum
}

/// y ← y + c x
#[inline]
pub fn axpy(c: f64, x: &[f64], y: &mut [f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += c * x;
    }
}

/// aᵢᵀ x of four vectors, which are read side by side.
#[inline]
pub(super) fn dots(a: [&[f64]; 4], x: &[f64]) -> [f64; 4] {
    let [a0, a1, a2, a3] = a.map(|a| a[..x.len()].as_chunks::<2>());
    let (pairs, rest) = x.as_chunks::<2>();
    let mut sums = [[0.0; 2]; 4];
    for ((((x, a0), a1), a2), a3) in pairs.iter().zip(a0.0).zip(a1.0).zip(a2.0).zip(a3.0) {
        for k in 0..2 {
            sums[0][k] += a0[k] * x[k];
            sums[1][k] += a1[k] * x[k];
            sums[2][k] += a2[k] * x[k];
            sums[3][k] += a3[k] * x[k];
        }
    }
    let last = [a0.1, a1.1, a2.1, a3.1];
    std::array::from_fn(|i| {
        let rest: f64 = last[i].iter().zip(rest).map(|(a, x)| a * x).sum();
        sums[i][0] + sums[i][1] + rest
    })
}

/// y ← y + Σ cᵢ aᵢ of four vectors.
#[inline]
pub(super) fn add_four(c: [f64; 4], a: [&[f64]; 4], y: &mut [f64]) {
    let [a0, a1, a2, a3] = a.map(|a| &a[..y.len()]);
    for ((((y, a0), a1), a2), a3) in y.iter_mut().zip(a0).zip(a1).zip(a2).zip(a3) {
        *y += (c[0] * a0 + c[1] * a1) + (c[2] * a2 + c[3] * a3);
    }
}

/// x ← c x
pub fn scale(c: f64, x: &mut [f64]) {
    x.iter_mut().for_each(|x| *x *= c);
}

/// a × b
#[inline]
pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// `out` = Σ wₖ aₖ, entry by entry.
pub(super) fn weighted_sum<T: Scalar>(out: &mut [T], terms: [&[f64]; 3], weights: [T; 3]) {
    let [a, b, c] = terms;
    for (((out, a), b), c) in out.iter_mut().zip(a).zip(b).zip(c) {
        *out = weights[0].times(*a) + (weights[1].times(*b) + weights[2].times(*c));
    }
}

/// Numbers in [−1, 1) without structure, the same for the same seed: a linear congruential sequence.
pub fn noise(n: usize, seed: u64) -> Vec<f64> {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(0x1234_5678_9abc_def1);
    (0..n)
        .map(|_| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        })
        .collect()
}
