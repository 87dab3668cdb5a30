"""How strongly each family's lines stand out, and what that is worth: the same search at orders of no part.

The statistic of a family is the largest over bands and channels of its comb's standardised score. Its probability
comes from the same search at random orders that no part of the machine has, in the same spectra: whatever makes these
spectra lively (load, gears, other machines) makes the controls lively too.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.kinematics.comb_scores import Controls, at_orders, best_at, comb, scores, trials
from reconcile.kinematics.controls import control_orders
from reconcile.kinematics.envelopes import Envelopes
from reconcile.kinematics.families import Family, Ties
from reconcile.tail import tail_chance
from signals.series import FloatArray

NOISE_LOG = 1.5
"""Log power over the floor below which a bin counts nothing: noise passes it in 1 % of the bins."""
LARGEST_LOG = 7.0
SHAFT_BINS = 2.0
DENSE = 0.2
"""Share of the orders that a shaft's multiples cover, from which not all of them are the shaft's."""
FIRST_MULTIPLES, MANY_MULTIPLES = 6, 20
"""Multiples that are the shaft's whatever stands there, and how many further ones it takes to know what is usual."""
USUAL, LEAST_LOG, COMB = 0.85, 1.0, 0.5
"""Quantile of the heights at a shaft's further multiples, how high (log power) it may be, and a line must stand above
it, for the line to be another part's. A broken tooth raises nearly all multiples; what dies out sooner, a rub, more
than this share of the first. A race with sidebands of the shaft raises many, but not those."""
WIDE_BINS, LEAN_BINS = 3, 2
"""To either side of a line that is taken out: as slip smears it, and the main lobe alone."""
PAIRS, MANY_PAIRS, COVERED = 2, 6, 0.25
"""Pairs of sidebands that are taken out; in records so long that they cover less than this share, of the load zone's
many."""
CERTAIN_Z = 6.0
"""Robust deviations that noise does not reach."""
FIRM_SHARE, FIRM_Z = 0.5, 5.0
"""Of the firmest band's score, and deviations, from which another band hears the family too."""


@dataclass(frozen=True, kw_only=True)
class Evidence:
    """A family in one recording: `z` standardised score, `chance` that a foreign order reaches it."""

    family: Family
    z: float
    chance: float
    slip: float
    order: float
    """The family's base order as found."""
    channel: str
    band_hz: tuple[float, float]
    depth: float
    """Root of the summed squares of its lines in the squared envelope, over the mean of it."""
    channel_z: dict[str, float]
    deepest: float = 0.0
    """The largest depth over all bands of the channel that hear it."""
    deepest_hz: tuple[float, float] = (0.0, 0.0)
    """That band."""
    kurtosis: float = 0.0
    """The largest excess kurtosis of those bands: impacts reach far beyond what noise does whose strength varies."""
    flatness: float = 0.0
    """Mean power of its third and higher lines over that of its first two, in the deepest band: of blows they are
    alike, of what swells smoothly they fall off."""
    others: tuple[Evidence, ...] = ()
    """The same of each other channel, the firmest first."""


def logs(envelopes: Envelopes, ties: Ties, *, shaft_lines: bool) -> FloatArray:
    """Log power over noise (bands, bins), clipped; lines of the shafts taken out unless `shaft_lines`."""
    values = np.clip(np.log(np.maximum(envelopes.excess, 1e-12)) - NOISE_LOG, 0.0, LARGEST_LOG)
    if not shaft_lines:
        for ratio in sorted(ties.shafts.values(), reverse=True):
            values[_of_shaft(values, envelopes.order_step, ratio, ties.mesh_orders)] = 0.0
    values[:, : int(np.ceil(SHAFT_BINS)) + 1] = 0.0
    wide = values.copy()
    wide[:, 1:-1] = np.maximum(np.maximum(values[:, :-2], values[:, 1:-1]), values[:, 2:])
    return wide


def _of_shaft(values: FloatArray, step: float, ratio: float, meshes: Sequence[float]) -> FloatArray:
    """Where the lines of a shaft lie, (bands, bins).

    The multiples of a slow shaft in a short recording cover half of all orders: nine turns of a gear of 81 teeth on 23
    are the outer race of seven balls to 0.7 %. There only the first multiples and those about the teeth's harmonics are
    the shaft's whatever stands at them. A line at another is not where the shaft's multiples are usually empty, and no
    comb begins at the first.
    """
    number = np.rint(np.arange(values.shape[1]) * step / ratio)
    near = np.abs(np.arange(values.shape[1]) * step - number * ratio) < SHAFT_BINS * step
    there, place = np.unique(number[near], return_inverse=True)
    later = there > FIRST_MULTIPLES
    if 2.0 * SHAFT_BINS * step <= DENSE * ratio or later.sum() < MANY_MULTIPLES:
        return np.asarray(np.broadcast_to(near, values.shape))
    apart = [np.abs(number - np.rint(number * ratio / mesh) * mesh / ratio) for mesh in meshes]
    known = np.minimum.reduce([number, *apart]) <= FIRST_MULTIPLES
    level = np.zeros((values.shape[0], there.size))
    for band, row in zip(level, values, strict=True):
        np.maximum.at(band, place, row[near])
    usual = np.quantile(level[:, later], USUAL, axis=1)[:, np.newaxis]
    first = level[:, ~later & (there > 0)] > LEAST_LOG
    comb = np.sum(first, axis=1, keepdims=True) > COMB * max(first.shape[1], 1)
    spared = (values > usual + LEAST_LOG) & (usual <= LEAST_LOG) & ~comb
    return np.asarray(near & (known | ~spared))


def without(
    values: FloatArray,
    envelopes: Envelopes,
    spacings: Sequence[float],
    order: float,
    reach: int = WIDE_BINS,
    pairs: int = PAIRS,
) -> FloatArray:
    """`values` (bands, bins) with all harmonics of an order and `pairs` of sidebands of each spacing put to noise,
    `reach` bins to either side."""
    cleared = values.copy()
    top = int(values.shape[1] * envelopes.order_step / order)
    shifts = np.unique([0.0, *(m * s for s in spacings for m in range(-pairs, pairs + 1))])
    lines = (np.arange(1, top + 1)[:, np.newaxis] * order + shifts).ravel()
    for shift in range(-reach, reach + 1):
        place = np.rint(lines / envelopes.order_step).astype(np.int64) + shift
        cleared[:, place[(place >= 0) & (place < values.shape[1])]] = 0.0
    return cleared


def _around(family: Family, ties: Ties) -> list[float]:
    """Distances of sidebands that load and shafts may give any defect: with Z balls BPFO + 2 shafts may lie on BPFI."""
    return [*ties.shafts.values(), *(f.order for f in ties.families if f.key == f"{family.site}.cage")]


def _absent(values: FloatArray, envelopes: Envelopes, spacing: float, order: float, *, many: bool) -> FloatArray:
    """`values` without a family's lines: few of its sidebands, or `many` in records so long that something is left."""
    top = envelopes.excess.shape[1] * envelopes.order_step
    covered = (
        top / order * (2 * WIDE_BINS + 1) * envelopes.order_step
    )  # of each distance of sidebands, by all harmonics
    pairs = MANY_PAIRS if many and covered < COVERED * spacing else PAIRS
    return without(values, envelopes, [spacing], order, pairs=pairs)


def family_evidence(
    channels: Sequence[Envelopes],
    ties: Ties,
    family: Family,
    speed_doubt: float,
    rng: np.random.Generator,
    explained: Sequence[tuple[Family, float]] = (),
    lean: bool = False,
    certain_z: float = CERTAIN_Z,
) -> Evidence:
    """Evidence of one family over all bands and channels; `speed_doubt`: relative, widens the search; `certain_z`:
    deviations from which its lines are kept from the controls.

    `explained`: families (with their order as found) whose lines are taken out first; `lean`: only those of the family
    itself, not what shafts and cage may add, which in short records covers much of what another has.
    """
    turn = family.kind == "turn"
    reach = speed_doubt + (0.0 if turn else family.slip)
    controls = control_orders(ties, family, rng)
    best_control = np.full(controls.size, -np.inf)
    firmest: list[_Firmest] = []
    foreign: dict[tuple[float, int], Controls] = {}
    for e in channels:
        values = logs(e, ties, shaft_lines=turn)
        for other, order in explained:
            around = ([other.spacing] if other.sidebands else []) if lean else _around(other, ties)
            values = without(values, e, around, order, LEAN_BINS if lean else WIDE_BINS)
        base = trials(family, family.order, reach, e.order_step)
        table = scores(values, e, family, base)
        size = e.order_step, e.excess.shape[1]
        if size not in foreign:
            foreign[size] = at_orders(e, family, controls, reach)
        control, centre, spread = best_at(values, foreign[size])
        z = (table - centre) / spread
        if float(np.max(z)) > certain_z:
            # lines that are surely there must not be caught by the controls: were the family absent, so would they be
            found = float(base[int(np.argmax(np.max(z, axis=0)))])
            absent = _absent(values, e, family.spacing, found, many=certain_z < CERTAIN_Z)
            control, centre, spread = best_at(absent, foreign[size])
            z = (table - centre) / spread
        band, trial = (int(i) for i in np.unravel_index(int(np.argmax(z)), z.shape))
        best_control = np.maximum(best_control, np.max((control - centre) / spread, axis=0))
        firmest.append(_Firmest(envelopes=e, z=z[:, trial], band=band, order=float(base[trial])))
    by_channel = {one.envelopes.channel: one.top for one in firmest}
    firmest.sort(key=lambda one: -one.top)
    least = max(FIRM_Z, FIRM_SHARE * firmest[0].top)
    best, *others = (one.evidence(family, tail_chance(best_control, one.top), by_channel, least) for one in firmest)
    return replace(best, others=tuple(others))


@dataclass(frozen=True, kw_only=True)
class _Firmest:
    """The firmest reading of a family in one channel: scores of all bands (bands,) at its order, and the best band."""

    envelopes: Envelopes
    z: FloatArray
    band: int
    order: float

    @property
    def top(self) -> float:
        return float(self.z[self.band])

    def evidence(self, family: Family, chance: float, channel_z: dict[str, float], least: float) -> Evidence:
        """`least`: score from which a band hears it."""
        e = self.envelopes
        hear = np.flatnonzero(self.z >= least)
        depths = [comb_depth(e, int(b), family, self.order) for b in hear]
        deepest = int(hear[int(np.argmax(depths))]) if depths else self.band
        return Evidence(
            family=family,
            z=self.top,
            chance=chance,
            slip=self.order / family.order - 1,
            order=self.order,
            channel=e.channel,
            band_hz=e.band(self.band),
            depth=comb_depth(e, self.band, family, self.order),
            channel_z=channel_z,
            deepest=max(depths, default=0.0),
            deepest_hz=e.band(deepest),
            flatness=e.flatness(deepest, self.order),
            kurtosis=float(np.max(e.kurtosis[hear], initial=0.0)),
        )


def comb_depth(envelopes: Envelopes, band: int, family: Family, order: float) -> float:
    """Root of the summed squared depths of the comb's lines (largest of three bins), noise subtracted."""
    lines, _ = comb(family, np.array([order]))
    place = envelopes.place(np.abs(lines[0]))
    place = np.clip(place[(place > 1) & (place < envelopes.depth.shape[1] - 2)], 2, None)
    near = np.stack([place - 1, place, place + 1])
    pick = near[np.argmax(envelopes.depth[band][near], axis=0), np.arange(place.size)]
    square = envelopes.depth[band][pick] ** 2
    noise = square / np.maximum(envelopes.excess[band][pick], 1e-12)
    return float(np.sqrt(np.sum(np.maximum(square - 2 * noise, 0.0))))
