//! The contour of a cross-section, as it is drawn.

use flexion::section::Shape;
use std::f64::consts::TAU;

/// Corners of the polygon that stands for a circle or an ellipse.
const CORNERS: usize = 32;

/// Closed polygons in the plane of a section, in its axes: y along the height, z across \[m\].
#[derive(Clone, Debug, PartialEq)]
pub struct Contour {
    /// Outer polygon, counterclockwise seen against the tangent.
    pub(super) outer: Vec<[f64; 2]>,
    /// Inner polygon of a hollow section, corner by corner beside the outer one; empty for a solid section.
    pub(super) inner: Vec<[f64; 2]>,
}

impl Contour {
    /// The contour of a shape. Polygons in place of circles and ellipses have their areas.
    pub fn of(shape: &Shape) -> Contour {
        // Half the area of a regular polygon of n corners on the unit circle is n/4 sin(2π/n).
        let angle = TAU / CORNERS as f64;
        let larger = (angle / libm::sin(angle)).sqrt();
        let round = |y: f64, z: f64| -> Vec<[f64; 2]> {
            let corners = (0..CORNERS).map(|i| libm::sincos(angle * (i as f64 + 0.5)));
            corners.map(|(sin, cos)| [larger * y * cos, larger * z * sin]).collect()
        };
        let (outer, inner) = match *shape {
            Shape::Rectangle { width, height } => {
                let (y, z) = (0.5 * height, 0.5 * width);
                (vec![[-y, -z], [y, -z], [y, z], [-y, z]], Vec::new())
            }
            Shape::Circle { radius } => (round(radius, radius), Vec::new()),
            Shape::Ellipse { semi_width, semi_height } => (round(semi_height, semi_width), Vec::new()),
            Shape::Tube { outer_radius, inner_radius: 0.0 } => {
                (round(outer_radius, outer_radius), Vec::new())
            }
            Shape::Tube { outer_radius, inner_radius } => {
                (round(outer_radius, outer_radius), round(inner_radius, inner_radius))
            }
        };
        Contour { outer, inner }
    }

    /// The polygon through the given corners (y, z) \[m\]; `None` if it encloses no area or its area is not finite.
    pub fn through(mut corners: Vec<[f64; 2]>) -> Option<Contour> {
        let area = area(&corners);
        if area < 0.0 {
            corners.reverse();
        }
        (area != 0.0 && area.is_finite()).then_some(Contour { outer: corners, inner: Vec::new() })
    }

    /// The same, so many times as high and as wide.
    pub fn scaled(&self, [high, wide]: [f64; 2]) -> Contour {
        let scaled = |corners: &[[f64; 2]]| corners.iter().map(|[y, z]| [high * y, wide * z]).collect();
        Contour { outer: scaled(&self.outer), inner: scaled(&self.inner) }
    }

    /// Height and width \[m\].
    pub(super) fn size(&self) -> [f64; 2] {
        [0, 1].map(|k| {
            let of = self.outer.iter().map(|corner| corner[k]);
            of.clone().fold(f64::NEG_INFINITY, f64::max) - of.fold(f64::INFINITY, f64::min)
        })
    }
}

/// Area that a polygon encloses \[m²\], positive if it is counterclockwise.
fn area(corners: &[[f64; 2]]) -> f64 {
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).map(|(a, b)| 0.5 * (a[0] * b[1] - a[1] * b[0])).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contours_have_the_areas_and_the_sizes_of_their_shapes() {
        let shapes = [
            Shape::Rectangle { width: 0.3, height: 0.2 },
            Shape::Circle { radius: 0.1 },
            Shape::Ellipse { semi_width: 0.15, semi_height: 0.1 },
            Shape::Tube { outer_radius: 0.1, inner_radius: 0.07 },
        ];
        for shape in shapes {
            let contour = Contour::of(&shape);
            let found = area(&contour.outer) - area(&contour.inner);
            assert!((found / shape.area() - 1.0).abs() < 1e-14, "{shape:?}: {found}");
            let (lower, upper) = shape.fibres();
            assert!((contour.size()[0] / (upper - lower) - 1.0).abs() < 4e-3, "{shape:?}");
        }
        let [height, width] = Contour::of(&shapes[0]).size();
        assert_eq!((height, width), (0.2, 0.3));
    }

    #[test]
    fn a_given_contour_runs_counterclockwise_and_encloses_an_area() {
        let corners = vec![[0.0, 0.0], [0.0, 2.0], [1.0, 0.0]];
        let contour = Contour::through(corners.clone()).unwrap();
        assert_eq!(area(&contour.outer), 1.0);
        assert_eq!(area(&contour.scaled([3.0, 0.5]).outer), 1.5);
        assert!(Contour::through(corners[..2].to_vec()).is_none() && Contour::through(Vec::new()).is_none());
    }
}
