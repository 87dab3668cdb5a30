"""Causes of a result's lines: the counterfactual runs, what each line loses in them, and the document of it.

Beside the run itself every coalition of the active terms is run (up to three terms; beyond that each term taken away
by itself, and all of them), then the base machine without each of its own excitations. Same seed, same rate, same
stretch of time, the same band for envelopes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from jobs.cause_plan import Plan
from jobs.counterfactuals import PREDICTED, Effect, predicted_part, without
from jobs.labelling import LABELLED, Predicted, label_sets
from jobs.stretch import at_stretch
from signals.floor import noise_floor
from signals.labels.cause import (
    Cause,
    Coalition,
    Reading,
    places_hz,
    read_lines,
    removed_db,
    shares,
    split,
)
from signals.labels.images import FAMILY as NUMERICAL
from signals.labels.types import LabelledPeak, LabelSet
from signals.recording import Recording, from_response
from signals.series import FloatArray
from signals.spectra.amplitude import amplitude_spectrum
from signals.spectra.envelope import envelope_spectrum
from sim.core.response import Response
from sim.core.spec import MachineSpec

Run = Callable[[MachineSpec], Response]
Spectrum = str
MAX_CHANNELS = 12
SHOWN = 0.5
"""Share from which an effect is called the mechanism of a line."""
LEAST_SHARE = 0.005
"""Parts of the base machine below this are not listed; terms always are."""


@dataclass(frozen=True, kw_only=True)
class Target:
    """Labelled lines of one spectrum of a channel; `amplitude` shape (lines,)."""

    channel: str
    spectrum: Spectrum
    labels: LabelSet
    peaks: tuple[LabelledPeak, ...]

    @property
    def amplitude(self) -> FloatArray:
        """Amplitudes in the run itself."""
        return np.array([p.amplitude for p in self.peaks], dtype=np.float64)


@dataclass(kw_only=True)
class _Ledger:
    """What the runs gave, by target: amplitudes of coalitions and of the base machine without some excitations."""

    targets: tuple[Target, ...]
    acting: dict[Coalition, list[Reading]] = field(default_factory=dict)
    lacking: dict[Coalition, list[Reading]] = field(default_factory=dict)
    steps: list[int] = field(default_factory=list)


def find_causes(response: Response, plan: Plan, run: Run, *, start_s: float) -> dict[str, object]:
    """The document of causes: `run` simulates a machine like the response's, `start_s` is where the analysis begins."""
    everyone = frozenset(range(len(plan.effects)))
    ledger = _Ledger(targets=_targets(response, start_s))
    ledger.acting[everyone] = [
        Reading(amplitude=t.amplitude, lost=np.zeros(len(t.peaks), dtype=np.bool_)) for t in ledger.targets
    ]
    for acting in plan.coalitions:
        missing = [plan.effects[i] for i in sorted(everyone - acting)]
        ledger.acting[acting] = _account(ledger, run(without(response.machine, missing)), start_s)
    base = without(response.machine, plan.effects)
    for removed in plan.removals:
        taken = [plan.excitations[i] for i in sorted(removed)]
        kept = response.bases_hz if any(e.keeps_bases for e in taken) else None
        ledger.lacking[removed] = _account(ledger, run(without(base, taken)), start_s, bases_hz=kept)
    return _document(plan, ledger, response)


def _targets(response: Response, start_s: float) -> tuple[Target, ...]:
    response = at_stretch(response, start_s)
    recording = from_response(response).select(start_s=start_s)
    step_s = response.quality.step_s
    known = Predicted(machine=response.machine, seed=response.seed, bases_hz=response.bases_hz, step_s=step_s)
    found: list[Target] = []
    ranked = [c.name for quantity in LABELLED for c in recording.channels if c.quantity == quantity]
    names = [n for n in ranked if np.isfinite(recording.samples[recording.names.index(n)]).all()]
    for name in names[:MAX_CHANNELS]:
        sets = label_sets(recording.series(name), known)
        if sets is None:
            continue
        for spectrum, labels in (("amplitude", sets.amplitude), ("envelope", sets.envelope)):
            peaks = tuple(p for p in labels.peaks if p.label and p.amplitude and p.family != NUMERICAL)
            found.append(Target(channel=name, spectrum=spectrum, labels=labels, peaks=peaks))
    return tuple(found)


def _account(
    ledger: _Ledger,
    response: Response,
    start_s: float,
    *,
    bases_hz: Mapping[str, float] | None = None,
) -> list[Reading]:
    """Read the targets' lines in a counterfactual run; they lie where that machine's own kinematics put them."""
    response = at_stretch(response, start_s)
    recording = from_response(response).select(start_s=start_s)
    readings = [_read(recording, t, bases_hz or response.bases_hz) for t in ledger.targets]
    ledger.steps.append(response.quality.steps)
    return readings


def _read(recording: Recording, target: Target, bases_hz: Mapping[str, float]) -> Reading:
    series = recording.series(target.channel)
    band = target.labels.band
    spectrum = amplitude_spectrum(series) if band is None else envelope_spectrum(series, band=band)
    places = places_hz(target.peaks, bases_hz)
    return read_lines(spectrum, places, noise_floor(spectrum, target.labels.floor, places))


def _document(plan: Plan, ledger: _Ledger, response: Response) -> dict[str, object]:
    channels: dict[str, dict[str, dict[str, object]]] = {}
    for i, target in enumerate(ledger.targets):
        found = _causes(plan, ledger, i, response.machine)
        table: dict[str, object] = {
            peak.label: [_plain(cause) for cause in causes] for peak, causes in zip(target.peaks, found, strict=True)
        }
        channels.setdefault(target.channel, {})[target.spectrum] = table
    irregular = response.quality.step_error_kind == "irregular"
    return {
        "rule": plan.rule,
        "cost": {"runs": plan.runs, "steps": sum(ledger.steps)},
        "effects": [vars(e) for e in (*plan.effects, *plan.excitations)],
        "idle": [vars(e) for e in plan.idle],
        "not_run": [vars(e) for e in plan.left_out],
        "notes": ["the motion is irregular: shares hold for this one course of it"] if irregular else [],
        "channels": channels,
    }


def _causes(plan: Plan, ledger: _Ledger, i: int, machine: MachineSpec) -> list[list[Cause]]:
    """Causes of each line of target `i`, the largest share first."""
    acting = {group: readings[i] for group, readings in ledger.acting.items()}
    lacking = {removed: readings[i] for removed, readings in ledger.lacking.items()}
    count = len(plan.effects)
    everyone = frozenset(range(count))
    present, base = acting[everyone].amplitude, acting[frozenset()]
    parts = shares({group: reading.amplitude**2 for group, reading in acting.items()}, count, plan.rule)
    power = {removed: reading.amplitude**2 for removed, reading in lacking.items()}
    own = split(base.amplitude**2, power, len(plan.excitations)) * parts[-1]
    columns = [_column(effect, present, acting[everyone - {k}], parts[k]) for k, effect in enumerate(plan.effects)]
    nothing = np.zeros_like(present)
    columns += [_column(effect, present, acting[everyone], nothing) for effect in plan.idle]
    terms = len(columns)
    columns += [
        _column(effect, base.amplitude, lacking[frozenset({k})], own[k]) for k, effect in enumerate(plan.excitations)
    ]
    rows = [[c for k, c in enumerate(row) if k < terms or c.share >= LEAST_SHARE] for row in zip(*columns, strict=True)]
    peaks = ledger.targets[i].peaks
    rows = [row + _rest(peak, float(x), machine) for row, peak, x in zip(rows, peaks, own[-1], strict=True)]
    return [sorted(row, key=lambda c: (-c.share, c.term, c.site)) for row in rows]


def _rest(peak: LabelledPeak, share: float, machine: MachineSpec) -> list[Cause]:
    """What no run took away, in equal parts for the parts of the base machine that the line is predicted of."""
    if share < LEAST_SHARE:
        return []
    parts = dict.fromkeys(predicted_part(component, machine) for component in peak.components or ("",))
    each = share / len(parts)
    return [Cause(**_named(part), removed_db=0.0, at_least=False, share=each) for part in parts]


def _column(effect: Effect, present: FloatArray, reading: Reading, share: FloatArray) -> list[Cause]:
    """One effect's part in every line."""
    drop = removed_db(np.maximum(present, np.finfo(np.float64).tiny), reading.amplitude)
    return [
        Cause(**_named(effect), removed_db=float(d), at_least=bool(lost), share=float(s))
        for d, lost, s in zip(drop, reading.lost, share, strict=True)
    ]


def _named(effect: Effect) -> dict[str, str]:
    return {"term": effect.term, "site": effect.site, "counterfactual": effect.counterfactual}


def _plain(cause: Cause) -> dict[str, object]:
    # adding zero turns -0.0 into 0.0
    return {**vars(cause), "removed_db": round(cause.removed_db, 2) + 0.0, "share": round(cause.share, 4)}


def with_causes(labels: Mapping[str, object], document: Mapping[str, object], channel: str) -> dict[str, object]:
    """A document of labels whose peaks say what causes them, as far as `document` knows the channel."""
    tables = document["channels"]
    assert isinstance(tables, Mapping)
    known = tables.get(channel, {})
    about = {"cause_rule": document["rule"], "cause_cost": document["cost"]}
    envelope = labels.get("envelope")
    if isinstance(envelope, Mapping):
        envelope = {**envelope, **_told(envelope, known.get("envelope", {}))}
    return {**labels, **_told(labels, known.get("amplitude", {})), **about, "envelope": envelope}


def _told(labels: Mapping[str, object], table: Mapping[str, Sequence[Mapping[str, object]]]) -> dict[str, object]:
    peaks = labels["peaks"]
    assert isinstance(peaks, list)
    return {"peaks": [_decided(peak, table.get(peak["label"], ())) for peak in peaks]}


def _decided(peak: Mapping[str, object], causes: Sequence[Mapping[str, object]]) -> dict[str, object]:
    """The peak with its causes; one with half the line's power or more is its mechanism, and its site the component.

    One without which the line grows is not: it makes the line where another effect is missing, and weakens it here.
    """
    told = {**peak, "causes": list(causes)}
    if causes and float(str(causes[0]["share"])) >= SHOWN and float(str(causes[0].get("removed_db", 0.0))) >= 0:
        basis = PREDICTED if causes[0]["counterfactual"] == PREDICTED else "counterfactual"
        told |= {"mechanism": causes[0]["term"], "mechanism_basis": basis}
        told |= {"component": causes[0]["site"]} if causes[0]["site"] else {}
    return told
