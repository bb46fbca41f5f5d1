"""What results have in common: tables, warnings, a figure, files."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NoReturn, Protocol

from . import _core
from ._figure import Figure

Row = Sequence[str]


def text_table(rows: Sequence[Row]) -> str:
    """Rows of cells below each other."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return "\n".join("  ".join(map(str.ljust, row, widths)).rstrip() for row in rows)


def html_table(rows: Sequence[Row], title: str = "", warnings: Iterable[str] = ()) -> str:
    """The same for a notebook, the first row as a head, with a title above and warnings below."""

    import html

    def line(row: Row, cell: str) -> str:
        return "<tr>" + "".join(f"<{cell}>{html.escape(of)}</{cell}>" for of in row) + "</tr>"

    above = f"<div>{html.escape(title)}</div>" if title else ""
    below = "".join(f"<div><b>Warning:</b> {html.escape(text)}</div>" for text in warnings)
    head, *body = rows
    return f"{above}<table>{line(head, 'th')}{''.join(line(row, 'td') for row in body)}</table>{below}"


class _Core(Protocol):
    @property
    def warnings(self) -> list[str]: ...
    def figure(self) -> _core.Figure: ...
    def save(self, path: str | os.PathLike[str], force: bool) -> None: ...


class Shown:
    """A result of an analysis, with its warnings, its figure and its files."""

    _core: _Core

    def __reduce__(self) -> NoReturn:
        raise TypeError(f"{type(self).__name__} is not pickled: take its arrays, or `save` it into a folder")

    @property
    def warnings(self) -> tuple[str, ...]:
        """What a reader should know of it."""
        return tuple(self._core.warnings)

    def plot(self) -> Figure:
        """The figure that the program draws."""
        return Figure(self._core.figure())

    def save(self, folder: str | os.PathLike[str], *, force: bool = False) -> Path:
        """Writes the files that the program writes into a folder, which is whole then, or absent."""
        self._core.save(folder, force)
        return Path(folder)
