"""Datasets to train classifiers on: planned, labelled, without leaks between splits, every row reproducible alone."""

from sideband_datasets.make import Failure, rows
from sideband_datasets.plan import make_plan
from sideband_datasets.recipe import Recipe, recipe_named
from sideband_datasets.recipe.read import read_recipe
from sideband_datasets.row import COLUMNS, Peak, Row

__all__ = ["COLUMNS", "Failure", "Peak", "Recipe", "Row", "make_plan", "read_recipe", "recipe_named", "rows"]
