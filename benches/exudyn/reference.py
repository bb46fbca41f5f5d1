"""Reference tip history of the spin-up: a geometrically exact beam in the hub frame, independent of both programs.

Position p(x) = (X, Y) by cubic Hermite elements in the rotating frame; strain energy
U = 1/2 int EA (|p'| - 1)^2 + EI kappa^2 dx, kappa = (X'Y'' - Y'X'')/|p'|^2; constant mass M;
M p" + 2 w J M p' + (w' J - w^2) M p + dU/dp = 0. Gradient and Hessian of the energy density come from symbolic
differentiation; the unknowns are the vibration modes of the straight beam (all of them, so nothing is truncated).
Integrated by the Radau IIA method of order 5 with error control, restarted at the end of the spin-up.

    python reference.py [ELEMENTS] [TOLERANCE] > reference.csv
"""

import sys

import numpy as np
import scipy.linalg
import sympy
from scipy.integrate import Radau

LENGTH, MASS, AXIAL, BENDING = 10.0, 1.2, 2.8e7, 1.4e4
SPEED, SPIN_UP, END, OUTPUT = 4.0, 15.0, 20.0, 0.01
POINTS = 4  # Gauss points an element


def hermite(s, h):
    """Values, first and second derivatives of the four cubics of an element of length h, at s in [0, 1]."""
    value = [1 - 3 * s**2 + 2 * s**3, h * (s - 2 * s**2 + s**3), 3 * s**2 - 2 * s**3, h * (s**3 - s**2)]
    first = [(-6 * s + 6 * s**2) / h, 1 - 4 * s + 3 * s**2, (6 * s - 6 * s**2) / h, 3 * s**2 - 2 * s]
    second = [(-6 + 12 * s) / h**2, (-4 + 6 * s) / h, (6 - 12 * s) / h**2, (6 * s - 2) / h]
    return np.array(value).T, np.array(first).T, np.array(second).T


def energy_density():
    """Gradient (4) and Hessian (10, upper triangle) of the energy a length in (X' - 1, Y', X'', Y'')."""
    a, b, c, d = variables = sympy.symbols("a b c d")
    z = 2 * a + a * a + b * b
    strain = z / (1 + sympy.sqrt(1 + z))  # |p'| - 1 without cancellation
    curvature = ((1 + a) * d - b * c) / (1 + z)
    density = AXIAL * strain**2 / 2 + BENDING * curvature**2 / 2
    gradient = [sympy.diff(density, v) for v in variables]
    hessian = [sympy.diff(gradient[i], variables[j]) for i in range(4) for j in range(i, 4)]
    return sympy.lambdify(variables, gradient, cse=True), sympy.lambdify(variables, hessian, cse=True)


def hub(t):
    """Hub speed [rad/s] and acceleration [rad/s^2]."""
    w = 2 * np.pi / SPIN_UP
    if t < SPIN_UP:
        return SPEED / SPIN_UP * (t - np.sin(w * t) / w), SPEED / SPIN_UP * (1 - np.cos(w * t))
    return SPEED, 0.0


class Beam:
    """The clamped beam, in modal coordinates q of the straight state: p = p0 + V q."""

    def __init__(self, elements):
        h = LENGTH / elements
        n = 2 * (elements + 1)
        mass = np.zeros((n, n))
        x, w = np.polynomial.legendre.leggauss(6)
        value, _, _ = hermite((x + 1) / 2, h)
        for e in range(elements):
            mass[2 * e : 2 * e + 4, 2 * e : 2 * e + 4] += MASS * (value.T * w * h / 2) @ value
        x, w = np.polynomial.legendre.leggauss(POINTS)
        _, first, second = hermite((x + 1) / 2, h)
        slope = np.zeros((elements * POINTS, n))
        bend = np.zeros_like(slope)
        for e in range(elements):
            rows = slice(e * POINTS, (e + 1) * POINTS)
            slope[rows, 2 * e : 2 * e + 4] = first
            bend[rows, 2 * e : 2 * e + 4] = second
        self.weight = np.tile(w * h / 2, elements)
        self.gradient, self.hessian = energy_density()
        zero_, zero = np.zeros_like(slope), np.zeros((n, n))
        free = np.r_[np.arange(1, n), n + np.arange(2, n)]  # root: X, Y and Y' held
        operator = np.vstack([np.hstack(r) for r in ((slope, zero_), (zero_, slope), (bend, zero_), (zero_, bend))])
        self.operator = operator[:, free]
        full = np.block([[mass, zero], [zero, mass]])
        turn = np.block([[zero, -mass], [mass, zero]])
        straight = np.zeros(2 * n)
        straight[0:n:2], straight[1:n:2] = np.linspace(0, LENGTH, elements + 1), 1.0
        _, modes = scipy.linalg.eigh(self.stiffness(np.zeros(len(free))), full[np.ix_(free, free)])
        self.size = len(free)
        self.turn = modes.T @ turn[np.ix_(free, free)] @ modes
        self.turn0 = modes.T @ (turn @ straight)[free]
        self.mass0 = modes.T @ (full @ straight)[free]
        self.tip = modes[n - 3], modes[-2]
        self.operator = self.operator @ modes

    def strains(self, q):
        return (self.operator @ q).reshape(4, -1)

    def force(self, q):
        g = [np.broadcast_to(x, self.weight.shape) * self.weight for x in self.gradient(*self.strains(q))]
        return self.operator.T @ np.concatenate(g)

    def stiffness(self, q):
        h = iter(np.broadcast_to(x, self.weight.shape) * self.weight for x in self.hessian(*self.strains(q)))
        block = {}
        for i in range(4):
            for j in range(i, 4):
                block[i, j] = block[j, i] = next(h)
        parts = np.split(self.operator, 4)
        rows = [sum(block[i, j][:, None] * parts[j] for j in range(4)) for i in range(4)]
        return self.operator.T @ np.vstack(rows)

    def rate(self, t, y):
        w, a = hub(t)
        q, v = np.split(y, 2)
        return np.r_[v, w * w * (q + self.mass0) - a * self.turn0 - self.turn @ (2 * w * v + a * q) - self.force(q)]

    def jacobian(self, t, y):
        w, a = hub(t)
        n = self.size
        out = np.zeros((2 * n, 2 * n))
        out[:n, n:] = np.eye(n)
        out[n:, :n] = w * w * np.eye(n) - a * self.turn - self.stiffness(y[:n])
        out[n:, n:] = -2 * w * self.turn
        return out


def history(elements=40, tolerance=1e-8):
    """Times [s], tip axial [m], tip transverse [m] in the hub frame."""
    beam = Beam(elements)
    t = np.arange(round(END / OUTPUT) + 1) * OUTPUT
    axial, transverse = np.zeros_like(t), np.zeros_like(t)
    y, done = np.zeros(2 * beam.size), 1
    for start, end in ((0.0, SPIN_UP), (SPIN_UP, END)):
        solver = Radau(
            beam.rate, start, y, end, jac=beam.jacobian, rtol=tolerance, atol=tolerance / 100, max_step=0.05,
            first_step=1e-4,
        )
        while solver.status == "running":
            message = solver.step()
            if solver.status == "failed":
                raise RuntimeError(f"reference: Radau IIA stopped at t = {solver.t} s: {message}")
            upto = np.searchsorted(t, solver.t + 1e-12)
            if upto > done:
                q = solver.dense_output()(t[done:upto])[: beam.size]
                axial[done:upto], transverse[done:upto] = beam.tip[0] @ q, beam.tip[1] @ q
                done = upto
        y = solver.y
    return t, axial, transverse


def main():
    elements = int(sys.argv[1]) if len(sys.argv) > 1 else 40
    tolerance = float(sys.argv[2]) if len(sys.argv) > 2 else 1e-8
    print(f"# spin-up to {SPEED:g} rad/s, geometrically exact, {elements} Hermite elements, Radau IIA, rtol {tolerance:g}")
    print("time [s],tip.axial [m],tip.deflection [m]")
    for row in zip(*history(elements, tolerance)):
        print("{:.2f},{:.9e},{:.9e}".format(*row))


if __name__ == "__main__":
    main()
