"""Which operating point a recording states, and that recordings of one point may be of any lengths."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.observe.observation import observe, point_of
from reconcile.observe.watch import watch_list
from signals.recording import Operating, Recording
from sim.core.response import Channel
from sim.core.spec import MachineSpec, TorqueLoad
from sim.presets import preset

RATE_HZ = 10_000.0
CHANNEL = Channel(name="a", quantity="acceleration", unit="m/s^2", location="bearing1", axis="y")


def recorded(speed_hz: float = 30.0, torque_nm: float | None = None, duration_s: float = 1.0) -> Recording:
    rng = np.random.default_rng(round(100 * duration_s))
    return Recording(
        sampling_rate_hz=RATE_HZ,
        channels=(CHANNEL,),
        samples=rng.standard_normal((1, round(duration_s * RATE_HZ))),
        operating=Operating(shaft="input", speed_hz=speed_hz, torque_nm=torque_nm),
    )


def loaded_at_the_output(torque_nm: float) -> MachineSpec:
    machine = preset("paper")
    return machine.model_copy(update={"loads": [TorqueLoad(shaft="output", torque_nm=torque_nm)]})


def test_a_stated_torque_is_a_share_of_the_machines() -> None:
    machine = preset("paper")
    nominal = sum(x.torque_nm for x in machine.loads if isinstance(x, TorqueLoad) and x.shaft == "input")
    assert point_of(machine, recorded(torque_nm=0.5 * nominal)).torque_ratio == 0.5
    assert point_of(machine, recorded()).torque_ratio == 1.0


def test_the_balance_of_a_load_on_another_shaft_counts() -> None:
    teeth = {g.shaft: g.teeth for g in preset("paper").gears}
    balance = 88.0 * teeth["input"] / teeth["output"]
    machine = loaded_at_the_output(-88.0)
    for share in (1.0, 0.5, 0.1):
        assert point_of(machine, recorded(torque_nm=share * balance)).torque_ratio == share


def test_the_sign_of_a_torque_turns_no_load_round() -> None:
    machine = preset("paper")
    for torque in (12.5, -12.5):
        ahead = point_of(machine, recorded(torque_nm=torque)).torque_ratio
        assert ahead == point_of(machine, recorded(torque_nm=-torque)).torque_ratio > 0.0


@pytest.mark.parametrize(("speed_hz", "read"), [(30.004, 30.0), (22.516, 22.52), (0.1373, 0.1373), (0.0041, 0.0041)])
def test_slow_speeds_are_not_rounded_away(speed_hz: float, read: float) -> None:
    assert point_of(preset("paper"), recorded(speed_hz)).speed_hz == pytest.approx(read, rel=1e-12)


@pytest.mark.parametrize("lengths", [(2.0, 0.7), (0.7, 2.0)])
def test_recordings_of_one_point_have_halves_of_their_own(lengths: tuple[float, float]) -> None:
    machine = preset("paper")
    tests = [recorded(duration_s=seconds) for seconds in lengths]
    (point,) = observe(machine, watch_list(machine), tests, [recorded(duration_s=1.5)])
    first, second = (half.duration_s for half in point.halves)
    assert first == pytest.approx(second, rel=0.05) and first + second == pytest.approx(point.test.duration_s, rel=0.05)
    alone = observe(machine, watch_list(machine), [recorded(duration_s=2.0)], [recorded(duration_s=1.5)])[0]
    for half, long in zip(point.halves, alone.halves, strict=True):
        assert np.array_equal(np.isnan(half.total), np.isnan(long.total)), "the longer one tells what the other cannot"
