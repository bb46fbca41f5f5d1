"""Small motion of a hub with a beam, as CSV: exact in time, by the exponential of the equations and of what drives them.

    python small_motion.py FOLDER/HISTORY [MODES]       for example  free_hub_flexible_beam/formula
"""

import sys

import numpy as np
from scipy.linalg import eigh, expm
from scipy.optimize import brentq

LENGTH, RADIUS, HUB, MASS, BENDING = 10.0, 0.5, 100.0, 1.2, 14e3
STEP, STEPS = 0.1, 100

# Spring and damper of the hub; its torque is the first entry of d, with d' = (matrix) d; d at zero, and d set anew at a time.
HISTORIES = {
    "free_hub_flexible_beam/reference": (0, 0, [[0, 1], [0, 0]], [0, 0.1 / 3], (3.0, [0.1, 0])),
    "free_hub_flexible_beam/formula": (0, 0, [[0, 1], [-0.49, 0]], [0, 0.07], None),
    "free_hub_flexible_beam/restrained": (50, 30, [[0]], [0.1], None),
    "free_hub_flexible_beam/controlled": (200, 300, [[0]], [0.2], None),
}


def matrices(modes):
    """Mass and stiffness for the angle and the modes of the clamped beam of mean square 1; the shapes at the tip."""
    i = np.arange(1, modes + 1)
    b = np.array([brentq(lambda b: np.cos(b) + 1 / np.cosh(b), (k - 0.9) * np.pi, (k - 0.1) * np.pi, xtol=1e-15) for k in i])
    ratio = (np.cosh(b) + np.cos(b)) / (np.sinh(b) + np.sin(b))
    mass = np.diag([HUB + MASS * ((RADIUS + LENGTH) ** 3 - RADIUS**3) / 3, *(MASS * LENGTH + 0 * b)])
    # The integrals of a mode are 2 ratio L / b, and with x 2 (L / b)^2.
    mass[0, 1:] = mass[1:, 0] = MASS * (2 * RADIUS * ratio * LENGTH / b + 2 * (LENGTH / b) ** 2)
    return mass, np.diag([0.0, *(BENDING * b**4 / LENGTH**3)]), np.array([0.0, *(-2.0 * (-1.0) ** i)])


def history(name, modes=80):
    spring, damper, driver, drive, later = HISTORIES[name]
    driver = np.array(driver, float)
    mass, stiffness, tip = matrices(modes)
    stiffness[0, 0] += spring
    # Shifted and inverted: the low frequencies, which carry the motion, come to full accuracy beside those of the 80th mode.
    inverse, vectors = eigh(mass, stiffness + mass)
    squares, vectors = 1 / inverse - 1, vectors / np.sqrt(inverse)
    n, scale = len(tip), np.sqrt(np.maximum(squares, 1.0))
    # y = (frequency times coordinate, velocity of each mode; d)
    system = np.zeros((2 * n + len(drive), 2 * n + len(drive)))
    system[:n, n : 2 * n] = np.diag(scale)
    system[n : 2 * n, :n] = -np.diag(squares / scale)
    system[n : 2 * n, n : 2 * n] = -damper * np.outer(vectors[0], vectors[0])
    system[n : 2 * n, 2 * n] = vectors[0]
    system[2 * n :, 2 * n :] = driver
    advance = expm(STEP * system)
    y = np.concatenate([np.zeros(2 * n), drive])
    rows = []
    for i in range(STEPS + 1):
        q = vectors @ (y[:n] / scale)
        rows.append((i * STEP, q[0], tip @ q))
        if later and abs(i * STEP - later[0]) < 1e-9:
            y[2 * n :] = later[1]
        y = advance @ y
    return rows


def main():
    rows = history(sys.argv[1], *map(int, sys.argv[2:]))
    print("# Another formulation, coded independently: references/small_motion, modes and a matrix exponential.")
    print("time [s],hub.angle [rad],tip.deflection [m]")
    for t, angle, deflection in rows:
        print(f"{t:.1f},{angle:.12e},{deflection:.12e}")


if __name__ == "__main__":
    main()
