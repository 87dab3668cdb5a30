"""The report of a prescribed motion."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from reconcile.driven.faulty import beside
from reconcile.driven.forced import ALPHA, gain_interval
from reconcile.driven.judge import ROUGH
from reconcile.driven.machine import OWN_LAW, Site, driven_site
from reconcile.driven.nominate import LEAST_GAIN, leads, score_nats
from reconcile.driven.prescribed.analysis import Findings, Outcome, investigate
from reconcile.driven.prescribed.faults import HeldMotions, drifting
from reconcile.driven.prescribed.fitting import Resisting
from reconcile.driven.prescribed.machine import Built, built
from reconcile.driven.prescribed.pictures import SHOWN_CYCLES_S, force_samples, pictures
from reconcile.driven.prescribed.resistance import GRADUAL, UNITS, travel_to
from reconcile.driven.prescribed.reversals import SHARE
from reconcile.driven.prescribed.told import interval_of, left_of, sentence, sizes_of, undecided, used_errors
from reconcile.driven.split import parts_of
from reconcile.verdict import (
    Cause,
    EstimatedForce,
    HeldOut,
    NextExperiment,
    PlaceWeight,
    Report,
    Severity,
    Where,
    Word,
)
from sim.core.spec import MachineSpec
from sim.terms import REGISTRY

PARTS_OF_A_PATH = {"backlash": "backlash", "friction": "coulomb_friction", "cubic": "cubic_support"}
"""Registered effects by the parameter that is their size."""
WORTH = 0.15
"""Low end of the gain on the run held out, from which a law is worth a name: of made spring-dampers that were once
taken for friction it was at most 0.07, of laws that are there 0.39 and more."""
NEAR = 3.0
"""A law leaves at most so many times what all signals together leave: made play and friction 1 to 2.4, a measured brake
0.4 to 0.8, friction that falls with speed taken for dry friction 4.9, one that sets in gradually taken for play 3.8."""
FORETOLD = 0.5
"""Share of what a law leaves, from which on it is no more than the nearest one where other signals of the motion
foretell that and `ROUGH` of the force (read off once): laws that are there 0 to 0.34 (a measured brake), or, of play
behind which friction sets in softly, 0.8 but 4 % of the force; friction behind a spring told for play 0.5 and 0.7,
dry friction for one that falls with speed 0.8, of 10 to 22 % of the force."""
LEAST_LEFT, LINES = 0.02, 0.5
"""Share of the force that the linear model leaves, and share of it in lines, from which it is not noise."""
LEAST_TOLD, LEAST_MOTION = 1e-3, 0.7
"""Share of the force that a linear model must leave for anything to be missing: less is rounding. And the share from
which the force has little to do with the motion."""
SLOW = 0.15
"""Speed at which dry friction is developed, over the fastest, from which it cannot be told from damping: made friction
of 1500 N developed at 0.4 of it is told as 1060; at 0.04 to 0.06 as 1480 to 1500."""
QUIET = ("nothing_missing", "not_decidable")


def _term(parameter: str) -> str:
    key = PARTS_OF_A_PATH.get(parameter, OWN_LAW)
    return key if REGISTRY.get(key) is not None else OWN_LAW


def _severity(whole: Findings, found: Resisting, name: str) -> Severity:
    low, high = interval_of(whole, found, name)
    return Severity(name=name, value=found.values[name], unit=UNITS[name], low=low, high=high)


def _held_out(o: Outcome, seed: int) -> HeldOut:
    before, after, box, placebo = used_errors(o)
    _, low, high = gain_interval(o.squares[0], o.squares[1], np.random.default_rng([seed, 5]))
    how = "predicted with nothing of it" if o.transfers else "after one number (its level) from its first third"
    return HeldOut(
        metric="NRMSE of the force", unit="1", before=before, after=after, gain=1 - after / before, gain_low=low,
        gain_high=high, retuned=1 - o.retuned / before, black_box=1 - box / before, placebo=1 - placebo / before,
        held=f"{o.held}, fitted on {o.fitted_on}; {how}",
    )  # fmt: skip


def _times_left(found: Findings) -> float:
    """What the chosen law leaves on the stretch kept for choosing, over what all signals leave there."""
    return float(np.sqrt(found.trials[0][1].mean())) / max(found.rich.left, 1e-300)


def _reasons(found: Findings, gain_low: float) -> tuple[str, ...]:
    best = found.chosen.structure
    ends = {name: interval_of(found, found.chosen, name) for name in sizes_of(found, found.chosen)}
    failed = [f"the interval of {name} includes zero" for name, (low, high) in ends.items() if low <= 0 <= high]
    if not leads(found.linear_squares, found.trials[0][1]):
        failed.append(f"{best.words} is not better than a spring and damper on the stretch kept for choosing")
    if _times_left(found) > NEAR:
        failed.append(f"{best.words} leaves {_times_left(found):.1f} times what can be foretold from the motion")
    failed += [
        f"other signals of the motion tell {100 * told.size:.0f} % of the force on {run} beside {best.words}"
        for run, told in found.besides
        if told.share > FORETOLD and told.size > ROUGH
    ]
    if best == GRADUAL:
        failed.append(f"{best.words} is a picture of the hysteresis, no mechanism")
    if found.chosen.values.get("speed", 0.0) > SLOW * float(np.max(np.abs(found.fitted.motion.velocity))):
        failed.append(f"{best.words} is developed so slowly that damping may be part of it")
    if gain_low < WORTH:
        failed.append(f"on {found.outcomes[0].held} the error falls by less than {100 * WORTH:.0f} % (90 %)")
    for o in found.outcomes:
        before, after, _, placebo = used_errors(o)
        if after >= min(before, o.retuned, placebo):
            failed.append(f"fitted on {o.fitted_on}, {o.held} is not predicted better than by a retuned linear law")
    return tuple(failed)


def _something(found: Findings) -> bool:
    """Whether the motion foretells more of the force than a spring and damper do, by all signals or by a law."""
    if left_of(found) < LEAST_TOLD:
        return False
    best = found.trials[0][1]
    gain = 1.0 - float(best.mean() / max(float(found.linear_squares.mean()), 1e-300))
    return found.rich.foretells or (leads(found.linear_squares, best) and gain > LEAST_GAIN)


def _is_noise(found: Findings) -> bool:
    """Whether what the linear model leaves may be noise: no lines stand in it, and no cause of the test tells it."""
    told = found.missing.p_value < ALPHA and found.missing.statistic > LEAST_GAIN
    if left_of(found) > LEAST_MOTION:
        return False
    return not told and (left_of(found) < LEAST_LEFT or found.beyond < LINES)


def _verdict(found: Findings, reasons: Sequence[str]) -> Word:
    if not _something(found):
        return "nothing_missing" if _is_noise(found) else "not_decidable"
    if reasons:
        return "unknown_physics"
    return "explained" if found.rival is None else "ambiguous"


def _causes(found: Findings, verdict: Word, reasons: tuple[str, ...], site: str) -> tuple[Cause, ...]:
    causes = []
    named = verdict == "explained"
    for rank, (trial, squares) in enumerate(found.trials):
        score, _ = score_nats(found.linear_squares, squares)
        best = rank == 0
        shown = found.chosen if best else trial
        sizes = sizes_of(found, shown)
        why = reasons if best and reasons else (trial.structure.words,)
        if not sizes:
            causes.append(
                Cause(term=OWN_LAW, site=site, score=score, named=False, reasons=why, values=dict(shown.values))
            )
        causes += [
            Cause(
                term=_term(name), site=site, score=score, severity=_severity(found, shown, name),
                named=named and best, reasons=why, values=dict(shown.values),
            )
            for name in (sizes if best else sizes[:1])
        ]  # fmt: skip
    return tuple(causes)


def _stages(found: Findings) -> tuple[Mapping[str, object], ...]:
    stages: list[Mapping[str, object]] = [
        {"stage": "calibrate", **{k: found.linear.values[k] for k in ("stiffness", "damping", "offset")}},
        {"stage": "is_anything_missing", "statistic": found.missing.statistic, "null_95": found.missing.null_95,
         "p": found.missing.p_value, "foretold": found.rich.gain, "in_lines": found.beyond,
         "linear_leaves": left_of(found), "nothing_foretells_n": found.rich.left},
        {"stage": "nominate", **{t.structure.words: float(s.mean() ** 0.5) for t, s in found.trials}},
        {"stage": "beside_the_law", **{run: vars(told) for run, told in found.besides}},
        {"stage": "soft_start", **({} if found.widths is None else vars(found.widths))},
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


def _force(found: Findings, verdict: Word, site: str) -> EstimatedForce | None:
    if verdict in QUIET:
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
    spec: MachineSpec, held: HeldMotions, *, seed: int, provenance: Mapping[str, object]
) -> Report:
    """All steps and the report."""
    site = driven_site(spec)
    data, parts = held.data[0], parts_of(held.data)
    found = investigate(parts, seed)
    held_out = _held_out(found.outcomes[0], seed)
    reasons = _reasons(found, held_out.gain_low)
    verdict = _verdict(found, reasons)
    name = site.body.name
    machine = _built(spec, site, found)
    limits = (
        *held.remarks,
        "The whole resistance is measured in one place: where along its path the play sits cannot be told.",
    )
    something = verdict not in QUIET
    report = Report(
        verdict=verdict,
        sentence=" ".join([sentence(found, verdict, reasons, name), *held.remarks]),
        level="driven",
        where=Where(sites=(PlaceWeight(site=name, weight=1.0),) if something else (), limits=limits),
        causes=_causes(found, verdict, reasons, name) if something else (),
        held_out=held_out if something else None,
        force=_force(found, verdict, name),
        undecidable=(*(undecided(found) if something else ()), *((data.assumed,) if data.assumed else ())),
        next_experiment=NextExperiment(
            sentence="Move it slowly, well below the play and then just beyond it: play and spring then part."
        )
        if something
        else None,
        machine=machine.machine.model_dump(mode="json"),
        stages=_stages(found),
        pictures=pictures(found, named=verdict == "explained"),
        provenance={**provenance, "force_channels": machine.channels, "longest_step_s": machine.longest_step_s},
    )
    return beside(report, [*held.faults, *drifting(found, parts)])
