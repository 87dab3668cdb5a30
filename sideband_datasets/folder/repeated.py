"""Signals that are the same, to the bit, in two splits; of each only a hash is kept."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from sideband_datasets.folder.finding import Finding
from sideband_datasets.folder.layout import DATA

HASH_BYTES = 16
MOST_TOLD = 3


class Signals:
    """Hashes of the signals of a dataset, 17 bytes a row. A signal that does not move is like any other silence."""

    def __init__(self, *, rows: int, splits: Sequence[str]) -> None:
        self._splits = list(splits)
        self._hashes = np.zeros((rows, HASH_BYTES), dtype=np.uint8)
        self._split = np.full(rows, -1, dtype=np.int8)

    def add(self, row: int, split: str, signal: NDArray[np.float32]) -> None:
        """Keep the hash of a row's signal, shape (samples,), in the split of its file."""
        if split not in self._splits or signal.size == 0 or np.all(signal == signal[0]):
            return
        digest = hashlib.sha256(signal.tobytes()).digest()[:HASH_BYTES]
        self._hashes[row] = np.frombuffer(digest, dtype=np.uint8)
        self._split[row] = self._splits.index(split)

    def repeated(self) -> Iterator[Finding]:
        """One finding, with the first few pairs of rows."""
        rows = np.flatnonzero(self._split >= 0)
        if rows.size < 2:
            return
        halves = self._hashes[rows].view(np.uint64)
        order = np.lexsort((rows, halves[:, 0], halves[:, 1]))
        rows, halves = rows[order], halves[order]
        begins = np.flatnonzero(np.r_[True, np.any(halves[1:] != halves[:-1], axis=1)])
        split = self._split[rows]
        crossing = np.minimum.reduceat(split, begins) != np.maximum.reduceat(split, begins)
        if not crossing.any():
            return
        ends = np.r_[begins[1:], rows.size]
        pairs = [self._pair(rows[a:b]) for a, b in zip(begins[crossing][:MOST_TOLD], ends[crossing], strict=False)]
        what = f"leak: {int(crossing.sum())} signals stand in two splits, bit for bit: {'; '.join(pairs)}"
        yield Finding(where=DATA, what=what)

    def _pair(self, rows: NDArray[np.int64]) -> str:
        """The first row of a signal and the first of another split."""
        first = rows[0]
        other = rows[np.flatnonzero(self._split[rows] != self._split[first])[0]]
        return " and ".join(f"row {row} of {self._splits[int(self._split[row])]}" for row in (first, other))
