"""Odd teeth on whole machines: lines at three speeds, where the damage acts, refusals, everything on one mesh."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.core.errors import SpecError
from sim.core.laws import TOOTH_POINTS
from sim.core.spec import MeshTable, TermSpec
from sim.parts.pair_kernels import SHAPE_POINTS
from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.ensemble import Member, simulate_many
from sim.solve.plain import plain_context, plain_force
from sim.solve.settings import Settings
from sim.terms import REGISTRY
from tests.contract.shown import recorded, spectra
from tests.strategies.kernels import compiled_context, compiled_force, trials
from tests.strategies.meshes import at_phase, element_of
from tests.strategies.systems import with_terms
from tests.strategies.trains import train

MACHINE = preset("paper-lightly-damped")
FAULTS = ("tooth_crack", "tooth_spall", "missing_tooth", "pitch_error", "eccentricity")
TEETH = ("tooth_crack", "tooth_spall", "missing_tooth", "profile_error", "tip_relief")
MESHES = ("backlash", "tooth_friction", "lead_misalignment")


def spec(key, site="pinion", **values):
    return TermSpec(term=key, site=site, parameters=values)


def stiffness(system, phase, mesh="mesh1", teeth=23):
    return at_phase(element_of(system, mesh), teeth, phase, np.zeros(5), np.zeros(5)).outputs[3]


def nearest_peak_hz(spectrum, hz, span_hz):
    """Frequency of the largest bin around a frequency."""
    near = np.abs(spectrum.frequency_hz - hz) < span_hz
    return float(spectrum.frequency_hz[near][np.argmax(spectrum.values[near])])


@pytest.mark.slow
@pytest.mark.parametrize("speed_hz", [20.0, 30.0, 45.0])
@pytest.mark.parametrize("key", FAULTS)
def test_the_line_found_is_the_predicted_one(key, speed_hz):
    operating = MACHINE.operating.model_copy(update={"speed_hz": speed_hz})
    machine = with_terms(MACHINE.model_copy(update={"operating": operating}), spec(key))
    system = assemble(machine)
    line = next(x for x in system.lines if x.mechanism == key)
    predicted = line.frequency_hz(system.bases_hz)
    record = recorded(machine)
    found = []
    for name in record.names:
        amplitude, envelope = (pair[0] for pair in spectra(record.series(name), record.series(name)))
        found += [nearest_peak_hz(spectrum, predicted, 0.4 * speed_hz) for spectrum in (amplitude, envelope)]
    error = min(abs(hz - predicted) for hz in found)
    assert error <= 0.5 * amplitude.resolution_hz
    assert error <= REGISTRY.get(key).validation[-1].deviation * predicted


@pytest.mark.parametrize("share", [0.25, 0.9])
def test_a_broken_tooth_keeps_the_share_that_is_left(share):
    sound = assemble(MACHINE)
    broken = assemble(with_terms(MACHINE, spec("missing_tooth", width=share, place=3.5 / 23)))
    allowed = REGISTRY.get("missing_tooth").validation[0].deviation
    # interpolation between samples of the compliance is exact at a sample
    places = np.array([70, 80, 90]) / 128.0 * contact_ratio()
    for place in places[places < 1.0]:
        at = 3.0 + place
        assert stiffness(broken, at) == pytest.approx((1.0 - share) * stiffness(sound, at), rel=allowed)
        assert stiffness(broken, at + 2.0) == stiffness(sound, at + 2.0)


def contact_ratio():
    system = assemble(MACHINE)
    par = element_of(system, "mesh1").parameters
    rows = int(par[18])
    return float(par[int(par[26]) + rows // 2])


def test_a_tooth_broken_off_at_the_tip_is_whole_where_its_mate_enters():
    sound, broken = assemble(MACHINE), assemble(with_terms(MACHINE, spec("missing_tooth", width=1.0, height=0.2)))
    assert stiffness(broken, 0.8) == pytest.approx(stiffness(sound, 0.8), rel=1e-12)
    assert stiffness(broken, 23.0 + 1.6) < 0.7 * stiffness(sound, 23.0 + 1.6)


def test_the_gears_tooth_comes_once_a_turn_of_the_gear():
    sound = assemble(MACHINE)
    cracked = assemble(with_terms(MACHINE, spec("tooth_crack", site="gear", place=10.2 / 81)))
    odd = [n for n in range(162) if stiffness(cracked, n + 0.85) < 0.999 * stiffness(sound, n + 0.85)]
    assert odd == [10, 91]


def idler(*terms):
    return train({"a": 20, "b": 31, "c": 25}, [("a", "b"), ("b", "c")], {"a": 30.0}, terms=terms)


@pytest.mark.parametrize(("key", "both"), [("tooth_crack", False), ("tooth_spall", False), ("missing_tooth", True)])
def test_an_idler_is_loaded_on_either_flank_in_turn(key, both):
    """Damage of one flank acts in the mesh that loads it; a broken tooth is missed by both neighbours."""
    before = {e.name: e.parameters for e in assemble(idler()).elements}
    after = assemble(idler(spec(key, site="b"))).elements
    changed = [e.name for e in after if e.parameters.size != before[e.name].size]
    assert changed == (["mesh1", "mesh2"] if both else ["mesh1"])


@pytest.mark.slow
@pytest.mark.parametrize("key", [*TEETH, "tooth_friction", "lead_misalignment"])
def test_a_mesh_of_one_curve_is_refused(key):
    mesh = MACHINE.meshes[0].model_copy(update={"tooth_pairs": False})
    machine = MACHINE.model_copy(update={"meshes": [mesh]})
    site = "pinion" if key in TEETH else "mesh1"
    with pytest.raises(SpecError) as caught:
        assemble(with_terms(machine, spec(key, site=site)))
    problem = caught.value.problems[0]
    assert (problem.field, problem.given) == ("meshes.mesh1.tooth_pairs", False)
    assert key in problem.message
    assert problem.allowed


def test_a_given_curve_beside_tooth_pairs_is_named():
    table = MeshTable(centre_distance_error_m=[0.0], stiffness_n_per_m=[[3e8] * 8])
    mesh = MACHINE.meshes[0].model_copy(update={"tooth_pairs": True, "table": table})
    with pytest.raises(SpecError) as caught:
        assemble(with_terms(MACHINE.model_copy(update={"meshes": [mesh]}), spec("tooth_crack")))
    (problem,) = caught.value.problems
    assert (problem.field, problem.given) == ("meshes.mesh1.table", "a table")


@pytest.mark.parametrize("key", ["tooth_crack", "tip_relief", "tooth_friction", "lead_misalignment"])
def test_helical_gears_are_refused(key):
    hands = (10.0, -10.0)
    gears = [g.model_copy(update={"helix_angle_deg": h}) for g, h in zip(MACHINE.gears, hands, strict=True)]
    machine = MACHINE.model_copy(update={"gears": gears})
    with pytest.raises(SpecError, match="spur gears only") as caught:
        assemble(with_terms(machine, spec(key, site="pinion" if key in TEETH else "mesh1")))
    assert caught.value.problems[0].field == "gears.pinion.helix_angle_deg"


def everything(angle=3e-4):
    return with_terms(
        MACHINE,
        spec("tooth_crack"),
        spec("tooth_crack", site="gear", place=0.5),
        spec("tooth_spall", place=0.3),
        spec("missing_tooth", site="gear", place=0.2),
        spec("profile_error", site="gear"),
        spec("tip_relief"),
        spec("pitch_error"),
        spec("eccentricity"),
        spec("backlash", site="mesh1"),
        spec("tooth_friction", site="mesh1"),
        spec("lead_misalignment", site="mesh1", angle=angle),
    )


@pytest.mark.slow
def test_all_of_it_acts_on_one_mesh():
    run = simulate(
        everything(),
        duration_s=0.2,
        output_rate_hz=12_000.0,
        channels=("mesh1.force", "mesh1.friction.friction", "mesh1.tilting.tilting_moment"),
        settings=Settings(estimate_error=False),
    )
    assert np.all(np.isfinite(run.signals))
    assert np.all(run.signals.std(axis=1) > 0.0)
    assert run.quality.unconverged_steps == 0
    assert run.quality.energy.acceptable
    par = element_of(assemble(everything()), "mesh1").parameters
    assert par[39] > 1  # slices
    # crack and spall of the pinion with relief, its sound teeth with relief, two of the gear and its others with error
    assert par[35] == 7


def test_compiled_equals_plain_with_all_of_it():
    system = assemble(everything())
    for name in ("mesh1", "mesh1.friction", "mesh1.tilting"):
        element = element_of(system, name)
        for trial in trials(system, element, count=3):
            plain = plain_context(element, trial.step, trial.shafts, trial.u, trial.ud)
            found = compiled_context(element, trial)
            assert found == pytest.approx(plain, rel=1e-9, abs=1e-12 * np.max(np.abs(plain)))
            for mode in (0, 1, 2):
                force, _ = compiled_force(element, mode, trial.u, trial.ud, plain[-1])
                expected = plain_force(element, mode, trial.u, trial.ud, plain[-1]).force
                assert force == pytest.approx(expected, rel=1e-10, abs=1e-9)


def test_shapes_are_sampled_alike_everywhere():
    assert SHAPE_POINTS == TOOTH_POINTS


CORNERS = [
    pytest.param(key, corner, id=f"{key}-{'-'.join(f'{v:g}' for v in corner)}")
    for key in (*TEETH, *MESHES)
    for corner in product(*([p.low, p.high] for p in REGISTRY.get(key).params if p.name != "place"))
]


@pytest.mark.slow
@pytest.mark.parametrize(("key", "corner"), CORNERS)
def test_corners_end_in_finite_signals(key, corner):
    names = [p.name for p in REGISTRY.get(key).params if p.name != "place"]
    for site in ("mesh1",) if key in MESHES else ("pinion", "gear"):
        machine = with_terms(MACHINE, spec(key, site=site, **dict(zip(names, corner, strict=True))))
        run = simulate(machine, duration_s=0.05, output_rate_hz=12_000.0, settings=Settings(estimate_error=False))
        assert np.all(np.isfinite(run.signals))
        assert np.max(np.abs(run.signals)) < 1e6
        assert run.quality.unconverged_steps == 0
        assert run.quality.energy.relative_residual < 1e-2


@pytest.mark.slow
def test_lanes_equal_single_runs_with_all_of_it():
    """Different damage side by side; eight machines of one structure."""
    machines = [everything(angle) for angle in (1e-4, 3e-4, 8e-4)]
    run = {"duration_s": 0.02, "output_rate_hz": 30_000.0}
    settings = Settings(estimate_error=False, anti_alias=False, steps_per_output=2)
    found = simulate_many([Member(machine=m) for m in machines], settings=settings, **run)
    for machine, response in zip(machines, found, strict=True):
        alone = simulate(machine, settings=settings, **run).signals
        assert response.signals == pytest.approx(alone, abs=1e-9 * np.max(np.abs(alone)))
