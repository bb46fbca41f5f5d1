"""A ball that falls from 1 m and bounces with e = 0.8, closed form, as CSV."""
import math

g, e = 9.81, 0.8
flights = [(-math.sqrt(2 / g), math.sqrt(2 * g))]
while flights[-1][0] < 3:
    start, speed = flights[-1]
    flights.append((start + 2 * speed / g, e * speed))
print("# Closed form: references/bounces.py")
print("time [s],ball.position.x [m],ball.position.z [m]")
for k in range(101):
    t = 0.02 * k
    start, speed = [flight for flight in flights if flight[0] <= t][-1]
    z = speed * (t - start) - 0.5 * g * (t - start) ** 2
    print(f"{t:.2f},{0.5 * t:.10e},{z:.10e}")
