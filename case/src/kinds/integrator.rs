//! The integrator of a case: kinds, keys and makers.

use crate::declaration::Bound::*;
use crate::fault::{Fault, Made};
use crate::keys::{Field, boolean, integer, keys, number, quantity, table};
use crate::kind::{Choice, Kind, Of};
use crate::units::TIME;
use flexion::integrator::{
    Adams, GeneralizedAlpha, Integrator, InvalidParameter, MoreauJean, NonsmoothAlpha, Radau, RungeKutta,
    Tolerance,
};

/// An integrator that has not yet started, and the steps that a case asks of it.
pub struct Method {
    /// The integrator: it belongs to one run.
    pub integrator: Box<dyn Integrator>,
    /// The steps.
    pub steps: Steps,
}

/// The steps that a case asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Steps {
    /// All steps have this length \[s\].
    Fixed {
        /// The step \[s\].
        step: f64,
        /// The step while a contact is closed or comes near \[s\].
        contact: Option<f64>,
    },
    /// The method controls its steps, by the tolerances of its table.
    Controlled {
        /// Relative tolerance of the local error.
        tolerance: f64,
        /// Absolute tolerance, in scales of the unknowns.
        absolute_tolerance: f64,
        /// First step \[s\]; chosen by the run when `None`.
        first: Option<f64>,
        /// Largest step \[s\]; no limit when `None`.
        longest: Option<f64>,
        /// Largest step while a contact is closed or comes near \[s\].
        contact: Option<f64>,
        /// Least number of steps between two neighbouring breaks.
        breaks: u32,
    },
}

impl Steps {
    /// The fixed step \[s\]; `None` for step control.
    pub fn step(self) -> Option<f64> {
        match self {
            Steps::Fixed { step, .. } => Some(step),
            Steps::Controlled { .. } => None,
        }
    }
}

/// A method with a fixed step, and another near contacts.
fn fixed<I: Integrator + 'static>(
    integrator: Result<I, InvalidParameter>,
    step: f64,
    contact: Option<f64>,
) -> Made<Method> {
    Ok(Method { integrator: Box::new(checked(integrator)?), steps: Steps::Fixed { step, contact } })
}

/// A generalized-α method, which may be stabilized.
fn alpha(
    integrator: Result<GeneralizedAlpha, InvalidParameter>,
    stabilized: Option<bool>,
) -> Result<GeneralizedAlpha, InvalidParameter> {
    integrator.map(|method| match stabilized {
        Some(true) => method.stabilized(),
        Some(false) => method.positions_only(),
        None => method,
    })
}

/// An explicit method, with the constants by which it holds contacts.
fn explicit<I: Integrator + 'static>(
    k: &Explicit,
    method: I,
    held: impl Fn(I, f64, f64) -> I,
) -> Made<Method> {
    let method = match &k.baumgarte {
        Some(Baumgarte { position, velocity }) => held(method, *velocity, *position),
        None => method,
    };
    fixed(Ok(method), k.step, k.contact_step)
}

/// The method, or what is wrong at the key of its parameter.
fn checked<I>(integrator: Result<I, InvalidParameter>) -> Made<I> {
    integrator.map_err(|error| Fault::new(error.parameter.replace(' ', "-"), error.to_string()).into())
}

pub(crate) const STEP: Field<f64> = quantity(&TIME, Positive).called("step", "time step");
pub(crate) const CONTACT_STEP: Field<Option<f64>> = quantity(&TIME, Positive)
    .called("contact-step", "time step while a contact is closed or comes near, that of flight if left out");
const STABILIZED: Field<Option<bool>> = boolean().called(
    "stabilized",
    "joints and closed contacts hold their velocities too, by a second multiplier (Gear, Gupta & Leimkuhler); if left out, where there are rigid contacts",
);
const SPECTRAL_RADIUS: Field<f64> = number(Between(0.0, 1.0))
    .or(0.8)
    .called("spectral-radius", "spectral radius ρ∞ at high frequency, from 0 (most dissipation) to 1 (none)");

keys! {
    pub(crate) struct Controlled {
        /// relative tolerance of the local error
        tolerance: f64 = number(Between(1e-14, 1e-1)).or(1e-6);
        /// absolute tolerance, in scales of the unknowns
        absolute_tolerance: f64 = number(Between(1e-14, 1e-1)).or(1e-8);
        /// first step, chosen if left out
        initial_step: Option<f64> = quantity(&TIME, Positive);
        /// largest step, free if left out
        max_step: Option<f64> = quantity(&TIME, Positive);
        /// largest step while a contact comes near and, in flight too, from the first impact on; no such limit if left out
        contact_step: Option<f64> = quantity(&TIME, Positive);
        /// least number of steps between two times at which a load or a motion jumps, has a kink or changes fast
        break_steps: usize = integer(1, 1 << 16).or_count(1);
    }

    struct Newmark {
        step: f64 = STEP;
        contact_step: Option<f64> = CONTACT_STEP;
        stabilized: Option<bool> = STABILIZED;
        /// β, at least γ/2
        beta: f64 = number(Between(0.01, 1.0)).or(0.25);
        /// γ; above 1/2 it dissipates
        gamma: f64 = number(Between(0.5, 1.5)).or(0.5);
    }

    struct Hht {
        step: f64 = STEP;
        contact_step: Option<f64> = CONTACT_STEP;
        stabilized: Option<bool> = STABILIZED;
        /// α, from 0 (no dissipation) to 1/3 (most)
        alpha: f64 = number(Between(0.0, 1.0 / 3.0)).or(0.05);
    }

    struct ChungHulbert {
        step: f64 = STEP;
        contact_step: Option<f64> = CONTACT_STEP;
        stabilized: Option<bool> = STABILIZED;
        spectral_radius: f64 = SPECTRAL_RADIUS;
    }

    struct Nonsmooth {
        step: f64 = STEP;
        spectral_radius: f64 = SPECTRAL_RADIUS;
        /// position and velocity are corrected after a smooth step; if false, all is solved at once
        decoupled: bool = boolean().or_true();
    }

    struct Theta {
        step: f64 = STEP;
        /// θ; above 1/2 it dissipates
        theta: f64 = number(Between(0.5, 1.0)).or(0.5);
    }

    struct Baumgarte {
        /// ε in 1/s
        position: f64 = number(NotNegative);
        /// δ in 1/s
        velocity: f64 = number(NotNegative);
    }

    struct Explicit {
        step: f64 = STEP;
        contact_step: Option<f64> = CONTACT_STEP;
        /// constants by which closed contacts are held, g̈ + 2δ ġ + ε² g = 0 (Baumgarte 1972, doi:10.1016/0045-7825(72)90018-7);
        /// without them a case with rigid contacts is refused, with joints always
        baumgarte: Option<Baumgarte> = table();
    }
}

fn radau(k: &Controlled) -> Made<Method> {
    let &Controlled { tolerance, absolute_tolerance, .. } = k;
    let integrator = Radau::new(Tolerance { relative: tolerance, absolute: absolute_tolerance });
    Ok(Method {
        integrator: Box::new(checked(integrator)?),
        steps: Steps::Controlled {
            tolerance,
            absolute_tolerance,
            first: k.initial_step,
            longest: k.max_step,
            contact: k.contact_step,
            breaks: k.break_steps as u32,
        },
    })
}

/// The kinds of integrator.
pub static INTEGRATOR: Choice<Method> = Choice {
    name: "integrator",
    path: "integrator",
    summary: "time integration",
    kinds: &[
        Kind {
            name: "radau",
            summary: "Radau IIA, implicit, order 5, with step control",
            source: "Hairer & Wanner 1999, doi:10.1016/S0377-0427(99)00134-X",
            example: "integrator={kind='radau', tolerance=1e-8, max-step='20 ms'}",
            make: &Of(|k: Controlled, _| radau(&k)),
        },
        Kind {
            name: "newmark",
            summary: "Newmark, implicit, order 2 with γ = 1/2",
            source: "Newmark 1959, doi:10.1061/JMCEA3.0000098",
            example: "integrator={kind='newmark', step='1 ms'}",
            make: &Of(|k: Newmark, _| {
                fixed(alpha(GeneralizedAlpha::newmark(k.beta, k.gamma), k.stabilized), k.step, k.contact_step)
            }),
        },
        Kind {
            name: "hht",
            summary: "Hilber–Hughes–Taylor, implicit, order 2, dissipates high frequencies",
            source: "Hilber, Hughes & Taylor 1977, doi:10.1002/eqe.4290050306",
            example: "integrator={kind='hht', step='1 ms', alpha=0.1}",
            make: &Of(|k: Hht, _| {
                fixed(alpha(GeneralizedAlpha::hht(k.alpha), k.stabilized), k.step, k.contact_step)
            }),
        },
        Kind {
            name: "generalized-alpha",
            summary: "generalized-α, implicit, order 2, dissipates high frequencies",
            source: "Chung & Hulbert 1993, doi:10.1115/1.2900803",
            example: "integrator={kind='generalized-alpha', step='1 ms'}",
            make: &Of(|k: ChungHulbert, _| {
                let method = GeneralizedAlpha::chung_hulbert(k.spectral_radius);
                fixed(alpha(method, k.stabilized), k.step, k.contact_step)
            }),
        },
        Kind {
            name: "nonsmooth-generalized-alpha",
            summary: "nonsmooth generalized-α, implicit, order 2, 1 across impacts; locates no events",
            source: "Brüls, Acary & Cardona 2014, doi:10.1016/j.cma.2014.07.025; Cosimo et al. 2020, \
                     doi:10.1007/s11044-019-09706-6",
            example: "integrator={kind='nonsmooth-generalized-alpha', step='1 ms'}\n\
                      contact=[{obstacle={kind='stop', offset='-1 um'}, law={kind='constraint', restitution=0.5}}]",
            make: &Of(|k: Nonsmooth, _| {
                let make = if k.decoupled { NonsmoothAlpha::decoupled } else { NonsmoothAlpha::coupled };
                fixed(make(k.spectral_radius), k.step, None)
            }),
        },
        Kind {
            name: "moreau-jean",
            summary: "Moreau–Jean, nonsmooth, implicit, order 1; locates no events",
            source: "Moreau 1988, doi:10.1007/978-3-7091-2624-0_1; Jean 1999, doi:10.1016/S0045-7825(98)00383-1",
            example: "integrator={kind='moreau-jean', step='1 ms'}",
            make: &Of(|k: Theta, _| fixed(MoreauJean::new(k.theta), k.step, None)),
        },
        Kind {
            name: "runge-kutta-4",
            summary: "classical Runge–Kutta, explicit, order 4",
            source: "Hairer, Nørsett & Wanner 1993, doi:10.1007/978-3-540-78862-1",
            example: "integrator={kind='runge-kutta-4', step='1 us'}",
            make: &Of(|k: Explicit, _| explicit(&k, RungeKutta::new(), RungeKutta::with_baumgarte)),
        },
        Kind {
            name: "adams-4",
            summary: "Adams–Bashforth–Moulton predictor–corrector, explicit, order 4",
            source: "Hairer, Nørsett & Wanner 1993, doi:10.1007/978-3-540-78862-1",
            example: "integrator={kind='adams-4', step='1 us'}",
            make: &Of(|k: Explicit, _| explicit(&k, Adams::new(), Adams::with_baumgarte)),
        },
    ],
};
