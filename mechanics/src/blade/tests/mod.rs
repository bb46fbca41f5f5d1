//! Derivatives against an energy that is coded apart from the model, and frequencies against published ones.

mod derivatives;
mod frequencies;

use super::mesh::Component;
use super::*;
use crate::linalg::Matrix;
use crate::section::BladeResultants;
use crate::system::{Dynamics, Observed, State, Weights};

/// Vibration problem of a blade in dense matrices: M, C, K, rows of the given unknowns.
pub fn matrices(blade: &mut Blade, keep: impl Fn(Component) -> bool) -> [Vec<Vec<f64>>; 3] {
    let numbers: Vec<usize> = (0..blade.size().v).filter(|&i| keep(blade.components()[i])).collect();
    [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)].map(|(a, v, q)| {
        let mut matrix = Matrix::new(&blade.structure(0));
        blade.tangent(&State::zeros(blade.size(), 0.0), Weights::new(a, v, q), &mut matrix);
        numbers.iter().map(|&i| numbers.iter().map(|&j| matrix.get(i, j)).collect()).collect()
    })
}

/// Lower Cholesky factor.
fn cholesky(a: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let n = a.len();
    let mut l = vec![vec![0.0; n]; n];
    for j in 0..n {
        for i in j..n {
            let sum: f64 = (0..j).map(|k| l[i][k] * l[j][k]).sum();
            l[i][j] = if i == j { (a[i][i] - sum).sqrt() } else { (a[i][j] - sum) / l[j][j] };
        }
    }
    assert!(l.iter().flatten().all(|x| x.is_finite()), "not positive definite");
    l
}

/// L⁻¹ A L⁻ᵀ
fn reduced(l: &[Vec<f64>], a: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let forward = |b: &[Vec<f64>]| -> Vec<Vec<f64>> {
        // Rows of the result solve L x = columns of b.
        let n = l.len();
        let mut out = vec![vec![0.0; n]; n];
        for c in 0..n {
            for i in 0..n {
                let sum: f64 = (0..i).map(|k| l[i][k] * out[c][k]).sum();
                out[c][i] = (b[i][c] - sum) / l[i][i];
            }
        }
        out
    };
    forward(&forward(a))
}

/// Eigenvalues of a symmetric matrix by Jacobi's rotations, ascending.
fn eigenvalues(mut a: Vec<Vec<f64>>) -> Vec<f64> {
    let n = a.len();
    for _ in 0..60 {
        let off: f64 = (0..n).flat_map(|i| (0..i).map(move |j| (i, j))).map(|(i, j)| a[i][j] * a[i][j]).sum();
        let diagonal: f64 = (0..n).map(|i| a[i][i] * a[i][i]).sum();
        if off <= 1e-30 * diagonal {
            break;
        }
        for p in 0..n {
            for q in p + 1..n {
                if a[p][q].abs() <= 1e-18 * (a[p][p] * a[q][q]).abs().sqrt() {
                    continue;
                }
                let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
                let c = 1.0 / t.hypot(1.0);
                let s = t * c;
                for k in 0..n {
                    let (x, y) = (a[k][p], a[k][q]);
                    (a[k][p], a[k][q]) = (c * x - s * y, s * x + c * y);
                }
                let (upper, lower) = a.split_at_mut(q);
                for (x, y) in upper[p].iter_mut().zip(lower[0].iter_mut()) {
                    (*x, *y) = (c * *x - s * *y, s * *x + c * *y);
                }
            }
        }
    }
    let mut values: Vec<f64> = (0..n).map(|i| a[i][i]).collect();
    values.sort_by(f64::total_cmp);
    values
}

/// Natural frequencies [rad/s] without gyroscopic terms.
pub fn frequencies(blade: &mut Blade, keep: impl Fn(Component) -> bool) -> Vec<f64> {
    let [m, _, k] = matrices(blade, keep);
    // 1/ω² of the pair exchanged: the lowest frequencies are then the largest eigenvalues, and precise.
    let values = eigenvalues(reduced(&cholesky(&k), &m));
    values.iter().rev().map(|x| 1.0 / x.sqrt()).collect()
}

/// Natural frequencies [rad/s] with gyroscopic terms: of the antisymmetric W = L⁻¹ [−C −K; K 0] L⁻ᵀ with
/// L Lᵀ = diag(M, K), whose inverse has the eigenvalues ±i/ω.
pub fn gyroscopic_frequencies(blade: &mut Blade, keep: impl Fn(Component) -> bool) -> Vec<f64> {
    let [m, c, k] = matrices(blade, keep);
    // W⁻¹ in the metric of K: ω²M x − iωC x = K x. With K = L Lᵀ, A = L⁻¹ M L⁻ᵀ, B = L⁻¹ C L⁻ᵀ and A = R Rᵀ
    // the matrix [B R; −Rᵀ 0] is antisymmetric with eigenvalues ±i/ω.
    let l = cholesky(&k);
    let (a, b) = (reduced(&l, &m), reduced(&l, &c));
    let r = cholesky(&a);
    let n = r.len();
    let mut w = vec![vec![0.0; 2 * n]; 2 * n];
    for i in 0..n {
        for j in 0..n {
            w[i][j] = b[i][j];
            w[i][n + j] = r[i][j];
            w[n + j][i] = -r[i][j];
        }
    }
    let square = (0..2 * n)
        .map(|i| (0..2 * n).map(|j| (0..2 * n).map(|k| w[k][i] * w[k][j]).sum()).collect())
        .collect();
    eigenvalues(square).iter().rev().step_by(2).map(|x| 1.0 / x.sqrt()).collect()
}

fn flapwise(component: Component) -> bool {
    component == Component::Flapwise
}

fn chordwise(component: Component) -> bool {
    component == Component::Chordwise
}

/// ρA = EI = L = 1: γ is the speed itself.
fn unit() -> BladeResultants {
    BladeResultants {
        mass: 1.0,
        axial_stiffness: 1e4,
        flap_stiffness: 1.0,
        chord_stiffness: 1.0,
        ..BladeResultants::default()
    }
}

fn linear() -> Model {
    Model {
        strain_energy: StrainEnergy::Linear,
        gyroscopic: false,
        rotary_inertia: false,
        torsion: false,
        tension_torsion: false,
    }
}

fn setting() -> Setting {
    Setting { length: 1.0, ..Setting::default() }
}

#[test]
fn what_makes_no_blade_is_refused_with_the_reason() {
    let section = unit();
    for (setting, model, says) in [
        (Setting { length: 0.0, ..setting() }, linear(), "positive length"),
        (Setting { precone: 0.1, ..setting() }, linear(), "precone"),
        (Setting { hub_radius: -1.0, ..setting() }, linear(), "hub radius"),
        (setting(), Model { torsion: true, ..linear() }, "torsional stiffness"),
    ] {
        let message = Blade::new(setting, &section, model, 4).unwrap_err().to_string();
        assert!(message.contains(says), "{message}");
    }
    let mut soft = Blade::new(setting(), &section, Model { torsion: false, ..Model::default() }, 8).unwrap();
    let message = soft.set_speed(500.0).unwrap_err().to_string();
    assert!(message.contains("no steady state at 500 rad/s"), "{message}");
    soft.set_speed(5.0).unwrap();
}
