"""A speed that is stated for the wrong shaft is refused; a machine that really turns as stated is not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.kinematics import read_kinematic_spec
from reconcile.kinematics.families import ties
from reconcile.kinematics.whose_speed import check_whose_speeds, of_one_shaft, usual_speeds
from reconcile.stated import given
from signals.recording import Operating, Tacho
from sim.core.errors import SpecError
from tests.strategies.brief import RATE_HZ, recorded

PINION, WHEEL = 21, 64
SPEED_HZ, SECONDS = 24.52, 4.0


def spec(**speeds: float):  # type: ignore[no-untyped-def]
    shafts = [{"name": name, **({"speed_hz": speeds[name]} if name in speeds else {})} for name in ("input", "output")]
    gears = [
        {"name": "pinion", "shaft": "input", "teeth": PINION},
        {"name": "wheel", "shaft": "output", "teeth": WHEEL},
    ]
    meshes = [{"name": "mesh1", "gears": ["pinion", "wheel"]}]
    return read_kinematic_spec({"kinematics": {"shafts": shafts, "gears": gears, "meshes": meshes}})


def gearbox(shaft: str, speed_hz: float = SPEED_HZ, seed: int = 1, loud: float = 1.0):  # type: ignore[no-untyped-def]
    """Its input turns at `SPEED_HZ`, whatever is stated."""
    angle = 2 * np.pi * SPEED_HZ * np.arange(round(SECONDS * RATE_HZ)) / RATE_HZ
    lines = sum(a * np.cos(k * PINION * angle + k) for k, a in ((1, 1.0), (2, 0.5), (3, 0.3)))
    lines += 0.3 * np.cos(angle) + 0.1 * np.cos(2 * angle) + 0.1 * np.cos(angle * PINION / WHEEL)
    noise = 0.05 * np.random.default_rng(seed).standard_normal(angle.size)
    return replace(recorded(loud * lines + noise, speed_hz), operating=Operating(shaft=shaft, speed_hz=speed_hz))


def refused(machine, recording) -> str:  # type: ignore[no-untyped-def]
    with pytest.raises(SpecError) as caught:
        check_whose_speeds(machine, given([recording], []))
    return str(caught.value)


@pytest.mark.slow
def test_the_speed_of_the_motor_written_down_for_the_driven_shaft_is_refused() -> None:
    said = refused(spec(input=24.5), gearbox("output"))
    assert "stated for output; input would then turn at 74.73 Hz, the machine file says 24.5 Hz" in said
    assert "was input meant?" in said and "about 8.039 Hz for output" in said


@pytest.mark.slow
def test_without_any_line_the_number_of_the_file_tells() -> None:
    assert "was input meant?" in refused(spec(input=24.5), gearbox("output", loud=0.0))


@pytest.mark.slow
def test_lines_tell_where_the_drive_does_not_run_at_the_speed_of_the_file() -> None:
    assert "was input meant?" in refused(spec(input=18.0), gearbox("output"))


@pytest.mark.slow
@pytest.mark.parametrize(
    "usual", [{"input": 24.5}, {"input": 15.0}, {"input": 40.0}, {"output": 24.5}, {"input": 8.04}]
)
def test_a_right_description_stands_whatever_the_file_says(usual: dict[str, float]) -> None:
    check_whose_speeds(spec(**usual), given([gearbox("input")], []))
    check_whose_speeds(spec(**usual), given([gearbox("output", SPEED_HZ * PINION / WHEEL)], []))


@pytest.mark.slow
@pytest.mark.parametrize(("shaft", "right"), [("input", False), ("output", True)])
def test_pulses_decide_before_lines(shaft: str, right: bool) -> None:
    pulses = np.arange(0.0, SECONDS, 1 / SPEED_HZ)
    tacho = Tacho(shaft=shaft, pulse_times_s=pulses, pulses_per_revolution=1)
    one = replace(gearbox("output"), tacho=tacho)
    if right:
        check_whose_speeds(spec(input=24.5), given([one], []))
    else:
        assert "was input meant?" in refused(spec(input=24.5), one)


def test_a_file_without_speeds_contradicts_nothing() -> None:
    assert usual_speeds(spec()) == {}
    assert usual_speeds(spec(output=8.0)) == pytest.approx({"input": 8.0 * WHEEL / PINION, "output": 8.0})


def test_recordings_may_state_the_speeds_of_different_shafts() -> None:
    machine = spec(input=24.5)
    both = [gearbox("input"), gearbox("output", SPEED_HZ * PINION / WHEEL)]
    turned = of_one_shaft(both, ties(machine, "input"))
    assert [one.operating.shaft for one in turned] == ["input", "input"]  # type: ignore[union-attr]
    assert [one.operating.speed_hz for one in turned] == pytest.approx([SPEED_HZ, SPEED_HZ])  # type: ignore[union-attr]
