"""What rings above the output's Nyquist frequency is not heard below it, whatever the output rate."""

from __future__ import annotations

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.core.spec import BodySpec, ForceLoad, MachineSpec
from sim.solve.api import simulate
from sim.solve.settings import Settings
from sim.solve.step_choice import base_rate_hz, run_cost, steps_per_output

MODE_HZ, OUTPUT_HZ = 12_500.0, 20_000.0
MASS_KG = 0.5


def ringing():
    """A barely damped mass on a spring, struck at t = 0: it rings at 12.5 kHz for longer than the record."""
    omega = 2.0 * np.pi * MODE_HZ
    body = BodySpec(
        name="mass",
        mass_kg=MASS_KG,
        axes="y",
        stiffness_y_n_per_m=MASS_KG * omega**2,
        damping_y_ns_per_m=2e-6 * MASS_KG * omega,
    )
    return MachineSpec(name="bell", bodies=[body], loads=[ForceLoad(body="mass", axis="y", constant_n=1000.0)])


def line(signal, rate_hz, frequency_hz):
    """Amplitude of a line, Hann window, ends left out."""
    inner = signal[200:-200]
    window = np.hanning(inner.size)
    turn = np.exp(-2j * np.pi * frequency_hz / rate_hz * np.arange(inner.size))
    return 2.0 * abs(np.sum((inner - inner.mean()) * window * turn)) / window.sum()


def signal(rate_hz, **settings):
    response = simulate(
        ringing(),
        duration_s=0.2,
        output_rate_hz=rate_hz,
        channels=("mass.y.displacement",),
        settings=Settings(estimate_error=False, **settings),
    )
    return response.signals[0], response.quality.step_s


def test_mode_above_nyquist_leaves_no_line_where_it_would_fold_to():
    truth, _ = signal(160_000.0, anti_alias=False)
    amplitude = line(truth, 160_000.0, MODE_HZ)
    assert amplitude > 0
    folded = OUTPUT_HZ - MODE_HZ
    picked, _ = signal(OUTPUT_HZ, anti_alias=False)
    assert line(picked, OUTPUT_HZ, folded) == pytest.approx(amplitude, rel=0.02), "unfiltered, it does fold"
    filtered, _ = signal(OUTPUT_HZ)
    assert 20.0 * np.log10(line(filtered, OUTPUT_HZ, folded) / amplitude) <= -80.0


def test_output_at_the_base_rate_is_computed_at_twice_that():
    system = assemble(ringing())
    rate_hz = base_rate_hz(system)
    assert steps_per_output(system, rate_hz) == steps_per_output(system, 3.0 * rate_hz) == 2
    assert signal(rate_hz)[1] == pytest.approx(0.5 / rate_hz)
    cost = run_cost(system, duration_s=1.0, output_rate_hz=rate_hz, channels=1)
    assert cost.steps == 2 * rate_hz, "what is asked beforehand is what is done"
