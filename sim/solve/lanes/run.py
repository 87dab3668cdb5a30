"""Eight runs under way, and the pilot that says how far half the step would differ."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from sim.core.errors import SidebandError
from sim.core.lanes import WIDTH
from sim.core.response import FloatArray
from sim.core.system import System
from sim.solve.api import default_channels, diverged, too_stiff
from sim.solve.bounds import Bounds, beyond, bounds_of
from sim.solve.lanes.layout import LanePlan, lane_plan, stepped
from sim.solve.lanes.pointers import LaneWork, new_lane_work
from sim.solve.lanes.sampling import LaneProbe, begin, new_lane_probe, sample
from sim.solve.pilot import pilot_channels, step_difference
from sim.solve.plan import build_plan
from sim.solve.settings import pieces


@dataclass(frozen=True, kw_only=True)
class Steps:
    """How eight machines are stepped: base step, interval for which jumps are drawn band-limited, tolerance."""

    step_s: float
    drawn_s: float
    rtol: float


@dataclass(kw_only=True)
class Lanes:
    """`lost` holds the error of a lane whose motion left all bounds or took more than `most` iterations a step.

    In its first `listen` steps a run also observes `heard`, the pilot's channels, and keeps them: the pilot with the
    base step is the beginning of the run itself.
    """

    systems: Sequence[System]
    plan: LanePlan
    work: LaneWork
    probe: LaneProbe
    bounds: Bounds
    rtol: float
    most: float | None = None
    lost: dict[int, SidebandError] = field(default_factory=dict)
    listen: int = 0
    listener: LaneProbe | None = None
    heard: list[FloatArray] = field(default_factory=list)

    def advance(self, first: int, count: int, last: int) -> FloatArray:
        """(8 channels, count): lane after lane of every channel."""
        early = min(max(self.listen - first, 0), count) if self.listener is not None else 0
        if self.listener is None or early == 0:
            return self._advance(self.probe, first, count, last)
        both = self._advance(self.listener, first, early, last)
        own = (self.probe.pointer.size - 1) * WIDTH
        self.heard.append(both[own:])
        if first + early == self.listen:  # what has been added up so far goes on in the other probe
            for name in ("x", "energy", "contact"):
                getattr(self.probe, name)[...] = getattr(self.listener, name)
        if early == count:
            return both[:own]
        return np.concatenate([both[:own], self._advance(self.probe, first + early, count - early, last)], axis=1)

    def _advance(self, probe: LaneProbe, first: int, count: int, last: int) -> FloatArray:
        channels = probe.pointer.size - 1
        block = np.empty((channels, count, WIDTH))
        for at, steps in pieces(count, self.most):
            part = np.empty((channels, steps, WIDTH))
            sample(self.plan, self.work, probe, first + at, steps, self.rtol, last, part)
            block[:, at : at + steps] = part
            self._lose(first + at + steps, last)
        return np.ascontiguousarray(np.moveaxis(block, 2, 1)).reshape(channels * WIDTH, count)

    def _lose(self, done: int, last: int) -> None:
        """Lanes that left all bounds, or take too many iterations, stop."""
        displacements = self.work.z[: len(self.systems[0].dofs)]
        out = beyond(self.bounds, displacements) | (self.work.counts[7] == 0.0)
        for lane, system in enumerate(self.systems):
            if lane in self.lost:
                continue
            found: SidebandError | None = None
            if out[lane]:
                found = diverged(system, displacements[:, lane], done * self.plan.base_step)
            found = found or too_stiff(float(self.work.counts[0, lane]), done, last, self.plan.base_step, self.most)
            if found is not None:
                self.work.counts[7, lane] = 0.0
                self.lost[lane] = found


def start_lanes(systems: Sequence[System], steps: Steps, names: tuple[str, ...], listen: int = 0) -> Lanes:
    """Eight machines of one structure at rest; `names` are observed, and in the first `listen` steps the pilot's."""
    operators = {id(system): stepped(system, steps.step_s) for system in systems}
    first = build_plan(systems[0], steps.step_s, drawn_s=steps.drawn_s, pack=False)
    plan = lane_plan(systems, [operators[id(system)] for system in systems], first.plan)
    lanes = Lanes(
        systems=systems,
        plan=plan,
        work=new_lane_work(plan),
        probe=new_lane_probe(plan, systems, first, names),
        bounds=bounds_of(systems),
        rtol=steps.rtol,
        listen=listen,
    )
    if listen:
        lanes.listener = new_lane_probe(plan, systems, first, (*names, *_judged(systems)))
    begin(plan, lanes.work, lanes.listener or lanes.probe)
    return lanes


def _judged(systems: Sequence[System]) -> tuple[str, ...]:
    return pilot_channels(default_channels(systems[0]))


def pilot_steps(rate_hz: float, span_s: float) -> int:
    """Base steps of a pilot."""
    return max(int(span_s * rate_hz), 8)


def pilot(systems: Sequence[System], steps: Steps, count: int) -> FloatArray:
    """The pilot's channels over `count` steps, (8 channels, count)."""
    return start_lanes(systems, steps, _judged(systems)).advance(0, count, count)


def step_errors(systems: Sequence[System], steps: Steps, coarse: FloatArray) -> list[float]:
    """Step error of each lane, as the single solver measures it; `coarse`: what `pilot` gives with these steps."""
    halved = Steps(step_s=0.5 * steps.step_s, drawn_s=steps.drawn_s, rtol=steps.rtol)
    fine = pilot(systems, halved, 2 * coarse.shape[1])[:, ::2]
    return [step_difference(coarse[lane::WIDTH], fine[lane::WIDTH]) for lane in range(WIDTH)]
