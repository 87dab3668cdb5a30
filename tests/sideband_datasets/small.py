"""Small recipes for tests."""

from __future__ import annotations

from copy import deepcopy
from typing import Any

from sideband_datasets import Recipe, read_recipe

OUTER = {"term": "outer_spall", "parameters": {"width": {"low": 5e-4, "high": 3e-3, "scale": "log"}}}
DOCUMENT: dict[str, Any] = {
    "name": "tiny",
    "seed": 3,
    "count": 12,
    "machines": [
        {
            "name": "rotor",
            "preset": "rotor",
            "instances": 4,
            "vary": {"bearings.bearing1.support.stiffness_y_n_per_m": {"factor": [0.5, 2.0]}},
        }
    ],
    "faults": [
        {"name": "outer", "terms": [OUTER]},
        {"name": "both", "terms": [OUTER, {"term": "unbalance", "sites": ["disc"]}]},
    ],
    "speeds_hz": {"low": 25, "high": 40},
    "measurement": [
        {
            "name": "stud",
            "chain": {
                "channels": [
                    {
                        "name": "de",
                        "kind": "accelerometer",
                        "preset": "icp-100mv-g",
                        "place": {"location": "bearing1.outer"},
                    },
                    {"name": "nde", "kind": "accelerometer", "place": {"location": "bearing2.outer"}},
                ]
            },
            "each": {"channels.de.noise.density_per_sqrt_hz": {"low": 5e-5, "high": 5e-3, "scale": "log"}},
        }
    ],
    "sampling_rate_hz": 8000,
    "duration_s": 0.1,
    "settle_s": 0.05,
    "windows": {"per_recording": 2, "length_s": 0.04},
    "splits": {"train": 0.5, "test": 0.5},
}


def document(**changes: object) -> dict[str, Any]:
    """The tiny recipe's document with top-level changes."""
    return {**deepcopy(DOCUMENT), **changes}


def tiny(**changes: object) -> Recipe:
    """The tiny recipe, changed."""
    return read_recipe(document(**changes))
