"""A speed or torque of another shaft is converted; pulses that contradict the statement are refused."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.machine.drive import on_drive
from signals.recording import Operating, Recording, Tacho
from sim.core.errors import SpecError
from sim.core.response import Channel
from sim.core.spec import MachineSpec
from sim.presets import preset

CHANNEL = Channel(name="a", quantity="acceleration", unit="m/s^2", location="bearing1", axis="y")


@pytest.fixture(scope="module")
def machine() -> MachineSpec:
    return preset("paper")


def recorded(shaft: str, speed_hz: float, *, tacho: Tacho | None = None) -> Recording:
    return Recording(
        sampling_rate_hz=1000.0,
        channels=(CHANNEL,),
        samples=np.zeros((1, 2000)),
        operating=Operating(shaft=shaft, speed_hz=speed_hz, torque_nm=70.0),
        tacho=tacho,
        label="r.json",
    )


def pulses(shaft: str, hz: float, per_turn: int = 1) -> Tacho:
    return Tacho(shaft=shaft, pulse_times_s=np.arange(0.0, 1.9, 1.0 / hz), pulses_per_revolution=per_turn)


def test_another_shaft_is_converted_by_the_teeth(machine: MachineSpec) -> None:
    teeth = {g.shaft: g.teeth for g in machine.gears}
    ratio = teeth["output"] / teeth["input"]
    (found,) = on_drive(machine, [recorded("output", 30.0 / ratio, tacho=pulses("output", 30.0 / ratio))])
    assert found.operating is not None and found.tacho is not None
    assert found.operating.shaft == "input" and found.operating.speed_hz == pytest.approx(30.0)
    assert found.operating.torque_nm == pytest.approx(70.0 / ratio), "power is what both have in common"
    same = recorded("input", 30.0)
    assert on_drive(machine, [same])[0] is same


def test_an_unknown_shaft_is_refused_by_name(machine: MachineSpec) -> None:
    with pytest.raises(SpecError, match=r"r\.json: operating\.shaft.*allowed: input, output"):
        on_drive(machine, [recorded("middle", 30.0)])


def test_pulses_that_make_another_speed_are_refused(machine: MachineSpec) -> None:
    assert on_drive(machine, [recorded("input", 30.0, tacho=pulses("input", 30.0))])
    assert on_drive(machine, [recorded("input", 30.0, tacho=pulses("input", 60.0, 2))])
    with pytest.raises(SpecError, match=r"pulses_per_revolution: its pulses make 15 Hz, but 30 Hz are stated"):
        on_drive(machine, [recorded("input", 30.0, tacho=pulses("input", 30.0, 2))])


def test_where_no_number_of_pulses_fits_the_speed_is_blamed_as_it_was_stated(machine: MachineSpec) -> None:
    told = r"speed_hz: its pulses make 37\.5 Hz, but 30 Hz are stated.*speed_hz 37\.5 would"
    with pytest.raises(SpecError, match=told):
        on_drive(machine, [recorded("input", 30.0, tacho=pulses("input", 37.5))])
    with pytest.raises(SpecError, match=r"of output go with the 30 Hz stated of input") as caught:
        on_drive(machine, [recorded("input", 30.0, tacho=pulses("output", 12.0))])
    (problem,) = caught.value.problems
    assert "pulses_per_revolution" in problem.field
    assert "would fit" not in str(problem.allowed), "no speed of a shaft whose speed nobody stated"


@pytest.mark.parametrize("per_turn", [1, 64])
def test_pulses_of_another_shaft_are_turned_into_those_of_the_driven(machine: MachineSpec, per_turn: int) -> None:
    teeth = {g.shaft: g.teeth for g in machine.gears}
    ratio = teeth["output"] / teeth["input"]
    at = np.linspace(0.0, 1.9, 4001)
    turned = 30.0 * at + 2.0 * at**2  # the drive runs up from 30 to 37.6 Hz
    counted = np.arange(0.0, turned[-1] / ratio, 1.0 / per_turn)
    own = Tacho(shaft="output", pulse_times_s=np.interp(counted * ratio, turned, at), pulses_per_revolution=per_turn)
    (found,) = on_drive(machine, [recorded("input", 33.8, tacho=own)])
    assert found.tacho is not None and found.tacho.shaft == "input"
    each = found.tacho.pulses_per_revolution
    assert each == max(1, round(per_turn / ratio))
    exact = np.interp(np.arange(found.tacho.pulse_times_s.size) / each, turned, at)
    assert np.max(np.abs(found.tacho.pulse_times_s - exact)) < (1e-3 if per_turn == 1 else 1e-5)
    assert found.tacho.pulse_times_s[-1] > 1.7


def test_pulses_of_another_shaft_that_make_another_speed_are_refused(machine: MachineSpec) -> None:
    teeth = {g.shaft: g.teeth for g in machine.gears}
    slow = 30.0 * teeth["input"] / teeth["output"]
    assert on_drive(machine, [recorded("input", 30.0, tacho=pulses("output", slow))])
    with pytest.raises(SpecError, match=rf"r\.json: tacho\..* its pulses make {1.4 * slow:.4g} Hz, but {slow:.4g} Hz"):
        on_drive(machine, [recorded("input", 30.0, tacho=pulses("output", 1.4 * slow))])
    with pytest.raises(SpecError, match=r"r\.json: tacho\.shaft: is no shaft.*allowed: input, output"):
        on_drive(machine, [recorded("input", 30.0, tacho=pulses("middle", 30.0))])
