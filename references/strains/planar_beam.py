"""A planar beam on a rotating hub whose unknowns are its axial strain e and its curvature k at Gauss points.

See README.md for the equations. Arrays have a row for each point and a column for each time.
"""

import numpy as np
from numpy.polynomial import legendre


def integration(points):
    """Gauss points and weights on [-1, 1], and the matrix of integrals from -1 to each point of the Lagrange polynomials."""
    x, w = legendre.leggauss(points)
    value = legendre.legvander(x, points)
    primitive = np.empty((points, points))
    primitive[:, 0] = x + 1
    for i in range(1, points):
        primitive[:, i] = (value[:, i + 1] - value[:, i - 1]) / (2 * i + 1)
    return x, w, primitive @ np.linalg.inv(value[:, :points])


class Beam:
    def __init__(self, coupling, section, ends, points, radius=0.0, inertia=0.0, rotary=0.0, gravity=None):
        """`ends`: where the section is not smooth, from the root to the tip; `points` in each piece. With `gravity` the
        hub is free, and its angle the last unknown; the axes are inertial. `rotary`: inertia of the section per length."""
        z, w, matrix = integration(points)
        half = 0.5 * np.diff(ends)
        self.x = np.concatenate([ends[i] + half[i] * (z + 1) for i in range(len(half))])
        self.w = np.concatenate([h * w for h in half])
        n = self.n = len(self.x)
        self.s = np.zeros((n, n))  # integrals from the root
        for i, h in enumerate(half):
            rows = slice(i * points, (i + 1) * points)
            self.s[rows, : i * points] = self.w[: i * points]
            self.s[rows, rows] = h * matrix
        self.from_tip = self.s.T * self.w / self.w[:, None]  # integrals from the tip: the adjoint of s
        self.coupling, self.radius, self.inertia = coupling, radius, inertia
        self.rotary, self.gravity = rotary, gravity
        self.size = 2 * n + (gravity is not None)
        self.mass, self.ea, self.es, self.ei = (v[:, None] for v in section(self.x))
        self.pull = self.from_tip @ (self.mass * (radius + self.x[:, None]))

    def rotation(self, y):
        turned = self.s @ y[self.n : 2 * self.n]
        return turned if self.gravity is None else turned + y[-1]

    def shape(self, z, v, a):
        """The tangent r', its rates, and its derivatives by strain and rotation, each (along, across)."""
        e, de, dde = (y[: self.n] for y in (z, v, a))
        p, dp, ddp = (self.rotation(y) for y in (z, v, a))
        if self.coupling == "exact":
            c, s = np.cos(p), np.sin(p)
            tangent, normal = np.array([c, s]), np.array([-s, c])
            rate = de * tangent + (1 + e) * dp * normal
            second = (dde - (1 + e) * dp**2) * tangent + (2 * de * dp + (1 + e) * ddp) * normal
            return (1 + e) * tangent, rate, second, tangent, (1 + e) * normal
        # f_e = (1, 0) and f_p = (0, 1), with f_p = (-p, 1) of the high coupling.
        tangent, rate, second = np.array([1 + e, p]), np.array([de, dp]), np.array([dde, ddp])
        along, across = np.array([1 + 0 * p, 0 * p]), np.array([0 * p, 1 + 0 * p])
        if self.coupling == "high":
            self.shorten(p, dp, ddp, tangent, rate, second)
            across[0] = -p
        return tangent, rate, second, along, across

    @staticmethod
    def shorten(p, dp, ddp, tangent, rate, second):
        """Takes the slope p^2/2 of the foreshortening off, and its rates."""
        tangent[0] -= p**2 / 2
        rate[0] -= p * dp
        second[0] -= p * ddp + dp**2

    def forces(self, z, v, a, speed, acceleration):
        """Places and accelerations in the axes of the hub, force of the section."""
        tangent, rate, second, by_e, by_p = self.shape(z, v, a)
        x, y = self.s @ tangent
        x = x + self.radius
        dx, dy = self.s @ rate
        ax, ay = self.s @ second
        ax = ax - acceleration * y - 2 * speed * dy - speed**2 * x
        ay = ay + acceleration * x + 2 * speed * dx - speed**2 * y
        if self.gravity is not None:
            ay = ay + self.gravity
        force = -(self.from_tip @ (self.mass * np.array([ax, ay])))
        return x, y, ax, ay, force, by_e, by_p

    def residual(self, z, v, a, speed, acceleration, couple=0.0):
        *_, force, by_e, by_p = self.forces(z, v, a, speed, acceleration)
        along, across = (force * by_e).sum(0), (force * by_p).sum(0)
        if self.coupling == "first":
            across = across - speed**2 * self.pull * (self.s @ z[self.n :])
        if self.rotary:
            across = across - self.rotary * (acceleration + self.rotation(a))
        e, k = z[: self.n], z[self.n : 2 * self.n]
        out = [self.ea * e - self.es * k - along, self.ei * k - self.es * e - self.from_tip @ across - couple]
        if self.gravity is not None:
            out.append((self.inertia * a[-1] - self.w @ across)[None])
        return np.concatenate(out)

    def tip(self, z, v, a):
        """Displacement of the tip, its velocity and acceleration in the axes of the hub, (along, across)."""
        tangent, rate, second, *_ = self.shape(z, v, a)
        if self.coupling == "first":  # with the foreshortening
            self.shorten(*(self.rotation(y) for y in (z, v, a)), tangent, rate, second)
        tangent[0] -= 1
        return np.array([self.w @ tangent, self.w @ rate, self.w @ second])

    def torque(self, z, v, a, speed, acceleration):
        """That the motion of the hub needs."""
        x, y, ax, ay, *_ = self.forces(z, v, a, speed, acceleration)
        out = self.inertia * acceleration + self.w @ (self.mass * (x * ay - y * ax))
        if self.coupling == "first":
            p, dp = self.s @ z[self.n :], self.s @ v[self.n :]
            out -= self.w @ (self.pull * (acceleration * p**2 + 2 * speed * p * dp))
        return out
