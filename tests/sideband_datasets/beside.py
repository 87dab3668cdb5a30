"""Small recipes of recordings beside those of the same machine without the fault."""

from __future__ import annotations

from typing import Any

from sideband_datasets import Recipe, read_recipe
from tests.sideband_datasets.small import document

EVERY: dict[str, Any] = {"rolling": {}, "knocks": {"share": 1.0}, "neighbours": {"share": 1.0}, "free_axis": {}}
SPEED = {"low": 25, "high": 40}


def siblings(**changes: object) -> Recipe:
    """Four machines recorded sound, with an outer and with a ball's spall; a background unless it is changed."""
    found = document()
    found["machines"][0]["vary"]["operating.speed_hz"] = SPEED
    found["measurement"][0]["each"] = {}
    found["faults"][1] = {"name": "ball", "terms": [{"term": "ball_spall"}]}
    del found["speeds_hz"]
    return read_recipe({**found, "siblings": True, "background": EVERY, "peaks": {"spectra": []}, **changes})
