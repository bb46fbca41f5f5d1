//! The columns of a run that its reader sees first.

use super::Trajectory;
use flexion::system::{Channel, Kind, Role};

/// Primary columns that the figure of a run shows in any case; further ones fill its last row.
pub(super) const SHOWN: usize = 4;

/// The same of a run in space, beside three views.
const SHOWN_IN_SPACE: usize = 2;

/// Change of a coordinate over the largest of its kind below which it is not drawn.
const SMALL: f64 = 0.02;

/// Change of a column of a run, over its size or that of its unit, that the integration leaves of what is constant.
pub(super) const NOISE: f64 = 1e-7;

/// The columns that the figure of a run shows against time, energies and contacts aside: of a beam on a hub the first primary ones, and of a
/// system in space the first that change, a primary one before the secondary ones.
pub fn shown_columns(trajectory: &Trajectory, in_space: bool) -> Vec<usize> {
    let primary = trajectory.with_role(Role::Primary);
    if !in_space {
        return primary.take(SHOWN).collect();
    }
    let mut found = moving(trajectory);
    found.truncate(SHOWN_IN_SPACE);
    found
}

/// The columns of a run in space that change, by the order in which they are drawn; a principal one in any case.
pub(super) fn moving(trajectory: &Trajectory) -> Vec<usize> {
    let channels = trajectory.channels();
    let sizes: Vec<(f64, f64)> = (0..channels.len())
        .map(|i| {
            let extremes = trajectory.extremes(i);
            let (change, size) = (extremes.max - extremes.min, extremes.largest());
            (if change > NOISE * size { change } else { 0.0 }, size)
        })
        .collect();
    let most = |alike: &dyn Fn(&Channel) -> bool, size: fn(&(f64, f64)) -> f64| {
        let pairs = channels.iter().zip(&sizes).filter(|(channel, _)| alike(channel));
        pairs.map(|(_, pair)| size(pair)).fold(0.0, f64::max)
    };
    // A coordinate that does not change, or little beside others, says nothing.
    let moves = |i: &usize| {
        let (own, change) = (&channels[*i], sizes[*i].0);
        change > 0.0
            && change >= SMALL * most(&|c| c.role == own.role && c.unit == own.unit, |of| of.0)
            && change >= NOISE * most(&|c| c.unit == own.unit, |of| of.1)
    };
    // Those of contacts have panels of their own.
    let gaps = || channels.iter().filter(|channel| channel.kind == Kind::Gap);
    let contact = |i: &usize| {
        gaps().any(|gap| {
            gap.name.strip_suffix("gap").is_some_and(|contact| channels[*i].name.starts_with(contact))
        })
    };
    let all = |role| trajectory.with_role(role).filter(|i| !contact(i));
    let of = |role| all(role).filter(moves);
    let first = of(Role::Primary).next().or_else(|| all(Role::Primary).find(|i| sizes[*i].1 > 0.0));
    let others = of(Role::Secondary).chain(of(Role::Primary)).filter(|i| Some(*i) != first);
    first.into_iter().chain(others).collect()
}
