"""The page: one HTML file with its pictures in it, nothing fetched from elsewhere, no scripts.

What is `told` the dashboard leaves out, as it has words and tables of its own.
"""

from __future__ import annotations

import json

from reconcile.report.faintest import faintest
from reconcile.report.figures.bars import changes, ranking
from reconcile.report.figures.envelope import beside, caption, envelope, marked
from reconcile.report.figures.force_lines import by_lines
from reconcile.report.figures.gains import distances, gains
from reconcile.report.figures.law import from_force, law, law_words, one_axis
from reconcile.report.figures.maps import force_map, map_words
from reconcile.report.figures.mean_turn import mean_turn, turn_words
from reconcile.report.figures.path import path
from reconcile.report.figures.sketch import sketch
from reconcile.report.figures.spectrum import in_third_octaves
from reconcile.report.figures.traces import trace
from reconcile.report.heard import against_places
from reconcile.report.held import held_out_table, held_out_words
from reconcile.report.markup import Markup, figure_text, tag
from reconcile.report.named import cause, changed_or_added
from reconcile.report.overall import overall
from reconcile.report.panels import spectra, turns
from reconcile.report.pictures import numbers, several, text
from reconcile.report.provenance import provenance
from reconcile.report.revised import note
from reconcile.report.sections import (
    bullets,
    causes_table,
    fault,
    head,
    section,
    simulated,
    told,
    undecidable,
    where_table,
)
from reconcile.report.steps import stages
from reconcile.report.strict import plain
from reconcile.report.style import STYLE
from reconcile.report.words import LAWS, tidied, weight
from reconcile.verdict import Report

NEVER_FITTED = "Improvement on data never fitted"
FITTED = f"These recordings were fitted; how the model does on others stands under “{NEVER_FITTED}”."


def _key(before: str = "model without it", after: str | None = "with it") -> Markup:
    names = (("observed", "measured"), ("before", before), *((("after", after),) if after else ()))
    return tag("div", *(tag("span", tag("i", css=f"k-{css}"), words) for css, words in names), css="key")


def _where(report: Report) -> Markup:
    machine = plain(report.machine)
    weights = {p.site: p.weight for p in report.where.sites}
    drawing = sketch(machine, weights) if isinstance(machine, dict) else Markup("")
    sites = bullets(f"{p.site}: {weight(p.weight)} of the weight" for p in report.where.sites)
    return section("Where", drawing, told(sites, where_table(report.where, report.causes)))


def _reference(report: Report) -> str:
    """What the spectra are held against."""
    modes = {stage.get("mode") for stage in report.stages}
    if report.level == "driven" or "B" in modes:
        return "the model"
    return "the baseline" if "A" in modes else "the baseline, or the model where there is none"


def _spectra(report: Report) -> Markup:
    drawn = several(report.pictures, "spectra")
    if not drawn:
        return Markup("")
    thirds = all(in_third_octaves(numbers(p.get("frequency_hz"))) for p in drawn)
    title = "Third-octave spectra" if thirds else "Spectra"
    note = tag("p", THIRDS, css="muted") if thirds else Markup("")
    reference = _reference(report)
    if report.verdict == "nothing_missing" or all(p.get("after_db") == p.get("before_db") for p in drawn):
        # nothing is added to the reference
        bare = [{k: v for k, v in p.items() if k != "after_db"} for p in drawn]
        return section(title, note, _key(reference, None), spectra(bare, report.where.lines))
    fitted = tag("p", FITTED, css="muted") if report.level == "machine" and report.held_out is not None else Markup("")
    return section(title, fitted, note, _key(f"without it: {reference}"), spectra(drawn, report.where.lines))


def _envelope(report: Report) -> Markup:
    drawn = [p for p in several(report.pictures, "envelope") if envelope(p)]
    if not drawn:
        return Markup("")
    names = [("observed", "test"), *([("before", "baseline")] if any("baseline" in p for p in drawn) else [])]
    key = tag("div", *(tag("span", tag("i", css=f"k-{css}"), words) for css, words in names), css="key")
    ticks = ", ticks on the upper edge: its sidebands" if any(beside(p) for p in drawn) else ""
    note = f"Violet: harmonics of that family{ticks}. Grey: first lines of other parts."
    told_of = tag("p", note, css="muted") if any(marked(p) for p in drawn) else Markup("")
    panels = [Markup(tag("p", caption(p), css="muted") + key + envelope(p)) for p in drawn]
    return section("Envelope over orders", *panels, told_of)


def _mean_turn(report: Report) -> Markup:
    drawn = [p for p in several(report.pictures, "mean_turn") if p.get("test_db")]
    panels = []
    for p in drawn:
        names = [("observed", "test"), *([("before", "baseline")] if "baseline_db" in p else [])]
        key = tag("div", *(tag("span", tag("i", css=f"k-{css}"), words) for css, words in names), css="key")
        panels.append(Markup(tag("p", turn_words(p), css="muted") + key + mean_turn(p, report.where.angle_window)))
    return section("Over the turn of a gear", *panels) if panels else Markup("")


def _maps(report: Report) -> Markup:
    drawn = turns(several(report.pictures, "heat"), report.where.angle_window)
    if not drawn:
        return Markup("")
    angles = "Angles count from the tacho's pulse or, without one, from the first sample on."
    note = f"{angles} Red: more than the mean, blue: less."
    window = report.where.angle_window
    bar = " Bar along the upper edge: the window where the residual sits." if window is not None else ""
    return section("Over the turn of a shaft", tag("p", note + bar, css="muted"), drawn)


def _ranking(report: Report) -> Markup:
    drawn = several(report.pictures, "ranking")
    table = told(causes_table(report.causes, report.level))
    return section("What explains it", ranking(drawn) if drawn else Markup(""), table, against_places(report))


def _changes(report: Report) -> Markup:
    drawn = several(report.pictures, "changes")
    if not drawn:
        return Markup("")
    note = "Dot: observed. Grey: what nothing missing would give (90 %). Bar: what the answer gives."
    return section("Features that changed", tag("p", note, css="muted"), changes(drawn))


def _held_out(report: Report) -> Markup:
    found, drawn = report.held_out, several(report.pictures, "traces")
    added = found is not None or any(p.get("before") != p.get("after") for p in drawn)
    names = ("predicted without it", "predicted with it") if added else ("predicted by the model", None)
    kept = drawn if added else [{k: v for k, v in p.items() if k != "after"} for p in drawn]
    panels = [Markup(tag("h3", text(p.get("title"))) + trace(p)) for p in kept]
    key = _key(*names) if panels else Markup("")
    bars = Markup("")
    if found is not None:
        best = report.causes[0] if report.causes and report.verdict in ("explained", "ambiguous") else None
        subject = "what was found" if best is None else changed_or_added(best)
        if len(found.effects) > 1:
            subject = " and ".join(cause(c) for c in report.causes[:2])
        bars = Markup(distances(found, subject) + gains(found, subject))
    title = "Measured and predicted" if found is None else NEVER_FITTED
    return section(title, held_out_words(found), bars, told(held_out_table(found)), key, *panels)


def _force(report: Report) -> Markup:
    found = report.force
    if report.level == "driven" and (found is None or report.verdict == "measurement_fault"):
        return Markup("")  # what is left of a linear model is noise then, or the fault
    laws, planes = several(report.pictures, "law"), several(report.pictures, "force_map")
    if found is not None and not laws and (own := from_force(found)) is not None:
        laws = [own]
    ends = one_axis(laws, planes)
    drawn = [Markup(law_words(p) + law(p, ends)) for p in laws]
    maps = [Markup(map_words(p) + force_map(p, ends)) for p in planes]
    if found is None:
        return section("Estimated force", *drawn, *maps)
    said = f"At {found.site}: " + (f"law {found.law}." if found.law else "no law is named.")
    units = {c.severity.name: c.severity.unit for c in report.causes if c.severity is not None}
    terms = bullets(
        f"{LAWS.get(name, name.replace('_', ' '))}: {figure_text(value, units.get(name, ''), digits=4)}"
        for name, value in found.coefficients.items()
    )
    work = Markup("")
    if found.work_per_cycle_j is not None:
        work = tag("p", f"Work per cycle {figure_text(found.work_per_cycle_j)} J.", css="muted")
    remarks = bullets(found.remarks)
    return section("Estimated force", told(tag("p", said), terms, work, remarks), by_lines(found), *drawn, *maps)


def _machine(report: Report) -> Markup:
    if report.machine is None:
        return Markup("")
    spec = json.dumps(plain(report.machine), allow_nan=False, ensure_ascii=False, indent=1)
    body = tag("details", tag("summary", "Revised machine (JSON)"), tag("pre", spec))
    said = tag("p", note(report), css="muted")
    return section("Revised machine", said, told(tag("p", simulated(report)), body), _paths(report))


def _paths(report: Report) -> Markup:
    drawn = several(report.pictures, "paths")[:MOST_PATHS]
    if not drawn:
        return Markup("")
    note = "A spectrum of the simulated machine is recorded higher by so much: add it before comparing levels."
    panels = [Markup(tag("h3", text(p.get("channel"))) + path(p)) for p in drawn]
    return tag("details", tag("summary", "Paths to the sensors"), tag("p", note, css="muted"), *panels)


MOST_PATHS = 40
THIRDS = (
    "Power of a channel within each third of an octave, in dB over its unit squared: single lines are not told apart. "
    "Ticks on the upper edge: single lines that changed."
)


def page(report: Report) -> str:
    """The text of `report.html`."""
    body = (
        head(report),
        fault(report),
        _where(report),
        overall(report),
        _ranking(report),
        _held_out(report),
        _force(report),
        _spectra(report),
        _envelope(report),
        _mean_turn(report),
        _maps(report),
        _changes(report),
        undecidable(report),
        faintest(report),
        _machine(report),
        stages(report),
        provenance(report),
    )
    top = tag(
        "head",
        tag("meta", charset="utf-8"),
        tag("meta", name="viewport", content="width=device-width, initial-scale=1"),
        tag("title", f"Reconciliation: {tidied(report.sentence)}"),
        tag("style", Markup(STYLE)),
    )
    return "<!doctype html>\n" + tag("html", top, tag("body", tag("main", *body)), lang="en") + "\n"
