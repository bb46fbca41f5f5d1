//! Small deflections and frequencies against closed forms.

use super::chain::{Chain, cantilever, coupled, orders};
use flexion::linalg::{Mat3, Vec3};
use flexion::multibody::rotation::Quaternion;
use flexion::multibody::shear::Beam;
use flexion::section::Matrices;
use flexion::system::Frame;
use nalgebra::DMatrix;
use std::f64::consts::PI;

const LENGTH: f64 = 2.0;
const STIFFNESS: [f64; 6] = [90.0, 30.0, 40.0, 0.9, 1.3, 2.1];
const MASS: f64 = 1.5;
const INERTIA: [f64; 3] = [0.05, 0.02, 0.03];

/// The four lowest numbers of waves of a beam on two hinges: both branches of Timoshenko's beam in two planes, where
/// det [GA k² − μω², −GA k; −GA k, EI k² + GA − Jω²] = 0, waves of torsion and extension, held at both ends.
fn timoshenko() -> Vec<f64> {
    let mut all = Vec::new();
    for number in 1..=6 {
        let k = f64::from(number) * PI / LENGTH;
        for (shear, bending, inertia) in
            [(STIFFNESS[1], STIFFNESS[5], INERTIA[2]), (STIFFNESS[2], STIFFNESS[4], INERTIA[1])]
        {
            let (a, c) = (MASS * inertia, shear * k * k * bending * k * k);
            let b = MASS * (bending * k * k + shear) + inertia * shear * k * k;
            let root = (b * b - 4.0 * a * c).sqrt();
            // The smaller one by the product of both, without cancellation.
            all.extend([(2.0 * c / (b + root)).sqrt(), ((b + root) / (2.0 * a)).sqrt()]);
        }
        for wave in [STIFFNESS[3] / INERTIA[0], STIFFNESS[0] / MASS] {
            all.push(k * wave.sqrt());
        }
    }
    // The thickness shear of the whole beam: rotation without displacement.
    all.extend([(STIFFNESS[1] / INERTIA[2]).sqrt(), (STIFFNESS[2] / INERTIA[1]).sqrt()]);
    all.sort_by(f64::total_cmp);
    all
}

#[test]
fn frequencies_on_two_hinges_are_those_of_timoshenkos_closed_form() {
    let exact = timoshenko();
    let errors = [4, 8, 16].map(|n| {
        let mut chain = cantilever(LENGTH, n, Matrices::principal(STIFFNESS, MASS, INERTIA));
        chain.fixed.fill(false);
        let last = chain.fixed.len() - 6;
        for at in [0, last] {
            chain.fixed[at..at + 4].fill(true);
        }
        let found = chain.frequencies();
        let pairs = found.iter().zip(&exact).take(14);
        pairs.map(|(found, exact)| (found / exact - 1.0).abs()).collect::<Vec<f64>>()
    });
    println!("hinges: {errors:?}");
    for k in 0..14 {
        let of = errors.each_ref().map(|errors| errors[k]);
        // Order 6, to the rounding of the smallest of the numbers of a spectrum that reaches up to 10³.
        let order = orders(&of);
        assert!(of[2] < 1e-9 || order[1] > 5.7, "{k}: {of:?} {order:?}");
        assert!(of[2] < 1e-6, "{k}: {of:?}");
    }
}

/// A section with all couplings, and a mass with an offset.
fn general() -> Matrices {
    let mut of = Matrices::principal(STIFFNESS, MASS, INERTIA).with_mass_centre([0.06, -0.04]);
    of.stiffness = coupled(STIFFNESS, 0.3);
    of
}

/// The displacements and rotations (u, θ) at the tip of a clamped straight beam by a small force and couple there: with the
/// constant forces F and the moments M + (L − s) e₁ × F, the strains are e = C⁻¹ (F, M) and θ′ = κ, u′ = Γ − e₁ − e₁ × θ … in
/// closed form, since e is linear in s.
fn deflection(section: &Matrices, force: Vec3, couple: Vec3) -> [Vec3; 2] {
    let c = DMatrix::from_fn(6, 6, |i, j| section.stiffness[i][j]).try_inverse().unwrap();
    let axis = Vec3::AXES[0];
    let strain = |s: f64| {
        let moment = couple + (LENGTH - s) * axis.cross(force);
        let load = [force[0], force[1], force[2], moment[0], moment[1], moment[2]];
        let row = |i: usize| (0..6).map(|j| c[(i, j)] * load[j]).sum::<f64>();
        [Vec3([row(0), row(1), row(2)]), Vec3([row(3), row(4), row(5)])]
    };
    // Simpson's rule is exact for the integrals of cubics: θ(L) = ∫κ, u(L) = ∫ Γ + κ × e₁ (L − s) ds.
    let mut out = [Vec3::ZERO; 2];
    for (s, weight) in [(0.0, 1.0), (0.5 * LENGTH, 4.0), (LENGTH, 1.0)] {
        let [slope, bend] = strain(s);
        let weight = weight * LENGTH / 6.0;
        out[0] += weight * (slope + (LENGTH - s) * bend.cross(axis));
        out[1] += weight * bend;
    }
    out
}

#[test]
fn small_deflections_with_all_couplings_are_those_of_the_closed_form() {
    let section = general();
    for k in 0..6_usize {
        let unit = |at: usize| Vec3::AXES.get(k.wrapping_sub(at)).map_or(Vec3::ZERO, |x| 1e-7 * *x);
        let [force, couple] = [unit(0), unit(3)];
        for elements in [1, 3] {
            let mut chain = cantilever(LENGTH, elements, section);
            chain.load_tip(force, couple);
            chain.solve(1.0).unwrap();
            let Frame { position, rotation } = chain.tip();
            let found = [position - LENGTH * Vec3::AXES[0], Quaternion::from(rotation).logarithm()];
            let expected = deflection(&section, force, couple);
            for (found, expected) in found.into_iter().zip(expected) {
                // The squares of the deflections, and the rounding of the position.
                assert!((found - expected).norm() < 1e-12, "{k}: {found:?} for {expected:?}");
            }
        }
    }
}

/// The determinant of the forces at the free end by those at the clamp: of the transfer matrix exp(A L) of
/// e = C⁻¹ σ, u′ = Γ + θ × e₁ …, σ′ = −ω² M (u, θ) − (0, e₁ × N).
fn free_end(section: &Matrices, omega: f64) -> f64 {
    let c = DMatrix::from_fn(6, 6, |i, j| section.stiffness[i][j]).try_inverse().unwrap();
    let mut a = DMatrix::zeros(12, 12);
    for i in 0..6 {
        for j in 0..6 {
            a[(i, 6 + j)] = c[(i, j)];
            a[(6 + i, j)] = -omega * omega * section.mass[i][j];
        }
    }
    let cross = Mat3::skew(Vec3::AXES[0]);
    for i in 0..3 {
        for j in 0..3 {
            a[(i, 3 + j)] -= cross[i][j];
            a[(9 + i, 6 + j)] -= cross[i][j];
        }
    }
    let transfer = (LENGTH * a).exp();
    transfer.view((6, 6), (6, 6)).clone_owned().determinant()
}

#[test]
fn frequencies_with_all_couplings_are_those_of_the_transfer_matrix() {
    let section = general();
    let count = 8;
    let [coarse, middle, fine] = [3, 6, 12].map(|n| cantilever(LENGTH, n, section).frequencies());
    let mut errors = Vec::new();
    for k in 0..count {
        // The root of the determinant next to the extrapolated frequency, by bisection.
        let near = fine[k] + (fine[k] - middle[k]) / 63.0;
        let (mut low, mut high) = (near * (1.0 - 1e-3), near * (1.0 + 1e-3));
        let sign = free_end(&section, low).signum();
        assert!(sign != free_end(&section, high).signum(), "{k}");
        for _ in 0..60 {
            let mean = 0.5 * (low + high);
            if free_end(&section, mean).signum() == sign { low = mean } else { high = mean }
        }
        errors.push([&coarse, &middle, &fine].map(|of| (of[k] / low - 1.0).abs()));
    }
    println!("coupled: {errors:?}");
    for (k, errors) in errors.iter().enumerate() {
        assert!((errors[2] < 1e-10 || orders(errors)[1] > 5.7) && errors[2] < 1e-6, "{k}: {errors:?}");
    }
}

/// Equal damping times are Kelvin's and Voigt's: the matrix of damping is η times the stiffness.
#[test]
fn damping_times_are_those_of_the_strains() {
    let chain = cantilever(LENGTH, 3, general().with_damping_times([0.02; 6]));
    let [_, damping, stiffness] = chain.matrices();
    let largest = stiffness.amax();
    assert!((damping - 0.02 * stiffness).amax() < 1e-15 * largest);
    // The damping of torsion alone leaves an uncoupled bending alone.
    let section = Matrices::principal(STIFFNESS, MASS, INERTIA);
    let chain = cantilever(LENGTH, 3, section.with_damping_times([0.0, 0.0, 0.0, 0.1, 0.0, 0.0]));
    let [_, damping, stiffness] = chain.matrices();
    for i in 0..damping.nrows() {
        let expected = if i % 6 == 3 { 0.1 } else { 0.0 };
        assert!((damping[(i, i)] - expected * stiffness[(i, i)]).abs() < 1e-13);
    }
}

/// A tension through the tension centre does not bend, a force through the shear centre does not twist.
#[test]
fn forces_through_the_centres_do_not_bend_or_twist() {
    let [tension, shear] = [[0.1, -0.3], [0.25, 0.15]];
    let section =
        Matrices::principal(STIFFNESS, MASS, INERTIA).with_tension_centre(tension).with_shear_centre(shear);
    let arm = |[y, z]: [f64; 2]| Vec3([0.0, y, z]);
    for (centre, force, kept) in
        [(tension, Vec3([1e-6, 0.0, 0.0]), [3, 4, 5].as_slice()), (shear, Vec3([0.0, 1e-6, 2e-6]), &[3])]
    {
        let mut chain = cantilever(LENGTH, 2, section);
        chain.load_tip(force, arm(centre).cross(force));
        chain.solve(1.0).unwrap();
        for (e, element) in chain.beam.elements().iter().enumerate() {
            let at = e * 7 * (flexion::multibody::shear::NODES - 1);
            let q = chain.q[at..].first_chunk().unwrap();
            for sample in element.samples(q) {
                let largest = sample.strain.iter().fold(0.0, |a: f64, x| a.max(x.abs()));
                assert!(kept.iter().all(|k| sample.strain[*k].abs() < 1e-5 * largest), "{sample:?}");
            }
        }
    }
}

/// A rod that rotates steadily about its root: μ Ω² (s + u) + EA u″ = 0, s + u = sin ks/(k cos kL), k² = μΩ²/EA.
#[test]
fn a_rotating_rod_stretches_as_in_closed_form() {
    let section = Matrices::principal(STIFFNESS, MASS, INERTIA);
    let spin = 3.0;
    let k = (MASS * spin * spin / STIFFNESS[0]).sqrt();
    let exact = (k * LENGTH).sin() / (k * (k * LENGTH).cos());
    let errors = [1, 2, 4].map(|n| {
        let beam =
            Beam::straight(Frame { position: Vec3::ZERO, rotation: Mat3::IDENTITY }, LENGTH, n, section);
        let mut chain = Chain::clamped(beam.unwrap());
        let size = chain.beam.velocities();
        let mut v = vec![0.0; size];
        for _ in 0..4 {
            // Steady rotation: no acceleration beside that towards the axis.
            chain.beam.move_rigidly(Vec3::ZERO, spin * Vec3::AXES[2], &chain.q, &mut v);
            let mut a = vec![0.0; size];
            for i in 0..size / 6 {
                (-spin * spin * chain.beam.node(i, &chain.q).position).put(&mut a, 6 * i);
            }
            let mut r = vec![0.0; size];
            chain.beam.add_forces([&chain.q, &v, &a], Vec3::ZERO, &mut r);
            // By the axial unknowns: r̈ = −Ω² r.
            let rows = size / 6 - 1;
            let mut matrix = DMatrix::zeros(rows, rows);
            let w = flexion::system::Weights::new(-spin * spin, 0.0, 1.0);
            chain.beam.add_tangent([&chain.q, &v, &a], Vec3::ZERO, &w, |at, block| {
                for i in (0..block.len()).step_by(6).filter(|i| at + i > 0) {
                    for j in (0..block.len()).step_by(6).filter(|j| at + j > 0) {
                        matrix[((at + i) / 6 - 1, (at + j) / 6 - 1)] += block[i][j];
                    }
                }
            });
            let right = nalgebra::DVector::from_fn(rows, |i, _| -r[6 * (i + 1)]);
            let d = matrix.lu().solve(&right).unwrap();
            (0..rows).for_each(|i| chain.q[7 * (i + 1)] += d[i]);
            // Across and about the axis there is no force.
            assert!((6..size).filter(|i| i % 6 > 0).all(|i| r[i].abs() < 1e-12), "{r:?}");
        }
        (chain.tip().position[0] - exact).abs()
    });
    println!("rod: {errors:?}");
    assert!(orders(&errors).iter().all(|order| *order > 5.8) && errors[2] < 1e-7, "{errors:?}");
}
