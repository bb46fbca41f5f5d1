"""Writes ``flexion/keys.py``, the keys of a case as types, from the declarations of the engine: ``python generate/keys.py``.

A test holds the file to what this writes.
"""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import flexion

FILE = Path(__file__).parents[1] / "flexion" / "keys.py"

HEAD = '''"""The keys of a case as types, for editors and type checkers; written by ``generate/keys.py`` from the declarations of the engine."""

# ruff: noqa: E501

from __future__ import annotations

from typing import Literal, TypeAlias, TypedDict, Union

Quantity: TypeAlias = Union[float, str]
"""A number in SI, or a text with a unit."""

'''


class Writer:
    """Types by their names, each before it is used."""

    def __init__(self) -> None:
        self.written: dict[str, str] = {}
        self.names: dict[str, str] = {}

    def type_of(self, schema: dict[str, Any], name: str) -> str:
        """The type of a schema; ``name`` is that of a table."""
        if "const" in schema:
            return f"Literal[{json.dumps(schema['const'])}]"
        if "enum" in schema:
            return f"Literal[{', '.join(json.dumps(value) for value in schema['enum'])}]"
        alternatives = schema.get("oneOf") or (schema.get("anyOf") if "properties" not in schema else None)
        if alternatives:
            kinds = [self.type_of(of, name + pascal(kind_of(of))) for of in alternatives]
            if {"float", "str"} <= set(kinds):
                kinds = [kind for kind in kinds if kind not in ("float", "str")] + ["Quantity"]
            return union(kinds)
        match schema.get("type"):
            case "object":
                return self.table(schema, name)
            case "array":
                items = schema.get("items")
                return f"list[{self.type_of(items, name)}]" if isinstance(items, dict) else "list[Quantity]"
            case "boolean":
                return "bool"
            case "integer":
                return "int"
            case "number":
                return "float"
            case "string":
                return "str"
        return "object"

    def table(self, schema: dict[str, Any], name: str) -> str:
        """The type of a table, which is written once."""
        fields = {key: self.type_of(of, name + pascal(key)) for key, of in schema.get("properties", {}).items()}
        lines = [f"{name} = TypedDict(", f'    "{name}",', "    {"]
        for key, kind in fields.items():
            said = schema["properties"][key].get("description", "")
            lines.append(f"        # {said}" if said else "")
            lines.append(f'        "{key}": "{kind}",' if '"' not in kind else f"        \"{key}\": '{kind}',")
        lines += ["    },", "    total=False,", ")"]
        about = re.sub(r"\s+", " ", schema.get("description", "")).replace('"', "'")
        body = "\n".join(line for line in lines if line) + (f'\n"""{about[:1].upper()}{about[1:]}."""\n' if about else "\n")
        known = self.names.get(body.replace(name, "@"))
        if known is not None:
            return known
        self.names[body.replace(name, "@")] = name
        self.written[name] = body
        return name


def kind_of(schema: dict[str, Any]) -> str:
    """The kind that a table is of."""
    kind = schema.get("properties", {}).get("kind", {})
    return str(kind.get("const", ""))


def pascal(key: str) -> str:
    return "".join(part.capitalize() for part in re.split(r"[^A-Za-z0-9]+", key))


def union(kinds: list[str]) -> str:
    unique = list(dict.fromkeys(kinds))
    return unique[0] if len(unique) == 1 else f"Union[{', '.join(unique)}]"


def text() -> str:
    """The whole file."""
    schema = json.loads(flexion.schema())
    writer = Writer()
    cases = [writer.type_of(of, name) for of, name in zip(schema["anyOf"], ("BeamOnHub", "System"), strict=True)]
    body = "\n".join(writer.written.values())
    return f'{HEAD}{body}\nCase: TypeAlias = {union(cases)}\n"""A case: a beam on a hub, or a system in space."""\n'


if __name__ == "__main__":
    FILE.write_text(text(), encoding="utf-8")
