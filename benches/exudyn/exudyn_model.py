"""The prescribed spin-up of a rotating beam in Exudyn, with its fastest correct settings.

The hub rotation theta(t) enters through coordinate constraints whose offsets are *symbolic* user functions: Exudyn
evaluates them in C++ and never calls Python during a run. The hub radius is zero, so the root does not move.

- `ancf`: ANCFCable2D (cubic, four coordinates a node, global frame). The slope vector of the root follows
  (cos theta, sin theta); its length is therefore 1, which leaves out a root strain of 3e-5.
- `ge2`, `ge3`: ObjectBeamGeometricallyExact2D with two and three nodes an element (linear, quadratic; nodes carry
  x, y, angle). One constraint, root angle = theta. The element is shear-deformable; GA and the section inertia are
  set so that both effects vanish against the discretisation (the reference has neither).

Output is one sensor on the tip kept in memory; no file is written.
"""

import sys
import time

sys.exudynFast = True  # the build without range checks, with vector instructions
import exudyn as exu  # noqa: E402
import exudyn.itemInterface as items  # noqa: E402
import numpy as np  # noqa: E402
from exudyn.advancedUtilities import CreateSymbolicUserFunction  # noqa: E402

exu.config.printToConsole = False
sym = exu.symbolic

SPEED = 4.0  # final speed [rad/s]
SPIN_UP = 15.0  # duration of the spin-up [s]
END = 20.0  # [s]
LENGTH = 10.0  # [m]
MASS = 1.2  # per length [kg/m]
AXIAL = 2.8e7  # EA [N]
BENDING = 1.4e4  # EI [N m^2]
SHEAR = 1e9  # GA [N], ge2 and ge3 only
SECTION_INERTIA = 1e-6  # [kg m], ge2 and ge3 only
OUTPUT = 0.1  # [s]

W = 2 * np.pi / SPIN_UP


def hub_angle(t):
    """theta(t) [rad] of an array of times [s]."""
    return np.where(
        t < SPIN_UP,
        SPEED / SPIN_UP * (t * t / 2 - (1 - np.cos(W * t)) / W**2),
        SPEED * (t - SPIN_UP / 2),
    )


def symbolic_angle(t):
    ramp = SPEED / SPIN_UP * (t * t / 2 - (1 - sym.cos(W * t)) / W**2)
    return sym.IfThenElse(t < SPIN_UP, ramp, SPEED * (t - SPIN_UP / 2))


def symbolic_rate(t):
    return sym.IfThenElse(t < SPIN_UP, SPEED / SPIN_UP * (t - sym.sin(W * t) / W), SPEED + 0 * t)


def root_x(mbs, t, itemNumber, lOffset):
    return sym.cos(symbolic_angle(t)) - 1.0


def root_x_rate(mbs, t, itemNumber, lOffset):
    return -symbolic_rate(t) * sym.sin(symbolic_angle(t))


def root_y(mbs, t, itemNumber, lOffset):
    return sym.sin(symbolic_angle(t))


def root_y_rate(mbs, t, itemNumber, lOffset):
    return symbolic_rate(t) * sym.cos(symbolic_angle(t))


def root_angle(mbs, t, itemNumber, lOffset):
    return symbolic_angle(t)


def root_angle_rate(mbs, t, itemNumber, lOffset):
    return symbolic_rate(t)


container = exu.SystemContainer()


def build(kind, elements):
    """An assembled system, its tip sensor and the symbolic functions, which must outlive the run."""
    container.Reset()
    mbs = container.AddSystem()
    ground = mbs.AddNode(items.NodePointGround())
    fixed = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))
    alive = []

    def symbolic(function, name):
        made = CreateSymbolicUserFunction(mbs, function, name, itemTypeName="ObjectConnectorCoordinate")
        alive.append(made)
        return made

    def constrain(node, coordinate, offset=None, rate=None):
        moving = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate))
        functions = {}
        if offset is not None:
            functions["offsetUserFunction"] = symbolic(offset, "offsetUserFunction")
            functions["offsetUserFunction_t"] = symbolic(rate, "offsetUserFunction_t")
        mbs.AddObject(items.ObjectConnectorCoordinate(markerNumbers=[fixed, moving], **functions))

    h = LENGTH / elements
    if kind == "ancf":
        nodes = [
            mbs.AddNode(items.NodePoint2DSlope1(referenceCoordinates=[i * h, 0, 1, 0]))
            for i in range(elements + 1)
        ]
        for i in range(elements):
            mbs.AddObject(
                items.ObjectANCFCable2D(
                    length=h,
                    massPerLength=MASS,
                    bendingStiffness=BENDING,
                    axialStiffness=AXIAL,
                    nodeNumbers=[nodes[i], nodes[i + 1]],
                    useReducedOrderIntegration=1,
                )
            )
    else:
        parts = 1 if kind == "ge2" else 2
        nodes = [
            mbs.AddNode(items.NodeRigidBody2D(referenceCoordinates=[i * h / parts, 0, 0]))
            for i in range(parts * elements + 1)
        ]
        for i in range(elements):
            mbs.AddObject(
                items.ObjectBeamGeometricallyExact2D(
                    nodeNumbers=nodes[parts * i : parts * i + parts + 1],
                    length=h,
                    massPerLength=MASS,
                    crossSectionInertia=SECTION_INERTIA,
                    bendingStiffness=BENDING,
                    axialStiffness=AXIAL,
                    shearStiffness=SHEAR,
                )
            )
    constrain(nodes[0], 0)
    constrain(nodes[0], 1)
    if kind == "ancf":
        constrain(nodes[0], 2, root_x, root_x_rate)
        constrain(nodes[0], 3, root_y, root_y_rate)
    else:
        constrain(nodes[0], 2, root_angle, root_angle_rate)
    tip = mbs.AddSensor(
        items.SensorNode(
            nodeNumber=nodes[-1],
            storeInternal=True,
            outputVariableType=exu.OutputVariableType.Position,
        )
    )
    mbs.Assemble()
    return mbs, tip, alive


def settings(steps, modified, tolerance, radius):
    """Simulation settings: fixed steps, one thread, dense solver, no files."""
    made = exu.SimulationSettings()
    made.solution.file.write = False
    made.solution.sensors.writePeriod = OUTPUT
    made.linearSolver.solverType = exu.LinearSolverType.EigenDense
    made.parallel.numberOfThreads = 1
    time_ = made.timeIntegration
    time_.numberOfSteps = steps
    time_.endTime = END
    time_.adaptiveStep = False
    time_.verboseMode = 0
    time_.generalizedAlpha.spectralRadius = radius
    time_.newton.useModifiedNewton = modified
    time_.newton.relativeTolerance = tolerance
    time_.newton.absoluteTolerance = 1e-4
    return made


def run(kind, elements, steps, modified, tolerance, radius=0.95):
    """One run: (wall [s], cpu [s], times, tip axial [m], tip transverse [m]); building is not timed.

    Raises RuntimeError when Exudyn gives up.
    """
    mbs, tip, _alive = build(kind, elements)
    options = settings(steps, modified, tolerance, radius)
    wall, cpu = time.perf_counter(), time.process_time()
    mbs.SolveDynamic(options, solverType=exu.DynamicSolverType.GeneralizedAlpha)
    cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
    data = mbs.GetSensorStoredData(tip)
    t, x, y = data[:, 0], data[:, 1], data[:, 2]
    theta = hub_angle(t)
    axial = np.cos(theta) * x + np.sin(theta) * y - LENGTH
    transverse = -np.sin(theta) * x + np.cos(theta) * y
    return wall, cpu, t, axial, transverse
