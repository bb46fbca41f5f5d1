"""The compound pendulum from the horizontal, (J + m a^2) th'' = -m g a cos th, by the classical Runge-Kutta method, as CSV."""
import math

m, a, g = 2.0, 0.5, 9.81
k = m * g * a / (m / 12 * (1.0 + 0.03**2) + m * a * a)


def step(y, h):
    f = lambda y: (y[1], -k * math.cos(y[0]))
    k1 = f(y)
    k2 = f([y[i] + 0.5 * h * k1[i] for i in range(2)])
    k3 = f([y[i] + 0.5 * h * k2[i] for i in range(2)])
    k4 = f([y[i] + h * k3[i] for i in range(2)])
    return [y[i] + h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]) for i in range(2)]


print("# Same equation, coded independently: references/pendulum.py")
print("time [s],joint.angle [rad],bar.position.x [m],bar.position.z [m]")
y = [0.0, 0.0]
for i in range(101):
    print(f"{0.02 * i:.2f},{y[0]:.10e},{a * math.cos(y[0]):.10e},{a * math.sin(y[0]):.10e}")
    for _ in range(100):
        y = step(y, 2e-4)
