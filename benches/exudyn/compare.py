"""Flexion against Exudyn on the prescribed spin-up of a rotating beam: time at equal tip error.

    python compare.py [--flexion BINARY --case CASE.toml] [options]      (--help lists them)

Makes its own virtual environment beside itself on the first call. Method and choices: README.md.
"""

import argparse
import csv
import json
import math
import os
import pathlib
import re
import resource
import shlex
import statistics
import subprocess
import sys
import tempfile
import venv

HERE = pathlib.Path(__file__).resolve().parent
ENVIRONMENT = HERE / ".venv"
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "RAYON_NUM_THREADS")


def enter_environment(script=__file__):
    """Restart `script` inside the virtual environment beside it, made and filled if it is missing or out of date."""
    wanted = (HERE / "requirements.txt").read_text()
    stamp = ENVIRONMENT / "installed.txt"
    python = ENVIRONMENT / "bin" / "python"
    if not stamp.exists() or stamp.read_text() != wanted:
        venv.create(ENVIRONMENT, with_pip=True, clear=True)
        subprocess.run([python, "-m", "pip", "install", "--quiet", "-r", HERE / "requirements.txt"], check=True)
        stamp.write_text(wanted)
    if pathlib.Path(sys.prefix).resolve() != ENVIRONMENT.resolve():
        environment = dict(os.environ, **{name: "1" for name in THREADS})
        os.execve(python, [str(python), str(script), *sys.argv[1:]], environment)


# --- what is run -----------------------------------------------------------------------------------------------------

STEPS = (1000, 1250, 1600, 2000, 3000, 4000, 6000, 8000, 12000, 16000)  # every output time 0.1 s is a step
NEWTON = ((True, 1e-4), (True, 1e-6), (False, 1e-2), (False, 1e-6))  # modified?, relative tolerance
FULL_NEWTON = (False, 1e-8)  # Exudyn's own: a new tangent every iteration, its default relative tolerance
ELEMENTS = {
    "ancf": (4, 6, 8, 10, 16),
    "ancf-full": (4, 6, 8, 10, 16),
    "ge2": (10, 20, 40),
    "ge3": (3, 4, 5, 8, 12),
}
FLEXION_ELEMENTS = (4, 5, 6, 8, 10, 16)
RADAU_ELEMENTS = (3, 4, 5, 6, 8, 10)
RADAU_TOLERANCES = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
NAMES = {
    "ancf": "Exudyn ANCFCable2D, tuned Newton",
    "ancf-full": "Exudyn ANCFCable2D, full Newton",
    "ge2": "Exudyn GeometricallyExactBeam2D, 2 nodes",
    "ge3": "Exudyn GeometricallyExactBeam2D, 3 nodes",
    "flexion": "Flexion, exact coupling, Newmark",
    "radau": "Flexion, exact coupling, Radau",
}


class Failed(Exception):
    """A run that stopped or whose tip left the neighbourhood of the reference."""


class Reference:
    """The converged tip history, as a function of time."""

    def __init__(self, path):
        import numpy as np
        from scipy.interpolate import CubicSpline

        data = np.array([[float(x) for x in row] for row in table(path)[1]])
        self.times = np.arange(0, 201) * 0.1
        self.at = CubicSpline(data[:, 0], data[:, 2])

    def error(self, t, transverse):
        """max |tip transverse - reference| [m] over the times 0, 0.1, ... 20 s; a spline where they are not output."""
        import numpy as np
        from scipy.interpolate import CubicSpline

        t, transverse = np.asarray(t), np.asarray(transverse)
        if len(t) < 2 or t[-1] < self.times[-1] - 1e-6 or not np.all(np.isfinite(transverse)):
            raise Failed("the run ends early or is not finite")
        near = np.clip(np.searchsorted(t, self.times - 1e-7), 0, len(t) - 1)
        if np.all(np.abs(t[near] - self.times) < 1e-6):
            values = transverse[near]
        else:
            values = CubicSpline(t, transverse)(self.times)
        return float(np.max(np.abs(values - self.at(self.times))))


def table(path):
    """Header and rows of a CSV file; lines that begin with # are comments."""
    with open(path, newline="") as file:
        rows = [row for row in csv.reader(line for line in file if not line.startswith("#")) if row]
    return rows[0], rows[1:]


class Exudyn:
    """One configuration of Exudyn."""

    def __init__(self, kind, elements, steps, modified, tolerance):
        self.kind, self.elements, self.steps, self.modified, self.tolerance = kind, elements, steps, modified, tolerance

    def label(self):
        newton = "modified" if self.modified else "full"
        return f"{self.elements} elements, {self.steps} steps, {newton} Newton, tolerance {self.tolerance:g}"

    def run(self, reference):
        """(wall [s], cpu [s], tip error [m])"""
        import exudyn_model

        try:
            wall, cpu, t, _, transverse = exudyn_model.run(
                self.kind.removesuffix("-full"), self.elements, self.steps, self.modified, self.tolerance
            )
        except (RuntimeError, ValueError, ArithmeticError) as error:
            raise Failed(str(error)) from error
        return wall, cpu, reference.error(t, transverse)


class Flexion:
    """One configuration of Flexion: a case file with its number of elements and its step replaced."""

    def __init__(self, options, elements, steps, tolerance=None):
        self.options, self.elements, self.steps, self.tolerance = options, elements, steps, tolerance
        self.kind = "radau" if tolerance else "flexion"

    def label(self):
        if self.tolerance:
            return f"{self.elements} elements, tolerance {self.tolerance:g}"
        return f"{self.elements or 'as written'} elements, {self.steps or 'as written'} steps"

    def run(self, reference):
        """(wall [s], cpu [s], tip error [m]); wall is the solver's own, cpu that of the process if not in the summary."""
        options = self.options
        text = pathlib.Path(options.case).read_text()
        if self.elements:
            text = replace_key(text, options.elements_key, str(self.elements))
        if self.tolerance:
            text = with_integrator(text, self.tolerance)
        elif self.steps:
            text = replace_key(text, options.step_key, options.step_value.format(step=20.0 / self.steps))
        with tempfile.TemporaryDirectory() as folder:
            case, out = pathlib.Path(folder, "case.toml"), pathlib.Path(folder, "out")
            case.write_text(text)
            words = shlex.split(options.command)
            command = [w.format(binary=options.flexion, case=case, dir=out) for w in words]
            before = children_cpu()
            done = subprocess.run(command, capture_output=True, text=True)
            cpu = children_cpu() - before
            if done.returncode != 0:
                raise Failed(f"{' '.join(command)}: exit code {done.returncode}: {done.stderr.strip()[-600:]}")
            summary = json.loads((out / "summary.json").read_text())
            header, rows = table(out / "trajectory.csv")
        columns = [header.index("time [s]"), header.index("tip.deflection [m]")]
        t, transverse = ([float(row[c]) for row in rows] for c in columns)
        wall = summary["wall_time"] - summary.get("preparation_wall_time", 0.0)
        if summary.get("cpu_time") is not None:
            cpu = summary["cpu_time"] - (summary.get("preparation_cpu_time") or 0.0)
        return wall, cpu, reference.error(t, transverse)


def children_cpu():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def replace_key(text, key, value):
    """The TOML text with the line of `table.key` given a new value; the key must be there."""
    *tables, name = key.split(".")
    wanted, inside, lines, found = ".".join(tables), not tables, text.splitlines(), False
    for i, line in enumerate(lines):
        header = re.match(r"\s*\[\s*([^\[\]]+?)\s*\]", line)
        if header:
            inside = header.group(1) == wanted
        elif inside and re.match(rf"\s*{re.escape(name)}\s*=", line):
            lines[i], found = f"{name} = {value}", True
    if not found:
        raise SystemExit(f"compare.py: the case has no key `{key}`; name it with --elements-key or --step-key")
    return "\n".join(lines) + "\n"


def with_integrator(text, tolerance):
    """The TOML text with the adaptive method in place of the one it names."""
    lines = ["[integrator]", 'kind = "radau"', f"tolerance = {tolerance:g}"]
    made, found = re.subn(r"(?ms)^\[integrator\]\n.*?(?=^\[|\Z)", "\n".join(lines) + "\n\n", text)
    if not found:
        raise SystemExit("compare.py: the case has no table [integrator]")
    return made


# --- measuring -------------------------------------------------------------------------------------------------------


def front(points, slack=1.1):
    """The points that no other beats in both error and CPU time (by more than the slack in time)."""
    kept = []
    for p in points:
        if not any(q["error"] <= p["error"] and q["cpu"] * slack < p["cpu"] for q in points if q is not p):
            kept.append(p)
    return kept


def measure(runs, reference, repetitions, worst, progress):
    """Screen every run, keep each program's front, then repeat the kept runs in turn and take medians."""
    failed, screened = [], []
    for run in runs:
        try:
            samples = [run.run(reference) for _ in range(2)]
            wall, cpu, error = min(samples, key=lambda s: s[1])
            if not error < worst:
                raise Failed(f"tip error {error:.3g} m")
            screened.append({"run": run, "wall": wall, "cpu": cpu, "error": error})
        except Failed as reason:
            failed.append({"kind": run.kind, "settings": run.label(), "reason": str(reason)})
        progress(f"{run.kind}: {run.label()}")
    kept = [p for kind in NAMES for p in front([q for q in screened if q["run"].kind == kind])]
    samples = {id(p): [] for p in kept}
    for repetition in range(repetitions):
        for p in kept if repetition % 2 == 0 else reversed(kept):
            try:
                samples[id(p)].append(p["run"].run(reference))
            except Failed as reason:
                raise SystemExit(f"compare.py: {p['run'].label()} ran before and now fails: {reason}") from reason
        progress(f"repetition {repetition + 1} of {repetitions}")
    rows = []
    for p in kept:
        wall, cpu, error = zip(*samples[id(p)])
        rows.append(
            {
                "kind": p["run"].kind,
                "program": NAMES[p["run"].kind],
                "elements": p["run"].elements,
                "steps": p["run"].steps,
                "settings": p["run"].label(),
                "error": max(error),
                "wall": statistics.median(wall),
                "wall_least": min(wall),
                "cpu": statistics.median(cpu),
                "cpu_least": min(cpu),
            }
        )
    rows.sort(key=lambda r: (list(NAMES).index(r["kind"]), -r["error"]))
    return rows, failed


def time_at(rows, kind, error, clock):
    """Least time of a program to reach a tip error, log-log between the points of its front; None outside them."""
    points = sorted((r["error"], r[clock]) for r in rows if r["kind"] == kind)
    lower = []
    for e, t in points:  # from the smallest error upwards: keep what gets cheaper
        if not lower or t < lower[-1][1]:
            lower.append((e, t))
    if not lower or error < lower[0][0]:
        return None
    for (e0, t0), (e1, t1) in zip(lower, lower[1:]):
        if e0 <= error <= e1:
            share = math.log(error / e0) / math.log(e1 / e0)
            return math.exp(math.log(t0) * (1 - share) + math.log(t1) * share)
    return lower[-1][1]  # coarser than any run kept: the cheapest one does


def equal_error(rows, levels):
    """Times of each program at each error level, and the ratio of each to Flexion."""
    out = []
    for level in levels:
        line = {"error": level}
        for clock in ("wall", "cpu"):
            own = {kind: time_at(rows, kind, level, clock) for kind in ("flexion", "radau")}
            for kind in NAMES:
                taken = time_at(rows, kind, level, clock)
                line[f"{kind}_{clock}"] = taken
                if kind not in own:
                    for mine, time in own.items():
                        line[f"{kind}_{clock}_to_{mine}"] = taken / time if taken and time else None
        out.append(line)
    return out


# --- reporting -------------------------------------------------------------------------------------------------------


def show(rows, failed, levels):
    number = lambda x, form: form.format(x) if x is not None else "-"  # noqa: E731
    print(f"\n{'program':42}{'tip error [m]':>14}{'wall [ms]':>11}{'cpu [ms]':>10}  settings")
    for r in rows:
        print(f"{r['program']:42}{r['error']:14.2e}{r['wall'] * 1e3:11.1f}{r['cpu'] * 1e3:10.1f}  {r['settings']}")
    print(f"\n{len(failed)} runs failed or are outside the table (listed in the JSON file)")
    for kind in NAMES:
        reasons = [f for f in failed if f["kind"] == kind]
        for f in reasons[:2]:
            print(f"  {NAMES[kind]}, {f['settings']}: {f['reason'][-300:]}")
        if len(reasons) > 2:
            print(f"  {NAMES[kind]}: {len(reasons) - 2} more")
    for clock in ("wall", "cpu"):
        print(f"\n{clock} time [ms] at equal tip error (ratios to Flexion with Newmark and with Radau)")
        print(f"{'tip error [m]':>14}" + "".join(f"{kind:>20}" for kind in NAMES))
        for line in levels:
            cells = []
            for kind in NAMES:
                taken = line[f"{kind}_{clock}"]
                ratios = [line.get(f"{kind}_{clock}_to_{mine}") for mine in ("flexion", "radau")]
                cell = number(taken and taken * 1e3, "{:.1f}")
                if kind not in ("flexion", "radau"):
                    cell += " (" + ", ".join(number(r, "{:.0f}") for r in ratios) + ")"
                cells.append(f"{cell:>20}")
            print(f"{line['error']:14.1e}" + "".join(cells))


def machine():
    name = "unknown"
    if os.path.exists("/proc/cpuinfo"):
        found = re.search(r"model name\s*:\s*(.*)", pathlib.Path("/proc/cpuinfo").read_text())
        name = found.group(1) if found else name
    return {"processor": name, "cores": os.cpu_count(), "python": sys.version.split()[0]}


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--flexion", help="path of the flexion binary; without it only Exudyn is measured")
    parser.add_argument("--case", help="case file of the spin-up with exact coupling")
    parser.add_argument("--command", default="{binary} run {case} --output {dir}", help="how a case is run (%(default)s)")
    parser.add_argument("--elements-key", default="basis.elements", help="key of the number of elements (%(default)s)")
    parser.add_argument("--step-key", default="integrator.step", help="key of the step (%(default)s)")
    parser.add_argument("--step-value", default="{step:.12g}", help="how the step in s is written (%(default)s)")
    parser.add_argument("--as-written", action="store_true", help="run the case as it is, without a sweep")
    parser.add_argument("-n", "--repetitions", type=int, default=7)
    parser.add_argument("--worst", type=float, default=2e-3, help="tip error [m] above which a run is left out")
    parser.add_argument("--levels", type=float, nargs="+", default=[1e-3, 5e-4, 2e-4, 1e-4, 7.3e-5, 5e-5, 2e-5, 1e-5])
    parser.add_argument("--kinds", nargs="+", choices=list(ELEMENTS), default=list(ELEMENTS))
    parser.add_argument("--steps", nargs="+", type=int, default=list(STEPS), help="numbers of fixed steps to try")
    parser.add_argument("--quick", action="store_true", help="a few runs only, to see that everything works")
    parser.add_argument("--reference", default=HERE / "reference.csv")
    parser.add_argument("--out", default=HERE / "results", help="folder of the JSON and CSV tables")
    options = parser.parse_args()
    if bool(options.flexion) != bool(options.case):
        parser.error("--flexion and --case go together")
    if options.flexion and not os.access(options.flexion, os.X_OK):
        parser.error(f"{options.flexion} is not a program")
    return options


def main():
    enter_environment()
    sys.path.insert(0, str(HERE))
    options = arguments()
    reference = Reference(options.reference)
    steps = (2000, 4000) if options.quick else options.steps
    newton = NEWTON[:1] if options.quick else NEWTON
    runs = [
        Exudyn(kind, elements, count, modified, tolerance)
        for kind in options.kinds
        for elements in (ELEMENTS[kind][1:2] if options.quick else ELEMENTS[kind])
        for count in steps
        for modified, tolerance in ((FULL_NEWTON,) if kind.endswith("-full") else newton)
    ]
    if options.flexion and options.as_written:
        runs.append(Flexion(options, None, None))
    elif options.flexion:
        counts = (6,) if options.quick else FLEXION_ELEMENTS
        runs += [Flexion(options, elements, count) for elements in counts for count in steps]
        counts, tolerances = ((4,), (1e-4,)) if options.quick else (RADAU_ELEMENTS, RADAU_TOLERANCES)
        runs += [Flexion(options, elements, None, tolerance) for elements in counts for tolerance in tolerances]
    done = iter(range(1, len(runs) + options.repetitions + 1))
    total = len(runs) + options.repetitions

    def progress(text):
        if sys.stderr.isatty():
            print(f"\r\033[K{next(done)}/{total} {text}", end="", file=sys.stderr, flush=True)

    rows, failed = measure(runs, reference, options.repetitions, options.worst, progress)
    levels = equal_error(rows, options.levels)
    show(rows, failed, levels)
    out = pathlib.Path(options.out)
    out.mkdir(parents=True, exist_ok=True)
    import exudyn

    record = {
        "machine": machine(),
        "exudyn": exudyn.__version__,
        "repetitions": options.repetitions,
        "runs": rows,
        "equal_error": levels,
        "failed": failed,
    }
    (out / "compare.json").write_text(json.dumps(record, indent=1) + "\n")
    for name, lines in (("runs", rows), ("equal_error", levels)):
        if lines:
            with open(out / f"{name}.csv", "w", newline="") as file:
                writer = csv.DictWriter(file, fieldnames=list(lines[0]))
                writer.writeheader()
                writer.writerows(lines)
    print(f"\nwritten: {out / 'compare.json'}, runs.csv, equal_error.csv")


if __name__ == "__main__":
    main()
