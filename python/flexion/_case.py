"""Cases: what is there, how it moves, and how it is computed."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from . import _core
from ._errors import FlexionWarning, Interrupted, RunError, warn
from ._law import Function, Law, given
from ._linear import Linear, Stiffness
from ._progress import Event, Progress
from ._run import Run
from ._statics import LoadPath
from ._vibration import Diagram, Modes

if TYPE_CHECKING:
    import numpy.typing as npt
    from . import keys

Stop: TypeAlias = Event | Callable[[], bool] | None
"""What ends a computation: an event that is set, or a function that returns true."""


class Case:
    """A case: it does not change; what would change it makes another.

    It is read from a file (or a folder that holds a ``case.toml``), from a TOML text, or from nested dicts of the same keys. Quantities are
    numbers in SI or texts with a unit:

    >>> import flexion
    >>> case = flexion.Case({
    ...     "beam": {"length": "10 m"},
    ...     "section": {"kind": "uniform", "modulus": "70 GPa", "density": 3000, "area": 4e-4, "second-moment": 2e-7},
    ...     "hub": {"motion": {"kind": "spin-up", "speed": "4 rad/s", "time": 15}},
    ...     "run": {"duration": 20},
    ... })
    >>> stiff = case.with_("section.modulus", "140 GPa")
    >>> stiff == case | {"section.modulus": 140e9}
    True

    What is wrong with it is raised at once, as :class:`flexion.CaseError`.
    """

    __slots__ = ("_case",)
    _case: _core.Case

    def __init__(self, source: str | os.PathLike[str] | keys.Case | Mapping[str, Any]) -> None:
        if isinstance(source, Mapping):
            text = _core.Case.toml(source)
            self._case = _core.Case.parse(text, Path("case.toml"))
        elif isinstance(source, str) and ("\n" in source or "=" in source and not os.path.exists(source)):
            self._case = _core.Case.parse(source, Path("case.toml"))
        elif isinstance(source, str | os.PathLike):
            self._case = _core.Case.read(os.fspath(source))
        else:
            kind = type(source).__name__
            raise TypeError(f"a case is a path, a TOML text or nested dicts, and {kind} is none of them")

    @classmethod
    def _of(cls, core: _core.Case) -> Case:
        case = cls.__new__(cls)
        case._case = core
        return case

    # Changes.

    def with_(self, key: str, value: Any) -> Case:
        """The same case with another value at a dotted key; a dict replaces a whole table."""
        return self._of(self._case.changed({key: value}))

    def __or__(self, changes: Mapping[str, Any]) -> Case:
        if not isinstance(changes, Mapping):
            return NotImplemented
        return self._of(self._case.changed(dict(changes)))

    # What it is.

    @property
    def title(self) -> str:
        """Its title."""
        return self._case.title

    @property
    def file(self) -> Path:
        """The file from which it was read, or ``case.toml``."""
        return Path(self._case.file)

    def to_toml(self, *, defaults: bool = False) -> str:
        """The case as TOML in SI: what is written, or with every default."""
        return self._case.resolved() if defaults else self._case.stated()

    def __str__(self) -> str:
        return self.to_toml()

    def __repr__(self) -> str:
        return f"<flexion.Case {self.title or self.file}>"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Case):
            return NotImplemented
        return self._case.means(other._case)

    def __hash__(self) -> int:
        return hash(self._case.shared())

    def __reduce__(self) -> tuple[Any, ...]:
        core = self._case
        return _unpickled, (_core.version(), core.stated(), os.fspath(core.file), core.contents())

    # What it gives.

    def check(self) -> tuple[str, ...]:
        """Builds all that a run needs, and returns what a reader of its results should know.

        Raises :class:`flexion.CaseError` where it cannot be built. What a run alone needs may be missing, as in a case of modes: that is said.
        """
        return tuple(self._case.check())

    def run(
        self,
        *,
        until: float | None = None,
        errors: str = "auto",
        tolerance: float | str | None = None,
        quantity: str | None = None,
        laws: Mapping[str, Law | Function] | None = None,
        name: str | None = None,
        progress: bool | None = None,
        stop: Stop = None,
    ) -> Run:
        """Runs the case.

        ``until`` stops it behind the step that reaches this time [s]. ``errors`` estimates the errors of all columns: ``"off"``,
        ``"auto"`` (where that costs a few times the run) or ``"full"``. ``tolerance`` refines mesh and steps until the error is
        below it, a part of the largest value or a text with a unit, of ``quantity``, ``"tip.deflection.min"``, or of all principal columns.
        ``laws`` are functions that give torques or factors of loads, made by :func:`flexion.law` and :func:`flexion.sampled`: ``"hub.torque"`` is that of a free hub,
        ``"NAME.torque"`` and ``"NAME.thrust"`` those of joints, on top of what the case says of the motor; a law with a load has any other name.
        What they give is in the columns ``law.NAME``. They belong to the run and stand in no file.
        ``name`` stands in legends, by default the title of the case. ``progress`` shows a bar, by default on a terminal and in a notebook. ``stop`` ends
        the run: an event or a function.

        Ctrl-C raises :class:`flexion.Interrupted`, a run that breaks down :class:`flexion.RunError`; both have what was computed as ``.result``.
        """
        if isinstance(until, str):
            raise TypeError(f"`until` is {until!r} and must be a time in seconds, a number")
        if until is not None and not until >= 0.0:
            raise ValueError(f"`until` is {until} and must be a time of at least 0 s")
        bar = Progress(progress, stop)
        asked = None if tolerance is None else str(tolerance)
        try:
            core, raised, by_law = self._case.run(until, errors, asked, quantity, given(laws), bar)
        finally:
            bar.close()
        run = Run(core, name or self.title or self.file.stem)
        if by_law is not None and (isinstance(by_law, KeyboardInterrupt) or not isinstance(by_law, Exception)):
            raised = by_law
        try:
            _raise(raised, run)
            why = run.message or "the run failed" if run.status == "failed" else None
            if by_law is not None:
                why = why or f"a law raised {by_law!r} in a run that estimates the errors"
            elif core.refused is not None and not bar.stopped:
                why = why or core.refused
            if why is None:
                warn(run.warnings)
                return run
            # Where warnings are errors, the run that broke down is the greater one.
            with suppress(FlexionWarning):
                warn(run.warnings)
            raise RunError(why, run) from by_law
        finally:
            # What is raised has a traceback, which holds this frame.
            del raised, by_law

    def modes(self, speed: float | str = 0.0, count: int = 10, *, free_hub: bool = False, unit: str = "rad/s") -> Modes:
        """The modes of small vibrations about the equilibrium in steady rotation at a speed [rad/s], or ``"12 rpm"``.

        The hub keeps its speed, or rotates with the beam where it is free. ``unit`` is that of texts and figures: ``"rad/s"``, ``"Hz"``, or ``"rpm"`` of speeds
        with Hz of frequencies.
        """
        modes = Modes(self._case.modes(_speed(speed), _count(count), free_hub, unit))
        warn(modes.warnings)
        return modes

    def campbell(
        self,
        speeds: Sequence[float | str] | npt.NDArray[np.floating[Any]],
        count: int = 6,
        *,
        free_hub: bool = False,
        revolutions: int = 4,
        margin: float = 5.0,
        threads: int = 0,
        unit: str = "rad/s",
        progress: bool | None = None,
        stop: Stop = None,
    ) -> Diagram:
        """The modes over speeds of rotation [rad/s], or texts with units, ``["0 rpm", "6 rpm"]``, which ascend from at least zero.

        Resonances are speeds at which a frequency is within ``margin`` percent of kΩ, k = 1 … ``revolutions``. ``threads`` is 0 for
        one a processor; the results do not depend on it.
        """
        if not 0 <= revolutions <= 1000:
            raise ValueError(f"`revolutions` is {revolutions} and must be from 0 to 1000")
        if not 0.0 <= margin < 100.0:
            raise ValueError(f"`margin` is {margin} % and must be from 0 to less than 100")
        if isinstance(speeds, str):
            raise TypeError(f"`speeds` is {speeds!r} and must be a list, as numpy.linspace(0, 20, 21) or [\"0 rpm\", \"6 rpm\"]")
        if threads < 0:
            raise ValueError(f"`threads` is {threads} and must be at least 0")
        bar = Progress(progress, stop)
        listed = [_speed(speed) for speed in speeds]
        try:
            core, raised = self._case.campbell(
                listed, _count(count), free_hub, revolutions, margin, threads, unit, bar
            )
        finally:
            bar.close()
        diagram = Diagram(core)
        try:
            _raise(raised, diagram)
        finally:
            del raised
        warn([*diagram.warnings, *core.incomplete])
        return diagram

    def statics(
        self,
        to: float = 1.0,
        *,
        step: float = 0.05,
        points: int = 1000,
        errors: str = "auto",
        progress: bool | None = None,
        stop: Stop = None,
    ) -> LoadPath:
        """The equilibria as the loads grow from zero to ``to`` times those of the case, past limit points.

        ``step`` is the longest step, of displacements over the length of the beam and of the load factor; ``points`` the most equilibria.
        """
        if not 0.0 < to < math.inf:
            raise ValueError(f"`to` is {to} and must be positive and finite")
        if not 0.0 < step < math.inf:
            raise ValueError(f"`step` is {step} and must be positive and finite")
        if not 2 <= points <= 1_000_000:
            raise ValueError(f"`points` is {points} and must be from 2 to 1000000")
        bar = Progress(progress, stop)
        try:
            core, raised = self._case.statics(to, step, points, errors, bar)
        finally:
            bar.close()
        path = LoadPath(core)
        try:
            _raise(raised, path)
        finally:
            del raised
        warn([*path.warnings, *([] if path.end is None else [path.end])])
        return path

    def stiffness_at(self, place: str) -> Stiffness:
        """The stiffness of a place, ``"tip"`` or ``"arm@2 m"``, about the equilibrium at rest under the loads of the case, the hub held.

        In space it is 6 × 6, forces and couples by displacements and rotations; in the plane 3 × 3.
        """
        components, matrix, warnings = self._case.stiffness_at(place)
        warn(warnings)
        return Stiffness(place, tuple(components), matrix, tuple(warnings))

    def linearize(
        self,
        speed: float | str = 0.0,
        *,
        inputs: Mapping[str, Mapping[str, Any] | None] | None = None,
        outputs: Sequence[str] = (),
        free_hub: bool = False,
    ) -> Linear:
        """The equations of small motions about the equilibrium in steady rotation at a speed [rad/s], for control.

        An input is the amplitude of a load, ``inputs={"push": {"on": "tip", "force": [0, 1], "axes": "hub"}}``; ``"hub.torque": None`` is that
        of the hub of a beam with ``free_hub``. Outputs are columns of a run that are functions of the motion.
        """
        if isinstance(outputs, str):
            raise TypeError(f"`outputs` is a list of columns: write [{outputs!r}]")
        given = dict(inputs or {})
        found = self._case.linearize(_speed(speed), free_hub, list(given.items()), list(outputs))
        names, (m, d, g, k, b, j, z), (p, v, a), units, at, warnings = found
        warn(warnings)
        return Linear(
            tuple(names), tuple(given), tuple(outputs), m, d, g, k, b, j, z, p, v, a, tuple(units), np.array(at), tuple(warnings)
        )

    def advise(
        self,
        tolerance: float | str,
        quantity: str | None = None,
        *,
        progress: bool | None = None,
        stop: Stop = None,
    ) -> Advice:
        """The cheapest coupling, basis and integrator with which the case holds a tolerance."""
        bar = Progress(progress, stop)
        try:
            text, raised = self._case.advise(str(tolerance), quantity, bar)
        finally:
            bar.close()
        advice = Advice(self, json.loads(text))
        try:
            _raise(raised, advice)
        finally:
            del raised
        return advice


class Advice:
    """What came of a ladder of models, bases and integrators."""

    def __init__(self, case: Case, stated: dict[str, Any]) -> None:
        self._case = case
        self.stated = stated
        """All of it, as ``advice.json`` states it."""

    @property
    def changes(self) -> tuple[str, ...] | None:
        """What makes the cheapest case that holds of the given one, ``KEY=VALUE``; ``None`` where none holds."""
        cheapest = self.stated["cheapest"]
        return None if cheapest is None else tuple(cheapest["set"])

    def __repr__(self) -> str:
        tried = len(self.stated["tried"])
        cheapest = self.stated["cheapest"]
        if cheapest is None:
            return f"<flexion.Advice: none of {tried} holds>"
        return f"<flexion.Advice: of {tried}, {cheapest['coupling']}, {cheapest['basis']}, {cheapest['integrator']}>"


def _count(count: int) -> int:
    if not 1 <= count <= 1000:
        raise ValueError(f"the number of modes is {count} and must be from 1 to 1000")
    return count


def _speed(given: float | str) -> float:
    return _core.speed(given) if isinstance(given, str) else float(given)


def _raise(raised: BaseException | None, result: Any) -> None:
    try:
        if isinstance(raised, KeyboardInterrupt):
            raise Interrupted("interrupted: `.result` is what was computed", result) from raised
        if raised is not None:
            raise raised
    finally:
        # Its traceback holds this frame.
        del raised


def _unpickled(version: str, text: str, file: str, contents: list[tuple[str, bytes]]) -> Case:
    here = _core.version()
    if version != here:
        raise ValueError(f"the case was pickled by flexion {version}, and this is {here}: their results may differ")
    return Case._of(_core.Case.parse(text, Path(file), contents))
