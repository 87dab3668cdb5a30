"""How far a load carries a loose ring, against the simulation without a bore in the way."""

from __future__ import annotations

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.assembly.reach import static_displacement
from sim.core.spec import ForceLoad, TermSpec
from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.settings import Settings
from tests.strategies.systems import with_terms


def loose(base: str, gap_m: float, term: str = "fit_clearance", site: str = "bearing1"):
    return with_terms(preset(base), TermSpec(term=term, site=site, parameters={"gap": gap_m}))


def said(base: str, gap_m: float, **more: str) -> list[str]:
    return [w for w in assemble(loose(base, gap_m, **more)).warnings if "never touch" in w]


@pytest.mark.parametrize("term", ["fit_clearance", "fit_clearance_series"])
def test_a_gap_beyond_twice_the_static_motion_is_told(term):
    assert not said("paper-lightly-damped", 2e-5, term=term) and not said("paper-lightly-damped", 1e-4, term=term)
    (warning,) = said("paper-lightly-damped", 2e-4, term=term)
    assert warning.startswith("bearing1: the load carries its loose ring 52.2 um, a clearance of 200 um")


@pytest.mark.slow
def test_a_ring_that_only_its_bore_holds_reaches_it_whatever_the_gap():
    """Flexible shafts tilt about their other bearing until the ring is caught."""
    for base, site in (("bearing-rig", "drive_end"), ("two-stage", "bearing3"), ("overhung", "bearing1")):
        system = assemble(loose(base, 5e-4, site=site))
        assert static_displacement(system) is None
        assert not said(base, 5e-4, site=site)


def test_more_load_carries_the_ring_further():
    machine = loose("rotor", 1e-5)
    assert any("never touch" in w for w in assemble(machine).warnings)
    pushed = machine.model_copy(update={"loads": [ForceLoad(body="disc", axis="y", constant_n=-500.0)]})
    assert not any("never touch" in w for w in assemble(pushed).warnings)


@pytest.mark.slow
@pytest.mark.parametrize(("base", "near"), [("paper-lightly-damped", 0.15), ("rotor", 0.15)])
def test_the_static_motion_is_the_mean_of_the_free_ring(base, near):
    machine = loose(base, 5e-4)
    names = ["bearing1.outer.x.displacement", "bearing1.outer.y.displacement"]
    run = simulate(
        machine, duration_s=0.4, output_rate_hz=10_000.0, channels=names, settings=Settings(estimate_error=False)
    )
    assert run.contact_share["bearing1.wall"] == 0.0
    system = assemble(machine)
    expected = static_displacement(system)
    assert expected is not None
    reach = np.hypot(*(expected[system.index(f"bearing1.outer.{axis}")] for axis in "xy"))
    mean = np.hypot(*run.signals[:, 2000:].mean(axis=1))
    # the balls are taken as linear springs without clearance
    assert mean == pytest.approx(reach, rel=near)
