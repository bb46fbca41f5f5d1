"""One case with many values of some of its keys: on all cores, in processes, or on a cluster."""

from __future__ import annotations

import functools
import os
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np

from . import _core
from ._case import Case, Stop, _raise
from ._errors import SweepError, warn
from ._progress import Progress
from ._shown import html_table

if TYPE_CHECKING:
    from concurrent.futures import Future

    import numpy.typing as npt
    import pandas

Vary = Mapping[str, Any]
"""Of each dotted key its values: a sequence, a range ``"60 GPa:80 GPa:21"``, or a distribution ``"normal(70 GPa, 1 GPa)"``."""

_SHOWN = 20
"""Rows that a notebook shows."""

_TRIES = 3
"""How often a part is given to a cluster that loses it."""


class Executor(Protocol):
    """What computes elsewhere: ``concurrent.futures``, MPI's pool, or what ``get_executor`` of a client of Dask gives."""

    def submit(self, fn: Callable[..., Any], /, *args: Any) -> Future[Any]: ...


class _Plan(NamedTuple):
    """All that the rows of a sweep depend on; it is pickled whole."""

    case: Case
    vary: tuple[str, ...]
    table: tuple[str, str] | None
    sample: tuple[str, int, int] | None
    quantities: tuple[str, ...]
    errors: str
    limit: int | None
    part: int | None

    def made(self) -> _core.Sweep:
        case, vary, table, sample, quantities, errors, limit, part = self
        return _core.Sweep(case._case, list(vary), table, sample, list(quantities), errors, limit, part)


class Sweep(Mapping[str, "npt.NDArray[Any]"]):
    """The rows of a sweep: its columns by name, with or without the unit, as arrays in the order of the rows.

    Beside the inputs and the quantities there are ``status``, ``reason``, ``trusted_until``, ``warnings``, ``steps`` and ``wall_time``; of a
    quantity ``q`` there are ``q.error``, ``q.time`` and ``q.trusted``. A number that is not known is NaN.
    """

    def __init__(self, columns: Iterable[tuple[str, list[Any]]], folder: Path | None) -> None:
        self._columns: dict[str, npt.NDArray[Any]] = {}
        self.units: dict[str, str] = {}
        """Unit of each column, where it has one."""
        for name, values in columns:
            name, _, unit = name.partition(" [")
            self.units[name] = unit.rstrip("]")
            texts = any(isinstance(value, str) for value in values) or name in ("reason", "status", "version")
            truths = any(isinstance(value, bool) for value in values) or name.endswith(".trusted")
            kind = object if texts or truths else int if name in ("row", "warnings", "steps") else float
            self._columns[name] = np.array(values, dtype=kind)
            self._columns[name].flags.writeable = False
        self.folder = folder
        """Where its parts are kept, or ``None``."""

    def __getitem__(self, name: str) -> npt.NDArray[Any]:
        found = self._columns.get(name.partition(" [")[0])
        if found is None:
            raise KeyError(f"the sweep has no column `{name}`: {', '.join(self._columns)}")
        return found

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and name.partition(" [")[0] in self._columns

    def __eq__(self, other: object) -> bool:
        return self is other

    __hash__ = object.__hash__

    def __len__(self) -> int:
        return len(self._columns)

    @property
    def rows(self) -> int:
        """Number of rows."""
        return len(self._columns["row"])

    @property
    def failures(self) -> int:
        """Number of rows that did not finish."""
        return int((self._columns["status"] != "finished").sum())

    def to_pandas(self) -> pandas.DataFrame:
        """The rows as a frame, whose ``attrs["units"]`` are the units."""
        import pandas

        frame = pandas.DataFrame(dict(self._columns)).set_index("row")
        frame.attrs["units"] = self.units
        return frame

    def __repr__(self) -> str:
        failed = f", {self.failures} did not finish" if self.failures else ""
        return f"<flexion.Sweep: {self.rows} rows{failed}, columns {', '.join(self._columns)}>"

    def _repr_html_(self) -> str:
        shown = [name for name in self if not name.endswith((".time", ".trusted")) and name not in ("reason", "version")]
        rows = [shown, *([_cell(self[name][i]) for name in shown] for i in range(min(self.rows, _SHOWN)))]
        more = "" if self.rows <= _SHOWN else f"<div>… {self.rows} rows</div>"
        return html_table(rows) + more


def _cell(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def sweep(
    case: Case,
    vary: Vary | None = None,
    quantities: Sequence[str] | str = (),
    *,
    table: Any = None,
    sample: str | None = None,
    runs: int | None = None,
    seed: int | None = None,
    errors: str = "sample",
    limit: int | None = None,
    keep_going: bool = False,
    folder: str | os.PathLike[str] | None = None,
    part: int | None = None,
    threads: int = 0,
    client: Any = None,
    progress: bool | None = None,
    stop: Stop = None,
) -> Sweep:
    """Runs a case with many values of some of its keys and collects ``quantities``, ``"tip.deflection.min"``, one row a run.

    ``vary`` holds the values of dotted keys, run in all combinations, the last key changing fastest; ``table`` instead a row a run, as a frame, a
    list of dicts, a dict of columns, or the path of a CSV file. With ``sample``, ``"lhs"`` or ``"sobol"``, ``runs`` points of ranges
    ``"9.9 m:10.1 m"`` and distributions are drawn with ``seed``, 0 where none is given.

    ``errors`` are estimated of ``"each"`` row, of a ``"sample"`` of 20, or of ``"none"``. A run of more than ``limit`` steps is given up. More than a tenth
    of failed rows stop the sweep, unless ``keep_going``.

    With a ``folder`` the rows are kept there as Parquet parts of ``part`` rows: the same call goes on with what is missing, however it was ended.
    ``threads`` is 0 for one a processor. ``client``, a client of Dask or any ``concurrent.futures`` executor, computes the parts elsewhere, each with
    one thread. A row has the same bits anywhere.
    """
    asked = (quantities,) if isinstance(quantities, str) else tuple(quantities)
    if sample is None and not (runs is None and seed is None):
        raise ValueError("`runs` and `seed` are of a sample, and there is none: give `sample=`")
    if not isinstance(case, Case):
        raise TypeError(f"a sweep is of a flexion.Case, and {type(case).__name__} is none")
    if threads < 0:
        raise ValueError(f"`threads` is {threads} and must be at least 0")
    drawn = None if sample is None else (sample, _runs(runs), 0 if seed is None else seed)
    written = tuple(f"{key}={_values(values)}" for key, values in (vary or {}).items())
    plan = _Plan(case, written, _table(table), drawn, asked, errors, limit, part)
    made = plan.made()
    bar = Progress(progress, stop)
    import tempfile

    with tempfile.TemporaryDirectory() as scratch:
        place = Path(scratch) / "sweep" if folder is None else Path(folder)
        try:
            if client is not None:
                _elsewhere(plan, made, place, client, keep_going, bar)
            outcome, raised = made.run(place, threads, None, keep_going, bar)
        except KeyboardInterrupt as interrupt:
            raised, outcome = interrupt, None
        finally:
            bar.close()
        result = Sweep(made.columns(place), None if folder is None else place)
    try:
        _raise(raised, result)
    finally:
        # Its traceback holds this frame.
        del raised
    assert outcome is not None
    _, _, failures, _, _, why = outcome
    if why is not None and why.startswith("stopped"):
        warn([why])
    elif why is not None:
        raise SweepError(why, result)
    elif failures:
        warn([f"{failures} of {result.rows} rows did not finish: look at their `reason`"])
    return result


def _runs(runs: int | None) -> int:
    if runs is None:
        raise ValueError("a sample needs its number of runs, `runs=`")
    return runs


def _values(values: Any) -> str:
    """Values as the program takes them."""
    if isinstance(values, str):
        return values
    listed = values.tolist() if isinstance(values, np.ndarray) else values
    if not isinstance(listed, Iterable) or isinstance(listed, Mapping | bytes | bytearray):
        listed = [listed]
    return ",".join(_core.item(value) for value in listed)


def _table(table: Any) -> tuple[str, str] | None:
    """A table as the text of a CSV file, with its name."""
    if table is None:
        return None
    if isinstance(table, str | os.PathLike):
        return os.fspath(table), Path(table).read_text(encoding="utf-8")
    if hasattr(table, "to_dict") and hasattr(table, "columns"):
        table = {str(name): _listed(table[name]) for name in table.columns}
    if isinstance(table, Mapping):
        names = [str(name) for name in table]
        rows = list(zip(*table.values(), strict=True))
    else:
        listed = [dict(row) for row in table]
        names = list(listed[0]) if listed else []
        if any(list(row) != names for row in listed):
            raise ValueError("the rows of a table have the same keys in the same order")
        rows = [tuple(row.values()) for row in listed]
    import csv
    import io

    text = io.StringIO()
    writer = csv.writer(text)
    writer.writerow(names)
    writer.writerows([_core.item(value) for value in row] for row in rows)
    return "table", text.getvalue()


def _listed(column: Any) -> list[Any]:
    """The values of a column of pandas or of polars."""
    listed: list[Any] = column.to_list() if hasattr(column, "to_list") else column.tolist()
    return listed


# Elsewhere.


class _Computed(NamedTuple):
    """A part: its file where the folder is not there, its rows, and those that failed."""

    files: list[tuple[str, bytes]]
    rows: int
    failures: int


@functools.lru_cache(maxsize=4)
def _made(packed: bytes) -> _core.Sweep:
    import pickle

    plan: _Plan = pickle.loads(packed)
    return plan.made()


def _compute(packed: bytes, part: int, folder: str, manifest: bytes) -> _Computed | str:
    """Computes a part where it is called: into the folder, where that is the same there, or else as what is given back; or why it cannot."""
    import tempfile

    try:
        made = _made(packed)
        stated = Path(folder) / "sweep.json"
        if stated.is_file() and stated.read_bytes() == manifest:
            (_, rows, failures, *_), _ = made.run(folder, 1, part, True, None)
            return _Computed([], rows, failures)
        with tempfile.TemporaryDirectory() as scratch:
            (_, rows, failures, *_), _ = made.run(scratch, 1, part, True, None)
            files = [(path.name, path.read_bytes()) for path in Path(scratch).glob("part-*.parquet")]
            return _Computed(files, rows, failures)
    except Exception as error:
        return f"{type(error).__name__}: {error}"


def _elsewhere(plan: _Plan, made: _core.Sweep, folder: Path, client: Any, keep_going: bool, bar: Progress) -> None:
    """Gives the parts that a folder lacks to an executor. What it loses too often is left for whoever called."""
    import pickle

    executor: Executor = client.get_executor(pure=False) if hasattr(client, "get_executor") else client
    if not hasattr(executor, "submit"):
        raise TypeError(f"a client is one of Dask or an executor, and {type(client).__name__} is neither")
    made.open(folder)
    packed, where = pickle.dumps(plan), str(folder.resolve())
    manifest = (folder / "sweep.json").read_bytes()
    kept = set(made.kept_parts(folder))
    missing = [part for part in range(made.parts) if part not in kept]
    done = len(kept)
    from concurrent.futures import FIRST_COMPLETED, CancelledError, wait

    waiting: dict[Future[Any], tuple[int, int]] = {}
    lost: list[int] = []
    why = ""
    broken: str | None = None
    rows = failures = 0

    def submit(part: int, tries: int) -> None:
        nonlocal broken
        try:
            if broken is None:
                waiting[executor.submit(_compute, packed, part, where, manifest)] = (part, tries)
        except Exception as error:
            # An executor that is broken, or whose scheduler is gone, takes no more: what it has may still end, the rest is computed here.
            broken = f"{type(error).__name__}: {error}"

    try:
        for part in missing:
            submit(part, 1)
        while waiting:
            ended, _ = wait(waiting, timeout=0.2, return_when=FIRST_COMPLETED)
            for future in ended:
                part, tries = waiting.pop(future)
                try:
                    found = future.result()
                except (Exception, CancelledError) as error:
                    if tries < _TRIES:
                        submit(part, tries + 1)
                    else:
                        lost.append(part)
                        why = f"{type(error).__name__}: {error}"
                    continue
                if isinstance(found, str):
                    raise SweepError(f"part {part} of {made.parts} failed where the client computes it: {found}")
                for name, data in found.files:
                    _write(folder / name, data)
                done += 1
                rows, failures = rows + found.rows, failures + found.failures
            if bar(done / made.parts, f"{done} of {made.parts} parts"):
                return
            # Whether it stops is judged in the order of the rows, of what is there.
            if ended and not keep_going and failures > rows / 10 and made.fails(folder):
                return
            # Dask leaves futures of a client that has lost its scheduler without an end.
            if getattr(client, "status", None) in ("closing", "closed"):
                broken = broken or "it has closed"
                break
        if broken is not None:
            warn([f"the client takes no more parts ({broken}): {made.parts - done} of {made.parts} are computed here"])
            return
        if lost:
            warn([f"the client lost {len(lost)} of {made.parts} parts {_TRIES} times, which are computed here; the last by {why}"])
    finally:
        for future in waiting:
            # Of a client whose scheduler is gone nothing can be taken back.
            with suppress(Exception):
                future.cancel()


def _write(path: Path, data: bytes) -> None:
    """Writes a file whole or not at all."""
    new = path.with_name(f".{path.name}-{os.getpid()}-{threading.get_ident()}.new")
    new.write_bytes(data)
    os.replace(new, path)
