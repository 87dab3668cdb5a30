"""What the gate can find, and which of it is an answer."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from reconcile.verdict import SensorFault
from signals.recording import Recording

Kind = Literal[
    "not_finite",
    "silence",
    "stuck",
    "dropouts",
    "clipped",
    "irregular_time",
    "swapped_channels",
    "unit_mismatch",
    "gain_change",
    "filter_change",
    "mains_hum",
    "fixed_tones",
    "alias",
    "tacho_jitter",
    "loose_sensor",
    "too_short",
    "speed_mismatch",
    "noiseless",
    "spikes",
    "copied",
    "noise",
    "repeated",
    "breaks",
]
FAULTS: tuple[Kind, ...] = (
    "not_finite",
    "silence",
    "stuck",
    "dropouts",
    "repeated",
    "noise",
    "copied",
    "clipped",
    "spikes",
    "irregular_time",
    "swapped_channels",
    "unit_mismatch",
    "gain_change",
    "filter_change",
    "mains_hum",
    "fixed_tones",
    "alias",
    "tacho_jitter",
    "loose_sensor",
)
"""Kinds that can be the whole answer, the one that spoils the others first. The rest are remarks."""


@dataclass(frozen=True, kw_only=True)
class Finding:
    """One thing wrong with `channel` (empty: all of them) of `recording` (`test 1`, `baseline 2`).

    `severity` 0..1: what share of the signal it spoils. `fault`: it may explain a mismatch by itself; a finding that
    baseline and test share does not, nor one too small to matter.
    """

    kind: Kind
    channel: str
    recording: str
    detail: str
    severity: float
    where: str = ""
    fault: bool = False
    gain_db: float | None = None
    """Of gain and unit: the one change of level that undoing it takes back."""
    transfer_db: tuple[tuple[float, float], ...] = ()
    """Of a loose sensor: (frequency in Hz, change of level in dB) that undoing it takes back."""
    tones_hz: tuple[float, ...] = ()
    """Of fixed tones: where they are."""


@dataclass(frozen=True, kw_only=True)
class Gate:
    """Findings, and the recordings as far as they could be put right (hum subtracted, swaps and gains undone).

    `fault` is the finding to report if the cleaned recordings show nothing missing: a machine can have a fault and a
    bad sensor at once, so the answer is the fault's only after the cleaned recordings have been reconciled.
    """

    findings: tuple[Finding, ...]
    baselines: tuple[Recording, ...]
    tests: tuple[Recording, ...]
    fault: SensorFault | None
    usable: bool
    """False: no channel is left that the later stages could work on."""


def worst(findings: tuple[Finding, ...]) -> SensorFault | None:
    """The fault that spoils most: by kind in the order of `FAULTS`, then by severity; its detail names all channels."""
    faults = [f for f in findings if f.fault]
    if not faults:
        return None
    first = min(faults, key=lambda f: (FAULTS.index(f.kind), -f.severity))
    place = f"; {first.where}" if first.where else ""
    others = dict.fromkeys(f.channel for f in faults if f.kind == first.kind and f.channel != first.channel)
    also = f"; also on {', '.join(c for c in others if c)}" if any(others) else ""
    return SensorFault(kind=first.kind, channel=first.channel, detail=f"{first.recording}: {first.detail}{place}{also}")
