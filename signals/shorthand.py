"""Short names of what is changed most often. HTTP, command line and client know the same ones."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from sim.core.errors import Problem

SHORT: Mapping[str, str] = {
    "speed_hz": "operating.speed_hz",
    "profile": "operating.profile",
    "gravity": "gravity_m_per_s2",
}
"""Short name to the path it stands for."""
LONG: Mapping[str, str] = {path: name for name, path in SHORT.items()}
TORQUE = ("torque_nm", "torque")
"""Torque of the driven shaft; the second is the older name."""
NAMES = (*SHORT, *TORQUE)


def path_of(key: str) -> str:
    """What a key stands for: `speed_hz` is `operating.speed_hz`, `profile.kind` is `operating.profile.kind`."""
    if key in TORQUE:
        return TORQUE[0]
    head, dot, rest = key.partition(".")
    return f"{SHORT.get(head, head)}{dot}{rest}"


def set_torque(document: dict[str, Any], key: str, value: object) -> Problem | None:
    """Torque of the driven shaft; torques given at other shafts are scaled with it, so that the balance stays."""
    field = f"set.{key}"
    if isinstance(value, bool) or not isinstance(value, int | float):
        return Problem(field=field, message="must be a number", given=value, allowed="a finite number", unit="N m")
    shaft = (document.get("operating") or {}).get("shaft")
    loads = [load for load in document["loads"] if load["kind"] == "torque"]
    driven = [load for load in loads if load["shaft"] == shaft]
    if shaft is None or len(driven) != 1 or driven[0]["torque_nm"] == 0:
        message = "needs a machine with one torque, not zero, on its driven shaft"
        return Problem(field=field, message=message, given=value, allowed="a path such as `operating.speed_hz`")
    factor = value / driven[0]["torque_nm"]
    for load in loads:
        load["torque_nm"] = value if load["shaft"] == shaft else load["torque_nm"] * factor
    return None
