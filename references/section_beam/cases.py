"""Every value this program is held against, one row each.

    python cases.py [DECKS] [--write]     DECKS: folder of the IEA 15 MW and NREL 5 MW decks; --write stores data/checks.csv
"""

import csv
import json
import sys
from pathlib import Path

import numpy as np

import closed_forms as exact
from beam import Beam, Load, cross_matrix, inertia, section, uniform
from decks import Deck, mounting, pieces, read

HERE = Path(__file__).parent
PUBLISHED = json.loads((HERE / "data" / "published.json").read_text())
ROWS = []


def row(case, quantity, mine, reference, against):
    mine, reference = np.atleast_1d(mine), np.atleast_1d(reference)
    names = [quantity] if len(mine) == 1 else [f"{quantity} {i + 1}" for i in range(len(mine))]
    for name, a, b in zip(names, mine, reference):
        ROWS.append((case, name, float(a), float(b), 100 * (a / b - 1) if b else np.nan, against))


def nearest(found, wanted):
    return np.array([found[np.argmin(np.abs(found - w))] for w in wanted])


def line_of(*parts, root=None, split=4, points=8, law=None):
    return Beam(list(parts), root=root, points=points, split=split, tension_torsion=law)


def closed_form_cases():
    for slenderness in (10, 100, 1e4):
        r2 = 1 / slenderness**2
        shear = 1 / r2 / 3
        want = exact.timoshenko(1, 1, shear, 1, r2, 4)
        body = inertia(1, 2 * r2, r2, r2 / 1000)
        f = line_of(uniform(1, section(1 / r2, 7 * shear, shear, 100, 1, 1e4), body), split=8).steady().frequencies(16)[0]
        row(f"Timoshenko cantilever, L/r = {slenderness:g}", "w [rad/s]", nearest(2 * np.pi * f, want), want, "closed form (Huang 1961)")

    thin = section(1e9, 1e9, 1e9, 1e3, 1, 100)
    body = inertia(1, None, 1e-9, 1e-9)
    for speed, hub in ((3, 0), (12, 0), (12, 1)):
        beam = Beam([uniform(1, thin, body)], place=(hub, 0, 0), points=8, split=6)
        f = beam.steady((0, 0, speed)).frequencies(9)[0] * 2 * np.pi
        want = exact.rotating(speed, hub, 0, 3)
        row(f"rotating uniform beam, speed {speed}, hub {hub} L, flap", "w", nearest(f, want), want, "power series")
        soft = Beam([uniform(1, section(1e9, 1e9, 1e9, 1e3, 100, 1), body)], place=(hub, 0, 0), points=8, split=6)
        f = soft.steady((0, 0, speed)).frequencies(9)[0] * 2 * np.pi
        want = exact.rotating(speed, hub, 1, 3)
        row(f"rotating uniform beam, speed {speed}, hub {hub} L, lag", "w", nearest(f, want), want, "power series")
    # Set at an angle to the plane of rotation by the root: w^2 = flap^2 - (speed sin angle)^2 while the other bending is rigid.
    c, s = np.cos(0.5), np.sin(0.5)
    set_at = Beam([uniform(1, section(1e9, 1e9, 1e9, 1e3, 1, 1e7), body)], root=[[1, 0, 0], [0, c, -s], [0, s, c]], place=(1, 0, 0), points=8, split=6)
    f = set_at.steady((0, 0, 12)).frequencies(9)[0] * 2 * np.pi
    want = np.sqrt(exact.rotating(12, 1, 0, 3) ** 2 - (12 * s) ** 2)
    row("rotating uniform beam, speed 12, hub 1 L, set at 0.5 rad", "w", nearest(f, want), want, "power series")
    data = PUBLISHED["rotating_uniform"]
    for speed, flap in zip(data["speed"][:5], data["flap"]):
        f = Beam([uniform(1, thin, body)], points=8, split=6).steady((0, 0, speed)).frequencies(3)[0] * 2 * np.pi
        row(f"rotating uniform beam, speed {speed}", "flap 1", nearest(f, [flap]), flap, "Hamza-Cherif & Houmat 2004")

    E, G, b, t, rho, length, speed = 70e9, 27e9, 0.2, 0.004, 2700, 3.0, 60.0
    stiff = section(1e3 * E * b * t, G * b * t, G * b * t, G * b * t**3 / 3, E * b * t**3 / 12, E * t * b**3 / 12)
    i2, i3 = rho * b * t**3 / 12, rho * t * b**3 / 12
    stiff[4, 4], stiff[5, 5] = 1e3 * stiff[4, 4], 1e3 * stiff[5, 5]
    for law, r2 in ((None, 0.0), ("fibres", (b**2 + t**2) / 12)):
        strip = line_of(uniform(length, stiff, inertia(rho * b * t, None, i2, i3)), law=law)
        f = strip.steady((0, 0, speed)).frequencies(16)[0] * 2 * np.pi
        want = exact.strip_torsion(length, stiff[3, 3], i2 + i3, speed**2 * (i3 - i2), r2, rho * b * t, speed, 2)
        row(f"torsion of a rotating strip, tension-torsion {law}", "w [rad/s]", nearest(f, want), want, "power series")

    wing = dict(length=6.0, bending=9.75e6, torsion=9.88e5, mass=35.75, polar=8.65, offset=0.18)
    want = exact.offset_mass(*wing.values(), 5)
    m, e = wing["mass"], wing["offset"]
    body = inertia(m, wing["polar"] - m * e**2, 1e-9, 1e-9, c2=e)
    stiff = section(1e12, 1e12, 1e12, wing["torsion"], wing["bending"], 1e4 * wing["bending"])
    f = line_of(uniform(wing["length"], stiff, body)).steady().frequencies(9)[0] * 2 * np.pi
    row("wing with its mass centre 0.18 m beside the axis", "w [rad/s]", nearest(f, want), want, "closed form")

    for load in (1.0, 10.0):
        tip = line_of(uniform(1, section(1e9, 1e9, 1e9, 1, 1, 1), np.eye(6))).steady(load=Load(force=(0, 0, load))).tip()[0]
        row(f"elastica, F L2/EI = {load:g}", "tip/L", tip[[0, 2]], exact.elastica(load), "elliptic integrals")
    tip = line_of(uniform(1, section(1e9, 1e9, 1e9, 1, 1, 1), np.eye(6))).steady(load=Load(couple=(0, -3.0, 0))).tip()[0]
    row("bent by a couple 3 EI/L", "tip/L", tip[[0, 2]], [np.sin(3) / 3, (1 - np.cos(3)) / 3], "a circle")

    # The same beam described from a line 0.3 m beside: F and P stay, M and H gain the moment of the force.
    rng = np.random.default_rng(7)
    a = rng.standard_normal((6, 6))
    size = np.sqrt([1e9, 2e8, 3e8, 4e6, 2e7, 6e7])
    stiff = (np.eye(6) + 0.15 * (a @ a.T) / 6) * np.outer(size, size)
    body = inertia(100, None, 3.0, 12.0, 0.2, -0.1, 1.0)
    shift = np.array([0.0, 0.3, -0.2])
    move = np.eye(6)
    move[3:, :3] = -cross_matrix(shift)  # M about the new line = M - shift x F
    here = Beam([uniform(20, stiff, body)], place=(2, 0.5, 0.1), points=8, split=4).steady((0, 1.0, 3.0)).frequencies(6)[0]
    there = Beam([uniform(20, move @ stiff @ move.T, move @ body @ move.T)], place=np.array([2, 0.5, 0.1]) + shift, points=8, split=4)
    row("described from another line, all couplings, at speed", "f [Hz]", there.steady((0, 1.0, 3.0)).frequencies(6)[0], here, "itself")


def published_cases():
    data = PUBLISHED["composite_cantilever"]
    stiff, force = np.array(data["stiffness [lbf, lbf in, lbf in2]"]), Load(force=(0, 0, 150))
    for law, key, who in ((None, "tip_linear_law [in]", "Kynema, 18 nodes"), ("beamdyn", "tip_printed [in]", "BeamDyn, printed"), (None, "tip_printed [in]", "BeamDyn, printed")):
        tip = line_of(uniform(10, stiff, np.eye(6)), law=law).steady(load=force).tip()[0] - [10, 0, 0]
        row(f"composite cantilever, tension-torsion {law}", "u [in]", tip, data[key], who)
    data = PUBLISHED["twisted"]
    stiff = section(data["EA [N]"], data["GA [N]"], data["GA [N]"], data["GJ [N m2]"], *data["EI [N m2]"])
    for law, key in ((None, "tip_linear_law [m]"), ("beamdyn", "tip_r_test_order_7_of_2022 [m]"), (None, "tip_beamdyn_2017 [m]"), (None, "tip_ansys [m]")):
        tip = line_of(uniform(10, stiff, np.eye(6), (np.pi / 20, 0, 0)), law=law).steady(load=Load(force=(0, 0, -4e6))).tip()[0] - [10, 0, 0]
        row(f"twisted beam, tension-torsion {law}", "u [m]", tip, data[key], key)
    data = PUBLISHED["arc_45"]
    radius = data["radius [in]"]
    start = radius * np.array([np.sin(np.pi / 4), -(1 - np.cos(np.pi / 4)), 0])
    signs = np.array([1, -1, 1])
    for values, keys in ((data, ("tip_bathe [in]", "tip_wang_2015 [in]")), (data["gxbeam"], ("tip [in]",))):
        stiff = section(values["EA"], values["GA"], values["GA"], values["GJ"], values["EI"], values["EI"])
        tip = line_of(uniform(radius * np.pi / 4, stiff, np.eye(6), (0, 0, -1 / radius))).steady(load=Load(force=(0, 0, 600))).tip()[0]
        for key in keys:
            row("45 degree arc, a true arc" + ("" if values is data else ", constants of GXBeam"), "u [in]", signs * (tip - start), values[key], key)
    stiff = section(data["EA"], data["GA"], data["GA"], data["GJ"], data["EI"], data["EI"])
    back = np.ix_(*[[1, 2, 0, 4, 5, 3]] * 2)
    deck = Deck(np.array([[0, 0, 0, 0], [7.61205, 0, 38.2683, 0], [29.2893, 0, 70.7107, 0]]), np.array([0, 1.0]), np.array([stiff[back]] * 2), np.array([np.eye(6)] * 2))
    for order, key in ((None, "tip_r_test_2019 [in]"), (14, "tip_three_points [in]")):
        parts, axes, line = pieces(deck, order=order)
        tip = Beam(parts, axes, points=8, split=4).steady(load=Load(force=(0, 600, 0))).tip()[0] - line.place(line.z[-1])
        row(f"45 degree arc by three keypoints, {'natural spline' if order is None else 'polynomial'}", "u [in]", tip[[2, 0, 1]], data[key], key)
    data = PUBLISHED["princeton"]
    h, t, E = data["height [m]"], data["thickness [m]"], data["E [Pa]"]
    G = E / 2 / (1 + data["nu"])
    high, flat = t * h**3 / 12, h * t**3 / 12

    def bent(force, angle, factor=1.0):
        # axis 2 along the height: EI about axis 3 is that of the height
        stiff = section(E * h * t, G * h * t, G * h * t, factor * 0.198 * G * (high + flat), E * flat, E * high)
        c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
        return line_of(uniform(0.508, stiff, np.eye(6))).steady(load=Load(force=(0, force * c, force * s))).tip()[0] - [0.508, 0, 0]

    row("Princeton beam, 8.896 N along and across", "u [m]", [bent(8.896, 0)[1], bent(8.896, 90)[2]], data["along_and_across at 8.896 N [m]"], "a shear-deformable code")
    for angle, *want in data["obrezkov at 8.896 N: angle [deg], along the height, across [m]"]:
        row(f"Princeton beam, 8.896 N at {angle} deg", "u [m]", bent(8.896, angle, 1.31 / 1.198)[1:], want, "Obrezkov 2022")
    for force, *want in data["exudyn at 45 deg: force [N], axial, along the height, across [m]"]:
        row(f"Princeton beam, {force} N at 45 deg", "u [m]", bent(force, 45), want, "Exudyn")
    data = PUBLISHED["uniform_gravity_cantilever"]
    tip = line_of(uniform(10, section(1e4, 1e4, 1e4, 200, 100, 100), np.eye(6))).steady(load=Load(uniform=(0, 9.806, 0)), steps=10).tip()[0] - [10, 0, 0]
    row("cantilever under its weight", "u [m]", tip[[1, 0]], exact.heavy(10, 100, 1e4, 1e4, 9.806), "boundary value problem")
    row("cantilever under its weight", "u [m]", tip[[1, 0]], data["tip x, z [m]"], "BeamDyn, one element of order 5")


def laminates():
    """Minguet and Dugundji: the displacement 500 mm from the root under the largest mass, which hangs at 550 mm."""
    data = PUBLISHED["minguet_dugundji"]
    for name, readings in data["readings"].items():
        number, angle = name.split("_at_")
        entry = next(v for k, v in data.items() if k.startswith(f"stiffness {number[-1]}"))
        stiff = np.diag(entry["diagonal"])
        for key, value in entry.items():
            if key != "diagonal":
                i, j = (int(x) - 1 for x in key.split(","))
                stiff[i, j] = stiff[j, i] = value
        c, s = np.cos(np.radians(float(angle))), np.sin(np.radians(float(angle)))
        root = np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
        for direction, values in readings.items():
            masses, want = values["mass [g]"], np.array(values["displacement [m]"])
            parts = [uniform(0.5, stiff, np.eye(6)), uniform(0.05, stiff, np.eye(6))]
            beam = line_of(*parts, root=root, split=2).steady(load=Load(force=(0, 0, -masses[-1] * 9.80665e-3)))
            found = np.abs(beam.line()[0][2] - [0.5, 0, 0])["u1 u2 u3".split().index(direction)]
            if want.any():
                row(f"laminate {number[-1]} at {angle} deg, mass {masses[-1]} g", f"{direction} [m]", found, want[-1], "measured (Minguet & Dugundji 1990)")


def swept_tips():
    data = PUBLISHED["swept_tip"]
    E, rho, b, h = data["E [psi]"], data["density [lbf s2/in4]"], data["width [in]"], data["thickness [in]"]
    G, area, i2, i3 = E / 2 / (1 + data["nu"]), b * h, b * h**3 / 12, h * b**3 / 12
    stiff = section(E * area, G * area / data["A/Ay"], G * area / data["A/Az"], G * (i2 + i3) / data["(Iy+Iz)/J"], E * i2, E * i3)
    body = inertia(rho * area, None, rho * i2, rho * i3)
    for j, sweep in enumerate(data["sweep [deg]"]):
        c, s = np.cos(np.radians(sweep)), np.sin(np.radians(sweep))
        turn = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
        beam = Beam([uniform(31.5, stiff, body), uniform(6, stiff, body, turn=turn)], place=(2.5, 0, 0), points=8, split=4)
        for i, rpm in enumerate(data["speed [rpm]"]):
            f = beam.steady((0, 0, rpm * np.pi / 30)).frequencies(12)[0]
            want = [data[f"{k} bending [Hz]"][i][j] for k in ("first", "second", "third")]
            if rpm == 750:
                want += [x[j] for x in data["coupled at 750 rpm [Hz]: 1T/5B, 5B/1T, 4B/1T"]]
            row(f"swept tip {sweep} deg, {rpm} rpm", "f [Hz]", nearest(f, want), want, "measured (Epps & Chandra 1996), nearest of mine")
            ROWS.append((f"swept tip {sweep} deg, {rpm} rpm", "first eight [Hz]", " ".join(f"{x:.4f}" for x in f[:8]), "", np.nan, "this program"))


def blade(folder, name, hub, rpm, change=None, axis=0, law=None, **options):
    deck = read(Path(folder) / name)
    if change:
        change(deck)
    parts, axes, line = pieces(deck, **options)
    place, frame = mounting(hub)
    beam = Beam(parts, frame @ axes, place, points=4, tension_torsion=law).steady()
    rest = beam.frequencies(12)[0]
    tip = beam.tip()[0]
    spin = np.zeros(3)
    spin[axis] = rpm * np.pi / 30
    beam.steady(spin)
    return rest, beam.frequencies(12)[0], beam.tip()[0] - tip


def straight(deck):
    deck.keypoints[:, :2] = 0


def centred(deck):
    """The mass centre and the axes of inertia's products at the line: only m and the moments, without m c^2."""
    for mass in deck.mass:
        m, y, x = mass[0, 0], mass[2, 3] / mass[0, 0], -mass[2, 4] / mass[0, 0]
        mass[:3, 3:] = mass[3:, :3] = 0
        mass[3:, 3:] -= m * np.array([[y * y, -x * y, 0], [-x * y, x * x, 0], [0, 0, x * x + y * y]])


def uncoupled(deck):
    """No offset in the mass matrix, moments as they stand."""
    for mass in deck.mass:
        mass[:3, 3:] = mass[3:, :3] = 0


def first_model(deck):
    straight(deck)
    uncoupled(deck)
    deck.stiffness[:] = [np.diag(np.diag(k)) for k in deck.stiffness]
    deck.stiffness[:, [0, 1], [0, 1]] *= 1e6
    deck.mass[:] = [np.diag(np.diag(m)) for m in deck.mass]


def blades(folder):
    iea, nrel, table = "IEA-15-240-RWT_BeamDyn.dat", "NRELOffshrBsline5MW_BeamDyn.dat", "finite elements of director beams"
    speed = [0.53138, 0.70003, 1.50591, 2.15766, 2.95425, 4.07353]
    still = [0.50661, 0.69325, 1.47879, 2.13694, 2.92829, 4.08766]
    for options, name in (({}, "eta along z"), ({"along": "arc"}, "eta along the arc"), ({"order": 10}, "line of OpenFAST 4"), ({"law": "beamdyn"}, "tension-torsion of BeamDyn")):
        rest, turning, tip = blade(folder, iea, 3.97, 7.56, **options)
        row(f"IEA 15 MW at rest, {name}", "f [Hz]", rest[:6], still, table)
        row(f"IEA 15 MW at 7.56 rpm, {name}", "f [Hz]", turning[:6], speed, table)
        row(f"IEA 15 MW at 7.56 rpm, {name}", "steady tip x, y [m]", tip[:2], [0.4056, -0.0129], table)
        if not options:
            ROWS.append(("IEA 15 MW at rest", "first twelve [Hz]", " ".join(f"{x:.6f}" for x in rest), "", np.nan, "this program"))
            ROWS.append(("IEA 15 MW at 7.56 rpm", "first twelve [Hz]", " ".join(f"{x:.6f}" for x in turning), "", np.nan, "this program"))
    for change, name, want in (
        (straight, "straight", [0.5073, 0.7019, 1.4877, 2.2003, 2.9307, 3.963]),
        (uncoupled, "mass offsets dropped, moments kept", [0.5072, 0.6933, 1.4984, 2.1313, 2.9805, 3.672]),
        (centred, "mass centres moved to the line", [0.5072, 0.6933, 1.4984, 2.1313, 2.9805, 3.672]),
        (first_model, "K diagonal, no offsets, straight, no shear", [0.5195, 0.7495, 1.5767, 2.3438, 3.2504, 3.551]),
    ):
        row(f"IEA 15 MW at rest, {name}", "f [Hz]", nearest(blade(folder, iea, 3.97, 7.56, change)[0], want), want, table + ", 1e-3")
    row("IEA 15 MW at 7.56 rpm, turned by 90 degrees", "f [Hz]", blade(folder, iea, 3.97, 7.56, axis=1)[1][:3], [0.5170, 0.7103, 1.501], table)
    rest, turning, tip = blade(folder, nrel, 1.5, 12.1)
    row("NREL 5 MW at rest", "f [Hz]", rest[:6], [0.68582, 1.08057, 1.94681, 3.73930, 4.38517, 5.57593], table)
    row("NREL 5 MW at rest", "f [Hz], elements not aligned,", rest[:6], [0.6857, 1.0805, 1.9463, 3.7387, 4.3844, 5.576], table)
    _, fibres, _ = blade(folder, nrel, 1.5, 12.1, law="beamdyn")
    row("NREL 5 MW at 12.1 rpm, hub 1.5 m", "f [Hz], linear law against BeamDyn's,", turning[:6], fibres[:6], "this program")


def main():
    arguments = [a for a in sys.argv[1:] if a != "--write"]
    closed_form_cases()
    published_cases()
    laminates()
    swept_tips()
    if arguments:
        blades(arguments[0])
    for case, name, mine, want, difference, against in ROWS:
        if isinstance(mine, str):
            print(f"{case:62} {name:32} {mine}")
        else:
            print(f"{case:62} {name:32} {mine:14.8g} {want:14.8g} {difference:11.3g} %  {against}")
    if "--write" in sys.argv:
        with open(HERE / "data" / "checks.csv", "w", newline="") as file:
            out = csv.writer(file)
            out.writerow(["case", "quantity", "this program", "reference", "difference [%]", "against"])
            for case, name, mine, want, difference, against in ROWS:
                number = mine if isinstance(mine, str) else f"{mine:.10g}"
                out.writerow([case, name, number, want if isinstance(want, str) else f"{want:.10g}", "" if np.isnan(difference) else f"{difference:.3g}", against])


if __name__ == "__main__":
    main()
