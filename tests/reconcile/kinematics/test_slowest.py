"""Of a short recording the part is told whose lines it is short for, and only where it plays a role."""

from __future__ import annotations

from dataclasses import replace

import pytest

from reconcile.gate.findings import Finding, Gate
from reconcile.gate.timing import length_findings
from reconcile.kinematics import read_kinematic_spec
from reconcile.kinematics.families import ties
from reconcile.kinematics.observe import observe
from reconcile.kinematics.slowest import (
    MIN_TURNS,
    longer,
    needed_for,
    short_limits,
    shortest_s,
    with_slowest,
    without_short,
)
from reconcile.verdict import Cause, Report
from sim.core.errors import SpecError
from tests.strategies.brief import RATE_HZ, SPEED_HZ, N, recorded, sound

TIE = ties(
    read_kinematic_spec(
        {
            "kinematics": {
                "shafts": [{"name": "input", "speed_hz": SPEED_HZ}, {"name": "output", "speed_hz": SPEED_HZ / 3}],
                "bearings": [
                    {"name": "drive_end", "shaft": "input", "catalogue": "6205"},
                    {"name": "out_near", "shaft": "output", "catalogue": "6205"},
                ],
            }
        }
    )
)
REPORT = Report(verdict="nothing_missing", sentence="Nothing.", level="kinematics")
OTHER = Finding(kind="clipped", channel="a0", recording="test 1", detail="cut off", severity=0.5, fault=True)


def gate() -> Gate:
    one = recorded(sound(1)[: N // 8])
    short = length_findings(one, "test 1", SPEED_HZ, TIE.lowest_order)
    assert short
    found = Gate(findings=(OTHER, *short), baselines=(), tests=(one,), fault=None, usable=True)
    return with_slowest(found, TIE)


def named(site: str) -> Report:
    cause = Cause(term="outer_spall", site=site, score=9.0, named=True)
    return replace(REPORT, verdict="explained", causes=(cause, replace(cause, site="x", named=False)))


def test_the_part_is_told() -> None:
    (said,) = short_limits(gate(), REPORT)
    assert "turns of the cage of out_near (order 0.133)" in said and said.startswith("test 1: ")


def test_it_is_left_out_beside_another_parts_name() -> None:
    assert short_limits(gate(), named("drive_end")) == ()
    assert len(short_limits(gate(), named("out_near"))) == 1


def test_the_rest_of_the_gate_stays() -> None:
    assert without_short(gate()).findings == (OTHER,)


def test_how_long_to_record_is_the_longer_of_what_the_shaft_and_the_slowest_part_need() -> None:
    assert needed_for(TIE, 10.0) == "15.1 s (20 turns of the cage of out_near)"
    alone = replace(TIE, families=(), shafts={"input": 1.7})
    assert needed_for(alone, 10.0) == "1.2 s (12 turns of input)"
    short = recorded(sound(1)[: N // 100])
    advice = longer([recorded(sound(1)), short], TIE, None)
    assert advice is not None and advice.sentence == f"Record at least {needed_for(TIE, SPEED_HZ)}."
    assert longer([recorded(sound(1))], TIE, None) is None
    silent = replace(short, operating=None, tacho=None)
    assert longer([silent], TIE, None) is None and longer([silent], TIE, SPEED_HZ) == advice


@pytest.mark.parametrize("turns", [1.5, 4.2, 11.9])
def test_the_turns_that_are_needed_are_told_at_once_with_the_seconds(turns: float) -> None:
    """However short: nothing shorter is named that would not do either."""
    count = round(turns / SPEED_HZ * RATE_HZ)
    with pytest.raises(SpecError) as caught:
        observe(recorded(sound(1)[:count]), TIE, "test 1", stated_hz=None, seed=0)
    (told,) = caught.value.problems
    assert f" s, {turns:.3g} turns" in str(told.given) and "hold too few turns of input" in told.message
    least = f"at least 12 turns, {shortest_s(SPEED_HZ):g} s at {SPEED_HZ:.4g} Hz; better "
    assert told.allowed == least + needed_for(TIE, SPEED_HZ)


@pytest.mark.parametrize("speed_hz", [0.0, -24.3])
def test_a_speed_that_is_none_is_refused_as_such_and_not_as_too_few_turns(speed_hz: float) -> None:
    still = recorded(sound(1))
    assert still.operating is not None
    with pytest.raises(SpecError, match=r"operating\.speed_hz: is needed where there is no tacho"):
        observe(
            replace(still, operating=replace(still.operating, speed_hz=speed_hz)), TIE, "test 1", stated_hz=None, seed=0
        )


@pytest.mark.parametrize("speed_hz", [0.7, 10.0, 24.3, 29.93, 500.0])
def test_the_shortest_is_long_enough_and_hardly_longer(speed_hz: float) -> None:
    assert MIN_TURNS <= shortest_s(speed_hz) * speed_hz * (1 + 1e-9) <= 1.1 * MIN_TURNS
