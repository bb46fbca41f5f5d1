//! The high-order coupling against an energy written down apart from it, finite differences and itself.

use super::{HighCoupling, MOST_ELEMENTS};
use crate::basis::{
    BSpline, Basis, Bezier, Field, Hermite, Lagrange, Modes, Polynomial, PolynomialParameters, Radial,
    RadialParameters,
};
use crate::hub_beam::tests::{
    LENGTH, RADIUS, TwoFibres, check_power, check_tangent, free_hub, hub, relative, residual, state,
};
use crate::hub_beam::{Beam, Coupling, Drive, Fields, Foreshortening, Hub, HubBeam, LinearCoupling, Mass};
use crate::quadrature::Gauss;
use crate::section::{Resultants, Section};
use crate::system::{Observed, State, System};

/// ρA of the two fibres and nothing else.
#[derive(Debug)]
struct MassOnly;

impl Section for MassOnly {
    fn resultants(&self, x: f64) -> Resultants {
        let mass = TwoFibres::fibres(x).iter().map(|f| f.1).sum();
        Resultants { mass, axial_stiffness: 2200.0, bending_stiffness: 17.0, ..Resultants::default() }
    }
}

fn elements(count: usize, degree: usize) -> Fields {
    Fields::new(
        LENGTH,
        Box::new(Lagrange::new(LENGTH, count, degree).unwrap()),
        Box::new(Hermite::new(LENGTH, count, Field::Transverse).unwrap()),
        &[],
    )
}

fn high<'a>(fields: Fields, beam: impl Into<Beam<'a>>, hub: Hub) -> HubBeam<HighCoupling> {
    let coupling = HighCoupling::new(fields, beam, &hub).unwrap();
    HubBeam::new(hub, coupling, &[])
}

/// Every basis, by itself and with breaks of the section that cut its cells.
fn fields_of_every_basis() -> Vec<Fields> {
    let both = |of: &dyn Fn(Field) -> Box<dyn Basis>| [of(Field::Axial), of(Field::Transverse)];
    let polynomial = PolynomialParameters { nodes: 6, support: 1.5 };
    let pairs = [
        both(&|field| Box::new(Modes::new(LENGTH, 3, field).unwrap())),
        both(&|field| Box::new(Radial::new(LENGTH, RadialParameters::new(6), field).unwrap())),
        both(&|field| Box::new(Polynomial::new(LENGTH, polynomial, field).unwrap())),
        both(&|field| Box::new(BSpline::new(LENGTH, 24, 3, field).unwrap())),
        both(&|field| Box::new(Bezier::new(LENGTH, 1, 6, field).unwrap())),
        both(&|field| Box::new(Bezier::new(LENGTH, 12, 4, field).unwrap())),
    ];
    let mut all: Vec<Fields> = pairs
        .into_iter()
        .map(|[axial, transverse]| Fields::new(LENGTH, axial, transverse, &[0.31 * LENGTH]))
        .collect();
    all.push(elements(12, 1));
    all.push(elements(3, 2));
    all.push(elements(14, 2));
    all
}

/// T of a beam without thickness: ½∫ρA[(Ẋ − ωY)² + (Ẏ + ωX)²] with w_c summed afresh from the root to each point, and
/// of masses on it that rotate with w₂′.
fn kinetic_energy(fields: &Fields, masses: &[Mass], s: &State, speed: f64) -> f64 {
    let gauss = Gauss::new(14);
    let cells = fields.cells();
    let particle = |x: f64, mass: f64| {
        let (mut shortening, mut rate) = (0.0, 0.0);
        let mut boundaries: Vec<f64> = cells.iter().copied().filter(|end| *end < x).collect();
        boundaries.push(x);
        for piece in boundaries.windows(2) {
            for (y, w) in gauss.on(piece[0], piece[1]) {
                let b = fields.point(y, w).transverse;
                shortening -= 0.5 * w * b.field(1, &s.q).powi(2);
                rate -= w * b.field(1, &s.q) * b.field(1, &s.v);
            }
        }
        let point = fields.point(x, mass);
        let (a, b) = (point.axial, point.transverse);
        let (px, py) = (RADIUS + x + a.field(0, &s.q) + shortening, b.field(0, &s.q));
        let (vx, vy) = (a.field(0, &s.v) + rate, b.field(0, &s.v));
        0.5 * mass * ((vx - speed * py).powi(2) + (vy + speed * px).powi(2))
    };
    let mut total = 0.5 * 0.7 * speed * speed;
    for ends in cells.windows(2) {
        for (x, weight) in gauss.on(ends[0], ends[1]) {
            total += particle(x, weight * MassOnly.resultants(x).mass);
        }
    }
    for m in masses {
        let rate = fields.point(m.station, 1.0).transverse.field(1, &s.v) + speed;
        total += particle(m.station, m.mass) + 0.5 * m.inertia * rate * rate;
    }
    total
}

/// d/dt ∂T/∂v − ∂T/∂q by nothing but values of T, along the motion q + v t + ½ a t².
fn lagrange(fields: &Fields, masses: &[Mass], s: &State, speed: f64, acceleration: f64) -> Vec<f64> {
    let n = fields.len();
    let moved = |t: f64| {
        let mut out = s.clone();
        for i in 0..n {
            out.q[i] += t * (s.v[i] + 0.5 * t * s.a[i]);
            out.v[i] += t * s.a[i];
        }
        (out, speed + acceleration * t)
    };
    let stencil = [(1.0, -2.0), (-8.0, -1.0), (8.0, 1.0), (-1.0, 2.0)];
    let (h, d) = (2e-3, 1e-2);
    (0..n)
        .map(|k| {
            let momentum = |t: f64| -> f64 {
                let (at, speed) = moved(t);
                let value = |c: f64| {
                    let mut at = at.clone();
                    at.v[k] += c * d;
                    kinetic_energy(fields, masses, &at, speed)
                };
                // T is quadratic in v: the central difference is exact.
                (value(1.0) - value(-1.0)) / (2.0 * d)
            };
            let by_position = |c: f64| {
                let mut at = s.clone();
                at.q[k] += c * h;
                kinetic_energy(fields, masses, &at, speed)
            };
            let rate: f64 = stencil.iter().map(|(c, t)| c * momentum(t * h) / (12.0 * h)).sum();
            let slope: f64 = stencil.iter().map(|(c, t)| c * by_position(*t) / (12.0 * h)).sum();
            rate - slope
        })
        .collect()
}

/// Inside the second of three elements, at the end of it, and at the tip.
const MASSES: [Mass; 3] = [
    Mass { station: 0.45 * LENGTH, mass: 0.7, inertia: 0.02 },
    Mass { station: 2.0 / 3.0 * LENGTH, mass: 0.3, inertia: 0.0 },
    Mass { station: LENGTH, mass: 0.4, inertia: 0.05 },
];

#[test]
fn forces_are_lagranges_of_an_energy_with_nothing_dropped() {
    let hub = hub();
    let Drive::Prescribed(motion) = &hub.drive else { panic!("prescribed") };
    let beams = [&[], &MASSES[..]].map(|masses| Beam::new(&MassOnly, masses.to_vec(), &[]));
    let elements = |field| -> Box<dyn Basis> {
        match field {
            Field::Axial => Box::new(Lagrange::new(LENGTH, 3, 2).unwrap()),
            Field::Transverse => Box::new(Hermite::new(LENGTH, 3, field).unwrap()),
        }
    };
    let splines = |field| -> Box<dyn Basis> { Box::new(BSpline::new(LENGTH, 3, 3, field).unwrap()) };
    let bases: [&dyn Fn(Field) -> Box<dyn Basis>; 2] = [&elements, &splines];
    for (beam, basis) in beams.iter().flat_map(|s| bases.map(|b| (s, b))) {
        let fields = || Fields::new(LENGTH, basis(Field::Axial), basis(Field::Transverse), &beam.breaks);
        let mut system = high(fields(), beam, hub.clone());
        let s = state(&system, 0.3);
        let at = motion.at(s.t);
        let strain: Vec<f64> = {
            let (_, _, stiffness) = system.coupling().inertia().matrices();
            let mut product = vec![0.0; s.q.len()];
            stiffness.multiply(&s.q, &mut product);
            product
        };
        let forces: Vec<f64> = residual(&mut system, &s).iter().zip(&strain).map(|(r, k)| r - k).collect();
        let expected = lagrange(&fields(), &beam.masses, &s, at.speed, at.acceleration);
        let error = relative(&forces, &expected);
        assert!(error < 1e-8, "{error:e}");
        // And they are not those of the first order.
        let coupling = LinearCoupling::new(fields(), beam, &hub, Foreshortening::First);
        let mut first = HubBeam::new(hub.clone(), coupling, &[]);
        let forces: Vec<f64> = residual(&mut first, &s).iter().zip(&strain).map(|(r, k)| r - k).collect();
        assert!(relative(&forces, &expected) > 1e-2);
        let kinetic = kinetic_energy(&fields(), &beam.masses, &s, at.speed);
        assert!((system.energy(&s).kinetic / kinetic - 1.0).abs() < 1e-12);
    }
}

#[test]
fn the_points_of_modes_integrate_products_of_four_of_them_to_rounding() {
    for n in [1, 3, 5, 9] {
        // Breaks of the section cut every cell in two, which doubles the points.
        let halves: Vec<f64> = (0..n).map(|i| LENGTH * (i as f64 + 0.5) / n as f64).collect();
        let [few, many] = [&[], &halves[..]].map(|breaks| {
            let basis = |field| Box::new(Modes::new(LENGTH, n, field).unwrap());
            let fields = Fields::new(LENGTH, basis(Field::Axial), basis(Field::Transverse), breaks);
            let mut system = high(fields, &MassOnly, free_hub());
            let s = state(&system, 0.3);
            residual(&mut system, &s)
        });
        let error = relative(&few, &many);
        assert!(error < 1e-13, "{n} modes: {error:e}");
    }
}

#[test]
fn tangents_equal_finite_differences_on_every_basis() {
    // The free hub's equations hold those of the prescribed one.
    for fields in fields_of_every_basis() {
        let mut system = high(fields, &TwoFibres, free_hub());
        let s = state(&system, 0.1);
        check_tangent(&mut system, &s);
    }
}

#[test]
fn tangents_with_lumped_masses_equal_finite_differences() {
    let beam = Beam::new(&TwoFibres, MASSES.to_vec(), &[]);
    let both = |of: &dyn Fn(Field) -> Box<dyn Basis>| {
        Fields::new(LENGTH, of(Field::Axial), of(Field::Transverse), &beam.breaks)
    };
    let modes = both(&|field| Box::new(Modes::new(LENGTH, 3, field).unwrap()));
    let elements = both(&|field| match field {
        Field::Axial => Box::new(Lagrange::new(LENGTH, 3, 1).unwrap()),
        Field::Transverse => Box::new(Hermite::new(LENGTH, 3, field).unwrap()),
    });
    for fields in [modes, elements] {
        let mut system = high(fields, &beam, free_hub());
        let s = state(&system, 0.1);
        check_tangent(&mut system, &s);
        check_power(&mut system);
    }
}

#[test]
fn small_deflections_are_those_of_the_first_order() {
    let coupling = LinearCoupling::new(elements(4, 1), &TwoFibres, &hub(), Foreshortening::First);
    let mut first = HubBeam::new(hub(), coupling, &[]);
    let mut high = high(elements(4, 1), &TwoFibres, hub());
    let difference = |first: &mut dyn System, high: &mut dyn System, size: f64| {
        let s = state(high, size);
        let (a, b) = (residual(first, &s), residual(high, &s));
        a.iter().zip(&b).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()))
    };
    let (one, two) = (difference(&mut first, &mut high, 1e-3), difference(&mut first, &mut high, 2e-3));
    // What is beyond the first order is quadratic in the unknowns.
    assert!((two / one - 4.0).abs() < 0.05, "{one:e} {two:e}");
}

#[test]
fn more_elements_than_a_full_tangent_allows_are_refused() {
    assert!(HighCoupling::new(elements(MOST_ELEMENTS, 1), &TwoFibres, &hub()).is_ok());
    let refused = HighCoupling::new(elements(MOST_ELEMENTS + 1, 1), &TwoFibres, &hub()).unwrap_err();
    assert!(refused.to_string().contains("301 elements"), "{refused}");
}
