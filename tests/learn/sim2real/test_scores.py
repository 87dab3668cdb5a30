import numpy as np
import pytest
from scipy import stats

from learn.sim2real.scores import confusion, interval, score, sign_test


def test_interval_of_one_class_of_recordings_is_that_of_jeffreys():
    """Brown, Cai and DasGupta, Stat. Sci. 16 (2001) 101-133: Beta(k + 1/2, n - k + 1/2)."""
    expected = stats.beta(7.5, 3.5).ppf((0.025, 0.975))
    assert interval([[1.0] * 7 + [0.0] * 3]) == pytest.approx(tuple(expected), abs=0.01)


def test_a_class_of_two_right_ones_is_not_certain():
    low, high = interval([[1.0, 1.0]])
    assert 0.2 < low < 0.6
    assert high < 1.0
    assert score(["a", "a"], ["a", "a"], "recording")["high"] == 1.0


def test_windows_of_one_recording_bring_no_certainty():
    """Thirty windows of two recordings say no more than the two."""
    truth, said = ["a"] * 30, ["a"] * 15 + ["b"] * 15
    together = score(truth, said, "window", [1] * 15 + [2] * 15)
    apart = score(truth, said, "window")
    widths = [float(one["high"]) - float(one["low"]) for one in (together, apart)]
    assert widths[0] > 2 * widths[1]
    assert together["balanced_accuracy"] == apart["balanced_accuracy"] == 0.5


@pytest.mark.slow
@pytest.mark.parametrize("spread", [(1.2, 0.4), (4.0, 1.0)])
def test_the_interval_covers_the_truth_about_as_often_as_it_says(spread):
    """Recordings of a class differ (beta), windows of one recording are answered with its own share."""
    rng = np.random.default_rng(0)
    hits = 0
    for _ in range(200):
        shares = [[rng.binomial(n, p) / n for p in rng.beta(*spread, count)] for count, n in ((6, 7), (5, 11), (4, 12))]
        low, high = interval(shares)
        hits += low <= spread[0] / sum(spread) <= high
    assert 0.9 <= hits / 200 <= 0.995


def test_balanced_accuracy_is_the_mean_recall():
    found = score(["a", "a", "a", "b"], ["a", "a", "b", "b"], "window")
    assert found["balanced_accuracy"] == pytest.approx((2 / 3 + 1) / 2, abs=1e-4)
    assert found["n"] == 4
    assert found["low"] < found["balanced_accuracy"] < found["high"]
    assert found == score(["a", "a", "a", "b"], ["a", "a", "b", "b"], "window")


@pytest.mark.parametrize(("better", "worse"), [(5, 1), (1, 0), (0, 0), (3, 3), (0, 8)])
def test_sign_test_is_the_binomial_one(better, worse):
    expected = stats.binomtest(better, better + worse).pvalue if better + worse else 1.0
    assert sign_test(better, worse) == pytest.approx(expected)


def test_confusion_counts():
    assert confusion(["a", "b", "b"], ["a", "a", "b"], ("a", "b")) == [[1, 0], [1, 1]]
