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
    """The strongest found lines, under a line that says of which channel and out of how many."""
    found = sorted((p for p in peaks["peaks"] if p["status"] in FOUND), key=lambda p: -p["amplitude"])
    if not found:
        return []
    shown = found[:STRONGEST]
    which = f"the {len(shown)} strongest of {len(found)}" if len(found) > len(shown) else f"{len(found)}"
    doubtful = sum(peak["status"] == "ambiguous" for peak in found)
    some = f", {doubtful} of them ambiguous" if doubtful else ""
    head = (
        f"{peaks['channel']}: {which} labelled lines{some} (labels.json has them all, absent and unexplained ones too)"
    )
    return [head, *(f"  {_line(peak)}" for peak in shown)]


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
    told = [f"{100 * c['share']:.0f} % {c['term']}@{c['site']}" for c in peak.get("causes", ()) if c["share"] >= 0.1]
    return f"   {', '.join(told)}".replace("base_machine@", "base machine") if told else ""
