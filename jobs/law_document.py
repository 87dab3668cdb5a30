"""The law of an effect as pictures: curves over displacement, velocity or angle, with it and without. Plain JSON."""

from __future__ import annotations

from jobs.demonstration import Demonstration, demonstration
from jobs.documents import FloatArray
from sim.assembly.assemble import BASE_TERMS, BUILT_IN
from sim.core.terms import Term
from sim.solve.law_picture import Curve, Panel, built_in_picture, law_picture


def law_document(term: Term) -> dict[str, object]:
    """The document: where the effect acts, its values, and the panels, all SI.

    `without` is None for an effect that every machine has. Curves hold at most 2048 points; they are not thinned.
    """
    shown = demonstration(term)
    return {
        "key": term.key,
        "machine": term.demo.machine,
        "site": shown.site,
        "values": dict(shown.values),
        "panels": [_panel(panel) for panel in panels(term, shown)],
    }


def panels(term: Term, shown: Demonstration) -> tuple[Panel, ...]:
    """What the effect changes on the machine that demonstrates it."""
    if term.key not in BUILT_IN:
        return law_picture(shown.machine, shown.without, site=shown.site)
    kind = next((kind for kind, keys in BASE_TERMS.items() if term.key in keys), "load")
    return built_in_picture(shown.machine, kind)


def _panel(panel: Panel) -> dict[str, object]:
    return {
        "title": panel.title,
        "caption": panel.caption,
        "x": {"label": panel.x.label, "unit": panel.x.unit, "values": _numbers(panel.values)},
        "y": {"label": panel.y.label, "unit": panel.y.unit},
        "curves": [_curve(curve) for curve in panel.curves],
    }


def _curve(curve: Curve) -> dict[str, object]:
    without = None if curve.without is None else _numbers(curve.without)
    return {"name": curve.name, "with": _numbers(curve.here), "without": without}


def _numbers(values: FloatArray) -> list[float]:
    return [float(f"{value:.6g}") for value in values]
