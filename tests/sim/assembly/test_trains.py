"""Whole machines that must move alike: turned axes, swapped names, split power."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sim.core.spec import TermSpec
from sim.solve.api import simulate
from sim.solve.settings import Settings
from tests.strategies.trains import train

EXACT = Settings(rtol=1e-10, anti_alias=False, estimate_error=False, steps_per_output=4)
ALPHA = math.radians(20.0)
PAIR = {"a": 20, "b": 31}
NAMES = ("a", "b", "a_1.inner", "a_2.outer", "b_1.inner", "b_2.outer")


def run(machine):
    return simulate(machine, duration_s=0.03, output_rate_hz=20_000.0, channels=("all",), settings=EXACT)


def effects(turned_rad):
    """Run-out, unbalance and pitch errors at angles that turn with the machine."""
    return (
        TermSpec(term="eccentricity", site="a", parameters={"radius": 3e-5, "phase": 0.3 + turned_rad}),
        TermSpec(term="eccentricity", site="b", parameters={"radius": 2e-5, "phase": 1.9 + turned_rad}),
        TermSpec(term="unbalance", site="a", parameters={"moment": 5e-4, "phase": turned_rad}),
        TermSpec(term="pitch_error", site="b"),
    )


def same(found, expected):
    assert found == pytest.approx(expected, abs=1e-6 * np.abs(expected).max())


@pytest.mark.slow
@pytest.mark.parametrize("rotation", ["printed", "geared"])
@pytest.mark.parametrize("pairs", [True, False])
def test_turned_axes_show_the_same_machine(rotation, pairs):
    """A tilted centre line with y as line of action is a tilted line of action with x as centre line, turned."""
    common = {"rotation": rotation, "tooth_pairs": pairs, "offset_angle": pairs}
    upright = run(train(PAIR, [("a", "b")], {"a": 30.0}, terms=effects(0.0), centre_distance_form="true", **common))
    cages = {"a": ALPHA, "b": ALPHA}
    turned = run(
        train(
            PAIR, [("a", "b")], {"a": 30.0}, terms=effects(ALPHA), cages_rad=cages, line_of_action="rotated", **common
        )
    )
    for name in ("mesh1.force", "mesh1.centre_distance_error", "a.theta.acceleration", "mesh1.transmission_error"):
        same(turned.signal(name), upright.signal(name))
    for name in NAMES:
        x, y = (upright.signal(f"{name}.{axis}.acceleration") for axis in "xy")
        same(turned.signal(f"{name}.x.acceleration"), math.cos(ALPHA) * x - math.sin(ALPHA) * y)
        same(turned.signal(f"{name}.y.acceleration"), math.sin(ALPHA) * x + math.cos(ALPHA) * y)


@pytest.mark.slow
@pytest.mark.parametrize("line", ["y", "rotated"])
def test_a_pair_named_the_other_way_round_is_its_mirror_image(line):
    """The gear stands at +x of the pinion: swapping the names mirrors x, and the driving gear is then the second."""

    def runouts(mirrored):
        def seen(angle):
            return math.pi - angle if mirrored else angle

        return [
            TermSpec(term="eccentricity", site=n, parameters={"radius": r, "phase": seen(p)})
            for n, r, p in (("a", 3e-5, 0.3), ("b", 2e-5, 1.9))
        ]

    teeth = {"a": 25, "b": 25}
    common = {"line_of_action": line, "centre_distance_form": "true"}
    one = run(train(teeth, [("a", "b")], {"a": 30.0}, terms=runouts(False), **common))
    cages = {"a": math.pi, "b": math.pi}
    other = run(train(teeth, [("b", "a")], {"a": 30.0}, terms=runouts(True), cages_rad=cages, **common))
    same(other.signal("mesh1.force"), -one.signal("mesh1.force"))
    for name in NAMES:
        same(other.signal(f"{name}.x.acceleration"), -one.signal(f"{name}.x.acceleration"))
        same(other.signal(f"{name}.y.acceleration"), one.signal(f"{name}.y.acceleration"))


@pytest.mark.parametrize("line", ["y", "rotated"])
def test_a_shaft_that_drives_two_equal_ones_is_half_of_it_driving_one(line):
    """Opposite tooth forces hold the middle shaft still; each side is a pair with half its inertia and torque."""
    cages = {"a": math.pi}
    both = run(
        train(
            dict.fromkeys("abc", 25),
            [("b", "c"), ("a", "b")],
            {"b": 60.0, "a": -30.0, "c": -30.0},
            cages_rad=cages,
            line_of_action=line,
        )
    )
    half = run(
        train(
            dict.fromkeys("bc", 25),
            [("b", "c")],
            {"b": 30.0},
            held=["b"],
            inertia_share={"b": 0.5},
            line_of_action=line,
        )
    )
    largest = np.abs(both.signal("c.y.displacement")).max()
    assert np.abs(both.signal("b.y.displacement")).max() < 1e-9 * largest
    for name in ("c.y.acceleration", "c_1.outer.x.acceleration", "c.theta.acceleration", "mesh1.force"):
        same(both.signal(name), half.signal(name))
    same(both.signal("a.y.acceleration"), -both.signal("c.y.acceleration"))
    same(both.signal("mesh2.force"), -both.signal("mesh1.force"))
