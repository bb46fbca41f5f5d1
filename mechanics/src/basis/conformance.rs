//! What every basis must satisfy, checked from outside. What is not satisfied is reported with what was found and what
//! was expected.

use super::{Basis, Field};
use crate::quadrature::Gauss;

/// Receives the name of a check, the place, what was found there and what was expected.
pub type Report<'a> = dyn FnMut(&'static str, String, f64, f64) + 'a;

/// All checks; derivatives and quadrature to the given relative tolerances.
pub fn all(basis: &dyn Basis, field: Field, (difference, quadrature): (f64, f64), report: &mut Report<'_>) {
    let mut ordered = true;
    numbering(basis, &mut |check, place, found, expected| {
        ordered = false;
        report(check, place, found, expected);
    });
    if ordered {
        derivatives(basis, difference, report);
        clamp(basis, field, report);
        continuity(basis, field, report);
        points(basis, field, quadrature, report);
    }
}

/// Cells, supports and anchors ascend, and all functions belong to a cell.
fn numbering(basis: &dyn Basis, report: &mut Report<'_>) {
    let ends = basis.cells();
    if ends.len() < 2 || ends[0] != 0.0 {
        return report("cells", "the first boundary".into(), ends.first().copied().unwrap_or(f64::NAN), 0.0);
    }
    for c in ends.windows(2).filter(|c| !(c[0] < c[1])) {
        report("cells", "a boundary, which must ascend,".into(), c[1], c[0]);
    }
    let (cells, length) = (ends.len() - 1, ends[ends.len() - 1]);
    let mut number = |name: &str, found: usize, expected: usize, wrong: bool| {
        if wrong {
            report("supports", name.to_owned(), found as f64, expected as f64);
        }
    };
    let (first, end) = (basis.support(0).start, basis.support(cells - 1).end);
    number("the first function of the first cell", first, 0, first != 0);
    number("the number of functions up to the last cell", end, basis.len(), end != basis.len());
    for c in 0..cells {
        let (b, most) = (basis.support(c), basis.max_support());
        number(&format!("the number of functions of cell {c}"), b.len(), most, b.len() > most);
        if c > 0 {
            let a = basis.support(c - 1);
            number(&format!("the first function of cell {c}"), b.start, a.start, b.start < a.start);
            number(&format!("the first function of cell {c}"), b.start, a.end, b.start > a.end);
            number(&format!("the last function of cell {c}"), b.end, a.end, b.end < a.end);
        }
        let place = basis.locate(0.5 * (ends[c] + ends[c + 1]));
        number(&format!("the cell at the middle of cell {c}"), place, c, place != c);
    }
    // A mean of places is rounded.
    let (mut least, most) = (0.0, length * (1.0 + 1e-12));
    for i in 0..end.min(basis.len()) {
        let anchor = basis.anchor(i);
        if !(anchor >= least && anchor <= most) {
            let bound = if anchor < least { least } else { length };
            report("anchors", format!("that of function {i}, which must ascend from 0 to L,"), anchor, bound);
        }
        least = anchor;
    }
}

/// Derivative d + 1 against the five-point difference of derivative d, relative to its largest value.
pub fn derivatives(basis: &dyn Basis, tolerance: f64, report: &mut Report<'_>) {
    let mut buffers = vec![vec![0.0; basis.max_support()]; 6];
    let scale: Vec<f64> = (0..4).map(|d| largest(basis, d)).collect();
    for c in 0..basis.cells().len() - 1 {
        let (a, b) = (basis.cells()[c], basis.cells()[c + 1]);
        for s in [0.07, 0.31, 0.5, 0.83, 0.94] {
            let (x, h) = (a + s * (b - a), 2e-3 * (b - a));
            for d in 0..3 {
                for (buffer, step) in buffers.iter_mut().zip([-2.0, -1.0, 1.0, 2.0]) {
                    basis.eval(c, x + step * h, d, buffer);
                }
                let support = basis.eval(c, x, d + 1, &mut buffers[5]);
                for (k, i) in support.enumerate() {
                    let y: Vec<f64> = buffers[..4].iter().map(|b| b[k]).collect();
                    let slope = (y[0] - 8.0 * y[1] + 8.0 * y[2] - y[3]) / (12.0 * h);
                    // Rounding of the difference itself.
                    let floor = 8.0 * f64::EPSILON * scale[d] / h;
                    if !((buffers[5][k] - slope).abs() <= tolerance * scale[d + 1] + floor) {
                        let place = format!("derivative {} of function {i} at x = {x} m", d + 1);
                        report("derivatives", place, buffers[5][k], slope);
                    }
                }
            }
        }
    }
}

/// Largest |φ⁽ᵈ⁾| of all functions at a few places of each cell.
pub fn largest(basis: &dyn Basis, derivative: usize) -> f64 {
    let mut out = vec![0.0; basis.max_support()];
    let mut most: f64 = 0.0;
    for c in 0..basis.cells().len() - 1 {
        let (a, b) = (basis.cells()[c], basis.cells()[c + 1]);
        for k in 0..=8 {
            let count = basis.eval(c, a + k as f64 / 8.0 * (b - a), derivative, &mut out).len();
            most = out[..count].iter().fold(most, |m, v| m.max(v.abs()));
        }
    }
    most
}

/// Highest derivative that is continuous, and zero at the clamp.
fn smoothness(field: Field) -> usize {
    if field == Field::Transverse { 1 } else { 0 }
}

fn clamp(basis: &dyn Basis, field: Field, report: &mut Report<'_>) {
    let mut out = vec![0.0; basis.max_support()];
    for d in 0..=smoothness(field) {
        let scale = largest(basis, d);
        for (k, i) in basis.eval(0, 0.0, d, &mut out).enumerate() {
            if !(out[k].abs() <= 1e-11 * scale) {
                report("clamp", format!("derivative {d} of function {i} at x = 0"), out[k], 0.0);
            }
        }
    }
}

fn continuity(basis: &dyn Basis, field: Field, report: &mut Report<'_>) {
    let (mut left, mut right) = (vec![0.0; basis.max_support()], vec![0.0; basis.max_support()]);
    for d in 0..=smoothness(field) {
        let scale = largest(basis, d);
        for c in 1..basis.cells().len() - 1 {
            let x = basis.cells()[c];
            let (a, b) = (basis.eval(c - 1, x, d, &mut left), basis.eval(c, x, d, &mut right));
            for i in a.start..b.end {
                let one = if a.contains(&i) { left[i - a.start] } else { 0.0 };
                let two = if b.contains(&i) { right[i - b.start] } else { 0.0 };
                if !((one - two).abs() <= 1e-10 * scale) {
                    report(
                        "continuity",
                        format!("derivative {d} of function {i} behind x = {x} m"),
                        two,
                        one,
                    );
                }
            }
        }
    }
}

/// ∫ φᵢ⁽ᵈ⁾ φⱼ⁽ᵈ⁾ w dx with `points` Gauss points a cell, row-major.
pub fn gram(basis: &dyn Basis, derivative: usize, points: usize, weight: impl Fn(f64) -> f64) -> Vec<f64> {
    let (n, gauss) = (basis.len(), Gauss::new(points));
    let mut out = vec![0.0; basis.max_support()];
    let mut matrix = vec![0.0; n * n];
    for c in 0..basis.cells().len() - 1 {
        for (x, w) in gauss.on(basis.cells()[c], basis.cells()[c + 1]) {
            let support = basis.eval(c, x, derivative, &mut out);
            for (k, i) in support.clone().enumerate() {
                for (l, j) in support.clone().enumerate() {
                    matrix[i * n + j] += w * weight(x) * out[k] * out[l];
                }
            }
        }
    }
    matrix
}

/// The rule the basis asks for against one of many more points, relative to √(Gᵢᵢ Gⱼⱼ).
pub fn points(basis: &dyn Basis, field: Field, tolerance: f64, report: &mut Report<'_>) {
    let (n, points) = (basis.len(), basis.points_per_cell());
    let length = basis.cells()[basis.cells().len() - 1];
    for d in 0..=smoothness(field) + 1 {
        let weight = |x: f64| 0.3 + x / length;
        let (few, many) = (gram(basis, d, points, weight), gram(basis, d, 2 * points + 6, weight));
        for i in 0..n {
            for j in 0..n {
                let scale = (many[i * n + i] * many[j * n + j]).sqrt();
                let (found, expected) = (few[i * n + j], many[i * n + j]);
                if !((found - expected).abs() <= tolerance * scale) {
                    let place = format!("∫ φ_{i} φ_{j} w dx of derivatives {d} with {points} points a cell");
                    report("quadrature", place, found, expected);
                }
            }
        }
    }
}
