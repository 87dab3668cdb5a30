"""An effect at work: a signal and a spectrum of its demonstration machine, with it and without."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from jobs.demonstration import demonstration, predicted
from jobs.documents import FloatArray
from jobs.example_lines import Predicted, Seen, in_envelope, seen
from jobs.thinning import highest
from signals.recording import Recording, from_response
from signals.series import Series
from signals.spectra import amplitude_spectrum, envelope_spectrum
from signals.spectra.types import Spectrum
from sim.core.response import Channel
from sim.core.spec import MachineSpec
from sim.core.terms import Term
from sim.solve.api import simulate
from sim.solve.settings import Settings

SETTLING_S, SPAN_S, RATE_HZ = 0.2, 1.0, 20_000.0
MAX_POINTS = 2000
MARGIN = 1.3
LEAST_SPAN_HZ = 200.0
"""The spectrum is shown up to `MARGIN` times the highest marked line, at least so far."""


@dataclass(frozen=True, kw_only=True)
class View:
    """One channel with the effect and without, its spectra, and the lines that they show."""

    channel: Channel
    here: Series
    there: Series | None
    spectrum: Spectrum
    other: Spectrum | None
    lines: Seen


def example(term: Term) -> dict[str, object]:
    """The document: `signal` and `spectrum`, each `with` and `without` (None for a built-in effect), and the lines.

    `lines` are the strongest predicted ones that stand out here, `unseen` the leading predicted ones that do not. The
    channel is the first acceleration, of the default channels after the start-up, that shows half as many of the
    leading ones as any other or more. Both
    envelopes are of the band that suits the signal with the effect. Spectra are of the whole span; of the signal, the
    first `MAX_POINTS` samples (0.1 s) are given, as thinning would hide the shape of impacts.
    """
    shown = demonstration(term)
    lines = predicted(term, shown)
    here = _recorded(shown.machine)
    there = None if shown.machine == shown.without else _recorded(shown.without)
    felt = [c for c in here.channels if c.quantity == "acceleration"] or list(here.channels[:1])
    views = [_view(here, there, channel, lines, falls=term.demo.falls) for channel in (felt if lines else felt[:1])]
    best = next(view for view in views if 2 * view.lines.leading >= max(v.lines.leading for v in views))
    marked = best.lines.marked
    top_hz = max([LEAST_SPAN_HZ, *(MARGIN * hz for _, hz in marked)]) if marked else RATE_HZ / 20
    return {
        "key": term.key,
        "channel": best.channel.name,
        "unit": best.channel.unit,
        "note": term.demo.note,
        "signal": {"with": _signal(best.here), "without": None if best.there is None else _signal(best.there)},
        "spectrum": {
            "kind": best.spectrum.kind,
            "unit": best.spectrum.unit,
            "resolution_hz": best.spectrum.resolution_hz,
            "with": _spectrum(best.spectrum, top_hz),
            "without": None if best.other is None else _spectrum(best.other, top_hz),
        },
        "lines": [{"label": line.label, "family": line.family, "frequency_hz": hz} for line, hz in marked],
        "unseen": list(best.lines.unseen),
    }


def _view(here: Recording, there: Recording | None, channel: Channel, lines: list[Predicted], *, falls: bool) -> View:
    a, b = here.series(channel.name), None if there is None else there.series(channel.name)
    envelope = in_envelope(lines) and float(a.samples.std()) > 0
    spectrum = envelope_spectrum(a) if envelope else amplitude_spectrum(a)
    other = None
    if b is not None:
        other = envelope_spectrum(b, band=spectrum.band) if envelope else amplitude_spectrum(b)
    found = seen(lines, spectrum, other, falls=falls)
    return View(channel=channel, here=a, there=b, spectrum=spectrum, other=other, lines=found)


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
