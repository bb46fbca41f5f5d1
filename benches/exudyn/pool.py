"""Many runs of the spin-up: Flexion's sweep against a warm pool of Exudyn's processes, at equal tip error.

    python pool.py --flexion BINARY [--runs 200] [--workers 2] [--rounds 3]      (--help lists them)

Both compute `--runs` runs of one configuration each, on as many workers, and both are timed from the first run to the last with all that a run takes,
building and results included. Beside them stand single runs of the same configurations, one after the other on one worker: the ratio of the pools over the ratio of
the single runs is what Flexion's sweep keeps of its speed. Rounds alternate, and the medians are given.
"""

import argparse
import multiprocessing
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

from compare import HERE, NAMES, Exudyn, Failed, Reference, enter_environment


def single(job):
    """One run of Exudyn with its building: the error of the tip [m]."""
    kind, elements, steps, modified, tolerance = job
    return Exudyn(kind, elements, steps, modified, tolerance).run(Reference(HERE / "reference.csv"))[2]


def bare(job):
    """The same without its error."""
    import exudyn_model

    kind, elements, steps, modified, tolerance = job
    exudyn_model.run(kind, elements, steps, modified, tolerance)


def sweep(options, runs, threads):
    """Wall time of a sweep [s]: the call of the program with its start, its reading and its files."""
    with tempfile.TemporaryDirectory() as folder:
        vary = f"section.density=2999.9999:3000.0001:{runs}"
        words = [options.flexion, "sweep", HERE / "spin_up_exact.toml", "--vary", vary, "--collect", "tip.deflection.min"]
        words += ["--set", f"basis.elements={options.elements}"]
        words += ["--set", f'integrator={{kind="radau",tolerance={options.tolerance:g},absolute-tolerance={0.01 * options.tolerance:g}}}']
        words += ["--errors", "none", "--threads", str(threads), "--output", pathlib.Path(folder) / "sweep"]
        begin = time.perf_counter()
        done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
        wall = time.perf_counter() - begin
        if done.returncode:
            raise Failed(done.stderr)
        return wall


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--flexion", required=True, help="the program `flexion`")
    parser.add_argument("--runs", type=int, default=200)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--elements", type=int, default=6, help="elements of Flexion")
    parser.add_argument("--tolerance", type=float, default=1e-4, help="relative tolerance of Flexion's Radau")
    parser.add_argument("--kind", default="ancf", choices=NAMES, help="element of Exudyn")
    parser.add_argument("--exudyn-elements", type=int, default=10)
    parser.add_argument("--steps", type=int, default=4000)
    parser.add_argument("--newton", type=float, default=1e-2, help="relative tolerance of Exudyn's Newton")
    parser.add_argument("--modified", action="store_true", help="modified Newton")
    options = parser.parse_args()
    job = (options.kind, options.exudyn_elements, options.steps, options.modified, options.newton)
    print(f"Exudyn {job}: the tip is {single(job):.1e} m off")
    few = max(1, options.runs // 10)
    walls = {name: [] for name in ("pool", "sweep", "single Exudyn", "single Flexion")}
    with multiprocessing.get_context("spawn").Pool(options.workers) as pool:
        pool.map(bare, [job] * options.workers, chunksize=1)
        sweep(options, options.workers, options.workers)
        for _ in range(options.rounds):
            begin = time.perf_counter()
            pool.map(bare, [job] * options.runs, chunksize=1)
            walls["pool"].append((time.perf_counter() - begin) / options.runs)
            walls["sweep"].append(sweep(options, options.runs, options.workers) / options.runs)
            begin = time.perf_counter()
            for _ in range(few):
                bare(job)
            walls["single Exudyn"].append((time.perf_counter() - begin) / few)
            walls["single Flexion"].append(sweep(options, options.runs, 1) / options.runs)
    median = {name: statistics.median(of) for name, of in walls.items()}
    for name, wall in median.items():
        print(f"{name:16} {1e3 * wall:9.3f} ms a run")
    pools, singles = median["pool"] / median["sweep"], median["single Exudyn"] / median["single Flexion"]
    print(f"a pool takes {pools:.1f} times as long as a sweep, a run {singles:.1f} times: {pools / singles:.2f} of the ratio is kept")


if __name__ == "__main__":
    enter_environment(pathlib.Path(__file__).resolve())
    sys.exit(main())
