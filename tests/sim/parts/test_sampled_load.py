"""Measured inputs: closed forms of an oscillator under sampled forces and motions."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sim.core.errors import SpecError
from sim.core.spec import BodySpec, CustomLaw, MachineSpec, MeasuredLoad, TermSpec
from sim.parts.sampled_load import weights
from sim.solve.api import simulate

K, C, M = 1e5, 60.0, 1.0


def oscillator(load: MeasuredLoad) -> MachineSpec:
    body = BodySpec(name="mass", mass_kg=M, axes="y", stiffness_y_n_per_m=K, damping_y_ns_per_m=C)
    return MachineSpec(name="oscillator", bodies=[body], loads=[load])


def steady(frequency_hz: float, t: np.ndarray, *, base: bool) -> np.ndarray:
    w = 2 * math.pi * frequency_hz
    drive = complex(K, w * C) if base else 1.0
    return np.asarray((drive / complex(K - M * w * w, w * C) * np.exp(1j * w * t)).imag)


def response(load: MeasuredLoad, duration_s: float, rate_hz: float) -> np.ndarray:
    found = simulate(oscillator(load), duration_s=duration_s, output_rate_hz=rate_hz, channels=["mass.y.displacement"])
    return np.asarray(found.signals[0])


@pytest.mark.parametrize("base", [False, True])
def test_three_samples_a_period_are_enough(base: bool) -> None:
    """Sampled at 3 per period; the steady response is the closed form's within 0.1 % of its size."""
    frequency, rate = 100.0, 310.0
    samples = np.sin(2 * math.pi * frequency * np.arange(310) / rate)
    quantity = "displacement" if base else "force"
    load = MeasuredLoad(body="mass", axis="y", quantity=quantity, step_s=1 / rate, values=tuple(samples.tolist()))
    found = response(load, 0.9, 6200.0)
    t = np.arange(found.size) / 6200.0
    kept = (t > 0.5) & (t < 0.85)
    expected = steady(frequency, t, base=base)
    assert np.max(np.abs(found - expected)[kept]) < 1e-3 * np.max(np.abs(expected))


@pytest.mark.parametrize("interpolation", ["hold", "linear", "band_limited"])
def test_a_constant_stays_a_constant(interpolation: str) -> None:
    values = (3.0,) * 20
    load = MeasuredLoad(body="mass", axis="y", step_s=0.01, values=values, factor=2.0, interpolation=interpolation)
    assert response(load, 1.0, 2000.0)[-1] == pytest.approx(6.0 / K, rel=1e-9)


def test_held_samples_step() -> None:
    """From rest under a force that steps on at 0.1 s: the closed form of a damped oscillator."""
    load = MeasuredLoad(body="mass", axis="y", step_s=0.1, values=(0.0, 1.0, 1.0), interpolation="hold")
    found = response(load, 0.2, 4000.0)
    t = np.arange(found.size) / 4000.0 - 0.1
    decay = C / (2 * M)
    w = math.sqrt(K / M - decay**2)
    expected = np.where(t > 0, (1 - np.exp(-decay * t) * (np.cos(w * t) + decay / w * np.sin(w * t))) / K, 0.0)
    assert np.max(np.abs(found - expected)) < 0.02 / K


@given(st.integers(0, 256))
def test_weights_of_a_row_sum_to_one(row: int) -> None:
    for kind in ("hold", "linear", "band_limited"):
        assert weights(kind)[row].sum() == pytest.approx(1.0, abs=1e-12)


def test_samples_are_met_exactly() -> None:
    row = weights("band_limited")[0]
    assert row[11] == pytest.approx(1.0)
    assert np.delete(row, 11) == pytest.approx(np.zeros(23), abs=1e-15)


def test_a_motion_needs_a_spring_to_enter() -> None:
    load = MeasuredLoad(body="mass", axis="y", quantity="displacement", step_s=0.1, values=(0.0, 1.0))
    free = MachineSpec(
        name="free",
        bodies=[BodySpec(name="mass", mass_kg=1.0, axes="y")],
        loads=[load],
        custom_laws=[CustomLaw(name="spring", dof="mass.y", expression="10*x")],
        terms=[TermSpec(term="custom_force", site="mass", parameters={"law": 1.0})],
    )
    with pytest.raises(SpecError, match="stiffness_y"):
        simulate(free, duration_s=0.1, output_rate_hz=1000.0)


def test_a_load_on_a_direction_that_cannot_move_is_refused() -> None:
    load = MeasuredLoad(body="mass", axis="x", step_s=0.1, values=(0.0, 1.0))
    with pytest.raises(SpecError, match=r"mass\.x"):
        response(load, 0.1, 1000.0)


def test_specification_survives_json() -> None:
    machine = oscillator(MeasuredLoad(body="mass", axis="y", step_s=0.1, values=(0.0, 1.5)))
    assert MachineSpec.model_validate_json(machine.model_dump_json()) == machine
