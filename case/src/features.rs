//! Features of a section that are too short for the functions of a beam.

use super::fault::{Fault, Made};
use flexion::quadrature::Gauss;
use flexion::section::Section;

/// Least distance of two stations at which elements end, over the length of the beam: the stiffness of an element grows with the inverse
/// of its cube, and its rounding error with it.
const SHORTEST: f64 = 1e-5;
/// Distance that is rounding, over the length.
const ONE: f64 = 1e-9;
/// Part of the flexibility that functions lose from which it is told.
const LOST: f64 = 1e-3;
/// Part of that which functions of half the width still lose, from which the finer run does not show it.
const HIDDEN: f64 = 0.75;

/// Refuses a section that jumps twice within next to no length.
pub(super) fn apart(jumps: &[f64], length: f64) -> Made<()> {
    let mut ends = vec![0.0];
    ends.extend(jumps);
    ends.push(length);
    let near = |pair: &&[f64]| (ONE * length..SHORTEST * length).contains(&(pair[1] - pair[0]));
    let Some(pair) = ends.windows(2).find(near) else { return Ok(()) };
    let message = format!(
        "the segment from x = {} m to {} m is {:.1e} m long: no element is shorter than 1e-5 of the beam",
        pair[0],
        pair[1],
        pair[1] - pair[0]
    );
    let help =
        "make the segment longer and as much stiffer: what counts is its length over its bending stiffness";
    Err(Fault::new("section", message).help(help).into())
}

/// A caution where functions that end at no station, each about `width` \[m\] wide, do not follow the bending stiffness: over a width they see
/// its mean, and the flexibility ∫dx/EI loses
///
/// ```text
/// Σ (∫ dx/EI − w²/∫EI dx)
/// ```
///
/// A finer run shows what falls with the width; what a feature far shorter than the width loses does not.
pub(super) fn hidden(section: &dyn Section, length: f64, width: f64) -> Option<String> {
    if section.breaks().is_empty() {
        return None;
    }
    let (gauss, stiffness) = (Gauss::new(4), |x: f64| section.resultants(x).bending_stiffness);
    let lost = |width: f64| {
        let count = (length / width).ceil().max(1.0);
        let border = |i: f64| length * i / count;
        let (mut lost, mut whole) = (0.0, 0.0);
        for i in 0..count as usize {
            let (a, b) = (border(i as f64), border(i as f64 + 1.0));
            let mut cuts = vec![a];
            cuts.extend(section.breaks().iter().filter(|x| a < **x && **x < b));
            cuts.push(b);
            let over = |f: &dyn Fn(f64) -> f64| -> f64 {
                cuts.windows(2).map(|cut| gauss.integrate(cut[0], cut[1], f)).sum()
            };
            let (flexible, stiff) = (over(&|x| 1.0 / stiffness(x)), over(&stiffness));
            lost += flexible - (b - a).powi(2) / stiff;
            whole += flexible;
        }
        lost / whole
    };
    let (now, half) = (lost(width), lost(0.5 * width));
    (now > LOST && half > HIDDEN * now).then(|| {
        format!(
            "the section changes within less than the functions of this basis follow: the beam is too stiff by about {:.2} % of its \
             flexibility, and twice the functions do not show it; take `basis.kind = \"finite-elements\"`, which end there",
            100.0 * now
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexion::section::{Interpolation, Resultants, Table};

    fn table(rows: &[(f64, f64)]) -> Table {
        let of = |&(x, ei): &(f64, f64)| {
            let all = Resultants {
                mass: 1.0,
                axial_stiffness: 1e9,
                bending_stiffness: ei,
                ..Resultants::default()
            };
            (x, all)
        };
        Table::new(10.0, &rows.iter().map(of).collect::<Vec<_>>(), Interpolation::Linear).unwrap()
    }

    /// 2 cm of a thousandth are as flexible as 20 m: all but what a straight curvature takes of them is lost at any width.
    #[test]
    fn a_feature_shorter_than_the_functions_is_told_and_one_jump_is_not() {
        let soft = [(0.0, 1.0), (4.5, 1.0), (4.5, 1e-3), (4.52, 1e-3), (4.52, 1.0), (10.0, 1.0)];
        let told = hidden(&table(&soft), 10.0, 1.0).unwrap();
        assert!(told.contains("66.58 %"), "{told}");
        let jump = [(0.0, 1.0), (4.5, 1.0), (4.5, 2.0), (10.0, 2.0)];
        assert_eq!(hidden(&table(&jump), 10.0, 1.0), None);
        assert_eq!(hidden(&table(&[(0.0, 1.0), (10.0, 3.0)]), 10.0, 1.0), None);
    }

    #[test]
    fn a_segment_of_no_length_is_refused() {
        assert!(apart(&[4.5, 4.500_01], 10.0).is_err());
        assert!(apart(&[4.5, 4.501, 9.999], 10.0).is_ok());
    }
}
