"""A row of a dataset for a screen: its columns, and on request signal and spectrum, thinned."""

from __future__ import annotations

import numpy as np

from jobs.results import plain
from jobs.thinning import highest, min_max
from sideband_datasets.formats.record import Record
from signals.series import Series
from signals.spectra.amplitude import amplitude_spectrum
from signals.spectra.envelope import envelope_spectrum
from signals.spectra.types import Spectrum


def row_document(record: Record, *, signal: bool, spectrum: bool, max_points: int) -> dict[str, object]:
    """The row as JSON has it. Thinned signals keep the lowest and highest value of each stretch, spectra the highest
    line. With the spectrum goes that of the envelope where a peak of it is labelled, in the band the label was found
    in."""
    columns = {name: plain(value) for name, value in record.items() if name != "signal"}
    samples = np.asarray(record["signal"], dtype=np.float64)
    rate = float(record["sampling_rate_hz"])
    found: dict[str, object] = {"columns": columns}
    if signal:
        t = np.arange(samples.size) / rate
        x, y = min_max(t, samples, max_points)
        found["signal"] = {"unit": record["unit"], "t_s": x.tolist(), "values": plain(y)}
    if spectrum:
        series = Series(samples=samples, sampling_rate_hz=rate, unit=str(record["unit"]))
        found["spectrum"] = _thinned(amplitude_spectrum(series), max_points)
        if any(peak["spectrum"] == "envelope" for peak in record["peaks"]):
            found["envelope"] = _thinned(envelope_spectrum(series), max_points)
    return found


def _thinned(made: Spectrum, max_points: int) -> dict[str, object]:
    f, a = highest(made.frequency_hz, made.values, max_points)
    band = {} if made.band is None else {"band_hz": [made.band.low_hz, made.band.high_hz]}
    scale = {"unit": made.unit, "amplitude": made.scaling, "window": made.window, **band}
    return {**scale, "frequency_hz": f.tolist(), "values": plain(a)}
