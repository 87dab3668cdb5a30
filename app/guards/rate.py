"""Token buckets: how often the holder of an API key may call, counted in the memory of one process."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Bucket:
    """Calls that may still be made at once, at a time of a steady clock, s."""

    tokens: float
    at_s: float


def take(bucket: Bucket | None, per_minute: int, now_s: float) -> tuple[Bucket, float]:
    """The bucket after a call, and seconds to wait: 0 for a call that may be made, which takes a token.

    A full bucket holds a minute's calls and refills evenly: at most `per_minute` at once, then one every
    60 / `per_minute` s. A bucket that is not known is full.
    """
    if bucket is None:
        bucket = Bucket(tokens=per_minute, at_s=now_s)
    refill = max(0.0, now_s - bucket.at_s) * per_minute / 60.0
    tokens = min(bucket.tokens + refill, float(per_minute))
    if tokens >= 1.0:
        return Bucket(tokens=tokens - 1.0, at_s=now_s), 0.0
    return Bucket(tokens=tokens, at_s=now_s), (1.0 - tokens) * 60.0 / per_minute


class Buckets:
    """The buckets of all holders, at most `most`: then the one that called longest ago is forgotten."""

    def __init__(self, *, most: int, clock: Callable[[], float]) -> None:
        self._most, self._clock = most, clock
        self._held: OrderedDict[str, Bucket] = OrderedDict()

    def take(self, holder: str, per_minute: int) -> float:
        """Count a call; seconds to wait, 0 when it may be made."""
        self._held[holder], wait = take(self._held.get(holder), per_minute, self._clock())
        self._held.move_to_end(holder)
        while len(self._held) > self._most:
            self._held.popitem(last=False)
        return wait

    def __len__(self) -> int:
        return len(self._held)
