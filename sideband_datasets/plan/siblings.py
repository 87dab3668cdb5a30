"""What of a recipe would make siblings differ by more than the fault, or levels mean nothing."""

from __future__ import annotations

from collections.abc import Iterator

from sideband_datasets.recipe.model import Recipe
from sim.core.errors import Problem

SCALED = ("accelerometer", "tacho")
"""Sensors of a chain whose numbers may be multiples of a level of acceleration, and those without such numbers."""


def beside_problems(recipe: Recipe) -> Iterator[Problem]:
    """Problems of `siblings`, `shown_db` and `background.chain_in_levels`."""
    if recipe.siblings:
        yield from _siblings(recipe)
    if recipe.background is not None and recipe.background.chain_in_levels:
        yield from _in_levels(recipe)


def _siblings(recipe: Recipe) -> Iterator[Problem]:
    every = {
        "speeds_hz": recipe.speeds_hz is not None,
        "torques_nm": recipe.torques_nm is not None,
        "conditions": bool(recipe.conditions),
        **{f"measurement.{k}.each": bool(chain.each) for k, chain in enumerate(recipe.measurement)},
    }
    for field, given in every.items():
        if given:
            message = "is drawn for every recording; `siblings` differ by the fault alone"
            yield Problem(field=field, message=message, allowed="the same in `machines.vary` or `measurement.vary`")
    uneven = recipe.healthy_share is not None or len({fault.weight for fault in recipe.faults}) > 1
    if uneven:
        field = "healthy_share" if recipe.healthy_share is not None else "faults"
        message = "gives classes different shares; `siblings` has one recording of each class and machine"
        yield Problem(field=field, message=message, allowed="classes of one weight, no `healthy_share`")


def _in_levels(recipe: Recipe) -> Iterator[Problem]:
    if not recipe.measurement:
        message = "needs a measurement chain whose numbers it scales"
        yield Problem(field="background.chain_in_levels", message=message, allowed="`measurement`, or false")
    for k, measurement in enumerate(recipe.measurement):
        channels = measurement.chain.get("channels")
        for c, channel in enumerate(channels if isinstance(channels, list) else ()):
            kind = channel.get("kind") if isinstance(channel, dict) else None
            if kind not in SCALED:
                message = "cannot be in levels of acceleration (`background.chain_in_levels`)"
                field = f"measurement.{k}.chain.channels.{c}.kind"
                yield Problem(field=field, message=message, given=kind, allowed=" or ".join(SCALED))
