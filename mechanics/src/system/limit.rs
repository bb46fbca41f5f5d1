//! Where a model ends.

/// What of a state is beyond a model, or breaks a run of it down.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Limit {
    /// A displacement is too large for the coupling.
    #[error(
        "the {field} ({size:.3e} m at x = {station:.3} m) exceeds {bound} m on a beam of {length} m: the {coupling}-order coupling has \
         lost its meaning"
    )]
    Displacement {
        /// Deflection or axial displacement.
        field: &'static str,
        /// Its value \[m\].
        size: f64,
        /// Where \[m\].
        station: f64,
        /// Largest value \[m\].
        bound: f64,
        /// Length of the beam \[m\].
        length: f64,
        /// Name of the coupling.
        coupling: &'static str,
    },
    /// The axial strain exceeds what linear elasticity can mean.
    #[error(
        "the axial strain is {:.1} % at x = {station:.3} m and exceeds the limit of a linear-elastic beam, {:.0} %: the step is likely \
         too large, or the load",
        100.0 * strain,
        100.0 * largest
    )]
    Strain {
        /// Axial strain.
        strain: f64,
        /// Where \[m\].
        station: f64,
        /// Largest value.
        largest: f64,
    },
    /// Foreshortening takes the inertia of a free hub.
    #[error(
        "the {coupling}-order coupling is losing its positive kinetic energy: the effective inertia of the free hub has fallen from \
         {start:.2e} to {left:.2e} kg·m² by the foreshortening; give the hub more inertia, or use the high-order or the exact coupling"
    )]
    HubInertia {
        /// Name of the coupling.
        coupling: &'static str,
        /// Effective inertia at the start \[kg·m²\].
        start: f64,
        /// What is left of it \[kg·m²\].
        left: f64,
    },
    /// The zeroth-order coupling has no stiffness left at this speed.
    #[error(
        "{}the speed of the hub exceeds {critical:.4} rad/s, where the stiffness K − ω²M of the zeroth-order coupling is exhausted \
         (dynamic softening: it leaves out the centrifugal stiffening); use the first-order or the exact coupling",
        from(since)
    )]
    Softened {
        /// Speed at which the stiffness is exhausted \[rad/s\].
        critical: f64,
        /// First time at which a prescribed speed exceeds it \[s\].
        since: Option<f64>,
    },
    /// The centrifugal force outgrows the stiffness of the beam.
    #[error(
        "{}the speed of the hub exceeds {critical:.4} rad/s, where the centrifugal force outgrows the stiffness of the beam, centrifugal \
         stiffening included: a beam of this stiffness has no steady rotation at this speed; check the modulus, the section and the \
         speed, and their units",
        from(since)
    )]
    Overpowered {
        /// Speed at which the stiffness is exhausted \[rad/s\].
        critical: f64,
        /// First time at which a prescribed speed exceeds it \[s\].
        since: Option<f64>,
    },
    /// A beam in space has almost no length left.
    #[error(
        "beam `{beam}` is compressed to {stretch:.3} of its length at node {node}: its axial stiffness is too small for what acts there"
    )]
    Compressed {
        /// Name of the beam.
        beam: String,
        /// Length over that at rest.
        stretch: f64,
        /// Number of the node.
        node: usize,
    },
    /// An element of a beam in space is twisted by more than the angle between its ends can show.
    #[error(
        "beam `{beam}` is twisted by more than half a turn between its stations {from:.4} m and {to:.4} m, which are one element: take \
         more elements, or check the torque or the angle that twists it"
    )]
    Twisted {
        /// Name of the beam.
        beam: String,
        /// Where the element begins \[m\].
        from: f64,
        /// Where it ends \[m\].
        to: f64,
    },
    /// A joint is half a turn away from where it is prescribed to be.
    #[error(
        "joint `{joint}` is half a turn away from its prescribed angle {angle:.4} rad: the step is too large for what the angle changes \
         in it; take a smaller step"
    )]
    HalfTurn {
        /// Name of the joint.
        joint: String,
        /// Prescribed angle \[rad\].
        angle: f64,
    },
    /// A row of a joint that was left out no longer follows from the others.
    #[error(
        "{row} is violated by {violation:.3e} {unit}: it was left out since it followed from the others at the start, and it no longer \
         does. Prescribed motions contradict each other, or the configuration at the start was singular: change them, or begin \
         elsewhere"
    )]
    LeftOut {
        /// Name of the row.
        row: String,
        /// Size of the violation.
        violation: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// A spring has no length, and so no direction.
    #[error("spring `{spring}` has no length left, and its force no direction")]
    SpringWithoutLength {
        /// Name of the spring.
        spring: String,
    },
    /// Rows of joints almost follow from each other.
    #[error(
        "the joints {joints} are close to a singular configuration, in which {row} follows from the others (a part {part:.1e} of it \
         does not): bars that are stretched out or folded flat move on in more than one way or in none; keep a prescribed motion away \
         from there, or give a joint more freedom"
    )]
    Singular {
        /// Names of the joints.
        joints: String,
        /// Name of the row.
        row: String,
        /// Part of it that is independent of the others.
        part: f64,
    },
    /// The forces of rigid contacts may follow from each other.
    #[error(
        "the rigid contacts {} are closed at once, and their forces may follow from each other, as those of four corners of a body do: \
         use a nonsmooth method (Moreau–Jean, nonsmooth generalized-α) where this is none, shorter steps, fewer contacts, or a continuous contact force",
        contacts.join(", ")
    )]
    DependentContacts {
        /// Names of the contacts.
        contacts: Vec<String>,
    },
    /// A law of one's own gives nothing.
    #[error("the law `{name}` {why}")]
    Command {
        /// Its name.
        name: String,
        /// Why, as the rest of the sentence.
        why: String,
    },
    /// What a model of another crate says.
    #[error("{0}")]
    Other(String),
}

fn from(since: &Option<f64>) -> String {
    since.map_or_else(String::new, |t| format!("since t = {t:.3} s "))
}
