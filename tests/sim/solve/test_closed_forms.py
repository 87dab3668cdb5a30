"""One degree of freedom against closed forms, and rigid-body motion."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.core.spec import BodySpec, ForceLoad, MachineSpec
from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.settings import Settings
from tests.strategies.running import drive
from tests.strategies.systems import bare_system

MASS, STIFFNESS = 2.0, 8e5
OMEGA = np.sqrt(STIFFNESS / MASS)
EXACT = Settings(anti_alias=False, estimate_error=False, rtol=1e-10)


def displacement(machine, duration_s=0.2, rate_hz=2000.0):
    response = simulate(
        machine, duration_s=duration_s, output_rate_hz=rate_hz, channels=("mass.y.displacement",), settings=EXACT
    )
    return np.arange(response.signals.shape[1]) / rate_hz, response.signals[0]


def oscillator(ratio, load):
    body = BodySpec(
        name="mass",
        mass_kg=MASS,
        axes="y",
        stiffness_y_n_per_m=STIFFNESS,
        damping_y_ns_per_m=2.0 * ratio * MASS * OMEGA,
    )
    return MachineSpec(name="oscillator", bodies=[body], loads=[load])


@pytest.mark.parametrize("ratio", [0.0, 0.02, 0.5, 0.99])
def test_step_load(ratio):
    t, y = displacement(oscillator(ratio, ForceLoad(body="mass", axis="y", constant_n=16.0)))
    damped = OMEGA * np.sqrt(1.0 - ratio**2)
    decay = np.exp(-ratio * OMEGA * t)
    exact = 16.0 / STIFFNESS * (1.0 - decay * (np.cos(damped * t) + ratio * OMEGA / damped * np.sin(damped * t)))
    assert y == pytest.approx(exact, abs=1e-11 * 16.0 / STIFFNESS)


def test_overdamped_step_load():
    ratio = 3.0
    t, y = displacement(oscillator(ratio, ForceLoad(body="mass", axis="y", constant_n=16.0)))
    root = np.sqrt(ratio**2 - 1.0)
    slow, fast = -OMEGA * (ratio - root), -OMEGA * (ratio + root)
    exact = 16.0 / STIFFNESS * (1.0 + (fast * np.exp(slow * t) - slow * np.exp(fast * t)) / (slow - fast))
    assert y == pytest.approx(exact, abs=1e-10 * 16.0 / STIFFNESS)


@pytest.mark.parametrize("frequency_hz", [25.0, 80.0, 400.0])
def test_sinusoidal_load_from_rest(frequency_hz):
    load = ForceLoad(body="mass", axis="y", amplitude_n=10.0, frequency_hz=frequency_hz)
    t, y = displacement(oscillator(0.0, load))
    w = 2.0 * np.pi * frequency_hz
    scale = 10.0 / (MASS * (OMEGA**2 - w**2))
    exact = scale * (np.sin(w * t) - w / OMEGA * np.sin(OMEGA * t))
    assert y == pytest.approx(exact, abs=1e-8 * np.max(np.abs(exact)))


def test_free_mass_under_a_constant_force():
    system = bare_system(["free.y"], [2.0], load=[3.0])
    run = drive(system, step_s=1e-3, steps=100)
    t = 1e-3 * np.arange(101)
    assert run.states[:, 0] == pytest.approx(0.75 * t**2, rel=1e-11, abs=1e-15)
    assert run.states[:, 1] == pytest.approx(1.5 * t, rel=1e-11, abs=1e-15)


def test_the_mesh_cannot_change_the_rigid_body_momentum():
    system = assemble(preset("gear-pair"))
    system = replace(system, load=np.array([25.0, -60.0]))  # out of balance: the shafts run up
    assert system.dofs == ("pinion.theta", "gear.theta")
    radius = [0.001 * z * np.cos(np.radians(20.0)) for z in (23, 81)]
    step_s, steps = 1.0 / 60_000.0, 1200
    run = drive(system, step_s=step_s, steps=steps, rtol=1e-10)
    # the mesh force acts with -R_p on the pinion and +R_g on the gear, so it drops out of this sum
    momentum = run.states[:, 2:] @ (system.mass * radius[::-1])
    exact = (25.0 * radius[1] - 60.0 * radius[0]) * step_s * np.arange(steps + 1)
    assert momentum == pytest.approx(exact, abs=1e-9 * np.max(np.abs(exact)))
