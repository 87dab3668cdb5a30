"""Shares of the bearings of a flexible shaft, and the reach of the mesh tables that follows from them."""

from __future__ import annotations

import pytest

from sim.assembly.levers import lever
from sim.assembly.play import mesh_play
from sim.presets import preset

MACHINE = preset("overhung")
SPRINGS = dict.fromkeys((b.name for b in MACHINE.bearings), 1e8)


def test_shares_are_those_of_moments_about_the_bearings():
    """Pinion at 0.170 m, bearings at 0.015 and 0.125 m: (0.125 - 0.170)/0.110 and (0.170 - 0.015)/0.110."""
    found = lever(MACHINE, MACHINE.shafts[0], "pinion", SPRINGS)
    assert found.shares == pytest.approx({"bearing1": -0.045 / 0.11, "bearing2": 0.155 / 0.11})
    rigid = (0.045 / 0.11) ** 2 / 1e8 + (0.155 / 0.11) ** 2 / 1e8
    assert found.deflection_m_per_n > rigid, "springs alone, then bending on top"
    assert found.slope_rad_per_n > (0.155 + 0.045) / 0.11**2 / 1e8


def test_tables_cover_slack_by_the_lever():
    """20 um at the bearing beside the pinion move it by 20 um times 0.155/0.110, with a margin of a quarter."""
    mesh = MACHINE.meshes[0]
    still = mesh_play(MACHINE, mesh, 0.0, {})
    loose = mesh_play(MACHINE, mesh, 0.0, {"bearing2": 2e-5})
    assert loose.centre_m - still.centre_m == pytest.approx(1.25 * 2e-5 * 0.155 / 0.11)
    assert loose.tilt_rad > still.tilt_rad
