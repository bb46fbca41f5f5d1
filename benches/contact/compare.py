"""Flexion beside MuJoCo and Exudyn where rods and beams lie down on a floor: processor time at equal error.

    python compare.py --flexion BINARY [chain] [beam] [options]      (--help lists them)

Makes its own virtual environment beside itself on the first call. Method and choices: README.md.
"""

import argparse
import csv
import itertools
import json
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile
import time
import types
import venv

HERE = pathlib.Path(__file__).resolve().parent
ENVIRONMENT = HERE / ".venv"
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "RAYON_NUM_THREADS")
COARSE = [1e-3, 5e-4, 2.5e-4, 1e-4]
FINE = [2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5]
LIMIT = 60  # s of processor time after which a run is stopped


def enter_environment():
    """Restart inside the virtual environment beside this file, made and filled if it is missing or out of date."""
    wanted = (HERE / "requirements.txt").read_text()
    stamp = ENVIRONMENT / "installed.txt"
    python = ENVIRONMENT / "bin" / "python"
    if not stamp.exists() or stamp.read_text() != wanted:
        venv.create(ENVIRONMENT, with_pip=True, clear=True)
        subprocess.run([python, "-m", "pip", "install", "--quiet", "-r", HERE / "requirements.txt"], check=True)
        stamp.write_text(wanted)
    if pathlib.Path(sys.prefix).resolve() != ENVIRONMENT.resolve():
        environment = dict(os.environ, **{name: "1" for name in THREADS})
        os.execve(python, [str(python), *sys.argv], environment)


class Failed(Exception):
    """A run that stopped, or that took too long."""


# --- Flexion ---------------------------------------------------------------------------------------------------------


def flexion(binary, case):
    """Processor time [s] of the whole process, and the columns of its trajectory."""
    with tempfile.TemporaryDirectory() as folder:
        path, out = pathlib.Path(folder, "case.toml"), pathlib.Path(folder, "out")
        path.write_text(case)
        before = children()
        command = [binary, "run", path, "--error", "off", "--output", out]
        limit = lambda: resource.setrlimit(resource.RLIMIT_CPU, (LIMIT, LIMIT))
        done = subprocess.run(command, capture_output=True, text=True, preexec_fn=limit)
        cpu = children() - before
        if done.returncode:
            reason = re.sub(r"\s+", " ", done.stderr.split("error: ")[-1])[:150]
            raise Failed(reason or f"no end within {LIMIT} s of processor time")
        with open(out / "trajectory.csv", newline="") as file:
            rows = list(csv.reader(file))
    return cpu, {name: [float(x) for x in column] for name, *column in zip(*rows)}


def children():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def nonsmooth(step, radius):
    return f'{{ kind = "nonsmooth-generalized-alpha", step = {step}, spectral-radius = {radius} }}'


def flexion_chain(options):
    import numpy as np
    from models import G, Chain

    chain = Chain()
    integrators = [
        (f"nonsmooth-generalized-alpha, {h * 1e3:g} ms, ρ∞ {r}", nonsmooth(h, r))
        for h, r in itertools.product(options.coarse, (0, 0.5))
    ]
    integrators += [("moreau-jean, 0.5 ms", '{ kind = "moreau-jean", step = 5e-4 }')]
    integrators += [("radau, tolerance 1e-4", '{ kind = "radau", tolerance = 1e-4 }')]

    def run(integrator):
        cpu, columns = flexion(options.flexion, chain.flexion(integrator))
        return cpu, np.array(columns["energy.gravity [J]"]) / (chain.RODS * chain.MASS * G)

    return [("Flexion", name, lambda i=i: run(i)) for name, i in integrators]


def flexion_beam(options):
    import numpy as np
    from models import Beam

    beam = Beam()
    integrators = [("at rest from the start, static", None), ("radau, tolerance 1e-3", '{ kind = "radau", tolerance = 1e-3 }')]
    integrators += [(f"nonsmooth-generalized-alpha, {h * 1e3:g} ms", nonsmooth(h, 0.8)) for h in (2e-3, 1e-3, 5e-4)]
    integrators += [(f"moreau-jean, {h * 1e3:g} ms", f'{{ kind = "moreau-jean", step = {h} }}') for h in (1e-3, 1e-4)]

    def run(integrator, elements):
        static = integrator is None
        case = beam.flexion(integrator or '{ kind = "radau" }', elements, static)
        cpu, columns = flexion(options.flexion, case)
        forces = [c for name, c in columns.items() if re.fullmatch(r"floor\.\d+\.force \[N\]", name)]
        moments = np.array(columns["hub.torque [N*m]"])
        return cpu, moments, np.sum(forces, axis=0)

    return [
        ("Flexion, statics" if i is None else "Flexion", f"{n} elements, {name}", lambda i=i, n=n: run(i, n))
        for n in (10, 15, 20, 30, 40)
        for name, i in integrators
    ]


# --- MuJoCo ----------------------------------------------------------------------------------------------------------


def settings(step, ratio=5, time=2, integrator="implicitfast", jacobian="auto", impedance=0.9999):
    return types.SimpleNamespace(**locals())


def described(s):
    jacobian = "" if s.jacobian == "auto" else f", {s.jacobian}"
    return f"{s.integrator}, {s.step * 1e3:g} ms, solref {s.time} steps and {s.ratio}, solimp {s.impedance}{jacobian}"


def mujoco_chain(options):
    import mujoco
    import numpy as np
    from models import G, Chain

    chain = Chain()

    def run(s, half):
        start = time.process_time()
        model = mujoco.MjModel.from_xml_string(chain.mujoco(s))
        data = mujoco.MjData(model)
        if half:  # velocities of half a step before the start, which makes the fall exact
            mujoco.mj_kinematics(model, data)
            data.qvel[:2] = data.xaxis[:2] @ np.array([0.0, 0.0, G * s.step / 2.0])
        heights = [chain.HEIGHT + 0.5 * chain.RODS * chain.ROD * chain.SIN]
        for _ in range(round(chain.END / chain.EVERY)):
            mujoco.mj_step(model, data, round(chain.EVERY / s.step))
            mujoco.mj_kinematics(model, data)
            mujoco.mj_comPos(model, data)
            heights.append(data.subtree_com[0][2])
        return time.process_time() - start, np.array(heights)

    contacts = ((2, 5, 0.9999), (2, 2, 0.9999), (3, 1, 0.9999), (2, 1, 0.9))
    runs = [(settings(h, r, t, impedance=d, jacobian="dense"), True) for h in options.fine for t, r, d in contacts]
    runs += [(settings(h, integrator="RK4", jacobian="dense"), False) for h in options.fine]
    some = [h for h in options.fine if h in (5e-4, 1e-4)]
    runs += [(settings(h, jacobian="dense"), False) for h in some]
    runs += [(settings(h, integrator=i, jacobian="dense"), True) for h in some for i in ("Euler", "implicit")]
    runs += [(settings(h, jacobian="sparse"), True) for h in some]
    return [
        ("MuJoCo", described(s) + (", begun half a step before" if half else ""), lambda s=s, half=half: run(s, half))
        for s, half in runs
    ]


def mujoco_beam(_):
    import mujoco
    import numpy as np
    from models import Beam

    beam = Beam()

    def run(s, rods):
        start = time.process_time()
        model = mujoco.MjModel.from_xml_string(beam.mujoco(s, rods))
        data = mujoco.MjData(model)
        moments, forces = [0.0], [0.0]
        for _ in range(round(beam.END / beam.EVERY)):
            mujoco.mj_step(model, data, round(beam.EVERY / s.step))
            moments.append(model.jnt_stiffness[0] * data.qpos[0])
            forces.append(np.sum(data.efc_force))
        return time.process_time() - start, np.array(moments), np.array(forces)

    runs = [
        (settings(h, r, t, impedance=d), n)
        for n in (10, 20, 40, 80)
        for h in (2e-3, 1e-3, 5e-4, 2e-4, 1e-4)
        for t, r in ((2, 5), (2, 1), (5, 1), (10, 1))
        for d in (0.9, 0.99, 0.9999)
    ]
    runs += [(settings(h, r, 2, impedance=0.9), 160) for h in (1e-3, 5e-4, 2e-4) for r in (1, 5)]
    runs += [(settings(h, 1, 2, i, impedance=0.9), n) for n in (20, 40) for h in (1e-3, 5e-4) for i in ("Euler", "implicit")]
    return [("MuJoCo", f"{n} rods, {described(s)}", lambda s=s, n=n: run(s, n)) for s, n in runs]


# --- Exudyn ----------------------------------------------------------------------------------------------------------


def exudyn_runs(compute, cases, rows, limit):
    """Runs of a function of exudyn_models.py; one that takes steps of other sizes has other times of its rows."""

    def run(arguments):
        from exudyn_models import Stopped

        try:
            cpu, *found = compute(*arguments)
        except Stopped as stopped:
            raise Failed(str(stopped)) from stopped
        if len(found[0]) != rows:
            raise Failed("the solver's own shorter steps miss times of the rows")
        return cpu, *found

    def settings(steps, stiffness, damping, radius):
        return f"{limit / steps * 1e3:.3g} ms, stiffness {stiffness:g}, damping {damping:g}, ρ∞ {radius}"

    return [
        ("Exudyn", "".join(f"{n} elements, " for n in first) + settings(*rest), lambda a=(*first, *rest): run(a))
        for first, rest in cases
    ]


def exudyn_chain(_):
    from exudyn_models import chain
    from models import Chain

    laws = [(k, d) for k in (1e4, 1e5, 1e6) for d in (3e-3 * k**0.5, 3e-2 * k**0.5, 0.1 * k**0.5)]
    cases = [((), (steps, *law, r)) for steps in (200, 1000, 4000, 10000) for law in laws for r in (0.5, 0.9)]
    return exudyn_runs(chain, cases, round(Chain.END / Chain.EVERY) + 1, Chain.END)


def exudyn_beam(_):
    from exudyn_models import beam
    from models import Beam

    laws = [(k, d) for k in (1e4, 1e5, 1e6, 1e7) for d in (0.1 * k**0.5, 0.3 * k**0.5)]
    cases = [
        ((n,), (steps, *law, r)) for n in (10, 20, 40, 80) for steps in (90, 150, 300, 600) for law in laws for r in (0.5, 0.9)
    ]
    return exudyn_runs(beam, cases, round(Beam.END / Beam.EVERY) + 1, Beam.END)


# --- errors ----------------------------------------------------------------------------------------------------------


def chain_error(options):
    import numpy as np

    with open(HERE / "reference.csv", newline="") as file:
        reference = np.array([float(row[1]) for row in csv.reader(line for line in file if line[0].isdigit())])
    return lambda heights: {"error": float(np.max(np.abs(heights - reference)))}


def beam_error(_):
    import numpy as np
    from models import Beam

    def error(moments, forces):
        last = slice(-len(moments) // 3 if len(moments) > 2 else 0, None)
        relative = lambda values, exact: float(np.max(np.abs(values[last] / exact - 1.0)))
        return {"error": relative(moments, Beam.MOMENT), "floor": relative(forces, Beam.FLOOR)}

    return error


# --- measuring and reporting -----------------------------------------------------------------------------------------


def measure(runs, error, repetitions):
    rows, failed = [], []
    for program, name, run in runs:
        try:
            cpu, *found = run()
            row = {"program": program, "settings": name, "cpu": cpu, **error(*found)}
            if row["error"] != row["error"]:
                raise Failed("not a number")
            rows.append((row, run))
        except Failed as reason:
            failed.append({"program": program, "settings": name, "reason": str(reason)})
        if sys.stderr.isatty():
            print(f"\r\033[K{program}, {name}", end="", file=sys.stderr, flush=True)
    kept = [(r, run) for r, run in rows if not any(beats(other, r) for other, _ in rows)]
    for _ in range(repetitions - 1):
        for row, run in kept:
            row["cpu"] = min(row["cpu"], run()[0])
    front = [r for r, _ in kept if not any(beats(other, r, 1.0, 1.05) for other, _ in kept)]
    return [row for row, _ in rows], sorted(front, key=lambda r: (r["program"], -r["error"])), failed


def beats(other, row, slack=1.1, rounding=1.0):
    same = other["program"] == row["program"] and other is not row
    return same and other["error"] <= rounding * row["error"] and other["cpu"] * slack < row["cpu"]


def show(kept, failed, what):
    extra = " error of what the floor carries |" if "floor" in kept[0] else ""
    print(f"\n| program | settings | {what} |{extra} processor time [s] |")
    print("|---|---|---|" + ("---|" if extra else "") + "---|")
    for r in kept:
        floor = f" {r['floor']:.1e} |" if extra else ""
        print(f"| {r['program']} | {r['settings']} | {r['error']:.1e} |{floor} {r['cpu']:.3g} |")
    for f in failed:
        print(f"failed: {f['program']}, {f['settings']}: {f['reason']}")


def write_reference(options):
    """The heights by Flexion with its finest step, and how MuJoCo's two finest runs, extrapolated to no step, differ from them."""
    import numpy as np
    from models import G, Chain

    chain = Chain()
    _, columns = flexion(options.flexion, chain.flexion(nonsmooth(5e-5, 0.5)))
    heights = np.array(columns["energy.gravity [J]"]) / (chain.RODS * chain.MASS * G)
    fine = {h: run()[1] for h in (1e-5, 5e-6) for run in [mujoco_chain(types.SimpleNamespace(fine=[h]))[2][2]]}
    extrapolated = 2.0 * fine[5e-6] - fine[1e-5]
    print(f"MuJoCo, extrapolated, differs by {np.max(np.abs(extrapolated - heights)):.2e} m")
    with open(HERE / "reference.csv", "w") as file:
        file.write("# Height of the centre of mass of the chain: Flexion, nonsmooth-generalized-alpha, steps of 0.05 ms, rho 0.5.\n")
        file.write("# MuJoCo with steps of 0.01 and 0.005 ms, extrapolated to no step, is compared with it by --reference.\n")
        file.write("time [s],height [m]\n")
        for t, z in zip(columns["time [s]"], heights):
            file.write(f"{t:.12g},{z:.12g}\n")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="*", default=["chain", "beam"], help="chain, beam, or both")
    parser.add_argument("--flexion", required=True, help="path of the flexion binary")
    programs = ("mujoco", "exudyn", "flexion")
    parser.add_argument("--programs", nargs="+", choices=programs, default=programs, help="which are run")
    parser.add_argument("-n", "--repetitions", type=int, default=3)
    parser.add_argument("--reference", action="store_true", help="make reference.csv anew, and end")
    parser.add_argument("--coarse", nargs="+", type=float, default=COARSE, help="Flexion's steps [s] of the chain")
    parser.add_argument("--fine", nargs="+", type=float, default=FINE, help="MuJoCo's steps [s] of the chain")
    parser.add_argument("--out", default=HERE / "results", help="folder of the JSON file")
    return parser.parse_args()


def main():
    options = arguments()
    enter_environment()
    import exudyn
    import mujoco

    if options.reference:
        return write_reference(options)
    cases = {
        "chain": ((mujoco_chain, exudyn_chain), flexion_chain, chain_error, "error of the height [m]"),
        "beam": ((mujoco_beam, exudyn_beam), flexion_beam, beam_error, "error of the moment at the clamp"),
    }
    record = {"mujoco": mujoco.__version__, "exudyn": exudyn.__version__, "repetitions": options.repetitions}
    for name in options.cases:
        theirs, own, error, what = cases[name]
        runs = [run for program in (*theirs, own) if program.__name__.split("_")[0] in options.programs for run in program(options)]
        rows, kept, failed = measure(runs, error(options), options.repetitions)
        print(f"\n{name}: {len(rows)} runs, {len(failed)} failed; those that no other of the same program beats in both")
        show(kept, failed, what)
        record[name] = {"runs": rows, "front": kept, "failed": failed}
    out = pathlib.Path(options.out)
    out.mkdir(parents=True, exist_ok=True)
    (out / "compare.json").write_text(json.dumps(record, indent=1) + "\n")


if __name__ == "__main__":
    main()
