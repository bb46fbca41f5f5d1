"""A slender beam in space whose unknowns are its axial strain and its three curvatures at Gauss points of pieces.

See README.md for the equations. Arrays are (..., point, time); of vectors and quaternions the first axis is the component.
"""

import numpy as np

from planar_beam import integration


def cross(a, b):
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def product(p, q):
    """Of quaternions, the scalar first."""
    return np.concatenate([(p[0] * q[0] - (p[1:] * q[1:]).sum(0))[None], p[0] * q[1:] + q[0] * p[1:] + cross(p[1:], q[1:])])


def rotated(q, x):
    t = 2 * cross(q[1:], x)
    return x + q[0] * t + cross(q[1:], t)


def inverse(q):
    return np.concatenate([q[:1], -q[1:]])


class Slender:
    """Clamped at zero along x. Stiffness (EA, GJ, EI2, EI3), mass per length, rotary inertia (three per length)."""

    def __init__(self, lengths, points, stiffness, mass=0.0, rotary=(0, 0, 0), turns=None, curvature=(0, 0, 0)):
        """`turns`: the rotation (quaternion) at the start of each piece; `curvature` of the beam without forces."""
        z, w, matrix = integration(points)
        self.points, self.pieces, n = points, len(lengths), points * len(lengths)
        self.w = np.concatenate([length / 2 * w for length in lengths])
        self.s, self.local = np.zeros((n, n)), [length / 2 * matrix for length in lengths]
        for i in range(self.pieces):
            rows = slice(i * points, (i + 1) * points)
            self.s[rows, : i * points] = self.w[: i * points]
            self.s[rows, rows] = self.local[i]
        self.from_tip = self.s.T * self.w / self.w[:, None]
        self.n, self.mass, self.stiffness = n, mass, np.array(stiffness, float)[:, None, None]
        self.rotary = np.array(rotary, float)[:, None, None]
        self.curvature = np.array(curvature, float)[:, None, None]
        self.turns = turns or [(1.0, 0, 0, 0)] * self.pieces

    def rotations(self, curvature):
        """Quaternions of the sections, q' = q k/2, by collocation at the Gauss points of each piece."""
        m, times = self.points, curvature.shape[2]
        out = np.zeros((4, self.n, times), curvature.dtype)
        end = np.zeros((4, times), curvature.dtype)
        end[0] = 1
        for i in range(self.pieces):
            start = product(end, np.array(self.turns[i], float)[:, None] + 0 * end)
            k = curvature[:, i * m : (i + 1) * m]
            # Columns of (q -> q k/2) for the four units.
            zero = 0 * k[0]
            right = np.array([[zero, -k[0], -k[1], -k[2]], [k[0], zero, k[2], -k[1]], [k[1], -k[2], zero, k[0]], [k[2], k[1], -k[0], zero]]) / 2
            system = np.eye(4 * m) - np.einsum("ij,abjt->taibj", self.local[i], right).reshape(times, 4 * m, 4 * m)
            q = np.linalg.solve(system, np.repeat(start.T[:, :, None], m, 2).reshape(times, 4 * m, 1))
            q = q.reshape(times, 4, m).transpose(1, 2, 0)
            out[:, i * m : (i + 1) * m] = q
            end = start + np.einsum("j,abjt,bjt->at", self.w[i * m : (i + 1) * m], right, q)
        return out

    def split(self, y):
        y = y.reshape(4, self.n, -1)
        return y[0], y[1:]

    def motion(self, z, v, a):
        e, k = self.split(z)
        de, dk = self.split(v)
        dde, ddk = self.split(a)
        q = self.rotations(k + self.curvature)
        axis = np.zeros_like(k)
        axis[0] = 1
        t, turning = rotated(q, axis), rotated(q, dk)
        w = self.s @ turning
        acceleration = self.s @ (rotated(q, ddk) + cross(w, turning))
        tangent = (1 + e) * t
        second = dde * t + 2 * de * cross(w, t) + (1 + e) * (cross(acceleration, t) + cross(w, cross(w, t)))
        return q, t, tangent, second, w, acceleration

    def residual(self, z, v, a, forces):
        """`forces`: a list of (row of weights that are one from the root to the place of the force, vector (3, time))."""
        e, k = self.split(z)
        q, t, tangent, second, w, acceleration = self.motion(z, v, a)
        force = -(self.from_tip @ (self.mass * (self.s @ second)))
        for reach, vector in forces:
            force = force + reach[:, None] * vector[:, None, :]
        body = rotated(inverse(q), w)
        spin = rotated(q, self.rotary * rotated(inverse(q), acceleration) + cross(body, self.rotary * body))
        moment = rotated(inverse(q), self.from_tip @ (cross(tangent, force) - spin))
        along = (force * t).sum(0)
        return (self.stiffness * np.concatenate([e[None], k]) - np.concatenate([along[None], moment])).reshape(4 * self.n, -1)

    def tip(self, z):
        zero = np.zeros_like(z)
        return self.w @ self.motion(*(y[:, None] for y in (z, zero, zero)))[2][..., 0].T
