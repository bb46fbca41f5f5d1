"""A BeamDyn deck as pieces of a beam: keypoints, twist, 6x6 sections; and its writing."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline, PPoly

from beam import Piece

# BeamDyn counts shear x, shear y, axial z, bend x, bend y, torsion z; here tangent (z), height (x), across (y), turns likewise.
FROM_BEAMDYN = np.array([2, 0, 1, 5, 3, 4])


@dataclass
class Deck:
    """keypoints (n, 4): x, y, z [m], twist [deg], as in the primary file; stations eta (k,), stiffness and mass (k, 6, 6) in BeamDyn's order."""

    keypoints: np.ndarray
    eta: np.ndarray
    stiffness: np.ndarray
    mass: np.ndarray


def words(path):
    return [line.split() for line in Path(path).read_text(encoding="latin-1").splitlines()]


def read(primary, blade=None):
    """The primary file and the blade file it names (or `blade`)."""
    rows = words(primary)
    key = {row[1].lower(): (i, row[0]) for i, row in enumerate(rows) if len(row) > 1}
    members, count = int(key["member_total"][1]), int(key["kp_total"][1])
    if members != 1:
        raise ValueError("one member only")
    first = key["kp_total"][0] + 1 + members + 2
    keypoints = np.array([[float(x.replace("D", "E")) for x in row[:4]] for row in rows[first : first + count]])
    rows = words(blade or Path(primary).parent / key["bldfile"][1].strip('"'))
    stations = next(int(row[0]) for row in rows if len(row) > 1 and row[1].lower() == "station_total")
    start = next(i for i, row in enumerate(rows) if "DISTRIBUTED" in row) + 1
    numbers = np.array([float(x.replace("D", "E")) for row in rows[start:] for x in row][: stations * 73]).reshape(stations, 73)
    return Deck(keypoints, numbers[:, 0], numbers[:, 1:37].reshape(-1, 6, 6), numbers[:, 37:].reshape(-1, 6, 6))


def spline(z, values):
    """Natural cubic spline."""
    return CubicSpline(z, values, bc_type="natural")


def polynomial(z, values, order):
    """The polynomial in z that OpenFAST 4 fits to keypoints: least squares, both ends exact, at most of degree 6; as one interval."""
    degree = min(order, len(z) - 1, 6)
    t = (z - z[0]) / (z[-1] - z[0])
    ends = values[0] + (values[-1] - values[0]) * t
    free = t[:, None] * (1 - t[:, None]) * t[:, None] ** np.arange(degree - 1)
    c = np.linalg.lstsq(free, values - ends, rcond=None)[0]
    inside = np.polynomial.Polynomial(np.concatenate([[0.0], c, [0.0]])) - np.polynomial.Polynomial(np.concatenate([[0.0, 0.0], c]))
    whole = inside + np.polynomial.Polynomial([values[0], values[-1] - values[0]])
    scaled = np.zeros(degree + 1)
    scaled[: len(whole.coef)] = whole.coef[: degree + 1]
    return PPoly((scaled / (z[-1] - z[0]) ** np.arange(degree + 1))[::-1, None], z[[0, -1]])


class Line:
    """Reference line x(z), y(z) by natural cubic splines, twist linear in z; axes of the section: tangent, height, across.

    order: given, line and twist are the polynomials of OpenFAST 4 for elements of that order instead. Height is the axis x of the blade laid square to the tangent within the plane x-z, then turned about the tangent by minus the twist.
    """

    def __init__(self, keypoints, order=None):
        x, y, self.z, twist = keypoints.T
        if order is None:
            self.x, self.y = spline(self.z, x), spline(self.z, y)
            self.twist = PPoly(np.array([np.diff(twist) / np.diff(self.z), twist[:-1]]), self.z)
        else:
            self.x, self.y, self.twist = (polynomial(self.z, v, order) for v in (x, y, twist))
            self.z = self.z[[0, -1]]
        points, weights = np.polynomial.legendre.leggauss(20)
        self.rule = (points + 1) / 2, weights / 2
        self.arc = np.concatenate([[0], np.cumsum([self.length(a, b) for a, b in zip(self.z[:-1], self.z[1:])])])

    def evaluate(self, polynomial, z, interval, order=0):
        """Of the interval's own polynomial, also at complex z."""
        c = polynomial.c[:, interval]
        for _ in range(order):
            c = c[:-1] * np.arange(len(c) - 1, 0, -1)
        return np.polyval(c, z - self.z[interval])

    def interval(self, z):
        return int(np.clip(np.searchsorted(self.z, z, side="right") - 1, 0, len(self.z) - 2))

    def slope(self, z, interval):
        """dr/dz (n, 3)."""
        return np.stack([self.evaluate(self.x, z, interval, 1), self.evaluate(self.y, z, interval, 1), 1 + 0 * z], -1)

    def length(self, a, b):
        """Arc length between heights a and b of one interval [m]."""
        x, w = self.rule
        d = self.slope(a + (b - a) * x, self.interval((a + b) / 2))
        return (b - a) * (w * np.sqrt((d * d).sum(-1))).sum()

    def arc_at(self, z, interval):
        return self.arc[interval] + self.length(self.z[interval], z)

    def height(self, arc):
        """z where the arc length is so much, by Newton."""
        i = int(np.clip(np.searchsorted(self.arc, arc, side="right") - 1, 0, len(self.z) - 2))
        z = np.interp(arc, self.arc, self.z)
        for _ in range(20):
            slope = self.slope(np.array(z), i)
            z = z - (self.arc_at(z, i) - arc) / np.sqrt((slope * slope).sum())
        return z

    def axes(self, z, interval):
        """(n, 3, 3), columns tangent, height, across in x, y, z; for real or complex z."""
        d = self.slope(z, interval)
        t = d / np.sqrt((d * d).sum(-1))[..., None]
        square = np.sqrt(t[..., 0] ** 2 + t[..., 2] ** 2)
        e1 = np.stack([t[..., 2] / square, 0 * square, -t[..., 0] / square], -1)
        e2 = np.cross(t, e1)
        angle = -np.pi / 180 * self.evaluate(self.twist, z, interval)
        c, s = np.cos(angle)[..., None], np.sin(angle)[..., None]
        return np.stack([t, c * e1 + s * e2, -s * e1 + c * e2], -1)

    def place(self, z):
        i = self.interval(z)
        return np.array([self.evaluate(self.x, z, i), self.evaluate(self.y, z, i), z])


def pieces(deck, along="z", order=None):
    """Pieces between all keypoints and stations, the axes at the root (columns, in the axes of the deck), and the line.

    along: "z" counts the stations' eta along z, as BeamDyn's code does for a blade of one member; "arc" along the line, as its manual says.
    """
    line = Line(deck.keypoints, order)
    order = np.ix_(FROM_BEAMDYN, FROM_BEAMDYN)
    stiffness = np.array([k[order] for k in deck.stiffness])
    mass = np.array([k[order] for k in deck.mass])
    bottom, top, total = line.z[0], line.z[-1], line.arc[-1]
    heights = [line.height(total * e) for e in deck.eta] if along == "arc" else list(bottom + (top - bottom) * deck.eta)
    # Stations within 1e-7 of the length of a keypoint are that keypoint.
    cuts = list(line.z)
    cuts += [h for h in heights if np.abs(line.z - h).min() > 1e-7 * (top - bottom)]
    cuts = np.sort(cuts)
    made, before = [], None
    for a, b in zip(cuts[:-1], cuts[1:]):
        interval = line.interval((a + b) / 2)
        middle = (line.arc_at((a + b) / 2, interval) / total) if along == "arc" else ((a + b) / 2 - bottom) / (top - bottom)
        station = int(np.clip(np.searchsorted(deck.eta, middle) - 1, 0, len(deck.eta) - 2))

        def at(t, a=a, b=b, interval=interval, station=station):
            z = a + (b - a) * t
            d = line.slope(z, interval)
            ds = np.sqrt((d * d).sum(-1))
            step = 1e-30
            rotation = line.axes(z, interval)
            change = line.axes(z + 1j * step, interval).imag / step
            w = np.einsum("nij,nik->njk", rotation, change) / ds[:, None, None]
            k = np.stack([w[:, 2, 1], w[:, 0, 2], w[:, 1, 0]], -1)
            eta = np.array([line.arc_at(x, interval) for x in z]) / total if along == "arc" else (z - bottom) / (top - bottom)
            share = ((eta - deck.eta[station]) / (deck.eta[station + 1] - deck.eta[station]))[:, None, None]
            return (
                ds * (b - a),
                k,
                (1 - share) * stiffness[station] + share * stiffness[station + 1],
                (1 - share) * mass[station] + share * mass[station + 1],
            )

        start = line.axes(np.array([a]), interval)[0]
        turn = np.eye(3) if before is None else before.T @ start
        before = line.axes(np.array([b]), interval)[0]
        made.append(Piece(at, turn))
    return made, line.axes(np.array([cuts[0]]), line.interval(cuts[0]))[0], line


def mounting(hub=0.0, precone=0.0, pitch=0.0):
    """Place of the root [m] and axes x, y, z of the blade (columns) in the turning frame, whose axis of rotation is x.

    precone [rad] leans the blade towards +x, the hub radius along with it; pitch [rad] turns the blade about its z by minus that angle.
    """
    c, s = np.cos(precone), np.sin(precone)
    cone = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    c, s = np.cos(-pitch), np.sin(-pitch)
    turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    return hub * cone[:, 2], cone @ turn


def rows(matrix):
    return "\n".join(" ".join(f"{x: .9e}" for x in row) for row in matrix)


def write(deck, primary, blade):
    """The deck as a BeamDyn primary file and blade file."""
    n = len(deck.keypoints)
    keypoints = "\n".join(" ".join(f"{x: .9e}" for x in row) for row in deck.keypoints)
    Path(primary).write_text(f"""--------- BEAMDYN with OpenFAST INPUT FILE -------------------------------------------
A random deck
---------------------- SIMULATION CONTROL --------------------------------------
False         Echo             - Echo input data (flag)
True          QuasiStaticInit  - Quasi-static pre-conditioning (flag)
          0   rhoinf           - Numerical damping of the integrator
          2   quadrature       - 1=Gaussian; 2=Trapezoidal
"DEFAULT"     refine           - Refinement of the trapezoidal quadrature (-)
"DEFAULT"     n_fact           - Factorization frequency (-)
"DEFAULT"     DTBeam           - Time step size (s)
"DEFAULT"     load_retries     - Number of factored load retries
"DEFAULT"     NRMax            - Max number of iterations (-)
"DEFAULT"     stop_tol         - Tolerance (-)
"DEFAULT"     tngt_stf_fd      - Finite differenced tangent stiffness (flag)
"DEFAULT"     tngt_stf_comp    - Compare tangent stiffness (flag)
"DEFAULT"     tngt_stf_pert    - Perturbation size (-)
"DEFAULT"     tngt_stf_difftol - Allowable difference (-)
True          RotStates        - Orient states in the rotating frame (flag)
---------------------- GEOMETRY PARAMETER --------------------------------------
          1   member_total     - Total number of members (-)
{n:11d}   kp_total         - Total number of key points (-)
     1 {n:4d}                 - Member number; Number of key points in this member
   kp_xr         kp_yr         kp_zr        initial_twist
   (m)            (m)          (m)            (deg)
{keypoints}
---------------------- MESH PARAMETER ------------------------------------------
          5   order_elem       - Order of interpolation (-)
---------------------- MATERIAL PARAMETER --------------------------------------
"{Path(blade).name}"    BldFile - Name of file containing properties for blade
---------------------- PITCH ACTUATOR PARAMETERS -------------------------------
False         UsePitchAct      - Whether a pitch actuator should be used (flag)
          1   PitchJ           - Pitch actuator inertia (kg-m^2)
          0   PitchK           - Pitch actuator stiffness (kg-m^2/s^2)
          0   PitchC           - Pitch actuator damping (kg-m^2/s)
---------------------- OUTPUTS -------------------------------------------------
False         SumPrint         - Print summary data (flag)
"ES10.3E2"    OutFmt           - Format
          0   NNodeOuts        - Number of nodes to output (-)
          0   OutNd            - Nodes to output (-)
          OutList              - Output parameters
END of input file
---------------------------------------------------------------------------------------
""")
    stations = "\n".join(f" {e:.9f}\n{rows(k)}\n\n{rows(m)}\n" for e, k, m in zip(deck.eta, deck.stiffness, deck.mass))
    Path(blade).write_text(f""" ------- BEAMDYN V1.00.* INDIVIDUAL BLADE INPUT FILE --------------------------
 A random deck
 ---------------------- BLADE PARAMETERS --------------------------------------
{len(deck.eta)}   station_total    - Number of blade input stations (-)
 0   damp_type        - Damping type: 0: no damping; 1: damped
  ---------------------- DAMPING COEFFICIENT------------------------------------
   mu1        mu2        mu3        mu4        mu5        mu6
   (-)        (-)        (-)        (-)        (-)        (-)
 0.0 0.0 0.0 0.0 0.0 0.0
 ---------------------- DISTRIBUTED PROPERTIES---------------------------------
{stations}""")
