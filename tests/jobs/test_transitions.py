"""The state machine: a stateful model, and the steps one by one."""

from __future__ import annotations

import pytest
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule

from jobs import transitions as t
from jobs.errors import IllegalTransition, StaleAttempt
from jobs.record import Cost, Failure, JobRecord, Progress, ResultRef
from jobs.status import Status

COST = Cost(steps=1, memory_bytes=1, seconds=1.0)
LOST = Failure(code="worker-lost", message="gone")
RESULT = ResultRef(attempt=1, size_bytes=1, sha256="0" * 64, expires_at=None)


def accepted() -> JobRecord:
    return t.new(job_id="j", kind="simulation", submitter="a", source={}, cost=COST, now=1.0)


def running() -> JobRecord:
    return t.start(accepted(), attempt=1, worker="w", lease_s=10, now=2.0)


def test_only_one_worker_gets_an_attempt() -> None:
    with pytest.raises(StaleAttempt):
        t.start(running(), attempt=1, worker="other", lease_s=10, now=3.0)


def test_progress_never_goes_back() -> None:
    far = t.advance(running(), attempt=1, progress=Progress(fraction=0.6, stage="x"), lease_s=10, now=3.0)
    back = t.advance(far, attempt=1, progress=Progress(fraction=0.2, stage="y"), lease_s=10, now=4.0)
    assert (back.progress.fraction, back.progress.stage, back.lease_until) == (0.6, "y", 14.0)


def test_cancel_withdraws_one_and_stops_with_the_last() -> None:
    both = t.submit_again(running(), "b", 3.0)
    one = t.withdraw(both, {"a"}, 4.0)
    assert (one.submitters, one.cancel_requested_at, one.status) == (("b",), None, Status.RUNNING)
    none = t.withdraw(one, {"b"}, 5.0)
    assert none.cancel_requested_at == 5.0 and none.status is Status.RUNNING
    assert t.dismiss(none, attempt=1, now=6.0).status is Status.DISMISSED
    assert t.withdraw(accepted(), {"a"}, 5.0).status is Status.DISMISSED


def test_asking_again_while_it_is_being_stopped_starts_a_new_attempt() -> None:
    stopping = t.withdraw(running(), {"a"}, 3.0)
    again = t.submit_again(stopping, "b", 4.0)
    assert (again.status, again.attempt, again.submitters) == (Status.ACCEPTED, 2, ("b",))
    with pytest.raises(StaleAttempt):
        t.succeed(again, attempt=1, result=RESULT, now=5.0)


def test_result_that_comes_after_the_cancel_is_kept() -> None:
    stopping = t.withdraw(running(), {"a"}, 3.0)
    done = t.succeed(stopping, attempt=1, result=RESULT, now=4.0)
    assert done.status is Status.SUCCESSFUL and done.cancel_requested_at is None


def test_lost_attempts_are_tried_again_a_bounded_number_of_times() -> None:
    record = running()
    for attempt in (1, 2):
        record = t.lose(record, attempt=attempt, failure=LOST, max_losses=2, delay_s=0, now=3.0)
        assert (record.status, record.attempt) == (Status.ACCEPTED, attempt + 1)
        record = t.start(record, attempt=attempt + 1, worker="w", lease_s=1, now=3.0)
    record = t.lose(record, attempt=3, failure=LOST, max_losses=2, delay_s=0, now=4.0)
    assert record.status is Status.FAILED and record.failure is not None and "3 attempts" in record.failure.message


def test_lease_that_was_renewed_is_not_taken() -> None:
    with pytest.raises(StaleAttempt):
        t.lapse(running(), attempt=1, failure=LOST, max_losses=2, now=11.0)
    assert t.lapse(running(), attempt=1, failure=LOST, max_losses=2, now=13.0).attempt == 2


def test_handing_back_does_not_count_as_a_loss() -> None:
    back = t.release(running(), attempt=1, now=3.0)
    assert (back.status, back.attempt, back.losses) == (Status.ACCEPTED, 2, 0)


def test_jobs_under_way_are_not_deleted_and_finished_ones_not_cancelled() -> None:
    with pytest.raises(IllegalTransition):
        t.delete(running(), 3.0)
    done = t.succeed(running(), attempt=1, result=RESULT, now=3.0)
    with pytest.raises(IllegalTransition):
        t.withdraw(done, {"a"}, 4.0)
    renewed = t.submit_again(t.expire(done, 5.0), "b", 6.0)
    assert (renewed.status, renewed.gone, renewed.result, renewed.attempt) == (Status.ACCEPTED, None, None, 2)


class Lifecycle(RuleBasedStateMachine):
    """Any order of events, stale ones included, keeps the promises."""

    def __init__(self) -> None:
        super().__init__()
        self.record = accepted()
        self.now = 1.0
        self.highest = 1

    def step(self, change: object) -> None:
        self.now += 1.0
        try:
            self.record = change(self.record)  # type: ignore[operator]
        except IllegalTransition:
            return

    @rule(name=st.sampled_from("abc"))
    def submit(self, name: str) -> None:
        self.step(lambda r: t.submit_again(r, name, self.now))
        assert self.record.status.active or self.record.status is Status.SUCCESSFUL

    @rule(back=st.integers(0, 2))
    def start(self, back: int) -> None:
        self.step(lambda r: t.start(r, attempt=r.attempt - back, worker="w", lease_s=5, now=self.now))

    @rule(back=st.integers(0, 1), outcome=st.sampled_from(["succeed", "fail", "dismiss", "lose", "release"]))
    def end(self, back: int, outcome: str) -> None:
        before = self.record
        attempt = before.attempt - back
        ways = {
            "succeed": lambda r: t.succeed(r, attempt=attempt, result=RESULT, now=self.now),
            "fail": lambda r: t.fail(r, attempt=attempt, failure=LOST, now=self.now),
            "dismiss": lambda r: t.dismiss(r, attempt=attempt, now=self.now),
            "lose": lambda r: t.lose(r, attempt=attempt, failure=LOST, max_losses=2, delay_s=0, now=self.now),
            "release": lambda r: t.release(r, attempt=attempt, now=self.now),
        }
        self.step(ways[outcome])
        if back:
            assert self.record == before, "a stale report changes nothing"

    @rule(names=st.sets(st.sampled_from("abc")))
    def withdraw(self, names: set[str]) -> None:
        self.step(lambda r: t.withdraw(r, names, self.now))

    @precondition(lambda self: not self.record.status.active)
    @rule(how=st.sampled_from([t.expire, t.delete]))
    def forget(self, how: object) -> None:
        self.step(lambda r: how(r, self.now))  # type: ignore[operator]

    @invariant()
    def promises(self) -> None:
        r = self.record
        assert r.attempt >= self.highest
        self.highest = r.attempt
        assert (r.status is Status.RUNNING) == (r.lease_until is not None)
        assert (r.finished_at is not None) == (not r.status.active)
        assert (r.failure is not None) == (r.status is Status.FAILED)
        assert r.losses <= 3
        if r.status is Status.SUCCESSFUL:
            assert r.result is not None
        if r.status is Status.ACCEPTED:
            assert r.submitters and r.gone is None


TestLifecycle = Lifecycle.TestCase
