"""Simulate a machine: the one entry point of the physics."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from sim.assembly.assemble import assemble
from sim.core.errors import Diverged, Problem, SpecError, TooStiff, UnknownName
from sim.core.response import Channel, FloatArray, Response
from sim.core.spec import MachineSpec
from sim.core.system import System
from sim.solve.bounds import Bounds, beyond, bounds_of
from sim.solve.outcome import Finished, Request, response
from sim.solve.pilot import pilot_channels, step_difference
from sim.solve.plan import Built, build_plan
from sim.solve.pointers import Work, new_work
from sim.solve.sampling import Probe, begin, new_probe, sample
from sim.solve.settings import FIRST_SHARE, PILOT_S, Settings, pieces
from sim.solve.step_choice import Cost, run_cost, steps_per_output
from sim.solve.streaming import Stream, filtered, instantaneous, jumping

MAX_DURATION_S = 3600.0
MIN_RATE_HZ, MAX_OUTPUT_RATE_HZ = 100.0, 500_000.0


@dataclass(kw_only=True)
class _Run:
    system: System
    built: Built
    work: Work
    probe: Probe
    bounds: Bounds
    rtol: float
    most: float | None = None


def default_channels(system: System) -> tuple[str, ...]:
    """Acceleration of every resonator; without resonators, of every outer ring, else of every moving body."""
    spec = system.machine
    if spec.resonators:
        return tuple(f"{r.name}.{r.axis}.acceleration" for r in spec.resonators)
    if spec.bearings:
        return tuple(f"{b.name}.outer.{axis}.acceleration" for b in spec.bearings for axis in ("x", "y"))
    return tuple(f"{dof}.acceleration" for dof in system.dofs)


def resolve_channels(system: System, names: Sequence[str] | None) -> tuple[Channel, ...]:
    """Channels by name; `all` is every channel; UnknownName lists what exists."""
    known = {c.name: c for c in system.channels}
    wanted = default_channels(system) if names is None else tuple(names)
    if wanted == ("all",):
        return system.channels
    for name in wanted:
        if name not in known:
            raise UnknownName("channel", name, tuple(known))
    return tuple(known[name] for name in dict.fromkeys(wanted))


def check_request(duration_s: float, rate_hz: float) -> None:
    """SpecError when duration or output rate are out of bounds."""
    problems = []
    if not (math.isfinite(duration_s) and 0 < duration_s <= MAX_DURATION_S):
        problems.append(
            Problem(field="duration_s", message="out of bounds", given=duration_s, allowed="above 0 to 3600", unit="s")
        )
    if not (math.isfinite(rate_hz) and MIN_RATE_HZ <= rate_hz <= MAX_OUTPUT_RATE_HZ):
        problems.append(
            Problem(
                field="sampling_rate_hz", message="out of bounds", given=rate_hz, allowed="100 to 500000", unit="Hz"
            )
        )
    if not problems and duration_s * rate_hz < 2:
        problems.append(Problem(field="duration_s", message="gives fewer than two samples", given=duration_s, unit="s"))
    if problems:
        raise SpecError(problems)


def _start(system: System, rate_hz: float, names: tuple[str, ...], rtol: float, drawn_s: float) -> _Run:
    built = build_plan(system, 1.0 / rate_hz, drawn_s=drawn_s)
    run = _Run(
        system=system,
        built=built,
        work=new_work(built.plan),
        probe=new_probe(built, system, names),
        bounds=bounds_of([system]),
        rtol=rtol,
    )
    begin(built.plan, run.work, run.probe)
    return run


def diverged(system: System, displacement: FloatArray, time_s: float) -> Diverged:
    """The error of a motion that left all bounds: where it is worst, and what to do."""
    state = np.abs(displacement)
    worst = int(np.argmax(np.where(np.isfinite(state), state, np.inf)))
    doubts = f" (it was warned: {'; '.join(system.warnings[:3])})" if system.warnings else ""
    advice = (
        f"check the loads, stiffness and damping that act there for a slip in a unit{doubts}; "
        "if all are meant, a shorter step (a higher sampling rate) may resolve it"
    )
    return Diverged(time_s=time_s, dof=system.dofs[worst], advice=advice)


def too_stiff(iterations: float, done: int, last: int, step_s: float, most: float | None) -> TooStiff | None:
    """The error of a run of `last` base steps that took more than `most` iterations a step in the first `done`."""
    counted = max(float(done), FIRST_SHARE * last)
    if most is None or iterations <= most * counted:
        return None
    return TooStiff(time_s=done * step_s, per_step=iterations / done, allowed=most)


def _advance(run: _Run, first: int, count: int, last: int) -> FloatArray:
    block = np.empty((run.probe.pointer.size - 1, count))
    for at, steps in pieces(count, run.most):
        block[:, at : at + steps] = _piece(run, first + at, steps, last)
    return block


def _piece(run: _Run, first: int, count: int, last: int) -> FloatArray:
    block, step_s = np.empty((run.probe.pointer.size - 1, count)), run.built.plan.base_step
    done = sample(run.built.plan, run.work, run.probe, first, count, run.rtol, last, block)
    displacement = run.work.z[: len(run.system.dofs)]
    if done < count or beyond(run.bounds, displacement[:, None])[0]:
        raise diverged(run.system, displacement, (first + int(done)) * step_s)
    given_up = too_stiff(float(run.work.counts[0]), first + count, last, step_s, run.most)
    if given_up is not None:
        raise given_up
    return block


def _pilot_error(system: System, rate_hz: float, rtol: float, span_s: float) -> float:
    """Difference between a step and its half over the pilot: `sim.solve.pilot`."""
    names = pilot_channels(default_channels(system))
    count = max(int(span_s * rate_hz), 8)
    drawn_s = 1.0 / rate_hz  # alike in both: where a jump falls between samples is no error of the step
    coarse = _advance(_start(system, rate_hz, names, rtol, drawn_s), 0, count, count)
    fine = _advance(_start(system, 2 * rate_hz, names, rtol, drawn_s), 0, 2 * count, 2 * count)[:, ::2]
    return step_difference(coarse, fine)


def drawn_s(settings: Settings, factor: int, rate_hz: float) -> float:
    """Interval for which jumps are drawn band-limited, s: the base step where a filter thins the samples, else 0."""
    return 1.0 / rate_hz if settings.anti_alias and factor > 1 else 0.0


def simulate(
    machine: MachineSpec,
    *,
    duration_s: float,
    output_rate_hz: float,
    channels: Sequence[str] | None = None,
    seed: int = 0,
    settings: Settings | None = None,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Response:
    """Simulate from rest at t = 0, loads stepping on.

    Signals have ceil(duration * rate) samples at t = j / rate. `channels`: names, None for the sensors, ("all",).
    Raises SpecError for an impossible machine or request, UnknownName for a channel, Diverged, TooStiff
    (with `Settings.most_iterations`), Cancelled.
    """
    chosen = settings or Settings()
    check_request(duration_s, output_rate_hz)
    system = assemble(machine, seed=seed)
    selected = resolve_channels(system, channels)
    names = tuple(c.name for c in selected)
    factor = chosen.steps_per_output or steps_per_output(system, output_rate_hz)
    rate = output_rate_hz * factor
    samples = math.ceil(duration_s * output_rate_hz - 1e-9)
    error = None
    if chosen.estimate_error:
        error = _pilot_error(system, rate, chosen.rtol, min(PILOT_S, duration_s))
    run = _start(system, rate, names, chosen.rtol, drawn_s(chosen, factor, rate))
    run.most = chosen.most_iterations
    stream = Stream(
        advance=lambda first, count, last: _advance(run, first, count, last),
        channels=len(selected),
        samples=samples,
        factor=factor,
        step_s=1.0 / rate,
        progress=progress,
        cancelled=cancelled,
    )
    signals = filtered(stream, jumping(selected)) if chosen.anti_alias else instantaneous(stream)
    finished = Finished(
        z=run.work.z,
        work=run.work.work,
        counts=run.work.counts,
        energy=run.probe.energy,
        contact=run.probe.contact,
    )
    request = Request(channels=selected, rate_hz=output_rate_hz, step_s=1.0 / rate, seed=seed)
    return response(system, request, finished, signals, error)


def estimate_cost(
    machine: MachineSpec, *, duration_s: float, output_rate_hz: float, channels: Sequence[str] | None = None
) -> Cost:
    """Steps, memory and seconds a run would take; raises what `simulate` would raise before starting."""
    check_request(duration_s, output_rate_hz)
    system = assemble(machine)
    count = len(resolve_channels(system, channels))
    return run_cost(system, duration_s=duration_s, output_rate_hz=output_rate_hz, channels=count)
