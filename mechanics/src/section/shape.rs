//! Shapes of homogeneous cross-sections.

use super::{SectionError, positive};
use std::f64::consts::PI;

/// The shape of a cross-section, symmetric about the reference axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A solid rectangle: A = b h, I = b h³/12.
    Rectangle {
        /// Width b, across the plane of motion \[m\].
        width: f64,
        /// Height h, in the plane of motion \[m\].
        height: f64,
    },
    /// A solid circle: A = π r², I = π r⁴/4.
    Circle {
        /// Radius r \[m\].
        radius: f64,
    },
    /// A round tube: A = π (R² − r²), I = π (R⁴ − r⁴)/4.
    Tube {
        /// Outer radius R \[m\].
        outer_radius: f64,
        /// Inner radius r \[m\], 0 ≤ r < R.
        inner_radius: f64,
    },
    /// A solid ellipse: A = π a b, I = π a b³/4, J = π a³ b³/(a² + b²).
    Ellipse {
        /// Semi-axis a, across the plane of motion \[m\].
        semi_width: f64,
        /// Semi-axis b, in the plane of motion \[m\].
        semi_height: f64,
    },
}

/// What follows from the dimensions of a shape.
struct Properties {
    /// Names of the dimensions and the dimensions, all of them positive.
    dimensions: [(&'static str, f64); 2],
    /// Half of the height [m].
    half_height: f64,
    /// A [m²].
    area: f64,
    /// ∫ y² dA [m⁴], y in the plane of motion.
    second_moment: f64,
    /// ∫ z² dA [m⁴], z across the plane of motion.
    flap_moment: f64,
    /// J [m⁴]; not of a rectangle, whose series is summed when it is asked for.
    torsion_constant: f64,
}

impl Shape {
    /// All that is to be known of a shape.
    fn properties(&self) -> Properties {
        match *self {
            Shape::Rectangle { width, height } => Properties {
                dimensions: [("width of the section", width), ("height of the section", height)],
                half_height: 0.5 * height,
                area: width * height,
                second_moment: width * height.powi(3) / 12.0,
                flap_moment: height * width.powi(3) / 12.0,
                torsion_constant: 0.0,
            },
            Shape::Circle { radius } => {
                let second_moment = PI * radius.powi(4) / 4.0;
                Properties {
                    dimensions: [("radius of the section", radius); 2],
                    half_height: radius,
                    area: PI * radius * radius,
                    second_moment,
                    flap_moment: second_moment,
                    torsion_constant: 2.0 * second_moment,
                }
            }
            Shape::Tube { outer_radius: o, inner_radius: i } => {
                let second_moment = PI / 4.0 * (o - i) * (o + i) * (o * o + i * i);
                Properties {
                    dimensions: [("outer radius of the section", o); 2],
                    half_height: o,
                    area: PI * (o - i) * (o + i),
                    second_moment,
                    flap_moment: second_moment,
                    torsion_constant: 2.0 * second_moment,
                }
            }
            Shape::Ellipse { semi_width: a, semi_height: b } => Properties {
                dimensions: [("semi-width of the section", a), ("semi-height of the section", b)],
                half_height: b,
                area: PI * a * b,
                second_moment: PI * a * b.powi(3) / 4.0,
                flap_moment: PI * b * a.powi(3) / 4.0,
                torsion_constant: PI * (a * b).powi(3) / (a * a + b * b),
            },
        }
    }

    /// Shear factors k along the height and across, GA of a section being k G A, of a material with Poisson's ratio ν (Cowper 1966,
    /// doi 10.1115/1.3625046): those for which a long beam has the mean deflection and the mean rotation of its sections.
    ///
    /// ```text
    /// rectangle   10 (1 + ν)/(12 + 11 ν)
    /// circle      6 (1 + ν)/(7 + 6 ν)
    /// tube        6 (1 + ν)(1 + m²)²/((7 + 6 ν)(1 + m²)² + (20 + 12 ν) m²),   m = r/R
    /// ellipse     12 (1 + ν) a² (3 a² + b²)/((40 + 37 ν) a⁴ + (16 + 10 ν) a² b² + ν b⁴),   a along the force
    /// ```
    pub fn shear_factors(&self, poisson_ratio: f64) -> [f64; 2] {
        let nu = poisson_ratio;
        let ellipse = |a: f64, b: f64| {
            let (a, b) = (a * a, b * b);
            let below = (40.0 + 37.0 * nu) * a * a + (16.0 + 10.0 * nu) * a * b + nu * b * b;
            12.0 * (1.0 + nu) * a * (3.0 * a + b) / below
        };
        match *self {
            Shape::Rectangle { .. } => [10.0 * (1.0 + nu) / (12.0 + 11.0 * nu); 2],
            Shape::Circle { .. } => [6.0 * (1.0 + nu) / (7.0 + 6.0 * nu); 2],
            Shape::Tube { outer_radius, inner_radius } => {
                let square = (inner_radius / outer_radius).powi(2);
                let sum = (1.0 + square).powi(2);
                [6.0 * (1.0 + nu) * sum / ((7.0 + 6.0 * nu) * sum + (20.0 + 12.0 * nu) * square); 2]
            }
            Shape::Ellipse { semi_width, semi_height } => {
                [ellipse(semi_height, semi_width), ellipse(semi_width, semi_height)]
            }
        }
    }

    /// The shape whose dimensions lie between those of this one (s = 0) and of `other` (s = 1), d + s (d′ − d); `None`
    /// if the two are not of one kind.
    pub fn between(self, other: Shape, s: f64) -> Option<Shape> {
        let at = |from: f64, to: f64| from + s * (to - from);
        Some(match (self, other) {
            (Shape::Rectangle { width: b, height: h }, Shape::Rectangle { width, height }) => {
                Shape::Rectangle { width: at(b, width), height: at(h, height) }
            }
            (Shape::Circle { radius: r }, Shape::Circle { radius }) => {
                Shape::Circle { radius: at(r, radius) }
            }
            (
                Shape::Tube { outer_radius: o, inner_radius: i },
                Shape::Tube { outer_radius, inner_radius },
            ) => Shape::Tube { outer_radius: at(o, outer_radius), inner_radius: at(i, inner_radius) },
            (
                Shape::Ellipse { semi_width: a, semi_height: b },
                Shape::Ellipse { semi_width, semi_height },
            ) => Shape::Ellipse { semi_width: at(a, semi_width), semi_height: at(b, semi_height) },
            _ => return None,
        })
    }

    /// Area A \[m²\].
    pub fn area(&self) -> f64 {
        self.properties().area
    }

    /// Second moment of area I = ∫ y² dA for bending in the plane of motion \[m⁴\].
    pub fn second_moment(&self) -> f64 {
        self.properties().second_moment
    }

    /// Second moment of area ∫ z² dA for bending across the plane of motion \[m⁴\].
    pub fn flap_moment(&self) -> f64 {
        self.properties().flap_moment
    }

    /// Torsion constant J \[m⁴\]: GJ = G times it.
    ///
    /// Of a rectangle with sides a ≥ b, J = a b³/3 (1 − 192/π⁵ b/a Σ tanh(nπa/2b)/n⁵), n = 1, 3, 5 …; of a circle
    /// and of a tube its polar second moment of area. Source: S. P. Timoshenko & J. N. Goodier, *Theory of
    /// Elasticity*, 3rd ed. (1970), §109.
    pub fn torsion_constant(&self) -> f64 {
        match *self {
            Shape::Rectangle { width, height } => {
                let (a, b) = (width.max(height), width.min(height));
                let term = |n: f64| libm::tanh(n * PI * a / (2.0 * b)) / n.powi(5);
                let sum: f64 = (0..200).rev().map(|k| term(2.0 * f64::from(k) + 1.0)).sum();
                a * b.powi(3) / 3.0 * (1.0 - 192.0 / PI.powi(5) * b / a * sum)
            }
            _ => self.properties().torsion_constant,
        }
    }

    /// Heights of the lower and upper fibre \[m\].
    pub fn fibres(&self) -> (f64, f64) {
        let half = self.properties().half_height;
        (-half, half)
    }

    /// Whether the dimensions make a shape.
    ///
    /// # Errors
    /// [`SectionError::Quantity`] names the first dimension that does not.
    pub fn validate(&self) -> Result<(), SectionError> {
        for (name, value) in self.properties().dimensions {
            positive(name, "m", value)?;
        }
        match *self {
            Shape::Tube { outer_radius, inner_radius }
                if !(inner_radius >= 0.0 && inner_radius < outer_radius) =>
            {
                Err(SectionError::Quantity {
                    quantity: "inner radius of the section",
                    unit: "m",
                    value: inner_radius,
                    needed: "from 0 to less than the outer radius",
                })
            }
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quadrature::Gauss;

    /// ∫ chord(y) yᵏ dy with the substitution y = R sin φ, which makes chords of circles smooth.
    fn moment(half: f64, power: i32, chord: impl Fn(f64) -> f64) -> f64 {
        Gauss::new(60).integrate(-PI / 2.0, PI / 2.0, |p| {
            let y = half * p.sin();
            chord(y) * y.powi(power) * half * p.cos()
        })
    }

    #[test]
    fn area_and_second_moment_are_the_integrals_of_the_chord() {
        let circle = |r: f64| move |y: f64| 2.0 * (r * r - y * y).max(0.0).sqrt();
        type Moment = Box<dyn Fn(i32) -> f64>;
        let ellipse = |y: f64| 0.6 * (1.0 - (y / 0.1).powi(2)).max(0.0).sqrt();
        let cases: [(Shape, Moment); 4] = [
            (
                Shape::Ellipse { semi_width: 0.3, semi_height: 0.1 },
                Box::new(move |k| moment(0.1, k, ellipse)),
            ),
            (Shape::Rectangle { width: 0.3, height: 0.2 }, Box::new(|k| moment(0.1, k, |_| 0.3))),
            (Shape::Circle { radius: 0.2 }, Box::new(move |k| moment(0.2, k, circle(0.2)))),
            (
                Shape::Tube { outer_radius: 0.2, inner_radius: 0.15 },
                Box::new(move |k| moment(0.2, k, circle(0.2)) - moment(0.15, k, circle(0.15))),
            ),
        ];
        for (shape, moment) in cases {
            assert!((shape.area() / moment(0) - 1.0).abs() < 1e-13, "{shape:?}");
            assert!((shape.second_moment() / moment(2) - 1.0).abs() < 1e-13, "{shape:?}");
        }
    }

    #[test]
    fn an_ellipse_bends_out_of_the_plane_as_its_other_axis_says_and_a_round_one_is_a_circle() {
        let ellipse = |a, b| Shape::Ellipse { semi_width: a, semi_height: b };
        assert_eq!(ellipse(0.3, 0.1).flap_moment(), ellipse(0.1, 0.3).second_moment());
        let (round, circle) = (ellipse(0.2, 0.2), Shape::Circle { radius: 0.2 });
        let pairs = [Shape::area, Shape::second_moment, Shape::flap_moment, Shape::torsion_constant];
        for of in pairs {
            assert!((of(&round) / of(&circle) - 1.0).abs() < 1e-14);
        }
        // ∇²ψ = −2 with ψ = 0 on the edge is solved by ψ = a²b²/(a² + b²) (1 − z²/a² − y²/b²), and J = 2∫ψ dA.
        let (a, b) = (0.3, 0.1);
        let integral = moment(b, 0, |y: f64| {
            let half = a * (1.0 - (y / b).powi(2)).max(0.0).sqrt();
            4.0 / 3.0 * half * (1.0 - (y / b).powi(2))
        });
        let j = 2.0 * (a * b).powi(2) / (a * a + b * b) * integral;
        assert!((ellipse(a, b).torsion_constant() / j - 1.0).abs() < 1e-13);
    }

    #[test]
    fn impossible_dimensions_are_named() {
        for (shape, name) in [
            (Shape::Rectangle { width: 0.0, height: 1.0 }, "width"),
            (Shape::Rectangle { width: 1.0, height: f64::NAN }, "height"),
            (Shape::Circle { radius: -1.0 }, "radius"),
            (Shape::Ellipse { semi_width: 1.0, semi_height: 0.0 }, "semi-height"),
            (Shape::Tube { outer_radius: 1.0, inner_radius: 1.0 }, "inner radius"),
            (Shape::Tube { outer_radius: f64::INFINITY, inner_radius: 1.0 }, "outer radius"),
        ] {
            let message = shape.validate().unwrap_err().to_string();
            assert!(message.contains(name), "{message}");
        }
        assert!(Shape::Tube { outer_radius: 1.0, inner_radius: 0.0 }.validate().is_ok());
    }
}
