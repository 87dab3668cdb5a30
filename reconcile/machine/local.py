"""Stages 1 and 5 where a baseline exists: the candidates on machines that agree with it.

The atlas knows only machines of the kind; which resonance a mesh harmonic meets differs among them, and so do the
changes an effect brings. Machines that agree with the baseline show what the effect would change on this one.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.atlas.bank import ARRAYS, Bank, Mapper, make_bank
from reconcile.atlas.plan import AtlasPlan, Draw, side_by_side, simulated_at
from reconcile.calibrate.posterior import Posterior, calibrated, line_evidence
from reconcile.calibrate.uncertain import DRIFT, Offsets, draw_offsets, moved
from reconcile.judge.changes import lenses, observed_changes
from reconcile.machine.library import share_of
from reconcile.machine.misfit import FOREIGN, FOREIGN_BARE
from reconcile.machine.setting import Setting
from reconcile.observe.watch import watch_list
from signals.series import FloatArray
from sim.core.spec import TermSpec

MACHINES = 24
"""Machines that are fitted to the baseline."""
FIRST_SIZES = (4, 6, 2, 5, 7, 3, 1, 0)
"""Ranks by size in the order in which the draws of a candidate are simulated."""
LANES = 8
"""Machines that cost no more than one: vector lanes hold one effect."""
LEAST_DRAWS = 2
COSTLY = ("fit_clearance", "fit_clearance_series")
"""Effects whose machines run one by one, as each strikes at other moments: eight times as dear."""
TOLD, WORST = 12, 3
UNKNOWN_DB, MOST_DB, FEWEST_PAIRS = 5.0, 20.0, 6
"""Of a line's change from one recording of a sound machine to the next: taken where it is not known, and at most."""
DECIDED = 0.3
"""Share of its variance that the baseline must take from a number to count as decided; more where that is what numbers
without a part in the machines lose by chance."""


@dataclass(frozen=True, kw_only=True)
class Local:
    """A setting whose healthy machines agree with the baseline, and how well they do."""

    setting: Setting
    posterior: Posterior


def simulated_banks(setting: Setting, plan: AtlasPlan, mapper: Mapper) -> tuple[Bank, ...]:
    """All draws of a plan at the operating points and channels of the setting."""
    distinct = tuple(sorted(set(setting.simulated)))
    places = [distinct.index(s) for s in setting.simulated]
    rows = range(len(plan.draws))
    points = [simulated_at(setting.machine, one.point) for one in setting.data]
    return tuple(make_bank(plan, point, distinct, mapper).at(rows, places) for point in points)


def around_baseline(setting: Setting, mapper: Mapper) -> Local | None:
    """None without a baseline, or where it does not say enough."""
    recorded = [d.baseline for d in setting.data if d.baseline is not None]
    if len(recorded) < len(setting.data):
        return None
    plan = setting.plan
    scales, lines_hz = [x.scale for x in setting.seen_through], [d.lines_hz for d in setting.data]
    watched = watch_list(setting.machine)
    evidence = line_evidence(recorded, scales, lines_hz, watched.own)
    if not watched.gears:
        repeat = [repeat_db(bank, plan) for bank in setting.banks]
        at = zip(evidence.point, evidence.channel, evidence.line, strict=True)
        evidence = replace(evidence, repeat_db=np.array([repeat[p][c, i] for p, c, i in at]))
    alive = np.all([b.alive for b in setting.banks], axis=0)
    first = [k for k, d in enumerate(plan.draws) if d.candidate is None and not d.twin and alive[k]][:MACHINES]

    def simulate(offsets: Sequence[Offsets]) -> tuple[Bank, ...]:
        healthy = tuple(Draw(pair=k) for k in range(len(offsets)))
        fitted = replace(plan, offsets=tuple(offsets), twins=tuple(offsets), draws=healthy)
        return simulated_banks(setting, fitted, mapper)

    start = [plan.offsets[plan.draws[k].pair] for k in first]
    banks = [b.at(first, range(b.band.shape[1])) for b in setting.banks]
    posterior = calibrated(start, banks, evidence, simulate, seed=setting.seed)
    return None if posterior is None else _with_twins(setting, posterior, mapper)


def repeat_db(bank: Bank, plan: AtlasPlan) -> FloatArray:
    """Root mean square over healthy machines of what drift and slip change at each line, (C, L), dB; `UNKNOWN_DB` where
    too few machines say it."""
    first, twin = (
        {d.pair: k for k, d in enumerate(plan.draws) if d.candidate is None and d.twin == late and bank.alive[k]}
        for late in (False, True)
    )
    pairs = sorted(first.keys() & twin.keys())
    if len(pairs) < FEWEST_PAIRS:
        return np.full(bank.line.shape[1:], UNKNOWN_DB)
    with np.errstate(divide="ignore", invalid="ignore"):
        change = 10.0 * np.log10(bank.line[[twin[p] for p in pairs]] / bank.line[[first[p] for p in pairs]])
    change = np.clip(np.nan_to_num(change, nan=UNKNOWN_DB, posinf=MOST_DB, neginf=-MOST_DB), -MOST_DB, MOST_DB)
    return np.asarray(np.sqrt(np.mean(change**2, axis=0)))


def _with_twins(setting: Setting, posterior: Posterior, mapper: Mapper) -> Local:
    """The fitted machines and what drift does to each."""
    rng = np.random.default_rng([setting.seed, 12])
    plan = setting.plan
    twins = tuple(o.mixed(draw_offsets(plan.numbers, rng), DRIFT) for o in posterior.offsets)
    pairs = range(len(posterior.offsets))
    drifted = replace(plan, offsets=posterior.offsets, twins=twins, draws=tuple(Draw(pair=k, twin=True) for k in pairs))
    second = simulated_banks(setting, drifted, mapper)
    both = replace(drifted, draws=(*(Draw(pair=k) for k in pairs), *drifted.draws))
    banks = tuple(stacked(a, b) for a, b in zip(posterior.banks, second, strict=True))
    seen = lenses(setting.data, banks, both)
    changes = observed_changes(setting.data, seen, banks, both)
    return Local(
        setting=replace(
            setting,
            plan=both,
            banks=banks,
            seen_through=seen,
            changes=replace(changes, kind=setting.changes.null),
            fitted_machine=moved(plan.machine, plan.numbers, _middle(posterior)),
        ),
        posterior=posterior,
    )


def stacked(first: Bank, second: Bank) -> Bank:
    """Draws of both, one after the other."""

    def both(name: str) -> FloatArray:
        return np.concatenate([getattr(first, name), getattr(second, name)])

    return Bank(
        alive=both("alive"),
        resolution_hz=first.resolution_hz,
        duration_s=first.duration_s,
        **{name: both(name) for name in ARRAYS},
    )


def ordered_draws(atlas: AtlasPlan, shown: Sequence[TermSpec], nearest: Collection[int] = ()) -> dict[str, list[Draw]]:
    """The atlas' draws of each candidate in the order in which they are worth simulating: one whose term is among the
    `nearest` (their `id`), then those that were `shown` to change something, middle and large sizes first."""
    telling = {id(term) for term in shown}
    known: dict[str, list[Draw]] = {}
    for draw in atlas.draws:
        if draw.candidate is not None and draw.term is not None:
            known.setdefault(draw.candidate.label, []).append(draw)
    found = {}
    for name, draws in known.items():
        by_size = sorted(draws, key=share_of)
        order = [k for k in FIRST_SIZES if k < len(by_size)] + list(range(len(FIRST_SIZES), len(by_size)))
        usual = sorted((by_size[k] for k in order), key=lambda d: id(d.term) not in telling)
        found[name] = sorted(usual, key=lambda d: id(d.term) not in nearest)
    return found


def first_heat(plan: AtlasPlan, ranked: Sequence[str], atlas: Mapping[str, Sequence[Draw]], terms: int) -> AtlasPlan:
    """The best `terms` effects at all their `ranked` sites on the fitted machines, so many draws that vector lanes
    fill; of what fills none as few as say anything."""
    sites: dict[str, list[str]] = {}
    for name in ranked:
        sites.setdefault(name.split("@")[0], []).append(name)
    draws: dict[str, int] = {}
    for term, names in list(sites.items())[:terms]:
        count = LEAST_DRAWS if term in COSTLY else max(LEAST_DRAWS, LANES // len(names))
        draws |= dict.fromkeys(names, count)
    return side_by_side(_planned(plan, {name: (0, count) for name, count in draws.items()}, atlas))


def second_heat(
    plan: AtlasPlan, best: Sequence[str], atlas: Mapping[str, Sequence[Draw]], before: AtlasPlan
) -> AtlasPlan:
    """All draws of the `best` candidates that were not simulated `before`."""
    done = [d.candidate.label for d in before.draws if d.candidate is not None]
    return _planned(plan, {name: (done.count(name), LANES) for name in best}, atlas)


def more_draws(plan: AtlasPlan, done: Mapping[str, int], atlas: Mapping[str, Sequence[Draw]]) -> AtlasPlan:
    """The rest of the draws of candidates of which so many are `done`."""
    return _planned(plan, {name: (count, LANES) for name, count in done.items()}, atlas)


def _planned(plan: AtlasPlan, wanted: Mapping[str, tuple[int, int]], atlas: Mapping[str, Sequence[Draw]]) -> AtlasPlan:
    """Draws of each candidate from one place in their order to another."""
    planned: list[Draw] = []
    for number, (name, (first, last)) in enumerate(wanted.items()):
        taken = atlas.get(name, ())[first:last]
        planned += [replace(d, pair=(number + 5 * (first + j)) % len(plan.offsets)) for j, d in enumerate(taken)]
    return replace(plan, draws=tuple(planned))


def told(local: Local) -> dict[str, object]:
    """What the calibration found, for the report: how well, which numbers the baseline decides, which it cannot."""
    posterior = local.posterior
    labels = [n.label for n in local.setting.plan.numbers]
    order = np.argsort(-posterior.determined)
    middle = _middle(posterior).values
    least = max(DECIDED, posterior.by_chance)
    return {
        "machines": len(posterior.offsets),
        "misfit_before": posterior.misfit[0],
        "misfit_after": posterior.misfit[1],
        "misfit_allowed": FOREIGN if local.setting.machine.gears else FOREIGN_BARE,
        "decided": [
            {"number": labels[k], "share": float(posterior.determined[k]), "offset": float(middle[k])}
            for k in order[:TOLD]
            if posterior.determined[k] > least
        ],
        "undecided": int(np.sum(posterior.determined <= least)),
        "by_chance": posterior.by_chance,
        "strayed": [labels[k] for k in np.flatnonzero(posterior.strayed)],
        "farthest": _farthest(local),
    }


def _farthest(local: Local) -> list[dict[str, object]]:
    """The baseline's lines that the fitted machines are farthest from, dB above them, gains apart."""
    setting, seen = local.setting, local.posterior.evidence
    lines = watch_list(setting.machine).lines
    off = local.posterior.left_db
    return [
        {
            "line": lines[seen.line[k]].label,
            "speed_hz": setting.data[seen.point[k]].point.speed_hz,
            "channel": setting.channels[seen.channel[k]],
            "off_db": float(off[k]),
        }
        for k in np.argsort(-np.abs(off))[:WORST]
    ]


def _middle(posterior: Posterior) -> Offsets:
    return Offsets(values=np.mean([o.values for o in posterior.offsets], axis=0))
