"""What a fitted effect leaves, feature by feature: the likelihood by which a second one may stand beside it.

The metric that tells effects apart counts in units of how far draws of one effect lie apart on machines of the kind,
sixteen to twenty times what measurement and drift make. Once the best effect is fitted to the observation together with
the machine, what it leaves is compared with measurement, drift and the fitted draws' own spread instead, every feature
by itself, and a second effect counts by how much less both leave (docs/decisions/reconcile-leftover.md).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.judge.changes import Changes
from reconcile.judge.metric import LEAST_DB
from reconcile.machine.library import Catalogued
from reconcile.machine.second import strikes
from reconcile.machine.setting import Found, Setting
from reconcile.observe.phases import wrapped
from signals.series import FloatArray

NEAREST = 8
"""Draws of the fitted effect that speak for it."""
OWN_SHARE = 0.3
"""Share of a feature's change by which the forms of laws may err, as a deviation: of fits with the right effect half of
all features that change by more than 6 dB miss by less. The same whatever is supposed, so that a large supposed change
buys no tolerance."""
BEST = 4
"""Draws by which effects are compared with each other."""
QUIET_DB = 1.0
"""The fitted effect moves a feature less: what moved there is another's."""
LARGE = 3.0
"""Deviations from which a feature counts by its logarithm."""


@dataclass(frozen=True, kw_only=True)
class Leftover:
    """What the effect's nearest draws `members` (n, F) leave of the `observed` change (F,), dB; `variance` (F,) dB^2 of
    what they may leave, `used` (F,) features, `quiet` those that the effect does not move, and
    `turns` those that are known up to whole turns: phases."""

    observed: FloatArray
    members: FloatArray
    variance: FloatArray
    used: np.ndarray
    quiet: np.ndarray
    turns: np.ndarray

    @property
    def shown(self) -> FloatArray:
        """The median change, (F,) dB."""
        return np.asarray(np.median(self.members, axis=0))

    @property
    def base(self) -> float:
        """Log likelihood of the effect alone: of the better half of its draws."""
        return self.level(self.members)

    def likelihood(self, changes: FloatArray, mask: np.ndarray | None = None) -> FloatArray:
        """(n, F) -> (n,): log likelihood of the observation, up to a constant, by the features of `mask` or all; what
        is far off counts by its logarithm."""
        part = (self.used if mask is None else mask) & np.isfinite(changes)
        away = np.where(part, _turned(self.observed - changes, self.turns) / np.sqrt(self.variance), 0.0)
        compressed = LARGE * np.log1p(np.abs(away) / LARGE)
        return np.asarray(-0.5 * np.sum(compressed**2, axis=-1))

    def nearest(self, changes: FloatArray) -> FloatArray:
        """(n, F) -> (k, F): as many of these as speak for the effect, the likeliest."""
        return np.asarray(changes[np.argsort(-self.likelihood(changes))[:NEAREST]])

    def level(self, changes: FloatArray) -> float:
        """Mean log likelihood of the better half: the best of many is better by chance."""
        told = np.sort(self.likelihood(changes))
        return float(told[told.size // 2 :].mean())

    def by_point(self, changes: FloatArray, points: int) -> FloatArray:
        """(points,): by how much the better half of `changes` (n, F) is likelier than that of the effect alone at each
        operating point; all features of one stand before those of the next."""
        place = np.arange(self.observed.size) * points // self.observed.size
        told = [[self._better(one, self.used & (place == p)) for p in range(points)] for one in (changes, self.members)]
        return np.asarray(np.array(told[0]) - np.array(told[1]))

    def _better(self, changes: FloatArray, mask: np.ndarray) -> float:
        """Mean log likelihood by the features of `mask` of the half that is better by all."""
        order = np.argsort(self.likelihood(changes))
        return float(self.likelihood(changes, mask)[order[order.size // 2 :]].mean())

    def by(self, mask: np.ndarray) -> Leftover:
        """By the features of `mask` (F,) alone."""
        return replace(self, used=self.used & mask, quiet=self.quiet & mask)

    def by_sums(self, changes: Changes, others: FloatArray) -> FloatArray:
        """(n,): log likelihood that each of the `others` (n, F) adds to the median as a sum; by all features or by
        those that the effect does not move, whichever speaks louder: where both move one line, sums err."""
        both = changes.both(self.shown[None], others)
        alone = self.shown[None]
        gains = [self.likelihood(both, m) - self.likelihood(alone, m) for m in (self.used, self.quiet)]
        return np.asarray(np.maximum(*gains))


def _turned(away: FloatArray, turns: np.ndarray) -> FloatArray:
    """Differences (n, F), those of phases to the nearest turn."""
    found = np.array(away)
    found[..., turns] = wrapped(found[..., turns])
    return found


def leftover(setting: Setting, found: Found, name: str, told: FloatArray) -> Leftover:
    """Of an effect whose draws have the evidence `told` (draws,) in the library's order."""
    library = found.known.library
    rows = np.array(library.groups[name])[np.argsort(-told)[:NEAREST]]
    return _left_by(setting.changes, np.asarray(library.changes[rows]))


def _left_by(changes: Changes, members: FloatArray) -> Leftover:
    drift = np.nanstd(np.nan_to_num(changes.null), axis=0)
    observed = np.nan_to_num(changes.observed)
    measured = np.nan_to_num(changes.measured)
    channel = changes.single.chosen.size
    turns = np.arange(observed.size) % channel >= channel - changes.phases
    members = members[0] + _turned(members - members[0], turns)
    spread = np.nan_to_num(np.std(members, axis=0))
    variance = measured**2 + drift**2 + spread**2 + LEAST_DB**2 + (OWN_SHARE * observed) ** 2
    used = np.isfinite(changes.observed) & np.isfinite(changes.measured) & np.isfinite(members).all(axis=0)
    quiet = used & (np.abs(np.nan_to_num(members)).max(axis=0) < QUIET_DB)
    return Leftover(observed=observed, members=members, variance=variance, used=used, quiet=quiet, turns=turns)


def likelihoods(setting: Setting, found: Found) -> dict[str, float]:
    """Log likelihood over no change of every effect that was fitted together with the machine and does not strike: the
    mean of its best draws, all against the same variance."""
    library = found.known.library
    told = {}
    for name in found.led:
        values = np.sort(over_nothing(setting.changes, library.changes[list(library.groups[name])]))
        if not strikes(name):
            told[name] = float(values[-BEST:].mean())
    return told


def over_nothing(changes: Changes, drawn: FloatArray) -> FloatArray:
    """(n, F) -> (n,): log likelihood over no change of what is `drawn`, all against the same variance."""
    nothing = _left_by(changes, np.zeros((1, changes.observed.size)))
    return nothing.likelihood(drawn) - nothing.base


def ranked_seconds(
    left: Leftover, changes: Changes, atlas: Catalogued, names: Sequence[str]
) -> list[tuple[str, float, tuple[int, ...]]]:
    """Of every name in the `atlas`: what it adds by sums, the most first, and its rows there, the best first."""
    found = []
    for name in names:
        rows = np.array(atlas.library.groups[name])
        gains = left.by_sums(changes, atlas.library.changes[rows])
        order = np.argsort(-gains)
        found.append((name, float(gains[order[0]]), tuple(int(k) for k in rows[order])))
    return sorted(found, key=lambda one: -one[1])
