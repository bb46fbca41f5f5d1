"""The two cases of README.md in Exudyn, with contacts by penalties. All quantities in SI units."""

import contextlib
import os
import sys
import time
import warnings

sys.exudynFast = True  # the build without range checks
with open(os.devnull, "w") as nowhere, contextlib.redirect_stdout(nowhere):
    import exudyn as exu
import exudyn.itemInterface as items
import numpy as np

from models import RADIUS, Beam, Chain, G

warnings.filterwarnings("ignore", category=DeprecationWarning)
exu.config.printToConsole = False
CONTAINER = exu.SystemContainer()


class Stopped(Exception):
    """A run that Exudyn ended before its end."""


def solve(mbs, end, every, steps, radius):
    """Integrates by generalized-α with full Newton and the step reduction that contacts may need."""
    settings = exu.SimulationSettings()
    integration = settings.timeIntegration
    integration.numberOfSteps, integration.endTime, integration.verboseMode = steps, end, 0
    integration.newton.relativeTolerance = integration.newton.absoluteTolerance = 1e-6
    integration.generalizedAlpha.spectralRadius = radius
    integration.automaticStepSize = True
    settings.solutionSettings.writeSolutionToFile = False
    settings.solutionSettings.sensorsWritePeriod = every
    settings.parallel.numberOfThreads = 1
    settings.linearSolverType = exu.LinearSolverType.EigenSparse
    try:
        mbs.SolveDynamic(settings)
    except Exception as error:  # exudyn has an exception of its own for each cause
        raise Stopped(str(error)) from error


def kept(mbs, kind, **arguments):
    return mbs.AddSensor(kind(storeInternal=True, writeToFile=False, **arguments))


def beam(elements, steps, stiffness, damping, radius):
    """Processor time [s], the moment at the clamp and what the floor carries, at every hundredth second.

    ANCF cables, damped in bending, whose nodes press against the floor with a spring and a damper each."""
    start = time.process_time()
    CONTAINER.Reset()
    mbs = CONTAINER.AddSystem()
    h = Beam.LENGTH / elements
    fixed = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(items.NodePointGround()), coordinate=0))
    nodes = [mbs.AddNode(items.NodePoint2DSlope1(referenceCoordinates=[i * h, 0, 1, 0])) for i in range(elements + 1)]
    for i in range(elements):
        cable = items.ObjectANCFCable2D(
            length=h,
            massPerLength=Beam.MASS_PER_LENGTH,
            bendingStiffness=Beam.BENDING,
            axialStiffness=1e6,
            bendingDamping=Beam.LAG * Beam.BENDING,
            nodeNumbers=nodes[i : i + 2],
            useReducedOrderIntegration=1,
        )
        body = mbs.AddMarker(items.MarkerBodyMass(bodyNumber=mbs.AddObject(cable)))
        mbs.AddLoad(items.LoadMassProportional(markerNumber=body, loadVector=[0, -G, 0]))
    clamp = []
    for coordinate in (0, 1, 3):
        moving = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=nodes[0], coordinate=coordinate))
        clamp.append(mbs.AddObject(items.ObjectConnectorCoordinate(markerNumbers=[fixed, moving])))
    force = exu.OutputVariableType.Force
    moment = kept(mbs, items.SensorObject, objectNumber=clamp[2], outputVariableType=force)
    heights = []
    for node in nodes[1:]:
        moving = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=1))
        gap = mbs.AddNode(items.NodeGenericData(initialCoordinates=[1.0], numberOfDataCoordinates=1))
        touch = items.ObjectContactCoordinate(
            markerNumbers=[fixed, moving],
            nodeNumber=gap,
            contactStiffness=stiffness,
            contactDamping=damping,
            offset=-Beam.HEIGHT,
        )
        mbs.AddObject(touch)
        place = exu.OutputVariableType.Position
        heights.append(kept(mbs, items.SensorNode, nodeNumber=node, outputVariableType=place))
    mbs.Assemble()
    solve(mbs, Beam.END, Beam.EVERY, steps, radius)
    moments = -mbs.GetSensorStoredData(moment)[:, 1]
    indentations = [-Beam.HEIGHT - mbs.GetSensorStoredData(height)[:, 2] for height in heights]
    forces = stiffness * np.sum(np.maximum(indentations, 0.0), axis=0)
    return time.process_time() - start, moments, forces


def chain(steps, stiffness, damping, radius):
    """Processor time [s], and the height of the centre of mass at every hundredth second: rigid rods with balls at their ends."""
    start = time.process_time()
    CONTAINER.Reset()
    mbs = CONTAINER.AddSystem()
    of = Chain()
    contact = mbs.AddGeneralContact()
    contact.SetFrictionPairings(np.zeros((1, 1)))
    contact.SetSearchTreeCellSize([200, 1, 1])
    law = dict(contactStiffness=stiffness, contactDamping=damping, frictionMaterialIndex=0)
    ground = mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=mbs.AddObject(items.ObjectGround())))
    corners = [[-0.5, -RADIUS, -1], [2.5, -RADIUS, -1], [2.5, -RADIUS, 1], [-0.5, -RADIUS, 1]]
    contact.AddTrianglesRigidBodyBased(
        rigidBodyMarkerIndex=ground, pointList=corners, triangleList=[[0, 2, 1], [0, 3, 2]], **law
    )
    before, rods = None, []
    for i in range(of.RODS):
        s = (i + 0.5) * of.ROD
        place = [s * of.COS, of.HEIGHT + s * of.SIN, np.arctan(of.SLOPE)]
        node = mbs.AddNode(items.NodeRigidBody2D(referenceCoordinates=place))
        rod = mbs.AddObject(items.ObjectRigidBody2D(mass=of.MASS, inertia=of.INERTIA, nodeNumber=node))
        body = mbs.AddMarker(items.MarkerBodyMass(bodyNumber=rod))
        mbs.AddLoad(items.LoadMassProportional(markerNumber=body, loadVector=[0, -G, 0]))
        left, right = (
            mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=rod, localPosition=[0.5 * side * of.ROD, 0, 0]))
            for side in (-1, 1)
        )
        if before is None:
            contact.AddSphereWithMarker(left, radius=RADIUS, **law)
        else:
            mbs.AddObject(items.ObjectJointRevolute2D(markerNumbers=[before, left]))
        contact.AddSphereWithMarker(right, radius=RADIUS, **law)
        place = exu.OutputVariableType.Position
        rods.append(kept(mbs, items.SensorNode, nodeNumber=node, outputVariableType=place))
        before = right
    mbs.Assemble()
    solve(mbs, of.END, of.EVERY, steps, radius)
    heights = np.mean([mbs.GetSensorStoredData(rod)[:, 2] for rod in rods], axis=0)
    return time.process_time() - start, heights
