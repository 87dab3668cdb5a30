"""The machines on flexible shafts: statics of their bearings, settled and balanced runs, predicted lines."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.assembly.modes import contact_stiffness
from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.settings import Settings

RIGS = ("bearing-rig", "two-stage", "overhung")
FAST = Settings(estimate_error=False)
RATE_HZ = 24_000.0


@cache
def running(name, duration_s=2.4):
    return simulate(preset(name), duration_s=duration_s, output_rate_hz=RATE_HZ, settings=FAST)


@pytest.mark.slow
@pytest.mark.parametrize("name", RIGS)
def test_energy_is_balanced_and_the_transient_ends(name):
    run = running(name)
    assert run.quality.energy.relative_residual < 1e-3
    # half a second in, the start-up is over: later thirds are alike
    settled = run.signals[:, int(0.5 * RATE_HZ) :]
    parts = [part.std(axis=1) for part in np.array_split(settled, 3, axis=1)]
    assert parts[1] == pytest.approx(parts[2], rel=0.05)


@pytest.mark.slow
@pytest.mark.parametrize("name", RIGS)
def test_the_pilot_finds_the_step_fine_enough(name):
    run = simulate(preset(name), duration_s=0.1, output_rate_hz=RATE_HZ)
    assert run.quality.step_error < 5e-3


@pytest.mark.parametrize("name", RIGS)
def test_no_motion_grows_and_what_is_no_damper_is_gyroscopic(name):
    system = assemble(preset(name))
    n = len(system.dofs)
    k = system.stiffness + contact_stiffness(system)
    inverse = 1.0 / system.mass[:, None]
    poles = np.linalg.eigvals(np.block([[np.zeros((n, n)), np.eye(n)], [-k * inverse, -system.damping * inverse]]))
    assert poles.real.max() < 1e-3 * np.abs(poles).max() * 1e-3
    assert np.all(poles[np.abs(poles.imag) > 60.0].real < -1.0), "start-up is gone to 1/e within a second"
    dampers = np.zeros((n, n))
    for damper in system.dampers:
        row = np.zeros(n)
        for i, w in damper.weights:
            row[i] += w
        dampers += damper.damping * np.outer(row, row)
    skew = system.damping - dampers
    assert np.abs(skew).max() > 0.0
    assert np.abs(skew + skew.T).max() < 1e-9 * np.abs(system.damping).max()


def amplitudes(run, channel):
    """Frequency and amplitude of a sensor's settled signal, 0.5 Hz apart."""
    x = run.signal(channel)[-int(2.0 * RATE_HZ) :]
    window = np.hanning(x.size)
    return 2.0 * np.abs(np.fft.rfft(x * window)) / window.sum()


def peak(spectrum, hz):
    """Largest of the three bins at a frequency over the median around it."""
    k = round(2.0 * hz)
    return spectrum[k - 1 : k + 2].max() / np.median(spectrum[k - 20 : k + 21])


@pytest.mark.slow
def test_the_two_stage_gearbox_shows_both_meshes_and_three_shafts():
    run = running("two-stage")
    bases = assemble(preset("two-stage")).bases_hz
    assert bases["f_m"] == pytest.approx(21 * 25.0)
    assert bases["f_m2"] == pytest.approx(19 * 25.0 * 21 / 59)
    assert bases["f_r3"] == pytest.approx(25.0 * 21 / 59 * 19 / 67)
    spectra = [amplitudes(run, f"resonator{i}.y.acceleration") for i in range(1, 7)]
    wanted = {
        "f_m": bases["f_m"],
        "f_m2": bases["f_m2"],
        "f_m - f_r1": bases["f_m"] - bases["f_r1"],
        "f_m + f_r2": bases["f_m"] + bases["f_r2"],
        "f_m2 - f_r3": bases["f_m2"] - bases["f_r3"],
    }
    for name, hz in wanted.items():
        assert max(peak(s, hz) for s in spectra) > 4.0, name
    predicted = {line.label for line in assemble(preset("two-stage")).lines}
    assert {"1*f_m", "1*f_m2"} <= predicted
    for shaft in ("f_r1", "f_r2", "f_r3"):
        assert any(shaft in label and "f_m" in label for label in predicted), shaft


@pytest.mark.slow
def test_the_bearing_rig_shows_its_ball_pass():
    """6205, 29.95 Hz: 3.5848 orders, 107.36 Hz (Case Western Reserve University's bearing table)."""
    bases = assemble(preset("bearing-rig")).bases_hz
    assert bases["f_o1"] == pytest.approx(3.5848 * 29.95, rel=1e-4)
    spectrum = amplitudes(running("bearing-rig"), "resonator1.y.acceleration")
    for k in (1, 2, 3):
        assert peak(spectrum, k * bases["f_o1"]) > 10.0


def test_the_bearing_rig_is_balanced_to_its_grade():
    """G 2.5: a residual unbalance moves the centre of mass at 2.5 mm/s at the rig's speed (ISO 21940-11)."""
    machine = preset("bearing-rig")
    speed_m_per_s = {
        t.site: t.parameters["moment"]
        / next(b.mass_kg for b in machine.bodies if b.name == t.site)
        * 2
        * math.pi
        * machine.operating.speed_hz
        for t in machine.terms
    }
    assert speed_m_per_s == {"rotor": pytest.approx(2.5e-3, rel=0.02), "disc": pytest.approx(2.5e-3, rel=0.02)}


def reactions_n(name, bearings):
    """Mean force of each bearing on its shaft (x, y), N: no gravity and no run-out, six turns of the input averaged."""
    machine = preset(name).model_copy(update={"gravity_m_per_s2": 0.0, "terms": []})
    wanted = tuple(f"{b}.outer.{a}.displacement" for b in bearings for a in "xy")
    run = simulate(machine, duration_s=1.0, output_rate_hz=RATE_HZ, channels=wanted, settings=FAST)
    held = {b.name: b.support for b in machine.bearings}
    found = []
    turns = round(6 / 30.0 * RATE_HZ) if name == "overhung" else round(5 / 25.0 * RATE_HZ)
    for b in bearings:
        mean = [run.signal(f"{b}.outer.{a}.displacement")[-turns:].mean() for a in "xy"]
        found.append((-held[b].stiffness_x_n_per_m * mean[0], -held[b].stiffness_y_n_per_m * mean[1]))
    return np.array(found)


ALPHA = math.radians(20.0)


def lever(load, at, first, second):
    """Reactions of two bearings to a force at a place along the shaft: moments about either."""
    share = (at - first) / (second - first)
    return np.array([-(1.0 - share) * load, -share * load])


@pytest.mark.slow
def test_reactions_of_the_overhung_gearbox_are_those_of_statics():
    """F_t = T/r pushes the driving pinion along +y (it turns from y to x), F_r = F_t tan(alpha) away from its gear."""
    tangential = 25.0 / (0.5 * 0.0025 * 21)
    force = np.array([-tangential * math.tan(ALPHA), tangential])
    expected = np.vstack([lever(force, 0.17, 0.015, 0.125), lever(-force, 0.08, 0.01, 0.15)])
    found = reactions_n("overhung", ("bearing1", "bearing2", "bearing3", "bearing4"))
    assert found == pytest.approx(expected, rel=2e-3, abs=2e-3 * tangential)
    assert np.linalg.norm(found[1]) > 1.3 * tangential, "the bearing by the pinion carries more than the tooth force"


@pytest.mark.slow
def test_reactions_of_the_idler_are_the_sum_of_both_meshes():
    """Both tooth forces push the idler to one side in y, against each other in x."""
    first = 20.0 / (0.5 * 0.002 * 21)
    second = first * (59 * 0.002) / (19 * 0.0025)
    on_gear = np.array([first * math.tan(ALPHA), -first])
    on_pinion = np.array([-second * math.tan(ALPHA), -second])
    expected = lever(on_gear, 0.05, 0.01, 0.15) + lever(on_pinion, 0.105, 0.01, 0.15)
    found = reactions_n("two-stage", ("bearing3", "bearing4"))
    assert found == pytest.approx(expected, rel=5e-3, abs=5e-3 * second)
