"""Sections: mass per length, EA, ES, EI at the places x of a beam."""

import numpy as np


def constant(x, mass, ea, ei, es=0.0):
    return tuple(np.full_like(x, value) for value in (mass, ea, es, ei))


def graded(x, n, ceramic, metal, density=(3000.0, 2707.0), width=0.02, h=0.02):
    """A rectangle, modulus and density by a power law of its height: E(y) = (Ec - Em) (y/h + 1/2)^n + Em."""
    de = ceramic - metal
    mass = width * h * (density[0] + n * density[1]) / (n + 1)
    ea = width * (de * h / (n + 1) + metal * h)
    es = width * de * n * h**2 / (2 * (n + 1) * (n + 2))
    ei = width * (de * (n * n + n + 2) * h**3 / (4 * (n + 1) * (n + 2) * (n + 3)) + metal * h**3 / 12)
    return constant(x, mass, ea, ei, es)


def shaped(area, second, modulus=70e9, density=3000.0):
    a = area
    return density * a, modulus * a, 0 * a, modulus * second


def linear(x, root, tip, length=10.0):
    return root + (tip - root) * x / length


def circle(x):
    r = linear(x, 0.04, 0.02)
    return shaped(np.pi * r**2, np.pi * r**4 / 4)


def rectangle(x):
    b, h = linear(x, 0.008, 0.004), linear(x, 0.08, 0.04)
    return shaped(b * h, b * h**3 / 12)


def tube(x):
    outer, inner = linear(x, 0.05, 0.03), linear(x, 0.04, 0.025)
    return shaped(np.pi * (outer**2 - inner**2), np.pi * (outer**4 - inner**4) / 4)


def stepped(x):
    piece = np.searchsorted([4.0, 7.0], x)
    return shaped(np.array([6e-4, 4e-4, 3e-4])[piece], np.array([4e-7, 2e-7, 1e-7])[piece])


def table(x, rows):
    mass, ea, ei = (np.interp(x, rows[:, 0], rows[:, k]) for k in (1, 2, 3))
    return mass, ea, 0 * mass, ei
