"""Cone problems of contacts from runs, solved by several methods: how many iterations, how long, and what residual is left.

    cargo build --release -p flexion-case --example cones
    pip install -r requirements.txt
    python compare.py ../../target/release/examples/cones

A problem has a matrix A, rows G, laws of the rows, multipliers L0 from which it starts, and u = b before they change. Wanted are multipliers L in their
cones with u = b + G A^-1 G^T (L - L0) complementary to them. The residual is |L - P(L - s u)| over the largest |L|, with the projection P on the cones and
s = 1/W_ii of each row, of two rows of friction the smaller.
"""

import json
import pathlib
import subprocess
import sys
import time

import clarabel
import numpy as np
from scipy import sparse

HERE = pathlib.Path(__file__).parent
SWEEPS = 20_000


class Problem:
    """A problem as it is stored."""

    def __init__(self, path):
        of = json.loads(path.read_text())
        self.name, n = path.stem, of["order"]
        self.A = np.zeros((n, n))
        for i, j, x in of["matrix"]:
            self.A[i, j] = x
        m = len(of["rows"])
        self.G = np.zeros((m, n))
        for i, row in enumerate(of["rows"]):
            for j, g in row:
                self.G[i, j] = g
        self.b, self.start = np.array(of["b"]), np.array(of["start"])
        # Normal rows, each with the rows of its friction and the coefficient.
        self.groups = {i: ([], 0.0) for i, law in enumerate(of["laws"]) if law[0] == "unilateral"}
        for i, law in enumerate(of["laws"]):
            if law[0] == "friction":
                rows, _ = self.groups[law[2]]
                self.groups[law[2]] = ([*rows, i], law[1])
        self.W = self.G @ np.linalg.solve(self.A, self.G.T)
        self.c = self.b - self.W @ self.start
        diagonal = np.diag(self.W).copy()
        for rows, _ in self.groups.values():
            if rows:
                diagonal[rows] = diagonal[rows].max()
        self.scale = 1 / np.where(diagonal > 0, diagonal, 1)
        # Entries that G has in the normal rows first, and the sizes of the discs.
        self.normals = np.array(list(self.groups))

    def project(self, z):
        """Friction on the disc whose radius the normal multiplier of the same argument has."""
        out = np.zeros_like(z)
        for n, (rows, mu) in self.groups.items():
            out[n] = max(z[n], 0.0)
            if rows:
                size, radius = np.hypot.reduce(z[rows]), mu * out[n]
                out[rows] = z[rows] if size <= radius else z[rows] * (radius / size)
        return out

    def cone(self, z):
        """The projection on the cones mu L_n >= |L_t|, in the norm of their own scale 1."""
        out = np.zeros_like(z)
        for n, (rows, mu) in self.groups.items():
            if not rows:
                out[n] = max(z[n], 0.0)
                continue
            size = np.hypot.reduce(z[rows])
            if size <= mu * z[n]:
                out[n], out[rows] = z[n], z[rows]
            elif mu * size > -z[n]:
                out[n] = (z[n] + mu * size) / (1 + mu * mu)
                out[rows] = z[rows] * (mu * out[n] / size)
        return out

    def shift(self, u):
        """mu |u_t| of each contact: what makes the dual cone's condition that of Coulomb (de Saxce and Feng 1998)."""
        s = np.zeros_like(u)
        for n, (rows, mu) in self.groups.items():
            if rows:
                s[n] = mu * np.hypot.reduce(u[rows])
        return s

    def residual(self, L):
        u = self.c + self.W @ L
        return np.abs(L - self.project(L - self.scale * u)).max() / max(np.abs(L).max(), 1e-300)


def interior(p):
    """Clarabel's interior point on the convex problem, and the shift by its fixed point."""
    m, n = p.G.shape
    A = sparse.csc_matrix(0.5 * (p.A + p.A.T))
    # min 1/2 y A y + c L, A y = G^T L, the rows of each contact in a second-order cone.
    P = sparse.block_diag([sparse.triu(A), sparse.csc_matrix((m, m))], format="csc")
    rows, cones = [sparse.hstack([A, -sparse.csc_matrix(p.G.T)])], [clarabel.ZeroConeT(n)]
    for normal, (friction, mu) in p.groups.items():
        block = sparse.lil_matrix((1 + len(friction), n + m))
        block[0, n + normal] = -(mu if friction else 1.0)
        for k, i in enumerate(friction):
            block[1 + k, n + i] = -1.0
        rows.append(block.tocsc())
        cones.append(clarabel.SecondOrderConeT(1 + len(friction)) if friction else clarabel.NonnegativeConeT(1))
    K = sparse.vstack(rows, format="csc")
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.tol_gap_abs = settings.tol_gap_rel = settings.tol_feas = 1e-12
    shift, count, best = np.zeros(m), 0, (np.inf, None)
    for outer in range(100):
        q = np.concatenate([np.zeros(n), p.c + shift])
        solution = clarabel.DefaultSolver(P, q, K, np.zeros(K.shape[0]), cones, settings).solve()
        count += solution.iterations
        L = np.array(solution.x)[n:]
        best = min(best, (p.residual(L), outer), key=lambda of: of[0])
        if best[0] < 1e-10:
            break
        shift = p.shift(p.c + p.W @ L)
    return count, best[0]


def accelerated(p):
    """Nesterov's projected gradients with restarts, and the shift at every step."""
    # In multipliers L = D x, W's diagonal is one, so that one step fits all rows; the discs stay discs, for their rows share their scale.
    L, z, t = p.cone(p.start), p.cone(p.start), 1.0
    step = 1 / np.linalg.eigvalsh(0.5 * (p.W + p.W.T))[-1]
    best = p.residual(L)
    for k in range(SWEEPS):
        u = p.c + p.W @ z
        new = p.cone(z - step * (u + p.shift(u)))
        if (z - new) @ (new - L) > 0:
            t = 1.0
        following = 0.5 * (1 + np.sqrt(1 + 4 * t * t))
        z = new + (t - 1) / following * (new - L)
        L, t = new, following
        if k % 50 == 0:
            best = min(best, p.residual(L))
            if best < 1e-10:
                break
    return k + 1, best


def relaxed(p):
    """Projected Gauss-Seidel, a disc as one vector."""
    L = p.start.copy()
    best = p.residual(L)
    u = p.c + p.W @ L
    for k in range(SWEEPS):
        for n, (rows, mu) in p.groups.items():
            new = max(L[n] - p.scale[n] * u[n], 0.0)
            u += p.W[:, n] * (new - L[n])
            L[n] = new
            if rows:
                z = L[rows] - p.scale[rows] * u[rows]
                size, radius = np.hypot.reduce(z), mu * L[n]
                z = z if size <= radius else z * (radius / size)
                u += p.W[:, rows] @ (z - L[rows])
                L[rows] = z
        if k % 20 == 0:
            best = min(best, p.residual(L))
            if best < 1e-10:
                break
    return k + 1, best


def main():
    print("| problem | contacts | unknowns | rank of W | Newton, of Flexion | Clarabel, 0.11 | accelerated gradients | Gauss–Seidel |")
    print("|---|---|---|---|---|---|---|---|")
    for path in sorted((HERE / "problems").glob("*.json")):
        p = Problem(path)
        cells = []
        found = json.loads(subprocess.run([sys.argv[1], path], check=True, capture_output=True, text=True).stdout)
        cells.append((found["iterations"], p.residual(np.array(found["multipliers"])), found["seconds"]))
        for method in [interior, accelerated, relaxed]:
            start = time.process_time()
            count, residual = method(p)
            cells.append((count, residual, time.process_time() - start))
        rank = np.linalg.matrix_rank(p.W, tol=1e-10 * np.abs(p.W).max())
        said = [f"{count}: {residual:.0e} in {seconds:.2g} s" for count, residual, seconds in cells]
        print(f"| {p.name} | {len(p.groups)} | {len(p.A)} | {rank} of {len(p.W)} |", " | ".join(said), "|")


if __name__ == "__main__":
    main()
