"""Tooth friction against vectors, and its loss against the loss factor."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.core.spec import TermSpec, TransmissionError
from sim.parts.gear.from_spec import pair_from_spec
from sim.parts.gear.pair import pair_stiffness_n_per_m
from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.settings import Settings
from sim.terms import REGISTRY
from tests.strategies.meshes import at_phase, element_of
from tests.strategies.systems import with_terms
from tests.strategies.trains import train

MU, SPEED, DEFLECTION = 0.08, 0.02, 9e-6
TERM = REGISTRY.get("tooth_friction")
OMEGA = 2.0 * math.pi * 20.0


def cross(a, b):
    return a[0] * b[1] - a[1] * b[0]


def turned(v):
    return np.array([-v[1], v[0]])


def built(driver, flip):
    """Two gears of 20 and 31 teeth, by themselves or (`flip`) behind a third one, so that the pinion turns +1."""
    teeth, pairs = {"a": 20, "b": 31}, [("a", "b")]
    if flip:
        teeth, pairs = {"o": 30, **teeth}, [("o", "a"), *pairs]
    site = f"mesh{len(pairs)}"
    term = TermSpec(term="tooth_friction", site=site, parameters={"coefficient": MU, "speed": SPEED})
    machine = train(teeth, pairs, {driver: 30.0}, terms=[term], line_of_action="rotated")
    return machine, element_of(assemble(machine), f"{site}.friction"), machine.meshes[-1]


def vector_forces(machine, mesh, drive, sense, phase):
    """Resistances (across, pinion, gear): contact points, speeds, forces and torques as plane vectors."""
    gears = {g.name: g for g in machine.gears}
    pair = pair_from_spec(gears["a"], gears["b"], mesh).pair
    contact = pair.contact()
    alpha, a = contact.working_angle_rad, contact.centre_distance_m
    pitch_radius, centre = a * 20 / 51, np.array([a, 0.0])
    # the flanks that touch: the force on the pinion points away from the gear and against (with) its motion
    push = np.array([-math.sin(alpha), -drive * sense * math.cos(alpha)])
    pitch = np.array([pitch_radius, 0.0])
    foot = pitch - (pitch @ push) * push
    across = turned(push) * np.sign(turned(push)[0])
    total = np.zeros(3)
    for place in (phase, phase + 1.0):
        if place >= contact.contact_ratio:
            continue
        along = place * contact.base_pitch_m
        arm = contact.start_m + along if drive > 0 else contact.end_m - along
        point = foot - arm * push
        omega_p, omega_g = sense * OMEGA, -sense * OMEGA * 20 / 31
        sliding = across @ (omega_p * turned(point) - omega_g * turned(point - centre))
        load = float(pair_stiffness_n_per_m(pair, np.array(place))) * DEFLECTION
        on_pinion = -MU * load * math.tanh(sliding / SPEED) * across
        torques = sense * cross(point, on_pinion), -sense * cross(point - centre, -on_pinion)
        total -= np.array([across @ on_pinion, *torques])
    return total


@pytest.mark.parametrize("flip", [False, True])
@pytest.mark.parametrize("driver", ["a", "b"])
def test_forces_and_torques_of_vectors(driver, flip):
    machine, element, mesh = built(driver, flip)
    law_drive = 1.0 if driver == "a" else -1.0
    sense = 1.0 if flip else -1.0
    u = np.array([0.0, 0.0, 0.0, 0.0, law_drive * DEFLECTION, 0.0, 0.0])
    for phase in np.arange(0.03, 1.0, 0.09):
        expected = vector_forces(machine, mesh, law_drive, sense, phase)
        expected[1:] -= element.parameters[-2:]  # what makes good the mean loss
        found = at_phase(element, 20, phase, u, np.zeros(7), speeds=(OMEGA, OMEGA * 20 / 31))
        scale = np.array([1.0, 0.03, 0.05]) * MU * 4e8 * DEFLECTION
        # the stiffness table is interpolated
        assert found.force[:3] / scale == pytest.approx(expected / scale, abs=TERM.validation[0].deviation)


def test_it_reverses_at_the_pitch_point_and_always_takes_energy():
    machine, element, mesh = built("a", False)
    gears = {g.name: g for g in machine.gears}
    contact = pair_from_spec(gears["a"], gears["b"], mesh).pair.contact()
    pitch = (contact.pitch_point_m - contact.start_m) / contact.base_pitch_m
    assert contact.contact_ratio - 1.0 < pitch < 1.0  # one pair only
    u, speeds = np.array([0.0, 0.0, 0.0, 0.0, DEFLECTION, 0.0, 0.0]), (OMEGA, OMEGA * 20 / 31)
    found = [at_phase(element, 20, pitch + d, u, np.zeros(7), speeds=speeds) for d in (-0.01, 0.0, 0.01)]
    assert found[0].force[0] > 0.0 > found[2].force[0]
    assert abs(found[1].force[0]) < 1e-9
    assert found[0].outputs[1] > 0.0
    assert found[2].outputs[1] > 0.0


def loss_share(z1, z2, contact):
    """Loss over power per unit friction for equally shared load: pi (1/z1 + 1/z2)(1 - eps + eps1^2 + eps2^2)."""
    before = (contact.pitch_point_m - contact.start_m) / contact.base_pitch_m
    after = (contact.end_m - contact.pitch_point_m) / contact.base_pitch_m
    return math.pi * (1 / z1 + 1 / z2) * (1.0 - before - after + before**2 + after**2)


@pytest.fixture(scope="module")
def run():
    """Power lost over power transmitted and coefficient, of two gears without transmission error; and their contact."""
    plain = preset("gear-pair")
    mesh = plain.meshes[0].model_copy(update={"transmission_error": TransmissionError()})
    term = TermSpec(term="tooth_friction", site="mesh1", parameters={"coefficient": 0.05, "speed": 0.01})
    machine = with_terms(plain.model_copy(update={"meshes": [mesh]}), term)
    response = simulate(
        machine,
        duration_s=0.5,
        output_rate_hz=12_000.0,
        channels=("pinion.theta.velocity",),
        settings=Settings(estimate_error=False),
    )
    energy = response.quality.energy
    assert energy.acceptable
    lost = energy.dissipated_j["mesh1.friction"] / (0.5 * 25.0 * 2.0 * math.pi * 30.0 * 0.05)
    return lost, pair_from_spec(*machine.gears, mesh).pair, response.signals[0]


def test_loss_agrees_with_the_loss_factor(run):
    lost, pair, _ = run
    assert lost == pytest.approx(loss_share(23, 81, pair.contact()), rel=TERM.validation[1].deviation)


def test_loss_agrees_with_a_quadrature_over_the_mesh_period(run):
    lost, pair, _ = run
    contact = pair.contact()
    phase = (np.arange(4000) + 0.5) / 4000
    place = np.array([phase, phase + 1.0])
    stiffness = pair_stiffness_n_per_m(pair, place)
    path = contact.start_m + place * contact.base_pitch_m
    sliding = np.abs(path - (contact.line_length_m - path) * 23 / 81)
    expected = float(np.mean(np.sum(stiffness * sliding, axis=0) / stiffness.sum(axis=0))) / pair.pinion.base_radius_m
    assert lost == pytest.approx(expected, rel=TERM.validation[2].deviation)


def test_the_drive_makes_good_the_loss(run):
    """Without it the shafts would slow down by 12 rad/s in the half second (31 W at 30 J)."""
    assert np.abs(run[2][-600:].mean()) < 1.0


def test_it_drains_motion_across_the_line_of_action():
    """More sliding, more resistance: the friction of a pair beside the pitch point does not decrease."""
    _, element, _ = built("a", False)
    u = np.array([0.0, 0.0, 0.0, 0.0, DEFLECTION, 0.0, 0.0])
    values = []
    for rate in (-0.01, 0.0, 0.01):
        ud = np.array([rate, 0, 0, 0, 0, 0, 0.0])
        values.append(float(at_phase(element, 20, 0.62, u, ud, speeds=(OMEGA, OMEGA * 20 / 31)).force[0]))
    assert values == sorted(values)
