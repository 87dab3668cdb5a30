"""Spalls of races and balls: where rings rest over them, when balls enter and strike, and which lines they make."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import root

from signals.recording import from_response
from signals.spectra import envelope_spectrum
from sim.assembly.assemble import assemble
from sim.core.errors import SpecError
from sim.solve.api import simulate
from sim.solve.settings import Settings
from sim.terms.ball_spall import TERM as BALL
from sim.terms.inner_spall import TERM as INNER
from sim.terms.outer_spall import TERM as OUTER
from tests.strategies.bearings import bearing_with, context_at, element_of, force_at, gaps_at, turned

BALLS, BALL_M, PITCH_M, LOAD_N = 9, 0.00794, 0.03904, 50.0
DOWN = -0.5 * np.pi


def rest_written_anew(stiffness, drop_m):
    """Displacement under a load along -y of nine balls, the first of them straight down over a pit."""
    angles = DOWN + 2.0 * np.pi * np.arange(BALLS) / BALLS
    gaps = np.where(np.arange(BALLS) == 0, drop_m, 0.0)

    def unbalanced(um):
        squeeze = np.clip(1e-6 * (um[0] * np.cos(angles) + um[1] * np.sin(angles)) - gaps, 0.0, None) ** 1.5
        return stiffness * np.array([squeeze @ np.cos(angles), squeeze @ np.sin(angles)]) + [0.0, LOAD_N]

    found = root(unbalanced, [0.0, -5.0 - 1e6 * drop_m], tol=1e-13)
    assert np.max(np.abs(found.fun)) < 1e-6
    return 1e-6 * found.x


@pytest.mark.parametrize("term", [OUTER, INNER], ids=lambda t: t.key)
def test_a_ring_at_rest_sinks_as_far_as_root_finding_says(term):
    # a floor of 5 um, wide enough that the ball stands on it
    system, element = element_of(
        bearing_with((term.key, {"width": 4e-3, "depth": 5e-6, "angle": DOWN}), cage_phase_rad=DOWN)
    )
    row, load = context_at(system, element, 0.0), np.array([0.0, LOAD_N])
    found = root(lambda um: force_at(element, row, 1e-6 * um) + load, [0.0, -10.0], tol=1e-13)
    expected = rest_written_anew(element.parameters[1], 5e-6)
    off = np.hypot(*(1e-6 * found.x - expected)) / np.hypot(*expected)
    allowed = next(v.deviation for v in term.validation if "at_rest" in v.test)
    assert off < allowed
    assert np.hypot(*expected) > 1.2 * np.hypot(*rest_written_anew(element.parameters[1], 0.0))


def strike_s(width_m, speed_hz, rate_hz):
    """Time from a ball's entry into a deep pit to the largest acceleration of the ring, s."""
    machine = turned(bearing_with(("outer_spall", {"width": width_m, "depth": 1e-3})), speed_hz)
    run = simulate(machine, duration_s=1.0, output_rate_hz=rate_hz, settings=Settings(estimate_error=False))
    row = next(i for i, c in enumerate(run.channels) if c.name == "bearing1.outer.y.acceleration")
    gamma = BALL_M / PITCH_M
    cage = np.pi * speed_hz * (1.0 - gamma) * np.sign(element_of(machine)[1].parameters[3])
    turns = [(DOWN - 2.0 * np.pi * i / BALLS + 2.0 * np.pi * k) / cage for i in range(BALLS) for k in range(-40, 40)]
    enters = min(t for t in turns if t > 0.5) - 0.5 * width_m / along_m_per_s(speed_hz)
    first = int(enters * rate_hz)
    window = run.signals[row, first : first + int(0.8 * rate_hz / assemble(machine).bases_hz["f_o1"])]
    return (first + np.argmax(np.abs(window))) / rate_hz - enters


def along_m_per_s(speed_hz):
    """Speed at which the contact runs along the outer race."""
    gamma = BALL_M / PITCH_M
    return np.pi * speed_hz * (1.0 - gamma) * 0.5 * PITCH_M * (1.0 + gamma)


@pytest.mark.slow
@pytest.mark.parametrize("speed_hz", [5.0, 10.0])
def test_entry_and_impact_move_apart_by_length_over_speed(speed_hz):
    # a ball without mass is loaded again where it would be squeezed again: a fixed way before the exit edge
    allowed = next(v.deviation for v in OUTER.validation if "move_apart" in v.test)
    times = [strike_s(width, speed_hz, 48_000.0) for width in (1.5e-3, 2.5e-3, 3.5e-3)]
    for found in np.diff(times):
        assert found == pytest.approx(1e-3 / along_m_per_s(speed_hz), rel=allowed)
    assert times[0] < 1.5e-3 / along_m_per_s(speed_hz)


def crossed_at(time_s, deep_enough):
    """Instants at which a condition begins and ends to hold around a time at which it does, by bisection."""
    edges = []
    for side in (-1.0, 1.0):
        inside, outside = time_s, time_s
        while deep_enough(outside):
            outside += side * 1e-4
        for _ in range(40):
            middle = 0.5 * (inside + outside)
            inside, outside = (middle, outside) if deep_enough(middle) else (inside, middle)
        edges.append(inside)
    return edges


@pytest.mark.parametrize("speed_hz", [5.0, 30.0])
@pytest.mark.parametrize("term", [OUTER, INNER], ids=lambda t: t.key)
def test_a_ball_enters_and_leaves_a_pit_a_length_over_speed_apart(term, speed_hz):
    width, floor = 4e-3, 5e-6
    machine = turned(bearing_with((term.key, {"width": width, "depth": floor, "angle": DOWN})), speed_hz)
    system, element = element_of(machine)
    gamma, omega = BALL_M / PITCH_M, 2.0 * np.pi * speed_hz
    cage, side = 0.5 * omega * (1.0 - gamma), 1.0 if term is OUTER else -1.0
    race = 0.5 * PITCH_M * (1.0 + side * gamma)
    along = cage * race if term is OUTER else (omega - cage) * race
    assert along == pytest.approx(along_m_per_s(speed_hz), rel=1e-12)  # rolling: the same on both races
    sense = np.sign(element.parameters[3])
    rate = sense * (cage if term is OUTER else cage - omega)
    middle = (DOWN + (6.0 if rate > 0.0 else -6.0) * np.pi) / rate  # the first ball stands at 0 at t = 0
    # half the floor is met where the ball, turning about an edge, has sunk so far
    edge = np.sqrt(floor / (2.0 / BALL_M - side / race))
    enters, leaves = crossed_at(middle, lambda t: gaps_at(system, element, t, BALLS)[0][0] > 0.5 * floor)
    allowed = next(v.deviation for v in term.validation if "enters_and_leaves" in v.test)
    assert leaves - enters == pytest.approx((width - 2.0 * edge) / along, rel=allowed)
    assert 0.5 * (enters + leaves) == pytest.approx(middle, abs=allowed * width / along)


def test_the_ball_turns_at_its_spin_frequency():
    machine = bearing_with(("ball_spall", {"width": 2e-3, "depth": 1e-3}))
    system, element = element_of(machine)
    gamma = BALL_M / PITCH_M
    expected = 30.0 * (1.0 - gamma**2) / (2.0 * gamma)
    assert system.bases_hz["f_b1"] == pytest.approx(expected, rel=1e-12)
    # half a turn takes the pit from the outer race to the inner, whose drop is larger: 1/r + 1/R against 1/r - 1/R
    drops = [gaps_at(system, element, k / (2.0 * expected), BALLS)[0][0] for k in range(6)]
    assert drops[0] == pytest.approx(drops[2], rel=1e-9) == pytest.approx(drops[4], rel=1e-9)
    assert drops[1] == pytest.approx(drops[3], rel=1e-9) == pytest.approx(drops[5], rel=1e-9)
    inner, outer = 0.5 * PITCH_M * (1.0 - gamma), 0.5 * PITCH_M * (1.0 + gamma)
    ratio = (2.0 / BALL_M + 1.0 / inner) / (2.0 / BALL_M - 1.0 / outer)
    assert drops[1] / drops[0] == pytest.approx(ratio, rel=0.02)
    assert gaps_at(system, element, 0.25 / expected, BALLS)[0][0] == 0.0


@pytest.mark.parametrize("key", ["outer_spall", "inner_spall", "ball_spall"])
@pytest.mark.parametrize(
    ("values", "field"),
    [({"width": 9e-3, "pitch_diameter": 1e-2}, "width"), ({"depth": 1e-3, "pitch_diameter": 1e-2}, "depth")],
)
def test_what_is_no_spall_is_refused(key, values, field):
    with pytest.raises(SpecError) as caught:
        assemble(bearing_with((key, values), machine="paper"))
    assert field in caught.value.problems[0].field


def test_a_pitch_diameter_that_is_not_the_bearings_is_refused():
    with pytest.raises(SpecError, match="pitch_diameter"):
        assemble(bearing_with(("outer_spall", {"pitch_diameter": 0.06})))


ENVELOPES = [
    (machine, speed) for machine, speeds in {"rotor": (12.0, 40.0), "paper": (25.0, 40.0)}.items() for speed in speeds
]
BAND_HZ = (2_000.0, 10_000.0)


@pytest.mark.slow
@pytest.mark.parametrize(("machine", "speed_hz"), ENVELOPES)
@pytest.mark.parametrize(("term", "base", "times"), [(OUTER, "f_o1", 1), (INNER, "f_i1", 1), (BALL, "f_b1", 2)])
def test_the_strongest_line_of_the_envelope_near_it_is_the_predicted_one(term, base, times, machine, speed_hz):
    values = {"angle": DOWN if machine == "rotor" else -DOWN} if term is OUTER else {}
    spec = turned(bearing_with((term.key, {"width": 1e-3, **values}), machine=machine), speed_hz)
    run = simulate(spec, duration_s=2.2, output_rate_hz=24_000.0, settings=Settings(estimate_error=False))
    recording = from_response(run).select(start_s=0.2)
    name = next(n for n in recording.names if n.startswith(("bearing1.outer.x", "resonator1")))
    spectrum = envelope_spectrum(recording.series(name), band=BAND_HZ)
    expected = times * assemble(spec).bases_hz[base]
    near = np.abs(spectrum.frequency_hz - expected) < 0.2 * expected
    found = spectrum.frequency_hz[near][np.argmax(spectrum.values[near])]
    assert abs(found - expected) <= spectrum.resolution_hz
    assert np.max(spectrum.values[near]) > 4.0 * np.median(spectrum.values[near])
