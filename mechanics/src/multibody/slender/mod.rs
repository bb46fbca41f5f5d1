//! Slender beams in space: geometrically exact, without shear.
//!
//! The centreline r(s) carries sections whose first axis is its tangent, Λ = [t, n, b] with t = r′/|r′|. s is the arc length
//! without stress, and ′ the derivative by it. The strains are
//!
//! ```text
//! ε = |r′| − 1,    κ = axial(ΛᵀΛ′):  κ₁ = b·n′ (torsion),  κ₂ = −b·r″/|r′|,  κ₃ = n·r″/|r′| (bending)
//! U = ½ ∫ (γ − γ₀)ᵀ C (γ − γ₀) ds,   γ = (ε̄, κ₁, κ₂, κ₃),   ε̄ = ε + ½ K² κ₁²
//! ```
//!
//! with any symmetric C (see [`Properties`]) and the strains γ₀ of a curved and twisted beam without stress, of any size of
//! displacement and rotation.
//!
//! **Tension and torsion.** A fibre at the distance r from the axis is a helix in a section that twists, and longer by ½ r² κ₁² (Wagner
//! 1929; Hodges 1980). ε̄ is the mean of ε + ½ r² κ₁² over the section, K² = (C₂₂ + C₃₃)/C₀₀ the square of its radius of gyration: a tension N adds N K² to
//! the torsional stiffness and untwists a beam that is twisted without stress. Left out is what the deviations of r² from K² cost,
//! ⅛ (∫E r⁴ dA − EA K⁴)(κ₁² − κ₁₀²)² per length, which matters for a thin strip that twists by about its thickness or more over
//! its width, and ½ ∫E r² (z κ₂ − y κ₃) dA (κ₁² − κ₁₀²) of sections without two axes of symmetry.
//!
//! **Unknowns.** r is a cubic Hermite curve by r and r′ at the nodes. An axis n, and with it Λ, is given at the nodes and in the
//! middle of each element: seven velocities a node, ṙ, ṙ′ and the spin w = ω·t, and one a middle. Without the section in the
//! middle the twist is linear in an element and spoils the order of bending with torsion.
//!
//! **The configuration has no history.** q holds the axes n themselves, not angles against reference frames that would have to be
//! kept and renewed: the strain energy is a function of r, r′ and n alone. A load cycle that closes returns, a state is restored
//! from q bit by bit, and there is no singular orientation. The smallest rotation that takes one tangent to another (Bergou
//! et al. 2008, doi 10.1145/1360612.1360662; Meier, Popp & Wall 2014, doi 10.1016/j.cma.2014.05.017) appears in two places: as the
//! chart by which an increment moves n ([`Beam::retract`]), and in the element, between its three sections, where it does not
//! depend on how they came there ([`Pair`]). It commutes with rotations of the whole, and so do the strains: they are objective.
//!
//! **The twist between sections.** The angle φ of a pair of sections varies with their spins and tangents alone, not with n:
//! δφ = δΘ_b − δΘ_a + c·(δt_a + δt_b). Three such angles an element give the torsion as a quadratic polynomial that is exact for
//! a twisted straight bar (the source of `shapes` has the formulas).
//!
//! **No membrane locking.** A cubic curve cannot bend without axial strain. ε̄ is sampled at both nodes and in the middle, and
//! interpolated quadratically: two constraints an element to six new unknowns of the centreline (Meier, Popp & Wall 2015, doi
//! 10.1016/j.cma.2015.02.029). Curvatures are taken at two Gauss points, where the second derivative of a cubic
//! interpolant is best. With three points a ribbon locks that is much stiffer edgewise than flatwise.
//!
//! **Inertia.** ½ ∫ ρA |ṙ|² + ω·J ω ds, J = Λ diag(J₁, J₂, J₃) Λᵀ. J₁ is kept always: without it the spin would have no inertia.
//! J₂ and J₃ may be left out as in the usual theory of slender beams. The forces are Newton's and Euler's, δr·ρA r̈ + δθ·d(Jω)/dt;
//! w is not the rate of a coordinate, so Lagrange's equations would need its commutators.
//!
//! **Errors.** Displacements, rotations and frequencies converge with h⁴. The orientation within an element is found from that of
//! its middle: tangents in an element must not turn by half a turn against it, nor sections twist by as much
//! ([`BeamError::Turned`](super::BeamError::Turned) holds the beam without stress to a quarter).
//!
//! | file | content |
//! |---|---|
//! | `triad` | the axes of a section and their transport |
//! | `pair` | the twist between two sections |
//! | `shapes` | shape functions, interpolation of samples |
//! | `strain`, `stiffness` | strains and forces, and their derivatives, summed alike |
//! | `inertia` | rotation of a section |
//! | `element`, `beam` | both together; a chain and its space of configurations |
//! | `loads` | forces and couples at a section, and what a joint needs of it |

mod beam;
mod element;
mod inertia;
mod loads;
mod pair;
mod properties;
mod shapes;
mod stiffness;
mod strain;
mod triad;

pub(super) use loads::uniform_weights;
pub(super) use shapes::{hermite, sample};
pub(super) use strain::combined;

pub use beam::{Beam, ELEMENT_COORDINATES, ELEMENT_VELOCITIES, Station};
pub use element::{Element, Motion, Sample, Tangent};
pub use loads::{LineWeights, Load, SectionForces};
pub use pair::Pair;
pub use properties::Properties;
pub use strain::{COORDINATES, VELOCITIES};
pub use triad::Triad;
