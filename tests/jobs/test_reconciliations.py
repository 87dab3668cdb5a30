"""A reconciliation from acceptance through the worker's hands and back, on a real catalogue and folder."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from jobs import transitions
from jobs.budget import Budget
from jobs.errors import BudgetSpent, IdempotencyConflict, ResultNotReady
from jobs.reconciliations import carry_out
from jobs.reconciliations.chosen import _looked_up
from jobs.record import Answer
from jobs.recordings.words import RECORDING
from jobs.results import ResultReader
from jobs.status import Status
from reconcile.verdict import Cause, Report
from sim.core.errors import Problem, SpecError
from store.catalogue.ledger import SqlLedger
from tests.service.fakes import machine
from tests.service.reconciling import World, made


@pytest.fixture
def world(tmp_path: Path) -> World:
    return World(tmp_path)


REPORT = Report(
    verdict="explained",
    sentence="A <b> spall.",
    level="machine",
    machine={"name": "m"},
    provenance={},
    causes=(
        Cause(term="outer_spall", site="bearing1", score=9.0, named=True),
        Cause(term="unbalance", site="input", score=1.0),
    ),
)


@pytest.mark.slow
def test_the_answer_is_kept_as_report_page_and_machine(world: World, monkeypatch: pytest.MonkeyPatch) -> None:
    seen: dict[str, Any] = {}

    def engine(known: Any, tests: Any, baselines: Any, **how: Any) -> Report:
        seen.update(how, known=known, tests=tests, baselines=baselines)
        how["progress"](0.5, "held-out data")
        seen["told"] = world.catalogue.get(record.id).progress
        return REPORT

    monkeypatch.setattr(carry_out, "reconcile_recordings", engine)
    a, b = world.recording(1), world.recording(2)
    record = world.ask([a], baselines=[b], budget="full", seed=7)
    assert (record.kind, record.source["machine"], record.source["recordings"]) == (
        "reconciliation",
        "kinematics",
        [a],
    )
    done = world.carried_out(record)
    assert done.status is Status.SUCCESSFUL and done.result is not None and done.result.expires_at is not None
    np.testing.assert_array_equal(seen["tests"][0].samples, made(1).samples)
    np.testing.assert_array_equal(seen["baselines"][0].samples, made(2).samples)
    assert (seen["seed"], seen["budget"].name, seen["told"].stage) == (7, "full", "held-out data")
    assert 0.4 < seen["told"].fraction < 0.6
    assert world.catalogue.get(record.id).result == done.result
    assert done.result.answer == Answer(verdict="explained", causes=("outer_spall@bearing1",))
    reader = ResultReader(world.artefacts, f"{record.id}/1")
    assert reader.document("report")["sentence"] == "A <b> spall."
    assert reader.document("summary") == {"verdict": "explained", "sentence": "A <b> spall.", "level": "machine"}
    assert reader.document("machine") == {"name": "m"}
    page = world.artefacts.read(f"{record.id}/1/report.html").decode()
    assert "A &lt;b&gt; spall." in page and "<script" not in page


@pytest.mark.slow
def test_keys_that_are_not_used_stand_in_the_limits(world: World, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(carry_out, "reconcile_recordings", lambda *_given, **_how: REPORT)
    odd, plain = world.sent(made(1), shelf="left"), world.recording(2)
    for ids, baselines in (([odd], [plain]), ([plain], [odd])):
        record = world.ask(ids, baselines=baselines)
        world.carried_out(record)
        report = ResultReader(world.artefacts, f"{record.id}/1").document("report")
        assert report["where"]["limits"] == [f"r.npz ({odd}): shelf: is not used here"]
        assert "shelf: is not used here" in world.artefacts.read(f"{record.id}/1/report.html").decode()


@pytest.mark.slow
def test_the_same_question_is_one_job_another_is_another(world: World) -> None:
    a, b = world.recording(1), world.recording(2)
    first = world.ask([a])
    assert world.ask([a]).id == first.id
    others = [
        world.ask([a], seed=1),
        world.ask([a], budget="full"),
        world.ask([b]),
        world.ask([a], baselines=[b]),
        world.ask([a], "oscillator"),
    ]
    assert len({r.id for r in (first, *others)}) == 6
    assert world.ask([a], machine().model_dump(mode="json")).id == others[-1].id, "a preset is its specification"
    assert world.ask([a], key="k").id == first.id
    with pytest.raises(IdempotencyConflict):
        world.ask([b], key="k")


@pytest.mark.slow
def test_recordings_that_cannot_be_used_are_named(world: World) -> None:
    a, gone, late = world.recording(1), world.recording(2), world.recording(3, read=False)
    world.catalogue.change(gone, lambda r: transitions.delete(r, 1.0))
    simulation = world.ask([a]).id
    with pytest.raises(SpecError) as refused:
        world.ask([a, "nothing", gone, late], baselines=[a, simulation])
    told = {p.field: p.message for p in refused.value.problems}
    assert set(told) == {"recordings.1", "recordings.2", "baselines.0", "baselines.1"}
    assert "not the id" in told["recordings.1"] and "deleted" in told["recordings.2"]
    assert "second time" in told["baselines.0"] and "reconciliation" in told["baselines.1"]
    with pytest.raises(ResultNotReady, match=late):
        world.ask([a, late])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("known", "field"),
    [
        ("nothing", "machine"),
        ({"kinematics": {"shafts": []}}, "machine.kinematics.shafts"),
        ({"kinematics": {}, "name": "x"}, "machine.name"),
        ({"name": "x", "bodies": [{"name": "m"}]}, "machine.bodies.0.mass_kg"),
        ({"parameters": 3}, "machine.parameters"),
        ({"parameters": {}, "other": 1}, "machine.other"),
    ],
)
def test_a_machine_that_is_none_is_refused_at_once(world: World, known: object, field: str) -> None:
    with pytest.raises(SpecError) as refused:
        world.ask([world.recording(1)], known)
    assert field in [p.field for p in refused.value.problems]


@pytest.mark.slow
def test_what_the_engine_refuses_is_told_field_by_field(world: World, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: Any, **__: Any) -> Report:
        raise SpecError(Problem(field="recording[0]", message="is too short", given=np.float64(0.5), unit="s"))

    monkeypatch.setattr(carry_out, "reconcile_recordings", refuse)
    done = world.carried_out(world.ask([world.recording(1)]))
    assert done.status is Status.FAILED and done.failure is not None and done.failure.detail is not None
    assert done.failure.code == "not-reconcilable"
    (error,) = done.failure.detail["errors"]  # type: ignore[misc, attr-defined]
    assert (error["field"], error["given"]) == ("recording[0]", 0.5)


@pytest.mark.slow
def test_a_recording_deleted_in_the_meantime_is_told(world: World) -> None:
    a = world.recording(1)
    record = world.ask([a])
    world.catalogue.change(a, lambda r: transitions.delete(r, 1.0))
    done = world.carried_out(record)
    assert done.failure is not None and done.failure.code == "not-reconcilable" and "deleted" in done.failure.message


@pytest.mark.slow
def test_a_defect_of_ours_tells_no_paths_and_the_worker_goes_on(world: World, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: Any, **__: Any) -> Report:
        raise ValueError("/secret/path")

    monkeypatch.setattr(carry_out, "reconcile_recordings", broken)
    done = world.carried_out(world.ask([world.recording(1)]))
    assert done.failure is not None and done.failure.code == "internal" and "/secret" not in done.failure.message


@pytest.mark.slow
def test_a_cancel_is_heard_between_two_simulations(world: World, monkeypatch: pytest.MonkeyPatch) -> None:
    ran: list[int] = []

    def engine(*_: Any, progress: Any, mapper: Any, **__: Any) -> Report:
        progress(0.1, "atlas at 20 Hz")

        def simulate(task: int) -> list[None]:
            ran.append(task)
            if task == 2:
                world.catalogue.change(record.id, lambda r: transitions.withdraw(r, ("me",), world.now))
            return [None]

        list(mapper(simulate, range(10)))
        return REPORT

    monkeypatch.setattr(carry_out, "reconcile_recordings", engine)
    record = world.ask([world.recording(1)])
    assert world.carried_out(record).status is Status.DISMISSED
    assert ran == [0, 1, 2]


@pytest.mark.slow
def test_progress_goes_through_the_parts_of_an_atlas(world: World, monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[tuple[float, str]] = []

    def engine(*_: Any, progress: Any, mapper: Any, **__: Any) -> Report:
        for share, stage in ((0.1, "atlas at 20 Hz"), (0.7, "refining")):
            progress(share, stage)
            for _found in mapper(lambda task: [None], range(4)):
                state = world.catalogue.get(record.id).progress
                told.append((state.fraction, state.stage))
        return replace(REPORT, machine=None)

    monkeypatch.setattr(carry_out, "reconcile_recordings", engine)
    record = world.ask([world.recording(1)])
    assert world.carried_out(record).status is Status.SUCCESSFUL
    assert [stage for _, stage in told[:2]] == ["atlas at 20 Hz, part 1 of 4", "atlas at 20 Hz, part 2 of 4"]
    fractions = [fraction for fraction, _ in told]
    assert fractions == sorted(fractions) and len(set(fractions)) == 8 and fractions[-1] < 0.97
    assert not ResultReader(world.artefacts, f"{record.id}/1").has("machine")


@pytest.mark.slow
def test_what_is_accepted_is_charged_once_and_a_refusal_costs_nothing(world: World) -> None:
    ledger = SqlLedger(world.catalogue.engine)
    world.desk = replace(world.desk, budget=Budget(holder="me", core_seconds_per_day=24.0, ledger=ledger))
    a = world.recording(1)
    assert ledger.used("me", world.now) == 0, "reading a recording is not charged"
    for _ in range(2):
        record = world.ask([a], key="k")
        assert ledger.used("me", world.now) == record.cost.seconds == 5.0
    with pytest.raises(IdempotencyConflict):
        world.ask([a], key="k", seed=1)
    assert ledger.used("me", world.now) == 5.0
    b = world.recording(2)
    world.ask([a, b], seed=2)
    with pytest.raises(BudgetSpent):
        world.ask([a, b], key="late", seed=3)
    world.desk = replace(world.desk, budget=None)
    assert world.ask([a, b], key="late", seed=3).status is Status.ACCEPTED


@pytest.mark.slow
def test_what_a_worker_refuses_names_the_recording(world: World) -> None:
    once, again = world.recording(1), world.sent(replace(made(1), notes="sent again"))
    record = world.carried_out(world.ask([once, again]))
    assert record.status is Status.FAILED and record.failure is not None
    assert f"r.npz ({again})" in str(record.failure)


@pytest.mark.parametrize(("code", "word"), [("refused", "refused"), ("internal", "failed")])
def test_a_recording_that_was_refused_is_called_so(code: str, word: str) -> None:
    record = SimpleNamespace(
        kind=RECORDING,
        gone=None,
        status=Status.FAILED,
        failure=SimpleNamespace(code=code, message="too short"),
    )
    found, why = _looked_up(SimpleNamespace(get=lambda _: record), "r")  # type: ignore[arg-type]
    assert found is None and why == f"is a recording that could not be read ({word}): too short"
