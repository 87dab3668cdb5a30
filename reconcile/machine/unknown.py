"""Stage 6: where no known effect is adequate, does a force law at a support bring the change? By forward simulation.

A law stands only if it leaves single lines no more than what is usual, on all operating points together, and is ahead
of every known effect; else the answer is the likeliest place and "no stable law".
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.atlas.bank import Mapper
from reconcile.judge.adequacy import rest_of
from reconcile.judge.changes import signatures
from reconcile.judge.screen import looked
from reconcile.judge.space import Fitted, Library, fit_space
from reconcile.machine.laws import LAWS, SHARES, Motion, TrialLaw, label, motions, trial_plan, with_law
from reconcile.machine.left_lines import leaves_lines
from reconcile.machine.library import Catalogued, joined
from reconcile.machine.local import simulated_banks
from reconcile.machine.search import LEAST_OF_LINES
from reconcile.machine.setting import Found, Setting
from reconcile.machine.weigh import LEAST_EVIDENCE
from reconcile.verdict import EstimatedForce
from signals.series import FloatArray
from sim.core.errors import SidebandError
from sim.core.spec import MachineSpec

POINTS = 41
REACH = 3.0
"""Deviations of the healthy motion over which a law is shown."""
LEAST_DRAWS = 3
LIKELY = 3.0
"""Log evidence behind the likeliest support up to which laws are tried at another."""


AHEAD = 1.01
"""By which the place of a force leads one whose known effects weigh as much."""


@dataclass(frozen=True, kw_only=True)
class Unknown:
    """The force of a report; where a law stands also its library, its label in it, and the machine that has it."""

    force: EstimatedForce
    known: Catalogued | None = None
    label: str | None = None
    machine: MachineSpec | None = None
    change: FloatArray | None = None
    """(F,) dB: what the law brings, by its draw nearest to the observation."""
    tried: bool = True
    """Whether laws were tried."""


def unknown_force(setting: Setting, found: Found, supports: int, mapper: Mapper) -> Unknown | None:
    """Try all laws at the likeliest `supports`; None where single lines cannot be compared."""
    machine = setting.fitted_machine
    if machine is None or found.fine is None or not setting.machine.bearings:
        return None
    sites = likely_supports(setting, found)
    nowhere = Unknown(force=EstimatedForce(site=sites[0], samples={}, law=None))
    if supports == 0:
        return replace(nowhere, tried=False)
    try:
        moving = motions(machine, sites[:supports], setting.seed)
    except SidebandError:
        return nowhere
    tried = _tried(setting, found.unled, moving, mapper)
    if tried is None:
        return nowhere
    changes = setting.changes
    fine = fit_space(changes, tried.library, seed=setting.seed, view=changes.single, least=LEAST_OF_LINES)
    look = looked(fine, changes.observed)
    evidence = dict(zip(fine.paths.names, look.evidence, strict=True))
    own = {label(law, s): (law, s) for law in LAWS for s in moving if label(law, s) in evidence}
    best = max(own, key=lambda name: evidence[name])
    rest = max((e for name, e in evidence.items() if name not in own), default=0.0)
    law, site = own[best]
    stands = evidence[best] > max(rest, 0.0) + LEAST_EVIDENCE and not leaves_lines(
        rest_of(fine, changes.observed, best)
    )
    if not stands:
        return replace(nowhere, force=replace(nowhere.force, site=site if evidence[best] > rest else sites[0]))
    return _standing(setting, fine, tried, law, site, moving[site], machine)


def likely_supports(setting: Setting, found: Found) -> tuple[str, ...]:
    """Bearings by the evidence of what acts there, the likeliest first; those far behind it are left out, a trial of
    all laws costs as much as all else."""
    by_site = {b.name: -np.inf for b in setting.machine.bearings}
    for name, value in zip(found.screen.names, found.screen.evidence, strict=True):
        site = name.split("@")[1]
        if site in by_site:
            by_site[site] = max(by_site[site], float(value))
    likeliest = max(by_site.values())
    order = sorted(by_site, key=lambda s: -by_site[s])
    return tuple(s for s in order if by_site[s] >= likeliest - LIKELY or s == order[0])


def at_supports(weights: Mapping[str, float], site: str, supports: Sequence[str]) -> dict[str, float]:
    """Weights of effects (`effect@site`) where none of them is what it is: they tell a place as far as they are at
    supports, where the force is looked for, and its `site` leads."""
    kept = {name: w for name, w in weights.items() if name.split("@")[1] in supports}
    places: dict[str, float] = {}
    for name, w in kept.items():
        place = name.split("@")[1]
        places[place] = places.get(place, 0.0) + w
    lacking = AHEAD * max(places.values(), default=1.0) - places.get(site, 0.0)
    lacking = max(lacking, 0.0)
    found = {**kept, f"force@{site}": lacking}
    total = sum(found.values())
    return {name: w / total for name, w in found.items()} if total > 0.0 else {f"force@{site}": 1.0}


def _tried(setting: Setting, known: Catalogued, moving: Mapping[str, Motion], mapper: Mapper) -> Catalogued | None:
    """The library with all laws at all moving supports beside it."""
    found = known
    for site in moving:
        for law in LAWS:
            rows = _rows(setting, moving, law, site, mapper)
            found = found if rows is None else joined(found, rows)
    return None if found is known else found


def _rows(
    setting: Setting, moving: Mapping[str, Motion], law: TrialLaw, site: str, mapper: Mapper
) -> Catalogued | None:
    plan = trial_plan(setting.plan, moving, law, site)
    banks = simulated_banks(setting, plan, mapper)
    alive = np.all([b.alive for b in banks], axis=0)
    rows = [k for k in range(len(plan.draws)) if alive[k]]
    if len(rows) < LEAST_DRAWS:
        return None
    changes = signatures(
        setting.seen_through,
        banks,
        plan,
        rows,
        setting.banks,
        setting.plan,
        with_baseline=setting.changes.with_baseline,
    )
    sizes = np.repeat((np.arange(len(SHARES)) + 0.5) / len(SHARES), len(plan.draws) // len(SHARES))[rows]
    terms = tuple(plan.draws[k].term for k in rows)
    return Catalogued(
        library=Library(changes=changes, groups={label(law, site): tuple(range(len(rows)))}, shares=sizes),
        terms=tuple(t for t in terms if t is not None),
    )


def _standing(
    setting: Setting,
    fine: Fitted,
    tried: Catalogued,
    law: TrialLaw,
    site: str,
    motion: Motion,
    machine: MachineSpec,
) -> Unknown:
    """The law with its size, over the motion of the support."""
    name = label(law, site)
    coefficient, spread = _size(fine, tried, name, setting.changes.observed, motion, law)
    laws, terms = with_law(machine, law, site, motion, coefficient)
    update = {"custom_laws": [*machine.custom_laws, *laws], "terms": [*machine.terms, *terms]}
    argument = np.linspace(-REACH, REACH, POINTS) * float(np.std(motion.v if law.rate else motion.x))
    force = coefficient * law.values(argument, argument, motion.gap_m)
    low, high = sorted((np.exp(-spread), np.exp(spread)))
    samples = {"velocity_m_per_s" if law.rate else "displacement_m": argument, "force_n": force}
    ends = np.sort(np.stack([low * force, high * force]), axis=0)
    samples |= {"low_n": ends[0], "high_n": ends[1]}
    text = law.text.format(g=f"{motion.gap_m:.3g} m")
    return Unknown(
        force=EstimatedForce(
            site=site,
            samples={key: tuple(float(x) for x in values) for key, values in samples.items()},
            law=f"{coefficient:.3g} {law.unit} * {text} on both axes",
            coefficients={law.key: coefficient},
        ),
        known=tried,
        label=name,
        machine=machine.model_copy(update=update),
        change=_nearest_change(fine, tried, name, setting.changes.observed),
    )


def _nearest_change(fine: Fitted, tried: Catalogued, name: str, observed: FloatArray) -> FloatArray:
    rows = np.array(tried.library.groups[name])
    squared = np.sum((fine.points[rows] - fine.place(observed)) ** 2, axis=1)
    return np.asarray(tried.library.changes[rows[int(np.argmin(squared))]])


def _size(
    fine: Fitted, tried: Catalogued, name: str, observed: FloatArray, motion: Motion, law: TrialLaw
) -> tuple[float, float]:
    """Coefficient, and the half width of its 90 % interval in logarithm, from the sizes near the observation."""
    rows = np.array(tried.library.groups[name])
    squared = np.sum((fine.points[rows] - fine.place(observed)) ** 2, axis=1)
    weights = np.exp(-0.5 * (squared - squared.min()) / fine.overdispersion)
    weights /= weights.sum()
    place = np.clip((tried.library.shares[rows] * len(SHARES)).astype(int), 0, len(SHARES) - 1)
    logs = np.log([motion.coefficient(law, SHARES[k]) for k in place])
    mean = float(weights @ logs)
    step = float(np.log(SHARES[1] / SHARES[0]))
    return float(np.exp(mean)), 1.645 * float(np.sqrt(weights @ (logs - mean) ** 2 + (0.5 * step) ** 2 / 3))
