"""Modes, diagrams, paths and advice."""

from __future__ import annotations

import json
import math
import subprocess
import threading
from pathlib import Path

import flexion
import numpy as np
import pytest
from conftest import ARM


def test_modes_at_rest_are_those_of_the_cantilever(arm: flexion.Case) -> None:
    modes = arm.modes(0.0, 3)
    # βL of a clamped free beam (Blevins 1979, table 8-1).
    stiffness, mass, length = 7e10 * 2e-7, 3000 * 4e-4, 10.0
    exact = [(b / length) ** 2 * math.sqrt(stiffness / mass) for b in (1.87510407, 4.69409113, 7.85475744)]
    for mode, frequency in zip(modes, exact, strict=True):
        assert mode.frequency.error is not None
        # Without rotary inertia; the mesh is the only error.
        assert abs(mode.frequency - frequency) <= max(2 * mode.frequency.error, 1e-6 * frequency)
    assert modes.hertz[0] == pytest.approx(exact[0] / math.tau, rel=1e-5)
    shape = modes.shape(0)
    assert shape.shape == (len(modes.stations), 4) and shape.dtype == np.complex128
    assert np.abs(shape[:, 1]).argmax() == len(modes.stations) - 1
    assert modes[0].nodes == 0 and modes[1].nodes == 1 and modes[-1].nodes == 2
    with pytest.raises(IndexError):
        modes.shape(3)


def test_modes_and_diagrams_are_those_of_the_program(
    verification: Path, program: list[str], tmp_path: Path
) -> None:
    path = verification / "modes_blade_nrel_5mw"
    case = flexion.Case(path)
    case.modes(1.2, 4).save(tmp_path / "ours")
    words = ["modes", str(path), "--speed", "1.2", "--count", "4", "--output", str(tmp_path / "theirs")]
    subprocess.run([*program, *words], check=True, capture_output=True)
    for theirs in (tmp_path / "theirs").iterdir():
        assert (tmp_path / "ours" / theirs.name).read_bytes() == theirs.read_bytes(), theirs.name
    diagram = case.campbell(np.linspace(0, 1.2, 5), 3, unit="rad/s")
    words = ["campbell", str(path), "--speeds", "0:1.2:5", "--modes", "3", "--output", str(tmp_path / "diagram")]
    subprocess.run([*program, *words], check=True, capture_output=True)
    stated = json.loads((tmp_path / "diagram" / "campbell.json").read_text())
    assert len(diagram) == len(stated["modes"])
    diagram.save(tmp_path / "saved")
    assert (tmp_path / "saved" / "campbell.csv").read_bytes() == (tmp_path / "diagram" / "campbell.csv").read_bytes()
    frame = diagram.to_pandas()
    assert set(frame["branch"]) == {1, 2, 3, *range(4, len(diagram) + 1)}


def test_a_diagram_follows_modes_over_speeds(arm: flexion.Case) -> None:
    diagram = arm.campbell([0, 2, 4], 2)
    assert diagram[0].frequencies[0] == pytest.approx(float(arm.modes(0.0, 1)[0].frequency), rel=1e-12)
    assert (np.diff(diagram[0].frequencies) > 0).all()
    assert diagram.plot()._repr_svg_().startswith("<svg")
    for speeds in ([4, 2], [0], [-1, 1], [0, float("nan")], [0, float("inf")], []):
        with pytest.raises(flexion.AnalysisError, match="speeds"):
            arm.campbell(speeds)
    with pytest.raises(ValueError, match="modes"):
        arm.campbell([0, 1], 0)
    with pytest.raises(ValueError, match="unit"):
        arm.campbell([0, 1], unit="deg/s")
    stop = threading.Event()
    stop.set()
    with pytest.warns(flexion.FlexionWarning, match="stopped"):
        arm.with_("basis.elements", 60).campbell(np.linspace(0, 10, 400), stop=stop)


def test_a_request_that_cannot_be_met_says_why(arm: flexion.Case) -> None:
    backwards, forwards = ([float(mode.frequency) for mode in arm.modes(speed)] for speed in (-1.0, 1.0))
    assert backwards == pytest.approx(forwards, rel=1e-9)
    with pytest.raises(flexion.AnalysisError, match="speed"):
        arm.modes(float("nan"))
    with pytest.raises(flexion.AnalysisError, match="free"):
        arm.modes(1.0, free_hub=True)
    with pytest.raises(ValueError, match="from 1 to 1000"):
        arm.modes(1.0, 0)
    with pytest.raises(flexion.AnalysisError, match="no load"):
        arm.with_("hub.motion", {"kind": "constant", "speed": 0}).statics()


def test_numbers_that_no_analysis_takes_are_refused(arm: flexion.Case) -> None:
    for wrong in (0.0, -1.0, math.nan, math.inf):
        with pytest.raises(ValueError, match="must be positive and finite"):
            arm.statics(wrong)
    for revolutions in (-1, 1001):
        with pytest.raises(ValueError, match="`revolutions` is"):
            arm.campbell([0, 1], revolutions=revolutions)
    for margin in (-1.0, 100.0, math.nan):
        with pytest.raises(ValueError, match="`margin` is"):
            arm.campbell([0, 1], margin=margin)
    with pytest.raises(ValueError, match="`threads` is -1"):
        arm.campbell([0, 1], threads=-1)
    with pytest.raises(ValueError, match="`threads` is -1"):
        flexion.sweep(arm, {"beam.length": [1, 2]}, ["tip.deflection.min"], threads=-1)
    with pytest.raises(TypeError, match="must be a list, as"):
        arm.campbell("0:20:5")
    with pytest.raises(TypeError, match="`stop` is 5.0"):
        arm.run(stop=5.0)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="str is none"):
        flexion.compare("a", "b")  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="list has no names"):
        arm.run(laws=[max])  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="must be a time in seconds"):
        arm.run(until="1 s")  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="3 is no name of one"):
        flexion.law(lambda t, y: 0.0, reads=[3])  # type: ignore[list-item]


def test_advice_is_interrupted_by_what_its_stop_raises(arm: flexion.Case) -> None:
    def stop() -> bool:
        raise OSError("no")

    with pytest.raises(OSError, match="no"):
        arm.advise(1e-9, stop=stop)


def test_a_path_of_loads_has_stability_and_errors(arm: flexion.Case, tmp_path: Path) -> None:
    # A clamped beam under a dead end load −P along it, disturbed by P/1000 across: Euler's load π²EI/4L².
    euler = math.pi**2 * 7e10 * 2e-7 / 4 / 10.0**2
    case = arm | {
        "hub": {"motion": {"kind": "constant", "speed": 0}},
        "model.coupling": "exact",
        "load": [{"on": "tip", "force": [-euler, 1e-3 * euler]}],
    }
    path = case.statics(1.2)
    assert path.factors[0] == 0.0 and path.factors[-1] == pytest.approx(1.2)
    deflection = path["tip.deflection"]
    assert abs(deflection[np.searchsorted(path.factors, 0.5)]) < 0.2 < abs(deflection[-1])
    assert path.final("tip.deflection").error is not None
    assert all(path.stable)
    path.save(tmp_path / "path")
    assert (tmp_path / "path" / "statics.csv").is_file()
    with pytest.raises(KeyError, match="tip.deflection"):
        path["nothing"]


def test_advice_is_a_change_of_the_case(arm: flexion.Case) -> None:
    advice = arm.advise(1e-2)
    assert advice.changes is not None
    assert advice.stated["cheapest"]["holds"]


def test_advice_that_cannot_be_given_says_why(arm: flexion.Case) -> None:
    with pytest.raises(KeyError, match="tip.nothing"):
        arm.advise(1e-2, "tip.nothing")
    with pytest.raises(ValueError, match="furlong"):
        arm.advise("1 furlong", "tip.deflection")
    with pytest.raises(flexion.CaseError, match="duration"):
        flexion.Case({k: v for k, v in ARM.items() if k != "run"}).advise(1e-2)


def test_speeds_may_have_units(arm: flexion.Case) -> None:
    assert arm.modes("30 rpm", 2).frequencies == pytest.approx(arm.modes(math.pi, 2).frequencies, rel=1e-12)
    assert arm.campbell(["0 rpm", "30 rpm"], 2).speeds == pytest.approx([0, math.pi], rel=1e-12)
    with pytest.raises(ValueError, match="no speed"):
        arm.modes("30 m")
