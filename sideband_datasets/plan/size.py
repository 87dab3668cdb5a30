"""Bytes of a recording's rows, and how many recordings a shard may hold: a worker may keep all of it in memory."""

from __future__ import annotations

from itertools import pairwise

from sideband_datasets.plan.plan import Plan
from sideband_datasets.recipe.model import Recipe
from sideband_datasets.recipe.values import least
from sim.core.errors import Problem, SpecError
from sim.core.lanes import WIDTH

BYTES_PER_ROW = 6_000
"""Columns and peaks beside the samples."""
MOST_SHARD_BYTES = 1_000_000_000
"""Of the rows of a shard before compression. Eight of the largest recordings that may be simulated have no more where
their windows do not overlap, so lanes stay filled."""
BATCH = 32 * WIDTH
"""Recordings held at once at most: enough of one structure to fill the lanes."""
BATCH_BYTES = 64_000_000
"""Of the samples of the rows held at once, about; where eight recordings have more, as much as a shard may hold."""


def recording_bytes(plan: Plan) -> int:
    """Samples and columns of all rows of a recording, at most: where revolutions count, at the slowest speed."""
    recipe, windows = plan.recipe, plan.recipe.windows
    # Longer windows do not fit into the recording.
    longest_s = recipe.duration_s / windows.span(1.0)
    if windows.length_s is not None:
        longest_s = min(longest_s, windows.length_s)
    elif windows.length_revolutions is not None:
        slowest_hz = least(recipe.speeds_hz) if recipe.speeds_hz is not None else None
        longest_s = min(longest_s, windows.length_revolutions / slowest_hz) if slowest_hz else longest_s
    return round(plan.rows_per_recording * (4 * longest_s * recipe.sampling_rate_hz + BYTES_PER_ROW))


def least_bytes(recipe: Recipe) -> int:
    """Samples and columns of all rows of a recipe, at least, by its numbers alone: no machine is built for it."""
    windows = recipe.windows
    chains = [choice.chain.get("channels") for choice in recipe.measurement]
    channels = min((len(found) for found in chains if isinstance(found, list)), default=1)
    shortest_s = recipe.duration_s / windows.span(1.0)
    if windows.length_s is not None:
        shortest_s = windows.length_s
    elif windows.length_revolutions is not None:
        shortest_s = 0.0
    return round(
        recipe.count * windows.per_recording * channels * (4 * shortest_s * recipe.sampling_rate_hz + BYTES_PER_ROW)
    )


def most_recordings(plan: Plan) -> int:
    """Recordings that fit into a shard; 0: not even one does."""
    return MOST_SHARD_BYTES // recording_bytes(plan)


def batch_size(plan: Plan) -> int:
    """Recordings worked on at once: a multiple of the lanes, fewer only where a shard could not hold so many."""
    recipe = plan.recipe
    longest_s = min(recipe.duration_s, recipe.windows.length_s or recipe.duration_s)
    size = 4.0 * plan.rows_per_recording * longest_s * recipe.sampling_rate_hz
    lanes = max(WIDTH, min(BATCH, int(BATCH_BYTES / size) // WIDTH * WIDTH))
    return max(1, min(lanes, most_recordings(plan)))


def parted(plan: Plan, split: str, size: int | None = None) -> list[list[int]]:
    """Recordings of a split as its shards hold them, in the order of the plan; `size`: most recordings in each."""
    members = plan.of_split(split).tolist()
    count = -(-len(members) // (size or batch_size(plan)))
    ends = [k * len(members) // count for k in range(count + 1)] if count else []
    return [members[first:last] for first, last in pairwise(ends)]


def check_recording(plan: Plan) -> None:
    """SpecError for a recording whose rows alone are more than a shard may hold."""
    size = recording_bytes(plan)
    if size > MOST_SHARD_BYTES:
        message = "makes recordings whose rows are too large for a shard"
        allowed = f"{MOST_SHARD_BYTES} bytes or fewer: fewer windows, shorter ones, or less overlap"
        field = "windows.per_recording" if plan.recipe.windows.per_recording > 1 else "duration_s"
        raise SpecError(Problem(field=field, message=message, given=size, allowed=allowed))


def check_shard(plan: Plan, recordings: int, field: str, given: int) -> None:
    """SpecError for `field`, given as `given`, when a shard of so many recordings is more than one may hold."""
    size = recordings * recording_bytes(plan)
    if size > MOST_SHARD_BYTES:
        message = f"makes shards of up to {size} bytes; {MOST_SHARD_BYTES} are allowed"
        allowed = f"{most_recordings(plan)} recordings or fewer"
        raise SpecError(Problem(field=field, message=message, given=given, allowed=allowed))
