"""What a caller may ask of a dataset."""

from __future__ import annotations

from typing import Annotated

from pydantic import AfterValidator, ConfigDict, Field, WithJsonSchema

from sideband_datasets.formats import FORMATS
from sim.core.spec import SpecModel

MOST_IN_A_SHARD = 10_000


def _name_or_object(value: object) -> object:
    if isinstance(value, dict) or (isinstance(value, str) and 0 < len(value) <= 80):
        return value
    raise ValueError("must be the name of a ready recipe, or an object")


RecipeForm = Annotated[
    object,
    AfterValidator(_name_or_object),
    WithJsonSchema({"anyOf": [{"type": "string", "minLength": 1, "maxLength": 80}, {"type": "object"}]}),
]


class DatasetRequest(SpecModel):
    """A recipe, and how its rows are kept."""

    model_config = ConfigDict(json_schema_extra={"examples": [{"recipe": "small", "format": "parquet"}]})

    recipe: RecipeForm
    """Name of a ready recipe, or a whole one (`GET /v1/datasets/recipes` has both, with the schema)."""
    format: Annotated[str, Field(max_length=40, json_schema_extra={"enum": list(FORMATS)})] = "parquet"
    """Of the shards."""
    shard_recordings: Annotated[int, Field(ge=1, le=MOST_IN_A_SHARD)] | None = None
    """Most recordings in a shard, the piece that one worker makes; none: as many as take about two minutes."""
