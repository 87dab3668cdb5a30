"""Machines of an atlas simulated: side by side where enough share a structure and a step, else one by one."""

from __future__ import annotations

import math
from collections.abc import Hashable, Sequence
from dataclasses import replace

from sim.assembly.assemble import assemble
from sim.core.errors import Diverged, Meaningless, SidebandError, SpecError, TooStiff, UnknownName
from sim.core.response import Response
from sim.core.system import System
from sim.solve.api import simulate
from sim.solve.ensemble import Member, simulate_many, structure
from sim.solve.settings import Settings
from sim.solve.step_choice import LEAST_STEPS_PER_OUTPUT, steps_per_output

RATE_HZ = 20480.0
SETTLE_S = 0.2
"""Left out at the start, beside what the automatic end of the transient would keep: enough for 1e-3 of the level."""
SPAN_S = 1.0
FEW = 2
"""So many machines of one structure cost less one by one than in eight lanes of which the others idle."""
OFTEN = 0.05
"""Share of short steps from which that costs more than lanes save."""
COARSER = 2.0 / 3.0
"""Of the steps that a user's simulation takes: enough for levels (docs/decisions/atlas-steps.md)."""
MOST_ITERATIONS = 6.0
"""Of the corrector a step, on the whole: loose rings by themselves take 3.4 at most (36 machines of a gearbox of the
proof), beside dry friction 3.7 mostly; one that friction holds in its seat takes 12 to 390, up to half a minute."""
SETTINGS = Settings(rtol=1e-2, estimate_error=False, most_iterations=MOST_ITERATIONS)


def run_members(members: Sequence[Member], channels: Sequence[str]) -> list[Response | SidebandError]:
    """A response or an error a member, in their order."""
    results: dict[int, Response | SidebandError] = {}
    groups: dict[tuple[Hashable, int], list[int]] = {}
    built = list(members)
    for k, member in enumerate(members):
        try:
            system = assemble(member.machine, seed=member.seed)
        except SidebandError as error:
            results[k] = error
            continue
        built[k] = replace(member, system=system)
        groups.setdefault((structure(system), steps_of(system)), []).append(k)
    for (_, steps), group in groups.items():
        settings = replace(SETTINGS, steps_per_output=steps)
        found = _of_one_kind([built[k] for k in group], channels, settings)
        results |= dict(zip(group, found, strict=True))
    return [results[k] for k in range(len(members))]


def _of_one_kind(
    members: Sequence[Member], channels: Sequence[str], settings: Settings
) -> list[Response | SidebandError]:
    """Of one structure and step. Where rings may strike walls the first is run alone: if it strikes often, so are the
    others. Eight machines strike at different moments, and lanes wait for each other's short steps."""
    alone: list[Response | SidebandError] = []
    rest = list(members)
    if len(members) > FEW and may_strike(members[0].system):
        alone, rest = _one_by_one(rest[:1], channels, settings), rest[1:]
    run = _one_by_one if len(rest) <= FEW or _strikes_often(alone) else _side_by_side
    return [*alone, *run(rest, channels, settings)]


def may_strike(system: System | None) -> bool:
    """Whether it has rings that strike walls."""
    return system is not None and any(element.stiff for element in system.elements)


def _strikes_often(alone: Sequence[Response | SidebandError]) -> bool:
    """Or was given up, as others may be: a lane waits for the costliest."""
    often = (r for r in alone if isinstance(r, Response) and r.quality.refined_steps > OFTEN * r.quality.steps)
    return any(isinstance(r, TooStiff) for r in alone) or any(True for _ in often)


def steps_of(system: System) -> int:
    """Steps between two samples."""
    return max(LEAST_STEPS_PER_OUTPUT, math.ceil(COARSER * steps_per_output(system, RATE_HZ) - 1e-9))


def _side_by_side(
    members: Sequence[Member], channels: Sequence[str], settings: Settings
) -> list[Response | SidebandError]:
    return simulate_many(
        members, duration_s=SETTLE_S + SPAN_S, output_rate_hz=RATE_HZ, channels=list(channels), settings=settings
    )


def _one_by_one(
    members: Sequence[Member], channels: Sequence[str], settings: Settings
) -> list[Response | SidebandError]:
    found: list[Response | SidebandError] = []
    for member in members:
        try:
            found.append(
                simulate(
                    member.machine,
                    duration_s=SETTLE_S + SPAN_S,
                    output_rate_hz=RATE_HZ,
                    channels=list(channels),
                    seed=member.seed,
                    settings=settings,
                )
            )
        except (SpecError, UnknownName, Diverged, TooStiff, Meaningless) as error:
            found.append(error)
    return found
