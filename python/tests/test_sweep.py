"""Sweeps: the same rows on threads, in processes, on a cluster, and after being killed."""

from __future__ import annotations

import json
import os
import pickle
import random
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from concurrent.futures import Future, ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import flexion
import numpy as np
import pytest

QUANTITY = "tip.deflection.min"
VARY: dict[str, Any] = {"section.modulus": np.linspace(60e9, 80e9, 8), "model.coupling": ["first", "exact"]}


def assert_same(one: flexion.Sweep, other: flexion.Sweep) -> None:
    """The same rows to the bit, but for the time that they took."""
    assert list(one) == list(other)
    for name in one:
        if name == "wall_time":
            continue
        a, b = one[name], other[name]
        same = a.tolist() == b.tolist() if a.dtype == object else a.tobytes() == b.tobytes()
        assert same, name


@pytest.fixture
def whole(arm: flexion.Case) -> flexion.Sweep:
    return flexion.sweep(arm, VARY, QUANTITY)


def test_rows_are_those_of_single_runs(arm: flexion.Case, whole: flexion.Sweep) -> None:
    assert whole.rows == 16 and whole.failures == 0
    assert whole["model.coupling"].tolist() == ["first", "exact"] * 8
    for row in (0, 5, 15):
        modulus, coupling = float(whole["section.modulus"][row]), str(whole["model.coupling"][row])
        run = (arm | {"section.modulus": modulus, "model.coupling": coupling}).run()
        assert whole[QUANTITY][row] == run["tip.deflection"].min
        assert whole[f"{QUANTITY}.error"][row] == run["tip.deflection"].min.error
        assert whole[f"{QUANTITY}.time"][row] == run["tip.deflection"].min.time
    assert whole.units[QUANTITY] == "m" and whole.units["section.modulus"] == "Pa"
    with pytest.raises(ValueError, match="read-only"):
        whole[QUANTITY][0] = 0.0


def test_texts_of_python_are_texts_of_the_case(arm: flexion.Case, tmp_path: Path) -> None:
    texts = ["1", "true", "", " lead ", "a'b\"c", 'say "hi"', "two\nlines", "back\\slash", "50:60:3", "normal(1,2)", "x]y{", "a, b"]
    short = arm.with_("run.duration", 0.01)
    listed = flexion.sweep(short, {"title": texts}, QUANTITY, errors="none", folder=tmp_path / "kept", part=5)
    assert listed["title"].tolist() == texts and listed.failures == 0
    kept = flexion.sweep(short, {"title": texts}, QUANTITY, errors="none", folder=tmp_path / "kept", part=5)
    assert kept["wall_time"].tolist() == listed["wall_time"].tolist() and kept["title"].tolist() == texts
    table = {"title": texts, "section.modulus": ["60 GPa"] * len(texts)}
    tabled = flexion.sweep(short, table=table, quantities=QUANTITY, errors="none")
    assert tabled["title"].tolist() == texts and set(tabled["section.modulus"]) == {60e9}
    with pytest.raises(flexion.CaseError, match="some values have a unit and others none"):
        flexion.sweep(short, {"section.modulus": ["60 GPa", 7e10]}, QUANTITY)
    with pytest.raises(flexion.CaseError, match="a text is not what this key takes"):
        flexion.sweep(short, {"basis.elements": ["5"]}, QUANTITY)


def test_threads_processes_and_order_change_no_bit(arm: flexion.Case, whole: flexion.Sweep) -> None:
    assert_same(whole, flexion.sweep(arm, VARY, QUANTITY, threads=1))
    assert_same(whole, flexion.sweep(arm, VARY, QUANTITY, threads=3, part=2))
    with ProcessPoolExecutor(2) as pool:
        assert_same(whole, flexion.sweep(arm, VARY, QUANTITY, client=pool, part=3))
    order = list(range(16))
    random.Random(1).shuffle(order)
    table = {name: [whole[name][i].item() if name != "model.coupling" else whole[name][i] for i in order] for name in VARY}
    shuffled = flexion.sweep(arm, table=table, quantities=QUANTITY, errors="each")
    assert shuffled[QUANTITY].tobytes() == whole[QUANTITY][order].tobytes()
    assert shuffled[f"{QUANTITY}.error"].tobytes() == whole[f"{QUANTITY}.error"][order].tobytes()


def test_tables_may_be_frames_dicts_and_files(arm: flexion.Case, tmp_path: Path) -> None:
    pandas = pytest.importorskip("pandas")
    columns = {"section.modulus": [6e10, 7e10], "model.coupling": ["first", "exact"]}
    rows = [{"section.modulus": 6e10, "model.coupling": "first"}, {"section.modulus": 7e10, "model.coupling": "exact"}]
    (tmp_path / "table.csv").write_text("section.modulus,model.coupling\n60 GPa,first\n70 GPa,exact\n")
    tables = [columns, rows, pandas.DataFrame(columns), tmp_path / "table.csv"]
    found = [flexion.sweep(arm, table=table, quantities=QUANTITY)[QUANTITY].tolist() for table in tables]
    assert found[0] == found[1] == found[2] == found[3]
    with pytest.raises(ValueError, match="same keys"):
        flexion.sweep(arm, table=[{"section.modulus": 1}, {"beam.length": 1}], quantities=QUANTITY)


def test_a_sample_is_that_of_its_seed(arm: flexion.Case) -> None:
    vary = {"section.modulus": "normal(70 GPa, 1 GPa)", "beam.length": "9.9 m:10.1 m"}
    drawn = [flexion.sweep(arm, vary, QUANTITY, sample="lhs", runs=16, seed=s, errors="none") for s in (1, 1, 2)]
    assert_same(drawn[0], drawn[1])
    assert drawn[0]["beam.length"].tolist() != drawn[2]["beam.length"].tolist()
    assert np.isnan(drawn[0][f"{QUANTITY}.error"]).all()
    with pytest.raises(ValueError, match="runs"):
        flexion.sweep(arm, vary, QUANTITY, sample="lhs")
    with pytest.raises(ValueError, match="lhs, sobol"):
        flexion.sweep(arm, vary, QUANTITY, sample="grid", runs=3)


def test_what_is_wrong_is_said_before_anything_runs(arm: flexion.Case, tmp_path: Path) -> None:
    folder = tmp_path / "sweep"
    with pytest.raises(flexion.CaseError, match="did you mean `modulus`"):
        flexion.sweep(arm, {"section.modulos": [1, 2]}, QUANTITY, folder=folder)
    with pytest.raises(flexion.CaseError, match="unit"):
        flexion.sweep(arm, {"section.modulus": ["1 m"]}, QUANTITY, folder=folder)
    with pytest.raises(KeyError, match="tip.deflection"):
        flexion.sweep(arm, {"section.modulus": [7e10]}, "tip.deflektion.min", folder=folder)
    with pytest.raises(ValueError, match="finite"):
        flexion.sweep(arm, {"section.modulus": [float("nan")]}, QUANTITY, folder=folder)
    with pytest.raises(flexion.FlexionError):
        flexion.sweep(arm, {}, QUANTITY, folder=folder)
    with pytest.raises(flexion.FlexionError, match="quantity"):
        flexion.sweep(arm, VARY, (), folder=folder)
    with pytest.raises(TypeError, match="executor"):
        flexion.sweep(arm, VARY, QUANTITY, folder=folder, client=3)
    assert not folder.exists()


def test_a_row_that_fails_has_its_reason_and_no_value(arm: flexion.Case) -> None:
    # The zeroth coupling loses its meaning beyond 3.8 rad/s.
    vary = {"model.coupling": ["zeroth", "first"], "hub.motion.speed": [2.0, 4.0]}
    rows = flexion.sweep(arm, vary, QUANTITY, keep_going=True)
    assert rows["status"].tolist() == ["finished", "failed", "finished", "finished"]
    assert "zeroth" in rows["reason"][1] and np.isnan(rows[QUANTITY][1]) and rows["reason"][0] is None
    with pytest.raises(flexion.SweepError, match="tenth") as raised:
        flexion.sweep(arm, vary, QUANTITY)
    assert raised.value.result.failures == 1
    given_up = flexion.sweep(arm, {"section.modulus": [7e10]}, QUANTITY, limit=10, keep_going=True)
    assert given_up["status"].tolist() == ["given-up"]


def test_a_folder_goes_on_and_takes_no_other_sweep(arm: flexion.Case, whole: flexion.Sweep, tmp_path: Path) -> None:
    folder = tmp_path / "sweep"
    stopped = threading.Event()
    stopped.set()
    with pytest.warns(flexion.FlexionWarning, match="stopped"):
        slow = arm.with_("integrator", {"kind": "newmark", "step": 1e-4})
        flexion.sweep(slow, VARY, QUANTITY, folder=tmp_path / "slow", stop=stopped)
    first = flexion.sweep(arm, VARY, QUANTITY, folder=folder, part=2)
    assert_same(first, whole)
    parts = sorted(folder.glob("part-*.parquet"))
    assert len(parts) == 8
    torn = parts[3].read_bytes()
    parts[3].write_bytes(torn[: len(torn) // 2])
    parts[5].unlink()
    before = parts[0].stat().st_mtime_ns
    assert_same(flexion.sweep(arm, VARY, QUANTITY, folder=folder, part=2), whole)
    assert parts[0].stat().st_mtime_ns == before
    for other in (
        {"quantities": "tip.deflection.max"},
        {"errors": "none"},
        {"vary": {"section.modulus": [7e10]}},
        {"case": arm.with_("beam.length", 9)},
    ):
        given: dict[str, Any] = {"case": arm, "vary": VARY, "quantities": QUANTITY, "part": 2, **other}
        with pytest.raises(flexion.SweepError, match="another sweep"):
            flexion.sweep(folder=folder, **given)
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "notes.txt").write_text("mine")
    with pytest.raises(flexion.SweepError, match=r"notes\.txt"):
        flexion.sweep(arm, VARY, QUANTITY, folder=tmp_path / "full")


def test_other_programs_read_the_parts(arm: flexion.Case, whole: flexion.Sweep, tmp_path: Path) -> None:
    polars, duckdb = pytest.importorskip("polars"), pytest.importorskip("duckdb")
    flexion.sweep(arm, VARY, QUANTITY, folder=tmp_path / "sweep", part=4)
    pattern = str(tmp_path / "sweep" / "*.parquet")
    frame = polars.read_parquet(pattern).sort("row")
    assert frame[f"{QUANTITY} [m]"].to_list() == whole[QUANTITY].tolist()
    rows = duckdb.sql(f"SELECT \"{QUANTITY} [m]\" FROM '{pattern}' ORDER BY row").fetchall()
    assert [row[0] for row in rows] == whole[QUANTITY].tolist()


KILLED = """
import flexion, numpy as np, sys
arm = flexion.Case(sys.argv[1])
flexion.sweep(arm, {"section.modulus": np.linspace(60e9, 80e9, 300)}, "tip.deflection.min", errors="none", folder=sys.argv[2], part=5)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="SIGKILL")
def test_a_sweep_that_is_killed_goes_on(arm: flexion.Case, tmp_path: Path) -> None:
    (tmp_path / "arm.toml").write_text(str(arm))
    case, folder = tmp_path / "arm.toml", tmp_path / "sweep"
    vary = {"section.modulus": np.linspace(60e9, 80e9, 300)}
    expected = flexion.sweep(flexion.Case(case), vary, QUANTITY, errors="none")
    moments = random.Random(7)
    for _ in range(5):
        process = subprocess.Popen([sys.executable, "-c", KILLED, str(case), str(folder)])
        kept = len(list(folder.glob("part-*.parquet"))) if folder.exists() else 0
        deadline = time.monotonic() + 30
        while time.monotonic() < deadline and process.poll() is None:
            there = len(list(folder.glob("part-*.parquet"))) if folder.exists() else 0
            if there >= min(kept + moments.randint(1, 8), 58):
                break
            time.sleep(moments.random() * 0.01)
        process.send_signal(signal.SIGKILL)
        process.wait()
    whole = {path.name: path.stat().st_mtime_ns for path in folder.glob("part-*.parquet")}
    assert 0 < len(whole)
    resumed = flexion.sweep(flexion.Case(case), vary, QUANTITY, errors="none", folder=folder, part=5)
    assert_same(expected, resumed)
    assert all((folder / name).stat().st_mtime_ns == stamp for name, stamp in whole.items())


FULL = """
import flexion, numpy as np, resource, sys
arm = flexion.Case(sys.argv[1])
resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[3]), int(sys.argv[3])))
try:
    flexion.sweep(arm, {"section.modulus": np.linspace(60e9, 80e9, 40)}, "tip.deflection.min", errors="none", folder=sys.argv[2], part=5)
except OSError as error:
    print(type(error).__name__, error)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="limits of POSIX")
def test_a_disk_that_is_full_takes_no_part_that_is_there(arm: flexion.Case, tmp_path: Path) -> None:
    (tmp_path / "arm.toml").write_text(str(arm))
    case, folder = flexion.Case(tmp_path / "arm.toml"), tmp_path / "sweep"
    vary = {"section.modulus": np.linspace(60e9, 80e9, 40)}
    expected = flexion.sweep(case, vary, QUANTITY, errors="none", folder=folder, part=5)
    parts = sorted(folder.glob("part-*.parquet"))
    size = max(path.stat().st_size for path in parts)
    tables = [path for path in folder.iterdir() if path.is_file() and path.stat().st_size > size]
    for path in [*parts[3:], *tables]:
        path.unlink()
    stamps = {path: path.stat().st_mtime_ns for path in parts[:3]}
    # No part fits, and then each of them does, but the table of all rows does not.
    for most, there in ((size // 2, 3), (size, 8)):
        words = [sys.executable, "-c", FULL, str(tmp_path / "arm.toml"), str(folder), str(most)]
        done = subprocess.run(words, capture_output=True, text=True, timeout=120)
        assert done.returncode == 0, done.stderr
        if there == 3 or tables:
            assert done.stdout.startswith("OSError") and str(folder) in done.stdout, done.stdout
        assert len(list(folder.glob("part-*.parquet"))) == there
        assert not list(folder.glob(".*.new")) and not [path for path in tables if path.exists()]
        assert all(path.stat().st_mtime_ns == stamp for path, stamp in stamps.items())
    assert_same(flexion.sweep(case, vary, QUANTITY, errors="none", folder=folder, part=5), expected)
    assert all(path.stat().st_mtime_ns == stamp for path, stamp in stamps.items())


class Careless(ThreadPoolExecutor):
    """Loses every other task."""

    count = 0

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        self.count += 1

        def lost() -> None:
            raise OSError("the worker is gone")

        return super().submit(lost if self.count % 2 else fn, *([] if self.count % 2 else args))


def test_tasks_that_are_lost_are_done_again(arm: flexion.Case, whole: flexion.Sweep) -> None:
    with Careless(1) as pool, pytest.warns(flexion.FlexionWarning, match="the client lost 1 of 8 parts 3 times"):
        assert_same(whole, flexion.sweep(arm, VARY, QUANTITY, client=pool, part=2))


class Broken(ThreadPoolExecutor):
    """An executor that takes two parts and breaks then."""

    taken = 0

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        self.taken += 1
        if self.taken > 2:
            raise RuntimeError("no more")
        return super().submit(fn, *args, **kwargs)


def test_what_a_client_that_breaks_has_is_awaited_and_the_rest_computed_here(arm: flexion.Case, whole: flexion.Sweep) -> None:
    with Broken(1) as pool, pytest.warns(flexion.FlexionWarning, match=r"takes no more parts \(RuntimeError: no more\): 6 of 8 are"):
        assert_same(whole, flexion.sweep(arm, VARY, QUANTITY, client=pool, part=2))


def test_too_many_failures_stop_a_sweep_where_a_client_computes_it(arm: flexion.Case) -> None:
    failing = {"section.modulus": [-1.0] * 30 + [7e10] * 30}
    good = arm.with_("run.duration", 0.1)
    table = [{"section.modulus": value, "run.duration": 0.1} for value in (7e10, *failing["section.modulus"])]
    counts = []
    for pool in (None, ThreadPoolExecutor(1)):
        with pytest.raises(flexion.SweepError, match="of the first 20 rows did not finish") as raised:
            flexion.sweep(good, table=table, quantities=QUANTITY, errors="none", part=2, threads=1, client=pool)
        counts.append(raised.value.result.rows)
        assert pickle.loads(pickle.dumps(raised.value)).result.rows == counts[-1]
    # A client may have computed more by then.
    assert counts[0] == 20 <= counts[1] < 61


def test_a_sweep_of_a_client_is_stopped_by_what_is_true_once(arm: flexion.Case) -> None:
    asked = iter([True])
    with ThreadPoolExecutor(1) as pool, pytest.warns(flexion.FlexionWarning, match="stopped by the user"):
        some = flexion.sweep(arm, VARY | {"hub.motion.speed": np.linspace(3, 5, 50)}, QUANTITY, client=pool, part=2, stop=lambda: next(asked, False))
    assert some.rows < 800


def test_inputs_are_values_and_not_their_text_in_a_file(arm: flexion.Case) -> None:
    swept = flexion.sweep(arm.with_("run.duration", 0.1), {"output.energy-balance": [True, False], "title": ["a, b", "c"]}, QUANTITY, errors="none")
    assert swept["output.energy-balance"].tolist() == [True, True, False, False]
    assert swept["title"].tolist() == ["a, b", "c"] * 2


class Closed(ThreadPoolExecutor):
    """A client that has closed, and whose futures have no end."""

    status = "closed"

    def get_executor(self, pure: bool) -> Closed:
        return self

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        return Future()


def refuses(version: str, *rest: Any) -> flexion.Case:
    raise ValueError("the case was pickled by flexion 0.0.1, and this is another")


def test_what_fails_where_a_client_computes_is_raised(arm: flexion.Case, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("flexion._case._unpickled", refuses)
    monkeypatch.setattr("flexion._sweep._made", flexion._sweep._made.__wrapped__)
    with ThreadPoolExecutor(2) as pool, pytest.raises(flexion.SweepError, match=r"failed where .*pickled by flexion 0\.0\.1"):
        flexion.sweep(arm, VARY, QUANTITY, part=4, client=pool)


def test_threads_share_a_folder(arm: flexion.Case, whole: flexion.Sweep, tmp_path: Path) -> None:
    with ThreadPoolExecutor(4) as pool:
        sweeps = [pool.submit(flexion.sweep, arm, VARY, QUANTITY, folder=tmp_path / "one", part=1, threads=2) for _ in range(4)]
        for sweep in sweeps:
            assert_same(whole, sweep.result())
    assert not list((tmp_path / "one").glob(".*"))


def test_futures_without_an_end_of_a_client_that_has_closed_are_not_waited_for(arm: flexion.Case, whole: flexion.Sweep) -> None:
    with Closed(1) as client:
        with pytest.warns(flexion.FlexionWarning, match=r"takes no more parts \(it has closed\): 8 of 8"):
            assert_same(whole, flexion.sweep(arm, VARY, QUANTITY, client=client, part=2))


def test_workers_without_the_folder_send_their_parts(arm: flexion.Case, whole: flexion.Sweep, tmp_path: Path) -> None:
    from flexion import _sweep

    class Elsewhere(ThreadPoolExecutor):
        def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
            packed, part, _, manifest = args
            return super().submit(fn, packed, part, str(tmp_path / "nowhere"), manifest)

    with Elsewhere(2) as pool:
        found = flexion.sweep(arm, VARY, QUANTITY, client=pool, part=2, folder=tmp_path / "sweep")
    assert_same(whole, found)
    plan = _sweep._Plan(arm, ("section.modulus=6e10,7e10",), None, None, (QUANTITY,), "none", None, None)
    assert pickle.loads(pickle.dumps(plan)).made().rows == 2


@pytest.mark.skipif(sys.platform == "win32", reason="SIGKILL")
@pytest.mark.filterwarnings("ignore")
def test_on_dask_a_worker_that_is_killed_loses_no_row(arm: flexion.Case, tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    vary = {"section.modulus": np.linspace(60e9, 80e9, 200)}
    expected = flexion.sweep(arm, vary, QUANTITY, errors="none")
    folder = tmp_path / "sweep"
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as client:
            pids = list(client.run(os.getpid).values())

            def kill() -> None:
                while len(list(folder.glob("part-*.parquet"))) < 5:
                    time.sleep(0.01)
                os.kill(pids[0], signal.SIGKILL)

            threading.Thread(target=kill, daemon=True).start()
            found = flexion.sweep(arm, vary, QUANTITY, errors="none", client=client, folder=folder, part=4)
    assert_same(expected, found)
    assert len(list(folder.glob("part-*.parquet"))) == 50


@pytest.fixture
def dask_processes(tmp_path: Path) -> Iterator[tuple[str, list[subprocess.Popen[bytes]]]]:
    """A scheduler and two workers, each a process: the address, and the processes."""
    pytest.importorskip("distributed")
    file = tmp_path / "scheduler.json"
    command = [sys.executable, "-m", "distributed.cli.dask_scheduler", "--port", "0", "--no-dashboard", "--scheduler-file", str(file)]
    quiet: Any = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    processes = [subprocess.Popen(command, **quiet)]
    try:
        deadline = time.monotonic() + 60
        while not file.exists() and time.monotonic() < deadline:
            time.sleep(0.05)
        worker = [sys.executable, "-m", "distributed.cli.dask_worker", "--scheduler-file", str(file), "--nthreads", "1", "--no-dashboard"]
        processes += [subprocess.Popen([*worker, "--local-directory", str(tmp_path / f"worker{i}")], **quiet) for i in range(2)]
        yield json.loads(file.read_text())["address"], processes
    finally:
        for process in processes:
            process.kill()
            process.wait()


@pytest.mark.skipif(sys.platform == "win32", reason="SIGKILL")
@pytest.mark.filterwarnings("ignore")
def test_a_scheduler_that_is_killed_loses_no_row(
    arm: flexion.Case, tmp_path: Path, dask_processes: tuple[str, list[subprocess.Popen[bytes]]]
) -> None:
    import distributed

    address, (scheduler, first, _) = dask_processes
    vary = {"section.modulus": np.linspace(60e9, 80e9, 200)}
    expected = flexion.sweep(arm, vary, QUANTITY, errors="none")
    folder = tmp_path / "sweep"

    def kill() -> None:
        for count, process in ((3, first), (10, scheduler)):
            while len(list(folder.glob("part-*.parquet"))) < count:
                time.sleep(0.005)
            process.kill()

    # So long a client looks for a scheduler that is gone.
    with distributed.Client(address, timeout="5s") as client:
        client.wait_for_workers(2, timeout=60)
        threading.Thread(target=kill, daemon=True).start()
        found = flexion.sweep(arm, vary, QUANTITY, errors="none", client=client, folder=folder, part=2)
    assert scheduler.wait(10) == -signal.SIGKILL
    assert_same(expected, found)
    assert len(list(folder.glob("part-*.parquet"))) == 100


@pytest.mark.parametrize("given", [b"70 GPa", bytearray(b"7"), [b"70 GPa"]])
def test_bytes_are_no_values(arm: flexion.Case, given: Any) -> None:
    with pytest.raises(TypeError, match="type byte"):
        flexion.sweep(arm, {"section.modulus": given}, quantities=QUANTITY)
