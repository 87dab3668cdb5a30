"""Backlash as a term: the dead zone, its width, and motion that uses it."""

from __future__ import annotations

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.core.spec import TermSpec
from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.settings import Settings
from sim.terms import REGISTRY
from sim.terms.backlash import lightly_loaded
from tests.strategies.meshes import at_phase, element_of
from tests.strategies.systems import with_terms

WIDTH_M = 4e-5


def machine(*, pairs=True, given=None):
    plain = preset("gear-pair")
    error = type(plain.meshes[0].transmission_error)()
    changed = {"transmission_error": error, "tooth_pairs": pairs, "backlash_m": given}
    plain = plain.model_copy(update={"meshes": [plain.meshes[0].model_copy(update=changed)]})
    return with_terms(plain, TermSpec(term="backlash", site="mesh1", parameters={"width": WIDTH_M}))


@pytest.mark.parametrize("pairs", [True, False])
@pytest.mark.parametrize("given", [None, 2e-5])
def test_force_over_deflection_has_a_dead_zone(pairs, given):
    element = element_of(assemble(machine(pairs=pairs, given=given)), "mesh1")
    width = WIDTH_M + (given or 0.0)
    allowed = REGISTRY.get("backlash").validation[0].deviation
    for s in np.linspace(-1.5e-4, 1e-4, 26):
        found = at_phase(element, 23, 0.85, np.array([s, 0.0, 0.0, 0.0, 0.0]), np.zeros(5))
        expected = found.outputs[3] * (max(s, 0.0) + min(s + width, 0.0))
        assert found.force[0] == pytest.approx(expected, rel=allowed, abs=1e-6)


def test_under_little_load_the_flanks_part_and_energy_is_kept():
    light = with_terms(lightly_loaded(preset("gear-pair")), TermSpec(term="backlash", site="mesh1"))
    run = simulate(
        light,
        duration_s=0.3,
        output_rate_hz=20_000.0,
        channels=("mesh1.contact",),
        # light impacts last some tenths of a millisecond, and nearly nothing else takes energy
        settings=Settings(estimate_error=False, steps_per_output=8),
    )
    assert 0.02 < float(np.mean(run.signals[0] == 0.0)) < 0.98
    assert run.quality.energy.acceptable
