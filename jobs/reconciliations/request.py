"""What a caller may ask of a reconciliation."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal, Self

from pydantic import (
    AfterValidator,
    ConfigDict,
    Field,
    ModelWrapValidatorHandler,
    ValidationError,
    WithJsonSchema,
    model_validator,
)

from jobs.reconciliations.machine import check_preset, read_form
from jobs.request import MOST_SEED
from jobs.validation import problems_of
from reconcile.entry import MOST_RECORDINGS
from sim import presets
from sim.core.errors import SpecError
from sim.core.spec import SpecModel

RecordingId = Annotated[str, Field(min_length=1, max_length=64, pattern=r"^[A-Za-z0-9_-]+$")]


def _name_or_object(value: object) -> object:
    if isinstance(value, dict) or (isinstance(value, str) and 0 < len(value) <= 80):
        return value
    raise ValueError("must be the name of a preset, or an object")


MachineForm = Annotated[
    object,
    AfterValidator(_name_or_object),
    WithJsonSchema({"anyOf": [{"type": "string", "minLength": 1, "maxLength": 80}, {"type": "object"}]}),
]


MOST_TOLD_TOGETHER = 2000
"""Values of a machine that is read although another field is wrong: requests are checked one after the other."""


def _is_small(form: object) -> bool:
    """Whether an object has few enough values, at any depth."""
    left, count = [form], 0
    while left:
        one = left.pop()
        inside = list(one.values()) if isinstance(one, Mapping) else one if isinstance(one, list) else []
        count += len(inside)
        if count > MOST_TOLD_TOGETHER:
            return False
        left += inside
    return True


class ReconciliationRequest(SpecModel):
    """Recordings, and what is known of the machine they come from."""

    model_config = ConfigDict(
        json_schema_extra={
            "examples": [
                {
                    "machine": {
                        "kinematics": {
                            "shafts": [{"name": "input"}],
                            "bearings": [{"name": "bearing1", "shaft": "input", "catalogue": "6205"}],
                        }
                    },
                    "baselines": [],
                    "recordings": ["0123456789abcdef0123456789abcdef"],
                    "budget": "quick",
                    "seed": 0,
                }
            ]
        }
    )

    machine: MachineForm
    """Name of a preset, a machine specification, a flat parameter file's content, or `{"kinematics": {...}}` where only
    shafts, bearings and teeth are known."""
    recordings: Annotated[list[RecordingId], Field(min_length=1, max_length=MOST_RECORDINGS)]
    """Ids of the recordings to explain (`POST /v1/recordings`)."""
    baselines: Annotated[list[RecordingId], Field(max_length=MOST_RECORDINGS, default_factory=list)]
    """Ids of recordings of the same machine when it was sound."""
    budget: Literal["quick", "full"] = "quick"
    """How much is simulated beyond the atlas: the best few effects, or more of them (docs/reconcile.md)."""
    seed: Annotated[int, Field(ge=0, le=MOST_SEED)] = 0
    """Seed of the atlas and of the bootstrap."""

    @model_validator(mode="wrap")
    @classmethod
    def _told_together(cls, given: object, handler: ModelWrapValidatorHandler[Self]) -> Self:
        """Where another field is wrong the machine is read too, so that all is told in one reply."""
        try:
            return handler(given)
        except ValidationError as error:
            form = given.get("machine") if isinstance(given, Mapping) else None
            problems = [*problems_of(error, model=cls)]
            try:
                if isinstance(form, Mapping) and _is_small(form):
                    read_form(form)
                if isinstance(form, str) and all(p.field != "machine" for p in problems):
                    check_preset(form, presets.names())
            except SpecError as further:
                problems += further.problems
            raise SpecError(problems) from error
