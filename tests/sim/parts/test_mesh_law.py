"""From specification to mesh law: what tables cover, what is refused, which deflection a tilt meets."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.core.errors import SpecError
from sim.core.laws import TOOTH_POINTS
from sim.core.spec import MeshTable, TermSpec
from sim.parts.gear.from_spec import pair_from_spec
from sim.parts.gear.pair import MEAN_DEFLECTION_M
from sim.parts.gear.summary import mean_stiffness_n_per_m
from sim.parts.mesh_element import zero_row
from sim.parts.mesh_kernels import H_ROW0, H_ROW_STEP, H_ROWS, H_TILT0
from sim.parts.mesh_law import MeshSetting, base_radius_m, mesh_law
from sim.parts.pair_parameters import tooth_kinds
from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.settings import Settings
from tests.strategies.systems import with_terms

PLAIN = Settings(estimate_error=False, anti_alias=False)


def changed(machine, **mesh):
    return machine.model_copy(update={"meshes": [machine.meshes[0].model_copy(update=mesh)]})


def with_runout(machine, *radii):
    sites = ("pinion", "gear")
    terms = (
        TermSpec(term="eccentricity", site=s, parameters={"radius": r}) for s, r in zip(sites, radii, strict=False)
    )
    return with_terms(machine, *terms)


def reach(machine):
    """First and last row of the assembled mesh, m, and the system's warnings about its tables."""
    system = assemble(machine)
    par = next(e for e in system.elements if e.name == "mesh1").parameters
    rows = par[H_ROW0], par[H_ROW0] + (par[H_ROWS] - 1) * par[H_ROW_STEP]
    return *rows, [w for w in system.warnings if w.startswith("mesh1")]


LIGHT = preset("paper-lightly-damped")


def test_presets_keep_their_tables():
    for name in ("paper", "paper-lightly-damped", "paper-demo", "gear-pair"):
        low, high, warnings = reach(preset(name))
        assert (low, high) == pytest.approx((-2e-4, 2e-4))
        assert warnings == []


@pytest.mark.slow
@pytest.mark.parametrize("pairs", [True, False])
def test_rows_cover_run_out_and_clearances(pairs):
    machine = with_terms(
        with_runout(changed(LIGHT, tooth_pairs=pairs), 2e-4, 1e-4),
        TermSpec(term="fit_clearance", site="bearing1", parameters={"gap": 2e-4}),
    )
    low, high, warnings = reach(machine)
    # run-out of both, half the gap (one of the pinion's two bearings), with a quarter more
    assert min(-low, high) > 1.25 * (2e-4 + 1e-4 + 1e-4)
    assert warnings == []


@pytest.mark.slow
def test_more_than_the_teeth_allow_is_said():
    _, high, warnings = reach(with_runout(LIGHT, 5e-4, 5e-4))
    assert high < 1.5e-3
    _, high, warnings = reach(
        with_terms(
            with_runout(LIGHT, 5e-4, 5e-4),
            *(TermSpec(term="fit_clearance", site=f"bearing{i}", parameters={"gap": 5e-4}) for i in (1, 2, 3, 4)),
        )
    )
    assert len(warnings) == 1
    assert "contact ratio" in warnings[0]
    assert f"{1e6 * high:.0f} um" in warnings[0]


def test_a_given_table_that_is_too_short_is_said():
    flat = [[3e8, 3e8]] * 3
    table = MeshTable(centre_distance_error_m=[-1e-5, 0.0, 1e-5], stiffness_n_per_m=flat)
    _, _, warnings = reach(with_runout(changed(LIGHT, table=table), 5e-5))
    assert len(warnings) == 1
    assert "as it is given" in warnings[0]
    one = MeshTable(centre_distance_error_m=[0.0], stiffness_n_per_m=flat[:1])
    assert reach(with_runout(changed(LIGHT, table=one), 5e-5))[2] == []


@pytest.mark.parametrize("errors", [[1e-5, 2e-5], [-2e-5, -1e-5], [1e-5]])
def test_a_table_beside_the_installed_distance_is_refused(errors):
    table = MeshTable(centre_distance_error_m=errors, stiffness_n_per_m=[[3e8, 3e8]] * len(errors))
    with pytest.raises(SpecError, match="installed centre distance") as caught:
        assemble(changed(LIGHT, table=table))
    assert caught.value.problems[0].field == "meshes.mesh1.table.centre_distance_error_m"


def test_linearised_stiffness_is_that_of_the_installed_distance():
    rows = [[1e8, 1e8], [2e8, 2e8], [9e8, 9e8], [9.5e8, 9.5e8]]
    table = MeshTable(centre_distance_error_m=[-1e-4, 0.0, 1e-4, 2e-4], stiffness_n_per_m=rows)
    element = next(e for e in assemble(changed(LIGHT, table=table)).elements if e.name == "mesh1")
    assert element.linear_stiffness[0, 0] == 2e8


@pytest.mark.slow
def test_tilts_cover_the_clearances():
    tilted = changed(LIGHT, offset_angle=True)
    loose = TermSpec(term="fit_clearance", site="bearing1", parameters={"gap": 4e-4})
    first = [
        next(e for e in assemble(m).elements if e.name == "mesh1").parameters[H_TILT0]
        for m in (tilted, with_terms(tilted, loose))
    ]
    assert first[0] == pytest.approx(-5e-4)
    assert first[1] < -4e-4 / 0.26


def test_torsion_arm_uses_the_deflection_of_the_transmitted_load():
    machine = changed(LIGHT, offset_angle=True)
    pinion, gear = machine.gears
    pair = pair_from_spec(pinion, gear, machine.meshes[0]).pair
    expected = 25.0 / base_radius_m(pinion) / mean_stiffness_n_per_m(pair)
    said = assemble(machine).derived["mesh1.mean_deflection_m"]
    assert float(said.split()[1]) == pytest.approx(expected, rel=1e-5)
    assert expected < 0.5 * MEAN_DEFLECTION_M
    # half the deflection, twice the slope of the arm: four times the loss of stiffness at a small tilt
    rows = [mesh_law(machine, machine.meshes[0], {}, [], MeshSetting(force_n=f)).pair_rows for f in (2e4, 1e4)]
    loss = [1.0 - r[11].mean() / r[10].mean() for r in rows]
    assert loss[1] / loss[0] == pytest.approx(4.0, rel=0.02)
    assert "mesh1.mean_deflection_m" not in assemble(LIGHT).derived


def test_zero_row():
    law = mesh_law(LIGHT, LIGHT.meshes[0], {}, [], MeshSetting(centre_play_m=2e-3))
    assert law.centre_errors_m[zero_row(law)] == 0.0
    assert np.any(law.centre_errors_m[: zero_row(law)] < 0.0)


def test_a_run_beyond_its_table_shows_it():
    table = MeshTable(centre_distance_error_m=[-2e-5, 0.0, 2e-5], stiffness_n_per_m=[[3e8, 3e8]] * 3)
    machine = with_runout(changed(LIGHT, table=table), 3e-5)
    response = simulate(machine, duration_s=0.04, output_rate_hz=20_000.0, channels=("all",), settings=PLAIN)
    error = response.signal("mesh1.centre_distance_error")
    outside = response.signal("mesh1.outside_table")
    assert 0.1 < outside.mean() < 0.9
    assert np.array_equal(outside > 0.5, np.abs(error) > 2e-5)


def test_teeth_without_a_shape_are_all_of_the_sound_kind() -> None:
    machine = preset("gear-pair")
    mesh = machine.meshes[0]
    law = mesh_law(machine, mesh, {}, [])
    shapes = [np.zeros((teeth, 2, TOOTH_POINTS)) for teeth in law.teeth]
    flat = replace(law, pinion_shape=shapes[0], gear_shape=shapes[1])
    for none, given in zip(tooth_kinds(law), tooth_kinds(flat), strict=True):
        np.testing.assert_array_equal(none, given)
