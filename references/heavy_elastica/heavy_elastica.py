"""A heavy inextensible beam that hangs from a hold onto a smooth floor (the planar elastica under its weight), by shooting.

From the touch-down, s = 0, to the hold, s = l: theta' = M / EI, M' = (R - q s) cos theta, x' = cos theta, y' = sin theta, with the weight q per length.
The floor is smooth and the end that lies on it is free, so that no force acts along the floor. At the touch-down theta = M = y = 0, for the part that
lies is straight and the floor gives no couple; there it presses with the force R. Of a hold at the height h either theta(l) (clamped) or M(l) (hinged) is
zero: two unknowns, R and l, and two conditions. Run it to print the values of verification/contact_floor and verification/contact_floor_space.
"""

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve


def hang(stiffness, weight, height, end, at=()):
    """R, l, moment and slope at the hold, horizontal extent, and (s, x, y) at distances `at` from the hold along the beam."""

    def run(force, length, points=None):
        def rates(s, u):
            return [u[1] / stiffness, (force - weight * s) * np.cos(u[0]), np.cos(u[0]), np.sin(u[0])]

        return solve_ivp(rates, (0.0, length), np.zeros(4), "DOP853", points, rtol=1e-13, atol=1e-15).y

    def off(unknown):
        theta, moment, _, y = run(*unknown)[:, -1]
        return [y - height, theta if end == "clamped" else moment]

    first = {"clamped": (72.0, 3.0), "hinged": (24.0, 2.0)}[end]
    length = (first[0] * stiffness * height / weight) ** 0.25
    # From the closed form of small slopes.
    force, length = fsolve(off, [weight * length / first[1], length], xtol=1e-13)
    assert max(map(abs, off([force, length]))) < 1e-11
    theta, moment, x, _ = run(force, length)[:, -1]
    places = np.array(sorted(length - a for a in at))
    shape = run(force, length, places) if len(places) else np.zeros((4, 0))
    return force, length, moment, theta, x, [(length - s, x - u[2], u[3]) for s, u in zip(places, shape.T)]


if __name__ == "__main__":
    for end, height, at in [("clamped", 0.5, [0.4, 0.8]), ("hinged", 0.5, [0.3, 0.6])]:
        force, length, moment, theta, x, shape = hang(1.0, 9.81, height, end, at)
        print(f"{end}, h = {height} m: R = {force:.9f} N, l = {length:.9f} m, at the hold M = {moment:.9f} N m, slope {theta:.9f} rad, extent {x:.9f} m")
        for s, away, y in shape:
            print(f"    {s:.3f} m from the hold: {away:.9f} m away from it, {y:.9f} m over the floor")
