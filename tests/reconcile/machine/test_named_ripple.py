"""What acts many times a turn is the answer where nothing sure speaks for another one, and named where it forecasts."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from reconcile.atlas.candidates import with_effects
from reconcile.machine.many_turns import ManyTurns
from reconcile.machine.named_ripple import AHEAD, LEAST_GAIN, MOST_OFF_DB, STRANGERS, TOLD, shows, with_many_turns
from reconcile.machine.ripple import FEWEST, Ripple, Seen
from reconcile.report.action import to_do
from reconcile.verdict import (
    Cause,
    EstimatedForce,
    HeldOut,
    LineChange,
    NextExperiment,
    Report,
    SensorFault,
    Severity,
    Where,
    Word,
)
from sim.core.spec import MachineSpec, TermSpec
from sim.presets import preset
from tests.reconcile.machine.torques import FOUR, few

OTHER = LineChange(label="1*f_m", frequency_hz=690.0, change_db=4.0)
BESIDE = LineChange(label="teeth + 4*input", frequency_hz=810.0, change_db=9.0)
SEEN = replace(FOUR, lines=(BESIDE,))
TERM = TermSpec(term="torque_ripple", site="input", parameters={"amplitude": 2.0, "order": 4.0, "phase": 0.0})
SIZE = Severity(name="amplitude", value=2.0, unit="N*m", low=1.5, high=2.7)
LAW = EstimatedForce(site="bearing3", samples={}, law="1e9 N/m^3 * z^3 on both axes")


def held(gain: float, black_box: float | None = 0.1, off_db: float = 3.0) -> HeldOut:
    return HeldOut(
        metric="sideband_level_distance", unit="dB", before=off_db / (1.0 - gain), after=off_db, gain=gain,
        gain_low=gain - 0.1, gain_high=gain + 0.1, retuned=None, black_box=black_box, placebo=None,
    )  # fmt: skip


@pytest.fixture(scope="module")
def machine() -> MachineSpec:
    return preset("paper-lightly-damped")


def said(verdict: Word, score: float = 5.0, **more: Any) -> Report:
    """A torque of the same place among the causes, as the screen may list it, and all that belongs to one answer."""
    causes = (
        Cause(term="outer_spall", site="bearing1", score=score, named=True),
        Cause(term="torque_ripple", site="input", score=1.0),
        Cause(term="torque_ripple", site="output", score=0.5),
    )
    usual: dict[str, Any] = {
        "where": Where(lines=(OTHER,), limits=("so far",)), "held_out": held(0.5), "undecidable": ("something",),
        "next_experiment": NextExperiment(sentence="Another."), "machine": {"name": "revised"},
        "stages": ({"name": "screen"},), "faintest": ("none",),
    }  # fmt: skip
    return Report(verdict=verdict, sentence="so.", level="machine", causes=causes, **{**usual, **more})


def made(machine: MachineSpec, gain: float, black_box: float | None = 0.1, off_db: float = 3.0) -> Ripple:
    found = held(gain, black_box, off_db)
    return Ripple(term=TERM, severity=SIZE, held=found, machine=with_effects(machine, (TERM,)), score=31.0)


def heard(count: int) -> Seen:
    """Sidebands that rose by turns at two points, about two harmonics."""
    return Seen(
        point=np.arange(count) % 2,
        ratio_db=np.zeros(count),
        risen_db=np.full(count, 20.0),
        told=np.ones(count, dtype=bool),
        places=tuple((23.0, 1 + k // 2 % 2, 1, k) for k in range(count)),
    )


@pytest.fixture
def answer(machine: MachineSpec, monkeypatch: pytest.MonkeyPatch) -> Any:
    """The answer beside a report where `seen` is, with what it would be by `found`."""

    def of(report: Report, seen: ManyTurns | None, found: Ripple | None, count: int = FEWEST) -> Report:
        monkeypatch.setattr("reconcile.machine.named_ripple.many_turns", lambda *_args: seen)
        monkeypatch.setattr("reconcile.machine.named_ripple.sidebands", lambda *_args: heard(count))
        monkeypatch.setattr("reconcile.machine.named_ripple.ripple", lambda *_args: found)
        return with_many_turns(report, few(machine, ()), ["a", "b"])

    return of


OPEN = [
    said("nothing_missing"),
    said("not_decidable"),
    said("ambiguous"),
    said("unknown_physics", force=replace(LAW, law=None), fault=SensorFault(kind="loose_sensor", channel="a")),
]
SURE = [
    said("explained"),
    said("ambiguous", score=30.0),
    said("not_decidable", score=30.0),
    said("measurement_fault"),
    said("unknown_physics", force=LAW),
    *(said("unknown_physics", stages=({"name": name}, {"name": "last"})) for name in sorted(STRANGERS)),
]


@pytest.mark.parametrize("report", OPEN)
def test_a_torque_that_forecasts_is_named(report: Report, answer: Any, machine: MachineSpec) -> None:
    found = answer(report, SEEN, made(machine, 0.63))
    assert found.verdict == "explained"
    assert found.sentence == (
        "Torque ripple at input, amplitude 2 N*m (90 %: 1.5 N*m to 2.7 N*m), 4 times a turn: "
        "the teeth's lines are modulated 4 times a turn of input at every speed, new since the baseline; it takes 63 % "
        "off the distance of sideband levels at operating points it was not fitted to."
    )
    first, *others = found.causes
    assert (first.term, first.site, first.named, first.score) == ("torque_ripple", "input", True, 31.0)
    assert first.severity == SIZE and first.values == {"order": 4.0}
    assert [(c.term, c.site, c.named) for c in others] == [
        ("outer_spall", "bearing1", False),
        ("torque_ripple", "output", False),
    ]
    assert [(s.site, s.weight) for s in found.where.sites] == [("input", 1.0)]
    assert found.where.lines == (BESIDE, OTHER) and found.where.limits == ("so far",)
    assert found.held_out == replace(held(0.63), effects=("torque_ripple@input",))
    assert found.machine == machine.model_copy(update={"terms": [TERM]}).model_dump(mode="json")
    assert MachineSpec.model_validate(found.machine).terms[-1] == TERM
    assert (found.fault, found.force, found.undecidable, found.faintest) == (None, None, (), ())
    assert found.next_experiment == TOLD
    assert [stage["name"] for stage in found.stages] == ["screen", "many turns"]


@pytest.mark.parametrize("report", OPEN)
@pytest.mark.parametrize("gain", [None, LEAST_GAIN - 0.01, -0.5])
def test_one_that_does_not_forecast_or_does_not_run_is_unknown(
    report: Report, gain: float | None, answer: Any, machine: MachineSpec
) -> None:
    found = answer(report, SEEN, None if gain is None else made(machine, gain))
    assert found.verdict == "unknown_physics"
    assert found.sentence == (
        f"Something is missing that no known effect explains: {SEEN.text}. "
        "A torque that comes so often does not show what is seen."
    )
    assert not any(c.named for c in found.causes) and found.undecidable == ()
    assert [(c.term, c.site) for c in found.causes] == [(c.term, c.site) for c in report.causes]
    assert (found.machine, found.force, found.fault, found.held_out, found.faintest) == (None, None, None, None, ())
    assert found.where.likeliest == ("input",) and found.where.lines == (BESIDE, OTHER)
    assert found.next_experiment == TOLD and "poles" in to_do(found)
    assert found.stages[-1] == SEEN.stage


def test_machines_with_it_show_what_is_seen_by_gain_lead_and_what_is_left(machine: MachineSpec) -> None:
    assert shows(made(machine, LEAST_GAIN)) and not shows(made(machine, LEAST_GAIN - 0.01))
    assert shows(made(machine, 0.61, black_box=0.6 - AHEAD)) and not shows(made(machine, 0.59, black_box=0.6 - AHEAD))
    assert shows(made(machine, LEAST_GAIN, black_box=None)) and shows(made(machine, LEAST_GAIN, black_box=-1.0))
    assert shows(made(machine, 0.8, off_db=MOST_OFF_DB)) and not shows(made(machine, 0.8, off_db=MOST_OFF_DB + 0.01))


def test_too_few_sidebands_that_are_new_say_nothing(answer: Any, machine: MachineSpec) -> None:
    assert answer(OPEN[0], SEEN, made(machine, 0.9), FEWEST).verdict == "explained"
    for report in (OPEN[0], SURE[0]):
        assert answer(report, SEEN, made(machine, 0.9), FEWEST - 1) is report


@pytest.mark.parametrize("verdict", ["nothing_missing", "not_decidable", "ambiguous"])
def test_a_stranger_that_is_only_a_remark_does_not_stay(verdict: Word, answer: Any, machine: MachineSpec) -> None:
    report = said(verdict, stages=tuple({"name": name} for name in STRANGERS))
    assert answer(report, SEEN, made(machine, 0.9)).verdict == "explained"


@pytest.mark.parametrize("report", SURE)
def test_beside_a_sure_answer_it_is_a_remark(report: Report, answer: Any, machine: MachineSpec) -> None:
    found = answer(report, SEEN, made(machine, 0.9))
    where = replace(report.where, lines=(BESIDE, OTHER), limits=("so far", f"beside this, {SEEN.text}"))
    assert found == replace(report, where=where, stages=(*report.stages, SEEN.stage))


def test_what_is_not_seen_changes_nothing(answer: Any) -> None:
    for report in (*OPEN, *SURE):
        assert answer(report, None, None) is report


def test_what_is_looked_at_are_the_recordings_of_the_setting(
    machine: MachineSpec, monkeypatch: pytest.MonkeyPatch
) -> None:
    setting = few(machine, ("points",))
    asked: list[tuple[Any, ...]] = []

    def asks(answer: object) -> Any:
        def ask(*args: Any) -> object:
            asked.append(args)
            return answer

        return ask

    monkeypatch.setattr("reconcile.machine.named_ripple.many_turns", asks(SEEN))
    monkeypatch.setattr("reconcile.machine.named_ripple.sidebands", asks(heard(FEWEST)))
    monkeypatch.setattr("reconcile.machine.named_ripple.ripple", asks(None))
    with_many_turns(OPEN[0], setting, ["a"])
    first, second, third = asked
    assert (first, second) == ((machine, ("points",), ["a"]), (machine, ("points",), 4.0))
    assert third[:2] == (setting, SEEN) and third[2].enough
