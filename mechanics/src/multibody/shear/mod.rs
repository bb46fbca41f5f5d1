//! Beams with shear in space: geometrically exact, with symmetric 6 × 6 stiffness, damping and mass.
//!
//! The axis r(s) of the beam carries rigid sections with the axes Λ(s), of which the first need not be its tangent. s is the arc length
//! without stress, and ′ the derivative by it. With the strains (Reissner 1973; Simo 1985, doi 10.1016/0045-7825(85)90050-7)
//!
//! ```text
//! Γ = Λᵀ r′ = (1 + ε, γ₂, γ₃),    κ = axial(ΛᵀΛ′) = (κ₁, κ₂, κ₃)
//! U = ½ ∫ (e − e₀)ᵀ C (e − e₀) ds,   e = (Γ, κ),      T = ½ ∫ (u, Ω)ᵀ M (u, Ω) ds,   u = Λᵀ ṙ
//! ```
//!
//! with any symmetric C and M (see [`Matrices`](crate::section::Matrices)) and the strains e₀ of a curved, twisted and swept beam without stress, of any size
//! of displacement and rotation. Damping adds D ė to the stresses C (e − e₀).
//!
//! **Unknowns.** A node is a frame: position r and unit quaternion p, velocities ṙ in space and Ω in the axes of the section,
//! increments r + d_r and p exp d_φ, as those of a [body](super).
//!
//! **Interpolation.** Positions are interpolated by Lagrange's cubic functions of four nodes. Rotations are interpolated by the rotation
//! vectors of the nodes against one of them, the reference section (Crisfield & Jelenić 1999, doi 10.1098/rspa.1999.0352): the
//! strains are functions of the relative positions and rotations of the four sections, and therefore the same after any rigid
//! motion; they are functions of the present configuration alone, so that the way to it does not matter.
//!
//! **No locking, and order 6.** The strain energy is integrated with three Gauss points: 18 strains, as many as the 24 unknowns of
//! an element have beside the six of a rigid motion. Displacements and rotations of the ends of elements and frequencies
//! converge with h⁶, for every slenderness.
//!
//! **Inertia.** T is integrated by Lobatto's rule, whose points are the nodes. A node is then a rigid section with the mass matrix
//! of its part of the beam, the mass matrix of all is block diagonal, and gyroscopic and centrifugal forces are those of a rigid
//! body. The order of frequencies stays 6.
//!
//! **Range.** Rotations are of any size; strains are as small as C is constant for. The sections of an element turn by less than half a turn against
//! the reference section ([`BeamError::Turned`](super::BeamError::Turned) holds the beam without stress to a quarter). Sections do not warp, and no
//! strain is quadratic in the torsion: a tension does not stiffen torsion, as it does in the [slender beam](super::slender).
//!
//! | file | content |
//! |---|---|
//! | `rotation_map` | rotation, tangent and inverse tangent of a rotation vector, with two derivatives |
//! | `shapes` | nodes, quadrature points, shape functions |
//! | `strain`, `tangent` | strains and forces, and their derivatives |
//! | `inertia` | a section in motion |
//! | `element`, `beam` | all together; a chain and its space of configurations |

mod beam;
mod element;
mod inertia;
mod rotation_map;
mod shapes;
mod strain;
mod tangent;

pub(super) use shapes::lagrange;

pub use beam::Beam;
pub use element::{
    COORDINATES, Element, Motion, NODE_COORDINATES, NODE_VELOCITIES, Sample, Tangent, VELOCITIES,
};
pub use shapes::{NODES, POINTS};
