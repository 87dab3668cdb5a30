"""Faults of time: irregular stamps, a jittering tacho, a record too short, a speed that is not the stated one."""

from __future__ import annotations

import numpy as np

from reconcile.gate.findings import Finding
from reconcile.shares import percent, signed_percent
from reconcile.speed import SpeedEstimate
from signals.recording import Recording
from signals.series import BoolArray, FloatArray
from signals.timebase import read_time_base

JITTER = 0.004
"""RMS error of a pulse, share of its interval, from which on a tacho is at fault: inertia does not let a shaft change
its speed from one pulse to the next like that, and it smears an order of 10 by a quarter radian."""
ALTERNATES = -0.55
"""Correlation of a pulse's third difference with the next one's, below which it is an error of single pulses: -0.75 of
errors that are independent, -1/3 of a speed that random torques make wander, -2/3 of one that changes from pulse to
pulse at random. Of 100 made records of 8 s each at 24.7 Hz a wander of 3 or 10 % (random, first order, below 0.8 Hz) is
never told (76 and 100 by the power alone), errors of 0.5 % are 99 times, and of 1 % beside such a wander."""
EVEN_TEETH = 3
MISSED = 1.7
SPEED_TOLERANCE = 0.02
MIN_TURNS = 20.0
"""Turns of the slowest part that give its lines three bins of distance from those beside them."""


def time_stamp_findings(times_s: FloatArray, label: str) -> tuple[Finding, ...]:
    """`irregular_time` for time stamps, shape (n,), s, that no uniform clock gave."""
    base = read_time_base(times_s)
    if base.uniform:
        return ()
    steps = times_s.size - 1
    bad = base.gaps + base.repeated + base.backward
    detail = f"{base.gaps} gaps, {base.repeated} repeated and {base.backward} backward of {steps} time steps"
    return (
        Finding(
            kind="irregular_time",
            channel="",
            recording=label,
            detail=f"{detail}; longest step {base.longest_step_s:.4g} s",
            severity=float(min(1.0, bad / steps + base.largest_jitter_s * base.sampling_rate_hz / 100)),
            where=f"from sample {base.first_place} on",
            fault=bad > 0 or base.largest_jitter_s * base.sampling_rate_hz > 1,
        ),
    )


def tacho_findings(recording: Recording, label: str) -> tuple[Finding, ...]:
    """`tacho_jitter`: pulses scatter, are missed or counted twice.

    Uneven teeth of the pulse wheel repeat every turn and are taken out first. The third difference of the pulse times,
    which a smoothly changing speed does not have, tells what is left (`_jitter_s`).
    """
    tacho = recording.tacho
    if tacho is None or tacho.pulse_times_s.size < 12:
        return ()
    pulses = np.asarray(tacho.pulse_times_s, dtype=np.float64)
    steps = np.diff(pulses)
    typical = float(np.median(steps))
    wrong = (steps > MISSED * typical) | (steps < typical / MISSED)
    local = np.convolve(wrong, np.ones(4), mode="full")[: steps.size + 3] > 0
    third = np.diff(pulses, 3)
    per_turn = tacho.pulses_per_revolution
    if per_turn > 1 and third.size >= EVEN_TEETH * per_turn:
        for tooth in range(per_turn):
            third[tooth::per_turn] -= np.mean(third[tooth::per_turn])
    clean = ~local[3 : 3 + third.size]
    jitter = _jitter_s(third, clean if np.any(clean) else ~clean) / typical
    quantum = 1 / recording.sampling_rate_hz / typical / np.sqrt(12)
    missed = int(np.sum(wrong))
    if jitter < max(JITTER, 2 * quantum) and missed == 0:
        return ()
    said = [f"{missed} of {steps.size} intervals are of missed or doubled pulses"] if missed else []
    said += [f"each pulse is off by {percent(jitter, 2)} of its interval (RMS)"] if jitter > 0 else []
    first = f"first at {pulses[int(np.flatnonzero(wrong)[0])]:.6g} s" if missed else ""
    return (
        Finding(
            kind="tacho_jitter",
            channel="tacho",
            recording=label,
            detail=", ".join(said),
            severity=float(min(1.0, 10 * jitter + missed / steps.size)),
            where=first,
            fault=True,
        ),
    )


def _jitter_s(third: FloatArray, kept: BoolArray) -> float:
    """Standard deviation of a pulse's own error, s, from the third differences (n,) that are `kept` (n,).

    Independent errors give them 20 times their variance and -15 times that between neighbours; a speed that wanders by
    random torques a third of its own, negative: of both together a 25th of what is left of the sum counts.
    """
    pairs = kept[1:] & kept[:-1]
    if not np.any(pairs):
        return float(np.sqrt(np.mean(third[kept] ** 2) / 20))
    power = float(np.mean(third[kept] ** 2))
    beside = float(np.mean((third[1:] * third[:-1])[pairs]))
    return float(np.sqrt(max(0.0, -(power + 3 * beside) / 25))) if beside < ALTERNATES * power else 0.0


def length_findings(recording: Recording, label: str, speed_hz: float, lowest_order: float) -> tuple[Finding, ...]:
    """`too_short`: fewer than 20 turns of what turns slowest."""
    turns = recording.duration_s * speed_hz * lowest_order
    if turns >= MIN_TURNS:
        return ()
    needed_s = MIN_TURNS / max(speed_hz * lowest_order, 1e-9)
    detail = (
        f"{recording.duration_s:.4g} s hold {turns:.3g} turns of order {lowest_order:.3g}; {MIN_TURNS:g} are needed, "
        f"{needed_s:.2g} s"
    )
    severity = float(1 - turns / MIN_TURNS)
    return (Finding(kind="too_short", channel="", recording=label, detail=detail, severity=severity),)


def speed_findings(speed: SpeedEstimate, label: str) -> tuple[Finding, ...]:
    """`speed_mismatch`: the shaft did not turn as fast as stated (a remark: the later stages use the found speed)."""
    if speed.mismatch is None or speed.method == "stated" or abs(speed.mismatch) <= SPEED_TOLERANCE:
        return ()
    detail = f"{speed.shaft} turned at {speed.speed_hz:.4g} Hz ({speed.low_hz:.5g} to {speed.high_hz:.5g}), "
    detail += f"{signed_percent(speed.mismatch)} from the stated {speed.stated_hz:.4g} Hz"
    severity = float(min(1.0, abs(speed.mismatch) / 0.1))
    return (Finding(kind="speed_mismatch", channel="", recording=label, detail=detail, severity=severity),)
