"""m x'' + c x' + k (x - 1) = 0 from x = 1.3, closed form, as CSV."""
import math

m, k, c = 1.5, 60.0, 1.2
d = c / (2 * m)
w = math.sqrt(k / m - d * d)
print("# Closed form: references/vibration.py")
print("time [s],ball.position.x [m]")
for i in range(101):
    t = 0.03 * i
    x = 1 + 0.3 * math.exp(-d * t) * (math.cos(w * t) + d / w * math.sin(w * t))
    print(f"{t:.2f},{x:.10e}")
