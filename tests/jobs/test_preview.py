"""What a row shows of itself: the envelope's spectrum beside the other where its lines are labelled."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from jobs.datasets.preview import row_document

RATE = 8000.0


def record(*spectra: str) -> dict[str, Any]:
    """A row of 2 kHz whose height beats at 100 Hz."""
    t = np.arange(8000) / RATE
    signal = (1 + 0.5 * np.sin(2 * np.pi * 100 * t)) * np.sin(2 * np.pi * 2000 * t)
    return {
        "signal": signal.astype(np.float32),
        "sampling_rate_hz": RATE,
        "unit": "m/s^2",
        "peaks": [{"spectrum": name} for name in spectra],
    }


def test_the_envelope_is_there_where_a_peak_of_it_is_labelled() -> None:
    found: Any = row_document(record("amplitude", "envelope"), signal=False, spectrum=True, max_points=4000)
    (low, high), f = found["envelope"]["band_hz"], np.array(found["envelope"]["frequency_hz"])
    assert low < 2000 < high and found["envelope"]["unit"] == "m/s^2" and found["envelope"]["amplitude"] == "peak"
    values = np.array(found["envelope"]["values"]) * (f > 10)
    assert f[values.argmax()] == pytest.approx(100, abs=1.5) and values.max() == pytest.approx(0.5, rel=0.05)


@pytest.mark.parametrize("spectra", [(), ("amplitude",)])
def test_without_such_a_peak_there_is_none(spectra: tuple[str, ...]) -> None:
    assert "envelope" not in row_document(record(*spectra), signal=False, spectrum=True, max_points=100)
    assert "spectrum" not in row_document(record("envelope"), signal=False, spectrum=False, max_points=100)
