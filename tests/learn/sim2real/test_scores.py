import numpy as np
import pytest
from scipy import stats

from learn.sim2real.scores import confusion, interval, score, sign_test


def test_interval_of_one_class_of_recordings_is_that_of_two_betas():
    """Weights of a bootstrap are a Dirichlet's, so those of the right ones together are a beta's."""
    expected = stats.beta(7, 3.5).ppf(0.025), stats.beta(7.5, 3).ppf(0.975)
    assert interval([[1.0] * 7 + [0.0] * 3]) == pytest.approx(expected, abs=0.02)


def test_a_class_of_two_right_ones_is_not_certain():
    low, high = interval([[1.0, 1.0]])
    assert 0.1 < low < 0.6
    assert high == pytest.approx(1.0)


def test_windows_of_one_recording_bring_no_certainty():
    """Thirty windows of two recordings say no more than the two."""
    truth, said = ["a"] * 30, ["a"] * 15 + ["b"] * 15
    together = score(truth, said, "window", [1] * 15 + [2] * 15)
    apart = score(truth, said, "window")
    widths = [float(one["high"]) - float(one["low"]) for one in (together, apart)]
    assert widths[0] > 2 * widths[1]
    assert together["balanced_accuracy"] == apart["balanced_accuracy"] == 0.5


def shares(rng, recall, windows):
    """Of recordings of four classes, as many as are measured; windows of one recording share its own recall."""
    a, b = 3 * recall, 3 * (1 - recall)
    if not windows:
        return [(rng.random(count) < recall).astype(float) for count in (6, 5, 4, 2)]
    sizes = ((6, 7), (5, 11), (4, 12), (2, 15))
    return [[rng.binomial(n, p) / n for p in rng.beta(a, b, count)] for count, n in sizes]


@pytest.mark.slow
@pytest.mark.parametrize("recall", [0.7, 0.875])
@pytest.mark.parametrize("windows", [False, True])
def test_the_interval_holds_the_truth_at_least_as_often_as_it_says(recall, windows):
    rng = np.random.default_rng(0)
    hits, widths = 0, []
    for _ in range(200):
        low, high = interval(shares(rng, recall, windows))
        hits += low <= recall <= high
        widths.append(high - low)
    assert hits / 200 >= 0.95
    assert np.mean(widths) < 0.5


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
