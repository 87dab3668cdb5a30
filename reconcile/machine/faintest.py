"""What these recordings would have shown: the sizes of each effect from which a first look sees it.

"Nothing missing" is worth as much as what would have been noticed. Every draw of the atlas, heard through the sensors
at hand with their noise, is judged as an observation of its own would be, its effect's path without itself. Counted
are patterns and glaring changes on machines of the kind, and single lines as machines that agree with the baseline know
them; impacts and what is simulated on those machines may see smaller ones.
"""

from __future__ import annotations

import numpy as np

from reconcile.atlas.candidates import size_parameter
from reconcile.judge.nulls import group_lengths
from reconcile.judge.screen import largest, largest_of_nulls
from reconcile.judge.space import Fitted
from reconcile.machine.decide import ALSO_P, CLEAR_P, DETECT_P, GLARING, LOOKS
from reconcile.machine.setting import Found, Setting
from reconcile.machine.weigh import LEAST_EVIDENCE
from reconcile.tail import tail_chance
from reconcile.verdict import Faintest
from signals.series import FloatArray
from sim.terms import REGISTRY


def faintest_seen(setting: Setting, screened: Found, lines: Found | None = None) -> tuple[Faintest, ...]:
    """Of every effect at every place that was simulated; `screened`: the look at the whole atlas, `lines`: the same
    draws on machines that agree with the baseline, where there are any."""
    told = seen(setting, screened, lines)
    rows = []
    for name, members in screened.known.library.groups.items():
        key, site = name.split("@")
        term = REGISTRY.get(key)
        if term is None:
            continue
        size = size_parameter(term)
        sizes = np.array([float(screened.known.terms[k].parameters[size.name]) for k in members])
        here = told[list(members)]
        rows.append(
            Faintest(
                term=key, site=site, name=size.name, unit=size.unit, seen=int(here.sum()), simulated=here.size,
                seen_from=seen_from(sizes, here), largest=float(sizes.max()), strikes=term.strikes is not None,
            )
        )  # fmt: skip
    return tuple(rows)


def seen_from(sizes: FloatArray, told: np.ndarray) -> float | None:
    """The size from which all were seen; None where the largest was not."""
    order = np.argsort(sizes)
    missed = np.flatnonzero(~told[order])
    first = int(missed[-1]) + 1 if missed.size else 0
    return float(sizes[order[first]]) if first < sizes.size else None


def seen(setting: Setting, screened: Found, lines: Found | None) -> np.ndarray:
    """(m,): whether each draw of the library would have been told, by the rules of the verdict."""
    length, p_any = _whole(setting, screened)
    pattern = _patterns(screened.fitted, least=0.0 if setting.changes.with_baseline else LEAST_EVIDENCE)
    pattern[p_any > ALSO_P] = 1.0
    single = np.ones(pattern.size) if lines is None else _single_lines(lines)
    single[(single > CLEAR_P) & (pattern > ALSO_P)] = 1.0
    glaring = np.where(length > GLARING, p_any, 1.0)
    return np.asarray(LOOKS * np.min([pattern, glaring, single], axis=0) <= DETECT_P)


def _whole(setting: Setting, screened: Found) -> tuple[FloatArray, FloatArray]:
    """(m,): deviations of the most changed group of each draw, heard with noise, and the chance of as much."""
    fitted, draws = screened.fitted, screened.known.library.changes
    noise = np.random.default_rng([setting.seed, 7]).normal(size=draws.shape)
    heard = draws + noise * np.nan_to_num(setting.changes.measured)
    found = largest(group_lengths(fitted.whiten(heard), fitted.groups), fitted.resting)
    return found, _chances(largest_of_nulls(fitted.resting, fitted.pairs), found)


def _patterns(fitted: Fitted, *, least: float) -> FloatArray:
    """(m,): chance of the evidence for each draw's own effect, known by its other draws, where it is `least`."""
    evidence = (np.sum(fitted.points**2, axis=1) - fitted.apart) / (2.0 * fitted.overdispersion)
    null = (fitted.null[:, None] - fitted.near) / (2.0 * fitted.overdispersion)
    return np.where(evidence >= least, _chances(null.max(axis=1), evidence), 1.0)


def _single_lines(lines: Found) -> FloatArray:
    """(m,): chance of each draw's change of own lines or sidebands, the smaller for as many looks."""
    views = lines.views[1:]
    chances = [_chances(v.null, np.sum(v.points**2, axis=1)) for v in views]
    return np.minimum(len(views) * np.min(chances, axis=0), 1.0) if views else np.ones(lines.fitted.truth.size)


def _chances(controls: FloatArray, values: FloatArray) -> FloatArray:
    return np.array([tail_chance(controls, float(v)) for v in values])
