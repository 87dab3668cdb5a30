"""What the gain on held-out data is told with: an interval, the better black box, placebos that had their chance."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.machine.heldout import _distances, _gain_of, _interval, held_out
from reconcile.machine.library import Catalogued
from reconcile.machine.rivals import Split
from reconcile.verdict import HeldOut
from sim.terms import REGISTRY
from tests.reconcile.machine.test_severity_heldout import NAME, WRONG, data, spectral

ELSEWHERE = "outer_spall@bearing2"
SETS, ALIKE = 60, 5


@pytest.mark.slow
def test_an_interval_of_the_gain_leaves_out_a_twentieth_at_either_end() -> None:
    """Neighbouring features move together, five by five; the true gain is a half."""
    rng = np.random.default_rng(0)
    ends = []
    for k in range(SETS):
        before, after = (np.repeat(rng.normal(0.0, spread, 400), ALIKE) for spread in (10.0, 5.0))
        ends.append(_interval([before], [after], np.random.default_rng([k, 5])))
    low, high = np.array(ends).T
    for missed in (np.mean(low > 0.5), np.mean(high < 0.5)):
        assert 0.01 <= missed <= 0.15


def told(made: SimpleNamespace, known: Catalogued, frequency: np.ndarray, channel: np.ndarray | None) -> HeldOut:
    return held_out(made, known, NAME, spectral=spectral(3), frequency=frequency, channel=channel, seed=0)  # type: ignore[arg-type]


def test_what_a_forecast_says_nothing_of_counts_neither_before_nor_after() -> None:
    """Half of the features move by 20 dB and are not forecast, the others by 2 of which half is: that is the gain."""
    scored = np.repeat([20.0, 2.0], 50)
    way = Split(fit=np.isfinite(scored), score=np.isfinite(scored), fitted=scored, scored=scored)
    guess = np.where(scored > 10.0, np.nan, 1.0)
    (before,), (after,) = _distances([guess], [way])
    assert before.size == after.size == 50 and set(before) == {2.0} and set(after) == {1.0}
    assert _gain_of([guess], [way]) == pytest.approx(0.5)
    assert _gain_of([np.full(scored.size, np.nan)], [way]) is None


def test_the_black_box_is_the_better_of_one_curve_and_one_for_each_sensor() -> None:
    made, known, frequency = data(3, perfect=True)
    frequency = np.tile(np.geomspace(30.0, 8000.0, frequency.size // 3), 3)
    channel = np.arange(frequency.size) % 2
    opposite = replaced(made, np.where(channel, 10.0, -10.0))
    assert told(opposite, known, frequency, channel).black_box == pytest.approx(1.0, abs=0.01)
    assert told(opposite, known, frequency, None).black_box == pytest.approx(0.0, abs=0.1), "one curve tells nothing"
    term = REGISTRY.get("outer_spall")
    assert term is not None
    x = np.log(frequency / frequency[0]) / np.log(frequency[-1] / frequency[0])
    alike = replaced(made, 10.0 * np.cos(np.pi * (len(term.params) - 1) * x))
    found = told(alike, known, frequency, channel)
    assert found.numbers is not None and found.numbers // 2 < len(term.params), "too few for each sensor's own"
    assert found.black_box == pytest.approx(1.0, abs=0.01)


def replaced(made: SimpleNamespace, observed: np.ndarray) -> SimpleNamespace:
    return SimpleNamespace(**{**vars(made), "observed": observed})


@pytest.mark.parametrize(("draws", "counts"), [(5, False), (6, True)])
def test_a_placebo_of_few_draws_is_told_and_does_not_count_beside_one_of_many(draws: int, counts: bool) -> None:
    """Few draws that happen to fit: where a law was hardly simulated, the luck of the draw is no rival."""
    made, known, frequency = data(3, perfect=True)
    library = known.library
    groups = {**library.groups, ELSEWHERE: library.groups[NAME][:draws]}
    more = replace(known, library=replace(library, groups=groups))
    found = told(made, more, frequency, None)
    gains = {p.site: p.gain for p in found.placebos}
    assert gains["bearing2"] > 0.8 and gains["bearing3"] < 0.4
    assert found.placebo == pytest.approx(np.mean(list(gains.values())) if counts else gains["bearing3"])
    alone = replace(more, library=replace(library, groups={k: v for k, v in groups.items() if k != WRONG}))
    assert told(made, alone, frequency, None).placebo == pytest.approx(gains["bearing2"]), "better than none"
