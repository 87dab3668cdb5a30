"""Stage 8: what was found becomes a report."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from reconcile.atlas.keep import ATLAS_VERSION
from reconcile.atlas.places import sensor_sites
from reconcile.gate.findings import Gate
from reconcile.gate.spoiled import doubts, fault_sentence
from reconcile.machine.beside_play import placed_beside_play
from reconcile.machine.burst_size import burst_sizes
from reconcile.machine.causes import ranked_causes
from reconcile.machine.decide import AT_ONE, OFTEN, UNMEASURED, Decision
from reconcile.machine.decided import decided
from reconcile.machine.elsewhere import by_forecast
from reconcile.machine.envelope import envelopes_of
from reconcile.machine.heldout import feature_channels, feature_frequencies, held_out, spectral_mask
from reconcile.machine.level_size import by_levels
from reconcile.machine.limits import limits
from reconcile.machine.lines import by_name, line_changes
from reconcile.machine.meter import Meter
from reconcile.machine.next_look import apart_of
from reconcile.machine.pairs import Pair, Pairs, named_pair, sizes_of
from reconcile.machine.pictures import ranking, spectra, turn_maps, with_forms
from reconcile.machine.pit_size import pit_sizes
from reconcile.machine.placed import places, with_open, with_second
from reconcile.machine.proved import proved
from reconcile.machine.revised import Revised, paths, revised_machine
from reconcile.machine.second import Beside, Together, fitted_change, second_effect, struck_said
from reconcile.machine.setting import Found, Setting
from reconcile.machine.stages import all_stages, gate_stage, of_pairs, revisions
from reconcile.machine.strike_size import strike_sizes
from reconcile.machine.unknown import Unknown, at_supports
from reconcile.machine.unlisted import UNLISTED, beyond_the_known
from reconcile.machine.weigh import merged_weights, of_one_part, of_the_set
from reconcile.machine.words import law_sentence, more, next_experiment, sentence, size, title, together, with_points
from reconcile.observe.features import Layout
from reconcile.observe.tooth_place import angle_window
from reconcile.observe.watch import WatchList, watch_list
from reconcile.origin import origin
from reconcile.verdict import (
    NOT_JUDGED,
    Cause,
    HeldOut,
    Level,
    NextExperiment,
    Report,
    SensorFault,
    Severity,
    Where,
    Word,
)
from signals.series import FloatArray

MOST_STRUCK = 2
"""Effects that share another part's impacts and are ranked next to the name; more would push out its rivals."""
SETS = ("explained", "ambiguous", "not_decidable")
"""Verdicts on one name or a set of them, whose places are those of the set."""


def fault_answer(gate: Gate, *, level: Level) -> Report:
    """No channel is usable."""
    fault = gate.fault or SensorFault(kind="not_finite", channel="", detail="no usable channel")
    return Report(
        verdict="measurement_fault",
        sentence=fault_sentence(fault),
        level=level,
        fault=fault,
        undecidable=NOT_JUDGED,
        stages=(gate_stage(gate),),
    )


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


def answer(
    setting: Setting,
    found: Found,
    gate: Gate,
    meter: Meter,
    cost: Mapping[str, object],
    fit: Mapping[str, object] | None = None,
    unknown: Unknown | None = None,
    pairs: Pairs | None = None,
) -> Report:
    """The report at level `machine`; `unknown`: of stage 6; `pairs`: what was tried beside the best effect."""
    decision = decided(setting, found)
    watched = watch_list(setting.machine)
    layout = _layout(watched, setting)
    weights = of_one_part(merged_weights(found.screen), found.screen.struck)
    missing = decision.word != "nothing_missing"
    seen = second_effect(setting, found, decision)
    decision, other = placed_beside_play(setting, found, *named_pair(decision, seen, pairs))
    both = other.together if other is not None else None
    pair = pairs.best if pairs is not None and pairs.best is not None and other is pairs.best.beside else None
    held = _held(setting, found, decision, layout, unknown, other, pair) if decision.chosen else None
    decision = by_forecast(decision, held, measured=setting.changes.with_baseline)
    unknown = unknown if decision.word == "unknown_physics" else None
    struck = [n for n in struck_said(setting, found, decision)[1] if n in found.screen.names][:MOST_STRUCK]
    sizes = _sizes(setting, found, decision, pairs, other, meter) if missing else ()
    ranked = ranked_causes(found, decision, weights, setting.changes.observed, other, struck, *sizes) if missing else ()
    causes = with_forms(ranked, found.screen)
    revision = revised_machine(setting, found, causes, spectral_mask(layout, setting.seen_through), meter, both)
    fitted = _fitted(setting, found, decision, revision, unknown)
    before = decision
    decision, causes = proved(decision, causes, found, revision, held)
    other, held = (other, held) if decision is before else (None, None)
    unsettled = _unsettled(setting, found, decision, other, pairs)
    word, text, fault = _told(setting, decision, gate, causes, held, other, unknown)
    if word == "explained":
        text += more(*unsettled)
    named = [f"{c.term}@{c.site}" for c in causes if c.named]
    shown = of_the_set(weights, decision.chosen) if decision.word in SETS else weights
    placed = with_open(with_second(shown, other), unsettled[1])
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
        undecidable=_undecidable(decision, *unsettled),
        next_experiment=_next(setting, found, decision, unknown),
        force=unknown.force if unknown is not None else None,
        machine=_machine(revision, unknown, decision),
        stages=(*all_stages(setting, found, gate, decision, fit or {}), *of_pairs(pairs), *revisions(revision)),
        pictures=_pictures(setting, layout, fitted, where, ranking(setting, found, named) if missing else [], causes),
        provenance=provenance(setting.seed, len(setting.plan.draws), meter, cost),
    )


def _sizes(
    setting: Setting, found: Found, decision: Decision, pairs: Pairs | None, other: Beside | None, meter: Meter
) -> tuple[Together | None, dict[str, Severity], dict[str, Severity], dict[str, Severity]]:
    """Of what the answer stands on: beside a second effect; by what is heard; by levels, where the first is alone; by
    both edges of a pit."""
    names = list(dict.fromkeys((*decision.chosen[:1], *(other.names[:1] if other else ()), *decision.chosen[1:])))
    edges = strike_sizes(setting, names)
    unsized = [n for n in names if n not in edges]
    heard = {**burst_sizes(setting, decision.chosen, meter), **pit_sizes(setting, unsized, meter)}
    beside = other is not None or (pairs is not None and pairs.best is not None and bool(pairs.best.others))
    alone = decision.word in ("explained", "ambiguous") and not beside
    return sizes_of(pairs), heard, by_levels(setting, found, decision.chosen, meter) if alone else {}, edges


def _pictures(
    setting: Setting,
    layout: Layout,
    fitted: FloatArray | None,
    where: Where,
    ranked: list[dict[str, object]],
    causes: Sequence[Cause],
) -> dict[str, object]:
    """`fitted` (F,): the change that what is named shows, dB; None where nothing is."""
    return {
        "spectra": spectra(setting.data, setting.seen_through, fitted, layout, setting.channels),
        "ranking": ranked,
        "paths": paths(setting),
        "envelope": envelopes_of(setting.direct.envelopes, causes),
        "heat": turn_maps(setting.machine, setting.data, setting.channels, where.angle_window),
    }


def _fitted(
    setting: Setting, found: Found, decision: Decision, revision: Revised | None, unknown: Unknown | None
) -> FloatArray | None:
    """The change (F,) that stands for the answer: of the law found, of the revised machine, or of the nearest draw."""
    if unknown is not None and unknown.change is not None:
        return unknown.change
    if revision is not None:
        return revision.change
    return fitted_change(found, decision.chosen[0], setting.changes.observed) if decision.chosen else None


def _unsettled(
    setting: Setting, found: Found, decision: Decision, other: Beside | None, pairs: Pairs | None
) -> tuple[str, tuple[str, ...]]:
    """What stands beside a named effect without a name of its own: how it shows, and the effects it may be."""
    if decision.word != "explained":
        return "", ()
    pair = pairs.best if pairs is not None else None
    if other is None and pair is not None and pair.others:
        return "a second effect stands beside it", pair.others
    shows, struck = struck_said(setting, found, decision)
    told = other is not None and other.names[0] in struck
    return ("", ()) if told else (shows, struck)


def _undecidable(decision: Decision, shows: str, others: tuple[str, ...]) -> tuple[str, ...]:
    if decision.word in ("ambiguous", "not_decidable", "unknown_physics"):
        return UNLISTED if decision.word == "unknown_physics" else tuple(decision.reasons)
    return (f"{shows}, one of these: {', '.join(others)}",) if others else ()


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
    both = held is not None and len(held.effects) > 1
    word, text = decision.word, sentence(decision, severity, None if both else held)
    if unknown is not None:
        text = f"{text} {law_sentence(unknown.force, tried=unknown.tried)}"
    if other is not None:
        text = f"{text} Beside it: {title(other.names[0])}{size(causes[1].severity)}."
    if both and held is not None:
        text = f"{text} {together(held)}"
    if gate.fault is None or word not in ("nothing_missing", "not_decidable") or _doubtful(gate, setting, word):
        return word, text, None
    # a fault that is sure goes before a rest of which nothing can be told
    rest = "" if word == "nothing_missing" else " What differs on the other channels is too faint to tell."
    return "measurement_fault", f"{fault_sentence(gate.fault)}{rest}", gate.fault


def _where(setting: Setting, layout: Layout, watched: WatchList, weights: Mapping[str, float]) -> Where:
    return Where(
        sites=places(weights),
        lines=by_name(line_changes(setting.data, setting.changes, layout, watched, setting.channels), setting.machine),
        angle_window=angle_window(setting.direct.places),
        limits=limits(setting),
    )


def _machine(revision: Revised | None, unknown: Unknown | None, decision: Decision) -> dict[str, object] | None:
    """With a law that stands, or an effect that is claimed: none where no known effect is."""
    if unknown is not None and unknown.machine is not None:
        return unknown.machine.model_dump(mode="json")
    if revision is None or decision.word not in ("explained", "ambiguous"):
        return None
    return revision.machine.model_dump(mode="json")


def _doubtful(gate: Gate, setting: Setting, word: str) -> bool:
    """At one operating point a machine's own resonance may move as a loose sensor's does, within what is usual."""
    fault = gate.fault
    return fault is not None and fault.kind == "loose_sensor" and len(setting.data) == 1 and word == "nothing_missing"


def _lead(found: Found, decision: Decision) -> float:
    """Log evidence (natural) of the first effect of the answer over its second."""
    if len(decision.chosen) < 2:
        return 0.0
    names = found.screen.names
    first, second = (float(found.screen.evidence[names.index(c)]) for c in decision.chosen[:2])
    return first - second


def _held(
    setting: Setting,
    found: Found,
    decision: Decision,
    layout: Layout,
    unknown: Unknown | None,
    other: Beside | None,
    pair: Pair | None,
) -> HeldOut:
    lines = [d.lines_hz for d in setting.data]
    count = len(setting.channels)
    known = found.unled if unknown is None or unknown.known is None else unknown.known
    held = held_out(
        setting.changes,
        known,
        decision.chosen[0] if unknown is None or unknown.label is None else unknown.label,
        beside=other.names[0] if other is not None else None,
        drawn=pair.drawn if pair is not None else None,
        spectral=spectral_mask(layout, setting.seen_through),
        frequency=feature_frequencies(layout, lines, count),
        channel=feature_channels(layout, len(lines), count),
        seed=setting.seed,
    )
    together = None if pair is None else pair.beside.together
    return with_points(held, setting.data, searched=together is not None and together.searched)


def _next(setting: Setting, found: Found, decision: Decision, unknown: Unknown | None) -> NextExperiment | None:
    if decision.word == "unknown_physics":
        return beyond_the_known("" if unknown is None else unknown.force.site, tried=unknown is None or unknown.tried)
    if decision.reasons == (UNMEASURED,):
        return NextExperiment(sentence="Record the machine in a sound state as a baseline.")
    if decision.reasons and decision.reasons[0].startswith((AT_ONE, OFTEN)):
        return NextExperiment(
            sentence="Record baseline and test once more where it shows: that tells whether it comes and goes."
        )
    heard = sensor_sites(setting.machine, setting.simulated)
    apart = apart_of(setting, found, decision.chosen)
    return next_experiment(decision.chosen, _lead(found, decision), len(setting.data), heard, apart)


def provenance(seed: int, draws: int, meter: Meter, cost: Mapping[str, object]) -> Mapping[str, object]:
    """Versions, seed and cost."""
    return {
        **origin(seed, meter.spent_s(), **cost),
        "atlas_version": ATLAS_VERSION,
        "draws": draws,
    }
