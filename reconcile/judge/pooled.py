"""Features pooled over what belongs together: a family of lines, an octave or so of spectrum, a kind of modulation.

An effect moves whole families (all ball-pass lines of a bearing, all sidebands of a shaft), and which member moves most
depends on resonances that differ from machine to machine. Pooled over members and operating points, signatures of one
effect on different machines come close to each other, and few simulations suffice to tell effects apart.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from reconcile.judge.metric import Whitening
from reconcile.judge.pool_kernel import family_sums
from reconcile.observe.features import Layout
from reconcile.observe.watch import Watched, WatchList
from signals.series import BoolArray, FloatArray

BANDS_TOGETHER = 4
UNUSED = ""
DEAD = 2.0
"""Changes below this many deviations are noise: how large the noise is exactly must not matter."""
LARGE = 3.0
LOW_MESH = 2
"""Mesh harmonics up to here are one family, higher ones another: tooth shapes act on the higher ones."""


def _line_family(line: Watched) -> str:
    if line.family == "mesh":
        return "mesh low" if max(line.orders.values()) <= LOW_MESH else "mesh high"
    if line.family == "sideband":
        return _sideband_family(line)
    if line.family in ("shaft", "subharmonic"):
        base, order = next(iter(line.orders.items()))
        if order % 1:
            return f"{base} fractions"
        return f"{base} x{order:g}" if order <= LOW_MESH else f"{base} harmonics"
    return line.family + " " + next(b for b in line.orders if not b.startswith("f_r"))


def _shaft_order(line: Watched) -> tuple[str, float]:
    return next((base, order) for base, order in line.orders.items() if base.startswith("f_r"))


def _sideband_family(line: Watched) -> str:
    """The first pair of a shaft's sidebands is a family of its own: what is out of true or out of balance moves it and
    hardly the others."""
    base, order = _shaft_order(line)
    if abs(order) != 1:
        return f"sidebands {base}"
    mesh = next(n for b, n in line.orders.items() if b != base)
    return f"sidebands {base} first, mesh {'low' if mesh <= LOW_MESH else 'high'}"


def _phase_family(line: Watched) -> str:
    return "phase mesh" if line.family == "mesh" else f"phase sidebands {_shaft_order(line)[0]}"


def _modulation_family(line: Watched) -> str:
    return next((b for b in line.orders if not b.startswith("f_r")), next(iter(line.orders)))


@dataclass(frozen=True, kw_only=True)
class Pooling:
    """`family` (F,) of one channel's features, names of the families, and the points and channels of a change."""

    family: np.ndarray
    names: tuple[str, ...]
    points: int
    channels: int

    def __call__(self, z: FloatArray) -> FloatArray:
        """Whitened changes (n, P * C * F) -> (n, 3 * C * families): common rise, size, and size where it is largest.

        The common rise is the mean times the root of the number of members, so that noise keeps unit variance.
        """
        return self.whitened(z, np.ones(z.shape[1]), np.arange(z.shape[0]))

    def whitened(self, changes: FloatArray, sigma: FloatArray, rows: np.ndarray) -> FloatArray:
        """The same of some `rows` (k,) of changes (n, P * C * F) in dB, whitened by `sigma` (P * C * F,)."""
        found = np.zeros((rows.size, len(self.names), 3, self.channels))
        counts = np.bincount(self.family[self.family >= 0], minlength=len(self.names))
        family_sums(np.ascontiguousarray(changes), rows, sigma, self.family, counts, DEAD, found)
        pooled = found.reshape(rows.size, -1)
        return np.asarray(np.sign(pooled) * np.log1p(np.abs(pooled)))


def seen(
    view: Callable[[FloatArray], FloatArray], whiten: Whitening, changes: FloatArray, rows: np.ndarray | None = None
) -> FloatArray:
    """`view(whiten(changes[rows]))`, changes (n, P * C * F) in dB, all rows if not given; of single features only these
    are whitened."""
    if isinstance(view, OneByOne):
        columns = view.columns
        kept = changes.T[columns] if rows is None else changes.T[np.ix_(columns, rows)]
        return view.compressed(whiten.only(columns)(kept.T))
    if isinstance(view, Pooling):
        return view.whitened(changes, whiten.sigma, np.arange(changes.shape[0]) if rows is None else rows)
    return view(whiten(changes if rows is None else changes[rows]))


@dataclass(frozen=True, kw_only=True)
class OneByOne:
    """Whitened features of a channel that count each for itself, at every point: `chosen` (F,) is a mask.

    On machines that agree with the baseline the pattern of single lines is that of the effect: which resonance
    each of them meets is known. Changes much larger than `LARGE` deviations count by their logarithm.
    """

    chosen: np.ndarray
    points: int
    channels: int
    repeats: bool = True
    """Whether sound machines repeat these lines as simulated ones do: bearings that rattle under a weight do not, and a
    change of their lines that has no effect's pattern says nothing."""

    def __call__(self, z: FloatArray) -> FloatArray:
        """(n, P * C * F) -> (n, P * C * chosen)."""
        return self.compressed(z[:, self.columns])

    @property
    def columns(self) -> np.ndarray:
        """Places of the chosen features among P * C * F."""
        return np.flatnonzero(np.tile(self.chosen, self.points * self.channels))

    def compressed(self, kept: FloatArray) -> FloatArray:
        """The chosen features (n, D), whitened, to the same."""
        return np.asarray(np.sign(kept) * LARGE * np.log1p(np.abs(kept) / LARGE))


def _one_by_one(
    watched: WatchList, layout: Layout, which: BoolArray, *, points: int, channels: int, phased: bool
) -> OneByOne:
    chosen = np.zeros(layout.size, dtype=bool)
    chosen[: layout.lines] = which
    if phased:
        chosen[layout.slices()["phase"]] = which[list(watched.phased)]
    return OneByOne(chosen=chosen, points=points, channels=channels, repeats=bool(watched.gears))


def own_lines(watched: WatchList, layout: Layout, *, points: int, channels: int, phased: bool = False) -> OneByOne:
    """The machine's own lines (mesh harmonics where it has teeth), one by one; with their phases between sensors."""
    return _one_by_one(watched, layout, watched.own, points=points, channels=channels, phased=phased)


def lines_beside(watched: WatchList, layout: Layout, *, points: int, channels: int, phased: bool = False) -> OneByOne:
    """What modulates them (the first pair of every shaft's sidebands around mesh harmonics), one by one; with their
    phases."""
    return _one_by_one(watched, layout, watched.beside, points=points, channels=channels, phased=phased)


def lines_twice(watched: WatchList, layout: Layout, *, points: int, channels: int) -> OneByOne:
    """What modulates them twice a turn (the second pair of every shaft's sidebands), one by one."""
    return _one_by_one(watched, layout, watched.twice, points=points, channels=channels, phased=False)


def pooling(watched: WatchList, layout: Layout, *, points: int, channels: int, phased: bool = False) -> Pooling:
    """Families of this machine's watch list; with those of phases between sensors."""
    labels = [_line_family(line) for line in watched.lines]
    for kind in ("floor", "total"):
        labels += [f"{kind} {b // BANDS_TOGETHER}" for b in range(layout.bands)]
    for shape in range(layout.shapes):
        half = "low" if shape < layout.shapes // 2 else "high"
        labels += [f"modulation {half} {_modulation_family(line)}" for line in watched.modulations]
    for _ in range(layout.shapes):
        labels += [f"turn {base}" for base, _ in watched.gears]
    labels += [f"{kind} {shape}" for kind in ("kurtosis", "skewness") for shape in range(layout.shapes)]
    labels += [_phase_family(watched.lines[i]) if phased else UNUSED for i in watched.phased]
    names = tuple(sorted(set(labels) - {UNUSED}))
    place = {name: k for k, name in enumerate(names)} | {UNUSED: -1}
    return Pooling(family=np.array([place[label] for label in labels]), names=names, points=points, channels=channels)
