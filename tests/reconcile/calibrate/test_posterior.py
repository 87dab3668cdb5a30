"""Machines are moved until their mesh lines agree with the baseline, whatever the sensors' gains are."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from reconcile.atlas.bank import Bank
from reconcile.calibrate.posterior import Evidence, calibrated, line_evidence, smoothed
from reconcile.calibrate.uncertain import SPREAD, Offsets
from reconcile.observe.features import Scale
from reconcile.observe.statistics import Statistics

LINES, CHANNELS = 12, 2
RNG = np.random.default_rng(3)
SLOPES = RNG.normal(size=(CHANNELS, LINES, 3)) * 60.0
"""Decibels a unit of offset: a tenth moves a line by some 6 dB."""


def bank(theta: np.ndarray) -> Bank:
    """Levels that follow three numbers in a straight line."""
    n = theta.shape[0]
    level = np.einsum("cli,ni->ncl", SLOPES, theta)
    rest = np.zeros((n, CHANNELS, 1))
    return Bank(
        alive=np.ones(n, dtype=bool), line=10.0 ** (level / 10.0), floor=rest, total=rest, band=rest,
        depth=rest[..., None], turn=rest[..., None], kurtosis=rest, skewness=rest, phase=rest,
        resolution_hz=1.0, duration_s=1.0,
    )  # fmt: skip


def simulate(offsets: Sequence[Offsets]) -> list[Bank]:
    return [bank(np.array([o.values for o in offsets]))]


def evidence(truth: np.ndarray, gain_db: Sequence[float]) -> Evidence:
    level = np.einsum("cli,i->cl", SLOPES, truth) + np.array(gain_db)[:, None]
    c, line = np.nonzero(np.ones((CHANNELS, LINES), dtype=bool))
    return Evidence(
        levels_db=level[c, line], point=np.zeros(c.size, dtype=int), channel=c, line=line,
        frequency_hz=np.array([100.0 * 2.0 ** (i / 2) for i in line]),
    )  # fmt: skip


def start(n: int = 48) -> list[Offsets]:
    rng = np.random.default_rng(1)
    return [Offsets(values=row) for row in rng.uniform(-SPREAD, SPREAD, (n, 3))]


@pytest.mark.parametrize("gain_db", [(0.0, 0.0), (12.0, -7.0)])
def test_the_hidden_numbers_are_found_behind_unknown_gains(gain_db: tuple[float, float]) -> None:
    truth = np.array([0.06, -0.04, 0.05])
    found = calibrated(start(), simulate(start()), evidence(truth, gain_db), simulate, seed=2)
    assert found is not None
    middle = np.mean([o.values for o in found.offsets], axis=0)
    assert np.abs(middle - truth).max() < 0.025
    assert found.misfit[1] < 0.5 * found.misfit[0] and found.misfit[1] < 1.5
    assert (found.determined > 0.5).all() and not found.strayed.any()


def test_what_few_machines_take_from_numbers_without_a_part_by_chance_is_told() -> None:
    """Two dozen machines, lines that move independently by three numbers, and thirty numbers that move none."""
    rng = np.random.default_rng(5)
    real, idle = rng.uniform(-SPREAD, SPREAD, (24, 3)), rng.uniform(-SPREAD, SPREAD, (24, 30))
    first = [Offsets(values=row) for row in np.hstack([real, idle])]

    def shown(offsets: Sequence[Offsets]) -> list[Bank]:
        return [bank(np.array([o.values[:3] for o in offsets]))]

    found = calibrated(first, shown(first), evidence(np.array([0.06, -0.04, 0.05]), (0.0, 0.0)), shown, seed=2)
    assert found is not None
    lost = found.determined[3:]
    assert 0.05 < found.by_chance < 0.6 and (found.determined[:3] > found.by_chance).all()
    assert np.mean(lost > found.by_chance) <= 0.2, "about one in twenty"


def test_numbers_outside_their_spread_are_told() -> None:
    found = calibrated(start(), simulate(start()), evidence(np.array([0.15, 0.0, 0.0]), (0.0, 0.0)), simulate, seed=2)
    assert found is not None and found.strayed.tolist() == [True, False, False]


@pytest.mark.parametrize("gain_db", [(0.0, 0.0), (12.0, -7.0)])
def test_a_line_that_no_machine_of_the_kind_has_is_the_farthest(gain_db: tuple[float, float]) -> None:
    seen = evidence(np.array([0.03, 0.0, -0.02]), gain_db)
    seen.levels_db[LINES + 4] += 25.0
    found = calibrated(start(), simulate(start()), seen, simulate, seed=2)
    assert found is not None and found.evidence is seen and found.misfit[1] > 1.6
    worst = int(np.argmax(np.abs(found.left_db)))
    assert worst == LINES + 4 and (seen.channel[worst], seen.line[worst]) == (1, 4)
    assert 5.0 < found.left_db[worst] < 26.0


def test_lines_that_repeat_badly_decide_less_and_are_no_misfit() -> None:
    seen = evidence(np.array([0.05, 0.0, -0.05]), (0.0, 0.0))
    seen.levels_db[LINES + 4] += 9.0
    sharp = calibrated(start(), simulate(start()), seen, simulate, seed=2)
    loose = replace(seen, repeat_db=np.full(seen.levels_db.size, 6.0))
    blunt = calibrated(start(), simulate(start()), loose, simulate, seed=2)
    assert sharp is not None and blunt is not None
    assert blunt.misfit[1] < 0.5 * sharp.misfit[1]
    assert blunt.determined.sum() < sharp.determined.sum()


def test_two_lines_say_nothing() -> None:
    few = evidence(np.zeros(3), (0.0, 0.0))
    cut = Evidence(
        levels_db=few.levels_db[:2], point=few.point[:2], channel=few.channel[:2], line=few.line[:2],
        frequency_hz=few.frequency_hz[:2],
    )  # fmt: skip
    assert calibrated(start(), simulate(start()), cut, simulate, seed=2) is None


def test_only_lines_that_stand_out_are_evidence() -> None:
    line = np.full((CHANNELS, LINES), 1.0)
    line[0, 3] = 1000.0
    rest = np.zeros((CHANNELS, 1))
    seen = Statistics(
        line=line, floor=rest, total=rest, band=rest, depth=rest[..., None], turn=rest[..., None],
        kurtosis=rest, skewness=rest, phase=rest,
        resolution_hz=1.0, duration_s=1.0,
    )  # fmt: skip
    scale = Scale(line_noise=np.ones((CHANNELS, LINES)), depth_noise=np.ones(1), turn_noise=np.ones((CHANNELS, 1, 1)))
    found = line_evidence([seen], [scale], [np.arange(1.0, LINES + 1)], np.ones(LINES, dtype=bool))
    assert found.channel.tolist() == [0] and found.line.tolist() == [3]
    assert found.levels_db[0] == pytest.approx(10 * np.log10(999.0))


def test_one_assimilation_is_bayes_rule_for_straight_lines() -> None:
    rng = np.random.default_rng(5)
    slopes, prior, noise = rng.normal(size=(2, 4)), np.diag([0.5, 2.0]), 0.7 * np.eye(4)
    members = rng.multivariate_normal([1.0, -1.0], prior, 40_000)
    seen = np.array([0.5, -1.0, 2.0, 0.3])
    found = smoothed(members, members @ slopes, np.ones(len(members), dtype=bool), seen, noise, rng)
    gain = prior @ slopes @ np.linalg.inv(slopes.T @ prior @ slopes + noise)
    mean = np.array([1.0, -1.0]) + gain @ (seen - np.array([1.0, -1.0]) @ slopes)
    np.testing.assert_allclose(found.mean(axis=0), mean, atol=0.03)
    np.testing.assert_allclose(np.cov(found.T), prior - gain @ slopes.T @ prior, atol=0.04)
