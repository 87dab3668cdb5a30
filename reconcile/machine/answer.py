"""Stage 8: what was found becomes a report."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from reconcile.atlas.keep import ATLAS_VERSION
from reconcile.atlas.places import sensor_sites
from reconcile.gate.findings import Gate
from reconcile.gate.spoiled import doubts, fault_sentence
from reconcile.machine.causes import ranked_causes
from reconcile.machine.decide import Decision, decide
from reconcile.machine.heldout import feature_channels, feature_frequencies, held_out, spectral_mask, with_sums
from reconcile.machine.limits import limits
from reconcile.machine.lines import by_name, line_changes
from reconcile.machine.meter import Meter
from reconcile.machine.pairs import Pair, named_pair
from reconcile.machine.pictures import ranking, spectra, turn_maps, with_forms
from reconcile.machine.proved import proved
from reconcile.machine.revised import Revised, paths, revised_machine
from reconcile.machine.second import Beside, Together, fitted_change, second_effect, struck_somewhere
from reconcile.machine.setting import Found, Setting
from reconcile.machine.unknown import Unknown, at_supports
from reconcile.machine.weigh import merged_weights, of_one_part
from reconcile.machine.window import angle_window
from reconcile.machine.words import law_sentence, next_experiment, sentence, size, title, with_points
from reconcile.observe.features import Layout
from reconcile.observe.watch import WatchList, watch_list
from reconcile.origin import origin
from reconcile.verdict import (
    Cause,
    HeldOut,
    Level,
    NextExperiment,
    PlaceWeight,
    Report,
    SensorFault,
    Severity,
    Where,
    Word,
)


def fault_answer(gate: Gate, *, level: Level) -> Report:
    """No channel is usable."""
    fault = gate.fault or SensorFault(kind="not_finite", channel="", detail="no usable channel")
    return Report(
        verdict="measurement_fault",
        sentence=fault_sentence(fault),
        level=level,
        fault=fault,
        stages=(gate_stage(gate),),
    )


def gate_stage(gate: Gate) -> Mapping[str, object]:
    """What the sensor gate found, as a stage of the report."""
    remarks = [f"{f.recording} {f.channel}: {f.kind}, {f.detail}".strip() for f in gate.findings]
    return {"name": "sensor gate", "findings": remarks or ["nothing wrong with the measurement"]}


def _layout(watched: WatchList, setting: Setting) -> Layout:
    bank = setting.banks[0]
    return Layout(
        lines=len(watched.lines),
        bands=bank.floor.shape[2],
        shapes=bank.band.shape[2],
        modulations=len(watched.modulations),
        shafts=len(watched.gears),
        phases=len(watched.phased),
    )


def _sites(weights: Mapping[str, float]) -> tuple[PlaceWeight, ...]:
    total: dict[str, float] = {}
    for name, weight in weights.items():
        site = name.split("@")[1]
        total[site] = total.get(site, 0.0) + weight
    ordered = sorted(total.items(), key=lambda item: -item[1])
    return tuple(PlaceWeight(site=s, weight=w) for s, w in ordered if w > 0.01)


def answer(
    setting: Setting,
    found: Found,
    gate: Gate,
    meter: Meter,
    cost: Mapping[str, object],
    fit: Mapping[str, object] | None = None,
    unknown: Unknown | None = None,
    pair: Pair | None = None,
) -> Report:
    """The report of a machine-level reconciliation; `unknown`: what stage 6 says where no known effect is adequate;
    `pair`: what stands beside the best effect."""
    observed = setting.changes.observed
    decision = decide(found.screen, views=len(setting.channels) * len(setting.data))
    watched = watch_list(setting.machine)
    layout = _layout(watched, setting)
    weights = of_one_part(merged_weights(found.screen), found.screen.struck)
    missing = decision.word != "nothing_missing"
    decision, other = named_pair(decision, second_effect(setting, found, decision), pair)
    causes = with_forms(ranked_causes(found, decision, weights, observed, other), found.screen) if missing else ()
    both = other.together if other is not None else None
    held = _held(setting, found, decision, layout, unknown, both) if decision.chosen else None
    fitted = fitted_change(found, decision.chosen[0], observed) if decision.chosen else None
    revision = revised_machine(setting, found, causes, spectral_mask(layout, setting.seen_through), meter, both)
    if revision is not None:
        fitted = revision.change
    before = decision
    decision, causes = proved(decision, causes, found, revision)
    other = other if decision is before else None
    if unknown is not None and unknown.change is not None:
        fitted = unknown.change
    word, text, fault = _told(setting, decision, gate, causes, held, other, unknown)
    lead = _lead(found, decision)
    named = decision.chosen[0] if decision.word == "explained" else None
    placed = _with_second(weights, other)
    if unknown is not None:
        placed = at_supports(weights, unknown.force.site, [b.name for b in setting.machine.bearings])
    where = _where(setting, layout, watched, placed) if missing else Where(limits=limits(setting))
    if word != "measurement_fault":
        where = replace(where, limits=(*where.limits, *doubts(gate)))
    return Report(
        verdict=word,
        sentence=text,
        level="machine",
        where=where,
        causes=causes,
        fault=fault,
        held_out=held,
        undecidable=_undecidable(setting, found, decision, other, pair),
        next_experiment=_next(setting, decision, lead),
        force=unknown.force if unknown is not None else None,
        machine=_machine(revision, unknown, decision),
        stages=(*_stages(setting, found, gate, decision, fit or {}), *_revisions(revision)),
        pictures={
            "spectra": spectra(setting.data, setting.seen_through, fitted, layout, setting.channels),
            "ranking": ranking(setting, found, named) if missing else [],
            "paths": paths(setting),
            "heat": turn_maps(setting.machine, setting.data, setting.channels, where.angle_window),
        },
        provenance=provenance(setting.seed, len(setting.plan.draws), meter, cost),
    )


def _undecidable(
    setting: Setting, found: Found, decision: Decision, other: Beside | None, pair: Pair | None
) -> tuple[str, ...]:
    if decision.word in ("ambiguous", "not_decidable"):
        return tuple(decision.reasons)
    if decision.word == "explained" and other is None and pair is not None and pair.others:
        return (f"a second effect stands beside it, one of these: {', '.join(pair.others)}",)
    others = struck_somewhere(setting, found, decision)
    return (f"impacts come from another part too, which these share: {', '.join(others)}",) if others else ()


def _told(
    setting: Setting,
    decision: Decision,
    gate: Gate,
    causes: Sequence[Cause],
    held: HeldOut | None,
    other: Beside | None,
    unknown: Unknown | None,
) -> tuple[Word, str, SensorFault | None]:
    """Verdict, sentence and sensor fault."""
    severity: Severity | None = causes[0].severity if causes else None
    word, text = decision.word, sentence(decision, severity, held)
    if unknown is not None:
        text = f"{text} {law_sentence(unknown.force, tried=unknown.tried)}"
    if other is not None:
        text = f"{text} Beside it: {title(other.names[0])}{size(causes[1].severity)}."
    if gate.fault is None or word not in ("nothing_missing", "not_decidable") or _doubtful(gate, setting, word):
        return word, text, None
    # a fault that is sure goes before a rest of which nothing can be told
    rest = "" if word == "nothing_missing" else " What differs on the other channels is too faint to tell."
    return "measurement_fault", f"{fault_sentence(gate.fault)}{rest}", gate.fault


def _with_second(weights: Mapping[str, float], other: Beside | None) -> dict[str, float]:
    """Half of the weight for each of two effects."""
    if other is None:
        return dict(weights)
    own = np.exp(other.evidence - other.evidence[0])
    second = {name: 0.5 * float(w) for name, w in zip(other.names, own / own.sum(), strict=True)}
    return {name: 0.5 * weights.get(name, 0.0) + second.get(name, 0.0) for name in {**weights, **second}}


def _where(setting: Setting, layout: Layout, watched: WatchList, weights: Mapping[str, float]) -> Where:
    return Where(
        sites=_sites(weights),
        lines=by_name(line_changes(setting.data, setting.changes, layout, watched, setting.channels), setting.machine),
        angle_window=angle_window(setting.machine, setting.data, setting.channels),
        limits=limits(setting),
    )


def _machine(revision: Revised | None, unknown: Unknown | None, decision: Decision) -> dict[str, object] | None:
    """With a law that stands, or an effect that is claimed: none where no known effect is."""
    if unknown is not None and unknown.machine is not None:
        return unknown.machine.model_dump(mode="json")
    if revision is None or decision.word == "unknown_physics":
        return None
    return revision.machine.model_dump(mode="json")


def _doubtful(gate: Gate, setting: Setting, word: str) -> bool:
    """At one operating point a machine's own resonance may move as a loose sensor's does, within what is usual."""
    fault = gate.fault
    return fault is not None and fault.kind == "loose_sensor" and len(setting.data) == 1 and word == "nothing_missing"


def _lead(found: Found, decision: Decision) -> float:
    if len(decision.chosen) < 2:
        return 0.0
    names = found.screen.names
    first, second = (float(found.screen.evidence[names.index(c)]) for c in decision.chosen[:2])
    return abs(first - second)


def _held(
    setting: Setting,
    found: Found,
    decision: Decision,
    layout: Layout,
    unknown: Unknown | None,
    both: Together | None,
) -> HeldOut:
    lines = [d.lines_hz for d in setting.data]
    count = len(setting.channels)
    known = found.unled if unknown is None or unknown.known is None else unknown.known
    held = held_out(
        setting.changes,
        known if both is None else with_sums(known, decision.chosen[0], both.sums),
        decision.chosen[0] if unknown is None or unknown.label is None else unknown.label,
        also=() if both is None else (both.terms[0][1].term,),
        spectral=spectral_mask(layout, setting.seen_through),
        frequency=feature_frequencies(layout, lines, count),
        channel=feature_channels(layout, len(lines), count),
        seed=setting.seed,
    )
    return with_points(held, setting.data)


def _next(setting: Setting, decision: Decision, lead: float) -> NextExperiment | None:
    heard = sensor_sites(setting.machine, setting.simulated)
    return next_experiment(decision.chosen, lead, len(setting.data), heard)


def _stages(
    setting: Setting, found: Found, gate: Gate, decision: Decision, fit: Mapping[str, object]
) -> tuple[Mapping[str, object], ...]:
    speeds: Sequence[str] = [
        f"{d.point.speed_hz:g} Hz stated, {d.spectra[0].speed_hz:.3f} Hz found ({d.spectra[0].estimate.method})"
        for d in setting.data
    ]
    gains = [float(np.median(lens.chain.gain_db)) for lens in setting.seen_through[:1]]
    rest = found.screen.rest
    lines = rest.kept != 1.0 or rest.unmet != 0.0  # without teeth there is no view of single lines
    return (
        gate_stage(gate),
        {"name": "observe", "speeds": speeds, "features": int(np.isfinite(found.fitted.whiten.sigma).sum())},
        {"name": "calibrate", "median_gain_db": gains, "mode": "A" if setting.changes.with_baseline else "B", **fit},
        {
            "name": "impacts",
            "found": list(setting.direct.told)
            or ["no part's lines modulate more deeply than those of sound machines here (levels may have risen)"],
        },
        {
            "name": "is anything missing",
            "length": found.screen.length,
            "null_median": float(np.median(found.fitted.null)),
            "p_any": found.screen.p_any,
            "p_best": found.screen.p_best,
            "p_direct": found.screen.p_direct,
            "p_lines": found.screen.p_lines,
            "p_first": found.screen.p_first,
            "p": decision.p,
        },
        {"name": "nominate", "candidates": len(found.screen.names), "draws": len(found.known.terms)},
        {
            "name": "judge",
            "misfit": found.screen.misfit,
            "overdispersion": found.fitted.overdispersion,
            "lines_left": rest.unmet if lines else None,
            "lines_explained": rest.kept if lines else None,
            "families_explained": rest.pooled,
            "fitted_with_the_machine": sorted(found.led),
        },
    )


def _revisions(revision: Revised | None) -> tuple[Mapping[str, object], ...]:
    """How well the revised machine does, simulated: no forecast, on the recordings themselves."""
    if revision is None:
        return ()
    return (
        {
            "name": "revised machine",
            "simulated_forms": revision.forms,
            "level_change_db": round(revision.before_db, 2),
            "left_of_it_db": round(revision.after_db, 2),
        },
    )


def provenance(seed: int, draws: int, meter: Meter, cost: Mapping[str, object]) -> Mapping[str, object]:
    """Versions, seed and cost."""
    return {
        **origin(seed, meter.spent_s(), **cost),
        "atlas_version": ATLAS_VERSION,
        "draws": draws,
    }
