"""A report of any level says which versions, seed and processor time are behind it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from app.version import VERSION
from reconcile.driven import reconcile_driven
from reconcile.entry import reconcile_recordings
from reconcile.machine.engine import reconcile_machine
from reconcile.origin import METHOD_VERSION
from reconcile.verdict import Report
from signals.recording import Operating, Recording
from sim.core.response import Channel
from sim.presets import preset
from sim.version import PHYSICS_VERSION
from tests.reconcile.test_stated import SPEC, quiet


def _driven() -> Report:
    rng = np.random.default_rng(0)
    channels = (
        Channel(name="force", quantity="force", unit="N", location="drive", axis="x"),
        Channel(name="move", quantity="displacement", unit="m", location="mass", axis="x"),
    )
    samples = rng.standard_normal((2, 3000))
    return reconcile_driven(
        preset("oscillator"), [Recording(sampling_rate_hz=100.0, channels=channels, samples=samples)], seed=7
    )


def _dead_machine() -> Report:
    one = quiet()
    dead = replace(one, samples=np.zeros_like(one.samples), operating=Operating(shaft="input", speed_hz=30.0))
    return reconcile_machine(preset("paper-lightly-damped"), [dead], [], seed=7)


def _dead_kinematics() -> Report:
    one = quiet()
    return reconcile_recordings(SPEC, [replace(one, samples=np.zeros_like(one.samples))], seed=7)


def _kinematics() -> Report:
    return reconcile_recordings(SPEC, [quiet()], seed=7)


@pytest.mark.slow
@pytest.mark.parametrize("made", [_kinematics, _dead_kinematics, _dead_machine, _driven])
def test_every_level_says_versions_seed_and_cost(made: Callable[[], Report]) -> None:
    said = made().provenance
    assert (said["physics_version"], said["package_version"], said["seed"]) == (PHYSICS_VERSION, VERSION, 7)
    assert said["method_version"] == METHOD_VERSION
    cost = said["cost"]
    assert isinstance(cost, dict) and 0.0 < cost["core_s"] < 600.0
