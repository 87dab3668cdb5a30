"""Fixed limits of velocity, where a recording says that they apply.

ISO 10816-3:2009 "Mechanical vibration - Evaluation of machine vibration by measurements on non-rotating parts - Part 3:
Industrial machines with nominal power above 15 kW and nominal speeds between 120 r/min and 15 000 r/min when measured
in situ", tables A.1 and A.2: RMS velocity at the zone boundaries A/B, B/C and C/D. ISO 20816-3:2022 has replaced it.
Zone C is not fit for long operation (warning), zone D can damage (alarm). The standard's own alarm settings rest on a
machine's baseline (1.25 times zone B's end at most); that part is the rule of `jobs.health.rules`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from jobs.health.words import Severity

SOURCE = "ISO 10816-3:2009, tables A.1 and A.2 (RMS velocity, 10 Hz to 1 kHz)"
LOW_HZ, HIGH_HZ = 10.0, 250.0
"""Shaft speeds for which the band from 10 Hz applies: 600 to 15 000 r/min."""


@dataclass(frozen=True, kw_only=True)
class Zones:
    """RMS velocity at the zone boundaries, m/s."""

    a_b: float
    b_c: float
    c_d: float

    def severity(self, velocity: float) -> Severity | None:
        """Of the zone that a velocity lies in."""
        return "alarm" if velocity > self.c_d else "warning" if velocity > self.b_c else None

    def zone(self, velocity: float) -> str:
        """Its letter."""
        return "ABCD"[(velocity > self.a_b) + (velocity > self.b_c) + (velocity > self.c_d)]


ZONES: Mapping[str, Zones] = {
    "group1-rigid": Zones(a_b=2.3e-3, b_c=4.5e-3, c_d=7.1e-3),
    "group1-flexible": Zones(a_b=3.5e-3, b_c=7.1e-3, c_d=11.0e-3),
    "group2-rigid": Zones(a_b=1.4e-3, b_c=2.8e-3, c_d=4.5e-3),
    "group2-flexible": Zones(a_b=2.3e-3, b_c=4.5e-3, c_d=7.1e-3),
}


def zones_for(vibration_class: str | None, speed_hz: float | None) -> Zones | None:
    """The limits of a recording's class; None where it states none or turns at another speed than they are for."""
    if vibration_class is None or speed_hz is None or not LOW_HZ <= speed_hz <= HIGH_HZ:
        return None
    return ZONES.get(vibration_class)
