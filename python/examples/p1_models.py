"""Models of one beam beside each other: what the coupling does to a spin-up."""

import os
from pathlib import Path

import flexion

VERIFICATION = Path(os.environ.get("FLEXION_VERIFICATION", "verification"))

case = flexion.Case(VERIFICATION / "p1_spin_up_4")
exact = case.with_("model.coupling", "exact").run(name="exact")
print("exact", exact["tip.deflection"].min)
runs = [exact]
for coupling in ("first", "high"):
    run = case.with_("model.coupling", coupling).run(name=coupling)
    apart = flexion.compare(exact, run)["tip.deflection"]
    print(f"{coupling}: {run['tip.deflection'].min}, at most {apart.relative:.1%} from the exact one")
    runs.append(run)
flexion.plot(*runs, columns=["tip.deflection", "tip.axial"], title="Couplings").save("couplings.svg")

# The cheapest that is good enough.
print(case.advise(1e-2))
