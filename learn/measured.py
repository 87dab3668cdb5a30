"""What of a recording was measured at all: channels that were dead for a good part are left out of the answer."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from learn.unheard import of_noise
from signals.checks import Finding, Place, inspect
from signals.recording import Recording
from signals.series import FloatArray
from sim.core.errors import Problem, SpecError

VIBRATION = ("acceleration", "velocity", "displacement", "sound pressure")
GONE = ("constant", "stuck", "dropout", "silent")
"""Kinds of findings in whose samples nothing was measured; clipped ones still tell when something passed."""
DEAD = 0.1
"""Share of such samples from which a channel is left out."""
SILENT = 1e-3
"""RMS about the mean over that of the loudest channel of its quantity and unit, below which a channel hears nothing of
the machine: 60 dB, where places on one machine seldom differ by 40 (a convention, no measurement)."""


@dataclass(frozen=True, kw_only=True)
class Measured:
    """The channels to answer by, and what was found of those wanted; `left_out` are names."""

    recording: Recording
    findings: tuple[Finding, ...]
    left_out: tuple[str, ...]

    def faults(self) -> list[dict[str, object]]:
        """One object a finding: `channel`, `kind`, whether the channel was `left_out`."""
        return [{"channel": f.channel, "kind": f.kind, "left_out": f.channel in self.left_out} for f in self.findings]

    def remarks(self) -> list[str]:
        """The same in words, channels that were left out first."""
        total = self.recording.samples.shape[1]
        ordered = sorted(self.findings, key=lambda f: f.channel not in self.left_out)
        return [
            f"{f.channel}: {f.kind}: {f.message} ({f.samples / total:.0%} of the samples)"
            + ("; left out of the answer" if f.channel in self.left_out else "")
            for f in ordered
        ]


def measured(recording: Recording, channels: Sequence[str] | None = None) -> Measured:
    """The recording's vibration channels, or those named, without the dead ones.

    SpecError where no channel is one of vibration, none is left, or samples are not finite.
    """
    names = list(channels) if channels else [c.name for c in recording.channels if c.quantity in VIBRATION]
    if not names:
        known = ", ".join(f"{c.name} ({c.quantity or '-'})" for c in recording.channels)
        raise SpecError(
            Problem(field="channels", message="hold no vibration", given=known, allowed=", ".join(VIBRATION))
        )
    chosen = recording.select(channels=names)
    for name, values in zip(names, chosen.samples, strict=True):
        _check_finite(chosen, name, values)
    findings = (*inspect(chosen), *_silent(chosen))
    gone = _gone(findings)
    dead = {name: found for name, found in gone.items() if _share(found, chosen) > DEAD}
    kept = [name for name in names if name not in dead]
    if not kept:
        raise SpecError([_nothing(name, found, chosen) for name, found in dead.items()])
    heard = chosen.select(channels=kept)
    return Measured(recording=heard, findings=(*findings, *of_noise(heard)), left_out=tuple(dead))


def _silent(recording: Recording) -> Iterator[Finding]:
    """Channels in which next to nothing is heard beside others: not connected, or of another unit than stated."""
    loudness = np.std(recording.samples, axis=1)
    for k, channel in enumerate(recording.channels):
        alike = [(c.quantity, c.unit) == (channel.quantity, channel.unit) for c in recording.channels]
        loudest = float(np.max(loudness[alike]))
        if 0.0 < loudness[k] < SILENT * loudest:
            below = 20 * np.log10(loudest / loudness[k])
            message = f"{below:.0f} dB below the loudest channel of its unit; is it connected, and is its unit right?"
            count = recording.samples.shape[1]
            place = Place(
                first=0, stop=count, start_s=recording.start_s, stop_s=recording.start_s + recording.duration_s
            )
            yield Finding(channel=channel.name, kind="silent", message=message, count=1, samples=count, places=(place,))


def _check_finite(recording: Recording, name: str, values: FloatArray) -> None:
    bad = np.flatnonzero(~np.isfinite(values))
    if bad.size:
        at = recording.start_s + float(bad[0]) / recording.sampling_rate_hz
        message = f"has {bad.size} samples that are not finite, the first is sample {bad[0]} (t = {at:.6g} s)"
        allowed = "finite numbers: cut there, or leave the channel out"
        given = str(values[bad[0]])
        raise SpecError(Problem(field=f"channels.{name}", message=message, given=given, allowed=allowed))


def _gone(findings: Sequence[Finding]) -> Mapping[str, list[Finding]]:
    """Findings of samples that were not measured, by channel."""
    found: dict[str, list[Finding]] = {}
    for one in findings:
        if one.kind in GONE:
            found.setdefault(one.channel, []).append(one)
    return found


def _share(found: Sequence[Finding], recording: Recording) -> float:
    return float(sum(f.samples for f in found) / recording.samples.shape[1])


def _nothing(name: str, found: Sequence[Finding], recording: Recording) -> Problem:
    """The refusal of a channel in which too little was measured."""
    field = f"channels.{name}"
    if any(f.kind == "constant" for f in found):
        return Problem(field=field, message="is constant: nothing was measured")
    place = min((f.places[0] for f in found), key=lambda p: p.first)
    kinds = " and ".join(f.kind for f in found)
    message = f"measured nothing for a good part ({kinds}), first from {place.start_s:.6g} to {place.stop_s:.6g} s"
    given = f"{_share(found, recording):.1%} of the samples"
    return Problem(field=field, message=message, given=given, allowed=f"{DEAD:.0%} at most; cut it there")
