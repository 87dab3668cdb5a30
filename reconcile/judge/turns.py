"""Have the teeth's sidebands at a shaft's turns risen together? What no single one of them shows, all of them do.

Something out of true or balance, or a torque that comes so many times a turn, raises the sidebands of one shaft at one
number of turns around every harmonic of the teeth, on every sensor and at more than one speed. One by one each is
lost among what balls and drift do to others; their mean over harmonics, sides and sensors is not.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from reconcile.judge.metric import Whitening
from reconcile.observe.watch import WatchList
from reconcile.tail import tail_chance
from signals.series import FloatArray

LEAST_DB = 1.5
"""Mean rise at the speed where it is largest but one, below which it is nothing however rarely sound machines show it:
eight of the proof's come to 0.3 dB, but for the first turn of the slow shaft, which the speed's wander lifts by up to
6.3 and whose deviations are as wide; an eccentric pinion of 86 um (v070) to 1.8."""
FORM = 0.35
"""Share by which an effect's simulated rise may be wrong: another form of its law, another resonance."""
SOFTNESS = 8.0
"""Squared distance that counts as one unit of twice the evidence: between what `judge/space.py` finds for single lines
(4 and more) and for first sidebands of that machine (16)."""


@dataclass(frozen=True, kw_only=True)
class Sidebands:
    """Groups of watched lines: `members[k]` numbers among a channel's features, `names[k]` shaft's base and turns."""

    names: tuple[tuple[str, int], ...]
    members: tuple[np.ndarray, ...]

    def rises(self, changes: FloatArray, whiten: Whitening, points: int, channels: int) -> FloatArray:
        """Changes (n, P * C * F), dB -> (n, P, C, groups): mean of each group in units of its own noise."""
        cube = whiten(changes).reshape(changes.shape[0], points, channels, -1)
        return np.stack([cube[..., own].sum(axis=-1) / np.sqrt(own.size) for own in self.members], axis=-1)


def sidebands(watch: WatchList) -> Sidebands:
    """The sidebands of all harmonics, by shaft and turns."""
    found: dict[tuple[str, int], list[int]] = {}
    for k, line in enumerate(watch.lines):
        if line.family == "sideband":
            base, turns = next((b, n) for b, n in line.orders.items() if b.startswith("f_r"))
            found.setdefault((base, abs(int(turns))), []).append(k)
    return Sidebands(names=tuple(found), members=tuple(np.array(own) for own in found.values()))


@dataclass(frozen=True, kw_only=True)
class Turned:
    """`p`: chance that sound machines show as much at any shaft's turns; `shaft` (base of its speed) and `turns` where
    most has risen, by `rise_db` at the speed where it is largest but one."""

    p: float = 1.0
    shaft: str = ""
    turns: int = 0
    rise_db: float = 0.0


def turned(
    watch: WatchList,
    observed: FloatArray,
    sound: FloatArray,
    whiten: Whitening,
    speeds: Sequence[Sequence[int]],
    channels: int,
) -> Turned:
    """`observed` (F,) against sound machines with noise, `sound` (n, F), dB; nothing at one speed, where one resonance
    may be all, and without teeth. `speeds`: numbers of the operating points at each."""
    groups, points = sidebands(watch), sum(map(len, speeds))
    if len(speeds) < 2 or not groups.names:
        return Turned()

    def second(changes: FloatArray) -> FloatArray:
        """(n, groups): at the speed where it is largest but one."""
        together = groups.rises(changes, whiten, points, channels).sum(axis=2) / np.sqrt(channels)
        return _second(together, speeds)

    rest = second(sound)
    middle, spread = rest.mean(axis=0), np.maximum(rest.std(axis=0), 1e-9)
    seen = (second(observed[None])[0] - middle) / spread
    best = int(np.argmax(seen))
    own = np.nan_to_num(observed).reshape(points, channels, -1)[..., groups.members[best]]
    rise_db = float(_second(own.mean(axis=(1, 2))[None], speeds)[0])
    shaft, turns = groups.names[best]
    p = tail_chance(((rest - middle) / spread).max(axis=1), float(seen[best])) if rise_db >= LEAST_DB else 1.0
    return Turned(p=p, shaft=shaft, turns=turns, rise_db=rise_db)


def _second(values: FloatArray, speeds: Sequence[Sequence[int]]) -> FloatArray:
    """(n, points, ...) -> (n, ...): the largest but one of the speeds, each by its largest point."""
    each = np.stack([values[:, list(own)].max(axis=1) for own in speeds], axis=1)
    return np.asarray(np.sort(each, axis=1)[:, -2])


def evidence_of_turns(
    watch: WatchList,
    observed: FloatArray,
    sound: FloatArray,
    drawn: FloatArray,
    groups: Mapping[str, tuple[int, ...]],
    whiten: Whitening,
    shape: tuple[int, int],
) -> dict[str, float]:
    """Log evidence of effects over no change by what rose together, mean over the draws of each (no more of them make
    it likelier): `drawn` (m, F) rows of the effects `groups`, `shape` points and channels."""
    own = sidebands(watch)

    def seen(changes: FloatArray) -> FloatArray:
        return own.rises(changes, whiten, *shape).reshape(changes.shape[0], -1)

    rest = seen(sound)
    middle, spread = rest.mean(axis=0), np.maximum(rest.std(axis=0), 1.0)
    now, draws = (seen(observed[None])[0] - middle) / spread, seen(drawn) / spread
    variance = 1.0 + (FORM * draws) ** 2
    far = np.sum((now - draws) ** 2 / variance + np.log(variance), axis=1)
    nothing = float(np.sum(now**2))
    log = (nothing - far) / (2.0 * SOFTNESS)
    return {name: float(np.logaddexp.reduce(log[list(rows)]) - np.log(len(rows))) for name, rows in groups.items()}
