"""Results that mean nothing are refused and say who is to blame; doubtful ones say so; rest is no irregular motion."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from sim.core.errors import Diverged, Meaningless
from sim.core.response import EnergyBalance, Quality
from sim.core.spec import CustomLaw, TermSpec
from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.ensemble import Member, simulate_many
from sim.solve.pilot import step_difference
from sim.solve.trust import doubts
from tests.strategies.systems import with_terms

BALANCE = EnergyBalance(work_j={}, stored_j={}, dissipated_j={}, residual_j=1e-4, scale_j=1.0, limit=0.01)
SOUND = Quality(
    step_s=1e-5,
    steps=10_000,
    refined_steps=0,
    unconverged_steps=0,
    step_error=1e-4,
    step_error_kind="regular",
    transient_end_s=0.0,
    energy=BALANCE,
)
STEEP = {"sign(v)*1e6": "had not settled", "1e8*tanh(x/1e-6)": "unaccounted for"}


def with_law(name, dof, expression):
    machine = preset(name).model_copy(update={"custom_laws": [CustomLaw(name="mine", dof=dof, expression=expression)]})
    return with_terms(machine, TermSpec(term="custom_force", site=dof.split(".")[0]))


def run(machine, seconds=0.1):
    return simulate(machine, duration_s=seconds, output_rate_hz=30_000.0)


@pytest.mark.slow
@pytest.mark.parametrize("expression", STEEP)
def test_a_law_too_steep_for_any_step_is_named(expression):
    machine = with_law("rotor", "bearing1.outer.y", expression)
    with pytest.raises(Meaningless, match=r"custom law 'mine' .bearing1\.custom\.mine. is too steep") as told:
        run(machine)
    assert STEEP[expression] in "; ".join(told.value.reasons)
    (lost,) = simulate_many([Member(machine=machine)], duration_s=0.1, output_rate_hz=30_000.0)
    assert isinstance(lost, Meaningless)


def test_a_law_within_reach_is_taken():
    assert run(with_law("rotor", "bearing1.outer.y", "1e6*x")).quality.doubts == ()


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"energy": replace(BALANCE, residual_j=0.02)}, "2 % of the energy"),
        ({"unconverged_steps": 50}, "0.5 % of the steps"),
        ({"step_error": 3.0}, "level itself"),
    ],
)
def test_a_doubtful_result_says_so(change, said):
    assert doubts(SOUND) == ()
    (sentence,) = doubts(replace(SOUND, **change))
    assert sentence.startswith("DOUBTFUL RESULT") and said in sentence


def test_a_mass_that_sticks_is_not_irregular():
    stuck = TermSpec(term="coulomb_friction", site="mass", parameters={"force": 50.0})
    assert run(with_terms(preset("oscillator"), stuck)).quality.step_error < 1e-2


@pytest.mark.slow
def test_a_spring_far_stiffer_than_the_step_is_doubtful_and_not_irregular():
    quality = run(with_law("oscillator", "mass.y", "1e12*x")).quality
    assert quality.step_error_kind == "regular" and quality.doubts, "it stands still; its ringing is not resolved"


def test_the_difference_of_what_rests_is_taken_over_the_level_it_had():
    t = np.arange(2000) / 1000.0
    ringing = np.exp(-20.0 * t) * np.sin(300.0 * t)
    noise = 1e-6 * np.sin(997.0 * t)
    fine = np.vstack([ringing, np.cumsum(ringing)])
    assert step_difference(fine + [[1], [0]] * noise, fine) < 1e-5
    moving = np.vstack([np.sin(300.0 * t), np.cos(300.0 * t)])
    assert step_difference(1.01 * moving, moving) == pytest.approx(0.01, rel=1e-4)


def test_a_machine_that_diverges_repeats_what_was_odd_about_it():
    heavy = preset("gear-pair").model_copy(
        update={"loads": [preset("gear-pair").loads[0].model_copy(update={"torque_nm": 1e7})]}
    )
    with pytest.raises(Diverged, match="was N mm given for N m"):
        run(heavy)


@pytest.mark.slow
def test_the_end_of_the_path_moves_within_a_step():
    """Held over the step, the contact ratio was wrong by O(h) at every exit: 1.6e-3 at this rate."""
    assert run(preset("two-stage")).quality.step_error < 2e-4
