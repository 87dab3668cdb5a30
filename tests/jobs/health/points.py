"""Points of an imagined machine."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from jobs.health.points import ChannelPoint, Operating, Point
from jobs.health.words import CONDITION_VERSION


def point(
    name: str,
    features: Mapping[str, float | None],
    *,
    baseline: bool = False,
    speed_hz: float | None = 25.0,
    torque_nm: float | None = None,
    findings: Sequence[Mapping[str, Any]] = (),
    **changes: Any,
) -> Point:
    """A recording with one acceleration channel `de`."""
    unit = changes.pop("unit", "m/s^2")
    channel = ChannelPoint(quantity="acceleration", unit=unit, location="bearing1", axis="y", features=features)
    whole: dict[str, Any] = {
        "recording": name,
        "name": f"{name}.npz",
        "time": 0.0,
        "time_stated": True,
        "baseline": baseline,
        "vibration_class": None,
        "version": CONDITION_VERSION,
        "sampling_rate_hz": 20_000.0,
        "duration_s": 10.0,
        "operating": None
        if speed_hz is None
        else Operating(shaft="shaft", speed_hz=speed_hz, torque_nm=torque_nm, speed_from="stated"),
        "channels": {"de": channel},
        "findings": tuple(findings),
        "reasons": (),
    }
    return Point(**{**whole, **changes})


def sound_points(count: int = 12, seed: int = 0, **changes: Any) -> list[Point]:
    """Baselines: 0.3 dB of spread about 1."""
    rng = np.random.default_rng(seed)
    return [
        point(
            f"b{i}",
            {"rms": 10 ** (rng.normal(0, 0.3) / 20), "bearing1.outer": 0.1 * 10 ** (rng.normal(0, 0.3) / 20)},
            baseline=True,
            **changes,
        )
        for i in range(count)
    ]
