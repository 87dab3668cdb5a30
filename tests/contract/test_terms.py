"""What every registered effect promises."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.core.errors import SpecError
from sim.core.spec import CustomLaw, TermSpec
from sim.core.terms import Registry, Term
from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.plain import plain_context, plain_force
from sim.solve.settings import Settings
from sim.terms import REGISTRY
from tests.strategies.kernels import trials
from tests.strategies.systems import INSTEAD, WITHOUT_ASKING, every_term_machine, with_terms

ROOT = Path(__file__).resolve().parents[2]
UNITS = {
    "1",
    "m",
    "mm",
    "rad",
    "kg",
    "kg*m",
    "N",
    "N/m",
    "N/m^3",
    "N*s/m",
    "m/s",
    "Hz",
    "s",
    "Pa",
    "K",
    "N*m",
    "deg",
    "s/m",
}
LAW = CustomLaw(name="stop", dof="bearing2.outer.y", expression="1e6*max(x-1e-5,0)^1.5+20*tanh(v/0.02)*cos(phi)")
MACHINE = preset("paper-lightly-damped").model_copy(update={"custom_laws": [LAW]})
SITES = {"bearing": "bearing2", "gear": "pinion", "mesh": "mesh1", "shaft": "input"}
BASE = {"mesh_total", "mesh_pairs", "ball_contact", "force_load"}
"""Effects a machine has without asking, and that cannot be asked for twice."""
ALL = [pytest.param(term, id=term.key) for term in REGISTRY]
EXTRA = [pytest.param(term, id=term.key) for term in REGISTRY if term.key not in BASE]
HEALTHY = [p for p in EXTRA if p.values[0].severity and p.values[0].zero_is_healthy]


def acting(term: Term, **values: float):
    """The machine with the term at its first site."""
    return with_terms(MACHINE, TermSpec(term=term.key, site=SITES[term.sites[0]], parameters=values))


def added(term: Term, registry: Registry = REGISTRY, **values: float):
    """System with the term and the elements that the machine without it does not have, or has otherwise."""
    before = {e.name: e for e in assemble(MACHINE).elements}
    system = assemble(acting(term, **values), registry=registry)
    return system, [
        e
        for e in system.elements
        if e.name not in before or not np.array_equal(e.parameters, before[e.name].parameters)
    ]


@pytest.mark.parametrize("term", ALL)
def test_declaration(term):
    assert term.key.isidentifier()
    assert term.title
    assert term.sentence.endswith(".")
    assert term.references
    assert all(REGISTRY.get(other) is not None for other in term.excludes)
    assert term.severity is None or term.severity in [p.name for p in term.params]


@pytest.mark.parametrize("term", ALL)
def test_parameters(term):
    assert len({p.name for p in term.params}) == len(term.params)
    for param in term.params:
        assert param.unit in UNITS, f"{param.name}: unit {param.unit!r} is not in the house's list"
        assert param.low < param.high
        assert param.problem(param.default, param.name) is None
        assert param.sentence.endswith(".")
        assert param.scale == "linear" or param.high > 0.0


@pytest.mark.parametrize("term", ALL)
def test_a_page_of_its_own(term):
    assert (ROOT / "docs" / "physics" / f"{term.key}.md").is_file()


def test_keys_are_unique():
    keys = REGISTRY.keys()
    assert len(set(keys)) == len(keys)
    with pytest.raises(ValueError, match="two terms named"):
        Registry([next(iter(REGISTRY))] * 2)


@pytest.mark.parametrize("term", EXTRA)
def test_values_fill_defaults_and_refuse_the_rest(term):
    assert term.values({}, "here") == {p.name: p.default for p in term.params}
    for param in term.params:
        with pytest.raises(SpecError) as caught:
            term.values({param.name: param.high * 2.0 + 1.0}, "here")
        assert caught.value.problems[0].field == f"here.{param.name}"
    with pytest.raises(SpecError, match="unknown parameter"):
        term.values({"gremlins": 1.0}, "here")


@pytest.mark.parametrize("term", EXTRA)
def test_it_changes_something_at_its_default(term):
    system, elements = added(term)
    healthy = assemble(MACHINE)
    assert elements or system.dofs != healthy.dofs or not np.array_equal(system.load, healthy.load)


def awake(term: Term) -> Registry:
    """The registry with a term that assembly does not pass over at zero: what its own laws and elements do there."""
    return Registry([replace(t, zero_is_healthy=False) if t.key == term.key else t for t in REGISTRY])


@pytest.mark.parametrize("term", HEALTHY)
def test_zero_severity_adds_nothing(term):
    healthy, zero = assemble(MACHINE), assemble(acting(term, **{term.severity: 0.0}))
    assert term.idle(term.values({term.severity: 0.0}, "here"))
    assert zero.dofs == healthy.dofs
    assert zero.channels == healthy.channels
    assert zero.lines == healthy.lines
    for ours, theirs in zip(zero.elements, healthy.elements, strict=True):
        assert ours.name == theirs.name
        assert np.array_equal(ours.parameters, theirs.parameters)


@pytest.mark.parametrize("term", HEALTHY)
def test_at_zero_severity_its_own_elements_are_without_effect(term):
    system, elements = added(term, awake(term), **{term.severity: 0.0})
    healthy = assemble(MACHINE)
    for name in ("mass", "damping", "stiffness", "load"):
        assert np.array_equal(getattr(system, name), getattr(healthy, name)), name
    for element in elements:
        for trial in trials(system, element, count=4):
            row = plain_context(element, trial.step, trial.shafts, trial.u, trial.ud)[0]
            for mode in (1, 2):
                found = plain_force(element, mode, trial.u, trial.ud, row)
                assert np.all(found.force == 0.0)
            assert np.all(found.outputs[:3] == 0.0)


@pytest.mark.slow
@pytest.mark.parametrize("term", HEALTHY)
def test_at_zero_severity_its_own_laws_and_elements_change_no_motion(term, monkeypatch):
    run = {"duration_s": 0.005, "output_rate_hz": 30_000.0}
    settings = Settings(estimate_error=False, anti_alias=False, steps_per_output=2)
    healthy = simulate(MACHINE, settings=settings, **run).signals
    monkeypatch.setattr("sim.solve.api.assemble", partial(assemble, registry=awake(term)))
    zero = simulate(acting(term, **{term.severity: 0.0}), settings=settings, **run).signals
    # an element of zero force reorders sums, so rounding may differ; nothing else may
    assert zero == pytest.approx(healthy, abs=1e-11 * np.max(np.abs(healthy)))


@pytest.mark.parametrize("term", EXTRA)
def test_tangent_equals_finite_differences(term):
    system, elements = added(term)
    for element in elements:
        for trial in trials(system, element, count=4):
            row = plain_context(element, trial.step, trial.shafts, trial.u, trial.ud)[0]
            tangent = plain_force(element, 1, trial.u, trial.ud, row)
            for given, rate, step in ((tangent.stiffness, False, 1e-10), (tangent.damping, True, 1e-9)):
                for k in range(element.size):
                    shift = np.zeros(element.size)
                    shift[k] = step
                    sides = [
                        plain_force(element, 0, *((trial.u, trial.ud + d) if rate else (trial.u + d, trial.ud)), row)
                        for d in (shift, -shift)
                    ]
                    found = (sides[0].force - sides[1].force) / (2.0 * step)
                    rounding = 4.0 * np.spacing(np.max(np.abs(tangent.force))) / step
                    assert found == pytest.approx(given[:, k], abs=2e-4 * np.max(np.abs(given)) + 1e-6 + rounding)


@pytest.mark.parametrize("term", [p for p in EXTRA if p.values[0].passive])
def test_passive_terms_never_add_energy(term):
    system, elements = added(term)
    own = [e for e in elements if e.stiff]
    assert own
    for element in own:
        for trial in trials(system, element, count=40):
            row = plain_context(element, trial.step, trial.shafts, trial.u, trial.ud)[0]
            dt = 1e-9
            middle = plain_force(element, 2, trial.u, trial.ud, row)
            ends = [plain_force(element, 2, trial.u + s * dt * trial.ud, trial.ud, row).outputs[0] for s in (-1, 1)]
            put_in = float(middle.force @ trial.ud[: element.forces])
            stored = (ends[1] - ends[0]) / (2 * dt)
            scale = abs(put_in) + abs(stored) + 1e-9
            assert middle.outputs[0] >= 0.0
            assert middle.outputs[1] >= 0.0
            assert middle.outputs[2] == 0.0
            assert put_in - stored >= -1e-4 * scale
            assert put_in - stored == pytest.approx(middle.outputs[1], abs=1e-3 * scale)


@pytest.mark.parametrize("term", ALL)
def test_predicted_lines_refer_to_existing_bases(term):
    system = assemble(MACHINE) if term.key in BASE else assemble(acting(term))
    lines = [line for line in system.lines if line.mechanism == term.key]
    sites = {s.name for g in (MACHINE.gears, MACHINE.bearings, MACHINE.meshes, MACHINE.shafts) for s in g}
    for line in lines:
        assert {base for base, _ in line.orders} <= set(system.bases_hz)
        assert np.isfinite(line.frequency_hz(system.bases_hz))
        assert line.component in sites
        assert line.family in {"mesh", "shaft", "outer", "inner", "ball", "cage"}
    assert len({(line.label, line.component) for line in lines}) == len(lines), "a line is predicted twice"


@pytest.mark.parametrize("term", HEALTHY)
def test_zero_severity_predicts_no_line(term):
    system = assemble(acting(term, **{term.severity: 0.0}), registry=awake(term))
    assert not [line for line in system.lines if line.mechanism == term.key]


@pytest.mark.slow
def test_every_effect_has_a_place_in_one_machine_and_that_machine_runs():
    machine = every_term_machine()
    assert {spec.term for spec in machine.terms} == set(REGISTRY.keys()) - WITHOUT_ASKING - INSTEAD
    response = simulate(machine, duration_s=0.05, output_rate_hz=12_000.0, settings=Settings(estimate_error=False))
    assert np.all(np.isfinite(response.signals))
    assert response.quality.unconverged_steps == 0
    assert response.quality.energy.acceptable


def test_terms_compose():
    terms = [
        TermSpec(term=term.key, site=SITES[term.sites[0]])
        for term in REGISTRY
        if term.key not in BASE and term.key not in {t for other in REGISTRY for t in other.excludes[:1]}
    ]
    terms.append(TermSpec(term="fit_clearance", site="bearing1"))
    response = simulate(
        with_terms(MACHINE, *terms), duration_s=0.01, output_rate_hz=12_000.0, settings=Settings(estimate_error=False)
    )
    assert np.all(np.isfinite(response.signals))
    assert response.quality.unconverged_steps == 0
