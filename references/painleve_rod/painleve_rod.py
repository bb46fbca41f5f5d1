"""Painleve's rod: a homogeneous rod of mass m and length 2l slides on a rough plane on its lower end, away from the side to which it leans.

phi is its angle over the plane, c and s its cosine and sine, x the place of its centre along the plane, J = m l^2 / 3. While the lower end slides towards -x, the plane
presses with N and pulls with mu N towards +x:

    m x'' = mu N,   J phi'' = -l N (c - mu s),   m (l sin phi)'' = N - m g.

The first two in the third give p N = m (g - l s phi'^2) with p = 1 + 3 c (c - mu s). For p < 0 no N >= 0 holds the end on the plane, and without a force it would
enter it: the paradox, from mu = (1 + 3 c^2) / (3 s c) on, which is 4/3 at tan phi = 2 and more at any other angle. An impulse stops the end then; about the end the
angular momentum stays, 4/3 m l^2 phi' = m l s v, and so do the impulses l c phi' m along the normal and m (v - l s phi') along the plane, whose ratio is the same mu.
Once the end has stopped it stays, and the rod turns about it, phi'' = -3 g c / (4 l).

Run it to print the values of verification/contact_painleve.
"""

import numpy as np
from scipy.integrate import solve_ivp

G, MASS, HALF = 9.81, 1.0, 0.5
EXACT = dict(method="DOP853", rtol=1e-12, atol=1e-14)


def run(mu, duration, speed=1.0, tangent=2.0):
    phi = np.arctan(tangent)
    inertia = MASS * HALF**2 / 3.0
    ratio = lambda phi: 1.0 + 3.0 * np.cos(phi) * (np.cos(phi) - mu * np.sin(phi))
    state, start, stopped = np.array([HALF * np.cos(phi), phi, -speed, 0.0]), 0.0, None
    if ratio(phi) > 0.0:

        def slides(_, u):
            c, s = np.cos(u[1]), np.sin(u[1])
            force = MASS * (G - HALF * s * u[3] ** 2) / ratio(u[1])
            return [u[2], u[3], mu * force / MASS, -HALF * force * (c - mu * s) / inertia]

        stops = lambda _, u: u[2] + HALF * np.sin(u[1]) * u[3]
        stops.terminal = True
        print(f"    N = {MASS * G / ratio(phi):.9f} N at the start")
        motion = solve_ivp(slides, (0.0, duration), state, events=stops, **EXACT)
        assert min(ratio(motion.y[1])) > 0.0
        state, start = motion.y[:, -1], motion.t[-1]
        stopped = start if len(motion.t_events[0]) else None
    else:
        turn = 0.75 * np.sin(phi) * speed / HALF
        state, stopped = np.array([state[0], phi, -HALF * np.sin(phi) * turn, turn]), 0.0
        impulses = [MASS * HALF * np.cos(phi) * turn, MASS * (speed - HALF * np.sin(phi) * turn)]
        print(f"    jams: impulses {impulses[0]:.9f} and {impulses[1]:.9f} N s, spin {turn:.9f} rad/s, energy {2 / 3 * MASS * (HALF * turn) ** 2:.9f} J")
    if stopped is not None:
        tip = state[0] - HALF * np.cos(state[1])
        motion = solve_ivp(lambda _, u: [u[1], -0.75 * G / HALF * np.cos(u[0])], (start, duration), state[[1, 3]], **EXACT)
        phi, turn = motion.y[:, -1]
        state = [tip + HALF * np.cos(phi), phi, -HALF * np.sin(phi) * turn, turn]
        print(f"    stops at {stopped:.9f} s, {tip:.9f} m from where it was")
    return state


if __name__ == "__main__":
    for mu in (0.5, 1.0, 1.2, 1.4):
        print(f"mu = {mu}")
        x, phi, velocity, turn = run(mu, 0.05)
        print(f"    after 0.05 s: x {x:.9f} m, z {HALF * np.sin(phi):.9f} m, velocity {velocity:.9f} m/s, spin {turn:.9f} rad/s")
