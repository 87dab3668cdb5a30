"""The report of a prescribed motion."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from reconcile.driven.forced import ALPHA, gain_interval
from reconcile.driven.machine import OWN_LAW, Site, driven_site
from reconcile.driven.nominate import leads, score_nats
from reconcile.driven.prescribed.analysis import Findings, Outcome, investigate
from reconcile.driven.prescribed.fitting import Resisting
from reconcile.driven.prescribed.machine import Built, built
from reconcile.driven.prescribed.pictures import SHOWN_CYCLES_S, force_samples, pictures
from reconcile.driven.prescribed.resistance import ELASTIC, PLAY, UNITS, travel_to
from reconcile.driven.prescribed.reversals import SHARE
from reconcile.driven.split import Part
from reconcile.verdict import Cause, EstimatedForce, HeldOut, NextExperiment, PlaceWeight, Report, Severity, Where, Word
from sim.core.spec import MachineSpec
from sim.terms import REGISTRY

PARTS_OF_A_PATH = {"backlash": "backlash", "friction": "coulomb_friction", "cubic": "cubic_support"}
"""Registered effects by the parameter that is their size."""
SIZES = ("backlash", "friction", "drag", "cubic")


def _term(parameter: str) -> str:
    key = PARTS_OF_A_PATH.get(parameter, OWN_LAW)
    return key if REGISTRY.get(key) is not None else OWN_LAW


def _severity(found: Resisting, name: str) -> Severity:
    low, high = found.intervals[name]
    return Severity(name=name, value=found.values[name], unit=UNITS[name], low=low, high=high)


def _used(o: Outcome) -> tuple[float, float, float, float]:
    """NRMSE of linear, chosen, black box, placebo: blind where friction transfers, else with one number each."""
    k = 0 if o.transfers else 1
    return o.linear[k], o.chosen[k], o.black_box[k], o.placebo[k]


def _held_out(o: Outcome, seed: int) -> HeldOut:
    before, after, box, placebo = _used(o)
    _, low, high = gain_interval(o.squares[0], o.squares[1], np.random.default_rng([seed, 5]))
    how = "predicted with nothing of it" if o.transfers else "after one number (its level) from its first third"
    return HeldOut(
        metric="NRMSE of the force", unit="1", before=before, after=after, gain=1 - after / before, gain_low=low,
        gain_high=high, retuned=1 - o.retuned / before, black_box=1 - box / before, placebo=1 - placebo / before,
        held=f"{o.held}, fitted on {o.fitted_on}; {how}",
    )  # fmt: skip


def _reasons(found: Findings) -> tuple[str, ...]:
    best = found.chosen.structure
    ends = {name: found.chosen.intervals[name] for name in SIZES if name in found.chosen.values}
    failed = [f"the interval of {name} includes zero" for name, (low, high) in ends.items() if low <= 0 <= high]
    if not leads(found.linear_squares, found.trials[0][1]):
        failed.append(f"{best.words} is not better than a spring and damper on the stretch kept for choosing")
    for o in found.outcomes:
        before, after, _, placebo = _used(o)
        if after >= min(before, o.retuned, placebo):
            failed.append(f"fitted on {o.fitted_on}, {o.held} is not predicted better than by a retuned linear law")
    return tuple(failed)


def _verdict(found: Findings, reasons: Sequence[str]) -> Word:
    if found.missing.p_value >= ALPHA:
        return "nothing_missing"
    if reasons:
        return "unknown_physics"
    if not leads(found.trials[1][1], found.trials[0][1]):
        return "ambiguous"
    return (
        "explained"
        if found.chosen.structure.key in (PLAY.key, ELASTIC.key, "dry_friction", "cubic")
        else "unknown_physics"
    )


def _sentence(found: Findings, verdict: Word, site: str) -> str:
    values, words = found.chosen.values, found.chosen.structure.words
    if verdict == "nothing_missing":
        return f"A spring and damper explain the force on {site} up to noise."
    if verdict == "ambiguous":
        return f"The force on {site} has a part that is {words} or {found.trials[1][0].structure.words}."
    o = found.outcomes[0]
    before, after, _, _ = _used(o)
    said = f"What is missing at {site} is {words}"
    if "backlash" in values:
        low, high = (1e3 * x for x in found.chosen.intervals["backlash"])
        said += f": {1e3 * values['backlash']:.1f} mm of play (90 %: {low:.1f} to {high:.1f})"
    if found.travel is not None:
        t = found.travel
        said += (
            f", and after a reversal {1e3 * t.mean_m:.1f} mm ({1e3 * t.low_m:.1f} to {1e3 * t.high_m:.1f}) pass until "
            f"{100 * SHARE:.0f} % of the sliding force"
        )
    return f"{said}; error of the force on {o.held} falls from {100 * before:.0f} % to {100 * after:.0f} %."


def _causes(found: Findings, verdict: Word, reasons: tuple[str, ...], site: str) -> tuple[Cause, ...]:
    causes = []
    named = verdict == "explained"
    for rank, (trial, squares) in enumerate(found.trials):
        score, _ = score_nats(found.linear_squares, squares)
        best = rank == 0
        shown = found.chosen if best else trial
        sizes = [n for n in SIZES if n in shown.values]
        for name in sizes if best else sizes[:1]:
            why = reasons if best and reasons else (trial.structure.words,)
            causes.append(
                Cause(
                    term=_term(name), site=site, score=score, severity=_severity(shown, name), named=named and best,
                    reasons=why, values=dict(shown.values),
                )
            )  # fmt: skip
    return tuple(causes)


def _stages(found: Findings) -> tuple[Mapping[str, object], ...]:
    stages: list[Mapping[str, object]] = [
        {"stage": "calibrate", **{k: found.linear.values[k] for k in ("stiffness", "damping", "offset")}},
        {"stage": "is_anything_missing", "statistic": found.missing.statistic, "null_95": found.missing.null_95,
         "p": found.missing.p_value},
        {"stage": "nominate", **{t.structure.words: float(s.mean() ** 0.5) for t, s in found.trials}},
        {"stage": "fit", **found.chosen.values, "travel_of_the_model_m": _model_travel(found.chosen)},
    ]  # fmt: skip
    if found.travel is not None:
        stages.append({"stage": "locate", "travel_after_reversal": vars(found.travel)})
    for o in found.outcomes:
        told = {k: v for k, v in vars(o).items() if k not in ("squares", "before", "used")}
        stages.append({"stage": "validate", **told, "friction_transfers": o.transfers})
    return tuple(stages)


def _model_travel(found: Resisting) -> float | None:
    return travel_to(dict(found.values), SHARE) if "elastic" in found.values else None


def _undecidable(found: Findings) -> tuple[str, ...]:
    said = []
    if any(not o.transfers for o in found.outcomes):
        levels = ", ".join(f"{o.held} {o.level:.2f} times {o.fitted_on}" for o in found.outcomes)
        said.append(
            f"The friction level does not transfer between the runs ({levels}): it is a setting, not the machine."
        )
    if "backlash" in found.chosen.values:
        said.append("Play and the spring behind it share the travel: a soft start of the spring counts as play.")
    return tuple(said)


def _force(found: Findings, verdict: Word, site: str) -> EstimatedForce | None:
    if verdict == "nothing_missing":
        return None
    samples = force_samples(found)
    run = found.fitted
    step = run.motion.step_s
    late = slice(run.skip, None)
    turns = int(np.count_nonzero(np.diff(np.sign(run.motion.displacement[late])) > 0))
    work = float(np.sum(run.force[late] * run.motion.velocity[late]) * step) / max(turns, 1)
    stable = verdict in ("explained", "ambiguous")
    return EstimatedForce(
        site=site, samples=samples, law=found.chosen.structure.words if stable else None,
        coefficients=dict(found.chosen.values) if stable else {}, work_per_cycle_j=work,
    )  # fmt: skip


def _built(spec: MachineSpec, site: Site, found: Findings) -> Built:
    n = min(int(SHOWN_CYCLES_S / found.held.motion.step_s), found.held.force.size)
    return built(site, spec, found.outcomes[0].used, found.fitted.motion, found.held.motion.displacement[:n])


def reconcile_prescribed(
    spec: MachineSpec, parts: Sequence[Part], *, seed: int, provenance: Mapping[str, object], assumed: str = ""
) -> Report:
    """All steps and the report."""
    site = driven_site(spec)
    found = investigate(parts, seed)
    reasons = _reasons(found)
    verdict = _verdict(found, reasons)
    name = site.body.name
    machine = _built(spec, site, found)
    limits = ("The whole resistance is measured in one place: where along its path the play sits cannot be told.",)
    something = verdict != "nothing_missing"
    return Report(
        verdict=verdict,
        sentence=_sentence(found, verdict, name),
        level="driven",
        where=Where(sites=(PlaceWeight(site=name, weight=1.0),) if something else (), limits=limits),
        causes=_causes(found, verdict, reasons, name) if something else (),
        held_out=_held_out(found.outcomes[0], seed) if something else None,
        force=_force(found, verdict, name),
        undecidable=(*(_undecidable(found) if something else ()), *((assumed,) if assumed else ())),
        next_experiment=NextExperiment(
            sentence="Move it slowly, well below the play and then just beyond it: play and spring then part."
        )
        if something
        else None,
        machine=machine.machine.model_dump(mode="json"),
        stages=_stages(found),
        pictures=pictures(found),
        provenance={**provenance, "force_channels": machine.channels, "longest_step_s": machine.longest_step_s},
    )
