"""The heavy top (Bruels & Cardona 2010, doi 10.1115/1.4001370) with its fixed point as only reference, by the classical
Runge-Kutta method on quaternion and body-fixed angular velocity, as CSV."""

m, g = 15.0, 9.81
J = (0.234375 + m, 0.46875, 0.234375 + m)


def rotated(q, x):
    w, a, b, c = q
    t = (2 * (b * x[2] - c * x[1]), 2 * (c * x[0] - a * x[2]), 2 * (a * x[1] - b * x[0]))
    return (
        x[0] + w * t[0] + b * t[2] - c * t[1],
        x[1] + w * t[1] + c * t[0] - a * t[2],
        x[2] + w * t[2] + a * t[1] - b * t[0],
    )


def rate(y):
    q, o = y[:4], y[4:]
    w, a, b, c = q
    dq = (
        0.5 * (-a * o[0] - b * o[1] - c * o[2]),
        0.5 * (w * o[0] + b * o[2] - c * o[1]),
        0.5 * (w * o[1] + c * o[0] - a * o[2]),
        0.5 * (w * o[2] + a * o[1] - b * o[0]),
    )
    down = rotated((w, -a, -b, -c), (0.0, 0.0, -m * g))
    moment = (down[2], 0.0, -down[0])  # (0, 1, 0) x down
    do = (
        (moment[0] - (J[2] - J[1]) * o[1] * o[2]) / J[0],
        (moment[1] - (J[0] - J[2]) * o[2] * o[0]) / J[1],
        (moment[2] - (J[1] - J[0]) * o[0] * o[1]) / J[2],
    )
    return dq + do


def step(y, h):
    k1 = rate(y)
    k2 = rate([a + 0.5 * h * b for a, b in zip(y, k1)])
    k3 = rate([a + 0.5 * h * b for a, b in zip(y, k2)])
    k4 = rate([a + h * b for a, b in zip(y, k3)])
    return [a + h / 6 * (b + 2 * c + 2 * d + e) for a, b, c, d, e in zip(y, k1, k2, k3, k4)]


print("# Same equations, coded independently: references/heavy_top.")
print("time [s],top.position.x [m],top.position.y [m],top.position.z [m]")
y = [1.0, 0.0, 0.0, 0.0, 0.0, 150.0, -4.61538]
for k in range(101):
    x = rotated(y[:4], (0.0, 1.0, 0.0))
    print(f"{0.005 * k:.3f},{x[0]:.10e},{x[1]:.10e},{x[2]:.10e}")
    for _ in range(250):
        y = step(y, 2e-5)
