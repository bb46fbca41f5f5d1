"""Histories of the tip of planar beams that are spun up by a hub, as CSV.

    python planar.py FOLDER/HISTORY     for example  p1_spin_up_4/exact
    python planar.py steady             the equilibrium of steady_rotation_graded
"""

import sys
from functools import partial
from pathlib import Path

import numpy as np
from scipy.interpolate import BPoly

import section
from collocation import solve
from planar_beam import Beam


def p1(modulus):
    return partial(section.constant, mass=1.2, ea=modulus * 4e-4, ei=modulus * 2e-7)


def p3(n, ceramic=151e9):
    return partial(section.graded, n=n, ceramic=ceramic, metal=70e9)


def rows():
    return np.loadtxt(Path(__file__).parents[2] / "verification/varying_section/section.csv", delimiter=",", skiprows=2)


# coupling, section, ends of its pieces [m], speed [rad/s], points a piece
HISTORIES = {
    "p3_spin_up/reference": ("first", p3(2), (0, 5), 4, 24),
    "p3_spin_up/n0": ("first", p3(0), (0, 5), 4, 24),
    "p3_spin_up/n05": ("first", p3(0.5), (0, 5), 4, 24),
    "p3_spin_up/n1": ("first", p3(1), (0, 5), 4, 24),
    "p3_spin_up/n5": ("first", p3(5), (0, 5), 4, 24),
    "p3_spin_up/zeroth": ("zeroth", p3(2), (0, 5), 4, 24),
    "p3_spin_up/high": ("high", p3(2), (0, 5), 4, 24),
    "p3_spin_up/at_10_rad_s": ("first", p3(2), (0, 5), 10, 28),
    "p3_spin_up/at_20_rad_s": ("first", p3(2), (0, 5), 20, 28),
    "p3_spin_up/soft_ceramic": ("first", p3(0, 15.1e9), (0, 5), 10, 28),
    "varying_section/reference": ("first", section.circle, (0, 10), 4, 28),
    "varying_section/tapered_rectangle": ("first", section.rectangle, (0, 10), 4, 28),
    "varying_section/tapered_tube": ("first", section.tube, (0, 10), 4, 28),
    "varying_section/piecewise": ("first", section.stepped, (0, 4, 7, 10), 4, 12),
    "varying_section/table": ("first", partial(section.table, rows=rows()), rows()[:, 0], 4, 10),
    "simo_vu_quoc_spin_up/reference": ("exact", p1(70e9), (0, 10), 6, 24),
}
for folder, modulus, speed, points in (
    ("p1_spin_up_4", 70e9, 4, 24),
    ("p1_spin_up_4_at_5_gpa", 5e9, 4, 24),
    ("p1_spin_up_20", 70e9, 20, 28),
    ("p1_spin_up_20_at_30_gpa", 30e9, 20, 32),
):
    for coupling in ("first", "zeroth", "high", "exact"):
        name = f"{folder}/{'reference' if coupling == 'first' else coupling}"
        HISTORIES[name] = (coupling, p1(modulus), (0, 10), speed, points)
# Beyond these the deflection is more than the length, or there is no solution.
ENDS = {
    "p1_spin_up_4/zeroth": 12.6,
    "p1_spin_up_20/zeroth": 4.9,
    "p1_spin_up_4_at_5_gpa/zeroth": 4.7,
    "p1_spin_up_4_at_5_gpa/high": 7.7,
}
ROTARY = {"simo_vu_quoc_spin_up/reference": 6e-4}


def spin_up(t, speed, rise=15.0):
    """Speed and acceleration of the hub."""
    w, early = 2 * np.pi / rise, t <= rise
    return np.where(early, speed / rise * (t - np.sin(w * t) / w), speed), np.where(early, speed / rise * (1 - np.cos(w * t)), 0.0)


def history(name, points=None, step=0.02, inertia=0.0):
    """Times, tip (time; displacement, velocity, acceleration; along, across), torque."""
    coupling, shape, ends, speed, usual = HISTORIES[name]
    beam = Beam(coupling, shape, ends, points or usual, inertia=inertia, rotary=ROTARY.get(name, 0.0))
    times, tips, torques = [], [], []

    def observe(t, z, v, a):
        motion = spin_up(np.array([t]), speed)
        times.append(t)
        tips.append(beam.tip(*(y[:, None] for y in (z, v, a)))[..., 0])
        torques.append(beam.torque(*(y[:, None] for y in (z, v, a)), *motion)[0])

    solve(lambda t, z, v, a: beam.residual(z, v, a, *spin_up(t, speed)), np.zeros(beam.size), step, ENDS.get(name, 20.0), observe=observe)
    return np.array(times), np.array(tips), np.array(torques)


def roll_up(rise, points=24, step=0.0025):
    """Times and tip of a beam of 1 m x 2 mm x 2 mm at rest that a couple at its tip rolls up for `rise` [s] and releases."""
    area, ei = 4e-6, 70e9 * 2e-3**4 / 12
    bar = partial(section.constant, mass=2700 * area, ea=70e9 * area, ei=ei)
    beam = Beam("exact", bar, (0, 1), points, rotary=2700 * 2e-3**4 / 12)
    couple = lambda t: np.where(t < rise, 2 * np.pi * ei * np.sin(np.pi * t / rise), 0.0)
    times, tips = [], []

    def observe(t, z, v, a):
        times.append(t)
        tips.append(beam.tip(*(y[:, None] for y in (z, v, a)))[0, :, 0])

    solve(lambda t, z, v, a: beam.residual(z, v, a, 0.0, 0.0, couple(t)), np.zeros(beam.size), step, 10.0, observe=observe)
    return np.array(times), np.array(tips)


def steady(shape, length, speed, points=24):
    """Displacement of the tip in steady rotation."""
    beam = Beam("first", shape, (0, length), points)
    rest = np.zeros((beam.size, 1))
    force = beam.residual(rest, rest, rest, speed, 0.0)
    matrix = beam.residual(np.eye(beam.size), rest, rest, speed, 0.0) - force
    return beam.tip(np.linalg.solve(matrix, -force), rest, rest)[0, :, 0]


def figures(times, tips):
    """The least deflection and its time; amplitude and middle of the deflection after 15 s."""
    curve = BPoly.from_derivatives(times, tips[:, :, 1])
    dense = np.linspace(0, times[-1], 40 * len(times))
    at = dense[np.argmin(curve(dense))]
    slope, bend = curve.derivative(), curve.derivative(2)
    for _ in range(5):
        at -= slope(at) / bend(at)
    late = curve(dense[dense >= 15.0])
    out = f"# smallest tip.deflection {curve(at):.9g} m at {at:.9g} s"
    return out + (f"; from 15 s on amplitude {np.ptp(late) / 2:.9g} m, middle {(late.max() + late.min()) / 2:.9g} m" if late.size else "")


def columns(name):
    """Comment, names and rows of a file."""
    if name == "free_hub_recorded_torque/torque":
        times, _, torques = history("p1_spin_up_4/reference", step=0.025, inertia=100.0)
        return "", ["torque [N*m]"], times[::2], [torques[::2]]
    if name == "free_hub_recorded_torque/reference":
        times, tips, _ = history("p1_spin_up_4/reference")
        return "", ["tip.deflection [m]", "hub.speed [rad/s]"], times[::5], [tips[::5, 0, 1], spin_up(times[::5], 4)[0]]
    if name == "space_p1_spin_up/reference":
        times, tips, _ = history("p1_spin_up_4/exact")
        t, (axial, across) = times[::5], tips[::5, 0].T
        w = 2 * np.pi / 15
        angle = np.where(t <= 15, 4 / 15 * (t**2 / 2 + (np.cos(w * t) - 1) / w**2), 4 * (t - 7.5))
        c, s = np.cos(angle), np.sin(angle)
        names = [f"beam.tip.position.{axis} [m]" for axis in "xy"]
        return "", names, t, [c * (10 + axial) - s * across, s * (10 + axial) + c * across]
    if name.startswith("space_roll_up_release"):
        within, step = {"reference": (3.0, 0.0025), "two_seconds": (2.0, 0.00125), "four_seconds": (4.0, 0.0025)}[name.split("/")[1]]
        times, tips = roll_up(within, step=step)
        every = round(0.1 / times[1])
        names = [f"beam.tip.position.{axis} [m]" for axis in "xy"]
        return "", names, times[::every], [1 + tips[::every, 0], tips[::every, 1]]
    times, tips, _ = history(name)
    return figures(times, tips), ["tip.axial [m]", "tip.deflection [m]"], times[::5], tips[::5, 0].T


def main():
    if sys.argv[1] == "steady":
        stretch, deflection = steady(p3(2), 5.0, 10.0)
        return print(f"P3, N = 2, in steady rotation at 10 rad/s: tip {stretch:.10e} m along, {deflection:.10e} m across")
    comment, names, times, values = columns(sys.argv[1])
    print("# Another formulation, coded independently: references/strains, strains and curvatures at Gauss points.")
    if comment:
        print(comment)
    print(",".join(["time [s]", *names]))
    for t, *row in zip(times, *values):
        print(f"{t:.2f}," + ",".join(f"{value:.10e}" for value in row))


if __name__ == "__main__":
    main()
