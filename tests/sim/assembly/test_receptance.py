"""Receptances against closed forms, a sum over modes, reciprocity and a simulated machine that a sine drives."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sim.assembly.assemble import assemble
from sim.assembly.modes import contact_stiffness
from sim.assembly.receptance import receptances
from sim.core.spec import ForceLoad, MachineSpec
from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.settings import Settings

MASS, STIFFNESS, DAMPING = 2.0, 3e5, 40.0
PAPER = assemble(preset("paper-lightly-damped"))


def one_mass(**also: object) -> MachineSpec:
    body = {
        "name": "mass",
        "mass_kg": MASS,
        "axes": "y",
        "stiffness_y_n_per_m": STIFFNESS,
        "damping_y_ns_per_m": DAMPING,
    }
    return MachineSpec.model_validate({"name": "one", "bodies": [body], **also})


@pytest.mark.slow
@given(hz=st.floats(0.1, 5e3))
def test_one_mass_moves_as_the_closed_form_says(hz: float) -> None:
    omega = 2 * np.pi * hz
    found = receptances(assemble(one_mass()), np.array([hz]), forces=["mass.y"], motions=["mass.y"])
    assert found.shape == (1, 1, 1)
    assert found[0, 0, 0] == pytest.approx(1.0 / (STIFFNESS - MASS * omega**2 + 1j * omega * DAMPING), rel=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("hz", [20.0, 61.6, 200.0])
def test_a_simulated_mass_that_a_sine_drives_moves_so(hz: float) -> None:
    amplitude, rate, turns = 5.0, 20000.0, 1.0
    load = ForceLoad(body="mass", axis="y", amplitude_n=amplitude, frequency_hz=hz)
    found = simulate(
        one_mass(loads=[load.model_dump()]), duration_s=3.0 + turns, output_rate_hz=rate,
        channels=["mass.y.displacement"], settings=Settings(rtol=1e-9),
    )  # fmt: skip
    times = np.arange(found.signals.shape[1]) / rate
    t, y = times[times >= 3.0], np.asarray(found.signals)[0, times >= 3.0]
    basis = np.stack([np.cos(2 * np.pi * hz * t), np.sin(2 * np.pi * hz * t), np.ones(t.size)], axis=1)
    cosine, sine, _ = np.linalg.lstsq(basis, y, rcond=None)[0]
    expected = amplitude * abs(receptances(assemble(one_mass()), np.array([hz]), forces=["mass.y"], motions=["mass.y"]))
    assert np.hypot(cosine, sine) == pytest.approx(float(expected[0, 0, 0]), rel=5e-5)


def test_the_undamped_gearbox_is_the_sum_over_its_modes() -> None:
    bare = replace(PAPER, damping=np.zeros_like(PAPER.damping), stiffness=PAPER.stiffness + 1e3 * np.diag(PAPER.mass))
    hz = np.array([40.0, 333.0, 1111.0])
    ends = ["bearing1.outer.y", "resonator3.y", "pinion.theta"]
    root = 1.0 / np.sqrt(bare.mass)
    values, shapes = np.linalg.eigh((bare.stiffness + contact_stiffness(bare)) * root[:, None] * root[None, :])
    shapes = shapes * root[:, None]
    at = [bare.index(name) for name in ends]
    expected = np.stack([(shapes[at] / (values - (2 * np.pi * f) ** 2)) @ shapes[at].T for f in hz])
    found = receptances(bare, hz, forces=ends, motions=ends)
    assert np.allclose(found, expected, rtol=1e-6, atol=1e-9 * np.abs(expected).max())


@pytest.mark.slow
@given(hz=st.floats(1.0, 8e3))
def test_force_and_motion_may_be_exchanged(hz: float) -> None:
    ends = ["bearing1.outer.x", "bearing1.outer.y", "gear.y", "resonator4.y"]
    found = receptances(PAPER, np.array([hz]), forces=ends, motions=ends)[0]
    assert np.allclose(found, found.T, rtol=1e-6, atol=1e-9 * np.abs(found).max())


def test_a_degree_of_freedom_that_is_not_there_is_refused() -> None:
    with pytest.raises(ValueError, match="tuple"):
        receptances(PAPER, np.array([10.0]), forces=["bearing9.outer.y"], motions=["gear.y"])
