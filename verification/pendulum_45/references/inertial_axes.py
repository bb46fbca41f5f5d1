"""A flexible pendulum without a rotating frame: the references of pendulum_45 and pendulum_horizontal.

The place of the axis in inertial axes is p(x, t) = sum c_i(t) x P_i(2x/L - 1), with Legendre polynomials P_i, pinned at x = 0.
Hence a constant mass matrix and a constant force of gravity; the strain energy is the integral of
EA (|p'| - 1)^2/2 + EI k^2/2 with the rotation k = (p' x p'')/|p'|^2 of the section per length. DOP853 integrates it.

    python3 inertial_axes.py MODULUS DEGREES DURATION POLYNOMIALS > reference.csv     (needs NumPy and SciPy)
"""

import sys

import numpy as np
from numpy.polynomial import legendre
from scipy.integrate import solve_ivp

LENGTH, AREA, SECOND_MOMENT, DENSITY, GRAVITY = 1.0, 3.14e-4, 7.85e-9, 2766.7, 9.81
STEP = 0.005


def functions(n, x):
    """Values and first two derivatives of x P_i(2x/L - 1), one column each."""
    z, identity = 2 * x / LENGTH - 1, np.eye(n)
    p, dp, ddp = (
        np.stack([legendre.legval(z, legendre.legder(row, k)) for row in identity], axis=1) * (2 / LENGTH) ** k
        for k in range(3)
    )
    x = x[:, None]
    return x * p, p + x * dp, 2 * dp + x * ddp


def main():
    modulus, degrees, duration, n = float(sys.argv[1]), float(sys.argv[2]), float(sys.argv[3]), int(sys.argv[4])
    ea, ei, mass = modulus * AREA, modulus * SECOND_MOMENT, DENSITY * AREA
    z, w = legendre.leggauss(3 * n)
    x, w = 0.5 * LENGTH * (z + 1), 0.5 * LENGTH * w
    f, df, ddf = functions(n, x)
    inertia = mass * f.T @ (w[:, None] * f)
    inverse = np.linalg.inv(inertia)
    weight = np.outer(mass * GRAVITY * (w @ f), [0.0, 1.0])
    wdf, wddf = (w[:, None] * df).T, (w[:, None] * ddf).T

    def strain(c):
        a, b = df @ c, ddf @ c
        s = np.hypot(a[:, 0], a[:, 1])
        return a, b, s, (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / s**2

    def rate(_, y):
        c, v = y[: 2 * n].reshape(n, 2), y[2 * n :]
        a, b, s, k = strain(c)
        stretch = (ea * (s - 1) / s - 2 * ei * k * k / s**2)[:, None] * a
        moment = (ei * k / s**2)[:, None]
        force = wdf @ (stretch + moment * np.stack([b[:, 1], -b[:, 0]], axis=1))
        force += wddf @ (moment * np.stack([-a[:, 1], a[:, 0]], axis=1))
        return np.concatenate([v, -(inverse @ (force + weight)).ravel()])

    angle = np.radians(degrees)
    c = np.zeros((n, 2))
    c[0] = np.cos(angle), np.sin(angle)
    y = np.concatenate([c.ravel(), np.zeros(2 * n)])
    times = np.arange(round(duration / STEP) + 1) * STEP
    out = solve_ivp(rate, (0, times[-1]), y, "DOP853", times, rtol=1e-10, atol=1e-12)
    root, tip = functions(n, np.array([0.0, LENGTH]))[1][0], functions(n, np.array([0.0, LENGTH]))[0][1]
    rows, turns = [], np.unwrap([np.arctan2(*(root @ y[: 2 * n].reshape(n, 2))[::-1]) for y in out.y.T])
    for t, y, theta in zip(times, out.y.T, turns):
        c, v = y[: 2 * n].reshape(n, 2), y[2 * n :].reshape(n, 2)
        (a, da), (end, _) = (root @ c, root @ v), (tip @ c, None)
        speed = (a[0] * da[1] - a[1] * da[0]) / (a @ a)
        deflection = -np.sin(theta) * end[0] + np.cos(theta) * end[1]
        _, _, s, k = strain(c)
        energies = 0.5 * np.sum(v * (inertia @ v)), 0.5 * w @ (ea * (s - 1) ** 2 + ei * k**2), np.sum(weight * c)
        rows.append((t, theta, speed, deflection, *energies))
    drift = np.ptp([sum(row[4:]) for row in rows])
    print(f"# Another formulation, coded independently: inertial_axes.py, {n} Legendre polynomials a component in inertial")
    print(f"# axes, DOP853 with relative tolerance 1e-10. Its energy drifts by {drift:.0e} J.")
    print(
        "time [s],hub.angle [rad],hub.speed [rad/s],tip.deflection [m],energy.kinetic [J],energy.strain [J],energy.gravity [J]"
    )
    for row in rows:
        print(f"{row[0]:.3f}," + ",".join(f"{value:.12e}" for value in row[1:]))


if __name__ == "__main__":
    main()
