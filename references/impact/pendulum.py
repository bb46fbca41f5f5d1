"""A flexible pendulum that falls onto a plane: reference values for the impact tests.

Usage: python pendulum.py [N] [e] [end time in s] [tolerance]

The derivation is in README.md. Needs numpy and scipy.
"""

import sys

import numpy as np
from scipy.integrate import DOP853
from scipy.optimize import brentq

LENGTH, AREA, SECOND, DENSITY, MODULUS, G = 1.0, 3.14e-4, 7.85e-9, 2766.7, 6.8952e10, 9.81
MASS = DENSITY * AREA


def wave_numbers(n):
    """Roots of cos z cosh z = -1, written so that nothing overflows."""
    near = [(i - 0.5) * np.pi for i in range(1, n + 1)]
    return [brentq(lambda z: np.cos(z) + 1.0 / np.cosh(z), x - 0.4, x + 0.4, xtol=1e-15) for x in near]


class Pendulum:
    """Unknowns q = (angle, N axial, N transverse modes)."""

    def __init__(self, modes):
        self.modes = n = modes
        points, weights = np.polynomial.legendre.leggauss(24 + 8 * n)
        x, self.w = 0.5 * LENGTH * (points + 1), 0.5 * LENGTH * weights * MASS
        self.x = np.append(x, LENGTH)  # the tip is last
        self.z = wave_numbers(n)
        self.axial = self.axial_shapes(self.x)
        self.across = self.across_shapes(self.x)[0]
        # H(x), the integral of slope times slope from the root to x, by a Gauss rule for each x.
        self.h = np.zeros((len(self.x), n, n))
        for k, end in enumerate(self.x):
            slope = self.across_shapes(0.5 * end * (points + 1))[1]
            self.h[k] = np.einsum("k,ik,jk->ij", 0.5 * end * weights, slope, slope)
        slope = (np.arange(1, n + 1) - 0.5) * np.pi / LENGTH
        self.k = np.zeros(2 * n + 1)
        self.k[1 : n + 1] = MODULUS * AREA * slope**2 * 0.5 * LENGTH
        # The square of a mode has the mean 1.
        self.k[n + 1 :] = MODULUS * SECOND * (np.array(self.z) / LENGTH) ** 4 * LENGTH

    def axial_shapes(self, x):
        return np.array([np.sin((i - 0.5) * np.pi * x / LENGTH) for i in range(1, self.modes + 1)])

    def across_shapes(self, x):
        """Modes and slopes of the cantilever: cosh - cos - s (sinh - sin), with decaying exponentials only."""
        value, slope = [], []
        for z in self.z:
            b, end = z / LENGTH, np.exp(-z)
            s = (np.sin(z) - (np.cos(z) - 0) - end) / (1 + 2 * np.sin(z) * end - end * end)
            grow, decay = s * np.exp(b * (x - LENGTH)), (1 - s * end) * np.exp(-b * x)
            sigma = 1 - 2 * s * end
            value.append(grow + decay - np.cos(b * x) + sigma * np.sin(b * x))
            slope.append(b * (grow - decay + np.sin(b * x) + sigma * np.cos(b * x)))
        return np.array(value), np.array(slope)

    def kinematics(self, q, v):
        """Place, jacobian and the acceleration at rest of the unknowns of all points, in the frame of the beam."""
        n = self.modes
        a, b, va, vb = q[1 : n + 1], q[n + 1 :], v[1 : n + 1], v[n + 1 :]
        hb, hvb = self.h @ b, self.h @ vb
        along = self.x + a @ self.axial - 0.5 * (hb @ b)
        over = b @ self.across
        rate = va @ self.axial - hb @ vb
        jx = np.empty((2 * n + 1, len(self.x)))
        jy = np.empty_like(jx)
        jx[0], jy[0] = -over, along
        jx[1 : n + 1], jy[1 : n + 1] = self.axial, 0.0
        jx[n + 1 :], jy[n + 1 :] = -hb.T, self.across
        w = v[0]
        ax = -(hvb @ vb) - 2 * w * (vb @ self.across) - w * w * along
        ay = 2 * w * rate - w * w * over
        return along, over, jx, jy, ax, ay

    def equations(self, y):
        """M, f, G and the acceleration of the tip's height at rest of the unknowns."""
        n = len(y) // 2
        q, v = y[:n], y[n:]
        along, over, jx, jy, ax, ay = self.kinematics(q, v)
        s, c = np.sin(q[0]), np.cos(q[0])
        wx, wy = jx[:, :-1] * self.w, jy[:, :-1] * self.w
        m = wx @ jx[:, :-1].T + wy @ jy[:, :-1].T
        # Gravity has the components -g sin along the beam and -g cos across it.
        f = wx @ (-G * s - ax[:-1]) + wy @ (-G * c - ay[:-1]) - self.k * q
        row = s * jx[:, -1] + c * jy[:, -1]
        return m, f, row, s * ax[-1] + c * ay[-1]

    def acceleration(self, y, closed):
        m, f, row, rest = self.equations(y)
        both = np.linalg.solve(m, np.column_stack((f, row)))
        force = -(row @ both[:, 0] + rest) / (row @ both[:, 1]) if closed else 0.0
        return both[:, 0] + force * both[:, 1], force

    def gap(self, y):
        n = self.modes
        a, b = y[1 : n + 1], y[n + 1 : 2 * n + 1]
        along = LENGTH + a @ self.axial[:, -1] - 0.5 * b @ self.h[-1] @ b
        return along * np.sin(y[0]) + (b @ self.across[:, -1]) * np.cos(y[0])

    def closing(self, y):
        n = len(y) // 2
        _, _, row, _ = self.equations(y)
        return row @ y[n:]

    def energy(self, y):
        n = len(y) // 2
        q, v = y[:n], y[n:]
        along, over, *_ = self.kinematics(q, v)
        m = self.equations(y)[0]
        height = along[:-1] * np.sin(q[0]) + over[:-1] * np.cos(q[0])
        return 0.5 * v @ m @ v + 0.5 * self.k @ q**2 + G * self.w @ height


SAMPLES = 6


def first_root(value, slope, times, leaving):
    """The first time at which `value` falls to zero, with `slope` its derivative. `leaving`: it rises from zero."""
    root = lambda f, a, b: brentq(f, a, b, xtol=1e-18, rtol=1e-15)
    for a, b in zip(times[:-1], times[1:]):
        start = a
        if leaving and a == times[0]:
            if slope(b) >= 0:
                continue
            if slope(a) <= 0:
                if slope(a) < -1e-9:
                    return a
                continue  # zero but for rounding
            start = root(slope, a, b)  # the top of the flight
        if value(b) <= 0:
            return root(value, start, b) if value(start) > 0 else start
        if slope(start) < 0 < slope(b):
            least = root(slope, start, b)
            if value(least) < 0:
                return root(value, start, least)
    return None


def run(modes, e, end, tolerance=1e-12, resting=1e-6, report=None):
    """Events (time, closing speed, impulse, loss, energy behind) and detachments of a run from 45 degrees at rest."""
    p = Pendulum(modes)
    n = 2 * modes + 1
    y = np.zeros(2 * n)
    y[0] = np.pi / 4
    t, closed, leaving = 0.0, False, False
    events = []
    limit = np.inf
    offset = 0.0  # rounding of the gap at the last event
    while t < end:
        def derivative(_, y, closed=closed):
            a, force = p.acceleration(y[: 2 * n], closed)
            return np.concatenate((y[n : 2 * n], a, [force]))

        solver = DOP853(derivative, t, np.append(y, 0.0), end, rtol=tolerance, atol=tolerance * 1e-2, first_step=min(limit, 1e-6, 0.5 * (end - t)))
        while solver.status == "running":
            solver.step()
            dense = solver.dense_output()
            times = np.linspace(solver.t_old, solver.t, SAMPLES + 1)
            if closed:
                value = lambda s: p.acceleration(dense(s)[:-1], True)[1]
                slope = lambda s: 0.0
            else:
                value = lambda s: p.gap(dense(s)[:-1]) - offset
                slope = lambda s: p.closing(dense(s)[:-1])
            found = first_root(value, slope, times, leaving)
            leaving = False
            if found is not None:
                break
        if found is None:
            y, t = solver.y[:-1], solver.t
            if closed:
                events.append(("held", t, solver.y[-1]))
            break
        t, full = found, dense(found)
        y = full[:-1].copy()
        if closed:
            events.append(("open", t, full[-1], p.energy(y)))
            closed, leaving, offset = False, True, p.gap(y)
            limit = 1e-6
            continue
        m, f, row, rest = p.equations(y)
        u = row @ y[n:]
        image = np.linalg.solve(m, row)
        factor = 1 + (e if -u > resting else 0.0)
        strike = max(0.0, -factor * u / (row @ image))
        before = p.energy(y)
        y[n:] += strike * image
        after = p.energy(y)
        events.append(("strike", t, u, strike, before - after, after))
        if factor == 1.0:
            _, force = p.acceleration(y, True)
            closed = force > 0
        leaving, offset = not closed, p.gap(y)
        bend = abs(row @ np.linalg.solve(m, f) + rest)
        limit = 0.2 * max(e * abs(u), 1e-12) / bend if not closed else 1e-6
        if report:
            report(events[-1])
    return p, events, t, y


if __name__ == "__main__":
    modes, e = int(sys.argv[1]), float(sys.argv[2])
    end = float(sys.argv[3]) if len(sys.argv) > 3 else 0.6
    tolerance = float(sys.argv[4]) if len(sys.argv) > 4 else 1e-12
    p, events, t, y = run(modes, e, end, tolerance)
    for event in events:
        if event[0] == "strike" and event[3] == 0.0:
            continue  # touches that are rounding
        print(event[0], *(f"{x:.12g}" for x in event[1:]))
    print("end", t, p.gap(y), p.energy(y), y)
