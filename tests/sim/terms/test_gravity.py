"""Gravity of a shaft: static deflection in closed form, and that it reaches everything the shaft carries."""

from __future__ import annotations

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.core.spec import BodySpec, MachineSpec, OperatingSpec, ShaftSpec, TermSpec
from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.settings import Settings
from sim.terms.gravity import STANDARD_M_PER_S2, TERM
from tests.strategies.harmonic import allowed
from tests.strategies.systems import with_terms

MASS, STIFFNESS = 4.0, 2e5
DISC = MachineSpec(
    name="disc on springs",
    shafts=[ShaftSpec(name="input")],
    bodies=[
        BodySpec(
            name="disc",
            shaft="input",
            mass_kg=MASS,
            stiffness_x_n_per_m=STIFFNESS,
            stiffness_y_n_per_m=STIFFNESS,
            damping_x_ns_per_m=1400.0,
            damping_y_ns_per_m=1400.0,
        )
    ],
    operating=OperatingSpec(shaft="input", speed_hz=20.0),
)


def test_static_deflection():
    machine = with_terms(DISC, TermSpec(term="gravity", site="input", parameters={"share": 0.5, "direction": -1.0}))
    run = simulate(
        machine,
        duration_s=0.3,
        output_rate_hz=1000.0,
        channels=("disc.x.displacement", "disc.y.displacement"),
        settings=Settings(estimate_error=False, anti_alias=False),
    )
    exact = 0.5 * MASS * STANDARD_M_PER_S2 / STIFFNESS * np.array([np.cos(1.0), -np.sin(1.0)])
    assert run.signals[:, -1] == pytest.approx(exact, rel=allowed(TERM, "test_static_deflection"))


def test_all_shafts_together_weigh_what_the_machine_weighs():
    gearbox = preset("paper-lightly-damped")
    both = with_terms(gearbox, *(TermSpec(term="gravity", site=s) for s in ("input", "output")))
    system, plain = assemble(both), assemble(gearbox)
    whole = assemble(gearbox.model_copy(update={"gravity_m_per_s2": STANDARD_M_PER_S2}))
    assert system.load == pytest.approx(whole.load, abs=1e-12 * np.max(np.abs(whole.load)))
    assert not np.array_equal(system.load, plain.load)
