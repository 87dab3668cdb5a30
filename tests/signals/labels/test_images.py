"""Lines that the steps of a simulation make, in synthetic signals."""

import numpy as np
import pytest
from gearbox import BASES, KINEMATICS, LINES, sines

from signals.labels import label_peaks
from signals.labels.types import LabelSet
from signals.spectra import amplitude_spectrum
from sim.core.lines import Line

F_O1, STEP_HZ = BASES["f_o1"], 60_000.0
BALLS = [
    Line(orders=(("f_o1", k),), component="bearing1", mechanism="ball_contact", family="outer") for k in range(1, 7)
]
SERIES = {k * F_O1: 1.0 / k for k in range(1, 60)}
IMAGES = {abs(k * F_O1 - STEP_HZ): 0.01 for k in range(770, 785)}


def labels(lines: dict[float, float], step_hz: float | None) -> LabelSet:
    spectrum = amplitude_spectrum(sines(lines, seconds=4.0, noise=1e-4))
    return label_peaks(spectrum, [*LINES, *BALLS], BASES, kinematics=KINEMATICS, step_hz=step_hz)


def test_a_long_series_of_a_predicted_base_goes_on() -> None:
    found = labels(SERIES, None)
    for k in range(1, 60):
        peak = found[f"{k}*f_o1"]
        assert (peak.status, peak.family, peak.mechanism) == ("present", "outer", "ball_contact"), k
        assert peak.components == ("bearing1", "bearing2")
    assert [found[f"{k}*f_o1"].evidence for k in (6, 7, 21)] == ["term", "family", "sum"]
    assert not [p for p in found.peaks if p.label == "60*f_o1"]  # listed only where found


@pytest.mark.slow
def test_images_of_the_series_are_named_by_the_step_rate() -> None:
    found = labels(SERIES | IMAGES, STEP_HZ)
    assert found.frequencies_hz["f_s"] == STEP_HZ and found.unexplained == 0
    images = [p for p in found.peaks if p.family == "numerical"]
    assert {p.label for p in images} == {f"{k}*f_o1-1*f_s" for k in range(770, 785)}
    assert {(p.status, p.mechanism, p.evidence) for p in images} == {("present", "step_image", "sum")}
    unknown = labels(SERIES | IMAGES, None)
    assert unknown.unexplained == len(IMAGES) and "f_s" not in unknown.frequencies_hz


def test_a_few_lines_anywhere_are_no_images() -> None:
    places = np.random.default_rng(4).uniform(200.0, 4900.0, 30)
    found = labels(SERIES | {float(f): 0.01 for f in places}, STEP_HZ)
    assert not [p for p in found.peaks if p.family == "numerical" and p.status == "present"]
    assert found.unexplained == pytest.approx(30, abs=3)
