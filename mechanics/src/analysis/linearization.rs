//! The equations of small motions about a state, for control.
//!
//! With M, C and K = ∂r/∂a, ∂r/∂v and ∂r/∂q at the state, the multipliers of K included, and the jacobian J of the rows that hold,
//!
//! ```text
//! M δa + C δv + K δq − Jᵀ δλ = B u,   J δq = 0
//! ```
//!
//! A basis Z of the motions that J allows, δq = Z x, leaves the equations of as many coordinates as there are freedoms,
//!
//! ```text
//! Zᵀ M Z ẍ + Zᵀ (D + G) Z ẋ + Zᵀ K Z x = Zᵀ B u,   y = P x + V ẋ + A ẍ
//! ```
//!
//! with D = ½ (C + Cᵀ), the damping, and G = ½ (C − Cᵀ), the gyroscopic matrix. Each coordinate is one of the velocities of the system; the
//! others follow from them.
//!
//! Valid next to an equilibrium, at rest or in steady rotation. The state is taken as it stands; closed contacts are held as rows.
//!
//! Source: A. A. Shabana, *Dynamics of Multibody Systems*, 5th ed., Cambridge 2020, doi:10.1017/9781108757553 (chapters 3 and 5).

use super::stiffness::matrices;
use crate::linalg::{Matrix, NullSpace};
use crate::system::{State, System};
use nalgebra::DMatrix;

/// Most velocities of a system whose dense matrices are made.
const MOST: usize = 3000;
/// Part of the scale of an unknown by which it is moved for differences.
const STEP: f64 = 1e-6;
/// Change of a quantity over its size by which it depends on a multiplier.
const DEPENDS: f64 = 1e-9;

/// A matrix, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// Entries.
    pub entries: Vec<f64>,
}

impl Table {
    /// Of the entries at row i and column j.
    pub fn from_fn(rows: usize, columns: usize, entry: impl Fn(usize, usize) -> f64) -> Table {
        let entries = (0..rows).flat_map(|i| (0..columns).map(move |j| [i, j])).map(|[i, j]| entry(i, j));
        Table { rows, columns, entries: entries.collect() }
    }

    /// The entry at row i and column j.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        self.entries[i * self.columns + j]
    }
}

/// Small motions about a state.
#[derive(Clone, Debug, PartialEq)]
pub struct Linearization {
    /// What each coordinate is: the velocity of the system of this number, and its name.
    pub coordinates: Vec<(usize, String)>,
    /// Zᵀ M Z
    pub mass: Table,
    /// Zᵀ D Z
    pub damping: Table,
    /// Zᵀ G Z
    pub gyroscopic: Table,
    /// Zᵀ K Z
    pub stiffness: Table,
    /// J, of the rows that hold.
    pub jacobian: Table,
    /// Z, with a row for each velocity.
    pub basis: Table,
}

/// How recorded quantities follow from small motions.
#[derive(Clone, Debug, PartialEq)]
pub struct Outputs {
    /// P, V and A, with a row for each quantity.
    pub by: [Table; 3],
}

/// Why there are no equations of small motions.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoLinearization {
    /// The matrices would be too large.
    #[error(
        "the system has {found} velocities, and dense matrices are made of at most {MOST}: use a coarser mesh"
    )]
    TooLarge {
        /// Number of velocities.
        found: usize,
    },
    /// A number is not finite.
    #[error("the matrices at this state hold numbers that are not finite")]
    NotFinite,
}

/// Why a place has no stiffness.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NoStiffness {
    /// Some motion has no stiffness.
    #[error("a motion of the system has no stiffness at all: it is a mechanism")]
    Mechanism,
    /// Some force moves nothing.
    #[error("it is held, at least in one direction")]
    Held,
}

/// The equations of small motions of a system about a state.
///
/// # Errors
/// [`NoLinearization`].
pub fn linearize(system: &mut dyn System, state: &State) -> Result<Linearization, NoLinearization> {
    let n = system.size().v;
    if n > MOST {
        return Err(NoLinearization::TooLarge { found: n });
    }
    let (all, multipliers) = matrices(system, state);
    let rows = held_rows(&all[2], n, multipliers);
    // What moves across the plane of a system has no coordinate, nor has what is held.
    let unit = |i: usize| (0..n).map(|k| f64::from(u8::from(k == i))).collect();
    let still = system.across().into_iter().chain(held(&all, n));
    let all_rows: Vec<Vec<f64>> = rows.iter().cloned().chain(still.map(unit)).collect();
    let space = NullSpace::of(&all_rows, system.scales());
    let z = &space.vectors;
    let [damping, gyroscopic] = [all[1].symmetrized(), all[1].skew()];
    let reduced = |matrix: &Matrix| reduced(matrix, z, n);
    let out = Linearization {
        coordinates: space.independent.iter().map(|i| (*i, system.unknown(*i))).collect(),
        mass: reduced(&all[0]),
        damping: reduced(&damping),
        gyroscopic: reduced(&gyroscopic),
        stiffness: reduced(&all[2]),
        jacobian: Table::from_fn(rows.len(), n, |i, j| rows[i][j]),
        basis: Table::from_fn(n, z.len(), |i, j| z[j][i]),
    };
    let tables = [&out.mass, &out.damping, &out.gyroscopic, &out.stiffness, &out.basis];
    let finite = tables.iter().all(|table| table.entries.iter().all(|x| x.is_finite()));
    if finite { Ok(out) } else { Err(NoLinearization::NotFinite) }
}

/// Unknowns that are [held](crate::system::Steady::hold): their equation is that they do not change, and stands in no other.
fn held([mass, damping, stiffness]: &[Matrix; 3], n: usize) -> Vec<usize> {
    let mut moves = vec![false; n];
    let mut touch = |i: usize, j: usize, x: f64| {
        for k in [i, j].into_iter().filter(|k| *k < n && x != 0.0) {
            moves[k] = true;
        }
    };
    mass.visit(&mut touch);
    damping.visit(&mut touch);
    stiffness.visit(|i, j, x| touch(i, j, if i == j { 0.0 } else { x }));
    (0..n).filter(|i| !moves[*i]).collect()
}

/// The rows of J that hold, dense: those of −J in the stiffness that are not those of a multiplier alone.
fn held_rows(stiffness: &Matrix, n: usize, multipliers: usize) -> Vec<Vec<f64>> {
    let mut rows = vec![vec![0.0; n]; multipliers];
    stiffness.visit(|i, j, x| {
        if i >= n && j < n {
            rows[i - n][j] = -x;
        }
    });
    rows.retain(|row| row.iter().any(|x| *x != 0.0));
    rows
}

/// Zᵀ A Z
fn reduced(matrix: &Matrix, z: &[Vec<f64>], n: usize) -> Table {
    let mut of = vec![0.0; matrix.order()];
    let mut product = of.clone();
    let columns: Vec<Vec<f64>> = z
        .iter()
        .map(|z| {
            of[..n].copy_from_slice(z);
            matrix.multiply(&of, &mut product);
            product[..n].to_vec()
        })
        .collect();
    let inner = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    Table::from_fn(z.len(), z.len(), |i, j| inner(&z[i], &columns[j]))
}

impl Linearization {
    /// Number of coordinates.
    pub fn order(&self) -> usize {
        self.coordinates.len()
    }

    /// Zᵀ f of forces on the velocities of the system.
    pub fn force(&self, f: &[f64]) -> Vec<f64> {
        (0..self.order()).map(|j| (0..f.len()).map(|i| self.basis.get(i, j) * f[i]).sum()).collect()
    }

    /// The stiffness against forces Fᵢ = Zᵀ fᵢ: the inverse of the compliances Cᵢⱼ = Fᵢᵀ (Zᵀ K Z)⁻¹ Fⱼ.
    ///
    /// # Errors
    /// [`NoStiffness`].
    pub fn stiffness_against(&self, forces: &[Vec<f64>]) -> Result<Table, NoStiffness> {
        let (n, m) = (self.order(), forces.len());
        let f = DMatrix::from_fn(n, m, |i, j| forces[j][i]);
        let k = DMatrix::from_fn(n, n, |i, j| self.stiffness.get(i, j));
        let moved = k.lu().solve(&f).filter(|moved| moved.iter().all(|x| x.is_finite()));
        let c = f.transpose() * moved.ok_or(NoStiffness::Mechanism)?;
        // Displacements and rotations have sizes of their own.
        let size: Vec<f64> = (0..m).map(|i| c[(i, i)].abs().sqrt()).collect();
        if size.iter().any(|size| !(size.is_finite() && *size > 0.0)) {
            return Err(NoStiffness::Held);
        }
        let scaled = DMatrix::from_fn(m, m, |i, j| c[(i, j)] / (size[i] * size[j]));
        let smallest = scaled.clone().svd(false, false).singular_values.min();
        if !(smallest > DEPENDS) {
            return Err(NoStiffness::Held);
        }
        let inverse = scaled.try_inverse().ok_or(NoStiffness::Held)?;
        Ok(Table::from_fn(m, m, |i, j| inverse[(i, j)] / (size[i] * size[j])))
    }

    /// How the recorded quantities of the numbers `channels` follow from the coordinates, by central differences; or the numbers of those that
    /// depend on multipliers, which are no function of the motion.
    ///
    /// # Errors
    /// The quantities that depend on multipliers.
    pub fn outputs(
        &self,
        system: &mut dyn System,
        state: &State,
        channels: &[usize],
    ) -> Result<Outputs, Vec<usize>> {
        let count = system.channels().len();
        let mut record = |state: &State| {
            let mut row = vec![0.0; count];
            system.record(state, &mut row);
            channels.iter().map(|i| row[*i]).collect::<Vec<f64>>()
        };
        let at = record(state);
        let mut dependent: Vec<usize> = Vec::new();
        for k in 0..state.lambda.len() {
            let mut moved = state.clone();
            moved.lambda[k] += moved.lambda[k].abs().max(1.0);
            let changed = record(&moved);
            let pairs = channels.iter().zip(changed.iter().zip(&at));
            dependent.extend(
                pairs.filter(|(_, (a, b))| (*a - *b).abs() > DEPENDS * b.abs().max(1.0)).map(|(i, _)| *i),
            );
        }
        if !dependent.is_empty() {
            dependent.sort_unstable();
            dependent.dedup();
            return Err(dependent);
        }
        let scales = system.scales().to_vec();
        let by = [0, 1, 2].map(|of| {
            let columns: Vec<Vec<f64>> = (0..self.order())
                .map(|j| {
                    let h = STEP * scales[self.coordinates[j].0];
                    let ends = [h, -h].map(|h| {
                        let d: Vec<f64> = (0..scales.len()).map(|i| h * self.basis.get(i, j)).collect();
                        let mut moved = state.clone();
                        match of {
                            0 => system.retract(&state.q, &d, &mut moved.q),
                            1 => moved.v.iter_mut().zip(&d).for_each(|(v, d)| *v += d),
                            _ => moved.a.iter_mut().zip(&d).for_each(|(a, d)| *a += d),
                        }
                        let mut row = vec![0.0; count];
                        system.record(&moved, &mut row);
                        row
                    });
                    channels.iter().map(|i| (ends[0][*i] - ends[1][*i]) / (2.0 * h)).collect()
                })
                .collect();
            Table::from_fn(channels.len(), self.order(), |i, j| columns[j][i])
        });
        Ok(Outputs { by })
    }
}
