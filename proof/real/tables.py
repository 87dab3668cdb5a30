"""Tables of the recordings of which the kinematics are known."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from proof.real import told
from proof.real.call import Answer
from proof.real.describe import description
from proof.real.rigs import TUNED, WHY, judged, stem, true_width_m

Document = Mapping[str, Any]
WIDTH = 120
SPEED_ERROR = 0.003
"""Stated and measured speeds that differ by more are shown."""


@dataclass(frozen=True, kw_only=True)
class Row:
    """One comparison and its answer; the documents are entries of the recordings' catalogue."""

    baseline: Document
    test: Document
    answer: Answer

    @property
    def key(self) -> str:
        """Rig and test recording; the baseline where it is not the rig's sound machine."""
        against = "" if "ealthy" in self.baseline["condition"] else f" against {stem(self.baseline)}"
        return f"{stem(self.test)}{against}"

    @property
    def tuned(self) -> bool:
        """Whether the engine was tuned on its rig."""
        return bool(self.test["dataset"] == TUNED)

    @property
    def judged(self) -> str:
        """`right`, `undecided`, `refused` or `wrong`."""
        return judged(self.test["dataset"], self.test["condition"], self.answer.report, self.answer.error)


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    """Lines of a Markdown table; bars in cells are taken out."""
    lines = [f"| {' | '.join(head)} |", "|" + "---|" * len(head)]
    return lines + [f"| {' | '.join(cell.replace('|', '/') for cell in row)} |" for row in rows]


def names(rows: Sequence[Row]) -> list[str]:
    """Verdict and causes against the truth."""
    shown = []
    for row in rows:
        report = row.answer.report
        verdict = "refused" if report is None else report["verdict"].replace("_", " ")
        said = (row.answer.error or "").partition("test_1.json: ")[2].partition("\n")[0].partition(";")[0]
        cause = told.causes(report) if report is not None else said
        files = [row.test["dataset"], stem(row.test), stem(row.baseline)]
        shown.append([*files, row.test["condition"], verdict, cause, row.judged])
    return table(("rig", "test", "baseline", "truth", "verdict", "causes", "judged"), shown)


def sites(rows: Sequence[Row]) -> list[str]:
    """Place, size and what is not explained."""
    shown = []
    for row in _reported(rows):
        report = row.answer.report
        assert report is not None
        true = true_width_m(stem(row.test))
        real = "" if true is None else f"{1e3 * true:.2g} mm"
        cells = [told.places(report), told.size(report), real, told.left(report)]
        if any(cells[:2]):
            shown.append([row.key, *cells])
    return table(("test", "site (weight); heard by", "size (90 %)", "seeded", "not explained by it"), shown)


def paths(rows: Sequence[Row]) -> list[str]:
    """Order, band and channel that carried it; levels that changed; the speed where the stated one is wrong."""
    shown = []
    for row in _reported(rows):
        report = row.answer.report
        assert report is not None
        cells = [told.order(report), told.path(report), _speed(row)]
        if any(cells):
            shown.append([row.key, *cells])
    head = ("test", "order (from the drawing)", "carried by; levels that changed", "speed stated, found, measured (Hz)")
    return table(head, shown)


def gains(rows: Sequence[Row]) -> list[str]:
    """Held-out distances of all models."""
    shown = []
    for row in _reported(rows):
        report = row.answer.report
        held = report["held_out"] if report is not None else None
        if held is None:
            continue
        before = held["before"]
        rivals = [told.error(before, held[name], "dB") for name in ("retuned", "black_box", "placebo")]
        gain = f"{held['gain']:.2f} ({held['gain_low']:.2f} to {held['gain_high']:.2f})"
        shown.append([row.key, f"{before:.1f}", f"{held['after']:.1f}", gain, *rivals])
    return table(("test", "before", "after", "gain (90 %)", "retuned", "black box", "placebo"), shown)


def misses(rows: Sequence[Row]) -> list[str]:
    """Every row that is not right, with the reason; where none is known the engine's own words."""
    lines = []
    for row in rows:
        if row.judged != "right":
            own = row.answer.report["sentence"] if row.answer.report is not None else row.answer.error or ""
            lines.append(f"- {row.key} ({row.judged}): {WHY.get(stem(row.test), own)}")
    return lines or ["- none"]


def summary(rows: Sequence[Row]) -> list[str]:
    """Counts over the tables."""
    reports = [(r, r.answer.report) for r in rows if r.answer.report is not None]
    held = [d["held_out"] for _, d in reports if d["held_out"] is not None]
    sized = [(told.first_size(d), true_width_m(stem(r.test))) for r, d in reports]
    known = [(s, t) for s, t in sized if s is not None and t is not None]
    inside = sum(s["low"] <= t <= s["high"] for s, t in known)
    bounds = [(b, t) for r, d in reports if (b := told.first_bound_m(d)) and (t := true_width_m(stem(r.test)))]
    above = sum(t < b for b, t in bounds)
    count = {word: sum(r.judged == word for r in rows) for word in ("right", "undecided", "refused", "wrong")}
    blind = sum(1 for (s, t), (r, _) in zip(sized, reports, strict=True) if s and t and not r.tuned)
    lead = [h["gain"] - h["black_box"] for h in held]
    firm = sum(h["gain_low"] > max(h["retuned"], h["black_box"]) for h in held)
    text = (
        f"Of {len(rows)} comparisons {count['right']} are right, {count['undecided']} undecided (the truth is one of a "
        f"set), {count['refused']} refused for its clock, {count['wrong']} wrong; without the rig the engine was tuned "
        f"on {sum(r.judged == 'right' for r in rows if not r.tuned)} of {sum(not r.tuned for r in rows)} are right. A "
        "plain envelope detector is said to name 15 of the 17 bearing recordings of the catalogue. Of the defects of "
        f"known length {len(known)} are given a size: {inside} of the intervals hold the truth, and {blind} are of "
        f"rigs that nothing was tuned on. For {len(bounds)} only an upper bound is given, no size: {above} of them are "
        "above the truth. On held-out data the named defect "
        f"is ahead of the black box in {sum(x > 0 for x in lead)} of {len(held)}, by {min(lead, default=0.0):.2f} to "
        f"{max(lead, default=0.0):.2f} of gain; in {firm} its whole interval is above retuning and black box."
    )
    return textwrap.wrap(text, WIDTH)


def _reported(rows: Sequence[Row]) -> list[Row]:
    return [row for row in rows if row.answer.report is not None]


def _speed(row: Row) -> str:
    operating = description(row.test).get("operating")
    report = row.answer.report
    if operating is None or report is None:
        return ""
    stated, true = operating["speed_hz"], row.test["shaft_speed_hz"]
    found = told.speeds(report).get("test 1")
    if found is None or abs(true / stated - 1) < SPEED_ERROR:
        return ""
    return f"{stated:.2f}, {found:.2f}, {true:.2f}"
