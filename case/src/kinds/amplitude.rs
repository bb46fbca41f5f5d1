//! Changes of a load with time and along the beam: factors of it.

use super::profile::{self, OF_LOADS, Through};
use crate::declaration::Bound::*;
use crate::fault::Made;
use crate::keys::{Field, keys, kind, quantities, quantity, text};
use crate::kind::{Choice, Context, Is, Kind, Of};
use crate::units::{FACTOR, LENGTH, TIME};
use flexion::hub_beam::load::Amplitude;
use flexion::profile::{Pieces, Ramp};
use std::sync::Arc;

keys! {
    struct Growing {
        /// time in which it is reached
        time: f64 = quantity(&TIME, Positive);
    }

    struct Times {
        /// times, ascending
        times: Vec<f64> = quantities(&TIME, Any);
        /// factor at each time
        factors: Vec<f64> = quantities(&FACTOR, Any);
        interpolation: Through = OF_LOADS;
    }

    struct OfTime {
        /// formula in t
        formula: String = text();
    }
}

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
            example: "load=[{on='2 m', force=[0, 3], amplitude={kind='constant'}}]",
            make: &Is(None),
        },
        Kind {
            name: "ramp",
            summary: "growing linearly from zero, then constant",
            source: "",
            example: "load=[{on='2 m', force=[0, 3], amplitude={kind='ramp', time='30 ms'}}]",
            make: &Of(growing),
        },
        Kind {
            name: "table",
            summary: "curve through times and factors",
            source: "",
            example: "load=[{on='2 m', couple=1, amplitude={kind='table', times=[0, '20 ms', 0.05], factors=[0, 1, 2]}}]",
            make: &Of(|k: Times, c| {
                let rows = profile::factors(&k.times, &k.factors)?;
                profile::covering(profile::through(&rows, k.interpolation, c, "times")?, c, "times").map(Some)
            }),
        },
        Kind {
            name: "expression",
            summary: "formula of time t [s] for the factor",
            source: "",
            example: "load=[{on='beam', force-per-length=['0 N/m', '-2 N/m'], amplitude={kind='expression', formula='sin(t)'}}]",
            make: &Of(|k: OfTime, c| {
                profile::covering(profile::of_time(&k.formula, c)?, c, "formula").map(Some)
            }),
        },
    ],
};

fn growing(k: Growing, _: &Context<'_>) -> Made<Amplitude> {
    Ok(Some(Arc::new(profile::checked(Ramp::new(0.0, 1.0, k.time), "time")?)))
}

keys! {
    struct Stations {
        /// stations, ascending
        stations: Vec<f64> = quantities(&LENGTH, NotNegative);
        /// factor at each station
        factors: Vec<f64> = quantities(&FACTOR, Any);
    }

    struct OfStation {
        /// formula in x
        formula: String = text();
    }
}

fn lines(k: Stations, _: &Context<'_>) -> Made<Amplitude> {
    let line = Pieces::linear(&profile::factors(&k.stations, &k.factors)?);
    Ok(Some(Arc::new(profile::checked(line, "stations")?)))
}

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
            example: "load=[{on='beam', force-per-length=[0, 3], from=0.5, to='1 m', distribution={kind='uniform'}}]",
            make: &Is(None),
        },
        Kind {
            name: "table",
            summary: "straight lines through stations and factors",
            source: "",
            example: "load=[{on='beam', force-per-length=[0, 3], distribution={kind='table', stations=[0, 1, 2], factors=[0, 1, 0]}}]",
            make: &Of(lines),
        },
        Kind {
            name: "expression",
            summary: "formula of the station x [m] for the factor",
            source: "",
            example: "load=[{on='beam', force-per-length=[0, 3], axes='hub', distribution={kind='expression', formula='x^2'}}]",
            make: &Of(|k: OfStation, c| profile::formula(&k.formula, "x", c.length()?).map(Some)),
        },
    ],
};

/// The key of a load's change with time.
pub(super) const CHANGE: Field<Amplitude> =
    kind(&AMPLITUDE).or_name("constant").called("amplitude", "factor against time");
