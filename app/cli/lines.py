"""What a simulation says at its end: the strongest labelled lines, and how good the run was."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import Any

from jobs.documents import ResultDocuments
from sim.core.response import Response

STRONGEST = 12
FOUND = ("present", "ambiguous")
MOST_NAMED = 3
LEAST_SHARE, LEAST_GROWTH_DB = 0.1, -0.05
SHARES = {
    "shapley_power": "shares of a line's power by Shapley's value: the mean over all orders of adding the effects",
    "leave_one_out_power": "shares of a line's power by what goes away without each effect",
}
"""What the shares beside the lines are, by the rule of the causes."""


def print_result(
    response: Response, documents: ResultDocuments, *, duration_s: float, runs: int, elapsed_s: float
) -> None:
    """Lines to the output; quality, time and warnings beside it. `runs`: with those that show causes."""
    for line in listed(documents.peaks):
        print(line)
    quality, warnings = response.quality, documents.summary["warnings"]
    assert isinstance(warnings, list)
    error = "not measured" if quality.step_error is None else f"{quality.step_error:.1e}"
    print(
        f"step error {error} ({quality.step_error_kind}), energy residual {quality.energy.relative_residual:.1e}; "
        f"{spent(duration_s, runs, elapsed_s)}",
        file=sys.stderr,
    )
    for warning in warnings:
        print(f"warning: {warning}", file=sys.stderr)


def spent(duration_s: float, runs: int, elapsed_s: float) -> str:
    """How long the computing took beside how long the machine ran."""
    each = f" in each of {runs} runs" if runs > 1 else ""
    return f"{duration_s:g} s of motion{each}, computed in {elapsed_s:.3g} s"


def listed(peaks: Mapping[str, Any]) -> list[str]:
    """The strongest found lines, under lines that say of which channel, out of how many, and what has no name."""
    found = sorted((p for p in peaks["peaks"] if p["status"] in FOUND), key=lambda p: -p["amplitude"])
    if not found:
        return _nameless(peaks, 0.0)
    shown = found[:STRONGEST]
    which = f"the {len(shown)} strongest of {len(found)}" if len(found) > len(shown) else f"{len(found)}"
    doubtful = sum(peak["status"] == "ambiguous" for peak in found)
    some = f", {doubtful} of them ambiguous" if doubtful else ""
    kept = "labels.json has all of them, the absent ones and the strongest unexplained ones"
    head = f"{peaks['channel']}: {which} labelled lines{some} ({kept})"
    told = [SHARES[peaks["cause_rule"]]] if peaks.get("cause_rule") in SHARES else []
    least = float(shown[-1]["amplitude"])
    return [head, *_nameless(peaks, least), *told, *(f"  {_line(peak)}" for peak in shown)]


def _nameless(peaks: Mapping[str, Any], least: float) -> list[str]:
    """How many of the lines found nothing explains, and whether any is stronger than `least`, the last one listed."""
    strange = [p for p in peaks["peaks"] if p["status"] == "unexplained"]
    if not strange:
        return []
    count, first = int(peaks["unexplained"]), max(strange, key=lambda p: float(p["amplitude"]))
    above = sum(p["amplitude"] > least for p in strange)
    many = f"{above} or more" if above == len(strange) < count else f"{above}"
    stronger = f"{many} of them stronger than the last one listed" if above else "none stronger than those listed"
    if least == 0.0:
        stronger = "no line has a name"
    place = f"the strongest {first['amplitude']:.4g} {first['unit']} at {first['frequency_hz']:.2f} Hz"
    return [f"{count} of {peaks['found']} found lines are unexplained: {stronger}, {place}"]


def _line(peak: Mapping[str, Any]) -> str:
    line = f"{peak['label']:<20} {peak['frequency_hz']:>10.2f} Hz {peak['amplitude']:>12.4g} {peak['unit']}"
    return f"{line}{_doubt(peak)}{_causes(peak)}"


def _doubt(peak: Mapping[str, Any]) -> str:
    if peak["status"] != "ambiguous":
        return ""
    others = [str(other) for other in peak.get("alternatives") or ()]
    more = "" if len(others) <= MOST_NAMED else f" and {len(others) - MOST_NAMED} more"
    named = f": or {', '.join(others[:MOST_NAMED])}{more}" if others else ""
    return f"   ambiguous{named}"


def _causes(peak: Mapping[str, Any]) -> str:
    """The shares that make up most of a line, where causes were asked for."""
    causes = [c for c in peak.get("causes", ()) if c["share"] >= LEAST_SHARE]
    told = [f"{100 * c['share']:.0f} % {c['term']}@{c['site']}{_grows(c)}" for c in causes]
    return f"   {', '.join(told)}".replace("base_machine@", "base machine") if told else ""


def _grows(cause: Mapping[str, Any]) -> str:
    """Said of an effect that makes a line where others are missing, and weakens it in the whole machine."""
    removed_db = float(cause.get("removed_db", 0.0))
    return f" (without it the line grows by {-removed_db:.1f} dB)" if removed_db < LEAST_GROWTH_DB else ""
