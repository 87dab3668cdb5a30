"""Mesh helpers against vectors, closed forms and finite differences."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sim.assembly.assemble import assemble
from sim.core.spec import TermSpec
from sim.parts import mesh_kernels as mk
from sim.parts.gear.involute import involute
from sim.solve.plain import interpreted, plain_context, plain_force, view
from tests.strategies.kernels import trials
from tests.strategies.trains import train

R_P, R_G, PSI_P, PSI_G = 4e-5, 7e-5, 0.3, 1.9
LINES = {
    "printed": {},
    "true": {"centre_distance_form": "true"},
    "rotated": {"line_of_action": "rotated"},
}
ANGLES = st.floats(-50.0, 50.0)
SMALL = st.floats(-1e-4, 1e-4)
BACKLASH_M = 4e-5


def system_of(line="printed", *, driver="a", flip=False, runout=True, **mesh):
    """Two gears; `flip`: the second mesh of a chain, whose pinion turns from x to y."""
    terms = [
        TermSpec(term="eccentricity", site="a", parameters={"radius": R_P, "phase": PSI_P}),
        TermSpec(term="eccentricity", site="b", parameters={"radius": R_G, "phase": PSI_G}),
    ]
    teeth, pairs = {"a": 20, "b": 31}, [("a", "b")]
    if flip:
        teeth, pairs = {"o": 30, **teeth}, [("o", "a"), *pairs]
    return assemble(train(teeth, pairs, {driver: 30.0}, terms=terms if runout else (), **LINES[line], **mesh))


def mesh_of(system):
    return [e for e in system.elements if e.name.startswith("mesh")][-1]


def call(helper, element, *arguments):
    return interpreted(helper)(view(element.parameters), *arguments)


def offset(radius, sense, phi, phase):
    return radius * np.array([math.cos(sense * phi + phase), math.sin(sense * phi + phase)])


MESHES = {(line, flip): mesh_of(system_of(line, flip=flip)) for line in LINES for flip in (False, True)}
DRIVEN = [mesh_of(system_of(driver=d, backlash_m=BACKLASH_M, runout=False)) for d in "ab"]
MESH_KEYS = st.sampled_from(sorted(MESHES))


def frame(element, line, flip):
    """Senses, line of action and centre line, worked out by hand."""
    sense_p, side = (1.0, -1.0) if flip else (-1.0, 1.0)
    alpha = math.acos((20 + 31) * 0.0015 * math.cos(math.radians(20.0)) / element.parameters[mk.H_CENTRE])
    normal = {"rotated": (-math.sin(alpha), side * math.cos(alpha))}.get(line, (0.0, side))
    centre = {"true": (math.cos(alpha), -side * math.sin(alpha))}.get(line, (1.0, 0.0))
    return sense_p, np.array(normal), np.array(centre)


@given(key=MESH_KEYS, phi_p=ANGLES, phi_g=ANGLES)
def test_run_out_is_projected_on_the_line_of_action(key, phi_p, phi_g):
    element = MESHES[key]
    sense, normal, _ = frame(element, *key)
    both = offset(R_P, sense, phi_p, PSI_P) - offset(R_G, -sense, phi_g, PSI_G)
    assert call(mk.runout_error, element, phi_p, phi_g) == pytest.approx(float(normal @ both), abs=1e-18)


@given(key=MESH_KEYS, phi_p=ANGLES, phi_g=ANGLES, om_p=st.floats(-200, 200), om_g=st.floats(-200, 200))
def test_run_out_rate_is_its_derivative(key, phi_p, phi_g, om_p, om_g):
    element, dt = MESHES[key], 1e-6
    ends = [call(mk.runout_error, element, phi_p + s * om_p * dt, phi_g + s * om_g * dt) for s in (1, -1)]
    rate = call(mk.runout_rate, element, phi_p, om_p, phi_g, om_g)
    assert rate == pytest.approx((ends[0] - ends[1]) / (2 * dt), abs=1e-8)


@given(key=MESH_KEYS, phi_p=ANGLES, phi_g=ANGLES, x=SMALL, y=SMALL)
def test_centre_distance_is_the_length_between_base_circle_centres(key, phi_p, phi_g, x, y):
    element = MESHES[key]
    sense, _, centre = frame(element, *key)
    moved = np.array([x, y]) + offset(R_P, sense, phi_p, PSI_P) - offset(R_G, -sense, phi_g, PSI_G)
    installed = element.parameters[mk.H_CENTRE]
    expected = float(np.linalg.norm(installed * centre - moved)) - installed
    assert call(mk.centre_error, element, phi_p, phi_g, x, y) == pytest.approx(expected, abs=1e-15)


def test_printed_senses_are_the_seeds():
    element = mesh_of(system_of(rotation="printed"))
    for phi_p, phi_g in ((0.7, 0.4), (12.0, 7.0)):
        expected = R_P * math.sin(phi_p + PSI_P) - R_G * math.sin(PSI_G - phi_g)
        assert call(mk.runout_error, element, phi_p, phi_g) == pytest.approx(expected, abs=1e-18)


@pytest.mark.parametrize("error", [-1e-4, 1e-5, 2e-4])
def test_backlash_grows_as_the_involute_says(error):
    """2 (Rb1 + Rb2) (inv alpha' - inv alpha), whose first order is 2 sin(alpha) per metre of centre distance."""
    element = mesh_of(system_of(backlash_m=1e-3, runout=False))
    installed = element.parameters[mk.H_CENTRE]
    base = installed * math.cos(math.radians(20.0))
    exact = 2.0 * base * (involute(math.acos(base / (installed + error))) - involute(math.radians(20.0)))
    growth = call(mk.backlash_growth, element, error)
    # second order left out: cos^2(alpha) / (a sin(alpha)) error^2
    assert growth == pytest.approx(exact, rel=1.1 * abs(error) * 3.8 / installed)
    assert call(mk.backlash_growth, element, 0.0) == 0.0


def test_backlash_never_closes_below_nothing_and_no_backlash_stays_none():
    tight, none = (mesh_of(system_of(backlash_m=b, runout=False)) for b in (1e-5, None))
    assert call(mk.backlash_growth, tight, -1e-3) == -1e-5
    assert call(mk.flank_gap, tight, -1e-5, 0.0, 3e-6) == 3e-6
    assert call(mk.flank_gap, tight, -1e-5, 0.0, -3e-6) == -3e-6
    assert call(mk.backlash_growth, none, 1e-4) == 0.0
    assert call(mk.flank_gap, none, 0.0, 0.0, -3e-6) == -3e-6


@given(s=st.floats(-3e-4, 3e-4), growth=st.floats(-3e-5, 1e-4))
def test_the_added_gap_lies_at_the_flanks_without_load(s, growth):
    """Whoever drives: the same contact seen from the other gear is its negative."""
    pinion, gear = DRIVEN
    load = call(mk.flank_gap, pinion, growth, 0.0, s)
    assert load == pytest.approx(max(s, 0.0) + min(s + BACKLASH_M + growth, 0.0), abs=1e-18)
    assert call(mk.flank_gap, gear, growth, 0.0, -s - BACKLASH_M) == pytest.approx(-load, abs=1e-18)


def test_the_damper_rises_smoothly_from_touch():
    share = interpreted(mk.touch_share)
    depths = np.linspace(0.0, 2.0 * mk.TOUCH_M, 401)
    values = np.array([share(d) for d in depths])
    assert values[0] == 0.0
    assert np.all(np.diff(values) >= 0.0)
    assert np.all(values[depths >= mk.TOUCH_M] == 1.0)
    assert share(-3e-7) == share(3e-7)


@pytest.mark.slow
@pytest.mark.parametrize("pairs", [True, False])
def test_force_is_continuous_at_touch_while_closing_fast(pairs):
    element = mesh_of(system_of(backlash_m=BACKLASH_M, tooth_pairs=pairs, runout=False))
    trial = trials(system_of(backlash_m=BACKLASH_M, runout=False), element, count=1)[0]
    for edge, side in ((0.0, 1.0), (-BACKLASH_M, -1.0)):
        u, ud = np.zeros(5), np.zeros(5)
        ud[0] = 0.1 * side
        forces = []
        for depth in (-1e-9, 0.0, 1e-9, 1e-8):
            u[0] = edge + side * depth
            row = plain_context(element, trial.step, trial.shafts, np.zeros(5), np.zeros(5))[0]
            forces.append(float(plain_force(element, 0, u, ud, row).force[0]))
        assert forces[:2] == [0.0, 0.0]
        # stepwise damping would jump by c ud = 300 N
        assert 0.0 < side * forces[2] < 1.0
        assert 0.0 < side * forces[3] < 10.0


@pytest.mark.slow
@pytest.mark.parametrize("driver", ["a", "b"])
@pytest.mark.parametrize("pairs", [True, False])
def test_tangent_with_backlash_equals_finite_differences(pairs, driver):
    system = system_of(driver=driver, backlash_m=BACKLASH_M, tooth_pairs=pairs)
    element = mesh_of(system)
    seen = 0
    for trial in trials(system, element, count=60):
        row = plain_context(element, trial.step, trial.shafts, trial.u, trial.ud)[1]
        error, gap = (row[1], row[7]) if not pairs else (row[0], row[5])
        front, back = (0.0, gap) if driver == "a" else (gap, 0.0)
        for depth in (3e-7, 8e-7, 4e-6):
            for edge, side in ((front, 1.0), (-BACKLASH_M - back, -1.0)):
                u = trial.u.copy()
                u[0] = error + edge + side * depth
                tangent = plain_force(element, 1, u, trial.ud, row)
                for rate, given_row in ((False, tangent.stiffness), (True, tangent.damping)):
                    step = np.zeros(5)
                    step[0] = 1e-8 if rate else 1e-12
                    ends = [
                        plain_force(element, 0, *((u, trial.ud + d) if rate else (u + d, trial.ud)), row).force[0]
                        for d in (step, -step)
                    ]
                    found = (ends[0] - ends[1]) / (2.0 * step[0])
                    assert found == pytest.approx(given_row[0, 0], rel=2e-3, abs=1.0)
                seen += tangent.damping[0, 0] > 0.0
    assert seen > 100
