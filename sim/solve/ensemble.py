"""Many machines in one call: eight of one structure side by side, each with its own parameters, terms and seed.

A member's result is the same bytes alone, in any order, beside any others; it equals `simulate` to rounding
(the same steps and the same decisions, lane by lane).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass

import numpy as np

from sim.assembly.assemble import assemble
from sim.core.errors import Cancelled, Meaningless, SidebandError
from sim.core.lanes import WIDTH
from sim.core.response import Channel, Response
from sim.core.spec import MachineSpec
from sim.core.system import System
from sim.solve.api import check_request, drawn_s, resolve_channels
from sim.solve.lanes.run import Steps, pilot, pilot_steps, start_lanes, step_errors
from sim.solve.outcome import Finished, Request, response
from sim.solve.settings import PILOT_S, Settings
from sim.solve.step_choice import steps_per_output
from sim.solve.streaming import Stream, filtered, instantaneous, jumping


@dataclass(frozen=True, kw_only=True)
class Member:
    """One machine of an ensemble and the seed of its random parts; `system`: both assembled, where that is at hand."""

    machine: MachineSpec
    seed: int = 0
    system: System | None = None


@dataclass(frozen=True, kw_only=True)
class _Ready:
    """A member that was assembled: its place in the ensemble, steps an output sample, channels."""

    place: int
    member: Member
    system: System
    factor: int
    channels: tuple[Channel, ...]


def structure(system: System) -> Hashable:
    """What machines must share to run side by side: unknowns, elements, and the sizes that steer their loops."""
    elements = tuple(
        (
            e.kernel.lane_force,
            tuple(c.name for c in e.coordinates),
            e.forces,
            e.rates,
            e.stiff,
            e.opens,
            e.exact_end,
            e.context,
            e.shafts,
            e.contact_output,
            e.parameters.size,
            tuple(float(e.parameters[k]) for k in e.kernel.same),
            tuple(o.name for o in e.outputs),
        )
        for e in system.elements
    )
    return system.dofs, elements, tuple(system.dynamic_angle.items()), len(system.dampers), system.speed.size


@dataclass(frozen=True, kw_only=True)
class _Call:
    duration_s: float
    rate_hz: float
    settings: Settings
    progress: Callable[[float], None] | None
    cancelled: Callable[[], bool] | None


def _run_lanes(ready: Sequence[_Ready], call: _Call) -> list[Response | SidebandError]:
    """Up to eight members of one structure; missing ones are filled with copies that nobody reads."""
    full = [*ready, *([ready[-1]] * (WIDTH - len(ready)))]
    systems = [r.system for r in full]
    rate = call.rate_hz * full[0].factor
    samples = math.ceil(call.duration_s * call.rate_hz - 1e-9)
    channels = full[0].channels
    names = tuple(c.name for c in channels)
    steps = Steps(step_s=1.0 / rate, drawn_s=drawn_s(call.settings, full[0].factor, rate), rtol=call.settings.rtol)
    piloted = Steps(step_s=steps.step_s, drawn_s=1.0 / rate, rtol=steps.rtol)
    judged = pilot_steps(rate, min(PILOT_S, call.duration_s)) if call.settings.estimate_error else 0
    # The beginning of a run that draws jumps as a pilot does is the pilot.
    lanes = start_lanes(systems, steps, names, judged if steps == piloted else 0)
    lanes.most = call.settings.most_iterations
    stream = Stream(
        advance=lanes.advance,
        channels=len(channels) * WIDTH,
        samples=samples,
        factor=full[0].factor,
        step_s=1.0 / rate,
        progress=call.progress,
        cancelled=call.cancelled,
    )
    every = tuple(c for c in channels for _ in range(WIDTH))
    signals = filtered(stream, jumping(every)) if call.settings.anti_alias else instantaneous(stream)
    errors: list[float | None] = [None] * WIDTH
    if judged:
        heard = np.concatenate(lanes.heard, axis=1) if lanes.heard else pilot(systems, piloted, judged)
        errors = [*step_errors(systems, piloted, heard)]
    results: list[Response | SidebandError] = []
    for lane, one in enumerate(ready):
        if lane in lanes.lost:
            results.append(lanes.lost[lane])
            continue
        finished = Finished(
            z=lanes.work.z[:, lane],
            work=lanes.work.work[:, lane],
            counts=lanes.work.counts[:, lane],
            energy=lanes.probe.energy[:, lane],
            contact=lanes.probe.contact[:, lane].reshape(-1, 3),
        )
        request = Request(channels=channels, rate_hz=call.rate_hz, step_s=1.0 / rate, seed=one.member.seed)
        try:
            results.append(response(one.system, request, finished, signals[lane::WIDTH].copy(), errors[lane]))
        except Meaningless as error:
            results.append(error)
    return results


def _prepared(
    members: Sequence[Member],
    call: _Call,
    channels: Sequence[str] | None,
    results: list[Response | SidebandError | None],
) -> list[_Ready]:
    """Assemble every member; one that is impossible leaves its error as its result."""
    ready = []
    for place, member in enumerate(members):
        try:
            system = member.system or assemble(member.machine, seed=member.seed)
            selected = resolve_channels(system, channels)
        except SidebandError as error:
            results[place] = error
            continue
        factor = call.settings.steps_per_output or steps_per_output(system, call.rate_hz)
        ready.append(_Ready(place=place, member=member, system=system, factor=factor, channels=selected))
    return ready


def simulate_many(
    members: Sequence[Member],
    *,
    duration_s: float,
    output_rate_hz: float,
    channels: Sequence[str] | None = None,
    settings: Settings | None = None,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> list[Response | SidebandError]:
    """Simulate every member from rest; results stand in the order of the members.

    An impossible, diverging, costly or meaningless member leaves its error (SpecError, UnknownName, Diverged, TooStiff,
    Meaningless) in its place; the others are not touched. Raises SpecError for an impossible request and Cancelled.
    """
    check_request(duration_s, output_rate_hz)
    chosen = settings or Settings()
    results: list[Response | SidebandError | None] = [None] * len(members)
    call = _Call(duration_s=duration_s, rate_hz=output_rate_hz, settings=chosen, progress=None, cancelled=cancelled)
    groups: dict[Hashable, list[_Ready]] = {}
    for one in _prepared(members, call, channels, results):
        key = structure(one.system), one.factor, tuple(c.name for c in one.channels)
        groups.setdefault(key, []).append(one)
    batches = [group[k : k + WIDTH] for group in groups.values() for k in range(0, len(group), WIDTH)]
    for done, batch in enumerate(batches):
        if cancelled is not None and cancelled():
            raise Cancelled(f"cancelled after {done} of {len(batches)} batches")
        for one, found in zip(batch, _run_lanes(batch, call), strict=True):
            results[one.place] = found
        if progress is not None:
            progress((done + 1) / len(batches))
    return [r for r in results if r is not None]
