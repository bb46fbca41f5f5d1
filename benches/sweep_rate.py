"""Runs of a sweep a second and processor against the error of what they collect: a picture and its table.

    python benches/sweep_rate.py target/release/flexion docs/src/images/sweep_rate.svg

Needs Matplotlib and polars. Every point is a sweep of `--runs` rows without companions, timed by the processor time that it takes with its start, its reading and its
files; its error is the largest ± of a sweep of 20 of the rows with companions, over the value.
"""

import argparse
import pathlib
import resource
import subprocess
import tempfile

VERIFICATION = pathlib.Path(__file__).resolve().parent.parent / "verification"
CASE = "p1_spin_up_4"
VARY = "section.modulus=63 GPa:77 GPa:{}"
# Intervals of records [s], which bound the steps, and tolerances that go with a mesh.
ELEMENTS = {2: (0.2, 1e-3), 3: (0.1, 1e-4), 4: (0.08, 1e-4), 6: (0.05, 1e-5), 8: (0.04, 1e-6), 12: (0.025, 1e-7), 20: (0.02, 1e-8)}
CURVES = {"first": "plane, first order", "exact": "plane, exact", "space": "space"}
QUANTITY = "tip.deflection.min"


def sweep(flexion, changes, runs, errors):
    """Processor time [s] of a sweep, and its rows."""
    import polars

    with tempfile.TemporaryDirectory() as folder:
        place = pathlib.Path(folder) / "sweep"
        words = [flexion, "sweep", str(VERIFICATION / CASE), "--vary", VARY.format(runs), "--collect", QUANTITY, "--errors", errors, "--output", str(place)]
        for change in changes:
            words += ["--set", change]
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(words, check=True, capture_output=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        spent = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
        return spent, polars.read_parquet(f"{place}/part-*.parquet")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("flexion")
    parser.add_argument("picture", type=pathlib.Path)
    parser.add_argument("--runs", type=int, default=400)
    options = parser.parse_args()
    import matplotlib

    matplotlib.use("svg")
    from matplotlib import pyplot

    matplotlib.rcParams["svg.hashsalt"] = "flexion"
    figure, axes = pyplot.subplots(figsize=(6.4, 4.2), layout="constrained")
    for marker, (coupling, name) in zip("os^", CURVES.items()):
        points = []
        for elements, (step, tolerance) in ELEMENTS.items():
            method = f'integrator={{kind="radau",tolerance={tolerance:g},absolute-tolerance={0.01 * tolerance:g}}}'
            these = [f"model.coupling={coupling}", f"basis.elements={elements}", f"output.step={step}", "output.energy-balance=false", method]
            spent, rows = sweep(options.flexion, these, options.runs // (20 if coupling == "space" else 1), "none")
            _, known = sweep(options.flexion, these, 20, "each")
            error = max(e / abs(v) for e, v in zip(known[f"{QUANTITY}.error [m]"], known[f"{QUANTITY} [m]"]))
            print(f"{name:20} {elements:3} {error:9.1e} {len(rows) / spent:9.0f}", flush=True)
            # A mesh that is no model of the beam is no point.
            if error < 0.01:
                points.append((error, len(rows) / spent))
        points.sort()
        axes.loglog(*zip(*points), marker=marker, label=name)
    axes.set_xlabel("largest ± of the smallest deflection, over its value")
    axes.set_ylabel("runs a second and processor")
    axes.grid(True, linewidth=0.3)
    axes.legend()
    figure.savefig(options.picture, metadata={"Date": None})


if __name__ == "__main__":
    main()
