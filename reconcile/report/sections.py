"""Sections of the page that are words and tables."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence

from reconcile.report.action import on_the_speed, undecided
from reconcile.report.formula import formula
from reconcile.report.markup import Markup, escaped, figure_text, tag
from reconcile.report.mending import channels
from reconcile.report.named import cause, percent, score
from reconcile.report.revised import to_do
from reconcile.report.score import score_notes
from reconcile.report.words import (
    FORMS,
    LEFT_OVER,
    LEVEL,
    PART_LEFT,
    VERDICT,
    compared,
    forms,
    gains,
    leaves_a_part,
    severity,
    size_name,
    sizes,
    tidied,
    weight,
)
from reconcile.verdict import Cause, Level, LineChange, NextExperiment, PlaceWeight, Report, Where, operating_point

MOST_LINES = 20
MOST_PLACES = 4
MOST_TIMES = 1000
"""Times as likely, from which no figure is told."""
SYMBOLS = (
    "f_o, f_i, f_b, f_c: outer race, inner race, ball and cage of a bearing; f_r: a shaft; f_m: a mesh; numbered in "
    "the order of the machine file. 3*f_i1±2*f_r1 is a sideband. Bearings that roll alike share their lines."
)
CHANGE = (
    "Change: of the line's level (of a line of an envelope: of its depth of modulation) over what was expected there, "
    "by the baseline where there is one. "
)
STRUCK = {"outer_spall": ("outer",), "inner_spall": ("inner",), "ball_spall": ("ball", "balls")}
"""What the lines of a struck part are locked to."""
PERHAPS = ("Perhaps the measurement", "warn")
"""Badge of a fault that the machine itself may look like."""
TOLD = '<div class="told">'


def section(title: str, *parts: Markup) -> Markup:
    """A titled card; nothing when it would be empty. With words and tables only it counts as `told`."""
    kept = [part for part in parts if part]
    only = all(part.startswith(TOLD) for part in kept)
    return tag("section", tag("h2", title), *kept, css="told" if only else None) if kept else Markup("")


def told(*parts: Markup) -> Markup:
    """What the dashboard leaves out where it shows the page: it has told it already."""
    return Markup(TOLD + "".join(parts) + "</div>") if any(parts) else Markup("")


def bullets(items: Iterable[object]) -> Markup:
    """A list; nothing when it would be empty."""
    kept = [tag("li", item) for item in items]
    return tag("ul", *kept) if kept else Markup("")


def table(heads: Sequence[str], rows: Sequence[Sequence[object]], marked: Sequence[bool] = ()) -> Markup:
    """A table; columns whose cells are numbers already formatted stay left, as names do. On a narrow screen its rows
    stand as blocks, each cell after its head."""
    if not rows:
        return Markup("")
    flags = marked or [False] * len(rows)
    body = [
        tag("tr", *(tag("td", c, data_head=h or None) for h, c in zip(heads, row, strict=True)), css=css)
        for row, css in zip(rows, ("named" if flag else None for flag in flags), strict=True)
    ]
    return tag("div", tag("table", tag("tr", *(tag("th", h) for h in heads), css="heads"), *body), css="scroll")


def _tile(value: str, label: str) -> Markup:
    return tag("div", tag("b", value), tag("span", label), css="tile")


def _one_of(sites: Sequence[str]) -> str:
    """All places of a set, or the first of them and how many more there are."""
    if len(sites) <= MOST_PLACES:
        return " or ".join(sites)
    return f"{' or '.join(sites[: MOST_PLACES - 1])} or {len(sites) - MOST_PLACES + 1} more"


def _place(report: Report, best: PlaceWeight) -> Markup:
    """The tile of the place: one, or the several that a set leaves open."""
    if report.verdict == "not_decidable":
        return _tile(best.site, f"leads with {weight(best.weight)} of the weight; the place is not decided")
    kinds, sites = undecided(report)
    if report.verdict == "unknown_physics" and len(report.where.likeliest) > 1:
        return _tile(_one_of(report.where.likeliest), "places that nothing tells apart")
    named = list(dict.fromkeys(c.site for c in report.causes if c.named))
    if len(named) > 1:
        return _tile(" and ".join(named), "places of the effects that are named")
    if report.verdict != "ambiguous" or not sites:
        alone = len(report.where.sites) == 1 and best.weight > 1.0 - 1e-9
        likeliest = f"most likely place, {weight(best.weight)} of the weight"
        return _tile(best.site, "place, of the parts in the machine file" if alone else likeliest)
    if len(sites) > 1:
        what = "" if len(kinds) == 1 else "; what it is is open too"
        return _tile(_one_of(sites), f"places that these recordings do not tell apart{what}")
    open_still = "it hangs on the speed" if on_the_speed(report) else "what it is is not decided"
    return _tile(sites[0], f"place, {weight(best.weight)} of the weight; {open_still}")


def head(report: Report) -> Markup:
    """Verdict, sentence, and the figures that matter."""
    word, tone = VERDICT[report.verdict]
    if report.verdict == "measurement_fault" and report.fault is not None and report.fault.doubtful:
        word, tone = PERHAPS
    tiles = []
    named = [c for c in report.causes if c.named]
    if report.fault is not None:
        where = ", ".join(channels(report.fault, report.measurement_faults)) or "the measurement"
        tiles.append(_tile(report.fault.kind.replace("_", " "), f"on {where}"))
    if report.where.sites:
        best = max(report.where.sites, key=lambda s: s.weight)
        tiles.append(_place(report, best))
    for c in named[:2]:
        if c.severity is not None:
            size, low, high = sizes(c.severity)
            if c.severity.low == 0.0:  # a bound is all that is known
                size, ends = f"at most {high}", "an upper bound"
            else:
                ends = f"90 %: {low} to {high}"
            tiles.append(_tile(size, f"{' of '.join(filter(None, (size_name(c), cause(c))))}, {ends}"))
    if report.held_out is not None:
        metric = report.held_out.metric.replace("_", " ")
        no_nearer = report.held_out.gain <= 0.0
        figure = "no nearer" if no_nearer else gains(report.held_out)[0]
        what = f"by {metric}, on data never fitted" if no_nearer else f"less {metric} on data never fitted"
        tiles.append(_tile(figure, what))
    return tag(
        "header",
        tag("span", word, css=f"badge {tone}"),
        tag("h1", tidied(report.sentence)),
        tag("p", f"{compared(report)} {LEVEL[report.level]}.", css="muted"),
        tag("p", tag("b", "What to do: "), to_do(report)),
        tag("div", *tiles, css="tiles") if tiles else None,
        css="told",
    )


def fault(report: Report) -> Markup:
    """What is wrong with the measurement: the fault that is the answer, and all that stand beside it or the answer."""
    if report.fault is None and not report.measurement_faults:
        return Markup("")
    faults = report.measurement_faults or ((report.fault,) if report.fault is not None else ())
    rows = [
        (
            f.kind.replace("_", " "),
            f.channel or "–",
            ", ".join(f.recordings) or "–",
            tidied(f.detail),
            "; ".join(
                words for words, holds in (("left out", f.left_out), ("or the machine's own", f.doubtful)) if holds
            )
            or "–",
        )
        for f in faults
    ]
    heads = ("fault", "channel", "recordings", "what was seen", "remark")
    return section("The measurement", told(table(heads, rows)))


def where_table(where: Where, causes: Sequence[Cause] = ()) -> Markup:
    """Changed lines as a table, and the limits of the location. Lines of a part that is named as struck come first, by
    frequency, and the others below a fold."""
    shown = sorted(where.lines, key=lambda x: -abs(x.change_db))[:MOST_LINES]
    own = sorted((x for x in shown if _of_the_named(x, causes)), key=lambda x: (x.speed_hz or 0.0, x.frequency_hz))
    others = [x for x in shown if x not in own]
    window = where.angle_window
    said = Markup("")
    if window is not None:
        text = f"{window.centre_deg:.0f}° of {window.shaft} (from {window.low_deg:.0f}° to {window.high_deg:.0f}°)"
        since = "from the tacho's pulse or, without one, from the first sample on"
        said = tag("p", f"The residual sits at {text}, {since}.")
    folded = Markup("")
    if own and others:
        many = f"{len(others)} other line{'s' if len(others) > 1 else ''} that changed"
        folded = tag("details", tag("summary", many), _lines(others))
    limits = bullets(where.limits)
    symbols = formula(SYMBOLS) if any("*f_" in x.label for x in shown) else Markup("")
    key = tag("p", Markup(CHANGE + symbols), css="muted") if shown else ""
    return Markup(said + _lines(own or others) + folded + key + (tag("h3", "Limits") + limits if limits else ""))


def _lines(shown: Sequence[LineChange]) -> Markup:
    points = any(x.speed_hz is not None for x in shown)
    heads = ("line", *(("operating point",) if points else ()), "Hz", "change, dB", "channel", "locked to")
    rows = [
        (
            Markup(", ".join(formula(y.label) for y in same)),
            *((operating_point(x.speed_hz, x.torque_ratio) or "–",) if points else ()),
            ", ".join(f"{y.frequency_hz:.5g}" for y in same),
            f"{x.change_db:+.1f}",
            x.channel or "–",
            formula(x.locked_to or "nothing known"),
        )
        for x, same in _together(shown)
    ]
    return table(heads, rows)


def _of_the_named(line: LineChange, causes: Sequence[Cause]) -> bool:
    """Whether a line may be of the part that a name says is struck."""
    words = set(re.findall(r"[\w-]+", line.locked_to))
    return any(c.named and c.site in words and not words.isdisjoint(STRUCK.get(c.term, ())) for c in causes)


def _together(lines: Sequence[LineChange]) -> list[tuple[LineChange, list[LineChange]]]:
    """Lines whose change was told for all of them at once, as that of a family is, beside the first of them."""
    groups: dict[object, list[LineChange]] = {}
    for x in lines:
        groups.setdefault((x.locked_to, x.channel, x.change_db, x.speed_hz, x.torque_ratio), []).append(x)
    return [(same[0], same) for same in groups.values()]


def causes_table(causes: Sequence[Cause], level: Level) -> Markup:
    """Candidates in order with their other forms; why a name was or was not given, once where it goes for most.

    From frequencies alone a score is the height of what was found, not evidence over nothing missing; its unit is said.
    """
    if not causes:
        return Markup("")
    often = Counter(reason for c in causes for reason in c.reasons)
    common = [r for r, n in often.items() if len(causes) > 1 and 2 * n > len(causes)]
    rest = leaves_a_part(causes)
    own = [[r for r in c.reasons if r not in common and not (rest and r.startswith(PART_LEFT))] for c in causes]
    heads = ["candidate", "score", "severity", "named", *(["why"] if any(own) else [])]
    rows = [
        (
            Markup(escaped(cause(c)) + (tag("div", forms(c), css="forms") if c.forms else "")),
            score(c.score),
            severity(c) or "–",
            "yes" if c.named else "no",
            *(["; ".join(why)] if any(own) else []),
        )
        for c, why in zip(causes, own, strict=True)
    ]
    left = tag("p", LEFT_OVER, css="note") if rest else Markup("")
    most = [r for r in common if not (rest and r.startswith(PART_LEFT))]
    lead = "For most of them" if any(c.named for c in causes) else "Why none is named"
    why = tag("p", f"{lead}: {'; '.join(most)}.") if most else Markup("")
    notes = [*score_notes(causes, level), *([FORMS] if any(c.forms for c in causes) else [])]
    return Markup(
        left + why + table(heads, rows, [c.named for c in causes]) + "".join(tag("p", n, css="muted") for n in notes)
    )


def simulated(report: Report) -> str:
    """How well the revised machine does when it is simulated, on the recordings it was fitted to."""
    found = next((s for s in report.stages if s.get("name") == "revised machine"), None)
    if found is None:
        return ""
    return (
        f"Simulated, it leaves {figure_text(float(str(found['left_of_it_db'])))} dB of the "
        f"{figure_text(float(str(found['level_change_db'])))} dB (root mean square) by which levels of lines and bands "
        f"changed in the recordings that were fitted; the spectra above show it.{_worse_than_held_out(report, found)}"
    )


def _worse_than_held_out(report: Report, found: Mapping[str, object]) -> str:
    """Why more is left of what was fitted than of what was not, where it is so."""
    held = report.held_out
    if held is None or held.unit != "dB" or not held.before > 0 or not float(str(found["level_change_db"])) > 0:
        return ""
    here = float(str(found["left_of_it_db"])) / float(str(found["level_change_db"]))
    there = held.after / held.before
    if here <= there:
        return ""
    return (
        f" That is {percent(here)} of it, where {percent(there)} were left on the held-out data above. The two are "
        "different measures: here levels of single lines and bands, simulated with the one set of numbers "
        f"of this file; there the {held.metric.replace('_', ' ')}. The held-out figure is the one that judges the name."
    )


def undecidable(report: Report) -> Markup:
    """What could not be decided, and the experiment that would."""
    parts = [bullets(report.undecidable)]
    if report.next_experiment is not None:
        parts += [tag("h3", "Next experiment"), tag("p", report.next_experiment.sentence)]
        parts += separation(report.next_experiment)
    return section("What is undecided, and what would decide it", told(*parts))


def separation(found: NextExperiment) -> list[Markup]:
    """How far the first two candidates are apart now, and are expected to be after the experiment."""
    now, then = found.separation_now, found.separation_expected
    if now is None:
        return []
    expected = "what is expected after the experiment is not known"
    if then is not None:
        expected = f"{then:.1f} ({_times(then)}) expected after the experiment, if the first is what is there"
    text = (
        f"Separation of the first two candidates: log evidence (natural logarithm) {now:.1f} now, by which the first "
        f"is {_times(now)} as likely as the second; {expected}."
    )
    return [tag("p", text, css="muted")]


def _times(evidence: float) -> str:
    """`2.7 times` of a log evidence of 1."""
    if evidence > math.log(MOST_TIMES):
        return f"more than {MOST_TIMES} times"
    return f"{figure_text(math.exp(evidence), digits=2)} times"
