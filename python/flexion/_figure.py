"""Figures in the style of the program."""

from __future__ import annotations

import os
from pathlib import Path

from . import _core


class Figure:
    """A figure; a notebook shows it."""

    __slots__ = ("_figure",)

    def __init__(self, figure: _core.Figure) -> None:
        self._figure = figure

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Writes it to a file, ``.svg``, ``.png`` or ``.pdf``."""
        path = Path(path)
        match path.suffix.lower():
            case ".svg":
                path.write_text(self._figure.svg(), encoding="utf-8")
            case ".png":
                path.write_bytes(self._figure.png())
            case ".pdf":
                path.write_bytes(self._figure.pdf())
            case other:
                raise ValueError(f"a figure is .svg, .png or .pdf, not `{other}`")
        return path

    def _repr_svg_(self) -> str:
        return self._figure.svg()

    def __repr__(self) -> str:
        return "<flexion.Figure: show it in a notebook, or save it by .save(path)>"
