from __future__ import annotations

import numpy as np

from sideband_datasets.folder.repeated import Signals

RNG = np.random.default_rng(0)


def _signals(count: int) -> list[np.ndarray]:
    return [RNG.standard_normal(50).astype(np.float32) for _ in range(count)]


def _gathered(*rows: tuple[int, str, np.ndarray]) -> Signals:
    signals = Signals(rows=20, splits=("train", "test"))
    for row, split, signal in rows:
        signals.add(row, split, signal)
    return signals


def test_a_signal_of_two_splits_is_told_once_with_its_rows():
    a, b, c = _signals(3)
    found = list(
        _gathered((3, "train", a), (9, "test", b), (4, "train", c), (7, "test", a), (11, "test", a)).repeated()
    )
    (finding,) = found
    assert str(finding) == "data: leak: 1 signals stand in two splits, bit for bit: row 3 of train and row 7 of test"


def test_one_bit_makes_another_signal():
    (a,) = _signals(1)
    other = a.copy()
    other.view(np.uint32)[17] ^= 1
    assert not list(_gathered((0, "train", a), (1, "test", other)).repeated())
    assert list(_gathered((0, "train", a), (1, "test", a.copy())).repeated())


def test_within_a_split_a_signal_may_repeat():
    a, b = _signals(2)
    assert not list(_gathered((0, "train", a), (1, "train", a), (2, "test", b), (3, "test", b)).repeated())


def test_silence_is_like_any_other_silence():
    still = np.full(50, 2.5, dtype=np.float32)
    assert not list(_gathered((0, "train", still), (1, "test", still)).repeated())


def test_few_of_many_pairs_are_named_and_all_are_counted():
    kept = _signals(6)
    rows = [(k, "train", s) for k, s in enumerate(kept)] + [(k + 6, "test", s) for k, s in enumerate(kept)]
    (finding,) = _gathered(*rows).repeated()
    assert "6 signals" in finding.what
    assert finding.what.count(" and row ") == 3
