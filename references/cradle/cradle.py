"""Newton's cradle: equal balls on massless rods, with Hertz's force between neighbours.

Each ball of mass m and radius R turns, with its rod of length L, about a hinge of its own at the height L; the hinges are 2R apart:

    (m L² + 2/5 m R²) θᵢ″ = -m g L sin θᵢ + cᵢ × Fᵢ,   cᵢ = L (sin θᵢ, -cos θᵢ)
    F on ball i from ball j: -K δ^{3/2} n,  n = (pⱼ - pᵢ)/|pⱼ - pᵢ|,  δ = 2R - |pⱼ - pᵢ| > 0

and the rotations are those of a plane. The first ball is let go at an angle; the others hang at rest and touch. Prints the speeds of all balls
when the first blow is over, the largest angle of the last ball, and its time. Integrated by DOP853 with two tolerances, whose difference is printed too. With the name
of the history contact_cradle/reference it prints the angles of three balls from where they start.
"""

import sys

import numpy as np
from scipy.integrate import solve_ivp

M, R, L, K, G = 0.2, 0.02, 0.5, 1e8, 9.81
START = -0.4
J = M * L**2 + 0.4 * M * R**2


def rates(_, y, count):
    angle, rate = y[:count], y[count:]
    arm = L * np.stack([np.sin(angle), -np.cos(angle)], axis=1)
    place = arm + 2 * R * np.stack([np.arange(count), np.zeros(count)], axis=1)
    torque = -M * G * L * np.sin(angle)
    for i in range(count - 1):
        d = place[i + 1] - place[i]
        distance = np.hypot(*d)
        depth = 2 * R - distance
        if depth > 0:
            force = K * depth**1.5 * d / distance
            torque[i] -= arm[i, 0] * force[1] - arm[i, 1] * force[0]
            torque[i + 1] += arm[i + 1, 0] * force[1] - arm[i + 1, 1] * force[0]
    return np.concatenate([rate, torque / J])


def motion(count, tolerance):
    start = np.zeros(2 * count)
    start[0] = START
    turn = lambda t, y, n: y[2 * n - 1] if t > 0.37 else 1.0
    turn.terminal, turn.direction = True, -1
    settings = {"method": "DOP853", "rtol": tolerance, "atol": 1e-3 * tolerance, "max_step": 2e-5}
    return solve_ivp(rates, [0, 1.2], start, args=(count,), events=turn, dense_output=True, **settings)


def cradle(count, tolerance):
    found = motion(count, tolerance)
    speeds = L * found.sol(0.38)[count:]
    return np.concatenate([speeds, [found.y[count - 1, -1], found.t[-1]]])


def history():
    times = np.arange(0, 0.705, 0.01)
    angles = motion(3, 1e-12).sol(times)[:3].T - [START, 0, 0]
    print("# The equations of references/cradle/cradle.py, by DOP853.")
    print("time [s]," + ",".join(f"rod{i}.angle [rad]" for i in (1, 2, 3)))
    for t, row in zip(times, angles):
        print(f"{t:.2f}," + ",".join(f"{x:.12e}" for x in row))


if __name__ == "__main__":
    if sys.argv[1:] == ["contact_cradle/reference"]:
        sys.exit(history())
    for count in (3, 5):
        fine, coarse = cradle(count, 1e-12), cradle(count, 1e-10)
        print(count, "balls: speeds at 0.38 s [m/s], largest angle of the last, its time [s]")
        print(*(f"{x:.12g}" for x in fine))
        print("difference", f"{np.abs(fine - coarse).max():.1e}")
