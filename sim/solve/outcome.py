"""From a finished run to its response: quality, energy balance, warnings."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from sim.core.response import Channel, FloatArray, Quality, Response
from sim.core.speed import mean_ratio, warped_times
from sim.core.system import System
from sim.solve.chunks import IntArray
from sim.solve.energy import energy_balance
from sim.solve.settings import IRREGULAR
from sim.solve.transient import transient_end_s
from sim.solve.trust import doubts, refuse_meaningless
from sim.version import PHYSICS_VERSION

STEP_WARNING = 1e-2


@dataclass(frozen=True, kw_only=True)
class Request:
    """What was asked for: channels, output rate, base step, seed."""

    channels: tuple[Channel, ...]
    rate_hz: float
    step_s: float
    seed: int


@dataclass(frozen=True, kw_only=True)
class Finished:
    """What a run leaves: state, element work (E,) J, counts, energies and contact samples of its probe."""

    z: FloatArray
    work: FloatArray
    counts: FloatArray | IntArray
    energy: FloatArray
    contact: FloatArray


def _warnings(error: float | None, kind: str) -> tuple[str, ...]:
    if error is None or error <= STEP_WARNING:
        return ()
    if kind == "irregular":
        return ("the motion is irregular (impacts): compare spectra and statistics, not single samples",)
    return (f"the step changes the result by {100 * error:.3g} %: ask for more steps per output sample",)


SPEED_WARNING = 2e-3
"""Range of the speed, relative to nominal, above which lines of a spectrum over time smear."""
STEADY_SHARE = 0.1
"""Of the time simulated that must be steady at its end to be told so."""


def _speed_warning(system: System, duration_s: float) -> tuple[str, ...]:
    if system.speed[0] == 0:
        return ()
    times = np.linspace(0.0, duration_s, 1001)
    _, ratios = warped_times(system.speed, times)
    span = float(ratios.max() - ratios.min())
    if span <= SPEED_WARNING:
        return ()
    told = f"the speed varies by {100 * span:.3g} % of the nominal one"
    steady = float(times[np.flatnonzero(np.abs(ratios - ratios[-1]) > SPEED_WARNING)[-1] + 1])
    if steady <= (1.0 - STEADY_SHARE) * duration_s:
        return (f"{told} until {steady:.3g} s: lines smear in spectra over that time, and are sharp after it",)
    return (f"{told} (frequencies are those of its mean): lines smear in spectra over time; orders stay sharp",)


def _range_warnings(system: System, contact: FloatArray) -> list[str]:
    found = []
    for e, element in enumerate(system.elements):
        if element.range_output >= 0 and contact[e, 2] > 0:
            share = 100.0 * contact[e, 2] / max(contact[e, 0], 1.0)
            what = "left the range of its stiffness table"
            found.append(f"{element.name}: {share:.3g} % of the time {what}, whose last row was used")
    return found


def _contact_share(system: System, contact: FloatArray) -> dict[str, float]:
    share = {}
    for e, element in enumerate(system.elements):
        if element.contact_output >= 0 and contact[e, 0] > 0:
            share[element.name] = float(contact[e, 1] / contact[e, 0])
    return share


def response(
    system: System, request: Request, finished: Finished, signals: FloatArray, error: float | None
) -> Response:
    """Response of a run with its signals (channels, samples); `error` from the pilot, None when unmeasured."""
    kind = "not measured"
    if error is not None:
        kind = "irregular" if error > IRREGULAR else "regular"
    duration_s = signals.shape[1] / request.rate_hz
    ratio = mean_ratio(system.speed, 0.0, duration_s)
    period = 1.0 / max((hz for hz in system.speeds_hz.values() if hz > 0), default=20.0 / duration_s)
    quality = Quality(
        step_s=request.step_s,
        steps=int(finished.counts[1]),
        refined_steps=int(finished.counts[2]),
        unconverged_steps=int(finished.counts[4]),
        step_error=error,
        step_error_kind=kind,
        transient_end_s=transient_end_s(signals, request.rate_hz, period),
        energy=energy_balance(system, finished.z, finished.work, finished.energy),
    )
    refuse_meaningless(system, quality)
    quality = replace(quality, doubts=doubts(quality))
    return Response(
        machine=system.machine,
        sampling_rate_hz=request.rate_hz,
        channels=request.channels,
        signals=signals,
        bases_hz={name: hz * ratio for name, hz in system.bases_hz.items()},
        derived=dict(system.derived),
        quality=quality,
        warnings=quality.doubts
        + system.warnings
        + _warnings(error, kind)
        + _speed_warning(system, duration_s)
        + tuple(_range_warnings(system, finished.contact)),
        contact_share=_contact_share(system, finished.contact),
        seed=request.seed,
        version=PHYSICS_VERSION,
        speed=system.speed,
    )
