//! Discs on shafts: modes, critical speeds and ranges of instability against closed forms.

use flexion::analysis::campbell::{Campbell, HubState, Instability, Plan, campbell};
use flexion::analysis::modes::{Modes, modes};
use flexion::analysis::rotation::rotate;
use flexion::analysis::stability;
use flexion::drive::Actuator;
use flexion::linalg::Vec3;
use flexion::multibody::slender::{Beam, Properties, Station};
use flexion::multibody::{Axis, Body, Drive, Flexible, Kind, Model, Multibody, Part, Rotating};
use flexion::profile::Constant;
use flexion::system::{Dynamics, State};
use nalgebra::DMatrix;
use num_complex::Complex64;
use std::sync::Arc;

const Z: [f64; 3] = [0.0, 0.0, 1.0];

/// A shaft along z through the origin at station 0, with discs on it.
#[derive(Clone)]
struct Shaft {
    length: f64,
    elements: usize,
    /// Mass per length [kg/m].
    mass: f64,
    axial: f64,
    torsion: f64,
    /// Bending stiffnesses for deflections along y and x [N m²].
    bending: [f64; 2],
    /// Moment of inertia of the section about its tangent, over length [kg m].
    polar: f64,
    /// Discs: node, mass, moments of inertia.
    discs: Vec<(usize, f64, [f64; 3])>,
    /// What holds both ends on the ground.
    ends: [Option<Kind>; 2],
    /// Damping of the shaft in proportion to its stiffness \[s\], and of the discs in proportion to their mass [1/s].
    damping: [f64; 2],
}

impl Shaft {
    fn system(&self) -> Rotating {
        let root = Station { position: Vec3::ZERO, tangent: Vec3(Z), normal: Vec3([1.0, 0.0, 0.0]) };
        let [ey, ex] = self.bending;
        let properties =
            Properties::principal([self.axial, self.torsion, ex, ey], self.mass, [self.polar, 0.0, 0.0]);
        let beam = Beam::straight(root, self.length, self.elements, properties).unwrap();
        let mut model = Model::new();
        let beam = model.beam(Flexible { viscosity: self.damping[0], ..Flexible::new("shaft", beam) });
        let place = |node: usize| [0.0, 0.0, self.length * node as f64 / self.elements as f64];
        for (end, kind) in [0, self.elements].into_iter().zip(self.ends) {
            if let Some(kind) = kind {
                let parts = [Part::Ground, Part::Section { beam, node: end }];
                model.join(&format!("end{end}"), kind, parts, place(end), (Z, None)).unwrap();
            }
        }
        for (i, (node, mass, moments)) in self.discs.iter().enumerate() {
            let mut disc = Body::new(&format!("disc{i}"), *mass, *moments).at(place(*node));
            disc.damping = self.damping[1];
            let body = model.body(disc);
            let parts = [Part::Section { beam, node: *node }, body];
            model.join(&format!("fix{i}"), Kind::Fixed, parts, place(*node), (Z, None)).unwrap();
        }
        Rotating::new(Multibody::new(model).unwrap(), Axis::new([0.0; 3], Z).unwrap())
    }

    fn modes(&self, speed: f64, count: usize) -> Modes {
        let mut system = self.system();
        let mut s: State = system.initial();
        rotate(&mut system, &mut s, 0.0, speed, &mut || true).unwrap();
        modes(&mut system, &s, count, &[]).unwrap_or_else(|error| panic!("{speed} rad/s, {count}: {error}"))
    }

    fn campbell(&self, speeds: Vec<f64>, count: usize) -> Campbell {
        let plan = Plan { speeds, count, stations: Vec::new(), hub: HubState::Held, revolutions: 2 };
        campbell(Box::new(self.system()), &plan, |_| true).unwrap()
    }
}

/// A disc at the end of a clamped shaft almost without mass.
fn overhung() -> Shaft {
    Shaft {
        length: 0.8,
        elements: 12,
        mass: 1e-6,
        axial: 1e8,
        torsion: 1e6,
        bending: [200.0; 2],
        polar: 1e-7,
        discs: vec![(12, 2.0, [0.05, 0.05, 0.09])],
        ends: [Some(Kind::Fixed), None],
        damping: [0.0; 2],
    }
}

/// A disc without inertia of rotation in the middle of a shaft on two hinges, almost without mass. One of them holds its rotation about
/// its axis: of a rotation that is free rounding would leave an eigenvalue λ² = ε GJ/(h I) ~ 10⁻² s⁻² of the inertia I of disc and shaft.
fn jeffcott(bending: [f64; 2]) -> Shaft {
    Shaft {
        length: 1.0,
        axial: 1e9,
        bending,
        discs: vec![(6, 3.0, [1e-6; 3])],
        ends: [Some(Kind::Universal), Some(Kind::Spherical)],
        ..overhung()
    }
}

/// Frequencies ω of the whirls of an overhung disc on a shaft without mass, seen from the ground: of z = (deflection, slope), complex,
/// (K + ω Ω Ip E₂₂ − ω² M) z = 0 with M = diag(m, Id) and the stiffness of a cantilever at its tip.
fn whirls(shaft: &Shaft, speed: f64) -> Vec<f64> {
    let (_, m, [id, _, ip]) = shaft.discs[0];
    let (l, e) = (shaft.length, shaft.bending[0]);
    let k = [[12.0 * e / l.powi(3), -6.0 * e / (l * l)], [-6.0 * e / (l * l), 4.0 * e / l]];
    let a = DMatrix::from_row_slice(
        4,
        4,
        &[
            0.0,
            0.0,
            1.0,
            0.0, //
            0.0,
            0.0,
            0.0,
            1.0, //
            k[0][0] / m,
            k[0][1] / m,
            0.0,
            0.0, //
            k[1][0] / id,
            k[1][1] / id,
            0.0,
            speed * ip / id,
        ],
    );
    a.complex_eigenvalues().iter().map(|x| x.re).collect()
}

#[test]
fn an_overhung_disc_on_a_light_shaft_whirls_as_the_shaft_without_mass_would() {
    let shaft = overhung();
    for speed in [0.0, 5.0, 12.0, 22.0] {
        // Seen from the rotating frame; forward and backward whirls of one size are two modes.
        let mut expected: Vec<f64> = whirls(&shaft, speed).iter().map(|w| (w - speed).abs()).collect();
        expected.sort_by(f64::total_cmp);
        for count in [1, 2, 3, 4, 5, 8, 10, 13] {
            let found = shaft.modes(speed, count);
            assert_eq!(found.modes.len(), count);
            for (mode, expected) in found.modes.iter().zip(&expected) {
                assert_eq!(mode.eigenvalue.re, 0.0);
                // The mass of the shaft, 4e-7 of the disc's, shifts a frequency by half of its part.
                let off = mode.frequency() / expected - 1.0;
                assert!(off.abs() < 1e-6, "{speed} rad/s, {count}: {} for {expected}", mode.frequency());
            }
        }
    }
}

/// One critical speed, for Ip > Id: det(K − Ω² diag(m, Id − Ip)) = 0. Beyond it the stiffness is indefinite, and the whirl stable.
#[test]
fn the_critical_speed_of_an_overhung_disc_is_that_of_its_forward_whirl() {
    let shaft = overhung();
    let gap = |speed: f64| whirls(&shaft, speed).iter().map(|w| w - speed).fold(f64::NEG_INFINITY, f64::max);
    // The slower forward whirl meets the speed where one of ω − Ω changes its sign.
    let positive = |speed: f64| whirls(&shaft, speed).iter().filter(|w| **w > speed).count();
    assert!(gap(1.0) > 0.0);
    let (mut low, mut high) = (1.0, 60.0);
    while high - low > 1e-10 {
        let middle = 0.5 * (low + high);
        if positive(middle) == positive(1.0) { low = middle } else { high = middle }
    }
    let diagram = shaft.campbell((0..=12).map(|i| 5.0 * f64::from(i)).collect(), 4);
    let [critical] = diagram.criticals[..] else { panic!("{:?}", diagram.criticals) };
    assert_eq!(critical.directions, 2);
    assert!((critical.speed / low - 1.0).abs() < 1e-6, "{} for {low}", critical.speed);
    assert_eq!(diagram.instabilities, []);
    assert_eq!(diagram.speeds.last(), Some(&60.0));
}

/// m λ² + 2 m Ω λ J + (k_x − m Ω², k_y − m Ω²): stable up to √(k_x/m), divergent up to √(k_y/m), and stable above. 17/35 of the mass of the
/// shaft moves with the disc (Rayleigh).
#[test]
fn a_shaft_of_two_stiffnesses_is_unstable_between_its_two_critical_speeds() {
    let shaft = Shaft { mass: 1e-3, ..jeffcott([140.0, 100.0]) };
    let mass = 3.0 + 17.0 / 35.0 * shaft.mass * shaft.length;
    let [first, second] = [100.0, 140.0].map(|e| (48.0 * e / mass).sqrt());
    let diagram = shaft.campbell((0..=30).map(|i| 2.0 * f64::from(i)).collect(), 4);
    let [Instability::Divergence { speed, until: Some(until) }] = diagram.instabilities[..] else {
        panic!("{:?}", diagram.instabilities);
    };
    let speeds: Vec<f64> = diagram.criticals.iter().map(|c| c.speed).collect();
    // Rayleigh's quotient leaves (3e-4)² of a critical speed, and a speed is enclosed to 1e-7 of it. Divergence ends where Re λ < 1e-7 |λ|,
    // of λ² that is zero at the critical speed: one or two times 1e-7 beyond it.
    for (found, expected) in [(speed, first), (until, second), (speeds[0], first), (speeds[1], second)] {
        assert!((found / expected - 1.0).abs() < 5e-7, "{found} for {expected}");
    }
    assert_eq!(speeds.len(), 2);
    let last = *diagram.speeds.last().unwrap();
    assert_eq!(last, 60.0);
    // λ⁴ + λ² (a + b + 4Ω²) + a b = 0 with a, b = k/m − Ω².
    let [a, b] = [first, second].map(|w| w * w - last * last);
    let half = 0.5 * (a + b + 4.0 * last * last);
    let root = (half * half - a * b).sqrt();
    let mut found: Vec<f64> =
        diagram.branches.iter().map(|b| b.points.last().unwrap().mode.frequency()).collect();
    found.retain(|w| *w > 0.0 && *w < 1e3);
    found.sort_by(f64::total_cmp);
    for (found, expected) in found.iter().zip([(half - root).sqrt(), (half + root).sqrt()]) {
        assert!((found / expected - 1.0).abs() < 1e-5, "{found} for {expected}");
    }
}

/// The same shaft, of which nothing holds the rotation about its axis: next to a critical speed the deflection is softer than the rotation, and
/// rounding alone gives that a stiffness, of either sign by the mesh.
#[test]
fn a_free_spin_is_no_critical_speed() {
    for elements in [4, 8, 16] {
        let shaft = Shaft {
            elements,
            discs: vec![(elements / 2, 3.0, [1e-6; 3])],
            ends: [Some(Kind::Spherical); 2],
            ..jeffcott([140.0, 100.0])
        };
        let diagram = shaft.campbell((0..=6).map(|i| 9.0 * f64::from(i)).collect(), 2);
        let found: Vec<f64> = diagram.criticals.iter().map(|c| c.speed).collect();
        let expected = [100.0, 140.0].map(|e| (48.0 * e / 3.0_f64).sqrt());
        assert_eq!(found.len(), 2, "{elements} elements: {found:?}");
        for (found, expected) in found.iter().zip(expected) {
            assert!((found / expected - 1.0).abs() < 5e-6, "{elements} elements: {found} for {expected}");
        }
    }
}

/// Damping c_i that rotates with the shaft and c_e that does not: in the rotating frame
/// m λ² + (c_e + c_i + 2iΩm) λ + k − mΩ² + iΩ c_e = 0, unstable beyond Ω = (1 + c_e/c_i) √(k/m).
#[test]
fn a_shaft_with_internal_damping_flutters_beyond_its_critical_speed() {
    let (m, k, viscosity) = (3.0, 4800.0, 1e-3);
    for external in [0.0, 0.8] {
        let shaft = Shaft { damping: [viscosity, external], ..jeffcott([100.0; 2]) };
        let (ci, ce) = (viscosity * k, external * m);
        let limit = (1.0 + ce / ci) * (k / m).sqrt();
        for speed in [20.0, 0.98 * limit, 1.02 * limit, 70.0_f64] {
            let b = Complex64::new(ce + ci, 2.0 * m * speed);
            let c = Complex64::new(k - m * speed * speed, ce * speed);
            let root = (b * b - 4.0 * m * c).sqrt();
            for (mode, expected) in shaft.modes(speed, 2).modes.iter().zip([root - b, -root - b]) {
                let expected = expected / (2.0 * m);
                let off = mode.eigenvalue - Complex64::new(expected.re, expected.im.abs());
                // A part 2e-7 of the mass is that of the shaft.
                assert!(
                    off.norm() < 4e-7 * (k / m).sqrt(),
                    "{speed} rad/s: {} for {expected}",
                    mode.eigenvalue
                );
            }
            assert_eq!(
                shaft.modes(speed, 2).modes.iter().any(|mode| mode.grows()),
                speed > limit,
                "{speed} rad/s"
            );
        }
    }
}

/// At the critical speed a whirl stands still in the rotating frame: an error of its frequency is small against the speed.
#[test]
fn a_critical_speed_is_no_coarse_mesh() {
    let mut diagram = jeffcott([100.0; 2]).campbell(vec![0.0, 20.0, 39.999, 40.001, 60.0], 2);
    for point in diagram.branches.iter_mut().flat_map(|branch| &mut branch.points) {
        let finer = point.mode.frequency() + 1e-3;
        point.mode.compare(finer, 1.0);
    }
    let (.., error) = diagram.coarsest().unwrap();
    // Half way to the critical speed a whirl has the frequency 40 − 20 rad/s.
    assert!((error - 1e-3 / 20.0).abs() < 1e-9, "{error}");
}

/// Three blades at any azimuth on a hub on a clamped shaft: a minimum of the potential, whatever the rounding of its tangents.
#[test]
fn a_hub_with_blades_on_a_flexible_shaft_is_stable_at_rest() {
    for azimuth in [0.0, 0.3, 1.0] {
        for elements in [8, 16] {
            let mut model = Model::new();
            let hub = model.body(Body::new("hub", 1.0, [0.05, 0.05, 0.08]));
            let clamp = |model: &mut Model, name: &str, parts, at: Vec3| {
                model.join(name, Kind::Fixed, parts, at, (Z, None)).unwrap();
            };
            for blade in 0..3 {
                let (sin, cos) = (azimuth + std::f64::consts::TAU / 3.0 * f64::from(blade)).sin_cos();
                let root = Station {
                    position: Vec3([0.1 * cos, 0.1 * sin, 0.0]),
                    tangent: Vec3([cos, sin, 0.0]),
                    normal: Vec3([-sin, cos, 0.0]),
                };
                let properties = Properties::principal([1e7, 1e5, 1.0, 4.0], 1.0, [1e-7, 0.0, 0.0]);
                let beam = Beam::straight(root, 1.0, elements, properties).unwrap();
                let beam = model.beam(Flexible::new(&format!("blade{blade}"), beam));
                clamp(
                    &mut model,
                    &format!("root{blade}"),
                    [hub, Part::Section { beam, node: 0 }],
                    root.position,
                );
            }
            let root =
                Station { position: Vec3([0.0, 0.0, -0.4]), tangent: Vec3(Z), normal: Vec3([1.0, 0.0, 0.0]) };
            let properties = Properties::principal([1e6, 1e4, 3.0, 3.0], 1e-3, [1e-5, 0.0, 0.0]);
            let beam = model.beam(Flexible::new("shaft", Beam::straight(root, 0.4, 8, properties).unwrap()));
            clamp(&mut model, "bearing", [Part::Ground, Part::Section { beam, node: 0 }], root.position);
            clamp(&mut model, "nose", [Part::Section { beam, node: 8 }, hub], Vec3::ZERO);
            let mut system = Rotating::new(Multibody::new(model).unwrap(), Axis::new([0.0; 3], Z).unwrap());
            let s = system.initial();
            let found = stability(&mut system, &s).unwrap();
            assert!(found.is_stable(), "azimuth {azimuth}, {elements} elements: {found}");
        }
    }
}

/// Ground resonance: three blades with lag hinges on a hub on springs. With D = s − iΩ, M the whole mass and S the static moment of a
/// blade about its hinge, the whirl of the hub and of the centre of the blades is
///
/// (M s² + K)(I D² + k + S e Ω²) − 3/2 S² s⁴ = 0.
///
/// Source: R. P. Coleman & A. M. Feingold, NACA Report 1351 (1958).
#[test]
fn ground_resonance_is_found_between_the_speeds_of_coleman() {
    let (e, r, blade_mass, lag, support, hub_mass) = (0.15, 0.5, 1.0, 2.0, 600.0, 6.0);
    let own = 1.0 / 12.0;
    // Of s = iω, whose polynomial is real: it is stable where all four are real.
    let grows = |speed: f64| {
        let (m, i, s) = (hub_mass + 3.0 * blade_mass, own + blade_mass * r * r, blade_mass * r);
        let stiffness = lag + s * e * speed * speed;
        // (K − M ω²)(k' − I (ω − Ω)²) − 3/2 S² ω⁴
        let (a, b, c) = (stiffness - i * speed * speed, 2.0 * i * speed, -i);
        let lead = -m * c - 1.5 * s * s;
        let coefficients = [support * a, support * b, support * c - m * a, -m * b].map(|x| x / lead);
        let mut companion = DMatrix::<f64>::zeros(4, 4);
        for (row, x) in coefficients.iter().enumerate() {
            companion[(row, 3)] = -x;
            if row > 0 {
                companion[(row, row - 1)] = 1.0;
            }
        }
        companion.complex_eigenvalues().iter().any(|w| w.im.abs() > 1e-4)
    };
    let bound = |mut low: f64, mut high: f64| {
        let sign = grows(low);
        while high - low > 1e-6 {
            let middle = 0.5 * (low + high);
            if grows(middle) == sign { low = middle } else { high = middle }
        }
        low
    };
    let bounds = [bound(8.0, 15.0), bound(15.0, 30.0)];
    let spring = |stiffness: f64| {
        Drive::Actuated(Actuator {
            torque: Arc::new(Constant::new(0.0).unwrap()),
            damping: 0.0,
            stiffness,
            rest_angle: 0.0,
            controller: None,
        })
    };
    let mut model = Model::new();
    let slider = model.body(Body::new("slider", 1e-3, [1e-3; 3]));
    let hub = model.body(Body::new("hub", hub_mass - 1e-3, [0.01; 3]));
    for (name, parts, axis) in
        [("along", [Part::Ground, slider], [1.0, 0.0, 0.0]), ("across", [slider, hub], [0.0, 1.0, 0.0])]
    {
        model.join(name, Kind::Prismatic, parts, [0.0; 3], (axis, None)).unwrap().drive = spring(support);
    }
    for number in 0..3 {
        let (sin, cos) = (std::f64::consts::TAU / 3.0 * f64::from(number)).sin_cos();
        let mut blade = Body::new(&format!("blade{number}"), blade_mass, [own; 3]);
        blade.frame.position = Vec3([(e + r) * cos, (e + r) * sin, 0.0]);
        let blade = model.body(blade);
        let hinge = model.join(
            &format!("lag{number}"),
            Kind::Revolute,
            [hub, blade],
            [e * cos, e * sin, 0.0],
            (Z, None),
        );
        hinge.unwrap().drive = spring(lag);
    }
    let system = Rotating::new(Multibody::new(model).unwrap(), Axis::new([0.0; 3], Z).unwrap());
    let speeds: Vec<f64> = (0..=60).map(|i| 0.5 * f64::from(i)).collect();
    // More modes than there are: all five.
    let plan = Plan { speeds, count: 8, stations: Vec::new(), hub: HubState::Held, revolutions: 0 };
    let diagram = campbell(Box::new(system), &plan, |_| true).unwrap();
    assert_eq!(diagram.branches.len(), 5);
    // Two critical speeds, for the slider moves with the hub in one direction alone: (K − M Ω²)(k + S e Ω²) = 3/2 S² Ω⁴ of both masses.
    let critical = |mass: f64| {
        let (mut low, mut high) = (6.0_f64, 8.0_f64);
        let (s, k) = (blade_mass * r, support);
        while high - low > 1e-12 {
            let square = (0.5 * (low + high)).powi(2);
            let positive = (k - mass * square) * (lag + s * e * square) > 1.5 * (s * square).powi(2);
            if positive { low = square.sqrt() } else { high = square.sqrt() }
        }
        low
    };
    let mass = hub_mass + 3.0 * blade_mass;
    assert_eq!(diagram.criticals.len(), 2, "{:?}", diagram.criticals);
    for (found, expected) in diagram.criticals.iter().zip([critical(mass), critical(mass - 1e-3)]) {
        assert!((found.speed / expected - 1.0).abs() < 1e-6, "{} for {expected}", found.speed);
        assert_eq!(found.directions, 1);
    }
    let [Instability::Flutter { from, to, until: Some(until), .. }] = diagram.instabilities[..] else {
        panic!("{:?} for {bounds:?}", diagram.instabilities);
    };
    assert!(from <= bounds[0] && bounds[0] <= to && to - from <= 0.5, "{from}, {to} for {bounds:?}");
    assert!((until - 0.5..=until).contains(&bounds[1]), "{until} for {bounds:?}");
}
