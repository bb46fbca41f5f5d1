//! The integrator of a case: kinds and their keys.

use super::declaration::{
    Bound::*, Key, Kind, Presence as Default, Presence::*, Seam, Type, Type::Quantity, key,
};
use super::units::TIME;
use super::values::Values;

/// The integrator, in SI.
#[derive(Clone, Debug, PartialEq)]
pub enum Integrator {
    /// Radau IIA of order 5 with step control.
    Radau {
        /// Relative tolerance of the local error.
        tolerance: f64,
        /// Absolute tolerance, in scales of the unknowns.
        absolute_tolerance: f64,
        /// First step \[s\]; chosen by the run when `None`.
        initial_step: Option<f64>,
        /// Largest step \[s\]; no limit when `None`.
        max_step: Option<f64>,
    },
    /// Newmark's method with a fixed step.
    Newmark {
        /// Step \[s\].
        step: f64,
        /// β.
        beta: f64,
        /// γ.
        gamma: f64,
    },
    /// The method of Hilber, Hughes and Taylor.
    Hht {
        /// Step \[s\].
        step: f64,
        /// α, from 0 (no dissipation) to 1/3 (most).
        alpha: f64,
    },
    /// The generalized-α method of Chung and Hulbert.
    GeneralizedAlpha {
        /// Step \[s\].
        step: f64,
        /// Spectral radius ρ∞ at high frequency, from 0 (most dissipation) to 1.
        spectral_radius: f64,
    },
    /// The classical explicit method of order 4.
    RungeKutta4 {
        /// Step \[s\].
        step: f64,
    },
    /// Adams–Bashforth–Moulton predictor–corrector of order 4.
    Adams4 {
        /// Step \[s\].
        step: f64,
    },
}

impl Integrator {
    /// The fixed step \[s\]; `None` for step control.
    pub fn step(&self) -> Option<f64> {
        match self {
            Integrator::Radau { .. } => None,
            Integrator::Newmark { step, .. }
            | Integrator::Hht { step, .. }
            | Integrator::GeneralizedAlpha { step, .. }
            | Integrator::RungeKutta4 { step }
            | Integrator::Adams4 { step } => Some(*step),
        }
    }
}

const STEP: Key = key("step", Quantity(&TIME, Positive), Required, "time step");
const TOLERANCE: Type = Type::Number(Between(1e-14, 1e-1));

/// The kinds of integrator.
pub(super) static SEAM: Seam = Seam {
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
            ],
        },
        Kind {
            name: "newmark",
            summary: "Newmark, implicit, order 2 with γ = 1/2",
            source: "Newmark 1959, doi:10.1061/JMCEA3.0000098",
            keys: &[
                STEP,
                key("beta", Type::Number(Between(0.01, 1.0)), Default::Number(0.25), "β, at least γ/2"),
                key(
                    "gamma",
                    Type::Number(Between(0.5, 1.5)),
                    Default::Number(0.5),
                    "γ; above 1/2 it dissipates",
                ),
            ],
        },
        Kind {
            name: "hht",
            summary: "Hilber–Hughes–Taylor, implicit, order 2, dissipates high frequencies",
            source: "Hilber, Hughes & Taylor 1977, doi:10.1002/eqe.4290050306",
            keys: &[
                STEP,
                key(
                    "alpha",
                    Type::Number(Between(0.0, 1.0 / 3.0)),
                    Default::Number(0.05),
                    "α, from 0 (no dissipation) to 1/3 (most)",
                ),
            ],
        },
        Kind {
            name: "generalized-alpha",
            summary: "generalized-α, implicit, order 2, dissipates high frequencies",
            source: "Chung & Hulbert 1993, doi:10.1115/1.2900803",
            keys: &[
                STEP,
                key(
                    "spectral-radius",
                    Type::Number(Between(0.0, 1.0)),
                    Default::Number(0.8),
                    "spectral radius ρ∞ at high frequency, from 0 (most dissipation) to 1 (none)",
                ),
            ],
        },
        Kind {
            name: "runge-kutta-4",
            summary: "classical Runge–Kutta, explicit, order 4",
            source: "Hairer, Nørsett & Wanner 1993, doi:10.1007/978-3-540-78862-1",
            keys: &[STEP],
        },
        Kind {
            name: "adams-4",
            summary: "Adams–Bashforth–Moulton predictor–corrector, explicit, order 4",
            source: "Hairer, Nørsett & Wanner 1993, doi:10.1007/978-3-540-78862-1",
            keys: &[STEP],
        },
    ],
};

/// Reads the integrator.
pub(super) fn read(kind: &Kind, v: &Values) -> Option<Integrator> {
    let step = || v.number("step");
    Some(match kind.name {
        "newmark" => {
            Integrator::Newmark { step: step()?, beta: v.number("beta")?, gamma: v.number("gamma")? }
        }
        "hht" => Integrator::Hht { step: step()?, alpha: v.number("alpha")? },
        "generalized-alpha" => {
            Integrator::GeneralizedAlpha { step: step()?, spectral_radius: v.number("spectral-radius")? }
        }
        "runge-kutta-4" => Integrator::RungeKutta4 { step: step()? },
        "adams-4" => Integrator::Adams4 { step: step()? },
        _ => Integrator::Radau {
            tolerance: v.number("tolerance")?,
            absolute_tolerance: v.number("absolute-tolerance")?,
            initial_step: v.number("initial-step"),
            max_step: v.number("max-step"),
        },
    })
}
