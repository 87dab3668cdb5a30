"""Changing single values of a machine by name: `fit_clearance@bearing1.gap`, `operating.speed_hz`."""

from __future__ import annotations

import copy
import difflib
from collections.abc import Mapping
from typing import Any

from pydantic import ValidationError

from jobs.validation import problems_of
from sim.core.errors import Problem, SpecError
from sim.core.spec import MachineSpec

SYNTAX = "`term@site.parameter`, or a dotted path into the machine such as `operating.speed_hz`"


def apply_overrides(machine: MachineSpec, overrides: Mapping[str, object]) -> MachineSpec:
    """Return the machine with each named value changed; every wrong name or value is reported at once.

    A term that the machine does not have yet at that site is added. Items of lists are found by their `name`.
    """
    if not overrides:
        return machine
    document: dict[str, Any] = copy.deepcopy(machine.model_dump(mode="json"))
    problems: list[Problem] = []
    for key, value in overrides.items():
        problem = _set_term(document, key, value) if "@" in key else _set_path(document, key, value)
        if problem is not None:
            problems.append(problem)
    if problems:
        raise SpecError(problems)
    try:
        return MachineSpec.model_validate(document)
    except ValidationError as error:
        raise SpecError(problems_of(error, prefix="set")) from error


def _set_term(document: dict[str, Any], key: str, value: object) -> Problem | None:
    term, _, place = key.partition("@")
    site, _, parameter = place.partition(".")
    if not (term and site and parameter):
        return Problem(field=f"set.{key}", message="is not a parameter of a term", given=key, allowed=SYNTAX)
    if isinstance(value, bool) or not isinstance(value, int | float):
        return Problem(field=f"set.{key}", message="must be a number", given=value, allowed="a finite number")
    terms: list[dict[str, Any]] = document["terms"]
    for spec in terms:
        if spec["term"] == term and spec["site"] == site:
            spec["parameters"][parameter] = value
            return None
    terms.append({"term": term, "site": site, "parameters": {parameter: value}})
    return None


def _set_path(document: dict[str, Any], key: str, value: object) -> Problem | None:
    node: Any = document
    parts = key.split(".")
    for depth, part in enumerate(parts):
        names = _names(node)
        if part not in names:
            return _unknown(key, part, ".".join(parts[:depth]) or "the machine", names)
        if depth == len(parts) - 1:
            break
        node = node[part] if isinstance(node, dict) else next(item for item in node if item.get("name") == part)
    if not isinstance(node, dict) or isinstance(node[parts[-1]], list | dict):
        return Problem(field=f"set.{key}", message="names a part, not a single value", given=key, allowed=SYNTAX)
    node[parts[-1]] = value
    return None


def _names(node: object) -> list[str]:
    if isinstance(node, dict):
        return list(node)
    if isinstance(node, list):
        return [item["name"] for item in node if isinstance(item, dict) and "name" in item]
    return []


def _unknown(key: str, part: str, where: str, names: list[str]) -> Problem:
    close = difflib.get_close_matches(part, names, n=1)
    hint = f" (did you mean {close[0]!r}?)" if close else ""
    allowed = ", ".join(names) or SYNTAX
    return Problem(field=f"set.{key}", message=f"{where} has no {part!r}{hint}", given=key, allowed=allowed)
