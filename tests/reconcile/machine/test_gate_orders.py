"""The gate knows what turns slowest on any machine, and the teeth of its further stages."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.machine.engine import _gate
from reconcile.machine.gate_orders import gate_orders
from signals.recording import Operating, Recording
from sim.core.response import Channel
from sim.presets import preset


@pytest.mark.parametrize(
    ("name", "lowest"),
    [
        ("paper", 23 / 81 * 0.3677),  # the output's cages
        ("two-stage", 21 / 59 * 19 / 67 * 0.394),
        ("bearing-rig", 0.398),
    ],
)
def test_what_turns_slowest_is_the_slowest_cage(name, lowest):
    assert gate_orders(preset(name)).lowest == pytest.approx(lowest, rel=0.02)


def test_meshes_of_further_stages_are_told_apart_from_the_driven_shafts_teeth():
    found = gate_orders(preset("two-stage"))
    assert found.teeth == (21.0,)
    assert found.other_meshes == (pytest.approx(21 / 59 * 19),)
    assert gate_orders(preset("paper")).other_meshes == ()
    assert gate_orders(preset("bearing-rig")).teeth == ()


def test_without_an_operating_point_something_turns():
    assert gate_orders(preset("paper").model_copy(update={"operating": None})).lowest == 1.0


def recording(speed_hz: float, line_hz: float, amplitude: float, seed: int) -> Recording:
    rate = 5_000
    t = np.arange(4 * rate) / rate
    samples = np.random.default_rng(seed).standard_normal(t.size) + amplitude * np.sin(2 * np.pi * line_hz * t)
    channel = Channel(name="a", quantity="acceleration", unit="m/s^2", location="bearing3", axis="y")
    return Recording(
        sampling_rate_hz=float(rate),
        channels=(channel,),
        samples=samples[None, :],
        operating=Operating(shaft="input", speed_hz=speed_hz),
    )


def hum(speed_hz: float, amplitude: float) -> set[str]:
    """Faults found where a line of 120 Hz came since the baseline."""
    test, baseline = recording(speed_hz, 120.0, amplitude, 1), recording(speed_hz, 120.0, 0.0, 2)
    return {f.kind for f in _gate(preset("two-stage"), [test], [baseline], 0).findings if f.fault}


def test_teeth_of_the_second_stage_at_a_multiple_of_the_mains_are_no_hum():
    second = 21 / 59 * 19
    assert "mains_hum" in hum(16.3, 1.0)
    assert "mains_hum" not in hum(120.0 / second, 1.0)


def test_the_remark_on_length_counts_turns_of_the_slowest_part():
    machine = preset("two-stage")
    short = replace(recording(25.0, 120.0, 0.0, 1), label="r")
    (remark,) = (f for f in _gate(machine, [short], (), 0).findings if f.kind == "too_short")
    assert f"{4 * 25 * gate_orders(machine).lowest:.3g} turns" in remark.detail
