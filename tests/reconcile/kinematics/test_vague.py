"""Impacts once a turn, with or without an order of no part beside them."""

from __future__ import annotations

import re
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from reconcile.kinematics.gears import GearEvidence, of_own_lines
from reconcile.kinematics.vague import gear_report
from tests.strategies.impulses import RATE_HZ, SPEED_HZ, N, recorded, sound, train

SHAFT = {"name": "shaft"}
SIZES = {"ball_diameter_m": 0.00794, "pitch_diameter_m": 0.03904}
TRUE_INNER = 5.4152
"""Of the nine balls that turn."""


def spec(balls: int):  # type: ignore[no-untyped-def]
    bearing = {"name": "bearing1", "shaft": "shaft", "balls": balls, **SIZES}
    return read_kinematic_spec({"kinematics": {"shafts": [SHAFT], "bearings": [bearing]}})


@pytest.mark.slow
def test_an_inner_race_of_other_numbers_is_told_beside_the_turn_it_is_loaded_with() -> None:
    rng = np.random.default_rng(5)
    struck = recorded(sound(2) + train(rng, 0.992 * TRUE_INNER, 1.0, load=0.8) + train(rng, 1.0, 1.6))
    report = reconcile_kinematics(spec(8), [struck], [recorded(sound(1))], seed=3)
    assert report.verdict == "ambiguous" and "Impacts once a turn of shaft" in report.sentence
    assert (
        re.search(r"Impacts 5\.3[67]\d times a turn", report.sentence)
        and "order of no part of the specification" in report.sentence
    )
    assert "whether the bearings' numbers are those of the machine" in report.undecidable
    assert report.next_experiment is not None and "Check the bearing sizes" in report.next_experiment.sentence


@pytest.mark.slow
def test_a_turn_alone_has_nothing_beside_it() -> None:
    knocked = recorded(sound(2) + train(np.random.default_rng(5), 1.0, 1.6))
    report = reconcile_kinematics(spec(8), [knocked], [recorded(sound(1))], seed=3)
    assert "Impacts once a turn of shaft" in report.sentence and "no part of the specification" not in report.sentence
    assert "own line" not in report.sentence and "unbalance" not in {c.term for c in report.causes}
    assert report.next_experiment is not None and "Record with a tacho" in report.next_experiment.sentence


@pytest.mark.slow
def test_a_bearing_that_the_file_lacks_is_one_of_what_strikes_once_a_turn() -> None:
    """Of a machine without bearings no bearing's lines can be looked for."""
    bare = read_kinematic_spec({"kinematics": {"shafts": [SHAFT]}})
    knocked = recorded(sound(2) + train(np.random.default_rng(5), 1.0, 1.6))
    report = reconcile_kinematics(bare, [knocked], [recorded(sound(1))], seed=3)
    assert [(c.term, c.site) for c in report.causes][-1] == ("inner_spall", "shaft")
    assert report.causes[-1].score < report.causes[0].score
    assert any("the file has none there" in text for text in report.undecidable)


@pytest.mark.slow
def test_an_unbalance_is_one_of_what_strikes_once_a_turn_where_its_line_grew() -> None:
    line = 3.0 * np.sin(2.0 * np.pi * SPEED_HZ * np.arange(N) / RATE_HZ)
    knocked = recorded(sound(2) + line + train(np.random.default_rng(5), 1.0, 1.6))
    report = reconcile_kinematics(spec(9), [knocked], [recorded(sound(1))], seed=3)
    assert "Impacts once a turn of shaft" in report.sentence and "The turn's own line grew by" in report.sentence
    assert [(c.term, c.site) for c in report.causes[:2]] == [("unbalance", "shaft"), ("bent_shaft", "shaft")]


@pytest.mark.slow
@pytest.mark.parametrize(("balls", "told"), [(8, True), (9, False)])
def test_an_outer_race_of_other_numbers_strikes_at_an_order_of_no_part(balls: int, told: bool) -> None:
    """A second bearing brings orders whose halves and sidebands would cover this one, but none of them is heard."""
    document = {
        "shafts": [SHAFT],
        "bearings": [
            {"name": "bearing1", "shaft": "shaft", "balls": balls, **SIZES},
            {"name": "bearing2", "shaft": "shaft", "catalogue": "6203"},
        ],
    }
    struck = recorded(sound(2) + train(np.random.default_rng(6), 3.5848, 1.0))
    known = read_kinematic_spec({"kinematics": document})
    report = reconcile_kinematics(known, [struck], [recorded(sound(1))], seed=3)
    assert (report.verdict == "unknown_physics") is told
    assert bool(re.search(r"Impacts 3\.5[89]\d? times a turn", report.sentence)) is told
    if not told:
        assert [(c.term, c.site) for c in report.causes] == [("outer_spall", "bearing1")]


@pytest.mark.slow
@pytest.mark.parametrize(("balls", "ratio", "order", "height"), [(9, 0.2455, 6.599, 1.0), (9, 0.2455, 4.61, 2.0)])
def test_a_sideband_of_a_stranger_is_no_race(balls: int, ratio: float, order: float, height: float) -> None:
    """An inner race that the file has not, one turn above or below one that it has."""
    bearing = {"name": "b", "shaft": "shaft", "balls": balls, "diameter_ratio": ratio}
    known = read_kinematic_spec({"kinematics": {"shafts": [SHAFT], "bearings": [bearing]}})
    for seed in range(3):
        hits = train(np.random.default_rng(100 + seed), order, height, zone=True)
        report = reconcile_kinematics(known, [recorded(sound(2 + seed) + hits)], [recorded(sound(50 + seed))], seed=3)
        assert not any(c.named for c in report.causes), report.sentence


def grew(
    gear: str, growth_db: float, own_db: float, *, mesh: str = "mesh1", shaft: str = "", lines: int = 20
) -> GearEvidence:
    """Sidebands of a gear that grew."""
    return GearEvidence(
        mesh=mesh, shaft=shaft or gear, gear=gear, channel="a0", growth_db=growth_db, error_db=0.5, mesh_growth_db=0.0,
        lines=lines, window=None, label="test 1", contrast_db=10.0, multiples=5, own_db=own_db,
    )  # fmt: skip


def test_of_two_gears_the_one_whose_own_lines_grew_has_the_fault() -> None:
    wheel, pinion = grew("wheel", 10.0, 1.0), grew("pinion", 9.0, 8.0)
    assert of_own_lines([wheel, pinion]) == [pinion]
    assert of_own_lines([wheel, grew("pinion", 9.0, float("nan"))]) != [wheel], "of which nothing tells, stays"
    both = [grew("wheel", 10.0, 7.0), pinion]
    assert of_own_lines(both) == both


def test_gears_of_one_shaft_that_both_grew_are_one_set() -> None:
    """Multiples of one shaft surround the lines of both its meshes."""
    test = SimpleNamespace(label="test 1", speed=SimpleNamespace(speed_hz=25.0))
    first = grew("p2", 13.0, 13.0, mesh="mesh2", shaft="mid")
    twin = grew("w1", 9.0, 9.0, mesh="mesh1", shaft="mid")
    faint = grew("w1", 9.0, 9.0, mesh="mesh1", shaft="mid", lines=2)
    other = grew("p1", 12.0, 12.0, mesh="mesh1", shaft="in")
    report = gear_report([first, twin, other], [test])  # type: ignore[list-item]
    assert {c.site for c in report.causes} == {"p2", "w1"} and report.causes[0].site == "p2"
    assert "on p2 or w1" in report.sentence
    alone = gear_report([first, faint, other], [test])  # type: ignore[list-item]
    assert {c.site for c in alone.causes} == {"p2"}
    assert "whether it is w1, which turns with p2" in alone.undecidable
    assert not any("turns with" in text for text in report.undecidable)
