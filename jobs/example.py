"""An effect at work: a signal and a spectrum of its demonstration machine, with it and without."""

from __future__ import annotations

import numpy as np

from jobs.demonstration import demonstration, predicted
from jobs.documents import FloatArray
from jobs.thinning import highest
from signals.recording import Recording, from_response
from signals.series import Series
from signals.spectra import amplitude_spectrum, envelope_spectrum
from signals.spectra.types import Spectrum
from sim.core.spec import MachineSpec
from sim.core.terms import Term
from sim.solve.api import simulate
from sim.solve.settings import Settings

SETTLING_S, SPAN_S, RATE_HZ = 0.2, 0.5, 20_000.0
MAX_POINTS = 2000
LEADING = 6
"""Lines that are marked."""
IN_ENVELOPE = frozenset({"outer", "inner", "ball", "cage"})
"""Families whose rate shows in the envelope of a resonance rather than as a line of its own."""
MARGIN = 1.3
LEAST_SPAN_HZ = 200.0
"""The spectrum is shown up to `MARGIN` times the highest marked line, at least so far."""


def example(term: Term) -> dict[str, object]:
    """The document: `signal` and `spectrum`, each `with` and `without` (None for a built-in effect), and the lines.

    The channel is the first acceleration of the default channels, after the start-up. Both envelopes are of the band
    that suits the signal with the effect. Spectra are of the whole span; of the signal, the first `MAX_POINTS` samples
    (0.1 s) are given, as thinning would hide the shape of impacts.
    """
    shown = demonstration(term)
    lines = predicted(term, shown)[:LEADING]
    first = _recorded(shown.machine)
    channel = next((c for c in first.channels if c.quantity == "acceleration"), first.channels[0])
    here = first.series(channel.name)
    there = None if shown.machine == shown.without else _recorded(shown.without).series(channel.name)
    envelope = bool(lines) and lines[0][0].family in IN_ENVELOPE and float(here.samples.std()) > 0
    spectrum = envelope_spectrum(here) if envelope else amplitude_spectrum(here)
    other = None
    if there is not None:
        other = envelope_spectrum(there, band=spectrum.band) if envelope else amplitude_spectrum(there)
    top_hz = max([LEAST_SPAN_HZ, *(MARGIN * hz for _, hz in lines)]) if lines else RATE_HZ / 20
    return {
        "key": term.key,
        "channel": channel.name,
        "unit": channel.unit,
        "signal": {"with": _signal(here), "without": None if there is None else _signal(there)},
        "spectrum": {
            "kind": "envelope" if envelope else "amplitude",
            "unit": spectrum.unit,
            "resolution_hz": spectrum.resolution_hz,
            "with": _spectrum(spectrum, top_hz),
            "without": None if other is None else _spectrum(other, top_hz),
        },
        "lines": [{"label": line.label, "family": line.family, "frequency_hz": hz} for line, hz in lines],
    }


def _recorded(machine: MachineSpec) -> Recording:
    settings = Settings(estimate_error=False)
    run = simulate(machine, duration_s=SETTLING_S + SPAN_S, output_rate_hz=RATE_HZ, settings=settings)
    return from_response(run).select(start_s=SETTLING_S)


def _signal(series: Series) -> dict[str, list[float]]:
    time_s = series.start_s + np.arange(MAX_POINTS) / series.sampling_rate_hz
    return _curve(time_s, series.samples[:MAX_POINTS])


def _spectrum(found: Spectrum, top_hz: float) -> dict[str, list[float]]:
    inside = found.frequency_hz <= top_hz
    return _curve(*highest(found.frequency_hz[inside], found.values[inside], MAX_POINTS))


def _curve(x: FloatArray, y: FloatArray) -> dict[str, list[float]]:
    return {"x": [float(f"{value:.7g}") for value in x], "y": [float(f"{value:.5g}") for value in y]}
