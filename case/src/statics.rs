//! The path of equilibria of a case at rest as its loads grow.

use super::case::suspected;
use super::problem::Problems;
use super::reading::Reading;
use super::run::error::much;
use flexion::analysis::error::{COARSE, Effort, ROUNDING, Refinable};
use flexion::analysis::path::{Plan, Point, follow};
use flexion::system::{Role, System};
use flexion_results::{LoadPath, LoadPoint, PointError};

/// What is asked of a path.
#[derive(Clone, Debug)]
pub struct StaticsRequest {
    /// Load factor to which it is followed, its longest step, and the most equilibria.
    pub plan: Plan,
    /// What the estimate of its errors may cost; `None` estimates none.
    pub effort: Option<Effort>,
}

/// Why there is no path.
#[derive(Debug, thiserror::Error)]
pub enum StaticsError {
    /// The case is to blame, at its lines.
    #[error(transparent)]
    Case(#[from] Problems),
    /// No equilibrium was found, or no load moves anything.
    #[error("{0}")]
    NotFound(String),
}

const NO_LOAD: &str = "no load moves the system: those of t = 0 are zero, or there are none; give it a force, a couple, a distributed load or \
                       gravity";

impl Reading {
    /// Follows the equilibrium of the case, its hub at rest and held, as the loads of t = 0 grow, and estimates its errors. `progress` gets the
    /// number of points and the load factor, and stops by `false`. Its warnings are the cautions of the path.
    ///
    /// # Errors
    /// [`StaticsError`]. A path that ends early is no error.
    pub fn statics(
        &self,
        StaticsRequest { plan, effort }: &StaticsRequest,
        progress: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<LoadPath, StaticsError> {
        let mut path = self.load_path(plan, &mut *progress)?;
        if let Some(effort) = effort {
            let caution = self.estimate_path_errors(&mut path, plan, *effort, &mut *progress);
            path.cautions.extend(caution);
        }
        if let (Some(end), []) = (&path.end, path.points.as_slice()) {
            let caution =
                suspected(&self.case.cautions).map_or_else(String::new, |caution| format!("\n{caution}"));
            return Err(StaticsError::NotFound(format!("{end}{caution}")));
        }
        if path.end.is_none() && path.points.iter().all(|point| point.values == path.points[0].values) {
            return Err(StaticsError::NotFound(NO_LOAD.to_owned()));
        }
        let last = path.points.last().and_then(|point| point.stability);
        if let Some(last) = last.filter(|found| !found.is_stable()) {
            path.cautions.push(format!("the last equilibrium is {last}"));
        }
        Ok(path)
    }

    /// Follows the equilibrium of the case, its hub at rest and held, under the loads of t = 0 times a factor that grows from
    /// zero, to the load factor of the plan. `progress` gets the number of points and the load factor, and stops by `false`.
    ///
    /// # Errors
    /// [`Problems`] of the case, and of a hub that rotates at the start. A path that ends early is no error.
    pub fn load_path(
        &self,
        plan: &Plan,
        mut progress: impl FnMut(usize, f64) -> bool,
    ) -> Result<LoadPath, Problems> {
        let mut system = self.build()?.system;
        let key = if self.case.space().is_some() { "" } else { "hub" };
        self.at_rest(&system.initial().v, key, "`flexion modes` and `campbell` find its equilibrium")?;
        system.hold(true);
        let start = system.initial();
        let channels = system.channels();
        let mut points: Vec<LoadPoint> = Vec::new();
        let mut stopped = false;
        let visit = |system: &mut dyn System, point: &Point| {
            let mut values = vec![0.0; channels.len()];
            system.record(&point.state, &mut values);
            points.push(LoadPoint {
                factor: point.factor,
                length: point.length,
                stability: point.stability.as_ref().ok().copied(),
                critical: point.critical,
                values,
                error: None,
            });
            stopped = !progress(points.len(), point.factor);
            !point.arrived && !stopped
        };
        let end = follow(system.as_mut(), &start, plan, visit).err().map(|end| end.to_string());
        let end = if stopped { Some("stopped by the user".to_owned()) } else { end };
        let largest = |i: usize| points.iter().fold(0.0_f64, |most, point| most.max(point.values[i].abs()));
        let cautions = system.cautions(&(0..channels.len()).map(largest).collect::<Vec<_>>());
        Ok(LoadPath { channels, points, to: plan.to, end, unknown: None, cautions })
    }

    /// Estimates the errors of a path of this case by the same path on a mesh of twice the functions: S = 2 times the difference of the
    /// last points, and of critical states of one kind in their order, as [for a run](Reading::estimate_errors). Returns a warning of a
    /// coarse mesh, with one that would do where a path on it has shown that.
    pub fn estimate_path_errors(
        &self,
        path: &mut LoadPath,
        plan: &Plan,
        effort: Effort,
        mut progress: impl FnMut(usize, f64) -> bool,
    ) -> Option<String> {
        let changes = self.case.finer();
        let unknowns = self.case.system().map_or(0, |system| system.size().v);
        let work = (path.points.len() * unknowns) as f64;
        let why = match () {
            () if path.end.is_some() => Some("the path has ended".to_owned()),
            () if changes.is_empty() => Some("the case has no mesh".to_owned()),
            () if effort == Effort::Auto && work > COSTLY => Some(format!(
                "the path took {work:.1e} points times unknowns, and that of a finer mesh several times as many: `--error full` follows it"
            )),
            () => None,
        };
        let mut followed = |of: &Reading| -> Result<LoadPath, String> {
            let first =
                |problems: Problems| problems.list.into_iter().next().map_or(String::new(), |p| p.message);
            let path = of.load_path(plan, &mut progress).map_err(first)?;
            match &path.end {
                Some(end) => Err(end.clone()),
                None => Ok(path),
            }
        };
        let twice = |of: &Reading| of.changed(&of.case.finer()).map_err(|_| "it is too fine".to_owned());
        let found = match why {
            Some(why) => Err(why),
            None => twice(self).and_then(|finer| Ok((followed(&finer)?, finer))),
        };
        let (fine, finer) = match found {
            Ok(found) => found,
            Err(why) => {
                path.unknown = Some(why);
                return None;
            }
        };
        let safety = self.safety();
        let coarse = Coarse::of(path, &fine, safety, self.case.size());
        set_errors(path, &fine, safety);
        let Coarse { column, part } = coarse?;
        let said = format!("the mesh is coarse: the error of {column} {} of its largest value", much(part));
        let finest = twice(&finer).and_then(|finest| followed(&finest)).ok()?;
        let enough = Coarse::of(&fine, &finest, safety, self.case.size()).is_none();
        let changes = crate::run::variant::said(&changes);
        Some(if enough {
            format!("{said}; with `{changes}` it is below 1 %")
        } else {
            format!("{said}, and with `{changes}` still above 1 %: use a finer one")
        })
    }
}

/// Points times unknowns of a path beyond which its companion is not followed unasked: some seconds of computing.
const COSTLY: f64 = 2e4;

/// The points whose errors are stated, in pairs of two paths: the critical states of one kind in their order, and the last points.
fn pairs<'a>(ours: &'a LoadPath, theirs: &'a LoadPath) -> impl Iterator<Item = (usize, &'a LoadPoint)> {
    let critical = |path: &'a LoadPath| {
        path.points.iter().enumerate().filter_map(|(i, point)| Some((i, point, point.critical?)))
    };
    let alike = critical(ours).zip(critical(theirs)).take_while(|(a, b)| a.2 == b.2);
    let last = ours.points.len().checked_sub(1).zip(theirs.points.last());
    alike.map(|((i, ..), (_, point, _))| (i, point)).chain(last)
}

fn set_errors(path: &mut LoadPath, fine: &LoadPath, safety: f64) {
    let errors: Vec<(usize, PointError)> = pairs(path, fine)
        .map(|(i, theirs)| {
            let ours = &path.points[i];
            let error = |x: f64, y: f64| safety * (x - y).abs() + ROUNDING * y.abs();
            let values = ours.values.iter().zip(&theirs.values).map(|(x, y)| error(*x, *y)).collect();
            (i, PointError { factor: error(ours.factor, theirs.factor), values })
        })
        .collect();
    for (i, error) in errors {
        path.points[i].error = Some(error);
    }
}

/// The principal column that is off by the largest part of its largest value, if that is more than a hundredth.
struct Coarse {
    column: String,
    part: f64,
}

impl Coarse {
    fn of(ours: &LoadPath, theirs: &LoadPath, safety: f64, size: f64) -> Option<Coarse> {
        let principal = ours.channels.iter().enumerate().filter(|(_, channel)| channel.role == Role::Primary);
        let largest =
            |i: usize| theirs.points.iter().fold(0.0_f64, |most, point| most.max(point.values[i].abs()));
        // What is zero but for rounding has no relative error.
        let natural = |unit: &str| match unit {
            "m" => ROUNDING * size,
            "rad" | "" => ROUNDING,
            _ => 0.0,
        };
        let there = principal.filter(|(i, channel)| largest(*i) > natural(&channel.unit));
        let part = |i: usize| {
            let off =
                pairs(ours, theirs).map(|(k, point)| (ours.points[k].values[i] - point.values[i]).abs());
            safety * off.fold(0.0, f64::max) / largest(i)
        };
        let worst = there.map(|(i, channel)| Coarse { column: channel.name.clone(), part: part(i) });
        worst.max_by(|a, b| a.part.total_cmp(&b.part)).filter(|worst| worst.part > COARSE)
    }
}
