"""The beam of case.toml in CalculiX: solid elements, centrifugal load with large displacements, then frequencies
about the loaded state. Needs `ccx` (Debian: calculix-ccx) and Python 3.

    python3 benches/calculix/run.py [FOLDER FOR CALCULIX'S FILES]
"""

import pathlib
import subprocess
import sys
import tempfile

LENGTH, WIDTH, HEIGHT, RADIUS = 1.0, 0.020, 0.040, 0.1
MODULUS, DENSITY, POISSON = 210e9, 7850.0, 0.3
SPEEDS = (0.0, 100.0, 300.0)
ALONG, ACROSS, UP, MODES = 60, 4, 2, 8


def deck(speed):
    """Quadratic bricks (C3D20) along x; y in the plane of rotation, z along its axis."""
    number, nodes = {}, []

    def node(i, j, k):
        if (i, j, k) not in number:
            number[i, j, k] = len(number) + 1
            x = RADIUS + LENGTH * i / (2 * ALONG)
            y, z = HEIGHT * (j / (2 * ACROSS) - 0.5), WIDTH * (k / (2 * UP) - 0.5)
            nodes.append(f"{number[i, j, k]}, {x:.9g}, {y:.9g}, {z:.9g}")
        return number[i, j, k]

    corners = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
    edges = [(1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2)]
    edges += [(0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)]
    elements = []
    for i in range(ALONG):
        for j in range(ACROSS):
            for k in range(UP):
                ids = [node(2 * i + a, 2 * j + b, 2 * k + c) for a, b, c in corners + edges]
                row = f"{len(elements) + 1}, " + ", ".join(map(str, ids[:10])) + ",\n" + ", ".join(map(str, ids[10:]))
                elements.append(row)
    root = [str(n) for (i, _, _), n in number.items() if i == 0]
    lines = ["*NODE, NSET=NALL", *nodes, "*ELEMENT, TYPE=C3D20, ELSET=EALL", *elements]
    lines += ["*NSET, NSET=ROOT", *[n + "," for n in root], "*BOUNDARY", "ROOT, 1, 3"]
    lines += ["*MATERIAL, NAME=STEEL", "*ELASTIC", f"{MODULUS}, {POISSON}", "*DENSITY", f"{DENSITY}"]
    lines += ["*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL"]
    if speed:
        lines += ["*STEP, NLGEOM", "*STATIC", "1., 1.", "*DLOAD"]
        lines += [f"EALL, CENTRIF, {speed**2}, 0., 0., 0., 0., 0., 1.", "*END STEP"]
    lines += ["*STEP, PERTURBATION" if speed else "*STEP", "*FREQUENCY", f"{MODES}", "*END STEP", ""]
    return "\n".join(lines)


def frequencies(folder, speed):
    name = f"beam_{speed:.0f}"
    (folder / f"{name}.inp").write_text(deck(speed))
    with open(folder / f"{name}.log", "w") as log:
        subprocess.run(["ccx", name], cwd=folder, check=True, stdout=log, stderr=subprocess.STDOUT)
    found = []
    for line in (folder / f"{name}.dat").read_text().splitlines():
        words = line.split()
        # Mode, eigenvalue, frequency in rad/s and in Hz, imaginary part; the tables that follow have more columns.
        if len(words) == 5 and words[0].isdigit():
            found.append(float(words[3]))
    return found[:MODES]


if __name__ == "__main__":
    if len(sys.argv) > 1:
        folder = pathlib.Path(sys.argv[1])
        folder.mkdir(parents=True, exist_ok=True)
    else:
        folder = pathlib.Path(tempfile.mkdtemp())
    for speed in SPEEDS:
        print(f"{speed:g} rad/s:", *[f"{f:.4f}" for f in frequencies(folder, speed)])
