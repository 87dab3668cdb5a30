"""Combinations explain what the families leave, and little of what they should not."""

import numpy as np
import pytest
from gearbox import BASES, KINEMATICS, LINES, labelled, sines

from signals.labels import Bound, Kinematics, Matching, label_peaks
from signals.labels.combinations import modulators
from signals.spectra import amplitude_spectrum
from sim.core.lines import Line

F_M, F_R1, F_O1 = BASES["f_m"], BASES["f_r1"], BASES["f_o1"]


@pytest.mark.slow
def test_a_sum_of_three_is_named_with_all_its_parts() -> None:
    found = labelled({F_M: 1.0, 2 * F_M + F_R1 - F_O1: 0.1, 2 * F_M - F_R1 + F_O1: 0.1})
    peak = found["2*f_m-1*f_o1+1*f_r1"]
    assert (peak.status, peak.family, peak.mechanism) == ("present", "combination", "intermodulation")
    assert peak.evidence == "sum"
    assert set(peak.components) == {"pinion", "bearing1", "bearing2"}
    assert peak.amplitude == pytest.approx(0.1, rel=0.01)
    assert peak.chance_coincidence is not None and peak.chance_coincidence <= 0.05
    assert found.unexplained == 0
    lone = labelled({F_M: 1.0, 2 * F_M + F_R1 - F_O1: 0.1})["2*f_m-1*f_o1+1*f_r1"]
    assert (lone.status, lone.evidence) == ("ambiguous", "chance")


@pytest.mark.slow
def test_a_sum_below_zero_folds() -> None:
    found = labelled({F_M: 1.0, 6 * F_O1 + 2 * F_R1 - F_M: 0.1, 4 * F_M - 1 * F_O1 + 2 * F_R1: 0.1}, seconds=20.0)
    assert found["1*f_m-6*f_o1-2*f_r1"].status == "present"


def test_combinations_are_listed_only_where_found() -> None:
    assert not [p for p in labelled({F_M: 1.0}).peaks if p.family == "combination"]


@pytest.mark.slow
def test_strangers_are_mostly_left_unexplained() -> None:
    """Each of 200 lines anywhere may meet a sum by chance with at most 5 %: 200 trials pass 20 with 0.2 %."""
    places = np.random.default_rng(11).uniform(50.0, 4900.0, 200)
    found = labelled({float(f): 1.0 for f in places}, seconds=20.0)
    explained = [p for p in found.peaks if p.family == "combination"]
    assert len(explained) <= 20
    assert found.unexplained > 150


@pytest.mark.slow
def test_the_false_match_rate_is_measured_and_bounded() -> None:
    """The rates told beside the labels are those of lines put anywhere: given a name, and called present."""
    rng = np.random.default_rng(5)
    places = np.sort(rng.uniform(50.0, 4900.0, 150))
    told = labelled({float(f): 1.0 for f in places}, seconds=20.0, noise=0.05).false_match
    assert told.combinations < 0.01 and told.families < 0.01
    assert 0 < told.ambiguous <= told.bound + 0.01 and told.bound == 0.05
    hits = 0
    for seed in range(4):
        again = np.random.default_rng(100 + seed).uniform(50.0, 4900.0, 150)
        found = labelled({float(f): 1.0 for f in again}, seconds=20.0, noise=0.05)
        named = [p for p in found.peaks if p.label and p.amplitude]
        hits += len({p.measured_frequency_hz for p in named})
        assert not [p for p in named if p.status == "present"]
    # 600 lines at the rate told: within four standard deviations
    assert abs(hits / 600 - told.ambiguous) < 4 * (told.ambiguous * (1 - told.ambiguous) / 600) ** 0.5


@pytest.mark.slow
def test_many_products_of_few_bases_are_explained() -> None:
    """j f_m + k f_o1 with k far beyond the families, and with a shaft: what clearance and run-out make together."""
    lines = {j * F_M + k * F_O1: 0.01 for j in range(1, 5) for k in (-14, -11, 10, 13, 17)}
    lines |= {j * F_M + n * F_R1 + k * F_O1: 0.01 for j in range(1, 5) for n in (-1, 1) for k in (-2, -1, 1, 2)}
    found = labelled({F_M: 1.0, **lines}, seconds=10.0)
    explained = [p for p in found.peaks if p.family == "combination"]
    assert len(explained) > 0.9 * len(lines)
    assert found.unexplained < 0.1 * len(lines)


def test_only_excited_bases_modulate() -> None:
    """With a term that speaks of f_r1 alone, f_r2 (9/32 of it here) explains nothing."""
    excited = Line(orders=(("f_m", 1), ("f_r1", 1)), component="pinion", mechanism="eccentricity", family="mesh")
    bound = Bound()
    assert {m.base for m in modulators(KINEMATICS, BASES, LINES, bound)} == {"f_r1", "f_r2", "f_o1", "f_o3"}
    assert {m.base for m in modulators(KINEMATICS, BASES, [*LINES, excited], bound)} == {"f_r1"}


def test_equal_bearings_are_one_modulator_of_two_components() -> None:
    found = {m.base: m.components for m in modulators(KINEMATICS, BASES, LINES, Bound())}
    assert found["f_o1"] == ("bearing1", "bearing2")


@pytest.mark.slow
def test_uncertain_speeds_leave_combinations_unproven() -> None:
    """With 1 % of uncertainty a combination is near every peak, so none proves anything."""
    found = labelled({F_M: 1.0, 3456.7: 0.1}, matching=Matching(relative=0.01))
    assert not [p for p in found.peaks if p.family == "combination"]
    assert labelled({F_M: 1.0, 1234.5: 0.1}, matching=Matching(max_chance=0.0)).unexplained == 1


def test_machines_without_a_mesh_have_no_combinations() -> None:
    lone = Kinematics(shafts=KINEMATICS.shafts[:1])
    lines = [x for x in LINES if x.family == "shaft" and x.component == "input"]
    found = label_peaks(amplitude_spectrum(sines({F_R1: 1.0, 1234.5: 0.1})), lines, BASES, kinematics=lone)
    assert found.unexplained == 1
