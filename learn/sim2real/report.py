"""All ways of answering on all recordings, as tables and as one line of JSON."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass

from learn.gears.assess import CLASSES as GEAR_CLASSES
from learn.model import Model
from learn.real.load import Case
from learn.sim2real import tables
from learn.sim2real.answers import Answer, ByModel, Way, ask, ask_models, by_detector
from learn.sim2real.figures import controls, other_rigs, paired, pooled, rigs, stated_bearings
from learn.sim2real.fitted_rule import fitted_db, refitted
from learn.sim2real.gear_answers import gear_ways
from learn.sim2real.rivals import rivals_table
from learn.sim2real.severities import severity_pairs, severity_table
from sideband_datasets.recipe.bearings import CLASSES

GIVEN, NEAR = "speed and geometry given", "speed estimated near the stated one"
RIVAL = "classical detector (same information)"
FITTED = "classical detector, threshold fitted to windows"
UNKNOWN = "geometry unknown"
STATED = "bearings of stated size"
Ways = dict[str, list[Answer]]


@dataclass(frozen=True, kw_only=True)
class Results:
    """Tables in Markdown and the last line."""

    text: str
    line: str


@dataclass(frozen=True, kw_only=True)
class Asked:
    """Answers by name of the way: `ways` of all recordings, `alone` of bearings of known size; `unscored`: without a
    class; `rule_db`: the fitted threshold, if there is one."""

    ways: Ways
    alone: Ways
    unscored: list[Answer]
    rule_db: float | None


def report(
    model: Model, ablated: Mapping[str, Model], cases: Sequence[Case], *, seed: int, pool: Executor | None = None
) -> Results:
    """Everything. Recordings whose condition is none of the classes are answered and listed, and count nowhere."""
    asked = asked_all(model, ablated, cases, pool)
    known = [c for c in cases if c.orders is not None and c.label in CLASSES]
    return Results(text=text_of(asked, rivals_table(known, seed, pool)), line="SIM2REAL " + json.dumps(line_of(asked)))


def asked_all(model: Model, ablated: Mapping[str, Model], cases: Sequence[Case], pool: Executor | None) -> Asked:
    """All ways asked."""
    scored = [c for c in cases if c.label in (*CLASSES, *GEAR_CLASSES)]
    stages, bearings = [c for c in scored if c.teeth is not None], [c for c in scored if c.teeth is None]
    known, unsized = [c for c in bearings if c.orders is not None], [c for c in bearings if c.orders is None]
    given, near = ByModel(model=model), ByModel(model=model, speed="near")
    by_models = ask_models(known, {GIVEN: model, **ablated}, pool)
    alone: Ways = {GIVEN: by_models[GIVEN], RIVAL: ask(known, by_detector, pool=pool)}
    rule = fitted_db(alone[RIVAL])
    if rule is not None:
        alone[FITTED] = refitted(alone[RIVAL], rule)
    alone[NEAR] = ask(known, near, pool=pool)
    ways = {name: list(answers) for name, answers in alone.items()}
    gears = gear_ways(stages, model, pool)
    asking: tuple[Way, ...] = (given, by_detector, near)
    for name, way, more in zip((GIVEN, RIVAL, NEAR), asking, gears, strict=True):
        ways[name] += [*ask(unsized, way, pool=pool), *more]
    others: dict[str, tuple[Sequence[Case], Way, bool]] = {
        "speed estimated from nothing": (known, ByModel(model=model, speed="none"), False),
        UNKNOWN: (bearings, ByModel(model=model, geometry=False), True),
        f"{UNKNOWN}, {NEAR}": (bearings, ByModel(model=model, geometry=False, speed="near"), True),
    }
    ways |= {name: ask(which, way, windows=cut, pool=pool) for name, (which, way, cut) in others.items()}
    ways |= {f"smaller data set, {name}": by_models[name] for name in ablated}
    unscored = ask([c for c in cases if c not in scored], given, windows=False, pool=pool)
    return Asked(ways=ways, alone=alone, unscored=unscored, rule_db=rule)


def text_of(asked: Asked, rivals: str) -> str:
    """The tables."""
    ways, alone = asked.ways, asked.alone
    compared = {name: alone[name] for name in (GIVEN, RIVAL, FITTED) if name in alone}
    rows = {
        **ways,
        **{f"{name}, bearings of known size": answers for name, answers in alone.items() if name != FITTED},
    }
    for what, chosen in (
        ("bearings of known size, without the development rig", other_rigs),
        (STATED, stated_bearings),
    ):
        rows |= {f"{name}, {what}": some for name, answers in compared.items() if (some := chosen(answers))}
    parts = [
        tables.summary(rows, asked.rule_db),
        tables.by_rig("By rig, speed and geometry given:", {"": ways[GIVEN], "detector: ": ways[RIVAL]}),
        tables.inferred(ways[GIVEN]),
        tables.by_rig("Geometry unknown, by rig:", {"": ways[UNKNOWN]}),
        tables.by_class("Right of all by true class, bearings of known size:", alone),
        tables.paired_table(GIVEN, alone),
        rivals,
        tables.by_recording(ways),
        tables.failures(ways),
        tables.unscored(asked.unscored),
        "Confusion, windows, speed and geometry given (rows: truth):\n\n" + tables.confusion_table(ways[GIVEN]),
        severity_table(alone[GIVEN]),
    ]
    return "\n\n".join(part for part in parts if part)


def line_of(asked: Asked) -> dict[str, object]:
    """What the last line holds."""
    ways, alone = asked.ways, asked.alone
    main, detector, fitted = alone[GIVEN], alone[RIVAL], alone.get(FITTED, [])
    line: dict[str, object] = {
        "rigs": rigs(ways[GIVEN]),
        "detector": rigs(ways[RIVAL]),
        "controls": controls(ways[GIVEN]),
        "controls_detector": controls(ways[RIVAL]),
        "pooled": pooled(ways[GIVEN]),
        "pooled_detector": pooled(ways[RIVAL]),
        "pooled_bearings": pooled(main),
        "pooled_detector_bearings": pooled(detector),
        "pooled_other_rigs": {"model": pooled(other_rigs(main)), "detector": pooled(other_rigs(detector))},
        "pooled_stated_bearings": {
            "model": pooled(stated_bearings(main)),
            "detector": pooled(stated_bearings(detector)),
        },
        "geometry_unknown": rigs(ways[UNKNOWN]) | {"pooled": pooled(ways[UNKNOWN])},
        "speed_estimated": pooled(ways[NEAR]),
        "speed_estimated_bearings": pooled(alone[NEAR]),
        "paired": [paired(main, detector, kind) for kind in ("recording", "window")],
        "severity": severity_pairs(main),
    }
    if fitted:
        line["detector_fitted"] = {
            "rule_db": round(asked.rule_db or 0.0, 2),
            **rigs(fitted),
            "pooled": pooled(fitted),
            "pooled_other_rigs": pooled(other_rigs(fitted)),
            "pooled_stated_bearings": pooled(stated_bearings(fitted)),
            "paired": paired([a for a in main if a.unit.window is not None], fitted, "window"),
        }
    return line
