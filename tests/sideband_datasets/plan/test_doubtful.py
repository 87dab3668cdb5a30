"""What a recipe hardly means is told, and planned as it says."""

from __future__ import annotations

import pytest

from sideband_datasets import make_plan
from tests.sideband_datasets.small import document, tiny

STIFFNESS = "bearings.bearing1.support.stiffness_y_n_per_m"
OTHER = "bearings.bearing2.support.stiffness_y_n_per_m"
LONG = {"count": 60, "machines": [{**document()["machines"][0], "instances": 10}]}


@pytest.mark.parametrize(("part", "value"), [("vary", {"low": 2e7, "high": 5e7}), ("set", 2e7)])
def test_what_conditions_replace_is_told(part, value):
    machine = {"name": "rotor", "preset": "rotor", "instances": 10, "vary": {OTHER: {"factor": [0.5, 2.0]}}}
    machines = [{**machine, part: {**machine.get(part, {}), STIFFNESS: value}}]
    replaced = {**LONG, "machines": machines, "conditions": {STIFFNESS: {"low": 1e7, "high": 1e8}}}
    (told,) = make_plan(tiny(**replaced)).warnings
    assert told == f"`{part}` of machines rotor has no effect on {STIFFNESS}: `conditions` replaces it"
    assert not make_plan(tiny(**replaced | {"conditions": {STIFFNESS: {"factor": [0.9, 1.1]}}})).warnings


@pytest.mark.parametrize("width", [0, 0.0, {"choices": [0, 1e-3]}])
def test_a_fault_of_no_size_is_told(width):
    faults = [{"name": "outer", "terms": [{"term": "outer_spall", "parameters": {"width": width}}]}]
    (told,) = make_plan(tiny(**LONG, faults=faults)).warnings
    assert told == "class outer: outer_spall of width 0 is labelled as a fault all the same"


@pytest.mark.parametrize(("part", "given"), [("set", {"speed_hz": 11.0}), ("set", {"operating.speed_hz": 11.0})])
def test_what_the_speeds_replace_is_told(part, given):
    machines = [{**document()["machines"][0], "instances": 10, part: given}]
    (told,) = make_plan(tiny(**{**LONG, "machines": machines})).warnings
    assert told.endswith(f"no effect on {next(iter(given))}: `speeds_hz` replaces it")


@pytest.mark.parametrize(
    ("low", "high", "plan", "zero"),
    [(0, 1e-3, "factorial", True), (0, 1e-3, "sobol", False), (0, 0, "sobol", True), (1e-4, 1e-3, "factorial", False)],
)
def test_a_range_holds_its_ends_in_factorial_plans(low, high, plan, zero):
    width = {"low": low, "high": high}
    faults = [{"name": "outer", "terms": [{"term": "outer_spall", "parameters": {"width": width}}]}]
    told = make_plan(tiny(**LONG, faults=faults, plan=plan)).warnings
    assert any("labelled as a fault all the same" in text for text in told) is zero


@pytest.mark.parametrize("width", [1e-3, {"low": 0, "high": 1e-3}, {"choices": [5e-4, 1e-3]}])
def test_a_size_is_not(width):
    faults = [{"name": "outer", "terms": [{"term": "outer_spall", "parameters": {"width": width}}]}]
    assert not make_plan(tiny(**LONG, faults=faults)).warnings


@pytest.mark.parametrize(("factor", "told"), [((1.0, 1.0001), True), ((0.9, 1.1), False)])
def test_machines_that_hardly_differ_are_told(factor, told):
    (rotor,) = document()["machines"]
    vary = {"bearings.bearing1.support.stiffness_y_n_per_m": {"factor": factor}}
    found = make_plan(tiny(machines=[{**rotor, "vary": vary}])).warnings
    assert any("one machine, which stands in several splits" in w for w in found) == told


def test_a_ramp_leaves_no_labelled_peaks_and_is_told():
    (rotor,) = document()["machines"]
    ramp = {"profile.kind": "ramp", "profile.end_ratio": 1.5, "profile.duration_s": 0.4}
    machines = [{**rotor, "set": {**rotor.get("set", {}), **ramp}}]
    told = make_plan(tiny(machines=machines, peaks={"spectra": ["envelope"]})).warnings
    assert any("change speed while they are recorded" in w for w in told)
    assert not any("change speed" in w for w in make_plan(tiny(machines=machines, peaks={"spectra": []})).warnings)
    assert not any("change speed" in w for w in make_plan(tiny(peaks={"spectra": ["envelope"]})).warnings)
