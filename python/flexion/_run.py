"""Runs: columns, values with errors, events."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn, TypeAlias

import numpy as np

from . import _core
from ._figure import Figure
from ._shown import html_table, text_table
from ._value import Value
from ._view import View

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas
    import xarray

    from ._case import Case

Array: TypeAlias = "npt.NDArray[np.float64]"


class _Results:
    """What a run and its columns share; a column that held the run would keep both until the next collection of garbage."""

    def __init__(self, source: _core.Run | _core.Stored, summary: dict[str, Any] | None) -> None:
        self.source = source
        if summary is not None:
            self.summary = summary

    @cached_property
    def summary(self) -> dict[str, Any]:
        assert isinstance(self.source, _core.Run)
        stated: dict[str, Any] = json.loads(self.source.summary())
        return stated

    @cached_property
    def ended(self) -> tuple[str, str | None, Sequence[str]]:
        if isinstance(self.source, _core.Run):
            return self.source.ended()
        return str(self.summary["status"]), self.summary["message"], self.summary.get("warnings", ())


class Column:
    """A recorded quantity: its values at the times of the run, and its smallest, largest and last value with their errors."""

    __slots__ = ("_data", "_index", "_of", "kind", "name", "role", "unit")

    name: str
    """Its name, ``tip.deflection``."""
    unit: str
    """Its unit in SI, empty for a number."""
    role: str
    """What it is for: ``primary``, ``secondary``, ``detail``, ``energy``, ``work``, ``imbalance`` or ``integration``."""
    kind: str
    """What its values are: ``real`` numbers, an ``angle``, a part of a ``quaternion``."""

    def __init__(self, of: _Results, index: int, described: tuple[str, str, str, str]) -> None:
        self.name, self.unit, self.role, self.kind = described
        self._of, self._index = of, index
        self._data: Array | None = None

    @property
    def data(self) -> Array:
        """Its values, one at each of ``run.times``; the array cannot be written to and outlives the run."""
        if self._data is None:
            self._data = self._of.source.column(self._index)
        return self._data

    @property
    def min(self) -> Value:
        """Its smallest value, over all steps, with its time and error."""
        return self._value("min")

    @property
    def max(self) -> Value:
        """Its largest value, over all steps, with its time and error."""
        return self._value("max")

    @property
    def final(self) -> Value:
        """Its last value with its error."""
        return self._value("final")

    def _value(self, part: str) -> Value:
        summary = self._of.summary
        stated = summary["columns"][self.name]
        value = stated[part]
        time = float(summary["end_time"]) if part == "final" else stated[f"t_{part}"]
        error = (stated.get("error") or {}).get(part)
        model = (stated.get("error") or {}).get("model")
        return Value(np.nan if value is None else value, error, self.unit, time, model)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> npt.NDArray[Any]:
        if dtype is None and not copy:
            return self.data
        return np.array(self.data, dtype=dtype)

    def __array_function__(self, function: Any, _types: Any, args: Any, keywords: Any) -> Any:
        # numpy.max asks for a method `max`, which is a value here.
        plain = [np.asarray(of) if isinstance(of, Column) else of for of in args]
        return function(*plain, **keywords)

    def __len__(self) -> int:
        return len(self.data)

    def __getitem__(self, index: Any) -> Any:
        return self.data[index]

    def __repr__(self) -> str:
        unit = f" [{self.unit}]" if self.unit else ""
        return f"<{self.name}{unit}: min {self.min}, max {self.max}, final {self.final}>"


@dataclass(frozen=True)
class Event:
    """What happened at a contact."""

    time: float
    """Time [s]."""
    contact: str
    """Name of the contact."""
    what: str
    """``impact``, ``closes``, ``opens``, ``slips``, ``sticks`` …"""
    impulse: float | None
    """Normal impulse [N s]."""
    friction: float | None
    """Impulse of friction [N s]."""
    closing_speed: float | None
    """Speed of approach before it [m/s]."""
    effective_mass: float | None
    """Effective mass of the impact [kg]."""
    energy_lost: float | None
    """Energy lost [J]."""
    duration: float | None
    """Duration of a contact by continuous forces [s]."""
    largest_force: float | None
    """Largest force [N]."""
    largest_indentation: float | None
    """Largest indentation [m]."""
    place: tuple[float, float, float] | None
    """Where it happened [m]."""


@dataclass(frozen=True)
class Trust:
    """What the estimate of errors says of a run as a whole."""

    estimated: bool
    """Whether errors were estimated."""
    reason: str | None
    """Why not, where they were not."""
    until: float | None
    """Time up to which errors of the principal columns stay below a tenth of their largest values [s]."""


class Run(Mapping[str, Column]):
    """A run: its columns by name, ``run["tip.deflection"].min``."""

    _source: _core.Run | _core.Stored

    def __init__(
        self,
        source: _core.Run | _core.Stored,
        name: str,
        stored: tuple[Path, dict[str, Any]] | None = None,
    ) -> None:
        self._source = source
        self._folder = None if stored is None else stored[0]
        self._results = _Results(source, None if stored is None else stored[1])
        self.name = name
        """Its name in legends, which may be changed."""
        described = source.described()
        self._columns = {of[0]: Column(self._results, i, of) for i, of in enumerate(described)}

    def __getitem__(self, name: str) -> Column:
        try:
            return self._columns[name]
        except KeyError:
            import difflib

            near = difflib.get_close_matches(str(name), self._columns, n=3, cutoff=0.4)
            there = f"; near are {', '.join(near)}" if near else f": {', '.join(self._columns)}"
            raise KeyError(f"the run has no column `{name}`{there}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    __hash__ = object.__hash__

    def __reduce__(self) -> NoReturn:
        raise TypeError("a run is not pickled: `save` it into a folder, and `flexion.load` that")

    def __eq__(self, other: object) -> bool:
        return self is other

    @cached_property
    def times(self) -> Array:
        """Recorded times [s]."""
        return self._source.times()

    @property
    def columns(self) -> Mapping[str, Column]:
        """The columns by name."""
        return self

    @property
    def summary(self) -> dict[str, Any]:
        """What ``summary.json`` states."""
        return self._results.summary

    @property
    def status(self) -> str:
        """``finished``, ``stopped`` or ``failed``."""
        return self._results.ended[0]

    @property
    def message(self) -> str | None:
        """Why it ended early, where it did."""
        return self._results.ended[1]

    @property
    def end_time(self) -> float:
        """Time reached [s]."""
        return float(self.summary["end_time"])

    @property
    def warnings(self) -> tuple[str, ...]:
        """What a reader should know of it."""
        return tuple(self._results.ended[2])

    @property
    def trust(self) -> Trust:
        """What the estimate of errors says of it as a whole."""
        of = self.summary.get("trust")
        if of is None and self.status == "stopped":
            return Trust(False, "the run was stopped, and errors are estimated of a whole run", None)
        if of is None and self.status == "failed":
            return Trust(False, "the run failed, and errors are estimated of a whole run", None)
        if of is None:
            return Trust(False, "no errors were asked for", None)
        return Trust(bool(of["estimated"]), of["reason"], of["until"])

    @property
    def case(self) -> Case:
        """Its case, refined where a tolerance was asked."""
        from ._case import Case

        if isinstance(self._source, _core.Run):
            return Case._of(self._source.case())
        assert self._folder is not None
        return Case(self._folder / "case.resolved.toml")

    @cached_property
    def events(self) -> tuple[Event, ...]:
        """What happened at its contacts."""
        if isinstance(self._source, _core.Run):
            listed = self._source.events()
            return tuple(
                Event(time, contact, what, *_eight(numbers), None if place is None else (place[0], place[1], place[2]))
                for time, contact, what, numbers, place in listed
            )
        assert self._folder is not None
        return _events(self._folder / "events.csv")

    def save(self, folder: str | os.PathLike[str], *, force: bool = False) -> Path:
        """Writes the files that the program writes into a folder, which is whole then, or absent.

        ``force`` replaces what a run wrote there before.
        """
        if not isinstance(self._source, _core.Run):
            raise ValueError(f"the run was read from {self._folder}, where its files are")
        self._source.save(folder, force)
        return Path(folder)

    def _chosen(self, columns: Sequence[str] | None) -> list[Column]:
        names = [columns] if isinstance(columns, str) else columns
        return [self[name] for name in (names if names is not None else self)]

    def to_pandas(self, columns: Sequence[str] | None = None) -> pandas.DataFrame:
        """The columns as a frame over the times [s], whose ``attrs["units"]`` are their units."""
        import pandas

        chosen = self._chosen(columns)
        index = pandas.Index(self.times, name="time")
        frame = pandas.DataFrame({column.name: column.data for column in chosen}, index=index)
        frame.attrs["units"] = {column.name: column.unit for column in chosen}
        return frame

    def to_xarray(self, columns: Sequence[str] | None = None) -> xarray.Dataset:
        """The columns as a data set over the times [s], each with its unit."""
        import xarray

        chosen = self._chosen(columns)
        data = {column.name: ("time", column.data, {"units": column.unit}) for column in chosen}
        coordinates = {"time": ("time", self.times, {"units": "s"})}
        return xarray.Dataset(data, coords=coordinates, attrs={"title": self.name})

    def plot(self, *columns: str, title: str | None = None) -> Figure:
        """The figure that the program draws, or one of columns by patterns: ``run.plot("tip.*")``."""
        if not columns and title is None and isinstance(self._source, _core.Run):
            return Figure(self._source.figure())
        return Figure(_core.runs_figure([(self.name, self._source)], list(columns), title))

    def view(self, *columns: str) -> View:
        """The motion, to be played in a notebook or saved as a page."""
        if isinstance(self._source, _core.Run):
            return View(self._source.page(list(columns)))
        assert self._folder is not None
        return View(_core.view(self._folder, list(columns)))

    def _principal(self) -> list[Column]:
        return [column for column in self._columns.values() if column.role in ("primary", "secondary")]

    def __repr__(self) -> str:
        head = f"<flexion.Run {self.name}: {self.status} at t = {self.end_time:g} s, {len(self)} columns"
        return f"{head}, {len(self.times)} times>"

    def _table(self) -> list[tuple[str, ...]]:
        rows: list[tuple[str, ...]] = [("", "unit", "min", "at t [s]", "max", "at t [s]", "last")]
        for column in self._principal():
            least, most = column.min, column.max
            ends = (least._short(), _time(least), most._short(), _time(most), column.final._short())
            rows.append((column.name, column.unit or "1", *ends))
        return rows

    def __str__(self) -> str:
        return f"{repr(self)[1:-1]}\n\n{text_table(self._table())}"

    def _repr_html_(self) -> str:
        return html_table(self._table(), repr(self)[1:-1], self.warnings)


def _time(value: Value) -> str:
    return "" if value.time is None else f"{value.time:.4f}"


def _events(path: Path) -> tuple[Event, ...]:
    import csv

    if not path.is_file():
        return ()
    with path.open(newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))[1:]
    found = []
    for time, contact, what, *rest in rows:
        numbers = [float(text) if text else None for text in rest]
        x, y, z = numbers[8:11]
        place = None if x is None or y is None or z is None else (x, y, z)
        found.append(Event(float(time), contact, what, *_eight(numbers), place))
    return tuple(found)


_Number: TypeAlias = float | None


def _eight(
    numbers: list[_Number],
) -> tuple[_Number, _Number, _Number, _Number, _Number, _Number, _Number, _Number]:
    a, b, c, d, e, f, g, h = numbers[:8]
    return a, b, c, d, e, f, g, h


def load(folder: str | os.PathLike[str]) -> Run:
    """A run from the folder that the program or ``Run.save`` wrote."""
    path = Path(folder)
    stored = _core.Stored(path)
    summary = path / "summary.json"
    if not summary.is_file():
        raise FileNotFoundError(f"{path} holds no summary.json: give the folder of a run")
    try:
        stated = json.loads(summary.read_text(encoding="utf-8"))
    except ValueError as error:
        raise ValueError(f"{summary} cannot be read ({error}): it is torn or was changed; run the case again") from error
    texts = isinstance(stated, dict) and isinstance(stated.get("warnings"), list)
    if not texts or any(key not in stated for key in ("columns", "status", "message", "end_time")):
        raise ValueError(f"{summary} is not the summary of a run: it was changed, or is that of another analysis")
    run = Run(stored, path.resolve().name, (path, stated))
    if stored.caution is not None:
        from ._errors import warn

        warn([stored.caution])
    return run
