"""Force laws of the user's own: against closed forms, built-in effects, and other interpolation."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import RegularGridInterpolator
from scipy.special import ellipk

from sim.assembly.assemble import assemble
from sim.core.elements import STAGES
from sim.core.errors import SpecError
from sim.core.spec import CustomLaw, ForceTable, TermSpec
from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.collocation import collocation
from sim.solve.plain import plain_context, plain_force, step_array
from sim.solve.settings import Settings
from sim.terms.custom_force import TERM
from tests.strategies.harmonic import allowed, element_of, on, small_system
from tests.strategies.kernels import Trial, compiled_context, compiled_force
from tests.strategies.running import drive
from tests.strategies.systems import with_terms

ROTOR = preset("rotor")
DOF = "bearing1.outer.y"


def with_law(**law):
    return ROTOR.model_copy(update={"custom_laws": [CustomLaw(name="own", dof=DOF, **law)]})


def force_of(element, x, v, phi):
    """Force and its tangents by the compiled kernel and by the plain one."""
    rule = collocation(STAGES)
    step = step_array(0.0, 1e-4, rule.c, rule.lagrange, rule.b)
    shafts = np.array([np.full(4, phi), np.full(4, 190.0)] * 2)
    trial = Trial(step=step, shafts=shafts, u=np.array([x]), ud=np.array([v]))
    row = plain_context(element, step, shafts, trial.u, trial.ud)[0]
    assert np.array_equal(compiled_context(element, trial)[0][:1], row[:1])
    plain = plain_force(element, 1, trial.u, trial.ud, row.copy())
    force, out = compiled_force(element, 1, trial.u, trial.ud, row.copy())
    scale = 1e-12 * (1.0 + np.max(np.abs([plain.force[0], plain.stiffness[0, 0], plain.damping[0, 0]])))
    assert [force[0], *out[:2]] == pytest.approx(
        [plain.force[0], plain.stiffness[0, 0], plain.damping[0, 0]], abs=scale
    )
    return plain.force[0], plain.stiffness[0, 0], plain.damping[0, 0]


LAWS = {
    "2*x - v/4": lambda x, v, p: 2 * x - v / 4,
    "-x^2 + 3*x*v^3": lambda x, v, p: -(x**2) + 3 * x * v**3,
    "(x + 2)^-2 + x^0": lambda x, v, p: (x + 2) ** -2.0 + 1,
    "max(x - 0.2, 0)^1.5 * (1 + 0.3*v)": lambda x, v, p: max(x - 0.2, 0) ** 1.5 * (1 + 0.3 * v),
    "min(x, v) - abs(v)*v": lambda x, v, p: min(x, v) - abs(v) * v,
    "5*sign(v)*sqrt(abs(x))": lambda x, v, p: 5 * np.sign(v) * np.sqrt(abs(x)),
    "exp(-x)*tanh(v/0.5)*cos(2*phi+pi/4)": lambda x, v, p: np.exp(-x) * np.tanh(v / 0.5) * np.cos(2 * p + np.pi / 4),
    "sin(phi)/(1+x^2)": lambda x, v, p: np.sin(p) / (1 + x**2),
    "--(+x)*1.5e-1": lambda x, v, p: 0.15 * x,
    "x - v - 1": lambda x, v, p: x - v - 1,
    "8/4/(x + 2)": lambda x, v, p: 2 / (x + 2),
}


@pytest.mark.parametrize("text", LAWS)
def test_an_expression_is_what_it_says_with_its_derivatives(text):
    element = element_of(with_law(expression=text), "custom_force", "bearing1", scale=2.0)
    rng = np.random.default_rng(4)
    exact = LAWS[text]
    for _ in range(6):
        x, v, phi = (*rng.uniform(-1.0, 1.0, 2).tolist(), rng.uniform(0.0, 40.0))
        found = force_of(element, x, v, phi)
        h = 1e-6
        slopes = [
            (exact(x + h * a, v + h * b, phi) - exact(x - h * a, v - h * b, phi)) / (2 * h) for a, b in ((1, 0), (0, 1))
        ]
        assert found[0] == pytest.approx(2.0 * exact(x, v, phi), rel=1e-12, abs=1e-13)
        assert found[1:] == pytest.approx([2.0 * s for s in slopes], rel=1e-6, abs=1e-7)


@pytest.mark.parametrize("text", ["1/0", "1e308*1e308", "2/x", "1e10", "1/(phi - phi)"])
def test_a_force_beyond_reason_at_rest_is_refused_by_name(text):
    with pytest.raises(SpecError, match=r"custom_laws\.0\.expression: the force of law 'own' at rest"):
        element_of(with_law(expression=text), "custom_force", "bearing1")


def test_a_table_is_interpolated_linearly_and_held_at_its_ends():
    rng = np.random.default_rng(1)
    values = rng.normal(size=(5, 4, 6))
    table = ForceTable(
        displacement=[-2e-3, 3e-3],
        displacements=5,
        velocity=[-0.5, 0.25],
        velocities=4,
        angles=6,
        force=values.ravel().tolist(),
    )
    element = element_of(with_law(table=table), "custom_force", "bearing1")
    grid = (np.linspace(-2e-3, 3e-3, 5), np.linspace(-0.5, 0.25, 4), np.linspace(0.0, 2.0 * np.pi, 7))
    other = RegularGridInterpolator(grid, np.concatenate([values, values[:, :, :1]], axis=2))
    for _ in range(40):
        x, v, phi = rng.uniform(-3e-3, 4e-3), rng.uniform(-0.7, 0.4), rng.uniform(0.0, 50.0)
        exact = other([np.clip(x, -2e-3, 3e-3), np.clip(v, -0.5, 0.25), phi % (2.0 * np.pi)])[0]
        assert force_of(element, x, v, phi)[0] == pytest.approx(exact, abs=1e-10)


@pytest.mark.parametrize("amplitude", [0.2, 3.0])
def test_period_of_a_cubic_spring(amplitude):
    stiffness, mass = 1e5, 2.0
    machine = with_law(expression=f"{stiffness}*x^3")
    element = on(element_of(machine, "custom_force", "bearing1"), ((DOF, 1.0),))
    system = small_system([DOF], [mass], (element,), {"input": 30.0}, stiffness=[[stiffness]])
    linear, cubic = stiffness / mass, stiffness / mass
    sharp = linear + cubic * amplitude**2
    quarter = ellipk(0.5 * cubic * amplitude**2 / sharp) / np.sqrt(sharp)
    states = drive(system, step_s=quarter / 400.0, steps=400, start=np.array([amplitude, 0.0])).states
    assert abs(states[-1, 0]) < allowed(TERM, "test_period_of_a_cubic_spring") * amplitude


def test_equals_the_built_in_effect_it_repeats():
    run = {"duration_s": 0.05, "output_rate_hz": 20_000.0, "settings": Settings(estimate_error=False)}
    stiffness = 0.5 * ROTOR.bearings[0].support.stiffness_y_n_per_m
    machine = with_law(expression=f"-{stiffness}*max(x+1e-6,0)")
    ours = simulate(with_terms(machine, TermSpec(term="custom_force", site="bearing1")), **run).signals
    term = TermSpec(term="pedestal_looseness", site="bearing1", parameters={"loss": 0.5, "lift": -1e-6})
    built_in = simulate(with_terms(ROTOR, term), **run).signals
    assert ours == pytest.approx(built_in, abs=1e-9 * np.max(np.abs(built_in)))


def test_between_two_degrees_of_freedom_it_is_internal():
    machine = with_law(expression="1e5*x", against="bearing1.inner.y")
    element = element_of(machine, "custom_force", "bearing1")
    assert element.coordinates[0].weights == ((DOF, 1.0), ("bearing1.inner.y", -1.0))


def test_several_laws_act_at_one_site_and_a_repeated_one_is_refused():
    machine = with_law(expression="x").model_copy(
        update={"custom_laws": [CustomLaw(name=n, dof=DOF, expression="x") for n in ("one", "two")]}
    )
    terms = [TermSpec(term="custom_force", site="bearing1", parameters={"law": k}) for k in (1.0, 2.0)]
    names = [e.name for e in assemble(with_terms(machine, *terms)).elements]
    assert {"bearing1.custom.one", "bearing1.custom.two"} <= set(names)
    with pytest.raises(SpecError, match="given twice"):
        assemble(with_terms(machine, terms[0], terms[0]))


@pytest.mark.parametrize(
    ("law", "parameters", "field"),
    [
        ({"expression": "x +"}, {}, "custom_laws.0.expression"),
        ({"expression": "x"}, {"law": 2.0}, "custom_laws"),
        ({"expression": "x"}, {"law": 1.5}, "terms.0.parameters.law"),
        ({"expression": "x", "against": "nobody.y"}, {}, "bearing1"),
    ],
)
def test_what_cannot_be_meant_is_refused_where_it_stands(law, parameters, field):
    term = TermSpec(term="custom_force", site="bearing1", parameters=parameters)
    with pytest.raises(SpecError) as caught:
        assemble(with_terms(with_law(**law), term))
    assert caught.value.problems[0].field == field
