"""The shape of a spall against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.core.spec import TermSpec
from sim.parts.gear.flank import flank_of
from sim.presets import preset
from sim.terms import REGISTRY
from sim.terms.tooth_spall import spall_shape
from tests.strategies.meshes import at_phase, element_of
from tests.strategies.systems import with_terms

TERM = REGISTRY.get("tooth_spall")
MACHINE = preset("gear-pair")
PHASE = 0.85
"""One pair in contact, half way between entry and exit (contact ratio 1.709)."""


def spalled(**values):
    return assemble(with_terms(MACHINE, TermSpec(term="tooth_spall", site="pinion", parameters=values)))


def stiffness(system, phase):
    return at_phase(element_of(system, "mesh1"), 23, phase, np.zeros(5), np.zeros(5)).outputs[3]


@pytest.mark.parametrize("share", [0.2, 0.7, 0.95])
def test_the_pair_loses_the_contact_of_the_lost_width(share):
    """1/k' = 1/k + (1/k_h)(W / (W - w) - 1) with k_h = pi E W / (4 (1 - nu^2)), Yang & Sun 1985."""
    gear = MACHINE.gears[0]
    flat_n_per_m = math.pi * gear.youngs_modulus_pa * gear.face_width_m / (4 * (1 - gear.poisson_ratio**2))
    sound = stiffness(assemble(MACHINE), PHASE)
    expected = 1.0 / (1.0 / sound + (1.0 / (1.0 - share) - 1.0) / flat_n_per_m)
    system = spalled(width=share)
    assert stiffness(system, PHASE) == pytest.approx(expected, rel=TERM.validation[0].deviation)
    assert stiffness(system, PHASE + 1.0) == pytest.approx(sound, rel=1e-9)
    assert stiffness(system, PHASE + 23.0) == pytest.approx(expected, rel=TERM.validation[0].deviation)


def test_a_mate_sinks_in_by_the_sagitta_of_its_curvature():
    flank = flank_of(MACHINE, "mesh1", "pinion")
    values = TERM.values({"width": 1.0, "length": 0.1, "floor": 1e-3}, "here")
    _, cut = spall_shape(flank, values)
    middle = flank.x.size // 2
    roll, mate = flank.roll_m[middle], flank.mate_roll_m[middle]
    # edges of the slot: involute arc length roll^2 / (2 Rb)
    edges = [np.interp(0.5 + s * 0.05, flank.x, flank.roll_m) ** 2 / (2 * flank.tooth.base_radius_m) for s in (-1, 1)]
    arc, radius = edges[1] - edges[0], 1.0 / (1.0 / roll + 1.0 / mate)
    assert cut.max() == pytest.approx(radius - math.sqrt(radius**2 - 0.25 * arc**2), rel=2e-3)
    assert np.all(cut[np.abs(flank.x - 0.5) > 0.05] == 0.0)


def test_it_does_not_sink_below_the_floor():
    flank = flank_of(MACHINE, "mesh1", "gear")
    _, cut = spall_shape(flank, TERM.values({"width": 1.0, "length": 0.6, "floor": 1e-6}, "here"))
    assert cut.max() == 1e-6
