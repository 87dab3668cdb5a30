"""Channels that were away, held, cut off or no numbers: which samples, and whether that is what the model misses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.driven.channels import BoolArray, Driven, FloatArray
from reconcile.driven.model import Model, ready, simulated
from reconcile.gate.findings import FAULTS, Finding
from reconcile.gate.samples import QUIET_RATIO, QUIET_WINDOW_S, sample_findings
from reconcile.verdict import SensorFault
from signals.checks import defects
from signals.recording import Recording

MOST_SPOILED = 0.3
"""Share of the samples of a channel from which on it is not used at all."""
WORSE = 3.0
"""Error at spoiled samples over that elsewhere (RMS) from which they were not the signal: a force that was really off
for a while leaves no larger errors than one that was on."""
ACTING = 0.3
"""Force, over its usual size, that lets no mass stand still."""
LEAST_WINDOW = 16


@dataclass(frozen=True, kw_only=True)
class Mended:
    """A recording whose gaps are bridged, what was wrong with it, and its spoiled samples by channel, (n,) each."""

    recording: Recording
    findings: tuple[Finding, ...]
    bad: dict[str, BoolArray]

    def hopeless(self, channels: Sequence[str]) -> SensorFault | None:
        """The worst fault of one of these channels that leaves too little of it."""
        lost = [n for n in channels if float(np.mean(self.bad[n])) > MOST_SPOILED]
        found = [f for f in self.findings if f.channel in lost and f.fault]
        return sensor_fault(min(found, key=lambda f: FAULTS.index(f.kind))) if found else None


def sensor_fault(found: Finding) -> SensorFault:
    """A finding as the report has it."""
    where = f"; {found.where}" if found.where else ""
    detail = f"{found.recording}: {found.detail}{where}"
    return SensorFault(kind=found.kind, channel=found.channel, detail=detail, recordings=(found.recording,))


def mended(recording: Recording, label: str) -> Mended:
    """Gaps bridged by straight lines; `label`: what the report calls the recording."""
    samples, bad = recording.samples.copy(), {}
    for row, name in enumerate(recording.names):
        spoiled = _spoiled(samples[row], recording.sampling_rate_hz)
        gone = ~np.isfinite(samples[row])
        if np.any(gone):
            place = np.arange(gone.size)
            samples[row][gone] = 0.0 if np.all(gone) else np.interp(place[gone], place[~gone], samples[row][~gone])
        bad[name] = spoiled
    found = sample_findings(recording, label)
    return Mended(recording=replace(recording, samples=samples), findings=found, bad=bad)


def _spoiled(samples: FloatArray, rate_hz: float) -> BoolArray:
    """Samples (n,) that `signals.checks` finds fault with, and windows in which the signal is all but gone."""
    found = np.zeros(samples.size, dtype=np.bool_)
    for kind, _, stretches in defects(samples):
        for first, stop in stretches:
            found[first:stop] = True
            if kind == "clipping":  # of an end, single samples too
                found |= samples == samples[first]
    length = max(LEAST_WINDOW, int(QUIET_WINDOW_S * rate_hz))
    count = samples.size // length
    sound = samples[np.isfinite(samples)]
    if count >= 2 and sound.size:
        blocks = np.where(np.isfinite(samples), samples, 0.0)[: count * length].reshape(count, length)
        size = np.std(blocks, axis=1)
        quiet = size < QUIET_RATIO * float(np.median(size))
        quiet &= np.abs(np.mean(blocks, axis=1) - np.mean(sound)) < 0.5 * np.std(sound)
        found[: count * length] |= np.repeat(quiet, length)
    return found


def with_bad(data: Driven, found: Mended) -> Driven:
    """Input and output with their spoiled samples; a force that is cut off may have been so, and all of it counts."""
    drive, answer = found.bad[data.drive_channel.name], found.bad[data.answer_channel.name]
    cut = any(f.kind == "clipped" and f.channel == data.drive_channel.name for f in found.findings)
    return replace(
        data,
        bad_drive=drive if np.any(drive) and not cut else None,
        bad_answer=answer if np.any(answer) else None,
    )


def proved(
    findings: Sequence[Finding], several: Sequence[Driven], model: Model, explained: bool, missing: bool = False
) -> list[SensorFault]:
    """Faults of input and output that the fitted model confirms; `explained`: what is left is small; `missing`:
    a force is missing that no law describes.

    Where the channel was away the model must be off by much more than elsewhere; what is no number always counts. A
    force that stands at its ends is at fault only where nothing explains the motion that it made; a motion that does,
    to the last digit, where no law describes the force that is missing: the model that it is held against is then none.
    """
    found = []
    for i, data in enumerate(several, 1):
        for one in (f for f in findings if f.fault and f.recording == f"test {i}"):
            if one.channel == data.drive_channel.name and one.kind == "clipped":
                wrong = not explained
            elif one.channel == data.answer_channel.name and one.kind == "clipped" and missing:
                wrong = True
            elif one.channel in (data.drive_channel.name, data.answer_channel.name):
                still = _still_while_driven(one, data) and not (explained and _foretold(data, model))
                wrong = one.kind == "not_finite" or still or _worse(data, model)
            else:
                continue
            if wrong:
                found.append(sensor_fault(one))
    return sorted(found, key=lambda f: FAULTS.index(f.kind))


def _still_while_driven(found: Finding, data: Driven) -> bool:
    """Whether the output stands still, to the last digit, while a force acts that is about as large as ever."""
    still = found.kind in ("dropouts", "stuck") and found.channel == data.answer_channel.name
    if not still or data.bad_answer is None:
        return False
    acting = data.drive[data.bad_answer] - np.median(data.drive)
    return bool(np.sqrt(np.mean(acting**2)) > ACTING * data.drive.std())


def _foretold(data: Driven, model: Model) -> bool:
    """Whether the fitted model is no farther off at the spoiled samples than elsewhere: friction holds it there too."""
    bad = data.bad_answer
    if bad is None or not np.any(bad) or np.all(bad):
        return False
    error = data.answer - simulated(model, ready(data, model.memory_s))
    return float(np.mean(error[bad] ** 2)) < WORSE * float(np.mean(error[~bad] ** 2))


def _worse(data: Driven, model: Model) -> bool:
    """Whether the model is off at spoiled samples by much more than elsewhere."""
    run = ready(data, model.memory_s)
    if run.kept is None:
        return False
    error = (data.answer - simulated(model, run))[run.skip :]
    here, there = error[run.kept == 0.0], error[run.kept == 1.0]
    if not here.size or not there.size:
        return bool(here.size)
    return bool(np.mean(here**2) > WORSE**2 * np.mean(there**2))
