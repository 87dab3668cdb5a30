"""Overrides: problems are told by the key that brought them, and near names are suggested."""

from __future__ import annotations

import pytest

from jobs.limits import LEAST_SAMPLES, Limits
from jobs.physics import PhysicsEngine
from jobs.request import SimulationRequest
from jobs.resolve import resolve
from signals.overrides import apply_overrides, told_by_key
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
        {"speed_hz": 1800.0},
        {"torque_nm": 1e9},
        {"torque": "much"},
        {"profile": 3},
        {"profile.kind": "ramp", "profile.duration_s": -1.0, "profile.end_ratio": 20.0},
    ],
)
def test_a_problem_names_the_key_that_brought_it(change: dict[str, object]) -> None:
    wrong = {f"set.{key}" for key in change if key != "profile.kind"}
    assert {problem.field for problem in refused(change)} == wrong


@pytest.mark.parametrize(
    ("profile", "field", "allowed"),
    [
        ({"kind": "ramp", "end_ratio": 20, "duration_s": 1}, "set.profile.end_ratio", "<= 10"),
        ({"kind": "rmp"}, "set.profile.kind", "'ramp', 'fluctuating', 'measured'"),
        ({}, "set.profile.kind", ""),
        ({"kind": "measured", "step_s": 0.1, "ratios": [1, -1]}, "set.profile.ratios.1", ">= 0"),
    ],
)
def test_problems_inside_an_object_name_their_place_in_it(profile: object, field: str, allowed: str) -> None:
    assert [(p.field, p.allowed) for p in refused({"profile": profile})] == [(field, allowed)]


def test_problems_of_separate_steps_are_told_together() -> None:
    """Request, unknown path, wrong value: none hides another."""
    change = {"gears.pinon.teeth": 30, "gears.gear.teeth": 3}
    fields = {problem.field for problem in refused(change, duration_s=1e-5)}
    assert fields == {"duration_s", "set.gears.pinon.teeth", "set.gears.gear.teeth"}
    fields = {problem.field for problem in refused({}, sampling_rate_hz=200, channels=["nose"])}
    assert fields == {"sampling_rate_hz", "channels.0"}


def test_short_names_are_paths() -> None:
    paths = {"operating.speed_hz": 20.0, "operating.profile": {"kind": "ramp", "end_ratio": 2.0, "duration_s": 1.0}}
    short = {key.removeprefix("operating."): value for key, value in paths.items()}
    assert apply_overrides(preset("paper"), short) == apply_overrides(preset("paper"), paths)
    still = apply_overrides(apply_overrides(preset("paper"), short), {"profile": None, "gravity": 9.81})
    assert still.operating is not None and still.operating.profile is None
    assert still.gravity_m_per_s2 == 9.81


def test_all_outputs_are_asked_for_by_one_word() -> None:
    def resolved(**body: object) -> object:
        request = SimulationRequest.model_validate({"preset": "oscillator", **body})
        return resolve(request, ENGINE, Limits()).document

    names = list(ENGINE.report(preset("oscillator")).channels)
    assert resolved(channels="all") == resolved(channels=names)


def test_a_long_profile_is_shown_by_its_length() -> None:
    profile = {"kind": "measured", "step_s": 0.01, "ratios": [1.0] * 1000}
    request = SimulationRequest.model_validate({"preset": "paper", "set": {"profile": profile}})
    resolved = resolve(request, ENGINE, Limits())
    assert resolved.source["set"] == {"profile": {"kind": "measured", "step_s": 0.01, "ratios": "a list of 1000"}}
    assert len(resolved.document["machine"]["operating"]["profile"]["ratios"]) == 1000  # type: ignore[index]


def test_every_wrong_key_is_told_at_once() -> None:
    change: dict[str, object] = {"fit_clearance@bearing1.gap": 20.0, "eccentricity@pinion.radius": 20.0}
    assert {problem.field for problem in refused(change)} == {f"set.{key}" for key in change}


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"speed": 20.0}, "did you mean speed_hz?"),
        ({"teeth": 20.0}, "gears.pinion.teeth or gears.gear.teeth"),
        ({"rpm": 1800.0}, "speed_hz=30"),
        ({"profil": 1.0}, "did you mean profile?"),
        ({"gears.pinion": 3.0}, "names a part"),
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


def test_a_formula_where_a_number_stands_is_sent_to_the_laws() -> None:
    (problem,) = refused({"custom_force@gear.law": "50*x"})
    assert problem.field == "set.custom_force@gear.law" and "custom_laws" in str(problem.allowed)
