"""Exceptions and warnings of the package."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ._run import Run


@dataclass(frozen=True)
class Problem:
    """One thing that is wrong with a case."""

    message: str
    """What is wrong, in one sentence."""
    key: str
    """Dotted path of the key, empty where it belongs to none."""
    source: str
    """The file or text in which it was written."""
    line: int | None
    """Its line, from 1."""
    column: int | None
    """Its column, from 1."""
    help: tuple[str, ...]
    """What to do about it."""


class FlexionError(Exception):
    """Base class of the errors of this package."""


class CaseError(FlexionError, ValueError):
    """A case that is rejected; its text is the report of the program."""

    problems: tuple[Problem, ...]
    """Everything that is wrong with it."""

    def __init__(self, report: str, problems: tuple[Problem, ...] = ()) -> None:
        super().__init__(report)
        self.problems = problems

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.problems)


class RunError(FlexionError):
    """A run that broke down, or that could not be refined to what was asked."""

    result: Run | None
    """What it computed until then."""

    def __init__(self, message: str, result: Run | None = None) -> None:
        super().__init__(message)
        self.result = result

    def __reduce__(self) -> tuple[Any, ...]:
        # A run is not pickled.
        return type(self), (str(self),)


class AnalysisError(FlexionError):
    """An analysis without result: no modes, no diagram, no advice, no equilibrium."""


class SweepError(FlexionError):
    """A sweep that is refused, or that stopped because more than a tenth of its rows failed."""

    result: Any
    """The rows that are kept, where there are any."""

    def __init__(self, message: str, result: Any = None) -> None:
        super().__init__(message)
        self.result = result

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.result)


class InternalError(FlexionError, RuntimeError):
    """A fault of the program, which no case should reach: please report it."""


class Interrupted(KeyboardInterrupt):
    """Ctrl-C during a computation."""

    result: Any
    """What was computed until then: a run, a diagram or a path, or ``None``."""

    def __init__(self, message: str = "interrupted", result: Any = None) -> None:
        super().__init__(message)
        self.result = result

    def __reduce__(self) -> tuple[Any, ...]:
        # Most results are not pickled.
        return type(self), (str(self),)


class FlexionWarning(UserWarning):
    """What a reader of a result should know of it."""


def case_error(
    report: str, problems: list[tuple[str, str, str, int | None, int | None, list[str]]]
) -> CaseError:
    """The exception of everything that is wrong with a case."""
    return CaseError(
        report.rstrip(), tuple(Problem(*of[:5], help=tuple(of[5])) for of in problems)
    )


def warn(messages: Iterable[str]) -> None:
    """Warns at the line that called the package, each time: Python shows a warning once a line otherwise."""
    frame = sys._getframe(1)
    package = __name__.partition(".")[0]
    while frame.f_back is not None and frame.f_globals.get("__name__", "").partition(".")[0] == package:
        frame = frame.f_back
    for message in messages:
        warnings.warn_explicit(
            message,
            FlexionWarning,
            frame.f_code.co_filename,
            frame.f_lineno,
            module=frame.f_globals.get("__name__", "flexion"),
            registry={},
        )
