"""Where a flexible shaft has nodes: its ends, changes of section, everything seated on it, and points between."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import accumulate, pairwise

from sim.core.spec import ShaftSpec
from sim.parts.shaft.section import Section, section

MERGED_M = 1e-6
"""Places nearer than this are one node."""


@dataclass(frozen=True, kw_only=True)
class ShaftNodes:
    """Places of the nodes, m from the shaft's start, and the section of each element between two of them."""

    places_m: tuple[float, ...]
    sections: tuple[Section, ...]

    def nearest(self, place_m: float) -> int:
        """Index of the node at a place."""
        return min(range(len(self.places_m)), key=lambda i: abs(self.places_m[i] - place_m))


def shaft_length_m(shaft: ShaftSpec) -> float:
    """Length of a flexible shaft, m."""
    return math.fsum(s.length_m for s in shaft.segments)


def shaft_nodes(shaft: ShaftSpec) -> ShaftNodes:
    """Nodes of a flexible shaft; seats lie on it (checked at assembly)."""
    ends = [0.0, *accumulate(s.length_m for s in shaft.segments)]
    places: list[float] = []
    for place in sorted([*ends, *shaft.seats.values()]):
        if not places or place - places[-1] > MERGED_M:
            places.append(place)
    finer = [places[0]]
    for low, high in pairwise(places):
        count = 1 if shaft.longest_element_m is None else math.ceil((high - low) / shaft.longest_element_m - 1e-9)
        finer += [low + (high - low) * k / count for k in range(1, count)] + [high]
    sections = []
    for low, high in pairwise(finer):
        middle = 0.5 * (low + high)
        k = next((i for i, end in enumerate(ends[1:]) if middle < end), len(shaft.segments) - 1)
        sections.append(section(shaft.segments[k]))
    return ShaftNodes(places_m=tuple(finer), sections=tuple(sections))


def torsional_stiffness_nm_per_rad(nodes: ShaftNodes, from_m: float, to_m: float) -> float:
    """1 / sum(L / (G J)) between two places, N m/rad."""
    low, high = sorted((from_m, to_m))
    compliance = 0.0
    for (a, b), s in zip(pairwise(nodes.places_m), nodes.sections, strict=True):
        compliance += max(0.0, min(b, high) - max(a, low)) / s.torsion_nm2
    return 1.0 / compliance
