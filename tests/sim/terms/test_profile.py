"""Profile deviations and tip relief: the static transmission error under load."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.core.spec import TermSpec
from sim.parts.gear.from_spec import pair_from_spec
from sim.parts.gear.pair import pair_stiffness_n_per_m
from sim.presets import preset
from sim.terms import REGISTRY
from tests.strategies.meshes import at_phase, element_of, root_of
from tests.strategies.systems import with_terms

PLAIN = preset("gear-pair")
MACHINE = PLAIN.model_copy(
    update={
        "meshes": [
            PLAIN.meshes[0].model_copy(
                update={"transmission_error": type(PLAIN.meshes[0].transmission_error)(), "backlash_m": 1e-3}
            )
        ]
    }
)
FORCE_N = 1200.0
PHASES = np.arange(0.02, 1.0, 0.07)
CASES = {
    "linear relief of the pinion": ("tip_relief", "pinion", {"amount": 8e-6, "length": 0.4, "form": 1.0}),
    "parabolic relief of the gear": ("tip_relief", "gear", {"amount": 1.5e-5, "length": 0.3, "form": 2.0}),
    "slope": ("profile_error", "pinion", {"amplitude": 6e-6, "waves": 0.0}),
    "waves": ("profile_error", "gear", {"amplitude": 3e-6, "waves": 3.0}),
}


def missing_m(case, x):
    """Metal missing at the share x of the path from entry (gear's tip) to exit (pinion's tip)."""
    key, gear, v = case
    tip = 1.0 - x if gear == "pinion" else x
    if key == "tip_relief":
        return v["amount"] * max(0.0, 1.0 - tip / v["length"]) ** v["form"]
    if v["waves"] == 0.0:
        return v["amplitude"] * (1.0 - 2.0 * tip)
    return v["amplitude"] * math.sin(2.0 * math.pi * v["waves"] * (0.5 - tip))


def independent_error_m(case, phase):
    pair = pair_from_spec(*MACHINE.gears, MACHINE.meshes[0]).pair
    ratio = pair.contact().contact_ratio
    places = [p for p in (phase, phase + 1.0) if p < ratio]
    stiff = [float(pair_stiffness_n_per_m(pair, np.array(p))) for p in places]
    cuts = [missing_m(case, p / ratio) for p in places]

    def surplus(s):
        return sum(k * max(s - c, 0.0) for k, c in zip(stiff, cuts, strict=True)) - FORCE_N

    return root_of(surplus, -1e-4, 1e-4)


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_static_transmission_error(name):
    case = CASES[name]
    system = assemble(with_terms(MACHINE, TermSpec(term=case[0], site=case[1], parameters=case[2])))
    element = element_of(system, "mesh1")
    allowed = REGISTRY.get(case[0]).validation[0].deviation
    for phase in PHASES:

        def surplus(s, phase=phase):
            found = at_phase(element, 23, 46.0 + phase, np.array([s, 0.0, 0.0, 0.0, 0.0]), np.zeros(5))
            return float(found.force[0]) - FORCE_N

        assert root_of(surplus, -1e-4, 1e-4) == pytest.approx(independent_error_m(case, phase), rel=allowed)


def test_without_backlash_a_gap_shifts_the_spring():
    """Flanks that cannot part: the pair pulls at the deflection at which the sound one would rest."""
    free = MACHINE.model_copy(update={"meshes": [MACHINE.meshes[0].model_copy(update={"backlash_m": None})]})
    term = TermSpec(term="tip_relief", site="pinion", parameters={"amount": 1e-5, "length": 0.5})
    element = element_of(assemble(with_terms(free, term)), "mesh1")
    ends = [at_phase(element, 23, 0.65, np.array([s, 0, 0, 0, 0.0]), np.zeros(5)).force[0] for s in (0.0, 1e-5)]
    assert ends[0] < 0.0 < ends[1]
