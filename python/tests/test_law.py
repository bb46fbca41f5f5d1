"""Laws of Python: against controllers and formulas of cases, closed forms, and an integration of its own."""

from __future__ import annotations

import json
import math
import pickle
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import flexion
import numpy as np
import pytest
from conftest import ARM, FREE
from flexion._law import State

PD = {"proportional": 300, "derivative": 600, "target": 1.0}
READS = ["hub.angle", "hub.speed"]


def pd(t: float, state: State) -> float:
    return 300 * (1.0 - state["hub.angle"]) - 600 * state["hub.speed"]


def apart(a: flexion.Run, b: flexion.Run, name: str) -> float:
    return float(np.max(np.abs(a[name].data - b[name].data)))


def test_a_law_that_is_the_controller_of_a_case_moves_the_hub_as_that_does(free: flexion.Case) -> None:
    own = free.with_("hub.motion.controller", {"kind": "pd", **PD}).run()
    by_law = free.run(laws={"hub.torque": flexion.law(pd, READS)})
    for name in ("hub.angle", "tip.deflection"):
        error = own[name].max.error
        assert error is not None and apart(own, by_law, name) < 2 * error + 1e-9, name
        assert by_law[name].max.error == pytest.approx(error, rel=0.1)
    assert np.array_equal(by_law["law.hub.torque"].data, by_law["hub.torque"].data)
    assert by_law["law.hub.torque"].unit == "N*m"
    # Newton's method has the slopes of the law.
    work = [run.summary["work"]["iterations"] for run in (own, by_law)]
    assert work[1] < 1.1 * work[0]


def pi(t: float, state: State) -> tuple[float, dict[str, float]]:
    left = 1.0 - state["hub.angle"]
    return 300 * left - 600 * state["hub.speed"] + 200 * state["sum"], {"sum": left}


@pytest.mark.parametrize("change", [{}, {"model.coupling": "space", "run.duration": 1}, {"integrator": {"kind": "hht", "step": "2 ms"}}])
def test_a_state_is_the_integral_of_its_rate(free: flexion.Case, change: dict[str, Any]) -> None:
    run = (free | change).run(laws={"hub.torque": flexion.law(pi, READS, states={"sum": 0.5})})
    angle, times, found = run["hub.angle"].data, run.times, run["law.hub.torque.sum"]
    # Simpson's rule over two records at a time.
    step = times[1] - times[0]
    of = 1.0 - angle[: len(angle) - (1 - len(angle) % 2)]
    by_hand = 0.5 + step / 3 * (of[0] + of[-1] + 4 * of[1:-1:2].sum() + 2 * of[2:-1:2].sum())
    error = found.final.error
    assert error is not None and abs(found.data[len(of) - 1] - by_hand) < 5 * error + 1e-7
    torque = 300 * (1.0 - angle) - 600 * run["hub.speed"].data + 200 * found.data
    assert np.max(np.abs(run["hub.torque"].data - torque)) < 1e-8 * np.max(np.abs(torque))


@pytest.mark.parametrize("initial", [{"kind": "static"}, {"kind": "modes", "amplitudes": ["1 mm"]}], ids=["static", "modes"])
def test_states_do_not_change_how_a_run_begins(initial: dict[str, Any]) -> None:
    still = {**ARM, "hub": {"motion": {"kind": "constant", "speed": 0}}, "initial": initial, "run": {"duration": 0.1}}
    case = flexion.Case(still | {"load": [{"on": "tip", "force": [0, 5]}]})
    push = {"on": "tip", "force": [0, 1]}

    def nothing(t: float, state: State) -> tuple[float, dict[str, float]]:
        return 0.0, {"x": -3 * state["x"]}

    own, by_law = case.run(errors="off"), case.run(errors="off", laws={"push": flexion.law(nothing, load=push, states={"x": 2.0})})
    assert apart(own, by_law, "tip.deflection") < 1e-5 * float(np.max(np.abs(own["tip.deflection"].data)))
    assert by_law["law.push.x"].final == pytest.approx(2 * math.exp(-0.3), abs=1e-6)


def test_a_law_with_states_says_what_it_must_give(free: flexion.Case) -> None:
    def run(function: Any, **more: Any) -> None:
        free.run(errors="off", laws={"hub.torque": flexion.law(function, **more)})

    with pytest.raises(flexion.RunError, match=r"with the rates of x, and not 1.0"):
        run(lambda t, state: 1.0, states={"x": 0.0})
    with pytest.raises(flexion.RunError, match="the rate of each of its states, x, and not of y"):
        run(lambda t, state: (1.0, {"y": 0.0}), states={"x": 0.0})
    with pytest.raises(flexion.RunError, match="gives the rate inf of `x`"):
        run(lambda t, state: (1.0, {"x": math.inf}), states={"x": 0.0})
    with pytest.raises(ValueError, match="`sizes` names `y`, which is no state"):
        flexion.law(lambda t, state: 0.0, sizes={"y": 1.0})
    with pytest.raises(flexion.CaseError, match="must have a name of its own"):
        run(lambda t, state: (1.0, {"hub.angle": 0.0}), reads=["hub.angle"], states={"hub.angle": 0.0})


@pytest.mark.parametrize("space", [False, True], ids=["plane", "space"])
def test_a_law_of_time_alone_gives_the_bits_of_a_table(free: flexion.Case, space: bool) -> None:
    case = free | ({"model.coupling": "space", "run.duration": 1} if space else {})
    torque = {"kind": "constant", "torque": 50}
    push = {"on": "tip", "force": [0, 2], "axes": "follower"}
    own = (case | {"hub.motion.torque": torque, "load": [push]}).run(errors="off")
    laws = {"hub.torque": lambda t, state: 50, "push": flexion.law(lambda t, state: 1, load=push)}
    by_law = case.run(errors="off", laws=laws)
    assert np.array_equal(own["hub.angle"].data, by_law["hub.angle"].data)
    assert np.array_equal(own.times, by_law.times)


def test_a_law_is_the_amplitude_of_a_load_as_a_formula_is(free: flexion.Case) -> None:
    push = {"on": "beam", "force-per-length": [0, 3], "axes": "hub", "from": 4}
    formula = {**push, "amplitude": {"kind": "expression", "formula": "sin(3*t)"}}
    own = (free | {"load": [formula]}).run()
    by_law = free.run(laws={"wind": flexion.law(lambda t, state: math.sin(3 * t), load=push)})
    error = own["tip.deflection"].min.error
    assert error is not None and apart(own, by_law, "tip.deflection") < 2 * error
    assert np.allclose(by_law["law.wind"].data, np.sin(3 * by_law.times), atol=1e-12)


def test_a_law_reads_places_far_from_where_it_acts(free: flexion.Case) -> None:
    """A damper from the tip to the hub's axes, by a law and by a force on the tip of a beam whose root is held: decay of its first mode."""
    held = free | {"hub": {"motion": {"kind": "constant", "speed": 0}}, "initial": {"kind": "modes", "amplitudes": [0.01]}}
    held = held | {"run.duration": 10, "output.stations": ["5 m"]}
    mode = held.modes(count=1)[0]
    damper = flexion.law(
        lambda t, state: -2.0 * state["tip.deflection_velocity"],
        ["tip.deflection_velocity"],
        load={"on": "tip", "force": [0, 1], "axes": "hub"},
    )
    run = held.run(laws={"damper": damper})
    # Of the first mode of a cantilever φ(L)² = 4/(ρA L) of mass one: the decay rate is c φ(L)²/2, to first order of c.
    rate = 2.0 * 4 / (1.2 * 10) / 2
    omega = mode.frequency
    t, w = run.times, run["tip.deflection"].data
    expected = 0.01 * np.exp(-rate * t) * np.cos(omega * t)
    late = t > 2
    found = np.polyfit(t[late], np.log(np.abs(np.hypot(w, run["tip.deflection_velocity"].data / omega)[late])), 1)[0]
    assert found == pytest.approx(-rate, rel=0.1)
    assert np.max(np.abs(w - expected)) < 0.005


PENDULUM = """
gravity = [0, -9.81, 0]
[[body]]
name = "arm"
mass = 2
inertia = { kind = "principal", moments = [0.02, 0.5, 0.5] }
position = [0.7, 0, 0]
[[joint]]
name = "elbow"
kind = "revolute"
between = ["ground", "arm"]
at = [0, 0, 0]
axis = [0, 0, 1]
[run]
duration = 3
"""


class Pid:
    """A controller with memory: its integral, and the error at the last sample."""

    def __init__(self, period: float) -> None:
        self.period, self.sum, self.last, self.asked = period, 0.0, 0.5, [0.0][:0]

    def __call__(self, t: float, state: State) -> float:
        error = 0.5 - state["elbow.angle"]
        self.sum += error * self.period
        slope, self.last = (error - self.last) / self.period, error
        self.asked.append(t)
        return max(-40.0, min(40.0, 60.0 * error + 40.0 * self.sum + 12.0 * slope))


def rigid_arm(period: float, end: float) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    """θ̈ = (u − m g ℓ cos θ)/(I + m ℓ²) by the classical method of Runge and Kutta, 40 steps a sample."""
    controller, inertia, weight = Pid(period), 0.5 + 2 * 0.7**2, 2 * 9.81 * 0.7
    x, states, steps = np.zeros(2), [], 40
    for k in range(round(end / period)):
        states.append(x)
        u = controller(k * period, State({"elbow.angle": float(x[0])}))

        def f(x: np.ndarray[Any, Any], u: float = u) -> np.ndarray[Any, Any]:
            return np.array([x[1], (u - weight * math.cos(x[0])) / inertia])

        h = period / steps
        for _ in range(steps):
            k1 = f(x)
            k2 = f(x + h / 2 * k1)
            k3 = f(x + h / 2 * k2)
            k4 = f(x + h * k3)
            x = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return np.array(states), x


@pytest.mark.parametrize("integrator", [{"kind": "radau", "tolerance": 1e-9}, {"kind": "generalized-alpha", "step": 1e-3}])
def test_a_sampled_pid_moves_a_pendulum_as_an_integration_of_its_own_says(integrator: dict[str, Any]) -> None:
    period = 0.02
    case = flexion.Case(PENDULUM) | {"integrator": integrator, "output.step": period}
    made: list[Pid] = []

    def make() -> Pid:
        made.append(Pid(period))
        return made[-1]

    run = case.run(errors="full", laws={"elbow.torque": flexion.sampled(period, make, ["elbow.angle"])})
    states, last = rigid_arm(period, 3)
    angles = run["elbow.angle"].data
    allowed = 1e-7 if integrator["kind"] == "radau" else 1e-4
    assert len(angles) == 151
    assert np.max(np.abs(angles[:150] - states[:, 0])) < allowed
    assert abs(angles[-1] - last[0]) < allowed
    # The run and each of its companions have a controller of their own, asked once a sample in order of time.
    assert len(made) >= 2
    for controller in made:
        assert np.allclose(controller.asked, period * np.arange(150), atol=1e-12)
    assert abs(angles[-1] - 0.5) < 0.02


def test_a_hub_under_a_law_follows_the_closed_form_of_a_damped_oscillator() -> None:
    """A rigid arm, J θ̈ = K (1 − θ) − D θ̇ with J of the hub and the beam: θ = 1 − e^(−δt) (cos ωt + δ/ω sin ωt)."""
    stiff = flexion.Case(FREE) | {"section.modulus": "7e7 GPa", "basis": {"kind": "finite-elements", "elements": 2}}
    stiff = stiff | {"run.duration": 2}
    inertia, k, d = 50 + 1.2 * 10**3 / 3, 4000.0, 800.0
    run = stiff.run(laws={"hub.torque": flexion.law(lambda t, s: k * (1 - s["hub.angle"]) - d * s["hub.speed"], READS)})
    delta = d / (2 * inertia)
    omega = math.sqrt(k / inertia - delta**2)
    t = run.times
    expected = 1 - np.exp(-delta * t) * (np.cos(omega * t) + delta / omega * np.sin(omega * t))
    # What the arm bends under the torque at the start, K L/3EI.
    assert np.max(np.abs(run["hub.angle"].data - expected)) < 2 * k * 10 / (3 * 7e16 * 2e-7)


def test_a_prismatic_joint_takes_a_thrust() -> None:
    slider = flexion.Case(
        {
            "body": [{"name": "cart", "mass": 2, "inertia": {"kind": "sphere", "radius": 0.1}}],
            "joint": [{"name": "rail", "kind": "prismatic", "between": ["ground", "cart"], "axis": [1, 0, 0]}],
            "run": {"duration": 1},
        }
    )
    run = slider.run(laws={"rail.thrust": flexion.law(lambda t, s: 6.0 if t < 0.5 else 0.0, breaks=[0.5])})
    assert run["cart.position.x"].final == pytest.approx(0.5 * 3 * 0.25 + 1.5 * 0.5, abs=1e-9)
    assert run["rail.thrust"].data[0] == 6.0 and run["rail.thrust"].data[-1] == 0.0


WRONG: list[tuple[dict[str, Any], str]] = [
    ({"hub.torqe": pd}, "did you mean `hub.torque`"),
    ({"push": pd}, "names nothing that can be driven"),
    ({"hub.torque": flexion.law(pd, ["hub.acceleration"])}, "a reaction or an acceleration"),
    ({"hub.torque": flexion.law(pd, ["hub.torque"])}, "a reaction or an acceleration"),
    ({"hub.torque": flexion.law(pd, ["hub.angel"])}, "did you mean `hub.angle`"),
    (
        {
            "hub.torque": flexion.law(lambda t, s: (0.0, {"x": 0.0}), states={"x": 0.0}),
            "hub.torque.x": flexion.law(lambda t, s: 1.0, load={"on": "tip", "force": [0, 1]}),
        },
        "recorded as `law.hub.torque.x`, and so is something else",
    ),
    ({"hub.torque": flexion.sampled(0.0, lambda: pd)}, "positive and finite"),
    ({"hub.torque": flexion.sampled(1e-9, lambda: pd)}, "samples in the run"),
    ({"hub.torque": flexion.law(pd, breaks=[math.nan])}, "must be finite"),
    ({"push": flexion.law(pd, load={"on": "tip", "force": [0, 1], "amplitude": {"kind": "constant"}})}, "leave it out"),
    ({"push": flexion.law(pd, load={"on": "tip", "farce": [0, 1]})}, "farce"),
    ({"push": flexion.law(pd, load={"on": "beam", "law": {"kind": "linear-drag", "coefficient": 1}})}, "amplitude"),
]


@pytest.mark.parametrize("laws, said", WRONG, ids=[said for _, said in WRONG])
def test_what_no_law_can_be_is_refused_before_the_run(free: flexion.Case, laws: dict[str, Any], said: str) -> None:
    with pytest.raises(flexion.CaseError, match=said):
        free.run(laws=laws)


def test_what_moves_as_prescribed_takes_no_torque(arm: flexion.Case) -> None:
    with pytest.raises(flexion.CaseError, match="moves as prescribed"):
        arm.run(laws={"hub.torque": lambda t, state: 1.0})


class Mine(Exception):
    pass


def raises(at: float, error: BaseException) -> Callable[[float, State], float]:
    def law(t: float, state: State) -> float:
        if t > at:
            raise error
        return 1.0

    return law


@pytest.mark.parametrize("errors", ["off", "auto"])
@pytest.mark.parametrize("is_sampled", [False, True])
def test_a_law_that_raises_ends_the_run_with_its_exception_as_the_cause(
    free: flexion.Case, errors: str, is_sampled: bool
) -> None:
    mine = Mine("enough")
    function = raises(2.0, mine)
    of = flexion.sampled(0.01, lambda: function) if is_sampled else flexion.law(function)
    with pytest.raises(flexion.RunError, match=r"the law `hub.torque` raised Mine: enough at t = 2\.") as found:
        free.run(errors=errors, laws={"hub.torque": of})
    assert found.value.__cause__ is mine and "no longer finite" not in str(found.value)
    run = found.value.result
    assert run is not None and run.status == "failed" and 1.5 < run.end_time <= 2.1 and len(run.times) > 100


def test_interrupts_and_exits_within_a_law_are_what_they_are(free: flexion.Case) -> None:
    with pytest.raises(flexion.Interrupted) as found:
        free.run(laws={"hub.torque": raises(1.0, KeyboardInterrupt())})
    assert found.value.result.end_time > 0.5
    with pytest.raises(SystemExit):
        free.run(laws={"hub.torque": raises(1.0, SystemExit(3))})


RETURNED: list[tuple[Any, str]] = [
    (math.nan, "gives NaN at t = 0.0"),
    (math.inf, "gives inf"),
    (None, "TypeError"),
    ("1.0", "TypeError"),
    (1j, "TypeError"),
    ([1.0], "TypeError"),
    (np.array([1.0, 2.0]), "TypeError"),
    (10**400, "OverflowError"),
]


@pytest.mark.parametrize("value, said", RETURNED, ids=[type(value).__name__ + said[:10] for value, said in RETURNED])
def test_what_is_no_finite_number_ends_the_run(free: flexion.Case, value: Any, said: str) -> None:
    for of in (flexion.law(lambda t, state: value), flexion.sampled(0.1, lambda: lambda t, state: value)):
        with pytest.raises(flexion.RunError, match=said):
            free.run(laws={"hub.torque": of})


def test_numbers_of_numpy_are_numbers(free: flexion.Case) -> None:
    for value in (np.float32(2.0), np.int64(2), np.array(2.0), True, 2):
        assert free.run(until=0.1, laws={"hub.torque": lambda t, state, value=value: value})["hub.torque"].max == float(value)


def test_a_continuous_law_with_memory_is_found(free: flexion.Case) -> None:
    calls: list[float] = []

    def counts(t: float, state: State) -> float:
        calls.append(t)
        return float(len(calls))

    class Integral:
        sum, last = 0.0, 0.0

        def __call__(self, t: float, state: State) -> float:
            self.sum += (1.0 - state["hub.angle"]) * (t - self.last)
            self.last = t
            return self.sum

    for function in (counts, Integral()):
        with pytest.raises(flexion.RunError, match="what has memory is sampled"):
            free.run(laws={"hub.torque": flexion.law(function, ["hub.angle"])})


def test_what_a_law_does_not_read_it_does_not_get(free: flexion.Case) -> None:
    with pytest.raises(flexion.RunError, match="does not read `hub.speed` but hub.angle") as found:
        free.run(laws={"hub.torque": flexion.law(pd, ["hub.angle"])})
    assert isinstance(found.value.__cause__, KeyError)
    with pytest.raises(TypeError, match="write"):
        flexion.law(pd, "hub.angle")
    with pytest.raises(TypeError):
        flexion.sampled(0.1, pd(0.0, State({"hub.angle": 0.0, "hub.speed": 0.0})))  # type: ignore[arg-type]


def test_what_makes_a_controller_may_fail(free: flexion.Case) -> None:
    mine = Mine("no controller")

    def make() -> Callable[[float, State], float]:
        raise mine

    with pytest.raises(Mine):
        free.run(laws={"hub.torque": flexion.sampled(0.1, make)})
    with pytest.raises(TypeError, match="makes its controller"):
        free.run(laws={"hub.torque": flexion.sampled(0.1, lambda: 1.0)})  # type: ignore[arg-type,return-value]


def test_no_file_holds_a_law_and_nothing_goes_on_from_its_run(free: flexion.Case, tmp_path: Path) -> None:
    push = flexion.law(lambda t, s: 1.0, load={"on": "tip", "force": [0, 1]})
    run = free.run(errors="off", laws={"hub.torque": flexion.law(pd, READS), "push": push})
    folder = run.save("controlled")
    assert not (folder / "state.npz").exists()
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["laws"] == ["hub.torque", "push"]
    text = (folder / "case.resolved.toml").read_text()
    assert "no file holds: hub.torque, push" in text
    assert run.case == free == flexion.Case(folder / "case.resolved.toml")
    loaded = flexion.load(folder)
    assert np.array_equal(loaded["law.hub.torque"].data, run["law.hub.torque"].data)
    before = free.run(errors="off").save("before")
    initial = {"kind": "restart", "file": str(before.resolve() / "state.npz")}
    goes_on = flexion.Case({**FREE, "initial": initial, "run": {"duration": 5}})
    with pytest.raises(flexion.CaseError, match="begins at t = 0"):
        goes_on.run(errors="off", laws={"hub.torque": flexion.law(pd, READS)})


def test_a_tolerance_is_reached_with_laws(free: flexion.Case) -> None:
    coarse = free.with_("basis.elements", 2)
    run = coarse.run(tolerance="1e-5 rad", quantity="hub.angle", laws={"hub.torque": flexion.law(pd, READS)})
    error = run["hub.angle"].max.error
    assert error is not None and error < 1e-5
    assert "law.hub.torque" in run and run.case != coarse


def test_a_law_may_call_the_package_and_threads_run_beside_each_other(free: flexion.Case) -> None:
    short = free.with_("run.duration", 0.2)
    seen: list[float] = []

    def nested(t: float, state: State) -> float:
        if not seen:
            seen.append(float(short.run(errors="off", laws={"hub.torque": flexion.law(pd, READS)})["hub.angle"].max))
        return 1.0

    assert short.run(errors="off", laws={"hub.torque": nested}).status == "finished" and seen[0] > 0
    alone = short.run(errors="off", laws={"hub.torque": flexion.law(pd, READS)})["hub.angle"].data
    found: list[Any] = []
    threads = [
        threading.Thread(
            target=lambda: found.append(short.run(errors="off", laws={"hub.torque": flexion.law(pd, READS)})["hub.angle"].data)
        )
        for _ in range(4)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(timeout=120)
    assert len(found) == 4 and all(np.array_equal(alone, other) for other in found)


def test_stop_ends_a_run_with_a_law(free: flexion.Case) -> None:
    stop = threading.Event()

    def slow(t: float, state: State) -> float:
        time.sleep(0.001)
        if t > 0.01:
            stop.set()
        return 1.0

    endless = free.with_("run.duration", 1e4)
    assert endless.run(errors="off", laws={"hub.torque": slow}, stop=stop).status == "stopped"


def test_a_law_is_pickled_where_its_function_can_be() -> None:
    of = flexion.Law(make=dict, reads=("hub.angle",), period=0.1)
    assert pickle.loads(pickle.dumps(of)) == of
    with pytest.raises((AttributeError, pickle.PicklingError)):
        pickle.dumps(flexion.law(lambda t, state: 1.0))


def test_a_law_that_computes_its_own_case_ends_somewhere(free: flexion.Case) -> None:
    deep = 0

    def torque(t: float, state: State) -> float:
        nonlocal deep
        deep += 1
        return float(free.run(errors="off", laws={"hub.torque": torque})["hub.angle"].final)

    with pytest.raises(flexion.RunError, match="4 deep") as found:
        free.run(errors="off", laws={"hub.torque": torque})
    cause: BaseException | None = found.value
    while cause is not None and not isinstance(cause, RecursionError):
        cause = cause.__cause__
    assert cause is not None and deep == 4


def test_names_of_laws_stand_in_names_of_columns(arm: flexion.Case) -> None:
    def push(name: str, **states: float) -> None:
        arm.run(laws={name: flexion.law(lambda t, state: 1.0, load={"on": "tip", "force": [0, 1]}, states=states)})

    for name in ["a [m]", "a,b", "", "x..y", "x\n"]:
        with pytest.raises(flexion.CaseError, match="cannot stand in the name of a column"):
            push(name)
        with pytest.raises(flexion.CaseError, match="a state is called"):
            push("push", **{name: 0.0})


def test_a_run_that_ends_at_its_start_is_kept_and_says_why_it_holds_nothing(free: flexion.Case, tmp_path: Path) -> None:
    def breaks(t: float, state: flexion.State) -> float:
        raise ZeroDivisionError("no torque")

    with pytest.raises(flexion.RunError) as raised:
        free.run(laws={"hub.torque": flexion.law(breaks)})
    run = raised.value.result
    assert len(run.times) == 0 and math.isnan(float(run["hub.angle"].max))
    folder = run.save(tmp_path / "run")
    with pytest.raises(flexion.AnalysisError, match="holds no records: .* failed: .*ZeroDivisionError: no torque"):
        flexion.load(folder)


@pytest.mark.parametrize("number", [1 + 0j, np.complex64(1), np.complex128(1 + 5j), np.clongdouble(1)])
def test_a_complex_number_is_no_torque(free: flexion.Case, number: Any) -> None:
    with pytest.raises(flexion.RunError, match="must be real number, not complex"):
        free.run(laws={"hub.torque": flexion.law(lambda t, state: number)})
    with pytest.raises(flexion.RunError, match="must be real number, not complex"):
        free.run(laws={"hub.torque": flexion.law(lambda t, state: (number, {"x": 0.0}), states={"x": 0.0})})
