"""Mains hum: lines at multiples of 50 or 60 Hz that stay there at every speed and are not the machine's own."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reconcile.gate.findings import Finding
from reconcile.gate.sines import without_sines
from reconcile.shares import percent
from reconcile.speed.excess import line_excess
from signals.recording import Recording
from signals.series import FloatArray
from signals.spectra.amplitude import amplitude_spectrum

MAINS_HZ = (50.0, 60.0)
HARMONICS = (1, 2, 3, 4, 5, 6, 7)
PRESENT_DB = 15.0
"""Power over the local floor; noise reaches it in one bin of 1e13."""
GROWN_DB = 6.0
MATERIAL_SHARE = 0.01
"""Of the channel's power, where there is no baseline to tell whether the hum is new."""
LEAST_SHARE = 0.002
"""Of the channel's power that new hum must hold to explain anything."""
TOLERANCE = 0.002
SUPPLY, FINE = 0.0012, 0.25
"""By which a supply's frequency may be off (clocks of recorders with it), and a line's place in bins."""
HALF_BINS = 1.2
"""By which a line may miss a half multiple of a shaft's speed."""
NONE_HZ: FloatArray = np.zeros(0)
PULLS, EVEN = np.array([2.0, 4.0]), 0.04
"""Multiples of a supply that a motor's pull makes, and by which a line may miss one."""


def hum_findings(
    recording: Recording,
    label: str,
    expected_hz: FloatArray,
    baselines: Sequence[Recording],
    halves_hz: FloatArray = NONE_HZ,
) -> tuple[Finding, ...]:
    """One `mains_hum` a channel; `expected_hz` (lines,) are the machine's own lines near which nothing is claimed,
    `halves_hz` half multiples of its shafts, which alone are none."""
    found = []
    for name in recording.names:
        lines = hum_lines(recording, name, expected_hz, halves_hz)
        if not lines:
            continue
        power = sum(a**2 / 2 for _, a in lines)
        share = power / max(float(np.var(recording.series(name).samples)), 1e-300)
        before = [power_at(b, name, [hz for hz, _ in lines]) for b in baselines if name in b.names]
        grown = None if not before else 10 * np.log10(power / max(*before, 1e-300))
        fault = share > MATERIAL_SHARE if grown is None else bool(grown > GROWN_DB and share > LEAST_SHARE)
        change = "" if grown is None else f", {grown:+.0f} dB against the baseline"
        if fault and grown is None and _pulls([hz for hz, _ in lines]):
            fault, change = False, "; twice the supply and no odd multiple: the pull of a motor makes that too"
        places = ", ".join(f"{hz:.5g}" for hz, _ in lines)
        found.append(
            Finding(
                kind="mains_hum",
                channel=name,
                recording=label,
                detail=f"lines at {places} Hz hold {percent(share)} of the power{change}",
                severity=float(min(1.0, share)),
                where=f"{lines[0][0]:.5g} Hz and multiples",
                fault=fault,
            )
        )
    return tuple(found)


def _pulls(lines_hz: Sequence[float]) -> bool:
    """Whether all lines are at twice or four times one supply's frequency, as a magnetic pull makes them and pick-up
    seldom does."""
    found = np.asarray(lines_hz)
    return any(bool(np.all(np.min(np.abs(found[:, None] / m - PULLS), axis=1) < EVEN)) for m in MAINS_HZ)


def hum_lines(
    recording: Recording,
    channel: str,
    expected_hz: FloatArray,
    halves_hz: FloatArray = NONE_HZ,
    *,
    alone: bool = False,
) -> list[tuple[float, float]]:
    """(frequency in Hz, peak amplitude) of the lines at multiples of one mains frequency that are not expected, one at
    least no half multiple of a shaft; `alone`: without the first or second multiple too."""
    series = recording.series(channel)
    excess, resolution = line_excess(series)
    spectrum = amplitude_spectrum(series)
    best: list[tuple[float, float]] = []
    for mains in MAINS_HZ:
        rows: list[tuple[int, float, float, float]] = []
        for k in HARMONICS:
            reach = max(1, int(np.ceil(TOLERANCE * mains * k / resolution)))
            middle = round(mains * k / resolution)
            if middle + reach + 1 >= excess.size or middle - reach < 2:
                continue
            peak = middle - reach + int(np.argmax(excess[middle - reach : middle + reach + 1]))
            hz = peak * resolution
            own = expected_hz.size > 0 and float(np.min(np.abs(expected_hz - hz))) < 2.5 * resolution
            if (
                10 * np.log10(excess[peak]) > PRESENT_DB
                and excess[peak] >= excess[peak - 1 : peak + 2].max()
                and not own
            ):
                fine = (peak + _between(excess[peak - 1 : peak + 2])) * resolution
                rows.append((k, hz, fine, float(spectrum.values[peak])))
        lines = _of_one_supply(rows, mains, resolution)
        # hum without its fundamental or the magnetic pull at twice is some machine's line that happens to be there
        strong = any(abs(hz - mains * k) <= TOLERANCE * mains * k + resolution for hz, _ in lines for k in (1, 2))
        free = any(not near_half(hz, halves_hz, resolution) for hz, _ in lines)
        if (strong or alone) and free and sum(a for _, a in lines) > sum(a for _, a in best):
            best = lines
    return best


def near_half(hz: float, halves_hz: FloatArray, step_hz: float) -> bool:
    """Whether a line is at a half multiple of a shaft: looseness and rub make 0.5, 1.5, 2.5 ... times its speed."""
    return halves_hz.size > 0 and float(np.min(np.abs(halves_hz - hz))) < HALF_BINS * step_hz


def _between(power: FloatArray) -> float:
    """Where between three bins the top of a line is: the vertex of the parabola through their logarithms."""
    low, top, high = np.log(np.maximum(power, 1e-300))
    bend = low - 2 * top + high
    return float(np.clip((low - high) / (2 * bend), -0.5, 0.5)) if bend < 0 else 0.0


def _of_one_supply(
    rows: Sequence[tuple[int, float, float, float]], mains_hz: float, resolution_hz: float
) -> list[tuple[float, float]]:
    """(Hz, amplitude) of those lines (number, Hz of the bin, Hz, amplitude) that are multiples of one frequency which a
    supply may have: the highest tells it best. The second turn of a motor at 29.9 Hz is near 60 Hz, but no supply's."""
    fine = FINE * resolution_hz
    near = [r for r in rows if abs(r[2] - r[0] * mains_hz) <= SUPPLY * r[0] * mains_hz + fine]
    if not near:
        return []
    top, _, hz, _ = near[-1]
    return [(f, a) for k, f, exact, a in near if abs(exact - k * hz / top) <= fine * (1 + k / top)]


def without_hum(recording: Recording, expected_hz: FloatArray, halves_hz: FloatArray = NONE_HZ) -> Recording:
    """The recording with sines at its hum lines (frequency refined on the data) fitted and subtracted."""
    lines = {name: [hz for hz, _ in hum_lines(recording, name, expected_hz, halves_hz)] for name in recording.names}
    return without_sines(recording, lines)


def power_at(recording: Recording, channel: str, lines_hz: Sequence[float]) -> float:
    """Power of a channel in the bins of given lines, its unit squared."""
    spectrum = amplitude_spectrum(recording.series(channel))
    place = np.rint(np.asarray(lines_hz) / spectrum.resolution_hz).astype(np.int64)
    place = np.clip(place, 1, spectrum.values.size - 2)
    top = np.max(np.stack([spectrum.values[place + k] for k in (-1, 0, 1)]), axis=0)
    return float(np.sum(top**2) / 2)
