"""The two cases of README.md as texts: for Flexion (TOML) and for MuJoCo (MJCF). All quantities in SI units."""

import math

G = 9.81


class Chain:
    """Rods joined by hinges fall on a floor: straight, tilted by the slope 1/20, the lower end 5 cm over it."""

    RODS, ROD, MASS, HEIGHT, SLOPE = 100, 0.02, 0.02, 0.05, 0.05
    END, EVERY = 0.2, 0.01
    COS = 1.0 / math.hypot(1.0, SLOPE)
    SIN = SLOPE * COS
    INERTIA = MASS * ROD**2 / 12.0

    def flexion(self, integrator):
        x = lambda s: f"[{s * self.COS:.15g}, 0, {self.HEIGHT + s * self.SIN:.15g}]"
        inertia = f"[{self.INERTIA:.15g}, {self.INERTIA:.15g}, {self.INERTIA / 80.0:.15g}]"
        lines = [f"gravity = [0, 0, {-G}]", f"run = {{ duration = {self.END} }}", f"integrator = {integrator}"]
        lines += [f"output = {{ step = {self.EVERY}, plots = false, energy-balance = false }}"]
        for i in range(self.RODS):
            lines += ["[[body]]", f'name = "rod{i}"', f"mass = {self.MASS}", f"position = {x((i + 0.5) * self.ROD)}"]
            lines += [f'inertia = {{ kind = "principal", moments = {inertia} }}']
            lines += [f"axis = [{self.COS:.15g}, 0, {self.SIN:.15g}]", "across = [0, 1, 0]"]
        for i in range(1, self.RODS):
            lines += ["[[joint]]", 'kind = "revolute"', f'between = ["rod{i - 1}", "rod{i}"]']
            lines += [f"at = {x(i * self.ROD)}", "axis = [0, 1, 0]"]
        for i in range(self.RODS + 1):
            lines += ["[[contact]]", f'name = "end{i}"', f'on = "rod{max(i - 1, 0)}"', f"at = {x(i * self.ROD)}"]
            lines += ['obstacle = { kind = "plane", normal = [0, 0, 1] }']
            lines += ['law = { kind = "constraint", restitution = 0 }']
        return "\n".join(lines) + "\n"

    def mujoco(self, options):
        tilt = -math.degrees(math.atan(self.SLOPE))
        bodies = [f'<body pos="0 0 {self.HEIGHT}" euler="0 {tilt:.15g} 0">']
        # Two translations in the axes of the root, and its rotation: motion in the plane.
        bodies += [f'<joint type="slide" axis="{self.COS:.17g} 0 {-self.SIN:.17g}"/>']
        bodies += [f'<joint type="slide" axis="{self.SIN:.17g} 0 {self.COS:.17g}"/>', HINGE.format(""), BALL.format(0)]
        inertia = f"{self.INERTIA / 80.0:.15g} {self.INERTIA:.15g} {self.INERTIA:.15g}"
        for i in range(self.RODS):
            if i:
                bodies += [f'<body pos="{self.ROD} 0 0">', HINGE.format("")]
            bodies += [f'<inertial pos="{self.ROD / 2} 0 0" mass="{self.MASS}" diaginertia="{inertia}"/>']
            bodies += [BALL.format(self.ROD)]
        return mjcf(options, "".join(bodies) + "</body>" * self.RODS)


class Beam:
    """A beam clamped level over a floor is let go straight and lies down, damped like a Kelvin-Voigt solid."""

    LENGTH, BENDING, MASS_PER_LENGTH, LAG = 0.5, 1.0, 1.0, 0.02
    END, EVERY = 0.3, 0.01
    Q = MASS_PER_LENGTH * G
    LIFTED = 0.3  # length of the part that does not touch the floor
    HEIGHT = Q * LIFTED**4 / (72.0 * BENDING)
    MOMENT = Q * LIFTED**2 / 6.0  # at the clamp
    FLOOR = Q * (LENGTH - 2.0 / 3.0 * LIFTED)  # what the floor carries

    def flexion(self, integrator, elements, static=False):
        lines = [f"gravity = [0, {-G}]", f"beam = {{ length = {self.LENGTH} }}", f"integrator = {integrator}"]
        lines += [f"run = {{ duration = {0 if static else self.END} }}"]
        lines += [f"output = {{ step = {self.EVERY}, plots = false, energy-balance = false }}"]
        lines += ['model = { coupling = "exact" }', 'hub = { motion = { kind = "constant", speed = 0 } }']
        section = f"mass-per-length = {self.MASS_PER_LENGTH}, axial-stiffness = 1e6, bending-stiffness = {self.BENDING}"
        lines += [f'section = {{ kind = "resultants", {section} }}']
        lines += [f'basis = {{ kind = "finite-elements", elements = {elements} }}']
        lines += ['initial = { kind = "static" }'] if static else [f"damping = {{ stiffness = {self.LAG} }}"]
        lines += ["[[contact]]", 'name = "floor"', 'on = "beam"', f"points = {elements}"]
        lines += [f'obstacle = {{ kind = "plane", point = [0, {-self.HEIGHT:.15g}] }}']
        lines += ['law = { kind = "constraint", restitution = 0 }']
        return "\n".join(lines) + "\n"

    def mujoco(self, options, rods):
        rod = self.LENGTH / rods
        mass, stiffness = self.MASS_PER_LENGTH * rod, self.BENDING / rod
        # Half as much of the beam bends at the clamp as at a hinge between two rods.
        spring = lambda k: HINGE.format(f'stiffness="{k:.15g}" damping="{k * self.LAG:.15g}" ')
        bodies = [f'<body pos="0 0 {self.HEIGHT:.15g}">', spring(2.0 * stiffness)]
        inertia = mass * rod**2 / 12.0
        for i in range(rods):
            if i:
                bodies += [f'<body pos="{rod} 0 0">', spring(stiffness)]
            moments = f"{inertia / 80.0:.15g} {inertia:.15g} {inertia:.15g}"
            bodies += [f'<inertial pos="{rod / 2} 0 0" mass="{mass}" diaginertia="{moments}"/>', BALL.format(rod)]
        return mjcf(options, "".join(bodies) + "</body>" * rods)


RADIUS = 0.001  # of the balls that touch; the floor lies as much lower, so that it is the end of a rod that stops
HINGE = '<joint type="hinge" axis="0 1 0" {}/>'
BALL = f'<geom type="sphere" size="{RADIUS}" pos="{{}} 0 0" mass="0" contype="1" conaffinity="2"/>'


def mjcf(options, bodies):
    """`options`: step, integrator, solref's time constant in steps and its damping ratio, solimp's impedance."""
    contact = f'condim="1" solref="{options.time * options.step:.15g} {options.ratio}" solimp="{options.impedance} {options.impedance}"'
    return (
        f'<mujoco><option timestep="{options.step:.15g}" gravity="0 0 {-G}" integrator="{options.integrator}" '
        f'solver="Newton" jacobian="{options.jacobian}" iterations="100" tolerance="1e-12"/>'
        f"<default><geom {contact}/></default><worldbody>"
        f'<geom type="plane" size="0 0 1" pos="0 0 {-RADIUS}" contype="2" conaffinity="1"/>'
        f"{bodies}</worldbody></mujoco>"
    )
