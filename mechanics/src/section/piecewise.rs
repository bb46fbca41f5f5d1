//! Sections that are uniform between jumps.

use super::{Resultants, Section, SectionError, Uniform};

/// A part of a beam with one section.
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    /// Station at which it ends \[m\].
    pub end: f64,
    /// Its section.
    pub section: Uniform,
}

/// Segments one after the other from the root; at a jump the section is that of the outer segment.
#[derive(Clone, Debug, PartialEq)]
pub struct Piecewise {
    segments: Vec<Segment>,
    breaks: Vec<f64>,
}

impl Piecewise {
    /// Segments over a beam of the given length \[m\], whose ends ascend from above 0 to that length.
    ///
    /// # Errors
    /// [`SectionError::Invalid`] if there is no segment, if the ends do not ascend, or if the last one is off
    /// the length by more than 1e-9 of it.
    pub fn new(length: f64, segments: Vec<Segment>) -> Result<Piecewise, SectionError> {
        let mut start = 0.0;
        for (i, segment) in segments.iter().enumerate() {
            if !(segment.end.is_finite() && segment.end > start) {
                return Err(SectionError::Invalid(format!(
                    "segment {} ends at {} m and must end beyond {start} m, where it begins",
                    i + 1,
                    segment.end
                )));
            }
            start = segment.end;
        }
        if length.is_nan() || (start - length).abs() > 1e-9 * length {
            return Err(SectionError::Invalid(format!(
                "the last segment ends at {start} m and must end with the beam, at {length} m"
            )));
        }
        let breaks = segments.iter().rev().skip(1).rev().map(|segment| segment.end).collect();
        Ok(Piecewise { segments, breaks })
    }

    fn at(&self, x: f64) -> Option<&Segment> {
        self.segments.get(self.breaks.partition_point(|&end| end <= x))
    }
}

impl Section for Piecewise {
    fn resultants(&self, x: f64) -> Resultants {
        self.at(x).map(|segment| segment.section.resultants(x)).unwrap_or_default()
    }

    fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    fn jumps(&self) -> &[f64] {
        &self.breaks
    }

    fn fibres(&self, x: f64) -> Option<(f64, f64)> {
        self.at(x).and_then(|segment| segment.section.fibres(x))
    }
}

#[cfg(test)]
mod tests {
    use super::super::Shape;
    use super::*;

    fn segment(end: f64, radius: f64) -> Segment {
        let section = Uniform::from_material(70e9, 2700.0, Shape::Circle { radius }).unwrap();
        Segment { end, section }
    }

    #[test]
    fn each_station_has_the_section_of_its_segment() {
        let section =
            Piecewise::new(3.0, vec![segment(1.0, 0.03), segment(1.5, 0.02), segment(3.0, 0.01)]).unwrap();
        assert_eq!(section.breaks(), [1.0, 1.5]);
        for (x, radius) in [(0.0, 0.03), (0.99, 0.03), (1.0, 0.02), (1.6, 0.01), (3.0, 0.01)] {
            assert_eq!(section.resultants(x), segment(1.0, radius).section.resultants(x), "{x}");
            assert_eq!(section.fibres(x), Some((-radius, radius)), "{x}");
        }
    }

    #[test]
    fn a_shaft_of_two_parts_deflects_as_the_handbook_says() {
        // Tip load P: w = P/3 [ (L³ − c³)/EI₁ + c³/EI₂ ], c: length of the outer part.
        let (length, outer, load) = (3.0, 1.2, 7.0);
        let section =
            Piecewise::new(length, vec![segment(length - outer, 0.03), segment(length, 0.02)]).unwrap();
        let stiffness = |radius| segment(1.0, radius).section.resultants(0.0).bending_stiffness;
        let exact = load / 3.0
            * ((length.powi(3) - outer.powi(3)) / stiffness(0.03) + outer.powi(3) / stiffness(0.02));
        // Castigliano: ∫ M²/(EI) dx over the cells between the breaks.
        let ends = [&[0.0], section.breaks(), &[length]].concat();
        let rule = crate::quadrature::Gauss::new(3);
        let found: f64 = ends
            .windows(2)
            .map(|cell| {
                rule.integrate(cell[0], cell[1], |x| {
                    load * (length - x).powi(2) / section.resultants(x).bending_stiffness
                })
            })
            .sum();
        assert!((found / exact - 1.0).abs() < 1e-14, "{found} for {exact}");
    }

    #[test]
    fn segments_that_do_not_fill_the_beam_are_refused() {
        for (segments, says) in [
            (vec![], "must end with the beam"),
            (vec![segment(1.0, 0.1)], "must end with the beam"),
            (vec![segment(2.0, 0.1), segment(2.0, 0.2), segment(3.0, 0.1)], "segment 2 ends at 2 m"),
            (vec![segment(-1.0, 0.1), segment(3.0, 0.2)], "segment 1"),
            (vec![segment(f64::NAN, 0.1), segment(3.0, 0.2)], "segment 1"),
        ] {
            let message = Piecewise::new(3.0, segments).unwrap_err().to_string();
            assert!(message.contains(says), "{message}");
        }
    }
}
