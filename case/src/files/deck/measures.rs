//! What a station is like, in sizes that do not depend on where its reference line is.

use flexion::section::Matrices;

/// What a station is like.
pub(super) struct Measures {
    pub axial: f64,
    pub mass: f64,
    /// Along the height, edgewise, and across, flapwise.
    pub shear: [f64; 2],
    pub torsion: f64,
    /// Edgewise and flapwise, about the tension centre and the centre of mass.
    pub bending: [f64; 2],
    pub inertia: [f64; 2],
    /// Products of both.
    products: [f64; 2],
    /// Places of both centres along height and across.
    pub centres: [[f64; 2]; 2],
    pub polar: f64,
}

impl Measures {
    pub fn of(section: &Matrices) -> Measures {
        let (k, m) = (&section.stiffness, &section.mass);
        let centre = |of: &[[f64; 6]; 6]| [-of[0][5] / of[0][0], of[0][4] / of[0][0]];
        let about = |of: &[[f64; 6]; 6], [y, z]: [f64; 2]| {
            [of[5][5] - of[0][0] * y * y, of[4][4] - of[0][0] * z * z].map(|x| x.max(0.0))
        };
        let centres = [centre(k), centre(m)];
        let product = |of: &[[f64; 6]; 6], [y, z]: [f64; 2]| of[4][5] + of[0][0] * y * z;
        Measures {
            axial: k[0][0],
            mass: m[0][0],
            shear: [k[1][1], k[2][2]],
            torsion: k[3][3],
            bending: about(k, centres[0]),
            inertia: about(m, centres[1]),
            products: [product(k, centres[0]), product(m, centres[1])],
            centres,
            polar: m[3][3] / (m[4][4] + m[5][5]),
        }
    }

    /// Larger and smaller principal radius of gyration: of the stiffness, and of the mass.
    pub fn radii(&self) -> [[f64; 2]; 2] {
        let of = |[a, b]: [f64; 2], product: f64, by: f64| {
            let (mean, apart) = (0.5 * (a + b), libm::hypot(0.5 * (a - b), product));
            [mean + apart, mean - apart].map(|x| (x.max(0.0) / by).sqrt())
        };
        let [stiff, heavy] = self.products;
        [of(self.bending, stiff, self.axial), of(self.inertia, heavy, self.mass)]
    }

    /// Speed of waves along the beam \[m/s\].
    pub fn speed(&self) -> f64 {
        (self.axial / self.mass).sqrt()
    }

    /// Modulus \[Pa\] and density \[kg/m³\] that the material has at least: of all sections of one area the ellipse has the least product of its
    /// radii of gyration, A/4π, so that E ≥ EA/(4π i₁ i₂).
    pub fn least(&self) -> [f64; 2] {
        let [stiff, heavy] = self.radii();
        let of = |size: f64, [a, b]: [f64; 2]| size / (4.0 * std::f64::consts::PI * a * b);
        [of(self.axial, stiff), of(self.mass, heavy)]
    }
}
