"""Equilibria as loads grow."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from . import _core as _core_
from ._shown import Shown
from ._value import Value

if TYPE_CHECKING:
    import numpy.typing as npt

Array: TypeAlias = "npt.NDArray[np.float64]"


class LoadPath(Shown, Mapping[str, Array]):
    """Equilibria in their order along the path; its columns by name."""

    _core: _core_.LoadPath

    def __init__(self, core: _core_.LoadPath) -> None:
        self._core = core
        self._described = core.described()
        self._points = core.points()
        self._index = {name: i for i, (name, *_) in enumerate(self._described)}

    def __getitem__(self, name: str) -> Array:
        if name not in self._index:
            raise KeyError(f"the path has no column `{name}`: {', '.join(self._index)}")
        return self._core.column(self._index[name])

    def __iter__(self) -> Iterator[str]:
        return iter(self._index)

    def __len__(self) -> int:
        return len(self._index)

    @cached_property
    def factors(self) -> Array:
        """Load factors."""
        return np.array([point[0] for point in self._points])

    @property
    def stability(self) -> tuple[str, ...]:
        """Of each equilibrium: ``stable``, or in how many directions it is left."""
        return tuple(point[2] for point in self._points)

    @property
    def stable(self) -> tuple[bool | None, ...]:
        """Whether each is stable; ``None`` where that was not found."""
        return tuple(point[3] for point in self._points)

    @property
    def critical(self) -> tuple[tuple[str, Value], ...]:
        """Critical states, limit points, branchings and flutter, with their load factors."""
        return tuple(
            (what, Value(factor, None if error is None else error[0]))
            for factor, what, _, _, error in self._points
            if what is not None
        )

    def final(self, name: str) -> Value:
        """The last value of a column with its error."""
        index = self._index[name]
        values = self[name]
        error = self._points[-1][4] if self._points else None
        value = float(values[-1]) if len(values) else float("nan")
        return Value(value, None if error is None else error[1][index], self._described[index][1])

    @property
    def end(self) -> str | None:
        """Why the path ends early, where it does."""
        return self._core.end

    def __repr__(self) -> str:
        last = self.factors[-1] if len(self.factors) else float("nan")
        return f"<flexion.LoadPath: {len(self.factors)} equilibria up to the load factor {last:g}>"
