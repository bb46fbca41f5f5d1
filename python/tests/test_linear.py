"""Small motions for control, and the stiffness of a place."""

from __future__ import annotations

import math
from typing import Any

import flexion
import numpy as np
import pytest

EI, EA, L = 7e10 * 2e-7, 7e10 * 4e-4, 10.0
AT_REST: dict[str, Any] = {"hub": {"motion": {"kind": "constant", "speed": 0}}}
BENT: dict[str, Any] = {**AT_REST, "load": [{"on": "tip", "force": [-30, -40]}]}


def test_the_stiffness_of_the_tip_of_a_cantilever(arm: flexion.Case) -> None:
    cantilever = arm | AT_REST
    exact = np.array([[EA / L, 0, 0], [0, 12 * EI / L**3, -6 * EI / L**2], [0, -6 * EI / L**2, 4 * EI / L]])
    for coupling in ("first", "exact", "space"):
        found = cantilever.with_("model.coupling", coupling).stiffness_at("tip")
        assert tuple(found.components) == ("force.x", "force.y", "couple.z")
        assert np.allclose(found.matrix, exact, rtol=1e-6, atol=1e-6 * EI / L**2), coupling
    middle = cantilever.stiffness_at("5 m").matrix
    assert middle[1, 1] == pytest.approx(12 * EI / (L / 2) ** 3, rel=1e-6)


def test_in_space_it_is_six_by_six(arm: flexion.Case) -> None:
    tube = {"kind": "rectangle", "modulus": 7e10, "density": 2700, "height": 0.05, "width": 0.02}
    beam = arm | AT_REST | {"model.coupling": "space", "section": tube, "beam.poisson-ratio": 0.3}
    matrix = beam.stiffness_at("tip").matrix
    in_plane, across = 7e10 * 0.02 * 0.05**3 / 12, 7e10 * 0.05 * 0.02**3 / 12
    assert matrix.shape == (6, 6)
    assert np.allclose(matrix, matrix.T, rtol=1e-7, atol=1e-9 * np.abs(matrix).max())
    assert matrix[1, 1] == pytest.approx(12 * in_plane / L**3, rel=1e-6)
    assert matrix[2, 2] == pytest.approx(12 * across / L**3, rel=1e-6)
    assert matrix[2, 4] == pytest.approx(6 * across / L**2, rel=1e-6)
    assert matrix[0, 0] == pytest.approx(7e10 * 0.05 * 0.02 / L, rel=1e-9)


def test_about_a_bent_state_it_is_the_slope_of_the_path(arm: flexion.Case) -> None:
    def tip(force: tuple[float, float]) -> np.ndarray[Any, Any]:
        loaded = bent | {"load": [{"on": "tip", "force": list(force)}]}
        path = loaded.statics(errors="off")
        return np.array([path["tip.axial"][-1], path["tip.deflection"][-1]])

    bent = (arm | BENT).with_("model.coupling", "exact")
    compliance = np.linalg.inv(bent.stiffness_at("tip").matrix)[:2, :2]
    h = 0.01
    columns = [(tip((-30 + h, -40)) - tip((-30 - h, -40))) / (2 * h), (tip((-30, -40 + h)) - tip((-30, -40 - h))) / (2 * h)]
    assert np.allclose(compliance, np.array(columns).T, rtol=1e-5, atol=1e-8 * np.abs(compliance).max())


@pytest.mark.parametrize("place", ["root", "tipp", "", "20 m", 'tip"}, {on="tip'])
def test_a_place_without_stiffness_is_refused(arm: flexion.Case, place: str) -> None:
    with pytest.raises(flexion.FlexionError):
        (arm | AT_REST).stiffness_at(place)


def test_a_hub_that_rotates_has_no_stiffness_at_rest(arm: flexion.Case) -> None:
    with pytest.raises(flexion.CaseError, match="linearize"):
        arm.with_("hub.motion", {"kind": "constant", "speed": 2}).stiffness_at("tip")


PUSH: dict[str, Any] = {"push": {"on": "tip", "force": [0, 1], "axes": "hub"}}


@pytest.mark.parametrize("coupling", ["first", "exact", "space"])
def test_poles_are_the_modes(arm: flexion.Case, coupling: str) -> None:
    case = arm.with_("model.coupling", coupling) | {"damping": {"stiffness": "2 ms"}}
    axes = "follower" if coupling == "space" else "hub"
    push = {"push": {"on": "tip", "force": [0, 1], "axes": axes}}
    linear = case.linearize(4.0, inputs=push, outputs=["tip.deflection", "tip.deflection_velocity"])
    modes = case.modes(4.0, 3)
    a, b, c, d = linear.state_space()
    poles = np.linalg.eigvals(a)
    for mode in modes:
        assert np.abs(poles - mode.eigenvalue).min() < 1e-6 * abs(mode.eigenvalue), mode
    assert (poles.real < 1e-9).all()
    gain = -(c @ np.linalg.solve(a, b))[0, 0]
    assert gain == pytest.approx((linear.by_position @ np.linalg.solve(linear.stiffness, linear.input))[0, 0], rel=1e-9)
    assert d.shape == (2, 1) and tuple(linear.units) == ("m", "m/s")


def test_the_gain_is_that_of_a_pushed_run(arm: flexion.Case) -> None:
    steady = arm | {
        "hub": {"motion": {"kind": "constant", "speed": "2 rad/s"}},
        "initial": "steady-rotation",
        "model.coupling": "exact",
    }
    linear = steady.linearize(2.0, inputs=PUSH, outputs=["tip.deflection"])
    gain = (linear.by_position @ np.linalg.solve(linear.stiffness, linear.input))[0, 0]
    pushed = [
        float(
            (steady | {"load": [{"on": "tip", "force": [0, f], "axes": "hub"}], "run.duration": 0.01})
            .run(errors="off")["tip.deflection"]
            .data[0]
        )
        for f in (-1e-2, 1e-2)
    ]
    assert gain == pytest.approx((pushed[1] - pushed[0]) / 2e-2, rel=1e-5)


def test_a_free_hub_is_driven_by_its_torque(arm: flexion.Case) -> None:
    free = arm | {"hub": {"inertia": 50, "motion": {"kind": "free", "speed": 0}}}
    linear = free.linearize(0.0, inputs={"hub.torque": None}, outputs=["hub.speed", "tip.deflection"], free_hub=True)
    # Far below the first vibration the whole turns as a rigid body: hub and beam about the axis.
    inertia = 50 + 3000 * 4e-4 * L**3 / 3
    a, b, c, d = linear.state_space()
    s = 1e-3j
    transfer = c @ np.linalg.solve(s * np.eye(len(a)) - a, b) + d
    assert transfer[0, 0] == pytest.approx(1 / (inertia * s), rel=1e-4)
    with pytest.raises(flexion.AnalysisError, match=r"hub\.torque"):
        arm.linearize(0.0, inputs={"hub.torque": None})
    with pytest.raises(flexion.AnalysisError, match="free_hub=True"):
        free.linearize(0.0, inputs={"hub.torque": None})


def test_what_is_no_input_or_output_is_refused(arm: flexion.Case) -> None:
    with pytest.raises(flexion.AnalysisError, match="did you mean `tip.deflection`"):
        arm.linearize(4.0, outputs=["tip.deflexion"])
    with pytest.raises(flexion.AnalysisError, match="periodic"):
        arm.linearize(4.0, inputs={"dead": {"on": "tip", "force": [0, 1]}})
    with pytest.raises(flexion.CaseError, match="tipp"):
        arm.linearize(4.0, inputs={"push": {"on": "tipp", "force": [0, 1]}})
    with pytest.raises(flexion.AnalysisError, match="zero or positive"):
        arm.linearize(math.nan)
    with pytest.raises(TypeError):
        arm.linearize(0.0, inputs={"push": 3})  # type: ignore[dict-item]


def test_without_inputs_and_outputs_the_poles_remain(arm: flexion.Case) -> None:
    a, b, c, d = arm.linearize(4.0).state_space()
    assert b.shape == (len(a), 0) and c.shape == (0, len(a)) and d.shape == (0, 0)


def test_a_hub_that_is_held_is_no_coordinate(arm: flexion.Case) -> None:
    free = arm | {"hub": {"inertia": 50, "motion": {"kind": "free", "speed": 0}}}
    linear = free.linearize(0.0)
    assert not any("hub" in name for name in linear.coordinates)
    poles = np.abs(np.linalg.eigvals(linear.state_space()[0]))
    assert np.sort(poles)[0] == pytest.approx(float(free.modes(0.0, 1)[0].frequency), rel=1e-9)
    assert len(linear.coordinates) + 1 == len(free.linearize(0.0, free_hub=True).coordinates)
