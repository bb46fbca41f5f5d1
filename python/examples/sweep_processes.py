"""A sample of blades on worker processes, read back as a table. A client of Dask takes the place of the pool on a cluster."""

import os
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import flexion

VERIFICATION = Path(os.environ.get("FLEXION_VERIFICATION", "verification"))


def main() -> None:
    case = flexion.Case(VERIFICATION / "p1_spin_up_4")
    inputs = {"section.modulus": "normal(70 GPa, 2 GPa)", "hub.motion.speed": "3.8 rad/s:4.2 rad/s"}
    with ProcessPoolExecutor(2) as pool:
        rows = flexion.sweep(
            case, inputs, "tip.deflection.min", sample="sobol", runs=64, seed=1, folder="blades", client=pool
        )
    deflection = rows["tip.deflection.min"]
    print(f"{rows.rows} runs: {deflection.mean():.4f} m ± {deflection.std():.4f} m by the scatter of the inputs")
    print(rows.to_pandas().head())


if __name__ == "__main__":
    main()
