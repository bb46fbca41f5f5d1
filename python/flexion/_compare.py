"""How far runs are apart."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from . import _core
from ._figure import Figure
from ._run import Run


@dataclass(frozen=True)
class Difference:
    """The difference of one column, at the times of the first run."""

    max: float
    """Largest absolute difference."""
    at: float
    """When it first occurs [s]."""
    rms: float
    """Its root mean square."""
    peak: float
    """Largest absolute value of the first run."""
    relative: float | None
    """Largest difference over the scale of the column; ``None`` of a column that is zero."""
    unit: str
    """Unit of the column."""


class Comparison(Mapping[str, Difference]):
    """Differences of the columns that two runs have in common."""

    def __init__(self, stated: dict[str, Any], figure: _core.Figure) -> None:
        self.stated = stated
        """All of it, as ``compare.json`` states it."""
        self._figure = figure
        self._differences = {
            name: Difference(*(of.get(key) for key in ("max", "time", "rms", "peak", "relative", "unit")))
            for name, of in stated["comparisons"][0]["columns"].items()
        }

    def __getitem__(self, name: str) -> Difference:
        return self._differences[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._differences)

    def __len__(self) -> int:
        return len(self._differences)

    def plot(self) -> Figure:
        """Both runs and their difference."""
        return Figure(self._figure)

    def __repr__(self) -> str:
        worst = max(self._differences.items(), key=lambda item: item[1].relative or 0.0, default=None)
        if worst is None:
            return "<flexion.Comparison: no columns in common>"
        return f"<flexion.Comparison: {len(self)} columns, the largest relative difference {worst[1].relative or 0.0:.3e} of {worst[0]}>"


def _are_runs(given: Iterable[Any]) -> None:
    for run in given:
        if not isinstance(run, Run):
            raise TypeError(f"what is compared are results of Case.run or flexion.load, and {type(run).__name__} is none: give each by itself")


def compare(first: Run, second: Run, *columns: str) -> Comparison:
    """How far the second run is from the first, in columns by patterns, or in all that they have in common."""
    _are_runs((first, second))
    names = [first.name, second.name]
    if names[0] == names[1]:
        names[1] += " (2)"
    text, figure = _core.compare((names[0], first._source), (names[1], second._source), list(columns))
    return Comparison(json.loads(text), figure)


def plot(*runs: Run, columns: tuple[str, ...] | list[str] | str = (), title: str | None = None) -> Figure:
    """Several runs in one figure, in columns by patterns, or in the first principal ones."""
    if not runs:
        raise ValueError("a figure is of at least one run")
    _are_runs(runs)
    columns = [columns] if isinstance(columns, str) else columns
    named: list[tuple[str, _core.Run | _core.Stored]] = []
    for number, run in enumerate(runs, 1):
        taken = any(run.name == name for name, _ in named)
        named.append((f"{run.name} ({number})" if taken else run.name, run._source))
    return Figure(_core.runs_figure(named, list(columns), title))
