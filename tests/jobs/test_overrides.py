"""Overrides: problems are told by the key that brought them, and near names are suggested."""

from __future__ import annotations

import pytest

from jobs.limits import LEAST_SAMPLES, Limits
from jobs.overrides import apply_overrides, told_by_key
from jobs.physics import PhysicsEngine
from jobs.request import SimulationRequest
from jobs.resolve import resolve
from sim.core.errors import Problem, SpecError
from sim.presets import preset

ENGINE = PhysicsEngine()


def refused(change: dict[str, object], **body: object) -> list[Problem]:
    request = SimulationRequest.model_validate({"preset": "paper-demo", "set": change, **body})
    with pytest.raises(SpecError) as caught:
        resolve(request, ENGINE, Limits())
    return list(caught.value.problems)


@pytest.mark.parametrize(
    "change",
    [
        {"fit_clearance@bearing1.gap": 20.0},
        {"fit_clearance@bearing1.gape": 2e-5},
        {"no_such@bearing1.gap": 2e-5},
        {"unbalance@nowhere.moment": 1e-5},
        {"gears.pinion.teeth": 3},
        {"bearings.bearing3.radial_clearance_m": 5.0},
        {"operating.speed_hz": 1800.0},
        {"gears.pinon.teeth": 30},
    ],
)
def test_a_problem_names_the_key_that_brought_it(change: dict[str, object]) -> None:
    assert [problem.field for problem in refused(change)] == [f"set.{key}" for key in change]


def test_every_wrong_key_is_told_at_once() -> None:
    change: dict[str, object] = {"fit_clearance@bearing1.gap": 20.0, "eccentricity@pinion.radius": 20.0}
    assert {problem.field for problem in refused(change)} == {f"set.{key}" for key in change}


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"speed": 20.0}, "did you mean operating.speed_hz?"),
        ({"teeth": 20.0}, "gears.pinion.teeth or gears.gear.teeth"),
        ({"rpm": 1800.0}, "operating.speed_hz=30"),
        ({"operating.speed_hz": 1800.0}, "1800 rpm are 30 Hz"),
        ({"fit_clearence@bearing1.gap": 2e-5}, "did you mean fit_clearance?"),
        ({"gears.pinion.teth": 30}, "did you mean gears.pinion.teeth?"),
    ],
)
def test_near_names_and_likely_units_are_suggested(change: dict[str, object], says: str) -> None:
    assert says in refused(change)[0].message


def test_a_problem_that_no_override_touches_keeps_its_field() -> None:
    document = preset("paper-demo").model_dump(mode="json")
    with pytest.raises(SpecError) as caught, told_by_key(document, {"operating.speed_hz": 20.0}):
        raise SpecError(Problem(field="terms.0.parameters.gap", message="is wrong"))
    assert caught.value.problems[0].field == "terms.0.parameters.gap"


def test_what_was_asked_is_set() -> None:
    machine = apply_overrides(preset("paper-demo"), {"gears.pinion.teeth": 21, "unbalance@gear.moment": 1e-4})
    assert machine.gears[0].teeth == 21
    assert ("unbalance", "gear", {"moment": 1e-4}) in [(t.term, t.site, t.parameters) for t in machine.terms]


def test_a_record_too_short_for_a_spectrum_is_refused_with_the_least_that_is_not() -> None:
    problem = refused({}, duration_s=1e-4)[0]
    least = float(problem.allowed.removeprefix(">= "))
    assert problem.field == "duration_s" and least * 30_000 == pytest.approx(LEAST_SAMPLES, rel=1e-5)
    request = SimulationRequest(preset="paper-demo", duration_s=least)
    assert resolve(request, ENGINE, Limits()).cost.steps > 0
