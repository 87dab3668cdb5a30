"""A speed stated wrong by two is doubted by the lines of the teeth, before anything is simulated."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.gate.findings import Gate
from reconcile.machine import octave
from reconcile.machine.engine import reconcile_machine
from reconcile.machine.octave import doubted_speed, rival_speed
from reconcile.observe.watch import bases_at
from sim.core.spec import MachineSpec
from sim.presets import preset
from tests.reconcile.machine.teeth import CHANNELS, SPEED_HZ, seen, turning


@pytest.fixture(scope="module")
def machine() -> MachineSpec:
    return preset("paper-lightly-damped")


@pytest.mark.slow
@pytest.mark.parametrize(("stated_hz", "factor"), [(SPEED_HZ, None), (SPEED_HZ / 2, 2.0), (SPEED_HZ * 2, 0.5)])
def test_the_teeth_tell_a_factor_of_two(machine: MachineSpec, stated_hz: float, factor: float | None) -> None:
    data = seen(machine, turning(machine, 1, stated_hz=stated_hz))
    assert rival_speed(machine, data, CHANNELS) == factor


@pytest.mark.slow
def test_most_of_the_recordings_decide(machine: MachineSpec) -> None:
    right = [turning(machine, k, true_hz=hz, stated_hz=hz) for k, hz in enumerate((24.0, 40.0))]
    wrong = turning(machine, 3, true_hz=30.0, stated_hz=60.0)
    assert rival_speed(machine, seen(machine, *right, wrong), CHANNELS) is None
    assert rival_speed(machine, seen(machine, wrong), CHANNELS) == 0.5


@pytest.mark.slow
def test_a_baseline_with_the_teeth_where_they_were_stated_settles_it(machine: MachineSpec) -> None:
    wrong = turning(machine, 3, stated_hz=2 * SPEED_HZ)
    sound = turning(machine, 4, true_hz=2 * SPEED_HZ, stated_hz=2 * SPEED_HZ)
    assert rival_speed(machine, seen(machine, wrong, baseline=sound), CHANNELS) is None, "the gears have changed"
    alike = turning(machine, 4, stated_hz=2 * SPEED_HZ)
    assert rival_speed(machine, seen(machine, wrong, baseline=alike), CHANNELS) == 0.5


@pytest.mark.slow
def test_noise_alone_doubts_nothing(machine: MachineSpec) -> None:
    quiet = turning(machine, 5)
    noise = replace(quiet, samples=np.random.default_rng(6).normal(size=quiet.samples.shape))
    assert rival_speed(machine, seen(machine, noise), CHANNELS) is None


@pytest.mark.slow
def test_a_mesh_at_half_the_rate_of_another_cannot_tell(machine: MachineSpec, monkeypatch: pytest.MonkeyPatch) -> None:
    data = seen(machine, turning(machine, 1, stated_hz=SPEED_HZ * 2))
    mesh = bases_at(machine, SPEED_HZ * 2)["f_m"]
    monkeypatch.setattr(octave, "bases_at", lambda *_: {"f_m": mesh, "f_m2": mesh / 2})
    assert rival_speed(machine, data, CHANNELS) is None


@pytest.mark.slow
def test_nothing_is_simulated_at_a_doubted_speed(machine: MachineSpec) -> None:
    class Unused:
        def get(self, key: str) -> bytes | None:
            raise AssertionError(f"{key} was asked for")

        def put(self, key: str, data: bytes) -> None:
            raise AssertionError(f"{key} was stored")

    wrong = turning(machine, 3, true_hz=30.0, stated_hz=60.0)
    report = reconcile_machine(machine, [wrong], keeper=Unused())
    assert report.verdict == "not_decidable" and not report.causes
    assert {"physics_version", "package_version", "seed", "cost"} <= set(report.provenance)
    assert "60 Hz" in report.sentence and "30 Hz" in report.sentence
    assert report.next_experiment is not None and "tacho" in report.next_experiment.sentence
    assert report.stages[0]["name"] == "sensor gate"
    assert {"physics_version", "seed", "cost"} <= set(report.provenance)


@pytest.mark.slow
def test_the_sentence_says_what_the_teeth_show(machine: MachineSpec) -> None:
    data = seen(machine, turning(machine, 1))
    gate = Gate(findings=(), baselines=(), tests=(), fault=None, usable=True)
    assert "every other harmonic" in doubted_speed(2.0, data, gate, {}).sentence
    assert "half way between" in doubted_speed(0.5, data, gate, {}).sentence
