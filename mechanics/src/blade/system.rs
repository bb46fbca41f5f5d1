//! The blade as a [`System`](crate::system::System): small vibrations about its steady state.

use super::frame::axes;
use super::jet::Jet;
use super::matrices::Matrices;
use super::mesh::{Component, Mesh, hermite, quadratic};
use super::model::{BladeError, Body, Model, Setting, StrainEnergy};
use super::tension::Tension;
use crate::linalg::{Mat3, Matrix, Structure, Vec3};
use crate::section::BladeSection;
use crate::system::{
    Channel, Direction, Dynamics, Energy, Events, Frame, Kind, NotSet, Observed, Parameter, Role, Sink, Size,
    State, Steady, Weights,
};

/// A rotating blade. See the [module documentation](super).
///
/// Unknowns are the deviations from the steady state, which is q = 0: r = M a + C v + K q, with the matrices of
/// the present speed. C is antisymmetric, so that ½vᵀMv + ½qᵀKq is kept.
#[derive(Clone, Debug)]
pub struct Blade {
    matrices: Matrices,
    setting: Setting,
    speed: f64,
    steady: Vec<f64>,
    /// The speed before the present one and its steady state.
    earlier: Option<(f64, Vec<f64>)>,
    scratch: Vec<f64>,
}

impl Blade {
    /// A blade of `elements` equal elements, at rest.
    ///
    /// # Errors
    /// [`BladeError::Invalid`] if setting, section and model make no blade: torsion without torsional stiffness or
    /// polar inertia; precone of a blade that stays straight; a length, radius or mass out of range.
    pub fn new(
        setting: Setting,
        section: &dyn BladeSection,
        model: Model,
        elements: usize,
    ) -> Result<Blade, BladeError> {
        Blade::carrying(setting, section, model, (elements, 1), &[])
    }

    /// The same with bodies along it, besides that at its tip; elements end where they are, and each is cut into so many parts.
    ///
    /// # Errors
    /// As [`Blade::new`], and [`BladeError::Invalid`] for a body that is not between the clamp and the tip.
    pub fn carrying(
        setting: Setting,
        section: &dyn BladeSection,
        model: Model,
        elements: (usize, usize),
        bodies: &[Body],
    ) -> Result<Blade, BladeError> {
        let invalid = |message: &str| Err(BladeError::Invalid(message.to_owned()));
        let carried = bodies.iter().map(|body| body.of).chain([setting.tip]);
        let mut ranges = carried.flat_map(|body| [body.mass, body.inertia]).chain([setting.hub_radius]);
        if ranges.any(|x| !(x.is_finite() && x >= 0.0)) {
            return invalid(
                "hub radius, masses and moments of inertia of bodies must be zero or positive, and finite",
            );
        }
        if !(setting.precone.abs() < std::f64::consts::FRAC_PI_2 && setting.pitch.is_finite()) {
            return invalid("the precone must be less than 90° and the pitch finite");
        }
        if setting.precone != 0.0 && model.strain_energy != StrainEnergy::Exact {
            return invalid(
                "a blade with precone is bent by its rotation: only the strain energy `exact` finds its steady state",
            );
        }
        let mesh = Mesh::new(&setting, elements, section, model.torsion, bodies)?;
        let stiff = |p: &super::mesh::Point| p.section.has_torsion();
        if model.torsion && !mesh.elements.iter().flat_map(|e| &e.points).all(stiff) {
            return invalid(
                "torsion needs a torsional stiffness GJ and a polar inertia everywhere; give them, or leave torsion out",
            );
        }
        let tension = Tension::new(&mesh, section, &setting);
        let size = mesh.len();
        let mut blade = Blade {
            matrices: Matrices::new(mesh, setting, model, tension),
            setting,
            speed: 0.0,
            steady: vec![0.0; size],
            earlier: None,
            scratch: vec![0.0; size],
        };
        blade.set_speed(0.0)?;
        Ok(blade)
    }

    /// Speed of rotation Ω [rad/s].
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// Sets the speed of rotation Ω [rad/s]: finds the steady state, from the present one, and the matrices about
    /// it. Unknowns then measure from the new state.
    ///
    /// # Errors
    /// [`BladeError::NoSteadyState`]; the blade is then left as it was.
    pub fn set_speed(&mut self, speed: f64) -> Result<(), BladeError> {
        let former = self.speed;
        let mut state = self.guess(speed).unwrap_or_default();
        let mut found = Ok(());
        if state.is_empty() || !self.matrices.settle(speed, &mut state) {
            state.clone_from(&self.steady);
            found = self.matrices.follow(former, speed, &mut state);
        }
        match found {
            Ok(()) => {
                self.earlier = Some((former, std::mem::replace(&mut self.steady, state)));
                self.speed = speed;
                Ok(())
            }
            Err(reached) => {
                self.matrices.assemble(former, &self.steady);
                Err(BladeError::NoSteadyState { speed, reached })
            }
        }
    }

    /// Discards all states except the undeformed one.
    fn undeform(&mut self) {
        self.steady.fill(0.0);
        self.earlier = None;
        self.speed = 0.0;
    }

    /// The steady state at a speed extrapolated from the last two, which is linear in Ω² while it is small.
    fn guess(&self, speed: f64) -> Option<Vec<f64>> {
        let (earlier, former) = self.earlier.as_ref()?;
        let part = (speed * speed - self.speed * self.speed) / (self.speed * self.speed - earlier * earlier);
        let extrapolate = |(now, before): (&f64, &f64)| now + part * (now - before);
        (part.abs() <= 2.0).then(|| self.steady.iter().zip(former).map(extrapolate).collect())
    }

    /// The steady state: displacements from the undeformed blade, in the order of the unknowns.
    pub fn steady(&self) -> &[f64] {
        &self.steady
    }

    /// Which field each unknown belongs to.
    pub fn components(&self) -> &[Component] {
        &self.matrices.mesh().components
    }

    /// Displacements u, v, w \[m\], their slopes and torsion φ at station x \[m\] of the given unknowns.
    pub fn displacement(&self, q: &[f64], x: f64) -> ([f64; 3], [f64; 3], f64) {
        let elements = &self.matrices.mesh().elements;
        let last = elements.len() - 1;
        let number = elements[..last].partition_point(|e| e.ends[1] <= x);
        let element = &elements[number];
        let h = element.ends[1] - element.ends[0];
        let s = ((x - element.ends[0]) / h).clamp(0.0, 1.0);
        let (n, m, local) = (hermite(s, h), quadratic(s, h), element.gather(q));
        let field = |d: usize| std::array::from_fn(|f| (0..4).map(|k| n[d][k] * local[4 * f + k]).sum());
        (field(0), field(1), (0..3).map(|k| m[0][k] * local[12 + k]).sum())
    }

    #[cfg(test)]
    pub(super) fn matrices(&mut self) -> &mut Matrices {
        &mut self.matrices
    }

    /// y = A x with A one of the matrices.
    fn product(matrix: &Matrix, x: &[f64], y: &mut [f64]) {
        matrix.multiply(x, y);
    }

    /// ½ xᵀ A x
    fn quadratic(&mut self, which: fn(&Matrices) -> &Matrix, x: &[f64]) -> f64 {
        Blade::product(which(&self.matrices), x, &mut self.scratch);
        0.5 * x.iter().zip(&self.scratch).map(|(x, y)| x * y).sum::<f64>()
    }
}

impl Dynamics for Blade {
    fn size(&self) -> Size {
        Size { q: self.steady.len(), v: self.steady.len(), lambda: 0, memory: 0 }
    }

    fn structure(&self, _multipliers: usize) -> Structure {
        self.matrices.mesh().structure()
    }

    fn scales(&self) -> &[f64] {
        self.matrices.scales()
    }

    fn unknown(&self, i: usize) -> String {
        self.matrices.mesh().name(i).unwrap_or_else(|| format!("unknown {i}"))
    }

    fn is_affine(&self) -> bool {
        true
    }

    fn residual(&mut self, s: &State, r: &mut [f64]) {
        let Blade { matrices, scratch, .. } = self;
        Blade::product(&matrices.mass, &s.a, r);
        for (matrix, x) in [(&matrices.gyroscopic, &s.v), (&matrices.stiffness, &s.q)] {
            Blade::product(matrix, x, scratch);
            for (r, y) in r.iter_mut().zip(scratch.iter()) {
                *r += y;
            }
        }
    }

    fn tangent(&mut self, _s: &State, w: Weights<'_>, out: &mut Matrix) {
        // The last number keeps the stamp from being taken for that of another kind of system.
        let stamp = [w.a, w.v, w.q, self.speed, 0.0, f64::INFINITY];
        if out.holds(&stamp) {
            return;
        }
        out.clear();
        let m = &self.matrices;
        for (weight, matrix) in [(w.a, &m.mass), (w.v, &m.gyroscopic), (w.q, &m.stiffness)] {
            if weight == 0.0 {
                continue;
            }
            for (out, part) in out.begin().rows_mut().zip(matrix.storage().rows()) {
                for (out, part) in out.iter_mut().zip(part) {
                    *out += weight * part;
                }
            }
        }
        out.set_stamp(Some(stamp));
    }

    fn stiffness_forms(&mut self, _s: &State, vectors: &[Vec<f64>]) -> Option<Vec<f64>> {
        Some(self.matrices.stiffness_forms(self.speed, &self.steady, vectors))
    }
}

impl Events for Blade {}

impl Steady for Blade {
    fn set(&mut self, parameter: Parameter, speed: f64) -> Result<(), NotSet> {
        if parameter != Parameter::Speed {
            return Err(NotSet::Unknown(parameter));
        }
        // At rest the blade is undeformed.
        if speed == 0.0 {
            self.undeform();
        }
        if self.speed == speed && speed != 0.0 {
            return Ok(());
        }
        // From the present state, and if that leads nowhere from the undeformed blade.
        if self.set_speed(speed).is_ok() {
            return Ok(());
        }
        let former = (self.speed, self.steady.clone());
        self.undeform();
        self.set_speed(speed).map_err(|error| {
            (self.speed, self.steady) = former;
            self.matrices.assemble(self.speed, &self.steady);
            NotSet::Lost(error.to_string())
        })
    }
}

impl Observed for Blade {
    fn direction(&self, i: usize) -> Direction {
        match self.components().get(i) {
            Some(Component::Axial) => Direction::Axial,
            Some(Component::Chordwise) => Direction::Chord,
            Some(Component::Flapwise) => Direction::Flap,
            Some(Component::Torsion) => Direction::Torsion,
            None => Direction::Other,
        }
    }

    fn energy(&mut self, s: &State) -> Energy {
        let kinetic = self.quadratic(|m| &m.mass, &s.v);
        let strain = self.quadratic(|m| &m.stiffness, &s.q);
        Energy { kinetic, strain, ..Energy::default() }
    }

    fn frames(&mut self, _body: usize, s: &State, stations: &[f64], out: &mut [Frame]) {
        let whole: Vec<f64> = self.steady.iter().zip(&s.q).map(|(a, b)| a + b).collect();
        let (sin, cos) = libm::sincos(self.setting.precone);
        let (sin_rotation, cos_rotation) = libm::sincos(self.speed * s.t);
        // From the blade's frame through the hub's frame to the inertial frame.
        let inertial = |r: [f64; 3]| {
            let hub = [cos * r[0] - sin * r[2], r[1], sin * r[0] + cos * r[2]];
            Vec3([
                cos_rotation * hub[0] - sin_rotation * hub[1],
                sin_rotation * hub[0] + cos_rotation * hub[1],
                hub[2],
            ])
        };
        for (&x, frame) in stations.iter().zip(out) {
            let (u, slope, torsion) = self.displacement(&whole, x);
            let variables = [1.0 + slope[0], slope[1], slope[2]].map(Jet::<1>::constant);
            let twist = self.twist(x);
            let axes = axes(&variables, &Jet::constant(self.setting.pitch + twist + torsion));
            frame.position = inertial([self.setting.hub_radius + x + u[0], u[1], u[2]]);
            frame.rotation = Mat3::columns(axes.map(|axis| inertial([axis[0].x, axis[1].x, axis[2].x])));
        }
    }

    /// The vibration of the tip.
    fn observe(&mut self, s: &State, sink: &mut Sink<'_>) {
        let (u, _, torsion) = self.displacement(&s.q, self.setting.length);
        let energy = self.energy(s);
        let mut put = |value, role, name, unit: &'static str, meaning| {
            sink.put(value, || Channel::new(role, name, unit, meaning));
        };
        put(u[0], Role::Primary, "tip.axial", "m", "axial displacement of the tip from the steady state");
        let meaning = "displacement of the tip in the direction of motion, from the steady state";
        put(u[1], Role::Primary, "tip.chordwise", "m", meaning);
        let meaning = "displacement of the tip along the angular velocity, from the steady state";
        put(u[2], Role::Primary, "tip.flapwise", "m", meaning);
        if self.components().contains(&Component::Torsion) {
            put(torsion, Role::Primary, "tip.torsion", "rad", "torsion of the tip from the steady state");
        }
        let mut put = |value, kind, name, meaning| {
            sink.put(value, || Channel::new(Role::Energy, name, "J", meaning).with_kind(kind));
        };
        put(energy.kinetic, Kind::KineticEnergy, "energy.kinetic", "½vᵀMv of the vibration");
        let meaning = "½qᵀKq of the vibration, centrifugal work included";
        put(energy.strain, Kind::StrainEnergy, "energy.strain", meaning);
    }
}

impl Blade {
    /// Twist of the section at x [m], from the quadrature points of its element.
    fn twist(&self, x: f64) -> f64 {
        let elements = &self.matrices.mesh().elements;
        let last = elements.len() - 1;
        let points = &elements[elements[..last].partition_point(|e| e.ends[1] <= x)].points;
        let near = points.iter().min_by(|a, b| (a.x - x).abs().total_cmp(&(b.x - x).abs()));
        near.map_or(0.0, |p| p.section.twist + p.section.twist_rate * (x - p.x))
    }
}
