"""Made rigs: the same seed makes the same case, what is hidden is there, and answers are counted as they are worth."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any

import numpy as np
import pytest

from proof.made.__main__ import ANSWERS, made, page, worth
from proof.made.rigs import KINDS, bearing
from proof.made.signals import Hidden
from reconcile.kinematics import read_kinematic_spec

Report = Mapping[str, Any]


@cache
def case(kind: str, seed: int) -> Any:
    """A case that several tests look at; its records cannot be written."""
    found = made(kind, seed)
    for record in found[2:]:
        record.flags.writeable = False
    return found


def test_a_case_is_that_of_its_seed() -> None:
    for kind in KINDS:
        one, again, other = case(kind, 3), made(kind, 3), case(kind, 4)
        assert one[0].drawing() == again[0].drawing() != other[0].drawing()
        assert np.array_equal(one[3], again[3]) and one[1] == again[1]


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_drawings_can_be_read_and_records_are_whole(seed: int) -> None:
    for kind in KINDS:
        rig, _, baseline, test = case(kind, seed)
        spec = read_kinematic_spec(rig.drawing())
        assert tuple(s.name for s in spec.shafts) == rig.shafts
        assert len(spec.meshes) == len(rig.teeth) and len(spec.bearings) == len(rig.bearings)
        assert baseline.shape == test.shape == (rig.sensors, int(rig.rate_hz * rig.seconds))
        assert np.isfinite(test).all() and np.std(test, axis=1).min() > 0.0


@pytest.mark.parametrize("ratio", np.linspace(0.16, 0.26, 21))
def test_every_bearing_that_may_be_drawn_can_be_built(ratio: float) -> None:
    for balls in range(7, 13):
        drawn = bearing(1, 0, balls=balls, ratio=round(float(ratio), 4))
        shafts = [{"name": "rotor", "speed_hz": 30.0}]
        given = [{"name": drawn.name, "shaft": "rotor", "balls": drawn.balls, "diameter_ratio": drawn.ratio}]
        read_kinematic_spec({"kinematics": {"shafts": shafts, "bearings": given}})
        assert drawn.balls == balls or (drawn.balls == balls - 1 and ratio > 0.25)


@pytest.mark.slow
def test_a_pit_strikes_and_a_load_is_louder() -> None:
    found = {}
    for kind in KINDS:
        for seed in range(8):
            _, what, baseline, test = case(kind, seed)
            found.setdefault(what.word, []).append(
                (float(np.max(np.abs(test)) / np.max(np.abs(baseline))), float(np.std(test) / np.std(baseline)))
            )
    assert set(found) == {"nothing", "outer", "inner", "ball", "tooth", "load"}
    assert max(row[0] for row in found["outer"]) > 1.5
    assert all(row[1] > 1.1 for row in found["load"]) and all(0.8 < row[1] < 1.25 for row in found["nothing"])


def said(verdict: str, *causes: tuple[str, str]) -> Report:
    """A report."""
    return {"verdict": verdict, "causes": [{"term": t, "site": s} for t, s in causes], "sentence": "so"}


PIT = Hidden(word="inner", site="bearing2")
TOOTH = Hidden(word="tooth", site="wheel1")
SET = [("missing_tooth", "wheel1"), ("tooth_crack", "wheel1"), ("tooth_spall", "wheel1")]


@pytest.mark.parametrize(
    ("what", "report", "answer"),
    [
        (PIT, said("explained", ("inner_spall", "bearing2")), "right"),
        (PIT, said("ambiguous", ("inner_spall", "bearing2"), ("inner_spall", "bearing1")), "among others"),
        (PIT, said("ambiguous", ("inner_spall", "bearing2"), ("ball_spall", "bearing2")), "among others"),
        (PIT, said("explained", ("outer_spall", "bearing2")), "elsewhere"),
        (PIT, said("nothing_missing"), "quiet"),
        (PIT, None, "failed"),
        (TOOTH, said("ambiguous", *SET), "right"),
        (TOOTH, said("ambiguous", *SET, ("rub", "output")), "right"),
        (TOOTH, said("ambiguous", *SET, ("tooth_crack", "pinion1")), "among others"),
        (Hidden(word="nothing"), said("nothing_missing"), "quiet"),
        (Hidden(word="load"), said("ambiguous", ("rub", "input")), "an alarm"),
        (Hidden(word="load"), said("measurement_fault"), "an alarm"),
    ],
)
def test_answers_are_counted_as_they_are_worth(what: Hidden, report: Report | None, answer: str) -> None:
    assert worth(what, report) == answer and answer in ANSWERS


def test_the_page_counts_every_answer_and_lists_what_is_wrong() -> None:
    rows = {("motor", "outer", "right"): 2, ("motor", "outer", "elsewhere"): 1, ("gearbox", "load", "quiet"): 3}
    text = page(rows, ["* motor 7, outer bearing1 (3), elsewhere: so"], 5, 3, alone=True)
    assert "| motor | outer | 3 | 2 |  | 1 |  |  |  |" in text and "| gearbox | load | 3 |" in text
    assert "* motor 7" in text and "--first 5 --count 3 --alone" in text
