"""Closed form of a symmetric body in free flight, as CSV.

The angular momentum L = J w stays, and the axis e of symmetry goes round it with |L|/J1:
w = L/J1 + (1 - J3/J1) w3 e, with w3 along e constant.
"""
import math

m, r, l, g = 2.0, 0.3, 0.4, 9.81
J1, J3 = m * (r * r / 4 + l * l / 12), m * r * r / 2
L = (J1 * 0.8, 0.0, J3 * 3.0)
size = math.hypot(L[0], L[2])
n = (L[0] / size, 0.0, L[2] / size)
e0 = (0.0, 0.0, 1.0)
print("# Closed form: references/precession.py")
print("time [s],disc.position.x [m],disc.position.z [m],disc.spin.x [rad/s],disc.spin.y [rad/s],disc.spin.z [rad/s]")
for k in range(101):
    t = 0.02 * k
    a = size / J1 * t
    along = sum(x * y for x, y in zip(n, e0))
    cross = (n[1] * e0[2] - n[2] * e0[1], n[2] * e0[0] - n[0] * e0[2], n[0] * e0[1] - n[1] * e0[0])
    e = [math.cos(a) * e0[i] + math.sin(a) * cross[i] + (1 - math.cos(a)) * along * n[i] for i in range(3)]
    w = [L[i] / J1 + (1 - J3 / J1) * 3.0 * e[i] for i in range(3)]
    print(f"{t:.2f},{t:.9e},{1 + 2 * t - 0.5 * g * t * t:.9e},{w[0]:.9e},{w[1]:.9e},{w[2]:.9e}")
