"""Impacts of no order are a ball's only if its order is hinted at."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from reconcile.kinematics.faint import impulsive_report
from reconcile.kinematics.shafts import Impulsiveness
from tests.strategies.brief import N, recorded, sound

FOUND = Impulsiveness(channel="a0", now=9.0, before=0.0, band_hz=(2000.0, 4000.0), label="test 1")


@pytest.mark.parametrize(("z", "likely"), [(1.5, False), (4.0, True)])
def test_a_ball_is_likely_where_its_order_is_hinted_at(z: float, likely: bool) -> None:
    ball: Any = SimpleNamespace(family=SimpleNamespace(kind="ball", site="bearing1"), z=z)
    report = impulsive_report(FOUND, [ball], ["bearing1", "bearing2"])
    assert report.verdict == "ambiguous" and ("is likely" in report.sentence) is likely
    assert ("from outside" in report.sentence) is not likely
    assert (report.causes[0].score > report.causes[-1].score) is likely


@pytest.mark.slow
def test_noise_alone_is_no_sound_machine() -> None:
    bearing = {"name": "bearing1", "shaft": "shaft", "catalogue": "6205"}
    spec = read_kinematic_spec({"kinematics": {"shafts": [{"name": "shaft"}], "bearings": [bearing]}})
    noise = reconcile_kinematics(spec, [recorded(np.random.default_rng(3).standard_normal(N))], [], seed=0)
    assert noise.verdict == "not_decidable" and "not heard" in noise.sentence and not noise.causes
    assert reconcile_kinematics(spec, [recorded(sound(3))], [], seed=0).verdict == "nothing_missing"
