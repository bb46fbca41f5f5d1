//! Live objects from a validated case.

use super::basis::{Basis as BasisCase, RadialBasis};
use super::blade::{Blade as BladeCase, StrainEnergy as StrainEnergyCase};
use super::blade_file;
use super::integrator::Integrator as IntegratorCase;
use super::layout::{Case, Coupling};
use super::load_build;
use super::motion::{Motion as MotionCase, MotionOf};
use super::section::{Interpolation as InterpolationCase, Section as SectionCase, Shape as ShapeCase};
use super::section_file;
use super::torque::{Controller as ControllerCase, Free as FreeCase, Torque as TorqueCase};
use flexion::basis::{
    BSpline, Basis, BasisError, Bezier, Field, Hermite, Lagrange, Modes, Polynomial, PolynomialParameters,
    Radial, RadialParameters,
};
use flexion::blade::{Blade, BladeError, Model, Setting, StrainEnergy, Tip};
use flexion::hub_beam::{
    Controller, Coupling as HubCoupling, Drive, ExactCoupling, Fields, Foreshortening, FreeHub, HighCoupling,
    Hub, HubBeam, LinearCoupling, Sampling,
};
use flexion::integrator::{
    Adams, GeneralizedAlpha, Integrator, InvalidParameter, Radau, RungeKutta, Tolerance,
};
use flexion::profile::{self, Constant, Expression, Profile, ProfileError, Ramp, SpinUp, Table};
use flexion::section::{
    self, BladeSection, Graded, HomogeneousBlade, Inertia, Interpolation, Material, Piecewise, PlanarBlade,
    Resultants, Section, SectionError, Segment, Shape, Tapered, Uniform,
};
use flexion::system::{Dynamics, Events, System};
use std::path::Path;
use std::sync::Arc;

/// The section of a case, on a beam of the given length \[m\].
///
/// # Errors
/// [`SectionError`] when the quantities make no section, or its file cannot be read.
pub fn section(case: &SectionCase, length: f64) -> Result<Box<dyn Section>, SectionError> {
    let kept = |rotary| if rotary { Inertia::Rotary } else { Inertia::Translation };
    Ok(match *case {
        SectionCase::Uniform {
            modulus,
            density,
            shape: ShapeCase::General { area, second_moment },
            rotary_inertia,
        } => Box::new(general(modulus, density, area, second_moment)?.with_inertia(kept(rotary_inertia))),
        SectionCase::Uniform { modulus, density, shape: dimensions, rotary_inertia } => {
            let section = Uniform::from_material(modulus, density, shape(dimensions)?)?;
            Box::new(section.with_inertia(kept(rotary_inertia)))
        }
        SectionCase::Tapered { modulus, density, root, tip, rotary_inertia } => {
            let section = Tapered::new(modulus, density, length, shape(root)?, shape(tip)?)?;
            Box::new(section.with_inertia(kept(rotary_inertia)))
        }
        SectionCase::Piecewise { ref segments, rotary_inertia } => {
            let segments: Result<_, SectionError> = segments
                .iter()
                .map(|s| {
                    let section = general(s.modulus, s.density, s.area, s.second_moment)?;
                    Ok(Segment { end: s.end, section: section.with_inertia(kept(rotary_inertia)) })
                })
                .collect();
            Box::new(Piecewise::new(length, segments?)?)
        }
        SectionCase::Table { ref file, interpolation } => {
            let rows = section_file::rows(file).map_err(SectionError::Invalid)?;
            let interpolation = match interpolation {
                InterpolationCase::Linear => Interpolation::Linear,
                InterpolationCase::Cubic => Interpolation::Cubic,
            };
            Box::new(section::Table::new(length, &rows, interpolation)?)
        }
        SectionCase::Blade { ref file, format } => {
            let rows = blade_file::rows(file, format, length).map_err(SectionError::Invalid)?;
            Box::new(section::Guided(section::BladeTable::new(length, &rows)?))
        }
        SectionCase::Resultants { mass, axial_stiffness, bending_stiffness, rotary_inertia } => {
            Box::new(Uniform::from_resultants(Resultants {
                mass,
                rotary_inertia,
                axial_stiffness,
                bending_stiffness,
                ..Resultants::default()
            })?)
        }
        SectionCase::Graded {
            ceramic_modulus,
            metal_modulus,
            ceramic_density,
            metal_density,
            width,
            height,
            exponent,
            first_moment,
            rotary_inertia,
        } => {
            let ceramic = Material { modulus: ceramic_modulus, density: ceramic_density };
            let metal = Material { modulus: metal_modulus, density: metal_density };
            let inertia = if first_moment { Inertia::Full } else { kept(rotary_inertia) };
            Box::new(Graded::new(ceramic, metal, exponent, width, height)?.with_inertia(inertia))
        }
    })
}

/// A homogeneous section of given area and second moment, with all inertia.
fn general(modulus: f64, density: f64, area: f64, second_moment: f64) -> Result<Uniform, SectionError> {
    Uniform::from_resultants(Resultants {
        mass: density * area,
        rotary_inertia: density * second_moment,
        axial_stiffness: modulus * area,
        bending_stiffness: modulus * second_moment,
        ..Resultants::default()
    })
}

/// A shape given by its dimensions.
fn shape(case: ShapeCase) -> Result<Shape, SectionError> {
    Ok(match case {
        ShapeCase::Rectangle { width, height } => Shape::Rectangle { width, height },
        ShapeCase::Circle { radius } => Shape::Circle { radius },
        ShapeCase::Tube { outer_radius, inner_radius } => Shape::Tube { outer_radius, inner_radius },
        ShapeCase::General { .. } => {
            let message = "area and second moment alone give no dimensions to taper";
            return Err(SectionError::Invalid(message.to_owned()));
        }
    })
}

/// The section of a case as that of a blade of the given length [m]: with both stiffnesses where its shape is
/// known, with equal ones where only those of the plane are.
fn blade_section(
    case: &SectionCase,
    length: f64,
    poisson_ratio: f64,
) -> Result<Box<dyn BladeSection>, SectionError> {
    let homogeneous =
        |modulus, density, root: Shape, tip: Shape| -> Result<Box<dyn BladeSection>, SectionError> {
            let along = Tapered::new(modulus, density, length, root, tip)?;
            Ok(Box::new(HomogeneousBlade::new(modulus, density, poisson_ratio, move |x| along.shape(x))?))
        };
    Ok(match *case {
        SectionCase::Blade { ref file, format } => {
            let rows = blade_file::rows(file, format, length).map_err(SectionError::Invalid)?;
            Box::new(section::BladeTable::new(length, &rows)?)
        }
        SectionCase::Uniform {
            modulus,
            density,
            shape:
                dimensions @ (ShapeCase::Rectangle { .. } | ShapeCase::Circle { .. } | ShapeCase::Tube { .. }),
            ..
        } => homogeneous(modulus, density, shape(dimensions)?, shape(dimensions)?)?,
        SectionCase::Tapered { modulus, density, root, tip, .. } => {
            homogeneous(modulus, density, shape(root)?, shape(tip)?)?
        }
        SectionCase::Graded { .. } => {
            let message =
                "a graded section bends and stretches together, which the blade leaves out".to_owned();
            return Err(SectionError::Invalid(message));
        }
        SectionCase::Uniform { .. }
        | SectionCase::Piecewise { .. }
        | SectionCase::Table { .. }
        | SectionCase::Resultants { .. } => Box::new(PlanarBlade(section(case, length)?)),
    })
}

/// A blade with the section of a case, on a beam of the given length [m] and a hub of the given radius [m],
/// at rest.
pub(super) fn blade_of(
    case: &BladeCase,
    section: &SectionCase,
    length: f64,
    hub_radius: f64,
) -> Result<Blade, BuildError> {
    let blade = blade_section(section, length, case.poisson_ratio)?;
    let blade = section::Twisted { blade, rate: case.twist / length };
    // A section that says enough does so everywhere: at both ends and at every break.
    let mut stations = vec![0.0, length];
    stations.extend(blade.breaks());
    let known = stations.iter().all(|&x| blade.resultants(x).has_torsion());
    let model = Model {
        strain_energy: match case.strain_energy {
            StrainEnergyCase::Linear => StrainEnergy::Linear,
            StrainEnergyCase::Coupled(terms) => StrainEnergy::Coupled(terms),
            StrainEnergyCase::Exact => StrainEnergy::Exact,
        },
        gyroscopic: case.gyroscopic,
        rotary_inertia: case.rotary_inertia,
        torsion: case.torsion.unwrap_or(known),
        tension_torsion: true,
    };
    let setting = Setting {
        length,
        hub_radius,
        precone: case.precone,
        pitch: case.pitch,
        tip: Tip { mass: case.tip_mass, inertia: case.tip_inertia },
    };
    Ok(Blade::new(setting, &blade, model, case.elements)?)
}

/// The blade of a case, at rest: `None` if the case has no `[blade]`.
///
/// # Errors
/// [`BuildError`] when section or setting make no blade.
pub fn blade(case: &Case) -> Result<Option<Blade>, BuildError> {
    let build = |blade| blade_of(blade, &case.section, case.length, case.hub.radius);
    case.blade.as_ref().map(build).transpose()
}

/// What vibrates about a steady rotation: the blade of a case, or its hub–beam if it has no `[blade]`.
///
/// # Errors
/// As [`blade`] and [`system`].
pub fn vibrating(case: &Case) -> Result<Box<dyn System>, BuildError> {
    match blade(case)? {
        Some(blade) => Ok(Box::new(blade)),
        None => system(case),
    }
}

/// Why a motion cannot be built.
#[derive(Debug, thiserror::Error)]
pub enum MotionError {
    /// The profile is refused.
    #[error(transparent)]
    Profile(#[from] ProfileError),
    /// The file of a table cannot be read.
    #[error("{0}")]
    File(String),
}

/// Time [s] over which a formula must have values in a run of the given duration [s]: of a run without one, its start and what
/// follows at once.
pub(super) fn known_for(duration: f64) -> f64 {
    if duration > 0.0 { duration } else { 1e-3 }
}

/// What turns the hub of a case, checked over its duration \[s\].
///
/// # Errors
/// [`MotionError`] when a file cannot be read, or a profile is refused or does not cover the run.
pub fn drive(case: &MotionCase, duration: f64) -> Result<Drive, MotionError> {
    let (profile, of): (Arc<dyn Profile>, _) = match case {
        MotionCase::SpinUp { speed, time } => (Arc::new(SpinUp::new(*speed, *time)?), MotionOf::Speed),
        MotionCase::Constant { speed } => (Arc::new(Constant::new(*speed)?), MotionOf::Speed),
        MotionCase::Ramp { speed, time } => (Arc::new(Ramp::new(0.0, *speed, *time)?), MotionOf::Speed),
        MotionCase::Table { file, of } => {
            let rows = rows(file).map_err(MotionError::File)?;
            (Arc::new(Table::new(&rows, profile::End::default())?), *of)
        }
        MotionCase::Expression { formula, of } => {
            (Arc::new(Expression::new(formula, "t", known_for(duration))?), *of)
        }
        MotionCase::Free(free) => return Ok(Drive::Free(free_hub(free, duration)?)),
    };
    let motion = match of {
        MotionOf::Speed => profile::Motion::Speed { profile, initial_angle: 0.0 },
        MotionOf::Angle => profile::Motion::Angle(profile),
    };
    motion.validate(duration)?;
    Ok(Drive::Prescribed(motion))
}

fn free_hub(case: &FreeCase, duration: f64) -> Result<FreeHub, MotionError> {
    let torque: Arc<dyn Profile> = match &case.torque {
        TorqueCase::Constant { torque } => Arc::new(Constant::new(*torque)?),
        TorqueCase::Ramp { torque, time } => Arc::new(Ramp::new(0.0, *torque, *time)?),
        TorqueCase::Table { file } => {
            let rows = rows(file).map_err(MotionError::File)?;
            Arc::new(Table::new(&rows, profile::End::default())?)
        }
        TorqueCase::Expression { formula } => Arc::new(Expression::new(formula, "t", known_for(duration))?),
    };
    profile::covers(torque.as_ref(), duration)?;
    let controller = |c: &ControllerCase| -> Result<Controller, MotionError> {
        let way = c.target - case.angle;
        let reference: Arc<dyn Profile> = match c.rate {
            Some(rate) if way != 0.0 => Arc::new(Ramp::new(case.angle, c.target, (way / rate).abs())?),
            _ => Arc::new(Constant::new(c.target)?),
        };
        Ok(Controller {
            proportional: c.proportional,
            derivative: c.derivative,
            reference: profile::Motion::Angle(reference),
            limit: c.limit.unwrap_or(f64::INFINITY),
        })
    };
    Ok(FreeHub {
        angle: case.angle,
        speed: case.speed,
        torque,
        damping: case.damping,
        stiffness: case.stiffness,
        rest_angle: case.rest_angle,
        controller: case.controller.as_ref().map(controller).transpose()?,
    })
}

/// The two columns of a CSV file; a first line of names and lines that begin with `#` are skipped.
fn rows(file: &Path) -> Result<Vec<(f64, f64)>, String> {
    let name = file.display();
    if file.is_dir() {
        return Err(format!("{name} is a folder, not a file"));
    }
    if file.exists() && !file.is_file() {
        return Err(format!("{name} is not a regular file"));
    }
    let reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .comment(Some(b'#'))
        .flexible(true)
        .trim(csv::Trim::All)
        .from_path(file);
    let failed = |error: csv::Error| format!("cannot read {name}: {error}");
    let mut rows = Vec::new();
    for (index, record) in reader.map_err(failed)?.records().enumerate() {
        let record = record.map_err(failed)?;
        let number = |column: usize| record.get(column).and_then(|text| text.parse::<f64>().ok());
        match (number(0), number(1), record.len()) {
            (Some(time), Some(value), 2) => rows.push((time, value)),
            (None, None, _) if index == 0 => {}
            _ => {
                let line = record.position().map_or(0, csv::Position::line);
                let text = record.iter().collect::<Vec<_>>().join(",");
                return Err(format!(
                    "line {line} of {name}, `{text}`, is not two numbers: a time in s and a value"
                ));
            }
        }
    }
    Ok(rows)
}

/// The basis of one field of a beam of the given length \[m\].
///
/// # Errors
/// [`BasisError`] when the parameters make no basis.
pub fn basis(case: &BasisCase, length: f64, field: Field) -> Result<Box<dyn Basis>, BasisError> {
    Ok(match *case {
        BasisCase::FiniteElements { elements, axial_degree } => match field {
            Field::Axial => Box::new(Lagrange::new(length, elements, axial_degree)?),
            Field::Transverse => Box::new(Hermite::new(length, elements, field)?),
        },
        BasisCase::Modes { count } => Box::new(Modes::new(length, count, field)?),
        BasisCase::Radial(RadialBasis { nodes, shape, exponent, support, degree }) => {
            let parameters = RadialParameters { nodes, shape, exponent, support, degree };
            Box::new(Radial::new(length, parameters, field)?)
        }
        BasisCase::Polynomial { nodes, support } => {
            Box::new(Polynomial::new(length, PolynomialParameters { nodes, support }, field)?)
        }
        BasisCase::BSpline { elements, degree } => Box::new(BSpline::new(length, elements, degree, field)?),
        BasisCase::Bezier { elements, degree } => Box::new(Bezier::new(length, elements, degree, field)?),
    })
}

/// The integrator of a case.
///
/// # Errors
/// [`InvalidParameter`] when a parameter is outside the range of the method.
pub fn integrator(case: &IntegratorCase) -> Result<Box<dyn Integrator>, InvalidParameter> {
    Ok(match *case {
        IntegratorCase::Radau { tolerance, absolute_tolerance, .. } => {
            Box::new(Radau::new(Tolerance { relative: tolerance, absolute: absolute_tolerance })?)
        }
        IntegratorCase::Newmark { beta, gamma, .. } => Box::new(GeneralizedAlpha::newmark(beta, gamma)?),
        IntegratorCase::Hht { alpha, .. } => Box::new(GeneralizedAlpha::hht(alpha)?),
        IntegratorCase::GeneralizedAlpha { spectral_radius, .. } => {
            Box::new(GeneralizedAlpha::chung_hulbert(spectral_radius)?)
        }
        IntegratorCase::RungeKutta4 { .. } => Box::new(RungeKutta::new()),
        IntegratorCase::Adams4 { .. } => Box::new(Adams::new()),
    })
}

/// Why a section cannot be cut into so many equal elements of smooth curvature, if it cannot.
pub(super) fn jump_inside_element(section: &dyn Section, length: f64, elements: usize) -> Option<String> {
    let off = |jump: &&f64| {
        let nodes = *jump / length * elements as f64;
        (nodes - nodes.round()).abs() > 1e-6
    };
    section.jumps().iter().find(off).map(|jump| {
        format!(
            "the section jumps at {jump} m, inside one of the {elements} equal elements of {} m; with the exact coupling elements must end at the jumps",
            length / elements as f64
        )
    })
}

/// A case that cannot be built although each of its values is in range.
#[derive(Debug, thiserror::Error)]
pub enum BuildError {
    /// The section.
    #[error(transparent)]
    Section(#[from] SectionError),
    /// The motion.
    #[error(transparent)]
    Motion(#[from] MotionError),
    /// The basis.
    #[error(transparent)]
    Basis(#[from] BasisError),
    /// A load.
    #[error(transparent)]
    Load(#[from] ProfileError),
    /// The blade.
    #[error(transparent)]
    Blade(#[from] BladeError),
}

/// The mechanical system of a case.
///
/// # Errors
/// [`BuildError`] when a part of it is refused; a case that was read has passed these checks.
pub fn system(case: &Case) -> Result<Box<dyn System>, BuildError> {
    let section = load_build::laden(section(&case.section, case.length)?, case)?;
    let drive = drive(&case.hub.motion, case.duration)?;
    let (length, stations) = (case.length, &case.output.stations);
    let hub = Hub { radius: case.hub.radius, inertia: case.hub.inertia, drive };
    let foreshortening = match case.coupling {
        Coupling::Zeroth => Foreshortening::None,
        Coupling::First | Coupling::High => Foreshortening::First,
        Coupling::Exact => {
            let BasisCase::FiniteElements { elements, .. } = case.bases.transverse else {
                let message = "the exact coupling needs finite elements".to_owned();
                return Err(BasisError::Invalid(message).into());
            };
            if let Some(jump) = jump_inside_element(section.as_ref(), length, elements) {
                return Err(SectionError::Invalid(jump).into());
            }
            let coupling = ExactCoupling::new(length, elements, section.as_ref(), &hub)?;
            return finished(HubBeam::new(hub, coupling, stations), section.as_ref(), case);
        }
    };
    let axial = basis(&case.bases.axial, length, Field::Axial)?;
    let transverse = basis(&case.bases.transverse, length, Field::Transverse)?;
    let fields = Fields::new(length, axial, transverse, section.breaks());
    if case.coupling == Coupling::High {
        let coupling = HighCoupling::new(fields, section.as_ref(), &hub)?;
        return finished(HubBeam::new(hub, coupling, stations), section.as_ref(), case);
    }
    let coupling = LinearCoupling::new(fields, section.as_ref(), &hub, foreshortening);
    finished(HubBeam::new(hub, coupling, stations), section.as_ref(), case)
}

/// A system under the loads and with the damping of a case, and with the section forces and strains that it wants
/// recorded.
fn finished<C: HubCoupling + 'static>(
    system: HubBeam<C>,
    section: &dyn Section,
    case: &Case,
) -> Result<Box<dyn System>, BuildError> {
    let loads = load_build::loads(case)?;
    let loads: Vec<_> = loads.iter().map(|load| load.as_ref()).collect();
    let system = if loads.is_empty() { system } else { system.with_loads(section, &loads) };
    let system = system.with_damping(case.loads.damping);
    let output = &case.output;
    if !output.section_forces && output.strain_heights.is_empty() {
        return Ok(Box::new(system));
    }
    let sampling = match (case.coupling, &case.bases.axial, &case.bases.transverse) {
        (Coupling::Exact, ..) => Sampling::Curve,
        (
            _,
            BasisCase::FiniteElements { elements, axial_degree },
            BasisCase::FiniteElements { elements: transverse, .. },
        ) if elements == transverse => Sampling::Elements(*axial_degree),
        _ => Sampling::Station,
    };
    Ok(Box::new(system.with_section_forces(section, sampling, output.section_forces, &output.strain_heights)))
}
