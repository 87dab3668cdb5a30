"""Mains hum: lines at multiples of 50 or 60 Hz that stay there at every speed and are not the machine's own."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reconcile.gate.findings import Finding
from reconcile.gate.sines import without_sines
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
PULLS, EVEN = np.array([2.0, 4.0]), 0.04
"""Multiples of a supply that a motor's pull makes, and by which a line may miss one."""


def hum_findings(
    recording: Recording, label: str, expected_hz: FloatArray, baselines: Sequence[Recording]
) -> tuple[Finding, ...]:
    """One `mains_hum` a channel; `expected_hz` (lines,) are the machine's own lines near which nothing is claimed."""
    found = []
    for name in recording.names:
        lines = hum_lines(recording, name, expected_hz)
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
                detail=f"lines at {places} Hz hold {share:.1%} of the power{change}",
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


def hum_lines(recording: Recording, channel: str, expected_hz: FloatArray) -> list[tuple[float, float]]:
    """(frequency in Hz, peak amplitude) of the lines at multiples of one mains frequency that are not expected."""
    series = recording.series(channel)
    excess, resolution = line_excess(series)
    spectrum = amplitude_spectrum(series)
    best: list[tuple[float, float]] = []
    for mains in MAINS_HZ:
        lines = []
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
                lines.append((hz, float(spectrum.values[peak])))
        # hum without its fundamental or the magnetic pull at twice is some machine's line that happens to be there
        strong = any(abs(hz - mains * k) <= TOLERANCE * mains * k + resolution for hz, _ in lines for k in (1, 2))
        if strong and sum(a for _, a in lines) > sum(a for _, a in best):
            best = lines
    return best


def without_hum(recording: Recording, expected_hz: FloatArray) -> Recording:
    """The recording with sines at its hum lines (frequency refined on the data) fitted and subtracted."""
    lines = {name: [hz for hz, _ in hum_lines(recording, name, expected_hz)] for name in recording.names}
    return without_sines(recording, lines)


def power_at(recording: Recording, channel: str, lines_hz: Sequence[float]) -> float:
    """Power of a channel in the bins of given lines, its unit squared."""
    spectrum = amplitude_spectrum(recording.series(channel))
    place = np.rint(np.asarray(lines_hz) / spectrum.resolution_hz).astype(np.int64)
    place = np.clip(place, 1, spectrum.values.size - 2)
    top = np.max(np.stack([spectrum.values[place + k] for k in (-1, 0, 1)]), axis=0)
    return float(np.sum(top**2) / 2)
