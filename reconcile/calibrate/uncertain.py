"""Which numbers of a machine specification are uncertain, and machines drawn from that uncertainty."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from signals.series import FloatArray
from sim.core.spec import MachineSpec

SPREAD = 0.10
"""A number off a drawing or a data sheet lies uniformly within this share: the kind's common factor."""
OWN_SPREAD = 0.03
"""What parts of one kind differ among each other beside the common factor."""
DRIFT = 0.15
"""Between two recordings of one machine: share of the spread by which numbers may have moved."""
SUFFIXES = (
    "_n_per_m",
    "_n_per_m15",
    "_nm_per_rad",
    "_ns_per_m",
    "_nms_per_rad",
    "_kg",
    "_kg_m2",
    "damping_ratio",
    "radial_clearance_m",
    "amplitude_m",
    "torque_nm",
    "youngs_modulus_pa",
)
SHARED = ("torque_nm", "youngs_modulus_pa")
"""One factor for all of the machine: the torques stay in balance, mates are of one material."""


@dataclass(frozen=True, kw_only=True)
class Uncertain:
    """A number of the specification: its place in the JSON document, and its kind (field name and part)."""

    path: tuple[str | int, ...]
    kind: str

    @property
    def label(self) -> str:
        """`bearings.0.support.stiffness_x_n_per_m`."""
        return ".".join(str(p) for p in self.path)


def _leaves(node: object, path: tuple[str | int, ...]) -> Iterator[tuple[tuple[str | int, ...], float]]:
    if isinstance(node, Mapping):
        for key, value in node.items():
            yield from _leaves(value, (*path, key))
    elif isinstance(node, list):
        for i, value in enumerate(node):
            yield from _leaves(value, (*path, i))
    elif isinstance(node, float) and node != 0.0 and math.isfinite(node):
        yield path, node


def uncertain_numbers(machine: MachineSpec) -> tuple[Uncertain, ...]:
    """Every stiffness, damping, mass, inertia, clearance, error and torque that is given and not zero."""
    document = machine.model_dump(mode="json")
    found = []
    for part in ("shafts", "gears", "bodies", "meshes", "bearings", "resonators", "loads"):
        for path, _ in _leaves(document[part], (part,)):
            name = str(path[-1])
            if "table" in path or not name.endswith(SUFFIXES):
                continue
            stem = name.replace("_x_", "_").replace("_y_", "_")
            kind = stem if name in SHARED else ".".join([part, *(str(p) for p in path[2:-1]), stem])
            found.append(Uncertain(path=path, kind=kind))
    return tuple(found)


@dataclass(frozen=True, kw_only=True)
class Offsets:
    """Relative deviations, shape (numbers,): the machine's value is nominal * (1 + offset)."""

    values: FloatArray

    def mixed(self, other: Offsets, share: float) -> Offsets:
        """Moved by `share` of another draw: a drift."""
        return Offsets(values=self.values + share * other.values)


def draw_offsets(numbers: Sequence[Uncertain], rng: np.random.Generator, *, spread: float = SPREAD) -> Offsets:
    """One draw: a common factor a kind, and a small one of each part's own."""
    kinds = list(dict.fromkeys(n.kind for n in numbers))
    common = dict(zip(kinds, rng.uniform(-spread, spread, len(kinds)), strict=True))
    own = rng.uniform(-OWN_SPREAD, OWN_SPREAD, len(numbers)) * (spread / SPREAD)
    single = {n.kind for n in numbers if n.kind in SHARED}
    values = [common[n.kind] + (0.0 if n.kind in single else own[i]) for i, n in enumerate(numbers)]
    return Offsets(values=np.array(values))


def moved(machine: MachineSpec, numbers: Sequence[Uncertain], offsets: Offsets) -> MachineSpec:
    """The machine with these relative deviations; a given mesh table is scaled as its gears' modulus would be."""
    document = machine.model_dump(mode="json")
    modulus = 1.0
    for number, offset in zip(numbers, offsets.values, strict=True):
        node: Any = document
        for key in number.path[:-1]:
            node = node[key]
        node[number.path[-1]] *= 1.0 + float(offset)
        if number.kind == "youngs_modulus_pa":
            modulus = 1.0 + float(offset)
    for mesh in document["meshes"]:
        if mesh["table"] is not None:
            rows = mesh["table"]["stiffness_n_per_m"]
            mesh["table"]["stiffness_n_per_m"] = [[k * modulus for k in row] for row in rows]
    return MachineSpec.model_validate(document)
