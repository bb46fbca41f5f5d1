"""What no user means to do: nothing ends the interpreter, nothing hangs, and what is refused says why."""

from __future__ import annotations

import warnings
import time
import os
import copy
import json
import math
import pickle
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import flexion
import numpy as np
import pytest
from conftest import ARM

REFUSED = (flexion.FlexionError, TypeError, ValueError, KeyError, OSError, OverflowError)

VALUES: list[Any] = [
    None,
    True,
    -1,
    0,
    2**63,
    -(2**70),
    1e308,
    -1e-320,
    math.nan,
    math.inf,
    "",
    "∞ m",
    "10 m\n[run]\nduration = 1",
    "'; DROP TABLE beams",
    "\x00",
    "a" * 100_000,
    b"10 m",
    [],
    [[[[]]]],
    {},
    {"kind": "nothing"},
    {"": {"": 1}},
    {"a.b": 1},
    {1: 2},
    np.array([]),
    np.array([np.nan, 1.0]),
    np.datetime64("2026-01-01"),
    np.float32(1e30),
    object(),
    print,
    range(3),
    {1, 2},
    lambda t: t,
    1 + 2j,
    Path("/"),
]


def paths(schema: dict[str, Any], prefix: str = "") -> list[str]:
    """Dotted keys of a schema, without those of kinds within kinds."""
    found = []
    for key, of in schema.get("properties", {}).items():
        found.append(prefix + key)
        found += paths(of, f"{prefix}{key}.")
    for of in schema.get("oneOf", []):
        found += paths(of, prefix)
    return list(dict.fromkeys(found))


KEYS = paths(json.loads(flexion.schema())["anyOf"][0])


@pytest.mark.parametrize("key", KEYS)
def test_any_key_takes_any_value_or_refuses_it(arm: flexion.Case, key: str) -> None:
    for value in VALUES:
        try:
            changed = arm.with_(key, value)
        except REFUSED as error:
            assert str(error)
        else:
            assert isinstance(str(changed), str) and changed == flexion.Case(str(changed))


@pytest.mark.parametrize("value", VALUES, ids=lambda value: type(value).__name__)
def test_arguments_of_any_type_are_refused_or_taken(arm: flexion.Case, value: Any, tmp_path: Path) -> None:
    short = arm.with_("run.duration", 0.1)
    calls: list[Any] = [
        lambda: flexion.Case(value),
        lambda: flexion.Case({**ARM, "beam": value}),
        lambda: flexion.Case({"title": value}),
        lambda: short | value,
        lambda: short.with_(value, 1),
        lambda: short.run(until=value, errors="off"),
        lambda: short.run(errors=value),
        lambda: short.run(errors="off", tolerance=value, quantity="tip.deflection"),
        lambda: short.run(errors="off", stop=value),
        lambda: short.run(errors="off", laws=value),
        lambda: short.run(errors="off", laws={"hub.torque": value}),
        lambda: short.run(errors="off", laws={value: print}),
        lambda: short.run(errors="off", laws={"push": flexion.law(lambda t, state: value, load={"on": "tip", "force": [0, 1]})}),
        lambda: short.run(errors="off", laws={"push": flexion.law(lambda t, state: 1.0, load=value)}),
        lambda: short.run(errors="off", laws={"push": flexion.law(lambda t, state: 1.0, value, load={"on": "tip", "force": [0, 1]})}),
        lambda: short.run(errors="off", laws={"push": flexion.sampled(value, lambda: value, load={"on": "tip", "force": [0, 1]})}),
        lambda: flexion.law(lambda t, state: 1.0, breaks=value),
        lambda: short.modes(value),
        lambda: short.modes(0.0, value),
        lambda: short.modes(0.0, 2, unit=value),
        lambda: short.campbell(value),
        lambda: short.campbell([0, 1], value),
        lambda: short.campbell([value, 1]),
        lambda: short.statics(value),
        lambda: short.statics(step=value, points=10),
        lambda: short.statics(points=value, to=0.1),
        lambda: short.linearize(value),
        lambda: short.linearize(0.0, inputs=value),
        lambda: short.linearize(0.0, outputs=[value]),
        lambda: short.stiffness_at(value),
        lambda: flexion.load(value),
        lambda: flexion.compare(value, value),
        lambda: flexion.plot(value),
        lambda: flexion.sweep(short, {"section.modulus": value}, "tip.deflection.min", errors="none"),
        lambda: flexion.sweep(short, {"section.modulus": [7e10]}, value, errors="none"),
        lambda: flexion.sweep(short, table=value, quantities="tip.deflection.min", errors="none"),
        lambda: flexion.sweep(short, {"section.modulus": [7e10]}, "tip.deflection.min", client=value, errors="none"),
    ]
    for number, call in enumerate(calls):
        try:
            call()
        except (*REFUSED, AttributeError, flexion.Interrupted) as error:
            assert not isinstance(error, flexion.InternalError), number


def test_objects_are_copied_pickled_and_hashed(arm: flexion.Case) -> None:
    assert pickle.loads(pickle.dumps(arm)) == copy.copy(arm) == copy.deepcopy(arm) == arm
    run = arm.with_("run.duration", 0.1).run(errors="off")
    for other in (run, run.plot(), arm.modes(0.0, 1)):
        hash(other)
    with pytest.raises(TypeError):
        pickle.dumps(run._source)


def test_a_callback_may_call_the_package(arm: flexion.Case) -> None:
    calls: list[float] = []
    slow = arm.with_("run.duration", 2000).with_("integrator", {"kind": "newmark", "step": 1e-3})

    def stop() -> bool:
        calls.append(float(arm.run(errors="off")["tip.deflection"].min))
        return len(calls) > 2

    run = slow.run(errors="off", stop=stop)
    assert run.status == "stopped" and len(set(calls)) == 1


def test_a_callback_that_raises_ends_the_run_with_its_error(arm: flexion.Case) -> None:
    slow = arm.with_("run.duration", 20000).with_("integrator", {"kind": "newmark", "step": 1e-3})

    class Mine(BaseException):
        pass

    for error in (RuntimeError("mine"), Mine(), SystemExit(3), KeyboardInterrupt()):

        def stop(error: BaseException = error) -> bool:
            raise error

        expected = flexion.Interrupted if isinstance(error, KeyboardInterrupt) else type(error)
        with pytest.raises(expected):
            slow.run(errors="off", stop=stop)


def test_errors_are_pickled(arm: flexion.Case) -> None:
    for error in (flexion.RunError("broke down", arm.with_("run.duration", 0.1).run(errors="off")), flexion.Interrupted("by hand", 1)):
        other = pickle.loads(pickle.dumps(error))
        assert (type(other), str(other), other.result) == (type(error), str(error), None)


def test_a_run_that_breaks_down_is_an_error_where_warnings_are(arm: flexion.Case) -> None:
    def law(t: float, state: flexion._law.State) -> float:
        raise OSError("lost")

    load = {"on": "tip", "force": [0, 1]}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(flexion.RunError, match="lost"):
            arm.run(laws={"push": flexion.law(law, load=load)})


@pytest.mark.skipif(not hasattr(os, "fork"), reason="forks")
def test_a_child_that_was_forked_while_a_thread_computes_ends_at_once(arm: flexion.Case) -> None:
    stop = threading.Event()
    long = arm.with_("run.duration", 1e5)
    thread = threading.Thread(target=lambda: long.run(errors="off", stop=stop))
    thread.start()
    time.sleep(0.2)
    try:
        began = time.monotonic()
        child = os.fork()
        if child == 0:
            import atexit

            atexit._run_exitfuncs()
            os._exit(0 if time.monotonic() - began < 5.0 else 1)
        assert os.waitpid(child, 0)[1] == 0
    finally:
        stop.set()
        thread.join()


INTERRUPTED = """
import _thread, threading, time, flexion
case = flexion.Case({case!r})
call = {{"modes": lambda: case.modes(0.0, 900), "advise": lambda: case.advise(1e-9)}}[{what!r}]
threading.Timer(0.3, _thread.interrupt_main).start()
try:
    call()
    print("done")
except KeyboardInterrupt as error:
    print(type(error).__name__)
"""


@pytest.mark.parametrize("what", ["modes", "advise"])
def test_what_is_not_a_run_ends_at_an_interrupt_too(arm: flexion.Case, what: str) -> None:
    case = (arm | {"basis.elements": 1500, "run.duration": 200}).to_toml()
    done = subprocess.run([sys.executable, "-c", INTERRUPTED.format(case=case, what=what)], capture_output=True, text=True, timeout=100, check=True)
    assert done.stdout.strip() == "Interrupted", done


def test_threads_stop_each_other(arm: flexion.Case) -> None:
    slow = arm | {"run.duration": 1e6, "output.step": 10, "integrator": {"kind": "newmark", "step": 1e-3}}
    stop, ended = threading.Event(), []
    threads = [threading.Thread(target=lambda: ended.append(slow.run(errors="off", stop=stop).status)) for _ in range(4)]
    for thread in threads:
        thread.start()
    threading.Timer(0.3, stop.set).start()
    for thread in threads:
        thread.join(timeout=60)
    assert ended == ["stopped"] * 4


EXITS = """
import flexion, threading, sys
case = flexion.Case(sys.argv[1]) | {"run.duration": 1e6, "output.step": 10, "integrator": {"kind": "newmark", "step": 1e-3}}
threading.Thread(target=lambda: case.run(errors="off", progress=False), daemon=True).start()
import time; time.sleep(0.2)
print("leaving", flush=True)
"""


def test_the_interpreter_may_end_while_a_thread_computes(verification: Path) -> None:
    words = [sys.executable, "-c", EXITS, str(verification / "p1_spin_up_4")]
    done = subprocess.run(words, capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stdout.strip()) == (0, "leaving"), done.stderr
