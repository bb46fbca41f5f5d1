"""The keys of a case as types, for editors and type checkers; written by ``generate/keys.py`` from the declarations of the engine."""

# ruff: noqa: E501

from __future__ import annotations

from typing import Literal, TypeAlias, TypedDict, Union

Quantity: TypeAlias = Union[float, str]
"""A number in SI, or a text with a unit."""

BeamOnHubBeam = TypedDict(
    "BeamOnHubBeam",
    {
        # length L of the beam; a deck that has a length says it by itself
        "length": "Quantity",
        # in space, angle of the root section about the axis towards the tip; at 0 its height is along the motion, that of a deck against it, with the leading edge ahead
        "pitch": "Quantity",
        # in space, angle of the axis out of the plane of rotation, towards the vector of rotation
        "precone": "Quantity",
        # in space, angle of the tip section against the root without stress, linear between, added to that of a deck
        "twist": "Quantity",
        # in space, it has shear strains, by the stiffness GA of its section, and rotary inertia
        "shear": "bool",
        # in space, shear factor of a shape, Cowper's if left out
        "shear-factor": "float",
        # in space, it twists; if left out, where its section says enough
        "torsion": "bool",
        # in space, Poisson's ratio, for the stiffness of a shape in torsion and in shear
        "poisson-ratio": "float",
        # in space, moment of inertia per length about the axis; that of the section if left out
        "polar-inertia": "Quantity",
    },
    total=False,
)
"""Beam itself."""

BeamOnHubSectionUniform = TypedDict(
    "BeamOnHubSectionUniform",
    {
        "kind": 'Literal["uniform"]',
        # Young's modulus E
        "modulus": "Quantity",
        # density ρ
        "density": "Quantity",
        # area A
        "area": "Quantity",
        # second moment of area I for bending in the plane of motion
        "second-moment": "Quantity",
        # rotary inertia of the section, ρI, is kept
        "rotary-inertia": "bool",
    },
    total=False,
)
"""One material; area and second moment given."""

BeamOnHubSectionRectangle = TypedDict(
    "BeamOnHubSectionRectangle",
    {
        "kind": 'Literal["rectangle"]',
        # Young's modulus E
        "modulus": "Quantity",
        # density ρ
        "density": "Quantity",
        # width, normal to the plane of motion
        "width": "Quantity",
        # height, in the plane of motion
        "height": "Quantity",
        # rotary inertia of the section, ρI, is kept
        "rotary-inertia": "bool",
    },
    total=False,
)
"""One material; a rectangle."""

BeamOnHubSectionCircle = TypedDict(
    "BeamOnHubSectionCircle",
    {
        "kind": 'Literal["circle"]',
        # Young's modulus E
        "modulus": "Quantity",
        # density ρ
        "density": "Quantity",
        # radius
        "radius": "Quantity",
        # rotary inertia of the section, ρI, is kept
        "rotary-inertia": "bool",
    },
    total=False,
)
"""One material; a full circle."""

BeamOnHubSectionTube = TypedDict(
    "BeamOnHubSectionTube",
    {
        "kind": 'Literal["tube"]',
        # Young's modulus E
        "modulus": "Quantity",
        # density ρ
        "density": "Quantity",
        # outer radius
        "outer-radius": "Quantity",
        # inner radius, less than the outer
        "inner-radius": "Quantity",
        # rotary inertia of the section, ρI, is kept
        "rotary-inertia": "bool",
    },
    total=False,
)
"""One material; a circular tube."""

BeamOnHubSectionEllipse = TypedDict(
    "BeamOnHubSectionEllipse",
    {
        "kind": 'Literal["ellipse"]',
        # Young's modulus E
        "modulus": "Quantity",
        # density ρ
        "density": "Quantity",
        # semi-axis a, normal to the plane of motion
        "semi-width": "Quantity",
        # semi-axis b, in the plane of motion
        "semi-height": "Quantity",
        # rotary inertia of the section, ρI, is kept
        "rotary-inertia": "bool",
    },
    total=False,
)
"""One material; a full ellipse."""

BeamOnHubSectionResultants = TypedDict(
    "BeamOnHubSectionResultants",
    {
        "kind": 'Literal["resultants"]',
        # mass per length ρA
        "mass-per-length": "Quantity",
        # axial stiffness EA
        "axial-stiffness": "Quantity",
        # bending stiffness EI in the plane of motion
        "bending-stiffness": "Quantity",
        # rotary inertia per length ρI
        "rotary-inertia": "Quantity",
    },
    total=False,
)
"""Mass and stiffnesses per length given directly."""

BeamOnHubSectionGeneral = TypedDict(
    "BeamOnHubSectionGeneral",
    {
        "kind": 'Literal["general"]',
        # mass per length ρA
        "mass-per-length": "Quantity",
        # axial stiffness EA
        "axial-stiffness": "Quantity",
        # torsional stiffness GJ
        "torsional-stiffness": "Quantity",
        # bending stiffness EI in the direction of the height
        "bending-stiffness": "Quantity",
        # bending stiffness EI in the direction across
        "bending-stiffness-across": "Quantity",
        # rotary inertia per length in bending in the direction of the height
        "rotary-inertia": "Quantity",
        # rotary inertia per length in bending in the direction across
        "rotary-inertia-across": "Quantity",
        # shear stiffness GA in the direction of the height, for beams with shear
        "shear-stiffness": "Quantity",
        # shear stiffness GA in the direction across
        "shear-stiffness-across": "Quantity",
    },
    total=False,
)
"""Mass and stiffnesses per length for bending in two planes and torsion."""

BeamOnHubSectionGraded = TypedDict(
    "BeamOnHubSectionGraded",
    {
        "kind": 'Literal["graded"]',
        # Young's modulus Eh of the ceramic
        "ceramic-modulus": "Quantity",
        # Young's modulus Et of the metal
        "metal-modulus": "Quantity",
        # density ρh of the ceramic
        "ceramic-density": "Quantity",
        # density ρt of the metal
        "metal-density": "Quantity",
        # width b, normal to the plane of motion
        "width": "Quantity",
        # height h, in the plane of motion
        "height": "Quantity",
        # exponent N of the power law
        "exponent": "float",
        # first mass moment of the section, ρS, is kept
        "first-moment": "bool",
        # rotary inertia of the section, ρI, is kept
        "rotary-inertia": "bool",
    },
    total=False,
)
"""A rectangle graded over its height by a power law, from metal (bottom) to ceramic (top). Reddy 2000, doi:10.1002/(SICI)1097-0207(20000110/30)47:1/3<663::AID-NME787>3.0.CO;2-8."""

BeamOnHubSectionTaperedRectangle = TypedDict(
    "BeamOnHubSectionTaperedRectangle",
    {
        "kind": 'Literal["tapered-rectangle"]',
        # Young's modulus E
        "modulus": "Quantity",
        # density ρ
        "density": "Quantity",
        # width at the root, normal to the plane of motion
        "root-width": "Quantity",
        # width at the tip
        "tip-width": "Quantity",
        # height at the root, in the plane of motion
        "root-height": "Quantity",
        # height at the tip
        "tip-height": "Quantity",
        # rotary inertia of the section, ρI, is kept
        "rotary-inertia": "bool",
    },
    total=False,
)
"""One material; a rectangle whose width and height change linearly from root to tip."""

BeamOnHubSectionTaperedCircle = TypedDict(
    "BeamOnHubSectionTaperedCircle",
    {
        "kind": 'Literal["tapered-circle"]',
        # Young's modulus E
        "modulus": "Quantity",
        # density ρ
        "density": "Quantity",
        # radius at the root
        "root-radius": "Quantity",
        # radius at the tip
        "tip-radius": "Quantity",
        # rotary inertia of the section, ρI, is kept
        "rotary-inertia": "bool",
    },
    total=False,
)
"""One material; a full circle whose radius changes linearly from root to tip."""

BeamOnHubSectionTaperedTube = TypedDict(
    "BeamOnHubSectionTaperedTube",
    {
        "kind": 'Literal["tapered-tube"]',
        # Young's modulus E
        "modulus": "Quantity",
        # density ρ
        "density": "Quantity",
        # outer radius at the root
        "root-outer-radius": "Quantity",
        # inner radius at the root, less than the outer
        "root-inner-radius": "Quantity",
        # outer radius at the tip
        "tip-outer-radius": "Quantity",
        # inner radius at the tip, less than the outer
        "tip-inner-radius": "Quantity",
        # rotary inertia of the section, ρI, is kept
        "rotary-inertia": "bool",
    },
    total=False,
)
"""One material; a circular tube whose radii change linearly from root to tip."""

BeamOnHubSectionPiecewise = TypedDict(
    "BeamOnHubSectionPiecewise",
    {
        "kind": 'Literal["piecewise"]',
        # stations at which the segments end
        "ends": "list[Quantity]",
        # Young's moduli E
        "modulus": "list[Quantity]",
        # densities ρ
        "density": "list[Quantity]",
        # areas A
        "area": "list[Quantity]",
        # second moments of area I for bending in the plane of motion
        "second-moment": "list[Quantity]",
        # rotary inertia of the section, ρI, is kept
        "rotary-inertia": "bool",
    },
    total=False,
)
"""Uniform segments from the root to the tip: one entry a segment in every list."""

BeamOnHubSectionTable = TypedDict(
    "BeamOnHubSectionTable",
    {
        "kind": 'Literal["table"]',
        # CSV file whose first line names the columns x, mass, EA, EI and, if wanted, ES, first-moment, rotary-inertia, in SI or as `x [mm]`
        "file": "str",
        # values between the rows
        "interpolation": 'Union[Literal["linear"], Literal["cubic"]]',
    },
    total=False,
)
"""Mass and stiffnesses tabulated along the beam."""

BeamOnHubSectionDeck = TypedDict(
    "BeamOnHubSectionDeck",
    {
        "kind": 'Literal["deck"]',
        # file of the deck; of BeamDyn the primary file, which names that of the sections
        "file": "str",
        # format of the deck
        "format": 'Union[Literal["beamdyn"], Literal["hawc2"], Literal["windio"], Literal["elastodyn"], Literal["csv"]]',
        # number of the set of a HAWC2 file, the first if left out
        "set": "int",
        # number of the subset of a HAWC2 file, the first if left out
        "subset": "int",
    },
    total=False,
)
"""A blade deck: sections of a blade along its span, by 6 × 6 matrices along a reference line, which is the axis of its beam, or by stiffnesses about principal axes."""

BeamOnHubHubMotionSpinUp = TypedDict(
    "BeamOnHubHubMotionSpinUp",
    {
        "kind": 'Literal["spin-up"]',
        # angular speed Ω reached
        "speed": "Quantity",
        # time T in which it is reached
        "time": "Quantity",
    },
    total=False,
)
"""Smooth spin-up from rest: Ω t/T − Ω/(2π) sin(2πt/T), then Ω. Kane, Ryan & Banerjee 1987, doi:10.2514/3.20195."""

BeamOnHubHubMotionConstant = TypedDict(
    "BeamOnHubHubMotionConstant",
    {
        "kind": 'Literal["constant"]',
        # angular speed Ω
        "speed": "Quantity",
    },
    total=False,
)
"""Constant angular speed."""

BeamOnHubHubMotionRamp = TypedDict(
    "BeamOnHubHubMotionRamp",
    {
        "kind": 'Literal["ramp"]',
        # angular speed Ω reached
        "speed": "Quantity",
        # time T in which it is reached
        "time": "Quantity",
    },
    total=False,
)
"""Angular speed growing linearly from rest, then constant."""

BeamOnHubHubMotionTable = TypedDict(
    "BeamOnHubHubMotionTable",
    {
        "kind": 'Literal["table"]',
        # CSV file with the columns t and value, in SI or with the units in their titles
        "file": "str",
        # quantity that is given
        "of": 'Union[Literal["speed"], Literal["angle"]]',
        # values between the rows
        "interpolation": 'Union[Literal["linear"], Literal["monotone"], Literal["spline"]]',
    },
    total=False,
)
"""Table of time and angular speed or angle."""

BeamOnHubHubMotionExpression = TypedDict(
    "BeamOnHubHubMotionExpression",
    {
        "kind": 'Literal["expression"]',
        # formula in t, in rad/s or rad
        "formula": "str",
        # quantity that is given
        "of": 'Union[Literal["speed"], Literal["angle"]]',
    },
    total=False,
)
"""Formula of time t [s] for the angular speed or the angle."""

BeamOnHubHubMotionFreeTorqueConstant = TypedDict(
    "BeamOnHubHubMotionFreeTorqueConstant",
    {
        "kind": 'Literal["constant"]',
        # torque on the hub
        "torque": "Quantity",
    },
    total=False,
)
"""Constant torque."""

BeamOnHubHubMotionFreeTorqueRamp = TypedDict(
    "BeamOnHubHubMotionFreeTorqueRamp",
    {
        "kind": 'Literal["ramp"]',
        # torque reached
        "torque": "Quantity",
        # time in which it is reached
        "time": "Quantity",
    },
    total=False,
)
"""Torque growing linearly from zero, then constant."""

BeamOnHubHubMotionFreeTorqueTable = TypedDict(
    "BeamOnHubHubMotionFreeTorqueTable",
    {
        "kind": 'Literal["table"]',
        # CSV file with the columns t and torque, in SI or with the units in their titles
        "file": "str",
        # values between the rows
        "interpolation": 'Union[Literal["linear"], Literal["monotone"], Literal["spline"]]',
    },
    total=False,
)
"""Table of time and torque."""

BeamOnHubHubMotionFreeTorqueExpression = TypedDict(
    "BeamOnHubHubMotionFreeTorqueExpression",
    {
        "kind": 'Literal["expression"]',
        # formula in t, in N·m
        "formula": "str",
    },
    total=False,
)
"""Formula of time t [s] for the torque."""

BeamOnHubHubMotionFreeControllerNone = TypedDict(
    "BeamOnHubHubMotionFreeControllerNone",
    {
        "kind": 'Literal["none"]',
    },
    total=False,
)
"""No controller."""

BeamOnHubHubMotionFreeControllerPd = TypedDict(
    "BeamOnHubHubMotionFreeControllerPd",
    {
        "kind": 'Literal["pd"]',
        # gain of the angle
        "proportional": "Quantity",
        # gain of the speed
        "derivative": "Quantity",
        # angle to be reached
        "target": "Quantity",
        # largest speed of the reference on its way to the target; a step if left out
        "rate": "Quantity",
        # largest torque of the actuator; no limit if left out
        "limit": "Quantity",
    },
    total=False,
)
"""Proportional–derivative control of the angle, towards a target reached at a limited rate."""

BeamOnHubHubMotionFree = TypedDict(
    "BeamOnHubHubMotionFree",
    {
        "kind": 'Literal["free"]',
        # angle of the hub at the start
        "angle": "Quantity",
        # speed of the hub at the start
        "speed": "Quantity",
        # torque on the hub
        "torque": "Union[BeamOnHubHubMotionFreeTorqueConstant, BeamOnHubHubMotionFreeTorqueRamp, BeamOnHubHubMotionFreeTorqueTable, BeamOnHubHubMotionFreeTorqueExpression]",
        # viscous restraint of the hub
        "damping": "Quantity",
        # spring restraint of the hub
        "stiffness": "Quantity",
        # angle at which the spring is at rest
        "rest-angle": "Quantity",
        # controller of the angle
        "controller": "Union[BeamOnHubHubMotionFreeControllerNone, BeamOnHubHubMotionFreeControllerPd]",
    },
    total=False,
)
"""Free to rotate, driven by torques, restrained or controlled."""

BeamOnHubHub = TypedDict(
    "BeamOnHubHub",
    {
        # radius a, where the beam is clamped
        "radius": "Quantity",
        # moment of inertia of the hub about its axis
        "inertia": "Quantity",
        # rotation of the hub: prescribed, or free
        "motion": "Union[BeamOnHubHubMotionSpinUp, BeamOnHubHubMotionConstant, BeamOnHubHubMotionRamp, BeamOnHubHubMotionTable, BeamOnHubHubMotionExpression, BeamOnHubHubMotionFree]",
    },
    total=False,
)
"""Hub and its motion."""

BeamOnHubModel = TypedDict(
    "BeamOnHubModel",
    {
        # kinematic model
        "coupling": 'Union[Literal["zeroth"], Literal["first"], Literal["high"], Literal["exact"], Literal["space"], Literal["space-shear"]]',
        # rows of joints that follow from others are left out, in place of an error, and have no forces; a run ends where they no longer follow
        "drop-redundant-rows": "bool",
        # into how many each element of beams in space is cut
        "refine": "int",
    },
    total=False,
)
"""Model of the beam."""

BeamOnHubBasisFiniteElements = TypedDict(
    "BeamOnHubBasisFiniteElements",
    {
        "kind": 'Literal["finite-elements"]',
        # number of equal elements over the length; they are cut where loads and masses are and the section jumps
        "elements": "int",
        # into how many equal parts each element is cut, those beside loads, masses and jumps too
        "refine": "int",
        # degree of the axial elements (the exact coupling is cubic and does without it)
        "axial-degree": "int",
    },
    total=False,
)
"""Lagrange elements (axial) and cubic Hermite elements (transverse). Du, Zhang & Hong 2015, doi:10.6052/0459-1879-14-334."""

BeamOnHubBasisModes = TypedDict(
    "BeamOnHubBasisModes",
    {
        "kind": 'Literal["modes"]',
        # number of axial modes
        "axial": "int",
        # number of bending modes
        "transverse": "int",
    },
    total=False,
)
"""Vibration modes of the beam at rest (assumed modes). Du, Zhang & Hong 2015, doi:10.6052/0459-1879-14-334."""

BeamOnHubBasisRadial = TypedDict(
    "BeamOnHubBasisRadial",
    {
        "kind": 'Literal["radial"]',
        # number of equally spaced nodes, ends included
        "nodes": "int",
        # shape parameter α_c; 2 to 7 is accurate, above that the moment matrix becomes singular
        "shape": "float",
        # exponent q; not an integer
        "exponent": "float",
        # half width α_s of the support domain over the node spacing
        "support": "float",
        # degree of the added polynomials, -1 for none
        "degree": "int",
        # whether each point has a support domain of its own, and not each interval between two nodes: displacements then jump inside of the beam
        "domain-per-point": "bool",
    },
    total=False,
)
"""Radial point interpolation (RPIM) with multiquadrics. Du, Zhang & Hong 2015, doi:10.6052/0459-1879-14-334."""

BeamOnHubBasisPolynomial = TypedDict(
    "BeamOnHubBasisPolynomial",
    {
        "kind": 'Literal["polynomial"]',
        # number of equally spaced nodes, ends included
        "nodes": "int",
        # half width α_s of the support domain over the node spacing; 0.5 gives finite elements
        "support": "float",
    },
    total=False,
)
"""Meshfree point interpolation (PIM) with polynomials. Du & Zhang 2015, doi:10.7498/aps.64.034501."""

BeamOnHubBasisBSpline = TypedDict(
    "BeamOnHubBasisBSpline",
    {
        "kind": 'Literal["b-spline"]',
        # number of equal elements over the length
        "elements": "int",
        # degree p; at least 2 for the transverse field
        "degree": "int",
    },
    total=False,
)
"""B-splines of any degree on equal spans. Fan & Zhang 2012, doi:10.3901/JME.2012.23.059."""

BeamOnHubBasisBezier = TypedDict(
    "BeamOnHubBasisBezier",
    {
        "kind": 'Literal["bezier"]',
        # degree n; at least 2 for the transverse field
        "degree": "int",
        # number of equal elements, joined smoothly
        "elements": "int",
    },
    total=False,
)
"""Bézier curve over the whole beam, or smoothly joined ones. Fan & Zhang 2014, doi:10.7498/aps.63.154501."""

BeamOnHubBasisMixedAxialModes = TypedDict(
    "BeamOnHubBasisMixedAxialModes",
    {
        "kind": 'Literal["modes"]',
        # number of modes
        "count": "int",
    },
    total=False,
)
"""Vibration modes of the beam at rest (assumed modes). Du, Zhang & Hong 2015, doi:10.6052/0459-1879-14-334."""

BeamOnHubBasisMixed = TypedDict(
    "BeamOnHubBasisMixed",
    {
        "kind": 'Literal["mixed"]',
        # basis of the axial displacement
        "axial": "Union[BeamOnHubBasisFiniteElements, BeamOnHubBasisMixedAxialModes, BeamOnHubBasisRadial, BeamOnHubBasisPolynomial, BeamOnHubBasisBSpline, BeamOnHubBasisBezier]",
        # basis of the transverse displacement
        "transverse": "Union[BeamOnHubBasisFiniteElements, BeamOnHubBasisMixedAxialModes, BeamOnHubBasisRadial, BeamOnHubBasisPolynomial, BeamOnHubBasisBSpline, BeamOnHubBasisBezier]",
    },
    total=False,
)
"""Another basis for each field."""

BeamOnHubMass = TypedDict(
    "BeamOnHubMass",
    {
        # name, for messages and columns; that of its number if left out
        "name": "str",
        # station of a beam
        "on": "str",
        # mass
        "mass": "Quantity",
        # moment of inertia about its centre, which lies on the axis of the beam
        "inertia": "Quantity",
    },
    total=False,
)

BeamOnHubSpring = TypedDict(
    "BeamOnHubSpring",
    {
        # name, for messages and columns; that of its number if left out
        "name": "str",
        # parts that it joins
        "kind": 'Union[Literal["point"], Literal["line"]]',
        # station of a beam, of a spring of the kind `point`
        "on": "str",
        # the two parts, of a spring of the kind `line`
        "between": "list[str]",
        # point of space where it is fixed to the first part at the start; the part's own if left out
        "from": "list[Quantity]",
        # the same of the second part; of the kind `point`, the point fixed in space
        "to": "list[Quantity]",
        # stiffness k
        "stiffness": "Quantity",
        # force over velocity, c: over the rate of the length in the kind `line`
        "damping": "Quantity",
        # length without force, that at the start if left out, of the kind `line`
        "length": "Quantity",
    },
    total=False,
)

BeamOnHubLoadDistributionUniform = TypedDict(
    "BeamOnHubLoadDistributionUniform",
    {
        "kind": 'Literal["uniform"]',
    },
    total=False,
)
"""The same everywhere."""

BeamOnHubLoadDistributionTable = TypedDict(
    "BeamOnHubLoadDistributionTable",
    {
        "kind": 'Literal["table"]',
        # stations, ascending
        "stations": "list[Quantity]",
        # factor at each station
        "factors": "list[Quantity]",
    },
    total=False,
)
"""Straight lines through stations and factors."""

BeamOnHubLoadDistributionExpression = TypedDict(
    "BeamOnHubLoadDistributionExpression",
    {
        "kind": 'Literal["expression"]',
        # formula in x
        "formula": "str",
    },
    total=False,
)
"""Formula of the station x [m] for the factor."""

BeamOnHubLoadLawLinearDrag = TypedDict(
    "BeamOnHubLoadLawLinearDrag",
    {
        "kind": 'Literal["linear-drag"]',
        # drag per length and velocity, c
        "coefficient": "Quantity",
    },
    total=False,
)
"""Drag −c v in proportion to the velocity, as of a slow motion in a viscous fluid at rest."""

BeamOnHubLoadLawQuadraticDrag = TypedDict(
    "BeamOnHubLoadLawQuadraticDrag",
    {
        "kind": 'Literal["quadratic-drag"]',
        # drag per length and square of the velocity, c
        "coefficient": "Quantity",
    },
    total=False,
)
"""Drag −c |v| v in a fluid at rest, c = ½ ρ C_D d with its density ρ and the width d of the beam. Morison et al. 1950, doi:10.2118/950149-G."""

BeamOnHubLoadAmplitudeConstant = TypedDict(
    "BeamOnHubLoadAmplitudeConstant",
    {
        "kind": 'Literal["constant"]',
    },
    total=False,
)
"""Constant."""

BeamOnHubLoadAmplitudeRamp = TypedDict(
    "BeamOnHubLoadAmplitudeRamp",
    {
        "kind": 'Literal["ramp"]',
        # time in which it is reached
        "time": "Quantity",
    },
    total=False,
)
"""Growing linearly from zero, then constant."""

BeamOnHubLoadAmplitudeTable = TypedDict(
    "BeamOnHubLoadAmplitudeTable",
    {
        "kind": 'Literal["table"]',
        # times, ascending
        "times": "list[Quantity]",
        # factor at each time
        "factors": "list[Quantity]",
        # values between the rows
        "interpolation": 'Union[Literal["linear"], Literal["monotone"], Literal["spline"]]',
    },
    total=False,
)
"""Curve through times and factors."""

BeamOnHubLoadAmplitudeExpression = TypedDict(
    "BeamOnHubLoadAmplitudeExpression",
    {
        "kind": 'Literal["expression"]',
        # formula in t
        "formula": "str",
    },
    total=False,
)
"""Formula of time t [s] for the factor."""

BeamOnHubLoad = TypedDict(
    "BeamOnHubLoad",
    {
        # name, for messages and columns; that of its number if left out
        "name": "str",
        # place where it acts, or the beam along which it acts
        "on": "str",
        # point of a body where it acts, in space at the start; its centre of mass if left out
        "at": "list[Quantity]",
        # components of the force at the place
        "force": "list[Quantity]",
        # couple at the place: a number is about z
        "couple": "Union[Quantity, list[Quantity]]",
        # components of the force per length along the beam
        "force-per-length": "list[Quantity]",
        # arc length where a force per length begins, the root if left out
        "from": "Quantity",
        # arc length where it ends, the tip if left out
        "to": "Quantity",
        # factor of a force per length against the arc length, 1 if left out
        "distribution": "Union[BeamOnHubLoadDistributionUniform, BeamOnHubLoadDistributionTable, BeamOnHubLoadDistributionExpression]",
        # law by which a force per length follows from the motion, in the place of `force-per-length`
        "law": "Union[BeamOnHubLoadLawLinearDrag, BeamOnHubLoadLawQuadraticDrag]",
        # axes of the components
        "axes": 'Union[Literal["dead"], Literal["hub"], Literal["follower"]]',
        # factor against time
        "amplitude": "Union[BeamOnHubLoadAmplitudeConstant, BeamOnHubLoadAmplitudeRamp, BeamOnHubLoadAmplitudeTable, BeamOnHubLoadAmplitudeExpression]",
    },
    total=False,
)

BeamOnHubContactObstaclePlaneMotion = TypedDict(
    "BeamOnHubContactObstaclePlaneMotion",
    {
        # components of the displacement at the amplitude 1
        "displacement": "list[Quantity]",
        # factor against time
        "amplitude": "Union[BeamOnHubLoadAmplitudeConstant, BeamOnHubLoadAmplitudeRamp, BeamOnHubLoadAmplitudeTable, BeamOnHubLoadAmplitudeExpression]",
    },
    total=False,
)
"""Prescribed translation of the obstacle, at rest if left out."""

BeamOnHubContactObstaclePlane = TypedDict(
    "BeamOnHubContactObstaclePlane",
    {
        "kind": 'Literal["plane"]',
        # a point of the plane, the origin if left out
        "point": "list[Quantity]",
        # direction out of the obstacle; [0, 1, 0] if left out for a beam on a hub
        "normal": "list[Quantity]",
        # angle about z from the x axis to the plane, in the place of `normal`; the free side is to its left
        "angle": "Quantity",
        # prescribed translation of the obstacle, at rest if left out
        "motion": "BeamOnHubContactObstaclePlaneMotion",
    },
    total=False,
)
"""Half-space behind a plane."""

BeamOnHubContactObstacleCylinder = TypedDict(
    "BeamOnHubContactObstacleCylinder",
    {
        "kind": 'Literal["cylinder"]',
        # a point of its axis, the origin if left out
        "centre": "list[Quantity]",
        # direction of its axis; [0, 0, 1] if left out for a beam on a hub
        "axis": "list[Quantity]",
        # radius
        "radius": "Quantity",
        # the point is inside, in a hole
        "inside": "bool",
        # prescribed translation of the obstacle, at rest if left out
        "motion": "BeamOnHubContactObstaclePlaneMotion",
    },
    total=False,
)
"""Circular cylinder, or the outside of a hole; in the plane a disc."""

BeamOnHubContactObstacleSphere = TypedDict(
    "BeamOnHubContactObstacleSphere",
    {
        "kind": 'Literal["sphere"]',
        # its centre, the origin if left out
        "centre": "list[Quantity]",
        # radius
        "radius": "Quantity",
        # the point is inside
        "inside": "bool",
        # prescribed translation of the obstacle, at rest if left out
        "motion": "BeamOnHubContactObstaclePlaneMotion",
    },
    total=False,
)
"""Ball, or the inside of a hollow one."""

BeamOnHubContactObstacleStop = TypedDict(
    "BeamOnHubContactObstacleStop",
    {
        "kind": 'Literal["stop"]',
        # height of the stop over the axis of the undeformed beam: positive on the side of y, negative on the other
        "offset": "Quantity",
    },
    total=False,
)
"""Stop beside the beam, fixed to the hub: bounds the deflection of the station."""

BeamOnHubContactLawMassless = TypedDict(
    "BeamOnHubContactLawMassless",
    {
        "kind": 'Literal["massless"]',
    },
    total=False,
)
"""The tip has no mass of its own: it is stopped without impulse and loss, and no restitution is needed. Khenous, Laborde & Renard 2008, doi:10.1016/j.euromechsol.2008.01.001; arXiv 2207.00795."""

BeamOnHubContactLawConstraint = TypedDict(
    "BeamOnHubContactLawConstraint",
    {
        "kind": 'Literal["constraint"]',
        # nominal coefficient of restitution e
        "restitution": "float",
        # coefficient of friction μ
        "friction": "float",
    },
    total=False,
)
"""Impulse with Newton's restitution, then a constraint until it would pull; Coulomb friction. Pfeiffer & Glocker 1996, doi:10.1002/9783527618385."""

BeamOnHubContactLawHertz = TypedDict(
    "BeamOnHubContactLawHertz",
    {
        "kind": 'Literal["hertz"]',
        # K in N/mⁿ, with `points` that of a length of 1 m
        "stiffness": "float",
        # n
        "exponent": "float",
        # coefficient of friction μ
        "friction": "float",
        # sliding speed v_s of the regularised friction, −μ F tanh(v/v_s)
        "slip-speed": "Quantity",
    },
    total=False,
)
"""Elastic force K δⁿ of the indentation δ. Hertz 1881, doi:10.1515/crll.1882.92.156."""

BeamOnHubContactLawHuntCrossley = TypedDict(
    "BeamOnHubContactLawHuntCrossley",
    {
        "kind": 'Literal["hunt-crossley"]',
        # K in N/mⁿ, with `points` that of a length of 1 m
        "stiffness": "float",
        # n
        "exponent": "float",
        # nominal coefficient of restitution e
        "restitution": "float",
        # coefficient of friction μ
        "friction": "float",
        # sliding speed v_s of the regularised friction, −μ F tanh(v/v_s)
        "slip-speed": "Quantity",
    },
    total=False,
)
"""The same damped by χ = 3(1 − e)/2 in K δⁿ (1 + χ δ̇/v₀). Hunt & Crossley 1975, doi:10.1115/1.3423596."""

BeamOnHubContactLawLankaraniNikravesh = TypedDict(
    "BeamOnHubContactLawLankaraniNikravesh",
    {
        "kind": 'Literal["lankarani-nikravesh"]',
        # K in N/mⁿ, with `points` that of a length of 1 m
        "stiffness": "float",
        # n
        "exponent": "float",
        # nominal coefficient of restitution e
        "restitution": "float",
        # coefficient of friction μ
        "friction": "float",
        # sliding speed v_s of the regularised friction, −μ F tanh(v/v_s)
        "slip-speed": "Quantity",
    },
    total=False,
)
"""The same with χ = 3(1 − e²)/4. Lankarani & Nikravesh 1990, doi:10.1115/1.2912617."""

BeamOnHubContactLawFlores = TypedDict(
    "BeamOnHubContactLawFlores",
    {
        "kind": 'Literal["flores"]',
        # K in N/mⁿ, with `points` that of a length of 1 m
        "stiffness": "float",
        # n
        "exponent": "float",
        # nominal coefficient of restitution e
        "restitution": "float",
        # coefficient of friction μ
        "friction": "float",
        # sliding speed v_s of the regularised friction, −μ F tanh(v/v_s)
        "slip-speed": "Quantity",
    },
    total=False,
)
"""The same with χ = 8(1 − e)/(5e). Flores et al. 2011, doi:10.1007/s11044-010-9237-4."""

BeamOnHubContactLawGonthier = TypedDict(
    "BeamOnHubContactLawGonthier",
    {
        "kind": 'Literal["gonthier"]',
        # K in N/mⁿ, with `points` that of a length of 1 m
        "stiffness": "float",
        # n
        "exponent": "float",
        # nominal coefficient of restitution e
        "restitution": "float",
        # coefficient of friction μ
        "friction": "float",
        # sliding speed v_s of the regularised friction, −μ F tanh(v/v_s)
        "slip-speed": "Quantity",
    },
    total=False,
)
"""The same with χ = (1 − e²)/e. Gonthier et al. 2004, doi:10.1023/B:MUBO.0000029392.21648.bc."""

BeamOnHubContactLawMatched = TypedDict(
    "BeamOnHubContactLawMatched",
    {
        "kind": 'Literal["matched"]',
        # K in N/mⁿ, with `points` that of a length of 1 m
        "stiffness": "float",
        # n
        "exponent": "float",
        # nominal coefficient of restitution e
        "restitution": "float",
        # coefficient of friction μ
        "friction": "float",
        # sliding speed v_s of the regularised friction, −μ F tanh(v/v_s)
        "slip-speed": "Quantity",
    },
    total=False,
)
"""The same with the χ that gives back e itself to a single mass. χ (1 + e) = ln[(1 + χ)/(1 − χ e)], the exact rebound of that force."""

BeamOnHubContact = TypedDict(
    "BeamOnHubContact",
    {
        # name, for messages and columns; that of its number if left out
        "name": "str",
        # parts that may touch: a body, a place of a beam, a list of them, or a whole beam, where it is nearest to the obstacle or by `points`; the tip of the only beam if left out
        "on": "Union[str, list[str]]",
        # point of a body that may touch, in space at the start; its centre of mass if left out
        "at": "list[Quantity]",
        # radius of the ball about the point, which slides and rolls on the obstacle, or of a beam that is round
        "radius": "Quantity",
        # number of equidistant points, the last at the tip, by which a whole beam may touch, and one more at the root where nothing holds it
        "points": "int",
        # rigid obstacle
        "obstacle": "Union[BeamOnHubContactObstaclePlane, BeamOnHubContactObstacleCylinder, BeamOnHubContactObstacleSphere, BeamOnHubContactObstacleStop]",
        # part that the obstacle is fixed to, in whose axes and from whose point it is given: `ground`, `hub`, a body or a place of a beam in space; the ground if left out, the hub of a stop
        "mount": "str",
        # law of the contact
        "law": "Union[BeamOnHubContactLawMassless, BeamOnHubContactLawConstraint, BeamOnHubContactLawHertz, BeamOnHubContactLawHuntCrossley, BeamOnHubContactLawLankaraniNikravesh, BeamOnHubContactLawFlores, BeamOnHubContactLawGonthier, BeamOnHubContactLawMatched]",
    },
    total=False,
)

BeamOnHubDamping = TypedDict(
    "BeamOnHubDamping",
    {
        # force over mass and velocity relative to the hub, β
        "mass": "Quantity",
        # viscous over elastic stress and rate of strain, η
        "stiffness": "Quantity",
    },
    total=False,
)
"""Damping of the beam."""

BeamOnHubBodyInertiaPrincipal = TypedDict(
    "BeamOnHubBodyInertiaPrincipal",
    {
        "kind": 'Literal["principal"]',
        # principal moments of inertia about the first, second and third axis
        "moments": "list[Quantity]",
    },
    total=False,
)
"""The axes of the body are principal axes."""

BeamOnHubBodyInertiaFull = TypedDict(
    "BeamOnHubBodyInertiaFull",
    {
        "kind": 'Literal["full"]',
        # moments of inertia J₁₁, J₂₂, J₃₃
        "moments": "list[Quantity]",
        # entries J₂₃, J₁₃, J₁₂ of the tensor, −∫ y z dm, −∫ x z dm, −∫ x y dm
        "products": "list[Quantity]",
    },
    total=False,
)
"""Moments and products of inertia in the axes of the body."""

BeamOnHubBodyInertiaBox = TypedDict(
    "BeamOnHubBodyInertiaBox",
    {
        "kind": 'Literal["box"]',
        # edges along the three axes
        "size": "list[Quantity]",
    },
    total=False,
)
"""A homogeneous box."""

BeamOnHubBodyInertiaCylinder = TypedDict(
    "BeamOnHubBodyInertiaCylinder",
    {
        "kind": 'Literal["cylinder"]',
        # radius
        "radius": "Quantity",
        # length along the third axis
        "length": "Quantity",
    },
    total=False,
)
"""A homogeneous cylinder about the third axis."""

BeamOnHubBodyInertiaSphere = TypedDict(
    "BeamOnHubBodyInertiaSphere",
    {
        "kind": 'Literal["sphere"]',
        # radius
        "radius": "Quantity",
    },
    total=False,
)
"""A homogeneous sphere."""

BeamOnHubBodyDamping = TypedDict(
    "BeamOnHubBodyDamping",
    {
        # force over mass and velocity, and moment over inertia and angular velocity, β
        "mass": "Quantity",
    },
    total=False,
)
"""Damping against the ground."""

BeamOnHubBody = TypedDict(
    "BeamOnHubBody",
    {
        # name, which begins the names of its columns
        "name": "str",
        # mass
        "mass": "Quantity",
        # inertia about the centre of mass
        "inertia": "Union[BeamOnHubBodyInertiaPrincipal, BeamOnHubBodyInertiaFull, BeamOnHubBodyInertiaBox, BeamOnHubBodyInertiaCylinder, BeamOnHubBodyInertiaSphere]",
        # centre of mass at the start, the origin if left out
        "position": "list[Quantity]",
        # direction of the third axis, [0, 0, 1] if left out
        "axis": "list[Quantity]",
        # direction to which the first axis points, as far as the third allows; chosen if left out
        "across": "list[Quantity]",
        # velocity of the centre of mass at the start; what the joints and the spin ask for, if left out
        "velocity": "list[Quantity]",
        # angular velocity at the start, in the axes of space; what the joints ask for, if left out
        "spin": "list[Quantity]",
        # damping against the ground
        "damping": "BeamOnHubBodyDamping",
    },
    total=False,
)

BeamOnHubJointMotionFree = TypedDict(
    "BeamOnHubJointMotionFree",
    {
        "kind": 'Literal["free"]',
        # angle of the hub at the start
        "angle": "Quantity",
        # speed of the hub at the start
        "speed": "Quantity",
        # torque on the hub
        "torque": "Union[BeamOnHubHubMotionFreeTorqueConstant, BeamOnHubHubMotionFreeTorqueRamp, BeamOnHubHubMotionFreeTorqueTable, BeamOnHubHubMotionFreeTorqueExpression]",
        # viscous restraint of the hub
        "damping": "Quantity",
        # spring restraint of the hub
        "stiffness": "Quantity",
        # angle at which the spring is at rest
        "rest-angle": "Quantity",
        # controller of the angle
        "controller": "Union[BeamOnHubHubMotionFreeControllerNone, BeamOnHubHubMotionFreeControllerPd]",
    },
    total=False,
)
"""Free to rotate, driven by torques, restrained or controlled."""

BeamOnHubJointTravelConstant = TypedDict(
    "BeamOnHubJointTravelConstant",
    {
        "kind": 'Literal["constant"]',
        # speed
        "speed": "Quantity",
    },
    total=False,
)
"""Constant speed."""

BeamOnHubJointTravelTable = TypedDict(
    "BeamOnHubJointTravelTable",
    {
        "kind": 'Literal["table"]',
        # CSV file with the columns t and value, in SI or with the units in their titles
        "file": "str",
        # values between the rows
        "interpolation": 'Union[Literal["linear"], Literal["monotone"], Literal["spline"]]',
        # quantity that is given
        "of": 'Union[Literal["speed"], Literal["displacement"]]',
    },
    total=False,
)
"""Table of time and speed or displacement."""

BeamOnHubJointTravelExpression = TypedDict(
    "BeamOnHubJointTravelExpression",
    {
        "kind": 'Literal["expression"]',
        # formula in t, in m/s or m
        "formula": "str",
        # quantity that is given
        "of": 'Union[Literal["speed"], Literal["displacement"]]',
    },
    total=False,
)
"""Formula of time t [s] for the speed or the displacement."""

BeamOnHubJointTravelFree = TypedDict(
    "BeamOnHubJointTravelFree",
    {
        "kind": 'Literal["free"]',
        # force on the second part
        "force": "Quantity",
        # force over speed
        "damping": "Quantity",
        # force over displacement
        "stiffness": "Quantity",
        # displacement at which the spring is at rest
        "rest": "Quantity",
    },
    total=False,
)
"""Free to slide, with a force, a spring and a damper."""

BeamOnHubJoint = TypedDict(
    "BeamOnHubJoint",
    {
        # name, for messages and columns; that of its number if left out
        "name": "str",
        # motions that it leaves free
        "kind": 'Union[Literal["fixed"], Literal["revolute"], Literal["prismatic"], Literal["cylindrical"], Literal["universal"], Literal["spherical"], Literal["planar"]]',
        # the two parts: `ground`, bodies, or places of beams such as `blade.root` and `blade.tip`
        "between": "list[str]",
        # its point in space at the start; the second part's own if left out
        "at": "list[Quantity]",
        # direction of the third axis, [0, 0, 1] if left out
        "axis": "list[Quantity]",
        # direction to which the first axis points, as far as the third allows; chosen if left out
        "across": "list[Quantity]",
        # rotation of a revolute or cylindrical joint: prescribed, or driven by a torque
        "motion": "Union[BeamOnHubHubMotionSpinUp, BeamOnHubHubMotionConstant, BeamOnHubHubMotionRamp, BeamOnHubHubMotionTable, BeamOnHubHubMotionExpression, BeamOnHubJointMotionFree]",
        # displacement of a prismatic joint: prescribed, or driven by a force
        "travel": "Union[BeamOnHubJointTravelConstant, BeamOnHubJointTravelTable, BeamOnHubJointTravelExpression, BeamOnHubJointTravelFree]",
    },
    total=False,
)

BeamOnHubFibre = TypedDict(
    "BeamOnHubFibre",
    {
        # name, which ends the name of its column
        "name": "str",
        # station of a beam
        "on": "str",
        # place along the height of the section
        "y": "Quantity",
        # place across, along tangent × height
        "z": "Quantity",
    },
    total=False,
)

BeamOnHubRotation = TypedDict(
    "BeamOnHubRotation",
    {
        # name of a revolute or cylindrical joint with the ground: the system rotates about its axis
        "about": "str",
        # direction of the axis, in the place of a joint
        "axis": "list[Quantity]",
        # a point of the axis, the origin if left out
        "point": "list[Quantity]",
    },
    total=False,
)
"""Axis about which `modes` and `campbell` rotate the system, and the ground with it; that of the joint with the ground if left out."""

BeamOnHubInitialUndeformed = TypedDict(
    "BeamOnHubInitialUndeformed",
    {
        "kind": 'Literal["undeformed"]',
    },
    total=False,
)
"""Undeformed, moving with the hub."""

BeamOnHubInitialSteadyRotation = TypedDict(
    "BeamOnHubInitialSteadyRotation",
    {
        "kind": 'Literal["steady-rotation"]',
    },
    total=False,
)
"""Steady rotation at the initial speed of the hub, or of all parts about one axis: in equilibrium, and under gravity across the axis in the motion that repeats itself."""

BeamOnHubInitialStatic = TypedDict(
    "BeamOnHubInitialStatic",
    {
        "kind": 'Literal["static"]',
    },
    total=False,
)
"""Static equilibrium under the loads of the start, the hub at rest and held."""

BeamOnHubInitialRestart = TypedDict(
    "BeamOnHubInitialRestart",
    {
        "kind": 'Literal["restart"]',
        # state.npz of the earlier run, or the folder of its results
        "file": "str",
    },
    total=False,
)
"""Last state of an earlier run of the same model, whose time goes on."""

BeamOnHubInitialModes = TypedDict(
    "BeamOnHubInitialModes",
    {
        "kind": 'Literal["modes"]',
        # displacement of the tip in each mode, the lowest mode first
        "amplitudes": "list[Quantity]",
        # velocity of the tip in each mode, the lowest mode first
        "velocities": "list[Quantity]",
    },
    total=False,
)
"""Vibrating in given modes about the equilibrium of the start."""

BeamOnHubIntegratorRadau = TypedDict(
    "BeamOnHubIntegratorRadau",
    {
        "kind": 'Literal["radau"]',
        # relative tolerance of the local error
        "tolerance": "float",
        # absolute tolerance, in scales of the unknowns
        "absolute-tolerance": "float",
        # first step, chosen if left out
        "initial-step": "Quantity",
        # largest step, free if left out
        "max-step": "Quantity",
        # largest step while a contact comes near and, in flight too, from the first impact on; no such limit if left out
        "contact-step": "Quantity",
        # least number of steps between two times at which a load or a motion jumps, has a kink or changes fast
        "break-steps": "int",
    },
    total=False,
)
"""Radau IIA, implicit, order 5, with step control. Hairer & Wanner 1999, doi:10.1016/S0377-0427(99)00134-X."""

BeamOnHubIntegratorNewmark = TypedDict(
    "BeamOnHubIntegratorNewmark",
    {
        "kind": 'Literal["newmark"]',
        # time step
        "step": "Quantity",
        # time step while a contact is closed or comes near, that of flight if left out
        "contact-step": "Quantity",
        # joints and closed contacts hold their velocities too, by a second multiplier (Gear, Gupta & Leimkuhler); if left out, where there are rigid contacts
        "stabilized": "bool",
        # β, at least γ/2
        "beta": "float",
        # γ; above 1/2 it dissipates
        "gamma": "float",
    },
    total=False,
)
"""Newmark, implicit, order 2 with γ = 1/2. Newmark 1959, doi:10.1061/JMCEA3.0000098."""

BeamOnHubIntegratorHht = TypedDict(
    "BeamOnHubIntegratorHht",
    {
        "kind": 'Literal["hht"]',
        # time step
        "step": "Quantity",
        # time step while a contact is closed or comes near, that of flight if left out
        "contact-step": "Quantity",
        # joints and closed contacts hold their velocities too, by a second multiplier (Gear, Gupta & Leimkuhler); if left out, where there are rigid contacts
        "stabilized": "bool",
        # α, from 0 (no dissipation) to 1/3 (most)
        "alpha": "float",
    },
    total=False,
)
"""Hilber–Hughes–Taylor, implicit, order 2, dissipates high frequencies. Hilber, Hughes & Taylor 1977, doi:10.1002/eqe.4290050306."""

BeamOnHubIntegratorGeneralizedAlpha = TypedDict(
    "BeamOnHubIntegratorGeneralizedAlpha",
    {
        "kind": 'Literal["generalized-alpha"]',
        # time step
        "step": "Quantity",
        # time step while a contact is closed or comes near, that of flight if left out
        "contact-step": "Quantity",
        # joints and closed contacts hold their velocities too, by a second multiplier (Gear, Gupta & Leimkuhler); if left out, where there are rigid contacts
        "stabilized": "bool",
        # spectral radius ρ∞ at high frequency, from 0 (most dissipation) to 1 (none)
        "spectral-radius": "float",
    },
    total=False,
)
"""Generalized-α, implicit, order 2, dissipates high frequencies. Chung & Hulbert 1993, doi:10.1115/1.2900803."""

BeamOnHubIntegratorNonsmoothGeneralizedAlpha = TypedDict(
    "BeamOnHubIntegratorNonsmoothGeneralizedAlpha",
    {
        "kind": 'Literal["nonsmooth-generalized-alpha"]',
        # time step
        "step": "Quantity",
        # spectral radius ρ∞ at high frequency, from 0 (most dissipation) to 1 (none)
        "spectral-radius": "float",
        # position and velocity are corrected after a smooth step; if false, all is solved at once
        "decoupled": "bool",
    },
    total=False,
)
"""Nonsmooth generalized-α, implicit, order 2, 1 across impacts; locates no events. Brüls, Acary & Cardona 2014, doi:10.1016/j.cma.2014.07.025; Cosimo et al. 2020, doi:10.1007/s11044-019-09706-6."""

BeamOnHubIntegratorMoreauJean = TypedDict(
    "BeamOnHubIntegratorMoreauJean",
    {
        "kind": 'Literal["moreau-jean"]',
        # time step
        "step": "Quantity",
        # θ; above 1/2 it dissipates
        "theta": "float",
    },
    total=False,
)
"""Moreau–Jean, nonsmooth, implicit, order 1; locates no events. Moreau 1988, doi:10.1007/978-3-7091-2624-0_1; Jean 1999, doi:10.1016/S0045-7825(98)00383-1."""

BeamOnHubIntegratorRungeKutta4Baumgarte = TypedDict(
    "BeamOnHubIntegratorRungeKutta4Baumgarte",
    {
        # ε in 1/s
        "position": "float",
        # δ in 1/s
        "velocity": "float",
    },
    total=False,
)
"""Constants by which closed contacts are held, g̈ + 2δ ġ + ε² g = 0 (Baumgarte 1972, doi:10.1016/0045-7825(72)90018-7); without them a case with rigid contacts is refused, with joints always."""

BeamOnHubIntegratorRungeKutta4 = TypedDict(
    "BeamOnHubIntegratorRungeKutta4",
    {
        "kind": 'Literal["runge-kutta-4"]',
        # time step
        "step": "Quantity",
        # time step while a contact is closed or comes near, that of flight if left out
        "contact-step": "Quantity",
        # constants by which closed contacts are held, g̈ + 2δ ġ + ε² g = 0 (Baumgarte 1972, doi:10.1016/0045-7825(72)90018-7); without them a case with rigid contacts is refused, with joints always
        "baumgarte": "BeamOnHubIntegratorRungeKutta4Baumgarte",
    },
    total=False,
)
"""Classical Runge–Kutta, explicit, order 4. Hairer, Nørsett & Wanner 1993, doi:10.1007/978-3-540-78862-1."""

BeamOnHubIntegratorAdams4 = TypedDict(
    "BeamOnHubIntegratorAdams4",
    {
        "kind": 'Literal["adams-4"]',
        # time step
        "step": "Quantity",
        # time step while a contact is closed or comes near, that of flight if left out
        "contact-step": "Quantity",
        # constants by which closed contacts are held, g̈ + 2δ ġ + ε² g = 0 (Baumgarte 1972, doi:10.1016/0045-7825(72)90018-7); without them a case with rigid contacts is refused, with joints always
        "baumgarte": "BeamOnHubIntegratorRungeKutta4Baumgarte",
    },
    total=False,
)
"""Adams–Bashforth–Moulton predictor–corrector, explicit, order 4. Hairer, Nørsett & Wanner 1993, doi:10.1007/978-3-540-78862-1."""

BeamOnHubRun = TypedDict(
    "BeamOnHubRun",
    {
        # simulated time; 0 for the initial state alone
        "duration": "Quantity",
        # largest error of `quantity` over its largest value: mesh and steps are refined until it is reached
        "tolerance": "float",
        # column of `tolerance`, also its `.min`, `.max` or `.final`; all principal columns if left out
        "quantity": "str",
    },
    total=False,
)
"""Extent of the run."""

BeamOnHubOutput = TypedDict(
    "BeamOnHubOutput",
    {
        # interval between records, a thousandth of the duration if left out
        "step": "Quantity",
        # stations of beams that are recorded besides the tip
        "stations": "Union[str, list[str]]",
        # axial force, shear force and bending moment are recorded at the stations
        "section-forces": "bool",
        # heights over the axis at which the strain is recorded at the stations
        "strain-heights": "list[Quantity]",
        # work, losses and the balance of energy are recorded, for an evaluation or more of the power a step
        "energy-balance": "bool",
        # the shares B²/ΣB² of the transverse modes are recorded, for the basis `modes`
        "modal-shares": "bool",
        # the run is drawn: plot.svg and plot.png
        "plots": "bool",
        # the shape of the beam is written too, for ParaView: beam.pvd
        "vtk": "bool",
        # interval between shapes, rounded to records, 200 shapes if left out
        "vtk-step": "Quantity",
    },
    total=False,
)
"""Recording of results."""

BeamOnHub = TypedDict(
    "BeamOnHub",
    {
        # title for plots and reports
        "title": "str",
        # acceleration of gravity along x, y and z, none if left out; z may be left out
        "gravity": "list[Quantity]",
        # beam itself
        "beam": "BeamOnHubBeam",
        # cross-section
        "section": "Union[BeamOnHubSectionUniform, BeamOnHubSectionRectangle, BeamOnHubSectionCircle, BeamOnHubSectionTube, BeamOnHubSectionEllipse, BeamOnHubSectionResultants, BeamOnHubSectionGeneral, BeamOnHubSectionGraded, BeamOnHubSectionTaperedRectangle, BeamOnHubSectionTaperedCircle, BeamOnHubSectionTaperedTube, BeamOnHubSectionPiecewise, BeamOnHubSectionTable, BeamOnHubSectionDeck]",
        # hub and its motion
        "hub": "BeamOnHubHub",
        # model of the beam
        "model": "BeamOnHubModel",
        # basis of the displacements
        "basis": "Union[BeamOnHubBasisFiniteElements, BeamOnHubBasisModes, BeamOnHubBasisRadial, BeamOnHubBasisPolynomial, BeamOnHubBasisBSpline, BeamOnHubBasisBezier, BeamOnHubBasisMixed]",
        # lumped masses on beams
        "mass": "list[BeamOnHubMass]",
        # springs and dampers
        "spring": "list[BeamOnHubSpring]",
        # forces, couples, and forces per length
        "load": "list[BeamOnHubLoad]",
        # contacts with obstacles
        "contact": "list[BeamOnHubContact]",
        # damping of the beam
        "damping": "BeamOnHubDamping",
        # rigid bodies, as they stand and move at the start
        "body": "list[BeamOnHubBody]",
        # joints between two parts
        "joint": "list[BeamOnHubJoint]",
        # points of sections of beams in space whose strain is recorded
        "fibre": "list[BeamOnHubFibre]",
        # axis about which `modes` and `campbell` rotate the system, and the ground with it; that of the joint with the ground if left out
        "rotation": "BeamOnHubRotation",
        # state at the start
        "initial": "Union[BeamOnHubInitialUndeformed, BeamOnHubInitialSteadyRotation, BeamOnHubInitialStatic, BeamOnHubInitialRestart, BeamOnHubInitialModes]",
        # integrator
        "integrator": "Union[BeamOnHubIntegratorRadau, BeamOnHubIntegratorNewmark, BeamOnHubIntegratorHht, BeamOnHubIntegratorGeneralizedAlpha, BeamOnHubIntegratorNonsmoothGeneralizedAlpha, BeamOnHubIntegratorMoreauJean, BeamOnHubIntegratorRungeKutta4, BeamOnHubIntegratorAdams4]",
        # extent of the run
        "run": "BeamOnHubRun",
        # recording of results
        "output": "BeamOnHubOutput",
    },
    total=False,
)
"""A beam on a hub."""

SystemBody = TypedDict(
    "SystemBody",
    {
        # name, which begins the names of its columns
        "name": "str",
        # mass
        "mass": "Quantity",
        # inertia about the centre of mass
        "inertia": "Union[BeamOnHubBodyInertiaPrincipal, BeamOnHubBodyInertiaFull, BeamOnHubBodyInertiaBox, BeamOnHubBodyInertiaCylinder, BeamOnHubBodyInertiaSphere]",
        # centre of mass at the start, the origin if left out
        "position": "list[Quantity]",
        # direction of the third axis, [0, 0, 1] if left out
        "axis": "list[Quantity]",
        # direction to which the first axis points, as far as the third allows; chosen if left out
        "across": "list[Quantity]",
        # velocity of the centre of mass at the start; what the joints and the spin ask for, if left out
        "velocity": "list[Quantity]",
        # angular velocity at the start, in the axes of space; what the joints ask for, if left out
        "spin": "list[Quantity]",
        # damping against the ground
        "damping": "BeamOnHubBodyDamping",
    },
    total=False,
)

SystemBeamCurveStraight = TypedDict(
    "SystemBeamCurveStraight",
    {
        "kind": 'Literal["straight"]',
    },
    total=False,
)
"""A straight line."""

SystemBeamCurveArc = TypedDict(
    "SystemBeamCurveArc",
    {
        "kind": 'Literal["arc"]',
        # angle of the arc
        "angle": "Quantity",
        # direction to which it bends at the root, `up` if left out
        "towards": "list[Quantity]",
    },
    total=False,
)
"""An arc of a circle."""

SystemBeamCurveHelix = TypedDict(
    "SystemBeamCurveHelix",
    {
        "kind": 'Literal["helix"]',
        # radius of the centreline
        "radius": "Quantity",
        # advance along the axis in a turn
        "pitch": "Quantity",
    },
    total=False,
)
"""A helix about `direction`, that begins on the side of `up` of its axis; the height points outwards."""

SystemBeamCurvePoints = TypedDict(
    "SystemBeamCurvePoints",
    {
        "kind": 'Literal["points"]',
        # x of the points, from the root to the tip
        "x": "list[Quantity]",
        # their y
        "y": "list[Quantity]",
        # their z
        "z": "list[Quantity]",
        # CSV file of x, y and z of the points, in m or with the units in their titles, in place of the lists
        "file": "str",
    },
    total=False,
)
"""A cubic spline through points of space, which says the length and the direction of the beam; the height follows it without turning about it."""

SystemBeamOutline = TypedDict(
    "SystemBeamOutline",
    {
        # places of its corners along the height of the section
        "y": "list[Quantity]",
        # places across, along tangent × height
        "z": "list[Quantity]",
    },
    total=False,
)
"""Outline of its root section, for pictures; that of the shape if left out."""

SystemBeamDamping = TypedDict(
    "SystemBeamDamping",
    {
        # force over mass and velocity against the ground, β: it brakes a beam that rotates too
        "mass": "Quantity",
        # viscous over elastic stress and rate of strain, η
        "stiffness": "Quantity",
    },
    total=False,
)
"""Damping against the ground, of lumped masses on it too."""

SystemBeam = TypedDict(
    "SystemBeam",
    {
        # name, which begins the names of its columns
        "name": "str",
        # length of its axis, which a curve through points and a deck say by themselves
        "length": "Quantity",
        # its root at the start, the origin if left out
        "start": "list[Quantity]",
        # direction from root to tip, [1, 0, 0] if left out
        "direction": "list[Quantity]",
        # direction of the height of the section, as far as the beam's allows; of a section as stiff along all axes [0, 0, 1] if left out, for an upright beam [1, 0, 0]
        "up": "list[Quantity]",
        # axis without stress, straight if left out; a deck has its own
        "curve": "Union[SystemBeamCurveStraight, SystemBeamCurveArc, SystemBeamCurveHelix, SystemBeamCurvePoints]",
        # angle of the tip section against the root without stress, linear between
        "twist": "Quantity",
        # cross-section
        "section": "Union[BeamOnHubSectionUniform, BeamOnHubSectionRectangle, BeamOnHubSectionCircle, BeamOnHubSectionTube, BeamOnHubSectionEllipse, BeamOnHubSectionResultants, BeamOnHubSectionGeneral, BeamOnHubSectionGraded, BeamOnHubSectionTaperedRectangle, BeamOnHubSectionTaperedCircle, BeamOnHubSectionTaperedTube, BeamOnHubSectionPiecewise, BeamOnHubSectionTable, BeamOnHubSectionDeck]",
        # outline of its root section, for pictures; that of the shape if left out
        "outline": "SystemBeamOutline",
        # it stays in the plane of x and y: a section that says nothing of torsion is as stiff in torsion and across as in the plane, and nothing acts out of it
        "planar": "bool",
        # Poisson's ratio, for the stiffness of a shape in torsion and in shear, 0.3 if left out
        "poisson-ratio": "float",
        # it has shear strains, by the stiffness GA of its section, and rotary inertia
        "shear": "bool",
        # shear factor of a shape, Cowper's if left out
        "shear-factor": "float",
        # it twists; without, it is held so stiff in torsion that it hardly does; if left out, a deck that says too little of torsion is held
        "torsion": "bool",
        # moment of inertia per length about the axis, that of the section if left out
        "polar-inertia": "Quantity",
        # place of the section's tension centre, [along the height, across], against the centreline, which goes through the centres of mass; bending stiffnesses are about axes through it
        "tension-centre": "list[Quantity]",
        # stiffnesses that couple [torsion and bending across, torsion and bending along the height, the two bendings]
        "coupling": "list[Quantity]",
        # number of elements, if none end at other stations
        "elements": "int",
        # hold of the root, beside its joints
        "root": 'Union[Literal["free"], Literal["clamped"], Literal["hinged"]]',
        # hold of the tip, beside its joints
        "tip": 'Union[Literal["free"], Literal["clamped"], Literal["hinged"]]',
        # velocity of the root at the start; what joints and spin ask for, if left out
        "velocity": "list[Quantity]",
        # angular velocity at the start, in the axes of space; what the joints ask for, if left out
        "spin": "list[Quantity]",
        # damping against the ground, of lumped masses on it too
        "damping": "SystemBeamDamping",
    },
    total=False,
)

SystemJoint = TypedDict(
    "SystemJoint",
    {
        # name, for messages and columns; that of its number if left out
        "name": "str",
        # motions that it leaves free
        "kind": 'Union[Literal["fixed"], Literal["revolute"], Literal["prismatic"], Literal["cylindrical"], Literal["universal"], Literal["spherical"], Literal["planar"]]',
        # the two parts: `ground`, bodies, or places of beams such as `blade.root` and `blade.tip`
        "between": "list[str]",
        # its point in space at the start; the second part's own if left out
        "at": "list[Quantity]",
        # direction of the third axis, [0, 0, 1] if left out
        "axis": "list[Quantity]",
        # direction to which the first axis points, as far as the third allows; chosen if left out
        "across": "list[Quantity]",
        # rotation of a revolute or cylindrical joint: prescribed, or driven by a torque
        "motion": "Union[BeamOnHubHubMotionSpinUp, BeamOnHubHubMotionConstant, BeamOnHubHubMotionRamp, BeamOnHubHubMotionTable, BeamOnHubHubMotionExpression, BeamOnHubJointMotionFree]",
        # displacement of a prismatic joint: prescribed, or driven by a force
        "travel": "Union[BeamOnHubJointTravelConstant, BeamOnHubJointTravelTable, BeamOnHubJointTravelExpression, BeamOnHubJointTravelFree]",
    },
    total=False,
)

SystemLoad = TypedDict(
    "SystemLoad",
    {
        # name, for messages and columns; that of its number if left out
        "name": "str",
        # place where it acts, or the beam along which it acts
        "on": "str",
        # point of a body where it acts, in space at the start; its centre of mass if left out
        "at": "list[Quantity]",
        # components of the force at the place
        "force": "list[Quantity]",
        # couple at the place: a number is about z
        "couple": "Union[Quantity, list[Quantity]]",
        # components of the force per length along the beam
        "force-per-length": "list[Quantity]",
        # arc length where a force per length begins, the root if left out
        "from": "Quantity",
        # arc length where it ends, the tip if left out
        "to": "Quantity",
        # factor of a force per length against the arc length, 1 if left out
        "distribution": "Union[BeamOnHubLoadDistributionUniform, BeamOnHubLoadDistributionTable, BeamOnHubLoadDistributionExpression]",
        # law by which a force per length follows from the motion, in the place of `force-per-length`
        "law": "Union[BeamOnHubLoadLawLinearDrag, BeamOnHubLoadLawQuadraticDrag]",
        # axes of the components
        "axes": 'Union[Literal["dead"], Literal["hub"], Literal["follower"]]',
        # factor against time
        "amplitude": "Union[BeamOnHubLoadAmplitudeConstant, BeamOnHubLoadAmplitudeRamp, BeamOnHubLoadAmplitudeTable, BeamOnHubLoadAmplitudeExpression]",
    },
    total=False,
)

SystemContactObstaclePlane = TypedDict(
    "SystemContactObstaclePlane",
    {
        "kind": 'Literal["plane"]',
        # a point of the plane, the origin if left out
        "point": "list[Quantity]",
        # direction out of the obstacle; [0, 1, 0] if left out for a beam on a hub
        "normal": "list[Quantity]",
        # angle about z from the x axis to the plane, in the place of `normal`; the free side is to its left
        "angle": "Quantity",
        # prescribed translation of the obstacle, at rest if left out
        "motion": "BeamOnHubContactObstaclePlaneMotion",
    },
    total=False,
)
"""Half-space behind a plane."""

SystemContact = TypedDict(
    "SystemContact",
    {
        # name, for messages and columns; that of its number if left out
        "name": "str",
        # parts that may touch: a body, a place of a beam, a list of them, or a whole beam, where it is nearest to the obstacle or by `points`; the tip of the only beam if left out
        "on": "Union[str, list[str]]",
        # point of a body that may touch, in space at the start; its centre of mass if left out
        "at": "list[Quantity]",
        # radius of the ball about the point, which slides and rolls on the obstacle, or of a beam that is round
        "radius": "Quantity",
        # number of equidistant points, the last at the tip, by which a whole beam may touch, and one more at the root where nothing holds it
        "points": "int",
        # rigid obstacle
        "obstacle": "Union[SystemContactObstaclePlane, BeamOnHubContactObstacleCylinder, BeamOnHubContactObstacleSphere, BeamOnHubContactObstacleStop]",
        # part that the obstacle is fixed to, in whose axes and from whose point it is given: `ground`, `hub`, a body or a place of a beam in space; the ground if left out, the hub of a stop
        "mount": "str",
        # law of the contact
        "law": "Union[BeamOnHubContactLawMassless, BeamOnHubContactLawConstraint, BeamOnHubContactLawHertz, BeamOnHubContactLawHuntCrossley, BeamOnHubContactLawLankaraniNikravesh, BeamOnHubContactLawFlores, BeamOnHubContactLawGonthier, BeamOnHubContactLawMatched]",
    },
    total=False,
)

SystemModel = TypedDict(
    "SystemModel",
    {
        # kinematic model
        "coupling": 'Union[Literal["zeroth"], Literal["first"], Literal["high"], Literal["exact"], Literal["space"], Literal["space-shear"]]',
        # rows of joints that follow from others are left out, in place of an error, and have no forces; a run ends where they no longer follow
        "drop-redundant-rows": "bool",
        # into how many each element of beams in space is cut
        "refine": "int",
    },
    total=False,
)
"""Model of the system."""

SystemIntegratorRungeKutta4 = TypedDict(
    "SystemIntegratorRungeKutta4",
    {
        "kind": 'Literal["runge-kutta-4"]',
        # time step
        "step": "Quantity",
        # time step while a contact is closed or comes near, that of flight if left out
        "contact-step": "Quantity",
        # constants by which closed contacts are held, g̈ + 2δ ġ + ε² g = 0 (Baumgarte 1972, doi:10.1016/0045-7825(72)90018-7); without them a case with rigid contacts is refused, with joints always
        "baumgarte": "BeamOnHubIntegratorRungeKutta4Baumgarte",
    },
    total=False,
)
"""Classical Runge–Kutta, explicit, order 4. Hairer, Nørsett & Wanner 1993, doi:10.1007/978-3-540-78862-1."""

SystemOutput = TypedDict(
    "SystemOutput",
    {
        # interval between records, a thousandth of the duration if left out
        "step": "Quantity",
        # stations of beams that are recorded besides the tip
        "stations": "Union[str, list[str]]",
        # stations are recorded in the axes of their root too, as those of a beam in the plane: deflection, axial, across, rotation
        "root-axes": "bool",
        # work, losses and the balance of energy are recorded, for an evaluation or more of the power a step
        "energy-balance": "bool",
        # the run is drawn: plot.svg and plot.png
        "plots": "bool",
        # the shape of the beam is written too, for ParaView: beam.pvd
        "vtk": "bool",
        # interval between shapes, rounded to records, 200 shapes if left out
        "vtk-step": "Quantity",
    },
    total=False,
)
"""Recording of results."""

System = TypedDict(
    "System",
    {
        # title for plots and reports
        "title": "str",
        # acceleration of gravity along x, y and z, none if left out; z may be left out
        "gravity": "list[Quantity]",
        # rigid bodies, as they stand and move at the start
        "body": "list[SystemBody]",
        # beams
        "beam": "list[SystemBeam]",
        # joints between two parts
        "joint": "list[SystemJoint]",
        # lumped masses on beams
        "mass": "list[BeamOnHubMass]",
        # springs and dampers
        "spring": "list[BeamOnHubSpring]",
        # forces, couples, and forces per length
        "load": "list[SystemLoad]",
        # contacts with obstacles
        "contact": "list[SystemContact]",
        # points of sections of beams in space whose strain is recorded
        "fibre": "list[BeamOnHubFibre]",
        # axis about which `modes` and `campbell` rotate the system, and the ground with it; that of the joint with the ground if left out
        "rotation": "BeamOnHubRotation",
        # model of the system
        "model": "SystemModel",
        # state at the start
        "initial": "Union[BeamOnHubInitialUndeformed, BeamOnHubInitialSteadyRotation, BeamOnHubInitialStatic, BeamOnHubInitialRestart, BeamOnHubInitialModes]",
        # integrator
        "integrator": "Union[BeamOnHubIntegratorRadau, BeamOnHubIntegratorNewmark, BeamOnHubIntegratorHht, BeamOnHubIntegratorGeneralizedAlpha, BeamOnHubIntegratorNonsmoothGeneralizedAlpha, BeamOnHubIntegratorMoreauJean, SystemIntegratorRungeKutta4, BeamOnHubIntegratorAdams4]",
        # extent of the run
        "run": "BeamOnHubRun",
        # recording of results
        "output": "SystemOutput",
    },
    total=False,
)
"""A system in space."""

Case: TypeAlias = Union[BeamOnHub, System]
"""A case: a beam on a hub, or a system in space."""
