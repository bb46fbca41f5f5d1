"""Modes of vibration, and their diagram over speeds of rotation."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias, overload

import numpy as np

from . import _core as _core_
from ._shown import Shown, html_table, text_table
from ._value import Value

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas

Array: TypeAlias = "npt.NDArray[np.float64]"


@dataclass(frozen=True)
class Mode:
    """A mode of vibration."""

    eigenvalue: complex
    """λ = −ζω ± iω√(1 − ζ²) [1/s]."""
    frequency: Value
    """|λ| [rad/s], with its error by the mesh."""
    damping: float
    """Damping ratio ζ = −Re λ/|λ|."""
    nodes: int
    """Number of nodes of the component that names it."""
    residual: float
    """Residual of the eigenproblem, relative."""
    moves: str
    """What it moves, ``flap 98 %, chord 2 %``."""
    moves_in_section: str
    """The same in the axes of the sections, empty where they are those of the rotation."""

    @property
    def hertz(self) -> Value:
        """Its frequency in Hz."""
        error = self.frequency.error
        return Value(self.frequency / math.tau, None if error is None else error / math.tau, "Hz")

    @classmethod
    def _of(cls, row: _core_._ModeRow) -> Mode:
        eigenvalue, mesh, nodes, residual, moves, in_section = row
        size = abs(eigenvalue)
        damping = -eigenvalue.real / size if size > 0 else 0.0
        return cls(eigenvalue, Value(size, mesh, "rad/s"), damping, nodes, residual, moves, in_section)


class Modes(Shown, Sequence[Mode]):
    """Modes at one speed of rotation, the lowest first."""

    _core: _core_.Modes

    def __init__(self, core: _core_.Modes) -> None:
        self._core = core
        self._modes = tuple(Mode._of(row) for row in core.rows())

    @overload
    def __getitem__(self, index: int) -> Mode: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[Mode]: ...
    def __getitem__(self, index: int | slice) -> Mode | Sequence[Mode]:
        return self._modes[index]

    def __len__(self) -> int:
        return len(self._modes)

    @property
    def frequencies(self) -> Array:
        """Their frequencies [rad/s]."""
        return np.array([float(mode.frequency) for mode in self._modes])

    @property
    def hertz(self) -> Array:
        """Their frequencies [Hz]."""
        return self.frequencies / math.tau

    @property
    def overdamped(self) -> tuple[float, ...]:
        """Decay rates of motions that do not vibrate [1/s]."""
        return tuple(self._core.overdamped())

    @property
    def stations(self) -> Array:
        """Stations of the shapes along the beam [m]."""
        return self._core.stations()

    def shape(self, mode: int) -> npt.NDArray[np.complex128]:
        """Shape of a mode by its place from 0: a row for each station, displacements along the three axes and rotation about the beam."""
        return self._core.shape(range(len(self))[mode])

    @property
    def about(self) -> str:
        """The state that they are of, in words."""
        return self._core.about

    def to_pandas(self) -> pandas.DataFrame:
        """Their table, numbered from 1."""
        import pandas

        rows = [
            {
                "frequency [rad/s]": float(mode.frequency),
                "± [rad/s]": mode.frequency.error,
                "frequency [Hz]": float(mode.hertz),
                "damping": mode.damping,
                "nodes": mode.nodes,
                "moves": mode.moves,
                "in section": mode.moves_in_section,
            }
            for mode in self._modes
        ]
        return pandas.DataFrame(rows, index=pandas.RangeIndex(1, len(rows) + 1, name="mode"))

    def _table(self) -> list[tuple[str, ...]]:
        rows: list[tuple[str, ...]] = [("mode", "rad/s", "Hz", "damping", "nodes", "moves")]
        for number, mode in enumerate(self._modes, 1):
            hertz = mode.hertz
            cells = (str(number), mode.frequency._short(), hertz._short(), f"{mode.damping:.3e}")
            rows.append((*cells, str(mode.nodes), mode.moves))
        return rows

    def __str__(self) -> str:
        return f"{len(self)} modes {self.about}\n\n{text_table(self._table())}"

    def __repr__(self) -> str:
        return f"<flexion.Modes: {len(self)} modes {self.about}>"

    def _repr_html_(self) -> str:
        return html_table(self._table(), repr(self)[1:-1], self.warnings)


@dataclass(frozen=True, eq=False)
class Branch:
    """A mode followed over speeds."""

    name: str
    """What it moves at the first speed: ``flap``, ``chord``, ``torsion`` …"""
    speeds: Array
    """Speeds of rotation at which it was found [rad/s]."""
    modes: tuple[Mode, ...]
    """The mode at each."""

    @property
    def frequencies(self) -> Array:
        """Its frequency at each speed [rad/s]."""
        return np.array([float(mode.frequency) for mode in self.modes])

    @property
    def damping(self) -> Array:
        """Its damping ratio at each speed."""
        return np.array([mode.damping for mode in self.modes])


@dataclass(frozen=True)
class Crossing:
    """A speed at which a frequency is k times the speed of rotation."""

    branch: int
    """The branch, from 0."""
    k: int
    """The number k of the line kΩ."""
    speed: float
    """The speed [rad/s]."""


@dataclass(frozen=True)
class Resonance:
    """A range of speeds in which a frequency is near k times the speed of rotation."""

    branch: int
    """The branch, from 0."""
    k: int
    """The number k of the line kΩ."""
    first: float
    """Its first speed [rad/s]."""
    last: float
    """Its last speed [rad/s]."""


class Diagram(Shown, Sequence[Branch]):
    """A Campbell diagram: branches of modes over speeds of rotation."""

    _core: _core_.Diagram

    def __init__(self, core: _core_.Diagram) -> None:
        self._core = core
        self._branches = tuple(
            Branch(name, np.array([speed for speed, _ in points]), tuple(Mode._of(row) for _, row in points))
            for name, points in core.branches()
        )

    @overload
    def __getitem__(self, index: int) -> Branch: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[Branch]: ...
    def __getitem__(self, index: int | slice) -> Branch | Sequence[Branch]:
        return self._branches[index]

    def __len__(self) -> int:
        return len(self._branches)

    def __iter__(self) -> Iterator[Branch]:
        return iter(self._branches)

    @property
    def speeds(self) -> Array:
        """All speeds, with those that were inserted where a shape changes fast [rad/s]."""
        return self._core.speeds()

    @property
    def crossings(self) -> tuple[Crossing, ...]:
        """Where frequencies cross lines kΩ."""
        return tuple(Crossing(*of) for of in self._core.crossings())

    @property
    def resonances(self) -> tuple[Resonance, ...]:
        """Where frequencies are near lines kΩ."""
        return tuple(Resonance(*of) for of in self._core.resonances())

    @property
    def criticals(self) -> tuple[float, ...]:
        """Critical speeds, at which a motion has no stiffness in the rotating frame, as a forward whirl with its speed [rad/s]."""
        return tuple(self._core.criticals())

    def to_pandas(self) -> pandas.DataFrame:
        """All points: branch from 1, speed, frequency, its error, damping."""
        import pandas

        rows = [
            {
                "branch": number,
                "name": branch.name,
                "speed [rad/s]": float(speed),
                "frequency [rad/s]": float(mode.frequency),
                "± [rad/s]": mode.frequency.error,
                "damping": mode.damping,
            }
            for number, branch in enumerate(self._branches, 1)
            for speed, mode in zip(branch.speeds, branch.modes, strict=True)
        ]
        return pandas.DataFrame(rows)

    def __repr__(self) -> str:
        return f"<flexion.Diagram: {len(self)} modes at {len(self.speeds)} speeds>"

    def _repr_html_(self) -> str:
        return self._core.figure().svg()
