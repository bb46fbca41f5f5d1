"""The page that plays a motion, and how a notebook shows it."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import numpy as np

LARGEST = 300_000
"""Most characters of a cell of a notebook, of which the code of the page takes 235,000."""

_BITS = 12
"""Digits of numbers in a cell: a part of 1/4096 of the largest of an array is below what a screen shows."""

_UNPACK = """<!doctype html><meta charset="utf-8"><script>
const bytes = Uint8Array.from(atob("PACKED"), c => c.charCodeAt(0));
const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
new Response(stream).text().then(page => { document.open(); document.write(page); document.close(); });
</script>"""
"""A page that unpacks another: half the size in a notebook."""


class View:
    """A page that plays a motion; a notebook shows it in a frame that can run its script and nothing else.

    In a notebook numbers have three digits, and of long motions there are fewer times: a cell takes at most 300 kB where that is enough
    for 16 of them. A page that is saved has all of them.
    """

    __slots__ = ("html",)

    def __init__(self, html: str) -> None:
        self.html = html
        """The page, which needs no server and no network."""

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Writes the page to a file."""
        path = Path(path)
        path.write_text(self.html, encoding="utf-8")
        return path

    def _repr_html_(self) -> str:
        shown = _frame(self.html)
        every = 1
        while len(shown) > LARGEST and (thinned := _thinned(self.html, every)) is not None:
            shown, every = _frame(thinned), 2 * every
        return shown

    def __repr__(self) -> str:
        return "<flexion.View: show it in a notebook, or save it by .save(path)>"


def _frame(page: str) -> str:
    import base64
    import gzip
    import html

    packed = base64.b64encode(gzip.compress(page.encode(), 9, mtime=0)).decode()
    escaped = html.escape(_UNPACK.replace("PACKED", packed), quote=True)
    return f'<iframe sandbox="allow-scripts" style="width:100%;height:560px;border:0" srcdoc="{escaped}"></iframe>'


def _thinned(page: str, every: int) -> str | None:
    """The page with numbers of fewer digits, and every so many times of its motion; ``None`` where there is nothing to be left out."""
    start = page.index('id="results">') + len('id="results">')
    end = page.index("</script>", start)
    results: dict[str, Any] = json.loads(page[start:end])
    scene, curves = results["scene"], results.get("curves")
    if curves is None or scene["time"]["shape"][0] < 16 * every:
        return None
    times = scene["time"]["shape"][0]
    for name, array in scene.items():
        shape = array["shape"]
        if shape[0] == times and (name == "time" or len(shape) > 1):
            rows = _decoded(array["values"]).reshape(shape)
            # The last one stays.
            kept = np.unique(np.append(np.arange(0, times, every), times - 1))
            array["shape"] = [len(kept), *shape[1:]]
            array["values"] = _encoded(rows[kept], array["values"], name != "time")
    count = len(_decoded(curves["times"]))
    kept = np.unique(np.append(np.arange(0, count, every), count - 1))
    curves["times"] = _encoded(_decoded(curves["times"])[kept], curves["times"], False)
    for column in curves["columns"]:
        column["values"] = _encoded(_decoded(column["values"])[kept], column["values"], True)
    return page[:start] + json.dumps(results).replace("<", "\\u003c") + page[end:]


def _decoded(text: str) -> Any:
    import base64

    kind, _, data = text.partition(":")
    return np.frombuffer(base64.b64decode(data), f"<{kind}")


def _encoded(values: Any, before: str, rounds: bool) -> str:
    import base64

    kind = before.partition(":")[0]
    largest = float(np.max(np.abs(values), initial=0.0, where=np.isfinite(values)))
    if rounds and largest > 0.0:
        # A power of two, so that the digits behind are zeros.
        unit = 2.0 ** (np.ceil(np.log2(largest)) - _BITS)
        values = np.round(values / unit) * unit
    return f"{kind}:{base64.b64encode(np.ascontiguousarray(values, f'<{kind}').tobytes()).decode()}"
