"""Work-precision diagram: error of the tip against processor time, for every integrator.

    pip install matplotlib
    cargo build --release
    python benches/work_precision/diagram.py --flexion target/release/flexion [--repeat 3] [--quick]

P1's spin-up to 4 rad/s with 20 elements, first-order and exact coupling. The error is the largest difference of the tip
deflection, over the times 0, 0.1, ... 20 s: for `exact` from the independent history in benches/exudyn, for `first` from radau with
40 elements and the tolerance 1e-11 (the independent history in verification/p1_spin_up_4 has errors of 3e-7 m of its own, those
of Newmark's method with 1 ms; radau's distance from it is printed); the time is `cpu_time` of the summary less that of preparation: the integration, without the books of energy. The smallest
of the repetitions counts. Writes points.csv beside this file and docs/src/work_precision.png, and prints the lower hull of each
coupling. `--redraw` draws the points of a former run again.
"""

import argparse
import csv
import json
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
REFERENCE = {
    "first": ROOT / "verification/p1_spin_up_4/reference.csv",
    "exact": ROOT / "benches/exudyn/reference.csv",
}
ELEMENTS = 20
PICTURE = ROOT / "docs/src/work_precision.png"

# Fixed steps [s]; Runge-Kutta and Adams have only what their stability leaves them.
STEPS = [2e-2, 1e-2, 5e-3, 2.5e-3, 1.25e-3, 6.25e-4]
TOLERANCES = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9]
FIXED = ["newmark", "hht", "generalized-alpha"]
EXPLICIT = {("runge-kutta-4", "first"): 4e-5, ("adams-4", "first"): 2.7e-6}

# Milliseconds of processor time of Exudyn at equal error, as docs/src/speed.md has them (exact coupling).
EXUDYN = {
    "Exudyn, ANCF cable, full Newton": [(2e-4, 62.0), (7.3e-5, 82.3), (2e-5, 130.1), (1e-5, 193.2)],
    "Exudyn, ANCF cable, tuned beyond": [(2e-4, 61.2), (7.3e-5, 73.3), (2e-5, 106.7), (1e-5, 130.1)],
    "Exudyn, GE2D with 3 nodes, tuned beyond": [(2e-4, 32.0), (7.3e-5, 44.6), (2e-5, 114.2)],
}


def column(path, name):
    rows = csv.reader(line for line in path.open() if not line.startswith("#"))
    head = next(rows)
    time, value = head.index("time [s]"), head.index(name)
    return {round(float(row[time]), 6): float(row[value]) for row in rows}


def measure(flexion, coupling, integrator, repeat, reference, elements=ELEMENTS):
    best = None
    with tempfile.TemporaryDirectory() as out:
        for _ in range(repeat):
            command = [
                flexion, "run", str(ROOT / "verification/p1_spin_up_4"), "--force", "--output", out,
                "--set", f"model.coupling={coupling}",
                "--set", f"basis={{kind='finite-elements',elements={elements}}}",
                "--set", f"integrator={integrator}",
                "--set", "output={step=0.1,energy-balance=false}",
            ]
            done = subprocess.run(command, capture_output=True, text=True)
            if done.returncode != 0:
                return None, (done.stderr.strip().splitlines() or ["?"])[0]
            summary = json.loads((Path(out) / "summary.json").read_text())
            cpu, before = summary.get("cpu_time"), summary.get("preparation_cpu_time")
            time = cpu - (before or 0.0) if cpu else summary["wall_time"] - summary["preparation_wall_time"]
            best = time if best is None else min(best, time)
        tip = column(Path(out) / "trajectory.csv", "tip.deflection [m]")
    error = max(abs(tip[t] - value) for t, value in reference.items() if t in tip)
    return (error, best, tip), None


def runs(coupling, quick):
    for tolerance in TOLERANCES[1:5] if quick else TOLERANCES:
        yield "radau", tolerance, f"{{kind='radau',tolerance={tolerance:g},absolute-tolerance={tolerance / 1e2:g}}}"
    for kind in FIXED:
        for step in STEPS[1:4] if quick else STEPS:
            yield kind, step, f"{{kind='{kind}',step={step:g}}}"
    for (kind, of), step in EXPLICIT.items():
        if of == coupling and not quick:
            yield kind, step, f"{{kind='{kind}',step={step:g}}}"


def hull(points):
    """Those that no other beats in both error and time, by time."""
    best, out = float("inf"), []
    for point in sorted(points, key=lambda p: (p["cpu_ms"], p["error_m"])):
        if point["error_m"] < best:
            best = point["error_m"]
            out.append(point)
    return out


def draw(points, path):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    marks = {"radau": "o-", "newmark": "s-", "hht": "^-", "generalized-alpha": "d-", "runge-kutta-4": "*", "adams-4": "P"}
    figure, axes = plt.subplots(1, 2, figsize=(11, 5.2), sharey=True)
    for axis, coupling in zip(axes, REFERENCE):
        for kind, mark in marks.items():
            own = [p for p in points if p["coupling"] == coupling and p["integrator"] == kind]
            if own:
                own.sort(key=lambda p: p["setting"])
                axis.plot([p["cpu_ms"] for p in own], [p["error_m"] for p in own], mark, label=kind, markersize=5, lw=1.2)
        chosen = [p for p in points if p["coupling"] == coupling and p["default"]]
        axis.plot([p["cpu_ms"] for p in chosen], [p["error_m"] for p in chosen], "o", ms=12, mfc="none", mec="black",
                  label="default tolerance")
        if coupling == "exact":
            for (name, own), grey in zip(EXUDYN.items(), ("0.45", "0.6", "0.2")):
                axis.plot([t for _, t in own], [e for e, _ in own], "x--", color=grey, label=name, ms=5, lw=1)
        axis.set(xscale="log", yscale="log", xlabel="processor time [ms]", title=f"coupling {coupling}")
        axis.grid(True, which="major", alpha=0.3)
    axes[0].set_ylabel("largest error of the tip deflection [m]")
    named = {}
    for axis in axes:
        for handle, label in zip(*axis.get_legend_handles_labels()):
            named.setdefault(label, handle)
    figure.legend(named.values(), named.keys(), loc="lower center", ncols=4, fontsize=8, frameon=False)
    figure.tight_layout(rect=(0, 0.12, 1, 1))
    figure.savefig(path, dpi=130)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--flexion", default="target/release/flexion")
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--redraw", action="store_true")
    arguments = parser.parse_args()
    if arguments.redraw:
        rows = list(csv.DictReader((HERE / "points.csv").open()))
        for row in rows:
            row.update({key: float(row[key]) for key in ("setting", "error_m", "cpu_ms")}, default=row["default"] == "True")
        return draw(rows, PICTURE)
    points = []
    for coupling, file in REFERENCE.items():
        head = next(line for line in file.open() if not line.startswith("#")).strip().split(",")
        name = next(h for h in head if "deflection" in h or "transverse" in h)
        rows = csv.reader(line for line in file.open() if not line.startswith("#"))
        next(rows)
        of = head.index(name)
        reference = {round(float(row[0]), 6): float(row[of]) for row in rows}
        reference = {t: y for t, y in reference.items() if abs(10 * t - round(10 * t)) < 1e-6}
        if coupling == "first":
            fine = "{kind='radau',tolerance=1e-11,absolute-tolerance=1e-14}"
            (off, _, reference), _ = measure(arguments.flexion, coupling, fine, 1, reference, 2 * ELEMENTS)
            print(f"first: reference {off:.1e} m from the independent history")
        for kind, setting, integrator in runs(coupling, arguments.quick):
            repeat = 1 if (kind, coupling) in EXPLICIT else arguments.repeat
            measured, problem = measure(arguments.flexion, coupling, integrator, repeat, reference)
            if problem:
                print(f"{coupling} {kind} {setting:g}: {problem}", file=sys.stderr)
                continue
            error, time, _ = measured
            default = kind == "radau" and setting == 1e-6
            points.append(dict(coupling=coupling, integrator=kind, setting=setting, error_m=error, cpu_ms=1e3 * time,
                               default=default))
            print(f"{coupling} {kind} {setting:g}: {error:.3e} m, {1e3 * time:.2f} ms", flush=True)
    with (HERE / "points.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, points[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows({**p, "error_m": f"{p['error_m']:.4e}", "cpu_ms": f"{p['cpu_ms']:.3f}"} for p in points)
    draw(points, PICTURE)
    for coupling in REFERENCE:
        print(f"lower hull, {coupling}:")
        for p in hull([p for p in points if p["coupling"] == coupling]):
            print(f"  {p['cpu_ms']:8.2f} ms  {p['error_m']:.2e} m  {p['integrator']} {p['setting']:g}"
                  + ("  (default)" if p["default"] else ""))


if __name__ == "__main__":
    main()
