"""All stages where the machine can be simulated: observe, calibrate, compare, nominate, refine, judge, validate."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from reconcile.atlas.bank import Mapper
from reconcile.atlas.candidates import Candidate, candidates
from reconcile.atlas.keep import Forgetful, Keeper, kept_bank
from reconcile.atlas.places import simulated_channels, standard_channels
from reconcile.atlas.plan import AtlasPlan, atlas_plan, with_tooth_pairs
from reconcile.calibrate.uncertain import uncertain_numbers
from reconcile.gate import inspect_measurement
from reconcile.gate.findings import Gate
from reconcile.gate.spoiled import without_spoiled
from reconcile.judge.changes import lenses, observed_changes
from reconcile.judge.screen import judge
from reconcile.judge.space import fit_space
from reconcile.machine.answer import answer, fault_answer
from reconcile.machine.decide import credible_set, merged_weights, plausible, remarkable, tempered
from reconcile.machine.direct import direct_evidence
from reconcile.machine.library import Catalogued, catalogued, joined
from reconcile.machine.local import around_baseline, first_heat, ordered_draws, second_heat, simulated_banks, told
from reconcile.machine.meter import Meter
from reconcile.machine.refine import best_draws, refined_plan
from reconcile.machine.second import beside, looks_for_second, strikes
from reconcile.machine.setting import Found, Setting
from reconcile.observe.observation import observe
from reconcile.observe.watch import watch_list
from reconcile.verdict import Report
from signals.recording import Recording
from sim.core.errors import SpecError
from sim.core.spec import MachineSpec

Progress = Callable[[float, str], None]
REFINED_DRAWS = 8
POINTS_OF_LINES = 2
"""Operating points from which single lines have a pattern: at one, each meets its resonance by chance."""
LEAST_OF_LINES = 4.0
"""Overdispersion of single lines: that of sixteen effects on development cases was 4 to 8."""
LEAST_TERMS = 5
"""Effects that are simulated at all their places, however far ahead the best is."""
SECONDS = 3
"""Candidates for a second effect that are simulated with all their draws."""


@dataclass(frozen=True, kw_only=True)
class Budget:
    """How much is simulated beyond the atlas, on machines that agree with the baseline: the best `terms` at all sites,
    more of the best `candidates`, then the `effects` best near their best draws in each of `rounds`."""

    name: Literal["quick", "full"]
    terms: int
    candidates: int
    effects: int
    rounds: int


QUICK = Budget(name="quick", terms=12, candidates=6, effects=3, rounds=1)
FULL = Budget(name="full", terms=100, candidates=20, effects=6, rounds=2)
BUDGETS = {"quick": QUICK, "full": FULL}


def _silent(_share: float, _stage: str) -> None:
    return None


def reconcile_machine(
    machine: MachineSpec,
    tests: Sequence[Recording],
    baselines: Sequence[Recording] = (),
    *,
    budget: Budget = QUICK,
    keeper: Keeper | None = None,
    mapper: Mapper = map,
    seed: int = 0,
    progress: Progress = _silent,
    nominated: Sequence[Candidate] | None = None,
) -> Report:
    """Reconcile recordings with a machine; SpecError says what cannot be done and why.

    `nominated` limits the effects considered; without it every registered effect at every site is a candidate.
    """
    meter = Meter(mapper)
    progress(0.0, "sensor gate")
    gate = _gate(machine, tests, baselines, seed)
    if not gate.usable:
        return fault_answer(gate, level="machine")
    gate = without_spoiled(gate)
    paired = with_tooth_pairs(machine)
    chosen = candidates(paired) if nominated is None else tuple(nominated)
    plan = atlas_plan(paired, uncertain_numbers(paired), chosen, seed=seed)
    setting = _setting(machine, gate, plan, keeper or Forgetful(), meter, progress)
    atlas_s = meter.spent_s()
    progress(0.6, "candidates")
    found = _screened(setting)
    fit: Mapping[str, object] = {}
    screened = found
    if remarkable(found.screen):
        progress(0.62, "machines that agree with the baseline")
        local = around_baseline(setting, meter)
        if local is not None:
            progress(0.7, "candidates on these machines")
            fit = told(local)
            setting = replace(local.setting, overdispersion=found.fitted.overdispersion)
            found = _located(setting, found, plan, budget, meter)
        for turn in range(budget.rounds):
            progress(0.8 + 0.1 * turn / budget.rounds, "refining the best candidates")
            found = _refined(setting, found, budget, meter, turn)
        found = replace(found, screen=tempered(found.screen, screened.screen))
    progress(0.9, "held-out data")
    cost = {"core_s": meter.spent_s(), "until_atlas_core_s": atlas_s, "budget": budget.name}
    report = answer(setting, found, gate, cost, fit)
    progress(1.0, "done")
    return report


def _gate(machine: MachineSpec, tests: Sequence[Recording], baselines: Sequence[Recording], seed: int) -> Gate:
    shaft = machine.operating.shaft if machine.operating else ""
    teeth = [float(g.teeth) for g in machine.gears if g.shaft == shaft]
    return inspect_measurement(baselines, tests, mesh_orders=teeth, lowest_order=0.3, seed=seed)


def _setting(
    machine: MachineSpec, gate: Gate, plan: AtlasPlan, keeper: Keeper, mapper: Mapper, progress: Progress
) -> Setting:
    watched = watch_list(machine)
    progress(0.05, "speed and features")
    data = observe(machine, watched, gate.tests, gate.baselines, seed=plan.seed)
    recorded = gate.tests[0].channels
    simulated = simulated_channels(machine, recorded)
    distinct = standard_channels(machine, simulated)
    banks = []
    for k, one in enumerate(data):
        progress(0.1 + 0.5 * k / len(data), f"atlas at {one.point.speed_hz:g} Hz")
        bank = kept_bank(plan, one.point, distinct, keeper=keeper, mapper=mapper)
        banks.append(bank.at(range(len(plan.draws)), [distinct.index(s) for s in simulated]))
    seen = lenses(data, banks, plan)
    return Setting(
        machine=machine,
        data=data,
        channels=tuple(c.name for c in recorded),
        simulated=simulated,
        plan=plan,
        banks=tuple(banks),
        seen_through=seen,
        changes=observed_changes(data, seen, banks, plan),
        seed=plan.seed,
        direct=direct_evidence(machine, data, recorded, seed=plan.seed),
    )


def _fit(setting: Setting, known: Catalogued) -> Found:
    """Families of features; on machines that agree with the baseline single lines beside them."""
    changes, direct = setting.changes, setting.direct
    fitted = fit_space(changes, known.library, seed=setting.seed, least=setting.overdispersion)
    fine = None
    if setting.fitted_machine is not None and len(setting.data) >= POINTS_OF_LINES:
        fine = fit_space(changes, known.library, seed=setting.seed, view=changes.single, least=LEAST_OF_LINES)
    views = (fitted,) if fine is None else (fitted, fine)
    screen = judge(views, changes.observed, direct.evidence, direct.p)
    return Found(known=known, fitted=fitted, screen=screen, fine=fine)


def _screened(setting: Setting) -> Found:
    known = catalogued(
        setting.plan,
        setting.banks,
        setting.seen_through,
        setting.plan,
        setting.banks,
        with_baseline=setting.changes.with_baseline,
    )
    return _fit(setting, known)


def _located(setting: Setting, screened: Found, atlas: AtlasPlan, budget: Budget, mapper: Mapper) -> Found:
    """The best of the screened candidates, simulated on the setting's own machines alone, the best of them more."""
    ranked = _with_others(screened)
    shown = [t for t, seen in zip(screened.known.terms, screened.fitted.visible, strict=True) if seen]
    draws = ordered_draws(atlas, shown)
    first = first_heat(setting.plan, ranked, draws, budget.terms)
    known = _simulated(setting, first, mapper)
    found = _fit(setting, known)
    best = plausible(found.screen)[: budget.candidates]
    if looks_for_second(found):
        others = beside(setting, found, best[0])
        best += [n for n in (others.names[:SECONDS] if others else ()) if n not in best]
    second = second_heat(setting.plan, best, draws, first)
    if not second.draws:
        return found  # effects with one place only: the first heat had all of their draws
    return _fit(setting, _simulated(setting, second, mapper, known))


def _with_others(screened: Found) -> list[str]:
    """What is plausible, and so much more that the metric learns what differs; where impacts are sure and something is
    left beside them, all that strikes nowhere."""
    ranked = plausible(screened.screen)
    names = screened.screen.names
    rest = [names[k] for k in np.argsort(-screened.screen.evidence) if names[k] not in ranked]
    second = looks_for_second(screened)
    for name in rest:
        known = {n.split("@")[0] for n in ranked}
        if len(known) < LEAST_TERMS or name.split("@")[0] in known or (second and not strikes(name)):
            ranked.append(name)
    return ranked


def _simulated(setting: Setting, plan: AtlasPlan, mapper: Mapper, known: Catalogued | None = None) -> Catalogued:
    """The plan's draws, with what was `known` before; that alone where none of them runs."""
    banks = simulated_banks(setting, plan, mapper)
    try:
        more = catalogued(
            plan,
            banks,
            setting.seen_through,
            setting.plan,
            setting.banks,
            with_baseline=setting.changes.with_baseline,
        )
    except SpecError:
        if known is None:
            raise
        return known
    return more if known is None else joined(known, more)


def _refined(setting: Setting, found: Found, budget: Budget, mapper: Mapper, turn: int) -> Found:
    """Simulate the leading candidates again near their best draws, and judge with both libraries."""
    weights = merged_weights(found.screen)
    leading = list(weights)[: budget.effects]
    if len(credible_set(weights, 0.999)) == 1:
        leading = leading[:2]
    around = [(name, best_draws(found.view(name), found.known, name, setting.changes.observed)) for name in leading]
    pairs = len(setting.plan.offsets)
    plan = refined_plan(setting.plan, around, draws=REFINED_DRAWS, pairs=pairs, seed=setting.seed + turn)
    return _fit(setting, _simulated(setting, plan, mapper, found.known))
