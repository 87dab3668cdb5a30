"""What makes two machines one machine, and two transfer paths one path: hashes that splits are kept apart by."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Mapping
from typing import Any

from sideband_datasets.plan.documents import holders
from signals.shorthand import path_of
from sim.core.errors import SpecError
from sim.core.spec import MachineSpec
from sim.terms import REGISTRY

NOT_BUILT_IN = ("schema_version", "name", "notes", "operating", "loads", "gravity_m_per_s2")
"""Of a machine's description, what is no property of the machine: words, how it is run, what acts from outside.

Loads are left out like the speed: a torque, a force or a measured input is applied to a machine, and the same one under
another load is heard with the same resonances. What a classifier could know it by would stand in both splits.
"""


def hashed(document: object) -> str:
    """A short hash of a JSON document."""
    text = json.dumps(document, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def content_of(spec: MachineSpec, conditions: Iterable[str]) -> str:
    """Hash of what a machine is built of. `conditions`: names of values that are drawn anew for every recording; they
    replace the machine's own, so they cannot tell it from another.
    """
    document = spec.model_dump(mode="json")
    for key in NOT_BUILT_IN:
        document.pop(key, None)
    for key in conditions:
        _without(document, path_of(key))
    document["terms"] = sorted((t for t in document["terms"] if not _nothing(t)), key=hashed)
    return hashed(document)


def _nothing(term: Mapping[str, Any]) -> bool:
    """Whether an effect is of the size at which it changes nothing."""
    known = REGISTRY.get(term["term"])
    if known is None or known.severity is None or not known.zero_is_healthy:
        return False
    default = next(p.default for p in known.params if p.name == known.severity)
    return bool(term["parameters"].get(known.severity, default) == 0)


def _without(document: dict[str, Any], key: str) -> None:
    """Take the value of a name out; names that lead nowhere are told where the machine is put at its point."""
    if "@" in key:
        term, _, place = key.partition("@")
        site, _, parameter = place.partition(".")
        for found in document["terms"]:
            if found["term"] == term and found["site"] == site:
                found["parameters"].pop(parameter, None)
        return
    try:
        for holder, name in holders(document, key, "conditions"):
            holder.pop(name, None)
    except SpecError:
        return


def channel_paths(chain: Mapping[str, Any] | None) -> dict[str, str]:
    """Hash of the transfer path of every channel that has one, by the name of the channel.

    A channel without one sees the machine directly: its path is the machine's own, and goes where that goes.
    """
    channels = chain["channels"] if chain is not None else []
    return {channel["name"]: hashed(channel["path"]) for channel in channels if channel.get("path")}


def path_id_of(machine_id: str, chain: Mapping[str, Any] | None) -> str:
    """One hash for the transfer paths of all channels; without any the path is the machine's own."""
    paths = [c.get("path") for c in chain["channels"]] if chain is not None else []
    return hashed(paths if any(paths) else machine_id)
