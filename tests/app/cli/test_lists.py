"""`presets`, `terms`, `bearings`, `mesh`: text for people, JSON for programs."""

from __future__ import annotations

import json
from collections.abc import Callable

from signals.sensors import PRESETS
from sim.core.spec import MachineSpec
from sim.parts.bearing import catalogue
from sim.presets import names, preset
from sim.terms import REGISTRY

Call = Callable[..., tuple[int, str, str]]


def test_presets(call: Call) -> None:
    assert [row["name"] for row in json.loads(call("presets", "--json")[1])] == list(names())
    assert all(name in call("presets")[1] for name in names())
    assert MachineSpec.model_validate_json(call("presets", "paper")[1]) == preset("paper")


def test_terms(call: Call) -> None:
    assert {row["key"] for row in json.loads(call("terms", "--json")[1])} == set(REGISTRY.keys())
    one = json.loads(call("terms", "fit_clearance", "--json")[1])
    assert {p["name"]: p["unit"] for p in one["parameters"]}["gap"] == "m"
    assert one["predicted_lines"][0]["label"] == "1*f_o1" and one["demo"]["site"]
    assert "gap" in call("terms", "fit_clearance")[1]


def test_bearings(call: Call) -> None:
    listed = json.loads(call("bearings", "--json")[1])
    assert {row["designation"] for row in listed["bearings"]} == set(catalogue())
    assert all(row["source"] for row in listed["bearings"])
    one = json.loads(call("bearings", "6205-2RS", "--json")[1])
    assert one["designation"] == "6205"
    # Case Western Reserve University prints 3.5848 for this bearing.
    assert abs(one["orders"]["bpfo"] - 3.5848) < 1e-3
    assert "source" in call("bearings", "6205")[1]


def test_sensors(call: Call) -> None:
    listed = json.loads(call("sensors", "--json")[1])
    assert [row["name"] for row in listed["presets"]] == list(PRESETS)
    assert all(name in call("sensors")[1] for name in PRESETS)
    assert json.loads(call("sensors", "icp-magnet", "--json")[1])["stages"]["converter"]["bits"] == 24
    assert "mounting" in call("sensors", "icp-magnet")[1] and "source" in call("sensors", "icp-magnet")[1]
    code, _, error = call("sensors", "nose")
    assert code == 2 and "icp-magnet" in error


def test_mesh_of_the_paper(call: Call) -> None:
    found = json.loads(call("mesh", "--preset", "paper", "--json")[1])
    # Contact ratio of 23/81 standard 20 degree gears, from the seed: 1.71.
    assert round(found["contact_ratio"], 2) == 1.71
    assert 0 < found["min_n_per_m"] < found["mean_n_per_m"] < found["max_n_per_m"]
    assert found["d_mean_d_centre_distance"] < 0
    # The seed's notes: a bore of 0.5 r raises the mean stiffness by 14 %.
    assert 1.10 < found["bore_0.5r_over_0.3r"] < 1.20
    assert found["root_model"] == "clamped_at_base"
    assert "contact_ratio" in call("mesh")[1]


def test_mesh_follows_a_change(call: Call) -> None:
    narrow = json.loads(call("mesh", "--set", "gears.gear.face_width_m=0.012", "--json")[1])
    wide = json.loads(call("mesh", "--json")[1])
    assert 0.4 < narrow["mean_n_per_m"] / wide["mean_n_per_m"] < 0.6
