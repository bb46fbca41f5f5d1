"""A blade as its deck has it, to its Campbell diagram."""

import os
from pathlib import Path

import flexion
import numpy as np

VERIFICATION = Path(os.environ.get("FLEXION_VERIFICATION", "verification"))

case = flexion.Case(VERIFICATION / "modes_blade_nrel_5mw")
rated = 12.1 * 2 * np.pi / 60

# What the first modes move, at rest and at the rated speed.
print(case.modes(0.0, 4))
print(case.modes(rated, 4, unit="rpm"))

# The diagram over the speeds, with what comes near multiples of the speed.
diagram = case.campbell(np.linspace(0.0, 1.3 * rated, 14), count=4, unit="rpm")
for resonance in diagram.resonances:
    branch = diagram[resonance.branch]
    rpm = np.array([resonance.first, resonance.last]) * 60 / (2 * np.pi)
    print(f"{branch.name} is near {resonance.k} Ω from {rpm[0]:.1f} to {rpm[1]:.1f} rpm")
diagram.plot().save("campbell.svg")
