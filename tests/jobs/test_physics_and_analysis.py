"""The real physics behind the ports: what the service says of it, and what it keeps of a run."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from jobs.analysis import analyse
from jobs.labelling import label_stored
from jobs.limits import Limits
from jobs.physics import PhysicsEngine
from jobs.request import SimulationRequest
from jobs.resolve import resolve, restored
from jobs.results import ResultReader, write_result
from sim.core.errors import SpecError
from sim.solve.api import simulate
from store.artefacts.folder import FolderStore

ENGINE = PhysicsEngine()
LIMITS = Limits()


def ask(**body: object) -> SimulationRequest:
    return SimulationRequest.model_validate({"preset": "paper-demo", **body})


def fields(error: SpecError) -> list[str]:
    return [problem.field for problem in error.problems]


def test_cost_grows_with_duration_and_is_bounded() -> None:
    one = resolve(ask(duration_s=1), ENGINE, LIMITS).cost
    ten = resolve(ask(duration_s=10), ENGINE, LIMITS).cost
    assert ten.steps == 10 * one.steps and ten.memory_bytes > one.memory_bytes and ten.seconds > one.seconds
    with pytest.raises(SpecError) as caught:
        resolve(ask(duration_s=10), ENGINE, Limits(steps=ten.steps - 1))
    problem = caught.value.problems[0]
    assert (problem.field, problem.given, problem.unit) == ("duration_s", 10.0, "steps")


def test_sampling_below_what_the_labels_need() -> None:
    with pytest.raises(SpecError) as caught:
        resolve(ask(sampling_rate_hz=1500), ENGINE, LIMITS)
    problem = caught.value.problems[0]
    assert problem.field == "sampling_rate_hz" and problem.allowed == ">= 1843.2" and problem.unit == "Hz"


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"fit_clearance@bearing1.gap": 20.0}, "if meant in um"),
        ({"fit_clearance@bearing1.gape": 2e-5}, "unknown parameter"),
        ({"fit_clearance@bearing9.gap": 2e-5}, "bearing9"),
        ({"no_such_term@bearing1.gap": 2e-5}, "no_such_term"),
        ({"gears.pinion.teeth": 5}, ">= 6"),
        ({"operating.speed_hz": 1e6}, "<= 1000"),
    ],
)
def test_overrides_that_do_not_fit(change: dict[str, float], says: str) -> None:
    with pytest.raises(SpecError) as caught:
        resolve(ask(set=change), ENGINE, LIMITS)
    assert says in str(caught.value)


def test_override_moves_the_frequencies() -> None:
    resolved = resolve(ask(set={"operating.speed_hz": 20}), ENGINE, LIMITS)
    machine = resolved.document["machine"]
    assert isinstance(machine, dict) and machine["operating"]["speed_hz"] == 20.0


def test_every_channel_named_is_there_and_others_are_refused() -> None:
    with pytest.raises(SpecError) as caught:
        resolve(ask(channels=["bearing1.y.nothing"]), ENGINE, LIMITS)
    assert fields(caught.value) == ["channels.0"]


@pytest.mark.slow
def test_demo_run_is_kept_with_its_labels(tmp_path: Path) -> None:
    ENGINE.warm(lanes=True)
    machine = ENGINE.preset("paper-demo")
    told: list[float] = []
    response = ENGINE.simulate(
        machine,
        duration_s=1.0,
        sampling_rate_hz=20_000.0,
        channels=None,
        seed=0,
        progress=told.append,
        cancelled=lambda: False,
    )
    assert told == sorted(told) and told[-1] == 1.0
    documents = analyse(response, discard_transient=True)
    store = FolderStore(tmp_path)
    first = write_result(store, "j/1", attempt=1, response=response, documents=documents, expires_at=None)
    second = write_result(store, "j/2", attempt=1, response=response, documents=documents, expires_at=None)
    assert first == second, "the same response gives the same bytes"
    reader = ResultReader(store, "j/1")
    peaks = reader.document("peaks")
    assert peaks["frequencies"]["f_m"] == 690.0
    assert abs(peaks["frequencies"]["f_o1"] - 77.21) < 0.01 and abs(peaks["frequencies"]["f_r2"] - 8.5185) < 1e-4
    present = {p["label"] for p in peaks["peaks"] if p["status"] == "present"}
    assert {"1*f_m", "1*f_m-1*f_r1", "1*f_m+1*f_r1"} <= present
    name = reader.manifest.channels[0].name
    assert np.array_equal(reader.signal(name, 0, 20_000), response.signals[0])
    kinds = {entry.kind for entry in reader.manifest.spectra if entry.channel == name}
    assert kinds == {"amplitude", "psd", "envelope", "order"}
    assert label_stored(reader, name, machine)["peaks"] == peaks["peaks"]
    again = label_stored(reader, reader.manifest.channels[1].name, machine)
    assert again["channel"] == reader.manifest.channels[1].name and again["peaks"]


@pytest.mark.slow
def test_a_contact_that_never_closed_is_told() -> None:
    def warnings(gap_m: float) -> list[str]:
        request = ask(set={"fit_clearance@bearing1.gap": gap_m})
        machine, _ = restored(resolve(request, ENGINE, LIMITS).document)
        response = simulate(machine, duration_s=0.1, output_rate_hz=20_000.0)
        told = analyse(response, discard_transient=False).summary["warnings"]
        assert isinstance(told, list)
        return [w for w in told if w.startswith("bearing1")]

    assert warnings(2e-5) == []
    far = warnings(3e-4)
    assert any("may never touch the bore" in w for w in far)
    assert any(w.startswith("bearing1.wall was never in contact: ") for w in far)
