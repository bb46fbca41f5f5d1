"""Closed forms and power series that the program is held against; nothing here uses `beam.py`."""

import numpy as np
from scipy.integrate import solve_bvp
from scipy.optimize import brentq
from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc


def roots(function, start, stop, count, steps=4000):
    """The first roots of a function of one variable, by change of sign and Brent's method."""
    found, grid = [], np.linspace(start, stop, steps)
    values = [function(x) for x in grid]
    for a, b, fa, fb in zip(grid[:-1], grid[1:], values[:-1], values[1:]):
        if np.sign(fa) != np.sign(fb) and len(found) < count:
            found.append(brentq(function, a, b, xtol=1e-14, rtol=1e-14))
    return np.array(found)


def timoshenko(length, bending, shear, mass, inertia, count):
    """Circular frequencies [rad/s] of a uniform clamped Timoshenko beam, below the cut-off (Huang, J. Appl. Mech. 28 (1961) 579)."""
    r2, s2 = inertia / (mass * length**2), bending / (shear * length**2)
    unit = np.sqrt(bending / mass) / length**2

    def equation(b):
        root = np.sqrt((r2 - s2) ** 2 + 4 / b**2)
        alpha, beta = np.sqrt((root - r2 - s2) / 2), np.sqrt((root + r2 + s2) / 2)
        return (
            2 / np.cosh(b * alpha)
            + (b**2 * (r2 - s2) ** 2 + 2) * np.cos(b * beta)
            - b * (r2 + s2) / np.sqrt(1 - b**2 * r2 * s2) * np.tanh(b * alpha) * np.sin(b * beta)
        )

    top = min(1 / np.sqrt(r2 * s2) * (1 - 1e-9), 20.0 * count**2)
    return roots(equation, 0.5, top, count) * unit


def series(c0, c1, rhs, terms=400):
    """Coefficients of the power series whose next ones `rhs` gives."""
    c = [c0, c1]
    while len(c) < terms:
        c.append(rhs(c, len(c)))
    return np.array(c, dtype=np.longdouble)


def rotating(speed, hub, lag, count):
    """w'''' - (T w')' - (f^2 + lag s^2) w = 0, T = s^2 ((1 - x^2)/2 + hub (1 - x)); clamped, free. Frequencies f in units of sqrt(EI/m)/L^2.

    lag: 0 out of the plane of rotation, 1 in it. Power series from the root in numbers of 64 bits of mantissa.
    """
    s2, n = np.longdouble(speed) ** 2, 260
    t0, t1, t2 = s2 * (np.longdouble(0.5) + hub), -s2 * hub, -s2 / 2
    powers = np.arange(n, dtype=np.longdouble)

    def shape(square, first):
        c = np.zeros(n, np.longdouble)
        c[2 + first] = 1
        for k in range(n - 4):
            # x^k: (k+4)(k+3)(k+2)(k+1) c4 = (T w')' + square w
            right = square * c[k] + (k + 1) * (t0 * (k + 2) * c[k + 2] + t1 * (k + 1) * c[k + 1] + t2 * k * c[k])
            c[k + 4] = right / ((k + 4) * (k + 3) * (k + 2) * (k + 1))
        return (c * powers * (powers - 1)).sum(), (c * powers * (powers - 1) * (powers - 2)).sum()

    def equation(f):
        (a, b), (c, d) = (shape(np.longdouble(f) ** 2 + lag * s2, i) for i in (0, 1))
        return float((a * d - b * c) / (abs(a * d) + abs(b * c)))

    return roots(equation, 0.2, 25.0 * count**2 + 3 * speed * count, count, 1500)


def strip_torsion(length, torsion, polar, extra, gyration, mass, speed, count):
    """((GJ + r2 T) p')' + (w^2 I - extra) p = 0, T = m s^2 (L^2 - x^2)/2; p(0) = 0, p'(L) = 0. Circular frequencies w.

    polar: I [kg m]; extra: s^2 (i_in - i_out), the moment that turns the strip back into the plane of rotation; r2 = gyration.
    """
    stiff = torsion + gyration * mass * speed**2 * length**2 / 2
    fall = gyration * mass * speed**2 * length**2 / 2

    def equation(w):
        square, c = (w**2 * polar - extra) * length**2, np.zeros(400)
        c[1] = 1.0
        for k in range(len(c) - 2):
            # ((stiff - fall x^2) p')' + square p = 0
            c[k + 2] = (fall * k * (k + 1) - square) * c[k] / (stiff * (k + 2) * (k + 1))
        return (c * np.arange(len(c))).sum()

    return roots(equation, 1e-3, 8 * np.sqrt((stiff / length**2 * 3 + extra) / polar) * count, count)


def offset_mass(length, bending, torsion, mass, polar, offset, count):
    """EI w'''' = w2 (m w + m e p), GJ p'' = -w2 (I p + m e w): bending and torsion, mass centre e beside the axis; I about the axis."""

    def equation(w):
        w2 = w * w
        # exp(l x): (EI y^2 - m w2)(GJ y + I w2) = -(m e w2)^2 ... with y = l^2 and p = (EI y^2 - m w2) / (m e w2) w
        y = np.roots([bending * torsion, bending * polar * w2, -mass * w2 * torsion, -mass * polar * w2**2 + (mass * offset * w2) ** 2])
        y = np.sort(y.real)
        columns = []
        for v in y:
            ratio, l = (bending * v**2 - mass * w2) / (mass * offset * w2), np.sqrt(abs(v)) * length
            scale = np.cosh(l) if v > 0 else 1.0
            c, s = (np.cosh(l) / scale, np.sinh(l) / scale) if v > 0 else (np.cos(l), np.sin(l))
            l, sign = l / length, np.sign(v)
            # even: C(x), odd: S(x); rows w(0), w'(0), p(0), w''(L), w'''(L), p'(L)
            columns.append([1 / scale, 0, ratio / scale, sign * l**2 * c, l**3 * s, ratio * sign * l * s])
            columns.append([0, l / scale, 0, sign * l**2 * s, sign * l**3 * c, ratio * l * c])
        matrix = np.array(columns).T
        matrix /= np.abs(matrix).max(1, keepdims=True)
        return np.linalg.det(matrix / np.abs(matrix).max(0))

    low = np.sqrt(bending / mass) / length**2
    return roots(equation, 0.3 * low, 130.0 * low, count, 20000)


def elastica(load):
    """Tip (x, y) / L of an inextensible cantilever under a dead force across its end, load = F L^2 / EI (Bisshopp and Drucker 1945)."""

    def modulus(k):
        return ellipk(k**2) - ellipkinc(np.arcsin(1 / (k * np.sqrt(2))), k**2) - np.sqrt(load)

    k = brentq(modulus, np.sqrt(0.5) + 1e-12, 1 - 1e-12)
    phi = np.arcsin(1 / (k * np.sqrt(2)))
    x = np.sqrt(2 * (2 * k**2 - 1) / load)
    y = 1 - 2 / np.sqrt(load) * (ellipe(k**2) - ellipeinc(phi, k**2))
    return x, y


def heavy(length, bending, axial, shear, load):
    """Displacement of the tip (across, along) of a plane cantilever with shear under a dead load a length, as a boundary value problem."""

    def rate(s, y):
        angle, moment = y[0], y[1]
        force = load * (length - s)
        n, q = force * np.sin(angle), force * np.cos(angle)
        g1, g2 = 1 + n / axial, q / shear
        return np.array([moment / bending, -(g1 * q - g2 * n), g1 * np.cos(angle) - g2 * np.sin(angle), g1 * np.sin(angle) + g2 * np.cos(angle)])

    s = np.linspace(0, length, 200)
    guess = np.array([1.4 * s / length, 0 * s, s, 0 * s])
    y = solve_bvp(rate, lambda a, b: np.array([a[0], a[2], a[3], b[1]]), s, guess, tol=1e-10, max_nodes=100000).y[:, -1]
    return np.array([y[3], y[2] - length])
