"""Machines that would run away or drift are refused; slip reaches the frequencies."""

from __future__ import annotations

import pytest

from sim.assembly.assemble import assemble
from sim.core.errors import SpecError
from sim.core.spec import TermSpec, TorqueLoad
from sim.presets import preset


def test_torques_out_of_balance_are_refused():
    loads = [TorqueLoad(shaft="input", torque_nm=25.0), TorqueLoad(shaft="output", torque_nm=-10.0)]
    with pytest.raises(SpecError, match="not in balance"):
        assemble(preset("paper").model_copy(update={"loads": loads}))


def test_torques_on_one_shaft_add_up():
    one = assemble(preset("paper"))
    loads = [TorqueLoad(shaft="input", torque_nm=20.0), TorqueLoad(shaft="input", torque_nm=5.0)]
    two = assemble(preset("paper").model_copy(update={"loads": loads}))
    assert two.load == pytest.approx(one.load)


def test_two_turning_masses_on_a_shaft_need_a_stiffness():
    machine = preset("paper")
    shafts = [s.model_copy(update={"torsional_stiffness_nm_per_rad": None}) for s in machine.shafts]
    with pytest.raises(SpecError) as caught:
        assemble(machine.model_copy(update={"shafts": shafts}))
    assert caught.value.problems[0].field == "shafts.input.torsional_stiffness_nm_per_rad"


def test_cage_slip_moves_the_bearing_frequencies():
    machine = preset("paper")
    slipping = machine.model_copy(
        update={"terms": [TermSpec(term="cage_slip", site="bearing1", parameters={"share": 0.02})]}
    )
    sound, slow = assemble(machine).bases_hz, assemble(slipping).bases_hz
    assert slow["f_o1"] == pytest.approx(0.98 * sound["f_o1"])
    assert slow["f_c1"] == pytest.approx(0.98 * sound["f_c1"])
    assert slow["f_o1"] + slow["f_i1"] == pytest.approx(7 * sound["f_r1"])
    assert slow["f_o2"] == sound["f_o2"]
