"""What each stage did, for the report."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from reconcile.gate.findings import Gate
from reconcile.machine.decide import Decision
from reconcile.machine.pairs import Pairs
from reconcile.machine.revised import Revised
from reconcile.machine.setting import Found, Setting


def gate_stage(gate: Gate) -> Mapping[str, object]:
    """What the sensor gate found, as a stage of the report."""
    remarks = [f"{f.recording} {f.channel}: {f.kind}, {f.detail}".strip() for f in gate.findings]
    return {"name": "sensor gate", "findings": remarks or ["nothing wrong with the measurement"]}


def all_stages(
    setting: Setting, found: Found, gate: Gate, decision: Decision, fit: Mapping[str, object]
) -> tuple[Mapping[str, object], ...]:
    """From the gate to the judge; `fit`: how well machines agree with the baseline."""
    speeds: Sequence[str] = [
        f"{d.point.speed_hz:g} Hz stated, no line confirms it"
        if d.spectra[0].estimate.method == "stated"
        else f"{d.point.speed_hz:g} Hz stated, {d.spectra[0].speed_hz:.3f} Hz found ({d.spectra[0].estimate.method})"
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
            "p_lines": found.screen.p_lines if _repeat(found) else None,
            "p_first": found.screen.p_first,
            "p_turns": found.screen.p_turns,
            "p": decision.p,
        },
        {"name": "nominate", "candidates": len(found.screen.names), "draws": len(found.known.terms)},
        {
            "name": "judge",
            "misfit": found.screen.misfit,
            "overdispersion": found.fitted.overdispersion,
            "lines_left": rest.unmet if lines else None,
            "lines_left_elsewhere": rest.elsewhere if lines else None,
            "lines_explained": rest.kept if lines else None,
            "families_explained": rest.pooled,
            "fitted_with_the_machine": sorted(found.led),
            "as_likely_and_leaves_more": [f"{name}: {value:.1f}" for name, value in found.screen.yields.items()],
            "bursts_set_aside": [f"{name}: {value:.1f}" for name, value in found.screen.bursts.items()],
            "heard_less_likely": [f"{name}: {value:.1f}" for name, value in sorted(found.screen.heard.items())],
        },
    )


def of_pairs(pairs: Pairs | None) -> tuple[Mapping[str, object], ...]:
    """What was tried beside the best effect; nothing where nothing was looked for or worth it."""
    if pairs is None or not pairs.tried:
        return ()
    tried = [
        f"{name}: {summed:.1f} by sums" + ("" if simulated is None else f", {simulated:.1f} simulated")
        for name, summed, simulated in pairs.tried
    ]
    return ({"name": "two effects together", "first": pairs.first, "adds": tried},)


def revisions(revision: Revised | None) -> tuple[Mapping[str, object], ...]:
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


def _repeat(found: Found) -> bool:
    """Whether single lines were asked: those of rattling bearings are not."""
    return all(getattr(view.view, "repeats", True) for view in found.views[1:])
