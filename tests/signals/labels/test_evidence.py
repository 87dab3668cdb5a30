"""What is there stays present, what chance brings does not: families and sums with and without evidence."""

from __future__ import annotations

import numpy as np
import pytest
from gearbox import BASES, KINEMATICS, LINES, labelled, sines
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import poisson

from signals.labels import Matching, label_peaks
from signals.labels.evidence import expected_hits, proven_layers
from signals.labels.types import LabelSet
from signals.spectra import amplitude_spectrum
from sim.core.lines import Line

F_M, F_R1, F_O1, F_I1, F_C1 = (BASES[name] for name in ("f_m", "f_r1", "f_o1", "f_i1", "f_c1"))
SECONDS = 4.0
ANYTHING_GOES = Matching(family_chance=1.0, lone_chance=1.0, false_share=1e9)
"""Every line near a peak is evidence of itself."""


def told(component: str, mechanism: str, family: str, **orders: int) -> Line:
    return Line(orders=tuple(orders.items()), component=component, mechanism=mechanism, family=family)


TERMS = [
    *(told("mesh1", "mesh_pairs", "mesh", f_m=k) for k in range(1, 8)),
    *(told("pinion", "eccentricity", "mesh", f_m=k, f_r1=s) for k in range(1, 8) for s in (-1, 1)),
    *(told(f"bearing{i}", "ball_contact", "outer", **{f"f_o{i}": k}) for i in range(1, 5) for k in range(1, 7)),
]
TRUE = {k * F_M: 1.0 / k for k in range(1, 7)}
TRUE |= {k * F_M + s * F_R1: 0.05 for k in range(1, 5) for s in (-1, 1)} | {k * F_O1: 0.02 for k in range(1, 9)}
PRODUCTS = {k * F_M + F_R1 - F_O1: 0.01 for k in (2, 3)} | {k * F_M - F_R1 + F_O1: 0.01 for k in (2, 4)}


def strangers(seed: int, count: int, true: dict[float, float]) -> dict[float, float]:
    """Lines anywhere, of any size, two resolved lines away from the true ones and each other."""
    rng = np.random.default_rng(1000 + seed)
    found: dict[float, float] = {}
    while len(found) < count:
        place = float(rng.uniform(50.0, 4900.0))
        if min(abs(place - x) for x in (*true, *found)) > 8 / SECONDS:
            found[place] = float(10 ** rng.uniform(-2, 0))
    return found


def statuses(labels: LabelSet, places: dict[float, float]) -> list[str]:
    """The best that is said of the peak at each place."""
    peaks = [p for p in labels.peaks if p.measured_frequency_hz is not None]
    result = []
    for place in places:
        said = {p.status for p in peaks if abs((p.measured_frequency_hz or 0) - place) < 0.3 / SECONDS}
        result.append(next(word for word in ("present", "ambiguous", "unexplained", "absent") if word in said))
    return result


def shares(terms: list[Line], matching: Matching, seeds: int = 16, count: int = 40) -> tuple[float, float]:
    """Share of random lines called present, and of true ones."""
    false: list[str] = []
    right: list[str] = []
    for seed in range(seeds):
        true = TRUE | (PRODUCTS if terms else {})
        noise = strangers(seed, count, true)
        spectrum = amplitude_spectrum(sines(true | noise, seconds=SECONDS, seed=seed))
        labels = label_peaks(spectrum, [*LINES, *terms], BASES, kinematics=KINEMATICS, matching=matching)
        false += statuses(labels, noise)
        right += statuses(labels, true)
    return false.count("present") / len(false), right.count("present") / len(right)


@pytest.mark.slow
@pytest.mark.parametrize("terms", [TERMS, []], ids=["simulated", "measured"])
def test_chance_hits_vanish_and_true_lines_stay(terms: list[Line]) -> None:
    """640 lines anywhere: some 5 % had a name before, hardly any is called present with evidence asked for."""
    before, true_before = shares(terms, ANYTHING_GOES)
    after, true_after = shares(terms, Matching())
    assert 0.03 < before < 0.08
    assert after < 0.01
    assert true_before == true_after == 1.0


def test_a_lone_line_of_a_silent_family_is_ambiguous_with_its_chance() -> None:
    noise = strangers(3, 40, TRUE)
    found = labelled(TRUE | noise | {3 * F_C1: 0.05}, seconds=SECONDS)
    peak = found["3*f_c1"]
    assert (peak.status, peak.evidence, peak.alternatives) == ("ambiguous", "chance", ())
    assert peak.amplitude == pytest.approx(0.05, rel=0.01)
    assert peak.chance_coincidence is not None and 1e-4 < peak.chance_coincidence < 0.05
    assert not [p for p in found.with_status("unexplained") if abs(p.frequency_hz - 3 * F_C1) < 0.1]


@pytest.mark.slow
def test_several_lines_of_a_silent_family_are_present() -> None:
    noise = strangers(3, 40, TRUE)
    inner = {F_I1: 0.05, F_I1 - F_R1: 0.02, F_I1 + F_R1: 0.02, 2 * F_I1: 0.03}
    found = labelled(TRUE | noise | inner, seconds=SECONDS)
    for label in ("1*f_i1", "1*f_i1-1*f_r1", "1*f_i1+1*f_r1", "2*f_i1"):
        assert (found[label].status, found[label].evidence) == ("present", "family"), label


def test_a_clean_lone_fundamental_needs_no_company() -> None:
    assert labelled({F_O1: 0.1}, seconds=SECONDS)["1*f_o1"].status == "present"


@pytest.mark.slow
def test_a_term_is_evidence_enough() -> None:
    noise = strangers(3, 40, TRUE)
    term = told("bearing1", "cage_unbalance", "cage", f_c1=3)
    spectrum = amplitude_spectrum(sines(TRUE | noise | {3 * F_C1: 0.05}, seconds=SECONDS))
    found = label_peaks(spectrum, [*LINES, *TERMS, term], BASES, kinematics=KINEMATICS)
    assert (found["3*f_c1"].status, found["3*f_c1"].evidence) == ("present", "term")


def test_what_nothing_speaks_for_does_not_put_a_predicted_line_in_doubt() -> None:
    """A cage's line as near as the peak's own place can tell."""
    bases = BASES | {"f_c1": F_M / 5 + 1e-4}
    spectrum = amplitude_spectrum(sines(TRUE | strangers(3, 40, TRUE), seconds=SECONDS))
    found = label_peaks(spectrum, [*LINES, *TERMS], bases)
    assert (found["1*f_m"].status, found["1*f_m"].alternatives) == ("present", ())
    assert found["5*f_c1"].status == "ambiguous" and "1*f_m" in found["5*f_c1"].alternatives


@given(st.lists(st.tuples(st.integers(1, 5), st.booleans(), st.floats(1e-6, 0.5)), min_size=1, max_size=20))
def test_layers_are_poissons_tail_of_what_is_found_so_far(lines: list[tuple[int, bool, float]]) -> None:
    weights, hit, expected = (np.array(column) for column in zip(*lines, strict=True))
    proven, chance = proven_layers(weights, hit, expected, Matching())
    for weight in set(weights.tolist()):
        upto = weights <= weight
        number = int(hit[upto].sum())
        tail = poisson.sf(number - 1, expected[upto].sum())
        assert chance[weights == weight] == pytest.approx(tail, rel=1e-6, abs=1e-12)
    if np.any(proven):
        heaviest = weights[proven].max()
        assert np.all(proven == (weights <= heaviest))
        upto = weights <= heaviest
        false = np.expm1(expected[upto & ~hit]).sum()
        assert chance[weights == heaviest][0] <= 1e-3 and false <= 0.05 * hit[upto].sum()
        assert expected[upto].sum() <= 0.2 * hit[upto].sum()


def test_false_lines_are_counted_by_the_lines_missed() -> None:
    """Of many random families, with some true lines each, as many are false as the missed ones say."""
    rng = np.random.default_rng(7)
    expected, true = np.full(4000, 0.15), np.arange(4000) < 3000
    hit = true | (rng.random(4000) < -np.expm1(-0.15))
    false = np.count_nonzero(hit & ~true)
    assert np.expm1(expected[~hit]).sum() == pytest.approx(false, rel=0.15)


def test_a_family_found_whole_is_there_however_many_peaks_there_are() -> None:
    weights, expected = np.arange(1, 41), np.full(40, 0.08)
    whole, _ = proven_layers(weights, np.ones(40, dtype=np.bool_), expected, Matching())
    half, _ = proven_layers(weights, np.arange(40) % 2 == 0, expected, Matching())
    assert whole.all() and not half.any()


@pytest.mark.slow
@settings(deadline=None, max_examples=20)
@given(st.integers(0, 1000))
def test_expected_hits_are_those_of_random_peaks(seed: int) -> None:
    """The mean over many lines is the number of peaks that lie within their own reach of them."""
    rng = np.random.default_rng(seed)
    peaks = np.sort(rng.uniform(0.0, 5000.0, 400))
    reach = rng.uniform(0.01, 0.1, peaks.size)
    lines = rng.uniform(500.0, 4500.0, 20_000)
    free = np.ones(peaks.size, dtype=np.bool_)
    told_hits = expected_hits(lines, np.zeros(lines.size), peaks, reach, free, resolution_hz=0.5, top_hz=5000.0)
    right = np.searchsorted(peaks, lines)
    hits = sum(np.abs(peaks[np.clip(right - i, 0, 399)] - lines) < reach[np.clip(right - i, 0, 399)] for i in (0, 1))
    assert np.sum(told_hits) == pytest.approx(np.sum(hits), rel=0.25)
