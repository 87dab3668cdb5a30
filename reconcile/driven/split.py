"""What is fitted and what is held out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from reconcile.driven.channels import Driven, FloatArray

PARTS = 3
"""Consecutive parts of a lone recording."""
MOST_FITTED = 12_000
MOST_CHOOSING = 8_000
"""Samples of the stretch that is fitted, and of the one after it on which candidates are chosen."""


@dataclass(frozen=True, kw_only=True)
class Part:
    """A recording, or a stretch of one, with its name."""

    name: str
    data: Driven

    @property
    def peak(self) -> float:
        """Largest excursion of the output."""
        answer = self.data.answer
        return float(np.max(np.abs(answer - np.median(answer))))


def parts_of(recordings: Sequence[Driven]) -> tuple[Part, ...]:
    """Each recording is a part; a lone one is cut into consecutive thirds."""
    if len(recordings) > 1:
        return tuple(Part(name=f"recording {i + 1}", data=data) for i, data in enumerate(recordings))
    data = recordings[0]
    edges = [data.answer.size * k // PARTS for k in range(PARTS + 1)]
    names = tuple(f"the {which} third of the record" for which in ("first", "second", "last"))
    return tuple(Part(name=names[k], data=data.part(edges[k], edges[k + 1])) for k in range(PARTS))


def order_of_use(parts: Sequence[Part]) -> tuple[Part, Part]:
    """Part to fit, part to hold out: the one that goes farthest is held out, the farthest of the rest is fitted.

    So a law must hold beyond the motion it was found on.
    """
    by_peak = sorted(parts, key=lambda p: -p.peak)
    return by_peak[1], by_peak[0]


def strongest(values: FloatArray, count: int) -> int:
    """First index of the window of `count` samples with the largest mean square."""
    if values.size <= count:
        return 0
    total = np.concatenate([[0.0], np.cumsum((values - values.mean()) ** 2)])
    return int(np.argmax(total[count:] - total[:-count]))


def stretches(part: Part, *, quiet: bool = False) -> tuple[Driven, Driven]:
    """Stretch to fit and, right after it, the one to choose on: the liveliest window of the part, 3 to 2.

    `quiet`: the opposite window, where what grows faster than the motion matters least; half as long.
    """
    size = part.data.answer.size
    count = min(MOST_FITTED + MOST_CHOOSING, size)
    if quiet:
        count = min(count, size // 2)
        loud = strongest(part.data.answer, count)
        first = 0 if loud > size - count - loud else size - count
    else:
        first = strongest(part.data.answer, count)
    cut = first + count * MOST_FITTED // (MOST_FITTED + MOST_CHOOSING)
    return part.data.part(first, cut), part.data.part(cut, first + count)
