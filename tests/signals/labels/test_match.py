"""Labels of synthetic signals with known lines."""

import json

import numpy as np
import pytest
from gearbox import BASES, INPUT_HZ, KINEMATICS, LINES, RATE, labelled, sines

from signals.export import labels_document
from signals.floor import FloorSettings
from signals.labels import Bound, Matching, kinematic_lines, label_peaks, merge_lines
from signals.spectra import amplitude_spectrum, envelope_spectrum, power_spectral_density
from sim.core.errors import SpecError, UnknownName
from sim.core.lines import Line

GEAR = {690.0: 1.0, 660.0: 0.02, 720.0: 0.03, 1380.0: 0.5}
OUTER = {BASES["f_o1"]: 0.01, 2 * BASES["f_o1"]: 0.005, 11 * BASES["f_o1"]: 0.004}


def test_known_lines_are_present_with_their_amplitude() -> None:
    found = labelled(GEAR | OUTER)
    for label, amplitude in (
        ("1*f_m", 1.0),
        ("1*f_m-1*f_r1", 0.02),
        ("1*f_m+1*f_r1", 0.03),
        ("2*f_m", 0.5),
        ("1*f_o1", 0.01),
        ("11*f_o1", 0.004),
    ):
        peak = found[label]
        assert peak.status == "present", label
        assert peak.label == label
        assert peak.amplitude == pytest.approx(amplitude, rel=0.01)
        assert peak.measured_frequency_hz == pytest.approx(peak.frequency_hz, abs=0.02)
        assert peak.order == pytest.approx(peak.frequency_hz / INPUT_HZ)
        assert (peak.unit, peak.scaling) == ("m/s^2", "peak")
        assert peak.chance_coincidence is not None and peak.chance_coincidence < 0.1
    assert {p.label for p in found.with_status("present")} == {
        "1*f_m", "1*f_m-1*f_r1", "1*f_m+1*f_r1", "2*f_m", "1*f_o1", "2*f_o1", "11*f_o1",
    }  # fmt: skip
    assert not found.with_status("ambiguous") and not found.with_status("unexplained")
    assert found["1*f_o1"].components == ("bearing1", "bearing2")


@pytest.mark.slow
def test_predicted_lines_that_are_not_there_are_absent_with_a_limit() -> None:
    found = labelled({690.0: 1.0})
    sideband = found["1*f_m+1*f_r1"]
    assert (sideband.status, sideband.amplitude, sideband.measured_frequency_hz) == ("absent", None, None)
    # the noise of 1e-3 has a bin amplitude of about 2 sigma sqrt(1.5 / n) = 1.7e-5 and a threshold of 3.7 times that
    assert sideband.detection_limit == pytest.approx(3.7 * 1.73e-5, rel=0.3)
    assert sideband.masked_by is None
    # a line of twice the limit is indeed found
    assert labelled({690.0: 1.0, 720.0: 2 * (sideband.detection_limit or 0)})["1*f_m+1*f_r1"].amplitude


def test_found_lines_nobody_predicts_are_unexplained() -> None:
    found = labelled(GEAR | {1234.567: 0.01})
    (stranger,) = found.with_status("unexplained")
    assert stranger.label == ""
    assert stranger.measured_frequency_hz == pytest.approx(1234.567, abs=0.01)
    assert stranger.amplitude == pytest.approx(0.01, rel=0.01)
    assert found.unexplained == 1


@pytest.mark.slow
def test_the_list_of_unexplained_lines_is_bounded_and_says_so() -> None:
    lines = {1000.0 + 37.77 * k: 0.01 for k in range(30)}
    found = labelled(GEAR | lines, max_unexplained=5, matching=Matching(max_chance=0.0))
    assert len(found.with_status("unexplained")) == 5
    assert found.unexplained == found.truncated + 5 > 20
    assert labelled(GEAR | lines, max_unexplained=0).truncated > 0


@pytest.mark.slow
def test_lines_beyond_the_axis_are_listed_as_such() -> None:
    lines = kinematic_lines(KINEMATICS, BASES, max_frequency_hz=np.inf)
    spectrum = amplitude_spectrum(sines(GEAR))
    found = label_peaks(spectrum, lines, BASES, kinematics=KINEMATICS)
    beyond = found.with_status("above_nyquist")
    assert found["8*f_m"].status == "above_nyquist" and found["8*f_m"].frequency_hz == pytest.approx(5520.0)
    assert all(p.frequency_hz > RATE / 2 - 2.0 and p.amplitude is None and p.detection_limit is None for p in beyond)
    assert not [p for p in found.with_status("absent") if p.frequency_hz > RATE / 2]
    inside = {p.label for p in found.peaks if p.label} - {p.label for p in beyond}
    assert {"7*f_m", "1*f_o1"} <= inside
    envelope = label_peaks(envelope_spectrum(sines(GEAR), band=(500.0, 1500.0)), lines, BASES, kinematics=KINEMATICS)
    assert not envelope.with_status("above_nyquist")  # its axis ends with the band, not with the record


def test_one_component_is_named_and_several_are_left_open() -> None:
    found = labelled(GEAR | OUTER)
    assert found["1*f_m"].component == "mesh1"
    assert found["1*f_o1"].component is None and found["1*f_o1"].components == ("bearing1", "bearing2")
    assert {p.mechanism_basis for p in found.peaks} == {"predicted"}


def two_sums(distance_hz: float) -> tuple[dict[str, float], list[Line]]:
    """Bases with 4 f_x a little above 3 f_r1."""
    bases = {"f_r1": 100.0, "f_x": (300.0 + distance_hz) / 4}
    lines = [
        Line(orders=(("f_r1", 3),), component="input", mechanism="a", family="shaft"),
        Line(orders=(("f_x", 4),), component="other", mechanism="b", family="other"),
    ]
    return bases, lines


def test_close_but_different_sums_are_ambiguous_with_a_probability() -> None:
    bases, lines = two_sums(0.01)
    spectrum = amplitude_spectrum(sines({300.0: 1.0}))
    found = label_peaks(spectrum, lines, bases)
    assert [p.status for p in found.peaks] == ["ambiguous", "ambiguous"]
    assert found["3*f_r1"].alternatives == ("4*f_x",)
    assert found["4*f_x"].alternatives == ("3*f_r1",)
    assert found["4*f_x"].measured_frequency_hz == found["3*f_r1"].measured_frequency_hz
    probability = found["3*f_r1"].chance_coincidence
    # one other line in +-50 Hz, a tie within 0.05 bins of 0.5 Hz: 1 - exp(-0.05/100)
    assert probability == pytest.approx(5e-4, rel=0.05)


def test_a_measurably_nearer_sum_wins_and_masks_the_other() -> None:
    bases, lines = two_sums(0.2)
    found = label_peaks(amplitude_spectrum(sines({300.0: 1.0})), lines, bases)
    assert found["3*f_r1"].status == "present"
    assert (found["4*f_x"].status, found["4*f_x"].masked_by) == ("absent", "3*f_r1")
    assert (found["4*f_x"].detection_limit or 0) > 0.5  # nothing can be said below the peak that hides it


def test_a_weak_line_cannot_be_told_apart_where_a_strong_one_can() -> None:
    bases, lines = two_sums(0.1)
    weak = label_peaks(amplitude_spectrum(sines({300.0: 1e-4}, seed=3)), lines, bases)
    strong = label_peaks(amplitude_spectrum(sines({300.0: 1.0}, seed=3)), lines, bases)
    assert weak["3*f_r1"].status == "ambiguous"
    assert strong["3*f_r1"].status == "present"


def test_far_fetched_sums_do_not_compete_with_simple_ones() -> None:
    bases = {"f_r1": 100.0, "f_x": 300.0 / 40}
    lines = [
        Line(orders=(("f_r1", 3),), component="input", mechanism="a", family="shaft"),
        Line(orders=(("f_x", 40),), component="other", mechanism="b", family="other"),
    ]
    spectrum = amplitude_spectrum(sines({300.0: 1.0}))
    assert label_peaks(spectrum, lines, bases)["3*f_r1"].status == "present"
    wide = label_peaks(spectrum, lines, bases, bound=Bound(ambiguity_weight=50))
    assert wide["3*f_r1"].status == "ambiguous"


def test_identical_sums_are_never_ambiguous() -> None:
    lines = [*LINES, Line(orders=(("f_r1", 22),), component="input", mechanism="kinematic", family="shaft")]
    spectrum = amplitude_spectrum(sines(GEAR))
    tied = label_peaks(spectrum, lines, BASES, kinematics=KINEMATICS)
    assert tied["22*f_r1"] is tied["1*f_m-1*f_r1"]
    assert tied["22*f_r1"].status == "present"
    assert "input" in tied["22*f_r1"].components
    untied = label_peaks(spectrum, lines, BASES, bound=Bound(ambiguity_weight=30))
    # without the ties only the numbers are known, and that no lower multiple of the shaft is there
    assert (untied["22*f_r1"].status, untied["22*f_r1"].alternatives) == ("ambiguous", ("1*f_m-1*f_r1",))
    assert untied["1*f_m-1*f_r1"].status == "present"


@pytest.mark.slow
def test_a_shifted_speed_is_met_with_a_relative_tolerance() -> None:
    shifted = {f * 1.004: a for f, a in (GEAR | OUTER).items()}
    assert not labelled(shifted)["1*f_o1"].amplitude
    found = labelled(shifted, matching=Matching(relative=0.006), bound=Bound(ambiguity_weight=3))
    assert found["1*f_m"].amplitude == pytest.approx(1.0, rel=0.01)
    assert found["1*f_o1"].measured_frequency_hz == pytest.approx(1.004 * BASES["f_o1"], rel=1e-4)


def test_sidelobes_of_strong_lines_are_not_lines() -> None:
    """Without noise the skirts of a line stand far above the floor; none of them is reported."""
    found = labelled({690.123: 1.0, 1380.246: 0.1}, noise=1e-13)
    assert found.found == 2


@pytest.mark.slow
@pytest.mark.parametrize("window", ["hann", "hamming", "blackman", "flattop", "blackmanharris", "boxcar"])
def test_every_window_finds_the_lines_and_their_amplitude(window: str) -> None:
    series = sines({690.0: 1.0, 1234.567: 0.3})
    found = label_peaks(amplitude_spectrum(series, window_name=window), LINES, BASES, kinematics=KINEMATICS)
    assert found["1*f_m"].amplitude == pytest.approx(1.0, rel=0.01)
    strangers = sorted(found.with_status("unexplained"), key=lambda p: -(p.amplitude or 0))
    assert strangers[0].amplitude == pytest.approx(0.3, rel=0.01)
    assert strangers[0].frequency_hz == pytest.approx(1234.567, abs=0.03)


def test_rms_spectra_give_rms_amplitudes() -> None:
    spectrum = amplitude_spectrum(sines(GEAR), amplitude="rms")
    peak = label_peaks(spectrum, LINES, BASES, kinematics=KINEMATICS)["1*f_m"]
    assert (peak.scaling, peak.amplitude) == ("rms", pytest.approx(np.sqrt(0.5), rel=1e-3))


def test_bad_questions_are_refused() -> None:
    spectrum = amplitude_spectrum(sines(GEAR))
    with pytest.raises(UnknownName, match="f_zz"):
        label_peaks(spectrum, [Line(orders=(("f_zz", 1),), component="", mechanism="", family="")], BASES)
    with pytest.raises(UnknownName, match="f_r9"):
        label_peaks(spectrum, LINES, BASES, reference="f_r9")
    with pytest.raises(SpecError, match=r"bases_hz\.f_m"):
        label_peaks(spectrum, LINES, BASES | {"f_m": 0.0})
    with pytest.raises(ValueError, match="density"):
        label_peaks(power_spectral_density(sines(GEAR)), LINES, BASES)
    with pytest.raises(SpecError, match="false_alarm"):
        FloorSettings(false_alarm=0.0)


def test_the_document_has_the_agreed_keys_and_is_json() -> None:
    document = json.loads(json.dumps(labels_document(labelled(GEAR | {1234.567: 0.01})), allow_nan=False))
    assert document["frequencies"]["f_o1"] == pytest.approx(77.2065)
    assert document["frequencies"]["f_m"] == 690.0
    keys = {"label", "frequency_hz", "order", "amplitude", "unit", "status", "components"}
    assert all(keys <= set(peak) for peak in document["peaks"])
    assert {p["status"] for p in document["peaks"]} <= {"present", "absent", "unexplained", "above_nyquist"}
    assert document["truncated"] == 0 and document["false_match"]["bound"] == 0.05
    assert document["bound"]["outer"] == 20 and document["floor"]["false_alarm"] == 1e-6


@pytest.mark.slow
def test_thousands_of_sums_on_a_long_axis_are_labelled() -> None:
    """2000 candidate sums over 1e5 bins (its time is kept by the benchmarks, not here)."""
    rich = [
        Line(orders=(("f_m", k), ("f_r1", n), ("f_o1", o)), component="c", mechanism="m", family="mesh")
        for k in range(1, 8)
        for n in range(-12, 13)
        for o in range(-6, 7)
    ]
    spectrum = amplitude_spectrum(sines(GEAR | OUTER, seconds=20.0))
    assert spectrum.values.size > 1e5 - 1
    found = label_peaks(spectrum, rich, BASES, kinematics=KINEMATICS)
    assert len(merge_lines(rich, BASES, KINEMATICS)) > 2000
    assert found["1*f_m+1*f_r1"].status in ("present", "ambiguous")
