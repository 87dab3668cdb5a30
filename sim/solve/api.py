"""Simulate a machine: the one entry point of the physics."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from sim.assembly.assemble import assemble
from sim.core.errors import Cancelled, Diverged, Problem, SpecError, UnknownName
from sim.core.response import Channel, FloatArray, Quality, Response
from sim.core.spec import MachineSpec
from sim.core.system import System
from sim.solve.decimate import Decimator
from sim.solve.energy import energy_balance
from sim.solve.plan import Built, IntArray, build_plan
from sim.solve.pointers import Work, new_work
from sim.solve.sampling import Probe, begin, new_probe, sample
from sim.solve.settings import IRREGULAR, PILOT_S, Settings
from sim.solve.step_choice import Cost, run_cost, steps_per_output
from sim.solve.transient import transient_end_s
from sim.version import PHYSICS_VERSION

BLOCK = 4096
MAX_DURATION_S = 3600.0
MIN_RATE_HZ, MAX_OUTPUT_RATE_HZ = 100.0, 500_000.0


@dataclass(kw_only=True)
class _Run:
    system: System
    built: Built
    work: Work
    probe: Probe
    rtol: float


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


def _check(duration_s: float, rate_hz: float) -> None:
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


def _start(system: System, rate_hz: float, names: tuple[str, ...], rtol: float) -> _Run:
    built = build_plan(system, 1.0 / rate_hz)
    run = _Run(system=system, built=built, work=new_work(built.plan), probe=new_probe(built, system, names), rtol=rtol)
    begin(built.plan, run.work, run.probe)
    return run


def _diverged(run: _Run, index: int) -> Diverged:
    n = len(run.system.dofs)
    state = np.abs(run.work.z[:n])
    worst = int(np.argmax(np.where(np.isfinite(state), state, np.inf)))
    return Diverged(
        time_s=index * run.built.plan.base_step,
        dof=run.system.dofs[worst],
        advice="check stiffness, damping and load there; a shorter step (more steps per output) may resolve it",
    )


RUNAWAY = 1.0
"""Displacement in m (or rad) no machine of this kind survives: treated as divergence."""


def _advance(run: _Run, first: int, count: int, last: int) -> FloatArray:
    block = np.empty((run.probe.pointer.size - 1, count))
    done = sample(run.built.plan, run.work, run.probe, first, count, run.rtol, last, block)
    linear = [i for i, name in enumerate(run.system.dofs) if not name.endswith(".theta")]
    if done < count or np.any(np.abs(run.work.z[linear]) > RUNAWAY):
        raise _diverged(run, first + int(done))
    return block


def _pilot_error(system: System, rate_hz: float, names: tuple[str, ...], rtol: float, span_s: float) -> float:
    """Worst relative L2 difference between a step and its half over the second half of the pilot."""
    count = max(int(span_s * rate_hz), 8)
    coarse = _advance(_start(system, rate_hz, names, rtol), 0, count, count)
    fine = _advance(_start(system, 2 * rate_hz, names, rtol), 0, 2 * count, 2 * count)[:, ::2]
    half = count // 2
    difference = np.linalg.norm(coarse[:, half:] - fine[:, half:], axis=1)
    size = np.linalg.norm(fine[:, half:] - fine[:, half:].mean(axis=1, keepdims=True), axis=1)
    level = size.max()
    kept = size > 1e-9 * level if level > 0 else size > 0
    return float(np.max(difference[kept] / size[kept])) if np.any(kept) else 0.0


PICKED = ("state", "stiffness")
"""Quantities that jump: sampled at the output instants, because a filter would ring at every tooth entry."""


def _signals(
    run: _Run,
    samples: int,
    factor: int,
    picked: IntArray,
    progress: Callable[[float], None] | None,
    cancelled: Callable[[], bool] | None,
) -> FloatArray:
    """Run to the end; returns (channels, samples) at the output rate."""
    channels = run.probe.pointer.size - 1
    decimator = Decimator(factor, channels)
    total = (samples - 1) * factor + 1 + decimator.tail
    signals = np.empty((channels, samples))
    values = np.empty((picked.size, samples))
    filled, done = 0, 0
    while done < total:
        if cancelled is not None and cancelled():
            raise Cancelled(f"cancelled at t = {done * run.built.plan.base_step:.4g} s")
        count = min(BLOCK, total - done)
        block = _advance(run, done, count, total)
        ready = decimator.push(block)
        keep = min(ready.shape[1], samples - filled)
        signals[:, filled : filled + keep] = ready[:, :keep]
        filled += keep
        first = -(-done // factor)
        instants = block[picked, first * factor - done :: factor]
        keep = max(min(instants.shape[1], samples - first), 0)
        values[:, first : first + keep] = instants[:, :keep]
        done += count
        if progress is not None:
            progress(done / total)
    signals[picked] = values
    return signals


STEP_WARNING = 1e-2


def _step_warnings(error: float | None, kind: str) -> tuple[str, ...]:
    if error is None or error <= STEP_WARNING:
        return ()
    if kind == "irregular":
        return ("the motion is irregular (impacts): compare spectra and statistics, not single samples",)
    return (f"the step changes the result by {100 * error:.2g} %: ask for more steps per output sample",)


def _contact_share(run: _Run) -> dict[str, float]:
    share = {}
    for e, element in enumerate(run.system.elements):
        if element.contact_output >= 0 and run.probe.contact[e, 0] > 0:
            share[element.name] = float(run.probe.contact[e, 1] / run.probe.contact[e, 0])
    return share


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
    Raises SpecError for an impossible machine or request, UnknownName for a channel, Diverged, Cancelled.
    """
    chosen = settings or Settings()
    _check(duration_s, output_rate_hz)
    system = assemble(machine, seed=seed)
    selected = resolve_channels(system, channels)
    names = tuple(c.name for c in selected)
    factor = chosen.steps_per_output or steps_per_output(system, output_rate_hz)
    rate = output_rate_hz * factor
    samples = math.ceil(duration_s * output_rate_hz - 1e-9)
    error, kind = None, "not measured"
    if chosen.estimate_error:
        error = _pilot_error(system, rate, default_channels(system), chosen.rtol, min(PILOT_S, duration_s))
        kind = "irregular" if error > IRREGULAR else "regular"
    run = _start(system, rate, names, chosen.rtol)
    if chosen.anti_alias:
        jumps = np.flatnonzero([c.quantity in PICKED for c in selected])
        signals = _signals(run, samples, factor, jumps, progress, cancelled)
    else:
        signals = _picked(run, samples, factor, progress, cancelled)
    period = 1.0 / max((hz for hz in system.speeds_hz.values() if hz > 0), default=20.0 / duration_s)
    counts = run.work.counts
    return Response(
        machine=machine,
        sampling_rate_hz=output_rate_hz,
        channels=selected,
        signals=signals,
        bases_hz=dict(system.bases_hz),
        derived=dict(system.derived),
        quality=Quality(
            step_s=1.0 / rate,
            steps=int(counts[1]),
            refined_steps=int(counts[2]),
            unconverged_steps=int(counts[4]),
            step_error=error,
            step_error_kind=kind,
            transient_end_s=transient_end_s(signals, output_rate_hz, period),
            energy=energy_balance(system, run.work, run.probe),
        ),
        warnings=system.warnings + _step_warnings(error, kind),
        contact_share=_contact_share(run),
        seed=seed,
        version=PHYSICS_VERSION,
    )


def _picked(
    run: _Run,
    samples: int,
    factor: int,
    progress: Callable[[float], None] | None,
    cancelled: Callable[[], bool] | None,
) -> FloatArray:
    """Instantaneous values at the output instants, no filter: for comparisons with reference solutions."""
    signals = np.empty((run.probe.pointer.size - 1, samples))
    block = max(1, BLOCK // factor)
    for start in range(0, samples, block):
        if cancelled is not None and cancelled():
            raise Cancelled(f"cancelled at t = {start * factor * run.built.plan.base_step:.4g} s")
        count = min(block, samples - start)
        values = _advance(run, start * factor, count * factor, samples * factor)
        signals[:, start : start + count] = values[:, ::factor]
        if progress is not None:
            progress((start + count) / samples)
    return signals


def estimate_cost(
    machine: MachineSpec, *, duration_s: float, output_rate_hz: float, channels: Sequence[str] | None = None
) -> Cost:
    """Steps, memory and seconds a run would take; raises what `simulate` would raise before starting."""
    _check(duration_s, output_rate_hz)
    system = assemble(machine)
    count = len(resolve_channels(system, channels))
    return run_cost(system, duration_s=duration_s, output_rate_hz=output_rate_hz, channels=count)
