"""What a chain says of its recording."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass

from signals.recording import Recording
from signals.sensors.spec import SensorChain

MAX_PULSES = 100_000
"""Pulse times listed in the description; the recording itself has all of them."""


@dataclass(frozen=True, kw_only=True)
class ChannelReport:
    """One channel: what it is of, and how much of it is not what the machine did.

    `sources` are the weights of the outputs; `step` the converter's step in the channel's unit (None: no converter).
    """

    name: str
    kind: str
    preset: str | None
    quantity: str
    unit: str
    location: str
    axis: str
    sources: Mapping[str, float]
    step: float | None
    saturated_samples: int = 0
    """Samples of the simulation at which the sensor itself was at its limit."""
    out_of_range_samples: int = 0
    """Samples of the simulation beyond a probe's linear range."""
    clipped_samples: int = 0
    """Samples beyond the converter's range."""
    lost_samples: int = 0


@dataclass(frozen=True, kw_only=True)
class Measured:
    """The recording and one report for each of its channels."""

    recording: Recording
    reports: tuple[ChannelReport, ...]


def description(
    chain: SensorChain, reports: Sequence[ChannelReport], recording: Recording, seed: int
) -> dict[str, object]:
    """JSON-ready: the chain with every value it used, the seed, what became of each channel, the tacho's pulses."""
    document: dict[str, object] = {
        "chain": chain.model_dump(mode="json"),
        "seed": seed,
        "sampling_rate_hz": recording.sampling_rate_hz,
        "samples": int(recording.samples.shape[1]),
        "channels": [asdict(report) for report in reports],
    }
    if recording.tacho is not None:
        times = recording.tacho.pulse_times_s
        document["tacho"] = {
            "shaft": recording.tacho.shaft,
            "pulses_per_revolution": recording.tacho.pulses_per_revolution,
            "pulse_times_s": [float(t) for t in times[:MAX_PULSES]],
            "truncated": max(0, int(times.size) - MAX_PULSES),
        }
    return document
