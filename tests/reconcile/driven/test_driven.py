"""The level `driven`: laws that an independent integrator hid are named, and what is not there is not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.driven import reconcile_driven
from reconcile.driven.channels import driven_of
from reconcile.driven.direction import directed
from reconcile.driven.fit import first_guess, fit
from reconcile.driven.missing import anything_missing
from reconcile.driven.model import Model, errors, nrmse, ready, refined, simulated
from reconcile.driven.split import parts_of, strongest
from reconcile.report import page, strict_json
from reconcile.verdict import Report
from sim.core.errors import SpecError
from sim.core.response import Channel
from sim.core.spec import MachineSpec, MeasuredLoad
from sim.presets import preset
from sim.solve.api import simulate
from tests.reconcile.driven.made import DAMPING, FREQUENCY, MASS, RATE, hysteretic, recording

SPEC = preset("oscillator")
STIFFNESS = MASS * (2 * np.pi * FREQUENCY) ** 2


def reproduced(report: Report) -> float:
    """Largest difference between the revised machine in the simulator and the shown prediction, over its size."""
    machine = MachineSpec.model_validate(report.machine)
    load = machine.loads[0]
    trace = report.pictures["traces"][0]  # type: ignore[index]
    found = simulate(
        machine,
        duration_s=len(load.values) * load.step_s,
        output_rate_hz=1 / load.step_s,
        channels=["mass.y.displacement"],
    )
    shown = np.asarray(trace["after"])
    run = found.signals[0][-shown.size :] + float(report.provenance["output_offset"])  # type: ignore[arg-type]
    return float(np.max(np.abs(run - shown)) / np.max(np.abs(shown)))


@pytest.mark.slow
def test_linear_model_is_found_from_any_start() -> None:
    data = driven_of(recording(None, seed=3), SPEC)
    start = first_guess(data)
    run = ready(data, start.memory_s)
    found = fit(start, run)
    assert found.model.stiffness == pytest.approx(STIFFNESS / MASS, rel=2e-3)
    assert found.model.damping == pytest.approx(2 * DAMPING * 2 * np.pi * FREQUENCY, rel=1e-2)
    assert 1 / found.model.gain == pytest.approx(MASS, rel=5e-3)
    value, low, high = found.interval(0)
    assert low < value < high
    assert high - low < 0.01 * value


@pytest.mark.slow
def test_free_run_is_its_closed_form() -> None:
    """A step of force on a damped oscillator."""
    data = driven_of(recording(None, seed=3, n=3000), SPEC)
    run = ready(replace(data, drive=np.ones(3000)), 0.0)
    w, c = 2 * np.pi * FREQUENCY, 30.0
    found = simulated(Model(stiffness=w * w, damping=c, gain=w * w), run)
    t = np.arange(3000) / RATE
    wd = np.sqrt(w * w - c * c / 4)
    expected = 1 - np.exp(-c * t / 2) * (np.cos(wd * t) + c / 2 / wd * np.sin(wd * t))
    assert np.max(np.abs(found - expected)) < 1e-3


def test_input_between_samples_is_band_limited() -> None:
    k = np.arange(400)
    fine = refined(np.sin(2 * np.pi * 0.33 * k))
    expected = np.sin(2 * np.pi * 0.33 * np.arange(fine.size) / 8)
    assert np.max(np.abs(fine - expected)[300:-300]) < 1e-3


@pytest.mark.slow
def test_a_linear_system_has_nothing_missing() -> None:
    """20 linear systems with coloured noise: at a level of 1 % two alarms or more have a probability of 2 %."""
    alarms = 0
    for seed in range(20):
        data = driven_of(recording(None, seed=100 + seed, n=4000, noise=0.02), SPEC)
        run = ready(data, 0.2)
        found = fit(first_guess(data), run)
        alarms += anything_missing(found.model, run, found.error, np.random.default_rng(seed)).p_value < 0.01
    assert alarms <= 1


@pytest.mark.slow
@pytest.mark.parametrize(
    ("key", "law"),
    [
        ("cubic", lambda x, v: 0.3 * STIFFNESS * x**3 / 1e-6),
        ("contact_above", lambda x, v: 0.5 * STIFFNESS * max(x - 5e-4, 0.0)),
        ("drag", lambda x, v: 0.2 * STIFFNESS * 1e-3 * v * abs(v) / 0.25**2),
    ],
)
def test_a_hidden_law_is_named_and_the_machine_reproduces_it(key: str, law: object) -> None:
    report = reconcile_driven(SPEC, [recording(law, seed=11)], seed=2)  # type: ignore[arg-type]
    assert report.verdict in ("explained", "unknown_physics", "ambiguous")
    assert report.held_out is not None
    assert report.held_out.gain_low > max(report.held_out.retuned or 0, report.held_out.placebo or 0)
    assert report.causes[0].severity is not None
    best = {report.causes[0].severity.name} | ({"stops", "contact_below"} if key == "contact_above" else set())
    assert key in best
    assert report.held_out.after < 0.05
    assert reproduced(report) < 5e-3
    assert page(report).startswith("<!doctype html>")
    assert strict_json(report)


@pytest.mark.slow
def test_a_linear_recording_gets_no_name() -> None:
    report = reconcile_driven(SPEC, [recording(None, seed=21)], seed=2)
    assert report.verdict == "nothing_missing"
    assert not report.causes
    assert not report.where.sites
    assert report.held_out is None


def test_roles_come_from_quantities_locations_or_are_stated() -> None:
    made = recording(None, seed=1, n=600)
    flipped = made.select(channels=["displacement", "force"])
    assert driven_of(flipped, SPEC).drive_channel.name == "force"
    volts = replace(made, channels=tuple(replace(c, quantity="voltage", unit="V") for c in made.channels))
    assert "taken to drive" in driven_of(volts, SPEC).assumed
    told = replace(
        volts, channels=(replace(volts.channels[0], location="output"), replace(volts.channels[1], location="input"))
    )
    assert driven_of(told, SPEC).drive_channel.name == "displacement"
    moving = replace(made, channels=tuple(replace(c, quantity="acceleration", unit="m/s^2") for c in made.channels))
    with pytest.raises(SpecError, match="which channel drives"):
        driven_of(moving, SPEC)


@pytest.mark.slow
def test_direction_is_told_by_the_purer_sine() -> None:
    made = recording(None, seed=1, n=4000)
    forced = directed(made, SPEC)
    assert forced.drive_channel.name == "force"
    assert "is taken to drive" in forced.assumed
    t = np.arange(4000) / RATE
    x = 1e-2 * np.sin(2 * np.pi * t) * (1 + 0.3 * np.sin(0.7 * t))
    force = 1e5 * x + 800.0 * np.tanh(np.gradient(x, 1 / RATE) / 1e-3)
    moved = directed(replace(made, samples=np.vstack([force, x])), SPEC)
    assert moved.prescribed
    assert moved.drive_channel.name == "displacement"
    load = MeasuredLoad(body="mass", axis="y", step_s=0.1, values=(0.0, 1.0))
    assert directed(made, SPEC.model_copy(update={"loads": [load]})).assumed == ""


@pytest.mark.slow
def test_bad_input_is_refused_with_its_place() -> None:
    made = recording(None, seed=1, n=3200)
    with pytest.raises(SpecError, match="one mass on a spring"):
        reconcile_driven(preset("rotor"), [made])
    with pytest.raises(SpecError, match="too short"):
        reconcile_driven(SPEC, [made.select(end_s=1.0)])
    holed = made.samples.copy()
    holed[1, 77] = np.nan
    with pytest.raises(SpecError, match="sample 77"):
        driven_of(replace(made, samples=holed), SPEC)
    third = Channel(name="t", quantity="temperature", unit="K", location="")
    wide = replace(made, channels=(*made.channels, third), samples=np.vstack([made.samples, holed[0]]))
    assert driven_of(wide, SPEC).drive_channel.name == "force"


def test_parts_of_one_and_of_several_recordings() -> None:
    data = driven_of(recording(None, seed=1, n=600), SPEC)
    assert [p.data.answer.size for p in parts_of([data])] == [200, 200, 200]
    assert [p.name for p in parts_of([data, data])] == ["recording 1", "recording 2"]
    values = np.zeros(100)
    values[60:70] = np.arange(10.0)
    assert 55 <= strongest(values, 15) <= 60


def test_error_is_relative_to_the_spread() -> None:
    data = driven_of(recording(None, seed=1, n=600), SPEC)
    run = ready(data, 0.0)
    silent = Model(stiffness=1e4, damping=10.0, gain=0.0)
    assert nrmse(errors(silent, run), run.compared) == pytest.approx(1.0, rel=0.05)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1])
def test_hysteresis_which_is_no_listed_law_gets_no_name_that_feeds_energy_in(seed: int) -> None:
    report = reconcile_driven(SPEC, [hysteretic(seed=seed)], seed=1)
    assert report.verdict == "unknown_physics", report.sentence
    assert not any(c.named for c in report.causes) and report.force is not None and report.force.law is None
    assert any("feeds energy in" in reason for c in report.causes for reason in c.reasons)


@pytest.mark.slow
def test_an_output_that_does_not_follow_the_input_decides_nothing() -> None:
    linear = recording(None, seed=4)
    noise = linear.samples[1].std() * np.random.default_rng(4).normal(size=linear.samples.shape[1])
    report = reconcile_driven(SPEC, [replace(linear, samples=np.vstack([linear.samples[0], noise]))], seed=1)
    assert report.verdict == "not_decidable" and "does not follow the input" in report.sentence
    assert report.machine is None and report.undecidable and report.next_experiment is not None
    assert report.force is None and not report.where.sites
