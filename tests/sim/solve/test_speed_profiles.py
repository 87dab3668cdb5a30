"""Machines whose speed changes: channels, inertia torques, lanes, and orders that stay where they are."""

from __future__ import annotations

import numpy as np
import pytest

from sim.core.response import Response
from sim.core.spec import FluctuatingSpeed, MachineSpec, MeasuredSpeed, RampSpeed, SpeedProfile
from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.ensemble import Member, simulate_many
from sim.solve.settings import Settings
from sim.solve.transient import transient_end_s

QUICK = Settings(estimate_error=False)
ANGLE = ("input.angle", "input.speed", "input.acceleration")


def turning(name: str, profile: SpeedProfile | None) -> MachineSpec:
    machine = preset(name)
    assert machine.operating is not None
    return machine.model_copy(update={"operating": machine.operating.model_copy(update={"profile": profile})})


def test_channels_follow_the_profile():
    machine = turning("paper", RampSpeed(end_ratio=0.5, duration_s=0.1))
    found = simulate(machine, duration_s=0.15, output_rate_hz=20_000.0, channels=ANGLE, settings=QUICK)
    nominal = 2.0 * np.pi * 30.0
    angle, speed, acceleration = found.signals
    t = np.arange(angle.size) / 20_000.0
    inner = (t > 0.02) & (t < 0.08)  # away from the kink, which the anti-alias filter rounds
    np.testing.assert_allclose(speed[inner], nominal * (1.0 - 5.0 * t[inner]), rtol=1e-4)
    np.testing.assert_allclose(angle[inner], nominal * (t[inner] - 2.5 * t[inner] ** 2), rtol=1e-4)
    np.testing.assert_allclose(acceleration[inner], -5.0 * nominal, rtol=1e-3)
    (told,) = (text for text in found.warnings if "speed varies" in text)
    assert told.startswith("the speed varies by 50 % of the nominal one until 0.0997 s") and "sharp after it" in told
    assert found.bases_hz["f_r1"] == pytest.approx(30.0 * (0.75 * 0.1 + 0.5 * 0.05) / 0.15)


def test_a_ramp_that_is_not_over_smears_all_lines():
    machine = turning("paper", RampSpeed(end_ratio=0.5, duration_s=0.05))
    found = simulate(machine, duration_s=0.052, output_rate_hz=20_000.0, channels=ANGLE, settings=QUICK)
    assert any("lines smear in spectra over time; orders stay sharp" in text for text in found.warnings)


@pytest.mark.slow
def test_a_ramp_loads_the_teeth_by_the_driven_inertia():
    """Extra mesh force of a steady ramp: the driven side's inertia times its acceleration, over the base radius."""
    still, ramp = (
        simulate(
            turning("paper", profile),
            duration_s=0.6,
            output_rate_hz=10_000.0,
            channels=("mesh1.force",),
            settings=QUICK,
        ).signals[0]
        for profile in (None, RampSpeed(end_ratio=2.0, duration_s=1.0))
    )
    machine = preset("paper")
    pinion, gear = machine.gears
    output = next(s for s in machine.shafts if s.name == gear.shaft)
    acceleration = 2.0 * np.pi * 30.0 * pinion.teeth / gear.teeth
    inertia = (gear.inertia_kg_m2 or 0.0) + (output.end_inertia_kg_m2 or 0.0)
    radius = 0.5 * gear.module_m * gear.teeth * np.cos(np.radians(gear.pressure_angle_deg))
    tail = slice(3000, None)
    assert ramp[tail].mean() - still[tail].mean() == pytest.approx(inertia * acceleration / radius, rel=0.02)


@pytest.mark.slow
@pytest.mark.parametrize(
    "profile",
    [
        RampSpeed(end_ratio=0.7, duration_s=0.02),
        FluctuatingSpeed(amplitude=0.05, frequency_hz=20.0, random_rms=0.01, correlation_s=0.05),
        MeasuredSpeed(step_s=0.01, ratios=(1.0, 0.9, 1.1, 1.0)),
    ],
)
def test_lanes_equal_the_single_solver(profile):
    machine = turning("paper-demo", profile)
    single = simulate(machine, duration_s=0.03, output_rate_hz=20_000.0, settings=QUICK)
    (lane,) = simulate_many([Member(machine=machine)], duration_s=0.03, output_rate_hz=20_000.0, settings=QUICK)
    assert isinstance(lane, Response)
    size = np.abs(single.signals).max()
    np.testing.assert_allclose(lane.signals, single.signals, atol=1e-9 * size)


def test_a_flat_profile_is_the_constant_speed():
    plain = simulate(turning("paper", None), duration_s=0.03, output_rate_hz=20_000.0, settings=QUICK)
    flat = turning("paper", MeasuredSpeed(step_s=0.01, ratios=(1.0, 1.0, 1.0)))
    found = simulate(flat, duration_s=0.03, output_rate_hz=20_000.0, settings=QUICK)
    np.testing.assert_allclose(found.signals, plain.signals, atol=1e-9 * np.abs(plain.signals).max())
    assert found.quality.energy.residual_j == pytest.approx(plain.quality.energy.residual_j, abs=1e-6)


def test_energy_closes_under_a_fluctuating_speed():
    machine = turning("paper-lightly-damped", FluctuatingSpeed(amplitude=0.1, frequency_hz=10.0))
    found = simulate(machine, duration_s=0.3, output_rate_hz=20_000.0, settings=QUICK)
    energy = found.quality.energy
    assert abs(energy.residual_j) < 1e-3 * energy.scale_j


@pytest.mark.slow
def test_dynamic_angles_do_not_drift():
    """Torques of printed values leave a rest; where angles follow the torsion it would add up to a speed."""
    machine = preset("paper-lightly-damped")
    assert machine.operating is not None
    operating = machine.operating.model_copy(update={"kinematics": "dynamic"})
    found = simulate(
        machine.model_copy(update={"operating": operating}),
        duration_s=1.0,
        output_rate_hz=5_000.0,
        channels=("pinion.theta.velocity",),
        settings=QUICK,
    )
    assert transient_end_s(found.signals, 5_000.0, 1.0 / 30.0) < 0.8
    assert abs(found.signals[0, 4000:].mean()) < 0.05
