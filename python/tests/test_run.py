"""Runs: the numbers of the program, columns, errors, interruption."""

from __future__ import annotations

import base64
import gc
import gzip
import html
import json
import os
import pickle
import re
import signal
import subprocess
import sys
import threading
import time
import warnings
import weakref
from collections.abc import Callable
from pathlib import Path
from typing import Any

import flexion
import numpy as np
import pytest

TIMES = ("wall_time", "cpu_time", "preparation_wall_time", "preparation_cpu_time")


def without_times(summary: dict[str, object]) -> dict[str, object]:
    return {key: value for key, value in summary.items() if key not in TIMES}


@pytest.mark.parametrize("name", ["p1_spin_up_4", "falling_pendulum", "space_joints"])
def test_the_numbers_are_those_of_the_program(
    name: str, verification: Path, program: list[str], tmp_path: Path
) -> None:
    case = verification / name
    if not case.exists():
        pytest.fail(f"{case} is gone: name another case")
    run = flexion.Case(case).run(errors="off")
    run.save(tmp_path / "package")
    options = ["--error", "off", "--output", str(tmp_path / "program")]
    subprocess.run([*program, "run", str(case), *options], check=True, capture_output=True)
    for theirs in sorted((tmp_path / "program").iterdir()):
        ours = tmp_path / "package" / theirs.name
        if theirs.name == ".flexion-files":
            # It has the hash of the summary, and that has times.
            continue
        if theirs.name == "summary.json":
            stated = [without_times(json.loads(path.read_text())) for path in (ours, theirs)]
            assert stated[0] == stated[1]
        else:
            assert ours.read_bytes() == theirs.read_bytes(), theirs.name
    assert len(list((tmp_path / "package").iterdir())) == len(list((tmp_path / "program").iterdir()))


def test_results_are_freed_without_the_collector_of_garbage(arm: flexion.Case) -> None:
    def interrupt() -> bool:
        raise KeyboardInterrupt

    def fails(t: float, state: object) -> float:
        raise ValueError("no")

    free = arm | {"hub": {"inertia": 5, "motion": {"kind": "free"}}}
    raising: list[Callable[[], Any]] = [
        lambda: free.run(errors="off", laws={"hub.torque": fails}),
        lambda: (arm | {"run.duration": 2000}).run(errors="off", stop=interrupt),
        lambda: arm.campbell([x / 100 for x in range(2000)], stop=interrupt),
    ]
    gc.disable()
    try:
        for ends in raising:
            try:
                ends()
            except (flexion.RunError, flexion.Interrupted) as error:
                left = weakref.ref(error)
            assert left() is None
        for compute in (lambda: arm.run(errors="off"), lambda: arm.modes(count=2), lambda: arm.campbell([0, 1], count=2)):
            result: Any = compute()
            kept = weakref.ref(result)
            del result
            assert kept() is None
    finally:
        gc.enable()


def test_columns_are_arrays_that_outlive_the_run_and_cannot_be_written_to(arm: flexion.Case) -> None:
    run = arm.run(errors="off")
    deflection, times = run["tip.deflection"].data, run.times
    assert np.max(run["tip.deflection"]) == deflection.max()
    least = float(run["tip.deflection"].min)
    assert deflection.dtype == np.float64 and deflection.shape == times.shape == (1001,)
    assert run["tip.deflection"].data is deflection
    with pytest.raises(ValueError, match="read-only"):
        deflection[0] = 1.0
    with pytest.raises(ValueError, match="read-only"):
        times[0] = 1.0
    del run
    gc.collect()
    assert deflection.min() == pytest.approx(least, rel=1e-3)
    assert times[-1] == 20.0


def test_values_have_their_errors_units_and_times(arm: flexion.Case) -> None:
    run = arm.run()
    least = run["tip.deflection"].min
    fine = arm.with_("basis.elements", 40).with_("integrator", {"kind": "radau", "tolerance": 1e-9})
    true = float(fine.run(errors="off")["tip.deflection"].min)
    assert least.error is not None and abs(least - true) <= least.error < 1e-5
    assert least.unit == "m" and least.time == pytest.approx(6.95, abs=0.01)
    assert run.trust.estimated and run.trust.until == 20.0
    assert isinstance(least * 2, float) and f"{least:.3f}" == "-0.400"
    again = pickle.loads(pickle.dumps(least))
    assert (again, again.error, again.unit, again.time) == (least, least.error, "m", least.time)
    off = arm.run(errors="off")
    assert off["tip.deflection"].min.error is None and not off.trust.estimated


def test_a_tolerance_refines_mesh_and_steps(arm: flexion.Case) -> None:
    run = arm.run(tolerance="10 nm", quantity="tip.deflection.min")
    assert run["tip.deflection"].min.error is not None
    assert run["tip.deflection"].min.error <= 1e-8
    assert run.case != arm
    with pytest.raises(ValueError, match="tolerance"):
        arm.run(quantity="tip.deflection.min")
    with pytest.raises(ValueError, match="furlong"):
        arm.run(tolerance="1 furlong", quantity="tip.deflection")
    with pytest.raises(KeyError, match="tip.deflection"):
        arm.run(tolerance=1e-3, quantity="tip.deflektion")
    with pytest.raises(ValueError, match="none of off, auto, full"):
        arm.run(errors="maybe")


def test_a_saved_run_reads_back(arm: flexion.Case, tmp_path: Path) -> None:
    run = arm.run()
    run.save(tmp_path / "run")
    again = flexion.load(tmp_path / "run")
    assert again.times.tolist() == run.times.tolist()
    for name, column in run.items():
        assert again[name].data.tolist() == column.data.tolist(), name
        assert (again[name].unit, again[name].role) == (column.unit, column.role)
        assert (again[name].min, again[name].min.error) == (column.min, column.min.error)
    assert again.case == arm
    with pytest.raises(OSError, match="run"):
        run.save(tmp_path / "run")
    run.save(tmp_path / "run", force=True)
    with pytest.raises(flexion.FlexionError, match="trajectory"):
        flexion.load(tmp_path)


def test_a_file_that_a_run_did_not_write_stays(arm: flexion.Case, tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("mine")
    run = arm.run(errors="off")
    with pytest.raises(OSError, match="not empty|files"):
        run.save(tmp_path)
    run.save(tmp_path, force=True)
    assert (tmp_path / "notes.txt").read_text() == "mine"


def test_events_of_contacts_are_listed(verification: Path, tmp_path: Path) -> None:
    run = flexion.Case(verification / "falling_pendulum").run(errors="off")
    impacts = [event for event in run.events if event.what == "impact"]
    assert len(impacts) == run.summary["events"]["impacts"] > 0
    assert impacts[0].impulse is not None and impacts[0].impulse > 0
    run.save(tmp_path / "run")
    assert flexion.load(tmp_path / "run").events == run.events


def test_frames_and_figures(arm: flexion.Case, tmp_path: Path) -> None:
    pandas, xarray = pytest.importorskip("pandas"), pytest.importorskip("xarray")
    run = arm.run(errors="off")
    frame = run.to_pandas(["tip.deflection", "hub.speed"])
    assert isinstance(frame, pandas.DataFrame) and frame.shape == (1001, 2)
    assert frame.attrs["units"] == {"tip.deflection": "m", "hub.speed": "rad/s"}
    data = run.to_xarray()
    assert isinstance(data, xarray.Dataset) and data["tip.deflection"].attrs["units"] == "m"
    for name, start in (("a.svg", b"<svg"), ("a.png", b"\x89PNG"), ("a.pdf", b"%PDF")):
        assert run.plot("tip.*").save(tmp_path / name).read_bytes().startswith(start)
    with pytest.raises(ValueError, match=r"\.gif"):
        run.plot().save(tmp_path / "a.gif")
    with pytest.raises(KeyError, match="nothing"):
        run.plot("nothing.*")
    assert "<table>" in run._repr_html_() and run.plot()._repr_svg_().startswith("<svg")
    view = run.view()
    assert "<html" in view.html and 'sandbox="allow-scripts"' in view._repr_html_()
    assert len(view._repr_html_()) <= 300_000
    other = arm.with_("model.coupling", "exact").run(errors="off", name="exact one")
    assert other.name == "exact one" and "exact one" in flexion.plot(run, other)._repr_svg_()
    assert flexion.plot(run, other, columns=["tip.deflection"])._repr_svg_().startswith("<svg")
    difference = flexion.compare(run, other)["tip.deflection"]
    assert 0 < difference.relative < 1e-2 and difference.unit == "m"
    assert all(d.max == 0 for d in flexion.compare(run, run).values())


def test_warnings_stand_at_the_line_that_called_and_repeat(verification: Path) -> None:
    case = flexion.Case(verification / "falling_pendulum")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("default")
        for _ in range(2):
            run = case.run(errors="off")
    assert run.warnings
    assert [str(w.message) for w in caught] == list(run.warnings) * 2
    assert all(w.filename == __file__ and w.category is flexion.FlexionWarning for w in caught)


def test_until_and_stop_end_a_run_and_keep_what_it_has(arm: flexion.Case) -> None:
    run = arm.run(until=2.0, errors="off")
    assert run.status == "stopped" and 2.0 <= run.end_time < 3.0
    long = arm.with_("run.duration", 20000).with_("integrator", {"kind": "newmark", "step": 1e-3})
    stop = threading.Event()
    threading.Timer(0.3, stop.set).start()
    began = time.monotonic()
    run = long.run(errors="off", stop=stop)
    assert run.status == "stopped" and 0 < run.end_time < 20000 and len(run.times) > 1
    assert time.monotonic() - began < 10
    run = long.run(errors="off", stop=lambda: True)
    assert run.status == "stopped"

    def raises() -> bool:
        raise RuntimeError("mine")

    with pytest.raises(RuntimeError, match="mine"):
        long.run(errors="off", stop=raises)


INTERRUPTED = """
import flexion, signal, threading, os, time
case = flexion.Case({case!r}).with_("run.duration", 20000).with_("integrator", {{"kind": "newmark", "step": 1e-3}})
before = signal.getsignal(signal.SIGINT)
threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
try:
    case.run(errors="off")
except flexion.Interrupted as interrupted:
    run = interrupted.result
    print("interrupted", run.status, run.end_time > 0, isinstance(interrupted, KeyboardInterrupt))
assert signal.getsignal(signal.SIGINT) is before
"""


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_ctrl_c_ends_a_run_and_keeps_what_it_has(verification: Path) -> None:
    code = INTERRUPTED.format(case=str(verification / "p1_spin_up_4"))
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.stdout.split() == ["interrupted", "stopped", "True", "True"], done.stderr


def test_what_was_stopped_says_why_it_has_no_errors(arm: flexion.Case) -> None:
    assert "stopped" in str(arm.run(until=2.0).trust.reason)
    assert arm.run(errors="off").trust.reason == "no errors were asked for"


def test_arguments_that_mean_nothing_are_refused(arm: flexion.Case) -> None:
    for until in (float("nan"), -1.0):
        with pytest.raises(ValueError, match="until"):
            arm.run(until=until)
    for step in (0.0, -0.1, float("nan")):
        with pytest.raises(ValueError, match="step"):
            arm.statics(step=step)
    with pytest.raises(ValueError, match="points"):
        arm.statics(points=0)
    with pytest.raises(TypeError, match="list of columns"):
        arm.linearize(outputs="tip.deflection")
    for given in ({"seed": 3}, {"runs": 10}):
        with pytest.raises(ValueError, match="sample"):
            flexion.sweep(arm, {"section.modulus": [6e10]}, "tip.deflection.min", **given)


def test_results_say_how_they_are_kept(arm: flexion.Case, tmp_path: Path) -> None:
    run = arm.run(errors="off", until=1.0)
    for result in (run, arm.modes(4.0, 2)):
        with pytest.raises(TypeError, match="save"):
            pickle.dumps(result)
    run.save(tmp_path / "run")
    summary = tmp_path / "run/summary.json"
    text = summary.read_text()
    (tmp_path / "run/.flexion-files").unlink()
    for torn in (text[: len(text) // 2], "", "[]", "3"):
        summary.write_text(torn)
        with pytest.raises(ValueError, match=r"summary\.json"):
            flexion.load(tmp_path / "run")


def test_threads_compute_beside_each_other(arm: flexion.Case) -> None:
    expected = arm.run(errors="off")["tip.deflection"].data.tolist()
    found: list[list[float]] = []
    threads = [
        threading.Thread(target=lambda: found.append(arm.run(errors="off")["tip.deflection"].data.tolist()))
        for _ in range(4)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [expected] * 4


@pytest.mark.skipif(not hasattr(os, "fork"), reason="fork of POSIX")
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_a_fork_computes(arm: flexion.Case) -> None:
    expected = float(arm.run(errors="off")["tip.deflection"].min)
    child = os.fork()
    if child == 0:
        same = float(arm.run(errors="off")["tip.deflection"].min) == expected
        os._exit(0 if same else 1)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="memory of Linux")
def test_cases_that_are_dropped_take_no_memory(arm: flexion.Case) -> None:
    def resident() -> int:
        return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    def make(count: int) -> None:
        for i in range(count):
            arm.with_("section.modulus", 7e10 + i)

    make(2000)
    before = resident()
    make(10000)
    assert resident() - before < 20e6
    for _ in range(20):
        arm.run(errors="off")
    before = resident()
    for _ in range(200):
        arm.run(errors="off")["tip.deflection"].data.sum()
    assert resident() - before < 20e6


def test_import_is_light() -> None:
    code = (
        "import sys, numpy, time; t = time.perf_counter(); import flexion; "
        "print(time.perf_counter() - t, [m for m in ('matplotlib', 'pandas', 'scipy', 'dask', 'xarray', 'IPython') "
        "if m in sys.modules])"
    )
    runs = [subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True) for _ in range(5)]
    seconds, modules = min(run.stdout.split(maxsplit=1) for run in runs)
    assert modules.strip() == "[]"
    # 30 ms on an idle machine; this holds that nothing heavy is imported.
    assert float(seconds) < 0.3


def test_the_package_carries_the_program(tmp_path: Path, verification: Path) -> None:
    code = "from flexion._program import main; main()"

    def program(*words: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run([sys.executable, "-c", code, *words], capture_output=True, text=True)

    assert flexion.__version__ in program("--version").stdout
    assert program("check", str(verification / "p1_spin_up_4")).returncode == 0
    assert program("check", str(tmp_path / "nothing.toml")).returncode == 1
    assert "Exit codes" in program("run", "--help").stdout
    # A process that was started in the background ignores it.
    assert signal.getsignal(signal.SIGINT) in (signal.default_int_handler, signal.SIG_IGN)


def test_the_program_prints_values_for_scripts(program: list[str], verification: Path, tmp_path: Path) -> None:
    case = verification / "p1_spin_up_4"
    words = [*program, "run", str(case), "--output", str(tmp_path / "run")]
    asked = ["--print", "tip.deflection.min,hub.speed.final"]
    printed = subprocess.run([*words, *asked], capture_output=True, text=True, check=True).stdout
    rows = [line.split("\t") for line in printed.splitlines()]
    run = flexion.load(tmp_path / "run")
    least, last = run["tip.deflection"].min, run["hub.speed"].final
    assert [row[0] for row in rows] == ["tip.deflection.min", "hub.speed.final"]
    assert [float(row[1]) for row in rows] == [least, last] and [row[2] for row in rows] == ["m", "rad/s"]
    assert [float(row[3]) for row in rows] == [least.error, last.error]
    assert float(rows[0][4]) == least.time
    refused = subprocess.run([*words, "--force", "--print", "tip.deflektion"], capture_output=True, text=True)
    assert refused.returncode == 1 and "did you mean `tip.deflection`" in refused.stderr


def results_of(page: str) -> dict[str, Any]:
    start = page.index('id="results">') + len('id="results">')
    results: dict[str, Any] = json.loads(page[start : page.index("</script>", start)])
    return results


def values_of(text: str) -> Any:
    kind, _, data = text.partition(":")
    return np.frombuffer(base64.b64decode(data), f"<{kind}")


def test_a_cell_shows_the_motion_of_the_page_to_three_digits(verification: Path) -> None:
    view = flexion.Case(verification / "p1_spin_up_4").run(errors="off").view()
    cell = html.unescape(view._repr_html_())
    packed = re.search(r'atob\("([^"]+)"\)', cell)
    assert packed is not None and len(cell) < 300_000 < len(view.html)
    shown, whole = (results_of(page) for page in (gzip.decompress(base64.b64decode(packed[1])).decode(), view.html))
    assert shown["title"] == whole["title"] and shown["scene"].keys() == whole["scene"].keys()
    times, all_times = (values_of(of["scene"]["time"]["values"]) for of in (shown, whole))
    assert 50 < len(times) < len(all_times) and times[-1] == all_times[-1]
    kept = np.searchsorted(all_times, times)
    a, b = (
        values_of(of["scene"]["beam.displacement"]["values"]).reshape(of["scene"]["beam.displacement"]["shape"])
        for of in (shown, whole)
    )
    assert np.max(np.abs(a - b[kept])) <= np.max(np.abs(b)) / 4096
    curves, all_curves = shown["curves"], whole["curves"]
    kept = np.searchsorted(values_of(all_curves["times"]), values_of(curves["times"]))
    for a, b in zip(curves["columns"], all_curves["columns"], strict=True):
        assert a["name"] == b["name"]
        a, b = values_of(a["values"]), values_of(b["values"])
        assert np.max(np.abs(a - b[kept])) <= np.max(np.abs(b)) / 4096


def test_the_import_loads_nothing_that_only_some_need() -> None:
    code = "import numpy, sys; before = set(sys.modules); import flexion; print(*sorted(set(sys.modules) - before))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=True)
    loaded = {name.partition(".")[0] for name in done.stdout.split()}
    heavy = {"matplotlib", "pandas", "scipy", "dask", "distributed", "xarray", "polars", "duckdb", "IPython", "tqdm"}
    of_python = {"asyncio", "concurrent", "multiprocessing", "tempfile", "logging", "csv", "html", "gzip", "pickle"}
    assert not loaded & heavy and not loaded & of_python, loaded


@pytest.mark.parametrize("name", ["trajectory.csv", "summary.json", "case.resolved.toml"])
def test_a_folder_of_which_a_bit_has_changed_is_not_loaded(arm: flexion.Case, tmp_path: Path, name: str) -> None:
    folder = arm.with_("run.duration", 0.1).run(errors="off").save(tmp_path / "run")
    file = folder / name
    whole = file.read_bytes()
    for at in range(0, len(whole), max(1, len(whole) // 20)):
        line = whole[whole.rfind(b"\n", 0, at) + 1 :].split(b"\n")[0]
        if b"wall_time" in line or b"cpu_time" in line:
            # How long it took is no result.
            continue
        file.write_bytes(whole[:at] + bytes([whole[at] ^ 1]) + whole[at + 1 :])
        with pytest.raises(flexion.AnalysisError, match="not those that were written"):
            flexion.load(folder)
    file.write_bytes(whole)
    flexion.load(folder)
