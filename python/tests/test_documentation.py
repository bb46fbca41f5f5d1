"""What the documentation shows runs as it stands there."""

from __future__ import annotations

import ast
import json
import re
import runpy
import warnings
from pathlib import Path

import pytest
from conftest import ROOT

PAGES = [ROOT / "docs/src/tasks/python.md", ROOT / "python/README.md"]
EXAMPLES = sorted((ROOT / "python/examples").glob("*.py"))
NOTEBOOKS = sorted((ROOT / "python/notebooks").glob("*.ipynb"))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_the_code_of_a_page_runs(page: Path) -> None:
    blocks = re.findall(r"^```python\n(.*?)^```", page.read_text(encoding="utf-8"), flags=re.M | re.S)
    assert blocks
    names: dict[str, object] = {}
    for block in blocks:
        exec(compile(block, str(page), "exec"), names)


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda example: example.stem)
def test_an_example_runs(example: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FLEXION_VERIFICATION", str(ROOT / "verification"))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        runpy.run_path(str(example), run_name="__main__")


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda notebook: notebook.stem)
def test_the_cells_of_a_notebook_run_and_show_what_they_end_in(notebook: Path) -> None:
    """As a notebook runs them: in their order, in one name space, and what the last line gives is shown."""
    stated = json.loads(notebook.read_text(encoding="utf-8"))
    assert (stated["nbformat"], stated["nbformat_minor"]) == (4, 5)
    cells = [cell for cell in stated["cells"] if cell["cell_type"] == "code"]
    assert cells and all(not cell["outputs"] and cell["execution_count"] is None for cell in cells)
    names: dict[str, object] = {"__name__": "__main__"}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for cell in cells:
            tree = ast.parse("".join(cell["source"]), str(notebook))
            last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
            exec(compile(tree, str(notebook), "exec"), names)
            if isinstance(last, ast.Expr):
                shown = eval(compile(ast.Expression(last.value), str(notebook), "eval"), names)
                forms = [getattr(shown, form, None) for form in ("_repr_html_", "_repr_svg_")]
                assert shown is None or [form() for form in forms if callable(form)] or repr(shown)


def test_the_types_of_keys_are_those_of_the_declarations() -> None:
    made = runpy.run_path(str(ROOT / "python/generate/keys.py"))["text"]()
    written = (ROOT / "python/flexion/keys.py").read_text(encoding="utf-8")
    assert written == made, "run `python generate/keys.py` in python/"
