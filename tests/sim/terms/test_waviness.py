"""Waviness of races: which orders shake the ring, at which frequencies, all round and in a load zone."""

from __future__ import annotations

import numpy as np
import pytest

from signals.recording import from_response
from signals.spectra import amplitude_spectrum
from sim.assembly.assemble import assemble
from sim.parts.bearing.waviness import passes
from sim.solve.api import simulate
from sim.solve.settings import Settings
from sim.terms.inner_waviness import TERM as INNER
from sim.terms.outer_waviness import TERM as OUTER
from tests.strategies.bearings import bearing_with, context_at, element_of, force_at, turned

BALLS = 9
PRELOAD_M = -1e-5


def force_over_time(term, order, points=400):
    """Force (points, 2), N, on centred preloaded rings over one pattern of balls and shaft, and the times, s."""
    machine = bearing_with((term.key, {"amplitude": 1e-8, "order": float(order)}), radial_clearance_m=PRELOAD_M)
    system, element = element_of(machine)
    rate = system.bases_hz["f_o1" if term is OUTER else "f_i1"]
    times = np.arange(points) / points / rate
    return np.array([force_at(element, context_at(system, element, t), np.zeros(2)) for t in times]), times, system


@pytest.mark.slow
@pytest.mark.parametrize("term", [OUTER, INNER], ids=lambda t: t.key)
@pytest.mark.parametrize("k", [1, 2])
def test_loaded_all_round_only_orders_beside_k_z_shake_the_ring(term, k):
    sizes = {}
    for side in (-1, 0, 1, 3):
        forces, _, _ = force_over_time(term, k * BALLS + side)
        sizes[side] = np.max(np.hypot(*forces.T))
    # Z balls of slope 1.5 k sqrt(preload), each pushed by the amplitude, half of it along one direction
    _, element = element_of(bearing_with(radial_clearance_m=PRELOAD_M))
    expected = 0.5 * BALLS * 1.5 * element.parameters[1] * np.sqrt(-PRELOAD_M) * 1e-8
    allowed = term.validation[0].deviation
    assert sizes[-1] == pytest.approx(expected, rel=allowed)
    assert sizes[1] == pytest.approx(expected, rel=allowed)
    assert sizes[0] < allowed * expected
    assert sizes[3] < allowed * expected


@pytest.mark.slow
@pytest.mark.parametrize("k", [1, 2])
@pytest.mark.parametrize("side", [-1, 1])
def test_inner_waves_shake_at_k_f_i_plus_minus_f_r(k, side):
    forces, times, system = force_over_time(INNER, k * BALLS + side)
    line = next(line for line in system.lines if line.mechanism == INNER.key)
    assert line.label == f"{k}*f_i1{side:+d}*f_r1"
    # one turning force of that frequency and no other: its phasor stands still
    phasor = (forces[:, 0] + 1j * forces[:, 1]) * np.exp(2j * np.pi * line.frequency_hz(system.bases_hz) * times)
    back = (forces[:, 0] + 1j * forces[:, 1]) * np.exp(-2j * np.pi * line.frequency_hz(system.bases_hz) * times)
    assert min(np.ptp(np.abs(np.cumsum(p)) / np.arange(1, p.size + 1)) / np.abs(p[0]) for p in (phasor, back)) < 1e-2


def test_passes_are_the_multiples_next_to_the_order():
    assert passes(10, 9)[0] == (1, 1)
    assert passes(8, 9)[0] == (1, -1)
    assert passes(28, 9)[0] == (3, 1)
    assert passes(1, 9)[0] == (0, 1)
    assert passes(4, 9)[0] == (0, 4)


@pytest.mark.slow
@pytest.mark.parametrize("speed_hz", [12.0, 25.0, 40.0])
@pytest.mark.parametrize(("term", "order"), [(OUTER, 28.0), (INNER, 10.0)], ids=["outer", "inner"])
def test_the_first_line_stands_out_where_predicted(term, order, speed_hz):
    spectra = []
    for amplitude in (2e-6, 0.0):
        machine = turned(bearing_with((term.key, {"amplitude": amplitude, "order": order})), speed_hz)
        run = simulate(machine, duration_s=2.2, output_rate_hz=12_000.0, settings=Settings(estimate_error=False))
        recording = from_response(run).select(start_s=0.2)
        spectra.append(amplitude_spectrum(recording.series("bearing1.outer.y.acceleration")))
        if amplitude:
            system = assemble(machine)
    with_waves, without = spectra
    line = next(line for line in system.lines if line.mechanism == term.key)
    expected = line.frequency_hz(system.bases_hz)
    near = np.abs(with_waves.frequency_hz - expected) < 0.45 * speed_hz
    k = np.flatnonzero(near)[np.argmax(with_waves.values[near])]
    assert abs(with_waves.frequency_hz[k] - expected) <= with_waves.resolution_hz
    assert with_waves.values[k] > 2.0 * np.max(without.values[k - 1 : k + 2])
