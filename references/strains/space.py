"""Slender beams in space: a history and equilibria, as CSV.

    python space.py space_elbow/reference [POINTS STEP]
    python space.py bend                                   the tip of the 45 degree bend of space_cantilever
"""

import sys

import numpy as np

from collocation import solve
from slender_beam import Slender


def equilibrium(beam, force, parts=10):
    z = np.zeros(4 * beam.n)
    for part in np.arange(1, parts + 1) / parts:
        given = [(np.ones(beam.n), part * np.array(force, float)[:, None])]
        residual = lambda y: beam.residual(y, 0 * y, 0 * y, given)
        for _ in range(30):
            matrix = residual(z[:, None] + 1e-30j * np.eye(len(z))).imag / 1e-30
            change = np.linalg.solve(matrix, residual(z[:, None])[:, 0])
            z = z - change
            if np.abs(change).max() < 1e-13 * (1e-3 + np.abs(z).max()):
                break
        else:
            raise RuntimeError(f"no equilibrium: {np.abs(change).max()}")
    return beam.tip(z)


def bend(points=20):
    """R = 100, a square of 1 x 1, E = 1e7, GJ = 1e7/2 x 1/6, force 600 out of the plane."""
    length, ei = 100 * np.pi / 4, 1e7 / 12
    beam = Slender([length], points, (1e7, ei, ei, ei), curvature=(0, 0, 0.01))
    start = np.array([100 * np.sin(np.pi / 4), 100 * (1 - np.cos(np.pi / 4)), 0])
    return equilibrium(beam, (0, 0, 600)) - start


def elbow(points=12, step=0.1, end=20.0):
    half = np.sqrt(0.5)
    beam = Slender([10, 10], points, (1e6, 1e3, 1e3, 1e3), 1.0, (20, 10, 10), [(1, 0, 0, 0), (half, 0, 0, half)])
    reach = np.concatenate([np.ones(points), np.zeros(points)])
    rows = []

    def residual(t, z, v, a):
        size = 50 * np.maximum(0, 1 - np.abs(t - 1))
        return beam.residual(z, v, a, [(reach, np.array([0 * size, 0 * size, size]))])

    solve(residual, np.zeros(4 * beam.n), step, end, observe=lambda t, z, v, a: rows.append((t, *beam.tip(z) - [10, 10, 0])))
    return np.array(rows)


def main():
    name, given = sys.argv[1], [float(x) for x in sys.argv[2:]]
    if name == "bend":
        return print(*(f"{x:.9g}" for x in bend(*map(int, given))))
    rows = elbow(int(given[0]), given[1]) if given else elbow()
    print("# Another formulation, coded independently: references/strains, strains and curvatures at Gauss points.")
    print("time [s]," + ",".join(f"second.tip.displacement.{axis} [m]" for axis in "xyz"))
    for t, *row in rows[:: round(0.1 * (len(rows) - 1) / 20)]:
        print(f"{t:.1f}," + ",".join(f"{value:.10e}" for value in row))


if __name__ == "__main__":
    main()
