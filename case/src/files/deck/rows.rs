//! The matrices of a station as a format has them, and the section that they make.

use flexion::section::{Matrices, Matrix6};

/// Where a format has the components of this program: strain and force k here is row `place[k]` there, with the sign `sign[k]`.
pub(super) struct Convention {
    pub place: [usize; 6],
    pub sign: [f64; 6],
    /// What the format calls its stations.
    pub station: &'static str,
    /// What it calls the diagonal of the stiffness, where it has no stiffness matrix.
    pub stiffness: Option<[&'static str; 6]>,
    /// What it calls mass, moments of inertia about tangent, height and across, and offsets along height and across, where it has no mass
    /// matrix.
    pub inertia: Option<[&'static str; 6]>,
    /// Whether its twist is that of a rotor blade, positive about the axis towards the root.
    pub twists: bool,
}

/// Shear x, shear y, axial z, bend x, bend y, torsion z with x to the suction side and y edgewise: (tangent, height, across) = (z, y, −x).
pub(super) static BEAMDYN: Convention = Convention {
    place: [2, 1, 0, 5, 4, 3],
    sign: [1.0, 1.0, -1.0, 1.0, 1.0, -1.0],
    station: "eta",
    stiffness: None,
    inertia: None,
    twists: true,
};

impl Convention {
    /// The matrix in the axes and the order of this program.
    pub fn inward(&self, of: &Matrix6) -> Matrix6 {
        let entry = |i: usize, j: usize| self.sign[i] * self.sign[j] * of[self.place[i]][self.place[j]];
        std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)))
    }

    /// The matrix in the axes and the order of the format.
    pub fn outward(&self, of: &Matrix6) -> Matrix6 {
        let mut out = [[0.0; 6]; 6];
        for i in 0..6 {
            for j in 0..6 {
                out[self.place[i]][self.place[j]] = self.sign[i] * self.sign[j] * of[i][j];
            }
        }
        out
    }

    /// The number in the format of row and column i of this program.
    pub fn number(&self, i: usize) -> usize {
        self.place[i] + 1
    }

    /// The name in the format of the entry (i, j) of this program of a matrix `k`.
    pub fn entry(&self, k: char, i: usize, j: usize) -> String {
        if let Some(names) = self.stiffness.filter(|_| k == 'K' && i == j) {
            return names[i].to_owned();
        }
        let named = self.inertia.filter(|_| k == 'M').and_then(|names| match (i.min(j), i.max(j)) {
            (0, 0) | (1, 1) | (2, 2) => Some(names[0]),
            (a, b) if a == b => Some(names[a - 2]),
            (0, 5) | (2, 3) => Some(names[4]),
            (0, 4) | (1, 3) => Some(names[5]),
            _ => None,
        });
        named.map_or_else(|| format!("{k}{}{}", self.number(i), self.number(j)), str::to_owned)
    }

    /// The same, of the upper triangle.
    pub fn upper(&self, k: char, i: usize, j: usize) -> String {
        if self.place[i] < self.place[j] { self.entry(k, i, j) } else { self.entry(k, j, i) }
    }
}

/// A station in the axes and the order of its format.
pub(super) struct Row {
    /// Its number from 1.
    pub number: usize,
    /// Where it is, as the file writes it.
    pub written: f64,
    /// Its parameter on the line.
    pub place: f64,
    /// Lines of the rows of both matrices; 0 where the format has none.
    pub lines: [[usize; 6]; 2],
    pub stiffness: Matrix6,
    pub mass: Matrix6,
}

/// Entries of the diagonal in SI units: EI of a carbon nanotube is 10⁻²⁴ N·m² and its moment of inertia 10⁻³³ kg·m.
const ENGINEERED: [f64; 2] = [1e-40, 1e30];
/// Difference of Kᵢⱼ and Kⱼᵢ, over the larger of both and over √(Kᵢᵢ Kⱼⱼ), up to which they count as equal: the digits of a file.
const SAME: (f64, f64) = (1e-3, 1e-6);

impl Row {
    /// `station 3 (eta 0.02) of FILE, line 40`.
    pub fn at(&self, name: &str, convention: &Convention, matrix: usize, row: usize) -> String {
        let line = match self.lines[matrix][row] {
            0 => String::new(),
            line => format!(", line {line}"),
        };
        format!("station {} ({} {}) of {name}{line}", self.number, convention.station, self.written)
    }

    /// The section without damping.
    pub fn section(&self, name: &str, c: &Convention) -> Result<Matrices, String> {
        let mut made = [[[0.0; 6]; 6]; 2];
        for (which, (letter, of)) in [('K', &self.stiffness), ('M', &self.mass)].into_iter().enumerate() {
            let of = c.inward(of);
            let at = |i: usize| self.at(name, c, which, c.place[i]);
            for i in 0..6 {
                if !(of[i][i] > 0.0 && of[i][i].is_finite()) {
                    let help =
                        if which == 1 { ", which a deck for equilibria alone needs here, too" } else { "" };
                    return Err(format!(
                        "{}: {} = {:.4e} must be positive; it is {}{help}",
                        at(i),
                        c.entry(letter, i, i),
                        of[i][i],
                        MEANING[which][i]
                    ));
                }
                if !(ENGINEERED[0]..=ENGINEERED[1]).contains(&of[i][i]) {
                    return Err(format!(
                        "{}: {} = {:.4e} is outside of {:e} to {:e} in SI units, where structures of all sizes are; it is {}",
                        at(i),
                        c.entry(letter, i, i),
                        of[i][i],
                        ENGINEERED[0],
                        ENGINEERED[1],
                        MEANING[which][i]
                    ));
                }
            }
            for i in 0..6 {
                for j in 0..i {
                    let (a, b, bound) = (of[i][j], of[j][i], (of[i][i] * of[j][j]).sqrt());
                    if !((a - b).abs() <= (SAME.0 * a.abs().max(b.abs())).max(SAME.1 * bound)) {
                        return Err(format!(
                            "{}: {} = {:.6e} and {} = {:.6e}, which are equal in the symmetric matrix of a section",
                            at(i),
                            c.entry(letter, i, j),
                            c.sign[i] * c.sign[j] * a,
                            c.entry(letter, j, i),
                            c.sign[i] * c.sign[j] * b
                        ));
                    }
                    if !(0.5 * (a + b).abs() < bound) {
                        return Err(format!(
                            "{}: |{}| = {:.4e} must be less than √({}·{}) = {bound:.4e}, or there are strains of negative energy",
                            at(i),
                            c.upper(letter, i, j),
                            a.abs(),
                            c.entry(letter, i, i),
                            c.entry(letter, j, j)
                        ));
                    }
                }
            }
            made[which] = std::array::from_fn(|i| std::array::from_fn(|j| 0.5 * (of[i][j] + of[j][i])));
        }
        let [stiffness, mass] = made;
        let mass = self.rigid(&mass, name, c)?;
        let section = Matrices { stiffness, damping: [[0.0; 6]; 6], mass };
        match section.fault() {
            None => Ok(section),
            // The lines of both matrices begin with the place of the first row.
            Some(fault) => {
                Err(format!("{}: {fault}", self.at(name, c, usize::from(fault.contains("mass")), 0)))
            }
        }
    }

    /// The mass matrix of a rigid section of which `m` has the digits of a file.
    fn rigid(&self, m: &Matrix6, name: &str, c: &Convention) -> Result<Matrix6, String> {
        let size = (m[0][0] + m[1][1] + m[2][2]) / 3.0;
        let at = |i: usize| self.at(name, c, 1, c.place[i]);
        for i in 0..3 {
            if !((m[i][i] - size).abs() <= SAME.0 * size) {
                return Err(format!(
                    "{}: M11, M22 and M33 are the mass per length, and are {:.6e}, {:.6e} and {:.6e}",
                    at(i),
                    self.mass[0][0],
                    self.mass[1][1],
                    self.mass[2][2]
                ));
            }
        }
        // Entries that a rigid section has not, and pairs of equal magnitude.
        let (none, pairs) = (
            [(0, 1), (0, 2), (1, 2), (0, 3), (1, 4), (1, 5), (2, 4), (2, 5)],
            [((0, 4), (1, 3)), ((0, 5), (2, 3))],
        );
        let scale = |i: usize, j: usize| (m[i][i] * m[j][j]).sqrt();
        for (i, j) in none {
            if !(m[i][j].abs() <= SAME.0 * scale(i, j)) {
                return Err(format!(
                    "{}: {} = {:.4e} must be 0, as in the mass matrix of any section",
                    at(i),
                    c.upper('M', i, j),
                    c.sign[i] * c.sign[j] * m[i][j]
                ));
            }
        }
        let mut out = [[0.0; 6]; 6];
        for ((i, j), (k, l)) in pairs {
            let (a, b) = (m[i][j], m[k][l]);
            if !((a + b).abs() <= SAME.0 * scale(i, j).max(scale(k, l))) {
                let sign = c.sign[i] * c.sign[j] * c.sign[k] * c.sign[l];
                return Err(format!(
                    "{}: {} = {:.6e}, and must be {} = {:.6e}: both are mass times an offset of its centre",
                    at(i),
                    c.upper('M', i, j),
                    c.sign[i] * c.sign[j] * a,
                    if sign < 0.0 { c.upper('M', k, l) } else { format!("−{}", c.upper('M', k, l)) },
                    -c.sign[i] * c.sign[j] * b
                ));
            }
            let mean = 0.5 * (a - b);
            (out[i][j], out[j][i], out[k][l], out[l][k]) = (mean, mean, -mean, -mean);
        }
        (0..3).for_each(|i| out[i][i] = size);
        (3..6).for_each(|i| (3..6).for_each(|j| out[i][j] = m[i][j]));
        // About the centre of mass (y, z) nothing may be left but positive moments of inertia.
        let (y, z) = (-out[0][5] / size, out[0][4] / size);
        for (i, arm) in [(3, libm::hypot(y, z)), (4, z), (5, y)] {
            let moved = size * arm * arm;
            if !(m[i][i] > moved) {
                return Err(format!(
                    "{}: {} = {:.4e} is a moment of inertia about the reference line and must be more than {moved:.4e}, mass times \
                     the square of {:.4} m of its centre",
                    at(i),
                    c.entry('M', i, i),
                    m[i][i],
                    arm.abs()
                ));
            }
        }
        Ok(out)
    }
}

/// What the diagonal entries are.
const MEANING: [[&str; 6]; 2] = [
    [
        "the axial stiffness EA",
        "the shear stiffness edgewise",
        "the shear stiffness flapwise",
        "the torsional stiffness GJ",
        "the bending stiffness flapwise",
        "the bending stiffness edgewise",
    ],
    [
        "the mass per length",
        "the mass per length",
        "the mass per length",
        "the polar moment of inertia",
        "the moment of inertia of flapwise bending",
        "the moment of inertia of edgewise bending",
    ],
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conventions_are_rotations_and_go_back() {
        let m: Matrix6 = std::array::from_fn(|i| std::array::from_fn(|j| (1 + i * 6 + j) as f64));
        assert_eq!(BEAMDYN.outward(&BEAMDYN.inward(&m)), m);
        // (tangent, height, across) = (z, y, −x): a mass of 2 at (x, y) = (3, 5) is at 5 along the height and −3 across.
        let mut of = [[0.0; 6]; 6];
        (of[0][5], of[1][5], of[2][3], of[2][4]) = (-10.0, 6.0, 10.0, -6.0);
        let inward = BEAMDYN.inward(&of);
        assert_eq!((inward[0][4], inward[0][5], inward[1][3], inward[2][3]), (-6.0, -10.0, 6.0, 10.0));
    }
}
