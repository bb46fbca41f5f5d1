"""Laws of one's own: torques, forces and factors of loads that functions of Python give."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeAlias, cast

Given: TypeAlias = (
    "tuple[str, Mapping[str, Any] | None, list[str], list[tuple[str, float, float]], float | None, list[float], Callable[[], _Call]]"
)
_Call: TypeAlias = "Callable[[float, tuple[float, ...]], float | tuple[float, list[float]]]"


class State(dict[str, float]):
    """What a law reads, by the names of columns: positions, velocities, and what follows from them; and its own states by theirs."""

    def __missing__(self, name: str) -> float:
        there = ", ".join(self) or "nothing"
        raise KeyError(f"the law does not read `{name}` but {there}: name it in `reads`")


Function: TypeAlias = Callable[[float, State], "float | tuple[float, Mapping[str, float]]"]
"""What a law is: a function of the time [s] and of what it reads, which gives a number, and beside it the rates of its states if it has some."""


@dataclass(frozen=True)
class Law:
    """A torque, or the factor of a load, that a function gives; made by :func:`law` or :func:`sampled`."""

    make: Callable[[], Function] = field(repr=False)
    """What makes the function of a run."""
    reads: tuple[str, ...] = ()
    """Columns that it reads."""
    load: Mapping[str, Any] | None = None
    """The load whose factor it is."""
    period: float | None = None
    """Interval at which it is asked [s]; ``None`` of one that is asked at any time."""
    breaks: tuple[float, ...] = ()
    """Times at which it jumps or kinks [s]."""
    states: tuple[tuple[str, float, float], ...] = ()
    """Its states: names, values at t = 0, and the sizes by which their errors are measured."""


def law(
    function: Function,
    reads: Sequence[str] = (),
    *,
    load: Mapping[str, Any] | None = None,
    breaks: Sequence[float] = (),
    states: Mapping[str, float] | None = None,
    sizes: Mapping[str, float] | None = None,
) -> Law:
    """A law that is asked at any time: ``function(t, state)``, a function of the time [s] and of the columns that it ``reads``.

    Its memory are its ``states``, names with their values at t = 0, which the method of integration integrates with the motion: it reads them
    in ``state``, and gives ``(value, {name: rate, …})``. They are recorded as ``law.NAME.STATE`` with their errors, which are measured by their
    ``sizes``, 1 where none is given. Other memory it has none: it is called in any order of time, by steps that are refused, iterations and runs for the estimate of errors. That is
    checked by calling it twice. Of accelerations and reactions it reads none, for these follow from what it gives. ``load`` is the load
    whose factor it is, ``{"on": "tip", "force": [0, 1]}``; ``breaks`` are times at which it jumps or kinks.
    """
    if not callable(function):
        raise TypeError(f"a law is a function of the time and of what it reads, and {type(function).__name__} is none")
    starts, measures = dict(states or {}), dict(sizes or {})
    for name in measures:
        if name not in starts:
            there = ", ".join(starts) or "none"
            raise ValueError(f"`sizes` names `{name}`, which is no state of the law: there is {there}")
    of = tuple((str(name), float(start), float(measures.get(name, 1.0))) for name, start in starts.items())
    return Law(lambda: function, _names(reads), load, None, tuple(float(time) for time in breaks), of)


def sampled(
    period: float, make: Callable[[], Function], reads: Sequence[str] = (), *, load: Mapping[str, Any] | None = None
) -> Law:
    """A law that is asked once a ``period`` [s], in order of time from t = 0 on, and held until the next sample.

    It may have a memory. ``make()`` gives the controller, a function of the time [s] and of what it ``reads``, anew for each run: those that
    estimate the errors have controllers of their own.
    """
    if not callable(make):
        raise TypeError(f"a sampled law needs a function that makes its controller, and {type(make).__name__} is none")
    return Law(make, _names(reads), load, float(period))


def _names(reads: Sequence[str]) -> tuple[str, ...]:
    if isinstance(reads, str):
        raise TypeError(f"`reads` is a list of columns: write [{reads!r}]")
    for name in reads:
        if not isinstance(name, str):
            raise TypeError(f"`reads` is a list of columns, and {name!r} is no name of one")
    return tuple(reads)


def _made(of: Law) -> Callable[[], _Call]:
    own = [name for name, _, _ in of.states]
    names = [*of.reads, *own]

    def make() -> _Call:
        function = of.make()
        if not callable(function):
            kind = type(function).__name__
            raise TypeError(f"a sampled law takes a function that makes its controller, and that has made {kind}")

        def call(t: float, values: tuple[float, ...]) -> float | tuple[float, list[float]]:
            result = function(t, State(zip(names, values, strict=True)))
            return _with_rates(result, own) if own else cast(float, result)

        return call

    return make


def _with_rates(result: Any, own: list[str]) -> tuple[float, list[float]]:
    if not (isinstance(result, tuple) and len(result) == 2 and isinstance(result[1], Mapping)):
        raise TypeError(f"a law with states gives (value, {{name: rate}}), with the rates of {', '.join(own)}, and not {result!r}")
    value, rates = result
    if set(rates) != set(own):
        raise ValueError(f"a law gives the rate of each of its states, {', '.join(own)}, and not of {', '.join(rates) or 'none'}")
    return value, [float(rates[name]) for name in own]


def given(laws: Mapping[str, Law | Function] | None) -> list[Given]:
    """The laws as the engine takes them."""
    if laws is not None and not isinstance(laws, Mapping):
        raise TypeError(f"`laws` names laws, {{\"hub.torque\": law}}, and {type(laws).__name__} has no names")
    listed: list[Given] = []
    for name, of in (laws or {}).items():
        of = of if isinstance(of, Law) else law(of)
        listed.append((name, of.load, list(of.reads), list(of.states), of.period, list(of.breaks), _made(of)))
    return listed
