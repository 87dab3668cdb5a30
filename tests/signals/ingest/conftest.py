"""A short recording, its description, and a door into the parser."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from signals.ingest import Bounds, Ingested, parse, read_description

RATE = 1000.0
Read = Callable[..., Ingested]


@pytest.fixture
def described() -> dict[str, Any]:
    """Two channels in g."""
    return {
        "sampling_rate_hz": RATE,
        "channels": [
            {"name": "a", "quantity": "acceleration", "unit": "g", "location": "bearing1", "axis": "x"},
            {"name": "b", "quantity": "acceleration", "unit": "m/s^2", "location": "bearing1", "axis": "y"},
        ],
        "operating": {"shaft": "input", "speed_hz": 25, "torque_nm": 3},
        "condition": "baseline",
        "notes": "test",
    }


@pytest.fixture
def read(described: dict[str, Any]) -> Read:
    """Parse a file under the description, changed as given."""

    def door(path: Path, bounds: Bounds | None = None, **changes: Any) -> Ingested:
        document = {k: v for k, v in {**described, **changes}.items() if v is not ...}
        return parse(read_description(document), path, bounds)

    return door
