"""Histories of a flexible pendulum on a free hub without inertia, released straight and at rest, as CSV.

    python pendulum.py FOLDER/HISTORY [POINTS STEP]      for example  pendulum_45/reference
"""

import sys
from functools import partial

import numpy as np

import section
from collocation import solve
from planar_beam import Beam

AREA, SECOND_MOMENT, MASS, GRAVITY = 3.14e-4, 7.85e-9, 2766.7 * 3.14e-4, 9.81
# modulus [Pa], angle [degrees], end [s], points, step [s]
HISTORIES = {
    "pendulum_45/reference": (68.952e9, 45, 0.5, 48, 5e-5),
    "pendulum_horizontal/reference": (689.52e6, 0, 0.8, 48, 1e-4),
}
COLUMNS = [
    "time [s]",
    "hub.angle [rad]",
    "hub.speed [rad/s]",
    "tip.deflection [m]",
    "energy.kinetic [J]",
    "energy.strain [J]",
    "energy.gravity [J]",
]


def history(modulus, degrees, end, points, step):
    bar = partial(section.constant, mass=MASS, ea=modulus * AREA, ei=modulus * SECOND_MOMENT)
    beam = Beam("exact", bar, (0, 1), points, gravity=GRAVITY)
    start = np.zeros(beam.size)
    start[-1] = np.radians(degrees)
    rows, every = [], round(0.005 / step)

    def observe(t, z, v, a):
        if round(t / step) % every:
            return
        tangent, rate, *_ = beam.shape(*(y[:, None] for y in (z, v, a)))
        tip, height, velocity = (beam.w @ tangent)[:, 0], beam.s @ tangent[1], beam.s @ rate
        deflection = np.cos(z[-1]) * tip[1] - np.sin(z[-1]) * tip[0]
        kinetic = beam.w @ (beam.mass * (velocity**2).sum(0)) / 2
        e, k = z[:points, None], z[points:-1, None]
        strain = beam.w @ (beam.ea * e**2 + beam.ei * k**2) / 2
        rows.append((t, z[-1], v[-1], deflection, kinetic[0], strain[0], GRAVITY * (beam.w @ (beam.mass * height))[0]))

    solve(lambda t, z, v, a: beam.residual(z, v, a, 0 * t, 0 * t), start, step, end, 6, observe)
    return rows


def main():
    given = HISTORIES[sys.argv[1]]
    if len(sys.argv) > 3:
        given = (*given[:3], int(sys.argv[2]), float(sys.argv[3]))
    rows = history(*given)
    print("# Another formulation, coded independently: references/strains, strains and curvatures at Gauss points, inertial axes.")
    print(f"# Its energy drifts by {np.ptp([sum(row[4:]) for row in rows]):.0e} J.")
    print(",".join(COLUMNS))
    for t, *row in rows:
        print(f"{t:.3f}," + ",".join(f"{value:.10e}" for value in row))


if __name__ == "__main__":
    main()
