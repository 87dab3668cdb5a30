"""What a dataset is to be made of: machines, faults, operating points, measurement, windows, plan, splits."""

from sideband_datasets.recipe.model import FaultClass, FaultTerm, Machines, Measurement, Peaks, Recipe, Windows
from sideband_datasets.recipe.ready import RECIPES, recipe_named
from sideband_datasets.recipe.values import Choice, Factor, Range, Value

__all__ = [
    "RECIPES",
    "Choice",
    "Factor",
    "FaultClass",
    "FaultTerm",
    "Machines",
    "Measurement",
    "Peaks",
    "Range",
    "Recipe",
    "Value",
    "Windows",
    "recipe_named",
]
