"""What holds for the labels of any signal of sines."""

from dataclasses import replace

import pytest
from gearbox import BASES, KINEMATICS, LINES, RATE, sines
from hypothesis import given, settings
from hypothesis import strategies as st

from signals.labels import label_peaks, merge_lines
from signals.spectra import amplitude_spectrum

GEAR = {690.0: 1.0, 660.0: 0.02, 720.0: 0.03, 1380.0: 0.5}
OUTER = {BASES["f_o1"]: 0.01, 2 * BASES["f_o1"]: 0.005, 11 * BASES["f_o1"]: 0.004}


@pytest.mark.slow
@settings(deadline=None, max_examples=25)
@given(
    lines=st.dictionaries(st.floats(20.0, 4900.0), st.floats(1e-3, 10.0), max_size=12),
    seed=st.integers(0, 100),
)
def test_every_predicted_line_has_one_entry_and_every_peak_an_owner(lines: dict[float, float], seed: int) -> None:
    spectrum = amplitude_spectrum(sines(lines, seconds=1.0, seed=seed))
    found = label_peaks(spectrum, LINES, BASES, kinematics=KINEMATICS)
    names = [p.label for p in found.peaks if p.label]
    assert len(names) == len(set(names))
    inside = [c for c in merge_lines(LINES, BASES, KINEMATICS) if 2.0 <= c.frequency_hz <= RATE / 2 - 2.0]
    listed = [p for p in found.peaks if p.label and p.family != "combination" and p.status != "above_nyquist"]
    assert {p.label for p in listed} == {c.label for c in inside}
    for peak in found.peaks:
        assert (peak.amplitude is None) == (peak.status in ("absent", "above_nyquist"))
        assert (peak.detection_limit is not None) == (peak.status == "absent")
        assert (bool(peak.alternatives) or peak.evidence == "chance") == (peak.status == "ambiguous")
        assert bool(peak.evidence) == (peak.status in ("present", "ambiguous"))
    owned = {p.measured_frequency_hz for p in found.peaks if p.amplitude is not None}
    assert len(owned) == found.found - found.truncated


@pytest.mark.slow
@settings(deadline=None, max_examples=20)
@given(scale=st.floats(1e-6, 1e6))
def test_labels_do_not_depend_on_the_unit(scale: float) -> None:
    series = sines(GEAR | OUTER)
    plain = label_peaks(amplitude_spectrum(series), LINES, BASES, kinematics=KINEMATICS)
    scaled_series = replace(series, samples=series.samples * scale)
    scaled = label_peaks(amplitude_spectrum(scaled_series), LINES, BASES, kinematics=KINEMATICS)
    assert [(p.label, p.status) for p in plain.peaks] == [(p.label, p.status) for p in scaled.peaks]
