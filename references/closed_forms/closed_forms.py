"""Histories of motions that have a closed form, as CSV. Each case's README.md states the form.

    python closed_forms.py FOLDER/HISTORY                for example  initial_modes/reference
"""

import sys

import numpy as np
from numpy import cos, exp, pi, sin, sqrt
from scipy.optimize import brentq
from scipy.special import ellipj, ellipk

FORMS = {}


def form(name, columns, step, end, digits=2):
    """Registers a function of the times that gives a list of columns."""

    def register(function):
        FORMS[name] = (function, columns, np.arange(round(end / step) + 1) * step, digits)
        return function

    return register


def wave_numbers(n):
    """cos b cosh b = -1."""
    return np.array([brentq(lambda b: cos(b) + 1 / np.cosh(b), (i - 0.9) * pi, (i - 0.1) * pi, xtol=1e-15) for i in range(1, n + 1)])


def mode(b, x):
    """Mode of the cantilever of length 1 over its value at the tip."""
    s = (np.cosh(b) + cos(b)) / (np.sinh(b) + sin(b))
    shape = lambda x: np.cosh(b * x) - cos(b * x) - s * (np.sinh(b * x) - sin(b * x))
    return shape(x) / shape(1.0)


# A cantilever in one bending mode: w'' + 2 d w' + o^2 w = 0.04 F(t).
o, push = wave_numbers(1)[0] ** 2, 0.04
ramp = lambda t: np.where(t > 0, push / o**2 * (t - sin(o * t) / o), 0.0)
TIP = ["tip.deflection [m]"]
form("force_on_one_mode/reference", TIP, 0.05, 4)(lambda t: [ramp(t) - ramp(t - 1)])
form("force_on_one_mode/table", TIP, 0.05, 4)(lambda t: [ramp(t)])
form("force_on_one_mode/formula", TIP, 0.05, 4)(lambda t: [push / (o**2 - 25) * (sin(5 * t) - 5 / o * sin(o * t))])


@form("force_on_one_mode/damped", TIP, 0.05, 8)
def damped(t):
    d = (0.2 + 0.05 * o**2) / 2
    w = sqrt(o**2 - d**2)
    return [push / o**2 * (1 - exp(-d * t) * (cos(w * t) + d / w * sin(w * t)))]


# One rigid body on a hub.
J = 3 + 1.5 * (2.5**3 - 0.5**3) / 3
HUB = ["hub.angle [rad]", "hub.speed [rad/s]"]


@form("free_hub_stiff_beam/reference", HUB, 0.1, 5)
def against_a_damper(t):
    final, rate = 20 / 4, 4 / J
    return [final * t + (0.5 - final) * (1 - exp(-rate * t)) / rate, final + (0.5 - final) * exp(-rate * t)]


@form("free_hub_stiff_beam/ramp", HUB, 0.1, 5)
def growing(t):
    late = np.maximum(t - 2, 0)
    grown = np.minimum(t, 2)
    speed = 20 * grown**2 / (4 * J)
    return [20 * grown**3 / (12 * J) + speed * late + 10 / J * late**2, speed + 20 / J * late]


@form("free_hub_stiff_beam/oscillating", HUB, 0.1, 5)
def oscillating(t):
    w = sqrt(40 / J)
    size = 6 / (40 - 9 * J)
    return [size * (sin(3 * t) - 3 / w * sin(w * t)), 3 * size * (cos(3 * t) - cos(w * t))]


@form("free_hub_stiff_beam/controlled", HUB, 0.1, 5)
def controlled(t):
    w, d = sqrt(60 / J), 6 / J
    wd = sqrt(w**2 - d**2)
    return [0.5 * (1 - exp(-d * t) * (cos(wd * t) + d / wd * sin(wd * t))), 0.5 * w**2 / wd * exp(-d * t) * sin(wd * t)]


def compound_pendulum(t, start, rate):
    """Angle above the horizontal and speed of th'' = -rate^2 cos th from rest at `start`."""
    k = sin((start + pi / 2) / 2)
    # From the highest place, a quarter of a period after the lowest.
    sn, cn, dn, _ = ellipj(ellipk(k * k) + rate * t, k * k)
    return 2 * np.arcsin(k * sn) - pi / 2, 2 * k * rate * cn


@form("gravity_rigid_pendulum/reference", [*HUB, "energy.kinetic [J]", "energy.gravity [J]"], 0.02, 2)
def rigid_pendulum(t):
    angle, speed = compound_pendulum(t, pi / 4, sqrt(1.5 * 9.81))
    return [angle, speed, 2 * speed**2 / 6, 9.81 * sin(angle)]


@form("space_joints/reference", ["joint.angle [rad]", "bar.position.x [m]", "bar.position.z [m]"], 0.02, 2)
def hinged_bar(t):
    inertia = 2 / 12 * (1 + 0.03**2) + 2 * 0.25
    angle, _ = compound_pendulum(t, 0.0, sqrt(2 * 9.81 * 0.5 / inertia))
    return [angle, 0.5 * cos(angle), 0.5 * sin(angle)]


@form("initial_modes/reference", [*TIP, "tip.deflection_velocity [m/s]", "x=0.5.deflection [m]"], 0.01, 2)
def two_modes(t):
    b = wave_numbers(2)
    w, half = b**2, mode(b, 0.5)
    start, speed = np.array([0.01, 0.02]), np.array([0.0, 0.3])
    c, s = cos(np.outer(t, w)), sin(np.outer(t, w))
    q, v = c * start + s * speed / w, c * speed - s * start * w
    return [q.sum(1), v.sum(1), q @ half]


@form("motion_constant/reference", ["tip.axial [m]"], 0.0002, 0.04, 4)
def stretched(t):
    speed, length, c = 0.1, 10.0, sqrt(70e9 / 3000)
    k = (2 * np.arange(1, 20001) - 1) * pi / (2 * length)
    w = sqrt((c * k) ** 2 - speed**2)
    # The series of (1 - cos) sums to the static stretch; its tail falls like n^-4.
    return [(1 - cos(np.outer(t, w))) @ (2 * speed**2 / (length * k**2 * w**2))]


@form("motion_ramp/reference", TIP, 0.1, 10, 1)
def accelerated(t):
    b = wave_numbers(200)
    w = b**2 * sqrt(14e3 / (1.2 * 1e4))
    weight = -1e-4 * 2 * (-1.0) ** np.arange(200) * 20 / b**2 / w**2
    response = lambda t: (1 - cos(np.outer(np.maximum(t, 0), w))) @ weight
    return [response(t) - response(t - 5)]


def spin_up(t, speed=4.0, rise=15.0):
    return np.where(t < rise, speed / rise * t - speed / (2 * pi) * sin(2 * pi * t / rise), speed)


form("p1_spin_up_4/speed", ["speed [rad/s]"], 0.1, 21, 1)(lambda t: [spin_up(t)])
form("space_joints/travel", ["displacement [m]"], 0.1, 2.1, 1)(lambda t: [0.2 * t**2])


@form("space_contact/reference", ["ball.position.x [m]", "ball.position.z [m]"], 0.02, 2)
def bouncing_ball(t):
    g, e = 9.81, 0.8
    start, speed = [-sqrt(2 / g)], [sqrt(2 * g)]
    while start[-1] < 3:
        start.append(start[-1] + 2 * speed[-1] / g)
        speed.append(e * speed[-1])
    flight = np.searchsorted(start, t, "right") - 1
    since = t - np.array(start)[flight]
    return [0.5 * t, np.array(speed)[flight] * since - g / 2 * since**2]


@form("space_free_body/reference", ["disc.position.x [m]", "disc.position.z [m]", *(f"disc.spin.{i} [rad/s]" for i in "xyz")], 0.02, 2)
def precession(t):
    """The angular momentum L = J w stays, and the axis e of symmetry goes round it with |L|/J1."""
    j1, j3 = 2 * (0.3**2 / 4 + 0.4**2 / 12), 0.3**2
    momentum = np.array([0.8 * j1, 0, 3 * j3])
    size = np.linalg.norm(momentum)
    n, e, a = momentum / size, np.array([0, 0, 1.0]), (size / j1 * t)[:, None]
    axis = cos(a) * e + sin(a) * np.cross(n, e) + (1 - cos(a)) * (n @ e) * n
    return [t, 1 + 2 * t - 9.81 / 2 * t**2, *(momentum / j1 + (1 - j3 / j1) * 3 * axis).T]


@form("space_loads/reference", ["disc.position.x [m]", "disc.position.y [m]", "disc.spin.z [rad/s]"], 0.04, 4)
def thrust(t):
    """x = integral of (t - s) 2 (cos s^2/4, sin s^2/4) ds, by Gauss's rule."""
    z, w = np.polynomial.legendre.leggauss(60)
    s = t[:, None] * (z + 1) / 2
    weight = 2 * (t[:, None] - s) * t[:, None] / 2 * w
    return [(weight * cos(s**2 / 4)).sum(1), (weight * sin(s**2 / 4)).sum(1), 0.5 * t]


@form("space_spring/reference", ["ball.position.x [m]"], 0.03, 3)
def vibration(t):
    d = 1.2 / 3
    w = sqrt(60 / 1.5 - d**2)
    return [1 + 0.3 * exp(-d * t) * (cos(w * t) + d / w * sin(w * t))]


def main():
    function, columns, times, digits = FORMS[sys.argv[1]]
    print(f"# Closed form: references/closed_forms, {sys.argv[1]}.")
    print(",".join(["time [s]", *columns]))
    for t, *values in zip(times, *function(times)):
        print(f"{t:.{digits}f}," + ",".join(f"{value:.12e}" for value in values))


if __name__ == "__main__":
    main()
