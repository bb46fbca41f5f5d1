"""How far a computation is, on a terminal or in a notebook."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any, Protocol

_FIRST = 0.5
"""Seconds after which a bar appears: most runs end before."""
_WIDTH = 30


class Event(Protocol):
    """What says whether to stop, as ``threading.Event`` does."""

    def is_set(self) -> bool: ...


class Progress:
    """Shows a bar while a computation goes on, and asks whether it is to stop."""

    def __init__(self, show: bool | None, stop: Event | Callable[[], bool] | None) -> None:
        if not (stop is None or callable(stop) or hasattr(stop, "is_set")):
            raise TypeError(f"`stop` is {stop!r} and must be an event, or a function that says whether to stop")
        self._asked = stop
        self.stopped = False
        """Whether it has been asked to stop."""
        self._began = time.monotonic()
        self._drawn = False
        self._handle: Any = None
        self._notebook = show is not False and _in_notebook()
        asked = _on_terminal() if show is None else show
        self._show = self._notebook or asked and sys.stderr is not None

    def __call__(self, part: float, text: str) -> bool:
        """Whether the computation is to stop."""
        if self._show and time.monotonic() - self._began > _FIRST:
            self._draw(min(max(part, 0.0), 1.0), text)
        if self._asked is not None and not self.stopped:
            self.stopped = self._asked.is_set() if hasattr(self._asked, "is_set") else bool(self._asked())
        return self.stopped

    def _draw(self, part: float, text: str) -> None:
        done = round(part * _WIDTH)
        line = f"{'█' * done}{'░' * (_WIDTH - done)} {100 * part:3.0f} %  {text}"
        self._drawn = True
        if not self._notebook:
            sys.stderr.write(f"\r\x1b[2K{line}")
            sys.stderr.flush()
            return
        from IPython.display import display  # type: ignore[import-not-found]

        data = {"text/plain": line}
        if self._handle is None:
            self._handle = display(data, raw=True, display_id=True)
        else:
            self._handle.update(data, raw=True)

    def close(self) -> None:
        """Takes the bar away."""
        if not self._drawn:
            return
        if self._handle is not None:
            self._handle.update({"text/plain": ""}, raw=True)
        elif not self._notebook:
            sys.stderr.write("\r\x1b[2K")
            sys.stderr.flush()


def _on_terminal() -> bool:
    return sys.stderr is not None and sys.stderr.isatty()


def _in_notebook() -> bool:
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    return shell is not None and shell.__class__.__name__ == "ZMQInteractiveShell"
