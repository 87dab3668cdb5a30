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
from sim.core.response import Channel, FloatArray, Response
from sim.core.spec import MachineSpec
from sim.core.system import System
from sim.solve.api import (
    check_request,
    default_channels,
    diverged,
    drawn_s,
    resolve_channels,
    runs_away,
)
from sim.solve.lanes.layout import LanePlan, lane_plan, stepped
from sim.solve.lanes.pointers import LaneWork, new_lane_work
from sim.solve.lanes.sampling import LaneProbe, begin, new_lane_probe, sample
from sim.solve.outcome import Finished, Request, response
from sim.solve.pilot import pilot_channels, step_difference
from sim.solve.plan import build_plan
from sim.solve.settings import PILOT_S, Settings
from sim.solve.step_choice import steps_per_output
from sim.solve.streaming import Stream, filtered, instantaneous, jumping


@dataclass(frozen=True, kw_only=True)
class Member:
    """One machine of an ensemble and the seed of its random parts."""

    machine: MachineSpec
    seed: int = 0


@dataclass(frozen=True, kw_only=True)
class _Ready:
    """A member that was assembled: its place in the ensemble, steps an output sample, channels."""

    place: int
    member: Member
    system: System
    factor: int
    channels: tuple[Channel, ...]


@dataclass(kw_only=True)
class _Lanes:
    """Eight runs under way; `lost` holds the error of a lane whose motion left all bounds."""

    systems: Sequence[System]
    plan: LanePlan
    work: LaneWork
    probe: LaneProbe
    rtol: float
    lost: dict[int, SidebandError]

    def advance(self, first: int, count: int, last: int) -> FloatArray:
        """(8 channels, count): lane after lane of every channel."""
        channels = self.probe.pointer.size - 1
        block = np.empty((channels, count, WIDTH))
        sample(self.plan, self.work, self.probe, first, count, self.rtol, last, block)
        for lane, system in enumerate(self.systems):
            displacement = self.work.z[: len(system.dofs), lane]
            if lane not in self.lost and (self.work.counts[7, lane] == 0.0 or runs_away(system, displacement)):
                self.work.counts[7, lane] = 0.0
                self.lost[lane] = diverged(system, displacement, (first + count) * self.plan.base_step)
        return np.ascontiguousarray(np.moveaxis(block, 2, 1)).reshape(channels * WIDTH, count)


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


def _start(systems: Sequence[System], step_s: float, names: tuple[str, ...], rtol: float, drawn_s: float) -> _Lanes:
    operators = {id(system): stepped(system, step_s) for system in systems}
    first = build_plan(systems[0], step_s, drawn_s=drawn_s)
    plan = lane_plan(systems, [operators[id(system)] for system in systems], first.plan)
    lanes = _Lanes(
        systems=systems,
        plan=plan,
        work=new_lane_work(plan),
        probe=new_lane_probe(plan, systems, first, names),
        rtol=rtol,
        lost={},
    )
    begin(plan, lanes.work, lanes.probe)
    return lanes


def _pilots(systems: Sequence[System], rate_hz: float, rtol: float, span_s: float) -> list[float]:
    """Step error of each lane, as the single solver measures it."""
    names = pilot_channels(default_channels(systems[0]))
    count = max(int(span_s * rate_hz), 8)
    drawn = 1.0 / rate_hz
    coarse = _start(systems, 1.0 / rate_hz, names, rtol, drawn).advance(0, count, count)
    fine = _start(systems, 0.5 / rate_hz, names, rtol, drawn).advance(0, 2 * count, 2 * count)[:, ::2]
    return [step_difference(coarse[lane::WIDTH], fine[lane::WIDTH]) for lane in range(WIDTH)]


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
    errors: list[float | None] = [None] * WIDTH
    if call.settings.estimate_error:
        errors = [*_pilots(systems, rate, call.settings.rtol, min(PILOT_S, call.duration_s))]
    channels = full[0].channels
    drawn = drawn_s(call.settings, full[0].factor, rate)
    lanes = _start(systems, 1.0 / rate, tuple(c.name for c in channels), call.settings.rtol, drawn)
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
            system = assemble(member.machine, seed=member.seed)
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

    An impossible, diverging or meaningless member leaves its error (SpecError, UnknownName, Diverged, Meaningless) in
    its place; the others are not touched. Raises SpecError for an impossible request and Cancelled.
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
