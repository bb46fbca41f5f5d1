"""Makes each history of histories.toml and compares it with the one stored.

    references/run [--write] [WORD]      --write stores what is made; WORD: only histories whose name contains it
"""

import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np

HERE = Path(__file__).parent


def table(text):
    """Names and rows."""
    lines = [line for line in text.splitlines() if line and not line.startswith("#")]
    return lines[0], np.array([[float(x) for x in line.split(",")] for line in lines[1:]])


def difference(made, stored):
    """Largest difference over the peak of the column."""
    (names, made), (stored_names, stored) = table(made), table(stored)
    if names != stored_names or made.shape != stored.shape:
        return np.inf
    peak = np.abs(made).max(0)
    return (np.abs(made - stored).max(0) / np.where(peak > 0, peak, 1)).max()


def main():
    words = [word for word in sys.argv[1:] if word != "--write"]
    differ = 0
    for program in tomllib.loads((HERE / "histories.toml").read_text())["program"]:
        for name in program["histories"]:
            if not all(word in name for word in words):
                continue
            path = HERE / program["path"]
            made = subprocess.run([sys.executable, path, name], check=True, capture_output=True, text=True).stdout
            file = HERE.parent / "verification" / f"{name}.csv"
            off = difference(made, file.read_text()) if file.exists() else np.inf
            same = off <= 0.5 * 10.0 ** -program["digits"]
            print(f"{name:40} {program['path']:32} off {off:.1e}, {'the same' if same else 'DIFFERENT'}", flush=True)
            differ += not same
            if "--write" in sys.argv:
                file.write_text(made)
    sys.exit(f"{differ} histories differ" if differ else 0)


if __name__ == "__main__":
    main()
