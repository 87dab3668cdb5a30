from __future__ import annotations

import pytest

from sideband_datasets.plan.plan import planned
from sim.core.errors import SpecError
from sim.presets import preset
from tests.sideband_datasets.small import document, tiny

UNBALANCE = "unbalance@disc.moment"


def _inline(width: float) -> dict[str, object]:
    machine = preset("rotor").model_dump(mode="json")
    machine["terms"].append({"term": "outer_spall", "site": "bearing1", "parameters": {"width": width}})
    (rotor,) = document()["machines"]
    return {"machines": [{**{k: v for k, v in rotor.items() if k != "preset"}, "machine": machine}]}


@pytest.mark.parametrize("width", [0.0, 2e-3])
def test_a_drawing_with_a_defect_is_refused_whatever_its_size(width):
    with pytest.raises(SpecError, match="healthy ones too") as told:
        planned(tiny(**_inline(width)))
    (problem,) = told.value.problems
    assert problem.field.startswith("machines.0.machine.terms.") and problem.given == "outer_spall@bearing1"


@pytest.mark.parametrize("place", ["vary", "set", "conditions"])
def test_what_sound_machines_have_too_is_told(place):
    (rotor,) = document()["machines"]
    value = {UNBALANCE: 1e-4}
    changes = {"conditions": value} if place == "conditions" else {
        "machines": [{**rotor, place: {**rotor.get(place, {}), **value}}]}  # fmt: skip
    told = planned(tiny(**changes)).warnings
    assert any("unbalance of their own" in w and "class both" in w for w in told)
    assert not any("of their own" in w for w in planned(tiny()).warnings)


def test_a_class_without_a_recording_is_told():
    told = planned(tiny(count=12, healthy_share=0.999)).warnings
    assert any(w.startswith("class outer has no recording") for w in told)
    assert not any("has no recording" in w for w in planned(tiny(count=12, healthy_share=0.0)).warnings)


@pytest.mark.parametrize(
    "key", ["bent_shaft@disc.bow", "pedestal_looseness@bearing1.loss", "fit_clearance@bearing1.gap"]
)
def test_play_and_looseness_in_all_recordings_are_told_unless_a_class_has_them(key):
    (rotor,) = document()["machines"]
    term, value = key.split("@")[0], 0.3 if "loss" in key else 1e-5
    changes = {"machines": [{**rotor, "set": {**rotor.get("set", {}), key: value}}]}
    told = planned(tiny(**changes)).warnings
    assert any(f"have {term} in all recordings, and no class tells of it" in w for w in told)
    worn = {"name": "worn", "terms": [{"term": term, "sites": [key.split("@")[1].split(".")[0]]}]}
    told = planned(tiny(**changes, faults=[*document()["faults"], worn])).warnings
    assert not any("no class tells" in w for w in told)
    assert not any("no class tells" in w for w in planned(tiny()).warnings)


def test_a_force_of_ones_own_in_a_drawing_is_told():
    machine = preset("rotor").model_dump(mode="json")
    machine["custom_laws"] = [{"name": "knock", "dof": "disc.y", "expression": "10*sin(phi)"}]
    machine["terms"].append({"term": "custom_force", "site": "disc", "parameters": {"law": 1}})
    (rotor,) = document()["machines"]
    alone = {k: v for k, v in rotor.items() if k not in ("preset", "set")}
    told = planned(tiny(machines=[{**alone, "machine": machine}])).warnings
    assert any("have custom_force in all recordings" in w for w in told)
