"""Ready recipes."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from importlib.resources import files

from sideband_datasets.recipe.bearings import MACHINES, SHARE_FAST, bearings_recipe
from sideband_datasets.recipe.model import Recipe
from sideband_datasets.recipe.read import read_recipe
from sim.core.errors import UnknownName


@dataclass(frozen=True, kw_only=True)
class Ready:
    """Name of a recipe, the sentence that explains it, and what builds it; none: `recipes/NAME.json` beside this."""

    name: str
    sentence: str
    build: Callable[[], Recipe] | None = None

    def read(self) -> Recipe:
        """The recipe."""
        if self.build is not None:
            return self.build()
        text = files("sideband_datasets.recipe").joinpath("recipes", f"{self.name}.json").read_text(encoding="utf-8")
        return read_recipe(json.loads(text))


RECIPES: Mapping[str, Ready] = {
    ready.name: ready
    for ready in (
        Ready(
            name="bearing-rig",
            sentence="Motor shaft on two ball bearings: healthy, outer, inner, ball; no background.",
        ),
        Ready(
            name="gearbox",
            sentence="The paper's gearbox: healthy, loose fit, crack, broken tooth, unbalance, spall with crack.",
        ),
        Ready(
            name="two-stage",
            sentence="A two-stage gearbox, two sensors: healthy, crack, broken tooth, outer race, in either stage.",
        ),
        Ready(name="overhung", sentence="An overhung pinion: healthy, crack, unbalance, outer race beside it."),
        Ready(
            name="bearings-fast",
            sentence="Bearing machines of all kinds at 22 to 62 Hz, with a background: what `classify` learns from.",
            build=partial(bearings_recipe, round(MACHINES * SHARE_FAST), fast=True),
        ),
        Ready(
            name="bearings-slow",
            sentence="The same at 9 to 22 Hz; the two belong together.",
            build=partial(bearings_recipe, round(MACHINES * (1 - SHARE_FAST)), fast=False),
        ),
        Ready(name="small", sentence="Sixteen short recordings (32 rows) of the smallest rotor: to try the doors."),
    )
}


def recipe_named(name: str) -> Recipe:
    """A ready recipe; UnknownName lists what exists."""
    if name not in RECIPES:
        raise UnknownName("recipe", name, tuple(RECIPES))
    return RECIPES[name].read()
