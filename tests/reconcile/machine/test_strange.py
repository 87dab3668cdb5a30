"""What modulates the teeth and is of no known part is the answer where nothing sure speaks for another one."""

from __future__ import annotations

from dataclasses import replace

import pytest

from reconcile.machine.own_order import OwnOrder
from reconcile.machine.own_time import OwnTime
from reconcile.machine.strange import explained_by, with_strange
from reconcile.report.action import to_do
from reconcile.verdict import Cause, EstimatedForce, HeldOut, Report, SensorFault, Where, Word
from sim.core.spec import MachineSpec
from sim.presets import preset


@pytest.fixture(scope="module")
def machine() -> MachineSpec:
    return preset("paper-lightly-damped")


SEEN = OwnTime(hz=100.1, rise_db=5.0, elsewhere_db=0.3)


def said(verdict: Word, score: float = 5.0, fault: SensorFault | None = None) -> Report:
    causes = (Cause(term="outer_spall", site="bearing1", score=score, named=verdict == "explained"),)
    held = HeldOut(
        metric="m",
        unit="dB",
        before=2.0,
        after=1.0,
        gain=0.5,
        gain_low=0.4,
        gain_high=0.6,
        retuned=None,
        black_box=None,
        placebo=None,
    )
    return Report(
        verdict=verdict, sentence="so.", level="machine", causes=causes, fault=fault, where=Where(), held_out=held
    )


LAW = EstimatedForce(site="bearing3", samples={}, law="1e9 N/m^3 * z^3 on both axes")
HUM, LOOSE = SensorFault(kind="mains_hum", channel="a"), SensorFault(kind="loose_sensor", channel="a")


@pytest.mark.parametrize(
    ("report", "answers"),
    [
        (said("nothing_missing"), True),
        (said("not_decidable"), True),
        (said("not_decidable", score=30.0), False),
        (replace(said("unknown_physics"), force=LAW), False),
        (said("unknown_physics"), True),
        (said("ambiguous"), True),
        (said("ambiguous", score=30.0), False),
        (said("explained"), False),
        (said("measurement_fault", fault=HUM), True),
        (said("measurement_fault", fault=LOOSE), False),
    ],
)
def test_it_is_the_answer_where_nothing_sure_speaks_for_another(
    machine: MachineSpec, report: Report, answers: bool
) -> None:
    found = with_strange(report, SEEN, machine, {})
    assert found.stages[-1]["name"] == "own time"
    if answers:
        assert found.verdict == "unknown_physics"
        assert "100.1 Hz at every speed" in found.sentence
        assert "supply of 50 Hz" in found.sentence
        assert found.where.sites[0].site == "input"
        assert sum(site.weight for site in found.where.sites) == pytest.approx(1.0)
        assert not any(cause.named for cause in found.causes)
        assert found.fault is None
        assert found.held_out is None, "no gain of an effect that is not the answer"
        assert "drive off" in to_do(found)
        assert to_do(found).startswith("look at input first")
    else:
        assert (found.verdict, found.sentence, found.fault) == (report.verdict, report.sentence, report.fault)
        assert "100.1 Hz" in found.where.limits[-1]
    assert with_strange(report, None, machine, {}) is report


TURNS = OwnOrder(order=0.788, shaft="input", rise_db=5.0, elsewhere_db=0.2, speeds=(2, 3))


def test_an_order_of_no_part_is_said_with_its_shaft(machine: MachineSpec) -> None:
    found = with_strange(said("nothing_missing"), TURNS, machine, {})
    assert found.verdict == "unknown_physics"
    assert "0.788 times a turn of input at 2 of 3 speeds" in found.sentence
    assert "no part of its specification turns so" in found.sentence
    assert "belt" in to_do(found)
    assert found.stages[-1]["turns"] == 0.788
    assert explained_by(found) == (), "no drive's hum"
    hum = with_strange(said("measurement_fault", fault=HUM), TURNS, machine, {})
    assert (hum.verdict, hum.fault) == ("measurement_fault", HUM)


@pytest.mark.parametrize(
    ("gain", "placebo", "heard", "answers"),
    [(0.053, 0.057, 0.0, True), (0.053, 0.04, 0.0, False), (0.3, 0.4, 0.0, False), (0.053, 0.057, 12.0, False)],
)
def test_a_name_that_its_placebos_forecast_as_well_stands_behind_it(
    machine: MachineSpec, gain: float, placebo: float, heard: float, answers: bool
) -> None:
    """As an angle at a coupling beside a pull of 100 Hz (c046 of the proof); what is heard at its own lines stays."""
    named = said("explained", score=10.4)
    assert named.held_out is not None
    named = replace(named, held_out=replace(named.held_out, gain=gain, placebo=placebo))
    found = with_strange(named, SEEN, machine, {"outer_spall@bearing1": heard})
    assert (found.verdict == "unknown_physics") is answers
    assert any(cause.named for cause in found.causes) is not answers


@pytest.mark.parametrize(("placebo", "answers"), [(0.33, True), (0.2, False)])
def test_so_does_a_set_whose_placebos_forecast_as_well(machine: MachineSpec, placebo: float, answers: bool) -> None:
    """As wavy races beside a torque of 100 Hz (c067 of the proof)."""
    several = said("ambiguous", score=11.0)
    assert several.held_out is not None
    faint = replace(SEEN, rise_db=4.9)
    several = replace(several, held_out=replace(several.held_out, gain=0.27, placebo=placebo))
    assert (with_strange(several, SEEN, machine, {}).verdict == "unknown_physics") is answers
    assert with_strange(several, SEEN, machine, {"outer_spall@bearing1": 12.0}).verdict == "ambiguous"
    assert with_strange(several, faint, machine, {}).verdict == "ambiguous"
    none = replace(several, held_out=replace(several.held_out, gain=-0.01, placebo=0.06))  # type: ignore[type-var]
    assert with_strange(none, SEEN, machine, {}).verdict == "ambiguous", "nothing is forecast by anything"


@pytest.mark.parametrize(
    ("left", "gain", "answers"),
    [(1.75, 0.005, True), (1.67, 0.099, True), (1.65, 0.005, False), (1.75, 0.1, False), (2.2, 0.005, False)],
    ids=["all", "nearly all", "less", "it forecasts", "another machine's file"],
)
def test_so_does_a_name_whose_revised_machine_leaves_the_whole_change(
    machine: MachineSpec, left: float, gain: float, answers: bool
) -> None:
    """A belt that was a torque and a run-out of 14 each, whose placebos forecast less still (tw039 of the proof)."""
    named = said("explained", score=14.8)
    assert named.held_out is not None
    stage = {"name": "revised machine", "level_change_db": 1.75, "left_of_it_db": left}
    named = replace(named, held_out=replace(named.held_out, gain=gain, placebo=-0.03), stages=(*named.stages, stage))
    assert (with_strange(named, SEEN, machine, {}).verdict == "unknown_physics") is answers
    assert with_strange(named, SEEN, machine, {"outer_spall@bearing1": 12.0}).verdict == "explained", "it is heard"
    sure = replace(named, causes=tuple(replace(c, score=21.0) for c in named.causes))
    assert with_strange(sure, SEEN, machine, {}).verdict == "explained", "beyond doubt"


def test_a_name_beyond_doubt_stays_before_what_is_seen(machine: MachineSpec) -> None:
    named = said("explained", score=21.0)
    assert named.held_out is not None
    named = replace(named, held_out=replace(named.held_out, gain=0.053, placebo=0.057))
    assert with_strange(named, SEEN, machine, {}).verdict == "explained"
