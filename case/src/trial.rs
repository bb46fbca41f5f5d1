//! Builds the parts of a case on trial, so that what only their constructors know is reported with the
//! other problems, at the key that it concerns.

use super::basis::{Bases, Basis};
use super::blade::{Blade, StrainEnergy, TERMS};
use super::build::{self, MotionError};
use super::integrator::Integrator;
use super::layout::Coupling;
use super::motion::Motion;
use super::problem::{Place, Problem, Problems};
use super::reader::inside;
use super::section::Section;
use super::torque::Torque;
use super::values::{Values, join};
use flexion::basis::Field;
use flexion::hub_beam::HighCoupling;
use flexion::profile::ProfileError;

/// Largest matrices of a run: with its dozens of them it takes some 10 GB.
const MOST_ENTRIES: f64 = 5e7;

/// Tries the section on a beam of the given length [m], and cut into `elements` of the exact coupling.
pub(super) fn section(
    case: Option<&Section>,
    length: Option<f64>,
    elements: Option<usize>,
    values: &Values,
    problems: &mut Problems,
) {
    let (Some(case), Some(length)) = (case, length) else { return };
    let message = match build::section(case, length) {
        Err(error) => Some(error.to_string()),
        Ok(section) => elements.and_then(|n| build::jump_inside_element(section.as_ref(), length, n)),
    };
    let Some(message) = message else { return };
    let key = match case {
        Section::Piecewise { .. } => "ends",
        Section::Table { .. } | Section::Blade { .. } => "file",
        _ => {
            problems.push(Problem::new("section", values.place("section"), message));
            return;
        }
    };
    let place = values.kind("section").and_then(|(_, table)| table.place(key));
    problems.push(Problem::new(join("section", key), place, message));
}

/// Tries the blade at rest.
pub(super) fn blade(
    case: Option<&Blade>,
    section: Option<&Section>,
    length: Option<f64>,
    values: &Values,
    problems: &mut Problems,
) {
    let (Some(case), Some(section), Some(length)) = (case, section, length) else { return };
    if let (Some(table), false) =
        (values.table("blade"), matches!(case.strain_energy, StrainEnergy::Coupled(_)))
    {
        for term in TERMS.into_iter().filter(|term| table.boolean(term).is_some()) {
            let message = "a term of the strain energy `coupled`, which the blade does not have; write \
                           `strain-energy = \"coupled\"`, or leave the term out";
            problems.push(Problem::new(join("blade", term), table.place(term), message));
        }
    }
    // What is wrong with the section is reported there.
    if build::section(section, length).is_err() {
        return;
    }
    if let Err(error) = build::blade_of(case, section, length, 0.0) {
        problems.push(Problem::new("blade", values.place("blade"), error.to_string()));
    }
}

/// Tries the motion over the duration [s].
pub(super) fn motion(case: Option<&Motion>, duration: Option<f64>, values: &Values, problems: &mut Problems) {
    let (Some(case), Some(duration)) = (case, duration) else { return };
    let Err(error) = build::drive(case, duration) else { return };
    let mut table = values.table("hub").and_then(|hub| hub.kind("motion")).map(|(_, values)| values);
    let mut path = "hub.motion";
    let (mut file, mut formula) =
        (matches!(case, Motion::Table { .. }), matches!(case, Motion::Expression { .. }));
    if let Motion::Free(free) = case {
        table = table.and_then(|free| free.kind("torque")).map(|(_, values)| values);
        path = "hub.motion.torque";
        file = matches!(free.torque, Torque::Table { .. });
        formula = matches!(free.torque, Torque::Expression { .. });
    }
    let key = match (file, formula) {
        (true, _) => "file",
        (_, true) => "formula",
        _ => "kind",
    };
    let mut place = table.and_then(|table| table.place(key));
    let mut message = error.to_string();
    if let (MotionError::Profile(ProfileError::Expression { text, offset, fault }), Some(whole)) =
        (&error, &place)
    {
        place = Some(inside(whole, text, *offset..text.len().min(offset + 1), problems));
        message = fault.clone();
    }
    let problem = Problem::new(join(path, key), place, message);
    problems.push(match &error {
        MotionError::Profile(ProfileError::OutOfRange { .. }) => {
            problem.help("shorten the run, or extend the table over all of it")
        }
        _ => problem,
    });
}

/// Tries the bases of both fields on a beam of the given length [m].
pub(super) fn bases(
    case: Option<&Bases>,
    coupling: Option<Coupling>,
    length: Option<f64>,
    values: &Values,
    problems: &mut Problems,
) {
    let (Some(case), Some(length), Some((_, table))) = (case, length, values.kind("basis")) else { return };
    let entries = case.entries();
    if entries > MOST_ENTRIES {
        let message = format!(
            "a matrix of this basis has about {entries:.0e} entries, and a run needs some dozen of that size; at most \
             {MOST_ENTRIES:.0e} are tried: take fewer or narrower functions"
        );
        problems.push(Problem::new("basis", values.place("basis"), message));
        return;
    }
    let refused = |basis: &Basis, field, key| {
        let mixed = table.kind(key).map(|(_, values)| values);
        let path = if mixed.is_some() { join("basis", key) } else { "basis".to_owned() };
        let built = match build::basis(basis, length, field) {
            Err(error) => {
                let place = mixed.and_then(|values| values.place.clone());
                return Some(Problem::new(path, place.or_else(|| place_of(basis, table)), error.to_string()));
            }
            Ok(built) => built,
        };
        let error = (coupling == Some(Coupling::High)).then(|| HighCoupling::validate(built.as_ref()).err());
        let place = mixed.unwrap_or(table).place(basis.size_key());
        Some(Problem::new(join(&path, basis.size_key()), place, error.flatten()?.to_string()))
    };
    let axial = refused(&case.axial, Field::Axial, "axial");
    let transverse = refused(&case.transverse, Field::Transverse, "transverse");
    // One basis for both fields is reported once.
    let same = axial.as_ref().zip(transverse.as_ref()).is_some_and(|(a, t)| a.place == t.place);
    problems.list.extend(axial.into_iter().chain(transverse.filter(|_| !same)));
}

/// The key that most likely is to blame.
fn place_of(basis: &Basis, table: &Values) -> Option<Place> {
    table.place(match basis {
        Basis::Radial(_) => "shape",
        Basis::Polynomial { .. } => "support",
        Basis::BSpline { .. } | Basis::Bezier { .. } => "degree",
        _ => "kind",
    })
}

/// Tries the integrator.
pub(super) fn integrator(case: Option<&Integrator>, values: &Values, problems: &mut Problems) {
    if let Some(Err(error)) = case.map(build::integrator) {
        let key = error.parameter.replace(' ', "-");
        let place = values.kind("integrator").and_then(|(_, table)| table.place(&key));
        problems.push(Problem::new(join("integrator", &key), place, error.to_string()));
    }
}
