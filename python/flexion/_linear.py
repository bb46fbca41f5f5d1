"""Small motions for control."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

Array: TypeAlias = "npt.NDArray[np.float64]"


@dataclass(frozen=True, eq=False)
class Linear:
    """The equations of small motions about an equilibrium, M ẍ + (D + G) ẋ + K x = B u, y − y₀ = P x + V ẋ + A ẍ.

    The coordinates x are independent: the motions δq = Z x move no joint, J Z = 0.
    """

    coordinates: Sequence[str]
    """Names of the coordinates, n of them."""
    inputs: Sequence[str]
    """Names of the inputs u, m of them: amplitudes of loads."""
    outputs: Sequence[str]
    """Names of the outputs y, p of them."""
    mass: Array
    """M, n × n."""
    damping: Array
    """D, n × n: symmetric."""
    gyroscopic: Array
    """G, n × n: skew."""
    stiffness: Array
    """K, n × n."""
    input: Array
    """B, n × m."""
    jacobian: Array
    """J of the joints, a row for each of their equations, a column for each velocity of the system."""
    basis: Array
    """Z, a row for each velocity of the system, n columns."""
    by_position: Array
    """P, p × n."""
    by_velocity: Array
    """V, p × n."""
    by_acceleration: Array
    """A, p × n."""
    units: Sequence[str]
    """Units of the outputs."""
    at: Array
    """y₀, the outputs at the equilibrium."""
    warnings: tuple[str, ...]
    """What a reader should know."""

    def state_space(self) -> tuple[Array, Array, Array, Array]:
        """A, B, C, D of ż = A z + B u, y − y₀ = C z + D u, with z = (x, ẋ).

        A mass that is singular, as that of a mesh with spins without inertia, has none: ``numpy.linalg.LinAlgError``.
        """
        n = len(self.coordinates)
        forces = np.hstack([-self.stiffness, -(self.damping + self.gyroscopic), self.input])
        solved = np.linalg.solve(self.mass, forces)
        a = np.vstack([np.hstack([np.zeros((n, n)), np.eye(n)]), solved[:, : 2 * n]])
        b = np.vstack([np.zeros((n, self.input.shape[1])), solved[:, 2 * n :]])
        c = np.hstack([self.by_position, self.by_velocity]) + self.by_acceleration @ solved[:, : 2 * n]
        return a, b, c, self.by_acceleration @ solved[:, 2 * n :]

    def __repr__(self) -> str:
        return (
            f"<flexion.Linear: {len(self.coordinates)} coordinates, inputs {', '.join(self.inputs) or 'none'}, "
            f"outputs {', '.join(self.outputs) or 'none'}>"
        )


@dataclass(frozen=True, eq=False)
class Stiffness:
    """The stiffness of a place, F = K u: forces and couples there by its small displacements and rotations."""

    place: str
    """The place."""
    components: Sequence[str]
    """Names of the components of F: ``force.x`` … ``couple.z``, along and about the axes of space."""
    matrix: Array
    """K [N/m, N, N m]."""
    warnings: tuple[str, ...]
    """What a reader should know."""

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> npt.NDArray[np.float64]:
        return np.array(self.matrix, dtype=dtype)

    def __repr__(self) -> str:
        return f"<flexion.Stiffness of {self.place}: {', '.join(self.components)}>"
