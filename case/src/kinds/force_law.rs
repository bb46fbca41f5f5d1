//! Force laws: forces per length by the velocity of each place of a beam.

use crate::declaration::{Bound::*, Presence::*, Type::Quantity, key};
use crate::kind::{Choice, Kind};
use crate::units::{QUADRATIC_DRAG, VISCOSITY};
use flexion::law::{ForceLaw, LinearDrag, QuadraticDrag};
use std::sync::Arc;

/// The kinds of force law.
pub static FORCE_LAW: Choice<Arc<dyn ForceLaw>> = Choice {
    name: "force law",
    path: "load.law",
    summary: "force per length by the motion of the beam",
    kinds: &[
        Kind {
            name: "linear-drag",
            summary: "drag −c v in proportion to the velocity, as of a slow motion in a viscous fluid at rest",
            source: "",
            keys: &[key(
                "coefficient",
                Quantity(&VISCOSITY, NotNegative),
                Required,
                "drag per length and velocity, c",
            )],
            example: "load=[{on='beam', law={kind='linear-drag', coefficient='0.5 Pa*s'}}]",
            make: |v, _| Ok(Arc::new(LinearDrag { coefficient: v.number("coefficient")? })),
        },
        Kind {
            name: "quadratic-drag",
            summary: "drag −c |v| v in a fluid at rest, c = ½ ρ C_D d with its density ρ and the width d of the beam",
            source: "Morison et al. 1950, doi:10.2118/950149-G",
            keys: &[key(
                "coefficient",
                Quantity(&QUADRATIC_DRAG, NotNegative),
                Required,
                "drag per length and square of the velocity, c",
            )],
            example: "load=[{on='beam', from='1 m', law={kind='quadratic-drag', coefficient='0.6 kg/m^2'}}]",
            make: |v, _| Ok(Arc::new(QuadraticDrag { coefficient: v.number("coefficient")? })),
        },
    ],
};
