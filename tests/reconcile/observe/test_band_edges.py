"""A line of the teeth is in one band in all recordings of a point, wherever third octaves would end."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.observe.observation import observe
from reconcile.observe.statistics import CLEAR_OF_LINES, band_edges, third_octaves
from reconcile.observe.watch import bases_at, watch_list
from signals.recording import Operating, Recording
from sim.core.response import Channel
from sim.presets import preset

TEETH = 21
RATE_HZ = 10_000


def test_edges_stand_clear_of_lines_and_elsewhere_where_they_were():
    lines = [504.0, 1008.0, 2016.5]
    found, usual = band_edges(lines), third_octaves()
    assert all(np.min(np.abs(found / hz - 1.0)) > 0.99 * CLEAR_OF_LINES for hz in lines)
    assert np.sum(found != usual) == len(lines)
    assert np.all(np.diff(found) > 0.2 * found[:-1])


@pytest.mark.parametrize("speed_hz", [18.0, 22.5, 30.0, 36.0, 39.0])
def test_atlases_kept_for_the_proofs_first_machine_are_still_of_the_same_bands(speed_hz):
    machine = preset("paper-lightly-damped")
    assert np.array_equal(watch_list(machine).edges_hz(bases_at(machine, speed_hz)), third_octaves())


def turning(speed_hz: float, seed: int) -> Recording:
    """Three lines of the teeth in noise, at another speed than the 24 Hz stated."""
    rng, t = np.random.default_rng(seed), np.arange(2 * RATE_HZ) / RATE_HZ
    mesh = 2 * np.pi * TEETH * speed_hz * t
    wave = sum((a * np.sin(k * mesh + k) for k, a in ((1, 3.0), (2, 2.0), (3, 1.0))), np.zeros(t.size))
    channel = Channel(name="a", quantity="acceleration", unit="m/s^2", location="bearing1", axis="y")
    return Recording(
        sampling_rate_hz=float(RATE_HZ),
        channels=(channel,),
        samples=(wave + 0.05 * rng.standard_normal(t.size))[None, :],
        operating=Operating(shaft="input", speed_hz=24.0),
    )


@pytest.mark.slow
@pytest.mark.parametrize("pair", [(24.05, 23.94), (24.0, 24.003), (23.9, 24.1)])
def test_a_slightly_different_speed_moves_no_line_into_another_band(pair):
    machine = preset("overhung")  # its 21 teeth at 24 Hz meet two edges: 504 and 1008 Hz
    (point,) = observe(machine, watch_list(machine), [turning(pair[0], 1)], [turning(pair[1], 2)])
    change_db = 10 * np.log10(point.test.total / point.baseline.total)
    assert np.nanmax(np.abs(change_db)) < 3.0
    powers = np.sort(point.test.total[0][np.isfinite(point.test.total[0])])[-3:]
    assert powers == pytest.approx([0.5, 2.0, 4.5], rel=0.05)
