"""In which sense shafts turn, and what follows that sense."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.assembly.kinematics import kinematics
from sim.assembly.laws import site_context
from sim.assembly.senses import senses
from sim.core.errors import SpecError
from sim.core.spec import OperatingSpec, TermSpec
from sim.parts.mesh_kernels import H_DRIVE, H_GAPS_G, H_GAPS_P, H_NORMAL_X, H_NORMAL_Y, H_SENSE_G, H_SENSE_P
from sim.presets import names, preset
from sim.solve.api import simulate
from sim.solve.settings import Settings
from tests.strategies.trains import train

CHAIN = {"a": 20, "b": 30, "c": 25}
ROW = (("a", "b"), ("b", "c"))
EXACT = Settings(rtol=1e-10, anti_alias=False, estimate_error=False, steps_per_output=4)


def element(system, name):
    return next(e for e in system.elements if e.name == name)


def run(machine, duration_s=0.03):
    return simulate(machine, duration_s=duration_s, output_rate_hz=20_000.0, channels=("all",), settings=EXACT)


def test_shafts_alternate_through_meshes_from_the_printed_pinion():
    found = senses(train(CHAIN, ROW, {"a": 20.0}))
    assert found.geared
    assert [found.rotors[f"shaft_{n}"] for n in "abc"] == [-1.0, 1.0, -1.0]
    assert found.rings["b"] == found.rotors["b"] == 1.0


def test_the_driven_end_does_not_decide():
    forward, back = (senses(train(CHAIN, ROW, {n: 20.0})) for n in "ac")
    assert forward.rotors == back.rotors


def test_printed_turns_all_balls_alike_and_run_out_of_driven_gears_back():
    found = senses(train(CHAIN, ROW, {"a": 20.0}, rotation="printed"))
    assert set(found.rings.values()) == {1.0}
    assert [found.rotors[n] for n in "abc"] == [1.0, -1.0, -1.0]


def test_a_shaft_without_mesh_turns_from_x_to_y():
    assert set(senses(preset("rotor")).rotors.values()) == {1.0}


def test_an_odd_loop_is_refused_unless_printed():
    equal = dict.fromkeys("abc", 25)
    loop = (*ROW, ("c", "a"))
    with pytest.raises(SpecError, match=r"meshes\.mesh3.*same sense"):
        assemble(train(equal, loop, {"a": 20.0}))
    assemble(train(equal, loop, {"a": 20.0, "b": -10.0, "c": -10.0}, rotation="printed"))


def test_geared_is_the_default_and_every_preset_says_its_own():
    assert OperatingSpec(shaft="input", speed_hz=1.0).rotation == "geared"
    for name in names():
        operating = preset(name).operating
        if operating is not None:
            assert "rotation" in operating.model_fields_set
            assert operating.rotation == ("printed" if name.startswith("paper") else "geared")


def test_effects_are_told_the_sense_of_their_site():
    machine = train(CHAIN, ROW, {"a": 20.0}, rotation="printed")
    kin = kinematics(machine)
    assert [site_context(machine, kin, site, 0).sense for site in ("b", "b_1", "mesh1")] == [-1.0, 1.0, 1.0]
    machine = train(CHAIN, ROW, {"a": 20.0})
    kin = kinematics(machine)
    found = [site_context(machine, kin, site, 0).sense for site in ("b", "b_1", "shaft_b", "mesh1")]
    assert found == [1.0, 1.0, 1.0, -1.0]


@pytest.mark.parametrize("rotation", ["printed", "geared"])
def test_balls_turn_in_the_sense_of_their_shaft(rotation):
    system = assemble(train(CHAIN, ROW, {"a": 20.0}, rotation=rotation))
    ratio = 0.5 * (1.0 - 0.25)
    for name, sense in {"a": -1.0, "b": 1.0, "c": -1.0}.items():
        expected = ratio * (sense if rotation == "geared" else 1.0)
        assert element(system, f"{name}_1").parameters[3] == pytest.approx(expected)


def test_the_loaded_flank_agrees_with_the_sense_of_the_pinion():
    """A pinion that turns from y to x pushes the gear at +x along -y: force on the pinion +y; and the mirror image."""
    system = assemble(train(CHAIN, ROW, {"a": 20.0}))
    first, second = (element(system, f"mesh{i}").parameters for i in (1, 2))
    assert (first[H_SENSE_P], first[H_SENSE_G], first[H_NORMAL_Y]) == (-1.0, 1.0, 1.0)
    assert (second[H_SENSE_P], second[H_SENSE_G], second[H_NORMAL_Y]) == (1.0, -1.0, -1.0)


@pytest.mark.parametrize("driver", ["a", "b"])
def test_the_force_pushes_the_gears_apart_whichever_drives(driver):
    system = assemble(train({"a": 25, "b": 25}, [("a", "b")], {driver: 20.0}, line_of_action="rotated"))
    mesh = element(system, "mesh1").parameters
    force = 1.0 if driver == "a" else -1.0
    assert mesh[H_DRIVE] == force
    assert force * mesh[H_NORMAL_X] == pytest.approx(-math.sin(math.radians(20.0)))


def test_an_idler_carries_both_tooth_forces_on_one_side():
    response = run(train(CHAIN, ROW, {"a": 20.0}), 0.1)
    mean = {n: response.signal(f"{n}_1.outer.y.displacement")[1000:].mean() for n in "abc"}
    assert mean["a"] > 0.0
    assert mean["b"] / mean["a"] == pytest.approx(-2.0, rel=0.02)
    assert mean["c"] / mean["a"] == pytest.approx(1.0, rel=0.02)


def test_unbalances_of_one_shaft_add_as_vectors():
    gears = (("b", 3e-4, 0.4), ("d", 5e-4, 2.0))
    machine = train({**CHAIN, "d": 30}, (*ROW, ("d", "c")), {"a": 20.0})
    together = machine.model_copy(
        update={
            "gears": [g.model_copy(update={"shaft": "shaft_b"}) if g.name == "d" else g for g in machine.gears],
            "shafts": [s for s in machine.shafts if s.name != "shaft_d"],
            "terms": [TermSpec(term="unbalance", site=n, parameters={"moment": u, "phase": p}) for n, u, p in gears],
        }
    )
    response = run(together)
    omega = 2.0 * math.pi * 20.0 * 20 / 30
    t = np.arange(response.signals.shape[1]) / response.sampling_rate_hz
    turning = omega**2 * sum(u * np.exp(1j * p) for _, u, p in gears) * np.exp(1j * omega * t)
    for axis, expected in (("x", turning.real), ("y", turning.imag)):
        total = sum(response.signal(f"{n}.unbalance.force_{axis}") for n, _, _ in gears)
        # observed at the last collocation node's context, which ends the step; the first sample precedes it
        assert total[1:] == pytest.approx(expected[1:], abs=1e-9 * np.abs(turning).max())


def test_a_tooth_out_of_place_opens_one_mesh_of_an_idler_and_closes_the_other_half_a_turn_later():
    machine = train(CHAIN, ROW, {"a": 20.0}, terms=[TermSpec(term="pitch_error", site="b")])
    first, second = (element(assemble(machine), f"mesh{i}").parameters for i in (1, 2))
    as_gear = first[int(first[H_GAPS_G]) :][: CHAIN["b"]]
    as_pinion = second[int(second[H_GAPS_P]) :][: CHAIN["b"]]
    assert np.ptp(as_gear) > 0.0
    assert np.array_equal(as_pinion, -np.roll(as_gear, CHAIN["b"] // 2))
