"""A recipe from a JSON document: every wrong field told at once, with the names that may have been meant."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import replace

from pydantic import ValidationError

from sideband_datasets.recipe.model import Recipe
from sideband_datasets.recipe.values import TAGS
from signals.validation import problems_of
from sim.core.errors import Problem, SpecError


def read_recipe(document: object) -> Recipe:
    """The recipe; SpecError lists every field that must change."""
    if not isinstance(document, Mapping):
        raise SpecError(Problem(field="recipe", message="is not an object", allowed="a JSON object"))
    try:
        # Through text, so that lists and numbers are taken as JSON has them.
        return Recipe.model_validate_json(json.dumps(document, allow_nan=False))
    except ValidationError as error:
        raise SpecError([_plain(problem) for problem in problems_of(error, model=Recipe)]) from error
    except (TypeError, ValueError) as error:
        raise SpecError(Problem(field="recipe", message=f"is not JSON: {error}")) from error


def _plain(problem: Problem) -> Problem:
    """Without the kinds that validation puts behind a value of several kinds."""
    parts = problem.field.split(".")
    return replace(problem, field=".".join(p for i, p in enumerate(parts) if not (i and p in TAGS)) or "recipe")


LATER = ("background", "siblings", "shown_db")
"""Fields that came after the first datasets: left out where they are off, so that the older recipes keep their name."""


def document_of(recipe: Recipe) -> dict[str, object]:
    """The recipe ready for JSON, every default written out (but for fields of `LATER` that are off)."""
    document: dict[str, object] = recipe.model_dump(mode="json")
    off = [key for key in LATER if document[key] is None or document[key] is False]
    return {key: value for key, value in document.items() if key not in off}


def _text(document: object) -> str:
    return json.dumps(document, sort_keys=True, separators=(",", ":"), allow_nan=False)


def canonical(recipe: Recipe) -> str:
    """One text for one recipe: keys sorted, no blanks."""
    return _text(document_of(recipe))


def checksum(document: object) -> str:
    """SHA-256 of a recipe's document as it was written; a later version may know further fields."""
    return hashlib.sha256(_text(document).encode()).hexdigest()


def identity(recipe: Recipe) -> str:
    """SHA-256 of the canonical text."""
    return checksum(document_of(recipe))
