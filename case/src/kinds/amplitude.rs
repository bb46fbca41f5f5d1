//! Changes of a load with time and along the beam: factors of it.

use super::profile;
use crate::declaration::{Bound::*, Key, Presence as Default, Presence::Required, Type, Type::Quantity, key};
use crate::fault::Made;
use crate::kind::{Choice, Context, Kind};
use crate::units::{FACTOR, LENGTH, TIME};
use crate::values::Values;
use flexion::hub_beam::load::Amplitude;
use flexion::profile::{Polyline, Ramp};
use std::sync::Arc;

/// The kinds of change with time.
pub static AMPLITUDE: Choice<Amplitude> = Choice {
    name: "amplitude",
    path: "load.amplitude",
    summary: "change of a load with time, as a factor of it",
    kinds: &[
        Kind {
            name: "constant",
            summary: "constant",
            source: "",
            keys: &[],
            example: "load=[{on='2 m', force=[0, 3], amplitude={kind='constant'}}]",
            make: |_, _| Ok(None),
        },
        Kind {
            name: "ramp",
            summary: "growing linearly from zero, then constant",
            source: "",
            keys: &[key("time", Quantity(&TIME, Positive), Required, "time in which it is reached")],
            example: "load=[{on='2 m', force=[0, 3], amplitude={kind='ramp', time='30 ms'}}]",
            make: |v, _| {
                let ramp = Ramp::new(0.0, 1.0, v.number("time")?);
                Ok(Some(Arc::new(profile::checked(ramp, "time")?)))
            },
        },
        Kind {
            name: "table",
            summary: "curve through times and factors",
            source: "",
            keys: &[
                key("times", Type::Quantities(&TIME, Any), Required, "times, ascending"),
                key("factors", Type::Quantities(&FACTOR, Any), Required, "factor at each time"),
                profile::OF_LOADS,
            ],
            example: "load=[{on='2 m', couple=1, amplitude={kind='table', times=[0, '20 ms', 0.05], factors=[0, 1, 2]}}]",
            make: |v, c| {
                let rows = profile::factors(v, "times")?;
                profile::covering(profile::through(&rows, v, c, "times")?, c, "times").map(Some)
            },
        },
        Kind {
            name: "expression",
            summary: "formula of time t [s] for the factor",
            source: "",
            keys: &[key("formula", Type::Text, Required, "formula in t")],
            example: "load=[{on='beam', force-per-length=['0 N/m', '-2 N/m'], amplitude={kind='expression', formula='sin(t)'}}]",
            make: |v, c| profile::covering(profile::of_time(v, c)?, c, "formula").map(Some),
        },
    ],
};

/// The kinds of change along the beam.
pub static DISTRIBUTION: Choice<Amplitude> = Choice {
    name: "distribution",
    path: "load.distribution",
    summary: "change of a force per length along the beam, as a factor of it",
    kinds: &[
        Kind {
            name: "uniform",
            summary: "the same everywhere",
            source: "",
            keys: &[],
            example: "load=[{on='beam', force-per-length=[0, 3], from=0.5, to='1 m', distribution={kind='uniform'}}]",
            make: |_, _| Ok(None),
        },
        Kind {
            name: "table",
            summary: "straight lines through stations and factors",
            source: "",
            keys: &[
                key("stations", Type::Quantities(&LENGTH, NotNegative), Required, "stations, ascending"),
                key("factors", Type::Quantities(&FACTOR, Any), Required, "factor at each station"),
            ],
            example: "load=[{on='beam', force-per-length=[0, 3], distribution={kind='table', stations=[0, 1, 2], factors=[0, 1, 0]}}]",
            make: |v, _| {
                let line = Polyline::new(&profile::factors(v, "stations")?);
                Ok(Some(Arc::new(profile::checked(line, "stations")?)))
            },
        },
        Kind {
            name: "expression",
            summary: "formula of the station x [m] for the factor",
            source: "",
            keys: &[key("formula", Type::Text, Required, "formula in x")],
            example: "load=[{on='beam', force-per-length=[0, 3], axes='hub', distribution={kind='expression', formula='x^2'}}]",
            make: |v, c| profile::formula(v, "x", c.length()?).map(Some),
        },
    ],
};

/// The key of a load's change with time.
pub(super) const CHANGE: Key =
    key("amplitude", Type::Kind(&AMPLITUDE), Default::Name("constant"), "factor against time");

/// The change of a load with time.
pub(super) fn amplitude(v: &Values, c: &Context<'_>) -> Made<Amplitude> {
    AMPLITUDE.make(v, CHANGE.name, c)
}
