"""Values inside JSON documents by path: `bearings.bearing1.balls`, `channels.*.noise.corner_hz`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from sim.core.errors import Problem, SpecError
from sim.core.near import did_you_mean
from sim.core.spec import MachineSpec


def own_value(machine: MachineSpec, key: str) -> object:
    """What a machine has under the name of a change; None where it has nothing there."""
    return value_in(machine.model_dump(mode="json"), key)


def value_in(document: Mapping[str, Any], key: str) -> object:
    """`own_value` of a machine's description as JSON."""
    if "@" in key:
        term, _, place = key.partition("@")
        site, _, parameter = place.partition(".")
        found = [t for t in document["terms"] if t["term"] == term and t["site"] == site]
        return found[0]["parameters"].get(parameter) if found else None
    node: Any = document
    for part in key.split("."):
        if isinstance(node, list):
            node = next((item for item in node if item.get("name") == part), None)
        else:
            node = node.get(part) if isinstance(node, Mapping) else None
    return node


def _below(node: Any, part: str) -> list[Any]:  # noqa: ANN401 - a JSON document
    """Children that a part of a path names: all for `*`, by number or name in lists."""
    if isinstance(node, list):
        if part == "*":
            return list(node)
        if part.isdigit():
            return node[int(part) : int(part) + 1]
        return [item for item in node if isinstance(item, dict) and item.get("name") == part]
    return [node[part]] if isinstance(node, dict) and part in node else []


def _names(node: Any) -> list[str]:  # noqa: ANN401 - a JSON document
    if isinstance(node, list):
        return ["*", *(str(item["name"]) for item in node if isinstance(item, dict) and "name" in item)]
    return list(node) if isinstance(node, dict) else []


def holders(document: object, path: str, field: str) -> Iterator[tuple[dict[str, Any], str]]:
    """Every object that holds the last name of a path, with that name; SpecError names the part that is not there."""
    nodes: list[Any] = [document]
    parts = path.split(".")
    for part in parts[:-1]:
        below = [child for node in nodes for child in _below(node, part) if child is not None]
        if not below:
            known = _names(nodes[0])
            hint = " (it is null: give it in the chain)" if part in known else did_you_mean(part, known)
            message = f"has no {part!r} on the way to {path!r}{hint}"
            raise SpecError(Problem(field=field, message=message, given=path, allowed=", ".join(known)))
        nodes = below
    for node in nodes:
        if not isinstance(node, dict):
            raise SpecError(Problem(field=field, message="names a part, not a single value", given=path))
        yield node, parts[-1]
