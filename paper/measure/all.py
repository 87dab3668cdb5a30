"""Every measure of a run as one flat table."""

from __future__ import annotations

from paper.measure.mean import PairLaw
from paper.measure.mesh import motion_numbers, stiffness_numbers
from paper.measure.sensor import acceleration_numbers, displacement_numbers, orbit_numbers
from paper.measure.window import Window


def measures(window: Window, law: PairLaw | None) -> dict[str, float]:
    """Numbers by name, SI."""
    return (
        stiffness_numbers(window, law)
        | motion_numbers(window, "a")
        | motion_numbers(window, "theta")
        | displacement_numbers(window)
        | acceleration_numbers(window)
        | orbit_numbers(window)
    )
