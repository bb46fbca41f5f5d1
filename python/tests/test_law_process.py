"""Laws of Python and their processes: what is left behind, interrupts, forks, and the end of the interpreter."""

from __future__ import annotations

import gc
import os
import signal
import subprocess
import sys
import time
import weakref
from pathlib import Path
from typing import Any

import flexion
import pytest
from flexion._law import State


def test_nothing_of_a_law_is_left_behind(free: flexion.Case) -> None:
    short = free.with_("run.duration", 0.2)
    kept: list[weakref.ref[Any]] = []

    class Controller:
        def __call__(self, t: float, state: State) -> float:
            if len(kept) > 4 and t > 0.1:
                raise ValueError("late")
            return 1.0

    def make() -> Controller:
        controller = Controller()
        kept.append(weakref.ref(controller))
        return controller

    short.run(laws={"hub.torque": flexion.sampled(0.01, make)})
    try:
        short.run(laws={"hub.torque": flexion.sampled(0.01, make)})
        short.run(laws={"hub.torque": flexion.sampled(0.01, make)})
    except flexion.RunError:
        pass
    gc.collect()
    assert len(kept) >= 3 and all(controller() is None for controller in kept)


HANGS = """
import flexion, os, signal, sys, threading, time
case = flexion.Case(sys.argv[1]) | {"hub": {"inertia": 5, "motion": {"kind": "free"}}}
def hangs(t, state):
    while t > 1.0:
        pass
    return 1.0
threading.Timer(1.0, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
try:
    case.run(errors="off", progress=False, laws={"hub.torque": hangs})
except flexion.Interrupted as error:
    print("interrupted", error.result.end_time <= 1.1, flush=True)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_ctrl_c_ends_a_law_that_never_returns(verification: Path) -> None:
    words = [sys.executable, "-c", HANGS, str(verification / "p1_spin_up_4")]
    done = subprocess.run(words, capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stdout.strip()) == (0, "interrupted True"), done.stderr


FORKS = """
import os, sys, flexion
case = flexion.Case(sys.argv[1]) | {"hub": {"inertia": 5, "motion": {"kind": "free"}}, "run.duration": 1}
laws = {"hub.torque": flexion.law(lambda t, s: 1.0 - s["hub.angle"], ["hub.angle"])}
before = case.run(errors="off", laws=laws)["hub.angle"].max
child = os.fork()
if child == 0:
    same = case.run(errors="off", laws=laws)["hub.angle"].max == before
    rows = flexion.sweep(case, {"section.modulus": [6e10, 7e10]}, "hub.angle.max", errors="none")
    os._exit(0 if same and len(rows.to_pandas()) == 2 else 1)
print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), case.run(errors="off", laws=laws)["hub.angle"].max == before)
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork")
def test_a_process_may_fork_after_the_import(verification: Path) -> None:
    words = [sys.executable, "-c", FORKS, str(verification / "p1_spin_up_4")]
    done = subprocess.run(words, capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stdout.strip()) == (0, "0 True"), done.stderr


SLEEPS = """
import sys, threading, time, flexion
case = flexion.Case(sys.argv[1]) | {"hub": {"inertia": 5, "motion": {"kind": "free"}}, "run.duration": 1}
asked = threading.Event()
def torque(t, state):
    asked.set()
    time.sleep(0.3)
    return 1.0
def compute():
    case.run(errors="off", laws={"hub.torque": torque})
threading.Thread(target=compute, daemon=True).start()
asked.wait()
print("ends")
"""


def test_python_may_end_while_a_law_sleeps_in_another_thread(verification: Path) -> None:
    words = [sys.executable, "-c", SLEEPS, str(verification / "p1_spin_up_4")]
    done = subprocess.run(words, capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stdout.strip()) == (0, "ends"), done.stderr


BEFORE = """
import atexit, sys
def last():
    run = flexion.Case(sys.argv[1]).run(errors="off")
    print(run.status, run.end_time)
atexit.register(last)
import flexion
"""


def test_a_handler_of_the_end_of_python_computes_whole_runs(verification: Path) -> None:
    words = [sys.executable, "-c", BEFORE, str(verification / "p1_spin_up_4")]
    done = subprocess.run(words, capture_output=True, text=True, timeout=60)
    assert (done.stdout.strip(), done.stderr) == ("finished 20.0", "")


ENDLESS = """
import sys, threading, flexion
case = flexion.Case(sys.argv[1]) | {"hub": {"inertia": 5, "motion": {"kind": "free"}}, "run.duration": 1}
asked = threading.Event()
def torque(t, state):
    asked.set()
    while True:
        pass
def stop():
    return torque(0, {})
laws = {
    "law": lambda: case.run(errors="off", laws={"hub.torque": torque}),
    "maker": lambda: case.run(errors="off", laws={"hub.torque": flexion.sampled(0.1, lambda: torque(0, {}))}),
    "stop": lambda: (case | {"run.duration": 10000}).run(errors="off", stop=stop),
}
threading.Thread(target=laws[sys.argv[2]], daemon=True).start()
asked.wait()
sys.exit(3)
"""


@pytest.mark.parametrize("what", ["law", "maker", "stop"])
def test_python_may_end_while_what_another_thread_asks_does_not(verification: Path, what: str) -> None:
    words = [sys.executable, "-c", ENDLESS, str(verification / "p1_spin_up_4"), what]
    done = subprocess.run(words, capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stderr) == (3, "")


def test_a_controller_that_keeps_its_run_or_its_error_is_freed(free: flexion.Case) -> None:
    class Controller:
        kept: Any = None

        def torque(self, t: float, state: State) -> float:
            return 1.0

        def failing(self, t: float, state: State) -> float:
            raise ValueError

    short, controllers = free.with_("run.duration", 0.1), []
    for law in (lambda of: of.torque, lambda of: flexion.sampled(0.01, lambda: of.torque), lambda of: of.failing):
        controller = Controller()
        try:
            controller.kept = short.run(errors="off", laws={"hub.torque": law(controller)})
        except flexion.RunError as error:
            controller.kept = error
        controllers.append(weakref.ref(controller))
    del controller
    gc.collect()
    assert [controller() for controller in controllers] == [None, None, None]


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_ctrl_c_in_a_run_for_the_errors_ends_all_of_them(free: flexion.Case) -> None:
    asked: list[int] = []

    class Controller:
        def __init__(self) -> None:
            asked.append(0)
            self.number = len(asked)

        def __call__(self, t: float, state: State) -> float:
            if self.number == 2 and t > 0.05:
                os.kill(os.getpid(), signal.SIGINT)
                time.sleep(1)
            if self.number > 1:
                asked[self.number - 1] += 1
            return 1.0

    with pytest.raises(flexion.Interrupted) as interrupted:
        free.with_("run.duration", 0.5).run(errors="full", laws={"hub.torque": flexion.sampled(0.01, Controller)})
    assert interrupted.value.result.end_time == pytest.approx(0.5)
    assert sum(asked[2:]) == 0
