"""An extra mode at a support: two masses on two springs in closed form, names, channels, and what it hangs on."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import eigh

from sim.assembly.assemble import assemble
from sim.assembly.laws import base_laws
from sim.assembly.linear import linear_part
from sim.core.errors import SpecError
from sim.core.laws import AddedMass, AddedSpring
from sim.core.spec import TermSpec
from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.settings import Settings
from sim.terms.support_mode import TERM
from tests.strategies.harmonic import allowed
from tests.strategies.systems import with_terms

ROTOR = preset("rotor")


@pytest.mark.parametrize("mass", [1e-3, 0.05, 3.0])
@pytest.mark.parametrize("frequency", [100.0, 3500.0])
def test_two_masses(mass, frequency):
    term = TermSpec(term="support_mode", site="bearing1", parameters={"mass": mass, "frequency": frequency})
    system = assemble(with_terms(ROTOR, term))
    pair = [system.index("bearing1.outer.y"), system.index("bearing1.mode.y")]
    found = eigh(system.stiffness[np.ix_(pair, pair)], np.diag(system.mass[pair]), eigvals_only=True)
    bearing = ROTOR.bearings[0]
    seat, alone = bearing.support.stiffness_y_n_per_m / bearing.outer_mass_kg, (2.0 * np.pi * frequency) ** 2
    middle = seat + alone * (1.0 + mass / bearing.outer_mass_kg)
    root = np.sqrt(middle**2 - 4.0 * seat * alone)
    exact = np.array([2.0 * seat * alone / (middle + root), 0.5 * (middle + root)])
    assert found == pytest.approx(exact, rel=allowed(TERM, "test_two_masses"))


def test_the_added_mass_has_channels_and_energy():
    machine = with_terms(
        ROTOR,
        TermSpec(term="support_mode", site="bearing1", parameters={"axis": 0.0}),
        TermSpec(term="support_mode", site="bearing1", parameters={"axis": 1.0, "frequency": 300.0}),
    )
    system = assemble(machine)
    assert system.dofs[-2:] == ("bearing1.mode.x", "bearing1.mode.y")
    assert system.dofs[:-2] == assemble(ROTOR).dofs
    run = simulate(
        machine,
        duration_s=0.05,
        output_rate_hz=10_000.0,
        channels=("bearing1.mode.y.acceleration",),
        settings=Settings(estimate_error=False),
    )
    assert np.max(np.abs(run.signals)) > 0.0
    assert run.quality.energy.relative_residual < 1e-3


def test_it_hangs_on_the_housing_where_the_ring_has_one():
    machine = with_terms(
        preset("paper-lightly-damped"),
        TermSpec(term="support_mode", site="bearing2"),
        TermSpec(term="fit_clearance_series", site="bearing2"),
    )
    system = assemble(machine)
    row = system.stiffness[system.index("bearing2.mode.y")]
    assert row[system.index("bearing2.housing.y")] < 0.0 and row[system.index("bearing2.outer.y")] == 0.0


def test_two_of_one_axis_are_refused():
    twice = [TermSpec(term="support_mode", site="bearing1")] * 2
    with pytest.raises(SpecError, match="given twice"):
        assemble(with_terms(ROTOR, *twice))


@pytest.mark.parametrize("end", ["nowhere.y", "disc.theta"])
def test_a_mass_cannot_hang_on_what_does_not_exist(end):
    supports = base_laws(ROTOR, {}, []).supports
    added = AddedMass(name="disc.mode.y", mass=1.0, springs=(AddedSpring(a="disc.mode.y", b=end, stiffness=1e5),))
    with pytest.raises(SpecError, match="would hang on"):
        linear_part(ROTOR, supports, masses=(added,))
    with pytest.raises(SpecError, match="two effects add"):
        linear_part(ROTOR, supports, masses=(AddedMass(name="disc.mode.y", mass=1.0, springs=()),) * 2)
