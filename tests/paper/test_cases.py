"""The machines of the study are what their settings say, and a cached result comes back unchanged."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from paper.cases import COLLISION_DAMPING, PRESETS, RUNOUT_M, Case, Setting, all_settings, clearance_sweep, machine
from paper.changes import CHANGES
from paper.run import CHANNELS, Result, cache_path, load, save
from paper.verdict.parts import PARTS
from paper.verdict.sweep import Sweep
from sim.presets import preset

SETTING = Setting(preset="paper", runout_m=RUNOUT_M)
CASE = Case(setting=SETTING, gap_um=20.0, speed_hz=40.0)


def test_machine_carries_its_setting() -> None:
    spec = machine(replace(CASE, setting=replace(SETTING, form="true")))
    terms = {t.term: t for t in spec.terms}
    assert terms["fit_clearance"].parameters["gap"] == pytest.approx(2e-5)
    assert terms["fit_clearance"].parameters["damping"] == 2e5
    assert terms["eccentricity"].parameters["radius"] == RUNOUT_M
    assert spec.meshes[0].centre_distance_form == "true"
    assert spec.operating is not None
    assert spec.operating.speed_hz == 40.0


@pytest.mark.parametrize("name", PRESETS)
def test_collision_damping_is_the_machines(name: str) -> None:
    assert {b.bore_damping_ns_per_m for b in preset(name).bearings} == {COLLISION_DAMPING[name]}


def test_settings_are_all_different_and_the_healthy_machine_has_no_clearance() -> None:
    assert len(set(all_settings())) == 16
    healthy = clearance_sweep(SETTING)[0]
    assert not any(t.term.startswith("fit_clearance") for t in machine(healthy).terms)


@pytest.mark.parametrize("name", list(CHANGES))
def test_every_change_changes_the_machine_of_some_preset(name: str) -> None:
    def differs(preset: str) -> bool:
        setting = Setting(preset=preset, runout_m=RUNOUT_M)
        return machine(replace(CASE, setting=replace(setting, change=name))) != machine(replace(CASE, setting=setting))

    assert differs("paper") or differs("paper-lightly-damped")


def test_cache_returns_what_was_saved_and_separates_cases(tmp_path: Path) -> None:
    trace = {name: np.linspace(0.0, 1.0, 8) for name in CHANNELS}
    result = Result(
        case=CASE,
        numbers={"k_mean": 1 / 3},
        trace=trace,
        trace_rate_hz=10.0,
        spectrum=np.ones(4),
        spectrum_resolution_hz=2.0,
    )
    path = cache_path(tmp_path, CASE)
    save(path, result)
    back = load(path, CASE)
    assert back is not None
    assert back.numbers == result.numbers
    np.testing.assert_allclose(back.trace["k"], trace["k"], rtol=1e-6)
    assert cache_path(tmp_path, replace(CASE, gap_um=10.0)) != path
    assert [p.suffix for p in tmp_path.iterdir()] == [".npz"]


def test_part_keys_are_unique_and_every_trend_has_parts() -> None:
    keys = [p.key for p in PARTS]
    assert len(set(keys)) == len(keys)
    assert {k[0] for k in keys} == set("12345678")


def test_verdict_follows_the_numbers() -> None:
    part = next(p for p in PARTS if p.key == "5b")
    gaps = (1.0, 5.0, 10.0, 20.0, 30.0, 50.0)

    def sweep(values: tuple[float, ...]) -> Sweep:
        by_gap = {g: {"fm1": v} for g, v in zip(gaps, values, strict=True)}
        return Sweep(healthy={"fm1": 1.0}, by_gap=by_gap, by_speed={}, f_o1_hz=77.2, f_r1_hz=30.0)

    assert part.judge(sweep((2.0, 3.0, 2.0, 1.5, 1.2, 1.1))).verdict == "reproduced"
    assert part.judge(sweep((1.1, 1.2, 1.3, 1.4, 1.5, 1.6))).verdict == "not"
