"""200 random legal decks and their frequencies at rest and at speed.

    python random_decks.py make                draws the decks: data/decks.json
    python random_decks.py solve               data/frequencies_z.csv and data/frequencies_arc.csv (some minutes)
    python random_decks.py statics             data/statics.csv, the first 100 (ten minutes)
    python random_decks.py write FOLDER [N]    deck N, or all, as BeamDyn primary and blade files
"""

import csv
import json
import sys
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from beam import Beam, Load, cross_matrix
from decks import FROM_BEAMDYN, Deck, mounting, pieces, write

DATA = Path(__file__).parent / "data"
COUNT, SEED = 200, 23
# 0 .. 5 of BeamDyn's order, as places in the order tangent, height, across
TO_BEAMDYN = np.argsort(FROM_BEAMDYN)
UPPER = np.triu_indices(6)


def digits(values, n=7):
    return [float(f"{v:.{n}g}") for v in np.ravel(values)]


def places(rng, count, least):
    """0, 1 and what is between them, at least so far apart."""
    while True:
        x = np.sort(np.concatenate([[0, 1], rng.uniform(0, 1, count - 2)]))
        if np.diff(x).min() > least:
            return np.round(x, 4)


def moved(matrix, angle, shift):
    """The section's matrix in axes turned by the angle about the tangent and from a line that lies at -shift (height, across)."""
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
    both = np.kron(np.eye(2), turn)
    move = np.eye(6)
    move[3:, :3] = cross_matrix(np.array([0.0, *shift]))
    return move @ both @ matrix @ both.T @ move.T


def draw(rng, number):
    length = float(np.round(np.exp(rng.uniform(np.log(5), np.log(120))), 3))
    stations, points = 2 + number % 7, int(rng.integers(3, 9))
    eta, along = places(rng, stations, 0.05), places(rng, points, 0.08)
    bend, sweep = rng.uniform(-0.08, 0.08), rng.uniform(-0.05, 0.05)
    keypoints = np.zeros((points, 4))
    keypoints[:, 0] = length * bend * along ** rng.uniform(1.5, 3)
    keypoints[:, 1] = length * sweep * along ** rng.uniform(1.5, 3)
    keypoints[:, 2] = length * along
    keypoints[:, 3] = rng.uniform(-5, 20) * (1 - along) ** rng.uniform(1, 2) + rng.uniform(-6, 6) * along
    keypoints = np.round(keypoints, 4)
    chord = length / rng.uniform(12, 25) * (1 - (1 - rng.uniform(0.3, 0.9)) * eta)
    thick = rng.uniform(0.15, 0.6) * chord
    modulus, density = 10 ** rng.uniform(9.5, 10.5), 10 ** rng.uniform(2.5, 3.2)
    fill = rng.uniform(0.05, 0.5)
    stiffness, mass = [], []
    for c, t in zip(chord, thick):
        area = fill * c * t
        r2, r3 = rng.uniform(0.25, 0.35) * t, rng.uniform(0.25, 0.35) * c  # height is through the thickness, across along the chord
        bends = modulus * area * np.array([r3**2, r2**2])  # about height, about across
        shear = modulus * area * rng.uniform(0.05, 0.25, 2)
        torsion = rng.uniform(0.1, 0.6) * bends[1]
        diagonal = np.array([modulus * area, *shear, torsion, *bends])
        couple = np.triu(rng.uniform(-0.15, 0.15, (6, 6)), 1)
        k = (np.eye(6) + couple + couple.T) * np.sqrt(np.outer(diagonal, diagonal))
        stiffness.append(moved(k, rng.uniform(-0.3, 0.3), rng.uniform(-1, 1, 2) * [0.1 * t, 0.15 * c]))
        m = density * area
        x, y = rng.uniform(-1, 1, 2) * [0.1 * t, 0.15 * c]
        i4, i5 = m * rng.uniform(0.8, 1.2) * r3**2, m * rng.uniform(0.8, 1.2) * r2**2  # about x (height) and y (across), mass centre
        cross = rng.uniform(-0.3, 0.3) * np.sqrt(i4 * i5)
        mass.append([m, x, y, i4 + m * y * y, i5 + m * x * x, cross + m * x * y])
    return {
        "keypoints": keypoints.tolist(),
        "eta": eta.tolist(),
        "stiffness": [digits(k[np.ix_(TO_BEAMDYN, TO_BEAMDYN)][UPPER]) for k in stiffness],
        "mass": [digits(m) for m in mass],
        "hub": float(np.round(rng.uniform(0, 0.2) * length, 3)),
        "precone": float(np.round(rng.uniform(-8, 8), 2)),
        "pitch": float(np.round(rng.uniform(-15, 15), 2)),
    }


def deck_of(entry):
    """m, x, y, i_edge, i_flap, i_cp to BeamDyn's mass matrix; the polar moment is the sum of the two."""
    stiffness = np.zeros((len(entry["eta"]), 6, 6))
    mass = np.zeros_like(stiffness)
    for k, values, body, section in zip(stiffness, entry["stiffness"], entry["mass"], mass):
        k[UPPER] = values
        k += np.triu(k, 1).T
        m, x, y, i4, i5, cross = body
        first = m * cross_matrix(np.array([x, y, 0.0]))
        section[:3, :3], section[:3, 3:], section[3:, :3] = m * np.eye(3), -first, first
        section[3:, 3:] = [[i4, -cross, 0], [-cross, i5, 0], [0, 0, i4 + i5]]
    return Deck(np.array(entry["keypoints"]), np.array(entry["eta"]), stiffness, mass)


def solve(entry, along, speeds, elements=20, points=7):
    """For each speed: frequencies [Hz], displacement of the tip [m], largest real part over |root|; at least so many elements."""
    deck = deck_of(entry)
    parts, axes, _ = pieces(deck, along)
    place, frame = mounting(entry["hub"], np.radians(entry["precone"]), np.radians(entry["pitch"]))
    beam = Beam(parts, frame @ axes, place, points=points, split=-(-elements // len(parts)))
    start = beam.steady().tip()[0]
    found = []
    for speed in speeds:
        beam.steady((speed, 0, 0))
        f, real = beam.frequencies(6)
        found.append((f, beam.tip()[0] - start, real))
    return found


def make():
    rng = np.random.default_rng(SEED)
    entries = []
    for number in range(COUNT):
        entry = draw(rng, number)
        deck = deck_of(entry)
        assert all(np.linalg.eigvalsh(a).min() > 0 for a in [*deck.stiffness, *deck.mass])
        first = solve(entry, "z", [0.0])[0][0][0]
        share = rng.uniform(0.2, 0.9)
        while True:
            entry["speed"] = digits(share * 2 * np.pi * first, 5)[0]
            if solve(entry, "z", [entry["speed"]])[0][2] < 1e-6:
                break
            share *= 0.7
            print(f"deck {number} unstable, slower: speed {share:.2f} of the first frequency")
        entries.append(entry)
    text = ",\n".join(json.dumps(entry, separators=(",", ":")) for entry in entries)
    DATA.joinpath("decks.json").write_text(f"[\n{text}\n]\n")


def run():
    entries = json.loads(DATA.joinpath("decks.json").read_text())
    for along in ("z", "arc"):
        worst = 0.0
        with open(DATA / f"frequencies_{along}.csv", "w", newline="") as file:
            out = csv.writer(file)
            out.writerow(["deck", "speed [rad/s]", *(f"f{i} [Hz]" for i in range(1, 7)), "tip x [m]", "tip y [m]", "tip z [m]", "two resolutions", "real part"])
            for number, entry in enumerate(entries):
                speeds = [0.0, entry["speed"]]
                coarse, fine = (solve(entry, along, speeds, *size) for size in ((20, 10), (40, 8)))
                for speed, (f, _, _), (g, tip, real) in zip(speeds, coarse, fine):
                    change = np.abs(f / g - 1).max()
                    worst = max(worst, change)
                    tip = np.where(np.abs(tip) < 1e-12, 0, tip)
                    out.writerow([number, speed, *(f"{x:.10g}" for x in g), *(f"{x:.8g}" for x in tip), f"{change:.1e}", f"{real:.1e}"])
        print(f"eta along {along}: two resolutions differ by at most {worst:.1e}")


def statics():
    """Dead force and couple at the tip and dead load a length, together, in the deck's axes, without hub, precone and pitch; eta along z."""
    entries = json.loads(DATA.joinpath("decks.json").read_text())
    with open(DATA / "frequencies_z.csv") as file:
        first = {int(r["deck"]): float(r["f1 [Hz]"]) for r in csv.DictReader(file) if float(r["speed [rad/s]"]) == 0}
    rng, worst = np.random.default_rng(SEED + 1), 0.0
    with open(DATA / "statics.csv", "w", newline="") as file:
        out = csv.writer(file)
        names = [f"{name} {axis} [{unit}]" for name, unit in (("force", "N"), ("couple", "N m"), ("load", "N/m"), ("tip", "m"), ("rotation", "rad")) for axis in "xyz"]
        out.writerow(["deck", *names, "two resolutions"])
        for number, entry in enumerate(entries[:100]):
            deck = deck_of(entry)
            length = deck.keypoints[-1, 2]
            size = 0.06 * length * 0.25 * length * deck.mass[:, 0, 0].mean() * (2 * np.pi * first[number]) ** 2
            vectors = rng.standard_normal((3, 3))
            vectors *= (size * np.array([1, 0.3 * length, 1 / length]) / np.linalg.norm(vectors, axis=1))[:, None]
            vectors = [digits(v, 5) for v in vectors]
            parts, axes, line = pieces(deck)
            found = []
            for elements, points in ((20, 10), (36, 8)):
                beam = Beam(parts, axes, points=points, split=-(-elements // len(parts))).steady()
                before = beam.tip()[1]
                place, after = beam.steady(load=Load(*vectors), steps=2).tip()
                turned = Rotation.from_matrix(after @ before.T).as_rotvec()
                found.append(np.concatenate([place - line.place(line.z[-1]), turned]))
            change = np.abs(found[0] - found[1]).max() / np.abs(found[1]).max()
            worst = max(worst, change)
            out.writerow([number, *sum(vectors, []), *(f"{x:.10g}" for x in found[1]), f"{change:.1e}"])
    print(f"two resolutions differ by at most {worst:.1e} of the largest")


def main():
    if sys.argv[1] == "make":
        make()
    elif sys.argv[1] == "solve":
        run()
    elif sys.argv[1] == "statics":
        statics()
    elif sys.argv[1] == "write":
        entries = json.loads(DATA.joinpath("decks.json").read_text())
        folder = Path(sys.argv[2])
        folder.mkdir(parents=True, exist_ok=True)
        chosen = [int(sys.argv[3])] if len(sys.argv) > 3 else range(len(entries))
        for n in chosen:
            write(deck_of(entries[n]), folder / f"deck_{n:03d}.dat", folder / f"deck_{n:03d}_blade.dat")


if __name__ == "__main__":
    main()
