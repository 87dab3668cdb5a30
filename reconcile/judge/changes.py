"""Observed and simulated changes of all features at all operating points, in the same terms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import block_diag

from reconcile.atlas.bank import Bank
from reconcile.atlas.plan import AtlasPlan
from reconcile.calibrate.chain import Chain, Healthy, calibrate_chain
from reconcile.judge.in_step import Delay, clock_delays, compared
from reconcile.judge.measured import measured_db, unsteady_db, wander_patterns
from reconcile.judge.pooled import OneByOne, Pooling, lines_beside, lines_twice, own_lines, pooling
from reconcile.observe.background import gained_between
from reconcile.observe.features import Layout, Scale, changed, scale_of, soft_features, through
from reconcile.observe.observation import PointData
from reconcile.observe.statistics import Statistics
from reconcile.observe.watch import bases_at, watch_list
from signals.series import FloatArray


@dataclass(frozen=True, kw_only=True)
class Changes:
    """Rows of decibels, the features of all points one after the other (`starts` says where each point begins).

    `observed` (F,), `halves` (2, F): the test against its reference. `measured` (F,): standard deviation.
    `null` (n, F): healthy machines against their drifted twins (or, without baseline, against the nominal one).
    """

    observed: FloatArray
    halves: FloatArray
    measured: FloatArray
    null: FloatArray
    starts: tuple[int, ...]
    with_baseline: bool
    groups: np.ndarray
    """(F,): number of the group a feature belongs to: one point, one channel, one part."""
    pooling: Pooling
    single: OneByOne
    """The machine's own lines (mesh harmonics), one by one."""
    sides: OneByOne
    """What modulates them (the shafts' first sidebands), one by one."""
    twice: OneByOne
    """What modulates them twice a turn (the shafts' second sidebands), one by one; none without teeth."""
    wander: FloatArray
    """(k, F): changes that speed wander brings about, one deviation each; signs and sizes are free."""
    kind: FloatArray
    """(k, F): what drift changes on other machines of the kind, to learn from and not to compare with; may be empty."""
    phases: int = 0
    """Of each channel's features the last ones, which are known up to whole turns."""

    phased: tuple[OneByOne, ...] = ()
    """`single` and `sides` with the phases of these lines between sensors, where these are compared."""
    delays: tuple[Delay, ...] = ()
    """Of channels against each other since the baseline; where there are any, phases do not count."""

    def left(self, change: FloatArray) -> FloatArray:
        """What a change (F,) leaves of the observed one, (F,)."""
        channel = self.single.chosen.size
        return changed(self.observed.reshape(-1, channel), change.reshape(-1, channel), self.phases).ravel()

    def both(self, first: FloatArray, second: FloatArray) -> FloatArray:
        """Two changes (..., F) at once: what both raise adds as power, else one goes on from where the other ends.

        That is right on the mean over the phases by which two effects move one line, which nobody knows. Phases add.
        """
        power = 10.0 ** (np.clip(first, 0.0, 200.0) / 10.0) + 10.0 ** (np.clip(second, 0.0, 200.0) / 10.0) - 1.0
        linear = np.asarray(first + second)
        found = np.where((first > 0.0) & (second > 0.0), 10.0 * np.log10(power), linear)
        if self.phases:
            channel = self.single.chosen.size
            split = (*linear.shape[:-1], -1, channel)
            turned = changed(linear.reshape(split), np.zeros(channel), self.phases)[..., -self.phases :]
            found = found.reshape(split)
            found[..., -self.phases :] = turned
            found = found.reshape(linear.shape)
        return np.asarray(found)


@dataclass(frozen=True, kw_only=True)
class Lens:
    """Everything needed to see a simulated machine as the sensors of one point would."""

    chain: Chain
    scale: Scale
    lines_hz: FloatArray
    resolution_hz: float
    nominal: FloatArray
    """Features (C, F) of the nominal healthy machine."""

    def features(self, bank: Bank) -> FloatArray:
        """(N, C, F)."""
        return through(self.chain, bank, self.lines_hz, self.resolution_hz).features(self.scale)


def healthy_of(bank: Bank, plan: AtlasPlan) -> Healthy:
    """Logarithmic means over the healthy draws."""
    rows = [k for k, d in enumerate(plan.draws) if d.candidate is None and not d.twin and bank.alive[k]]
    line = np.log(bank.line[rows] + 1e-300)
    with np.errstate(invalid="ignore"):
        floor = np.log(bank.floor[rows] + 1e-300)
        return Healthy(
            line=np.exp(line.mean(axis=0)),
            line_spread_db=np.asarray(10.0 / np.log(10.0) * line.std(axis=0)),
            floor=np.exp(floor.mean(axis=0)),
        )


def lenses(data: Sequence[PointData], banks: Sequence[Bank], plan: AtlasPlan) -> tuple[Lens, ...]:
    """Calibrate the sensors' paths on the baselines, or on the tests where there are none."""
    healthy = [healthy_of(b, plan) for b in banks]
    recorded = [d.baseline or d.test for d in data]
    chains = calibrate_chain(recorded, healthy, [d.lines_hz for d in data])
    found = []
    rows = [k for k, d in enumerate(plan.draws) if d.candidate is None and not d.twin]
    for one, chain, bank, seen in zip(data, chains, banks, recorded, strict=True):
        scale = scale_of(chain, one.lines_hz, seen.resolution_hz, half_turns(one, plan))
        passed = through(chain, bank.at(rows, range(bank.band.shape[1])), one.lines_hz, seen.resolution_hz)
        found.append(
            Lens(
                chain=chain,
                scale=scale,
                lines_hz=one.lines_hz,
                resolution_hz=seen.resolution_hz,
                nominal=np.asarray(np.median(passed.features(scale), axis=0)),
            )
        )
    return tuple(found)


def half_turns(one: PointData, plan: AtlasPlan) -> FloatArray:
    """Turns of each watched shaft in half of the test, (S,)."""
    bases = bases_at(plan.machine, one.point.speed_hz)
    return np.array([0.5 * one.test.duration_s * t.hz for t in watch_list(plan.machine).turning(bases)])


def _of(seen: Statistics, lens: Lens) -> FloatArray:
    return soft_features(
        seen.line,
        seen.floor,
        seen.total,
        seen.depth,
        seen.turn,
        seen.kurtosis,
        seen.skewness,
        seen.phase,
        lens.scale,
    )


def observed_only(data: Sequence[PointData], seen_through: Sequence[Lens], plan: AtlasPlan) -> FloatArray:
    """`Changes.observed` alone, (F,)."""
    return np.concatenate([_changed(one, lens, plan) for one, lens in zip(data, seen_through, strict=True)])


def _changed(one: PointData, lens: Lens, plan: AtlasPlan) -> FloatArray:
    reference = _of(one.baseline, lens) if one.baseline is not None else lens.nominal
    return changed(_of(one.test, lens), reference, len(watch_list(plan.machine).phased)).ravel()


def observed_changes(
    data: Sequence[PointData], seen_through: Sequence[Lens], banks: Sequence[Bank], plan: AtlasPlan
) -> Changes:
    """What the recordings changed, and what healthy machines change by themselves."""
    observed, halves, measured, null, starts = [], [], [], [], [0]
    wander: list[FloatArray] = []
    watched = watch_list(plan.machine)
    groups: list[np.ndarray] = []
    based = all(d.baseline is not None for d in data)
    delays = clock_delays(data, [lens.scale.line_noise for lens in seen_through], watched)
    phased = compared(data, delays)
    for one, lens, bank in zip(data, seen_through, banks, strict=True):
        reference = _of(one.baseline, lens) if one.baseline is not None else lens.nominal
        phases = len(watched.phased)
        observed.append(_changed(one, lens, plan))
        halves.append(np.stack([changed(_of(h, lens), reference, phases).ravel() for h in one.halves]))
        fallen = gained_between(one, watched)
        spread = measured_db(one.test, lens.chain, lens.lines_hz, lens.scale, watched.phased, fallen) ** 2
        if one.baseline is not None:
            spread = spread + measured_db(one.baseline, lens.chain, lens.lines_hz, lens.scale, watched.phased) ** 2
        if not phased:
            spread[:, spread.shape[1] - phases :] = np.nan
        steady = unsteady_db(one.test, watched, one.lines_hz)
        measured.append(np.sqrt(spread + steady**2).ravel())
        wander.append(np.tile(wander_patterns(watched, one.lines_hz, steady.size), spread.shape[0]))
        groups.append(_groups(one.test) + (groups[-1].max() + 1 if groups else 0))
        null.append(_null(lens, bank, plan, phases, based=based))
        starts.append(starts[-1] + observed[-1].size)
    layout, size = layout_of(data[0].test), {"points": len(data), "channels": data[0].test.line.shape[0]}
    return Changes(
        observed=np.concatenate(observed),
        halves=np.concatenate(halves, axis=1),
        measured=np.concatenate(measured),
        null=np.concatenate(null, axis=1),
        starts=tuple(starts),
        with_baseline=based,
        groups=np.concatenate(groups),
        pooling=pooling(watched, layout, phased=phased, **size),
        single=own_lines(watched, layout, **size),
        sides=lines_beside(watched, layout, **size),
        twice=lines_twice(watched, layout, **size),
        phased=tuple(view(watched, layout, phased=True, **size) for view in (own_lines, lines_beside) if phased),
        wander=block_diag(*wander),
        kind=np.zeros((0, starts[-1])),
        phases=layout.phases,
        delays=delays,
    )


def layout_of(seen: Statistics) -> Layout:
    """How one channel's features lie one after the other."""
    return Layout(
        lines=seen.line.shape[1],
        bands=seen.floor.shape[1],
        shapes=seen.band.shape[1],
        modulations=seen.depth.shape[2],
        shafts=seen.turn.shape[2],
        phases=seen.phase.shape[1],
    )


def _groups(seen: Statistics) -> np.ndarray:
    """(C * F,): channel and part of each feature of a point, counted from 0."""
    channels = seen.line.shape[0]
    sizes = [seen.line.shape[1], seen.floor.shape[1], seen.total.shape[1]]
    sizes += [seen.depth.shape[1] * seen.depth.shape[2], seen.turn.shape[1] * seen.turn.shape[2]]
    sizes += [seen.kurtosis.shape[1], seen.skewness.shape[1], seen.phase.shape[1]]
    one = np.repeat(np.arange(len(sizes)), sizes)
    return np.concatenate([one + len(sizes) * c for c in range(channels)])


def _null(lens: Lens, bank: Bank, plan: AtlasPlan, phases: int, *, based: bool) -> FloatArray:
    first = {d.pair: k for k, d in enumerate(plan.draws) if d.candidate is None and not d.twin}
    twin = {d.pair: k for k, d in enumerate(plan.draws) if d.candidate is None and d.twin}
    pairs = sorted(first)
    every = range(bank.band.shape[1])
    before = lens.features(bank.at([first[p] for p in pairs], every))
    if not based:
        return changed(before, lens.nominal, phases).reshape(len(pairs), -1)
    after = lens.features(bank.at([twin[p] for p in pairs], every))
    return changed(after, before, phases).reshape(len(pairs), -1)


def signatures(
    seen_through: Sequence[Lens],
    banks: Sequence[Bank],
    plan: AtlasPlan,
    rows: Sequence[int],
    healthy_banks: Sequence[Bank],
    healthy_plan: AtlasPlan,
    *,
    with_baseline: bool,
) -> FloatArray:
    """Changes (m, F) that the draws `rows` of a plan would show against their own healthy machines."""
    first = {d.pair: k for k, d in enumerate(healthy_plan.draws) if d.candidate is None and not d.twin}
    pairs = [first[plan.draws[k].pair] for k in rows]
    found = []
    for lens, bank, healthy in zip(seen_through, banks, healthy_banks, strict=True):
        every = range(bank.band.shape[1])
        effect = lens.features(bank.at(rows, every))
        rest = lens.features(healthy.at(pairs, every)) if with_baseline else lens.nominal
        found.append(changed(effect, rest, bank.phase.shape[2]).reshape(len(rows), -1))
    return np.concatenate(found, axis=1)
