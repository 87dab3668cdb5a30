"""From a request to a plan and its shards: the same division wherever and whenever it is made."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import cast

from jobs.datasets.request import DatasetRequest
from sideband_datasets import Recipe, make_plan, read_recipe, recipe_named
from sideband_datasets.folder.manifest import versions
from sideband_datasets.folder.shards import Shard, shards_of
from sideband_datasets.formats.format import format_named
from sideband_datasets.plan import Estimate, Plan, check_shard, estimate, most_recordings, plan_again, recording_bytes
from sideband_datasets.plan.size import batch_size
from sideband_datasets.recipe.read import document_of
from sim.core.errors import Problem, SpecError, UnknownName
from sim.core.lanes import WIDTH
from sim.core.near import did_you_mean

SHARD_S = 120.0
"""Core-seconds that a shard should take: long against starting one, short against losing one."""
LEAST_RECORDINGS = 4 * WIDTH
"""Below that, few machines of one structure meet in a shard, and the lanes stay empty."""
MOST_SHARDS = 4096


@dataclass(frozen=True, kw_only=True)
class Division:
    """A plan and the shards that together are its dataset."""

    plan: Plan
    format: str
    shard_recordings: int
    shards: tuple[Shard, ...]
    cost: Estimate

    @property
    def shard_bytes(self) -> int:
        """Rows of the largest shard before compression, estimated."""
        return recording_bytes(self.plan) * self.shard_most

    @property
    def shard_most(self) -> int:
        """Recordings of the largest shard."""
        return max(len(shard.recordings) for shard in self.shards)

    @property
    def document(self) -> dict[str, object]:
        """The request as the catalogue keeps it: one form a meaning."""
        return {
            "recipe": document_of(self.plan.recipe),
            "format": self.format,
            "shard_recordings": self.shard_recordings,
            "versions": versions(),
        }

    def expected(self, workers: int) -> Estimate:
        """What it takes with so many workers: as the command line tells of the same shards and workers."""
        return estimate(self.plan, workers, self.shard_recordings)


@contextmanager
def _told_of(request: DatasetRequest) -> Iterator[None]:
    """Problems of a recipe raised inside carry the names that the request has for their fields."""
    try:
        yield
    except UnknownName as error:
        message = f"is not a known {error.kind}{did_you_mean(error.name, error.known)}"
        allowed = ", ".join(error.known)
        problem = Problem(field=_place(error, request), message=message, given=error.name, allowed=allowed)
        raise SpecError(problem) from None
    except SpecError as error:
        raise SpecError([replace(p, field=_within(p.field)) for p in error.problems]) from None


def recipe_of(request: DatasetRequest) -> Recipe:
    """The recipe that a request asks for, read; SpecError names its wrong fields."""
    with _told_of(request):
        form = request.recipe
        return recipe_named(form) if isinstance(form, str) else read_recipe(form)


def divide(request: DatasetRequest) -> Division:
    """What the request asks for, divided; SpecError names every field that must change."""
    recipe = recipe_of(request)
    with _told_of(request):
        suffix = format_named(request.format).suffix
        plan = make_plan(recipe)
        cost = estimate(plan, 1)
    size = request.shard_recordings or _size(plan, cost)
    shards = tuple(shards_of(plan, suffix, size))
    if len(shards) > MOST_SHARDS:
        message = f"makes {len(shards)} shards"
        allowed = f"{MOST_SHARDS} or fewer: {math.ceil(plan.recipe.count / MOST_SHARDS) + 1} recordings in each, or so"
        raise SpecError(Problem(field="shard_recordings", message=message, given=size, allowed=allowed))
    division = Division(
        plan=plan, format=request.format, shard_recordings=size, shards=shards, cost=estimate(plan, 1, size)
    )
    check_shard(plan, division.shard_most, "shard_recordings", size)
    return division


def division_of(document: Mapping[str, object]) -> tuple[Plan, list[Shard]]:
    """Plan and shards of a request as it is kept, all machines looked at once more."""
    return _divided(make_plan(read_recipe(document["recipe"])), document)


def division_again(document: Mapping[str, object]) -> tuple[Plan, list[Shard]]:
    """As `division_of`, of a request that was accepted: no machine is built before its recordings are made."""
    return _divided(plan_again(read_recipe(document["recipe"])), document)


def _divided(plan: Plan, document: Mapping[str, object]) -> tuple[Plan, list[Shard]]:
    suffix = format_named(str(document["format"])).suffix
    return plan, shards_of(plan, suffix, cast(int, document["shard_recordings"]))


def balance_of(plan: Plan) -> dict[str, dict[str, int]]:
    """Planned rows by split and class."""
    found = {split: dict.fromkeys(plan.recipe.classes, 0) for split in plan.splits}
    for recording, kind in enumerate(plan.kind.tolist()):
        found[plan.split(recording)][plan.recipe.classes[kind]] += plan.rows_per_recording
    return found


def _place(error: UnknownName, request: DatasetRequest) -> str:
    """Where the name that does not exist was given."""
    if error.kind in ("format", "recipe"):
        return error.kind
    families = request.recipe.get("machines", ()) if isinstance(request.recipe, Mapping) else ()
    for number, family in enumerate(families):
        if family.get(error.kind) == error.name:
            return f"recipe.machines.{number}.{error.kind}"
    return f"recipe.{error.kind}"


def _within(field: str) -> str:
    """Where a field of a recipe stands in the request."""
    return field if field == "format" or field.partition(".")[0] == "recipe" else f"recipe.{field}"


def _size(plan: Plan, cost: Estimate) -> int:
    """Recordings in a shard, whole lanes where that many fit."""
    wanted = SHARD_S * plan.recipe.count / max(cost.core_seconds, 1e-9)
    fit = max(LEAST_RECORDINGS, min(batch_size(plan), int(wanted) // WIDTH * WIDTH))
    fit = min(fit, _whole_lanes(most_recordings(plan)))
    least = math.ceil(plan.recipe.count / (MOST_SHARDS - len(plan.splits)))
    return min(max(fit, least), plan.recipe.count)


def _whole_lanes(recordings: int) -> int:
    return recordings // WIDTH * WIDTH or recordings
