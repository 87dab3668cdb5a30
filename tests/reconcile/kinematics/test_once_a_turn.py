"""What strikes once a turn of a shaft: the same places in the causes, the shares, the tile, and what is to be done."""

from __future__ import annotations

import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.kinematics import turning
from reconcile.kinematics.families import Ties
from reconcile.kinematics.tooth_turn import ToothTurn, with_sidebands
from reconcile.observe.tooth_place import ToothPlace
from reconcile.observe.whole_turn import WholeTurn
from reconcile.report.action import to_do
from reconcile.report.page import page
from reconcile.verdict import Report

TIES = Ties(
    reference="input",
    shafts={"input": 1.0, "output": 21 / 64},
    families=(),
    meshes=(("mesh1", 21.0, ("input", "output"), ("pinion", "wheel")),),
    races={},
)
CARRIED = ("drive_end", "fan_end")
WITH_GEAR = ["input", "drive_end", "fan_end", "pinion"]


def struck(ties: Ties, carried: tuple[str, ...], monkeypatch: pytest.MonkeyPatch) -> Report:
    monkeypatch.setattr(turning, "lines_of", lambda *_: ())
    candidate = SimpleNamespace(family=SimpleNamespace(site="input"), z=41.0)
    found = turning.turn_report(candidate, ties, [], [], carried)  # type: ignore[arg-type]
    flat = WholeTurn(windows=np.ones(100), teeth=21, turns=99)
    place = ToothPlace(shaft="input", standing=0.5, strongest=flat, start_turns=0.0)
    return with_sidebands(found, [ToothTurn(gear="pinion", shaft="input", place=place, grown=1.0, tests=1)], [])


def test_the_gear_is_one_of_the_places_everywhere(monkeypatch: pytest.MonkeyPatch) -> None:
    report = struck(TIES, CARRIED, monkeypatch)
    assert list(dict.fromkeys(c.site for c in report.causes)) == WITH_GEAR
    assert {w.site: w.weight for w in report.where.sites} == dict.fromkeys(WITH_GEAR, 0.25)
    assert list(report.where.likeliest) == WITH_GEAR
    text = page(report)
    assert "<b>input or drive_end or fan_end or pinion</b>" in text
    assert re.findall(r"<li>(\w+): 25 % of the weight</li>", text) == WITH_GEAR
    todo = to_do(report)
    assert todo.startswith(
        "plan to inspect what turns with input: the teeth of pinion first, then input itself, drive_end and fan_end; "
        "which of them it is stays open."
    )
    assert "Record with a tacho" in todo


def test_more_places_than_a_tile_holds_are_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    report = struck(TIES, (*CARRIED, "middle"), monkeypatch)
    assert "<b>input or drive_end or fan_end or 2 more</b>" in page(report)


def test_a_shaft_without_gears_and_one_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    bare = replace(TIES, meshes=())
    todo = to_do(struck(bare, CARRIED, monkeypatch))
    assert todo.startswith("plan to inspect what turns with input: input itself, drive_end and fan_end; which")
    alone = struck(bare, (), monkeypatch)
    assert [(w.site, w.weight) for w in alone.where.sites] == [("input", 1.0)]
    assert to_do(alone).startswith("plan to inspect input; ")
