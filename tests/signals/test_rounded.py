"""Stamps are regular if rounding explains all of what they are off a grid; what it does not is refused, with the
place."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from signals.ingest.stamps import Stamps, check_regular
from signals.rounded import first_off_grid, regular_grid
from signals.series import FloatArray
from sim.core.errors import SpecError

RATES = st.one_of(st.sampled_from([1000.0, 12_800.0, 25_600.0, 44_100.0, 51_200.0]), st.floats(500.0, 60_000.0))
WRITTEN = st.sampled_from(
    ["%.6f", "%.5f", "%.4f", "%.7g", "%.8g", "%.9g", "%.12g", "single", "%.7g of single", "%.8g of single", "cut"]
)


def written(times: FloatArray, way: str) -> FloatArray:
    """Times as a file holds them."""
    if way == "cut":
        return np.floor(times * 1e6) / 1e6
    form, _, of = way.partition(" of ")
    held = times.astype(np.float32).astype(np.float64) if "single" in (form, of) else times
    return held if form == "single" else np.array([float(form % t) for t in held])


def rounding(times: FloatArray, way: str) -> float:
    """The distance of what can be written near the last of the times, s."""
    last, (form, _, of) = float(times[-1]), way.partition(" of ")
    single = float(np.spacing(np.float32(last))) if "single" in (form, of) else 0.0
    if form == "cut" or form.endswith("f"):
        return 10.0 ** -(6 if form == "cut" else int(form[2]))
    return single if form == "single" else single + 10.0 ** (np.floor(np.log10(last)) + 1 - int(form[2:-1]))


@pytest.mark.slow
@given(rate=RATES, way=WRITTEN, start=st.sampled_from([0.0, 0.37, 5.0, 90.0]), n=st.integers(200, 3000))
def test_any_way_of_writing_a_grid_is_taken_with_its_rate(rate: float, way: str, start: float, n: int) -> None:
    times = start + np.arange(n) / rate
    found = written(times, way)
    if found[-1] == found[0] or rounding(times, way) > 20 / rate:
        return
    told = check_regular(found)
    # a line through stamps that are each off by at most half of it has a slope that is off by at most 1.5 / span of it
    off = 1.5 * rounding(times, way) / (times[-1] - times[0])
    assert told.sampling_rate_hz == pytest.approx(rate, rel=max(off, 1e-9)), told


@pytest.mark.slow
@given(
    rate=RATES,
    way=WRITTEN,
    n=st.integers(400, 3000),
    share=st.floats(0.1, 0.9),
    kind=st.sampled_from(["missing", "twice", "late", "jump", "jitter"]),
    seed=st.integers(0, 2**16),
)
def test_what_rounding_does_not_explain_is_refused_with_the_place(
    rate: float, way: str, n: int, share: float, kind: str, seed: int
) -> None:
    times, place = np.arange(n + 1) / rate, int(share * n)
    # at least a twentieth of a step, five times what clocks may; no round number, which would look like few decimals
    off = 1.3371 * max(3 * rounding(times, way), 0.05 / rate)
    if kind in ("missing", "twice") and off > 1 / rate:
        return
    if kind == "missing":
        times = np.delete(times, place)
    elif kind == "twice":
        times = np.insert(times, place, times[place - 1])
    elif kind == "late":
        times[place] += off
    elif kind == "jump":
        times[place:] += off
    else:
        place = 0
        times = np.sort(times + off * np.random.default_rng(seed).uniform(-1, 1, n + 1))
    with pytest.raises(SpecError, match="irregular from sample") as refused:
        check_regular(written(times, way))
    said = int(str(refused.value).split("irregular from sample ")[1].split()[0])
    assert said >= place, (said, place)
    if kind != "jitter":
        assert said <= place + 200, (said, place)


def test_a_missing_stamp_under_coarse_rounding_is_found_by_the_shift_of_all_after_it() -> None:
    """Rounded to four steps no single step tells that one is missing."""
    times = np.delete(np.arange(20_000) / 25_600.0, 9_000)
    stamps = np.round(times, 4)
    assert np.ptp(np.unique(np.diff(stamps))) < 1.5e-4
    assert regular_grid(stamps) is None
    assert regular_grid(np.round(np.arange(20_000) / 25_600.0, 4)) is not None
    place = first_off_grid(stamps)
    assert place is not None and 9_000 <= place <= 9_050


@pytest.mark.slow
def test_rounded_stamps_are_told_and_fine_ones_are_not() -> None:
    times = np.arange(128_000) / 25_600.0
    assert check_regular(times).remarks == check_regular(written(times, "%.9f")).remarks == ()
    (said,) = check_regular(written(times, "%.7g")).remarks
    assert "7 significant digits" in said and "25600" in said
    assert "single precision" in check_regular(written(times, "single")).said
    assert "multiples of 1e-06" in check_regular(written(times, "%.6f")).said


def test_the_rate_is_fitted_by_all_stamps_not_by_the_ends() -> None:
    times = 3.7e-7 + np.arange(2_000) / 25_600.0
    stamps = np.round(times, 4)
    by_ends = (stamps.size - 1) / (stamps[-1] - stamps[0])
    found: Stamps = check_regular(stamps)
    assert abs(found.sampling_rate_hz - 25_600.0) < 0.2 * abs(by_ends - 25_600.0)


def test_the_refusal_gives_the_median_step() -> None:
    times = np.arange(1000) / 25_600.0
    times[500:] += 1e-4
    with pytest.raises(SpecError, match=r"irregular from sample 500 on .* their median, 3\.906e-05 s, or"):
        check_regular(times)


@pytest.mark.parametrize("start", [1.7e9, 1.7e9 + 50.0, 128.0 * 13_281_250])
def test_seconds_since_1970_are_no_single_precision(start):
    """Near a multiple of 128 s all of them are one number of single precision: gaps were taken for its rounding."""
    even = start + np.arange(5000) / 25_600.0
    assert regular_grid(np.round(even, 6)) is not None
    late = even + np.where(np.arange(5000) >= 2000, 80 / 25_600.0, 0.0)
    lost = late + np.where(np.arange(5000) >= 3000, 10 / 25_600.0, 0.0)
    for gaps in (late, lost, even + np.where(np.arange(5000) >= 2500, 20 / 25_600.0, 0.0)):
        assert regular_grid(np.round(gaps, 6)) is None


def drifting(rate_hz: float, drift: float, n: int = 20_000) -> FloatArray:
    """Stamps with six decimals of a clock whose rate falls evenly, by `drift` from one end to the other."""
    k = np.arange(n)
    return np.round(k / rate_hz * (1 + drift / 2 * k / n), 6)


@pytest.mark.parametrize(("rate_hz", "drift"), [(12_800.0, 2e-5), (25_600.0, 2e-5), (25_600.0, 1e-4), (51_200.0, 5e-5)])
def test_a_clock_that_drifts_a_little_is_taken_with_its_mean_rate_and_told(rate_hz: float, drift: float) -> None:
    found = check_regular(drifting(rate_hz, drift, 200_000))
    assert found.sampling_rate_hz == pytest.approx(rate_hz, rel=drift)
    assert "clock drifts" in found.remarks[0] and "multiples of 1e-06" in found.remarks[0]


@pytest.mark.parametrize("at", [0, 3, 450, 500, 999])
@pytest.mark.parametrize("step", [1.0, -1.0, 0.5])
def test_a_sample_that_was_lost_is_no_drift(at: int, step: float) -> None:
    stamps = drifting(25_600.0, 5e-5)
    stamps[7001 + at :] += np.round(step / 25_600.0, 6)
    with pytest.raises(SpecError, match="irregular"):
        check_regular(stamps)


def test_nor_is_a_clock_of_another_rate_half_way() -> None:
    stamps = np.round(np.cumsum(np.where(np.arange(20_000) < 10_000, 1.0, 1.001)) / 25_600.0, 6)
    with pytest.raises(SpecError, match="irregular"):
        check_regular(stamps)
