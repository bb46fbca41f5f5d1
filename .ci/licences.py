"""Holds the licences of all packages in Cargo.lock to the list in deny.toml: python .ci/licences.py"""

import json
import re
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).parent.parent


def holds(expression, allowed):
    """Whether a licence expression of SPDX can be met by the licences of the list; `/` is an old spelling of OR."""
    tokens = re.findall(r"\(|\)|[^\s()/]+|/", expression)
    at = 0

    def taken(*words):
        nonlocal at
        found = at < len(tokens) and tokens[at].upper() in words
        at += found
        return found

    def alternatives():
        met = requirements()
        while taken("OR", "/"):
            met = requirements() or met
        return met

    def requirements():
        met = one()
        while taken("AND"):
            met = one() and met
        return met

    def one():
        nonlocal at
        if taken("("):
            met = alternatives()
            taken(")")
            return met
        name = tokens[at]
        at += 1
        if taken("WITH"):
            name += f" WITH {tokens[at]}"
            at += 1
        return name in allowed

    return alternatives() and at == len(tokens)


def main():
    allowed = tomllib.loads((ROOT / "deny.toml").read_text())["licenses"]["allow"]
    command = ["cargo", "metadata", "--format-version", "1", "--locked"]
    packages = json.loads(subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout)["packages"]
    refused = [p for p in packages if not holds(p["license"] or "none", allowed)]
    for package in refused:
        print(f"{package['name']} {package['version']}: {package['license']} is not among {', '.join(allowed)}")
    print(f"{len(packages)} packages, {len(refused)} with a licence that deny.toml does not allow")
    sys.exit(bool(refused))


if __name__ == "__main__":
    main()
