//! Polynomials through points, and their zeros.

/// The polynomial through some points, in Newton's form.
pub(super) struct Polynomial {
    places: Vec<f64>,
    differences: Vec<f64>,
}

impl Polynomial {
    pub(super) fn through(points: &[(f64, f64)]) -> Polynomial {
        let places: Vec<f64> = points.iter().map(|p| p.0).collect();
        let mut differences: Vec<f64> = points.iter().map(|p| p.1).collect();
        for order in 1..places.len() {
            for i in (order..places.len()).rev() {
                differences[i] = (differences[i] - differences[i - 1]) / (places[i] - places[i - order]);
            }
        }
        Polynomial { places, differences }
    }

    fn at(&self, x: f64) -> f64 {
        let terms = self.places.iter().zip(&self.differences).rev();
        terms.fold(0.0, |sum, (place, difference)| sum * (x - place) + difference)
    }

    /// A zero between two places at which the signs differ, by bisection.
    pub(super) fn zero(&self, mut low: f64, mut high: f64) -> f64 {
        let rises = self.at(high) > 0.0;
        loop {
            let middle = 0.5 * (low + high);
            if !(low < middle && middle < high) {
                return middle;
            }
            if (self.at(middle) > 0.0) == rises {
                high = middle;
            } else {
                low = middle;
            }
        }
    }
}
