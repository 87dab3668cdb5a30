"""Parameter files: bounds of sizes, the centre distance, and what the equations take for themselves."""

from __future__ import annotations

import pytest

from sim.core.errors import SpecError
from sim.presets.reference import machine_from_reference, reference_machine
from tests.sim.presets.needed import GRID, NEEDED, ROWS


def test_a_centre_distance_far_off_is_told_with_the_range() -> None:
    for distance in (0.05, 0.2):
        with pytest.raises(SpecError) as caught:
            machine_from_reference(NEEDED | {"a0": distance}, ROWS, GRID)
        (problem,) = caught.value.problems
        assert (problem.field, problem.given, problem.unit) == ("parameters.a0", distance, "m")
        low, high = map(float, problem.allowed.split(" to "))
        assert low < 0.104 < high and 0.5e-3 < high - 0.104 < 3e-3


@pytest.mark.parametrize("name", ["mp_", "ms", "ks", "kf", "kre", "m", "W", "L", "a0", "Rb_pin", "g1"])
def test_absurdly_small_sizes_are_refused_by_name(name: str) -> None:
    with pytest.raises(SpecError, match=f"parameters.{name}: is out of bounds"):
        machine_from_reference(NEEDED | {name: 1e-320}, ROWS, GRID)


def test_the_output_torque_is_the_balance_whatever_the_file_says() -> None:
    """The reference equations have -T Rb_ge / Rb_pin on the output shaft; Tout in a file only repeats it."""
    plain = reference_machine(NEEDED, table=ROWS, errors=GRID)
    for tout in (80.0, -88.0, 0.0):
        built = reference_machine(NEEDED | {"Tout": tout}, table=ROWS, errors=GRID)
        assert built.machine == plain.machine
        assert any(f"Tout = {tout:g} N m is not T Rb_ge / Rb_pin" in warning for warning in built.warnings)
    assert not reference_machine(NEEDED | {"Tout": NEEDED["T"] * 81 / 23}, table=ROWS, errors=GRID).warnings


def test_gravity_of_a_file_acts_along_y() -> None:
    assert machine_from_reference(NEEDED | {"gravity": 9.81}, ROWS, GRID).gravity_m_per_s2 == 9.81


def test_refusals_of_missing_and_contradicting_numbers_say_what_is_allowed() -> None:
    for gone, words in (("kf", "1e-06 to 1e+10"), ("z1", "a whole number, 6 to 2000"), ("nb1", "a whole number")):
        with pytest.raises(SpecError) as caught:
            machine_from_reference({k: v for k, v in NEEDED.items() if k != gone}, ROWS, GRID)
        (problem,) = caught.value.problems
        assert problem.field == f"parameters.{gone}"
        assert words in problem.allowed
    with pytest.raises(SpecError) as caught:
        machine_from_reference(NEEDED | {"fm": 1.0}, ROWS, GRID)
    (problem,) = caught.value.problems
    assert problem.given == 1.0
    assert problem.allowed.startswith("690 (within 0.0001 of it)")


def test_a_speed_that_would_fit_as_rpm_is_told_so() -> None:
    with pytest.raises(SpecError, match=r"fr1: is out of bounds \(it would fit as rpm.*given 1800"):
        machine_from_reference(NEEDED | {"fr1": 1800.0}, ROWS, GRID)
