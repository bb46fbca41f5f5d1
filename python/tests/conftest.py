"""Cases that the tests share."""

from __future__ import annotations

import os
import signal
import sys
from pathlib import Path
from typing import Any

import flexion
import pytest

# Whoever starts the tests in the background may ignore Ctrl-C, and the processes that they start would inherit that.
signal.signal(signal.SIGINT, signal.default_int_handler)

ROOT = Path(__file__).resolve().parents[2]
"""The repository."""

ARM: dict[str, Any] = {
    "beam": {"length": "10 m"},
    "section": {"kind": "uniform", "modulus": "70 GPa", "density": 3000, "area": 4e-4, "second-moment": 2e-7},
    "hub": {"motion": {"kind": "spin-up", "speed": "4 rad/s", "time": 15}},
    "run": {"duration": 20},
}

FREE: dict[str, Any] = {
    **{key: ARM[key] for key in ("beam", "section")},
    "hub": {"inertia": 50, "motion": {"kind": "free"}},
    "model": {"coupling": "exact"},
    "run": {"duration": 4},
}


@pytest.fixture(autouse=True)
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Tests run outside of the sources, whose folder would hide the package that is built."""
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def arm() -> flexion.Case:
    return flexion.Case(ARM)


@pytest.fixture
def free() -> flexion.Case:
    return flexion.Case(FREE)


@pytest.fixture(scope="session")
def verification() -> Path:
    return ROOT / "verification"


@pytest.fixture(scope="session")
def program() -> list[str]:
    """The program: the one that a variable names, or the one that the package carries."""
    found = os.environ.get("FLEXION_PROGRAM")
    return [found] if found else [sys.executable, "-c", "from flexion._program import main; main()"]
