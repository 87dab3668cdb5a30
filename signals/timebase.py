"""Time stamps of a recording: the sampling rate they stand for, and where they are irregular."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signals.series import FloatArray
from sim.core.errors import Problem, SpecError

JITTER_SHARE = 0.01
"""Steps within 1 % of the median step count as uniform: time stamps printed with few digits scatter that much."""


@dataclass(frozen=True, kw_only=True)
class TimeBase:
    """`sampling_rate_hz` is the mean one; the counts and `first_place` (sample index) say what is irregular."""

    sampling_rate_hz: float
    uniform: bool
    gaps: int
    repeated: int
    backward: int
    longest_step_s: float
    median_step_s: float
    largest_jitter_s: float
    """Largest distance of a stamp from where a uniform clock would put it."""
    first_place: int | None


def read_time_base(times_s: FloatArray) -> TimeBase:
    """Judge time stamps of shape (n,), s. Irregular ones are reported, not resampled."""
    times = np.asarray(times_s, dtype=np.float64)
    if times.ndim != 1 or times.size < 3 or not np.all(np.isfinite(times)) or times[-1] <= times[0]:
        raise SpecError(
            Problem(field="time", message="must be at least 3 finite time stamps that end after they start", unit="s")
        )
    steps = np.diff(times)
    median = float(np.median(steps))
    span = float(times[-1] - times[0])
    uniform_step = span / steps.size
    wrong = np.flatnonzero(np.abs(steps - median) > JITTER_SHARE * max(median, np.finfo(np.float64).tiny))
    clock = times[0] + np.arange(times.size) * uniform_step
    return TimeBase(
        sampling_rate_hz=1 / uniform_step,
        uniform=wrong.size == 0,
        gaps=int(np.sum(steps > 1.5 * median)),
        repeated=int(np.sum(steps == 0)),
        backward=int(np.sum(steps < 0)),
        longest_step_s=float(np.max(steps)),
        median_step_s=median,
        largest_jitter_s=float(np.max(np.abs(times - clock))),
        first_place=int(wrong[0]) + 1 if wrong.size else None,
    )


def require_uniform(times_s: FloatArray) -> float:
    """The sampling rate of uniform time stamps, Hz; SpecError says where they are not."""
    base = read_time_base(times_s)
    if not base.uniform:
        raise irregular(base)
    return base.sampling_rate_hz


def irregular(base: TimeBase) -> SpecError:
    """What is told about stamps that are not uniform."""
    detail = f"{base.gaps} gaps, {base.repeated} repeated, {base.backward} backward"
    detail += f", longest step {base.longest_step_s:.4g} s"
    return SpecError(
        Problem(
            field="time",
            message=f"stamps are irregular from sample {base.first_place} on ({detail}); resample them first",
            given=f"mean {base.sampling_rate_hz:.6g} Hz",
            allowed=f"steps within {100 * JITTER_SHARE:g} % of their median, {base.median_step_s:.4g} s, or stamps "
            "that are off a regular grid by no more than they are rounded",
        )
    )
