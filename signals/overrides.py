"""Changing single values of a machine by name: `fit_clearance@bearing1.gap`, `operating.speed_hz`."""

from __future__ import annotations

import copy
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

from pydantic import ValidationError

from signals.copied import copied
from signals.shorthand import LONG, NAMES, TORQUE, path_of, set_torque
from signals.validation import problems_of, shown
from sim.core.errors import Problem, SpecError
from sim.core.near import did_you_mean, near
from sim.core.spec import MachineSpec

RPM_NAMES = ("rpm", "speed_rpm", "n_rpm", "revolutions", "rev_per_min")
MANY_NAMES = 8
THE_MACHINE = "the machine"
SYNTAX = (
    "`term@site.parameter`, a short name (speed_hz, torque_nm, profile, gravity), "
    "or a dotted path such as `gears.pinion.teeth`"
)
OBJECTS = ("operating.profile",)
"""Parts that a machine may lack and that are made from single values, `profile.kind`, `profile.end_ratio` ..."""


def apply_overrides(machine: MachineSpec, overrides: Mapping[str, object]) -> MachineSpec:
    """Return the machine with each named value changed; every wrong name or value is reported at once.

    A term that the machine does not have yet at that site is added. Items of lists are found by their `name`. A part
    that is an object, or none, takes an object: `{"operating.profile": {"kind": "ramp", "end_ratio": 2, ...}}`.
    """
    if not overrides:
        return machine
    document: dict[str, Any] = copied(machine.model_dump(mode="json"))
    problems = _twice(overrides)
    # The torque comes last: it is that of the driven shaft, which may be changed too.
    for key, value in sorted(overrides.items(), key=lambda item: item[0] in TORQUE):
        problem = _set(document, key, value)
        if problem is not None:
            problems.append(problem)
    with told_by_key(document, overrides):
        try:
            changed = MachineSpec.model_validate(document)
        except ValidationError as error:
            raise SpecError([*problems, *problems_of(error)]) from error
        if problems:
            raise SpecError(problems)
        return changed


def _set(document: dict[str, Any], key: str, value: object) -> Problem | None:
    if key in TORQUE:
        return set_torque(document, key, value)
    return _set_term(document, key, value) if "@" in key else _set_path(document, key, value)


def _twice(overrides: Mapping[str, object]) -> list[Problem]:
    paths = [path_of(key) for key in overrides]
    return [
        Problem(field=f"set.{key}", message=f"is given twice: {key} stands for {path_of(key)}")
        for key in overrides
        if path_of(key) != key and paths.count(path_of(key)) > 1
    ]


@contextmanager
def told_by_key(document: Mapping[str, Any], overrides: Mapping[str, object]) -> Iterator[None]:
    """Problems raised inside name the override that brought them, not the place it has in the machine.

    `document`: the machine with the overrides in it. A problem that no override touches keeps its field.
    """
    try:
        yield
    except SpecError as error:
        places = {place: key for key in overrides for place in _places(document, key)}
        raise SpecError([_renamed(problem, places) for problem in error.problems]) from error


def _renamed(problem: Problem, places: Mapping[str, str]) -> Problem:
    place = problem.field.removeprefix("machine.")
    key, rest = places.get(place), ""
    if key is None:
        # Inside an object that was given whole.
        above = next((p for p in places if place.startswith(f"{p}.")), None)
        if above is None or problem.field.startswith("set."):
            return problem
        key, rest = places[above], place.removeprefix(above)
    hint = did_you_mean(problem.given, problem.allowed.split(", ")) if isinstance(problem.given, str) else ""
    return replace(problem, field=f"set.{key}{rest}", message=problem.message + hint)


def _places(document: Mapping[str, Any], key: str) -> Iterator[str]:
    """Fields by which validation and assembly may call what `key` names: by number, and by name."""
    if key in TORQUE:
        torques = [i for i, load in enumerate(document["loads"]) if load["kind"] == "torque"]
        yield from (f"loads.{i}.torque_nm" for i in torques)
        return
    if "@" not in key:
        path = path_of(key)
        yield path
        yield ".".join(_numbered(document, path.split(".")))
        return
    term, _, place = key.partition("@")
    site, _, parameter = place.partition(".")
    for i, spec in enumerate(document["terms"]):
        if spec["term"] == term and spec["site"] == site:
            yield f"terms.{i}.parameters.{parameter}"
            # Of a term's name and site only what was given here can be wrong: presets are checked.
            yield from (f"terms.{i}.term", f"terms.{i}.site", f"terms.{i}")


def _numbered(node: Any, parts: list[str]) -> list[str]:  # noqa: ANN401 - a JSON document
    if not parts:
        return []
    if isinstance(node, list):
        names = [item.get("name") for item in node]
        if parts[0] not in names:
            return parts
        at = names.index(parts[0])
        return [str(at), *_numbered(node[at], parts[1:])]
    child = node.get(parts[0]) if isinstance(node, dict) else None
    return [parts[0], *_numbered(child, parts[1:])]


def _set_term(document: dict[str, Any], key: str, value: object) -> Problem | None:
    term, _, place = key.partition("@")
    site, _, parameter = place.partition(".")
    if not (term and site and parameter):
        return Problem(field=f"set.{key}", message="is not a parameter of a term", given=key, allowed=SYNTAX)
    if isinstance(value, bool) or not isinstance(value, int | float):
        number = "a finite number"
        allowed = number if parameter != "law" else f"{number}: of a law in the machine file's `custom_laws`"
        return Problem(field=f"set.{key}", message="must be a number", given=shown(value), allowed=allowed)
    terms: list[dict[str, Any]] = document["terms"]
    for spec in terms:
        if spec["term"] == term and spec["site"] == site:
            spec["parameters"][parameter] = value
            return None
    terms.append({"term": term, "site": site, "parameters": {parameter: value}})
    return None


def _set_path(document: dict[str, Any], key: str, value: object) -> Problem | None:
    node: Any = document
    parts = path_of(key).split(".")
    for depth, part in enumerate(parts):
        if ".".join(parts[:depth]) in OBJECTS and isinstance(node, dict):
            node.setdefault(part, None)
        names = _names(node)
        if part not in names:
            whole = [".".join([*parts[:depth], path]) for path in _near(node, part)]
            return _unknown(key, value, part, ".".join(parts[:depth]) or THE_MACHINE, names, whole)
        if depth == len(parts) - 1:
            break
        if isinstance(node, dict) and node[part] is None and ".".join(parts[: depth + 1]) in OBJECTS:
            node[part] = {}
        node = node[part] if isinstance(node, dict) else next(item for item in node if item.get("name") == part)
    if not isinstance(node, dict) or not _fits(node[parts[-1]], value):
        message = "names a part, not a single value"
        return Problem(field=f"set.{key}", message=message, given=shown(value), allowed=SYNTAX)
    node[parts[-1]] = copy.deepcopy(value)
    return None


def _fits(present: object, value: object) -> bool:
    """Lists of parts stay; an object takes an object or nothing."""
    return not isinstance(present, list | dict) or (
        isinstance(present, dict) and (value is None or isinstance(value, Mapping))
    )


def _names(node: object) -> list[str]:
    if isinstance(node, dict):
        return list(node)
    return [item["name"] for item in _named(node)]


def _named(node: object) -> list[dict[str, Any]]:
    return [i for i in node if isinstance(i, dict) and "name" in i] if isinstance(node, list) else []


def _near(node: object, part: str) -> list[str]:
    """Paths below `node` whose last name is like `part`; the likeliest first, at most three."""
    leaves = list(_leaves(node))
    names = {path.rsplit(".", 1)[-1] for path in leaves} | set(_names(node))
    close = near(part, sorted(names), most=2)
    close += [name for name in sorted(names) if name.startswith(f"{part}_") and name not in close]
    by_name = [path for name in close for path in (*_names(node), *leaves) if path.rsplit(".", 1)[-1] == name]
    return list(dict.fromkeys(by_name))[:3]


def _leaves(node: object, path: str = "") -> Iterator[str]:
    if isinstance(node, dict | list):
        items = node.items() if isinstance(node, dict) else zip(_names(node), _named(node), strict=True)
        for name, item in items:
            yield from _leaves(item, f"{path}.{name}" if path else name)
    elif path:
        yield path


def _unknown(key: str, value: object, part: str, where: str, names: list[str], paths: list[str]) -> Problem:
    paths = [LONG.get(path, path) for path in paths]
    if where == THE_MACHINE:
        paths += [n for n in near(part, NAMES, most=1, like=0.7) if n not in paths]
    hint = f" (did you mean {' or '.join(paths)}?)" if paths else ""
    if part.lower() in RPM_NAMES:
        hertz = f"={value / 60:g}" if isinstance(value, int | float) and not isinstance(value, bool) else ""
        hint = f" (speeds are given in Hz, rpm / 60: speed_hz{hertz})"
    # A dozen names of which one is suggested already would hide the suggestion.
    allowed = SYNTAX if hint and len(names) > MANY_NAMES else ", ".join(names) or SYNTAX
    return Problem(field=f"set.{key}", message=f"{where} has no {part!r}{hint}", given=shown(value), allowed=allowed)
