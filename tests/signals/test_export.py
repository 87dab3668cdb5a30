"""Documents are JSON with units."""

import json

import numpy as np

from signals.export import features_document, spectrogram_document, spectrum_document
from signals.features import features, line_amplitudes
from signals.series import Series
from signals.spectra import amplitude_spectrum, envelope_spectrum, order_spectrum, spectrogram


def test_every_result_becomes_strict_json_with_its_unit() -> None:
    t = np.arange(4000) / 1000
    series = Series(samples=np.sin(2 * np.pi * 100 * t), sampling_rate_hz=1000.0, unit="g", name="a")
    amplitude = amplitude_spectrum(series)
    envelope = envelope_spectrum(series, band=(50.0, 150.0))
    order = order_spectrum(series, shaft="input", rotation=25.0)
    documents = [
        spectrum_document(amplitude),
        spectrum_document(envelope),
        spectrum_document(order),
        spectrogram_document(spectrogram(series)),
        features_document(features(series), line_amplitudes(amplitude, {"f_m": 100.0}, "f_m", [1, 2])),
    ]
    read = [json.loads(json.dumps(d, allow_nan=False)) for d in documents]
    assert all(d["unit"] == "g" for d in read)
    assert read[0]["frequency_hz"][400] == 100.0 and abs(read[0]["values"][400] - 1) < 1e-9
    assert read[1]["band"]["low_hz"] == 50.0 and read[1]["band"]["impulsive"] is None
    assert len(read[2]["order"]) == len(read[2]["values"]) and read[2]["shaft"] == "input"
    assert len(read[3]["values"]) == len(read[3]["frequency_hz"])
    assert read[4]["lines"][0]["label"] == "1*f_m"
