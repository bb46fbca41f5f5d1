"""Holds the JSON Schema of cases and the program to each other, by a validator that knows neither.

    pip install jsonschema
    python check_schema.py PROGRAM

Every case of verification/, and the long spelling of every variant that has one, must pass docs/flexion.schema.json. Of MUTANTS cases with one
mistake each, in a key, a type, a kind or a bound, the schema must reject those that the program rejects for that, and the program those that
the schema rejects. Exits with 1 if not, and names what differs. What a schema cannot say is listed in BEYOND.
"""

import copy
import json
import random
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

import jsonschema

ROOT = Path(__file__).resolve().parent.parent
MUTANTS = 400
SEED = 20

# What the reader of cases says of keys, types, kinds and bounds; all else is of the parts that are made of them.
OF_KEYS = re.compile(
    r"unknown key|this key is missing|this table is missing|is not what this key takes|is not a table|the kind of .* is missing"
    r"|a kind is a text|: unknown [a-z -]+ `|must be (from|positive|zero or positive|finite|a finite number)| is not an? [a-z ]+$",
    re.MULTILINE,
)
# Unit and bound of a text such as "-3 kg": a pattern knows no dimensions; a length that a deck may say.
BEYOND = re.compile(r"unit|measures|must be (positive|zero or positive|from)|a deck that has a length says it")


def written(value):
    """A value of TOML, on one line."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(key)} = {written(of)}" for key, of in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(written, value)) + "]"
    return json.dumps(value)


def toml(case):
    return "".join(f"{json.dumps(key)} = {written(value)}\n" for key, value in case.items())


def places(table, path=()):
    """Every key of a case, as the path that leads to it."""
    for key, value in table.items():
        yield (*path, key)
        for number, item in [(None, value)] if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else []:
            if isinstance(item, dict):
                yield from places(item, (*path, key) if number is None else (*path, key, number))


def mutated(case, rng):
    """A copy with one mistake, and what it is."""
    case = copy.deepcopy(case)
    path = rng.choice(list(places(case)))
    table = case
    for key in path[:-1]:
        table = table[key]
    key = path[-1]
    value = table[key]
    mistakes = ["renamed", "left out", "of another type"]
    if isinstance(value, str) and re.match(r"[0-9]", value):
        mistakes += ["of another unit", "below zero"]
    if key == "kind":
        mistakes.append("no kind")
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        mistakes += ["negative", "a fraction", "a text without number"]
    mistake = rng.choice(mistakes)
    if mistake == "renamed":
        table[key + "x"] = table.pop(key)
    elif mistake == "left out":
        del table[key]
    elif mistake == "of another type":
        others = [True, "some text", 7, [True], {"kind": "none"}, [{"none": 1}]]
        table[key] = rng.choice([other for other in others if type(other) is not type(value)])
    elif mistake == "no kind":
        table[key] = value + "-"
    elif mistake == "of another unit":
        table[key] = re.match(r"[0-9.e+-]*", value)[0] + " furlong"
    elif mistake == "below zero":
        table[key] = "-" + value
    elif mistake == "negative":
        table[key] = -abs(value) - 1
    elif mistake == "a fraction":
        table[key] = value + 0.5
    else:
        table[key] = "m"
    return case, f"{'.'.join(map(str, path))} {mistake}"


def main(program):
    schema = json.loads((ROOT / "docs/flexion.schema.json").read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)

    def checked(path):
        told = subprocess.run([program, "check", path], capture_output=True, text=True)
        return told.returncode == 0, told.stderr

    folders = sorted(path.parent for path in (ROOT / "verification").glob("*/case.toml"))
    cases, wrong, long = {}, [], 0
    for folder in folders:
        cases[folder] = tomllib.loads((folder / "case.toml").read_text())
        variants = tomllib.loads((folder / "expected.toml").read_text()).get("variant", [])
        for name, changes in [("", []), *((variant["name"], variant["set"]) for variant in variants)]:
            setting = [word for change in changes for word in ("--set", change)]
            for space in [], ["--set", "model.coupling=space"]:
                told = subprocess.run([program, "check", "--long", folder, *setting, *space], capture_output=True, text=True)
                if told.returncode != 0:
                    continue
                long += 1
                if not validator.is_valid(tomllib.loads(told.stdout)):
                    wrong.append(f"the long spelling of {folder.name}/{name} does not pass")
        if not validator.is_valid(cases[folder]):
            wrong.append(f"{folder.name} does not pass")
    print(f"{len(cases)} cases, {long} long spellings")

    rng = random.Random(SEED)
    counts = dict.fromkeys(["both", "neither", "the program for its parts", "the program beyond a schema"], 0)
    with tempfile.TemporaryDirectory() as work:
        # With the files beside the cases, which they name.
        shutil.copytree(ROOT / "verification", work, dirs_exist_ok=True)
        for folder in folders:
            place = Path(work) / folder.name
            (place / "case.toml").write_text(toml(cases[folder]))
            if not checked(place)[0]:
                wrong.append(f"{folder.name} written anew does not pass the program")
        for number in range(MUTANTS):
            folder = rng.choice(folders)
            case, mistake = mutated(cases[folder], rng)
            place = Path(work) / folder.name
            (place / "case.toml").write_text(toml(case))
            passes, message = checked(place)
            valid = validator.is_valid(case)
            of_keys = not passes and OF_KEYS.search(message)
            if not valid and not passes:
                counts["both"] += 1
            elif valid and passes:
                counts["neither"] += 1
            elif valid and not of_keys:
                counts["the program for its parts"] += 1
            elif valid and BEYOND.search(message):
                counts["the program beyond a schema"] += 1
            else:
                who = "the program" if passes else "the schema"
                wrong.append(f"mutant {number} of {folder.name}, {mistake}: passes {who}\n{message}")
    print("mutants rejected by", ", ".join(f"{what}: {count}" for what, count in counts.items()))
    print("\n".join(wrong))
    sys.exit(1 if wrong or counts["both"] < 100 else 0)


main(sys.argv[1])
