"""The stiffness a crack takes from a pair, against finite elements of the cracked tooth on its body."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve

from sim.parts.gear.crack import crack_compliance_m_per_n, half_root_m
from sim.parts.gear.flank import flank_of
from sim.presets import preset
from sim.terms.tooth_crack import TERM
from tests.strategies.cracked_tooth import Fineness, compliance_m_per_n, plane_stress, quadrilaterals, tooth_mesh
from tests.strategies.harmonic import allowed

MACHINE = preset("paper-lightly-damped")
FINER = Fineness(across=16, up=26, beside=10, down=16)


def gained(flank, depth, angle_deg, fine):
    """Load angles and the compliance gained by elements, m/N."""
    length = 2.0 * half_root_m(flank.tooth, "clamped_at_base") * depth
    mesh = tooth_mesh(flank.tooth, length, math.radians(angle_deg), fine)
    apart, tied = (
        compliance_m_per_n(mesh, flank.tooth, flank.pair.width_m, open_crack=open_) for open_ in (True, False)
    )
    return mesh.alpha_1_rad[1:], apart - tied


def losses(gear, depth, angle_deg):
    """Share of the sound pair's stiffness lost along the path of contact: ours and by elements."""
    flank = flank_of(MACHINE, "mesh1", gear)
    angles, more = gained(flank, depth, angle_deg, Fineness())
    ours = crack_compliance_m_per_n(
        flank.tooth,
        flank.alpha_1_rad,
        flank.pair.width_m,
        "clamped_at_base",
        depth_share=depth,
        angle_rad=math.radians(angle_deg),
    )
    sound = flank.compliance_m_per_n
    return tuple(c / (sound + c) for c in (ours, np.interp(flank.alpha_1_rad, angles, more)))


@pytest.mark.slow
@pytest.mark.parametrize("gear", ["pinion", "gear"])
@pytest.mark.parametrize(("depth", "anywhere"), [(0.1, 0.035), (0.2, 0.05), (0.3, 0.06), (0.4, 0.09), (0.5, None)])
def test_loss_of_stiffness_by_finite_elements(gear, depth, anywhere):
    ours, elements = losses(gear, depth, 70.0)
    limit = allowed(TERM, "test_loss_of_stiffness_by_finite_elements")
    assert np.max(np.abs(ours - elements)) < (anywhere or limit)
    assert abs(np.mean(ours) - np.mean(elements)) < 0.04
    assert np.mean(elements) > 0.01


@pytest.mark.slow
@pytest.mark.parametrize("angle", [45.0, 90.0])
def test_other_angles_lose_about_as_much(angle):
    for depth in (0.2, 0.4):
        ours, elements = losses("gear", depth, angle)
        assert abs(np.mean(ours) - np.mean(elements)) < 0.06


@pytest.mark.slow
def test_the_elements_have_converged():
    flank = flank_of(MACHINE, "mesh1", "pinion")
    coarse, fine = (gained(flank, 0.3, 70.0, f) for f in (Fineness(), FINER))
    inner = flank.alpha_1_rad[5:-5]
    assert np.interp(inner, *coarse) == pytest.approx(np.interp(inner, *fine), rel=0.015)


def test_the_elements_bend_as_a_beam_does():
    length, height, young, poisson = 20.0, 1.0, 2.0e11, 0.3
    x, y = np.meshgrid(np.linspace(0.0, length, 81), np.linspace(-0.5, 0.5, 9) * height)
    ids = np.arange(x.size).reshape(x.shape)
    stiffness = plane_stress(np.stack([x.ravel(), y.ravel()], axis=-1), np.array(quadrilaterals(ids)), young, poisson)
    free = np.setdiff1d(np.arange(2 * x.size), np.concatenate([2 * ids[:, 0], 2 * ids[:, 0] + 1]))
    load = np.zeros(2 * x.size)
    load[2 * ids[4, -1] + 1] = 1.0
    moved = np.zeros(2 * x.size)
    moved[free] = spsolve(stiffness[free][:, free], load[free])
    bending = length**3 / (3.0 * young * height**3 / 12.0)
    shear = 1.2 * length / (0.5 * young / (1.0 + poisson) * height)
    assert moved[2 * ids[0, -1] + 1] == pytest.approx(bending + shear, rel=2e-3)
