"""An odd multiple of the supply's frequency without the first or the second: what a sensor picks up of a current.

Cables beside a drive or a saturated transformer bring 150 Hz and no 50 Hz. A line of the machine may happen to be there
as well, so more is asked than of hum: it is new, narrow, strong, at no order of the machine, in every test. Even
multiples (300 Hz of 50 and of 60 Hz among them) are left alone: a motor's torque and pull make them.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from reconcile.gate.findings import Finding
from reconcile.gate.mains import MAINS_HZ, MATERIAL_SHARE, SUPPLY, TOLERANCE, hum_lines, near_half, power_at
from reconcile.gate.sines import without_sines
from reconcile.gate.tones import Heard
from reconcile.shares import percent
from reconcile.speed.excess import line_excess
from signals.recording import Recording
from signals.series import FloatArray

ODD, EVEN = (3, 5, 7), (2, 4, 6, 8)
GROWN_DB = 12.0
"""Over every baseline, at the frequency and at the order. Of 499 channels of the proof's gearboxes none has a line at
such a place; at even ones it grew by 22 dB where the supply's torque or pull is the effect.
Pick-up that holds a hundredth of the power, made on motors, grew by 19 to 28 dB."""
PRESENT_DB, REACH_BINS = 20.0, 2.0


def harmonic_findings(
    tests: Sequence[Recording],
    label: str,
    speeds_hz: Sequence[float],
    expected_hz: Sequence[FloatArray],
    baselines: Sequence[tuple[Recording, float]],
    told: Collection[str] = (),
    halves_hz: Sequence[FloatArray] = (),
) -> tuple[tuple[Finding, ...], list[Recording]]:
    """One `mains_hum` a channel, and the tests without the lines; `baselines`: with their speeds, Hz; `told`: the
    channels whose hum is found; `halves_hz`: half multiples of the shafts at each test, which alone are no hum.
    Nothing is claimed without a baseline: a line that was always there may be the machine's."""
    found, clean = [], list(tests)
    for name in tests[0].names:
        before = [(one, hz) for one, hz in baselines if name in one.names]
        if name in told or not before or any(name not in one.names for one in tests):
            continue
        lines = _new_lines(tests, name, speeds_hz, expected_hz, before, halves_hz)
        share = min((_share(one, name, lines) for one in tests), default=0.0) if lines else 0.0
        if share < MATERIAL_SHARE:
            continue
        found.append(
            Finding(
                kind="mains_hum",
                channel=name,
                recording=label,
                detail=_detail(lines, share),
                severity=float(min(1.0, share)),
                where=f"{lines[0]:.5g} Hz",
                fault=True,
            )
        )
        clean = [without_sines(one, {name: lines}) for one in clean]
    return tuple(found), clean


def _detail(lines_hz: Sequence[float], share: float) -> str:
    places = ", ".join(f"{hz:.5g}" for hz in lines_hz)
    rest = f"{percent(share)} of the power; no baseline and no part of the machine has"
    if len(lines_hz) == 1:
        return f"a narrow line at {places} Hz, an odd multiple of the supply's frequency, holds {rest} it"
    return f"narrow lines at {places} Hz, odd multiples of the supply's frequency, hold {rest} them"


def _new_lines(
    tests: Sequence[Recording],
    name: str,
    speeds_hz: Sequence[float],
    expected_hz: Sequence[FloatArray],
    baselines: Sequence[tuple[Recording, float]],
    halves_hz: Sequence[FloatArray],
) -> list[float]:
    """Odd multiples of one supply's frequency, Hz, that every test has as narrow lines and no baseline has."""
    heard = [
        Heard(*line_excess(one.series(name)), hz, own)
        for one, hz, own in zip(tests, speeds_hz, expected_hz, strict=True)
    ]
    lines: list[float] = []
    loose: list[bool] = []
    for hz, _ in hum_lines(tests[0], name, expected_hz[0], alone=True):
        if not _odd(hz):
            continue
        at = [h.peak(hz, REACH_BINS + SUPPLY * hz / h.step_hz, PRESENT_DB, narrow=True) for h in heard]
        if any(place is None or h.own(place) for place, h in zip(at, heard, strict=True)):
            continue
        own = min(power_at(one, name, [place]) for one, place in zip(tests, at, strict=True) if place is not None)
        places = [(b, place) for b, turns in baselines for place in (hz, hz / speeds_hz[0] * turns)]
        had = max(power_at(b, name, [place]) for b, place in places)
        if own > had * 10 ** (GROWN_DB / 10):
            lines.append(hz)
            loose.append(any(near_half(p, f, h.step_hz) for p, f, h in zip(at, halves_hz, heard, strict=False) if p))
    return [] if all(loose) else lines


def _odd(hz: float) -> bool:
    """Whether a line is near an odd multiple of a supply's frequency, and near no even one of another's."""
    odd = any(abs(hz - k * supply) <= TOLERANCE * hz for supply in MAINS_HZ for k in ODD)
    even = any(abs(hz - k * supply) <= TOLERANCE * hz for supply in MAINS_HZ for k in EVEN)
    return odd and not even


def _share(one: Recording, name: str, lines_hz: Sequence[float]) -> float:
    return power_at(one, name, lines_hz) / max(float(np.var(one.series(name).samples)), 1e-300)
