"""Clearances a bearing of a given size is made and mounted with: beyond them a number is hardly meant."""

from __future__ import annotations

import math

C5_UM = (
    (10.0, 37.0),
    (18.0, 45.0),
    (24.0, 48.0),
    (30.0, 53.0),
    (40.0, 64.0),
    (50.0, 73.0),
    (80.0, 105.0),
    (100.0, 120.0),
)
"""Bore up to (mm) and largest radial internal clearance of class C5 (um): ISO 5753-1, deep-groove ball bearings with
cylindrical bore, as reprinted in makers' catalogues. The reprints at hand misprint the row of 50 to 65 mm: it is judged
by the next one. Larger bores are not judged."""


def largest_internal_clearance_m(bore_m: float) -> float | None:
    """Largest radial internal clearance of any class, m: the ring's whole travel, twice the gap of a centred ball."""
    return next((1e-6 * um for bore_mm, um in C5_UM if bore_m <= 1e-3 * bore_mm), None)


def tolerance_unit_m(diameter_m: float) -> float:
    """Standard tolerance factor i = 0.45 D^(1/3) + 0.001 D, um and mm, up to 500 mm (ISO 286-1:1988, annex A)."""
    mm = 1e3 * diameter_m
    return 1e-6 * (0.45 * math.cbrt(mm) + 0.001 * mm)


def loosest_seat_m(outside_m: float) -> float:
    """Largest radial clearance of a ring in a bore by H11/h11, the coarsest locational fit: IT11 = 100 i each."""
    return 100.0 * tolerance_unit_m(outside_m)
