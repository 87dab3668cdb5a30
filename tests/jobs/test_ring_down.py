"""What is told of a machine that nothing keeps moving, and of outputs that go away with their effect."""

from __future__ import annotations

import pytest

from jobs.analysis import analyse, analysed_from, rings_down
from jobs.carry_out import CAUSES, carry_out
from jobs.physics import PhysicsEngine
from jobs.request import SimulationRequest
from sim.core.spec import ForceLoad
from sim.presets import names, preset

ENGINE = PhysicsEngine()


def test_only_what_nothing_keeps_moving_rings_down() -> None:
    oscillator = preset("oscillator")
    shaken = ForceLoad(body="mass", axis="y", amplitude_n=1.0, frequency_hz=20.0)
    assert [name for name in names() if rings_down(preset(name))] == ["oscillator"]
    assert not rings_down(oscillator.model_copy(update={"loads": [*oscillator.loads, shaken]}))


def test_a_ring_down_is_analysed_whole_and_nobody_is_told_to_simulate_longer() -> None:
    response = ENGINE.simulate(
        preset("oscillator"),
        duration_s=1.0,
        sampling_rate_hz=5000.0,
        channels=None,
        seed=0,
        progress=lambda _: None,
        cancelled=lambda: False,
    )
    assert analysed_from(response, discard=True) == (0.0, [])
    summary = analyse(response, discard_transient=True).summary
    assert summary["rings_down"] is True
    assert not [text for text in summary["warnings"] if "transient" in text]


@pytest.mark.slow
def test_causes_are_found_although_an_output_goes_with_its_effect() -> None:
    body = {
        "preset": "paper-demo",
        "duration_s": 0.6,
        "sampling_rate_hz": 12_000.0,
        "channels": ["resonator1.y.acceleration", "bearing1.wall.normal_force"],
        "causes": True,
    }
    request = SimulationRequest.model_validate(body)
    found = carry_out(ENGINE, preset("paper-demo"), request, progress=lambda _: None, cancelled=lambda: False)
    assert found.extras[CAUSES]["channels"]
    assert [c.name for c in found.response.channels] == body["channels"]
