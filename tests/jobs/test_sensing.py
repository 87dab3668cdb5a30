"""Sensors of a request: what is simulated for them, what the labels make of what they see, what is refused."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from jobs.analysis import analyse
from jobs.carry_out import CAUSES, Outcome, carry_out, completed
from jobs.limits import Limits
from jobs.physics import PhysicsEngine
from jobs.request import SimulationRequest
from jobs.resolve import resolve, restored
from jobs.sensing import SENSORS
from sim.core.errors import SpecError

ENGINE = PhysicsEngine()
ACC = {"kind": "accelerometer", "name": "acc", "place": {"location": "resonator1"}}
TACHO = {"kind": "tacho", "name": "key", "shaft": "input"}


def ask(*channels: dict, preset: str = "paper-demo", clock: dict | None = None, **more: object) -> SimulationRequest:
    body = {"preset": preset, "duration_s": 0.6, "sampling_rate_hz": 30_000.0, **more}
    return SimulationRequest.model_validate({**body, "sensors": {"channels": list(channels), "clock": clock or {}}})


def carried(request: SimulationRequest) -> Outcome:
    document = resolve(request, ENGINE, Limits()).document
    machine, again = restored(document)
    return carry_out(ENGINE, machine, again, progress=lambda _: None, cancelled=lambda: False)


@cache
def noisy(density: float, ppm: float = 0.0, tacho: bool = False) -> Outcome:
    sensor = {**ACC, "noise": {"density_per_sqrt_hz": density}}
    return carried(ask(sensor, *([TACHO] if tacho else []), clock={"rate_error_ppm": ppm}))


def statuses(outcome: Outcome) -> dict[str, dict]:
    peaks = analyse(outcome.response, discard_transient=True).peaks["peaks"]
    assert isinstance(peaks, list)
    return {p["label"]: p for p in peaks if p["label"]}


@pytest.mark.slow
def test_only_what_the_sensors_need_is_simulated_and_an_ideal_one_shows_it() -> None:
    outcome = carried(ask(ACC))
    assert outcome.raw is not None
    assert [c.name for c in outcome.raw.channels] == ["resonator1.y.acceleration"]
    assert [c.name for c in outcome.response.channels] == ["acc"]
    assert np.array_equal(outcome.raw.signals[0], outcome.response.signals[0])
    assert outcome.extras[SENSORS]["channels"][0]["sources"] == {"resonator1.y.acceleration": 1.0}


@pytest.mark.slow
def test_labels_call_absent_what_the_noise_hides() -> None:
    quiet, loud = statuses(noisy(1e-9)), statuses(noisy(0.2))
    seen = {label for label, p in quiet.items() if p["status"] == "present" and label in loud}
    hidden = {label for label in seen if loud[label]["status"] == "absent"}
    weak = [label for label in seen if quiet[label]["amplitude"] < 0.01]
    assert len(hidden) >= 0.9 * len(weak) > 0
    assert loud["1*f_m"]["status"] == "present", "what stands above the noise stays"
    assert loud["1*f_m"]["amplitude"] == pytest.approx(quiet["1*f_m"]["amplitude"], rel=0.05)
    for label in hidden:
        assert loud[label]["detection_limit"] > quiet[label]["amplitude"]


@pytest.mark.slow
def test_a_wrong_clock_loses_the_lines_unless_a_tacho_tells_the_speed() -> None:
    lost, kept = noisy(1e-6, ppm=3000.0), noisy(1e-6, ppm=3000.0, tacho=True)
    assert lost.response.bases_hz["f_m"] == pytest.approx(690.0)
    assert kept.response.bases_hz["f_m"] == pytest.approx(690.0 / 1.003)
    assert statuses(lost)["3*f_m"]["status"] == "absent"
    assert statuses(kept)["3*f_m"]["status"] == "present"


@pytest.mark.slow
def test_marked_gaps_leave_a_channel_out_of_the_analysis() -> None:
    gap = {"dropouts": {"gaps": [{"start_s": 0.4, "duration_s": 0.01}], "fill": "nan"}}
    outcome = carried(ask({**ACC, **gap}, {**ACC, "name": "whole"}))
    documents = completed(analyse(outcome.response, discard_transient=True), outcome.extras)
    assert documents.peaks["channel"] == "whole"
    assert any("missing: acc" in text for text in documents.summary["warnings"])
    assert {s.channel for s in documents.spectra} == {"whole"}
    alone = analyse(carried(ask({**ACC, **gap})).response, discard_transient=True)
    assert "missing" in str(alone.peaks["reason"])


@pytest.mark.slow
def test_causes_are_those_of_the_measured_lines() -> None:
    outcome = carried(ask(ACC, causes=True, preset="paper-lightly-damped", set={"eccentricity@pinion.radius": 2e-5}))
    documents = completed(analyse(outcome.response, discard_transient=True), outcome.extras)
    line = next(p for p in documents.peaks["peaks"] if p["label"] == "1*f_m+1*f_r1")
    assert line["causes"][0]["term"] == "eccentricity" and line["causes"][0]["share"] > 0.9
    assert {CAUSES, SENSORS} <= set(outcome.extras)


def test_a_request_without_sensors_keeps_its_identity_and_lists_tell_a_chain_shortly() -> None:
    plain = SimulationRequest.model_validate({"preset": "oscillator", "duration_s": 0.5})
    assert SENSORS not in resolve(plain, ENGINE, Limits()).document
    taps = {"path": {"kind": "impulse_response", "sampling_rate_hz": 1e4, "taps": [0.5] * 1000}}
    found = resolve(ask({**ACC, **taps}), ENGINE, Limits())
    assert len(found.document[SENSORS]["channels"][0]["path"]["taps"]) == 1000
    assert found.source[SENSORS]["channels"] == [{"kind": "accelerometer", "name": "acc", "preset": None}]
    assert found.cost.seconds > resolve(plain, ENGINE, Limits()).cost.seconds


@pytest.mark.slow
def test_tachos_alone_and_a_machine_that_does_not_turn() -> None:
    outcome = carried(ask(TACHO))
    assert [c.name for c in outcome.response.channels] == ["key"]
    mass = {"kind": "velocity", "name": "v", "place": {"location": "mass"}}
    still = carried(ask(mass, preset="oscillator"))
    assert still.response.channels[0].unit == "m/s"


@pytest.mark.parametrize(
    ("request_", "field"),
    [
        (ask({**ACC, "place": {"location": "resonator9"}}), "sensors.channels.0.place.location"),
        (
            ask({**ACC, "place": {"location": "resonator1", "direction_deg": 0.0}}),
            "sensors.channels.0.place.direction_deg",
        ),
        (ask({**TACHO, "shaft": "motor"}), "sensors.channels.0.shaft"),
        (ask(TACHO, preset="oscillator"), "sensors.channels.0.shaft"),
        (
            ask({**TACHO, "pulser": {"pulses_per_revolution": 10_000}}, duration_s=100.0),
            "sensors.channels.0.pulser.pulses_per_revolution",
        ),
        (ask(ACC, clock={"sampling_rate_hz": 48_000.0}), "sensors.clock.sampling_rate_hz"),
        (ask(ACC, clock={"sampling_rate_hz": 100.0}), "sensors.clock.sampling_rate_hz"),
        (ask(ACC, clock={"jitter_rms_s": 1e-4}), "sensors.clock.jitter_rms_s"),
        (ask(ACC, channels=["resonator1.y.acceleration"]), "channels"),
    ],
)
def test_what_cannot_be_measured_is_refused_before_it_is_simulated(request_: SimulationRequest, field: str) -> None:
    with pytest.raises(SpecError) as caught:
        resolve(request_, ENGINE, Limits())
    problem = caught.value.problems[0]
    assert problem.field == field and problem.given is not None and problem.allowed
