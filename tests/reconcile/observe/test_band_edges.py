"""A line of the teeth is in one band in all recordings of a point, wherever third octaves would end."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.observe.observation import observe
from reconcile.observe.statistics import CLEAR_OF_LINES, SHAPE_BANDS_HZ, bands_beside, third_octaves
from reconcile.observe.watch import bases_at, watch_list
from signals.recording import Operating, Recording
from sim.core.response import Channel
from sim.presets import preset

TEETH = 21
RATE_HZ = 10_000


def test_edges_stand_clear_of_lines_and_elsewhere_where_they_were():
    lines = [504.0, 1008.0, 2016.5]
    found, usual = bands_beside(lines).edges_hz, third_octaves()
    assert all(np.min(np.abs(found / hz - 1.0)) > 0.99 * CLEAR_OF_LINES for hz in lines)
    assert np.sum(found != usual) == len(lines)
    assert np.all(np.diff(found) > 0.2 * found[:-1])


def test_shape_bands_stand_clear_of_lines_too_and_still_meet():
    found = bands_beside([600.0, 2001.0, 4485.0]).shapes_hz
    assert found[0][1] == found[1][0] == pytest.approx(609.0)
    assert found[1][1] == found[2][0] == pytest.approx(2031.0, abs=1.0)
    assert found[2:] == ((found[2][0], 4500.0), SHAPE_BANDS_HZ[3])


@pytest.mark.parametrize("speed_hz", [18.0, 22.5, 30.0, 36.0, 39.0])
def test_atlases_kept_for_the_proofs_first_machine_are_still_of_the_same_bands(speed_hz):
    machine = preset("paper-lightly-damped")
    assert watch_list(machine).bands(bases_at(machine, speed_hz)).usual
    assert not watch_list(machine).bands(bases_at(machine, 504.0 / 23)).usual


def turning(speed_hz: float, seed: int, stated_hz: float = 24.0) -> Recording:
    """Three lines of the teeth in noise, at another speed than the stated one."""
    rng, t = np.random.default_rng(seed), np.arange(2 * RATE_HZ) / RATE_HZ
    mesh = 2 * np.pi * TEETH * speed_hz * t
    wave = sum((a * np.sin(k * mesh + k) for k, a in ((1, 3.0), (2, 2.0), (3, 1.0))), np.zeros(t.size))
    channel = Channel(name="a", quantity="acceleration", unit="m/s^2", location="bearing1", axis="y")
    return Recording(
        sampling_rate_hz=float(RATE_HZ),
        channels=(channel,),
        samples=(wave + 0.05 * rng.standard_normal(t.size))[None, :],
        operating=Operating(shaft="input", speed_hz=stated_hz),
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


@pytest.mark.slow
def test_the_shape_of_a_band_does_not_hang_on_a_line_at_its_edge():
    machine, stated = preset("overhung"), 600.0 / TEETH
    several = [[turning(stated * f, k, stated)] for k, f in enumerate((1.003, 0.997))]
    (point,) = observe(machine, watch_list(machine), *several)
    change_db = 10 * np.log10(point.test.band / point.baseline.band)[0]
    assert change_db[:2] == pytest.approx([0.0, 0.0], abs=0.5)
