//! The integrator of a case: kinds, keys and makers.

use crate::declaration::{Bound::*, Key, Presence as Default, Presence::*, Type, Type::Quantity, key};
use crate::fault::{Fault, Made};
use crate::kind::{Choice, Kind};
use crate::units::TIME;
use crate::values::Values;
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

/// A method with the fixed step of its key `step`, and another near contacts.
fn fixed<I: Integrator + 'static>(v: &Values, integrator: Result<I, InvalidParameter>) -> Made<Method> {
    let contact = v.optional_number(CONTACT_STEP.name)?;
    Ok(Method {
        integrator: Box::new(checked(integrator)?),
        steps: Steps::Fixed { step: v.number("step")?, contact },
    })
}

/// A generalized-α method, in the form of its key `stabilized`.
fn alpha(v: &Values, integrator: Result<GeneralizedAlpha, InvalidParameter>) -> Made<Method> {
    let stabilized = v.boolean(STABILIZED.name)?;
    fixed(v, integrator.map(|method| if stabilized { method.stabilized() } else { method }))
}

/// An explicit method, with the constants of its key `baumgarte`.
fn explicit<I: Integrator + 'static>(v: &Values, method: I, held: impl Fn(I, f64, f64) -> I) -> Made<Method> {
    if v.optional(BAUMGARTE.name)?.is_none() {
        return fixed(v, Ok(method));
    }
    let constants = v.table(BAUMGARTE.name)?;
    fixed(v, Ok(held(method, constants.number("velocity")?, constants.number("position")?)))
}

/// A method with the fixed step of its key `step`, which impacts do not change.
fn nonsmooth<I: Integrator + 'static>(v: &Values, integrator: Result<I, InvalidParameter>) -> Made<Method> {
    let steps = Steps::Fixed { step: v.number("step")?, contact: None };
    Ok(Method { integrator: Box::new(checked(integrator)?), steps })
}

/// The method, or what is wrong at the key of its parameter.
fn checked<I>(integrator: Result<I, InvalidParameter>) -> Made<I> {
    integrator.map_err(|error| Fault::new(error.parameter.replace(' ', "-"), error.to_string()).into())
}

fn radau(v: &Values) -> Made<Method> {
    let (tolerance, absolute_tolerance) = (v.number("tolerance")?, v.number("absolute-tolerance")?);
    let integrator = Radau::new(Tolerance { relative: tolerance, absolute: absolute_tolerance });
    let (first, longest) = (v.optional_number("initial-step")?, v.optional_number("max-step")?);
    let contact = v.optional_number(CONTACT_STEP.name)?;
    let breaks = v.count("break-steps")? as u32;
    Ok(Method {
        integrator: Box::new(checked(integrator)?),
        steps: Steps::Controlled { tolerance, absolute_tolerance, first, longest, contact, breaks },
    })
}

const STEP: Key = key("step", Quantity(&TIME, Positive), Required, "time step");
const CONTACT_STEP: Key = key(
    "contact-step",
    Quantity(&TIME, Positive),
    Optional,
    "time step while a contact is closed or comes near, that of flight if left out",
);
const STABILIZED: Key = key(
    "stabilized",
    Type::Boolean,
    Default::Boolean(false),
    "joints and closed contacts hold their velocities too, by a second multiplier (Gear, Gupta & Leimkuhler)",
);
static CONSTANTS: [Key; 2] = [
    key("position", Type::Number(NotNegative), Required, "ε in 1/s"),
    key("velocity", Type::Number(NotNegative), Required, "δ in 1/s"),
];
const BAUMGARTE: Key = key(
    "baumgarte",
    Type::Table(&CONSTANTS),
    Optional,
    "constants by which closed contacts are held, g̈ + 2δ ġ + ε² g = 0 (Baumgarte 1972, \
     doi:10.1016/0045-7825(72)90018-7); without them a case with rigid contacts is refused, with joints always",
);
const SPECTRAL_RADIUS: Key = key(
    "spectral-radius",
    Type::Number(Between(0.0, 1.0)),
    Default::Number(0.8),
    "spectral radius ρ∞ at high frequency, from 0 (most dissipation) to 1 (none)",
);
const TOLERANCE: Type = Type::Number(Between(1e-14, 1e-1));

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
            keys: &[
                key("tolerance", TOLERANCE, Default::Number(1e-6), "relative tolerance of the local error"),
                key(
                    "absolute-tolerance",
                    TOLERANCE,
                    Default::Number(1e-8),
                    "absolute tolerance, in scales of the unknowns",
                ),
                key("initial-step", Quantity(&TIME, Positive), Optional, "first step, chosen if left out"),
                key("max-step", Quantity(&TIME, Positive), Optional, "largest step, free if left out"),
                key(
                    CONTACT_STEP.name,
                    Quantity(&TIME, Positive),
                    Optional,
                    "largest step while a contact comes near and, in flight too, from the first impact on; no such limit if left out",
                ),
                key(
                    "break-steps",
                    Type::Integer(1, 1 << 16),
                    Default::Integer(1),
                    "least number of steps between two times at which a load or a motion jumps, has a kink or changes fast",
                ),
            ],
            example: "integrator={kind='radau', tolerance=1e-8, max-step='20 ms'}",
            make: |v, _| radau(v),
        },
        Kind {
            name: "newmark",
            summary: "Newmark, implicit, order 2 with γ = 1/2",
            source: "Newmark 1959, doi:10.1061/JMCEA3.0000098",
            keys: &[
                STEP,
                CONTACT_STEP,
                STABILIZED,
                key("beta", Type::Number(Between(0.01, 1.0)), Default::Number(0.25), "β, at least γ/2"),
                key(
                    "gamma",
                    Type::Number(Between(0.5, 1.5)),
                    Default::Number(0.5),
                    "γ; above 1/2 it dissipates",
                ),
            ],
            example: "integrator={kind='newmark', step='1 ms'}",
            make: |v, _| alpha(v, GeneralizedAlpha::newmark(v.number("beta")?, v.number("gamma")?)),
        },
        Kind {
            name: "hht",
            summary: "Hilber–Hughes–Taylor, implicit, order 2, dissipates high frequencies",
            source: "Hilber, Hughes & Taylor 1977, doi:10.1002/eqe.4290050306",
            keys: &[
                STEP,
                CONTACT_STEP,
                STABILIZED,
                key(
                    "alpha",
                    Type::Number(Between(0.0, 1.0 / 3.0)),
                    Default::Number(0.05),
                    "α, from 0 (no dissipation) to 1/3 (most)",
                ),
            ],
            example: "integrator={kind='hht', step='1 ms', alpha=0.1}",
            make: |v, _| alpha(v, GeneralizedAlpha::hht(v.number("alpha")?)),
        },
        Kind {
            name: "generalized-alpha",
            summary: "generalized-α, implicit, order 2, dissipates high frequencies",
            source: "Chung & Hulbert 1993, doi:10.1115/1.2900803",
            keys: &[STEP, CONTACT_STEP, STABILIZED, SPECTRAL_RADIUS],
            example: "integrator={kind='generalized-alpha', step='1 ms'}",
            make: |v, _| alpha(v, GeneralizedAlpha::chung_hulbert(v.number("spectral-radius")?)),
        },
        Kind {
            name: "nonsmooth-generalized-alpha",
            summary: "nonsmooth generalized-α, implicit, order 2, 1 across impacts; locates no events",
            source: "Brüls, Acary & Cardona 2014, doi:10.1016/j.cma.2014.07.025; Cosimo et al. 2020, \
                     doi:10.1007/s11044-019-09706-6",
            keys: &[
                STEP,
                SPECTRAL_RADIUS,
                key(
                    "decoupled",
                    Type::Boolean,
                    Default::Boolean(true),
                    "position and velocity are corrected after a smooth step; if false, all is solved at once",
                ),
            ],
            example: "integrator={kind='nonsmooth-generalized-alpha', step='1 ms'}\n\
                      contact=[{obstacle={kind='stop', offset='-1 um'}, law={kind='constraint', restitution=0.5}}]",
            make: |v, _| {
                let spectral_radius = v.number("spectral-radius")?;
                let decoupled = v.boolean("decoupled")?;
                let make = if decoupled { NonsmoothAlpha::decoupled } else { NonsmoothAlpha::coupled };
                nonsmooth(v, make(spectral_radius))
            },
        },
        Kind {
            name: "moreau-jean",
            summary: "Moreau–Jean, nonsmooth, implicit, order 1; locates no events",
            source: "Moreau 1988, doi:10.1007/978-3-7091-2624-0_1; Jean 1999, doi:10.1016/S0045-7825(98)00383-1",
            keys: &[
                STEP,
                key(
                    "theta",
                    Type::Number(Between(0.5, 1.0)),
                    Default::Number(0.5),
                    "θ; above 1/2 it dissipates",
                ),
            ],
            example: "integrator={kind='moreau-jean', step='1 ms'}",
            make: |v, _| nonsmooth(v, MoreauJean::new(v.number("theta")?)),
        },
        Kind {
            name: "runge-kutta-4",
            summary: "classical Runge–Kutta, explicit, order 4",
            source: "Hairer, Nørsett & Wanner 1993, doi:10.1007/978-3-540-78862-1",
            keys: &[STEP, CONTACT_STEP, BAUMGARTE],
            example: "integrator={kind='runge-kutta-4', step='1 us'}",
            make: |v, _| explicit(v, RungeKutta::new(), RungeKutta::with_baumgarte),
        },
        Kind {
            name: "adams-4",
            summary: "Adams–Bashforth–Moulton predictor–corrector, explicit, order 4",
            source: "Hairer, Nørsett & Wanner 1993, doi:10.1007/978-3-540-78862-1",
            keys: &[STEP, CONTACT_STEP, BAUMGARTE],
            example: "integrator={kind='adams-4', step='1 us'}",
            make: |v, _| explicit(v, Adams::new(), Adams::with_baumgarte),
        },
    ],
};
