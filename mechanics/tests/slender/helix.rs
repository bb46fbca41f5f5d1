//! A helical spring that is drawn out: from one helix to another, in closed form.
//!
//! A helix of radius R and pitch angle α has the curvature κ = cos²α/R and the torsion τ = sin α cos α/R. With the moments
//! M = EI (κ₁ − κ₀) about its binormal and T = GJ (τ₁ − τ₀) about its tangent it is in equilibrium under a force F and a couple along
//! its axis, F = (T cos α − M sin α)/R (Love 1927, art. 271). With the tension N = F sin α in fibres that are helices themselves,
//! T has N K² τ₁ beside and the axis the strain N/EA − ½K² (τ₁² − τ₀²), K² = 2EI/EA.

use super::newton::{Statics, distance, equal, orders};
use flexion::linalg::Vec3;
use flexion::multibody::slender::{Beam, Load, Properties, Station};

const LENGTH: f64 = 6.0;
const STIFFNESS: [f64; 4] = [500.0, 0.8, 1.0, 1.0];

#[derive(Clone, Copy)]
struct Helix {
    radius: f64,
    pitch: f64,
    /// |r′|
    stretch: f64,
}

impl Helix {
    fn curvatures(&self) -> [f64; 2] {
        let (sin, cos) = self.pitch.sin_cos();
        [cos * cos / self.radius, sin * cos / self.radius].map(|k| k * self.stretch)
    }

    /// Position, t, principal normal and binormal.
    fn at(&self, s: f64) -> [Vec3; 4] {
        let (sin, cos) = self.pitch.sin_cos();
        let along = self.stretch * s;
        let (y, x) = (along * cos / self.radius).sin_cos();
        [
            Vec3([self.radius * x, self.radius * y, along * sin]),
            Vec3([-cos * y, cos * x, sin]),
            Vec3([-x, -y, 0.0]),
            Vec3([sin * y, -sin * x, cos]),
        ]
    }
}

/// The drawn helix with its stretch, and the force and the couple at its end.
fn drawn(before: Helix, mut now: Helix) -> (Helix, Vec3, Vec3) {
    let (sin, cos) = now.pitch.sin_cos();
    let [k0, t0] = before.curvatures();
    let (mut force, mut moments) = (0.0, [0.0; 2]);
    let polar = (STIFFNESS[2] + STIFFNESS[3]) / STIFFNESS[0];
    for _ in 0..60 {
        let [k, t] = now.curvatures();
        moments = [STIFFNESS[1] * (t - t0) + force * sin * polar * t, STIFFNESS[2] * (k - k0)];
        force = (moments[0] * cos - moments[1] * sin) / now.radius;
        now.stretch = 1.0 + force * sin / STIFFNESS[0] - 0.5 * polar * (t * t - t0 * t0);
    }
    let [_, t, _, b] = now.at(LENGTH);
    (now, Vec3([0.0, 0.0, force]), moments[0] * t + moments[1] * b)
}

/// The error of the tip and of the axes there, from the drawn helix as the first guess.
fn error(elements: usize) -> f64 {
    let before = Helix { radius: 0.5, pitch: 0.15, stretch: 1.0 };
    let (now, force, couple) = drawn(before, Helix { radius: 0.45, pitch: 0.5, stretch: 1.0 });
    let curve = |s: f64| {
        let [position, tangent, normal, _] = before.at(s);
        Station { position, tangent, normal }
    };
    let section = Properties::principal(STIFFNESS, 1.0, [1.0; 3]);
    let beam = Beam::new(&equal(LENGTH, elements), curve, |_| section).unwrap();
    let mut statics = Statics::clamped(beam);
    let h = LENGTH / elements as f64;
    for i in 0..=elements {
        let [r, t, n, _] = now.at(i as f64 * h);
        let slope = now.stretch * t;
        statics.q[12 * i..12 * i + 9].copy_from_slice(&[r.0, slope.0, n.0].concat());
        if i < elements {
            statics.q[12 * i + 9..12 * i + 12].copy_from_slice(&now.at((i as f64 + 0.5) * h)[2].0);
        }
    }
    // The normals in the middle are made normal to the tangents by a retraction without increment.
    let mut q = statics.q.clone();
    statics.beam.retract(&statics.q, &vec![0.0; statics.fixed.len()], &mut q);
    statics.q = q;
    // r′ at the clamp is held as that of the drawn helix.
    statics.hold(0, &[3]);
    statics.loads = vec![(elements, Load::Force(force)), (elements, Load::Couple(couple))];
    statics.solve(1.0);
    let (position, triad) = statics.tip();
    let [r, t, n, _] = now.at(LENGTH);
    distance(position, r).max(distance(triad.tangent, t)).max(distance(triad.normal, n))
}

#[test]
fn a_helical_spring_is_drawn_to_another_helix() {
    let errors = [24, 48, 96].map(error);
    let order = orders(&errors);
    assert!(errors[2] < 1e-5 && order.iter().all(|order| *order > 3.7), "{errors:?} of order {order:?}");
}
