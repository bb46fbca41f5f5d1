"""What the documentation shows runs as it stands there."""

from __future__ import annotations

import re
import runpy
import warnings
from pathlib import Path

import pytest
from conftest import ROOT

PAGES = [ROOT / "docs/src/tasks/python.md", ROOT / "python/README.md"]
EXAMPLES = sorted((ROOT / "python/examples").glob("*.py"))


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


def test_the_types_of_keys_are_those_of_the_declarations() -> None:
    made = runpy.run_path(str(ROOT / "python/generate/keys.py"))["text"]()
    written = (ROOT / "python/flexion/keys.py").read_text(encoding="utf-8")
    assert written == made, "run `python generate/keys.py` in python/"
