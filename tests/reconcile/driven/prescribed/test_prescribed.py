"""Prescribed motion: backlash and friction hidden by an independent stepping, and a measured banded brake."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

from reconcile.driven import reconcile_driven
from reconcile.driven.prescribed.resistance import Motion, path_force, travel_to
from reconcile.driven.prescribed.reversals import backlash_travel
from reconcile.report import page, strict_json
from reconcile.verdict import Report
from signals.recording import Recording
from sim.core.response import Channel
from sim.core.spec import MachineSpec
from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.settings import Settings

RATE = 500.0
SPEC = preset("oscillator")
BRFD = Path(__file__).resolve().parents[5] / "shared" / "recordings" / "brfd_backlash"
INCH_M, KIP_N = 0.0254, 4448.2216152605


def channels() -> tuple[Channel, Channel]:
    return (
        Channel(name="displacement", quantity="displacement", unit="m", location="input"),
        Channel(name="force", quantity="force", unit="N", location="output"),
    )


def swing(size_m: float, n: int = 5000) -> np.ndarray:
    """A 1 Hz sine that fades in over two cycles."""
    t = np.arange(n) / RATE
    return np.asarray(size_m * np.clip(t / 2, 0, 1) * np.sin(2 * math.pi * t))


def hidden(x: np.ndarray, friction: float, backlash: float, elastic: float, seed: int) -> Recording:
    """Slider found by bisection-free geometry: it is dragged when the far side of the play is reached."""
    rng = np.random.default_rng(seed)
    reach = 0.5 * backlash + friction / elastic
    slider, force = 0.0, np.empty(x.size)
    for i, place in enumerate(x):
        slider = place - reach if place - slider > reach else place + reach if slider - place > reach else slider
        gap = place - slider
        force[i] = elastic * math.copysign(max(abs(gap) - 0.5 * backlash, 0.0), gap)
    noise = np.convolve(rng.normal(size=x.size + 4), np.ones(5) / 5, mode="valid")
    return Recording(
        sampling_rate_hz=RATE, channels=channels(), samples=np.vstack([x, force + 0.03 * friction * noise])
    )


def measured(name: str) -> Recording:
    path = BRFD / f"{name}.json"
    if not path.exists():
        pytest.skip(f"no recording {path.name} beside the project")
    rows = np.array(json.loads(path.read_text())["data"])
    samples = np.vstack([rows[:, 1] * INCH_M, rows[:, 2] * KIP_N])
    return Recording(sampling_rate_hz=1024.0, channels=channels(), samples=samples)


def severity(report: Report, name: str) -> tuple[float, float, float]:
    found = next(c.severity for c in report.causes if c.severity is not None and c.severity.name == name)
    return found.value, found.low, found.high


def test_path_is_its_closed_form_over_a_half_turn() -> None:
    """From the sliding force: unloading, play, loading, sliding again, in that order and length."""
    x = np.concatenate([np.linspace(0, 10, 1001), np.linspace(10, 0, 1001)[1:]])
    motion = Motion(displacement=x, velocity=np.gradient(x), step_s=1.0)
    values = {"friction": 6.0, "elastic": 3.0, "asymmetry": 0.0, "backlash": 1.5, "slack": 0.0}
    force = path_force(values, motion)
    assert force[1000] == pytest.approx(6.0)
    down = 10 - x[1000:]
    expected = np.where(down < 2, 6 - 3 * down, np.where(down < 3.5, 0.0, np.maximum(-3 * (down - 3.5), -6.0)))
    assert np.max(np.abs(force[1000:] - expected)) < 1e-9
    assert travel_to(values, 0.8) == pytest.approx(1.5 + 1.8 * 2.0)


def test_travel_is_read_from_the_data() -> None:
    made = hidden(swing(0.02), 1000.0, 4e-3, 1e6, 1)
    x = made.samples[0]
    motion = Motion(displacement=x, velocity=np.gradient(x, 1 / RATE), step_s=1 / RATE)
    found = backlash_travel(motion, made.samples[1], np.random.default_rng(0))
    assert found is not None
    assert found.low_m <= found.mean_m <= found.high_m
    assert found.mean_m == pytest.approx(4e-3 + 1.8e-3, abs=3e-4)


@pytest.mark.slow
def test_hidden_backlash_is_named_with_its_size() -> None:
    runs = [hidden(swing(0.010), 1000.0, 4e-3, 1e6, 1), hidden(swing(0.02), 1000.0, 4e-3, 1e6, 2)]
    report = reconcile_driven(SPEC, runs, seed=1)
    assert report.verdict == "explained"
    assert report.causes[0].term == "backlash"
    value, low, high = severity(report, "backlash")
    assert low - 1e-4 <= 4e-3 <= high + 1e-4
    assert value == pytest.approx(4e-3, rel=0.05)
    assert severity(report, "friction")[0] == pytest.approx(1000.0, rel=0.03)
    assert report.held_out is not None
    assert report.held_out.after < 0.08
    assert report.held_out.gain_low > max(report.held_out.retuned or 0, report.held_out.black_box or 0)
    assert page(report)
    assert strict_json(report)


@pytest.mark.slow
def test_a_spring_and_damper_have_nothing_missing() -> None:
    runs = []
    for seed in (1, 2):
        x = swing(0.01 * seed)
        force = 1e5 * x + 2e3 * np.gradient(x, 1 / RATE)
        rng = np.random.default_rng(seed)
        noise = np.convolve(rng.normal(size=x.size + 4), np.ones(5) / 5, mode="valid")
        samples = np.vstack([x, force + 20 * noise])
        runs.append(Recording(sampling_rate_hz=RATE, channels=channels(), samples=samples))
    report = reconcile_driven(SPEC, runs, seed=1)
    assert report.verdict == "nothing_missing"
    assert not report.causes


@pytest.mark.slow
def test_the_revised_machine_reproduces_the_prediction() -> None:
    """Half a second of the simulator with a light slider against the quasi-static law: within 10 % of its spread."""
    runs = [hidden(swing(0.010), 1000.0, 4e-3, 1e6, 1), hidden(swing(0.012), 1000.0, 4e-3, 1e6, 2)]
    report = reconcile_driven(SPEC, runs, seed=1)
    machine = MachineSpec.model_validate(report.machine)
    load = machine.loads[0]
    longest = float(report.provenance["longest_step_s"])  # type: ignore[arg-type]
    steps = min(math.ceil(load.step_s / longest) if math.isfinite(longest) else 64, 4000)
    found = simulate(
        machine,
        duration_s=1.2,
        output_rate_hz=RATE,
        channels=report.provenance["force_channels"],  # type: ignore[arg-type]
        settings=Settings(steps_per_output=steps, estimate_error=False),
    )
    shown = np.asarray(report.pictures["traces"][0]["after"])[: found.signals.shape[1]]  # type: ignore[index]
    difference = found.signals.sum(axis=0) - shown
    assert math.sqrt(float(np.mean(difference**2))) < 0.1 * shown.std()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("names", "transfers"),
    [
        (("ds2_1Hz30lbtension0.5amplitude", "ds2_1Hz30lbtension1.5amplitude"), True),
        (("ds1_1Hz20lbtension", "ds1_1Hz80lbtension"), False),
    ],
)
def test_a_measured_brake_shows_backlash_and_friction(names: tuple[str, str], transfers: bool) -> None:
    """Travel until 80 % of the sliding force lies between 0.19 and 0.40 in, as read off the 18 files of the series."""
    report = reconcile_driven(SPEC, [measured(name) for name in names], seed=1)
    assert report.verdict == "explained"
    assert report.causes[0].term == "backlash"
    assert "friction" in report.sentence
    travel = next(s["travel_after_reversal"] for s in report.stages if s["stage"] == "locate")
    assert 0.19 < travel["mean_m"] / INCH_M < 0.40  # type: ignore[index]
    value, low, high = severity(report, "backlash")
    assert 1.5e-3 < low < value < high < 8e-3
    assert report.held_out is not None
    assert report.held_out.gain_low > 0.4
    assert report.held_out.gain > max(report.held_out.retuned or 0, report.held_out.black_box or 0)
    validations = [s for s in report.stages if s["stage"] == "validate"]
    assert all(v["friction_transfers"] is transfers for v in validations)
    assert any("does not transfer" in text for text in report.undecidable) is not transfers
