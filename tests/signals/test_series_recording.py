"""Series and recordings: what is refused, and that selecting loses nothing."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from signals.recording import Operating, Recording
from signals.series import Series
from sim.core.errors import SpecError, UnknownName
from sim.core.response import Channel

CHANNELS = (
    Channel(name="a", quantity="acceleration", unit="m/s^2", location="bearing1", axis="y"),
    Channel(name="x", quantity="displacement", unit="m", location="pinion", axis="x"),
)


def recording(n: int = 100, **changes: object) -> Recording:
    samples = np.arange(2.0 * n).reshape(2, n)
    facts: dict[str, object] = {"sampling_rate_hz": 50.0, "channels": CHANNELS, "samples": samples}
    return Recording(**(facts | changes))  # type: ignore[arg-type]


@pytest.mark.parametrize("rate", [0, -1.0, float("nan"), float("inf"), None, "48000", True])
def test_unknown_sampling_rate_is_refused(rate: object) -> None:
    with pytest.raises(SpecError, match="sampling_rate_hz: must be known"):
        recording(sampling_rate_hz=rate)


def test_unknown_unit_and_repeated_name_are_refused_with_their_place() -> None:
    bad = (
        Channel(name="a", quantity="acceleration", unit="", location="bearing1"),
        Channel(name="a", quantity="acceleration", unit="g", location="bearing1"),
    )
    with pytest.raises(SpecError) as caught:
        recording(channels=bad)
    assert [p.field for p in caught.value.problems] == ["channels[0].unit", "channels[1].name"]


def test_rows_must_fit_the_channels() -> None:
    with pytest.raises(SpecError, match="one row a channel"):
        recording(samples=np.zeros((3, 10)))


def test_samples_cannot_be_written_through() -> None:
    with pytest.raises(ValueError, match="read-only"):
        recording().samples[0, 0] = 1.0


def test_unknown_channel_lists_the_known() -> None:
    with pytest.raises(UnknownName, match="known: a, x"):
        recording().series("b")


@given(first=st.integers(0, 90), count=st.integers(8, 10))
def test_selecting_by_time_takes_exactly_those_samples(first: int, count: int) -> None:
    whole = recording()
    part = whole.select(channels=["x"], start_s=first / 50.0, end_s=(first + count) / 50.0)
    assert np.array_equal(part.samples[0], whole.samples[1, first : first + count])
    assert part.start_s == pytest.approx(first / 50.0)
    assert np.allclose(part.time_s(), whole.time_s()[first : first + count])
    assert part.series("x").start_s == part.start_s


@pytest.mark.parametrize(("start", "end"), [(1.0, 1.0), (-1.0, 1.0), (0.0, 9.0), (float("nan"), 1.0)])
def test_an_empty_or_outside_range_is_refused(start: float, end: float) -> None:
    with pytest.raises(SpecError, match="select no samples"):
        recording().select(start_s=start, end_s=end)


def test_series_says_where_it_is_not_finite() -> None:
    samples = np.zeros(100)
    samples[30:32] = np.nan
    with pytest.raises(SpecError, match=r"2 samples are not finite, the first at sample 30 \(t = 3.6 s\)"):
        Series(samples=samples, sampling_rate_hz=50.0, unit="m", start_s=3.0)


def test_operating_point_is_kept() -> None:
    point = Operating(shaft="input", speed_hz=30.0, torque_nm=25.0)
    assert recording(operating=point).select(channels=["a"]).operating == point


@pytest.mark.parametrize("largest", [1e300, -1e200, 1e31, 1e-31, -1e-300])
def test_sizes_that_no_sensor_gives_are_refused_with_their_place(largest: float) -> None:
    """Squares of these are no numbers, or nothing: an analysis would end in the middle."""
    samples = np.zeros((2, 100))
    samples[1, 7] = largest
    with pytest.raises(SpecError) as caught:
        recording(samples=samples)
    (problem,) = caught.value.problems
    assert (problem.field, problem.given, problem.unit) == ("channels.x", largest, "m")
    assert "sample 7" in problem.message and "1e-30 to 1e+30" in problem.allowed


@pytest.mark.parametrize("largest", [0.0, 2.0**63, -(2.0**31), 1e-15, np.nan, np.inf, -np.inf])
def test_real_sizes_silence_and_what_is_not_finite_are_taken(largest: float) -> None:
    """What is not finite is found with its place by `signals.checks.inspect`."""
    samples = np.zeros((2, 100))
    samples[1, 7] = largest
    assert np.array_equal(recording(samples=samples).samples, samples, equal_nan=True)


def test_a_size_beside_infinite_samples_is_refused_all_the_same() -> None:
    samples = np.zeros((2, 100))
    samples[0, 3:6] = np.inf, np.nan, 1e40
    with pytest.raises(SpecError, match=r"channels\.a: .*sample 5 \(given 1e\+40\)"):
        recording(samples=samples)


def test_of_a_simulation_what_is_left_of_nothing_is_taken_but_no_absurd_size() -> None:
    samples = np.full((2, 100), 1e-40)
    assert recording(samples=samples, origin="simulated").samples[0, 0] == 1e-40
    with pytest.raises(SpecError, match="no sensor gives"):
        recording(samples=1e240 * samples, origin="simulated")
