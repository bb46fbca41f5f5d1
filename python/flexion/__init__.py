"""Flexion: dynamics of rotating and slender flexible beams.

>>> import flexion
>>> run = flexion.Case("case.toml").run()          # doctest: +SKIP
>>> run["tip.deflection"].min                      # doctest: +SKIP
-0.0115 ± 2e-06 m
"""

import atexit as _atexit
import os as _os
from typing import Any as _Any

from . import _core as _engine
from ._case import Advice, Case
from ._compare import Comparison, Difference, compare, plot
from ._core import schema, version
from ._errors import (
    AnalysisError,
    CaseError,
    FlexionError,
    FlexionWarning,
    InternalError,
    Interrupted,
    Problem,
    RunError,
    SweepError,
)
from ._figure import Figure
from ._law import Law, law, sampled
from ._linear import Linear, Stiffness
from ._run import Column, Event, Run, Trust, load
from ._statics import LoadPath
from ._sweep import Sweep, sweep
from ._value import Value
from ._vibration import Branch, Crossing, Diagram, Mode, Modes, Resonance
from ._view import View

__version__ = version()


def _end() -> None:
    # Threads that Python ends while they compute would end the process with an error.
    import ctypes

    told: set[int] = set()
    for _ in range(10):
        try:
            asked = _engine.end(1.0)
        except KeyboardInterrupt:
            asked = _engine.end(0.0)
        if asked is None:
            return
        for thread in set(asked) - told:
            # A law that does not return, or what is asked whether to stop.
            ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(thread), ctypes.py_object(SystemExit))
        told.update(asked)


_atexit.register(_end)
# The child of a process has the thread alone that forked.
if hasattr(_os, "register_at_fork"):
    _os.register_at_fork(after_in_child=_engine.forked)


def __getattr__(name: str) -> _Any:
    # The names of keys are many, and are not needed to run.
    if name == "keys":
        import importlib

        return importlib.import_module(".keys", __name__)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


__all__ = [
    "Advice",
    "AnalysisError",
    "Branch",
    "Case",
    "CaseError",
    "Column",
    "Comparison",
    "Crossing",
    "Diagram",
    "Difference",
    "Event",
    "Figure",
    "FlexionError",
    "FlexionWarning",
    "InternalError",
    "Interrupted",
    "Law",
    "Linear",
    "LoadPath",
    "Mode",
    "Modes",
    "Problem",
    "Resonance",
    "Run",
    "RunError",
    "Stiffness",
    "Sweep",
    "SweepError",
    "Trust",
    "Value",
    "View",
    "__version__",
    "compare",
    "law",
    "load",
    "plot",
    "sampled",
    "schema",
    "sweep",
]
