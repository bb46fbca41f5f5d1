//! The conformance checks find what is wrong with a model: ten seeded faults, each caught.

use super::multibody::{BallsOnWall, FourBar, HeavyTop};
use super::seam::anywhere;
use flexion::linalg::{Matrix, Structure};
use flexion::system::{
    Dynamics, Energy, Events, Observed, Power, RowWeights, Set, Size, State, Steady, System, VisitRow,
    Weights,
};
use flexion::verify::dynamics;

/// What is wrong with a model.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    None,
    /// ∂r/∂q has the wrong sign.
    StiffnessSign,
    /// ∂r/∂v is left out.
    NoDamping,
    /// M is twice what it is.
    TwiceTheMass,
    /// The gyroscopic forces are left out of r, not of the tangent.
    NoGyroscopicForce,
    /// G has the wrong sign.
    JacobianSign,
    /// Gᵀλ has half its size.
    HalfTheMultipliers,
    /// ġ is left out of Baumgarte's and the other forms.
    NoVelocityOfConstraint,
    /// g̈ lacks the terms of the velocities.
    NoCentripetalTerm,
    /// The rate of increments is that of a vector space.
    FlatRate,
    /// The kinetic energy counts half.
    HalfTheEnergy,
}

struct Mutant<S> {
    model: S,
    fault: Fault,
}

impl<S: System> Dynamics for Mutant<S> {
    fn size(&self) -> Size {
        self.model.size()
    }
    fn structure(&self, multipliers: usize) -> Structure {
        self.model.structure(multipliers)
    }
    fn scales(&self) -> &[f64] {
        self.model.scales()
    }
    fn initial(&self) -> State {
        self.model.initial()
    }
    fn is_vector_space(&self) -> bool {
        self.model.is_vector_space()
    }
    fn retract(&self, q: &[f64], d: &[f64], out: &mut [f64]) {
        self.model.retract(q, d, out);
    }
    fn difference(&self, from: &[f64], to: &[f64], d: &mut [f64]) {
        self.model.difference(from, to, d);
    }
    fn rate(&self, from: &[f64], d: &[f64], v: &[f64], out: &mut [f64]) {
        if self.fault == Fault::FlatRate { out.copy_from_slice(v) } else { self.model.rate(from, d, v, out) }
    }
    fn residual(&mut self, s: &State, r: &mut [f64]) {
        let mut at = s.clone();
        if self.fault == Fault::NoGyroscopicForce {
            at.v.fill(0.0);
        }
        if self.fault == Fault::HalfTheMultipliers {
            at.lambda.iter_mut().for_each(|x| *x *= 0.5);
        }
        self.model.residual(&at, r);
    }
    fn rows(&self) -> &[Set] {
        self.model.rows()
    }
    fn constraint(&mut self, s: &State, c: RowWeights, g: &mut [f64]) {
        let RowWeights([c0, _c1, c2]) = c;
        match self.fault {
            Fault::NoVelocityOfConstraint => self.model.constraint(s, RowWeights([c0, 0.0, c2]), g),
            Fault::NoCentripetalTerm if c2 != 0.0 => {
                let mut at = s.clone();
                at.v.fill(0.0);
                self.model.constraint(&at, c, g);
            }
            _ => self.model.constraint(s, c, g),
        }
    }
    fn jacobian(&mut self, s: &State, visit: &mut VisitRow<'_>) {
        let sign = if self.fault == Fault::JacobianSign { -1.0 } else { 1.0 };
        self.model.jacobian(s, &mut |row, velocities, entries| {
            let entries: Vec<f64> = entries.iter().map(|x| sign * x).collect();
            visit(row, velocities, &entries);
        });
    }
    fn tangent(&mut self, s: &State, w: Weights<'_>, out: &mut Matrix) {
        let mut w = w;
        match self.fault {
            Fault::StiffnessSign => w.q = -w.q,
            Fault::NoDamping => w.v = 0.0,
            Fault::TwiceTheMass => w.a *= 2.0,
            _ => {}
        }
        self.model.tangent(s, w, out);
    }
}

impl<S: System> Events for Mutant<S> {}
impl<S: System> Steady for Mutant<S> {}

impl<S: System> Observed for Mutant<S> {
    fn energy(&mut self, s: &State) -> Energy {
        let energy = self.model.energy(s);
        let part = if self.fault == Fault::HalfTheEnergy { 0.5 } else { 1.0 };
        Energy { kinetic: part * energy.kinetic, ..energy }
    }
    fn power(&mut self, s: &State) -> Power {
        self.model.power(s)
    }
}

fn found<S: System>(model: S, fault: Fault, s: &State) -> Vec<&'static str> {
    dynamics(&mut Mutant { model, fault }, s).into_iter().map(|defect| defect.check).collect()
}

#[test]
fn ten_seeded_faults_are_each_found_by_their_check() {
    let top = anywhere(&HeavyTop::new());
    let bars = FourBar::new().swung(0.7, 1.3);
    let mut balls = anywhere(&BallsOnWall::new(0.5, [0.2, 0.3]));
    balls.lambda.fill(0.7);
    assert_eq!(found(HeavyTop::new(), Fault::None, &top), [""; 0]);
    assert_eq!(found(FourBar::new(), Fault::None, &bars), [""; 0]);
    let of_top = [
        (Fault::StiffnessSign, "∂r/∂q"),
        (Fault::NoDamping, "∂r/∂v"),
        (Fault::TwiceTheMass, "∂r/∂a"),
        (Fault::NoGyroscopicForce, "∂r/∂v"),
        (Fault::FlatRate, "T(d)⁻¹ v"),
        (Fault::HalfTheEnergy, "dE/dt"),
    ];
    for (fault, check) in of_top {
        assert!(found(HeavyTop::new(), fault, &top).contains(&check), "{fault:?}");
    }
    let of_rows = [
        (Fault::JacobianSign, "G"),
        (Fault::HalfTheMultipliers, "Gᵀ λ in r"),
        (Fault::NoVelocityOfConstraint, "ġ"),
        (Fault::NoCentripetalTerm, "g̈"),
    ];
    for (fault, check) in of_rows {
        assert!(!found(FourBar::new(), fault, &bars).is_empty(), "{fault:?}");
        let balls = found(BallsOnWall::new(0.5, [0.2, 0.3]), fault, &balls);
        assert!(balls.contains(&check), "{fault:?}: {balls:?}");
    }
}
