"""A beam with 6x6 sections by Hodges' intrinsic equations: steady states under rotation or loads, and small motion about them.

Unknowns along the arc length s of the unloaded reference line, in the section's own axes (tangent, height, across):
force F [N], moment M [N m], velocity V [m/s], angular velocity W [rad/s]; no displacement and no rotation is interpolated.

    F' = d/dt P + W x P - K x F - f                  (g, c)  = S (F, M)      strains, S the inverse of the 6x6 stiffness
    M' = d/dt H + W x H + V x P - K x M - (e1 + g) x F     (P, H)  = I (V, W)     momenta, I the 6x6 mass a length
    V' = d/dt g - K x V - (e1 + g) x W                K = k + c, k the curvature and twist of the unloaded line
    W' = d/dt c - K x W                               q' = -K x q      a direction fixed in space, seen from the section

Hodges, AIAA Journal 41 (2003) 1131 (without displacements) and Int. J. Solids Struct. 26 (1990) 1253 (mixed form).
Gauss-Legendre collocation on every element: order 2m at the ends of elements with m points.
"""

from dataclasses import dataclass, field

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import LinearOperator, eigs, splu

E1 = np.array([1.0, 0.0, 0.0])


def cross_matrix(v):
    """(..., 3) to (..., 3, 3): the matrix of v x."""
    m = np.zeros(v.shape + (3,), v.dtype)
    m[..., 0, 1], m[..., 0, 2], m[..., 1, 2] = -v[..., 2], v[..., 1], -v[..., 0]
    m[..., 1, 0], m[..., 2, 0], m[..., 2, 1] = v[..., 2], -v[..., 1], v[..., 0]
    return m


def gauss(m):
    """Points and weights of Gauss-Legendre on [0, 1], and the integrals a[i, j] of Lagrange polynomial j from 0 to point i."""
    x, w = np.polynomial.legendre.leggauss(m)
    x, w = (x + 1) / 2, w / 2
    powers = np.arange(1, m + 1)
    a = (x[:, None] ** powers / powers) @ np.linalg.inv(x[:, None] ** (powers - 1))
    return x, w, a


@dataclass
class Piece:
    """A part of the line on which everything is smooth.

    at(t), t in [0, 1] of shape (n,): ds/dt [m] (n,), k [1/m] (n, 3), stiffness (n, 6, 6), mass (n, 6, 6); order tangent, height, across.
    turn: the axes at the start of this piece, seen from those at the end of the piece before (a kink), columns are axes.
    """

    at: object
    turn: np.ndarray = field(default_factory=lambda: np.eye(3))


def uniform(length, stiffness, mass, curvature=(0, 0, 0), turn=None):
    """A piece with constant section and constant curvature (tangent: twist rate)."""
    stiffness, mass, curvature = (np.array(x, float) for x in (stiffness, mass, curvature))

    def at(t):
        one = np.ones(len(t))
        return length * one, one[:, None] * curvature, one[:, None, None] * stiffness, one[:, None, None] * mass

    return Piece(at, np.eye(3) if turn is None else np.asarray(turn, float))


@dataclass
class Load:
    """Loads [N, N m, N/m].

    force, couple: at the tip, fixed in space, in the axes of the frame that `root` belongs to; uniform: likewise, a length of the unloaded line.
    following_force, following_couple: at the tip, in the axes of the tip's section.
    """

    force: tuple = (0, 0, 0)
    couple: tuple = (0, 0, 0)
    uniform: tuple = (0, 0, 0)
    following_force: tuple = (0, 0, 0)
    following_couple: tuple = (0, 0, 0)


class Beam:
    """Clamped at its first end to a frame that turns steadily about a fixed axis; free, or loaded, at the other.

    root: 3x3, columns are the section axes (tangent, height, across) at the root in the axes of the turning frame.
    place: of the root in that frame, its origin on the axis of rotation [m].
    points, split: collocation points an element, elements a piece.
    tension_torsion: None, the law is linear, which is what a 6x6 matrix says; "fibres" (Wagner) or "beamdyn", see `strains`.
    """

    def __init__(self, pieces, root=None, place=(0, 0, 0), points=5, split=1, tension_torsion=None):
        self.root = np.eye(3) if root is None else np.asarray(root, float)
        self.place = np.asarray(place, float)
        self.points, self.elements = points, len(pieces) * split
        x, self.b, self.a = gauss(points)
        ds, k, stiffness, mass, turn = [], [], [], [], []
        # Closer together at the ends of a piece, where a compliance may grow steeply.
        cuts = (1 - np.cos(np.pi * np.arange(split + 1) / split)) / 2
        for piece in pieces:
            for i, (start, size) in enumerate(zip(cuts, np.diff(cuts))):
                parts = piece.at(start + size * x)
                ds.append(parts[0] * size)
                k.append(parts[1])
                stiffness.append(parts[2])
                mass.append(parts[3])
                turn.append(piece.turn if i == 0 else np.eye(3))
        self.ds, self.k, self.turn, self.mass = map(np.array, (ds, k, turn, mass))
        stiffness = np.array(stiffness)
        self.compliance = np.linalg.inv(stiffness)
        coupling = stiffness[..., 4, 4] + stiffness[..., 5, 5]
        self.coupling = None if tension_torsion is None else coupling
        self.cubic = coupling**2 / stiffness[..., 0, 0] if tension_torsion == "fibres" else 0 * coupling
        self.length = (self.ds * self.b).sum()
        # Units for the unknowns: a bending stiffness and a mass of the middle, the length.
        middle = self.compliance[len(self.compliance) // 2, 0]
        bending = 2 / (middle[4, 4] + middle[5, 5])
        time = self.length**2 * np.sqrt(self.mass[len(self.mass) // 2, 0, 0, 0] / bending)
        units = np.repeat([bending / self.length**2, bending / self.length, self.length / time, 1 / time], 3)
        self.time, self.units = time, units
        self.state = None

    def strains(self, y):
        """Strains (E, m, 6) of forces and moments y (E, m, 6), and their derivatives (E, m, 6, 6).

        Linear: e = S y. With tension-torsion F1 gains C c1^2 / 2 and M1 gains C g1 c1 (+ C^2 / EA c1^3 / 2 for "fibres"), C = EI2 + EI3:
        the axial strain of a fibre off the axis, g1 + r^2 c1^2 / 2, with one r^2 = C / EA; BeamDyn has the first two terms.
        """
        S = self.compliance
        strain = np.einsum("emij,emj->emi", S, y)
        if self.coupling is None:
            return strain, S
        C, D = self.coupling, self.cubic
        for _ in range(50):
            g, c = strain[..., 0], strain[..., 3]
            extra, by = np.zeros_like(y), np.zeros_like(S)
            extra[..., 0], extra[..., 3] = C * c**2 / 2, C * g * c + D * c**3 / 2
            by[..., 0, 3] = by[..., 3, 0] = C * c
            by[..., 3, 3] = C * g + 1.5 * D * c**2
            tangent = np.eye(6) + S @ by
            residual = strain - np.einsum("emij,emj->emi", S, y - extra)
            change = np.linalg.solve(tangent, residual[..., None])[..., 0]
            strain = strain - change
            if np.abs(change).max() < 1e-15 + 1e-14 * np.abs(strain).max():
                break
        return strain, np.linalg.solve(tangent, S)

    def transported(self, start):
        """Directions of space (rows) seen from the section: at the points, and at the ends, for the strains `self.strain`."""
        m, values = self.points, np.array(start, float)  # (directions, 3)
        ends, inner = [values], []
        curvature = self.k + self.strain[..., 3:]
        for e in range(self.elements):
            values = values @ self.turn[e]
            rate = -cross_matrix(curvature[e]) * self.ds[e][:, None, None]  # q' = rate q
            system = np.eye(3 * m) - (self.a[:, None, :, None] * rate.transpose(1, 0, 2)[None]).reshape(3 * m, 3 * m)
            stages = np.linalg.solve(system, np.tile(values.T, (m, 1))).reshape(m, 3, -1)
            values = values + np.einsum("j,jab,jbd->da", self.b, rate, stages)
            inner.append(stages.transpose(0, 2, 1))
            ends.append(values)
        return np.array(inner), np.array(ends)

    def line(self):
        """Places of the ends of elements and axes there (columns), in the turning frame, for the present strains."""
        inner, ends = self.transported(self.root)  # row i: direction i of the frame in section axes = row i of the rotation
        along = np.einsum("emia,ema->emi", inner, E1 + self.strain[..., :3])
        steps = np.einsum("em,em,emi->ei", self.ds, self.b + 0 * self.ds, along)
        return self.place + np.concatenate([np.zeros((1, 3)), np.cumsum(steps, 0)]), ends

    def equations(self, y, load, factor):
        """Right sides f (E, m, n) of y' = f + B dy/dt at the points, their derivatives, and B; y (E, m, n)."""
        n = y.shape[-1]
        F, M, V, W = (y[..., 3 * i : 3 * i + 3] for i in range(4))
        strain, slope = self.strains(y[..., :6])
        momentum = np.einsum("emij,emj->emi", self.mass, y[..., 6:12])
        e = E1 + strain[..., :3]
        K = self.k + strain[..., 3:]
        P, H = momentum[..., :3], momentum[..., 3:]
        f = np.zeros_like(y)
        f[..., :3] = np.cross(W, P) - np.cross(K, F)
        f[..., 3:6] = np.cross(W, H) + np.cross(V, P) - np.cross(K, M) - np.cross(e, F)
        f[..., 6:9] = -np.cross(K, V) - np.cross(e, W)
        f[..., 9:12] = -np.cross(K, W)
        d = np.zeros(y.shape + (n,))
        c = cross_matrix
        Kx, ex, Fx, Mx, Vx, Wx, Px, Hx = map(c, (K, e, F, M, V, W, P, H))
        by_strain = np.zeros(y.shape[:2] + (12, 6))
        by_strain[..., :3, 3:] = Fx
        by_strain[..., 3:6, :3], by_strain[..., 3:6, 3:] = Fx, Mx
        by_strain[..., 6:9, :3], by_strain[..., 6:9, 3:] = Wx, Vx
        by_strain[..., 9:12, 3:] = Wx
        by_momentum = np.zeros(y.shape[:2] + (12, 6))
        by_momentum[..., :3, :3] = Wx
        by_momentum[..., 3:6, :3], by_momentum[..., 3:6, 3:] = Vx, Wx
        d[..., :12, :6] = by_strain @ slope
        d[..., :12, 6:12] = by_momentum @ self.mass
        for i in range(4):
            d[..., 3 * i : 3 * i + 3, 3 * i : 3 * i + 3] -= Kx
        d[..., 3:6, :3] -= ex
        d[..., 6:9, 9:12] -= ex
        d[..., :3, 9:12] -= Px
        d[..., 3:6, 9:12] -= Hx
        d[..., 3:6, 6:9] -= Px
        rate = np.zeros_like(d)
        rate[..., :6, 6:12] = self.mass
        rate[..., 6:12, :6] = slope
        for i in range((n - 12) // 3):
            at = slice(12 + 3 * i, 15 + 3 * i)
            q = y[..., at]
            f[..., at] = -np.cross(K, q)
            d[..., at, at] -= Kx
            d[..., at, :6] += c(q) @ slope[..., 3:, :]
            f[..., :3] -= factor * load.uniform[i] * q
            d[..., :3, at] -= factor * load.uniform[i] * np.eye(3)
        return f, d, rate

    def system(self, y_nodes, y_points, spin, load, factor):
        """Residual, its matrix, and the matrix of rates, all in the beam's own units."""
        E, m, n = y_points.shape
        extra = n - 12
        units = np.concatenate([self.units, np.ones(extra)])
        f, d, rate = self.equations(y_points * units, load, factor)
        f, d, rate = f / units, d * units / units[:, None], rate * units / units[:, None] / self.time
        f, d, rate = f * self.ds[..., None], d * self.ds[..., None, None], rate * self.ds[..., None, None]
        turn = np.zeros((E, n, n))
        for i in range(n // 3):
            turn[:, 3 * i : 3 * i + 3, 3 * i : 3 * i + 3] = self.turn.transpose(0, 2, 1)
        start = np.einsum("eij,ej->ei", turn, y_nodes[:-1])
        weights = np.vstack([self.a, self.b])  # the last row gives the end of the element
        targets = np.concatenate([y_points, y_nodes[1:, None]], 1)
        residual = targets - start[:, None] - np.einsum("ij,ejn->ein", weights, f)
        # Places of unknowns and equations: node 0; then for each element its points and its end node.
        block = n * (m + 1)
        base = n + block * np.arange(E)
        unknown = np.arange(n)
        row = base[:, None, None] + n * np.arange(m + 1)[None, :, None] + unknown  # (E, m+1, n)
        column_start = np.concatenate([[0], base[:-1] + n * m])[:, None] + unknown  # (E, n)
        rows, columns, values, rates = [], [], [], []

        def put(r, c, v, b=None):
            r, c, v = np.broadcast_arrays(r, c, v)
            rows.append(r.ravel())
            columns.append(c.ravel())
            values.append(v.ravel())
            rates.append(np.zeros(v.size) if b is None else np.broadcast_to(b, v.shape).ravel())

        put(row, row, np.ones(row.shape))
        put(row[..., None], column_start[:, None, None, :], -turn[:, None])
        inner = row[:, None, :m, None, :]  # columns (E, 1, m, 1, n)
        put(row[:, :, None, :, None], inner, -weights[None, :, :, None, None] * d[:, None], weights[None, :, :, None, None] * rate[:, None])
        # At the root V, W and the directions; at the tip F and M. Equations 0 .. n - 1.
        end = base[-1] + n * m
        wanted = np.concatenate([self.root.T @ np.cross(spin, self.place), self.root.T @ spin]) * self.spin_factor
        boundary = np.zeros(n)
        boundary[:6] = y_nodes[0, 6:12] - wanted / self.units[6:12]
        put(np.arange(6), 6 + np.arange(6), 1.0)
        boundary[6:12] = y_nodes[-1, :6] - factor * np.concatenate([load.following_force, load.following_couple]) / self.units[:6]
        put(6 + np.arange(6), end + np.arange(6), 1.0)
        for i in range(extra // 3):
            at = 12 + 3 * i
            boundary[at : at + 3] = y_nodes[0, at : at + 3] - self.root[i]
            put(at + np.arange(3), at + np.arange(3), 1.0)
            q = y_nodes[-1, at : at + 3]
            for first, size in ((0, load.force[i]), (3, load.couple[i])):
                size = factor * size / self.units[first]
                boundary[6 + first : 9 + first] -= size * q
                put(6 + first + np.arange(3), end + at + np.arange(3), -size)
        rows, columns, values, rates = map(np.concatenate, (rows, columns, values, rates))
        size = n + block * E
        matrix = coo_matrix((values, (rows, columns)), (size, size)).tocsc()
        rate_matrix = coo_matrix((rates, (rows, columns)), (size, size)).tocsc()
        return np.concatenate([boundary, residual.ravel()]), matrix, rate_matrix

    def steady(self, spin=(0, 0, 0), load=None, tolerance=1e-11, steps=1):
        """Newton for the steady state; the load or the speed is raised in steps where the whole does not converge."""
        spin, load = np.asarray(spin, float), load or Load()
        dead = any(np.any(v) for v in (load.force, load.couple, load.uniform))
        n = 21 if dead else 12
        E, m = self.elements, self.points
        self.strain = np.zeros((E, m, 6))
        y = np.zeros(n + E * (m + 1) * n)
        inner, ends = self.transported(self.root)
        if dead:
            y[:n][12:] = ends[0].ravel()
            blocks = y[n:].reshape(E, m + 1, n)
            blocks[:, :m, 12:] = inner.reshape(E, m, 9)
            blocks[:, m, 12:] = ends[1:].reshape(E, 9)
        reached, step = 0.0, 1.0 / steps
        while reached < 1:
            factor = min(1.0, reached + step)
            found = self.newton(y.copy(), n, spin, load, factor, tolerance)
            if found is None:
                step /= 2
                if step < 1e-3:
                    raise RuntimeError("no steady state found")
                continue
            y, reached, step = found, factor, step * 1.5
        self.state = (y, n, spin, load)
        return self

    def split_up(self, y, n):
        blocks = y[n:].reshape(self.elements, self.points + 1, n)
        return np.concatenate([y[None, :n], blocks[:, -1]]), blocks[:, :-1]

    def newton(self, y, n, spin, load, factor, tolerance):
        self.spin_factor = factor
        last = np.inf
        for _ in range(40):
            nodes, points = self.split_up(y, n)
            residual, matrix, rate = self.system(nodes, points, spin, load, factor)
            change = splu(matrix).solve(residual)
            size = np.abs(change).max() / (1 + np.abs(y).max())
            y = y - change
            if not np.isfinite(size) or size > 1e6:
                return None
            # Converged, or as far as rounding lets it.
            if size < tolerance or (size < 1e-8 and size >= last):
                nodes, points = self.split_up(y, n)
                self.strain = self.strains(points[..., :6] * self.units[:6])[0]
                return y
            last = size
        return None

    def frequencies(self, count=12, vectors=False):
        """Roots of small motion about the steady state: [Hz] ascending, and the largest real part over |root| as a check.

        Roots come in pairs +-i w (and quadruples where unstable); one of each pair is given, as the root / (2 pi i) if vectors.
        """
        y, n, spin, load = self.state
        self.spin_factor = 1.0
        nodes, points = self.split_up(y, n)
        _, matrix, rate = self.system(nodes, points, spin, load, 1.0)
        factors = splu(matrix)
        size = len(y)
        operator = LinearOperator((size, size), lambda x: factors.solve(rate @ x), dtype=float)
        start = factors.solve(rate @ np.random.default_rng(1).standard_normal(size))
        values, shapes = eigs(operator, k=2 * count + 4, which="LM", v0=start, tol=1e-13, ncv=min(size - 2, 6 * count + 30), maxiter=20000)
        roots = 1 / values / self.time
        keep = roots.imag >= -1e-9 * np.abs(roots)
        order = np.argsort(np.abs(roots[keep]))[:count]
        roots, shapes = roots[keep][order], shapes[:, keep][:, order]
        if not vectors:
            return roots.imag / (2 * np.pi), np.abs(roots.real / np.abs(roots)).max()
        return roots, [self.split_up(v, n) for v in shapes.T]

    def tip(self):
        """Place of the tip [m] and axes there (columns), in the turning frame."""
        places, axes = self.line()
        return places[-1], axes[-1]


def section(EA, GA2, GA3, GJ, EI2, EI3):
    """Stiffness of a section without couplings; 2 height, 3 across; EI2 bends about the height axis."""
    return np.diag([EA, GA2, GA3, GJ, EI2, EI3]).astype(float)


def inertia(m, polar=None, i2=0.0, i3=0.0, c2=0.0, c3=0.0, i23=0.0):
    """Mass a length: m [kg/m], moments about the mass centre (polar = i2 + i3 if not given), mass centre at (c2, c3)."""
    polar = i2 + i3 if polar is None else polar
    c = cross_matrix(np.array([0.0, c2, c3]))
    about = np.array([[polar, 0, 0], [0, i2, -i23], [0, -i23, i3]])
    return np.block([[m * np.eye(3), -m * c], [m * c, about - m * c @ c]])
