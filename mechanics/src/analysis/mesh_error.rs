//! Errors of frequencies by the mesh: the modes of a mesh beside those of a finer one.
//!
//! The meshes have other unknowns, and their modes other numbers: with damping modes ascend in |λ|, and motions of the highest modes of a mesh may stand
//! among the lowest. A mode is joined with the one of the finer mesh at the smallest distance
//!
//! ```text
//! |λ − λ′| / max(|λ|, |λ′|) + 1 − Σ √(s s′)
//! ```
//!
//! with the shares s of what moves, that sum to one; the closest pairs of all first, each mode once.

use super::modes::Mode;

/// Notes the estimated errors of the frequencies of `modes` by the mesh, `safety` times their differences to those of the modes of a finer mesh.
pub fn compare<'m>(modes: impl IntoIterator<Item = &'m mut Mode>, finer: &[Mode], safety: f64) {
    let mut modes: Vec<&mut Mode> = modes.into_iter().collect();
    let pairs = (0..modes.len()).flat_map(|i| (0..finer.len()).map(move |j| (i, j)));
    let mut pairs: Vec<(f64, usize, usize)> =
        pairs.map(|(i, j)| (distance(modes[i], &finer[j]), i, j)).collect();
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut joined, mut taken) = (vec![false; modes.len()], vec![false; finer.len()]);
    for (_, i, j) in pairs {
        if !joined[i] && !taken[j] {
            (joined[i], taken[j]) = (true, true);
            modes[i].compare(finer[j].frequency(), safety);
        }
    }
}

fn distance(a: &Mode, b: &Mode) -> f64 {
    let size = a.eigenvalue.norm().max(b.eigenvalue.norm());
    let apart = if size > 0.0 { (a.eigenvalue - b.eigenvalue).norm() / size } else { 0.0 };
    let shares = a.shares.named().into_iter().zip(b.shares.named());
    let alike: f64 = shares.map(|((_, s), (_, t))| (s.max(0.0) * t.max(0.0)).sqrt()).sum();
    apart + 1.0 - alike
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::modes::{Shape, Shares};
    use num_complex::Complex64;

    fn mode(re: f64, im: f64, torsion: f64) -> Mode {
        let shares = Shares { torsion, flap: 1.0 - torsion, ..Shares::default() };
        Mode {
            eigenvalue: Complex64::new(re, im),
            vector: Vec::new(),
            residual: 0.0,
            rounding: 0.0,
            mesh: None,
            shares,
            shape: Shape::default(),
            nodes: 0,
        }
    }

    fn errors(mut modes: Vec<Mode>, finer: &[Mode]) -> Vec<f64> {
        compare(&mut modes, finer, 1.0);
        modes.iter().map(|mode| mode.mesh.map_or(f64::NAN, |error| (1e6 * error).round() / 1e6)).collect()
    }

    /// Damping numbers the modes of two meshes otherwise, bending falls below torsion, and of two equal frequencies of a round beam the shares are any.
    #[test]
    fn a_mode_has_the_error_of_its_own_kind() {
        let coarse = vec![mode(-1.0, 10.0, 0.0), mode(-99.0, 92.0, 0.0), mode(-157.0, 105.0, 0.0)];
        let fine =
            [mode(-1.0, 9.9, 0.0), mode(-100.0, 3.0, 0.0), mode(-99.0, 91.5, 0.0), mode(-156.0, 104.0, 0.0)];
        assert_eq!(errors(coarse, &fine), [0.1, 0.5, 1.0], "a motion that one mesh has alone");
        let coarse = vec![mode(0.0, 10.0, 1.0), mode(0.0, 10.1, 0.02)];
        let fine = [mode(0.0, 9.0, 0.0), mode(0.0, 9.99, 0.97)];
        assert_eq!(errors(coarse, &fine), [0.01, 1.1], "bending falls below torsion");
        let coarse = vec![mode(0.0, 10.0, 1.0), mode(0.0, 10.0, 0.0), mode(0.0, 60.0, 0.5)];
        let fine = [mode(0.0, 9.0, 0.5), mode(0.0, 9.0, 0.5), mode(0.0, 59.0, 0.5)];
        assert_eq!(errors(coarse, &fine), [1.0; 3], "equal frequencies");
    }
}
