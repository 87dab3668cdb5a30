"""Judged again as if the tests' channels were exchanged, or in another unit: where a strong defect hides both.

What a fault leaves alone tells a unit or a swap before anything is simulated (`gate/robust.py`, `gate/lines.py`). A pit
that raises all bands of a small rig leaves nothing alone; but with its channels put right it fits.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from types import MappingProxyType

import numpy as np

from reconcile.gate.units import GRAVITY, possible
from reconcile.judge.changes import observed_only
from reconcile.judge.screen import quantile_of_misfit
from reconcile.judge.space import Fitted
from reconcile.machine.beaten import beaten
from reconcile.machine.proved import UNLIKE
from reconcile.machine.setting import Setting
from reconcile.machine.weigh import LEAST_EVIDENCE
from reconcile.observe.statistics import Statistics
from reconcile.report.words import readable
from reconcile.verdict import NextExperiment, Report, SensorFault, Where
from sim.core.response import Channel

MOST_CHANNELS = 6
"""Of which any two may be exchanged."""
SURE, BETTER, LIKELIER = 20.0, 3.0, 1.0
"""Log likelihood by which the tests must fit better put right than as they are where nothing known explains them, and
exchanged where a name is doubted anyway, or leads the same effect elsewhere by less than a name's lead. A rig's pit
with its sensors exchanged: 3.3 and 4.2 (right ones exchanged: -4.3); in g for m/s^2: 57. With nothing
wrong in the tests exchanged ones are worse by 0.1 and more (six of a rotor, eleven gearboxes of the proof), and another
unit is better by up to 5.9 where a pit is stronger than any that was simulated. The last one where nothing is named, as
the machine with what strikes is far off: a sound rig with its two sensors exchanged 1.4."""
FITS = 0.9
"""Quantile of the misfit that they must then be below, as most simulated effects are."""
RAISED = ("line", "floor", "total", "band", "turn")
SHAPED = ("depth", "kurtosis", "skewness", "phase")


@dataclass(frozen=True, kw_only=True)
class Correction:
    """Which channel of the tests each one is, and what all of their numbers are multiplied by."""

    order: tuple[int, ...]
    factor: float = 1.0
    unit: str = ""

    def put_right(self, seen: Statistics) -> Statistics:
        """What the corrected test shows."""
        order = list(self.order)
        raised = {name: getattr(seen, name)[order] * self.factor**2 for name in RAISED}
        return replace(seen, **raised, **{name: getattr(seen, name)[order] for name in SHAPED})


@dataclass(frozen=True, kw_only=True)
class Fit:
    """How well the best known effect `name` fits: log `likelihood` up to a constant, how far that is over nothing at
    all (`evidence`), and the quantile of its misfit."""

    name: str
    likelihood: float
    misfit: float
    evidence: float = np.inf

    @property
    def text(self) -> str:
        """What explains the tests then."""
        return "a sound machine" if self.evidence < LEAST_EVIDENCE else readable(self.name)


def with_mistaken(
    report: Report,
    setting: Setting,
    view: Fitted,
    channels: Sequence[Channel],
    heard: Mapping[str, float] = MappingProxyType({}),
) -> Report:
    """The report; a fault of the measurement where nothing known explains the tests as they are and something does
    once they are put right, and no name where a doubted one, or one at either of two places, fits better so. `view`:
    all candidates by families; `heard`: `Screen.heard`."""
    doubted = beaten(report) or beside_twin(report, heard) or _forecasts_nothing(report)
    unlike = report.verdict == "not_decidable" and UNLIKE in report.undecidable
    based = all(one.baseline is not None for one in setting.data)
    if not based or not (doubted or unlike or report.verdict == "unknown_physics"):
        return report
    usual = _fit(view, setting, Correction(order=tuple(range(len(channels)))))
    fits = [(one, _fit(view, setting, one)) for one in corrections(channels)]
    open_to = doubted or unlike
    good = [(one, fit) for one, fit in fits if fit.misfit < FITS and not (open_to and one.unit)]
    if not good:
        return report
    one, best = max(good, key=lambda pair: pair[1].likelihood)
    better = best.likelihood - usual.likelihood
    if better < (LIKELIER if unlike else BETTER if doubted else SURE):
        return report
    return _doubted(report, one, best, channels) if doubted else _mistaken(report, one, best, channels)


def _forecasts_nothing(report: Report) -> bool:
    """Whether the interval of a name's gain on held-out data reaches down to none."""
    low = report.held_out.gain_low if report.held_out is not None else None
    return report.verdict == "explained" and low is not None and low <= 0.0


def beside_twin(report: Report, heard: Mapping[str, float] = MappingProxyType({})) -> bool:
    """Whether one effect is named and the same elsewhere is less than a name's lead behind, but for what is `heard`:
    then which sensor hears it louder decides the place."""
    named = [c for c in report.causes if c.named]
    if len(named) != 1:
        return False
    twins = [c for c in report.causes if c.term == named[0].term and c.site != named[0].site]
    own, *scores = [c.score + heard.get(f"{c.term}@{c.site}", 0.0) for c in (named[0], *twins)]
    return bool(scores) and own - max(scores) < LEAST_EVIDENCE


def corrections(channels: Sequence[Channel]) -> Iterator[Correction]:
    """Any two channels of one quantity and unit exchanged; all channels of the same in another unit, either way."""
    usual = tuple(range(len(channels)))
    if len(channels) <= MOST_CHANNELS:
        for a, b in combinations(usual, 2):
            if (channels[a].quantity, channels[a].unit) == (channels[b].quantity, channels[b].unit):
                yield Correction(order=tuple(b if k == a else a if k == b else k for k in usual))
    if len({(c.quantity, c.unit) for c in channels}) == 1:
        for unit, ratio in possible(channels[0].quantity).items():
            for factor in (ratio, 1.0 / ratio):
                yield Correction(order=usual, factor=factor, unit=unit)


def _fit(view: Fitted, setting: Setting, one: Correction) -> Fit:
    data = [replace(d, test=one.put_right(d.test)) for d in setting.data]
    observed = observed_only(data, setting.seen_through, setting.plan)
    place = view.place(observed)
    squared = view.paths.distances(place)
    nearest = int(np.argmin(squared))
    rest = float(np.sum(place**2))
    return Fit(
        name=view.paths.names[view.paths.owner[nearest]],
        likelihood=-float(squared[nearest]) / (2.0 * view.overdispersion),
        misfit=quantile_of_misfit(view, float(squared[nearest]), rest),
        evidence=(rest - float(squared[nearest])) / (2.0 * view.overdispersion),
    )


def _said(one: Correction, channels: Sequence[Channel]) -> tuple[SensorFault, str]:
    """The fault, and what was wrong with the tests."""
    moved = [c.name for k, c in enumerate(channels) if one.order[k] != k]
    if moved:
        which = " and ".join(moved)
        return SensorFault(kind="swapped_channels", channel=which, doubtful=True), f"{which} exchanged in the tests"
    larger = one.factor > 1.0
    if one.unit == GRAVITY:
        what = "g described as m/s^2" if larger else "m/s^2 described as g"
        return SensorFault(kind="unit_mismatch", channel="", doubtful=True), f"the tests' numbers in {what}"
    size = one.factor if larger else 1.0 / one.factor
    what = f"the tests' numbers {size:.4g} times too {'small' if larger else 'large'} ({one.unit})"
    return SensorFault(kind="unit_mismatch", channel="", doubtful=True), what


def _mistaken(report: Report, one: Correction, fit: Fit, channels: Sequence[Channel]) -> Report:
    fault, wrong = _said(one, channels)
    text = f"no known effect explains the tests as they are described, but with {wrong}: {fit.text} then does"
    return replace(
        report,
        verdict="measurement_fault",
        sentence=f"The mismatch may be in the measurement: {text}.",
        fault=replace(fault, detail=text),
        where=Where(limits=report.where.limits),
        causes=(),
        held_out=None,
        force=None,
        machine=None,
        undecidable=("what the machine has, until the description is put right",),
        next_experiment=None,
    )


def _doubted(report: Report, one: Correction, fit: Fit, channels: Sequence[Channel]) -> Report:
    fault, wrong = _said(one, channels)
    text = f"with {wrong}, {fit.text} fits better than what is named as they are described"
    named = " and ".join(readable(f"{c.term}@{c.site}") for c in report.causes if c.named)
    return replace(
        report,
        verdict="ambiguous",
        sentence=f"Either {named}, or {wrong}: then {fit.text} fits better. As described: {report.sentence}",
        fault=replace(fault, detail=text),
        measurement_faults=(replace(fault, detail=text),),
        causes=tuple(replace(c, named=False) for c in report.causes),
        machine=None,
        undecidable=(text, *report.undecidable),
        next_experiment=NextExperiment(sentence="Look which sensor is which channel, and what its unit is."),
    )
