"""Collocation in time: R(z, z', z'', t) = 0 at the s points of Radau in each step, order 2 s - 1."""

import numpy as np
from numpy.polynomial import legendre
from scipy.linalg import lu_factor, lu_solve


def radau(s):
    """Points and integration matrix on [0, 1]: roots of P_s - P_(s-1), the last is 1."""
    roots = np.sort(legendre.legroots([0.0] * (s - 1) + [-1.0, 1.0]).real)
    c = np.append((roots[:-1] + 1) / 2, 1.0)
    powers = np.arange(1, s + 1)
    return c, (c[:, None] ** powers / powers) @ np.linalg.inv(c[:, None] ** (powers - 1))


def solve(residual, start, step, end, stages=5, observe=lambda *_: None):
    """From rest at `start`. `residual(t, z, v, a)` takes a column for each time. `observe(t, z, v, a)` after each step."""
    c, once = radau(stages)
    once, twice = step * once, step**2 * once @ once
    size = len(start)
    identity, steps = np.eye(size), round(end / step)
    z, v, a = np.array(start), np.zeros(size), np.zeros((size, stages))
    observe(0.0, z, v, np.zeros(size))
    factors = None
    for i in range(steps):
        times = (i + c) * step
        before = np.inf
        for iteration in range(30):
            if factors is None:
                at = [np.repeat(y[:, None], size, 1).astype(complex) for y in (z, v, a[:, 0])]
                blocks = []
                for j in range(3):
                    at[j] = at[j] + 1e-30j * identity
                    blocks.append(residual(times[:1], *at).imag / 1e-30)
                    at[j] = at[j].real.astype(complex)
                matrix = np.kron(np.eye(stages), blocks[2]) + np.kron(once, blocks[1]) + np.kron(twice, blocks[0])
                factors, fresh = lu_factor(matrix), True
            stage_z = z[:, None] + v[:, None] * c * step + a @ twice.T
            stage_v = v[:, None] + a @ once.T
            r = residual(times, stage_z, stage_v, a)
            change = lu_solve(factors, r.T.ravel()).reshape(stages, size).T
            a = a - change
            moved = np.abs(change @ twice.T).max() / (1e-6 + np.abs(stage_z).max())
            if moved < 1e-12 or (moved < 1e-9 and moved > 0.3 * before):
                break
            if moved > 0.3 * before and not fresh:
                factors, before = None, np.inf
                continue
            before, fresh = moved, False
        else:
            raise RuntimeError(f"no solution at {times[0]:.4f} s: {moved:.1e}")
        z, v = z + v * step + a @ twice[-1], v + a @ once[-1]
        observe(times[-1], z, v, a[:, -1])
        if iteration > 6:
            factors = None
