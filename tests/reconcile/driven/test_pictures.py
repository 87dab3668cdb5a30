"""Pictures of a driven analysis: axes in the units of what they show, and no force where none is missing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.driven import reconcile_driven
from reconcile.driven.pictures import UNKNOWN_FORCE, Freed, force_pictures, motion_units
from reconcile.force_law.picture import curve
from reconcile.force_law.samples import ForceSamples, even_blocks
from reconcile.report import page
from sim.presets import preset
from tests.reconcile.driven.made import recording


@pytest.mark.parametrize(
    ("unit", "order", "said"),
    [
        ("m", 0, ("m", "m/s")),
        ("m/s", 1, ("m", "m/s")),
        ("m/s^2", 2, ("m", "m/s")),
        ("V", 0, ("V", "V/s")),
        ("V", 1, ("V s", "V")),
        ("uncalibrated", 2, ("uncalibrated s^2", "uncalibrated s")),
    ],
)
def test_displacement_and_velocity_have_the_units_of_what_was_integrated(
    unit: str, order: int, said: tuple[str, str]
) -> None:
    assert motion_units(unit, order) == said


def freed(*, rate: bool) -> Freed:
    rng = np.random.default_rng(5)
    z, v = rng.normal(size=(2, 1200)) * [[1e-3], [0.3]]
    samples = ForceSamples(
        force_n=1e9 * z**3, displacement_m=z, velocity_m_per_s=v, blocks=even_blocks(1200, 12), step_s=1e-3
    )
    return Freed(samples=samples, over=curve(samples, v if rate else z, rng), fitted=None, rate=rate)


def test_the_axes_of_an_acceleration_are_metres_and_metres_a_second() -> None:
    drawn = force_pictures(freed(rate=False), "m/s^2", 2)
    assert drawn["law"]["x_label"] == "displacement, m"
    assert (drawn["force_map"]["x_label"], drawn["force_map"]["y_label"]) == ("displacement, m", "velocity, m/s")
    assert force_pictures(freed(rate=True), "m/s^2", 2)["law"]["x_label"] == "velocity, m/s"
    assert (drawn["law"]["y_label"], drawn["force_map"]["value_label"]) == ("force beyond linear, N", "N")


def test_a_force_in_volts_is_none_in_newtons() -> None:
    drawn = force_pictures(freed(rate=False), "V", 0, calibrated=False)
    assert drawn["law"]["y_label"] == f"force beyond linear, {UNKNOWN_FORCE}"
    assert drawn["force_map"]["value_label"] == UNKNOWN_FORCE


@pytest.mark.slow
def test_where_nothing_is_missing_no_force_is_drawn() -> None:
    sound = reconcile_driven(preset("oscillator"), [recording(None, seed=21)], seed=2)
    assert sound.verdict == "nothing_missing" and sound.pictures["traces"]
    assert not {"law", "force_map"} & set(sound.pictures)
    text = page(replace(sound, pictures={**sound.pictures, **force_pictures(freed(rate=False), "m", 0)}))
    assert "Estimated force" not in text, "nor of a report that still has one"
    assert "Measured and predicted" in text and "predicted by the model" in text
    assert "Improvement on data" not in text and "predicted with it" not in text
