"""Whether machines and transfer paths stay in one split each; a recipe where they do not is refused."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from sideband_datasets.plan.machines import Machine
from sideband_datasets.plan.quotas import IntArray
from sideband_datasets.plan.walk import Known
from sideband_datasets.recipe.model import Recipe
from sim.core.errors import Problem, SpecError


def check_apart(recipe: Recipe, machines: Sequence[Machine], known: Sequence[Known], split_of: IntArray) -> None:
    """SpecError where one machine would stand in two splits, or a channel would have one transfer path in two.

    `known`: what is kept of each of `machines`; `split_of`: number of each one's split, shape (machines,).
    """
    splits = [list(recipe.splits)[number] for number in split_of.tolist()]
    problem = _one_machine(known, splits)
    problems = [problem] if problem is not None else list(_one_path(recipe, machines, known, splits))
    if problems:
        raise SpecError(problems)


def _one_machine(known: Sequence[Known], splits: Sequence[str]) -> Problem | None:
    seen: dict[str, tuple[str, str]] = {}
    for machine, split in zip(known, splits, strict=True):
        first, name = seen.setdefault(machine.content, (split, machine.machine_id))
        if first != split:
            message = f"machines of the same parameters would stand in two splits: {name} in {first}, "
            message += f"{machine.machine_id} in {split} (name, notes, speed, loads and what is drawn for every "
            message += "recording make no other machine)"
            allowed = "ranges in `machines.vary` of what the machines are built of, or one split"
            return Problem(field="splits", message=message, allowed=allowed)
    return None


def _one_path(
    recipe: Recipe, machines: Sequence[Machine], known: Sequence[Known], splits: Sequence[str]
) -> Iterator[Problem]:
    """One problem for each channel of each chain."""
    seen: dict[str, tuple[str, str]] = {}
    told: set[tuple[int, str]] = set()
    for place, (machine, split) in enumerate(zip(known, splits, strict=True)):
        for channel, path in machine.channel_paths.items():
            first, name = seen.setdefault(path, (split, machine.machine_id))
            number = machine.measurement or 0
            if first == split or (number, channel) in told:
                continue
            told.add((number, channel))
            yield Problem(
                field=f"measurement.{number}.vary",
                message=f"machines with the same transfer path would stand in two splits: that of channel {channel} "
                f"is one for {name} in {first} and {machine.machine_id} in {split}",
                given=", ".join(recipe.measurement[number].vary) or "nothing",
                allowed=f"a range below `channels.{channel}.path` that tells its paths apart, such as "
                f"`channels.{channel}.path.{_example(machines[place], channel)}`, or one split",
            )


def _example(machine: Machine, channel: str) -> str:
    """A value that a channel's path has."""
    assert machine.chain is not None
    path = next(c["path"] for c in machine.chain["channels"] if c["name"] == channel)
    return "modes.0.frequency_hz" if path["kind"] == "modes" else "sampling_rate_hz"
