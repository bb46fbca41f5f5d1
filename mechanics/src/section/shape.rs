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
}

impl Shape {
    /// Area A \[m²\].
    pub fn area(&self) -> f64 {
        match *self {
            Shape::Rectangle { width, height } => width * height,
            Shape::Circle { radius } => PI * radius * radius,
            Shape::Tube { outer_radius: o, inner_radius: i } => PI * (o - i) * (o + i),
        }
    }

    /// Second moment of area I = ∫ y² dA for bending in the plane of motion \[m⁴\].
    pub fn second_moment(&self) -> f64 {
        match *self {
            Shape::Rectangle { width, height } => width * height.powi(3) / 12.0,
            Shape::Circle { radius } => PI * radius.powi(4) / 4.0,
            Shape::Tube { outer_radius: o, inner_radius: i } => {
                PI / 4.0 * (o - i) * (o + i) * (o * o + i * i)
            }
        }
    }

    /// Heights of the lower and upper fibre \[m\].
    pub fn fibres(&self) -> (f64, f64) {
        let half = match *self {
            Shape::Rectangle { height, .. } => 0.5 * height,
            Shape::Circle { radius } => radius,
            Shape::Tube { outer_radius, .. } => outer_radius,
        };
        (-half, half)
    }

    /// Whether the dimensions make a shape.
    ///
    /// # Errors
    /// [`SectionError::Quantity`] names the first dimension that does not.
    pub fn validate(&self) -> Result<(), SectionError> {
        match *self {
            Shape::Rectangle { width, height } => {
                positive("width of the section", "m", width)?;
                positive("height of the section", "m", height)
            }
            Shape::Circle { radius } => positive("radius of the section", "m", radius),
            Shape::Tube { outer_radius, inner_radius } => {
                positive("outer radius of the section", "m", outer_radius)?;
                if inner_radius >= 0.0 && inner_radius < outer_radius {
                    return Ok(());
                }
                Err(SectionError::Quantity {
                    quantity: "inner radius of the section",
                    unit: "m",
                    value: inner_radius,
                    needed: "from 0 to less than the outer radius",
                })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quadrature::Gauss;

    /// ∫ chord(y) yᵏ dy with the substitution y = R sin φ, which makes chords of circles smooth.
    fn moment(reach: f64, power: i32, chord: impl Fn(f64) -> f64) -> f64 {
        Gauss::new(60).integrate(-PI / 2.0, PI / 2.0, |p| {
            let y = reach * p.sin();
            chord(y) * y.powi(power) * reach * p.cos()
        })
    }

    #[test]
    fn area_and_second_moment_are_the_integrals_of_the_chord() {
        let circle = |r: f64| move |y: f64| 2.0 * (r * r - y * y).max(0.0).sqrt();
        type Moment = Box<dyn Fn(i32) -> f64>;
        let cases: [(Shape, Moment); 3] = [
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
    fn impossible_dimensions_are_named() {
        for (shape, name) in [
            (Shape::Rectangle { width: 0.0, height: 1.0 }, "width"),
            (Shape::Rectangle { width: 1.0, height: f64::NAN }, "height"),
            (Shape::Circle { radius: -1.0 }, "radius"),
            (Shape::Tube { outer_radius: 1.0, inner_radius: 1.0 }, "inner radius"),
            (Shape::Tube { outer_radius: f64::INFINITY, inner_radius: 1.0 }, "outer radius"),
        ] {
            let message = shape.validate().unwrap_err().to_string();
            assert!(message.contains(name), "{message}");
        }
        assert!(Shape::Tube { outer_radius: 1.0, inner_radius: 0.0 }.validate().is_ok());
    }
}
