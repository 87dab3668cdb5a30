"""Tooth pairs come and go in jumps; sampled, they leave no lines where nothing is."""

from __future__ import annotations

import numpy as np
import pytest

from sim.core.spec import TermSpec
from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.settings import Settings
from tests.strategies.systems import with_terms

PAIR = preset("gear-pair")
CRACK = with_terms(PAIR, TermSpec(term="tooth_crack", site="pinion", parameters={"depth": 0.3}))
CHANNEL, MESH_HZ, SPAN_S = "pinion.theta.acceleration", 690.0, 1.0


def lines(machine, rate_hz, **settings):
    """Amplitudes at whole Hz of the settled motion, and the frequencies, up to the pass band's end."""
    chosen = Settings(estimate_error=False, **settings)
    span = SPAN_S + 0.2
    response = simulate(machine, duration_s=span, output_rate_hz=rate_hz, channels=(CHANNEL,), settings=chosen)
    settled = response.signals[0, -round(SPAN_S * rate_hz) :]
    amplitude = 2.0 * np.abs(np.fft.rfft(settled)) / settled.size
    amplitude[0] = 0.0
    hz = np.arange(amplitude.size) / SPAN_S
    return hz[hz <= 0.4 * rate_hz], amplitude[hz <= 0.4 * rate_hz]


def strongest_image_db(rate_hz, **settings):
    hz, amplitude = lines(PAIR, rate_hz, **settings)
    between = np.abs(hz - MESH_HZ * np.round(hz / MESH_HZ)) > 0.5 / SPAN_S
    return 20.0 * np.log10(amplitude[between].max() / amplitude.max())


@pytest.mark.slow
@pytest.mark.parametrize(
    ("rate_hz", "steps", "allowed_db"), [(24_000.0, 2, -56.0), (30_000.0, 2, -62.0), (48_000.0, 2, -74.0)]
)
def test_images_of_the_mesh_lines(rate_hz, steps, allowed_db):
    assert strongest_image_db(rate_hz, steps_per_output=steps) < allowed_db
    assert strongest_image_db(rate_hz, steps_per_output=steps, anti_alias=False) > -40.0, "unfiltered, they fold"


@pytest.mark.slow
@pytest.mark.parametrize("machine", [PAIR, CRACK], ids=["sound", "crack"])
def test_the_spectrum_does_not_depend_on_the_rate(machine):
    (hz, one), (_, other) = lines(machine, 48_000.0), lines(machine, 96_000.0)
    below = hz <= 15_000.0
    both = one[below], other[: below.size][below]
    assert np.linalg.norm(both[0] - both[1]) < 1e-3 * np.linalg.norm(both[1])


@pytest.mark.slow
def test_the_step_error_does_not_depend_on_where_jumps_fall_between_samples():
    for rate_hz in (50_000.0, 51_000.0, 52_000.0):
        found = simulate(PAIR, duration_s=0.06, output_rate_hz=rate_hz, channels=(CHANNEL,))
        assert found.quality.step_error < 5e-4, rate_hz
