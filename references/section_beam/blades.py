"""Length, mass, centre of mass and frames of two blades, from their BeamDyn decks: python blades.py FOLDER, data/blades.json.

Axes of the sections: tangent, height, across with height = y of BeamDyn (edgewise) and across = −x.
"""

import json
import sys
from pathlib import Path

import numpy as np

from decks import Line, read

STATIONS = [0.0, 0.013, 0.1, 0.25, 0.37, 0.5, 0.66, 0.81, 0.93, 1.0]


def described(primary):
    deck = read(primary)
    line = Line(deck.keypoints)
    total = line.arc[-1]
    bottom, top = line.z[0], line.z[-1]
    cuts = np.unique(np.concatenate([line.z, bottom + (top - bottom) * deck.eta]))
    points, weights = np.polynomial.legendre.leggauss(12)
    mass, moment = 0.0, np.zeros(3)
    for a, b in zip(cuts[:-1], cuts[1:]):
        if b - a < 1e-9:
            continue
        z = a + (b - a) * (points + 1) / 2
        i = line.interval((a + b) / 2)
        ds = np.sqrt((line.slope(z, i) ** 2).sum(-1)) * (b - a) * weights / 2
        eta = (z - bottom) / (top - bottom)
        station = int(np.clip(np.searchsorted(deck.eta, eta.mean()) - 1, 0, len(deck.eta) - 2))
        share = ((eta - deck.eta[station]) / (deck.eta[station + 1] - deck.eta[station]))[:, None, None]
        m = (1 - share) * deck.mass[station] + share * deck.mass[station + 1]
        axes = line.axes(z, i)  # tangent, x turned, y turned
        place = np.stack([line.evaluate(line.x, z, i), line.evaluate(line.y, z, i), z], -1)
        x, y = -m[:, 2, 4], m[:, 2, 3]  # mass times the offsets of its centre
        mass += (ds * m[:, 0, 0]).sum()
        moment += (ds[:, None] * (m[:, 0, 0, None] * place + x[:, None] * axes[:, :, 1] + y[:, None] * axes[:, :, 2])).sum(0)
    frames = []
    for share in STATIONS:
        z = float(line.height(share * total))
        i = line.interval(z)
        axes = line.axes(np.array([z]), i)[0]
        turned = np.stack([axes[:, 0], axes[:, 2], -axes[:, 1]])
        frames.append({"s": share * total, "place": line.place(z).tolist(), "axes": turned.tolist()})
    return {"length": total, "mass": mass, "centre": (moment / mass).tolist(), "frames": frames}


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    names = {"iea_15mw": "IEA-15-240-RWT_BeamDyn.dat", "nrel_5mw": "NRELOffshrBsline5MW_BeamDyn.dat"}
    out = {key: described(folder / name) for key, name in names.items()}
    (Path(__file__).parent / "data" / "blades.json").write_text(json.dumps(out, indent=1) + "\n")
