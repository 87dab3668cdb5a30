import pytest

from learn.sim2real.scores import confusion, score, wilson


def test_wilson_is_that_of_the_literature():
    """Newcombe, Stat. Med. 17 (1998) 857-872, table I: 81 of 263 gives 0.2553 to 0.3662; 0 of 20 gives 0 to 0.1611."""
    assert wilson(81, 263) == pytest.approx((0.2553, 0.3662), abs=5e-5)
    assert wilson(0, 20) == pytest.approx((0.0, 0.1611), abs=5e-5)


def test_balanced_accuracy_is_the_mean_recall():
    found = score(["a", "a", "a", "b"], ["a", "a", "b", "b"], "window")
    assert found["balanced_accuracy"] == pytest.approx((2 / 3 + 1) / 2, abs=1e-4)
    assert found["n"] == 4
    assert found["low"] < found["balanced_accuracy"] < found["high"]


def test_confusion_counts():
    assert confusion(["a", "b", "b"], ["a", "a", "b"], ("a", "b")) == [[1, 0], [1, 1]]
