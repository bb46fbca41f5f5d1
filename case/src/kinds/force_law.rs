//! Force laws: forces per length by the velocity of each place of a beam.

use crate::declaration::Bound::NotNegative;
use crate::fault::Made;
use crate::keys::{keys, quantity};
use crate::kind::{Choice, Kind, Of};
use crate::units::{QUADRATIC_DRAG, VISCOSITY};
use flexion::law::{ForceLaw, LinearDrag, QuadraticDrag};
use std::sync::Arc;

keys! {
    struct Linear {
        /// drag per length and velocity, c
        coefficient: f64 = quantity(&VISCOSITY, NotNegative);
    }

    struct Quadratic {
        /// drag per length and square of the velocity, c
        coefficient: f64 = quantity(&QUADRATIC_DRAG, NotNegative);
    }
}

fn law(law: impl ForceLaw + 'static) -> Made<Arc<dyn ForceLaw>> {
    Ok(Arc::new(law))
}

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
            example: "load=[{on='beam', law={kind='linear-drag', coefficient='0.5 Pa*s'}}]",
            make: &Of(|Linear { coefficient }, _| law(LinearDrag { coefficient })),
        },
        Kind {
            name: "quadratic-drag",
            summary: "drag −c |v| v in a fluid at rest, c = ½ ρ C_D d with its density ρ and the width d of the beam",
            source: "Morison et al. 1950, doi:10.2118/950149-G",
            example: "load=[{on='beam', from='1 m', law={kind='quadratic-drag', coefficient='0.6 kg/m^2'}}]",
            make: &Of(|Quadratic { coefficient }, _| law(QuadraticDrag { coefficient })),
        },
    ],
};
