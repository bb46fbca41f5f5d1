"""The history of ../../p1_spin_up_4/exact.csv, in axes that turn with the hub, in inertial axes, as CSV."""
import math
from pathlib import Path

lines = (Path(__file__).parent / "../../p1_spin_up_4/exact.csv").read_text().splitlines()
print("# ../p1_spin_up_4/exact.csv in inertial axes: references/inertial.py")
print("time [s],beam.tip.position.x [m],beam.tip.position.y [m]")
for line in lines[2:]:
    t, u, w = (float(x) for x in line.split(","))
    T, speed = 15.0, 4.0
    if t < T:
        angle = speed / T * (t * t / 2 + (T / (2 * math.pi)) ** 2 * (math.cos(2 * math.pi * t / T) - 1))
    else:
        angle = speed * (t - T / 2)
    x, y = 10 + u, w
    s, c = math.sin(angle), math.cos(angle)
    print(f"{line.split(',')[0]},{c * x - s * y:.10e},{s * x + c * y:.10e}")
