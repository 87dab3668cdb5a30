"""A force from what lines gained: closed forms, bounds that hold whatever the phases, and what cannot be told."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from reconcile.machine import force as force_module
from reconcile.machine.added_power import ways
from reconcile.machine.force import AS_WELL, MODEL_DB, Heard, Squares, force_squares, likely_squares, mixed

LINES = 6
RESPONSE = 1e-4


def heard(
    test: np.ndarray, before: np.ndarray, *, share: float = 0.1, noise: float = 1e-8, response: np.ndarray | None = None
) -> Heard:
    """Channels by lines; one way to act unless `response` (W, C, L) says otherwise."""
    known = np.full((1, *test.shape), RESPONSE) if response is None else response
    deviation = share * before + noise
    return Heard(test=test, before=before, deviation=deviation, response=known, spread_db=np.zeros(test.shape))


def drawn(seed: int, channels: int, spread_db: float, least: float) -> tuple[np.ndarray, Heard]:
    """Forces of `least` to 100 N at lines of 1 to 9 N's worth each, with errors and phases as the engine takes them;
    all far apart, so that none counts as a product of others."""
    rng, n = np.random.default_rng(seed), 800
    force, size = 10.0 ** rng.uniform(np.log10(least), 2.0, n), (channels, n)
    before = 9.0 * RESPONSE * 10.0 ** rng.uniform(-1.0, 1.0, size)
    deviation = 0.15 * before + 0.02 * 9.0 * RESPONSE
    error = 10.0 ** (rng.normal(0.0, np.hypot(spread_db, MODEL_DB), size) / 10.0)
    joined = np.sqrt(before) + force * np.sqrt(RESPONSE * error) * np.exp(1j * rng.uniform(0.0, 2.0 * np.pi, size))
    test = np.maximum(np.abs(joined) ** 2 + deviation * rng.normal(size=size), 0.0)
    one = heard(test, before)
    return force, replace(one, deviation=deviation, spread_db=np.full(size, spread_db))


@pytest.mark.slow
@pytest.mark.parametrize("channels", [1, 3])
@pytest.mark.parametrize("spread_db", [0.0, 3.0, 11.0])
@pytest.mark.parametrize("least", [0.01, 1.0])
def test_the_true_force_is_in_nine_of_ten_bands(
    channels: int, spread_db: float, least: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(force_module, "MIXED", 0.0)
    force, one = drawn(7, channels, spread_db, least)
    found = force_squares(one)
    inside = (found.low <= force**2) & (force**2 <= found.high)
    told = found.low > 0.0
    assert told.mean() > 0.3, "else the upper ends alone are looked at"
    assert 0.85 <= inside.mean() <= 0.955 and 0.85 <= inside[told].mean() <= 0.955, (inside.mean(), inside[told].mean())


@pytest.mark.slow
@pytest.mark.parametrize(("name", "value"), [("UNHEARD", 1e-3), ("LOUDEST", 400.0), ("ACROSS", 1e-4)])
def test_no_end_hangs_on_where_the_sizes_begin_and_end(
    name: str, value: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(force_module, "MIXED", 0.0)
    _, one = drawn(8, 1, 6.0, 0.01)
    here = force_squares(one)
    monkeypatch.setattr(force_module, name, value)
    monkeypatch.setattr(force_module, "SIZES", 320)
    there = force_squares(one)
    assert np.mean((here.low > 0.0) != (there.low > 0.0)) < 0.01
    both = (here.low > 0.0) & (there.low > 0.0)
    assert np.allclose(10 * np.log10(here.high / there.high), 0.0, atol=0.5)
    for known in ("low", "best"):
        off = 10 * np.log10(getattr(here, known)[both] / getattr(there, known)[both])
        assert np.quantile(np.abs(off), 0.99) < 0.5


def band_by_hand(test: float, before: float, deviation: float) -> tuple[float, float]:
    """Ends of the band of F^2 R, by hundreds of phases and errors of the response each; thousands give the same."""
    phase = np.cos(np.pi * (np.arange(500) + 0.5) / 500)[:, None]
    steps = np.linspace(-4.0, 4.0, 161)
    shares = np.exp(-0.5 * steps**2)
    error = np.exp(0.1 * np.log(10.0) * MODEL_DB * steps)[None, :]
    sizes = 10.0 ** np.arange(-7.0, 3.0, 0.05)
    likely = []
    for size in sizes:
        brought = size * error
        made = np.maximum(before + brought + 2.0 * np.sqrt(before * brought) * phase, 0.0) + deviation
        scatter = np.hypot(deviation / made, 0.02)
        density = np.exp(-0.5 * (np.log(made / (test + deviation)) / scatter) ** 2) / scatter
        likely.append(float(density.mean(axis=0) @ shares / shares.sum()))
    inside = np.flatnonzero(np.array(likely) >= AS_WELL * max(likely))
    return (0.0 if inside[0] == 0 else float(sizes[inside[0]])), float(sizes[inside[-1]])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("test", "share"), [(1.0, 0.1), (1.0, 1.0), (2.5, 0.1), (6.0, 0.3), (30.0, 0.1), (0.1, 0.1), (0.01, 0.5)]
)
def test_the_band_is_that_of_all_phases_and_errors(test: float, share: float) -> None:
    low, high = band_by_hand(test, 1.0, share)
    found = force_squares(heard(np.full((1, 1), test), np.ones((1, 1)), share=share, response=np.ones((1, 1, 1))))
    assert 10.0 * np.log10(found.high[0] / high) == pytest.approx(0.0, abs=1.0)
    assert bool(found.rose[0]) == (low > 0.0) == (found.best[0] > 0.0)
    if low > 0.0:
        assert 10.0 * np.log10(found.low[0] / low) == pytest.approx(0.0, abs=1.0)


@pytest.mark.parametrize("force", [0.3, 3.0, 30.0])
def test_a_line_that_was_not_there_tells_the_force_in_closed_form(force: float) -> None:
    """Without anything to meet, power is F^2 R: the median is F, the band that of the response's error alone."""
    found = force_squares(heard(np.full((1, 1), force**2 * RESPONSE), np.zeros((1, 1))))
    assert np.sqrt(found.best[0]) == pytest.approx(force, rel=0.15)
    db = 10 * np.log10(np.array([found.low[0], found.high[0]]) / force**2)
    assert db == pytest.approx([-1.645 * 3.0, 1.645 * 3.0], abs=1.2)


def test_more_channels_tell_it_closer() -> None:
    def width(channels: int) -> float:
        one = force_squares(heard(np.full((channels, 1), 9.0 * RESPONSE), np.zeros((channels, 1))))
        assert np.sqrt(one.best[0]) == pytest.approx(3.0, rel=0.15)
        return float(one.high[0] / one.low[0])

    assert width(4) < 0.6 * width(1)


def test_what_did_not_change_may_be_nothing_and_has_an_upper_end() -> None:
    line = np.full((2, LINES), 1e-2)
    found = force_squares(heard(line, line))
    assert np.all(found.low == 0.0) and np.all(found.high > 0.0)
    assert np.all(np.sqrt(found.high) < 2.5 * np.sqrt(line[0] / RESPONSE))


def test_a_line_that_fell_tells_a_force_too() -> None:
    before = np.full((2, 1), 1e-2)
    found = force_squares(heard(0.01 * before, before))
    least = 0.9 * np.sqrt(before[0] / RESPONSE)
    assert found.low[0] > 0.0 and np.sqrt(found.low[0]) < least < np.sqrt(found.high[0])


@settings(deadline=None, max_examples=40)
@pytest.mark.slow
@given(seed=st.integers(0, 10**6), force=st.floats(0.1, 100.0), there=st.floats(0.0, 100.0))
def test_the_true_force_is_never_far_outside_the_band_whatever_the_phases(
    seed: int, force: float, there: float
) -> None:
    rng = np.random.default_rng(seed)
    before = RESPONSE * there**2 * rng.uniform(0.3, 3.0, (3, 1))
    phase = rng.uniform(0.0, 2 * np.pi, (3, 1))
    error = 10 ** (rng.normal(0.0, 2.0, (3, 1)) / 10)
    amplitude = np.sqrt(before) + force * np.sqrt(RESPONSE * error) * np.exp(1j * phase)
    found = force_squares(heard(np.abs(amplitude) ** 2, before))
    assert 0.25 * np.sqrt(found.low[0]) <= force <= 4.0 * np.sqrt(found.high[0])


@pytest.mark.slow
@given(scale=st.floats(1e-3, 1e3))
def test_it_goes_with_the_gain(scale: float) -> None:
    """Power of all channels times a gain, with the responses, leaves the force."""
    before, test = np.full((2, 2), 1e-3), np.array([[3e-3, 1e-3], [2e-3, 5e-4]])
    plain = force_squares(heard(test, before))
    more = force_squares(
        heard(scale * test, scale * before, noise=scale * 1e-8, response=np.full((1, 2, 2), scale * RESPONSE))
    )
    assert np.allclose(plain.best, more.best, rtol=1e-6) and np.allclose(plain.high, more.high, rtol=1e-6)


def of_axes(x: list[float], y: list[float]) -> np.ndarray:
    """Response (W, C, 1) of channels that hear so much of either axis."""
    return np.asarray(np.einsum("wa,ac->wc", ways(), np.array([x, y])) * RESPONSE)[:, :, None]


def test_channels_along_two_axes_tell_both_together() -> None:
    test, before = np.array([[4.0 * RESPONSE], [9.0 * RESPONSE]]), np.zeros((2, 1))
    both = force_squares(heard(test, before, response=of_axes([1.0, 0.0], [0.0, 1.0])))
    assert np.sqrt(both.best[0]) == pytest.approx(np.hypot(2.0, 3.0), rel=0.15)
    none = np.full((len(ways()), 2, 1), np.nan)
    assert np.isnan(force_squares(heard(test, before, response=none)).best[0])


def test_a_force_along_one_axis_may_hide_under_a_strong_line_there() -> None:
    """The other axis' silence says nothing of it."""
    before = np.array([[1e-6], [100.0]])
    found = force_squares(heard(before, before, response=of_axes([1.0, 0.0], [0.0, 1.0])))
    alone = force_squares(heard(before[1:], before[1:]))
    assert found.low[0] == 0.0 and found.high[0] == pytest.approx(alone.high[0], rel=0.1)


@pytest.mark.parametrize("across", [0.1, 0.5, 1.0])
def test_a_channel_that_hears_both_axes_leaves_the_direction_open(across: float) -> None:
    test, before = np.full((1, 1), 9.0 * RESPONSE), np.zeros((1, 1))
    found = force_squares(heard(test, before, response=of_axes([1.0], [across])))
    db = 10.0 * np.log10(np.array([found.low[0], found.high[0]]) / 9.0)
    assert db == pytest.approx([-1.645 * 3.0, 1.645 * 3.0 - 10.0 * np.log10(across)], abs=1.2)


@pytest.mark.slow
@pytest.mark.parametrize("across", [[0.14], [0.71], [0.0, 0.71, 0.14]])
@pytest.mark.parametrize("along", ["any", "x", "y"])
def test_the_true_force_is_in_the_band_whatever_its_direction(
    across: list[float], along: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each channel hears x as 1 and y as so much, the phase between them anyhow."""
    monkeypatch.setattr(force_module, "MIXED", 0.0)
    rng, size = np.random.default_rng(3), (len(across), 500)
    force = 10.0 ** rng.uniform(-1.0, 2.0, size[1])
    angle = {"any": rng.uniform(0.0, 0.5 * np.pi, size[1]), "x": np.zeros(size[1]), "y": np.full(size[1], 0.5 * np.pi)}
    y = np.sqrt(across)[:, None] * np.exp(1j * rng.uniform(0.0, 2.0 * np.pi, size)) * np.sin(angle[along])
    error = 10.0 ** (rng.normal(0.0, MODEL_DB, size) / 20.0)
    brought = force * np.sqrt(RESPONSE) * error * (np.cos(angle[along]) + y)
    before = 9.0 * RESPONSE * 10.0 ** rng.uniform(-1.0, 1.0, size)
    deviation = 0.15 * before + 0.02 * 9.0 * RESPONSE
    joined = np.sqrt(before) + brought * np.exp(1j * rng.uniform(0.0, 2.0 * np.pi, size))
    test = np.maximum(np.abs(joined) ** 2 + deviation * rng.normal(size=size), 0.0)
    response = np.repeat(of_axes([1.0] * len(across), across), size[1], axis=2)
    found = force_squares(replace(heard(test, before, response=response), deviation=deviation))
    inside = (found.low <= force**2) & (force**2 <= found.high)
    assert (found.low > 0.0).mean() > 0.3 and inside.mean() >= 0.85, inside.mean()


def test_channels_that_contradict_each_other_do_not_make_it_sure() -> None:
    alike = force_squares(heard(np.full((2, 1), 9.0 * RESPONSE), np.zeros((2, 1))))
    apart = force_squares(heard(np.array([[900.0 * RESPONSE], [0.09 * RESPONSE]]), np.zeros((2, 1))))
    assert apart.high[0] / max(apart.low[0], 1e-30) > 10 * alike.high[0] / alike.low[0]


def test_lines_far_below_a_told_one_may_be_its_products() -> None:
    squares = Squares(
        best=np.array([100.0, 0.5, np.nan, 5.0]),
        low=np.array([50.0, 0.2, np.nan, 3.0]),
        high=np.array([150.0, 1.0, np.nan, 9.0]),
        rose=np.array([True, True, False, True]),
    )
    found = mixed(squares, np.ones((1, 4)))
    assert found.low[[0, 1, 3]].tolist() == [50.0, 0.0, 3.0] and np.isnan(found.low[2])
    assert found.best[1] == 0.0 and found.rose[1] and found.high[1] == 1.0


def test_what_may_hide_at_lines_that_are_hardly_heard_makes_no_product_of_what_rose() -> None:
    """A line up by 40 dB is told beside lines that stay and tell nothing; beside one that is heard as well and hides
    ten times as much it may be a product."""
    before = np.array([[1e-6, 100.0]])
    test = np.array([[1e-2, 100.0]])
    faint = np.array([[[1.0, 1e-3]]]) * RESPONSE
    found = force_squares(heard(test, before, response=faint))
    assert found.low[0] > 0.0 and found.rose.tolist() == [True, False]
    found = force_squares(heard(test, before))
    assert found.low[0] == 0.0 and found.rose.tolist() == [True, False]


def test_a_channel_without_any_signal_tells_nothing() -> None:
    silent = np.zeros((1, 2))
    found = force_squares(
        Heard(test=silent, before=silent, deviation=silent, response=np.ones((1, 1, 2)), spread_db=np.zeros((1, 2)))
    )
    assert np.isnan(found.best).all()


def test_a_force_that_was_heard_is_likelier_than_none_and_most_where_it_acts() -> None:
    """A place that hears it as the channels did leads one that hears it the other way round."""
    loud = 50.0**2 * RESPONSE
    before = np.full((2, 3), 9.0 * RESPONSE)
    test = before + np.array([[loud, 0.0, loud], [0.01 * loud, 0.0, 0.01 * loud]])
    here = np.full((1, 2, 3), RESPONSE)
    here[0, 1] *= 0.01
    there = here[:, ::-1].copy()
    for response in (here, there):
        response[0, :, 2] = np.nan
    at_place, elsewhere = (likely_squares(heard(test, before, response=r)) for r in (here, there))
    assert at_place[0] > 5.0 and at_place[0] > elsewhere[0] + 3.0
    assert at_place[1] < 1.0 and at_place[2] == 0.0, "nothing rose; nobody hears it"
    silent = np.full((1, 2, 3), np.nan)
    assert np.array_equal(likely_squares(heard(test, before, response=silent)), np.zeros(3))
