"""v = F/m (cos th, sin th), th = t^2/4, integrated by Simpson's rule, as CSV."""
import math

print("# Closed form, integrated: references/thrust.py")
print("time [s],disc.position.x [m],disc.position.y [m],disc.spin.z [rad/s]")
n, h = 400, 1e-4
v, x = [0.0, 0.0], [0.0, 0.0]
f = lambda t: (2 * math.cos(0.25 * t * t), 2 * math.sin(0.25 * t * t))
for k in range(101):
    t = 0.04 * k
    print(f"{t:.2f},{x[0]:.10e},{x[1]:.10e},{0.5 * t:.10e}")
    for i in range(n):
        a, b, c = f(t + i * h), f(t + (i + 0.5) * h), f(t + (i + 1) * h)
        for j in range(2):
            # Exact for a cubic acceleration.
            x[j] += h * v[j] + h * h / 6 * (a[j] + 2 * b[j])
            v[j] += h / 6 * (a[j] + 4 * b[j] + c[j])
