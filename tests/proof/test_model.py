"""The second machine against the reference solutions, its own integration, and the lines its effects must make."""

from __future__ import annotations

import json
import math
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from proof.effects import Choice
from proof.library import CLOSED
from proof.machine import NOMINAL, arrays_of, exact_machine
from proof.model.layout import B, G, Tooth
from proof.run_up import Y_DOFS, Diverged, accelerations, steady
from proof.unknown import OPEN

REFERENCE = Path(__file__).resolve().parents[2].parent / "shared" / "reference"
Y_RING_1 = 4
PALMGREN = 3.83e-5


def reference(name):
    if not (REFERENCE / f"{name}.npz").exists():
        pytest.skip(f"no reference solution {name} beside the project")
    told = json.loads((REFERENCE / f"{name}.json").read_text())
    machine = arrays_of(exact_machine(), NOMINAL | {key: told[key] for key in NOMINAL if key in told}, ramp_s=0.0)
    machine.bearings[2:, B.RATIO] = told["g2"]
    machine.bearings[:2, B.RATIO] = told["g1"]
    with np.load(REFERENCE / f"{name}.npz") as stored:
        return told, machine, stored["a"][1500:].T


def level(signal, hz, rate=20_000):
    """Amplitude at a frequency (Hann)."""
    n = signal.size
    t = np.arange(n) / rate
    window = np.hanning(n)
    return 2.0 * abs(np.sum((signal - signal.mean()) * window * np.exp(-2j * math.pi * hz * t))) / window.sum()


def motion(machine, **changes):
    """0.15 s from 0.05 s after the step in torque, at 30 kHz."""
    given = {"duration_s": 0.15, "settle_s": 0.05, "oversampling": 4, "rate_hz": 30_000, "dofs": tuple(range(28))}
    given |= changes
    return accelerations(machine, steady(30.0), **given)[:, :: given["oversampling"]]


@pytest.mark.slow
def test_the_healthy_machine_is_that_of_the_reference():
    _, machine, theirs = reference("lightly_damped_healthy")
    ours = motion(machine)
    moving = np.std(theirs, axis=1) > 5.0
    assert moving.sum() == 23
    ratio = np.std(ours, axis=1)[moving] / np.std(theirs, axis=1)[moving]
    assert np.all(np.abs(ratio - 1.0) < 0.02)
    for dof in Y_DOFS:
        assert np.linalg.norm(ours[dof] - theirs[dof]) < 0.05 * np.linalg.norm(theirs[dof])


@pytest.mark.slow
def test_a_ring_in_a_rigid_bore_is_that_of_the_reference():
    told, machine, theirs = reference("lightly_damped_clearance_20um")
    b = machine.bearings[0]
    b[B.FIT], b[B.FIT_GAP], b[B.FIT_N] = 2.0, told["delta"], 10.0 / 9.0
    b[B.FIT_K] = (1e3 * told["L2"] ** 0.8 / PALMGREN) ** (10.0 / 9.0)
    b[B.FIT_LOSS], b[B.FIT_MU], b[B.FIT_PRESLIDE] = 3.5, told["mu"], 1e-6
    ours = motion(machine)
    for dof in (*Y_DOFS[1:], Y_RING_1):
        assert np.std(ours[dof]) == pytest.approx(np.std(theirs[dof]), rel=0.15)
    # the loose ring's resonator moves little and mostly with the shocks of entering teeth, which are softer here
    for order in (1, 2):
        lines = [level(a[Y_DOFS[0]], order * 23 * 30.0, 30_000) for a in (ours, theirs)]
        assert lines[0] == pytest.approx(lines[1], rel=0.25)


@pytest.mark.slow
def test_halving_the_step_changes_the_motion_by_a_sixteenth_as_much():
    machine = arrays_of(exact_machine())
    runs = {n: motion(machine, duration_s=0.02, settle_s=0.0, oversampling=n) for n in (2, 4, 8, 16)}
    errors = [np.linalg.norm(runs[n][list(Y_DOFS)] - runs[16][list(Y_DOFS)]) for n in (2, 4, 8)]
    assert errors[0] > 6.0 * errors[1] > 36.0 * errors[2]
    assert errors[1] < 2e-3 * np.linalg.norm(runs[16][list(Y_DOFS)])


def test_a_machine_that_flies_apart_is_an_error():
    machine = arrays_of(exact_machine())
    machine.bearings[:, B.KPY] = -1e8
    with pytest.raises(Diverged):
        motion(machine, duration_s=0.3)


def at_torque(torque_nm):
    return arrays_of(exact_machine(), dict(NOMINAL) | {"T": torque_nm})


def with_effect(name, site, value, variant=0, seed=1):
    law = CLOSED[name] if name in CLOSED else OPEN[name]
    machine = at_torque(law.torque_nm)
    choice = Choice(site=law.sites.index(site), value=value, variant=variant, rng=np.random.default_rng(seed))
    law.apply(machine, choice)
    return machine


def run(machine, duration_s=0.3, settle_s=0.15):
    """Lines are resolved to 4 / 0.3 Hz by the window: less than half a turn's, the nearest of any two."""
    fine = accelerations(
        machine, steady(30.0), duration_s=duration_s, settle_s=settle_s, oversampling=1, rate_hz=120_000, dofs=Y_DOFS
    )
    return fine[:, ::6]


@cache
def healthy(torque_nm=25.0, **changes):
    return run(at_torque(torque_nm), **changes)


SPEED = 30.0
G1 = 0.2647
FTF = 0.5 * (1 - G1) * SPEED
BPFO, BPFI = 7 * FTF, 7 * (SPEED - FTF)
MESH = 23 * SPEED
LINES = [
    ("outer_pit", "bearing1", 1.6e-3, 0, [BPFO, 2 * BPFO, 3 * BPFO]),
    ("inner_pit", "bearing1", 1.6e-3, 0, [BPFI, BPFI - SPEED, BPFI + SPEED]),
    ("root_crack", "pinion", 0.1, 0, [MESH + SPEED, MESH - SPEED, MESH + 2 * SPEED]),
    ("flank_pit", "pinion", 0.95, 0, [MESH + SPEED, MESH - SPEED]),
    ("broken_tooth", "pinion", 0.7, 0, [MESH + SPEED, MESH - SPEED]),
    ("imbalance", "pinion", 1.2e-2, 0, [SPEED]),
    ("run_out", "pinion", 2e-5, 0, [SPEED, MESH - SPEED]),
    ("bow", "pinion", 1e-4, 0, [SPEED]),
    ("parallel_offset", "input", 1e-3, 0, [2 * SPEED]),
    ("joint_angle", "input", 0.12, 0, [2 * SPEED]),
    ("tooth_pitch", "pinion", 5e-6, 0, [SPEED * 5, MESH + SPEED]),
    ("line_torque", "input", 4.0, 0, [100.0]),
]


@pytest.mark.slow
@pytest.mark.parametrize(("name", "site", "value", "variant", "lines"), LINES, ids=[row[0] for row in LINES])
def test_an_effect_shows_at_its_lines(name, site, value, variant, lines):
    faulty = run(with_effect(name, site, value, variant))
    for hz in lines:
        gains = [level(f, hz) / max(level(h, hz), 1e-4) for f, h in zip(faulty, healthy(), strict=True)]
        assert max(gains) > 3.0, f"{hz:g} Hz: {gains}"


@pytest.mark.slow
@pytest.mark.parametrize("name", [*CLOSED, *OPEN])
def test_every_law_runs_at_its_corners_and_changes_something(name):
    law = CLOSED[name] if name in CLOSED else OPEN[name]
    short = {"duration_s": 0.1, "settle_s": 0.1 if name == "ball_pit" else 0.0}  # a ball turns its pit to a race late
    sound = healthy(law.torque_nm, **short)
    for site, variant in {*((law.sites[0], v) for v in range(law.variants)), (law.sites[-1], 0)}:
        found = run(with_effect(name, site, law.levels[3], variant), **short)
        assert np.all(np.isfinite(found))
        assert np.linalg.norm(found - sound) > 1e-3 * np.linalg.norm(sound)


@pytest.mark.slow
def test_a_sound_tooth_and_a_zero_severity_change_nothing():
    machine = arrays_of(exact_machine())
    before = motion(machine, duration_s=0.02)
    machine.teeth[0, 3, Tooth.CRACK_FORM] = 1.0
    machine.bearings[0, B.OUTER_DEPTH] = 1e-4
    assert np.array_equal(before, motion(machine, duration_s=0.02))


def test_the_mean_force_balances_the_torque():
    machine = arrays_of(exact_machine())
    assert machine.g[G.TOUT] == pytest.approx(25.0 * 81 / 23)
