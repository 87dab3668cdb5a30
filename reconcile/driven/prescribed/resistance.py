"""Resistance to a prescribed motion: a linear law and one of several with or without memory.

The path with memory is, from the moving part to the ground: play of width `backlash` (in which a weak spring `slack`
acts), a spring `elastic`, and a slider that gives way at the friction. The stretch d of play and spring follows the
motion and is held where the slider slips: d += dx, clipped to the stretch at which the force is the friction. Without
play it is what the literature calls Jenkins' element.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from reconcile.driven.channels import FloatArray
from sim.core.compiled import jit

LINEAR = ("stiffness", "damping", "offset")
GRADES = (1.0, 0.5, 0.25, 0.12, 0.05)
"""Stretches at which the parts of a friction that sets in gradually slip, over the longest of them."""


@dataclass(frozen=True, kw_only=True)
class Structure:
    """Which parts are there: `names` are its parameters beyond the linear ones."""

    key: str
    words: str
    names: tuple[str, ...]


NONE = Structure(key="linear", words="spring and damper", names=())
DRY = Structure(key="dry_friction", words="dry friction", names=("friction", "speed"))
"""`speed`: at which it is developed."""
ELASTIC = Structure(
    key="elastic_friction", words="friction behind a spring", names=("friction", "elastic", "asymmetry")
)
PLAY = Structure(
    key="backlash_friction",
    words="backlash in series with friction",
    names=("friction", "elastic", "asymmetry", "backlash", "slack"),
)
DRAG = Structure(key="drag", words="quadratic damping", names=("drag",))
CUBIC = Structure(key="cubic", words="cubic stiffness", names=("cubic",))
STOPS = Structure(key="stops", words="stops behind gaps", names=("contact", "gap_up", "gap_down"))
GRADUAL = Structure(
    key="gradual_friction",
    words="friction that sets in gradually",
    names=("reach", *(f"grade_{k}" for k in range(1, len(GRADES) + 1))),
)
"""Several sliders behind springs of their own (Iwan's model): tells the picture, not a mechanism."""
STRUCTURES = (DRAG, CUBIC, DRY, ELASTIC, STOPS, PLAY, GRADUAL)
"""The simplest first."""
HOLDS = {
    ELASTIC.key: (DRY.key,), PLAY.key: (DRY.key, ELASTIC.key, STOPS.key), GRADUAL.key: (DRY.key, ELASTIC.key),
}  # fmt: skip
"""Structures that another one holds as special cases, nearly or exactly."""
UNITS = {
    "stiffness": "N/m", "damping": "N*s/m", "offset": "N", "friction": "N", "elastic": "N/m", "asymmetry": "1",
    "backlash": "m", "slack": "N/m", "drag": "N/(m/s)^2", "cubic": "N/m^3", "speed": "m/s", "contact": "N/m",
    "gap_up": "m", "gap_down": "m", "reach": "m", **dict.fromkeys(GRADUAL.names[1:], "N"),
}  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Motion:
    """Prescribed displacement m with its velocity m/s, (n,) each."""

    displacement: FloatArray
    velocity: FloatArray
    step_s: float

    def part(self, first: int, last: int) -> Motion:
        """Samples first <= i < last."""
        return replace(self, displacement=self.displacement[first:last], velocity=self.velocity[first:last])


@jit
def _follow(x, friction_up, friction_down, elastic, backlash, slack, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN202
    half = 0.5 * backlash
    high = half + (friction_up - slack * half) / elastic
    low = -half - (friction_down - slack * half) / elastic
    d = 0.0
    for i in range(x.size):
        if i > 0:
            d = min(max(d + x[i] - x[i - 1], low), high)
        inside = min(max(d, -half), half)
        out[i] = elastic * (d - inside) + slack * inside


def path_force(values: dict[str, float], motion: Motion) -> FloatArray:
    """Force of the path with memory, N, (n,)."""
    friction, lean = values["friction"], values["asymmetry"]
    backlash = values.get("backlash", 0.0)
    slack = min(values.get("slack", 0.0), 0.9 * friction * (1 - abs(lean)) / max(0.5 * backlash, 1e-12))
    out = np.empty(motion.displacement.size)
    x = np.ascontiguousarray(motion.displacement)
    _follow(x, friction * (1 + lean), friction * (1 - lean), values["elastic"], backlash, slack, out)
    return out


def paths(values: Mapping[str, float]) -> list[dict[str, float]]:
    """The paths with memory of a resistance, each with its own friction, spring and play."""
    if "elastic" in values:
        return [dict(values)]
    if "reach" not in values:
        return []
    forces = [(values[name], share) for name, share in zip(GRADUAL.names[1:], GRADES, strict=True)]
    return [
        {"friction": f, "elastic": f / (share * values["reach"]), "asymmetry": 0.0} for f, share in forces if f > 0.0
    ]


def resistance(structure: Structure, values: dict[str, float], motion: Motion) -> FloatArray:
    """Force that resists the motion, N, (n,)."""
    x, v = motion.displacement, motion.velocity
    force = values["stiffness"] * x + values["damping"] * v + values["offset"]
    if structure.key == DRY.key:
        force = force + values["friction"] * np.clip(v / values["speed"], -1.0, 1.0)
    elif structure.key == DRAG.key:
        force = force + values["drag"] * v * np.abs(v)
    elif structure.key == CUBIC.key:
        force = force + values["cubic"] * x**3
    elif structure.key == STOPS.key:
        beyond = np.maximum(x - values["gap_up"], 0.0) + np.minimum(x + values["gap_down"], 0.0)
        force = force + values["contact"] * beyond
    for path in paths(values):
        force = force + path_force(path, motion)
    return np.asarray(force)


def travel_to(values: dict[str, float], share: float) -> float:
    """Travel after a reversal until the force on the other side is `share` of its friction, m (slack neglected)."""
    friction, elastic = values["friction"], values["elastic"]
    return values.get("backlash", 0.0) + (1.0 + share) * friction / elastic
