"""A row of a dataset for a screen: its columns, and on request signal and spectrum, thinned."""

from __future__ import annotations

import numpy as np

from jobs.results import plain
from jobs.thinning import highest, min_max
from sideband_datasets.formats.record import Record
from signals.series import Series
from signals.spectra.amplitude import amplitude_spectrum


def row_document(record: Record, *, signal: bool, spectrum: bool, max_points: int) -> dict[str, object]:
    """The row as JSON has it. Thinned signals keep the lowest and highest value of each stretch, spectra the highest
    line."""
    columns = {name: plain(value) for name, value in record.items() if name != "signal"}
    samples = np.asarray(record["signal"], dtype=np.float64)
    rate = float(record["sampling_rate_hz"])
    found: dict[str, object] = {"columns": columns}
    if signal:
        t = np.arange(samples.size) / rate
        x, y = min_max(t, samples, max_points)
        found["signal"] = {"unit": record["unit"], "t_s": x.tolist(), "values": plain(y)}
    if spectrum:
        made = amplitude_spectrum(Series(samples=samples, sampling_rate_hz=rate, unit=str(record["unit"])))
        f, a = highest(made.frequency_hz, made.values, max_points)
        scale = {"unit": made.unit, "amplitude": "peak", "window": "hann"}
        found["spectrum"] = {**scale, "frequency_hz": f.tolist(), "values": plain(a)}
    return found
