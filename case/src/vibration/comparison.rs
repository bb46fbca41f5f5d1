//! Frequencies of a rotating beam by less than the whole linear problem, for comparisons.

use super::VibrationError;
use crate::hub_beam::HubBeam;
use crate::reading::Reading;
use flexion::linalg::eigen::Pencil;
use flexion::linalg::{Matrix, Structure};
use flexion::strain_energy::{RotatingBeam, StrainEnergy};
use flexion::system::{Direction, Parameter, State, Weights};

impl Reading {
    /// The lowest frequencies [rad/s] of a beam on a hub that rotates steadily, of its deflection alone: M₂ B̈ + [Ω²(C − M₂) + K₃] B = 0, without axial
    /// displacement, without the coupling of stretch and bending, and without gyroscopic forces. Each comes with the error that the mesh makes, where a
    /// finer one can be made.
    ///
    /// # Errors
    /// [`VibrationError`]: a case that is no beam on a hub in the plane, or frequencies that are not found.
    pub fn transverse_frequencies(
        &self,
        speed: f64,
        count: usize,
    ) -> Result<Vec<(f64, Option<f64>)>, VibrationError> {
        let own = self.of_deflection(speed, count)?;
        let finer = self.with_finer_mesh().ok().and_then(|finer| finer.of_deflection(speed, count).ok());
        let safety = self.case.safety_of_frequencies();
        let error = |i: usize, own: f64| Some(safety * (own - finer.as_ref()?.get(i)?).abs());
        Ok(own.iter().enumerate().map(|(i, own)| (*own, error(i, *own))).collect())
    }

    fn of_deflection(&self, speed: f64, count: usize) -> Result<Vec<f64>, VibrationError> {
        self.on_hub()?;
        let mut system = self.case.system().map_err(|faults| VibrationError::Case(self.problems(faults)))?;
        system.set(Parameter::Speed, speed).map_err(VibrationError::not_found)?;
        let state = State::zeros(system.size(), 0.0);
        let kept: Vec<usize> =
            (0..system.size().v).filter(|&i| system.direction(i) == Direction::Chord).collect();
        let structure = system.structure(0);
        let mut part = |a: f64, q: f64| {
            let mut whole = Matrix::new(&structure);
            system.tangent(&state, Weights::new(a, 0.0, q), &mut whole);
            let mut part = Matrix::new(&Structure::dense(kept.len()));
            for (i, &from) in kept.iter().enumerate() {
                for (j, &to) in kept.iter().enumerate() {
                    part.add(i, j, whole.get(from, to));
                }
            }
            part
        };
        let (mass, stiffness) = (part(1.0, 0.0), part(0.0, 1.0));
        let none = Matrix::new(&Structure::dense(kept.len()));
        let mut pencil = Pencil::new([mass, none, stiffness], 0, 0.0).map_err(VibrationError::not_found)?;
        let pairs = pencil.pairs(count, &[]).map_err(VibrationError::not_found)?;
        Ok(pairs.iter().map(|pair| pair.value.im.abs()).collect())
    }

    /// The lowest frequencies [rad/s] of bending out of the plane of rotation of the case's beam, as a uniform one with the section of its root, by a strain
    /// energy.
    ///
    /// # Errors
    /// [`VibrationError`]: a case that is no beam on a hub in the plane, or a speed beyond that at which the beam can be held.
    pub fn frequencies_by(
        &self,
        energy: StrainEnergy,
        speed: f64,
        count: usize,
    ) -> Result<Vec<f64>, VibrationError> {
        let beam = self.on_hub()?;
        let of = beam.section.planar.resultants(0.0);
        let beam = RotatingBeam {
            length: beam.length,
            hub_radius: beam.hub.radius,
            mass: of.mass,
            axial_stiffness: of.axial_stiffness,
            bending_stiffness: of.bending_stiffness,
        };
        beam.flapwise(energy, speed, count).map_err(VibrationError::not_found)
    }

    fn on_hub(&self) -> Result<&HubBeam, VibrationError> {
        self.case.hub_beam().ok_or_else(|| {
            VibrationError::Request("these are frequencies of a beam on a hub in the plane".to_owned())
        })
    }
}
