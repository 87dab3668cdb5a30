"""How much one request for indicators may hold and take, checked before any sample is read.

Seconds are measured on one core of the machine that `jobs/cost.json` names too; they need not be exact to keep a server
from standing still.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from jobs.indicators.subject import Rotation
from signals.cyclic.coherence import LONGEST_SEGMENT_S
from sim.core.errors import Problem, SpecError

MAX_SAMPLES = 5_000_000
"""Of the channel and its earlier runs together: about 170 bytes each while the angle is taken from the vibration."""
MAX_SECONDS = 20.0
SECONDS_PER_SAMPLE = {"gear": 0.6e-6, "average": 0.25e-6, "cepstrum": 0.1e-6, "kurtogram": 0.5e-6, "cyclic": 0.1e-6}
TACHOLESS_SECONDS_PER_SAMPLE = 2e-6
SECONDS_PER_PRODUCT = 1.7e-9
"""Of a carrier and a cyclic frequency, in each segment of a coherence."""


@dataclass(frozen=True, kw_only=True)
class Stretch:
    """Samples of one record, and their rate."""

    samples: int
    rate_hz: float


def usual_alpha_hz(bases_hz: Mapping[str, float], rate_hz: float) -> float:
    """Largest cyclic frequency unless given: 3.2 times the fastest shaft or bearing frequency."""
    slow = [hz for base, hz in bases_hz.items() if not base.startswith("f_m")]
    usual = min(3.2 * max(slow), 1000.0) if slow else 500.0
    return min(usual, rate_hz / 8)


def expected_seconds(kind: str, records: Sequence[Stretch], *, rotation: Rotation, alpha_hz: float) -> float:
    """Estimated time; `records`: the channel first, then the earlier runs."""
    first = records[0]
    counted = records if kind == "gear" else records[:1]
    seconds = sum(SECONDS_PER_SAMPLE[kind] * record.samples for record in counted)
    if rotation == "tacholess" and kind in ("gear", "average"):
        seconds += sum(TACHOLESS_SECONDS_PER_SAMPLE * record.samples for record in records)
    if kind == "cyclic":
        segment_s = min(first.samples / first.rate_hz, LONGEST_SEGMENT_S)
        segments = max(1.0, 2 * first.samples / first.rate_hz / segment_s - 1)
        alphas, carriers = alpha_hz * segment_s, max(0.0, first.rate_hz / 2 - alpha_hz) * segment_s
        seconds += SECONDS_PER_PRODUCT * segments * alphas * carriers
    return seconds


def check_bounds(kind: str, records: Sequence[Stretch], *, rotation: Rotation, alpha_hz: float) -> None:
    """SpecError that says the bound, where the records are too long together or the work would take too long."""
    samples = sum(record.samples for record in records)
    beside = "" if len(records) == 1 else f" with {len(records) - 1} earlier"
    if samples > MAX_SAMPLES:
        message = f"too many samples for indicators ({samples}{beside}); give a shorter stretch (start_s, end_s)"
        raise SpecError(
            Problem(field="end_s", message=message, given=samples, allowed=f"<= {MAX_SAMPLES}", unit="samples")
        )
    seconds = expected_seconds(kind, records, rotation=rotation, alpha_hz=alpha_hz)
    if seconds > MAX_SECONDS:
        field, less = ("max_alpha_hz", "a smaller max_alpha_hz or ") if kind == "cyclic" else ("end_s", "")
        message = f"would take too long (about {seconds:.3g} s); give {less}a shorter stretch (start_s, end_s)"
        allowed = f"<= {MAX_SECONDS:g}"
        raise SpecError(Problem(field=field, message=message, given=round(seconds, 3), allowed=allowed, unit="s"))
