"""Machines of an atlas simulated: side by side where enough share a structure and a step, else one by one."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import replace

from sim.assembly.assemble import assemble
from sim.core.errors import Diverged, Meaningless, SidebandError, SpecError, UnknownName
from sim.core.response import Response
from sim.solve.api import simulate
from sim.solve.ensemble import Member, simulate_many, structure
from sim.solve.settings import Settings
from sim.solve.step_choice import steps_per_output

RATE_HZ = 20480.0
SETTLE_S = 0.2
"""Left out at the start, beside what the automatic end of the transient would keep: enough for 1e-3 of the level."""
SPAN_S = 1.0
FEW = 2
"""So many machines of one structure cost less one by one than in eight lanes of which the others idle."""
SETTINGS = Settings(rtol=1e-3, estimate_error=False)


def run_members(members: Sequence[Member], channels: Sequence[str]) -> list[Response | SidebandError]:
    """A response or an error a member, in their order."""
    results: dict[int, Response | SidebandError] = {}
    groups: dict[Hashable, list[int]] = {}
    built = list(members)
    for k, member in enumerate(members):
        try:
            system = assemble(member.machine, seed=member.seed)
        except SidebandError as error:
            results[k] = error
            continue
        built[k] = replace(member, system=system)
        groups.setdefault((structure(system), steps_per_output(system, RATE_HZ)), []).append(k)
    for group in groups.values():
        run = _one_by_one if len(group) <= FEW else _side_by_side
        results |= dict(zip(group, run([built[k] for k in group], channels), strict=True))
    return [results[k] for k in range(len(members))]


def _side_by_side(members: Sequence[Member], channels: Sequence[str]) -> list[Response | SidebandError]:
    return simulate_many(
        members, duration_s=SETTLE_S + SPAN_S, output_rate_hz=RATE_HZ, channels=list(channels), settings=SETTINGS
    )


def _one_by_one(members: Sequence[Member], channels: Sequence[str]) -> list[Response | SidebandError]:
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
                    settings=SETTINGS,
                )
            )
        except (SpecError, UnknownName, Diverged, Meaningless) as error:
            found.append(error)
    return found
