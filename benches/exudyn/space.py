"""Two motions of slender beams in space in Exudyn, beside the histories that Flexion writes.

    python space.py couple --method ancf --elements 20 --steps 100000 --reference trajectory.csv
    python space.py plate --elements 80 --steps 6000 --end 3 --reference trajectory.csv

`couple`: the cantilever of verification/space_roll_up_release with T0 = 3 s; `plate`: that of verification/space_air_bearing. A
reference is the trajectory.csv of `flexion run` of that case. One thread, fixed steps, nothing but sensors; the time is that of
`SolveDynamic`. Makes and enters the virtual environment of compare.py. Choices: README.md.
"""

import argparse
import csv
import math
import time

import compare

compare.enter_environment(__file__)

import sys  # noqa: E402

sys.exudynFast = True  # the build without range checks, with vector instructions
import exudyn as exu  # noqa: E402
import exudyn.itemInterface as items  # noqa: E402
import numpy as np  # noqa: E402
from exudyn.advancedUtilities import CreateSymbolicUserFunction  # noqa: E402

exu.config.printToConsole = False
sym = exu.symbolic

BETA = 0.2  # damping over mass of the plate [1/s]


class Section:
    """A rectangle of the height h along the second axis and the width w along the third."""

    def __init__(self, modulus, density, height, width):
        area, shear = height * width, modulus / 2.6
        self.about_y, self.about_z = height * width**3 / 12, width * height**3 / 12
        long, short = max(height, width), min(height, width)
        odd = np.arange(1, 200, 2)
        series = np.sum(np.tanh(odd * np.pi * long / (2 * short)) / odd**5)
        torsion = long * short**3 / 3 * (1 - 192 / np.pi**5 * short / long * series)
        self.axial, self.bending = modulus * area, modulus * self.about_z
        self.mass, self.density, self.height = density * area, density, height
        self.stiffness = [
            modulus * area,
            5 / 6 * shear * area,
            5 / 6 * shear * area,
            shear * torsion,
            modulus * self.about_y,
            modulus * self.about_z,
        ]
        self.inertia = [density * (self.about_y + self.about_z), density * self.about_y, density * self.about_z]

    def data(self):
        made = exu.BeamSection()
        made.massPerLength = self.mass
        made.stiffnessMatrix = np.diag(self.stiffness)
        made.inertia = np.diag(self.inertia)
        return made


CANTILEVER = Section(70e9, 2700.0, 2e-3, 2e-3)
PLATE = Section(69e9, 2766.0, 2.5e-3, 0.1)
ROOT, LENGTH, HUB = 0.35, 1.45, 9.557  # [m], [m], [kg m^2]


def torque(mbs, t, loadVector):
    sine = 2 * math.pi * CANTILEVER.bending * sym.sin(math.pi / 3 * t)
    return [0, 0, sym.IfThenElse(t < 3.0, sine, 0 * t)]


def nodes_of(mbs, root, length, elements, roll):
    h = length / elements
    return [
        mbs.AddNode(items.NodeRigidBodyRotVecLG(referenceCoordinates=[root + i * h, 0, 0, roll, 0, 0]))
        for i in range(elements + 1)
    ]


def beam(mbs, section, nodes, length):
    data, h = section.data(), length / (len(nodes) - 1)
    return [
        mbs.AddObject(items.ObjectBeamGeometricallyExact(nodeNumbers=list(pair), length=h, sectionData=data))
        for pair in zip(nodes, nodes[1:])
    ]


def position(mbs, node):
    of = exu.OutputVariableType.Position
    kept = {"storeInternal": True, "writeToFile": False}
    return mbs.AddSensor(items.SensorNode(nodeNumber=node, outputVariableType=of, **kept))


def couple(options):
    """The cantilever: system, names and sensors of what is compared, what must outlive the run."""
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    ground = mbs.AddNode(items.NodePointGround())
    fixed = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))
    n = options.elements
    if options.method == "ancf":
        h = 1.0 / n
        nodes = [mbs.AddNode(items.NodePoint2DSlope1(referenceCoordinates=[i * h, 0, 1, 0])) for i in range(n + 1)]
        for pair in zip(nodes, nodes[1:]):
            last = mbs.AddObject(
                items.ObjectANCFCable2D(
                    length=h,
                    massPerLength=CANTILEVER.mass,
                    bendingStiffness=CANTILEVER.bending,
                    axialStiffness=CANTILEVER.axial,
                    nodeNumbers=list(pair),
                    useReducedOrderIntegration=1,
                )
            )
        held = [0, 1, 3]
        tip = mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=last, localPosition=[h, 0, 0]))
    else:
        nodes = nodes_of(mbs, 0.0, 1.0, n, 0.0)
        beam(mbs, CANTILEVER, nodes, 1.0)
        held = range(6)
        tip = mbs.AddMarker(items.MarkerNodeRigid(nodeNumber=nodes[-1]))
    for coordinate in held:
        moving = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=nodes[0], coordinate=coordinate))
        mbs.AddObject(items.ObjectConnectorCoordinate(markerNumbers=[fixed, moving]))
    load = CreateSymbolicUserFunction(mbs, torque, "loadVectorUserFunction", itemTypeName="LoadTorqueVector")
    mbs.AddLoad(items.LoadTorqueVector(markerNumber=tip, loadVector=[0, 0, 1], loadVectorUserFunction=load))
    sensor = position(mbs, nodes[-1])
    compared = {"beam.tip.position.y": lambda: column(mbs, sensor, 1)}
    if not options.push:
        return mbs, compared, (container, load)
    # Across the plane, for a twentieth of a second.
    size = options.push

    def pushing(mbs, t, loadVector):
        return [0, 0, sym.IfThenElse(t < 0.05, size + 0 * t, 0 * t)]

    across = CreateSymbolicUserFunction(mbs, pushing, "loadVectorUserFunction", itemTypeName="LoadForceVector")
    mbs.AddLoad(items.LoadForceVector(markerNumber=tip, loadVector=[0, 0, 1], loadVectorUserFunction=across))
    compared["beam.tip.position.z"] = lambda: column(mbs, sensor, 2)
    return mbs, compared, (container, load, across)


def column(mbs, sensor, k):
    data = mbs.GetSensorStoredData(sensor)
    return data[:, 0], data[:, 1 + k]


def plate(options):
    """The plate on the air bearing."""
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    ground = mbs.AddObject(items.ObjectGround())
    n = options.elements
    h = LENGTH / n
    bearing = mbs.AddNode(items.NodeRigidBodyRotVecLG())
    inertia = [HUB, HUB, HUB, 0, 0, 0]
    hub = mbs.AddObject(
        items.ObjectRigidBody(mass=10.0, inertia=inertia, nodeNumber=bearing)
    )
    nodes = nodes_of(mbs, ROOT, LENGTH, n, math.pi / 4)
    elements = beam(mbs, PLATE, nodes, LENGTH)

    def marker(body, place=(0, 0, 0)):
        return mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=body, localPosition=list(place)))

    def joint(markers, axes):
        mbs.AddObject(items.ObjectJointGeneric(markerNumbers=markers, constrainedAxes=axes))

    at_nodes = [mbs.AddMarker(items.MarkerNodeRigid(nodeNumber=node)) for node in nodes]
    space = marker(ground)
    joint([space, marker(hub)], [1, 1, 1, 1, 1, 0])
    cos = math.sqrt(0.5)
    roll = exu.HT(rotation=[[1, 0, 0], [0, cos, -cos], [0, cos, cos]], translation=[ROOT, 0, 0])
    seat = mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=hub, localHT=roll))
    mbs.AddObject(
        items.ObjectJointGeneric(
            markerNumbers=[seat, at_nodes[0]], constrainedAxes=[1] * 6
        )
    )
    # The damping, in proportion to the mass that falls to each node.
    for i, at in enumerate(at_nodes):
        share = (0.5 if i in (0, n) else 1.0) * h
        along = [BETA * share * PLATE.mass] * 3
        about = [BETA * share * j for j in PLATE.inertia]
        damping = np.diag(along + about)
        mbs.AddObject(items.ObjectConnectorRigidBodySpringDamper(markerNumbers=[at, space], damping=damping))
    damping = np.diag([0.0, 0.0, 0.0] + [BETA * HUB] * 3)
    mbs.AddObject(items.ObjectConnectorRigidBodySpringDamper(markerNumbers=[marker(hub), space], damping=damping))
    for element in elements:
        mass = mbs.AddMarker(items.MarkerBodyMass(bodyNumber=element))
        mbs.AddLoad(items.LoadMassProportional(markerNumber=mass, loadVector=[0, 0, -9.81]))
    kept = {"storeInternal": True, "writeToFile": False}
    spin = mbs.AddSensor(
        items.SensorNode(nodeNumber=bearing, outputVariableType=exu.OutputVariableType.AngularVelocity, **kept)
    )

    def gauges(place):
        """Axial strain and curvature in the middles of the two elements about a station, and their parts."""
        first = min(max(int(place / h - 0.5), 0), n - 2)
        part = place / h - 0.5 - first
        made = []
        for element, share in [(elements[first], 1 - part), (elements[first + 1], part)]:
            for of, k, factor in [
                (exu.OutputVariableType.StrainLocal, 0, 1.0),
                (exu.OutputVariableType.CurvatureLocal, 2, -0.5 * PLATE.height),
            ]:
                sensor = mbs.AddSensor(items.SensorBody(bodyNumber=element, outputVariableType=of, **kept))
                made.append((sensor, k, share * factor))
        return made

    def strain(place):
        made = gauges(place)

        def read():
            t = column(mbs, made[0][0], 0)[0]
            return t, sum(factor * column(mbs, sensor, k)[1] for sensor, k, factor in made)

        return read

    tip = position(mbs, nodes[-1])
    compared = {
        "bearing.speed": lambda: column(mbs, spin, 2),
        "beam.C.strain": strain(0.3),
        "beam.D.strain": strain(1.2),
        "beam.tip.position.z": lambda: column(mbs, tip, 2),
    }
    return mbs, compared, container


def settings(options):
    made = exu.SimulationSettings()
    made.solution.file.write = False
    made.solution.sensors.writePeriod = options.period
    made.parallel.numberOfThreads = 1
    sparse = options.elements >= 20
    kinds = exu.LinearSolverType
    made.linearSolver.solverType = kinds.EigenSparse if sparse else kinds.EigenDense
    of_time = made.timeIntegration
    of_time.numberOfSteps = options.steps
    of_time.endTime = options.end
    of_time.adaptiveStep = False
    of_time.verboseMode = 0
    of_time.generalizedAlpha.spectralRadius = options.radius
    of_time.newton.useModifiedNewton = options.modified
    of_time.newton.relativeTolerance = options.relative
    of_time.newton.absoluteTolerance = options.absolute
    return made


def read(path):
    """Columns of a trajectory.csv by name."""
    with open(path, newline="") as file:
        rows = [row for row in csv.reader(line for line in file if not line.startswith("#")) if row]
    data = np.array([[float(x) for x in row] for row in rows[1:]])
    return {name.split(" ")[0]: data[:, i] for i, name in enumerate(rows[0])}


def means(t, x, width):
    """Means over intervals of `width` [s]."""
    place = np.minimum((t / width).astype(int), int(round(t[-1] / width)) - 1)
    return np.array([x[place == k].mean() for k in range(place[-1] + 1)])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("case", choices=["couple", "plate"])
    parser.add_argument("--method", choices=["ancf", "ge3d"], default="ge3d")
    parser.add_argument("--elements", type=int, default=20)
    parser.add_argument("--steps", type=int, default=10000)
    parser.add_argument("--end", type=float, default=10.0)
    parser.add_argument("--period", type=float, default=0.01, help="time between samples [s]")
    parser.add_argument("--radius", type=float, default=0.8)
    parser.add_argument("--push", type=float, default=0.0, help="force across the plane of the couple at first [N]")
    parser.add_argument("--modified", action="store_true", help="keep the jacobian")
    parser.add_argument("--relative", type=float, default=1e-6)
    parser.add_argument("--absolute", type=float, default=1e-4)
    parser.add_argument("--reference", help="trajectory.csv of Flexion")
    parser.add_argument("--write", help="file for what is compared")
    options = parser.parse_args()
    mbs, compared, _alive = (couple if options.case == "couple" else plate)(options)
    mbs.Assemble()
    wall, cpu = time.perf_counter(), time.process_time()
    try:
        mbs.SolveDynamic(settings(options), solverType=exu.DynamicSolverType.GeneralizedAlpha)
    except (RuntimeError, ValueError) as error:
        print("stopped:", str(error).strip().splitlines()[-1] if str(error).strip() else error)
    cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
    print(f"{options.case} {options.method}, {options.elements} elements, {options.steps} steps: {wall:.1f} s, cpu {cpu:.1f} s")
    reference = read(options.reference) if options.reference else {}
    lines = {}
    for name, history in compared.items():
        t, x = history()
        lines["time"], lines[name] = t, x
        line = f"{name}: peak {np.max(np.abs(x)):.6g}"
        if name in reference and t[-1] > 0.99 * options.end:
            own = np.interp(t, reference["time"], reference[name])
            peak = np.max(np.abs(own))
            off = np.max(np.abs(x - own)) / peak
            smooth = np.max(np.abs(means(t, x, 0.1) - means(t, own, 0.1))) / peak
            line += f" of {peak:.6g}, off {off:.3%} of the peak, its means over 0.1 s {smooth:.3%}"
        print(line, f"(to {t[-1]:.3g} s)")
    if options.write:
        names = list(lines)
        table = np.column_stack([lines[name] for name in names])
        np.savetxt(options.write, table, delimiter=",", header=",".join(names), comments="")


if __name__ == "__main__":
    main()
