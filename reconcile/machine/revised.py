"""The revised machine, simulated: of a few close forms of what is named the one that shows what was observed.

A size is estimated and the other parameters are those of the nearest draw; nothing says that the two together, on the
mean of the machines that fit, show the change they were found by. Eight vector lanes cost what one does: the machine as
it is and seven forms are simulated, and the nearest form is the revised machine.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from reconcile.atlas.bank import Mapper
from reconcile.atlas.candidates import Candidate, with_effects
from reconcile.atlas.plan import AtlasPlan, Draw
from reconcile.calibrate.chain import band_centres_hz
from reconcile.calibrate.uncertain import Offsets, moved
from reconcile.machine.causes import cause_terms
from reconcile.machine.local import simulated_banks
from reconcile.machine.refine import best_draws
from reconcile.machine.second import Together
from reconcile.machine.setting import Found, Setting
from reconcile.observe.features import changed
from reconcile.observe.statistics import third_octaves
from reconcile.verdict import Cause, Severity
from signals.series import FloatArray
from sim.core.spec import MachineSpec, TermSpec

FORMS = 7
"""With the machine as it is they fill the vector lanes."""


@dataclass(frozen=True, kw_only=True)
class Revised:
    """The machine with what is named, and what its simulation shows: `change` (F,) in dB as the recordings' change.

    `before_db`, `after_db`: root mean square of the observed levels' change, and of what the simulated change leaves of
    it, on the recordings that were fitted; `forms` were simulated.
    """

    machine: MachineSpec
    change: FloatArray
    before_db: float
    after_db: float
    forms: int


def revised_machine(
    setting: Setting,
    found: Found,
    causes: Sequence[Cause],
    levels: np.ndarray,
    mapper: Mapper,
    both: Together | None = None,
) -> Revised | None:
    """Of the causes that are named, or else the likeliest, or of two as they were fitted together (`both`); `levels`
    (F,): features compared. None without causes, or where none of the forms runs."""
    if not causes:
        return None
    terms = cause_terms(causes)
    name = f"{causes[0].term}@{causes[0].site}"
    forms = [(form, *terms[1:]) for form in _forms(found, name, terms[0], causes[0].severity, setting.changes.observed)]
    machine = found.machine(setting, name)
    if both is not None:
        forms = list(both.terms[:FORMS])
        machine = moved(setting.plan.machine, setting.plan.numbers, both.middle)
    still = Offsets(values=np.zeros(len(setting.plan.numbers)))
    candidate = Candidate(term=causes[0].term, site=causes[0].site)
    draws = (Draw(pair=0), *(Draw(pair=0, candidate=candidate, term=form[0], also=form[1:]) for form in forms))
    plan = AtlasPlan(
        machine=machine,
        numbers=setting.plan.numbers,
        offsets=(still,),
        twins=(still,),
        draws=draws,
        seed=setting.plan.seed,
    )
    changes = _changes(setting, plan, mapper)
    seen = setting.changes.observed
    runs = _running(changes, setting.changes.starts)
    if not runs:
        return None
    compared = levels & np.isfinite(seen) & np.isfinite(changes[runs]).all(axis=0)
    left = {k: _size((seen - changes[k])[compared]) for k in runs}
    best = min(left, key=lambda k: left[k])
    return Revised(
        machine=with_effects(machine, forms[best]),
        change=changes[best],
        before_db=_size(seen[compared]),
        after_db=left[best],
        forms=len(forms),
    )


def _running(changes: FloatArray, starts: Sequence[int]) -> list[int]:
    """Forms (rows) that run at every operating point."""
    points = [np.isfinite(changes[:, a:b]).any(axis=1) for a, b in pairwise(starts)]
    return [int(k) for k in np.flatnonzero(np.all(points, axis=0))]


def _size(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2))) if values.size else float("nan")


def _forms(
    found: Found, name: str, first: TermSpec, size: Severity | None, observed: FloatArray
) -> tuple[TermSpec, ...]:
    """The estimated size with the nearest draw's parameters, then near draws at that size and at their own, where that
    lies within its interval."""
    forms = [first]
    for drawn in best_draws(found.view(name), found.known, name, observed, count=FORMS):
        if size is None:
            forms.append(drawn)
            continue
        forms.append(drawn.model_copy(update={"parameters": {**drawn.parameters, size.name: size.value}}))
        if size.low <= abs(drawn.parameters[size.name]) <= size.high:
            forms.append(drawn)
    distinct = [form for k, form in enumerate(forms) if form not in forms[:k]]
    return tuple(distinct[:FORMS])


def _changes(setting: Setting, plan: AtlasPlan, mapper: Mapper) -> FloatArray:
    """(forms, F): what each shows against the machine as it is, or without baseline against the nominal one; NaN where
    one of the two does not run."""
    parts = []
    for bank, lens in zip(simulated_banks(setting, plan, mapper), setting.seen_through, strict=True):
        features = lens.features(bank)
        rest = features[0] if setting.changes.with_baseline else lens.nominal
        change = changed(features[1:], rest, bank.phase.shape[2]).reshape(len(plan.draws) - 1, -1)
        dead = ~bank.alive[1:] | ~bank.alive[0]
        parts.append(np.where(dead[:, None], np.nan, change))
    return np.concatenate(parts, axis=1)


def paths(setting: Setting) -> list[dict[str, object]]:
    """Gain of every sensor's path by which a simulated spectrum becomes the recorded one, and the noise power that the
    recording of the first operating point adds in each third octave; dB."""
    chain = setting.seen_through[0].chain
    noise = 10.0 * np.log10(chain.noise * np.diff(third_octaves()) + 1e-300)
    return [
        {
            "channel": name,
            "frequency_hz": band_centres_hz().tolist(),
            "gain_db": np.round(chain.gain_db[c], 2).tolist(),
            "noise_db": np.round(noise[c], 2).tolist(),
        }
        for c, name in enumerate(setting.channels)
    ]
