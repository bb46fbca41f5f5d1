"""Cases: from files, texts and dicts; changes, meaning, pickling, problems."""

from __future__ import annotations

import copy
import pickle
from pathlib import Path
from typing import Any

import flexion
import numpy as np
import pytest
from conftest import ARM


def test_a_dict_a_text_and_a_file_are_the_same_case(arm: flexion.Case, tmp_path: Path) -> None:
    text = str(arm)
    (tmp_path / "case.toml").write_text(text)
    assert arm == flexion.Case(text) == flexion.Case(tmp_path) == flexion.Case(str(tmp_path / "case.toml"))
    assert hash(arm) == hash(flexion.Case(text))
    assert flexion.Case(arm.to_toml(defaults=True)) == arm
    assert arm.to_toml(defaults=True) != arm.to_toml()


def test_equality_is_of_meaning_and_not_of_spelling(arm: flexion.Case) -> None:
    assert arm == arm.with_("beam.length", "10000 mm") == arm.with_("beam.length", 10)
    assert arm != arm.with_("beam.length", "10.001 m")
    assert arm.with_("gravity", [0.0, -9.81]) == arm.with_("gravity", [-0.0, -9.81])
    assert (arm == 3) is False
    assert len({arm, arm.with_("beam.length", 10.0), arm.with_("beam.length", 11)}) == 2


def test_changes_make_another_case(arm: flexion.Case) -> None:
    before = str(arm)
    changed = arm | {"section.modulus": 140e9, "model.coupling": "exact"}
    assert str(arm) == before != str(changed)
    assert changed == arm.with_("model.coupling", "exact").with_("section.modulus", "140 GPa")
    # A dict replaces a table, as on the command line.
    newmark = arm | {"integrator": {"kind": "newmark", "step": "2 ms"}}
    assert 'kind = "newmark"' in str(newmark) and "step = 0.002" in str(newmark)
    with pytest.raises(TypeError):
        arm | 3  # type: ignore[operator]
    with pytest.raises(AttributeError):
        arm.title = "another"  # type: ignore[misc]


def test_values_may_be_those_of_numpy(arm: flexion.Case) -> None:
    assert arm.with_("beam.length", np.float64(10)) == arm
    assert arm.with_("gravity", np.array([0.0, -9.81])) == arm.with_("gravity", [0, -9.81])
    assert arm.with_("basis.elements", np.int64(7)) == arm.with_("basis.elements", 7)
    assert arm.with_("gravity", (0, -9.81)) == arm.with_("gravity", [0.0, "-9.81 m/s^2"])
    assert arm.with_("beam.length", np.longdouble(10)) == arm
    for complex_number in (np.complex128(10 + 2j), np.clongdouble(10 + 2j)):
        with pytest.raises(TypeError, match="beam.length: a value of the type c"):
            arm.with_("beam.length", complex_number)


def test_files_of_the_same_bytes_are_the_same_under_any_name(verification: Path, tmp_path: Path) -> None:
    source = verification / "modes_blade_nrel_5mw"
    case = flexion.Case(source)
    text = (source / "case.toml").read_text()
    assert '"blade.dat"' in text
    (tmp_path / "case.toml").write_text(text.replace('"blade.dat"', '"another.dat"'))
    data = (source / "blade.dat").read_bytes()
    (tmp_path / "another.dat").write_bytes(data)
    other = flexion.Case(tmp_path)
    assert other == case and hash(other) == hash(case)
    (tmp_path / "another.dat").write_bytes(data + b"\n")
    assert flexion.Case(tmp_path) != case


def test_a_pickled_case_carries_the_bytes_of_its_files(verification: Path, tmp_path: Path) -> None:
    case = flexion.Case(verification / "modes_blade_nrel_5mw")
    packed = pickle.dumps(case)
    again = pickle.loads(packed)
    assert again == case == copy.deepcopy(case)
    assert again.modes(1.2, 2).frequencies.tolist() == case.modes(1.2, 2).frequencies.tolist()
    with pytest.raises(ValueError, match="0.0.9"):
        pickle.loads(packed.replace(flexion.__version__.encode(), b"0.0.9"))


def test_all_problems_are_said_at_once_with_place_and_remedy() -> None:
    with pytest.raises(flexion.CaseError) as raised:
        flexion.Case({"beam": {"lenght": 3}, "run": {"duration": "x"}})
    problems = raised.value.problems
    assert {problem.key for problem in problems} == {"beam.length", "beam.lenght", "run.duration", "section"}
    misspelt = next(problem for problem in problems if problem.key == "beam.lenght")
    assert (misspelt.line, misspelt.column) == (2, 1)
    assert "did you mean `length`?" in str(raised.value)
    again = pickle.loads(pickle.dumps(raised.value))
    assert again.problems == problems and str(again) == str(raised.value)
    assert isinstance(raised.value, ValueError)


def test_a_problem_of_a_file_names_the_file(tmp_path: Path) -> None:
    (tmp_path / "arm.toml").write_text("[beam]\nlength = 'ten'\n")
    with pytest.raises(flexion.CaseError, match=r"arm\.toml:2:"):
        flexion.Case(tmp_path / "arm.toml")
    with pytest.raises(flexion.CaseError, match="missing.toml"):
        flexion.Case(tmp_path / "missing.toml")


@pytest.mark.parametrize(
    ("value", "error"),
    [
        (float("nan"), "no finite number"),
        (float("inf"), "no finite number"),
        (np.array([1.0, np.nan]), "no finite number"),
        (None, "NoneType"),
        (object(), "object"),
        ({1: 2}, "texts"),
        (b"10 m", "bytes"),
        (2**70, "too large"),
        (1 + 2j, "complex"),
        ({"a": {"b": {1, 2}}}, "set"),
    ],
)
def test_what_is_no_value_of_a_case_is_refused_with_its_key(arm: flexion.Case, value: Any, error: str) -> None:
    with pytest.raises((TypeError, ValueError), match="beam.length") as raised:
        arm.with_("beam.length", value)
    assert error in str(raised.value)
    with pytest.raises((TypeError, ValueError)):
        flexion.Case({**ARM, "beam": {"length": value}})


def test_tables_without_end_are_refused() -> None:
    endless: dict[str, Any] = {}
    endless["beam"] = endless
    with pytest.raises(ValueError, match="deeper"):
        flexion.Case(endless)
    listed: list[Any] = []
    listed.append(listed)
    with pytest.raises(ValueError, match="deeper"):
        flexion.Case({"gravity": listed})


@pytest.mark.parametrize("source", [3, None, b"case.toml", ["case.toml"], 1.5])
def test_what_is_no_case_is_refused(source: Any) -> None:
    with pytest.raises(TypeError, match="a case is"):
        flexion.Case(source)


def test_a_key_with_an_equals_sign_changes_nothing_else(arm: flexion.Case) -> None:
    with pytest.raises(ValueError, match="no key"):
        arm.with_("beam.length=3\nrun.duration", 4)
    with pytest.raises(flexion.CaseError):
        arm.with_("beam.nothing", 1)
    with pytest.raises(flexion.CaseError):
        arm.with_("", 1)


def test_check_says_what_a_reader_should_know(arm: flexion.Case) -> None:
    assert arm.check() == ()
    # As the program: modes need no duration.
    assert flexion.Case({k: v for k, v in ARM.items() if k != "run"}).check() == ("a run: not without `run.duration`, which modes do not need",)


def test_many_unknown_keys_are_refused_with_their_lines() -> None:
    with pytest.raises(flexion.CaseError) as refused:
        flexion.Case({f"k{i}": i for i in range(30_000)})
    assert [problem.line for problem in refused.value.problems[:30_000]] == list(range(1, 30_001))


def test_a_value_of_a_result_keeps_its_unit(arm: flexion.Case) -> None:
    assert arm.with_("beam.length", flexion.Value(8.0, unit="m")) == arm.with_("beam.length", "8 m")
    with pytest.raises(flexion.CaseError, match="`s`"):
        arm.with_("beam.length", flexion.Value(8.0, unit="s"))
    least = arm.run(errors="off")["tip.deflection"].min
    assert arm.with_("beam.length", abs(least)) == arm.with_("beam.length", abs(float(least)))
